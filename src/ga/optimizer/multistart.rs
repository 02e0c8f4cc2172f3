//! Multistart: Levenberg-Marquardt from the best points of a Latin hypercube, several descents
//! side by side, again and again with new points.

use super::levenberg_marquardt::Descent;
use super::{Answers, Method, Optimizer, Setup, Wants, has_failed, whole};
use crate::diag::Fault;
use crate::ga::sampling::latin_hypercube;
use crate::ga::{Genomes, Mrg32k3a, order};
use crate::registry::Entry;

/// The table entry.
pub(super) const ENTRY: Entry<dyn Method> = Entry {
    name: "multistart",
    aliases: &["multi-start"],
    summary: "Levenberg-Marquardt from the best points of a Latin hypercube",
    reference: "nocedal-wright-2006",
    make: |options| {
        Ok(Box::new(Multistart {
            points: whole(options, "points", 1.0..=1e6, 40.0)?,
            starts: whole(options, "starts", 1.0..=1e4, 4.0)?,
        }))
    },
};

/// Steps of one descent.
pub(super) const STEPS: usize = 60;

struct Multistart {
    points: usize,
    starts: usize,
}

impl Method for Multistart {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        let mut rng = setup.rng;
        let mut sample = latin_hypercube(setup.genes.len(), self.points, &mut rng);
        if let Some(start) = setup.start {
            sample.row_mut(0).copy_from_slice(&start);
        }
        let starts = self.starts.min(self.points);
        Ok(Box::new(Search { rng, starts, sample, team: None }))
    }

    fn needs_residuals(&self) -> bool {
        true
    }

    fn can_be_polished(&self) -> bool {
        false
    }
}

struct Search {
    rng: Mrg32k3a,
    starts: usize,
    sample: Genomes,
    /// The descents under way; `None` while the sample is evaluated.
    team: Option<Team>,
}

impl Optimizer for Search {
    fn ask(&mut self, batch: &mut Genomes) {
        if let Some(team) = &mut self.team {
            team.ask(batch);
            if !batch.is_empty() {
                return;
            }
            self.team = None;
            self.sample = latin_hypercube(batch.n_genes(), self.sample.len(), &mut self.rng);
        }
        self.sample.rows().for_each(|genome| batch.push(genome));
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        if let Some(team) = &mut self.team {
            team.tell(batch, answers);
            return;
        }
        let fitness: Vec<f64> = (0..batch.len()).map(|k| answers.fitness(k)).collect();
        let best = order(&fitness).into_iter().filter(|&k| !has_failed(fitness[k]));
        let starts = best.take(self.starts).map(|k| batch.row(k).to_vec());
        self.team = Some(Team::new(starts));
    }

    fn wants(&self) -> Wants {
        self.team.as_ref().map_or(Wants::Objectives, Team::wants)
    }

    fn phase(&self) -> &'static str {
        if self.team.is_some() { "least squares" } else { "sampling" }
    }
}

/// Descents whose questions are asked together: trials first, then Jacobians.
pub(super) struct Team {
    descents: Vec<Descent>,
    /// Individuals that each asked in the last question.
    shares: Vec<usize>,
    wants: Wants,
}

impl Team {
    pub(super) fn new(starts: impl Iterator<Item = Vec<f64>>) -> Team {
        let descents: Vec<Descent> = starts.map(|start| Descent::new(start, STEPS)).collect();
        Team { shares: vec![0; descents.len()], descents, wants: Wants::Residuals }
    }

    pub(super) fn ask(&mut self, batch: &mut Genomes) {
        for wants in [Wants::Residuals, Wants::Jacobians] {
            self.wants = wants;
            for (descent, share) in self.descents.iter_mut().zip(&mut self.shares) {
                let before = batch.len();
                if descent.wants() == wants {
                    descent.ask(batch);
                }
                *share = batch.len() - before;
            }
            if !batch.is_empty() {
                return;
            }
        }
    }

    pub(super) fn wants(&self) -> Wants {
        self.wants
    }

    pub(super) fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        let mut first = 0;
        for (descent, &share) in self.descents.iter_mut().zip(&self.shares) {
            if share > 0 {
                descent.tell(batch, &answers.part(first, first + share, batch.len()));
                first += share;
            }
        }
    }

    /// Where the descents stand, best first.
    pub(super) fn results(&self) -> Vec<(Vec<f64>, f64)> {
        let mut results: Vec<(Vec<f64>, f64)> = self
            .descents
            .iter()
            .map(|descent| descent.best())
            .map(|(x, f)| (x.to_vec(), f))
            .collect();
        results.sort_by(|a, b| a.1.total_cmp(&b.1));
        results
    }
}
