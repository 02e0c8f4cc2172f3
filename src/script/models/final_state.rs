//! The end of a simulation, which another one can begin with: in memory, and as the text that Dymola
//! keeps in `dsfinal.txt` (Dymola User Manual 1, section on dsin.txt and dsfinal.txt).

use super::translated::Translated;
use crate::codegen::{Access, VariableInfo};
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::fault;
use crate::flatten::Variability;
use crate::mat;
use crate::results::ResultTable;
use crate::runtime::System;
use crate::sim::Trajectory;
use crate::syntax::ast::CausalityPrefix;
use indexmap::IndexMap;
use rustc_hash::FxHashSet;
use std::fmt::Write as _;
use std::sync::Arc;

/// Bytes of a file that tell whether it holds a final state.
pub const BEGINNING: usize = 64;

/// The values of all variables at the end of a simulation, or at another time of it.
#[derive(Debug, Clone, Default)]
pub struct FinalState {
    /// Start and stop time of a simulation that continues from here, seconds.
    pub span: (f64, f64),
    /// The variables by their names.
    pub variables: IndexMap<Arc<str>, Final>,
}

/// A variable at the end of a simulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Final {
    /// Its value.
    pub value: f64,
    /// What it is.
    pub(crate) category: Category,
}

/// What a variable is, with the numbers that these files have for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Category {
    /// A parameter or constant.
    Parameter = 1,
    /// A state.
    State = 2,
    /// The derivative of a state.
    Derivative = 3,
    /// An output of the model.
    Output = 4,
    /// An input of the model.
    Input = 5,
    /// Any other variable.
    Auxiliary = 6,
}

impl FinalState {
    /// The end of a simulation from `start` on.
    pub(super) fn of(
        model: &Translated,
        system: &System,
        trajectory: &Trajectory,
        (start, stop): (f64, f64),
    ) -> FinalState {
        let end = trajectory.time().last().copied().unwrap_or(stop);
        let states: FxHashSet<&str> = model.state_names().map(|name| &**name).collect();
        let variables = model.program.variables().iter().enumerate();
        let value = |(at, variable): (usize, &VariableInfo)| {
            let value = match variable.access {
                Access::Time => return None,
                Access::Constant(_) | Access::Parameter => system.value(at)?,
                Access::Observed { column, negated } => {
                    let last = trajectory.column(column).last().copied()?;
                    if negated { -last } else { last }
                }
            };
            let category = category(variable, states.contains(&*variable.name));
            Some((variable.name.clone(), Final { value, category }))
        };
        FinalState {
            span: (end, end + (end - start)),
            variables: variables.filter_map(value).collect(),
        }
    }

    /// What a result has at a time of the variables of a model; between two points discrete ones have
    /// the value of the earlier.
    ///
    /// # Errors
    /// The results do not reach this time.
    pub fn in_result(
        model: &Translated,
        table: &ResultTable,
        time: f64,
    ) -> Result<FinalState, Fault> {
        let earlier = table.time.partition_point(|known| *known <= time).saturating_sub(1);
        let mut variables = IndexMap::new();
        for variable in model.program.variables() {
            let is_stepwise = variable.variability <= Variability::Discrete;
            let Ok(column) = table.column(&variable.name) else { continue };
            let value = match is_stepwise {
                true => column.get(earlier).copied().unwrap_or(f64::NAN),
                false => table.interpolate(&variable.name, &[time])?[0],
            };
            let category = category(variable, false);
            variables.insert(variable.name.clone(), Final { value, category });
        }
        Ok(FinalState { span: (time, time), variables })
    }

