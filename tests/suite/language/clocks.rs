//! Clocks and clocked equations (MLS chapter 16) against values that the specification gives or
//! that follow by hand.

use crate::support::simulated::{Run, attempt, compiled, simulated};
use gapilib::internals::sim::{OutputGrid, Settings, Simulator, Trajectory};

#[track_caller]
fn holds(run: &Run, name: &str, values: &[(f64, f64)]) {
    for (time, expected) in values {
        let found = run.at(name, *time);
        assert!((found - expected).abs() <= 1e-8, "{name} at {time}: {found}, not {expected}");
    }
}

/// The code, message and places of what is wrong.
#[track_caller]
fn refused(text: &str) -> (String, String) {
    match compiled(text) {
        Ok(_) => panic!("the model is accepted"),
        Err(error) => (error.code.slug.to_owned(), error.message.clone()),
    }
}

#[test]
fn a_sample_is_the_left_limit_and_initialization_comes_first() {
    // MLS §16.5.1: the value at the first tick is 2, not the start value 1.
    let run = simulated(
        "model M Real y(start = 1), yc; Boolean b = time >= 0.45; Boolean late = sample(b, c);
         Clock c = Clock(0.15);
         equation der(y) + y = 2 + (if time > 0.2 then 1 else 0); yc = sample(y, c);
         initial equation der(y) = 0; end M;",
        1.0,
    );
    holds(&run, "yc", &[(0.0, 2.0), (0.15, 2.0), (0.3, 3.0 - f64::exp(-0.1))]);
    // At 0.45 the condition is still false to the left.
    holds(&run, "late", &[(0.0, 0.0), (0.45, 0.0), (0.6, 1.0)]);
}

#[test]
fn sub_and_super_sampling_follow_the_specification() {
    let run = simulated(
        "model M Integer y = integer(sample(time + 0.5, Clock(1)));
         Integer ySub = subSample(y, 4); Integer ySubSuper = superSample(ySub, 5);
         Real h = interval(ySubSuper); Real hs = interval(ySub); end M;",
        9.0,
    );
    holds(&run, "y", &[(0.0, 0.0), (1.0, 1.0), (7.0, 7.0)]);
    holds(&run, "ySub", &[(0.0, 0.0), (4.0, 4.0), (7.0, 4.0), (8.0, 8.0)]);
    holds(&run, "ySubSuper", &[(3.2, 0.0), (4.0, 4.0), (7.2, 4.0), (8.0, 8.0)]);
    holds(&run, "h", &[(0.0, 0.8), (4.0, 0.8)]);
    holds(&run, "hs", &[(0.0, 4.0), (8.0, 4.0)]);
}

#[test]
fn shifted_clocks_follow_the_specification() {
    let run = simulated(
        "model M Integer y = integer(sample(time + 0.5, Clock(1)));
         Integer yShift(start = 10) = shiftSample(y, 1, 5);
         Integer yBack = backSample(yShift, 1, 5);
         Integer yShift2 = shiftSample(yShift, 4, 5);
         Integer yNamed = shiftSample(y, resolution = 5, shiftCounter = 1); end M;",
        3.0,
    );
    holds(&run, "yShift", &[(0.2, 0.0), (1.2, 1.0), (2.2, 2.0)]);
    holds(&run, "yNamed", &[(0.2, 0.0), (1.2, 1.0), (2.2, 2.0)]);
    holds(&run, "yBack", &[(0.0, 10.0), (1.0, 0.0), (2.0, 1.0)]);
    holds(&run, "yShift2", &[(1.0, 0.0), (2.0, 1.0)]);
}

#[test]
fn no_clock_is_the_value_now_and_a_sample_of_a_hold_is_the_one_before() {
    let run = simulated(
        "model M Clock clk1 = Clock(0.1); Clock clk2 = subSample(clk1, 2);
         Real x(start = 0), y(start = 0), z(start = 0);
         equation when clk1 then x = previous(x) + 0.1; end when;
         when clk2 then y = noClock(x); z = sample(hold(x)); end when; end M;",
        0.5,
    );
    holds(&run, "y", &[(0.0, 0.1), (0.2, 0.3), (0.4, 0.5)]);
    holds(&run, "z", &[(0.0, 0.0), (0.2, 0.2), (0.4, 0.4)]);
}

#[test]
fn clocks_whose_interval_is_a_variable_tick_when_it_has_passed() {
    let text = "model M Integer n(start = 2); Integer k(start = 0); Real h;
         Real d(start = 0.002), g; Integer l(start = 0);
         equation when Clock(n, 1000) then n = previous(n) + 1; k = previous(k) + 1;
         h = interval(); end when;
         when Clock(d) then d = previous(d) + 1e-3; l = previous(l) + 1; g = interval(); end when;
         end M;";
    let run = simulated(text, 0.0185);
    // MLS §16.3: ticks at 0, 0.003, 0.007, 0.012, …
    let ticks = [(0.0, 1.0), (0.003, 2.0), (0.007, 3.0), (0.012, 4.0), (0.018, 5.0)];
    holds(&run, "k", &ticks);
    holds(&run, "l", &ticks);
    assert_eq!((run.last("k"), run.last("l")), (5.0, 5.0));
    holds(&run, "h", &[(0.0, 0.002), (0.003, 0.003), (0.018, 0.006)]);
    holds(&run, "g", &[(0.0, 0.002), (0.003, 0.003), (0.018, 0.006)]);
}

