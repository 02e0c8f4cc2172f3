//! Variable `delay` and `spatialDistribution` against exact solutions of transport.

use crate::support::simulated::{all_near, attempt, near, refused, simulated};

fn failure(text: &str, stop: f64) -> String {
    let (program, _, _, ended) = attempt(text, stop);
    program.explain(&ended.expect_err("the simulation fails")).message.clone()
}

#[test]
fn a_variable_delay_reads_the_past_forwards_and_backwards() {
    // The delay grows by more than time passes between 1.6 and 2.4: the jump is passed three times.
    let text = "model D Real d = 0.4 + 0.3*sin(5*time); Real y = delay(sin(time), d, 1);
        Real u = if time > 1 then 1 else 0; Real z = delay(u, d, 1); Real area(start = 0, fixed = true);
        Real s(start = 0.2, fixed = true); Real own = delay(time^2, s, 2);
        equation der(area) = z; der(s) = 0.5*cos(time); end D;";
    let run = simulated(text, 3.0);
    let exact = |t: f64| (t - 0.4 - 0.3 * (5.0 * t).sin()).max(0.0).sin();
    for t in [0.12, 0.36, 0.9, 1.68, 2.22, 3.0] {
        near(run.at("y", t), exact(t), 1e-5);
    }
    let s = |t: f64| 0.2 + 0.5 * t.sin();
    near(run.last("own"), (3.0 - s(3.0)).powi(2), 1e-6);
    let arrives = |t: f64| t - 0.4 - 0.3 * (5.0 * t).sin() - 1.0;
    let jumps = run.jumps("z");
    assert!(!jumps.is_empty() && jumps.len() % 2 == 1, "{jumps:?}");
    jumps.iter().for_each(|t| near(arrives(*t), 0.0, 1e-6));
    let mut ends = jumps.clone();
    ends.push(3.0);
    let area: f64 = ends.windows(2).step_by(2).map(|pair| pair[1] - pair[0]).sum();
    near(run.last("area"), area, 1e-5);
}

#[test]
fn a_variable_delay_says_what_it_needs() {
    let refusal = refused("model M Real y = delay(time, 0.5 + time); end M;");
    assert!(refusal.contains("changes during the simulation"), "{refusal}");
    let text = "model L Real y = delay(sin(time), time, 0.5); end L;";
    let fails = failure(text, 1.0);
    assert!(fails.contains("between 0 and the longest delay"), "{fails}");
}

#[test]
fn a_profile_is_transported_at_constant_velocity() {
    let text = "model P Real x(start = 3, fixed = true); Real a; Real b; Real c;
        equation der(x) = 0.5; (a, b) = spatialDistribution(sin(time), 0, x, true, {0, 0.5, 0.5, 1}, {1, 2, 5, 4});
        c = spatialDistribution(0, cos(time), -x, false); end P;";
    let run = simulated(text, 5.0);
    // The content leaves first: from 4 at the end to 5 in the middle, then from 2 to 1.
    near(run.at("b", 0.5), 4.5, 1e-9);
    near(run.at("b", 1.5), 1.5, 1e-9);
    near(run.at("c", 1.0), 0.0, 0.0);
    all_near(&run.jumps("b"), &[1.0, 2.0], 1e-8);
    for t in [2.1, 3.3, 5.0f64] {
        near(run.at("b", t), (t - 2.0).sin(), 1e-5);
        near(run.at("c", t), (t - 2.0).cos(), 1e-5);
        near(run.at("a", t), t.sin(), 1e-4);
    }
}

#[test]
fn a_profile_comes_back_when_the_velocity_reverses() {
    // x = sin(t): what went in at 0 until π/2 comes out there in the opposite order until π, then
    // what went in at 1 between π/2 and π, moved by the whole pipe, follows.
    let text = "model R Real x(start = 0, fixed = true); Real v = cos(time); Real a; Real b;
        equation der(x) = v; (a, b) = spatialDistribution(2 + time, 5 - time, x, v >= 0, {0, 0.5, 0.5, 1}, {1, 1, 3, 3}); end R;";
    let run = simulated(text, 4.5);
    let half = std::f64::consts::FRAC_PI_2;
    near(run.at("b", 0.27), 3.0, 0.0);
    near(run.at("b", 1.17), 1.0, 0.0);
    all_near(&run.jumps("b")[..1], &[0.5f64.asin()], 1e-6);
    for t in [1.71, 2.25, 2.97f64] {
        near(run.at("a", t), 2.0 + (2.0 * half - t), 1e-5);
        near(run.at("b", t), 5.0 - t, 1e-4);
    }
    for t in [3.33, 4.05, 4.5f64] {
        // In at place 1 when x was 1 + sin(t).
        near(run.at("a", t), 5.0 - (2.0 * half - (1.0 + t.sin()).asin()), 1e-5);
    }
}

#[test]
fn the_content_of_a_pipe_is_refused_where_it_has_no_places() {
    for (arguments, reason) in [
        ("1, 0, x, true, {0, 1}, {0, 0, 0}", "2 initial points and 3 initial values"),
        ("1, 0, x, true, {0, 1}, {0, x}", "parameters only"),
    ] {
        let text =
            format!("model M Real x = time; Real y = spatialDistribution({arguments}); end M;");
        let fault = refused(&text);
        assert!(fault.contains(reason), "{fault}");
    }
    let text = "model N parameter Real p = 0.2; Real y = spatialDistribution(1, 0, time, true, {p, 1}, {0, 0}); end N;";
    let fails = failure(text, 1.0);
    assert!(fails.contains("ascend from 0 to 1"), "{fails}");
}
