//! Which seed a run began with, found from the calls that draw random numbers: each is given the
//! state that the one before has left, or another one that the script has set or read.

use rustc_hash::FxHashSet;

/// Calls of `Ram_Gen_ARENA`, each with the seed that the one before gave.
#[derive(Debug, Clone, Copy)]
struct Chain {
    first: [f64; 6],
    next: [f64; 6],
}

/// The seeds of a run.
#[derive(Debug, Clone, Default)]
pub struct Seeds {
    /// The seed that the random numbers of the first population began with.
    pub(super) seed: Option<[f64; 6]>,
    chain: Option<Chain>,
    /// The chain is that of the run before, and nothing was drawn since.
    inherited: bool,
    /// Another seed was set after the first simulation; it counts when the run continues.
    waiting: Option<[f64; 6]>,
    /// Places in the scripts that drew before the first simulation.
    initial: FxHashSet<u64>,
    /// Places in the scripts that draw between two generations.
    in_cycle: FxHashSet<u64>,
    /// Those that drew since the last simulation.
    since: Vec<u64>,
    /// What the next run seems to begin with: drawn elsewhere than between two generations.
    next_first: Option<[f64; 6]>,
}

impl Seeds {
    /// Numbers were drawn with `seed`, which left `next`, by the call at `site`. `simulated`:
    /// whether the run has simulated anything yet.
    pub fn drawn(&mut self, seed: [f64; 6], next: [f64; 6], site: u64, simulated: bool) {
        let continues = self.chain.filter(|chain| chain.next == seed && !self.inherited);
        self.inherited = false;
        let first = continues.map_or(seed, |chain| chain.first);
        self.chain = Some(Chain { first, next });
        if !simulated {
            self.seed = Some(first);
            self.initial.insert(site);
            return;
        }
        self.seed.get_or_insert(first);
        if continues.is_none() {
            (self.waiting, self.next_first) = (Some(seed), Some(seed));
        } else if !self.in_cycle.contains(&site)
            && (!self.in_cycle.is_empty() || self.initial.contains(&site))
        {
            self.next_first.get_or_insert(seed);
        }
        self.since.push(site);
    }

    /// The run continues with a simulation. The seed set since the last one, if it is not the one
    /// that the run is named by: what was drawn for the first population comes from another.
    pub fn goes_on(&mut self, generations: usize) -> Option<[f64; 6]> {
        self.in_cycle.extend(self.since.drain(..));
        self.next_first = None;
        let seed = self.waiting.take()?;
        if generations <= 1 {
            self.seed = Some(seed);
            return None;
        }
        Some(seed)
    }

    /// The seeds of the run that begins now.
    pub(crate) fn of_next_run(&self) -> Seeds {
        let chain = self
            .chain
            .map(|chain| Chain { first: self.next_first.unwrap_or(chain.first), next: chain.next });
        let seed = chain.map(|chain| chain.first);
        Seeds {
            seed,
            chain,
            inherited: seed.is_some() && seed == self.seed && self.next_first.is_none(),
            initial: self.initial.clone(),
            in_cycle: self.in_cycle.clone(),
            ..Seeds::default()
        }
    }

    /// The seeds of a search that began before its first simulation, as these were then; `now` is
    /// what was drawn since.
    pub(crate) fn of_next_search(&self, now: &Seeds) -> Seeds {
        let mut next = self.of_next_run();
        if let (Some(own), Some(now)) = (&mut next.chain, now.chain) {
            own.next = now.next;
        }
        next.inherited = false;
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seed(entry: f64) -> [f64; 6] {
        [entry; 6]
    }

    /// Draws with the state n, which leaves n + 1.
    fn draw(seeds: &mut Seeds, state: f64, site: u64, simulated: bool) {
        seeds.drawn(seed(state), seed(state + 1.0), site, simulated);
    }

    /// A first population at site 1, then generations that draw at site 2.
    fn run(seeds: &mut Seeds, first: f64, generations: u32) -> f64 {
        draw(seeds, first, 1, false);
        seeds.goes_on(0);
        for generation in 1..=generations {
            draw(seeds, first + f64::from(generation), 2, true);
            if generation < generations {
                seeds.goes_on(generation as usize);
            }
        }
        first + f64::from(generations) + 1.0
    }

    #[test]
    fn the_first_seed_counts() {
        let mut seeds = Seeds::default();
        draw(&mut seeds, 20.0, 1, false);
        draw(&mut seeds, 21.0, 1, false);
        assert_eq!(seeds.seed, Some(seed(20.0)));
        draw(&mut seeds, 30.0, 1, false);
        seeds.goes_on(0);
        draw(&mut seeds, 50.0, 1, true);
        assert_eq!(seeds.seed, Some(seed(30.0)), "another one may be for later");
    }

    /// A script initializes as always and then restores population and seed from a file.
    #[test]
    fn a_seed_restored_behind_the_initialization_is_the_one_that_counts() {
        let mut seeds = Seeds::default();
        draw(&mut seeds, 1.0, 1, false);
        seeds.goes_on(0);
        draw(&mut seeds, 77.0, 2, true);
        assert_eq!(seeds.goes_on(1), None);
        assert_eq!(seeds.seed, Some(seed(77.0)));
        draw(&mut seeds, 99.0, 2, true);
        assert_eq!(seeds.goes_on(2), Some(seed(99.0)), "changed in the middle of the run");
        assert_eq!(seeds.seed, Some(seed(77.0)));
    }

    /// The state that the first run has left, drawn from before or after the data are read.
    #[test]
    fn a_run_that_goes_on_with_the_saved_state_has_this_seed() {
        let mut first = Seeds::default();
        let state = run(&mut first, 1.0, 4);
        let mut next = first.of_next_run();
        draw(&mut next, state, 1, false);
        assert_eq!(next.seed, Some(seed(state)), "data, then population");
        draw(&mut first, state, 1, true);
        draw(&mut first, state + 1.0, 1, true);
        let mut before = first.of_next_run();
        assert_eq!(before.seed, Some(seed(state)), "population, then data");
        draw(&mut before, state + 2.0, 1, false);
        assert_eq!(before.seed, Some(seed(state)));
        assert_eq!(first.seed, Some(seed(1.0)));
    }
}
