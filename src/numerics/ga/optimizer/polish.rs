//! A search and multistart together. First comes a descent by least squares from the start values, then
//! descents from the best points of a small Latin hypercube: where they show which minimum is the best,
//! that is all. Further descents begin at the other points of the hypercube. Where descents fail, fit
//! badly or seldom reach the best minimum, rounds of the search (a genetic algorithm, say) and larger
//! hypercubes give the starts. The search itself is not disturbed. It all ends when the best minimum
//! was reached from several starts and few others can be expected.

use super::descents::{FEWEST, Pool, is_far};
use super::exchange::{Exchanges, Scale};
use super::levenberg_marquardt::{Accuracy, reach};
use super::{Answers, DescentReport, Optimizer, Required, Setup, has_failed, key};
use crate::diag::Fault;
use crate::elementary;
use crate::ga::sampling::latin_hypercube;
use crate::ga::{Genomes, Mrg32k3a};

/// Requests of the search between two rounds of descents; before the first there is none.
const QUESTIONS: usize = 10;
/// Points of a Latin hypercube: this many for each gene, within limits; first few, and many where the
/// search has begun.
const FEW_POINTS: usize = 3;
const FEW: [usize; 2] = [8, 60];
const POINTS: usize = 10;
const SAMPLE: [usize; 2] = [30, 150];
/// Descents of a round that begin at points of the search, of the hypercube, and beside the best
/// minimum so far.
const FROM_SEARCH: usize = 1;
const FROM_SAMPLE: usize = 2;
const FROM_BEST: usize = 1;
/// Genes of the best minimum that are redrawn at most. Minima often differ in few: a frequency,
/// the place of a peak (ENSO has 9 genes, and two periods decide).
const REDRAWN: usize = 3;
/// One of so many points of a hypercube has small values where a linear range begins at 0, down to this
/// part of the range: a diffusivity of 3e-14 in 0 .. 1e-9 is found, which the other points never show.
const SMALL_EVERY: usize = 3;
const SMALLEST: f64 = 1e-10;
const DECADES: i32 = 10;
/// Where the first descent begins in a range whose middle is zero.
const BESIDE: f64 = 0.55;
/// Individuals of a question remembered as candidates.
const CANDIDATES: usize = 24;

/// What is asked at present.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    Search(usize),
    Sample,
    Descents,
}

/// A search with descents.
pub struct Polished {
    /// `None` for multistart alone.
    search: Option<Box<dyn Optimizer>>,
    pool: Pool,
    stage: Stage,
    rng: Mrg32k3a,
    points: usize,
    from_sample: usize,
    /// Points of the small samples before the search begins.
    few: usize,
    /// Whether the search has begun.
    has_searched: bool,
    /// Points of the sample asked last, without those beside the best minimum.
    asked: usize,
    /// A point given by the user, until a descent has begun there.
    given: Option<Vec<f64>>,
    /// Where the first descent began, until one with short steps has begun there.
    first: Option<Vec<f64>>,
    /// The best of the search and of the hypercube since the last round.
    found: Vec<(Vec<f64>, f64)>,
    sampled: Vec<(Vec<f64>, f64)>,
    /// The best of those beside the best minimum.
    beside: Vec<(Vec<f64>, f64)>,
    exchanges: Exchanges,
    /// What the genes mean, where that is known.
    scales: Vec<Scale>,
}

impl Polished {
    /// Descents besides `search`, with random numbers of their own.
    pub fn new(search: Box<dyn Optimizer>, setup: &Setup, rng: Mrg32k3a) -> Polished {
        let n = setup.genes.len();
        let points = (POINTS * n).clamp(SAMPLE[0], SAMPLE[1]);
        let few = (FEW_POINTS * n).clamp(FEW[0], FEW[1]);
        let mut alone = Polished::alone(setup, points, FROM_SAMPLE);
        let start = alone.given.take().unwrap_or_else(|| alone.middle(n));
        alone.first = Some(start.clone());
        alone.pool.begin(vec![start], [1, 0]);
        Polished { search: Some(search), stage: Stage::Descents, rng, few, ..alone }
    }

    /// Descents from hypercubes alone, with so many points and descents in a round.
    pub(super) fn alone(setup: &Setup, points: usize, from_sample: usize) -> Polished {
        Polished {
            search: None,
            pool: Pool::new(Accuracy::of(setup), reach(&setup.scales)),
            stage: Stage::Sample,
            rng: setup.rng.clone(),
            points,
            from_sample,
            few: points,
            has_searched: false,
            asked: 0,
            given: setup.start.clone(),
            first: None,
            found: Vec::new(),
            sampled: Vec::new(),
            beside: Vec::new(),
            exchanges: Exchanges::new(setup.scales.clone()),
            scales: setup.scales.clone(),
        }
    }

    /// The middle of the ranges, but not zero: models that depend on a square have no derivative there.
    fn middle(&self, n: usize) -> Vec<f64> {
        let is_zero = |scale: &Scale| !scale.logarithmic && scale.min + scale.max == 0.0;
        let one = |k: usize| if self.scales.get(k).is_some_and(is_zero) { BESIDE } else { 0.5 };
        (0..n).map(one).collect()
    }