    /// The value of a variable.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.variables.get(name).map(|known| known.value)
    }

    /// The text of `dsfinal.txt`.
    pub fn text(&self) -> String {
        let (start, stop) = self.span;
        let names: Vec<&str> = self.variables.keys().map(|name| &**name).collect();
        let longest = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
        let count = names.len();
        let mut text = format!(
            "#1\nchar Aclass(3,32)\nAdymosim\n1.4\nFinal state of a simulation\n\n\
             # start time, stop time, increment, intervals, tolerance, fixed step, algorithm\n\
             double experiment(7,1)\n{start:?}\n{stop:?}\n0\n500\n0.0001\n0\n8\n\n\
             char initialName({count},{longest})\n"
        );
        for name in names {
            text += name;
            text.push('\n');
        }
        text += "\n# type (-1 fixed, 0 free), value, smallest, largest (0 and 0: no limits),\n\
                 # category (1 parameter, 2 state, 3 derivative, 4 output, 5 input, 6 auxiliary),\n\
                 # data type\n";
        let _ = writeln!(text, "double initialValue({count},6)");
        for Final { value, category } in self.variables.values() {
            let fixed = -i32::from(matches!(category, Category::Parameter | Category::State));
            let _ = writeln!(text, "{fixed} {value:?} 0 0 {} 0", *category as i32);
        }
        text
    }

    /// Whether a file that begins with these bytes holds a final state: a simulation may replace it, as
    /// it replaces result files.
    pub fn is_in(beginning: &[u8]) -> bool {
        let text = String::from_utf8_lossy(beginning);
        text.starts_with("#1") && text.contains("Aclass") && text.contains("Adymosim")
    }

    /// Reads what [`FinalState::text`] or Dymola has written.
    ///
    /// # Errors
    /// The bytes are not of this format.
    pub fn read(file: &str, bytes: &[u8]) -> Result<FinalState, Fault> {
        let content = mat::read(bytes)?;
        let names = content.matrix("initialName")?.row_strings();
        let values = content.matrix("initialValue")?;
        let experiment = content.matrix("experiment")?;
        if values.columns < 5 || values.rows != names.len() || experiment.values.len() < 2 {
            return Err(fault!(
                BAD_ARGUMENT,
                "`{file}` is not a final state: it has {} names and {} rows of {} values",
                names.len(), values.rows, values.columns;
                help: "use a file `dsfinal.txt` or `dsin.txt`"
            ));
        }
        let variables = names.iter().enumerate().map(|(row, name)| {
            let category = match values.get(row, 4) as i64 {
                1 => Category::Parameter,
                2 => Category::State,
                3 => Category::Derivative,
                4 => Category::Output,
                5 => Category::Input,
                _ => Category::Auxiliary,
            };
            (Arc::from(name.trim()), Final { value: values.get(row, 1), category })
        });
        let span = (experiment.values[0], experiment.values[1]);
        Ok(FinalState { span, variables: variables.collect() })
    }
}

fn category(variable: &VariableInfo, is_state: bool) -> Category {
    match variable.causality {
        _ if variable.is_known() => Category::Parameter,
        _ if is_state => Category::State,
        Some(CausalityPrefix::Input) => Category::Input,
        Some(CausalityPrefix::Output) => Category::Output,
        _ if variable.name.starts_with("der(") => Category::Derivative,
        _ => Category::Auxiliary,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let value = |value, category| Final { value, category };
        let variables = [
            ("a.b[2]", value(0.1, Category::State)),
            ("n", value(-3.0, Category::Parameter)),
            ("der(x)", value(1e-300, Category::Derivative)),
        ];
        let variables = variables.map(|(name, value)| (Arc::from(name), value)).into();
        let state = FinalState { span: (1.0, 2.5), variables };
        let read = FinalState::read("f", state.text().as_bytes()).expect("the same");
        assert_eq!(read.span, state.span);
        assert_eq!(read.variables, state.variables);
        assert!(FinalState::is_in(&state.text().as_bytes()[..BEGINNING]));
        assert!(!FinalState::is_in(b"#1\ndouble A(1,1)\n1\n"));
    }

    #[test]
    fn a_file_of_dymola_is_read() {
        let text = "#1\nchar Aclass(3,24)\nAdymosim\n1.4\nModelica experiment file\n\n# Experiment parameters\n\
            double experiment(7,1)\n       1                   # StartTime    Time at which integration starts\n       3\n       0\n     500\n   1.0E-004\n       0\n       8\n\n\
            char initialName(2,7)\nx\nlaw.k\n\ndouble initialValue(2,6)\n -1 1.353352832366127E-001 0 0 # x\n  2   272\n -1 0.5 0 0  1   280   # law.k\n";
        let read = FinalState::read("dsfinal.txt", text.as_bytes()).expect("a state");
        assert_eq!(read.span, (1.0, 3.0));
        assert_eq!(read.value("x"), Some(0.135_335_283_236_612_7));
        assert_eq!(read.variables["law.k"].category, Category::Parameter);
    }
}
