//! A fit of relative data as one in which scales and offsets are parameters like others: what their
//! standard errors, those of scaled curves, and the degrees of freedom follow from.

use super::relative::{Kind, Own, SolvedCoefficient};
use super::{Evaluation, Linearization, Problem};
use crate::elementary;

/// Scales and offsets at the best point.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Explicit {
    /// Their names and kinds.
    names: Vec<(String, Kind)>,
    /// Their values.
    values: Vec<f64>,
    /// Those that take part, in the order of their columns.
    active: Vec<usize>,
    /// The coefficients of each series.
    series: Vec<Own>,
    /// Derivatives of the points by the parameters and by the coefficients that take part.
    pub columns: Vec<Vec<f64>>,
}

impl Explicit {
    /// Those at `values`, with the solver's tolerance times `factor`; `None` where the problem has no
    /// relative data, or there is no simulation.
    pub fn at(
        problem: &Problem,
        evaluation: &Evaluation,
        values: &[f64],
        factor: f64,
    ) -> Option<Explicit> {
        evaluation.relative()?;
        let found = evaluation.linearize_unscaled(problem, &[values.to_vec()], factor).pop();
        Explicit::of(evaluation, found?.ok()?, values.len())
    }

    /// Their values alone, without derivatives.
    pub fn without_columns(evaluation: &Evaluation, values: &[f64]) -> Option<Explicit> {
        evaluation.relative()?;
        let row = evaluation.simulate_unscaled(&[values.to_vec()], 1.0).pop()?.ok()?;
        let found = Linearization {
            simulated: row,
            derivatives: Vec::new(),
            exact: false,
            refusal: None,
            simulations: 1,
            shares: Vec::new(),
        };
        Explicit::of(evaluation, found, 0)
    }

    fn of(evaluation: &Evaluation, mut found: Linearization, n: usize) -> Option<Explicit> {
        let relative = evaluation.relative()?;
        let scaled = evaluation.scaled_best(relative, &found.simulated);
        relative.scale_derivatives(&scaled, &mut found.derivatives);
        let column = |k: usize| found.derivatives.iter().skip(k).step_by(n).copied().collect();
        let mut columns: Vec<Vec<f64>> = (0..n).map(column).collect();
        let (active, own) = relative.columns(&scaled, &found.simulated).into_iter().unzip();
        let own: Vec<Vec<f64>> = own;
        columns.extend(own);
        let names = relative.coefficients().iter().map(|own| (own.name.clone(), own.kind));
        Some(Explicit {
            names: names.collect(),
            values: scaled.values,
            active,
            series: relative.series().to_vec(),
            columns,
        })
    }

    /// How many coefficients were estimated.
    pub fn count(&self) -> usize {
        self.active.len()
    }

    /// A point of a curve of a series, and its derivatives by parameters and coefficients, from those
    /// that the model has (with logarithms taken where these are compared); `None` where the series has
    /// no coefficients.
    pub fn scaled(&self, series: usize, value: f64, gradient: &[f64]) -> Option<(f64, Vec<f64>)> {
        let own = self.series.get(series)?;
        own.scale.or(own.offset)?;
        let factor = own.scale.filter(|_| !own.is_logarithmic).map_or(1.0, |c| self.values[c]);
        let shift = own.scale.filter(|_| own.is_logarithmic).map_or(0.0, |c| self.values[c])
            + own.offset.map_or(0.0, |c| self.values[c]);
        let entry = |c: &usize| match (own.scale == Some(*c), own.offset == Some(*c)) {
            (true, _) if !own.is_logarithmic => value,
            (false, false) => 0.0,
            _ => 1.0,
        };
        let by_parameters = gradient.iter().map(|g| factor * g);
        let all = by_parameters.chain(self.active.iter().map(entry)).collect();
        Some((factor * value + shift, all))
    }

    /// Scale and offset of the series with number `series`; `deviations`: standard errors of the
    /// coefficients that take part.
    pub fn solved(
        &self,
        series: usize,
        deviations: &[Option<f64>],
    ) -> [Option<SolvedCoefficient>; 2] {
        let own = self.series.get(series).copied().unwrap_or_default();
        let is_shared = |c: usize| {
            self.series.iter().filter(|own| [own.scale, own.offset].contains(&Some(c))).count() > 1
        };
        let coefficient = |c: usize| {
            let (name, kind) = &self.names[c];
            let at = self.active.iter().position(|own| *own == c);
            let deviation = at.and_then(|at| deviations.get(at).copied().flatten());
            let name = if is_shared(c) { name.clone() } else { String::new() };
            let value = self.values[c];
            match kind {
                Kind::Logarithm => {
                    let value = elementary::exp(value);
                    let deviation = deviation.map(|own| own * value);
                    SolvedCoefficient { name, value, deviation }
                }
                Kind::Scale | Kind::Offset => SolvedCoefficient { name, value, deviation },
            }
        };
        [own.scale, own.offset].map(|own| own.map(coefficient))
    }

    /// A scale or an offset by its name, where an experiment for validation has it.
    fn named(&self, name: &str, is_offset: bool) -> Option<(f64, Kind)> {
        let all = self.names.iter().zip(&self.values);
        let mut own = all.filter(|((_, kind), _)| (*kind == Kind::Offset) == is_offset);
        own.find(|((own, _), _)| own == name).map(|((_, kind), value)| (*value, *kind))
    }
}

impl Evaluation {
    /// Scales the simulation of a series that was not fitted, with the scale and the offset of fitted
    /// ones at the best values.
    pub fn scale_as_fitted(&self, values: &[f64], series: &super::Series, row: &mut [f64]) {
        if series.scaling.is_empty() {
            return;
        }
        let Some(found) = Explicit::without_columns(self, values) else { return };
        let scale = series.scaling.scale.as_ref().and_then(|own| found.named(&own.name, false));
        let factor = match scale {
            None => 1.0,
            Some((value, Kind::Logarithm)) => elementary::exp(value),
            Some((value, _)) => value,
        };
        let offset = series.scaling.offset.as_ref().and_then(|own| found.named(own, true));
        let offset = offset.map_or(0.0, |own| own.0);
        row.iter_mut().for_each(|y| *y = factor * *y + offset);
    }
}
