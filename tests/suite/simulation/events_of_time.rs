//! Relations on time: at the start itself and right after it (MLS §8.5, §8.6), and those that come and
//! go between two output points.

use crate::support::simulated::{near, simulated, simulated_with};
use gapilib::internals::sim::{OutputGrid, Settings};

/// der(x) = (if condition then 3 else 1) - x/2, steady at the start.
fn steady(condition: &str) -> String {
    format!(
        "model M parameter Real t0 = 0; parameter Real five = 5; Real x; \
         initial equation der(x) = 0; \
         equation der(x) = (if {condition} then 3 else 1) - 0.5*x; end M;"
    )
}

fn from(start: f64, stop: f64) -> Settings {
    let output = OutputGrid::Intervals(8);
    Settings { start, stop, tolerance: 1e-9, output, ..Settings::default() }
}

#[test]
fn what_is_later_than_the_start_holds_right_after_it() {
    let conditions = [
        ("time > 0", 0.0),
        ("0 < time", 0.0),
        ("2*time > 0", 0.0),
        ("time - 1 > -1", 0.0),
        ("not (time <= 0)", 0.0),
        ("time > t0", 0.0),
        ("time > five", 5.0),
        ("five + t0 < time", 5.0),
        ("time > -2.5", -2.5),
    ];
    for (condition, start) in conditions {
        let run = simulated_with(&steady(condition), &from(start, start + 8.0));
        near(run.first("x"), 2.0, 1e-9);
        for after in [1.0f64, 4.0, 8.0] {
            let exact = 6.0 - 4.0 * (-0.5 * after).exp();
            near(run.at("x", start + after), exact, 1e-6);
        }
    }
}

#[test]
fn what_is_not_earlier_than_the_start_holds_at_it() {
    for condition in ["time >= 0", "0 <= time", "not (time < 0)"] {
        let run = simulated_with(&steady(condition), &from(0.0, 8.0));
        near(run.first("x"), 6.0, 1e-9);
        near(run.last("x"), 6.0, 1e-9);
        assert!(run.events().is_empty(), "{condition}");
    }
}

#[test]
fn a_when_clause_fires_right_after_the_start() {
    let text = "model M Integer n(start = 0, fixed = true); discrete Real d, t1, e; \
        initial equation d = if time > 0 then 3 else 1; t1 = -1; e = 0; \
        equation when time > 0 then n = pre(n) + 1; t1 = time; end when; \
        when sample(2, 1) then d = pre(d); end when; \
        when n > 0 then e = pre(e) + n; end when; end M;";
    let run = simulated(text, 1.0);
    assert_eq!([run.first("d"), run.last("d")], [1.0, 1.0]);
    assert_eq!([run.first("n"), run.held("n", 0.0), run.last("n")], [0.0, 1.0, 1.0]);
    assert_eq!([run.first("t1"), run.last("t1")], [-1.0, 0.0]);
    assert_eq!(run.last("e"), 1.0);
}

#[test]
fn what_is_rounded_has_its_value_at_the_start() {
    let text = "model M Real up = ceil(time); Real down = floor(-time); Real same = floor(time); \
        Real x; initial equation x = ceil(time) + 10*floor(-time); equation der(x) = 0; end M;";
    let run = simulated(text, 1.5);
    assert_eq!([run.first("up"), run.held("up", 0.0), run.held("up", 1.0)], [0.0, 1.0, 2.0]);
    assert_eq!([run.first("down"), run.held("down", 0.0)], [0.0, -1.0]);
    assert_eq!([run.first("same"), run.held("same", 0.0), run.last("same")], [0.0, 0.0, 1.0]);
    assert_eq!(run.last("x"), 0.0);
}

#[test]
fn the_end_may_follow_the_start_at_once() {
    let text = "model M Real x(start = 1, fixed = true); equation der(x) = 1; \
        when time > 0 then terminate(\"done\"); end when; end M;";
    let run = simulated(text, 1.0);
    assert_eq!([run.last("time"), run.last("x")], [0.0, 1.0]);
}

#[test]
fn a_branch_without_value_at_the_start_begins_after_it() {
    let text = "model M Real z = if time <= 0 then 1 else sin(time)/time; end M;";
    let run = simulated(text, 1.0);
    assert_eq!(run.first("z"), 1.0);
    near(run.last("z"), 1f64.sin(), 1e-12);
}

/// 50 pulses in 1 s that take a part of the period, counted and added up.
fn pulses(wave: &str, intervals: usize) -> [f64; 2] {
    let text = format!(
        "model M constant Real pi = 3.141592653589793; parameter Real f = 50; \
         Real w = 2*pi*f; Real phase = w*time; \
         Real q(start = 0, fixed = true); Integer k(start = 0, fixed = true); \
         Boolean b = {wave}; \
         equation der(q) = if b then 1 else 0; when b then k = pre(k) + 1; end when; end M;"
    );
    let output = OutputGrid::Intervals(intervals);
    let run = simulated_with(&text, &Settings { output, ..Settings::default() });
    [run.last("k"), run.last("q")]
}

#[test]
fn pulses_are_found_whatever_the_output_grid() {
    let part = |level: f64| level.acos() / std::f64::consts::PI;
    let waves = [
        ("sin(2*pi*50*time) > 0.99", part(0.99)),
        ("cos(phase + 1) < -0.999", part(0.999)),
        ("0.5*sin(phase) + 0.25 > 0.7495", part(0.999)),
        ("sin(2*pi*f*time)^2 > 0.5 and sin(phase) > 0", 0.25),
    ];
    for (wave, share) in waves {
        for intervals in [1, 4, 500] {
            let [k, q] = pulses(wave, intervals);
            assert_eq!(k, 50.0, "{wave}, {intervals} intervals");
            near(q, share, 1e-4);
        }
    }
}

#[test]
fn a_short_pulse_is_found_without_output_points_in_it() {
    for condition in [
        "1 - ((time - 3.3)/0.02)^2 > 0",
        "abs(time - at) < 0.02",
        "0.02 >= abs(at - time)",
        "not abs(time - 3.3) > 0.02",
        "max(time - 3.32, 3.28 - time) <= 0",
        "min(time - 3.28, 3.32 - time) > 0",
        "abs(sin(time/9) - sin(3.3/9)) < 0.0020741",
    ] {
        let text = format!(
            "model M Integer k(start = 0, fixed = true); Real q(start = 0, fixed = true); \
             parameter Real at = 3.3; Boolean b = {condition}; \
             equation der(q) = if b then 1 else 0; when b then k = pre(k) + 1; end when; end M;"
        );
        for intervals in [2, 500] {
            let output = OutputGrid::Intervals(intervals);
            let run = simulated_with(&text, &Settings { stop: 8.0, output, ..Settings::default() });
            assert_eq!(run.last("k"), 1.0, "{condition}, {intervals} intervals");
            near(run.last("q"), 0.04, 1e-4);
        }
    }
}
