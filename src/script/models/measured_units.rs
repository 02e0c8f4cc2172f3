//! Units of measured columns beside those of the variables that they are compared with. A script
//! computes with the numbers of its files as they are; where the units differ, that is noted once.
//! A problem file converts them instead.

use crate::identify::errors::UNITS_DIFFER;
use crate::identify::{Quantity, Simulated, Study};
use crate::script::Session;
use crate::units::{Conversion, written};
use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

/// Columns and simulations remembered: scripts fit several experiments in each generation.
const REMEMBERED: usize = 40;

/// The columns with units that were read, and what was simulated.
#[derive(Default)]
struct Units {
    columns: VecDeque<Column>,
    simulated: VecDeque<Output>,
    said: BTreeSet<String>,
}

/// A measured column with a unit.
struct Column {
    file: String,
    name: String,
    unit: String,
    values: Vec<f64>,
}

/// The first row of a simulated population and what it was simulated of.
struct Output {
    row: Vec<f64>,
    study: Arc<Study>,
}

impl Session {
    /// Remembers the unit of a column that a script has read.
    pub(in crate::script) fn column_measured(
        &mut self,
        (file, name): (&str, &str),
        unit: Option<&str>,
        values: &[f64],
    ) {
        let Some(unit) = unit else { return };
        let [file, name, unit] = [file, name, unit].map(str::to_owned);
        let columns = &mut self.extension::<Units>().columns;
        columns.push_back(Column { file, name, unit, values: values.to_vec() });
        if columns.len() > REMEMBERED {
            columns.pop_front();
        }
    }

    /// Remembers what a population was simulated of, and notes the unit of X.
    pub(in crate::script) fn population_simulated(
        &mut self,
        study: &Arc<Study>,
        x: &[f64],
        simulated: &Simulated,
    ) {
        let units = self.extension::<Units>();
        if units.columns.is_empty() {
            return;
        }
        let row = simulated.rows.get(..x.len()).unwrap_or_default().to_vec();
        units.simulated.push_back(Output { row, study: study.clone() });
        if units.simulated.len() > REMEMBERED {
            units.simulated.pop_front();
        }
        self.compared(x, &study.model, &study.x);
    }

    /// Notes the units of measured and simulated values that a script compares.
    pub(in crate::script) fn fitted(&mut self, row: &[f64], measured: &[f64]) {
        let simulated = &self.extension::<Units>().simulated;
        let own = simulated.iter().rev().find(|output| same(&output.row, row));
        if let Some(study) = own.map(|output| output.study.clone()) {
            self.compared(measured, &study.model, &study.y);
        }
    }

    /// Notes it if these values are a measured column in another unit than that of the variable.
    pub(in crate::script) fn compared(&mut self, values: &[f64], model: &str, variable: &Quantity) {
        let units = self.extension::<Units>();
        let column = units.columns.iter().rev().find(|column| same(&column.values, values));
        let Some(sentence) = column.and_then(|column| sentence(column, model, variable)) else {
            return;
        };
        if units.said.insert(sentence.clone()) {
            self.note(UNITS_DIFFER, sentence);
        }
    }
}

fn same(a: &[f64], b: &[f64]) -> bool {
    let equal = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
    a.len() == b.len() && a.iter().zip(b).all(equal)
}

fn sentence(column: &Column, model: &str, variable: &Quantity) -> Option<String> {
    let Column { file, name, unit, .. } = column;
    if variable.unit.is_empty() || *unit == variable.unit {
        return None;
    }
    let (from, to) = (written(unit)?, written(&variable.unit)?);
    let both = format!(
        "the column `{name}` of `{file}` is in {unit}, but the variable `{}` of `{model}` is in {}",
        variable.name, variable.unit
    );
    let Some(conversion) = from.to(to) else {
        return Some(format!(
            "{both}, a different quantity: the numbers are compared without conversion"
        ));
    };
    let change = in_words(conversion)?;
    Some(format!(
        "{both}: the numbers are compared without conversion; to compare in {}, {change}",
        variable.unit
    ))
}

/// What to do with the numbers; `None` if nothing is.
fn in_words(conversion: Conversion) -> Option<String> {
    let Conversion { factor, offset, .. } = conversion;
    match (factor == 1.0, offset == 0.0) {
        (true, true) => None,
        (false, true) => Some(format!("multiply the column by {factor}")),
        (true, false) => Some(format!("add {offset} to the column")),
        (false, false) => Some(format!("multiply the column by {factor} and add {offset}")),
    }
}
