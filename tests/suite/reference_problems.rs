//! Problems of the test set of Bari (Mazzia & Magherini) as Modelica models, against the published
//! reference solutions.

use super::index_reduction::Run;
use gapilib::sim::{Settings, find_integrator};

/// Two transistors; node voltages `y`, the capacitors between nodes written as components.
const AMPLIFIER: &str = "model Amplifier
      parameter Real Ub = 6; parameter Real UF = 0.026; parameter Real alpha = 0.99; parameter Real beta = 1e-6;
      parameter Real R0 = 1000; parameter Real R = 9000; parameter Real C[5] = {1e-6, 2e-6, 3e-6, 4e-6, 5e-6};
      Real y[8]; Real Ue; Real g1; Real g2;
      Real u1(start = -3, fixed = true); Real u3(start = 3, fixed = true); Real u5(start = 6, fixed = true);
      Real u2(start = 3, fixed = true); Real u4(start = 3, fixed = true);
      Real i1; Real i3; Real i5;
    equation
      Ue = 0.1*sin(628.3185307179586*time);
      g1 = beta*(exp((y[2] - y[3])/UF) - 1); g2 = beta*(exp((y[5] - y[6])/UF) - 1);
      u1 = y[1] - y[2]; u2 = y[3]; u3 = y[4] - y[5]; u4 = y[6]; u5 = y[7] - y[8];
      i1 = C[1]*der(u1); i3 = C[3]*der(u3); i5 = C[5]*der(u5);
      -i1 = (y[1] - Ue)/R0;
      i1 = -Ub/R + 2*y[2]/R - (alpha - 1)*g1;
      -C[2]*der(u2) = -g1 + y[3]/R;
      -i3 = (y[4] - Ub)/R + alpha*g1;
      i3 = -Ub/R + 2*y[5]/R - (alpha - 1)*g2;
      -C[4]*der(u4) = -g2 + y[6]/R;
      -i5 = (y[7] - Ub)/R + alpha*g2;
      i5 = y[8]/R;
    end Amplifier;";

const AMPLIFIER_END: [f64; 8] = [
    -0.5562145012262709e-2,
    0.3006522471903042e1,
    0.2849958788608128e1,
    0.2926422536206241e1,
    0.2704617865010554e1,
    0.2761837778393145e1,
    0.4770927631616772e1,
    0.1236995868091548e1,
];

/// The largest error at the end, relative to max(|reference|, 1).
fn error_at_end(text: &str, names: &[&str], reference: &[f64], settings: Settings) -> f64 {
    let run = Run::with(text, settings);
    let end = |name: &str| *run.values(name).last().expect("a row");
    let pairs = names.iter().zip(reference);
    pairs.map(|(name, e)| (end(name) - e).abs() / e.abs().max(1.0)).fold(0.0, f64::max)
}

#[test]
fn the_transistor_amplifier_reaches_its_reference_solution() {
    let names = ["y[1]", "y[2]", "y[3]", "y[4]", "y[5]", "y[6]", "y[7]", "y[8]"];
    for method in ["dassl", "rodas4", "radau"] {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let method_entry = find_integrator(method).expect("a method");
            let settings =
                Settings { stop: 0.2, tolerance, method: method_entry, ..Settings::default() };
            let error = error_at_end(AMPLIFIER, &names, &AMPLIFIER_END, settings);
            assert!(error < 50.0 * tolerance, "{method} at {tolerance:e}: {error:e}");
        }
    }
}

/// The pendulum in Cartesian coordinates, index 3, falling from the height of its pivot.
const PENDULUM: &str = "model Pendulum Real x(start = 1, fixed = true); Real y(start = 0); Real u; Real v(start = 0, fixed = true);
      Real F; equation der(x) = u; der(y) = v; der(u) = -F*x; der(v) = -F*y - 9.81; x^2 + y^2 = 1; end Pendulum;";

#[test]
fn a_pendulum_of_index_three_is_solved_by_every_implicit_method() {
    // After half a period it stands level on the other side; the quarter period is the complete
    // elliptic integral at modulus sin(π/4) over √g.
    let half = 2.0 * 1.854_074_677_301_371_9 / 9.81f64.sqrt();
    for method in ["dassl", "rodas4", "radau", "dopri5"] {
        let method_entry = find_integrator(method).expect("a method");
        let settings =
            Settings { stop: half, tolerance: 1e-8, method: method_entry, ..Settings::default() };
        let error = error_at_end(PENDULUM, &["x", "y"], &[-1.0, 0.0], settings);
        assert!(error < 1e-5, "{method}: {error:e}");
    }
}
