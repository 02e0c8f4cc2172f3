//! What functions assert that are called without use of their values, and what initial sections
//! assert (MLS §8.3.7, §12.4).

use gapilib::Session;

const PACKAGE: &str = include_str!("../../data/models/assertions_package.mo");

const MESSAGES: &str = include_str!("../../data/models/assertions_messages.mo");

/// Exit code, output and errors.
fn simulate_message(model: &str) -> (u8, String, String) {
    let world = crate::support::shipped::world().with_file("V.mo", MESSAGES);
    let streams = world.streams();
    let script = format!("openModel(\"V.mo\");\nsimulateModel(\"V.{model}\", stopTime = 1);");
    let status = Session::new(Box::new(world)).run_text("s.mos", &script);
    (status.code, streams.output(), streams.errors())
}

#[test]
fn messages_have_the_values_of_when_they_are_given() {
    let (code, _, errors) = simulate_message("Warning");
    assert_eq!(code, 0, "{errors}");
    let words = "p = 0.5|true  |     0.5|starting|starting |low (at t = 0.";
    assert!(errors.contains(words) && !errors.contains('…'), "{errors}");
    // It is given at the end of a step, with what x is then.
    let number = |before: &str, after: char| -> f64 {
        let (_, rest) = errors.split_once(before).expect("the words before a number");
        rest.split(after).next().expect("a number").parse().expect("a number")
    };
    assert!((number("x = ", ',') + number("(at t = ", ')') - 1.0).abs() < 1e-3, "{errors}");
    let failing = [
        ("Error", "x = 0.50, i = 2 (at t = 0.5"),
        ("AtEvent", "x = 0.75 (at t = 0.25"),
        ("Stopped", "x is 0.75 (at t = 0.75"),
    ];
    for (model, message) in failing {
        let (code, _, errors) = simulate_message(model);
        assert!(code != 0 && errors.contains(message), "{model}: {errors}");
    }
    let (code, _, errors) = simulate_message("InFunction");
    // Where x reaches the bound, n is about to change from 1 to 2.
    let has_numbers = [1, 2].iter().any(|n| errors.contains(&format!(", n = {n} (at t = 0.5")))
        && !errors.contains('…');
    assert!(code != 0 && has_numbers, "{errors}");
}

#[test]
fn strings_of_loop_variables_have_their_types() {
    let (code, output, errors) = simulate_message("Printed");
    assert_eq!(code, 0, "{errors}");
    let lines = ["0.25 0.5", "2.75 5.5", "[0.5]1   off", "[0.5]2   starting", "running 5"];
    for line in lines {
        assert!(output.contains(line), "`{line}` is not in {output}");
    }
}

fn simulate(model: &str) -> (u8, String) {
    let world = crate::support::shipped::world().with_file("Q.mo", PACKAGE);
    let streams = world.streams();
    let script = format!("openModel(\"Q.mo\");\nsimulateModel(\"Q.{model}\", stopTime = 1);");
    let status = Session::new(Box::new(world)).run_text("s.mos", &script);
    (status.code, streams.errors())
}

fn fails(model: &str, message: &str) {
    let (code, errors) = simulate(model);
    assert!(errors.contains(message), "{model}: {errors}");
    assert_ne!(code, 0, "{model}");
}

#[test]
fn functions_called_for_what_they_assert_are_looked_at() {
    for model in ["Equation", "Statement", "Unused"] {
        fails(model, "y too large (at t = 0.9");
    }
}

#[test]
fn what_stands_in_a_branch_is_looked_at_only_there() {
    for model in ["Branch", "Nested"] {
        let (code, errors) = simulate(model);
        assert_eq!(code, 0, "{model}: {errors}");
    }
}

#[test]
fn messages_may_be_known_in_part() {
    let (code, errors) = simulate("Texts");
    assert_eq!(code, 0, "{errors}");
    fails("BadSum", "the sum is not 1");
    fails("Negative", "in m: X[");
}

#[test]
fn initial_sections_assert_at_the_start_alone() {
    let (code, errors) = simulate("Start");
    assert_eq!(code, 0, "{errors}");
    fails("BadStart", "too small at the start (at t = 0)");
    fails("BadCall", "y too large (at t = 0)");
    fails("When", "too small at the start (at t = 0)");
}

/// `|Σ f - 1| <= 0` asks more of a sum than arithmetic gives; a difference that matters fails.
#[test]
fn sums_are_asserted_up_to_rounding() {
    let model = |value: &str| {
        format!(
            "model M parameter Real f[3] = {{{value}, 0.2, 0.1}}; initial equation \
             assert(abs(f[1] + f[2] + f[3] - 1) <= 0, \"the fractions\"); \
             equation assert(sum(f) <= 1 and abs(1 - sum(f))*time <= 0, \"the sum\"); end M;"
        )
    };
    let run = |value: &str| {
        let world = gapilib::world::MemoryWorld::new().with_file("M.mo", model(value));
        let errors = world.streams();
        let script = "openModel(\"M.mo\");\nsimulateModel(\"M\", stopTime = 1);";
        let status = Session::new(Box::new(world)).run_text("s.mos", script);
        (status.code, errors.errors())
    };
    let (code, errors) = run("0.7");
    assert_eq!(code, 0, "{errors}");
    let (code, errors) = run("0.70000001");
    assert!(code != 0 && errors.contains("the fractions"), "{errors}");
}
