//! Sessions: exit codes, strictness, dialects, echo, libraries, and what lasts between statements.

use gapilib::Value;
use gapilib::world::MemoryWorld;
use gapilib::{Dialect, Echo, Options, Permissions, Session, Strictness, Transcript};
use std::path::Path;

fn run(world: MemoryWorld, options: Options, script: &str) -> (u8, String, Session) {
    let streams = world.streams();
    let mut session = Session::new(Box::new(world)).with_options(options);
    let status = session.run_text("test.mos", script);
    (status.code, streams.output(), session)
}

fn with_strictness(strictness: Strictness, script: &str) -> (u8, String) {
    let options = Options { strictness, ..Options::default() };
    let (code, output, _) = run(MemoryWorld::new(), options, script);
    (code, output)
}

#[test]
fn an_error_that_nobody_read_is_exit_code_one() {
    let broken = "x = 1 + \"a\"\nprint(\"on\")";
    assert_eq!(with_strictness(Strictness::Usual, broken), (1, "on\n".to_owned()));
    assert_eq!(with_strictness(Strictness::Lenient, broken), (0, "on\n".to_owned()));
    assert_eq!(with_strictness(Strictness::Strict, broken), (1, String::new()));
    let read = "x = 1 + \"a\"\nmessage = getLastError();";
    assert_eq!(with_strictness(Strictness::Usual, read).0, 0);
}

#[test]
fn a_negative_answer_stops_a_strict_run() {
    let script = "ok = openModel(\"missing.mo\");\nprint(\"on\")";
    assert_eq!(with_strictness(Strictness::Usual, script), (1, "on\n".to_owned()));
    assert_eq!(with_strictness(Strictness::Strict, script), (1, String::new()));
}

#[test]
fn exit_ends_every_script_with_its_status() {
    let world = MemoryWorld::new().with_file("inner.mos", "exit(4);\nprint(\"inner\");");
    let script = "for i in 1:3 loop\n  RunScript(\"inner.mos\");\nend for\nprint(\"outer\")";
    let (code, output, _) = run(world, Options::default(), script);
    assert_eq!((code, output.as_str()), (4, ""));
}

#[test]
fn an_interrupt_ends_nested_scripts_and_says_so_once() {
    let world = MemoryWorld::new().with_file("inner.mos", "i = i + 1;").interrupted_after(50);
    let streams = world.streams();
    let mut session = Session::new(Box::new(world));
    let status = session
        .run_text("test.mos", "i = 0;\nwhile true loop\n  RunScript(\"inner.mos\");\nend while");
    assert!(status.interrupted);
    assert_eq!(status.code, 130);
    assert_eq!(streams.errors().matches("interrupted]").count(), 1, "{}", streams.errors());
}

