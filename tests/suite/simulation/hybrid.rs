//! Models with events, from text to trajectory, against exact solutions.

use crate::support::simulated::{all_near, attempt, compiled, file, near, refused, simulated};
use gapilib::internals::sim::{Events, OutputGrid, Settings, Simulator, Trajectory};

#[test]
fn a_ball_bounces_twenty_times_at_the_exact_times() {
    let run = simulated(&file("BouncingBall"), 4.02);
    let (e, g) = (0.8f64, 9.81f64);
    let first = (2.0 / g).sqrt();
    let mut expected = vec![first];
    for n in 0..25 {
        expected.push(expected[n] + 2.0 * first * e.powi(n as i32 + 1));
    }
    expected.retain(|t| *t < 4.02);
    assert!(expected.len() >= 20, "{}", expected.len());
    all_near(&run.jumps("impacts"), &expected, 1e-7);
    assert_eq!(run.last("impacts"), expected.len() as f64);
    near(run.last("last"), *expected.last().unwrap(), 1e-7);
}

#[test]
fn a_sampled_controller_follows_its_difference_equation() {
    let run = simulated(&file("SampledController"), 2.0);
    let (k, decay) = (2.0, (-0.1f64).exp());
    let mut x = 1.0;
    for n in 0..20 {
        let t = n as f64 * 0.1;
        near(run.at("x", t), x, 1e-7);
        near(run.at("u", t), -k * x, 1e-7);
        x = x * decay - k * x * (1.0 - decay);
    }
    assert_eq!(run.last("n"), 21.0);
    let times: Vec<f64> = (1..=20).map(|n| n as f64 * 0.1).collect();
    assert_eq!(run.jumps("n"), times);
}

/// `time >= pre(next)` is a time event where what it is compared with changes at events only.
#[test]
fn what_events_schedule_happens_at_the_exact_times() {
    let text = "model Scheduled Real x(start = 0, fixed = true);
        discrete Real next(start = 0.1, fixed = true); Integer n(start = 0, fixed = true);
        discrete Real at(start = 0, fixed = true); Boolean late;
        equation der(x) = cos(20*time); late = time > next - 0.01;
          when time >= pre(next) then
            n = pre(n) + 1; at = time; next = pre(next) + 0.1 + 0.01*n;
          end when;
        end Scheduled;";
    let run = simulated(text, 2.0);
    let (mut next, mut times) = (0.1, Vec::new());
    while next < 2.0 {
        times.push(next);
        next = next + 0.1 + 0.01 * times.len() as f64;
    }
    assert_eq!(run.jumps("n"), times);
    assert_eq!(run.last("at"), *times.last().unwrap());
    assert_eq!(run.system.n_crossings(), 0);
    let began: Vec<f64> = times.iter().map(|time| time - 0.01).collect();
    all_near(&run.jumps("late").into_iter().step_by(2).collect::<Vec<_>>()[..], &began, 1e-15);
}

#[test]
fn an_algorithm_counts_at_samples() {
    let run = simulated(&file("Counter"), 2.0);
    let mut total = 0.0;
    for k in 1..=7 {
        let n = f64::from(k % 4);
        total += 6.0 * n;
        let t = 0.25 * f64::from(k);
        near(run.at("n", t), n, 0.0);
        near(run.at("total", t), total, 0.0);
        near(run.at("odd", t), f64::from(k % 2), 0.0);
    }
    near(run.at("n", 1.92), 100.0, 0.0);
    near(run.last("n"), 101.0, 0.0);
}

#[test]
fn a_two_point_controller_switches_at_the_exact_times() {
    let run = simulated(&file("Hysteresis"), 2.0);
    let first = (12.0f64 / 8.0).ln();
    let (fall, rise) = ((12.0f64 / 10.0).ln(), (10.0f64 / 8.0).ln());
    let mut expected = vec![first];
    while expected[expected.len() - 1] < 2.0 {
        let step = if expected.len() % 2 == 1 { fall } else { rise };
        expected.push(expected[expected.len() - 1] + step);
    }
    expected.pop();
    assert!(expected.len() > 6);
    all_near(&run.jumps("on"), &expected, 1e-7);
}

