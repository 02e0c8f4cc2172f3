//! Systems of higher index, from Modelica text, against exact solutions.

use crate::support::simulated::{Run, flat, program};
use gapilib::internals::causalize::causalize;
use gapilib::internals::sim::{Settings, SimErrorKind, simulate};

#[test]
fn a_given_position_determines_speed_and_force() {
    let text = "model Driven Real x; Real v; Real F; parameter Real m = 2;
        equation x = sin(3*time) + time^2; v = der(x); m*der(v) = F; end Driven;";
    let run = Run::of(text, 2.0);
    assert!(run.states().is_empty());
    run.follows("v", 1e-12, |t| 3.0 * (3.0 * t).cos() + 2.0 * t);
    run.follows("F", 1e-12, |t| 2.0 * (2.0 - 9.0 * (3.0 * t).sin()));
}

#[test]
fn a_function_is_differentiated_through_its_body() {
    let text = "model F
          function f input Real u; output Real y; algorithm
            y := u; for i in 1:3 loop y := y + sin(u*i)/i; end for; end f;
          Real x = f(time); Real v = der(x); Real a = der(v);
        end F;";
    let run = Run::of(text, 1.0);
    let v = |t: f64| 1.0 + (1..4).map(|i| (f64::from(i) * t).cos()).sum::<f64>();
    let a = |t: f64| -(1..4).map(|i| f64::from(i) * (f64::from(i) * t).sin()).sum::<f64>();
    run.follows("v", 1e-12, v);
    run.follows("a", 1e-12, a);
}

/// A volume of Modelica.Fluid: its mass and energy are differentiated, its pressure and enthalpy are
/// preferred.
#[test]
fn what_is_not_differentiated_may_be_preferred() {
    let volume = |wish: &str| {
        format!(
            "model Volume parameter Real V = 2; Real p({wish}start = 1); Real h({wish}start = 3);
               Real m; Real U; Real d; Real u; Real y({wish}start = 0) = sin(time) + p;
             initial equation p = 1; h = 3;
             equation m = V*d; U = m*u; u = h - p/d; d = 2*(p + 0.1*p^2)/(1 + h);
               der(m) = 0.5*cos(time) + 1 - p; der(U) = 3*(0.5*cos(time) + 1) - p*h; end Volume;"
        )
    };
    let plain = Run::of(&volume(""), 2.0);
    let preferred = Run::of(&volume("stateSelect = StateSelect.prefer, "), 2.0);
    assert_eq!(plain.states(), ["m", "U"]);
    // `y` follows from `p` and time, and needs no state of its own.
    assert_eq!(preferred.states(), ["p", "h"]);
    for name in ["p", "h", "m", "U"] {
        let (one, other) = (plain.values(name), preferred.values(name));
        for (a, b) in one.iter().zip(&other) {
            assert!((a - b).abs() <= 1e-6 * a.abs(), "{name}: {a}, {b}");
        }
    }
    // Nothing is iterated.
    let loops = |run: &Run| {
        let blocks = run.program.sorted().blocks.iter();
        blocks
            .filter(|block| matches!(block, gapilib::internals::causalize::Block::Loop(_)))
            .count()
    };
    assert_eq!((loops(&plain), loops(&preferred)), (1, 0));
}

/// What jumps at events is no state in the place of what does not.
#[test]
fn a_preferred_variable_that_jumps_is_no_state() {
    for jump in ["if x > 0.5 then 2*x else x", "k*x"] {
        let text = format!(
            "model Jump Real x(start = 0, fixed = true); discrete Real k(start = 1, fixed = true);
               Real y(stateSelect = StateSelect.prefer) = {jump};
             equation der(x) = 1; when time > 0.5 then k = 2; end when; end Jump;"
        );
        let run = Run::of(&text, 1.0);
        assert_eq!(run.states(), ["x"]);
        run.follows("x", 1e-9, |t| t);
        let end = *run.values("y").last().expect("a value");
        assert!((end - 2.0).abs() < 1e-9, "{end}");
    }
}

