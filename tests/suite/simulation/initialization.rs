//! Initial systems that are hard to solve, and loops inside the evaluation, from Modelica text.

use crate::support::simulated::{Run, program, simulated_with};
use gapilib::internals::runtime::System;
use gapilib::internals::sim::{
    EventOutcome, Events as _, Residual as _, Settings, find_integrator, simulate,
};

/// Its only root is 0; from 3 every step leads away from it.
const AWAY: &str = "x/(1 + x^2)";

#[test]
fn what_leads_newtons_method_away_is_solved_by_a_change_of_sign_or_by_homotopy() {
    let direct = format!("model D Real x(start = 3); equation {AWAY} = 0; end D;");
    Run::of(&direct, 1.0).follows("x", 1e-9, |_| 0.0);
    for arguments in
        [format!("{AWAY}, x - 0.5"), format!("simplified = (x + 2)/5, actual = {AWAY}")]
    {
        let text = format!("model H Real x(start = 3); equation homotopy({arguments}) = 0; end H;");
        Run::of(&text, 1.0).follows("x", 1e-9, |_| 0.0);
    }
}

#[test]
fn homotopy_chooses_among_solutions() {
    // x³ = x has three solutions, of which the start value 0 is one; x = ±0.8 leads to ±1.
    for (simplified, root) in [("x - 0.8", 1.0), ("x + 0.8", -1.0)] {
        let text = format!(
            "model C Real x(start = 0); equation homotopy(x^3 - x, {simplified}) = 0; end C;"
        );
        Run::of(&text, 1.0).follows("x", 1e-9, |_| root);
    }
}

#[test]
fn homotopy_that_leads_nowhere_is_left_aside() {
    let text = "model N Real x(start = 1); equation homotopy(x^2 - 4, x^2 + 1) = 0; end N;";
    Run::of(text, 1.0).follows("x", 1e-9, |_| 2.0);
}

#[test]
fn branches_of_large_loops_are_not_tried_where_homotopy_leads_nowhere() {
    // In no branch the simplified equation has a solution; all unknowns are iterated.
    let text = "model B Real x[60](each start = 1); Real y[6]; equation
        for i in 1:6 loop y[i] = if x[i] > 10 then 1 else 0; end for;
        for i in 1:59 loop x[i]^3 + x[i] = x[i + 1]^3 + x[i + 1]; end for;
        homotopy(x[60]^2 + x[1]^2 - 8, x[60]^2 + x[1]^2 + 1) + sum(y) = 0; end B;";
    let run = Run::of(text, 1.0);
    run.follows("x[30]", 1e-6, |_| 2.0);
    let start = &run.system.loop_efforts()[0];
    assert!(start.unknowns.len() > 50, "{}", start.unknowns.len());
    assert!(start.solutions < 4, "the loop of the start was solved {} times", start.solutions);
}

#[test]
fn homotopy_is_its_actual_argument_after_the_start() {
    let text = "model H Real x(start = 1, fixed = true); Real y;
        equation y = homotopy(actual = 2*x, simplified = 7); der(x) = -y; end H;";
    let run = Run::of(text, 1.0);
    run.follows("y", 1e-6, |t| 2.0 * (-2.0 * t).exp());
}

#[test]
fn guesses_of_zero_are_not_divided_by() {
    let text = "model Z Real x; Real y; equation x*y = 6; x/y = 1.5; end Z;";
    let run = Run::of(text, 1.0);
    run.follows("x", 1e-9, |_| 3.0);
}

#[test]
fn a_solution_with_which_something_has_no_value_is_left_for_another() {
    // Particles n of a mixture: zero is a solution as well, but not for the fractions.
    let text = "model N Real n; parameter Real m = 2; Real y(start = 0, fixed = true);
        equation n*(n - 0.5) = 0; der(y) = m/n; end N;";
    Run::of(text, 1.0).follows("y", 1e-6, |t| 4.0 * t);
}

