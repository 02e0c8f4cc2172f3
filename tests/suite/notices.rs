//! What models tell while they are simulated: warnings and texts that they print.

use gapilib::script::Session;
use gapilib::script::world::MemoryWorld;

const MODEL: &str = "model P
  impure function tell
    input String text;
    input String file = \"\";
    external \"C\" ModelicaInternal_print(text, file);
  end tell;
  Real x(start = 0, fixed = true);
  Boolean up(start = false, fixed = true);
  Integer n(start = 0, fixed = true);
equation
  der(x) = 1;
  assert(x < 0.3 or x > 0.6, \"x is between\", AssertionLevel.warning);
  when initial() then
    tell(\"start\");
  end when;
  when {x > 0.5, x > 0.8} then
    up = true;
    n = pre(n) + 1;
    tell(\"event \" + String(n) + \" at \" + String(time) + \", up \" + String(up));
    assert(x < 0.7, \"late: \" + String(n), AssertionLevel.warning);
  end when;
algorithm
  when sample(0.25, 0.5) then
    tell(\"tick\");
  end when;
end P;";

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

#[test]
fn printing_to_a_file_is_refused() {
    let model = MODEL.replace("tell(\"tick\")", "tell(\"tick\", \"out.txt\")");
    let (_, output, errors) = run(&model, "openModel(\"P.mo\");\nsimulateModel(\"P\");");
    assert!(errors.contains("printing to a file"), "{output}{errors}");
}
