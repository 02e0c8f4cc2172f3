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

/// A model with its filter.
pub(crate) struct Filtered {
    pub translated: Translated,
    /// For each output the variables that hold its prediction from all earlier samples and the standard
    /// deviation of that, each from its sample on.
    pub outputs: Vec<[String; 2]>,
    /// The uncertain states, and the variables that hold their variances.
    pub states: Vec<[String; 2]>,
}

/// Compiles a model with its filter, for simulations from `start` on.
///
/// # Errors
///
/// What is wrong with the model; what a filter cannot follow.
pub(crate) fn filtered(
    session: &mut Session,
    class: &str,
    (noise, measured): (&[Noise], &[Measured]),
    start: f64,
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
    let mut filter =
        Filter { flat: &mut flat, uncertain: &uncertain, measured, start, n, channels, text };
    filter.declare(&own_noise);
    filter.record();
    filter.write(&own_noise);
    let Filter { text, .. } = filter;
    add_equations(&mut flat, &text).map_err(|fault| vec![fault.at(place)])?;
    let mut sorted = causalize::causalize(&flat).map_err(one)?;
    uncertain.install(&mut sorted, &outputs).at(place).map_err(one)?;
    let program = Program::compile(sorted).map_err(one)?;
    let states = uncertain.states.iter().enumerate();
    Ok(Filtered {
        outputs: (0..outputs.len()).map(|k| [prediction(k), deviation(k)]).collect(),
        states: states.map(|(i, state)| [state.clone(), covariance(0, [i, i])]).collect(),
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

fn prediction(output: usize) -> String {
    format!("'prediction {}'", output + 1)
}

fn deviation(output: usize) -> String {
    format!("'standard deviation of prediction {}'", output + 1)
}

/// An entry of the covariance after the update by so many outputs.
fn covariance(outputs: usize, [i, j]: [usize; 2]) -> String {
    let (i, j) = (i.max(j) + 1, i.min(j) + 1);
    match outputs {
        0 => format!("'covariance {i} {j}'"),
        _ => format!("'covariance {i} {j} after {outputs}'"),
    }
}

/// What an update by so many outputs adds to a state.
fn correction(outputs: usize, state: usize) -> String {
    format!("'correction {} after {outputs}'", state + 1)
}

/// P hᵀ of an output.
fn product(output: usize, state: usize) -> String {
    format!("'product {} of output {}'", state + 1, output + 1)
}

fn before(output: usize) -> String {
    format!("'prediction {} before its sample'", output + 1)
}

fn variance(output: usize) -> String {
    format!("'variance of prediction {}'", output + 1)
}

/// A recorded input for an output.
fn channel(what: &str, output: usize) -> String {
    format!("'{what} of output {}'", output + 1)
}

/// A filter that is being written.
struct Filter<'a> {
    flat: &'a mut FlatModel,
    uncertain: &'a Uncertainty,
    measured: &'a [Measured],
    start: f64,
    /// Number of uncertain states.
    n: usize,
    /// Its recorded inputs.
    channels: Vec<String>,
    /// Equations.
    text: String,
}

impl Filter<'_> {
    fn pairs(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let n = self.n;
        (0..n).flat_map(|i| (0..=i).map(move |j| [i, j]))
    }

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
        for [i, j] in self.pairs() {
            let nominal = nominals(i) * nominals(j);
            let variance = noise[i].filter(|_| i == j).map_or(0.0, |own| own.initial * own.initial);
            let state = self.declared(&covariance(0, [i, j]), BaseType::Real, continuous);
            attribute(state, "start", ExpressionKind::Real(variance));
            attribute(state, "fixed", ExpressionKind::Boolean(true));
            let always = ExpressionKind::Integer(StateSelect::Always as i64 + 1);
            attribute(state, "stateSelect", always);
            if nominal > 0.0 {
                attribute(state, "nominal", ExpressionKind::Real(nominal));
            }
        }
        let rates = self.uncertain.rates.iter().map(|own| rate(*own));
        let gains = self.uncertain.gains.iter().map(|own| gain(*own));
        for entry in rates.chain(gains).collect::<Vec<_>>() {
            let entry = self.declared(&entry, BaseType::Real, Variability::Parameter);
            // Not 0, which the compiler would take as a number.
            entry.binding = Some(Expression::new(ExpressionKind::Real(1.0), Span::NONE));
        }
        for k in 0..self.measured.len() {
            for name in [before(k), variance(k)] {
                self.declared(&name, BaseType::Real, continuous);
            }
            for name in [prediction(k), deviation(k)] {
                self.declared(&name, BaseType::Real, Variability::Discrete);
            }
            for i in 0..self.n {
                self.declared(&product(k, i), BaseType::Real, continuous);
                self.declared(&correction(k + 1, i), BaseType::Real, continuous);
            }
            for pair in self.pairs() {
                self.declared(&covariance(k + 1, pair), BaseType::Real, continuous);
            }
        }
        if self.begins_uncertain(noise) {
            let first = self.declared(FIRST, BaseType::Boolean, Variability::Discrete);
            attribute(first, "start", ExpressionKind::Boolean(true));
            attribute(first, "fixed", ExpressionKind::Boolean(true));
        }
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
        let times = self.times();
        match times.as_slice() {
            [first, .., last] => (last - first) / (times.len() - 1) as f64,
            _ => 1.0,
        }
    }

    /// The times of all samples.
    fn times(&self) -> Vec<f64> {
        let mut times: Vec<f64> =
            self.measured.iter().flat_map(|own| own.times.iter().copied()).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Makes inputs of what was measured: between two samples they hold that of the second one, so that at
    /// a sample their previous values are its own.
    fn record(&mut self) {
        let times = self.times();
        let later = times.iter().copied().filter(|time| *time > self.start);
        let knots: Vec<f64> = std::iter::once(self.start).chain(later).collect();
        let numbers: Vec<f64> = (0..knots.len()).map(|number| number as f64).collect();
        self.follow(SAMPLE, BaseType::Integer, (&knots, numbers));
        for (k, own) in self.measured.iter().enumerate() {
            let at = |time: &f64| own.times.binary_search_by(|own| own.total_cmp(time)).ok();
            let of = |values: &[f64]| -> Vec<f64> {
                let next = knots[1..].iter().map(|time| at(time).map_or(0.0, |at| values[at]));
                let mut held: Vec<f64> = next.collect();
                held.push(held.last().copied().unwrap_or(0.0));
                held
            };
            self.follow(&channel("value", k), BaseType::Real, (&knots, of(&own.values)));
            let ones = vec![f64::from(own.is_used); own.times.len()];
            self.follow(&channel("presence", k), BaseType::Real, (&knots, of(&ones)));
            if let MeasuredSigma::Samples(sigma) = &own.sigma {
                let mut sigma = of(sigma);
                // Where there is none, no variance may become zero.
                sigma.iter_mut().filter(|own| **own == 0.0).for_each(|own| *own = 1.0);
                self.follow(&channel("deviation", k), BaseType::Real, (&knots, sigma));
            }
        }
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
        for pair in self.pairs() {
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
        let m = self.measured.len();
        for i in 0..self.n {
            let state = &self.uncertain.states[i];
            let line = format!("reinit({state}, {state} + {});", correction(m, i));
            self.line(&line);
        }
        for pair in self.pairs() {
            let line = format!("reinit({}, {});", covariance(0, pair), covariance(m, pair));
            self.line(&line);
        }
        self.predictions();
        if begins_uncertain {
            self.line(&format!("{FIRST} = false;"));
        }
        self.line("end when;\ninitial equation");
        for name in std::mem::take(&mut self.channels) {
            self.line(&format!("pre({name}) = {name};"));
        }
        self.predictions();
    }

    /// What each output is predicted as, and how well.
    fn predictions(&mut self) {
        for k in 0..self.measured.len() {
            let [mean, sd] = [prediction(k), deviation(k)];
            let line = format!("{mean} = {};\n{sd} = sqrt({});", before(k), variance(k));
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
                terms.push(format!("{}*{}", rate((row, k)), covariance(0, [k, other])));
            }
        }
        terms.extend(noise[i].filter(|_| i == j).map(|own| format!("({})^2", own.density)));
        let line = format!("der({}) = {};", covariance(0, [i, j]), sum(&terms));
        self.line(&line);
    }

    /// The prediction of an output and what its sample changes, after those of the outputs before it.
    fn output(&mut self, k: usize, begins_uncertain: bool) {
        let own = &self.measured[k];
        let gains: Vec<usize> =
            (0..self.n).filter(|i| self.uncertain.gains.contains(&(k, *i))).collect();
        let previous = |input: &str, first: f64| match begins_uncertain {
            true => format!("(if pre({FIRST}) then {first:e} else pre({input}))"),
            false => format!("pre({input})"),
        };
        let at_start = own.times.first() == Some(&self.start);
        let first = |values: &[f64], other: f64| if at_start { values[0] } else { other };
        let value = previous(&channel("value", k), first(&own.values, 0.0));
        let presence = previous(&channel("presence", k), f64::from(at_start && own.is_used));
        let sigma = match &own.sigma {
            MeasuredSigma::Expression(text) => format!("({text})"),
            MeasuredSigma::Samples(sigma) => previous(&channel("deviation", k), first(sigma, 1.0)),
        };
        for i in 0..self.n {
            let terms =
                gains.iter().map(|j| format!("{}*{}", gain((k, *j)), covariance(k, [i, *j])));
            let line = format!("{} = {};", product(k, i), sum(&terms.collect::<Vec<_>>()));
            self.line(&line);
        }
        let mut terms: Vec<String> =
            gains.iter().map(|i| format!("{}*{}", gain((k, *i)), product(k, *i))).collect();
        terms.push(format!("{sigma}^2"));
        let line = format!("{} = {};", variance(k), sum(&terms));
        self.line(&line);
        let mut terms = vec![own.name.clone()];
        terms.extend(
            gains
                .iter()
                .filter(|_| k > 0)
                .map(|i| format!("{}*{}", gain((k, *i)), correction(k, *i))),
        );
        let line = format!("{} = {};", before(k), sum(&terms));
        self.line(&line);
        for i in 0..self.n {
            let (g, v, e) = (product(k, i), variance(k), before(k));
            let mut terms = vec![format!("{presence}*{g}*({value} - {e})/{v}")];
            terms.extend((k > 0).then(|| correction(k, i)));
            let line = format!("{} = {};", correction(k + 1, i), sum(&terms));
            self.line(&line);
        }
        for [i, j] in self.pairs() {
            let line = format!(
                "{} = {} - {presence}*{}*{}/{};",
                covariance(k + 1, [i, j]),
                covariance(k, [i, j]),
                product(k, i),
                product(k, j),
                variance(k)
            );
            self.line(&line);
        }
    }
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
