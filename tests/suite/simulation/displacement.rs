//! Events during a slide or a rest that displace the states, the surface, or the fields.

use super::chattering::{METHODS, run};
use crate::support::simulated::near;
use gapilib::internals::sim::Treatment;

const TOLERANCES: [f64; 3] = [1e-4, 1e-6, 1e-8];

/// Simulates for 10 s with every method and compares with values at times.
fn check(text: &str, expected: &[(&str, f64, f64)]) {
    for method in METHODS {
        for tolerance in TOLERANCES {
            let run = run(text, method, tolerance, 10.0);
            let cost = run.cost();
            for (name, time, value) in expected {
                let (found, accuracy) = (run.at(name, *time), 100.0 * tolerance);
                let is_near = (found - value).abs() <= accuracy * value.abs().max(1.0);
                assert!(is_near, "{method}, {tolerance}: {name}({time}) = {found}, not {value}");
            }
            assert!(cost.state_events < 300, "{method}, {tolerance}: {cost:?}");
        }
    }
}

#[test]
fn a_slide_ends_where_the_state_is_set() {
    let model = |value: f64, event: &str| {
        format!(
            "model D Real x(start = 1, fixed = true); Real y(start = 0, fixed = true);
            equation der(y) = 1; der(x) = if x > 0 then -1 else 1;
            when {event} then reinit(x, {value}); end when; end D;"
        )
    };
    for event in ["time >= 3", "y > 3"] {
        for value in [1.0, -1.0] {
            let text = model(value, event);
            check(&text, &[("x", 2.9, 0.0), ("x", 3.5, 0.5 * value), ("x", 10.0, 0.0)]);
        }
    }
    let again = model(1.0, "sample(2, 2)");
    check(&again, &[("x", 2.5, 0.5), ("x", 4.5, 0.5), ("x", 8.5, 0.5), ("x", 9.9, 0.0)]);
}

#[test]
fn a_slide_ends_where_its_surface_jumps() {
    let by_when =
        "model D Real x(start = 1, fixed = true); discrete Real u(start = 0, fixed = true);
        equation der(x) = if x > u then -1 else 1; when time >= 3 then u = 1; end when; end D;";
    let by_if = "model D Real x(start = 1, fixed = true); Real u = if time > 3 then 1 else 0;
        equation der(x) = if x > u then -1 else 1; end D;";
    for text in [by_when, by_if] {
        check(text, &[("x", 2.9, 0.0), ("x", 3.5, 0.5), ("x", 10.0, 1.0)]);
    }
}

#[test]
fn a_thermostat_follows_its_set_point() {
    let by_if = "model T Real T(start = 15, fixed = true); Real Ts = if time < 5 then 20 else 25;
        Real Q = if T < Ts then 50 else 0; equation 10*der(T) = (10 - T) + Q; end T;";
    let by_when = "model T Real T(start = 15, fixed = true);
        discrete Real Ts(start = 20, fixed = true); Boolean heat = T < Ts;
        Real Q = if heat then 50 else 0; equation 10*der(T) = (10 - T) + Q;
        when time >= 5 then Ts = 25; end when; end T;";
    // T = 60 - 40 exp(-(t - 5)/10) from 5 on until it is 25.
    let heated = 60.0 - 40.0 * (-0.1f64).exp();
    for text in [by_if, by_when] {
        for method in METHODS {
            for tolerance in TOLERANCES {
                let run = run(text, method, tolerance, 10.0);
                near(run.at("T", 4.9), 20.0, 2e3 * tolerance);
                near(run.at("T", 6.0), heated, 2e3 * tolerance);
                near(run.at("T", 10.0), 25.0, 2e3 * tolerance);
            }
        }
    }
}

#[test]
fn dry_friction_slips_after_an_impulse() {
    let text = "model F Real v(start = 2, fixed = true);
        equation der(v) = -(if v > 0 then 1 elseif v < 0 then -1 else 0);
        when time >= 5 then reinit(v, pre(v) + 3); end when; end F;";
    check(text, &[("v", 4.9, 0.0), ("v", 5.2, 2.8), ("v", 10.0, 0.0)]);
}

#[test]
fn a_slide_goes_on_where_only_the_fields_jump() {
    // The share of the upper field is 1/2, and 3/4 from t = 5 on.
    let text = "model F Real x(start = 1, fixed = true); Real z(start = 0, fixed = true);
        Real f = if time < 5 then 1 else 3;
        equation der(x) = if x > 0 then -1 else f; der(z) = if x > 0 then 1 else 0; end F;";
    for method in METHODS {
        for tolerance in TOLERANCES {
            let run = run(text, method, tolerance, 10.0);
            near(run.at("z", 10.0), 1.0 + 4.0 / 2.0 + 5.0 * 0.75, 100.0 * tolerance);
            assert_eq!(run.cost().state_events, 4, "{method}, {tolerance}");
        }
    }
}

/// A ball with the coefficient of restitution 1/2, which rests from 1.36 s on.
fn ball(more: &str) -> String {
    format!(
        "model B Real h(start = 1, fixed = true); Real v(start = 0, fixed = true);
        discrete Real f(start = 0, fixed = true); Integer n(start = 0, fixed = true);
        equation der(h) = v; der(v) = -9.81;
        when h < f then reinit(v, -0.5*pre(v)); n = pre(n) + 1; end when;
        {more} end B;"
    )
}

/// The height of a ball that is dropped.
fn fallen(duration: f64) -> f64 {
    -9.81 / 2.0 * duration * duration
}

