//! Units of measured columns beside those of the variables that they are compared with. The numbers of
//! a script are those of its files; where `Eval`, `Fit` and `Refine` compare them with a variable in
//! another unit of the same quantity, they convert them as a problem file does, which is noted once.

use crate::Session;
use crate::identify::errors::UNITS_DIFFER;
use crate::identify::{Quantity, Study};
use crate::units::{Conversion, written};
use std::collections::{BTreeSet, VecDeque};
use std::ops::Range;
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

/// The individuals of a population and what they were simulated of.
struct Output {
    individuals: Range<u64>,
    study: Arc<Study>,
    /// Whether the compared variable is a difference, whose unit converts without an offset.
    is_relative: bool,
}

impl Session {
    /// Remembers the unit of a column that a script has read.
    pub(crate) fn column_measured(
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

    /// Remembers what a population was simulated of.
    pub(crate) fn population_simulated(
        &mut self,
        study: &Arc<Study>,
        individuals: Range<u64>,
        is_relative: bool,
    ) {
        let units = self.extension::<Units>();
        if units.columns.is_empty() {
            return;
        }
        units.simulated.push_back(Output { individuals, study: study.clone(), is_relative });
        if units.simulated.len() > REMEMBERED {
            units.simulated.pop_front();
        }
    }

    /// Measured values in the unit of the simulated ones that a script compares them with; `None`
    /// where they are in it, or nothing is known of them.
    pub(crate) fn fitted(&mut self, individuals: &[u64], measured: &[f64]) -> Option<Vec<f64>> {
        let first = individuals.first()?;
        let simulated = &self.extension::<Units>().simulated;
        let own = simulated.iter().find(|output| output.individuals.contains(first))?;
        let (study, is_relative) = (own.study.clone(), own.is_relative);
        self.in_unit_of(measured, &study.model, (&study.y, is_relative))
    }

    /// A measured column in the unit of the variable that it is compared with, which is noted; `None`
    /// where it is in it, or where these values are not a column with a unit.
    pub(crate) fn in_unit_of(
        &mut self,
        values: &[f64],
        model: &str,
        variable: (&Quantity, bool),
    ) -> Option<Vec<f64>> {
        let Mismatch { units, conversion, are_angles } = self.mismatch(values, model, variable)?;
        let Some(conversion) = conversion else {
            let why = match are_angles {
                true => ", one may count revolutions and the other radians",
                false => ", a different quantity",
            };
            self.note_units(format!("{units}{why}: the numbers are compared without conversion"));
            return None;
        };
        self.note_units(format!(
            "{units}: for the comparison the column is converted{}",
            conversion.in_words()
        ));
        Some(values.iter().map(|value| conversion.apply(*value)).collect())
    }

    /// Notes it if a script has compared these values by itself, although they are a measured column
    /// in another unit than that of the variable.
    pub(crate) fn compared(&mut self, values: &[f64], model: &str, variable: (&Quantity, bool)) {
        let Some(Mismatch { units, conversion, .. }) = self.mismatch(values, model, variable)
        else {
            return;
        };
        let remedy = conversion.map_or_else(String::new, |conversion| {
            format!("; to compare in {}, take the column{}", variable.0.unit, conversion.in_words())
        });
        self.note_units(format!("{units}: the numbers are compared without conversion{remedy}"));
    }

    fn mismatch(
        &mut self,
        values: &[f64],
        model: &str,
        variable: (&Quantity, bool),
    ) -> Option<Mismatch> {
        let columns = &self.extension::<Units>().columns;
        let column = columns.iter().rev().find(|column| same(&column.values, values))?;
        mismatch(column, model, variable)
    }

    fn note_units(&mut self, sentence: String) {
        if self.extension::<Units>().said.insert(sentence.clone()) {
            self.note_about_data(UNITS_DIFFER, sentence);
        }
    }
}

fn same(a: &[f64], b: &[f64]) -> bool {
    let equal = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
    a.len() == b.len() && a.iter().zip(b).all(equal)
}

/// A column in another unit than that of the variable that it is compared with.
struct Mismatch {
    /// Both in words.
    units: String,
    /// `None` between different quantities.
    conversion: Option<Conversion>,
    /// Whether one may count revolutions and the other radians.
    are_angles: bool,
}

/// `None` where both units mean the same, or one of them is not known.
fn mismatch(
    column: &Column,
    model: &str,
    (variable, is_relative): (&Quantity, bool),
) -> Option<Mismatch> {
    let Column { file, name, unit, .. } = column;
    if variable.unit.is_empty() || *unit == variable.unit {
        return None;
    }
    let (from, to) = (written(unit)?, written(&variable.unit)?);
    let conversion = from.to(to).map(|conversion| match is_relative {
        true => conversion.of_differences(),
        false => conversion,
    });
    let units = format!(
        "the column `{name}` of `{file}` is in {unit}, but the variable `{}` of `{model}` is in {}",
        variable.name, variable.unit
    );
    let is_needed = conversion.is_none_or(|conversion| !conversion.is_identity());
    let are_angles = from.angles_differ(to).is_some();
    is_needed.then_some(Mismatch { units, conversion, are_angles })
}

#[cfg(test)]
mod tests {
    use crate::world::MemoryWorld;
    use crate::{Options, Session};

    const LINE: &str = "model Line
  parameter Real R(unit=\"Ohm.cm2\") = 0.2;
  input Real i(unit=\"A/cm2\");
  output Real U(unit=\"V\") = 1 - R*i;
end Line;
";
    const SCRIPT: &str = "(ok, s, X, Y) = Exp_Adq_SISO(\"pol.csv\", \"j\", \"U\");
P = [0.1; 0.2; 0.3];
F = Fit(Eval(\"\", \"Line\", X, P, {\"R\"}, \"i\", \"U\"), Y);
(Q, G) = Fit_Order(P, F, 3, 2, 1);
";

    #[test]
    fn what_happened_to_the_data_is_in_the_report_of_a_quiet_run() {
        let data = "j [mA/cm2],U [mV]\n100,980\n200,960\n250,\n300,940\n400,921\n";
        let world = MemoryWorld::new().with_file("pol.csv", data.as_bytes());
        let streams = world.streams();
        let options = Options { quiet: true, ..Options::default() };
        let mut session = Session::new(Box::new(world)).with_options(options);
        session.load_text("Line.mo", LINE).expect("classes");
        let status = session.run_text("fit.mos", SCRIPT);
        let (said, errors) = (streams.output(), streams.errors());
        assert_eq!(status.code, 0, "{said}{errors}");
        let folder = session.world.output_dir();
        let result = session.world.read(&folder.join("result.json")).expect("the result");
        let result = String::from_utf8(result).expect("text");
        for words in ["the column is converted, times 0.001", "pol.csv: "] {
            assert!(said.contains(words), "{words}: {said}");
            assert!(result.contains(words), "{words}: {result}");
        }
    }
}
