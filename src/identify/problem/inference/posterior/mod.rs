//! The posterior distribution of the parameters by Markov chain Monte Carlo.
//!
//! The likelihood is normal; where the standard deviations of the measurements are not given, their
//! common one is integrated out with the prior 1/σ, so that the density is proportional to
//! S^(−n/2), S being the sum of squares; the same for each output whose own is estimated. Parameters without a prior are uniform over their range on
//! the scale that is searched. Chains start about the best point, spread twice as wide as the
//! covariance says, and go on until R-hat and the effective sample size are good or the limit is
//! reached. Each chain has its own random numbers and simulator: threads do not matter, and a
//! resumed run draws the same chains again.
//!
//! Reference: [Gelman et al. 2013](gapilib_base::bibliography#gelman-2013), chapters 3, 11 and 12.

pub mod diagnostics;
mod sampler;

use super::Local;
use crate::diag::Fault;
use crate::elementary;
use crate::ga::Mrg32k3a;
use crate::problem::{ErrorModel, Evaluation, Free, Problem, Run, Simulate, other_shards};
use crate::table::significant;
use nalgebra::DMatrix;
use sampler::{Chain, Drawn};
use serde::{Deserialize, Serialize};
use std::sync::{Mutex, PoisonError};

/// The stream of random numbers, far from those of the search and of the bootstrap.
const STREAM: u64 = 1_000_033;
/// Chains.
const CHAINS: usize = 4;
/// Steps of warm-up.
const WARM_UP: usize = 1000;
/// Draws of the first round; every further round doubles them.
const FIRST: usize = 1000;
/// Chains beyond this R-hat have not converged (Vehtari et al. 2021, section 4).
const CONVERGED: f64 = 1.01;
/// Fewer independent draws give no intervals (the same: 100 for each of 4 chains).
const ENOUGH: f64 = 400.0;
/// Where a direction is open or wider than the range, chains start with this part of the range.
const OPEN: f64 = 0.3;
/// A posterior is cut by an end of the range where more than this share of the draws lies within this
/// part of its 95 % interval beside the end; of a normal distribution that ends two standard
/// deviations from it, 0.5 % do.
const CUT: f64 = 0.01;
const NEAR_END: f64 = 0.05;
/// Rows of `posterior.csv` at most.
const ROWS: usize = 4000;

/// What is said where chains have no proposal.
const NOT_DEFINITE: &str =
    "There is no posterior: the covariance at the best point is not positive definite.";

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosteriorSettings {
    /// Draws of each chain at most.
    pub samples: usize,
}

/// The answer.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Posterior {
    /// Chains.
    pub chains: usize,
    /// Draws of each.
    pub draws: usize,
    /// Share of the steps that moved.
    pub(crate) acceptance: f64,
    /// Whether all chains agree and hold enough independent draws.
    pub converged: bool,
    /// For each parameter.
    pub parameters: Vec<Sampled>,
    /// Draws, evenly thinned, chain by chain, in `posterior.csv`.
    #[serde(skip)]
    pub rows: Vec<Vec<f64>>,
}

/// The posterior of a parameter.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Sampled {
    /// Its name.
    pub name: String,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
    /// 2.5 %, 25 %, 50 %, 75 % and 97.5 %.
    pub quantiles: [f64; 5],
    /// Rank-normalized split R-hat.
    pub(crate) r_hat: Option<f64>,
    /// Effective sample size of the bulk.
    pub(crate) bulk_ess: Option<f64>,
    /// Effective sample size of the tails.
    pub(crate) tail_ess: Option<f64>,
    /// The ends of the search range that cut the posterior: its density does not vanish there.
    #[serde(default)]
    pub cut: [Option<f64>; 2],
}