/// A vessel of Modelica.Fluid without data of its ports: all branches together look as if its pressure
/// was free and its flow given.
#[test]
fn branches_that_are_never_taken_do_not_count() {
    let text = "model Vessel Real p; Real q; Real level = 0; Real height; Boolean is_full; Real s;
        parameter Real C = 2;
        equation
          height = 0; is_full = level >= height; C*der(p) = q;
          if is_full then p = sin(time); s = 1;
          elseif s > 0 then q = s; s = time; else q = 0; s = -1; end if;
        end Vessel;";
    let run = Run::of(text, 2.0);
    assert!(run.states().is_empty());
    run.follows("q", 1e-12, |t| 2.0 * t.cos());
    run.follows("is_full", 0.0, |_| 1.0);
    // What a parameter decides may be set otherwise, and stays.
    let decided = text
        .replace("height = 0;", "height = h;")
        .replace("Real s;", "Real s; parameter Real h = 0;");
    assert_eq!(program(&decided).sorted().states.len(), 1);
}

#[test]
fn rigidly_connected_inertias_move_as_one() {
    let text = "model Shaft
          Real phi1(start = 0.5, fixed = true); Real w1(start = 1, fixed = true); Real phi2; Real w2;
          Real tau; parameter Real J1 = 1; parameter Real J2 = 3; parameter Real k = 16;
        equation der(phi1) = w1; der(phi2) = w2; phi1 = phi2;
          J1*der(w1) = -k*phi1 + tau; J2*der(w2) = -tau; end Shaft;";
    let run = Run::of(text, 3.0);
    assert_eq!(run.states(), ["phi1", "w1"]);
    run.follows("phi2", 1e-6, |t| 0.5 * (2.0 * t).cos() + 0.5 * (2.0 * t).sin());
    run.follows("tau", 1e-5, |t| 6.0 * ((2.0 * t).cos() + (2.0 * t).sin()));
}

#[test]
fn geared_inertias_have_one_degree_of_freedom() {
    let text = "model Gear
          Real phi1(start = 0.6, fixed = true); Real w1(fixed = true); Real phi2; Real w2; Real tau1; Real tau2;
          parameter Real i = -3; parameter Real J1 = 1; parameter Real J2 = 9; parameter Real k = 8;
        equation der(phi1) = w1; der(phi2) = w2; phi1 = i*phi2; 0 = i*tau1 + tau2;
          J1*der(w1) = -k*phi1 + tau1; J2*der(w2) = tau2; end Gear;";
    let run = Run::of(text, 3.0);
    assert_eq!(run.states().len(), 2);
    run.follows("phi2", 1e-6, |t| -0.2 * (2.0 * t).cos());
    run.follows("w2", 1e-6, |t| 0.4 * (2.0 * t).sin());
}

#[test]
fn parallel_capacitors_share_one_state() {
    let text = "model Capacitors parameter Real C1 = 1e-3; parameter Real C2 = 3e-3; parameter Real R = 50;
          Real v1(start = 0); Real v2; Real i1; Real i2; Real i;
        equation C1*der(v1) = i1; C2*der(v2) = i2; i = i1 + i2; v1 - 2 = v2 - 2; 10 - v1 = R*i; end Capacitors;";
    let run = Run::of(text, 0.5);
    assert_eq!(run.states().len(), 1);
    run.follows("v2", 1e-6, |t| 10.0 * (1.0 - (-5.0 * t).exp()));
    run.follows("i2", 1e-6, |t| 0.15 * (-5.0 * t).exp());
}

