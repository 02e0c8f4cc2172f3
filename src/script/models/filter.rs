//! Models compiled with the extended Kalman filter of their outputs (continuous time, discrete samples):
//! between samples the covariance of the uncertain states is integrated with the model, at a sample both
//! are moved by what was measured.
//!
//! ```text
//!   between samples   Ṗ = A P + P Aᵀ + Q
//!   at a sample       s² = h P hᵀ + r²,  g = P hᵀ,  e = y − ŷ
//!                     x += g e/s²,  P −= g gᵀ/s²        one output after the other
//! ```
//!
//! All of it is written as equations and a when-clause around the flat model, so that integration, exact
//! steps of linear models, events and sensitivities are those of any model. The outputs of one sample
//! are taken one after the other with one linearization, which is the update by all of them at once, and
//! its innovations are independent. The covariance itself is carried, not a factor of it: its equation
//! is linear, so that models which are linear have exact steps with their filter as well.
//!
//! Reference: [Jazwinski 1970](gapilib_base::bibliography#jazwinski-1970), sections 7.3 and 8.3.

use super::simulation;
use super::smoother::Smoothing;
use super::translated::Translated;
use crate::Session;
use crate::causalize;
use crate::codegen::{Program, Uncertainty, gain, rate};
use crate::diag::{At as _, Diagnostic, Fault};
use crate::fault;
use crate::flatten::{Attribute, BaseType, FlatModel, RecordedInput, Variability, Variable};
use crate::lower::StateSelect;
use crate::registry::BAD_OPTION;
use crate::source::{SourceId, Span};
use crate::syntax;
use crate::syntax::ast::{CausalityPrefix, ClassSpecifier, Expression, ExpressionKind, Section};
use std::fmt::Write as _;

/// The number of the next sample, counted from 0.
const SAMPLE: &str = "'number of samples'";
/// Whether the sample at the start is still to come.
const FIRST: &str = "'before the first sample'";
/// The number of the sample from which predictions over several begin first.
pub(crate) const FIRST_BEGIN: &str = "'first begin'";
/// For each sample the remainder of its number by the number of samples that predictions go over.
const REMAINDER: &str = "'remainder of the number'";

/// Noise of a state.
#[derive(Debug, Clone)]
pub(crate) struct Noise {
    /// The state.
    pub state: String,
    /// The root of its spectral density, as an expression of the model's parameters.
    pub density: String,
    /// About how large that is.
    pub scale: f64,
    /// The standard deviation of its initial value.
    pub initial: f64,
}

/// An output that was measured.
#[derive(Debug, Clone)]
pub(crate) struct Measured {
    /// The variable.
    pub name: String,
    /// When, ascending.
    pub times: Vec<f64>,
    /// What.
    pub values: Vec<f64>,
    /// The standard deviation of the errors.
    pub sigma: MeasuredSigma,
    /// Whether it moves the states; else it is only predicted.
    pub is_used: bool,
}

/// The standard deviation of measurement errors.
#[derive(Debug, Clone)]
pub(crate) enum MeasuredSigma {
    /// An expression of the model's parameters.
    Expression(String),
    /// One for each value.
    Samples(Vec<f64>),
}

/// What a model is filtered for.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Purpose<'a> {
    /// The likelihood of what was measured.
    Likelihood,
    /// Smoothed states.
    Smoothing,
    /// Predictions over several samples.
    Ahead(&'a Ahead),
}

/// Predictions over several samples from the states that a filter has found. One simulation takes
/// every so many of them; [`FIRST_BEGIN`] is the number of the first one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ahead {
    /// Over how many samples.
    pub steps: usize,
    /// The times of all samples.
    pub times: Vec<f64>,
    /// At each of them: the uncertain states, then the covariances of [`pairs`].
    pub found: Vec<Vec<f64>>,
}

impl Ahead {
    /// The number of a sample at this time, and of the next one where there is none; the start is 0.
    pub(crate) fn number(&self, start: f64, time: f64) -> usize {
        let later = self.times.iter().filter(|own| **own > start && **own < time).count();
        later + usize::from(time > start)
    }
}

