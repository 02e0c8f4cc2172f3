//! What follows from what.

use super::content::Place;
use super::variables::Table;
use crate::codegen::Program;
use crate::description::{
    Causality, DependencyKind, Initial, Structure, Unknown, Variability, Version,
};

/// The structure of a model.
pub(super) fn structure(program: &Program, table: &Table, version: Version) -> Structure {
    let n = table.states.len();
    let derivatives: Vec<Unknown> = table.derivatives[..n]
        .iter()
        .zip(&table.states)
        .map(|(place, state)| Unknown {
            variable: *place,
            dependencies: table.dependencies(program.states_of_derivative(*state)),
        })
        .collect();
    let outputs: Vec<Unknown> = places(table, |causality| causality == Causality::Output)
        .map(|place| Unknown {
            variable: place,
            dependencies: table.dependencies_of(program, place),
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
        discrete_states: Vec::new(),
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
    ) -> Option<Vec<(usize, DependencyKind)>> {
        let (variable, exported) = &self.variables[place];
        match exported.place {
            // What changes at events depends on what led to them.
            _ if variable.variability != Variability::Continuous => None,
            Place::State(state) => self.dependencies(Some(vec![state])),
            Place::Derivative(state) => self.dependencies(program.states_of_derivative(state)),
            Place::Variable(at) => self.dependencies(program.states_needed_by(&[at])),
            Place::Time | Place::Indicator(_) => None,
        }
    }

    /// States and inputs, by their numbers, as places.
    fn dependencies(&self, states: Option<Vec<usize>>) -> Option<Vec<(usize, DependencyKind)>> {
        let places = states?.into_iter().map(|state| {
            let own = self.states.iter().position(|known| *known == state);
            let input = || self.inputs.iter().find(|(known, _)| *known == state);
            own.map(|at| self.state_places[at]).or_else(|| input().map(|(_, place)| *place))
        });
        // Recorded inputs are not among the states.
        if self.has_recorded {
            return None;
        }
        let mut places: Vec<usize> = places.collect::<Option<_>>()?;
        places.sort_unstable();
        places.dedup();
        Some(places.into_iter().map(|place| (place, DependencyKind::Dependent)).collect())
    }
}