#[test]
fn a_block_sticks_and_slips() {
    let run = simulated(&file("StickSlip"), 12.0);
    // It breaks away at t = 2 and slides with v = 1 - cos τ + sin τ until v = 0 at τ = 3π/2; then
    // the force is 1 - (1 - 2)= 0, and 2 more seconds pass.
    let slide = 1.5 * std::f64::consts::PI;
    all_near(&run.jumps("sliding"), &[2.0, 2.0 + slide, 4.0 + slide], 1e-7);
    let v = |tau: f64| 1.0 - tau.cos() + tau.sin();
    near(run.at("v", 4.8), v(2.8), 1e-6);
    near(run.at("v", 7.2), 0.0, 1e-12);
}

/// The comparator leaves its limits at x = ±(1/2 - 1/a), where its equations have no solution left
/// but that at the other limit.
#[test]
fn a_comparator_with_positive_feedback_jumps() {
    let events = file("Multivibrator");
    let without = events.replace("hasEvents = true", "hasEvents = false");
    let edge: f64 = 0.49;
    let (first, half) = (-(1.0 - edge).ln(), ((1.0 + edge) / (1.0 - edge)).ln());
    for text in [events, without] {
        let run = simulated(&text, 5.0);
        let (mut t, mut y, mut x) = (first, 1.0, edge);
        while t + half < 5.0 {
            (t, y, x) = (t + half, -y, -x);
        }
        let last = -y + (x + y) * (t - 5.0).exp();
        near(run.last("x"), last, 1e-6);
        near(run.last("y"), -y, 1e-9);
    }
}

/// What starts at zero and grows steadily changes its sign, although errors of the tolerance's size would
/// make it larger: der(H) > 0 of a magnetic core, whose H follows from a flux of 1e-4 Wb.
#[test]
fn what_grows_from_zero_is_no_error_however_sensitive_it_is() {
    let text = "model M Real x(start = 0, fixed = true); Real s(start = 0, fixed = true); \
                Real y(start = 0, fixed = true); Boolean on; equation der(x) = 1e-14*(1 + time); \
                der(s) = cos(20*time); on = 1e17*x > 0; der(y) = if on then 1 else 0; end M;";
    let run = simulated(text, 1.0);
    near(run.last("on"), 1.0, 0.0);
    assert!(run.last("y") > 0.95, "{}", run.last("y"));
}

#[test]
fn what_breaks_away_is_kept_by_what_it_was_before() {
    let run = simulated(&file("Breakaway"), 3.0);
    all_near(&run.jumps("sliding"), &[2.0], 1e-7);
    near(run.last("force"), 2.0, 1e-9);
}

#[test]
fn a_network_of_gates_and_flip_flops_runs_in_step() {
    let run = simulated(&file("Logic"), 7.0);
    let mut q = [false; 3];
    for step in 1..=7 {
        q = [!q[2], q[0], q[1]];
        let t = f64::from(step);
        let count = q.iter().filter(|on| **on).count();
        for (at, on) in q.iter().enumerate() {
            near(run.at(&format!("q[{}]", at + 1), t), f64::from(u8::from(*on)), 0.0);
        }
        near(run.at("sum", t), f64::from(u8::from(count % 2 == 1)), 0.0);
        near(run.at("carry", t), f64::from(u8::from(count >= 2)), 0.0);
    }
}

#[test]
fn the_first_active_branch_of_a_when_clause_acts() {
    let run = simulated(&file("Priority"), 4.0);
    near(run.at("which", 0.96), 0.0, 0.0);
    near(run.at("which", 1.0), 1.0, 0.0);
    near(run.at("which", 2.0), 2.0, 0.0);
    near(run.at("which", 3.0), 3.0, 0.0);
    near(run.at("first", 0.0), 1.0, 0.0);
    near(run.last("first"), 2.0, 0.0);
}