/// A model with its filter.
pub(crate) struct Filtered {
    pub translated: Translated,
    /// For each output the variables that hold its prediction from all earlier samples and the standard
    /// deviation of that, each from its sample on.
    pub outputs: Vec<[String; 2]>,
    pub states: UncertainStates,
}

/// Variables about the uncertain states of a filtered model.
#[derive(Debug, Clone, Default)]
pub(crate) struct UncertainStates {
    /// The states.
    pub names: Vec<String>,
    /// Their covariances, of [`pairs`].
    pub covariances: Vec<String>,
    /// The times of the rows, which are those of the samples and those that were asked for.
    pub times: Vec<f64>,
    /// What a smoother needs; empty unless that is the purpose.
    pub smoothing: Smoothing,
}

/// Entries of the lower half of a symmetric matrix.
pub(crate) fn pairs(n: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..n).flat_map(|i| (0..=i).map(move |j| [i, j]))
}

/// Compiles a model with its filter, for simulations from `start` on. `more`: times of rows besides
/// those of the samples.
///
/// # Errors
///
/// What is wrong with the model; what a filter cannot follow.
pub(crate) fn filtered(
    session: &mut Session,
    class: &str,
    (noise, measured, purpose): (&[Noise], &[Measured], Purpose<'_>),
    (start, more): (f64, &[f64]),
    place: Span,
) -> Result<Filtered, Vec<Diagnostic>> {
    let one = |error: Diagnostic| vec![error];
    let mut flat = simulation::flattened(session, class)?.model.clone();
    let noisy: Vec<String> = noise.iter().map(|own| own.state.clone()).collect();
    let outputs: Vec<String> = measured.iter().map(|own| own.name.clone()).collect();
    let mut sorted = causalize::causalize(&flat).map_err(one)?;
    let uncertain = Uncertainty::of(&mut sorted, &noisy, &outputs).at(place).map_err(one)?;
    let own_noise = noise_of_states(&sorted, &uncertain, noise);
    let n = uncertain.states.len();
    let (channels, text) = (Vec::new(), String::new());
    let uncertain = &uncertain;
    let names = Names::new(&uncertain.states, &outputs);
    let flat_model = &mut flat;
    let mut filter = Filter {
        flat: flat_model,
        uncertain,
        names,
        measured,
        purpose,
        start,
        more,
        n,
        channels,
        text,
    };
    filter.declare(&own_noise);
    filter.record();
    filter.write(&own_noise);
    let smoothing = match purpose {
        Purpose::Smoothing => filter.smoothing(),
        _ => Smoothing::default(),
    };
    let times = filter.rows();
    let Filter { text, names, .. } = filter;
    add_equations(&mut flat, &text).map_err(|fault| vec![fault.at(place)])?;
    let mut sorted = causalize::causalize(&flat).map_err(one)?;
    uncertain.install(&mut sorted, &outputs).at(place).map_err(one)?;
    let program = Program::compile(sorted).map_err(one)?;
    Ok(Filtered {
        outputs: (0..outputs.len()).map(|k| [names.prediction(k), names.deviation(k)]).collect(),
        states: UncertainStates {
            names: uncertain.states.clone(),
            covariances: pairs(n).map(|pair| names.covariance(0, pair)).collect(),
            times,
            smoothing,
        },
        translated: Translated::new(class, flat, program),
    })
}

/// The noise of each uncertain state, if it has any.
fn noise_of_states<'n>(
    sorted: &causalize::CausalizedDae,
    uncertain: &Uncertainty,
    noise: &'n [Noise],
) -> Vec<Option<&'n Noise>> {
    let place = |name: &str| sorted.dae.variables.iter().position(|own| &*own.name == name);
    let resolved = |name: &str| {
        let at = place(name)?;
        Some(sorted.aliases[at].map_or(at, |alias| alias.of.0 as usize))
    };
    let of = |state: &String| noise.iter().find(|own| resolved(&own.state) == place(state));
    uncertain.states.iter().map(of).collect()
}

/// The names of the variables of a filter, by the states and outputs that they belong to: messages of
/// simulations that fail show them.
struct Names {
    states: Vec<String>,
    outputs: Vec<String>,
}

