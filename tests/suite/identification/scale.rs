//! What a cluster gains, on paper.

use crate::support::cluster::Cluster;

/// Seconds from sending a chunk to its answer without the simulations, and of rank 0's work for each:
/// assumed, for ranks that have a core each. `tests/mpi.rs` compares with what 2 to 8 ranks take.
const MESSAGE: f64 = 1.5e-4;
const HANDLING: f64 = 1e-5;

fn cluster(ranks: usize, individuals: usize, simulation: f64) -> Cluster {
    let (message, handling) = (MESSAGE, HANDLING);
    Cluster { ranks, cores: ranks, individuals, simulation, message, handling }
}

fn efficiency(ranks: usize, for_each: usize, simulation: f64) -> f64 {
    cluster(ranks, ranks * for_each, simulation).efficiency()
}

#[test]
fn long_simulations_scale_and_short_ones_do_not() {
    assert!(efficiency(2, 100, 0.1) > 0.97);
    assert!(efficiency(1000, 100, 0.1) > 0.95);
    // One population of 100 individuals of a microsecond on 64 ranks is nothing but messages.
    assert!(cluster(64, 100, 1e-6).efficiency() < 0.01);
    // Ranks that share cores gain nothing but lose little.
    let shared = Cluster { cores: 2, ..cluster(8, 2000, 0.01) };
    assert!((0.95..1.0).contains(&shared.efficiency()), "{}", shared.efficiency());
    // Rank 0 handles 100,000 messages a second, and chunks are as large as that asks.
    assert!(efficiency(10_000, 1000, 0.1) > 0.9);
}

/// A generation of case 4.2: 75 individuals of 0.27 ms on two ranks.
#[test]
fn a_short_generation_does_not_wait_for_messages() {
    let generation = cluster(2, 75, 2.7e-4);
    assert!(generation.efficiency() > 0.95, "{}", generation.efficiency());
    // Two that share everything without messages: 75 of 0.27 ms on two cores.
    assert!((generation.seconds() / (75.0 * 2.7e-4 / 2.0) - 1.0).abs() < 0.07);
}

/// `cargo test --test suite scale -- --ignored --nocapture`
#[test]
#[ignore = "prints the table of the guide"]
#[allow(clippy::print_stdout, reason = "that is what it is for")]
fn print_the_table() {
    for (title, for_each) in [("10 individuals for each rank", 10), ("1000", 1000)] {
        println!("\n{title}\n{:>8} {:>8} {:>8} {:>8}", "ranks", "1 us", "1 ms", "100 ms");
        for ranks in [1, 2, 8, 64, 1000, 10_000, 100_000] {
            let one = |simulation| 100.0 * efficiency(ranks, for_each, simulation);
            let [micro, milli, tenth] = [1e-6, 1e-3, 0.1].map(one);
            println!("{ranks:>8} {micro:>6.1} % {milli:>6.1} % {tenth:>6.1} %");
        }
    }
}
