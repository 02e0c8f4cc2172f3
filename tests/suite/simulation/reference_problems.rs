//! The problems of the test set for initial value solvers of Bari (Mazzia & Magherini) as Modelica
//! models in `tests/simulation/test_set`, against the published reference solutions: significant
//! correct digits, the least of all components, and evaluations of the right-hand side at three
//! tolerances. `cargo test reference_problems -- --nocapture` prints them.

use crate::support::simulated::{program, simulated_with};
use gapilib::internals::codegen::{Access, Program};
use gapilib::internals::sim::{OutputGrid, Settings, Statistics, find_integrator, simulate};
use std::sync::Arc;

/// The tolerances of all rows.
const TOLERANCES: [f64; 3] = [1e-4, 1e-6, 1e-8];

/// A problem with its solution at the end.
struct Problem {
    /// File and class.
    name: &'static str,
    stop: f64,
    /// What is compared, and with what.
    variables: &'static str,
    reference: &'static [f64],
    /// What errors are relative to where the reference is smaller.
    scale: f64,
}

const ROBERTSON: Problem = Problem {
    name: "Robertson",
    stop: 1e11,
    variables: "y1 y2 y3",
    reference: &[0.208_334_014_970_122_37e-7, 0.833_336_077_033_471_3e-13, 0.999_999_979_166_505_1],
    scale: 0.0,
};

const VAN_DER_POL: Problem = Problem {
    name: "VanDerPol",
    stop: 2.0,
    variables: "y1 y2",
    reference: &[1.706_167_732_170_483, -0.892_809_701_024_797_5],
    scale: 0.0,
};

const HIRES: Problem = Problem {
    name: "Hires",
    stop: 321.8122,
    variables: "y[1] y[2] y[3] y[4] y[5] y[6] y[7] y[8]",
    reference: &[
        0.737_131_257_332_566_8e-3,
        0.144_248_572_631_618_5e-3,
        0.588_872_974_096_757_5e-4,
        0.117_565_134_328_314_9e-2,
        0.238_635_619_883_133_1e-2,
        0.623_896_825_274_279_6e-2,
        0.284_999_839_518_576_9e-2,
        0.285_000_160_481_423_1e-2,
    ],
    scale: 0.0,
};

const POLLUTION: Problem = Problem {
    name: "Pollution",
    stop: 60.0,
    variables: "y[1] y[2] y[3] y[4] y[5] y[6] y[7] y[8] y[9] y[10] y[11] y[12] y[13] y[14] y[15] \
        y[16] y[17] y[18] y[19] y[20]",
    reference: &[
        0.564_625_548_002_276_9e-1,
        0.134_248_413_042_233_9,
        0.413_973_433_109_942_7e-8,
        0.552_314_020_748_435_9e-2,
        0.201_897_726_230_219_6e-6,
        0.146_454_186_349_396_6e-6,
        0.778_424_911_899_796_4e-1,
        0.324_507_535_339_601_8,
        0.749_401_338_388_040_6e-2,
        0.162_229_315_730_156_1e-7,
        0.113_586_383_325_707_5e-7,
        0.223_050_597_572_135_9e-2,
        0.208_716_288_279_863e-3,
        0.139_692_101_684_015_8e-4,
        0.896_488_485_689_829_5e-2,
        0.435_284_636_933_010_3e-17,
        0.689_921_969_626_340_5e-2,
        0.100_780_303_736_594_6e-3,
        0.177_214_651_396_998_4e-5,
        0.568_294_329_231_639_2e-4,
    ],
    scale: 0.0,
};

const AMPLIFIER: Problem = Problem {
    name: "TransistorAmplifier",
    stop: 0.2,
    variables: "y[1] y[2] y[3] y[4] y[5] y[6] y[7] y[8]",
    reference: &[
        -0.556_214_501_226_270_9e-2,
        0.300_652_247_190_304_2e1,
        0.284_995_878_860_812_8e1,
        0.292_642_253_620_624_1e1,
        0.270_461_786_501_055_4e1,
        0.276_183_777_839_314_5e1,
        0.477_092_763_161_677_2e1,
        0.123_699_586_809_154_8e1,
    ],
    scale: 0.0,
};