impl Names {
    fn new(states: &[String], outputs: &[String]) -> Names {
        let plain = |all: &[String]| -> Vec<String> {
            let names: Vec<String> =
                all.iter().map(|name| name.replace(['\'', '\\'], "")).collect();
            // Replicate measurements have one variable.
            let is_alone = |name: &String| names.iter().filter(|own| *own == name).count() == 1;
            let numbered = names.iter().enumerate().map(|(k, name)| match is_alone(name) {
                true => name.clone(),
                false => format!("{name} ({})", k + 1),
            });
            numbered.collect()
        };
        Names { states: plain(states), outputs: plain(outputs) }
    }

    fn prediction(&self, output: usize) -> String {
        format!("'prediction of {}'", self.outputs[output])
    }

    fn deviation(&self, output: usize) -> String {
        format!("'standard deviation of the prediction of {}'", self.outputs[output])
    }

    /// An entry of the covariance after the update by so many outputs.
    fn covariance(&self, outputs: usize, [i, j]: [usize; 2]) -> String {
        let [first, second] = [i.min(j), i.max(j)].map(|state| self.states[state].as_str());
        let after = if outputs == 0 { String::new() } else { format!(" after {outputs}") };
        match i == j {
            true => format!("'variance of {first}{after}'"),
            false => format!("'covariance of {first} and {second}{after}'"),
        }
    }

    /// What an update by so many outputs adds to a state.
    fn correction(&self, outputs: usize, state: usize) -> String {
        format!("'correction of {} after {outputs}'", self.states[state])
    }

    /// P hᵀ of an output.
    fn product(&self, output: usize, state: usize) -> String {
        format!("'covariance of {} with the output {}'", self.states[state], self.outputs[output])
    }

    fn before(&self, output: usize) -> String {
        format!("'prediction of {} before its sample'", self.outputs[output])
    }

    fn variance(&self, output: usize) -> String {
        format!("'variance of the prediction of {}'", self.outputs[output])
    }

    /// A recorded input for an output.
    fn channel(&self, what: &str, output: usize) -> String {
        format!("'{what} of the output {}'", self.outputs[output])
    }

    /// A deviation of a state at the row before, as it has moved since.
    fn moved(&self, [i, j]: [usize; 2]) -> String {
        format!("'change of {} by {} since the last row'", self.states[i], self.states[j])
    }

    /// That at a row.
    fn transition(&self, [i, j]: [usize; 2]) -> String {
        format!("'change of {} by {} from row to row'", self.states[i], self.states[j])
    }
}

/// What the filter has at a sample, held.
fn held(name: &str) -> String {
    format!("'held: {}'", name.replace('\'', ""))
}

/// All entries of a square matrix.
fn entries(n: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..n).flat_map(move |i| (0..n).map(move |j| [i, j]))
}

/// A filter that is being written.
struct Filter<'a> {
    flat: &'a mut FlatModel,
    uncertain: &'a Uncertainty,
    names: Names,
    measured: &'a [Measured],
    purpose: Purpose<'a>,
    start: f64,
    /// Times of rows besides those of the samples.
    more: &'a [f64],
    /// Number of uncertain states.
    n: usize,
    /// Its recorded inputs.
    channels: Vec<String>,
    /// Equations.
    text: String,
}