    /// The starts of the next round, and how many of them owe nothing to earlier descents: what the
    /// user gave, then the best that are far from each other and from where descents have been. What
    /// is better than all descents always counts. Then an exchange of two genes. Last one for
    /// short steps, or none, which is the second number.
    fn starts(&mut self) -> (Vec<Vec<f64>>, [usize; 2]) {
        let mut starts: Vec<Vec<f64>> = self.given.take().into_iter().collect();
        let lacking = FEWEST.saturating_sub(self.pool.count());
        let from_sample = match &self.search {
            Some(_) => self.from_sample.max(lacking),
            None => self.from_sample,
        };
        self.pool.choose(&mut self.found, FROM_SEARCH, &mut starts);
        self.pool.choose(&mut self.sampled, from_sample, &mut starts);
        let independent = starts.len();
        self.pool.choose(&mut self.beside, FROM_BEST, &mut starts);
        self.found.clear();
        self.beside.clear();
        if self.has_searched || self.search.is_none() {
            self.sampled.clear();
        }
        if lacking == 0 {
            starts.extend(self.exchanged());
        }
        let short = self.short_start(lacking, &starts[..independent]);
        let counts = [independent, usize::from(short.is_some())];
        starts.extend(short);
        (starts, counts)
    }

    /// Where a descent with short steps begins after the first rounds: where the very first one began,
    /// then where one of the round begins. Genes that the residuals hardly depend on may cross their ranges
    /// in one long step, into parts where the residuals depend on nothing: of Fiedler_BMCSystBiol2016, with
    /// ranges of eight decades, 24 of 60 descents with long steps ended there. Short steps do not tell how
    /// many minima there are: on Boehm_JProteomeRes2014 10 of 11 such descents ended at the second-best one,
    /// and a search that counted them ended there with 2 of 3 seeds.
    fn short_start(&mut self, lacking: usize, starts: &[Vec<f64>]) -> Option<Vec<f64>> {
        if lacking > 0 || !self.pool.has_short_steps() {
            return None;
        }
        self.first.take().or_else(|| starts.last().cloned())
    }

    /// A place that differs from the best minimum by an exchange of two genes.
    fn exchanged(&mut self) -> Option<Vec<f64>> {
        let best = self.pool.best_place()?.to_vec();
        self.exchanges.next(&best, |a, b| !is_far(a, b))
    }

    /// The points of a sample: a Latin hypercube, and where the search has begun as many with some
    /// genes of the best minimum redrawn.
    fn sample(&mut self, batch: &mut Genomes) {
        let n = batch.n_genes();
        let is_wide = self.has_searched || self.search.is_none();
        self.asked = if is_wide { self.points } else { self.few };
        let sample = latin_hypercube(n, self.asked, &mut self.rng);
        for (number, genome) in sample.rows().enumerate() {
            let row: Vec<f64> = genome.to_vec();
            match number % SMALL_EVERY == SMALL_EVERY - 1 {
                true => batch.push(&self.small(row)),
                false => batch.push(&row),
            }
        }
        if !is_wide && self.pool.fits_badly() {
            self.scan(batch);
        }
        let best = self.pool.best_place().filter(|_| n > 1 && is_wide);
        let Some(best) = best else { return };
        let mut genome = best.to_vec();
        for other in latin_hypercube(n, self.points, &mut self.rng).rows() {
            genome.copy_from_slice(best);
            let redrawn = 1 + (self.rng.uniform() * REDRAWN.min(n - 1) as f64) as usize;
            for _ in 0..redrawn {
                let gene = ((self.rng.uniform() * n as f64) as usize).min(n - 1);
                genome[gene] = other[gene];
            }
            batch.push(&genome);
        }
    }

    /// The best minimum with one gene, whose linear range begins or ends at 0, at each order of magnitude:
    /// all descents may end on a plateau far from the one that matters (3e-14 in 0 .. 1e-9).
    fn scan(&self, batch: &mut Genomes) {
        let Some(best) = self.pool.best_place() else { return };
        for (gene, scale) in self.scales.iter().enumerate().filter(|(_, s)| !s.logarithmic) {
            for decade in 1..=DECADES {
                let small = elementary::powi(0.1, decade);
                let mut genome = best.to_vec();
                match (scale.min == 0.0, scale.max == 0.0) {
                    (true, _) => genome[gene] = small,
                    (_, true) => genome[gene] = 1.0 - small,
                    _ => break,
                }
                batch.push(&genome);
            }
        }
    }

    /// The point with the genes whose linear range begins or ends at 0 at small values: such a range
    /// does not say of which order of magnitude the value is.
    fn small(&self, mut genome: Vec<f64>) -> Vec<f64> {
        for (gene, scale) in genome.iter_mut().zip(&self.scales).filter(|(_, s)| !s.logarithmic) {
            let from = |part: f64| elementary::powf(SMALLEST, 1.0 - part);
            if scale.min == 0.0 {
                *gene = from(*gene);
            } else if scale.max == 0.0 {
                *gene = 1.0 - from(1.0 - *gene);
            }
        }
        genome
    }