const RING_MODULATOR: Problem = Problem {
    name: "RingModulator",
    stop: 1e-3,
    variables: "y[1] y[2] y[3] y[4] y[5] y[6] y[7] y[8] y[9] y[10] y[11] y[12] y[13] y[14] y[15]",
    reference: &[
        -0.233_905_735_848_674_5e-1,
        -0.736_748_548_554_082_5e-2,
        0.258_295_670_929_116_9,
        -0.406_446_572_128_345,
        -0.403_945_566_514_979_4,
        0.260_796_676_542_294_3,
        0.110_676_186_126_997_5,
        0.293_990_434_243_559_6e-6,
        -0.284_002_993_364_232_9e-7,
        0.726_719_826_726_455_3e-3,
        0.792_948_719_696_084e-3,
        -0.725_528_349_569_896_5e-3,
        -0.794_140_196_852_652_1e-3,
        0.708_849_541_697_611_4e-4,
        0.239_005_907_523_657e-4,
    ],
    scale: 0.0,
};

const SQUEEZING_MECHANISM: Problem = Problem {
    name: "SqueezingMechanism",
    stop: 0.03,
    variables: "beta Theta gamma Phi delta Omega epsilon",
    reference: &[
        0.158_107_711_962_990_4e2,
        -0.157_563_710_598_429_8e2,
        0.408_222_401_307_310_1e-1,
        -0.534_730_116_322_694_8,
        0.524_409_965_880_530_4,
        0.534_730_116_322_694_8,
        0.104_808_074_104_226_3e1,
    ],
    scale: 0.0,
};

const CHARGE_PUMP: Problem = Problem {
    name: "ChargePump",
    stop: 1.2e-6,
    variables: "QG vs vd",
    reference: &[0.126_280_042_987_675_93e-12, 0.0, 0.0],
    scale: 1.0,
};

impl Problem {
    fn program(&self) -> Arc<Program> {
        let root = env!("CARGO_MANIFEST_DIR");
        let file = format!("{root}/tests/simulation/test_set/{}.mo", self.name);
        program(&std::fs::read_to_string(file).expect("a model"))
    }

    /// Significant correct digits at the end, and what they cost.
    fn digits(&self, program: &Arc<Program>, settings: &Settings) -> (f64, Statistics) {
        let mut system = program.system();
        let (trajectory, statistics) = simulate(&mut system, settings)
            .unwrap_or_else(|error| panic!("{}: {}", self.name, program.explain(&error)));
        let end = |name: &str| {
            let at = program.find_variable(name).expect("the variable exists");
            let Access::Observed { column, negated } = program.variables()[at].access else {
                panic!("{name} is not observed")
            };
            let value = *trajectory.column(column).last().expect("a row");
            if negated { -value } else { value }
        };
        let pairs = self.variables.split_whitespace().zip(self.reference);
        let worst = pairs
            .map(|(name, e)| (end(name) - e).abs() / e.abs().max(self.scale))
            .fold(0.0, f64::max);
        (-worst.log10(), statistics)
    }
}

/// Runs a problem with a method at the three tolerances; at each it must reach the digits with no
/// more evaluations than given.
#[track_caller]
#[allow(clippy::print_stdout)]
fn reaches(problem: &Problem, rows: &[(&str, [(f64, u64); 3])]) {
    let program = problem.program();
    for (method, bounds) in rows {
        for (tolerance, (digits, evaluations)) in TOLERANCES.into_iter().zip(bounds) {
            let settings = Settings {
                stop: problem.stop,
                tolerance,
                method: find_integrator(method).expect("a method"),
                output: OutputGrid::At(vec![problem.stop]),
                ..Settings::default()
            };
            let (reached, cost) = problem.digits(&program, &settings);
            println!(
                "{:20} {method:7} {tolerance:7.0e} {reached:5.2} digits {:6} steps {:4} rejected {:7} evaluations {:5} Jacobians",
                problem.name,
                cost.steps,
                cost.error_failures + cost.newton_failures,
                cost.rhs_evaluations,
                cost.jacobian_evaluations
            );
            let seen = format!("{} by {method} at {tolerance:e}: {reached} digits", problem.name);
            assert!(reached >= *digits, "{seen}");
            assert!(
                cost.rhs_evaluations <= *evaluations,
                "{seen}, {} evaluations",
                cost.rhs_evaluations
            );
        }
    }
}

