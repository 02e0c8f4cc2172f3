//! The models of fuel cells against voltages computed independently, and what they must conserve.

use crate::shipped;

/// Final values of variables of a model at several values of one parameter, `[values, variables]`.
fn finals(
    model: &str,
    stop: f64,
    parameter: &str,
    values: &[f64],
    names: &[&str],
) -> Vec<Vec<f64>> {
    let texts: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    let (count, width) = (values.len(), names.len());
    let script = format!(
        "values := {{{}}};\nlast := zeros({count}, {width});\nfor k in 1:{count} loop\n  \
         (ok, row) := simulateExtendedModel(\"{model}\", stopTime={stop}, tolerance=1e-6, \
         initialNames={{\"{parameter}\"}}, initialValues={{values[k]}}, finalNames={{{}}});\n  \
         last[k,:] := row;\nend for;\n",
        texts.join(", "),
        quoted.join(", ")
    );
    let run = shipped::run("test.mos", &script);
    assert_eq!(run.errors, "", "{model}");
    let last = run.session.variable("last").expect("assigned");
    let last = last.as_reals().expect("numbers").into_owned();
    last.chunks(names.len()).map(<[f64]>::to_vec).collect()
}

/// Resistances of the load in Ohm.m2 and voltages.
#[track_caller]
fn voltages(model: &str, tolerance: f64, expected: &[(f64, f64)]) {
    let loads: Vec<f64> = expected.iter().map(|(load, _)| *load).collect();
    let given = finals(model, 0.5, "RL1.R", &loads, &["V"]);
    for ((load, expected), given) in expected.iter().zip(given) {
        let error = (given[0] - expected).abs();
        assert!(error <= tolerance, "{model}, R = {load}: {} V, not {expected} V", given[0]);
    }
}

#[test]
fn legacy_has_the_voltages_of_the_original() {
    voltages(
        "FuelCellLib.casestudies.FC2Layer(legacy = true)",
        0.5e-4,
        &[
            (1.02, 1.0524),
            (0.1, 0.9877),
            (0.02, 0.8619),
            (0.01, 0.7902),
            (3e-3, 0.6550),
            (1.5e-3, 0.5756),
            (1e-3, 0.5297),
            (5e-4, 0.4531),
            (3e-4, 0.3991),
            (2.4e-4, 0.3763),
            (1.4e-4, 0.3241),
        ],
    );
}

/// Four corrections alone: what an independent solution of the same equations gives.
#[test]
fn corrections_one_by_one_have_the_reference_voltages() {
    voltages(
        "FuelCellLib.casestudies.FC2Layer(legacy = true, corrections(ionicCircuit = true, \
         limitSign = true, gasStorage = true, latentHeat = true))",
        0.6e-4,
        &[
            (1.02, 1.0523),
            (0.1, 0.9867),
            (0.02, 0.8574),
            (0.01, 0.7821),
            (3e-3, 0.6338),
            (1.5e-3, 0.5406),
            (1e-3, 0.4836),
            (5e-4, 0.3830),
            (3e-4, 0.3086),
            (1.4e-4, 0.2048),
        ],
    );
}

/// Voltages at n = 10, 20, 40 per layer of the same thickness: second order in the size of a volume.
#[test]
fn voltage_converges_with_the_mesh() {
    let voltage = |n: usize| {
        let (active, membrane) = (11e-6 / (n + 1) as f64, 110e-6 / (n + 1) as f64);
        let model = format!(
            "FuelCellLib.casestudies.FC2Layer(act_layer1(n = {n}, da = {active:e}), \
             mem_layer1(n = {n}, da = {membrane:e}))"
        );
        finals(&model, 0.5, "RL1.R", &[5e-4], &["V"])[0][0]
    };
    let [coarse, middle, fine] = [10, 20, 40].map(voltage);
    let order = ((coarse - middle) / (middle - fine)).abs().log2();
    assert!((coarse - fine).abs() < 3e-4, "{coarse} {middle} {fine}");
    assert!((1.7..2.3).contains(&order), "order {order}: {coarse} {middle} {fine}");
}

/// The protons that leave the anode are the electrons that arrive at the cathode, and every four
/// of them consume one molecule of oxygen.
#[test]
fn charge_and_oxygen_are_conserved() {
    for model in ["FC2Layer", "FC3Layer"] {
        let names = ["col_mem1.exa1.jp", "col_cat1.exa1.je", "RL1.i", "col_cat1.exa1.j"];
        let full = format!("FuelCellLib.casestudies.{model}");
        for values in finals(&full, 0.5, "RL1.R", &[1e-3, 1e-1], &names) {
            let current = values[2].abs();
            for given in &values[..2] {
                assert!((given.abs() - current).abs() < 1e-7 * current, "{model}: {values:?}");
            }
            let oxygen = current / (4.0 * 96485.0);
            assert!((values[3].abs() - oxygen).abs() < 1e-4 * oxygen, "{model}: {values:?}");
        }
    }
}
