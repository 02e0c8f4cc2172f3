//! Slides along surfaces that move or are curved: they cost steps as smooth solutions do.

use super::chattering::{METHODS, run};
use super::hybrid::near;

/// Simulates for 10 s and compares with values there.
fn slides(text: &str, expected: &[(&str, f64)]) {
    for method in METHODS {
        for tolerance in [1e-4, 1e-5, 1e-6, 1e-7] {
            let run = run(text, method, tolerance, 10.0);
            let cost = run.cost();
            for (name, value) in expected {
                near(run.at(name, 10.0), *value, 100.0 * tolerance);
            }
            assert!(cost.slides == 1 && cost.state_events < 10, "{method}, {tolerance}: {cost:?}");
            // The one of these methods of which the order falls along a slide takes most.
            let most = if method == "rodas4" { 10_000 } else { 600 };
            assert!(cost.steps < most, "{method}, {tolerance}: {cost:?}");
        }
    }
}

#[test]
fn a_slide_follows_a_surface_that_oscillates() {
    let from_it = "model S Real x(start = 0, fixed = true);
        equation der(x) = if x > 0.3*sin(3*time) then -2 else 2; end S;";
    let from_above = "model S Real x(start = 1, fixed = true); Real s = 0.3*sin(3*time);
        equation der(x) = if x > s then -1 else 1; end S;";
    for text in [from_it, from_above] {
        slides(text, &[("x", 0.3 * 30f64.sin())]);
    }
}

#[test]
fn states_beside_a_slide_move_with_the_mean() {
    // The share of the upper field is (2 - cos t)/4, so that y' = 5 + cos t.
    let text = "model S Real x(start = 0, fixed = true); Real y(start = 0, fixed = true);
        equation der(x) = if x > sin(time) then -2 else 2;
        der(y) = if x > sin(time) then 3 else 7; end S;";
    slides(text, &[("x", 10f64.sin()), ("y", 50.0 + 10f64.sin())]);
}

#[test]
fn a_slide_goes_round_a_circle() {
    // The angular velocity is 1 on both sides.
    let text = "model S Real x(start = 2, fixed = true); Real y(start = 0, fixed = true);
        Real r2 = x^2 + y^2; equation der(x) = -y + (if r2 > 1 then -x else x);
        der(y) = x + (if r2 > 1 then -y else y); end S;";
    slides(text, &[("x", 10f64.cos()), ("y", 10f64.sin())]);
}

#[test]
fn a_slide_is_left_at_the_time_when_a_field_turns() {
    // sin t = 1/2 at pi/6; v = 2 (cos(pi/6) - cos t) - (t - pi/6) from there on.
    let text = "model S Real v(start = 0, fixed = true);
        equation der(v) = 2*sin(time) - (if v > 0 then 1 else -1); end S;";
    let start = std::f64::consts::FRAC_PI_6;
    let v = 2.0 * (start.cos() - 1.5f64.cos()) - (1.5 - start);
    for method in METHODS {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            near(run(text, method, tolerance, 1.5).at("v", 1.5), v, 20.0 * tolerance);
        }
    }
}
