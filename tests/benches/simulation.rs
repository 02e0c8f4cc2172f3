//! Processor time of simulations at tolerance 1e-4 with 100 output intervals, initialisation included, as an
//! identification makes them: compiled once, two variables observed.
//!
//! | model | at most |
//! |---|---|
//! | RC circuit | 0.02 ms |
//! | FC2Layer, 0.5 s | 0.5 ms |
//! | FC3Layer, 0.5 s | 1.1 ms |
//! | FC3Layer from source to first result | 400 ms |
//!
//! LoadSteps, WaterEffect and the polarization curve are those of the whole runs of an
//! identification. LoadSteps with more and more control volumes shows how the cost grows.
//!
//! The folder that `GAPILIB_MSL` names holds the standard library, of which two examples are
//! simulated; without it they are left out.

use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::Program;
use gapilib::internals::flatten::{self, Library, LibraryFiles};
use gapilib::internals::name::Name;
use gapilib::internals::sim::{OutputGrid, Settings, Simulator, Trajectory};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

#[path = "disk.rs"]
mod disk;
use disk::Disk;
#[path = "processor_time.rs"]
mod processor_time;
use processor_time::processor_time;

/// Class, observed variables, end in seconds, what is aimed at.
const SHIPPED: &[(&str, &[&str], f64, &str)] = &[
    ("RC", &["capacitor.v"], 0.5, "at most 0.02 ms"),
    ("FuelCellLib.casestudies.FC2Layer", &["V"], 0.5, "at most 0.5 ms"),
    ("FuelCellLib.casestudies.FC3Layer", &["V"], 0.5, "at most 1.1 ms"),
    ("CaseStudies.PolarizationCurve", &["i", "V"], 1.0, "5000 x 100 in 5 s on 2 cores: 20 us"),
    ("CaseStudies.LoadSteps", &["V"], 25.0, "200 x 150 in 10 s on 2 cores: 0.67 ms"),
    ("CaseStudies.WaterEffect", &["V"], 9000.0, "700 x 70 in 60 s on 2 cores: 2.4 ms"),
];

/// Control volumes of the layers of LoadSteps.
const VOLUMES: [usize; 4] = [10, 100, 1000, 10_000];

/// The same of the standard library; there is no target.
const STANDARD: &[(&str, &[&str], f64)] = &[
    ("Modelica.Electrical.Analog.Examples.CauerLowPassAnalog", &["C9.v"], 60.0),
    ("Modelica.Mechanics.MultiBody.Examples.Elementary.DoublePendulum", &["revolute1.phi"], 3.0),
];

/// What is measured.
struct ProcessorTime;

impl Measurement for ProcessorTime {
    type Intermediate = Duration;
    type Value = Duration;

    fn start(&self) -> Duration {
        processor_time()
    }

    fn end(&self, begin: Duration) -> Duration {
        processor_time() - begin
    }

    fn add(&self, a: &Duration, b: &Duration) -> Duration {
        *a + *b
    }

    fn zero(&self) -> Duration {
        Duration::ZERO
    }

    fn to_f64(&self, value: &Duration) -> f64 {
        WallTime.to_f64(value)
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        static FORMATTER: WallTime = WallTime;
        FORMATTER.formatter()
    }
}

fn program(folder: &Path, packages: &[&str], class: &str) -> Arc<Program> {
    let files: Arc<dyn LibraryFiles> = Arc::new(Disk::default());
    let mut library = Library::new();
    for name in packages {
        let loaded = library.load_lazily(&files, &folder.join(name), &Name::default());
        loaded.expect("the library is there");
    }
    let flat = flatten::flatten(&library, &Name::parse(class), &[]).expect("a model").model;
    Program::compile(causalize(&flat).expect("it can be sorted")).expect("it compiles")
}

/// A model of the folder `models`, or of `tests/models`.
fn shipped(class: &str) -> Arc<Program> {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let file = match class.split_once('.') {
        Some((package, _)) => package.to_owned(),
        None => format!("../tests/models/{class}.mo"),
    };
    let mut packages = vec!["Modelica", "FuelCellLib"];
    if !packages.contains(&file.as_str()) {
        packages.push(&file);
    }
    program(&models, &packages, class)
}

/// LoadSteps with so many control volumes.
fn load_steps(n: usize) -> Arc<Program> {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let folder = tempfile::tempdir().expect("a folder");
    let text = format!("model Fine extends CaseStudies.LoadSteps(n = {n}); end Fine;");
    let file = folder.path().join("Fine.mo");
    std::fs::write(&file, text).expect("the file can be written");
    let file = file.to_str().expect("a path in UTF-8");
    program(&models, &["Modelica", "FuelCellLib", "CaseStudies", file], "Fine")
}

/// A function that simulates once.
fn run(program: &Arc<Program>, observed: &[&str], stop: f64) -> impl FnMut() -> f64 + use<> {
    let observed: Vec<usize> =
        observed.iter().map(|name| program.find_variable(name).expect("declared")).collect();
    let mut system = program.system();
    system.observe_only(&observed);
    let mut simulator = Simulator::new();
    let mut trajectory = Trajectory::default();
    let settings = Settings {
        stop,
        tolerance: 1e-4,
        output: OutputGrid::Intervals(100),
        ..Settings::default()
    };
    move || {
        simulator.run(&mut system, &settings, &mut trajectory).expect("the simulation succeeds");
        trajectory.column(0)[trajectory.len() - 1]
    }
}

/// Measures what `prepare` makes, which is not made where nobody asks for it.
fn measure<F: FnMut() -> f64>(
    group: &mut BenchmarkGroup<'_, ProcessorTime>,
    name: impl Into<String>,
    prepare: impl Fn() -> F,
) {
    let mut simulate = None;
    group.bench_function(name, |bencher| bencher.iter(simulate.get_or_insert_with(&prepare)));
}

fn simulations(criterion: &mut Criterion<ProcessorTime>) {
    let mut group = criterion.benchmark_group("simulation");
    for (class, observed, stop, target) in SHIPPED {
        let name = format!("{class}, {target}");
        measure(&mut group, name, || run(&shipped(class), observed, *stop));
    }
    if let Some(folder) = std::env::var_os("GAPILIB_MSL").map(PathBuf::from) {
        for (class, observed, stop) in STANDARD {
            let packages = ["Modelica", "ModelicaServices", "Complex.mo"];
            let simulate = || run(&program(&folder, &packages, class), observed, *stop);
            measure(&mut group, *class, simulate);
        }
    }
    group.finish();
}

/// What a control volume costs must not grow with their number.
fn control_volumes(criterion: &mut Criterion<ProcessorTime>) {
    let mut group = criterion.benchmark_group("LoadSteps by control volumes");
    group.sample_size(10);
    for n in VOLUMES {
        group.throughput(Throughput::Elements(n as u64));
        measure(&mut group, n.to_string(), || run(&load_steps(n), &["V"], 25.0));
    }
    group.finish();
}

fn first_result(criterion: &mut Criterion<ProcessorTime>) {
    let mut group = criterion.benchmark_group("source to first result");
    group.sample_size(10);
    group.bench_function("FC3Layer, at most 400 ms", |bencher| {
        bencher.iter(|| run(&shipped("FuelCellLib.casestudies.FC3Layer"), &["V"], 0.5)());
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(ProcessorTime);
    targets = simulations, control_volumes, first_result
}
criterion_main!(benches);
