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
    let (session, errors) = run(world(), include_str!("../../data/models/model_files_tables.mos"));
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
    let (session, errors) = run(world(), include_str!("../../data/models/model_files_random.mos"));
    assert_eq!(errors, "");
    assert_eq!(number(&session, "a"), 0.38722104692499104);
    assert_eq!(number(&session, "b"), 0.045592668276383974);
    assert_eq!(number(&session, "c"), 0.8755638338816416);
    assert_eq!(number(&session, "d"), 0.536539070551582);
}

/// The object is made when the model is flattened, and once more when the simulation starts.
#[test]
fn values_of_tables_shape_models() {
    let (session, errors) = run(world(), include_str!("../../data/models/model_files_values.mos"));
    assert_eq!((errors.as_str(), number(&session, "x")), ("", 3.0));
    assert!((number(&session, "y") - 3.0).abs() < 1e-12);
}