#[test]
fn inductors_in_series_share_one_state() {
    let text = "model Inductors parameter Real L1 = 1; parameter Real L2 = 4; Real i1(start = 0, fixed = true);
          Real i2; Real i3; Real u1; Real u2; parameter Real R = 10;
        equation L1*der(i1) = u1; L2*der(i2) = u2; i1 = i2 + i3; i3 = 0.2*time; 10 = u1 + u2 + R*i1; end Inductors;";
    let run = Run::of(text, 2.0);
    // 5 i1' = 10 - 10 i1 + 0.8
    run.follows("i1", 1e-6, |t| 1.08 * (1.0 - (-2.0 * t).exp()));
    run.follows("i2", 1e-6, |t| 1.08 * (1.0 - (-2.0 * t).exp()) - 0.2 * t);
}

#[test]
fn two_integrals_of_one_variable_keep_their_own_values() {
    let text = "model Twice Real x(start = 1, fixed = true); Real y(start = 5, fixed = true); Real v; Real z;
        equation der(x) = v; der(y) = v; z = x + y; z = 6 + time^2; end Twice;";
    let run = Run::of(text, 2.0);
    run.follows("x", 1e-9, |t| 1.0 + 0.5 * t * t);
    run.follows("v", 1e-9, |t| t);
}

const PENDULUM: &str = "model Pendulum parameter Real L = 2; parameter Real g = 9.81; parameter Real m = 0.5;
      Real x(start = 1.2, fixed = true); Real y(start = -1.6); Real u(start = 0, fixed = true); Real v; Real F;
      Real phi(start = asin(0.6), fixed = true); Real w(start = 0, fixed = true);
    equation der(x) = u; der(y) = v; m*der(u) = -F*x/L; m*der(v) = -F*y/L - m*g; x^2 + y^2 = L^2;
      der(phi) = w; L*der(w) = -g*sin(phi); end Pendulum;";

#[test]
fn a_pendulum_in_cartesian_coordinates_swings_as_in_its_angle() {
    let run = Run::of(PENDULUM, 5.0);
    assert_eq!(run.states().len(), 4);
    let of = |name| run.values(name);
    for ((x, y), phi) in of("x").iter().zip(of("y")).zip(of("phi")) {
        assert!((x * x + y * y - 4.0).abs() < 1e-7, "the constraint drifts: {x}, {y}");
        assert!((x - 2.0 * phi.sin()).abs() < 1e-6, "{x} instead of {}", 2.0 * phi.sin());
    }
    for ((f, w), phi) in of("F").iter().zip(of("w")).zip(of("phi")) {
        let expected = 0.5 * 9.81 * phi.cos() + 0.5 * 2.0 * w * w;
        assert!((f - expected).abs() < 1e-4, "{f} instead of {expected}");
    }
}

#[test]
fn the_attribute_state_select_decides() {
    let text = |a: &str, b: &str| {
        format!(
            "model S Real x(start = 1, stateSelect = StateSelect.{a}); Real y(start = 0.5, stateSelect = StateSelect.{b});
             Real f; equation der(x) = -2*x + f; der(y) = -f; x = 2*y; end S;"
        )
    };
    for (a, b, expected) in [
        ("prefer", "default", "x"),
        ("default", "prefer", "y"),
        ("never", "default", "y"),
        ("default", "avoid", "x"),
        ("always", "prefer", "x"),
        ("default", "default", "x"),
    ] {
        let run = Run::of(&text(a, b), 1.0);
        assert_eq!(run.states(), [expected], "{a} {b}");
        // 1.5 x' = -2 x
        run.follows("y", 1e-6, |t| 0.5 * (-4.0 / 3.0 * t).exp());
    }
}

#[test]
fn redundant_initial_values_must_agree() {
    let text = |second: f64| {
        format!(
            "model R Real x(start = 1, fixed = true); Real y(start = {second}, fixed = true); Real f;
             equation der(x) = -2*x + f; der(y) = -f; x = 2*y; end R;"
        )
    };
    Run::of(&text(0.5), 1.0).follows("x", 1e-6, |t| (-4.0 / 3.0 * t).exp());
    let program = program(&text(0.7));
    let error = simulate(&mut program.system(), &Settings::default()).unwrap_err();
    assert!(matches!(error.kind, SimErrorKind::Initialization(_)), "{error:?}");
    assert_eq!(program.explain(&error).code.slug, "initialization-failed");
    let alias = crate::support::simulated::program(
        "model A Real x(start = 1, fixed = true); Real y(start = 2, fixed = true);
         equation der(x) = -x; y = x; end A;",
    );
    assert!(simulate(&mut alias.system(), &Settings::default()).is_err());
}

