//! How values get into an instance and out of it.

use super::binary::Component;
use super::calls::CallError;
use super::layout::{Layout, Place, starts};
use super::plan::Plan;
use crate::Description;
use crate::description::{Causality, Kind};
use std::collections::BTreeMap;

/// A variable with the values that it is set to.
struct Assigned {
    kind: Kind,
    reference: u32,
    is_structural: bool,
    values: Vec<f64>,
}

/// Values that an instance is given before its initialization. Arrays are set as a whole.
pub(super) struct Assignment<'a> {
    plan: &'a Plan,
    description: &'a Description,
    variables: BTreeMap<usize, Assigned>,
}

impl<'a> Assignment<'a> {
    /// The values of a plan, with those that vary.
    pub(crate) fn new(
        description: &'a Description,
        layout: &Layout,
        plan: &'a Plan,
        varied: &[f64],
    ) -> Assignment<'a> {
        let mut assignment = Assignment { plan, description, variables: BTreeMap::new() };
        let fixed = plan.numbers.iter().copied();
        for (place, value) in fixed.chain(plan.varied.iter().copied().zip(varied.iter().copied())) {
            let variable = &description.variables[place.variable];
            let assigned = assignment.variables.entry(place.variable).or_insert_with(|| Assigned {
                kind: variable.kind,
                reference: variable.reference,
                is_structural: variable.causality == Causality::StructuralParameter,
                values: starts(variable, layout.count(place.variable)),
            });
            if let Some(slot) = assigned.values.get_mut(place.element) {
                *slot = value;
            }
        }
        assignment
    }

    /// Sets structural parameters, then all others.
    pub(crate) fn apply(&self, component: &Component) -> Result<(), CallError> {
        let structural = |one: &&Assigned| one.is_structural;
        if self.variables.values().any(|one| structural(&one)) {
            component.enter_configuration()?;
            self.variables.values().filter(structural).try_for_each(|one| one.apply(component))?;
            component.exit_configuration()?;
        }
        let mut others = self.variables.values().filter(|one| !structural(one));
        others.try_for_each(|one| one.apply(component))?;
        for (variable, strings) in &self.plan.strings {
            component.set_strings(self.description.variables[*variable].reference, strings)?;
        }
        Ok(())
    }
}

impl Assigned {
    fn apply(&self, component: &Component) -> Result<(), CallError> {
        component.set(self.kind, &[self.reference], &self.values)
    }
}

/// Values that are read from an instance, with one call for each kind.
pub(super) struct Readings {
    groups: Vec<Group>,
    count: usize,
}

struct Group {
    kind: Kind,
    references: Vec<u32>,
    values: Vec<f64>,
    /// Where a value is among those of the group, and which of the readings it is.
    picked: Vec<(usize, usize)>,
}

impl Readings {
    /// Readings of these scalars in this order.
    pub(crate) fn new(description: &Description, layout: &Layout, observed: &[Place]) -> Readings {
        let mut groups: BTreeMap<Kind, (Group, BTreeMap<usize, usize>)> = BTreeMap::new();
        for (reading, place) in observed.iter().enumerate() {
            let variable = &description.variables[place.variable];
            let (group, offsets) = groups.entry(variable.kind).or_insert_with(|| {
                let (references, values, picked) = (Vec::new(), Vec::new(), Vec::new());
                (Group { kind: variable.kind, references, values, picked }, BTreeMap::new())
            });
            let offset = *offsets.entry(place.variable).or_insert_with(|| {
                let offset = group.values.len();
                group.references.push(variable.reference);
                group.values.resize(offset + layout.count(place.variable), 0.0);
                offset
            });
            group.picked.push((offset + place.element, reading));
        }
        let groups = groups.into_values().map(|(group, _)| group).collect();
        Readings { groups, count: observed.len() }
    }

    /// Number of readings.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Writes the values that the instance has now.
    pub(crate) fn read(&mut self, component: &Component, out: &mut [f64]) -> Result<(), CallError> {
        for group in &mut self.groups {
            component.get(group.kind, &group.references, &mut group.values)?;
            group.picked.iter().for_each(|(from, to)| out[*to] = group.values[*from]);
        }
        Ok(())
    }
}