    fn next_stage(&mut self) {
        self.stage = match (self.stage, &self.search) {
            (Stage::Search(left), _) if left > 1 => Stage::Search(left - 1),
            (Stage::Search(_), _) => Stage::Sample,
            (Stage::Sample, _) => self.begin_round(),
            (Stage::Descents, Some(_)) => self.after_round(),
            (Stage::Descents, None) => Stage::Sample,
        };
    }

    fn begin_round(&mut self) -> Stage {
        let (starts, counts) = self.starts();
        self.pool.begin(starts, counts);
        Stage::Descents
    }

    /// What follows a round that is not enough.
    fn after_round(&mut self) -> Stage {
        let has_begun = self.pool.count() >= FEWEST;
        if self.has_searched || has_begun && self.pool.is_doubtful() {
            self.has_searched = true;
            Stage::Search(QUESTIONS)
        } else if has_begun && self.sampled.iter().any(|(genome, _)| self.pool.is_new(genome)) {
            self.begin_round()
        } else {
            Stage::Sample
        }
    }
}

/// Keeps the best of both.
fn remember(
    kept: &mut Vec<(Vec<f64>, f64)>,
    batch: &Genomes,
    answers: &Answers<'_>,
    which: std::ops::Range<usize>,
) {
    let all = which.map(|k| (k, answers.fitness(k)));
    let mut good: Vec<(usize, f64)> = all.filter(|(_, fitness)| !has_failed(*fitness)).collect();
    good.sort_by(|a, b| key(a.1).total_cmp(&key(b.1)));
    kept.extend(good.iter().take(CANDIDATES).map(|&(k, f)| (batch.row(k).to_vec(), f)));
    kept.sort_by(|a, b| key(a.1).total_cmp(&key(b.1)));
    kept.truncate(CANDIDATES);
}

impl Optimizer for Polished {
    fn ask(&mut self, batch: &mut Genomes) {
        // Each stage asks something, but for a search that has converged and a round that is over.
        for _ in 0..4 {
            match self.stage {
                Stage::Search(_) => {
                    if let Some(search) = &mut self.search {
                        search.ask(batch);
                    }
                    if batch.is_empty() {
                        self.stage = Stage::Sample;
                    }
                }
                Stage::Sample => {
                    self.sample(batch);
                }
                Stage::Descents => {
                    self.pool.ask(batch);
                    if batch.is_empty() && self.pool.is_enough() {
                        if self.pool.finish() {
                            self.pool.ask(batch);
                        }
                        return;
                    }
                    if batch.is_empty() {
                        self.next_stage();
                    }
                }
            }
            if !batch.is_empty() {
                return;
            }
        }
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        match (self.stage, &mut self.search) {
            (Stage::Descents, _) => return self.pool.tell(batch.len(), answers),
            (Stage::Search(_), Some(search)) => {
                remember(&mut self.found, batch, answers, 0..batch.len());
                search.tell(batch, answers);
            }
            _ => {
                let count = batch.len().min(self.asked);
                remember(&mut self.sampled, batch, answers, 0..count);
                remember(&mut self.beside, batch, answers, count..batch.len());
            }
        }
        self.next_stage();
    }

    fn required(&self) -> Required {
        match (self.stage, &self.search) {
            (Stage::Descents, _) => self.pool.required(),
            (Stage::Search(_), Some(search)) => search.required(),
            _ => Required::Objectives,
        }
    }

    fn phase(&self) -> &'static str {
        match (self.stage, &self.search) {
            (Stage::Descents, _) => "least squares",
            (Stage::Search(_), Some(search)) => search.phase(),
            _ => "sampling",
        }
    }

    fn fault(&self) -> Option<&Fault> {
        self.search.as_ref()?.fault()
    }

    fn descents(&self) -> Vec<DescentReport> {
        self.pool.reports()
    }

    fn change(&mut self, setting: &str, value: f64) -> Result<(), Fault> {
        match &mut self.search {
            Some(search) => search.change(setting, value),
            None => Err(crate::fault!(
                crate::registry::BAD_OPTION,
                "`{setting}` cannot be changed to {value} during the run"
            )),
        }
    }

    fn rescale(&mut self, gene: usize, offset: f64, scale: f64) {
        if let Some(search) = &mut self.search {
            search.rescale(gene, offset, scale);
        }
        // Derivatives and distances of the descents belong to the ranges that were.
        self.pool.clear();
        self.first = None;
        self.found.clear();
        self.sampled.clear();
        self.beside.clear();
        self.exchanges = Exchanges::default();
        if self.stage == Stage::Descents {
            self.next_stage();
        }
        if let Some(given) = &mut self.given {
            given[gene] = (offset + scale * given[gene]).clamp(0.0, 1.0);
        }
    }
}
