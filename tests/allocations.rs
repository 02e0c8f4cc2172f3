//! What simulations allocate. A test binary of its own, because its allocator counts.
//!
//! `GAPILIB_RUNS=100000 cargo test --release --test allocations -- --nocapture` simulates a cell
//! with as many random parameters in one process, and evaluates ten times as many individuals of a
//! static curve.

#![allow(unsafe_code, reason = "an allocator cannot be written without")]
#![allow(clippy::disallowed_methods, reason = "expected values need not have every digit")]
#![allow(clippy::print_stdout, reason = "the figures are asked for with --nocapture")]

use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::{Program, SensitivityCode};
use gapilib::internals::flatten::{self, Library, LibraryFiles};
use gapilib::internals::ga::optimizer::METHODS;
use gapilib::internals::identify::fitness::FITNESSES;
use gapilib::internals::identify::problem::{
    Experiment, Free, Inference, ModelSimulator, Observation, Problem, Run, Series, Sigma, Stop,
};
use gapilib::internals::identify::{CompiledModel, Descriptions};
use gapilib::internals::name::Name;
use gapilib::internals::registry::{self, Options};
use gapilib::internals::runtime::System;
use gapilib::internals::sim::{OutputGrid, Settings, SimErrorKind, Simulator, Trajectory};
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::parse_stored_definition;
use std::alloc::{GlobalAlloc, Layout, System as Malloc};
use std::cell::Cell;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

#[path = "benches/disk.rs"]
mod disk;

thread_local! {
    /// Allocations, and bytes that are not freed, of this thread.
    static COUNTED: Cell<(u64, i64)> = const { Cell::new((0, 0)) };
}

struct Counting;

fn count(allocations: u64, bytes: i64) {
    // Threads that end have no counters any more.
    let _ = COUNTED.try_with(|counted| {
        let (all, live) = counted.get();
        counted.set((all + allocations, live + bytes));
    });
}

