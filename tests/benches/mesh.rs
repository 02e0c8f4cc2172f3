//! FC2Layer and FC3Layer on meshes from 10 to 2,000 control volumes in each layer of the same
//! thickness: processor time of one simulation (0.5 s, tolerance 1e-4, 100 output intervals, compiled
//! once) and of one step, which must grow with the number of states and no faster.
//!
//! Prints a table and writes the figure that the model's documentation shows. Arguments that are
//! numbers limit the meshes: `cargo bench --bench mesh -- 200`.

#![allow(clippy::print_stdout, reason = "it prints a table")]

use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::Program;
use gapilib::internals::flatten::{self, Library, LibraryFiles};
use gapilib::internals::name::Name;
use gapilib::internals::plot::{Axis, Figure, Mark, Panel, Series};
use gapilib::internals::sim::{OutputGrid, Residual, Settings, Simulator, Trajectory};
use gapilib::internals::source::SourceMap;
use gapilib::internals::syntax;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

#[path = "disk.rs"]
mod disk;
use disk::Disk;
#[path = "processor_time.rs"]
mod processor_time;
use processor_time::processor_time;

const MESHES: [usize; 8] = [10, 20, 50, 100, 200, 500, 1000, 2000];
/// Name of a layer and its thickness in m.
const LAYERS: [(&str, f64); 3] =
    [("mem_layer1", 110e-6), ("act_layer1", 11e-6), ("dif_layer1", 210e-6)];

/// Simulations of one mesh are measured for so long.
const ENOUGH: Duration = Duration::from_secs(1);

/// What was measured on one mesh.
struct Row {
    states: usize,
    /// Seconds from the source to the program.
    translation: f64,
    steps: u64,
    /// Seconds of one simulation.
    simulation: f64,
}

fn program(model: &str, layers: usize, n: usize) -> Arc<Program> {
    let files: Arc<dyn LibraryFiles> = Arc::new(Disk::default());
    let mut library = Library::new();
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    for package in ["Modelica", "FuelCellLib"] {
        let loaded = library.load_lazily(&files, &models.join(package), &Name::default());
        loaded.expect("the library is there");
    }
    let mesh = |(layer, length): &(&str, f64)| {
        format!("{layer}(n = {n}, da = {:e})", length / (n + 1) as f64)
    };
    let meshes: Vec<String> = LAYERS[..layers].iter().map(mesh).collect();
    let text = format!("FuelCellLib.casestudies.{model}({})", meshes.join(", "));
    let source = SourceMap::default().add("mesh", text.clone());
    let (class, arguments) =
        syntax::parse_class_with_modification(source, &text).expect("a modification");
    let flat = flatten::flatten(&library, &class, &arguments).expect("a model").model;
    Program::compile(causalize(&flat).expect("it can be sorted")).expect("it compiles")
}

fn measure(model: &str, layers: usize, n: usize) -> Row {
    let begin = processor_time();
    let program = program(model, layers, n);
    let translation = (processor_time() - begin).as_secs_f64();
    let mut system = program.system();
    system.observe_only(&[program.find_variable("V").expect("declared")]);
    let settings = Settings {
        stop: 0.5,
        tolerance: 1e-4,
        output: OutputGrid::Intervals(100),
        ..Settings::default()
    };
    let (mut simulator, mut trajectory) = (Simulator::new(), Trajectory::default());
    let (mut runs, mut steps) = (0, 0);
    let begin = processor_time();
    while runs == 0 || processor_time() - begin < ENOUGH {
        let statistics = simulator.run(&mut system, &settings, &mut trajectory);
        steps = statistics.expect("the simulation succeeds").steps;
        runs += 1;
    }
    let simulation = (processor_time() - begin).as_secs_f64() / f64::from(runs);
    Row { states: system.n_differential(), translation, steps, simulation }
}

fn series(name: &str, colour: usize, rows: &[Row], value: impl Fn(&Row) -> f64) -> [Series; 2] {
    let x: Vec<f64> = rows.iter().map(|row| row.states as f64).collect();
    let y: Vec<f64> = rows.iter().map(value).collect();
    let name = name.to_owned();
    [
        Series { name: String::new(), x: x.clone(), y: y.clone(), mark: Mark::Line, colour },
        Series { name, x, y, mark: Mark::Points, colour },
    ]
}

fn figure(models: &[(&str, Vec<Row>)]) -> Figure {
    let panel = |label: &str, unit: &str, value: fn(&Row) -> f64| Panel {
        x: Axis::logarithmic("states", ""),
        y: Axis::logarithmic(label, unit),
        height: 200.0,
        zero_line: false,
        series: models
            .iter()
            .enumerate()
            .flat_map(|(k, (name, rows))| series(name, k + 1, rows, value))
            .collect(),
    };
    Figure {
        title: "Time over the size of the mesh".to_owned(),
        panels: vec![
            panel("simulation", "ms", |row| 1e3 * row.simulation),
            panel("step", "us", |row| 1e6 * row.simulation / row.steps as f64),
        ],
    }
}

fn main() {
    let limit = std::env::args().filter_map(|text| text.parse().ok()).min().unwrap_or(usize::MAX);
    let mut models = Vec::new();
    println!(
        "model     n     states  translation s  steps  simulation ms  step us  step and state ns"
    );
    for (model, layers) in [("FC2Layer", 2), ("FC3Layer", 3)] {
        let mut rows = Vec::new();
        for n in MESHES.into_iter().filter(|n| *n <= limit) {
            let row = measure(model, layers, n);
            let step = row.simulation / row.steps as f64;
            println!(
                "{model}  {n:<5} {:<7} {:<14.2} {:<6} {:<14.3} {:<8.1} {:.1}",
                row.states,
                row.translation,
                row.steps,
                1e3 * row.simulation,
                1e6 * step,
                1e9 * step / row.states as f64,
            );
            rows.push(row);
        }
        models.push((model, rows));
    }
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mesh.svg");
    std::fs::write(&file, figure(&models).svg()).expect("the folder of the build can be written");
    println!("figure: {}", file.display());
}