#[test]
fn a_ball_at_rest_falls_where_it_is_lifted_or_its_floor_drops() {
    let lifted = ball("when time >= 5 then reinit(h, 1); end when; f = 0;");
    check(&lifted, &[("h", 4.9, 0.0), ("h", 5.2, 1.0 + fallen(0.2)), ("h", 10.0, 0.0)]);
    let dropped = ball("when time >= 5 then f = -1; end when;");
    check(&dropped, &[("h", 4.9, 0.0), ("h", 5.2, fallen(0.2)), ("h", 10.0, -1.0)]);
}

#[test]
fn a_ball_at_rest_is_kicked_and_rests_again() {
    // Down again 2 s later, with half the speed.
    let up = ball("when time >= 5 then reinit(v, 9.81); end when; f = 0;");
    let second = |t: f64| 4.905 * t + fallen(t);
    check(&up, &[("h", 6.0, 4.905), ("h", 7.5, second(0.5)), ("h", 10.0, 0.0), ("v", 10.0, 0.0)]);
    let often = ball("when sample(5, 3) then reinit(v, 4.905); end when; f = 0;");
    check(&often, &[("h", 5.5, second(0.5)), ("h", 7.9, 0.0), ("h", 8.5, second(0.5))]);
    // Against the floor: an impact.
    let down = ball("when time >= 5 then reinit(v, -9.81); end when; f = 0;");
    check(&down, &[("h", 5.5, second(0.5)), ("h", 10.0, 0.0)]);
    let elsewhen = "model B Real h(start = 1, fixed = true); Real v(start = 0, fixed = true);
        equation der(h) = v; der(v) = -9.81; when h < 0 then reinit(v, -0.5*pre(v));
        elsewhen time >= 5 then reinit(v, 9.81); end when; end B;";
    check(elsewhen, &[("h", 6.0, 4.905), ("h", 7.5, second(0.5)), ("h", 10.0, 0.0)]);
}

#[test]
fn events_elsewhere_do_not_count_as_impacts() {
    let samples = "Integer k(start = 0, fixed = true); equation
        when sample(2, 0.01) then k = pre(k) + 1; end when;";
    let text = ball("f = 0;").replace("equation", samples);
    for method in METHODS {
        let run = run(&text, method, 1e-6, 10.0);
        run.cost();
        let impacts = run.at("n", 1.9);
        near(run.at("n", 10.0), impacts, 0.0);
        near(run.at("k", 10.0), 801.0, 0.0);
        near(run.at("h", 10.0), 0.0, 1e-6);
    }
}

#[test]
fn a_ball_rests_on_a_ball_that_rests() {
    let model = |h2: f64, kick: &str| {
        format!(
            "model S Real h1(start = 0.1, fixed = true); Real v1(start = 0, fixed = true);
            Real h2(start = {h2}, fixed = true); Real v2(start = 0, fixed = true);
            equation der(h1) = v1; der(v1) = -9.81; der(h2) = v2; der(v2) = -9.81;
            when h1 < 0 then reinit(v1, -0.5*pre(v1)); end when;
            when h2 - h1 < 0.5 then reinit(v2, {kick}); end when; end S;"
        )
    };
    for (h2, kick) in [(20.0, "-0.5*pre(v2)"), (2.0, "pre(v1) - 0.5*(pre(v2) - pre(v1))")] {
        let text = model(h2, kick);
        check(&text, &[("h1", 10.0, 0.0), ("h2", 10.0, 0.5), ("v2", 10.0, 0.0)]);
        let run = run(&text, "dassl", 1e-6, 10.0);
        assert_eq!(run.cost().accumulations, 2);
        assert!(run.treatments().contains(&Treatment::Rests));
    }
}

#[test]
fn a_ball_is_noticed_below_its_floor_however_long_the_step() {
    // Thrown up at t = 9 with 10 m/s against a gravity of about 7160 m/s2: a flight of 2.8 ms.
    let text = "model B Real h(start = 1, fixed = true); Real v(start = 0, fixed = true);
        equation der(h) = v; der(v) = -9.81*(1 + time^3);
        when h < 0 then reinit(v, -0.5*pre(v)); end when;
        when time >= 9 then reinit(v, 10); end when; end B;";
    for method in METHODS {
        for tolerance in [1e-4, 1e-6] {
            let run = run(text, method, tolerance, 10.0);
            run.cost();
            near(run.at("h", 8.9), 0.0, 10.0 * tolerance);
            near(run.at("h", 10.0), 0.0, 10.0 * tolerance);
        }
    }
}

#[test]
fn a_ball_rests_on_a_plate_that_shakes() {
    let text = "model P Real h(start = 1, fixed = true); Real v(start = 0, fixed = true);
        Real hp = 0.01*sin(5*time); Real vp = 0.05*cos(5*time);
        equation der(h) = v; der(v) = -9.81;
        when h < hp then reinit(v, vp - 0.5*(pre(v) - vp)); end when; end P;";
    for method in METHODS {
        for tolerance in [1e-4, 1e-6] {
            let run = run(text, method, tolerance, 10.0);
            let cost = run.cost();
            near(run.at("h", 10.0), 0.01 * 50f64.sin(), 10.0 * tolerance);
            assert!(cost.steps < 2000, "{method}, {tolerance}: {cost:?}");
        }
    }
}

#[test]
fn a_ball_follows_a_floor_that_sinks_in_small_steps() {
    for (tolerance, step) in [(1e-4, 1e-5), (1e-6, 1e-7)] {
        let down = format!("when sample(5, 0.01) then f = pre(f) - {step}; end when;");
        for method in METHODS {
            let run = run(&ball(&down), method, tolerance, 10.0);
            let cost = run.cost();
            near(run.at("h", 9.995), -500.0 * step, 2.0 * tolerance);
            assert!(cost.steps + cost.error_failures < 2000, "{method}, {tolerance}: {cost:?}");
        }
    }
}
