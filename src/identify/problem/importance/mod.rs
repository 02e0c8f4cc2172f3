//! Before a fit: which parameters matter for the compared points at all, over the whole search
//! space. Two ways, one file each: screening by single changes, which is cheap, and shares of the
//! variance, which say more.

mod morris;
mod sobol;

use super::{Evaluation, Problem};
use crate::diag::Fault;
use crate::elementary;
use crate::registry::{Entry, Options};
use crate::table::{quoted, significant};
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// A parameter whose figure is below this part of the largest hardly matters.
const HARDLY: f64 = 0.01;

/// How much each parameter matters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Importance {
    /// The name of the way.
    pub method: String,
    /// What the two figures are.
    pub headings: [String; 2],
    /// The parameters in their order.
    pub parameters: Vec<ParameterImportance>,
    /// Simulations that it took.
    pub simulations: u64,
    /// How many of them failed; what depends on them is left out.
    pub failed: u64,
}

/// How much one parameter matters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParameterImportance {
    /// Its name.
    pub name: String,
    /// The figures; `None` where too many simulations failed.
    pub figures: [Option<f64>; 2],
    /// Their standard errors from the sampling.
    pub errors: [Option<f64>; 2],
}

/// A way to find out how much parameters matter.
pub trait Analysis {
    /// Analyses a problem with `samples` base samples; 0 for the usual number. `None` where some
    /// belong to other shards.
    ///
    /// # Errors
    ///
    /// A seed that random numbers cannot start from.
    fn importance(
        &self,
        problem: &Problem,
        evaluation: &Evaluation,
        samples: usize,
    ) -> Result<Option<Importance>, Fault>;
}

/// All ways.
pub(crate) const ANALYSES: &[&Entry<dyn Analysis>] = &[&morris::ENTRY, &sobol::ENTRY];

/// The way of a name.
///
/// # Errors
///
/// `bad-option`, with the names that there are.
pub fn analysis(name: &str) -> Result<Box<dyn Analysis>, Fault> {
    (crate::registry::find("sensitivity analysis", ANALYSES, name)?.make)(&mut Options::default())
}

impl Importance {
    /// A table, and in words what hardly matters.
    pub fn text(&self) -> String {
        let mut text = format!("\nSensitivity ({})\n\n", self.method);
        let width = self.parameters.iter().map(|p| p.name.len()).max().unwrap_or(0).max(9);
        let [first, second] = &self.headings;
        // Writing into a String cannot fail.
        _ = writeln!(text, "  {:<width$}  {first:<20}  {second}", "parameter");
        for parameter in &self.parameters {
            let [first, second] = [0, 1].map(|k| figure(parameter.figures[k], parameter.errors[k]));
            _ = writeln!(text, "  {:<width$}  {first:<20}  {second}", parameter.name);
        }
        _ = writeln!(text, "\n  {} simulations, {} failed", self.simulations, self.failed);
        let idle = self.hardly_matter();
        if !idle.is_empty() {
            let verb = if idle.len() == 1 { "matters" } else { "matter" };
            _ = writeln!(
                text,
                "  {} hardly {verb} in these ranges: fix what you know.",
                idle.join(", ")
            );
        }
        text
    }

    /// Parameters that hardly matter.
    pub(crate) fn hardly_matter(&self) -> Vec<&str> {
        // Both figures of the screening and the total share are zero without any effect.
        let size =
            |p: &ParameterImportance| p.figures.iter().flatten().copied().fold(0.0, f64::max);
        let largest = self.parameters.iter().map(size).fold(0.0, f64::max);
        let known = self.parameters.iter().filter(|p| p.figures.iter().all(Option::is_some));
        known.filter(|p| size(p) <= HARDLY * largest).map(|p| p.name.as_str()).collect()
    }

    /// One line for each parameter.
    pub fn csv(&self) -> String {
        let [first, second] = self.headings.clone().map(|heading| heading.replace(' ', "_"));
        let mut text = format!("parameter,{first},{second},{first}_deviation,{second}_deviation\n");
        for parameter in &self.parameters {
            text += &quoted(&parameter.name);
            for value in parameter.figures.iter().chain(&parameter.errors) {
                _ = write!(text, ",{}", value.map_or(String::new(), |value| value.to_string()));
            }
            text.push('\n');
        }
        text
    }
}

fn figure(value: Option<f64>, error: Option<f64>) -> String {
    match (value, error) {
        (Some(value), Some(error)) => {
            format!("{} ± {}", significant(value, 3), significant(error, 2))
        }
        (Some(value), None) => significant(value, 3),
        (None, _) => "-".to_owned(),
    }
}

/// The values of the parameters at a place of the unit cube.
fn values(problem: &Problem, place: &[f64]) -> Vec<f64> {
    problem.parameters.iter().zip(place).map(|(free, u)| free.value(u.clamp(0.0, 1.0))).collect()
}

/// Mean and its standard error; `None` for fewer than two.
fn mean(values: &[f64]) -> Option<(f64, f64)> {
    let count = values.len() as f64;
    if values.len() < 2 {
        return None;
    }
    let mean = values.iter().sum::<f64>() / count;
    let square: f64 = values.iter().map(|v| elementary::powi(v - mean, 2)).sum();
    Some((mean, (square / (count - 1.0) / count).sqrt()))
}

#[cfg(test)]
mod tests;
