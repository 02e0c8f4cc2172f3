//! What keeps correct models from starting or going on, against exact solutions: divisions by unknowns that
//! begin at zero, overflows on the way to a limit, constraints hidden by numbers, preferred states.

use crate::support::simulated::{Run, program, simulated, simulated_with};
use gapilib::internals::sim::{Settings, simulate};

#[test]
fn an_unknown_below_a_fraction_is_not_divided_by_where_it_begins() {
    let run = Run::of("model G Real g; Real r; equation r = 4*(1 + time); r = 1/g; end G;", 1.0);
    run.follows("g", 1e-12, |t| 0.25 / (1.0 + t));
    // Nested, and with a factor that is a parameter.
    let text = "model N Real g; parameter Real k = 2; equation exp(time) = k/(3 + k/g); end N;";
    let run = Run::of(text, 0.1);
    run.follows("g", 1e-12, |t| 2.0 / (2.0 * (-t).exp() - 3.0));
    // No g fulfils it: an error, not a number.
    let program = program("model Z Real g; equation time = 1/g; end Z;");
    let error = simulate(&mut program.system(), &Settings::default()).unwrap_err();
    assert_eq!(program.explain(&error).code.slug, "domain-error");
}

#[test]
fn exp_may_overflow_where_its_limit_is_finite() {
    let text = "model S Real x(start = 1, fixed = true), f, g;
        equation der(x) = f - 2; f = 2/(1 + exp(-x/1e-3)) - 1; g = 1/cosh(1e3*x); end S;";
    // x falls by 1 a second until it passes zero, then by 3.
    let run = Run::of(text, 2.0);
    let values = run.values("x");
    let last = values.last().copied().unwrap_or(f64::NAN);
    assert!((last + 3.0).abs() < 1e-2, "{last}");
    let f = run.values("f").last().copied();
    assert_eq!(f, Some(-1.0));
    assert_eq!(run.values("g").last().copied(), Some(0.0));
}

#[test]
fn an_overflow_that_a_variable_takes_is_an_error() {
    for equations in
        ["x = exp(1e3*time)", "der(x) = cosh(1e3*time)", "x + 0 = 2*sinh(1e3*time) - 1"]
    {
        let program = program(&format!("model O Real x; equation {equations}; end O;"));
        let settings = Settings { stop: 1.0, ..Settings::default() };
        let error = simulate(&mut program.system(), &settings).unwrap_err();
        let diagnostic = program.explain(&error);
        assert_eq!(diagnostic.code.slug, "domain-error", "{equations}: {diagnostic}");
    }
}

#[test]
fn constraints_that_numbers_hide_are_differentiated() {
    // x = y follows from the equations of a and b.
    let text = "model H Real x(start = 1, fixed = true), y; Real a, b;
        equation a + b = x; 2*a + 2*b = 2*y; der(x) = a - x; der(y) = b - 2*y; end H;";
    let run = Run::of(text, 2.0);
    assert_eq!(run.states().len(), 1);
    run.follows("y", 1e-7, |t| (-t).exp());
    run.follows("b", 1e-7, |t| (-t).exp());
    run.follows("a", 1e-7, |_| 0.0);
}

/// Cosines of the angles of five phases: the second row is the first one, negated, but for rounding.
#[test]
fn constraints_hidden_by_rounded_numbers_are_found() {
    let text =
        "model P constant Real pi = 3.141592653589793; Real x(start = 1, fixed = true), y, a, b;
        equation cos(pi/5)*a + cos(2*pi/5)*b = x; cos(4*pi/5)*a + cos(3*pi/5)*b = y;
          der(x) = a - x; der(y) = b - 2*y; end P;";
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let run = Run::of(text, 1.0);
    assert_eq!(run.states().len(), 1);
    run.follows("x", 1e-7, |t| (golden * t).exp());
}

#[test]
fn a_preferred_state_begins_at_its_start_value() {
    let text = "model T Real m; Real level(start = 0.8, stateSelect = StateSelect.prefer);
        equation m = 1000*level; der(m) = -m; end T;";
    Run::of(text, 1.0).follows("m", 1e-6, |t| 800.0 * (-t).exp());
    // What is said of the state itself comes first.
    let text = "model F Real m(start = 500, fixed = true);
        Real level(start = 0.8, stateSelect = StateSelect.prefer);
        equation m = 1000*level; der(m) = -m; end F;";
    Run::of(text, 1.0).follows("m", 1e-6, |t| 500.0 * (-t).exp());
}