#[test]
fn an_event_clock_ticks_one_round_later_and_sees_what_set_it_off() {
    let run = simulated(
        "model M Boolean b = time >= 0.5; Clock c = Clock(b, 0.25); Boolean b2 = sample(b, c);
         Real angle = sample(time, e); Integer n(start = 0); Real h;
         Clock e = Clock(sin(20*time) > 0, 0.1); Clock every2 = subSample(e, 2);
         Integer m(start = 0);
         equation n = previous(n) + (if angle >= 0 then 1 else 0); h = interval(angle);
         when every2 then m = previous(m) + 1; end when; end M;",
        1.0,
    );
    holds(&run, "b2", &[(0.5, 1.0)]);
    let period = std::f64::consts::PI / 10.0;
    assert_eq!((run.last("n"), run.last("m")), (4.0, 2.0));
    assert!((run.last("h") - period).abs() < 1e-8 && (run.last("angle") - 3.0 * period) < 1e-8);
}

#[test]
fn counters_of_the_specification_stay_together() {
    // MLS §16.11.
    let run = simulated(
        "model ClockTicks Integer second = sample(1, Clock(1));
         Integer seconds(start = -1) = mod(previous(seconds) + second, 60);
         Integer milliSeconds(start = -1) =
           mod(previous(milliSeconds) + superSample(second, 1000), 1000);
         Integer minutes(start = -1) = mod(previous(minutes) + subSample(second, 60), 60);
         end ClockTicks;",
        121.5,
    );
    let last = ["seconds", "milliSeconds", "minutes"].map(|name| run.last(name));
    assert_eq!(last, [1.0, 500.0, 2.0]);
}

#[test]
fn implicit_equations_are_solved_at_every_tick() {
    let run = simulated(
        "model M Real x[2](start = {0, 1}); Real z(start = 1); Integer n(start = 0);
         Clock c = Clock(1, 10);
         equation when c then n = previous(n) + 1; [2, 1; 1, -1]*x = previous(x) + {n, 0};
         z^3 + z = 10*n; end when; end M;",
        0.3,
    );
    let (mut x, mut time) = ([0.0, 1.0], 0.0);
    for n in 1..=4 {
        let (a, b) = (x[0] + f64::from(n), x[1]);
        x = [(a + b) / 3.0, (a - 2.0 * b) / 3.0];
        holds(&run, "x[1]", &[(time, x[0])]);
        holds(&run, "x[2]", &[(time, x[1])]);
        let z = run.at("z", time);
        assert!((z.powi(3) + z - 10.0 * f64::from(n)).abs() < 1e-7, "{z}");
        time = f64::from(n) * 0.1;
    }
}

