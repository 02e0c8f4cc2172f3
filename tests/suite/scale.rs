//! What a cluster gains, on paper: rank 0 hands out chunks by the rule of the program
//! (`identify::ranks::chunk`), one message after the other; simulations take what they take. Bandwidth is
//! left out: a result of 1 KB takes less than a microsecond in any network of a cluster.

use gapilib::identify::ranks::chunk::{self, Times};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Seconds from sending a chunk to its answer without the simulations, and of rank 0's work for each:
/// assumed, for ranks that wait by sleeping and have a core each. Two ranks on two cores that some 15
/// other processes used, too, took 1 ms for a message with 35 to 55 results of 1 KB each.
const MESSAGE: f64 = 1.5e-4;
const HANDLING: f64 = 1e-5;

/// A job of so many ranks, cores and individuals; simulations take between a half and one and a half
/// times the mean.
struct Cluster {
    ranks: usize,
    cores: usize,
    individuals: usize,
    simulation: f64,
}

impl Cluster {
    /// What a simulation takes on a rank that shares its core with others.
    fn duration(&self) -> f64 {
        self.simulation * (self.ranks as f64 / self.cores as f64).max(1.0)
    }

    /// The share of the time of all cores in which they simulate.
    fn efficiency(&self) -> f64 {
        self.ranks.min(self.cores) as f64 / self.cores as f64 * self.share_of_ranks()
    }

    fn share_of_ranks(&self) -> f64 {
        let simulation = self.duration();
        let times = Times { simulation: Some(simulation), message: MESSAGE, handling: HANDLING };
        let nanoseconds = |seconds: f64| (seconds * 1e9).round() as u64;
        let mut free: BinaryHeap<Reverse<(u64, usize)>> =
            (0..self.ranks).map(|rank| Reverse((0, rank))).collect();
        let (mut next, mut busy, mut end, mut work) = (0, 0, 0, 0);
        let mut state = 1_u64;
        while let Some(Reverse((asked, rank))) = free.pop() {
            let remaining = self.individuals - next;
            if remaining == 0 {
                continue;
            }
            let size = chunk::size(&times, remaining, self.ranks).min(remaining);
            next += size;
            let duration: u64 = (0..size)
                .map(|_| {
                    // Knuth's linear congruential generator.
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                    let share = (state >> 40) as f64 / (1_u64 << 24) as f64;
                    nanoseconds(simulation * (0.5 + share))
                })
                .sum();
            busy = asked.max(busy) + nanoseconds(HANDLING);
            let done = busy + nanoseconds(MESSAGE) + duration;
            end = end.max(done);
            work += duration;
            free.push(Reverse((done, rank)));
        }
        work as f64 / (self.ranks as f64 * end as f64)
    }
}

fn efficiency(ranks: usize, for_each: usize, simulation: f64) -> f64 {
    Cluster { ranks, cores: ranks, individuals: ranks * for_each, simulation }.efficiency()
}

#[test]
fn long_simulations_scale_and_short_ones_do_not() {
    assert!(efficiency(2, 100, 0.1) > 0.97);
    assert!(efficiency(1000, 100, 0.1) > 0.95);
    // One population of 100 individuals of a microsecond on 64 ranks is nothing but messages.
    let small = Cluster { ranks: 64, cores: 64, individuals: 100, simulation: 1e-6 };
    assert!(small.efficiency() < 0.01);
    // Ranks that share cores gain nothing but lose little.
    let shared = Cluster { ranks: 8, cores: 2, individuals: 2000, simulation: 0.01 };
    assert!((0.95..1.0).contains(&shared.efficiency()), "{}", shared.efficiency());
    // Rank 0 handles 100,000 messages a second, and chunks are as large as that asks.
    assert!(efficiency(10_000, 1000, 0.1) > 0.9);
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