#[test]
fn a_relation_without_effect_ends_no_simulation() {
    // While q holds, nothing depends on the relation, which changes with every error of x.
    let text = "model Q Real x(start = 0, fixed = true); Real y; Boolean q(start = true, fixed = true);
        equation der(x) = 1e4*(sin(314*time) - x); y = x + 1e-7*sin(1e7*x); q = y <= x or pre(q); end Q;";
    let run = simulated_with(text, &Settings { stop: 0.1, ..Settings::default() });
    run.follows("q", 0.0, |_| 1.0);
}

#[test]
fn a_followed_relation_acts_when_it_matters() {
    // From 0.05 s on q is what the relation says; x stays below 2 until 0.07 s.
    let text =
        "model A Real x(start = 0, fixed = true); Real y; Boolean q(start = true, fixed = true);
        equation der(x) = 1e4*(sin(314*time) - x) + (if time > 0.07 then 1e8 else 0);
          y = x + 1e-7*sin(1e7*x);
          q = (if time > 0.05 then y <= x - 5 or x < 2 else y <= x or pre(q)); end A;";
    let run = simulated_with(text, &Settings { stop: 0.1, ..Settings::default() });
    for (t, q) in run.trajectory.time().iter().zip(run.values("q")) {
        let expected = if *t < 0.07 { 1.0 } else { 0.0 };
        let is_clear = (t - 0.07).abs() > 1e-6;
        assert!(!is_clear || q == expected, "q({t}) = {q}");
    }
}

#[test]
fn cascades_of_any_length_end() {
    // Each relay waits for the one before: by its relation, and by its value before the round.
    let chain = "model R parameter Integer n = 200; Real x[n];
        equation x[1] = if time > 0.5 then 1 else 0;
          for k in 2:n loop x[k] = if x[k - 1] > 0.5 then 1 else 0; end for; end R;";
    let run = Run::of(chain, 1.0);
    assert_eq!(run.values("x[200]").first(), Some(&0.0));
    assert_eq!(run.values("x[200]").last(), Some(&1.0));
    let breakers =
        "model B parameter Integer n = 160; Real v[n + 1]; Boolean open[n](each fixed = true);
        equation v[1] = if time > 0.5 then 10 else 1;
          for k in 1:n loop
            when v[k] > 5 then open[k] = true; end when;
            v[k + 1] = if open[k] then 10 else 1;
          end for; end B;";
    let run = Run::of(breakers, 1.0);
    assert_eq!(run.values("v[161]").last(), Some(&10.0));
    assert_eq!(run.values("v[161]").first(), Some(&1.0));
}

/// A limiter that begins at its limit hides what determines its input: another branch has a solution.
#[test]
fn a_branch_that_cannot_be_solved_is_left_for_one_that_can() {
    let text = include_str!("../../data/models/starting_branch.mo");
    let run = simulated(text, 0.0);
    assert_eq!([run.last("y"), run.last("before"), run.last("filtered")], [1.0, 1.0, 0.5]);
    let upper = text.replace("y = 1;", "y = 2.5;");
    assert_eq!(simulated(&upper, 0.0).last("filtered"), 2.0);
}

/// To multiply with what an unknown is divided by is possible where it is zero, too.
#[test]
fn an_unknown_over_zero_is_multiplied_out() {
    let one = Run::of("model H Real h; Real a = time; equation h/a^2 = 2 + time; end H;", 1.0);
    one.follows("h", 1e-12, |t| (2.0 + t) * t * t);
    let text = "model B Real h; Real a = time; equation
        if a < 0.5 then (h - 1)/a + 3 = 2*time; else h/a + 1 = 2*time; end if; end B;";
    Run::of(text, 1.0).follows("h", 1e-12, |t| {
        if t < 0.5 { 1.0 + (2.0 * t - 3.0) * t } else { (2.0 * t - 1.0) * t }
    });
}
