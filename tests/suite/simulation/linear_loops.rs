//! Linear algebraic loops, from Modelica text, against exact solutions.

use crate::support::simulated::{Run, flat, program, simulated_with};
use gapilib::internals::causalize::{Block, causalize};
use gapilib::internals::codegen::Program;
use gapilib::internals::sim::{Settings, simulate};

/// Sizes of the linear and of the other loops.
fn loops(program: &Program) -> (Vec<usize>, Vec<usize>) {
    let blocks = &program.sorted().blocks;
    let linear = blocks.iter().filter_map(|block| match block {
        Block::Linear(solved) => Some(solved.unknowns.len()),
        _ => None,
    });
    let torn = blocks.iter().filter_map(|block| match block {
        Block::Loop(torn) => Some(torn.iteration.len()),
        _ => None,
    });
    (linear.collect(), torn.collect())
}

/// Every entry of the matrix vanishes at some time, never all that a pivot could be chosen from.
const ROTATION: &str = "model Rotation Real a[3]; Real b[3]; Real x(start = 0, fixed = true);
    parameter Real u[3] = {1, -2, 3};
    equation
      cos(7*time)*a[1] - sin(7*time)*a[2] + 0.2*a[3]*sin(time) = u[1];
      sin(7*time)*a[1] + cos(7*time)*a[2] + 0.3*a[3]*cos(time) = u[2];
      0.1*a[1]*sin(time) + 0.1*a[2]*cos(3*time) + (3 + sin(5*time))*a[3] = u[3];
      b = 2*a;
      der(x) = u[1] - (cos(7*time)*a[1] - sin(7*time)*a[2] + 0.2*a[3]*sin(time)) + 1;
    end Rotation;";

#[test]
fn loops_of_three_are_solved_whatever_entries_vanish() {
    let run = Run::of(ROTATION, 3.0);
    assert_eq!(loops(&run.program), (vec![3], vec![]));
    let (a1, a2, a3) = (run.values("a[1]"), run.values("a[2]"), run.values("a[3]"));
    for (at, t) in run.values("time").into_iter().enumerate() {
        let first = (7.0 * t).cos() * a1[at] - (7.0 * t).sin() * a2[at] + 0.2 * a3[at] * t.sin();
        let third = 0.1 * a1[at] * t.sin()
            + 0.1 * a2[at] * (3.0 * t).cos()
            + (3.0 + (5.0 * t).sin()) * a3[at];
        assert!((first - 1.0).abs() < 1e-12 && (third - 3.0).abs() < 1e-12, "{first} {third}");
    }
    run.follows("x", 1e-8, |t| t);
}

#[test]
fn the_slopes_of_a_loop_reach_the_integrator() {
    // The inverse of a rotation by x turns (sin x, cos x, x) back: der(x) = -x.
    let text = "model Slopes Real x(start = 1, fixed = true); Real a[3];
        equation
          cos(x)*a[1] - sin(x)*a[2] + x*a[3] = -sin(x) + x*x;
          sin(x)*a[1] + cos(x)*a[2] + x*a[3] = cos(x) + x*x;
          2*cos(x)*a[2] + (1 + x*x)*a[3] = 2*cos(x) + x + x^3;
          der(x) = -a[3];
        end Slopes;";
    for method in ["dassl", "rodas4", "dopri5"] {
        let method = gapilib::internals::sim::find_integrator(method).unwrap();
        let run =
            simulated_with(text, &Settings { method, tolerance: 1e-9, ..Settings::default() });
        assert_eq!(loops(&run.program), (vec![3], vec![]));
        run.follows("x", 1e-7, |t| (-t).exp());
        run.follows("a[2]", 1e-9, |_| 1.0);
    }
}

#[test]
fn a_singular_loop_with_solutions_has_the_smallest() {
    // Two equal springs share a load: the static problem does not say how.
    let text = "model Shared Real f[2]; parameter Real k = 1;
        equation (2 + sin(time))*(f[1] + f[2]) = (2 + sin(time))*(6 + time);
          k*sin(time + 1)*(f[1] + f[2]) = sin(time + 1)*(6 + time);
        end Shared;";
    let run = Run::of(text, 1.0);
    run.follows("f[1]", 1e-9, |t| 3.0 + t / 2.0);
    run.follows("f[2]", 1e-9, |t| 3.0 + t / 2.0);
}

