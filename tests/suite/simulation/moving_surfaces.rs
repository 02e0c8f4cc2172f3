//! Slides along surfaces that move or are curved: they cost steps as smooth solutions do.

use super::chattering::{METHODS, run};
use crate::support::simulated::near;

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

/// Fields that lead round a corner: no surface attracts by itself.
fn spiral(force: &str) -> String {
    format!(
        "model C Real x(start = 1, fixed = true); Real y(start = 1, fixed = true);
        Real w(start = 0, fixed = true);
        Real sx = if x > 0 then 1 else -1; Real sy = if y > 0 then 1 else -1;
        equation der(x) = -sx + 2*sy + {force}; der(y) = -2*sx - sy; der(w) = 3 + sx; end C;"
    )
}

#[test]
fn a_spiral_into_a_corner_comes_to_rest_there() {
    for method in METHODS {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let run = run(&spiral("0"), method, tolerance, 10.0);
            let cost = run.cost();
            near(run.at("x", 10.0), 0.0, tolerance);
            near(run.at("y", 10.0), 0.0, tolerance);
            // With the integrals A and B of sx and sy: -1 = -A + 2 B, -1 = -2 A - B.
            near(run.at("w", 10.0), 30.0 + 3.0 / 5.0, tolerance);
            assert!(cost.slides == 1 && cost.state_events < 30, "{method}, {tolerance}: {cost:?}");
        }
    }
}

#[test]
fn a_corner_is_left_along_one_of_its_surfaces() {
    // sx = t/10 and sy = -t/5 until t = 5; then sx = t/2 - 2 on x = 0 below y = 0 until t = 6.
    for method in METHODS {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let run = run(&spiral("time/2"), method, tolerance, 8.0);
            let cost = run.cost();
            let accuracy = 100.0 * tolerance;
            near(run.at("y", 4.9), 0.0, accuracy);
            near(run.at("x", 5.9), 0.0, accuracy);
            near(run.at("y", 6.0), -0.5, accuracy);
            near(run.at("x", 8.0), 1.0, accuracy);
            near(run.at("y", 8.0), -2.5, accuracy);
            assert!(cost.state_events < 60, "{method}, {tolerance}: {cost:?}");
        }
    }
}

#[test]
fn a_corner_that_repels_is_not_held() {
    // Round the other way in growing turns: the solution stays outside.
    let text = "model C Real x(start = 0.01, fixed = true); Real y(start = 0.01, fixed = true);
        Real sx = if x > 0 then 1 else -1; Real sy = if y > 0 then 1 else -1;
        equation der(x) = 0.5*sx + 2*sy; der(y) = -2*sx + 0.5*sy; end C;";
    for method in METHODS {
        let run = run(text, method, 1e-6, 1.0);
        assert_eq!(run.cost().slides, 0);
        // The distance |x| + |y| grows on average.
        assert!(run.at("x", 1.0).abs() + run.at("y", 1.0).abs() > 0.1);
    }
}
