//! What models tell while they are simulated: warnings and texts that they print.

use gapilib::Session;
use gapilib::world::MemoryWorld;

const MODEL: &str = include_str!("../../data/models/notices_model.mo");

fn run(model: &str, script: &str) -> (u8, String, String) {
    let world = MemoryWorld::new().with_file("P.mo", model);
    let streams = world.streams();
    let status = Session::new(Box::new(world)).run_text("s.mos", script);
    (status.code, streams.output(), streams.errors())
}

#[test]
fn what_models_print_and_warn_of_is_told_in_its_order() {
    let script = "openModel(\"P.mo\");\nsimulateModel(\"P\", stopTime = 1);";
    let (code, output, errors) = run(MODEL, script);
    assert_eq!(code, 0, "{output}{errors}");
    let expected = ["start", "tick", "event 1 at 0.5, up true", "tick", "event 2 at 0.8, up true"];
    let lines: Vec<&str> =
        output.lines().filter(|line| expected.contains(line) || line.contains("event")).collect();
    assert_eq!(lines, expected, "{output}");
    // A warning that goes on holding is told once, and none ends the simulation.
    assert_eq!(
        errors.matches("x is between").count(),
        1 + 1,
        "with the line it stands in: {errors}"
    );
    assert!(errors.contains("late: 2 (at t = 0.8"), "{errors}");
    assert!(!errors.contains("late: 1"), "{errors}");
}

const WRITER: &str = include_str!("../../data/models/notices_writer.mo");

fn after_writer(model: &str, then: &str) -> (u8, String, String) {
    let world = MemoryWorld::new().with_file("P.mo", model);
    let streams = world.streams();
    let script = format!("openModel(\"P.mo\");\nsimulateModel(\"W\", stopTime = 1);\n{then}");
    let status = Session::new(Box::new(world)).run_text("s.mos", &script);
    (status.code, streams.output(), streams.errors())
}

/// The numbers of a text that goes into a file are those of the event, in the forms of `String`
/// (MLS §3.7.1).
#[test]
fn numbers_of_an_event_are_printed_into_files() {
    let model = include_str!("../../data/models/notices_printed.mo");
    let then = "Modelica.Utilities.Streams.readFile(\"log.txt\")\n\
                Modelica.Utilities.Streams.readFile(\"other.txt\")";
    let (code, output, errors) = after_writer(model, then);
    assert_eq!(code, 0, "{output}{errors}");
    let lines = ["0;0;1234567;false ;   0.000", "0.5;0.333;2469134;false ;   1.000"];
    assert!(output.contains(&format!("{{\"{}\", \"{}\", ", lines[0], lines[1])), "{output}");
    assert!(output.contains("\"1;0.667;3703701;true  ;   2.000\"}"), "{output}");
    assert!(output.contains("{\"u is 0.1666666667\"}"), "{output}");
}

#[test]
fn files_that_a_model_writes_are_there_behind_the_simulation_and_written_once() {
    let then =
        "Modelica.Utilities.Streams.readFile(\"log.txt\")\nreadMatrix(\"end.mat\", \"A\", 2, 2)";
    let (code, output, errors) = after_writer(WRITER, then);
    assert_eq!(code, 0, "{output}{errors}");
    assert!(output.contains("{\"event\", \"number 2\", \"event\", \"number 4\"}"), "{output}");
    assert!(output.contains("[1.0, 2.0;\n3.0, 4.0]"), "{output}");
    let other = WRITER.replace("method = 1", "method = 2");
    let (_, _, errors) = after_writer(&other, "readMatrix(\"end.mat\", \"A\", 2, 2)");
    assert!(errors.contains("end.mat"), "a branch that is not taken writes nothing: {errors}");
}

/// Its functions could be carried out on expressions; then what they write would be written in
/// branches that are not taken, too.
#[test]
fn every_call_that_writes_is_carried_out_where_it_stands() {
    let pure = WRITER.replace("impure function", "function");
    let several = pure.replace(
        "  parameter Integer method",
        concat!(include_str!("../../data/models/notices_all.mo"), "  parameter Integer method"),
    );
    let model = several.replace("write(\"end.mat\", \"A\", [x, n; 3, 4])", "all(x)");
    let read = |file: &str| format!("readMatrix(\"{file}.mat\", \"A\", 1, 1)\n");
    let (_, output, errors) = after_writer(&model, &(read("a") + &read("c")));
    assert_eq!(errors, "", "{output}");
    assert!(output.contains("[1.0]") && output.contains("[2.0]"), "{output}");
    let (_, _, errors) = after_writer(&model, &read("b"));
    assert!(errors.contains("b.mat"), "{errors}");
}

#[test]
fn where_nothing_may_be_written_the_simulation_says_so() {
    let model = WRITER.replace("end.mat", "/elsewhere/end.mat");
    let (code, output, errors) = after_writer(&model, "");
    assert_ne!(code, 0, "{output}{errors}");
    assert!(errors.contains("/elsewhere/end.mat"), "{errors}");
}

