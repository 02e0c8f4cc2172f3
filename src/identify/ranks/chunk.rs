//! How many individuals a message to a rank holds.
//!
//! While a processor works on a chunk, the next one is on its way: a chunk takes `HIDDEN` times what its
//! message takes, and all chunks under way together keep the ranks busy while rank 0 handles one message
//! after the other. Times are means: no chunk is more than half of a processor's share of what remains,
//! so that the last ones are small and all processors finish at about the same time (guided
//! self-scheduling). Where simulations take longer than messages, a chunk is one individual, none
//! waits for another, and a slow one delays no other.

/// A chunk takes at least this many times what its message takes, which hides the next message.
const HIDDEN: f64 = 4.0;
/// Simulations that take this many times what a message takes are not sent ahead.
const LONG: f64 = 20.0;
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
    let processors = processors.max(1);
    let for_handling = 2.0 * processors as f64 * times.handling;
    let least = individuals(for_handling.max(HIDDEN * times.message), simulation);
    let share = remaining.div_ceil(2 * processors).max(worth(times, simulation));
    least.min(share).min(remaining).max(1)
}

/// Individuals that a processor gets which still has work: `load` of them, of `unfinished` ones in all.
/// 0 where simulations are long, or where it has its share already.
pub fn ahead(
    times: &Times,
    (load, unfinished): (usize, usize),
    remaining: usize,
    processors: usize,
) -> usize {
    let Some(simulation) = times.simulation.filter(|simulation| *simulation < LONG * times.message)
    else {
        return 0;
    };
    let left = (unfinished / processors.max(1)).saturating_sub(load);
    match left < worth(times, simulation) {
        true => 0,
        false => size(times, remaining, processors).min(left),
    }
}

/// The smallest chunk that is worth rank 0's work for it.
fn worth(times: &Times, simulation: f64) -> usize {
    individuals(2.0 * times.handling, simulation).max(1)
}

/// So many simulations take these seconds.
fn individuals(seconds: f64, simulation: f64) -> usize {
    (seconds / simulation.max(1e-9)).ceil() as usize
}

/// Whether a population of this size gains from other ranks.
pub(crate) fn is_worth_distributing(times: &Times, individuals: usize, threads: usize) -> bool {
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
    fn short_ones_fill_chunks_that_hide_the_next_message() {
        // 4 times 100 us are 400 us.
        assert!((400..=401).contains(&size(&times(1e-6), 1_000_000, 4)));
        assert!(!is_worth_distributing(&times(1e-6), 100, 1));
        assert!(is_worth_distributing(&times(1e-6), 10_000, 1));
    }

    #[test]
    fn chunks_shrink_towards_the_end() {
        let sizes: Vec<usize> =
            [4000, 400, 40, 4, 1].iter().map(|rest| size(&times(1e-5), *rest, 4)).collect();
        // The smallest takes twice what rank 0 works for it.
        assert_eq!(sizes, [40, 40, 5, 2, 1]);
    }

    #[test]
    fn short_simulations_are_sent_ahead_until_each_has_its_share() {
        let times = times(2.7e-4);
        assert_eq!(size(&times, 80, 2), 2);
        assert_eq!(ahead(&times, (2, 80), 78, 2), 2);
        assert_eq!(ahead(&times, (8, 18), 9, 2), 1);
        assert_eq!(ahead(&times, (8, 16), 8, 2), 0, "it has its share");
        let long = Times { simulation: Some(0.1), ..times };
        assert_eq!(ahead(&long, (1, 80), 72, 2), 0, "a slow one would delay the next");
    }

    /// A population of case 4.2 of the paper with messages of a machine that others use, too: no more
    /// than half of it depends on the first guess of the times.
    #[test]
    fn no_chunk_is_a_whole_share() {
        let times = Times { simulation: Some(2.7e-4), message: 5e-3, handling: 1e-4 };
        assert_eq!(size(&times, 150, 2), 38);
        assert_eq!(ahead(&times, (38, 150), 112, 2), 28);
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
