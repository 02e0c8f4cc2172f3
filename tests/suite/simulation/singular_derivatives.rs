//! Equations that have values where their symbolic derivatives have none: `sqrt(y)` at 0, and norms
//! at 0, whose derivatives are 0/0. Answers are closed forms.

use crate::support::simulated::{Run, simulated_with};

#[test]
fn a_loop_through_a_square_root_starts_at_zero() {
    let text = "model M Real y, s; equation y + s = time; s = sqrt(y); end M;";
    let run = Run::of(text, 2.0);
    let s = |t: f64| ((1.0 + 4.0 * t).sqrt() - 1.0) / 2.0;
    run.follows("s", 1e-7, s);
    run.follows("y", 1e-7, |t| s(t) * s(t));
}

#[test]
fn a_loop_through_a_norm_starts_at_zero() {
    let text = "model M Real b, c; equation
          b + 0.5*sqrt(b^2 + c^2) = 2*time; c + 0.25*sqrt(b^2 + c^2) = time; end M;";
    // b = 2 c, so that the norm is sqrt(5) c.
    let c = |t: f64| t / (1.0 + 0.25 * 5f64.sqrt());
    let run = Run::of(text, 2.0);
    run.follows("b", 1e-7, |t| 2.0 * c(t));
    run.follows("c", 1e-7, c);
}

#[test]
fn states_move_away_from_where_a_loop_has_no_derivative() {
    // One method that holds y as an unknown, and one that solves the loop in every evaluation.
    let text = "model M Real x(start = 0, fixed = true); Real y, s;
        equation der(x) = 1 + 0*s; y + s = x; s = sqrt(y); end M;";
    for method in ["dassl", "dopri5"] {
        let method = gapilib::internals::sim::find_integrator(method).unwrap();
        let settings =
            gapilib::internals::sim::Settings { method, tolerance: 1e-8, ..Default::default() };
        let run = simulated_with(text, &settings);
        run.follows("x", 1e-7, |t| t);
        run.follows("s", 1e-6, |t| ((1.0 + 4.0 * t).sqrt() - 1.0) / 2.0);
    }
}

#[test]
fn a_domain_error_of_the_residual_is_still_one() {
    let compiled = crate::support::simulated::program(
        "model M Real x(start = 1, fixed = true); Real y; equation der(x) = -1; y = sqrt(x); end M;",
    );
    let settings = gapilib::internals::sim::Settings { stop: 2.0, ..Default::default() };
    let error =
        gapilib::internals::sim::simulate(&mut compiled.system(), &settings).expect_err("sqrt(-1)");
    assert!((error.time - 1.0).abs() < 1e-2, "{}", error.time);
}

/// The acceleration along a path is the derivative of the norm of a velocity, which starts at zero.
#[test]
fn the_derivative_of_a_norm_starts_at_zero() {
    let text = "model M Real u(start = 0, fixed = true), v(start = 0, fixed = true); Real s, d, e;
        equation der(u) = 3; der(v) = 4*cos(time); s = sqrt(u^2 + v*v) + 1e-4; d = der(s);
        e = der(sqrt(4*u^2)); end M;";
    let run = Run::of(text, 2.0);
    run.follows("e", 1e-8, |_| 6.0);
    run.follows("d", 1e-6, |t| {
        let (u, v) = (3.0 * t, 4.0 * t.sin());
        if t == 0.0 { 5.0 } else { (3.0 * u + 4.0 * t.cos() * v) / u.hypot(v) }
    });
}

/// Through zero: the speed of a body thrown upwards.
#[test]
fn the_derivative_of_a_norm_changes_sign_at_zero() {
    let text = "model M Real v(start = 1, fixed = true); Real s, d;
        equation der(v) = -1; s = sqrt(v^2); d = der(s); end M;";
    let run = Run::of(text, 2.0);
    run.follows("s", 1e-8, |t| (1.0 - t).abs());
    run.follows("d", 1e-8, |t| if t < 1.0 { -1.0 } else { 1.0 });
}

/// What is no sum of squares has no derivative at zero.
#[test]
fn the_derivative_of_another_root_at_zero_is_refused() {
    let compiled = crate::support::simulated::program(
        "model M Real u(start = 0, fixed = true), v(start = 0, fixed = true); Real s, d;
         equation der(u) = 2; der(v) = 1; s = sqrt(u^2 - v^2); d = der(s); end M;",
    );
    let settings = gapilib::internals::sim::Settings { stop: 2.0, ..Default::default() };
    gapilib::internals::sim::simulate(&mut compiled.system(), &settings).expect_err("0/0");
}