#[test]
fn an_integer_of_a_record_may_change_between_events() {
    let run = simulated(&file("Phase"), 1.0);
    for k in 0..50 {
        let t = 0.02 * f64::from(k);
        let phase = |h: f64| if h > 0.51 { 2.0 } else { 1.0 };
        near(run.at("bound.phase", t), phase(t), 0.0);
        near(run.at("equal.phase", t), phase(2.0 * t), 0.0);
        near(run.at("passed[1].phase", t), phase(2.0 * t), 0.0);
        near(run.at("passed[2].phase", t), phase(t), 0.0);
        near(run.at("density", t), if t > 0.51 { 10.0 } else { 1000.0 }, 0.0);
    }
}

#[test]
fn functions_that_jump_cause_events() {
    let run = simulated(&file("Rounding"), 2.0);
    for k in 1..50 {
        let t = 0.04 * f64::from(k);
        let x = 3.0 * t.sin();
        near(run.at("down", t), x.floor(), 0.0);
        near(run.at("up", t), x.ceil(), 0.0);
        near(run.at("quotient", t), (x / 2.0).trunc(), 0.0);
        if k % 25 != 0 {
            near(run.at("whole", t), (2.0 * t).floor(), 0.0);
            near(run.at("saw", t), t - (t / 0.5).floor() * 0.5, 1e-9);
        }
        if k % 15 != 0 {
            near(run.at("back", t), -(t - (t / 0.3).floor() * 0.3), 1e-9);
        }
    }
    assert_eq!(run.jumps("whole"), [0.5, 1.0, 1.5, 2.0]);
    near(run.last("area"), 0.5, 1e-7);
    all_near(&run.jumps("down")[..2], &[(1.0f64 / 3.0).asin(), (2.0f64 / 3.0).asin()], 1e-8);
}

#[test]
fn an_if_equation_switches_at_its_conditions() {
    let run = simulated(&file("Switch"), 3.0);
    let half = 1.0 + 2.0f64.ln();
    near(run.at("x", 0.6), 0.6, 1e-9);
    near(run.at("y", 0.6), 0.6, 1e-9);
    near(run.at("x", 1.5), (-0.5f64).exp(), 1e-7);
    near(run.at("y", 1.5), 2.0 * (-0.5f64).exp(), 1e-7);
    near(run.last("x"), 0.5, 1e-7);
    near(run.last("y"), -0.5, 1e-7);
    all_near(&run.jumps("y"), &[1.0, half], 1e-7);
}

#[test]
fn logic_without_a_stable_state_is_reported() {
    let text = "model O Boolean a(start = false); Boolean b = time > 0.5;
        equation a = b and not pre(a); end O;";
    let (program, _, _, ended) = attempt(text, 1.0);
    let error = ended.expect_err("it does not settle");
    near(error.time, 0.5, 1e-9);
    let diagnostic = program.explain(&error);
    assert!(diagnostic.message.contains("`a`"), "{}", diagnostic.message);
}

/// IMC_InverterDrive: rounding errors of a current that is zero contradict a diode that conducts and
/// one that does not.
#[test]
fn relations_that_rounding_errors_contradict_settle() {
    let diode = |error: &str| {
        let text = format!(
            "model D parameter Real e = {error}; Boolean off(start = true); Real s; Real x;
               Boolean large = 230*time > 100;
             equation off = s < 0; s = x + (if off then e else -e); x = max(time - 0.5, 0);
             end D;"
        );
        attempt(&text, 1.0).3
    };
    assert!(diode("2e-13").is_ok());
    let error = diode("2e-9").expect_err("it does not settle");
    near(error.time, 0.0, 1e-9);
}

#[test]
fn a_latch_of_two_gates_keeps_its_state() {
    let text = "model L Boolean s = time > 1 and time < 1.5; Boolean r = time > 2 and time < 2.5;
        Boolean q(start = false); Boolean n(start = true);
        equation q = not (r or n); n = not (s or q); end L;";
    let run = simulated(text, 3.0);
    for (t, q) in [(0.6, 0.0), (1.2, 1.0), (1.8, 1.0), (2.1, 0.0), (3.0, 0.0)] {
        near(run.at("q", t), q, 0.0);
        near(run.at("n", t), 1.0 - q, 0.0);
    }
}

