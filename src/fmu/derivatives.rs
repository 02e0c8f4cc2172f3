//! Derivatives along directions, and backwards, from the exact Jacobian.

use crate::codegen::Access;
use crate::fmi::export::{Place, Setter};
use crate::instance::{Instance, Wrong};
use crate::sim::SimErrorKind;
use nalgebra::DMatrix;

impl Instance {
    /// ∂unknowns/∂knowns at the values at hand, by value references: rows of the unknowns, columns of
    /// the knowns, which are continuous states and inputs.
    pub(crate) fn jacobian(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
    ) -> Result<DMatrix<f64>, Wrong> {
        let columns: Vec<(usize, f64)> =
            knowns.iter().map(|known| self.column(*known)).collect::<Result<_, _>>()?;
        let mut variables: Vec<usize> = Vec::new();
        let mut rows: Vec<Option<Row>> = Vec::new();
        for unknown in unknowns {
            rows.push(self.row(*unknown, &mut variables)?);
        }
        let n = self.state.x.len();
        let all = self.whole_jacobian(variables)?;
        let entry = |row: usize, column: usize| {
            let (state, sign) = columns[column];
            sign * match rows[row] {
                None => 0.0,
                Some(Row::State(own)) => f64::from(u8::from(own == state)),
                Some(Row::Derivative(own)) => all[(own, state)],
                Some(Row::Variable(own)) => all[(n + own, state)],
            }
        };
        Ok(DMatrix::from_fn(unknowns.len(), knowns.len(), entry))
    }

    /// The derivatives of the states and of these variables by all states: computed once for the values
    /// at hand, since importers ask for a direction at a time.
    fn whole_jacobian(&mut self, variables: Vec<usize>) -> Result<&DMatrix<f64>, Wrong> {
        let known = self.jacobian.take().filter(|(of, _)| *of == variables);
        let all = match known {
            Some((_, all)) => all,
            None => {
                let state = &mut self.state;
                let all = state.system.reduced_jacobian(&variables, state.time, &state.x);
                all.map_err(|failure| self.explained(SimErrorKind::Evaluation(failure)))?
            }
        };
        Ok(&self.jacobian.insert((variables, all)).1)
    }

    fn column(&self, reference: u32) -> Result<(usize, f64), Wrong> {
        let variable = self.model.content.variables.get(reference as usize);
        let found = variable.and_then(|variable| match (variable.place, variable.setter) {
            (_, Setter::Input { state, is_negated, .. }) => {
                Some((state, if is_negated { -1.0 } else { 1.0 }))
            }
            (Place::State(state), _) => Some((state, 1.0)),
            _ => None,
        });
        found.ok_or_else(|| {
            Wrong::Error(format!(
                "derivatives are known by continuous states and continuous inputs; the variable \
                 with value reference {reference} is none"
            ))
        })
    }

    /// Where the derivatives of a variable are; `None` where they are zero.
    fn row(&self, reference: u32, variables: &mut Vec<usize>) -> Result<Option<Row>, Wrong> {
        let variable = self.model.content.variables.get(reference as usize);
        let place = variable.map(|variable| variable.place);
        match place {
            Some(Place::Time) => Ok(None),
            Some(Place::State(state)) => Ok(Some(Row::State(state))),
            Some(Place::Derivative(state)) => Ok(Some(Row::Derivative(state))),
            Some(Place::Variable(at)) => match self.model.program.variables()[at].access {
                Access::Observed { .. } => {
                    variables.push(at);
                    Ok(Some(Row::Variable(variables.len() - 1)))
                }
                _ => Ok(None),
            },
            Some(Place::Indicator(_)) | None => Err(Wrong::Error(format!(
                "the variable with value reference {reference} has no derivatives"
            ))),
        }
    }
}

#[derive(Clone, Copy)]
enum Row {
    State(usize),
    Derivative(usize),
    Variable(usize),
}
