//! How many individuals a message to a rank holds.
//!
//! A chunk must be worth its message: the time to simulate it is `WORTH` times what the message
//! takes, and all chunks under way together keep the ranks busy while rank 0 handles one message after
//! the other. Towards the end of a population chunks shrink to each processor's share of what remains
//! (guided self-scheduling), so that all finish at about the same time. Where one simulation takes
//! longer than its message, a chunk is one individual, and a slow one delays no other.

/// A chunk takes at least this many times what its message takes.
const WORTH: f64 = 20.0;
/// A population is distributed where the threads of rank 0 alone would work this many times the
/// time of a message on it.
const WORTH_DISTRIBUTING: f64 = 10.0;

/// Measured times, in seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Times {
    /// One simulation; `None` where none was measured.
    pub simulation: Option<f64>,
    /// From the sending of a chunk to its results, less the simulations.
    pub message: f64,
    /// What rank 0 works for each message, during which it handles no other one.
    pub handling: f64,
}

/// Individuals of the next chunk: `remaining` are without a processor, `processors` take chunks.
pub fn size(times: &Times, remaining: usize, processors: usize) -> usize {
    let Some(simulation) = times.simulation else { return 1 };
    let for_message = WORTH * times.message / simulation.max(1e-9);
    let for_handling = 2.0 * processors as f64 * times.handling / simulation.max(1e-9);
    let least = for_message.max(for_handling).ceil() as usize;
    let share = remaining.div_ceil(processors.max(1));
    least.min(share).max(1)
}

/// Whether a population of this size gains from other ranks.
pub fn is_worth_distributing(times: &Times, individuals: usize, threads: usize) -> bool {
    let Some(simulation) = times.simulation else { return individuals > 1 };
    let alone = individuals as f64 * simulation / threads.max(1) as f64;
    individuals > 1 && alone > WORTH_DISTRIBUTING * times.message
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn times(simulation: f64) -> Times {
        Times { simulation: Some(simulation), message: 1e-4, handling: 1e-5 }
    }

    #[test]
    fn long_simulations_are_sent_one_by_one() {
        assert_eq!(size(&times(0.1), 10_000, 64), 1);
        assert!(is_worth_distributing(&times(0.1), 2, 1));
        assert!(!is_worth_distributing(&times(0.1), 1, 1), "there is nothing to share");
    }

    #[test]
    fn short_ones_fill_chunks_that_are_worth_their_message() {
        // 20 times 100 us are 2 ms.
        assert!((2000..=2001).contains(&size(&times(1e-6), 1_000_000, 4)));
        assert!(!is_worth_distributing(&times(1e-6), 100, 1));
        assert!(is_worth_distributing(&times(1e-6), 10_000, 1));
    }

    #[test]
    fn chunks_shrink_towards_the_end() {
        let sizes: Vec<usize> =
            [4000, 400, 40, 4, 1].iter().map(|rest| size(&times(1e-5), *rest, 4)).collect();
        assert_eq!(sizes, [200, 100, 10, 1, 1]);
    }

    /// A population of case 4.2 of the paper with messages of a machine that others use, too.
    #[test]
    fn a_short_population_is_no_sequence_of_small_messages() {
        let times = Times { simulation: Some(2.7e-4), message: 1e-3, handling: 2e-5 };
        let (mut remaining, mut messages) = (75, 0);
        while remaining > 0 {
            remaining -= size(&times, 2 * remaining, 2);
            messages += 1;
        }
        assert!(messages <= 2, "{messages}");
    }

    #[test]
    fn many_ranks_need_larger_chunks() {
        // Rank 0 handles 100,000 messages a second: with 10,000 ranks each may send one every 0.1 s,
        // and has work for twice as long.
        assert_eq!(size(&times(1e-2), 10_000_000, 10_000), 20);
    }

    #[test]
    fn the_first_chunk_measures() {
        let unknown = Times { simulation: None, ..times(1.0) };
        assert_eq!(size(&unknown, 1000, 4), 1);
        assert!(is_worth_distributing(&unknown, 2, 1));
    }
}