/// The posterior; `None` where it is refused.
pub fn posterior(
    run: &Run,
    settings: &PosteriorSettings,
    local: &Local,
    refusals: &mut Vec<String>,
) -> Result<Option<Posterior>, Fault> {
    let problem = &run.problem;
    let source = Mrg32k3a::new(&problem.seed)?.stream(STREAM);
    let centre: Vec<f64> =
        problem.parameters.iter().zip(&local.values).map(|(free, v)| free.fraction(*v)).collect();
    let covariance = start_covariance(problem, local);
    let density = Density::new(run, local);
    let begin = |number: usize, simulator: &mut dyn Simulate| {
        let mut target = |u: &[f64]| density.at(simulator, u);
        let rng = source.substream(number as u64);
        let mut chain = Chain::new(&centre, &covariance, rng, &mut target)?;
        chain.warm_up(WARM_UP, &mut target);
        Some(chain)
    };
    if run.evaluation.parts.are_divided() {
        return Ok(in_shards(run, settings, local, (&density, &begin), refusals));
    }
    run.evaluation.show("posterior: warm-up of the chains");
    let begun: Option<Vec<Chain>> = run.evaluation.each(CHAINS, begin).into_iter().collect();
    let Some(chains) = begun else {
        refusals.push(NOT_DEFINITE.to_owned());
        return Ok(None);
    };
    let chains: Vec<Mutex<Chain>> = chains.into_iter().map(Mutex::new).collect();
    let mut last = None;
    let mut drawn = 0;
    for count in rounds(settings.samples) {
        drawn += count;
        run.evaluation.show(&format!("posterior: draw {drawn} of {}", settings.samples));
        run.evaluation.each(CHAINS, |number, simulator| {
            let mut chain = chains[number].lock().unwrap_or_else(PoisonError::into_inner);
            chain.draw(count, &mut |u| density.at(simulator, u));
        });
        if run.evaluation.is_cancelled() {
            return Ok(None);
        }
        let chains: Vec<_> =
            chains.iter().map(|c| c.lock().unwrap_or_else(PoisonError::into_inner)).collect();
        let drawn: Vec<&Drawn> = chains.iter().map(|chain| &chain.drawn).collect();
        let posterior = summary(problem, &drawn);
        let converged = posterior.converged;
        last = Some(posterior);
        if converged {
            break;
        }
    }
    Ok(last)
}

/// The posterior where shards have chains: each draws its own to the end.
fn in_shards(
    run: &Run,
    settings: &PosteriorSettings,
    local: &Local,
    (density, begin): (&Density<'_>, &Begin<'_>),
    refusals: &mut Vec<String>,
) -> Option<Posterior> {
    let chain = |number: usize, simulator: &mut dyn Simulate| {
        let mut chain = begin(number, simulator)?;
        for count in rounds(settings.samples) {
            chain.draw(count, &mut |u| density.at(simulator, u));
        }
        Some(chain.drawn)
    };
    let all = run.evaluation.each_part("posterior", &local.values, CHAINS, chain);
    let Some(all) = all else {
        refusals.push(other_shards("posterior"));
        return None;
    };
    let Some(all) = all.into_iter().collect::<Option<Vec<Drawn>>>() else {
        refusals.push(NOT_DEFINITE.to_owned());
        return None;
    };
    (!run.evaluation.is_cancelled()).then(|| merged(&run.problem, &all))
}

/// Begins a chain.
type Begin<'a> = dyn Fn(usize, &mut dyn Simulate) -> Option<Chain> + Sync + 'a;

/// Draws of each round: as many as all before, until there are `most`.
fn rounds(most: usize) -> impl Iterator<Item = usize> {
    let mut drawn = 0;
    std::iter::from_fn(move || {
        let count = FIRST.max(drawn).min(most - drawn);
        drawn += count;
        (count > 0).then_some(count)
    })
}

/// The posterior of chains that were drawn to the end, cut where they agree.
fn merged(problem: &Problem, chains: &[Drawn]) -> Posterior {
    let of_round = |round: usize| -> Posterior {
        let cut: Vec<Drawn> = chains.iter().map(|chain| chain.up_to(round)).collect();
        summary(problem, &cut.iter().collect::<Vec<_>>())
    };
    let rounds = chains.iter().map(|chain| chain.rounds.len()).min().unwrap_or(1);
    let early = (0..rounds.saturating_sub(1)).map(of_round).find(|found| found.converged);
    early.unwrap_or_else(|| of_round(rounds.saturating_sub(1)))
}