#[test]
fn no_number_of_differentiations_makes_a_singular_system_regular() {
    let text =
        "model M Real x; Real y; Real z; equation der(x) = 1; x = time; z = y + time; end M;";
    let error = causalize(&flat(text).expect("a model")).expect_err("it is singular");
    assert_eq!(error.code.slug, "singular-system", "{error}");
}

#[test]
fn missing_initial_values_are_taken_from_start_and_named() {
    let text = "model W Real x(start = 1, fixed = true); Real y(start = 2); Real z(start = 3);
        equation der(x) = y; der(y) = -x; der(z) = 0; initial equation der(y) = y; end W;";
    let run = Run::of(text, 1.0);
    run.follows("y", 1e-6, |t| -t.cos() - t.sin());
    let warnings: Vec<_> = run.program.warnings().iter().map(|w| w.message.clone()).collect();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains("`z`") && !warnings[0].contains("`y`"), "{warnings:?}");
}

/// A pendulum of length 1 that starts level, beside its angle from below.
fn falling(speed: f64) -> String {
    format!(
        "model Falling parameter Real g = 9.81; Real x(start = 1, fixed = true); Real y(start = 0); Real u; Real v(start = {speed}, fixed = true);
           Real F; Real phi(start = asin(1.0), fixed = true); Real w(start = {speed}, fixed = true); Real E;
         equation der(x) = u; der(y) = v; der(u) = -F*x; der(v) = -F*y - g; x^2 + y^2 = 1;
           der(phi) = w; der(w) = -g*sin(phi); E = (u^2 + v^2)/2 + g*y; end Falling;"
    )
}

#[test]
fn a_pendulum_passes_points_where_one_coordinate_determines_nothing() {
    // Through the lowest point and back, and all the way round.
    for (speed, tolerance) in [(0.0, 1e-5), (-6.0, 1e-5), (8.0, 1e-5)] {
        let run = Run::of(&falling(speed), 4.0);
        let of = |name| run.values(name);
        for ((x, y), phi) in of("x").iter().zip(of("y")).zip(of("phi")) {
            assert!((x * x + y * y - 1.0).abs() < 1e-7, "the constraint drifts: {x}, {y}");
            assert!((x - phi.sin()).abs() < tolerance, "{x} instead of {}", phi.sin());
            assert!((y + phi.cos()).abs() < tolerance, "{y} instead of {}", -phi.cos());
        }
        let energy = of("E");
        assert!(energy.iter().all(|e| (e - energy[0]).abs() < 1e-4), "{energy:?}");
    }
}

/// Two pendulums of length 1 and mass 1, one hanging from the other, beside their angles.
const DOUBLE: &str = include_str!("../../data/models/index_reduction_double.mo");

#[test]
fn a_double_pendulum_moves_as_in_its_angles() {
    let run = Run::of(DOUBLE, 2.0);
    let of = |name| run.values(name);
    let angles = of("a").into_iter().zip(of("b"));
    let points = of("x1").into_iter().zip(of("y1")).zip(of("x2").into_iter().zip(of("y2")));
    for ((a, b), ((x1, y1), (x2, y2))) in angles.zip(points) {
        assert!((x1 * x1 + y1 * y1 - 1.0).abs() < 1e-7, "the first rod changes its length");
        let far = [(x1, a.sin()), (y1, -a.cos()), (x2 - x1, b.sin()), (y2 - y1, -b.cos())];
        assert!(far.iter().all(|(x, e)| (x - e).abs() < 1e-4), "{far:?}");
    }
}

