//! A job of many ranks on paper: rank 0 hands out chunks by the rule of the program
//! (`identify::ranks::chunk`), one message after the other, and its own thread simulates as well.
//! Bandwidth is left out: a result of 1 KB takes less than a microsecond in any network of a cluster.

use gapilib::internals::identify::ranks::chunk::{self, Times};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

/// A population on a cluster; simulations take between a half and one and a half times the mean.
#[derive(Debug, Clone, Copy)]
pub struct Cluster {
    pub ranks: usize,
    pub cores: usize,
    pub individuals: usize,
    /// Seconds of one simulation on a core of its own.
    pub simulation: f64,
    /// Seconds from sending a chunk to its answer without the simulations.
    pub message: f64,
    /// Seconds that rank 0 works for each message.
    pub handling: f64,
}

/// What a rank does.
#[derive(Default, Clone)]
struct Lane {
    /// When it has done what it was sent.
    free: u64,
    /// Individuals of the chunks that it was sent and that rank 0 does not know to be done.
    load: VecDeque<usize>,
}

/// The population under way; times in nanoseconds.
struct Population {
    cluster: Cluster,
    times: Times,
    lanes: Vec<Lane>,
    /// Answers on their way, by the time at which they arrive.
    answers: BinaryHeap<Reverse<(u64, usize)>>,
    remaining: usize,
    unfinished: usize,
    /// When rank 0 has handled its last message.
    busy: u64,
    /// The seed of the durations.
    state: u64,
    work: u64,
}

impl Cluster {
    /// The share of the time of all cores in which they simulate.
    pub fn efficiency(&self) -> f64 {
        let (work, end) = self.population();
        let used = self.ranks.min(self.cores) as f64 / self.cores as f64;
        used * work as f64 / (self.ranks as f64 * end as f64)
    }

    /// Seconds until the last individual is simulated.
    pub fn seconds(&self) -> f64 {
        self.population().1 as f64 * 1e-9
    }

    /// What a simulation takes on a rank that shares its core with others.
    fn shared(&self, seconds: f64) -> f64 {
        seconds * (self.ranks as f64 / self.cores as f64).max(1.0)
    }

    /// All simulations together, and the time at which the last has ended.
    fn population(&self) -> (u64, u64) {
        let simulation = Some(self.shared(self.simulation));
        let times = Times { simulation, message: self.message, handling: self.handling };
        let mut population = Population {
            cluster: *self,
            times,
            lanes: vec![Lane::default(); self.ranks - 1],
            answers: BinaryHeap::new(),
            remaining: self.individuals,
            unfinished: self.individuals,
            busy: 0,
            state: 1,
            work: 0,
        };
        let end = population.run();
        (population.work, end)
    }
}

fn nanoseconds(seconds: f64) -> u64 {
    (seconds * 1e9).round() as u64
}

impl Population {
    /// Until the last has ended.
    fn run(&mut self) -> u64 {
        // The first chunk of each lane, and the one behind it.
        for _ in 0..2 {
            (0..self.lanes.len()).for_each(|lane| self.send(lane, 0));
        }
        let (mut own, mut end) = (0, 0);
        loop {
            let answer = self.answers.peek().map_or(u64::MAX, |Reverse((at, _))| *at);
            if self.remaining > 0 && own <= answer {
                own += self.durations(1);
                self.remaining -= 1;
                self.unfinished -= 1;
                end = end.max(own);
                continue;
            }
            let Some(Reverse((at, lane))) = self.answers.pop() else { return end };
            self.unfinished -= self.lanes[lane].load.pop_front().unwrap_or(0);
            end = end.max(at);
            self.send(lane, at);
            self.send(lane, at);
        }
    }

    /// Gives a lane a chunk at the time `now`, if it is to have one.
    fn send(&mut self, lane: usize, now: u64) {
        let processors = self.lanes.len() + 1;
        if self.remaining == 0 {
            return;
        }
        let load: usize = self.lanes[lane].load.iter().sum();
        let size = match self.lanes[lane].load.len() {
            0 => chunk::size(&self.times, self.remaining, processors),
            1 => chunk::ahead(&self.times, (load, self.unfinished), self.remaining, processors),
            _ => 0,
        };
        if size == 0 {
            return;
        }
        let size = size.min(self.remaining);
        self.remaining -= size;
        self.busy = self.busy.max(now) + nanoseconds(self.cluster.handling);
        let half = nanoseconds(0.5 * self.cluster.message);
        let begin = self.lanes[lane].free.max(self.busy + half);
        let done = begin + self.durations(size);
        self.lanes[lane].free = done;
        self.lanes[lane].load.push_back(size);
        self.answers.push(Reverse((done + half, lane)));
    }

    fn durations(&mut self, count: usize) -> u64 {
        let simulation = self.times.simulation.unwrap_or(0.0);
        let mut all = 0;
        for _ in 0..count {
            // Knuth's linear congruential generator.
            self.state = self.state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let share = (self.state >> 40) as f64 / (1_u64 << 24) as f64;
            all += nanoseconds(simulation * (0.5 + share));
        }
        self.work += all;
        all
    }
}