#[test]
fn a_loop_without_a_solution_is_named() {
    let text = "model S Real x(start = 3); Real y(start = 1); parameter Real k = 1;
        equation x + y = 2 + k*time; x*exp(0*time) + k*y = 3 + time; end S;";
    let program = program(text);
    let error = simulate(&mut program.system(), &Settings::default()).unwrap_err();
    let diagnostic = program.explain(&error);
    assert!(
        diagnostic.message.contains("`x`") || diagnostic.message.contains("`y`"),
        "{diagnostic}"
    );
}

#[test]
fn start_values_are_propagated_along_alias_sets() {
    let text = "model A Real x; Real y(start = 2, fixed = true); Real z; equation x = -y; z = x; der(z) = 1; end A;";
    Run::of(text, 1.0).follows("y", 1e-9, |t| 2.0 - t);
    // The guess of an alias leads to the second root.
    let root = "model B Real x; Real y(start = -3); equation x = y; x^2 = 4; end B;";
    Run::of(root, 1.0).follows("x", 1e-9, |_| -2.0);
}

#[test]
fn a_fixed_start_value_goes_before_one_that_is_not() {
    for text in [
        "model F Real x(start = 1); Real y(start = 2, fixed = true); equation x = y; der(x) = 1; end F;",
        "model F Real x(start = 2, fixed = true); Real y(start = 1); equation x = y; der(y) = 1; end F;",
        "model F Real x(start = 1); Real y(start = -2, fixed = true); equation x = -y; der(x) = 1; end F;",
    ] {
        Run::of(text, 1.0).follows("x", 1e-9, |t| 2.0 + t);
    }
}

/// The clarifiers of WasteWater, fed by a table over time.
#[test]
fn an_initial_equation_determines_a_state_before_the_past_of_a_discrete_variable() {
    let text = "model M discrete Real n; Real q; Real h(start = 1); equation \
        when time >= 0.5 then n = pre(n) + 1; end when; q = 3 + pre(n); der(h) = -h; \
        initial equation h = 2*q; end M;";
    Run::of(text, 0.4).follows("h", 1e-7, |t| 6.0 * (-t).exp());
}

#[test]
fn fixed_start_values_of_one_alias_set_must_agree() {
    let text = |second: f64| {
        format!(
            "model T Real x(start = 1, fixed = true); Real y(start = {second}, fixed = true);
             equation x = -y; der(x) = 1; end T;"
        )
    };
    Run::of(&text(-1.0), 1.0).follows("y", 1e-9, |t| -1.0 - t);
    let program = program(&text(1.0));
    let error = simulate(&mut program.system(), &Settings::default()).unwrap_err();
    let message = program.explain(&error).message.clone();
    assert!(message.contains("initial"), "{message}");
}

#[test]
fn the_nominal_value_of_an_alias_scales_the_errors() {
    // Relative to 1 the state is noise; relative to 1e-9 it is followed.
    let text = "model N Real x(start = 0, fixed = true); Real y(nominal = 1e-9);
        equation x = y; der(x) = 1e-9 - x; end N;";
    Run::of(text, 1.0).follows("x", 1e-16, |t| -1e-9 * (-t).exp_m1());
}