#[test]
fn solver_methods_make_the_steps_of_the_specification() {
    let model = |method: &str| {
        format!(
            "model M Real x(start = 1, fixed = true); Real u = 3; Real y;
             equation der(x) = -2*x + sample(u, Clock(Clock(1, 10), solverMethod = \"{method}\"));
             y = hold(x); end M;"
        )
    };
    let (h, f) = (0.1, |x: f64| -2.0 * x + 3.0);
    let steps: [(&str, &dyn Fn(f64) -> f64); 3] = [
        ("ExplicitEuler", &|x| x + h * f(x)),
        ("ImplicitEuler", &|x| (x + 3.0 * h) / (1.0 + 2.0 * h)),
        ("ImplicitTrapezoid", &|x| (x * (1.0 - h) + 3.0 * h) / (1.0 + h)),
    ];
    for (method, step) in steps {
        let run = simulated(&model(method), 0.5);
        let mut x = 1.0;
        for tick in 0..5 {
            holds(&run, "y", &[(f64::from(tick) * 0.1, x)]);
            x = step(x);
        }
    }
}

#[test]
fn solver_methods_are_inferred() {
    // MLS §16.8.4.
    let text = |last: &str| {
        format!(
            "model M Real x(start = 3, fixed = true); Real y; Real z;
             equation
             der(x) = -x + sample(1, Clock(Clock(1, 10), solverMethod = \"ExplicitEuler\"));
             der(y) = subSample(x, 2)
               + sample(1, Clock(Clock(2, 10), solverMethod = \"ImplicitEuler\"));
             der(z) = {last}; end M;"
        )
    };
    let run = simulated(&text("subSample(x, 2) + 1"), 0.45);
    let mut x = [3.0; 5];
    (1..5).for_each(|i| x[i] = x[i - 1] + 0.1 * (1.0 - x[i - 1]));
    let y = 0.2 * (x[2] + 1.0) + 0.2 * (x[4] + 1.0);
    let z = 0.2 * (x[0] + 1.0) + 0.2 * (x[2] + 1.0);
    holds(&run, "y", &[(0.4, y)]);
    holds(&run, "z", &[(0.4, z)]);
    let (code, message) = refused(&text("subSample(x, 4) + 1 + subSample(y)"));
    assert_eq!(code, "clock-conflict", "{message}");
    let (code, _) = refused("model M Real x; equation der(x) = sample(time, Clock(1)); end M;");
    assert_eq!(code, "clock-conflict");
}

#[test]
fn ticks_count_from_the_start_of_the_simulation() {
    let text = "model M Real t = sample(time, Clock(0.25)); Real s = hold(t); end M;";
    let program = compiled(text).expect("it compiles");
    let mut system = program.system();
    let output = OutputGrid::Intervals(10);
    let settings = Settings { start: 0.1, stop: 0.7, output, ..Settings::default() };
    let mut rows = Trajectory::default();
    Simulator::new().run(&mut system, &settings, &mut rows).expect("it runs");
    let at = program.find_variable("t").expect("a variable");
    let gapilib::internals::codegen::Access::Observed { column, .. } =
        program.variables()[at].access
    else {
        panic!("t is observed");
    };
    let last = *rows.column(column).last().expect("a row");
    assert!((last - 0.6).abs() < 1e-12, "{last}");
}

#[test]
fn clocked_equations_cause_no_events_of_their_own() {
    // u passes 0.5 between ticks; the comparison belongs to the clock.
    let run = simulated(
        "model M Real u = sample(time, Clock(0.4)); Boolean large = u > 0.5;
         Integer whole = integer(10*u); end M;",
        1.0,
    );
    assert_eq!(run.events(), [0.4, 0.8]);
    holds(&run, "large", &[(0.4, 0.0), (0.8, 1.0)]);
    holds(&run, "whole", &[(0.4, 4.0), (0.8, 8.0)]);
}

#[test]
fn assertions_of_clocked_variables_wait_for_ticks() {
    let text = "model M Real u(start = -1) = sample(time + 1, Clock(shiftClock));
         Clock shiftClock = shiftSample(Clock(1, 2), 1, 2);
         equation assert(u > 0, \"u is negative\"); assert(u < 1.6, \"u is large\"); end M;";
    let (program, _, rows, ended) = attempt(text, 2.0);
    let error = ended.expect_err("it ends");
    assert!(program.explain(&error).message.contains("u is large"));
    assert!((rows.time().last().expect("a row") - 0.75).abs() < 1e-9);
}

#[test]
fn contradictions_are_found_before_the_simulation() {
    let conflicts = [
        "model M Real y; equation y = sample(time, Clock(1, 10)) + sample(time, Clock(1, 3));
         end M;",
        "model M Real y = sample(time, Clock(1, 10)); Real z = y + time; Real w; equation
         der(w) = z; end M;",
        "model M Real y = sample(time, Clock(2.5)); Real z = subSample(y, 2); Real v; equation
         v = z + sample(time, Clock(2.5)); end M;",
        "model M Clock c = Clock(1, 2); Clock early = backSample(c, 1);
         Real y = sample(time, early) ; Real z = sample(time, c); end M;",
        "model M Real y = sample(time, Clock(3, 10)); Real z = superSample(y);
         Real v = z + sample(time, Clock(2, 10)); end M;",
        "model M Real y = sample(time, Clock(1)); Real z = hold(y) + y; end M;",
    ];
    for text in conflicts {
        let (code, message) = refused(text);
        assert_eq!(code, "clock-conflict", "{text}: {message}");
    }
    let unsupported = [
        "model M Clock u = Clock(time > 1); Clock v = superSample(u, 2);
         Real y = sample(time, v); Real z = sample(time, u); end M;",
        "model M Real y = sample(time, Clock(1)); Real z = previous(2*y); end M;",
        "model M Real x(start = 1) ; equation
         der(x) = sample(time, Clock(Clock(1), solverMethod = \"Simpson\")); end M;",
    ];
    for text in unsupported {
        let (code, message) = refused(text);
        assert_eq!(code, "not-supported", "{text}: {message}");
    }
}

#[test]
fn a_partition_without_a_clock_ticks_every_second_and_says_so() {
    let text = "model M Integer n(start = 0) = previous(n) + 1; end M;";
    let program = compiled(text).expect("it compiles");
    let words: Vec<&str> = program.warnings().iter().map(|w| &*w.message).collect();
    assert!(words.iter().any(|w| w.contains("every second")), "{words:?}");
    assert_eq!(simulated(text, 3.5).last("n"), 4.0);
}