/// The covariance in the unit cube; the diagonal where a direction is open.
fn start_covariance(problem: &Problem, local: &Local) -> DMatrix<f64> {
    let n = local.values.len();
    let unit: Vec<f64> =
        problem.parameters.iter().zip(&local.values).map(|(free, v)| free.derivative(*v)).collect();
    let widest = OPEN * OPEN;
    if let Some(covariance) = local.information.covariance() {
        let cube = DMatrix::from_fn(n, n, |k, l| covariance[(k, l)] / (unit[k] * unit[l]));
        if (0..n).all(|k| cube[(k, k)] < widest) {
            return cube;
        }
    }
    let own = local.information.variances();
    let entry =
        |k: usize| own[k].map_or(widest, |v| (v / elementary::powi(unit[k], 2)).min(widest));
    DMatrix::from_fn(n, n, |k, l| if k == l { entry(k) } else { 0.0 })
}

/// The logarithm of the posterior density in the unit cube.
struct Density<'a> {
    problem: &'a Problem,
    evaluation: &'a Evaluation,
    local: &'a Local,
    error_model: ErrorModel,
    measured: Vec<f64>,
}

impl<'a> Density<'a> {
    fn new(run: &'a Run, local: &'a Local) -> Density<'a> {
        let (problem, evaluation) = (&run.problem, &run.evaluation);
        let error_model = match ErrorModel::of(problem) {
            // Deviations that are given but not believed share one unknown factor.
            ErrorModel::Known if !local.known => ErrorModel::OneVariance,
            own => own,
        };
        let measured = problem.series.iter().flat_map(|series| series.y.clone()).collect();
        Density { problem, evaluation, local, error_model, measured }
    }

    fn at(&self, simulator: &mut dyn Simulate, u: &[f64]) -> f64 {
        if u.iter().any(|u| !(0.0..=1.0).contains(u)) {
            return f64::NEG_INFINITY;
        }
        let values: Vec<f64> =
            self.problem.parameters.iter().zip(u).map(|(free, u)| free.value(*u)).collect();
        let mut row = vec![f64::NAN; self.measured.len()];
        if simulator.simulate(&values, &mut row).is_err() {
            return f64::NEG_INFINITY;
        }
        let likelihood = match self.error_model {
            // The objective is the negative logarithm itself.
            ErrorModel::Estimated | ErrorModel::Computed => {
                -self.evaluation.objective(self.problem, &row)
            }
            ErrorModel::Known => -0.5 * self.square(&row),
            ErrorModel::OneVariance => {
                -0.5 * self.measured.len() as f64 * elementary::ln(self.square(&row))
            }
        };
        let density = likelihood + self.measure(&values);
        if density.is_nan() { f64::NEG_INFINITY } else { density }
    }

    fn square(&self, row: &[f64]) -> f64 {
        let points = row.iter().zip(&self.measured).zip(&self.local.scales);
        points.map(|((s, m), w)| elementary::powi(w * (s - m), 2)).sum()
    }

    /// Between the density of the prior and that in the unit cube.
    fn measure(&self, values: &[f64]) -> f64 {
        let one = |prior: &super::Prior| {
            let logarithm = elementary::ln(values[prior.parameter]);
            match (prior.is_logarithmic(), self.problem.parameters[prior.parameter].logarithmic) {
                (true, false) => -logarithm,
                (false, true) => logarithm,
                _ => 0.0,
            }
        };
        self.problem.inference.priors.iter().map(one).sum()
    }
}

fn summary(problem: &Problem, chains: &[&Drawn]) -> Posterior {
    let parameter = |k: usize| {
        let free = &problem.parameters[k];
        let draws = |chain: &Drawn| chain.draws.iter().map(|u| free.value(u[k])).collect();
        let values: Vec<Vec<f64>> = chains.iter().map(|chain| draws(chain)).collect();
        Sampled { cut: cut_by(free, chains, k), ..sampled(&free.name, &values) }
    };
    let parameters: Vec<Sampled> = (0..problem.parameters.len()).map(parameter).collect();
    let good = |p: &Sampled| {
        let enough = |ess: Option<f64>| ess.is_some_and(|ess| ess >= ENOUGH);
        p.r_hat.is_some_and(|r| r <= CONVERGED) && enough(p.bulk_ess) && enough(p.tail_ess)
    };
    let count: usize = chains.iter().map(|chain| chain.draws.len()).sum();
    let every = count.div_ceil(ROWS).max(1);
    // As many rows of each chain: their places say which chain they are of.
    let thinned = chains.iter().flat_map(|chain| chain.draws.iter().step_by(every));
    let values = |u: &Vec<f64>| {
        problem.parameters.iter().zip(u.iter()).map(|(free, u)| free.value(*u)).collect()
    };
    Posterior {
        chains: chains.len(),
        draws: chains[0].draws.len(),
        acceptance: chains.iter().map(|chain| chain.acceptance()).sum::<f64>()
            / chains.len() as f64,
        converged: parameters.iter().all(good),
        parameters,
        rows: thinned.map(values).collect(),
    }
}