#[test]
fn a_choice_that_the_user_makes_or_that_never_fails_stays() {
    // y = f(x) determines y whatever x is.
    let slide = "model Slide Real x(start = 1, fixed = true); Real y; Real u(start = 0, fixed = true); Real v; Real F;
        equation der(x) = u; der(y) = v; y = x^2/2; der(u) = -F*x; der(v) = F - 9.81; end Slide;";
    let run = Run::of(slide, 1.0);
    assert_eq!(run.states(), ["x", "u"]);
    let energy = |at: usize| {
        let of = |name| run.values(name)[at];
        (of("u").powi(2) + of("v").powi(2)) / 2.0 + 9.81 * of("y")
    };
    assert!((energy(500) - energy(0)).abs() < 1e-5);
    // The angle is preferred to coordinates.
    let angle = "model Angle Real x; Real y; Real u; Real v; Real F;
          Real phi(start = 0.5, fixed = true, stateSelect = StateSelect.prefer);
          Real w(start = 0, fixed = true, stateSelect = StateSelect.prefer);
        equation x = sin(phi); y = -cos(phi); der(phi) = w; der(x) = u; der(y) = v;
          der(u) = -F*x; der(v) = -F*y - 9.81; end Angle;";
    assert_eq!(Run::of(angle, 2.0).states(), ["phi", "w"]);
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig {
        rng_seed: proptest::test_runner::RngSeed::Fixed(7),
        ..proptest::prelude::ProptestConfig::with_cases(16)
    })]

    /// A train of gears is one inertia on a spring.
    #[test]
    fn trains_of_gears_oscillate_as_one_inertia(
        gears in proptest::collection::vec((0.3f64..3.0, 0.2f64..5.0, proptest::bool::ANY), 1..6),
        wanted in 0usize..6,
    ) {
        let n = gears.len() + 1;
        let ratios: Vec<f64> =
            gears.iter().map(|(ratio, _, reversed)| if *reversed { -ratio } else { *ratio }).collect();
        let list = |values: &[f64]| {
            let texts: Vec<String> = values.iter().map(|v| format!("{v:?}")).collect();
            format!("{{{}}}", texts.join(", "))
        };
        let inertias: Vec<f64> = std::iter::once(1.0).chain(gears.iter().map(|g| g.1)).collect();
        let wishes: Vec<&str> =
            (0..n).map(|i| if i == wanted { "StateSelect.prefer" } else { "StateSelect.default" }).collect();
        let text = format!(
            "model Train parameter Real J[{n}] = {}; parameter Real r[{}] = {}; parameter Real k = 4;
               Real phi[{n}](stateSelect = {{{}}}); Real w[{n}]; Real a[{n}]; Real b[{n}];
             equation
               for i in 1:{n} loop der(phi[i]) = w[i]; J[i]*der(w[i]) = a[i] - b[i]; end for;
               for i in 1:{n}-1 loop phi[i] = r[i]*phi[i+1]; a[i+1] = r[i]*b[i]; end for;
               a[1] = -k*phi[1]; b[{n}] = 0;
             initial equation phi[1] = 1; w[1] = 0; end Train;",
            list(&inertias), n - 1, list(&ratios), wishes.join(", ")
        );
        let run = Run::of(&text, 2.0);
        proptest::prop_assert_eq!(run.states().len(), 2);
        if wanted < n {
            let name = format!("phi[{}]", wanted + 1);
            proptest::prop_assert!(run.states().contains(&name.as_str()));
        }
        let mut whole = 1.0;
        let mut transmission = 1.0;
        for (ratio, inertia) in ratios.iter().zip(&inertias[1..]) {
            transmission /= ratio;
            whole += inertia * transmission * transmission;
        }
        let omega = (4.0f64 / whole).sqrt();
        run.follows("phi[1]", 1e-5, |t| (omega * t).cos());
    }
}