impl Filter<'_> {
    /// Whether there is something to learn at the start: else the first prediction is certain but for the
    /// error of measurement.
    fn begins_uncertain(&self, noise: &[Option<&Noise>]) -> bool {
        let is_measured = self.measured.iter().any(|own| own.times.first() == Some(&self.start));
        is_measured && noise.iter().flatten().any(|own| own.initial > 0.0)
    }

    /// Variables of the filter.
    fn declare(&mut self, noise: &[Option<&Noise>]) {
        let continuous = Variability::Continuous;
        let interval = self.interval();
        let nominals = |i: usize| match noise[i] {
            Some(own) => (own.scale * interval.sqrt()).max(own.initial),
            None => 0.0,
        };
        for [i, j] in pairs(self.n) {
            let nominal = nominals(i) * nominals(j);
            let variance = noise[i].filter(|_| i == j).map_or(0.0, |own| own.initial * own.initial);
            let state = self.state(&self.names.covariance(0, [i, j]), variance);
            if nominal > 0.0 {
                attribute(state, "nominal", ExpressionKind::Real(nominal));
            }
        }
        let rates = self.uncertain.rates.iter().map(|own| rate(*own));
        let gains = self.uncertain.gains.iter().map(|own| gain(*own));
        let begin =
            matches!(self.purpose, Purpose::Ahead(_)).then(|| FIRST_BEGIN.to_owned()).into_iter();
        for entry in rates.chain(gains).chain(begin).collect::<Vec<_>>() {
            let entry = self.declared(&entry, BaseType::Real, Variability::Parameter);
            // Not 0, which the compiler would take as a number.
            entry.binding = Some(Expression::new(ExpressionKind::Real(1.0), Span::NONE));
        }
        for k in 0..self.measured.len() {
            for name in [self.names.before(k), self.names.variance(k)] {
                self.declared(&name, BaseType::Real, continuous);
            }
            for name in [self.names.prediction(k), self.names.deviation(k)] {
                self.declared(&name, BaseType::Real, Variability::Discrete);
            }
            for i in 0..self.n {
                self.declared(&self.names.product(k, i), BaseType::Real, continuous);
                self.declared(&self.names.correction(k + 1, i), BaseType::Real, continuous);
            }
            for pair in pairs(self.n) {
                self.declared(&self.names.covariance(k + 1, pair), BaseType::Real, continuous);
            }
        }
        if matches!(self.purpose, Purpose::Smoothing) {
            self.declare_smoothing();
        }
        if self.begins_uncertain(noise) {
            let first = self.declared(FIRST, BaseType::Boolean, Variability::Discrete);
            attribute(first, "start", ExpressionKind::Boolean(true));
            attribute(first, "fixed", ExpressionKind::Boolean(true));
        }
    }

    /// A state of the filter.
    fn state(&mut self, name: &str, start: f64) -> &mut Variable {
        let state = self.declared(name, BaseType::Real, Variability::Continuous);
        attribute(state, "start", ExpressionKind::Real(start));
        attribute(state, "fixed", ExpressionKind::Boolean(true));
        let always = ExpressionKind::Integer(StateSelect::Always as i64 + 1);
        attribute(state, "stateSelect", always);
        state
    }

    fn declared(&mut self, name: &str, base: BaseType, variability: Variability) -> &mut Variable {
        let variable = Variable {
            name: name.into(),
            base,
            dims: Vec::new(),
            variability,
            causality: None,
            is_input: false,
            is_final: false,
            protected: true,
            evaluate: false,
            is_relative: false,
            structural: false,
            top_level: true,
            attributes: [].into_iter().collect(),
            binding: None,
            description: None,
            span: Span::NONE,
        };
        self.flat.variables.entry(name.into()).insert_entry(variable).into_mut()
    }

    /// The mean time between samples.
    fn interval(&self) -> f64 {
        let times = self.samples();
        match times.as_slice() {
            [first, .., last] => (last - first) / (times.len() - 1) as f64,
            _ => 1.0,
        }
    }

    /// The times of all samples.
    fn samples(&self) -> Vec<f64> {
        ascending(self.measured.iter().flat_map(|own| own.times.iter().copied()))
    }

    /// The times at which states are estimated.
    fn rows(&self) -> Vec<f64> {
        ascending(self.samples().into_iter().chain(self.more.iter().copied()))
    }

    /// Makes inputs of what was measured: between two samples they hold that of the second one, so that at
    /// a sample their previous values are its own.
    fn record(&mut self) {
        let after = self.rows().into_iter().filter(|time| *time > self.start);
        let knots: Vec<f64> = std::iter::once(self.start).chain(after).collect();
        let numbers: Vec<f64> = (0..knots.len()).map(|number| number as f64).collect();
        self.follow(SAMPLE, BaseType::Integer, (&knots, numbers));
        if let Purpose::Ahead(ahead) = self.purpose {
            self.record_found(ahead, &knots);
        }
        for (k, own) in self.measured.iter().enumerate() {
            let at = |time: &f64| own.times.binary_search_by(|own| own.total_cmp(time)).ok();
            let of = |values: &[f64]| -> Vec<f64> {
                later(knots.iter().map(|time| at(time).map_or(0.0, |at| values[at])))
            };
            self.follow(&self.names.channel("value", k), BaseType::Real, (&knots, of(&own.values)));
            let ones = vec![f64::from(own.is_used); own.times.len()];
            self.follow(&self.names.channel("presence", k), BaseType::Real, (&knots, of(&ones)));
            if let MeasuredSigma::Samples(sigma) = &own.sigma {
                let mut sigma = of(sigma);
                // Where there is none, no variance may become zero.
                sigma.iter_mut().filter(|own| **own == 0.0).for_each(|own| *own = 1.0);
                self.follow(&self.names.channel("deviation", k), BaseType::Real, (&knots, sigma));
            }
        }
    }

    /// The same for the states from which predictions over several samples begin.
    fn record_found(&mut self, ahead: &Ahead, knots: &[f64]) {
        let sample = |time: &f64| ahead.times.binary_search_by(|own| own.total_cmp(time)).ok();
        // Predictions begin at samples alone.
        let remainder = |time: &f64| {
            sample(time).map_or(-1.0, |_| (ahead.number(self.start, *time) % ahead.steps) as f64)
        };
        let remainders = later(knots.iter().map(remainder));
        self.follow(REMAINDER, BaseType::Real, (knots, remainders));
        for (at, name) in self.found().iter().enumerate() {
            let values = knots.iter().map(|time| ahead.found[sample(time).unwrap_or(0)][at]);
            self.follow(&recorded(name), BaseType::Real, (knots, later(values)));
        }
    }

    /// The variables that a filter finds.
    fn found(&self) -> Vec<String> {
        let covariances = pairs(self.n).map(|pair| self.names.covariance(0, pair));
        self.uncertain.states.iter().cloned().chain(covariances).collect()
    }

    fn follow(&mut self, name: &str, base: BaseType, (times, values): (&[f64], Vec<f64>)) {
        let input = self.declared(name, base, Variability::Discrete);
        (input.causality, input.is_input) = (Some(CausalityPrefix::Input), true);
        self.channels.push(name.to_owned());
        self.flat.recorded.push(RecordedInput {
            name: name.into(),
            times: times.into(),
            values: values.into(),
            is_held: true,
        });
    }

    /// The equations.
    fn write(&mut self, noise: &[Option<&Noise>]) {
        let begins_uncertain = self.begins_uncertain(noise);
        for pair in pairs(self.n) {
            self.covariance_rate(pair, noise);
        }
        for k in 0..self.measured.len() {
            self.output(k, begins_uncertain);
        }
        let mut trigger = format!("{SAMPLE} > pre({SAMPLE})");
        if begins_uncertain {
            // Once, at the start.
            trigger = format!("{{{trigger}, sample({:e}, 1e300)}}", self.start);
        }
        self.line(&format!("when {trigger} then"));
        match self.purpose {
            Purpose::Ahead(ahead) => self.restart(ahead, begins_uncertain),
            _ => self.update(),
        }
        self.predictions();
        let is_smoothed = matches!(self.purpose, Purpose::Smoothing);
        if is_smoothed {
            self.hold();
            for [i, j] in entries(self.n) {
                let moved = self.names.moved([i, j]);
                self.line(&format!("reinit({moved}, {});", f64::from(i == j)));
            }
        }
        if begins_uncertain {
            self.line(&format!("{FIRST} = false;"));
        }
        self.line("end when;\ninitial equation");
        for name in std::mem::take(&mut self.channels) {
            self.line(&format!("pre({name}) = {name};"));
        }
        self.predictions();
        if is_smoothed {
            self.hold();
        }
    }

    /// The variables that a smoother needs.
    fn smoothing(&self) -> Smoothing {
        let (n, outputs) = (self.n, 0..self.measured.len());
        let products = |k: usize| (0..n).map(|i| held(&self.names.product(k, i))).collect();
        let gains = |k: usize| {
            let of_output = self.uncertain.gains.iter().filter(|own| own.0 == k);
            of_output.map(|own| (own.1, held(&gain(*own)))).collect()
        };
        Smoothing {
            transitions: entries(n).map(|entry| self.names.transition(entry)).collect(),
            products: outputs.clone().map(products).collect(),
            gains: outputs.map(gains).collect(),
        }
    }

    /// What is held for a smoother, and what it is taken from.
    fn held(&self) -> Vec<[String; 2]> {
        let pairs = (0..self.measured.len()).flat_map(|k| (0..self.n).map(move |i| (k, i)));
        let products = pairs.map(|(k, i)| self.names.product(k, i));
        let gains = self.uncertain.gains.iter().map(|own| gain(*own));
        let all = products.chain(gains).map(|name| [held(&name), name]);
        let moved = |entry: [usize; 2]| [self.names.transition(entry), self.names.moved(entry)];
        entries(self.n).map(moved).chain(all).collect()
    }

    /// Holds it, before the states are moved.
    fn hold(&mut self) {
        for [name, source] in self.held() {
            self.line(&format!("{name} = {source};"));
        }
    }

    /// Declares what a smoother needs, and lets deviations of the states move.
    fn declare_smoothing(&mut self) {
        for [i, j] in entries(self.n) {
            let moved = self.names.moved([i, j]);
            self.state(&moved, f64::from(i == j));
            let by = (0..self.n).filter(|k| self.uncertain.rates.contains(&(i, *k)));
            let terms: Vec<String> =
                by.map(|k| format!("{}*{}", rate((i, k)), self.names.moved([k, j]))).collect();
            self.line(&format!("der({moved}) = {};", sum(&terms)));
        }
        for [name, _] in self.held() {
            self.declared(&name, BaseType::Real, Variability::Discrete);
        }
    }

    /// Moves the states by what was measured.
    fn update(&mut self) {
        let m = self.measured.len();
        for i in 0..self.n {
            let state = &self.uncertain.states[i];
            let line = format!("reinit({state}, {state} + {});", self.names.correction(m, i));
            self.line(&line);
        }
        for pair in pairs(self.n) {
            let line = format!(
                "reinit({}, {});",
                self.names.covariance(0, pair),
                self.names.covariance(m, pair)
            );
            self.line(&line);
        }
    }

    /// Sets them to what was found, at every so many samples.
    fn restart(&mut self, ahead: &Ahead, begins_uncertain: bool) {
        let remainder = previous(REMAINDER, 0.0, begins_uncertain);
        for (at, name) in self.found().iter().enumerate() {
            let found = previous(&recorded(name), ahead.found[0][at], begins_uncertain);
            let line = format!(
                "reinit({name}, if abs({remainder} - {FIRST_BEGIN}) < 0.5 then {found} else {name});"
            );
            self.line(&line);
        }
    }

    /// What each output is predicted as, and how well.
    fn predictions(&mut self) {
        for k in 0..self.measured.len() {
            let [mean, sd] = [self.names.prediction(k), self.names.deviation(k)];
            let line = format!(
                "{mean} = {};\n{sd} = sqrt({});",
                self.names.before(k),
                self.names.variance(k)
            );
            self.line(&line);
        }
    }

    fn line(&mut self, line: &str) {
        // Writing into a String cannot fail.
        _ = writeln!(self.text, "{line}");
    }

    /// Ṗ = A P + P Aᵀ + Q
    fn covariance_rate(&mut self, [i, j]: [usize; 2], noise: &[Option<&Noise>]) {
        let mut terms = Vec::new();
        for (row, other) in [(i, j), (j, i)] {
            for k in (0..self.n).filter(|k| self.uncertain.rates.contains(&(row, *k))) {
                terms.push(format!("{}*{}", rate((row, k)), self.names.covariance(0, [k, other])));
            }
        }
        terms.extend(noise[i].filter(|_| i == j).map(|own| format!("({})^2", own.density)));
        let line = format!("der({}) = {};", self.names.covariance(0, [i, j]), sum(&terms));
        self.line(&line);
    }

    /// The prediction of an output and what its sample changes, after those of the outputs before it.
    fn output(&mut self, k: usize, begins_uncertain: bool) {
        let own = &self.measured[k];
        let gains: Vec<usize> =
            (0..self.n).filter(|i| self.uncertain.gains.contains(&(k, *i))).collect();
        let previous = |input: &str, first: f64| previous(input, first, begins_uncertain);
        let at_start = own.times.first() == Some(&self.start);
        let first = |values: &[f64], other: f64| if at_start { values[0] } else { other };
        let value = previous(&self.names.channel("value", k), first(&own.values, 0.0));
        let presence =
            previous(&self.names.channel("presence", k), f64::from(at_start && own.is_used));
        let sigma = match &own.sigma {
            MeasuredSigma::Expression(text) => format!("({text})"),
            MeasuredSigma::Samples(sigma) => {
                previous(&self.names.channel("deviation", k), first(sigma, 1.0))
            }
        };
        for i in 0..self.n {
            let terms = gains
                .iter()
                .map(|j| format!("{}*{}", gain((k, *j)), self.names.covariance(k, [i, *j])));
            let line =
                format!("{} = {};", self.names.product(k, i), sum(&terms.collect::<Vec<_>>()));
            self.line(&line);
        }
        let mut terms: Vec<String> = gains
            .iter()
            .map(|i| format!("{}*{}", gain((k, *i)), self.names.product(k, *i)))
            .collect();
        terms.push(format!("{sigma}^2"));
        let line = format!("{} = {};", self.names.variance(k), sum(&terms));
        self.line(&line);
        let mut terms = vec![own.name.clone()];
        terms.extend(
            gains
                .iter()
                .filter(|_| k > 0)
                .map(|i| format!("{}*{}", gain((k, *i)), self.names.correction(k, *i))),
        );
        let line = format!("{} = {};", self.names.before(k), sum(&terms));
        self.line(&line);
        for i in 0..self.n {
            let (g, v, e) =
                (self.names.product(k, i), self.names.variance(k), self.names.before(k));
            let mut terms = vec![format!("{presence}*{g}*({value} - {e})/{v}")];
            terms.extend((k > 0).then(|| self.names.correction(k, i)));
            let line = format!("{} = {};", self.names.correction(k + 1, i), sum(&terms));
            self.line(&line);
        }
        for [i, j] in pairs(self.n) {
            let line = format!(
                "{} = {} - {presence}*{}*{}/{};",
                self.names.covariance(k + 1, [i, j]),
                self.names.covariance(k, [i, j]),
                self.names.product(k, i),
                self.names.product(k, j),
                self.names.variance(k)
            );
            self.line(&line);
        }
    }
}

