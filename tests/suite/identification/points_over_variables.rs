//! Measured X that is a function of time with events: the points lie at the times at which the simulated
//! X has the measured values, and where there is no such time or more than one, the points are refused.
//! Every X is inverted here by hand; x = exp(-t).

use crate::support::shipped;
use gapilib::Value;
use gapilib::internals::value::{ArrayValue, Elements};

/// What `Eval` gives for x at these values of X, and what was said.
fn evaluated(x: &str, points: &[f64]) -> (Vec<f64>, String) {
    let points: Vec<String> = points.iter().map(f64::to_string).collect();
    let script = format!(
        "model M\n  parameter Real k = 1;\n  Real x(start = 1, fixed = true);\n  Real u = 2*time;\n  \
         {x}\nequation\n  der(x) = -k*x;\n  \
         annotation(experiment(StopTime = 3, Tolerance = 1e-8));\nend M;\n\
         D = Eval(\"\", \"M\", {{{}}}, [1.0], {{\"k\"}}, \"X\", \"x\");\n",
        points.join(", ")
    );
    let run = shipped::run("test.mos", &script);
    let values = match run.session.variable("D") {
        Some(Value::Array(ArrayValue { elements: Elements::Real(values), .. })) => values.clone(),
        _ => Vec::new(),
    };
    (values, run.errors)
}

#[test]
fn points_lie_where_the_simulated_x_has_their_values() {
    let ramp = "time + (if time > 1 then 1 else 0)";
    let semi = "time + semiLinear(time - 1, 2, 0)";
    let table: [(&str, &[f64], &[f64]); 12] = [
        (ramp, &[0.5, 2.0, 2.5, 3.25], &[0.5, 1.0, 1.5, 2.25]),
        ("if time < 1 then time else 4*time - 3", &[0.5, 1.0, 3.0], &[0.5, 1.0, 1.5]),
        ("smooth(0, if time > 1 then 4*time - 3 else time)", &[0.5, 3.0], &[0.5, 1.5]),
        (semi, &[0.5, 2.5], &[0.5, 1.5]),
        ("time + sign(time - 1)", &[-0.5, 2.5], &[0.5, 1.5]),
        ("time + floor(time)", &[0.5, 2.5, 4.25], &[0.5, 1.5, 2.25]),
        ("time + integer(u)", &[0.25, 1.75, 3.4], &[0.25, 0.75, 1.4]),
        ("time + noEvent(if time > 1 then 1 else 0)", &[0.5, 2.5], &[0.5, 1.5]),
        ("max(time, 2*time - 1)", &[0.5, 2.0], &[0.5, 1.5]),
        ("3*time - abs(u - 2)", &[0.5, 3.5], &[0.5, 1.5]),
        ("if u > 2 then 6 - time else 9 - time", &[8.5, 4.5], &[0.5, 1.5]),
        (
            "if time > 2 then 4*time elseif u > 2 then 3*time else time",
            &[0.5, 4.5, 10.0],
            &[0.5, 1.5, 2.5],
        ),
    ];
    for (x, points, times) in table {
        let (found, said) = evaluated(&format!("Real X = {x};"), points);
        assert_eq!((found.len(), said.as_str()), (points.len(), ""), "{x}");
        for (found, time) in found.iter().zip(times) {
            let expected = (-time).exp();
            assert!((found - expected).abs() < 1e-5 * expected, "{x}: {found} {expected}");
        }
    }
}

/// A value at which X is held counts where it is reached first: at the end of a ramp, and in the middle.
#[test]
fn held_values_count_where_they_are_reached_first() {
    let ramp = "Modelica.Blocks.Sources.Ramp i(height = 2, duration = 1, startTime = 0.5); \
                Real X = i.y;";
    let table: [(&str, &[f64], &[f64]); 5] = [
        (ramp, &[0.0, 1.0, 2.0], &[0.0, 1.0, 1.5]),
        ("Real X = if time < 1 then time else 1;", &[0.5, 1.0], &[0.5, 1.0]),
        ("Real X = min(time, 0.703);", &[0.5, 0.703], &[0.5, 0.703]),
        (
            "Real X = if time < 1 then time elseif time < 2 then 1 else time - 1;",
            &[1.0, 1.5],
            &[1.0, 2.5],
        ),
        ("Real X = -max(time, 1.25);", &[-1.25, -2.0], &[0.0, 2.0]),
    ];
    for (x, points, times) in table {
        let (found, said) = evaluated(x, points);
        assert_eq!((found.len(), said.as_str()), (points.len(), ""), "{x}");
        for (found, time) in found.iter().zip(times) {
            let expected = (-time).exp();
            assert!((found - expected).abs() < 1e-6 * expected, "{x}: {found} {expected}");
        }
    }
}

#[test]
fn blocks_that_begin_later_are_followed() {
    let ramp = "Modelica.Blocks.Sources.Ramp i(height = 1, duration = 1, startTime = 1); \
                Real X = i.y;";
    let (found, said) = evaluated(ramp, &[0.25, 0.75]);
    assert_eq!(said, "");
    for (found, time) in found.iter().zip([1.25_f64, 1.75]) {
        assert!((found - (-time).exp()).abs() < 1e-6, "{found} at {time}");
    }
}

#[test]
fn values_taken_twice_or_never_are_refused_with_the_reason() {
    let refused = |x: &str, point: f64, code: &str, words: &str| {
        let (found, said) = evaluated(&format!("Real X = {x};"), &[point]);
        assert!(found.is_empty(), "{x}: {found:?}");
        assert!(said.contains(code) && said.contains(words), "{x}: {said}");
    };
    let several = "takes the measured value";
    refused("if time < 1.5 then time else 3 - time", 1.0, "error[not-monotone]", several);
    refused("time - floor(time)", 0.5, "error[not-monotone]", several);
    refused(
        "if time < 1 then time elseif time < 2 then 1 else 3 - time",
        1.0,
        "error[not-monotone]",
        several,
    );
    let jump = "time + (if time > 1 then 1 else 0)";
    refused(jump, 1.5, "error[points-outside]", "jumps over this value at 1 s");
    refused(jump, 4.5, "error[points-outside]", "simulated only from 0 to 4");
}
