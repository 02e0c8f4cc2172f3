//! A search whose best distinct individuals are refined by Levenberg-Marquardt from time to time.
//! The search itself is not disturbed. It ends when two rounds in a row, the second of them with
//! another set of starts, lead to the same best.

use super::multistart::Team;
use super::{Answers, Optimizer, Wants, has_failed, key};
use crate::diag::Fault;
use crate::ga::{Genomes, Mrg32k3a, order};

/// Questions of the search between two refinements.
const QUESTIONS: usize = 10;
/// Individuals that are refined together.
const STARTS: usize = 3;
/// Individuals remembered as candidates.
const CANDIDATES: usize = 24;
/// Individuals nearer than this in every gene are the same.
const DISTINCT: f64 = 0.05;
/// Refinements without improvement that end the run.
const ROUNDS_WITHOUT_GAIN: usize = 3;
/// The smallest relative gain that counts.
const GAIN: f64 = 1e-6;

/// A search with refinements.
pub struct Polished {
    search: Box<dyn Optimizer>,
    team: Option<Team>,
    /// Questions of the search since the last refinement.
    questions: usize,
    /// The best distinct individuals of this round, best first.
    candidates: Vec<(Vec<f64>, f64)>,
    /// Where refinements have started, so that none starts twice near the same place.
    started: Vec<Vec<f64>>,
    best: f64,
    rounds_without_gain: usize,
    exhausted: bool,
    /// The sum of squares at which the answers are noise of rounding.
    floor: f64,
    rng: Mrg32k3a,
}

impl Polished {
    /// Refines the results of `search`; a fitness below `floor` is as good as none.
    pub fn new(search: Box<dyn Optimizer>, floor: f64, rng: Mrg32k3a) -> Polished {
        Polished {
            search,
            team: None,
            questions: 0,
            candidates: Vec::new(),
            started: Vec::new(),
            best: f64::INFINITY,
            rounds_without_gain: 0,
            exhausted: false,
            floor,
            rng,
        }
    }

    fn remember(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        let fitness: Vec<f64> = (0..batch.len()).map(|k| answers.fitness(k)).collect();
        for k in order(&fitness).into_iter().take(STARTS * 2) {
            if has_failed(fitness[k]) {
                break;
            }
            self.candidates.push((batch.row(k).to_vec(), fitness[k]));
        }
        self.candidates.sort_by(|a, b| key(a.1).total_cmp(&key(b.1)));
        let mut distinct: Vec<(Vec<f64>, f64)> = Vec::with_capacity(CANDIDATES);
        for candidate in self.candidates.drain(..) {
            if distinct.len() < CANDIDATES
                && distinct.iter().all(|kept| is_far(&kept.0, &candidate.0))
            {
                distinct.push(candidate);
            }
        }
        self.candidates = distinct;
    }

    /// The best individual always, then those far from every earlier start, then a random one.
    fn begin_round(&mut self, n_genes: usize) {
        let mut starts: Vec<Vec<f64>> = Vec::new();
        for (number, (genome, _)) in self.candidates.iter().enumerate() {
            let fresh = self.started.iter().chain(&starts).all(|known| is_far(known, genome));
            if starts.len() < STARTS && (number == 0 || fresh) {
                starts.push(genome.clone());
            }
        }
        if starts.len() < STARTS {
            starts.push((0..n_genes).map(|_| self.rng.uniform()).collect());
        }
        self.started.extend(starts.iter().cloned());
        self.candidates.clear();
        self.team = Some(Team::new(starts.into_iter()));
    }

    fn end_round(&mut self, team: &Team) {
        let found = team.results().first().map_or(f64::INFINITY, |best| best.1);
        let gained = found < self.best * (1.0 - GAIN) && self.best > self.floor;
        self.rounds_without_gain = if gained { 0 } else { self.rounds_without_gain + 1 };
        self.best = self.best.min(found);
        self.questions = 0;
    }
}

fn is_far(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).any(|(a, b)| (a - b).abs() > DISTINCT)
}

impl Optimizer for Polished {
    fn ask(&mut self, batch: &mut Genomes) {
        if let Some(mut team) = self.team.take() {
            team.ask(batch);
            if !batch.is_empty() {
                self.team = Some(team);
                return;
            }
            self.end_round(&team);
        }
        if self.exhausted || self.rounds_without_gain >= ROUNDS_WITHOUT_GAIN {
            return;
        }
        if self.questions < QUESTIONS {
            self.search.ask(batch);
            self.exhausted = batch.is_empty();
        }
        if batch.is_empty() {
            self.begin_round(batch.n_genes());
            self.ask(batch);
        }
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        match &mut self.team {
            Some(team) => team.tell(batch, answers),
            None => {
                self.questions += 1;
                self.remember(batch, answers);
                self.search.tell(batch, answers);
            }
        }
    }

    fn wants(&self) -> Wants {
        self.team.as_ref().map_or_else(|| self.search.wants(), Team::wants)
    }

    fn phase(&self) -> &'static str {
        if self.team.is_some() { "refinement" } else { self.search.phase() }
    }

    fn change(&mut self, setting: &str, value: f64) -> Result<(), Fault> {
        self.search.change(setting, value)
    }

    fn rescale(&mut self, gene: usize, offset: f64, scale: f64) {
        self.search.rescale(gene, offset, scale);
        let known = self.candidates.iter_mut().map(|candidate| &mut candidate.0);
        for genome in known.chain(&mut self.started) {
            genome[gene] = (offset + scale * genome[gene]).clamp(0.0, 1.0);
        }
    }
}