#[test]
fn robertson() {
    reaches(
        &ROBERTSON,
        &[
            ("dassl", [(4.0, 1_500), (5.7, 2_700), (7.2, 5_400)]),
            ("rodas4", [(5.3, 1_600), (7.3, 4_400), (9.3, 17_000)]),
            ("radau", [(5.1, 2_200), (7.1, 6_000), (8.9, 18_000)]),
        ],
    );
}

#[test]
fn van_der_pol() {
    reaches(
        &VAN_DER_POL,
        &[
            ("dassl", [(4.3, 2_000), (5.1, 3_500), (7.0, 7_200)]),
            ("rodas4", [(5.0, 3_700), (7.0, 11_000), (10.0, 54_000)]),
            ("radau", [(5.6, 4_300), (8.0, 9_200), (10.3, 26_000)]),
        ],
    );
}

#[test]
fn hires() {
    reaches(
        &HIRES,
        &[
            ("dassl", [(2.6, 520), (4.8, 920), (6.5, 2_000)]),
            ("rodas4", [(4.4, 840), (6.2, 3_000), (8.8, 15_000)]),
            ("radau", [(4.2, 1_300), (6.2, 2_000), (9.0, 5_400)]),
        ],
    );
}

#[test]
fn pollution() {
    reaches(
        &POLLUTION,
        &[
            ("dassl", [(3.9, 500), (5.7, 910), (7.7, 1_800)]),
            ("rodas4", [(4.9, 540), (7.2, 1_600), (8.3, 5_600)]),
            ("radau", [(4.4, 600), (6.5, 1_500), (8.2, 4_100)]),
        ],
    );
}

#[test]
fn transistor_amplifier() {
    reaches(
        &AMPLIFIER,
        &[
            ("dassl", [(2.7, 2_800), (5.5, 5_200), (6.7, 9_600)]),
            ("rodas4", [(4.5, 5_900), (6.3, 21_000), (8.3, 68_000)]),
            ("radau", [(5.2, 5_800), (7.5, 12_000), (8.5, 34_000)]),
        ],
    );
}

#[test]
#[ignore = "half a million steps"]
fn ring_modulator() {
    reaches(&RING_MODULATOR, &[("dassl", [(0.8, 270_000), (2.5, 600_000), (4.0, 1_300_000)])]);
}

#[test]
fn squeezing_mechanism() {
    reaches(
        &SQUEEZING_MECHANISM,
        &[
            ("dassl", [(3.4, 1_400), (4.3, 2_600), (6.0, 4_800)]),
            ("rodas4", [(4.1, 2_500), (6.9, 7_300), (8.6, 23_000)]),
            ("radau", [(4.3, 3_400), (6.4, 5_400), (8.8, 12_000)]),
        ],
    );
}

#[test]
fn charge_pump() {
    reaches(&CHARGE_PUMP, &[("dassl", [(1.8, 980), (2.9, 2_000), (4.4, 3_300)])]);
}

/// The largest error at the end, relative to max(|reference|, 1).
fn error_at_end(text: &str, names: &[&str], reference: &[f64], settings: Settings) -> f64 {
    let run = simulated_with(text, &settings);
    let end = |name: &str| *run.values(name).last().expect("a row");
    let pairs = names.iter().zip(reference);
    pairs.map(|(name, e)| (end(name) - e).abs() / e.abs().max(1.0)).fold(0.0, f64::max)
}

/// The pendulum in Cartesian coordinates, index 3, falling from the height of its pivot.
const PENDULUM: &str = "model Pendulum Real x(start = 1, fixed = true); Real y(start = 0); Real u; Real v(start = 0, fixed = true);
      Real F; equation der(x) = u; der(y) = v; der(u) = -F*x; der(v) = -F*y - 9.81; x^2 + y^2 = 1; end Pendulum;";

#[test]
fn a_pendulum_of_index_three_is_solved_by_every_implicit_method() {
    // After half a period it stands level on the other side; the quarter period is the complete
    // elliptic integral at modulus sin(π/4) over √g.
    let half = 2.0 * 1.854_074_677_301_371_9 / 9.81f64.sqrt();
    for method in ["dassl", "rodas4", "radau", "dopri5", "dop853"] {
        let method_entry = find_integrator(method).expect("a method");
        let settings =
            Settings { stop: half, tolerance: 1e-8, method: method_entry, ..Settings::default() };
        let error = error_at_end(PENDULUM, &["x", "y"], &[-1.0, 0.0], settings);
        assert!(error < 1e-5, "{method}: {error:e}");
    }
}
