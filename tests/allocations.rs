//! What simulations allocate. A test binary of its own, because its allocator counts.
//!
//! `GAPILIB_RUNS=100000 cargo test --release --test allocations -- --nocapture` simulates a cell
//! with as many random parameters in one process.

#![allow(unsafe_code, reason = "an allocator cannot be written without")]
#![allow(clippy::print_stdout, reason = "the figures are asked for with --nocapture")]

use gapilib::compile::{Program, System};
use gapilib::dae::sort;
use gapilib::flatten::{self, Library, LibraryFiles};
use gapilib::name::Name;
use gapilib::sim::{OutputGrid, Settings, SimErrorKind, Simulator, Trajectory};
use gapilib::source::SourceId;
use gapilib::syntax::parse_stored_definition;
use std::alloc::{GlobalAlloc, Layout, System as Malloc};
use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;

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
const CHAIN: &str = "model Chain Real T[20](each start = 1, each fixed = true); Real q[21]; \
    equation q[1] + exp(q[1]) = 2 + sin(20*time) - T[1]; q[21] = T[20]^4; \
    for i in 2:20 loop q[i] = 100*(T[i - 1] - T[i])*(1 + T[i]); end for; \
    for i in 1:20 loop der(T[i]) = q[i] - q[i + 1]; end for; end Chain;";

fn chain() -> System {
    let file = parse_stored_definition(SourceId::NONE, CHAIN).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let flat = flatten::flatten(&library, &Name::parse("Chain"), &[]).expect("a model").model;
    Program::compile(sort(&flat).expect("it can be sorted")).expect("it compiles").system()
}

/// A cell whose voltage is observed.
fn cell(class: &str) -> System {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let files: Arc<dyn LibraryFiles> = Arc::new(disk::Disk::default());
    let mut library = Library::new();
    for name in ["Modelica", "FuelCellLib"] {
        library.load_lazily(&files, &models.join(name), &Name::default()).expect("it is there");
    }
    let class = Name::parse(&format!("FuelCellLib.casestudies.{class}"));
    let flat = flatten::flatten(&library, &class, &[]).expect("a model").model;
    let program = Program::compile(sort(&flat).expect("it can be sorted")).expect("it compiles");
    let mut system = program.system();
    system.observe_only(&[program.find_variable("V").expect("declared")]);
    system
}

fn settings(method: &str, tolerance: f64) -> Settings {
    let method = gapilib::sim::find_integrator(method).expect("an integrator");
    let output = OutputGrid::Intervals(100);
    Settings { stop: 0.5, tolerance, output, method, ..Settings::default() }
}

#[test]
fn steps_allocate_nothing() {
    let mut system = chain();
    for method in ["dassl", "rodas4", "radau"] {
        let (mut simulator, mut trajectory) = (Simulator::new(), Trajectory::default());
        let mut cost = |tolerance: f64| {
            let settings = settings(method, tolerance);
            // Until tapes that run often are machine code.
            for _ in 0..50 {
                simulator.run(&mut system, &settings, &mut trajectory).expect("it succeeds");
            }
            let before = allocations();
            let statistics = simulator.run(&mut system, &settings, &mut trajectory);
            (statistics.expect("it succeeds").steps, allocations() - before)
        };
        let (few, at_start) = cost(1e-3);
        let (many, then) = cost(1e-6);
        assert!(many > 2 * few, "{method}: {few} and {many} steps");
        assert_eq!(then, at_start, "{method}: {few} and {many} steps");
    }
}

/// Numbers from 0 to 1 that look random (a linear congruential generator).
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

#[test]
fn memory_stays_the_same_over_many_simulations() {
    let runs = std::env::var("GAPILIB_RUNS").ok().and_then(|runs| runs.parse().ok());
    let runs: u64 = runs.unwrap_or(300);
    let mut system = cell("FC2Layer");
    let program = system.program().clone();
    let names = ["RL1.R", "T", "act_layer1.Aioref", "act_layer1.B", "mem_layer1.D2"];
    let parameters =
        names.map(|name| program.find_parameter(name).unwrap_or_else(|_| panic!("{name}")));
    let settings = Settings { max_steps: 2_000, ..settings("dassl", 1e-4) };
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
