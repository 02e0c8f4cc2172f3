//! The models of fuel cells against voltages computed independently, and what they must conserve.

use crate::support::shipped;

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
        0.5e-4,
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

/// The tables of the models' documentation.
#[test]
fn corrected_cells_have_the_documented_voltages() {
    let fc2 = [(1e-2, 0.7726933), (5e-4, 0.3748005), (1.4e-4, 0.1994044)];
    voltages("FuelCellLib.casestudies.FC2Layer", 2e-7, &fc2);
    let fc3 = [(1e-2, 0.7726916), (1e-3, 0.4743842), (1.4e-4, 0.1993318)];
    let coarse = "FuelCellLib.casestudies.FC3Layer(dif_layer1(n = 10, da = 210e-6/11))";
    voltages(coarse, 2e-7, &fc3);
}

/// The protons that leave the anode are the electrons that arrive at the cathode, and every four
/// of them consume one molecule of oxygen, every two form a molecule of water, which in the end
/// leaves through both collectors.
#[test]
fn charge_oxygen_and_water_are_conserved() {
    let names = [
        "col_mem1.exa1.jp",
        "col_cat1.exa1.je",
        "RL1.i",
        "col_cat1.exa1.j",
        "col_mem1.exa1.jwg",
        "col_mem1.exa1.jwl",
        "col_cat1.exa1.jwg",
        "col_cat1.exa1.jwl",
    ];
    for model in ["FC2Layer", "FC3Layer"] {
        let full = format!("FuelCellLib.casestudies.{model}");
        for values in finals(&full, 10.0, "RL1.R", &[1e-3], &names) {
            let current = values[2].abs();
            for given in &values[..2] {
                assert!((given.abs() - current).abs() < 1e-7 * current, "{model}: {values:?}");
            }
            let oxygen = current / (4.0 * 96485.0);
            assert!((values[3].abs() - oxygen).abs() < 1e-7 * oxygen, "{model}: {values:?}");
            let water: f64 = values[4..].iter().sum();
            assert!((water.abs() - 2.0 * oxygen).abs() < 2e-7 * oxygen, "{model}: {values:?}");
        }
    }
}

/// The trajectories of some variables at given times, `[variables, times]`. Interval divides them.
fn trajectories(
    source: &str,
    model: &str,
    interval: f64,
    times: &[f64],
    names: &[&str],
) -> Vec<Vec<f64>> {
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    let columns: Vec<String> = times.iter().map(|time| format!("{time}")).collect();
    let script = format!(
        "openModel(\"Test.mo\");\n\
         ok := simulateModel(\"{model}\", stopTime={}, outputInterval={interval}, tolerance=1e-7, \
         resultFile=\"result\");\n\
         at := interpolateTrajectory(\"result.mat\", {{{}}}, {{{}}});\n",
        times.last().expect("times"),
        quoted.join(", "),
        columns.join(", ")
    );
    let world = shipped::world().with_file("Test.mo", source).with_file("test.mos", script);
    let run = shipped::run_in(world, "test.mos");
    assert_eq!(run.errors, "", "{model}");
    let at = run.session.variable("at").expect("assigned");
    at.as_reals().expect("numbers").chunks(times.len()).map(<[f64]>::to_vec).collect()
}

/// Times in s and voltages computed with an independent program at a tolerance of 1e-10.
#[track_caller]
fn follows(model: &str, interval: f64, expected: &[(f64, f64)]) {
    let source = format!("model Test extends {model}; end Test;");
    let times: Vec<f64> = expected.iter().map(|(time, _)| *time).collect();
    let given = trajectories(&source, "Test", interval, &times, &["V"]).remove(0);
    for ((time, expected), given) in expected.iter().zip(given) {
        assert!((given - expected).abs() < 1.2e-6, "{time} s: {given} V, not {expected} V");
    }
}

#[test]
fn load_steps_have_the_reference_voltages() {
    follows(
        "CaseStudies.LoadSteps",
        0.1,
        &[
            (0.5, 1.061338),
            (4.5, 1.059950),
            (5.2, 0.995814),
            (5.5, 0.944975),
            (6.0, 0.905634),
            (11.5, 0.889470),
            (12.2, 0.940657),
            (13.0, 1.011386),
            (19.5, 1.059745),
            (20.5, 0.944915),
            (24.5, 0.889471),
        ],
    );
}

/// The layers of `FuelCellLib`, with moving gases, on a finer mesh; and the same without gases.
#[test]
fn load_steps_with_gases_have_the_reference_voltages() {
    let times = [(2.0, 1.060301), (5.2, 0.995846), (6.0, 0.905662), (7.0, 0.890621)];
    follows("CaseStudies.LoadSteps(n = 20)", 0.1, &times);
    follows(
        "CaseStudies.LoadStepsWithGases(act_layer1(n = 20, da = 11e-6/21), \
         mem_layer1(n = 20, da = 110e-6/21))",
        0.1,
        &times,
    );
}

#[test]
fn water_effect_has_the_reference_voltages() {
    let times = [
        (60.0, 0.789282),
        (300.0, 0.802184),
        (900.0, 0.812457),
        (2100.0, 0.817400),
        (3000.0, 0.817102),
        (4200.0, 0.806248),
        (6000.0, 0.783527),
        (9000.0, 0.771614),
    ];
    follows("CaseStudies.WaterEffect", 60.0, &times);
}

#[test]
fn water_effect_on_a_finer_mesh_has_the_reference_voltages() {
    let times = [(300.0, 0.802200), (2100.0, 0.817412), (4200.0, 0.806164), (9000.0, 0.771472)];
    follows("CaseStudies.WaterEffect(n = 20)", 60.0, &times);
}

/// Water in mol/m2: what the anode gave and the reaction formed, less what left through the
/// channel, is what the membrane and the pores hold more than at the start.
#[test]
fn water_is_conserved() {
    let source = include_str!("../../data/models/fuel_cells_water.mo");
    let names = ["anodeGave", "formed", "left", "held"];
    let rows = trajectories(source, "Test", 60.0, &[0.0, 9000.0], &names);
    let [gave, formed, left, held] = [0, 1, 2, 3].map(|row| rows[row][1] - rows[row][0]);
    assert!((gave - 2.83599).abs() < 2e-5 && (formed - 1.85763).abs() < 2e-5, "{gave} {formed}");
    assert!((left - 1.06526).abs() < 2e-5 && (held - 3.62835).abs() < 2e-5, "{left} {held}");
    assert!((gave + formed - left - held).abs() < 2e-5, "{gave} {formed} {left} {held}");
}

/// The generator's first numbers (12345 six times) times the period are the times between changes.
#[test]
fn pseudo_random_load_follows_the_generator() {
    let source = "model Test
        FuelCellLib.Basics.Loads.PRB_Load load;
        Modelica.Electrical.Analog.Sources.ConstantVoltage source(V = 1);
        Modelica.Electrical.Analog.Basic.Ground ground;
      equation
        connect(source.p, load.p); connect(source.n, load.n); connect(source.n, ground.p);
      end Test;";
    let times = [1.2, 1.3, 4.4, 4.5, 7.5, 7.6, 15.8, 15.9];
    let given = trajectories(source, "Test", 0.1, &times, &["load.R"]).remove(0);
    assert_eq!(given, [1.0, 0.01, 0.01, 1.0, 1.0, 0.01, 0.01, 1.0]);
}