/// From the start values the loop is not solved; from the solution with p = 0.1 it is, along p. Simulations
/// before it do not matter.
#[test]
fn a_start_far_from_the_parameters_of_the_model_is_reached_from_theirs() {
    let text = "model Q parameter Real p = 0.1; Real y(start = 0.1), z(start = 0.1);
        Real x(start = 1, fixed = true);
        equation sqrt(y) - sqrt(p) + 2*sin(3*(z - p)) = 0; sqrt(z)*exp(z - y) = sqrt(y);
        der(x) = -x; end Q;";
    let program = program(text);
    let p = program.find_parameter("p").expect("a parameter");
    let solved = |before: &[f64]| {
        let mut system = program.system();
        system.observe_only(&["y", "z"].map(|n| program.find_variable(n).expect("a variable")));
        let mut start = Vec::new();
        for value in before.iter().chain(&[30.0]) {
            system.set_parameter(p, *value).expect("a number");
            let (trajectory, _) = simulate(&mut system, &Settings::default()).expect("a start");
            start = vec![trajectory.column(0)[0], trajectory.column(1)[0]];
        }
        start
    };
    let alone = solved(&[]);
    let (y, z) = (alone[0], alone[1]);
    let residual = y.sqrt() - 30f64.sqrt() + 2.0 * (3.0 * (z - 30.0)).sin();
    assert!(residual.abs() < 1e-8, "{residual:e} at {y}, {z}");
    assert!((y - z).abs() < 1e-8, "{y} {z}");
    assert_eq!(alone, solved(&[100.0, 0.1, 10.0]));
}

/// Importers of units and integrators ask for derivatives, crossings, indicators and results at one point; an
/// event there, and a value that is set, need solutions of their own.
#[test]
fn loops_are_solved_once_at_a_point() {
    let text = "model P Real x(start = 1, fixed = true); Real z(start = 1);
        Boolean low(start = false, fixed = true);
        equation z + z^3 = (if low then 20 else 2)*x; der(x) = -z;
        when x < 0.5 then low = true; end when; end P;";
    let mut system = program(text).system();
    system.solve_loops(true);
    let mut x = vec![0.0; system.n_differential()];
    system.initialize(0.0, &mut x).unwrap();
    let [crossings, indicators] = [system.n_crossings(), system.program().n_indicators()];
    let observed = system.n_observed();
    let everything = |system: &mut System, t: f64, x: &[f64]| {
        let count = |system: &System| -> u64 {
            system.loop_efforts().iter().map(|own| own.solutions).sum()
        };
        let (before, mut derivatives) = (count(system), [0.0]);
        system.rhs(t, x, &mut derivatives).unwrap();
        system.crossings(t, x, &mut vec![0.0; crossings]).unwrap();
        system.event_indicators(t, x, &mut vec![0.0; indicators]).unwrap();
        system.observe(t, x, &mut vec![0.0; observed]).unwrap();
        (derivatives[0], count(system) - before)
    };
    let close = |(found, count): (f64, u64), z: f64| {
        assert!((found + z).abs() < 1e-12 && count == 1, "{found} {z} {count}");
    };
    close(everything(&mut system, 0.0, &x), 1.0);
    close(everything(&mut system, 1.0, &x), 1.0);
    let kept = system.clone();
    x[0] = 0.34;
    // The real root of z + z^3 = 0.68, and that of z + z^3 = 6.8 (Brent's method).
    close(everything(&mut system, 1.0, &x), 0.530_609_111_552_160_2);
    while system.handle_event(1.0, &mut x).unwrap() == EventOutcome::Again {}
    close(everything(&mut system, 1.0, &x), 1.719_144_140_974_806_5);
    // A state that is restored has its own solution.
    let mut system = kept;
    close(everything(&mut system, 1.0, &[0.34]), 0.530_609_111_552_160_2);
}

#[test]
fn explicit_methods_solve_loops_in_every_evaluation() {
    let text = "model E Real x(start = 1, fixed = true); Real y(start = 1); Real z;
        equation der(x) = -y; y + 0.1*(y^3 - x^3) = x; z + x*z = y; end E;";
    for method in ["dopri5", "dop853", "rungekutta", "euler"] {
        let settings = Settings {
            tolerance: 1e-9,
            step: Some(1e-3),
            method: find_integrator(method).unwrap(),
            ..Settings::default()
        };
        let run = simulated_with(text, &settings);
        let tolerance = if method == "euler" { 1e-3 } else { 1e-8 };
        run.follows("x", tolerance, |t| (-t).exp());
        run.follows("z", tolerance, |t| (-t).exp() / (1.0 + (-t).exp()));
    }
}
