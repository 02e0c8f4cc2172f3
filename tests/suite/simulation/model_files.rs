//! Models that read files, use texts and draw random numbers: what is read when they are compiled,
//! and what every simulation has for itself.

use crate::support::shipped;
use gapilib::Session;
use gapilib::internals::mat::{self, Matrix};
use gapilib::world::MemoryWorld;

const TABLES: &str = "#1\n# two tables\ndouble steps(4,3)\n0 0 1\n1 2 3\n1 5 3\n2 7 4\n\
                      float line(2,2)\n0 1\n4 9\n";

fn world() -> MemoryWorld {
    let matrix = Matrix::from_rows(&[vec![0.0, -1.0], vec![2.0, 3.0]]);
    shipped::world()
        .with_file("data/t.txt", TABLES)
        .with_file("t.csv", "a;b\n0;10\n1;30\n2;20\n")
        .with_file("t.mat", mat::write_v4([("m", &matrix)]).expect("a file"))
        .with_file("/lib/P/package.mo", "package P end P;")
        .with_file("/lib/P/Resources/t.txt", "#1\ndouble own(2,2)\n0 0\n1 6\n")
}

/// Runs a script in a world; the session with what was wrong.
fn run(world: MemoryWorld, script: &str) -> (Session, String) {
    let streams = world.streams();
    let mut session = Session::new(Box::new(world));
    session.add_library_dir(std::path::Path::new("/lib"));
    session.run_text("test.mos", script);
    (session, streams.errors())
}

fn number(session: &Session, name: &str) -> f64 {
    let value = session.variable(name).unwrap_or_else(|| panic!("{name} is not assigned"));
    value.as_real().unwrap_or_else(|| panic!("{name} is not a number"))
}