// SAFETY: everything is left to the allocator of the system.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(1, layout.size() as i64);
        // SAFETY: as promised to this method.
        unsafe { Malloc.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(0, -(layout.size() as i64));
        // SAFETY: as promised to this method.
        unsafe { Malloc.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(1, size as i64 - layout.size() as i64);
        // SAFETY: as promised to this method.
        unsafe { Malloc.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations() -> u64 {
    COUNTED.get().0
}

fn live_bytes() -> i64 {
    COUNTED.get().1
}

/// A chain of capacities that is heated at one end and radiates at the other: a sparse Jacobian, and
/// an equation that is solved by iteration in every step.
const CHAIN: &str = "model Chain parameter Real k = 100; Real T[20](each start = 1, each fixed = true); Real q[21]; \
    equation q[1] + exp(q[1]) = 2 + sin(20*time) - T[1]; q[21] = T[20]^4; \
    for i in 2:20 loop q[i] = k*(T[i - 1] - T[i])*(1 + T[i]); end for; \
    for i in 1:20 loop der(T[i]) = q[i] - q[i + 1]; end for; end Chain;";

fn chain() -> System {
    let file = parse_stored_definition(SourceId::NONE, CHAIN).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let flat = flatten::flatten(&library, &Name::parse("Chain"), &[]).expect("a model").model;
    Program::compile(causalize(&flat).expect("it can be sorted")).expect("it compiles").system()
}

/// A model of the packages that come with the program.
fn shipped(class: &str) -> Arc<Program> {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let files: Arc<dyn LibraryFiles> = Arc::new(disk::Disk::default());
    let mut library = Library::new();
    for name in ["Modelica", "FuelCellLib", "CaseStudies"] {
        library.load_lazily(&files, &models.join(name), &Name::default()).expect("it is there");
    }
    let flat = flatten::flatten(&library, &Name::parse(class), &[]).expect("a model").model;
    Program::compile(causalize(&flat).expect("it can be sorted")).expect("it compiles")
}

/// A cell whose voltage is observed.
fn cell(class: &str) -> System {
    let program = shipped(&format!("FuelCellLib.casestudies.{class}"));
    let mut system = program.system();
    system.observe_only(&[program.find_variable("V").expect("declared")]);
    system
}

fn settings(method: &str, tolerance: f64) -> Settings {
    let method = gapilib::internals::sim::find_integrator(method).expect("an integrator");
    let output = OutputGrid::Intervals(100);
    Settings { stop: 0.5, tolerance, output, method, ..Settings::default() }
}

#[test]
fn steps_allocate_nothing() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut system = chain();
    for method in ["dassl", "rodas4", "radau"] {
        no_step_allocates(&mut system, method);
    }
}

#[test]
fn steps_with_sensitivities_allocate_nothing() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut system = chain();
    let program = system.program().clone();
    let k = program.find_parameter("k").expect("declared");
    let end = program.find_variable("T[20]").expect("declared");
    system.observe_only(&[end]);
    let code = SensitivityCode::compile(&program, &[k], &[end]).expect("it has derivatives");
    system.differentiate(Some(&code));
    no_step_allocates(&mut system, "dassl");
}

/// Simulations with more steps allocate no more.
#[track_caller]
fn no_step_allocates(system: &mut System, method: &str) {
    let (mut simulator, mut trajectory) = (Simulator::new(), Trajectory::default());
    let mut cost = |tolerance: f64| {
        let settings = settings(method, tolerance);
        // Until tapes that run often are machine code.
        for _ in 0..50 {
            simulator.run(system, &settings, &mut trajectory).expect("it succeeds");
        }
        let before = allocations();
        let statistics = simulator.run(system, &settings, &mut trajectory);
        (statistics.expect("it succeeds").steps, allocations() - before)
    };
    let (few, at_start) = cost(1e-3);
    let (many, then) = cost(1e-6);
    assert!(many > 2 * few, "{method}: {few} and {many} steps");
    assert_eq!(then, at_start, "{method}: {few} and {many} steps");
}

/// Numbers from 0 to 1 that look random (a linear congruential generator).
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

#[test]
fn memory_stays_the_same_over_many_simulations() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let runs = std::env::var("GAPILIB_RUNS").ok().and_then(|runs| runs.parse().ok());
    let runs: u64 = runs.unwrap_or(300);
    let mut system = cell("FC2Layer");
    let program = system.program().clone();
    let names = ["RL1.R", "T", "act_layer1.Aioref", "act_layer1.B", "mem_layer1.D2"];
    let parameters =
        names.map(|name| program.find_parameter(name).unwrap_or_else(|_| panic!("{name}")));
    let settings = Settings { max_steps: 2_000, max_total_steps: 2_000, ..settings("dassl", 1e-4) };
    let (mut simulator, mut trajectory) = (Simulator::new(), Trajectory::default());
    let (mut seed, mut failures, mut after_some) = (1, 0, None);
    for run in 0..runs {
        for parameter in parameters {
            let default = program.parameters()[parameter].default;
            let factor = 10f64.powf(4.0 * random(&mut seed) - 2.0);
            system.set_parameter(parameter, default * factor).expect("a number");
        }
        if let Err(error) = simulator.run(&mut system, &settings, &mut trajectory) {
            failures += 1;
            let said = program.explain(&error);
            assert!(!said.message.is_empty() && error.time >= 0.0, "{error:?}");
            assert!(!matches!(error.kind, SimErrorKind::Settings | SimErrorKind::Cancelled));
        }
        // By then the workspaces are made, and the machine code as well.
        if run == runs / 2 {
            after_some = Some(live_bytes());
        }
    }
    let grown = live_bytes() - after_some.expect("half of the runs were made");
    println!("{runs} simulations, {failures} failed, {grown} bytes more than after half of them");
    assert!(failures < runs, "every simulation failed");
    assert!(grown.abs() < 100_000, "{grown} bytes");
}

/// Held by the tests one after the other: what a process holds is that of all its threads.
static ALONE: Mutex<()> = Mutex::new(());