#[test]
fn everything_is_echoed_as_dymola_logs_it() {
    let options = Options { echo: Echo::Everything, ..Options::default() };
    let script =
        "x = 3;\nx = 4;\nv = {1.5, 2};\nx + 1;\nfor i in 1:2 loop x = i; end for\nclearlog();";
    let (_, output, _) = run(MemoryWorld::new(), options, script);
    insta::assert_snapshot!(output, @r"
    x = 3;
    Declaring variable: Integer x ;
    x = 4;
    v = {1.5, 2};
    Declaring variable: Real v [2] ;
    x + 1;
     = 5
    for i in 1:2 loop x = i; end for
    clearlog();
     = true
    ");
}

#[test]
fn nothing_is_echoed_where_nothing_is_wanted() {
    let options = Options { echo: Echo::Nothing, ..Options::default() };
    let (_, output, _) = run(MemoryWorld::new(), options, "1 + 1\nprint(\"on\")");
    assert_eq!(output, "on\n");
}

#[test]
fn the_dialect_is_recognized_or_given() {
    let dialect = |options, script| run(MemoryWorld::new(), options, script).2.dialect();
    let usual = Options::default();
    assert_eq!(dialect(usual, "x = 1"), Dialect::Dymola);
    assert_eq!(dialect(usual, "x = 1; loadModel(M);"), Dialect::OpenModelica);
    assert_eq!(dialect(usual, "simulateModel(\"M\"); getErrorString();"), Dialect::Dymola);
    let given = Options { dialect: Some(Dialect::OpenModelica), ..usual };
    assert_eq!(dialect(given, "simulateModel(\"M\")"), Dialect::OpenModelica);
}

#[test]
fn a_library_folder_gives_the_newest_version() {
    let world = MemoryWorld::new()
        .with_file("/lib/P 1.9.0/package.mo", "package P constant Integer n = 1; end P;")
        .with_file("/lib/P 1.10.0/package.mo", "package P constant Integer n = 2; end P;")
        .with_file("/lib/P 1.10.0/data/table.txt", "#1\ndouble t(1,1)\n7\n")
        .with_file("/lib/F.mo", "function F output Integer y; algorithm y := P.n; end F;");
    let streams = world.streams();
    let mut session = Session::new(Box::new(world));
    session.add_library_dir(Path::new("/lib"));
    let status = session.run_text(
        "test.mos",
        "y = F();\nfile = Modelica.Utilities.Files.loadResource(\"modelica://P/data/table.txt\");\n\
         t = readMatrix(file, \"t\", 1, 1);\nx = t[1,1];",
    );
    assert_eq!(status.errors, 0, "{}", streams.errors());
    assert_eq!(session.variable("y"), Some(&Value::Integer(2)));
    assert_eq!(session.variable("x"), Some(&Value::Real(7.0)));
}

#[test]
fn models_beside_the_scripts_are_found() {
    let world = MemoryWorld::new()
        .with_file("/project/models/P/package.mo", "package P constant Integer n = 3; end P;")
        .with_file("/project/scripts/case/main.mos", "n = P.n");
    let mut session = Session::new(Box::new(world));
    let status = session.run_file(Path::new("/project/scripts/case/main.mos"));
    assert_eq!(status.errors, 0);
    assert_eq!(session.variable("n"), Some(&Value::Integer(3)));
}

#[test]
fn a_script_that_changes_is_read_again() {
    let world = MemoryWorld::new().with_file("inner.mos", "n = 1\n");
    let script = "RunScript(\"inner.mos\")\na = n;\n\
                  Modelica.Utilities.Streams.print(\"n = 2\", \"inner.mos\")\n\
                  RunScript(\"inner.mos\")\nb = n;";
    let permissions = Permissions { write: true, ..Permissions::default() };
    let options = Options { permissions, ..Options::default() };
    let (code, _, session) = run(world, options, script);
    assert_eq!(code, 0);
    assert_eq!(session.variable("a"), Some(&Value::Integer(1)));
    assert_eq!(session.variable("b"), Some(&Value::Integer(2)));
}

#[test]
fn a_class_defined_again_is_translated_again() {
    let script = "function f output Integer y; algorithm y := 1; end f;\na = f();\n\
                  function f output Integer y; algorithm y := 2; end f;\nb = f();";
    let (_, _, session) = run(MemoryWorld::new(), Options::default(), script);
    assert_eq!(session.variable("a"), Some(&Value::Integer(1)));
    assert_eq!(session.variable("b"), Some(&Value::Integer(2)));
}

#[test]
fn work_at_the_end_is_done_once() {
    fn say(session: &mut Session) -> Result<(), gapilib::Diagnostic> {
        session.print("end\n");
        Ok(())
    }
    let world = MemoryWorld::new();
    let streams = world.streams();
    let mut session = Session::new(Box::new(world));
    session.at_end(say);
    session.at_end(say);
    session.run_text("test.mos", "print(\"script\")");
    session.run_text("test.mos", "print(\"another\")");
    assert_eq!(streams.output(), "script\nend\nanother\n");
}

#[test]
fn flags_are_stored_and_read() {
    let script = "Advanced.StoreProtectedVariables = true;\nx = Advanced.StoreProtectedVariables;";
    let (code, _, session) = run(MemoryWorld::new(), Options::default(), script);
    assert_eq!((code, session.variable("x")), (0, Some(&Value::Boolean(true))));
}

#[test]
fn a_transcript_is_the_same_each_time() {
    let transcript = || {
        let mut session = Session::new(Box::new(MemoryWorld::new()));
        session.output.transcript = Some(Transcript::default());
        session.run_text("test.mos", "x = {1/3, 2};\nx\nlist()\ny = z");
        session.output.transcript.take().map(|transcript| transcript.to_string())
    };
    assert_eq!(transcript(), transcript());
}

#[test]
fn a_working_directory_changed_by_a_model_is_kept() {
    let world = MemoryWorld::new().with_file("sub/M.mo", "model M Real x = 1; end M;");
    let (code, _, session) = run(world, Options::default(), "openModel(\"sub/M.mo\")");
    assert_eq!(code, 0);
    assert_eq!(session.world.current_dir(), Path::new("/memory/sub"));
}

/// A flat model with more than 10,000 equations is given back once the model is translated; `checkModel`
/// asks for it afterwards.
#[test]
fn a_large_flat_model_is_made_again_where_it_is_asked_for() {
    let model = "model Chain\n  parameter Integer n = 10001;\n  Real x[n](each start = 1);\n  Real y;\n\
                 equation\n  y = x[1];\n  for i in 1:n loop\n    der(x[i]) = -x[i];\n  end for;\nend Chain;";
    let world = MemoryWorld::new().with_file("Chain.mo", model);
    let script = "loadFile(\"Chain.mo\");\ncheckModel(Chain);";
    let (_, output, _) = run(world, Options::default(), script);
    let checked = "Check of Chain completed successfully.\n\
                   Class Chain has 10002 equation(s) and 10002 variable(s).\n\
                   10002 of these are trivial equation(s).";
    assert_eq!(output, format!("true\n\"{checked}\"\n"));
}