/// The ends of the range near which there are more draws than there would be in the tail of a
/// distribution that ends within it.
fn cut_by(free: &Free, chains: &[&Drawn], k: usize) -> [Option<f64>; 2] {
    let mut all: Vec<f64> = chains.iter().flat_map(|chain| &chain.draws).map(|u| u[k]).collect();
    all.sort_by(f64::total_cmp);
    let [low, high] = [0.025, 0.975].map(|p| super::bootstrap::quantile(&all, p));
    let near = NEAR_END * (high - low);
    let share = |count: usize| count as f64 / all.len() as f64;
    let below = share(all.iter().filter(|u| **u < near).count());
    let above = share(all.iter().filter(|u| **u > 1.0 - near).count());
    [(below, free.min), (above, free.max)].map(|(share, end)| (share > CUT).then_some(end))
}

fn sampled(name: &str, chains: &[Vec<f64>]) -> Sampled {
    let mut all: Vec<f64> = chains.concat();
    all.sort_by(f64::total_cmp);
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    let square: f64 = all.iter().map(|value| elementary::powi(value - mean, 2)).sum();
    let finite = |value: f64| Some(value).filter(|value| value.is_finite());
    Sampled {
        name: name.to_owned(),
        mean,
        sd: (square / (all.len() as f64 - 1.0)).sqrt(),
        quantiles: [0.025, 0.25, 0.5, 0.75, 0.975].map(|p| super::bootstrap::quantile(&all, p)),
        r_hat: finite(diagnostics::r_hat(chains)),
        bulk_ess: finite(diagnostics::bulk_ess(chains)),
        tail_ess: finite(diagnostics::tail_ess(chains)),
        cut: [None; 2],
    }
}

impl Posterior {
    /// In words; without intervals where the chains have not converged.
    pub(super) fn sentences(&self) -> Vec<String> {
        let number = |value: Option<f64>, digits| {
            value.map_or("unknown".to_owned(), |value| significant(value, digits))
        };
        let worst = self.parameters.iter().filter_map(|p| p.r_hat).fold(1.0, f64::max);
        let least = self.parameters.iter().filter_map(|p| p.bulk_ess.zip(p.tail_ess));
        let least = least.map(|(bulk, tail)| bulk.min(tail)).fold(f64::INFINITY, f64::min);
        let judged = format!(
            "R-hat at most {}, at least {} independent draws",
            significant(worst, 4),
            significant(least, 3)
        );
        if !self.converged {
            return vec![format!(
                "The chains did not converge after {} draws each ({judged}; 1.01 and 400 are \
                 required), so there are no intervals. Draw more samples, or fix a parameter \
                 that is not identifiable from the data.",
                self.draws
            )];
        }
        let mut sentences = vec![format!(
            "{} chains of {} draws ({judged}), medians with 95 % intervals:",
            self.chains, self.draws
        )];
        sentences.extend(self.parameters.iter().map(|p| {
            let [low, _, median, _, high] = p.quantiles.map(|q| significant(q, 4));
            format!(
                "{} = {median} in {low} to {high}, R-hat {}, bulk ESS {}, tail ESS {}",
                p.name,
                number(p.r_hat, 4),
                number(p.bulk_ess, 3),
                number(p.tail_ess, 3)
            )
        }));
        let cut = self
            .parameters
            .iter()
            .flat_map(|p| p.cut.iter().flatten().map(move |end| (&p.name, end)));
        sentences.extend(cut.map(|(name, end)| {
            format!(
                "The posterior of {name} is cut by the end {} of its search range, which acts as a \
                 prior: widen the range, unless the bound is physical.",
                significant(*end, 4)
            )
        }));
        sentences
    }

    /// `posterior.csv`: draws of all chains, evenly thinned.
    pub fn csv(&self) -> String {
        crate::table::table_csv(self.parameters.iter().map(|p| p.name.as_str()), &self.rows)
    }
}

#[cfg(test)]
mod tests;