#[test]
fn tables_in_files_are_read_when_the_model_is_compiled() {
    let (session, errors) = run(
        world(),
        "model M
           parameter String folder = \"data\";
           Modelica.Blocks.Sources.CombiTimeTable steps(
             tableOnFile = true, tableName = \"steps\", fileName = folder + \"/t.txt\", columns = 2:3);
           Modelica.Blocks.Tables.CombiTable1Ds line(
             tableOnFile = true, tableName = \"line\", columns = {2},
             fileName = Modelica.Utilities.Files.loadResource(\"data/t.txt\"));
           Modelica.Blocks.Tables.CombiTable1Ds csv(
             tableOnFile = true, fileName = \"t.csv\", tableName = \"x\", columns = {2},
             delimiter = \";\", nHeaderLines = 1);
           Modelica.Blocks.Tables.CombiTable1Ds mat(
             tableOnFile = true, fileName = \"t.mat\", tableName = \"m\", columns = {2});
           Modelica.Blocks.Tables.CombiTable1Ds own(
             tableOnFile = true, fileName = \"modelica://P/Resources/t.txt\", tableName = \"own\",
             columns = {2});
           Modelica.Blocks.Tables.CombiTable1Ds twice(
             tableOnFile = true, fileName = \"modelica://P//Resources/t.txt\", tableName = \"own\",
             columns = {2});
           Real x(start = 0, fixed = true);
         equation
           twice.u = time;
           der(x) = steps.y[1];
           line.u = time;
           csv.u = time;
           mat.u = time;
           own.u = time;
         end M;
         loadModel(P);
         simulateModel(\"M\", stopTime = 2, tolerance = 1e-9, resultFile = \"r\");
         all := readTrajectory(\"r.mat\", {\"x\", \"steps.y[2]\", \"line.y[1]\", \"csv.y[1]\", \"mat.y[1]\",
                               \"own.y[1]\"}, readTrajectorySize(\"r.mat\"));
         x := all[1, end]; steps := all[2, end]; line := all[3, end];
         csv := all[4, end]; mat := all[5, end]; own := all[6, end];",
    );
    assert_eq!(errors, "");
    // ∫ 2 t from 0 to 1 and ∫ 5 + 2 (t - 1) from 1 to 2.
    assert!((number(&session, "x") - 7.0).abs() < 1e-7, "{}", number(&session, "x"));
    for (name, expected) in
        [("steps", 4.0), ("line", 5.0), ("csv", 20.0), ("mat", 3.0), ("own", 12.0)]
    {
        assert!((number(&session, name) - expected).abs() < 1e-12, "{name}");
    }
}

#[test]
fn a_table_that_is_not_there_is_an_error_of_the_model() {
    let wrong = |modifier: &str| {
        let script = format!(
            "model M
               Modelica.Blocks.Tables.CombiTable1Ds t(tableOnFile = true, {modifier});
             equation
               t.u = time;
             end M;
             simulateModel(\"M\");"
        );
        run(world(), &script).1
    };
    let errors = wrong("fileName = \"nowhere.txt\", tableName = \"t\", columns = {2}");
    assert!(errors.contains("there is no file `nowhere.txt`"), "{errors}");
    let errors = wrong("fileName = \"data/t.txt\", tableName = \"lime\", columns = {2}");
    assert!(errors.contains("`lime`"), "{errors}");
    let errors = wrong("fileName = \"data/t.txt\", tableName = \"line\", columns = {3}");
    assert!(errors.contains("no column 3"), "{errors}");
}

/// The expected numbers are xorshift1024* (Vigna 2016) of the words 2i + 1 + 2³² (2i + 2), computed
/// with another program.
#[test]
fn every_simulation_has_random_numbers_of_its_own() {
    let (session, errors) = run(
        world(),
        "impure function setState
           input Integer state[33];
           input Integer id;
           external \"C\" ModelicaRandom_setInternalState_xorshift1024star(state, size(state, 1), id);
         end setState;
         function start
           input Integer id;
           output Integer same;
         protected
           Integer state[33];
         algorithm
           state := cat(1, 1:32, {0});
           same := id;
           setState(state, same);
         end start;
         impure function draw
           input Integer id;
           output Real y;
           external \"C\" y = ModelicaRandom_impureRandom_xorshift1024star(id);
         end draw;
         model M
           parameter Integer id = start(7);
           discrete Real a(start = 0, fixed = true);
           discrete Real b(start = 0, fixed = true);
         algorithm
           when sample(0.1, 0.1) then
             a := draw(id);
             b := draw(id);
           end when;
         end M;
         simulateModel(\"M\", stopTime = 0.35, resultFile = \"r\");
         all := readTrajectory(\"r.mat\", {\"a\", \"b\"}, readTrajectorySize(\"r.mat\"));
         a := all[1, end]; b := all[2, end];
         simulateModel(\"M\", stopTime = 0.25, resultFile = \"r\");
         all := readTrajectory(\"r.mat\", {\"a\", \"b\"}, readTrajectorySize(\"r.mat\"));
         c := all[1, end]; d := all[2, end];",
    );
    assert_eq!(errors, "");
    assert_eq!(number(&session, "a"), 0.38722104692499104);
    assert_eq!(number(&session, "b"), 0.045592668276383974);
    assert_eq!(number(&session, "c"), 0.8755638338816416);
    assert_eq!(number(&session, "d"), 0.536539070551582);
}

/// The object is made when the model is flattened, and once more when the simulation starts.
#[test]
fn values_of_tables_shape_models() {
    let (session, errors) = run(
        world(),
        "model M
           parameter Real points[2, 2] = {{0, 1}, {1, 3}};
           parameter Modelica.Blocks.Types.ExternalCombiTable1D table =
             Modelica.Blocks.Types.ExternalCombiTable1D(\"NoName\", \"NoName\", points, {2},
               Modelica.Blocks.Types.Smoothness.LinearSegments);
           parameter Real u = 1;
           parameter Integer n =
             integer(Modelica.Blocks.Tables.Internal.getTable1DValueNoDer(table, 1, u) + 0.5);
           Real x[n];
           Real y = Modelica.Blocks.Tables.Internal.getTable1DValueNoDer(table, 1, time);
         equation
           for i in 1:n loop x[i] = i*time; end for;
         end M;
         simulateModel(\"M\", stopTime = 1, resultFile = \"r\");
         all := readTrajectory(\"r.mat\", {\"x[3]\", \"y\"}, readTrajectorySize(\"r.mat\"));
         x := all[1, end]; y := all[2, end];",
    );
    assert_eq!((errors.as_str(), number(&session, "x")), ("", 3.0));
    assert!((number(&session, "y") - 3.0).abs() < 1e-12);
}