/// The value of a recorded input before a sample; `first` at the sample at the start.
fn previous(input: &str, first: f64, begins_uncertain: bool) -> String {
    match begins_uncertain {
        true => format!("(if pre({FIRST}) then {first:e} else pre({input}))"),
        false => format!("pre({input})"),
    }
}

/// The recorded input with what was found of a variable.
fn recorded(name: &str) -> String {
    format!("'found: {}'", name.replace('\'', ""))
}

fn ascending(times: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut times: Vec<f64> = times.collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// Each value in the place of the one before it, and the last one twice.
fn later(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut all: Vec<f64> = values.skip(1).collect();
    all.push(all.last().copied().unwrap_or(0.0));
    all
}

fn sum(terms: &[String]) -> String {
    if terms.is_empty() { "0.0".to_owned() } else { terms.join(" + ") }
}

fn attribute(variable: &mut Variable, name: &'static str, kind: ExpressionKind) {
    let value = Expression::new(kind, Span::NONE);
    variable.attributes.insert(name, Attribute { value, is_final: false });
}

/// Adds equations and initial equations that are written as those of a class.
fn add_equations(flat: &mut FlatModel, text: &str) -> Result<(), Fault> {
    let text = format!("model Filter equation\n{text}end Filter;\n");
    let parsed = syntax::parse_stored_definition(SourceId::NONE, &text)
        .map_err(|error| fault!(BAD_OPTION, "{}", error.message))?;
    let Some(class) = parsed.classes.into_iter().next() else { return Ok(()) };
    let ClassSpecifier::Long(long) = &class.specifier else { return Ok(()) };
    for section in long.sections.iter() {
        match section {
            Section::Equations { initial: false, equations, .. } => {
                flat.equations.extend(equations.iter().cloned());
            }
            Section::Equations { equations, .. } => {
                flat.initial_equations.extend(equations.iter().cloned());
            }
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
#[path = "filter_tests.rs"]
mod tests;