#[test]
fn what_is_written_has_no_value() {
    let pure = WRITER.replace("impure function write", "function write");
    let model = pure.replace("der(x) = 1", "der(x) = if write(\"a\", \"b\", [x]) then 1 else 2");
    let (_, output, errors) = after_writer(&model, "");
    assert!(errors.contains("the function `W.write` writes"), "{output}{errors}");
}

/// The value of such a call says that it was carried out; files grow in the order of the statements.
#[test]
fn the_value_of_a_call_that_writes_can_be_assigned() {
    let model = include_str!("../../data/models/notices_assigned.mo");
    let read = |file: &str, name: &str| format!("readMatrix(\"{file}\", \"{name}\", 1, 1)\n");
    let all = read("all.mat", "A") + &read("all.mat", "B") + &read("all.mat", "C");
    let (code, output, errors) = after_writer(model, &(all + &read("other.mat", "A")));
    assert_eq!((code, errors.as_str()), (0, ""), "{output}");
    // Events lie closely behind the instants of their relations.
    for value in ["[1.0]", "[2.0]", "[0.25", "[0.5"] {
        assert!(output.contains(value), "{value} in {output}");
    }
    let (_, _, errors) = after_writer(model, &read("never.mat", "A"));
    assert!(errors.contains("never.mat"), "a branch that is not taken writes nothing: {errors}");
    // A part of an expression that is not needed writes nothing.
    let part = model.replace("other = write(", "other = x > 3 or write(");
    let (code, output, errors) = after_writer(&part, &read("other.mat", "A"));
    assert_eq!((code, errors.as_str()), (0, ""), "{output}");
    assert!(output.contains("[0.5"), "{output}");
}

const TALKING: &str = include_str!("../../data/models/notices_talking.mo");

/// What functions print whose values are used, at events and in equations.
#[test]
fn functions_print_what_they_say_once_at_each_event() {
    let script = "openModel(\"P.mo\");\nsimulateModel(\"P\", stopTime = 1);";
    let said = |output: &str| {
        let lines = output.lines().filter_map(|line| line.split_once("f of "));
        lines.map(|(_, x)| x.to_owned()).collect::<Vec<_>>()
    };
    let (code, output, errors) = run(TALKING, script);
    assert_eq!((code, errors.as_str()), (0, ""), "{output}");
    assert_eq!(said(&output), ["0.5", "0.75", "7.5", "1", "10"]);
    // A loop calls the function for every value that it tries.
    let looped = TALKING.split_once("  when time").expect("a when-clause").0.to_owned()
        + "  when sample(0.25, 0.25) then y = f(v); w = pre(w) + 1; u = y; end when;\nend P;";
    let (code, output, errors) = run(&looped, script);
    assert_eq!((code, errors.as_str()), (0, ""), "{output}");
    assert_eq!(said(&output), ["3", "6", "9", "12"]);
    // Between events nobody could tell how often it is called.
    let stepwise = TALKING.replace("der(z) = 1", "der(z) = f(z) + 1");
    let (code, output, errors) = run(&stepwise, script);
    assert_eq!((code, said(&output).len()), (0, 5), "{output}");
    assert!(errors.contains("what `P.f` prints is left out"), "{errors}");
}

/// Not allowed by MLS §12.3, but in the standard library.
#[test]
fn what_an_equation_prints_is_told_once_and_warned_of() {
    let model = MODEL.replace(
        "  when initial() then\n    tell(\"start\");\n  end when;",
        "  tell(\"x = \" + String(x + 2));\n  if x > 0.5 then tell(\"high at \" + String(x)); end if;",
    );
    let script = "openModel(\"P.mo\");\nsimulateModel(\"P\", stopTime = 1);";
    let (code, output, errors) = run(&model, script);
    assert_eq!(code, 0, "{output}{errors}");
    assert_eq!(output.matches("x = ").count(), 1, "{output}");
    assert!(output.contains("x = 2\n"), "{output}");
    assert_eq!(output.matches("high at 0.5").count(), 1, "{output}");
    assert!(errors.contains("it prints once at the start"), "{errors}");
    // Files are not written there, and values of impure functions have no instant.
    let file = model.replace("String(x + 2));", "String(x + 2), \"f.txt\");");
    let (code, _, errors) = run(&file, script);
    assert!(code != 0 && errors.contains("outside of when-clauses and initial"), "{errors}");
    let nested = model.replace("end tell;", "end tell;
  impure function draw output Real y; external \"C\" y = ModelicaRandom_impureRandom_xorshift1024star(1); end draw;")
        .replace("String(x + 2)", "String(draw())");
    let (code, _, errors) = run(&nested, script);
    assert!(code != 0 && errors.contains("`P.draw` is impure"), "{errors}");
}