#[test]
fn a_discrete_value_and_a_continuous_one_are_solved_together() {
    // y = 2u + x and u = 1 - y at samples: u = (1 - x)/3.
    let text = "model C Real x = time; Real y; discrete Real u(start = 0);
        equation y = 2*u + x; when sample(0, 0.5) then u = 1 - y; end when; end C;";
    let run = simulated(text, 1.2);
    near(run.at("u", 0.5), 0.5 / 3.0, 1e-12);
    near(run.at("y", 0.6), 1.0 / 3.0 + 0.6, 1e-12);
    near(run.last("u"), 0.0, 1e-12);
}

#[test]
fn terminate_ends_and_terminal_acts_at_the_end() {
    let text = "model T Real x(start = 0, fixed = true); Integer n(start = 0); Boolean done(start = false);
        equation der(x) = 1; when x > 0.7 then terminate(\"enough\"); end when;
        when terminal() then n = 5; done = true; end when; end T;";
    let run = simulated(text, 2.0);
    near(run.last("time"), 0.7, 1e-9);
    assert_eq!(run.last("n"), 5.0);
    assert_eq!(run.last("done"), 1.0);
}

#[test]
fn what_depends_on_the_end_changes_at_the_end() {
    let text = "model T Real a(start = 0.1); Real b = if terminal() then 2*time else 0;
        algorithm if terminal() then a := 1; end if; end T;";
    let run = simulated(text, 1.0);
    near(run.at("a", 0.5), 0.1, 0.0);
    near(run.at("b", 0.5), 0.0, 0.0);
    near(run.last("a"), 1.0, 0.0);
    near(run.last("b"), 2.0, 0.0);
}

#[test]
fn an_assertion_at_an_event_holds_at_that_event_only() {
    let text = |limit: f64| {
        format!(
            "model A Real x(start = 0, fixed = true); equation der(x) = 1;
             when sample(1, 1) then assert(x < {limit}, \"too large\"); end when; end A;"
        )
    };
    simulated(&text(2.5), 2.9);
    let (program, _, _, ended) = attempt(&text(1.5), 2.9);
    let error = ended.expect_err("x is 2 at the second sample");
    near(error.time, 2.0, 1e-12);
    assert_eq!(program.explain(&error).code.slug, "assertion-failed");
}

/// What lowering tries and gives up does not take an assertion out of its branch.
#[test]
fn an_assertion_in_a_branch_holds_there_only() {
    let run = simulated(&file("Guarded"), 3.0);
    assert_eq!(run.at("y", 1.5), 0.0);
    near(run.last("y"), 3.0_f64.sqrt() + 3.0, 1e-7);
}

#[test]
fn a_sample_next_to_an_output_point_is_not_lost() {
    // 12·0.05 and 15·0.04 differ by rounding.
    let run = simulated(
        "model S Integer n(start = 0, fixed = true); \
         equation when sample(0, 0.05) then n = pre(n) + 1; end when; end S;",
        2.0,
    );
    assert_eq!(run.last("n"), 41.0);
}

#[test]
fn semi_linear_takes_arrays() {
    let text = "model S Real m = time - 1; Real y[2] = semiLinear(m, {2, 3}, {4, 5}); end S;";
    let run = simulated(text, 3.0);
    assert_eq!([run.last("y[1]"), run.last("y[2]")], [4.0, 6.0]);
    let before = simulated(text, 0.5);
    assert_eq!([before.last("y[1]"), before.last("y[2]")], [-2.0, -2.5]);
}

#[test]
fn samples_do_not_drift() {
    let text = "model S Integer n(start = 0); discrete Real t(start = 0); Integer both(start = 0);
        equation when sample(0, 0.1) then n = pre(n) + 1; t = time; end when;
        when sample(0, 0.1) and sample(0, 0.3) then both = pre(both) + 1; end when; end S;";
    let run = simulated(text, 1000.0);
    assert_eq!(run.last("n"), 10_001.0);
    assert_eq!(run.last("both"), 3_334.0);
    let times: Vec<f64> = (1..=10_000).map(|i| f64::from(i) * 0.1).collect();
    all_near(&run.jumps("n"), &times, 1e-12);
}

#[test]
fn enumerations_step_through_states() {
    let text = "model E type Light = enumeration(red, green, yellow); Light light(start = Light.red, fixed = true);
        Integer k; equation when sample(1, 1) then
        if pre(light) == Light.red then light = Light.green; elseif pre(light) == Light.green then
        light = Light.yellow; else light = Light.red; end if;
        end when; k = if light == Light.yellow then 10 else Integer(light); end E;";
    let run = simulated(text, 4.5);
    for (t, light, k) in
        [(0.9, 1.0, 1.0), (1.0, 2.0, 2.0), (2.0, 3.0, 10.0), (3.0, 1.0, 1.0), (4.0, 2.0, 2.0)]
    {
        near(run.at("light", t), light, 0.0);
        near(run.at("k", t), k, 0.0);
    }
}

#[test]
fn initial_values_of_discrete_variables_follow_initial_equations() {
    let text = "model I Integer a(start = 3); Integer b(start = 4, fixed = true); Real x; discrete Real d;
        initial equation pre(a) = 7; der(x) = 0; d = 2;
        equation der(x) = 1 - x/d; when time > 1 then a = pre(a) + b; b = pre(b) + 1; d = 4; end when; end I;";
    let run = simulated(text, 2.0);
    assert_eq!((run.at("a", 0.0), run.at("b", 0.0), run.at("d", 0.0)), (7.0, 4.0, 2.0));
    near(run.at("x", 0.0), 2.0, 1e-12);
    assert_eq!((run.last("a"), run.last("b")), (12.0, 5.0));
    near(run.last("x"), 4.0 - 2.0 * (-0.25f64).exp(), 1e-7);
}

#[test]
fn change_and_edge_see_both_directions() {
    let text = "model D Boolean b = sin(6*time) > 0; Integer up(start = 0); Integer any(start = 0);
        equation when edge(b) then up = pre(up) + 1; end when;
        when change(b) then any = pre(any) + 1; end when; end D;";
    let run = simulated(text, 3.0);
    assert_eq!(run.last("up"), 3.0);
    assert_eq!(run.last("any"), 6.0);
}

#[test]
fn parameters_that_are_not_fixed_follow_from_the_initial_equations() {
    let text = "model P parameter Real k(fixed = false, start = 1); parameter Real twice = 2*k; parameter Real x0 = 3;
        Real x(start = 1); initial equation x = x0; der(x) = -6; equation der(x) = -k*x; end P;";
    let run = simulated(text, 1.0);
    near(run.last("k"), 2.0, 1e-12);
    near(run.last("twice"), 4.0, 1e-12);
    near(run.last("x"), 3.0 * (-2.0f64).exp(), 1e-7);
}

#[test]
fn initial_algorithms_set_parameters_and_states() {
    let text =
        "model A final parameter Integer n = 4; parameter Real s(fixed = false); Real x(start = 9);
        initial algorithm s := 0; for i in 1:n loop s := s + i; end for; x := 2*s;
        equation der(x) = s; end A;";
    let run = simulated(text, 1.0);
    near(run.last("s"), 10.0, 1e-12);
    near(run.at("x", 0.0), 20.0, 1e-12);
    near(run.last("x"), 30.0, 1e-7);
}

#[test]
fn an_initial_system_that_does_not_fit_is_reported_by_name() {
    let (program, _, _, ended) = attempt(
        "model M Real x(start = 1, fixed = true); initial equation x = 2; equation der(x) = 1; end M;",
        1.0,
    );
    let many = program.explain(&ended.expect_err("x cannot be both"));
    assert_eq!(many.code.slug, "initialization-failed");
    assert!(many.message.contains("inconsistent"), "{}", many.message);
    let few = refused(
        "model M parameter Real p(fixed = false); Real x(start = 1, fixed = true); equation der(x) = p; end M;",
    );
    assert!(few.contains("add an equation that determines") && few.contains("`p`"), "{few}");
}

#[test]
fn what_hybrid_models_may_not_do_is_refused_with_a_reason() {
    for (body, reason) in [
        ("Boolean b = noEvent(x > 1);", "can change between events: it follows from `x`"),
        (
            "Integer n; equation n = 1.5;",
            "`n` is an Integer, but the value of its equation is a Real",
        ),
        (
            "Integer n; equation 2*time = n;",
            "`n` is an Integer, but the value of its equation is a",
        ),
        ("Integer n; equation n = x + time;", "does not determine the Integer `n`: round it"),
        ("Integer n; Real y; equation y = n; x = y;", "write an equation `n = …` for it"),
        (
            "Integer k; Real y; algorithm k := 0; y := x;
             while y > 0.25 loop k := k + 1; y := y - 0.25; end while;",
            "can change between events: it follows from `x`; how often this loop runs",
        ),
        (
            "discrete Real d; Real free; equation when x > 1 then d = 1; end when; when x > 2 then d = 2; end when;",
            "assigned by two when-clauses",
        ),
        (
            "Integer n; equation when x > 1 then when x > 2 then n = 1; end when; end when;",
            "nested",
        ),
        ("Boolean a; Boolean b; equation a = not b; b and a = true;", "discrete"),
        ("Real y; equation y = x; when x > 1 then reinit(2*y, 1); end when;", "not a state"),
        ("Integer n = integer(x); Real y = pre(n) + pre(2*n);", "not a variable"),
        ("Real y = pre(x);", "in when-clauses only"),
        ("Boolean s = sample(x, 1);", "parameters"),
    ] {
        let text = format!("model M Real x = time; {body} end M;");
        let fault = refused(&text);
        assert!(fault.contains(reason), "{body}: {fault}");
    }
}

#[test]
fn reinit_of_a_discrete_variable_assigns_it() {
    let text = "model R discrete Real d(start = 0, fixed = true); equation
        when time >= 1 then d = 5; end when;
        when time >= 2 then reinit(d, pre(d) + 2); end when; end R;";
    let run = simulated(text, 3.0);
    for (t, value) in [(0.5, 0.0), (1.5, 5.0), (2.5, 7.0)] {
        near(run.held("d", t), value, 0.0);
    }
}

#[test]
fn a_delayed_equation_follows_its_pieces() {
    // x' = -x(t - 1), x = 1 before the start: x = 1 - t, then 1 - t + (t - 1)²/2, …
    let text = "model D Real x(start = 1, fixed = true); equation der(x) = -delay(x, 1); end D;";
    let run = simulated(text, 3.0);
    near(run.at("x", 0.6), 0.4, 1e-7);
    near(run.at("x", 1.8), 1.0 - 1.8 + 0.32, 1e-6);
    let t = 3.0f64;
    let exact = 1.0 - t + (t - 1.0).powi(2) / 2.0 - (t - 2.0).powi(3) / 6.0;
    near(run.last("x"), exact, 1e-6);
}

#[test]
fn a_delay_of_zero_is_a_connection() {
    let text = |d: f64| {
        format!(
            "model Z parameter Real d = {d}; parameter Real e = 2*d; Real u = sin(time);
        Real x; equation x + 0.5*delay(x, e) = u; end Z;"
        )
    };
    let run = simulated(&text(0.0), 2.0);
    near(run.last("x"), 2f64.sin() / 1.5, 1e-12);
    let run = simulated(&text(2.0), 2.0);
    near(run.last("x"), 2f64.sin(), 1e-12);
    let negative = attempt(&text(-1.0), 1.0).3.expect_err("a negative delay");
    let program = compiled(&text(-1.0)).expect("a model");
    assert!(program.explain(&negative).message.contains("must be positive"));
}

#[test]
fn when_statements_in_a_loop_are_one_for_each_value() {
    let text = "model W Real sum(start = 0, fixed = true); Real at[3](each start = 0, each fixed = true);
        algorithm for i in 1:3 loop when time > 0.2*i then sum := pre(sum) + i; at[i] := time; end when;
        end for; end W;";
    let run = simulated(text, 1.0);
    near(run.last("sum"), 6.0, 0.0);
    for (name, time) in [("at[1]", 0.2), ("at[2]", 0.4), ("at[3]", 0.6)] {
        near(run.last(name), time, 1e-9);
    }
}

#[test]
fn delayed_jumps_arrive_at_the_exact_time() {
    let text = "model J parameter Real d = 0.35; Real u = if time > 0.5 then 2 + sin(time) else 0; Real y = delay(u, d);
        Real area(start = 0, fixed = true); Boolean late = y > 1; Real twice = delay(y, 0.4, 1);
        equation der(area) = y; end J;";
    let run = simulated(text, 2.0);
    all_near(&run.jumps("y"), &[0.85], 1e-12);
    all_near(&run.jumps("late"), &[0.85], 1e-12);
    all_near(&run.jumps("twice"), &[1.25], 1e-12);
    near(run.at("y", 1.0), 2.0 + 0.65f64.sin(), 1e-7);
    near(run.at("twice", 1.6), 2.0 + 0.85f64.sin(), 1e-7);
    near(run.last("area"), 2.0 * 1.15 + 0.5f64.cos() - 1.65f64.cos(), 1e-6);
}

#[test]
fn a_sample_that_is_shown_is_true_at_its_instants_only() {
    let text = "model S Boolean b = sample(0.5, 0.5); Integer n(start = 0); Integer off(start = 0);
        equation when b then n = pre(n) + 1; end when; when not b then off = pre(off) + 1; end when; end S;";
    let run = simulated(text, 2.1);
    let rows = run.trajectory.time().iter().zip(run.values("b"));
    let on: Vec<f64> = rows.filter(|(_, b)| *b != 0.0).map(|(t, _)| *t).collect();
    assert_eq!(on, [0.5, 1.0, 1.5, 2.0]);
    assert_eq!((run.last("b"), run.last("n"), run.last("off")), (0.0, 4.0, 4.0));
}

#[test]
fn functions_in_when_clauses_check_their_arguments_when_called_only() {
    let text = "model F function root input Real x; output Real y; algorithm assert(x >= 0, \"negative\"); y := sqrt(x); end root;
        Real x = 1 - time; discrete Real r(start = 0); Real a; discrete Real s(start = 0);
        equation when time > 0.5 then r = root(x); end when;
        algorithm a := 0; if x > 0 then a := root(x); end if; when time > 0.75 then s := root(x); end when; end F;";
    let run = simulated(text, 2.0);
    near(run.last("r"), 0.5f64.sqrt(), 1e-9);
    near(run.last("s"), 0.5, 1e-9);
    near(run.last("a"), 0.0, 0.0);
}

#[test]
fn initial_selects_what_holds_at_the_start() {
    let text =
        "model I Real x(start = 5); Real y; equation der(x) = 1; y = if initial() then 2 else x;
        when initial() then reinit(x, 3); end when; end I;";
    let run = simulated(text, 1.0);
    near(run.at("x", 0.0), 3.0, 1e-12);
    near(run.at("y", 0.0), 3.0, 1e-12);
    near(run.last("x"), 4.0, 1e-9);
}

#[test]
fn a_discrete_subscript_chooses_an_element() {
    let text = "model T constant Integer table[2, 3] = [1, 2, 3; 10, 20, 30]; Integer i(start = 1); Integer j(start = 1);
        Real x[3] = {time, 2*time, 3*time}; Integer n = table[j, i]; Real y = x[i];
        equation when sample(1, 1) then i = pre(i) + 1; j = 3 - pre(j); end when; end T;";
    let run = simulated(text, 2.9);
    for (t, n, y) in [(0.58, 1.0, 0.58), (1.16, 20.0, 2.32), (2.9, 3.0, 8.7)] {
        near(run.at("n", t), n, 0.0);
        near(run.at("y", t), y, 1e-9);
    }
    let (program, _, _, ended) = attempt(text, 3.5);
    let error = ended.expect_err("there is no fourth element");
    near(error.time, 3.0, 1e-12);
    assert_eq!(program.explain(&error).code.slug, "assertion-failed");
}

#[test]
fn assertions_of_functions_hold_in_the_branch_taken_only() {
    let text = "model B function root input Real x; output Real y; algorithm assert(x >= 0, \"negative\"); y := sqrt(x); end root;
        Real x = 1 - time; Real y = if x > 0 then root(x) else -root(-x); end B;";
    let run = simulated(text, 2.0);
    near(run.at("y", 0.4), 0.6f64.sqrt(), 1e-12);
    near(run.last("y"), -1.0, 1e-12);
}

#[test]
fn loops_without_states_are_solved_at_every_point() {
    // G (T - 300) = P(T) with a power that falls with the temperature: the small difference of
    // large numbers shows whether T was interpolated.
    let text = "model H Real T(start = 300, nominal = 300); Real p; Real q;
        equation p = 100*sin(6.283185307179586*time)^2/(1 + 1e-3*(T - 300)); q = 50*(T - 300);
        p = q; end H;";
    let run = simulated(text, 1.0);
    for (time, p) in run.trajectory.time().iter().zip(run.values("q")) {
        let power = 100.0 * (std::f64::consts::TAU * time).sin().powi(2);
        // d (1 + d/1000) = power/50 for the difference d.
        let d = 500.0 * ((1.0 + 4e-3 * power / 50.0).sqrt() - 1.0);
        near(p, 50.0 * d, 1e-6);
    }
}

#[test]
fn a_rectifier_with_an_ideal_diode_conducts_at_the_exact_times() {
    // sin(2 π t) through a diode into a capacitor with a load: conducting until the current
    // C dv/dt + v/R is zero, then v falls exponentially until the source overtakes it.
    let text = "model R parameter Real r = 5; parameter Real c = 0.1; Real u = sin(6.283185307179586*time);
        Real v(start = 0, fixed = true); Real i; Real s; Boolean off = s < 0;
        equation u - v = if off then s else 1e-3*s; i = if off then 0 else s;
        c*der(v) = i - v/r; end R;";
    let run = simulated(text, 3.0);
    let charged = run.jumps("off");
    let omega = std::f64::consts::TAU;
    // The series resistance of 1e-3 shifts the ideal times by its share of the impedances.
    let begin = 0.5 - (omega * 5.0 * 0.1f64).atan() / omega;
    near(charged[0], begin, 1e-3);
    let mut t = 1.0;
    let decay = |t: f64| (omega * begin).sin() * (-(t - begin) / 0.5).exp();
    for _ in 0..100 {
        let f = (omega * t).sin() - decay(t);
        let slope = omega * (omega * t).cos() + decay(t) / 0.5;
        t -= f / slope;
    }
    near(charged[1], t, 1e-3);
    assert_eq!(charged.len(), 5, "{charged:?}");
    near(charged[3] - charged[1], 1.0, 2e-3);
    near(charged[4] - charged[2], 1.0, 2e-3);
}

/// Every simulation of many with other parameters ends, or fails with a code, a time and names of
/// the model; the same program and workspace serve all of them.
#[test]
fn many_simulations_end_or_fail_with_a_reason() {
    let text = "model M parameter Real a = 1; parameter Real b = 1; parameter Real limit = 2;
        Real x(start = 1, fixed = true); Real y;
        equation der(x) = a*x - b*x^3; sqrt(y) = x - a; assert(x < limit, \"too large\"); end M;";
    let program = compiled(text).expect("it compiles");
    let mut system = program.system();
    let (mut simulator, mut rows) = (Simulator::new(), Trajectory::default());
    let settings = Settings { stop: 2.0, output: OutputGrid::Intervals(10), ..Settings::default() };
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut counts = std::collections::BTreeMap::<&str, usize>::new();
    let runs = std::env::var("GAPILIB_RUNS").ok().and_then(|n| n.parse().ok()).unwrap_or(2000);
    for _ in 0..runs {
        for name in ["a", "b", "limit"] {
            let at = program.find_parameter(name).expect("a parameter");
            let value = if name == "limit" { 0.5 + 2.0 * random() } else { 4.0 * random() - 2.0 };
            system.set_parameter(at, value).expect("a number");
        }
        let ended = simulator.run(&mut system, &settings, &mut rows);
        let code = match &ended {
            Ok(_) => "ended",
            Err(error) => {
                let said = program.explain(error);
                assert!((0.0..=2.0).contains(&error.time), "{}", error.time);
                assert!(said.message.contains("t = ") || said.message.contains('`'), "{said}");
                said.code.slug
            }
        };
        *counts.entry(code).or_default() += 1;
    }
    assert_eq!(counts.values().sum::<usize>(), runs);
    assert!(counts.contains_key("ended") && counts.contains_key("assertion-failed"), "{counts:?}");
    assert!(counts.len() >= 3, "{counts:?}");
}
