//! Initial systems that are hard to solve, and loops inside the evaluation, from Modelica text.

use super::index_reduction::{Run, compiled};
use gapilib::sim::{Settings, find_integrator, simulate};

/// Its only root is 0; from 3 every step leads away from it.
const AWAY: &str = "x/(1 + x^2)";

#[test]
fn homotopy_leads_where_newton_does_not() {
    let direct = compiled(&format!("model D Real x(start = 3); equation {AWAY} = 0; end D;"));
    let error = simulate(&mut direct.system(), &Settings::default()).unwrap_err();
    let diagnostic = direct.explain(&error);
    assert_eq!(diagnostic.code.slug, "initialization-failed");
    assert!(diagnostic.message.contains("`x`"), "{diagnostic}");
    for arguments in
        [format!("{AWAY}, x - 0.5"), format!("simplified = (x + 2)/5, actual = {AWAY}")]
    {
        let text = format!("model H Real x(start = 3); equation homotopy({arguments}) = 0; end H;");
        Run::of(&text, 1.0).follows("x", 1e-9, |_| 0.0);
    }
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
fn a_loop_without_a_solution_is_named() {
    let text = "model S Real x(start = 3); Real y(start = 1); parameter Real k = 1;
        equation x + y = 2 + k*time; x*exp(0*time) + k*y = 3 + time; end S;";
    let program = compiled(text);
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
fn explicit_methods_solve_loops_in_every_evaluation() {
    let text = "model E Real x(start = 1, fixed = true); Real y(start = 1); Real z;
        equation der(x) = -y; y + 0.1*(y^3 - x^3) = x; z + x*z = y; end E;";
    for method in ["dopri5", "rungekutta", "euler"] {
        let settings = Settings {
            tolerance: 1e-9,
            step: Some(1e-3),
            method: find_integrator(method).unwrap(),
            ..Settings::default()
        };
        let run = Run::with(text, settings);
        let tolerance = if method == "euler" { 1e-3 } else { 1e-8 };
        run.follows("x", tolerance, |t| (-t).exp());
        run.follows("z", tolerance, |t| (-t).exp() / (1.0 + (-t).exp()));
    }
}
