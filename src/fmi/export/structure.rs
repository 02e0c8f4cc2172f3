//! What follows from what.

use super::content::{Exported, Place, Setter};
use super::variables::Table;
use crate::codegen::{Needs, Program};
use crate::description::{
    Causality, DependencyKind, Initial, Structure, Unknown, Variability, Variable, Version,
};

/// The structure of a model.
pub(super) fn structure(program: &Program, table: &Table, version: Version) -> Structure {
    let n = table.states.len();
    let derivatives: Vec<Unknown> = table.derivatives[..n]
        .iter()
        .zip(&table.states)
        .map(|(place, state)| Unknown {
            variable: *place,
            dependencies: table.dependencies(program.needs_of_derivative(*state), version),
        })
        .collect();
    let outputs: Vec<Unknown> = places(table, |causality| causality == Causality::Output)
        .map(|place| Unknown {
            variable: place,
            dependencies: table.dependencies_of(program, place, version),
        })
        .collect();
    let mut initial: Vec<usize> = Vec::new();
    let is_calculated = |place: &usize| {
        let variable = &table.variables[*place].0;
        matches!(variable.initial, Some(Initial::Approx | Initial::Calculated))
    };
    initial.extend(places(table, |causality| causality == Causality::Output).filter(is_calculated));
    let states = table.state_places.iter().copied();
    initial.extend(states.chain(table.derivatives[..n].iter().copied()).filter(is_calculated));
    initial.extend(places(table, |causality| causality == Causality::CalculatedParameter));
    initial.sort_unstable();
    initial.dedup();
    let indicators = table.variables.iter().enumerate();
    let indicators =
        indicators.filter(|(_, (_, exported))| matches!(exported.place, Place::Indicator(_)));
    let open = |variable| Unknown { variable, dependencies: None };
    Structure {
        outputs,
        derivatives,
        clocked_states: Vec::new(),
        initial_unknowns: initial.into_iter().map(open).collect(),
        event_indicators: match version {
            Version::V2 => Vec::new(),
            Version::V3 => indicators.map(|(place, _)| open(place)).collect(),
        },
    }
}

fn places(table: &Table, is: impl Fn(Causality) -> bool) -> impl Iterator<Item = usize> {
    let variables = table.variables.iter().enumerate();
    variables.filter(move |(_, (variable, _))| is(variable.causality)).map(|(place, _)| place)
}

impl Table {
    /// The dependencies of a variable; `None` where it may depend on everything.
    fn dependencies_of(
        &self,
        program: &Program,
        place: usize,
        version: Version,
    ) -> Option<Vec<(usize, DependencyKind)>> {
        let (variable, exported) = &self.variables[place];
        let needs = match exported.place {
            // What changes at events depends on what led to them.
            _ if variable.variability != Variability::Continuous => None,
            Place::State(state) => Some(Needs { states: vec![state], ..Needs::default() }),
            Place::Derivative(state) => program.needs_of_derivative(state),
            Place::Variable(at) => program.needs_of(at),
            Place::Time | Place::Indicator(_) | Place::Text(_) => None,
        };
        self.dependencies(needs, version)
    }

    /// What is needed, as places: states, inputs and the time, in FMI 3.0 also parameters.
    fn dependencies(
        &self,
        needs: Option<Needs>,
        version: Version,
    ) -> Option<Vec<(usize, DependencyKind)>> {
        let Needs { states, parameters, time } = needs?;
        let places = states.into_iter().map(|state| {
            let own = self.states.iter().position(|known| *known == state);
            let input = || self.inputs.iter().find(|(known, _)| *known == state);
            own.map(|at| self.state_places[at]).or_else(|| input().map(|(_, place)| *place))
        });
        // Recorded inputs are not among the states.
        if self.has_recorded {
            return None;
        }
        let mut places: Vec<usize> = places.collect::<Option<_>>()?;
        let is_needed = |(variable, exported): &(Variable, Exported)| match exported.setter {
            _ if exported.place == Place::Time => time,
            Setter::Parameter(at) => {
                version == Version::V3
                    && variable.causality == Causality::Parameter
                    && parameters.binary_search(&at).is_ok()
            }
            _ => false,
        };
        let all = self.variables.iter().enumerate();
        places.extend(all.filter(|(_, own)| is_needed(own)).map(|(place, _)| place));
        places.sort_unstable();
        places.dedup();
        Some(places.into_iter().map(|place| (place, DependencyKind::Dependent)).collect())
    }
}