/// Pages in memory and open files of this process; `None` where the system does not tell.
fn held() -> Option<(u64, usize)> {
    let memory = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages = memory.split(' ').nth(1)?.parse().ok()?;
    Some((pages, std::fs::read_dir("/proc/self/fd").ok()?.count()))
}

/// The polarization curve, with residuals that no parameters make vanish.
fn curve(evaluations: u64) -> Problem {
    let program = shipped("CaseStudies.PolarizationCurve");
    let settings = Settings { stop: 1.0, ..Settings::default() };
    let x: Vec<f64> = (1..=30).map(|k| f64::from(k) / 31.0).collect();
    let y: Vec<f64> = x.iter().map(|x| 1.0 - 0.3 * x + 0.01 * (9.0 * x).sin()).collect();
    let names = ["A", "Io", "B", "R", "In"];
    let experiment = Experiment {
        deviations: 0,
        second_attempt: true,
        name: "curve".to_owned(),
        model: Arc::new(CompiledModel::new("PolarizationCurve", program)),
        settings,
        x_name: "time".to_owned(),
        observations: vec![Observation { y_name: "V".to_owned(), x: x.clone() }],
        parameters: names.iter().enumerate().map(|(k, name)| (k, (*name).to_owned())).collect(),
    };
    let free = |name| Free::new(name, "", [1e-4, 0.5], None, None).expect("a range");
    let method = registry::find("method", METHODS, "lshade").expect("a method");
    Problem {
        title: String::new(),
        model: String::new(),
        text: String::new(),
        descriptions: Descriptions::default(),
        parameters: names.map(free).to_vec(),
        series: vec![Series {
            role: Default::default(),
            experiment: "curve".to_owned(),
            y_name: "V".to_owned(),
            y_unit: "V".to_owned(),
            x_name: "time".to_owned(),
            x_unit: "s".to_owned(),
            file: String::new(),
            x,
            y,
            weight: 1.0,
            relative: Vec::new(),
            sigma: Sigma::Unknown,
            law: Default::default(),
            censored: Vec::new(),
            column: "V".to_owned(),
            x_column: String::new(),
            rows: Vec::new(),
            missing: Vec::new(),
            scaling: Default::default(),
            joint: None,
        }],
        objectives: vec![(
            "sse".to_owned(),
            (FITNESSES[0].make)(&mut Options::default()).expect("a fitness"),
        )],
        method_name: method.name.to_owned(),
        method: (method.make)(&mut Options::default()).expect("usual settings"),
        polish: false,
        seed: [12345.0; 6],
        stop: Stop { evaluations: Some(evaluations), ..Stop::default() },
        noise: 1e-12,
        inference: Inference::default(),
        simulator: Box::new(move || {
            Ok(Box::new(ModelSimulator::new(std::slice::from_ref(&experiment))?) as Box<_>)
        }),
    }
}

#[test]
fn memory_stays_the_same_over_many_evaluations() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let runs = std::env::var("GAPILIB_RUNS").ok().and_then(|runs| runs.parse().ok());
    let evaluations = 10 * runs.unwrap_or(1000);
    let mut run = Run::new(curve(evaluations), 2).expect("a problem");
    let (mut half, mut failed) = (None, 0);
    while run.stop().is_none() {
        let record = run.step(0.0).expect("an answer");
        failed += record.answered.failures.len();
        if half.is_none() && run.evaluations() >= evaluations / 2 {
            half = Some((held(), run.generations()));
        }
    }
    let (held_then, generations) = half.expect("half of the evaluations were made");
    let Some(((pages_then, files_then), (pages, files))) = held_then.zip(held()) else {
        println!("this system does not tell what a process holds");
        return;
    };
    let grown = pages.saturating_sub(pages_then) * 4096;
    println!(
        "{} evaluations, {failed} failed, {grown} bytes more than after half of them, {files} open files",
        run.evaluations()
    );
    assert_eq!(files, files_then, "open files");
    // What is kept is one line of the history for each generation.
    let lines = 400 * (run.generations() - generations);
    assert!(grown < 4_000_000 + lines, "{grown} bytes");
}