#[test]
fn contradicting_equations_are_an_error() {
    let text = "model Contradiction Real f[2]; parameter Real k = 1;
        equation f[1] + f[2] = 6; k*sin(time + 1)*(f[1] + f[2]) = 7; end Contradiction;";
    let program = program(text);
    let error = simulate(&mut program.system(), &Settings::default()).unwrap_err();
    let diagnostic = program.explain(&error);
    assert!(diagnostic.message.contains("`f["), "{diagnostic}");
}

/// A torque along an axis, as joints have it: components of the axis are zero.
const AXIS: &str = "model Axis
    function unit input Real v[3]; output Real e[3];
    algorithm assert(v*v > 0, \"no direction\"); e := v/sqrt(v*v); end unit;
    parameter Real n[3] = {0, 2, 0} annotation(Evaluate = true);
    parameter Real r[3] = {0, 0, 3};
    final parameter Real e[3] = unit(n);
    Real t[3]; Real f[3]; Real tau;
    equation tau = e*t; t = {4, 5 + time, 6} + {r[2]*f[3] - r[3]*f[2], 0, 0}; r*f = 1;
      e*f = tau; f[1] = 2*t[1];
    end Axis;";

#[test]
fn parameters_that_are_zero_are_not_divided_by() {
    let run = Run::of(AXIS, 1.0);
    run.follows("tau", 1e-9, |t| 5.0 + t);
    run.follows("f[3]", 1e-9, |_| 1.0 / 3.0);
    run.follows("t[1]", 1e-9, |t| 4.0 - 3.0 * (5.0 + t));
}

#[test]
fn what_cannot_be_set_becomes_a_number() {
    let sorted = causalize(&flat(AXIS).expect("a model")).unwrap();
    let kind = |name: &str| sorted.dae.variables.iter().find(|v| &*v.name == name).unwrap().kind;
    assert_eq!(kind("e[2]"), gapilib::internals::lower::VariableKind::Constant(1.0));
    assert_eq!(kind("r[3]"), gapilib::internals::lower::VariableKind::Parameter { tunable: true });
}

#[test]
fn a_resistance_of_zero_is_a_connection() {
    // The voltage of the capacitor is that of the source.
    let text = "model Wire parameter Real R = 0; final parameter Real r = 2*R; Real i; Real v;
        equation r*i = sin(time) - v; 3*der(v) = i; end Wire;";
    let run = Run::of(text, 1.0);
    run.follows("v", 1e-9, f64::sin);
    run.follows("i", 1e-9, |t| 3.0 * t.cos());
    // Two of them, and a source that knows the current.
    let text = "model Wires parameter Real R = 0; Real i[2]; Real v; Real u;
        equation R*i[1] = u - v; R*i[2] = v - sin(time); i[1] + 1 = i[2]; der(u) = i[1]; end Wires;";
    let run = Run::of(text, 1.0);
    run.follows("u", 1e-9, f64::sin);
    run.follows("i[2]", 1e-9, |t| t.cos() + 1.0);
}

#[test]
fn a_capacitance_of_zero_holds_no_voltage() {
    let text = "model Open parameter Real C = 0; Real c; Real i; Real v; Real u;
        equation c = if v > 0 then C*exp(v) else C*(1 + v)^2; i = c*der(v); u - v = 2*i;
          u = 1 + time; end Open;";
    let run = Run::of(text, 1.0);
    run.follows("v", 1e-9, |t| 1.0 + t);
    run.follows("i", 1e-9, |_| 0.0);
}

#[test]
fn a_loop_of_many_unknowns_with_few_neighbours_is_solved() {
    // The solution is known: b follows from it.
    let text = "model Chain constant Integer n = 80; Real x[n]; Real b[n]; Real y(start = 1, fixed = true);
        equation
          for i in 1:n loop b[i] = exp(sin(i + time)) + sin(i + time)
            + (if i > 1 then 0.2*sin(sin(i - 1 + time)) else 0)
            + (if i < n then 0.3*sin(sin(i + 1 + time)) else 0);
            exp(x[i]) + x[i] + (if i > 1 then 0.2*sin(x[max(i - 1, 1)]) else 0)
            + (if i < n then 0.3*sin(x[min(i + 1, n)]) else 0) = b[i];
          end for;
          der(y) = -y;
        end Chain;";
    let run = Run::of(text, 1.0);
    let (linear, torn) = loops(&run.program);
    assert!(linear.is_empty() && torn == [80], "{torn:?}");
    for i in [1, 40, 80] {
        run.follows(&format!("x[{i}]"), 1e-9, |t| (t + f64::from(i)).sin());
    }
}

#[test]
fn nodes_may_have_any_number_of_connectors() {
    let text = "model Node
        connector Pin Real v; flow Real i; end Pin;
        model Load Pin p; parameter Real g = 1; equation p.i = g*p.v; end Load;
        model Source Pin p; equation p.v = 2 + time; end Source;
        Source source; Load load[900](g = {1/i for i in 1:900});
        equation
          for i in 1:900 loop connect(load[i].p, source.p); end for;
        end Node;";
    let sum: f64 = (1..=900).map(|i| 1.0 / f64::from(i)).sum();
    Run::of(text, 1.0).follows("source.p.i", 1e-10, |t| -(2.0 + t) * sum);
}

/// A chain of neighbours whose assignments, from one to the next, would multiply rounding errors by
/// 2.6 at every step. The exact solution is cos(i) (1 + time).
fn chain(cubic: &str) -> String {
    format!(
        "model Chain parameter Integer n = 120; Real z[n + 2];
        function c input Integer i; output Real y; algorithm y := cos(i); end c;
        equation
          z[1] = 1 + time;
          for i in 2:n + 1 loop
            3*z[i] - z[i - 1] - z[i + 1] {cubic} = (3 - 2*cos(1))*c(i - 1)*(1 + time);
          end for;
          z[n + 2] = c(n + 1)*(1 + time);
        end Chain;"
    )
}

#[test]
fn errors_do_not_grow_along_the_assignments_of_a_loop() {
    let run = Run::of(&chain(""), 1.0);
    for i in [2, 3, 40, 61, 100, 120, 121] {
        let cosine = f64::from(i - 1).cos();
        run.follows(&format!("z[{i}]"), 1e-9, |t| cosine * (1.0 + t));
    }
    let (linear, torn) = loops(&run.program);
    assert!(torn.is_empty() && linear.iter().all(|n| (2..30).contains(n)), "{linear:?} {torn:?}");
}

#[test]
fn errors_do_not_grow_along_the_assignments_of_a_nonlinear_loop() {
    let run = Run::of(&chain("+ 0.1*(tanh(z[i]) - tanh(c(i - 1)*(1 + time)))"), 1.0);
    for i in [2, 3, 40, 61, 100, 120, 121] {
        let cosine = f64::from(i - 1).cos();
        run.follows(&format!("z[{i}]"), 1e-7, |t| cosine * (1.0 + t));
    }
    let (_, torn) = loops(&run.program);
    assert!(torn.iter().all(|n| (2..30).contains(n)), "{torn:?}");
}

#[test]
fn a_program_grows_with_the_entries_of_a_loop_not_with_their_square() {
    // In each equation all unknowns are squares: none can be solved for, all are iterated.
    let size = |n: usize| {
        let text = format!(
            "model Squares Real z[{n}](each start = 1);
            equation
              z[1]^2 + z[2]^2 + z[1]*z[2] = 3;
              for i in 2:{n} - 1 loop z[i]^2 + z[i - 1]^2 + z[i + 1]^2 = 3 + time; end for;
              z[{n}]^2 + z[{n} - 1]^2 = 2;
            end Squares;"
        );
        let program = program(&text);
        assert_eq!(loops(&program), (vec![], vec![n]));
        program.to_bytes().expect("a program without external functions").len()
    };
    let (small, large) = (size(100), size(400));
    assert!(large < 5 * small, "{small} and {large} bytes");
}
