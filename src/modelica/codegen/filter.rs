//! What a Kalman filter needs of a model: which of its states are uncertain where noise acts on some,
//! and the derivatives of their rates and of the outputs as variables of the model, with which the
//! equations of the covariance are written.
//!
//! ```text
//!   ẋ = f(x, …) + noise,  y = h(x, …)      A = ∂f/∂x,  H = ∂h/∂x
//! ```
//!
//! The derivatives are total ones: what algebraic equations determine follows the states, through torn
//! loops as well. A class around the model has parameters in their places ([`rate`], [`gain`]) until the
//! system is causalized; then these become variables, computed after everything that the model itself
//! computes.

use super::errors::NO_FILTER;
use super::jacobian::Forward;
use super::linear_part::{add, variable};
use super::sensitivity::through_blocks;
use super::sequence::{resolved, right_sides};
use crate::causalize::{Assignment, Block, CausalizedDae};
use crate::diag::Fault;
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::lower::VariableKind;
use crate::symbolic::{Expr, Pool, VarId, VariableCollection};
use rustc_hash::FxHashSet;
use std::collections::{BTreeMap, BTreeSet};

/// Which states of a model are uncertain, and what depends on them.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// The names of these states, in the order of the model.
    pub states: Vec<String>,
    /// Which entries of A are not always zero: row, column.
    pub rates: BTreeSet<(usize, usize)>,
    /// Which entries of H are not always zero: output, state.
    pub gains: BTreeSet<(usize, usize)>,
}

/// The name of an entry of A, where states are counted from 0.
pub fn rate((row, column): (usize, usize)) -> String {
    format!("'rate {} by {}'", row + 1, column + 1)
}

/// The name of an entry of H, where outputs and states are counted from 0.
pub fn gain((output, state): (usize, usize)) -> String {
    format!("'output {} by {}'", output + 1, state + 1)
}

/// Derivatives by some states.
struct Derivatives {
    /// Assignments of what they consist of.
    made: Vec<Assignment>,
    /// Of the rates of all states.
    rates: Vec<BTreeMap<usize, Expr>>,
    /// Of outputs.
    outputs: Vec<BTreeMap<usize, Expr>>,
}

impl Uncertainty {
    /// That of a model in which noise acts on `noisy` states, or they begin uncertain.
    ///
    /// # Errors
    ///
    /// Names that are not those of states or variables; what the equations of a covariance do not hold for.
    pub fn of(
        sorted: &mut CausalizedDae,
        noisy: &[String],
        outputs: &[String],
    ) -> Result<Uncertainty, Fault> {
        refuse(sorted)?;
        let noisy: BTreeSet<usize> =
            noisy.iter().map(|name| state(sorted, name)).collect::<Result<_, _>>()?;
        let outputs: Vec<VarId> =
            outputs.iter().map(|name| variable(sorted, name)).collect::<Result<_, _>>()?;
        let mut pool = std::mem::take(&mut sorted.dae.pool);
        let states = sorted.states.clone();
        let found = derivatives(&mut pool, sorted, &states, &outputs);
        let uncertain = closed(noisy, &found.rates);
        let held = held_state(&mut pool, sorted, &uncertain);
        sorted.dae.pool = pool;
        if let Some(what) = held {
            return Err(what);
        }
        let place = |state: &usize| uncertain.iter().position(|own| own == state);
        let entries = |rows: Vec<(usize, &BTreeMap<usize, Expr>)>| {
            let all = rows.into_iter().flat_map(|(row, entries)| {
                entries.keys().filter_map(move |column| Some((row, place(column)?)))
            });
            all.collect()
        };
        let rates = uncertain.iter().enumerate().map(|(row, state)| (row, &found.rates[*state]));
        let rates = entries(rates.collect());
        let gains = entries(found.outputs.iter().enumerate().collect());
        let name = |state: &usize| sorted.dae.variable(sorted.states[*state]).name.to_string();
        let states: Vec<String> = uncertain.iter().map(name).collect();
        match states.iter().find(|name| name.starts_with("der(") || name.starts_with('$')) {
            Some(name) => Err(fault!(
                NO_FILTER,
                "the state `{name}` of `{}` has no variable of its own", sorted.dae.name;
                help: "declare a variable for the derivative in the model, `v = der(x)`"
            )),
            None => Ok(Uncertainty { states, rates, gains }),
        }
    }

    /// Makes the parameters in the places of the entries variables with their values.
    ///
    /// # Errors
    ///
    /// Where the class around the model has other states than the model alone.
    pub fn install(&self, sorted: &mut CausalizedDae, outputs: &[String]) -> Result<(), Fault> {
        let states: Vec<VarId> =
            self.states.iter().map(|name| variable(sorted, name)).collect::<Result<_, _>>()?;
        let places: Option<Vec<usize>> =
            states.iter().map(|own| sorted.states.iter().position(|state| state == own)).collect();
        let places = places.ok_or_else(|| {
            fault!(NO_FILTER, "`{}` has other states where it is filtered", sorted.dae.name)
                .help("set `stateSelect = StateSelect.always` for the states with noise")
        })?;
        let outputs: Vec<VarId> =
            outputs.iter().map(|name| variable(sorted, name)).collect::<Result<_, _>>()?;
        let mut pool = std::mem::take(&mut sorted.dae.pool);
        let found = derivatives(&mut pool, sorted, &states, &outputs);
        let zero = pool.constant(0.0);
        sorted.dae.pool = pool;
        let value = |row: Option<&BTreeMap<usize, Expr>>, column: &usize| {
            row.and_then(|row| row.get(column)).copied().unwrap_or(zero)
        };
        let rates = self.rates.iter().map(|(row, column)| {
            (rate((*row, *column)), value(found.rates.get(places[*row]), column))
        });
        let gains = self
            .gains
            .iter()
            .map(|(row, column)| (gain((*row, *column)), value(found.outputs.get(*row), column)));
        let mut last = found.made;
        for (name, value) in rates.chain(gains) {
            let variable = becomes_variable(sorted, &name)?;
            last.push(Assignment { variable, value, equation: 0 });
        }
        append(sorted, &last);
        Ok(())
    }
}

/// Refuses systems of which states or their past are no vector that a filter could move.
fn refuse(sorted: &CausalizedDae) -> Result<(), Fault> {
    let (name, events) = (&sorted.dae.name, &sorted.dae.events);
    if !sorted.selections.is_empty() {
        return Err(fault!(
            NO_FILTER,
            "`{name}` cannot be filtered: it chooses its states at run time";
            help: "set `stateSelect = StateSelect.always` for the states that shall remain"
        ));
    }
    if !events.delays.is_empty() || !events.transports.is_empty() {
        return Err(fault!(
            NO_FILTER,
            "`{name}` cannot be filtered: `delay` and `spatialDistribution` keep a past that is \
             uncertain as well";
            help: "replace them by a rational approximation, such as a chain of first-order blocks"
        ));
    }
    Ok(())
}

/// The place of a state among all.
fn state(sorted: &CausalizedDae, name: &str) -> Result<usize, Fault> {
    let own = variable(sorted, name)?;
    let of = sorted.aliases[own.0 as usize].map_or(own, |alias| alias.of);
    sorted.states.iter().position(|state| *state == of).ok_or_else(|| {
        let states = sorted.states.iter().map(|state| &*sorted.dae.variable(*state).name);
        let states: Vec<&str> = states.filter(|name| !name.contains('\'')).collect();
        fault!(NO_FILTER, "noise acts on states, and `{name}` is not a state").help(
            match states.is_empty() {
                true => format!("`{}` has no states", sorted.dae.name),
                false => format!("its states are {}", crate::diag::suggest::listed(&states)),
            },
        )
    })
}

/// These states and all whose rates depend on them, in the order of the model.
fn closed(mut uncertain: BTreeSet<usize>, rates: &[BTreeMap<usize, Expr>]) -> Vec<usize> {
    loop {
        let reached = rates
            .iter()
            .enumerate()
            .filter(|(_, row)| row.keys().any(|column| uncertain.contains(column)));
        let count = uncertain.len();
        let reached: Vec<usize> = reached.map(|(state, _)| state).collect();
        uncertain.extend(reached);
        if uncertain.len() == count {
            return uncertain.into_iter().collect();
        }
    }
}

/// Total derivatives of rates and outputs by states.
fn derivatives(
    pool: &mut Pool,
    sorted: &CausalizedDae,
    states: &[VarId],
    outputs: &[VarId],
) -> Derivatives {
    let rates = right_sides(sorted, pool);
    let outputs: Vec<Expr> = outputs.iter().map(|own| resolved(pool, sorted, *own)).collect();
    let mut next = sorted.dae.variables.len() as u32;
    let mut forward = seeded(pool, &mut next, states);
    let mut made = Vec::new();
    through_blocks(&mut forward, &sorted.blocks, &mut made);
    let rates = rates.into_iter().map(|rate| forward.row(rate)).collect();
    let outputs = outputs.into_iter().map(|output| forward.row(output)).collect();
    Derivatives { made, rates, outputs }
}

fn seeded<'a>(pool: &'a mut Pool, next: &'a mut u32, states: &[VarId]) -> Forward<'a> {
    let one = pool.constant(1.0);
    let mut forward = Forward::new(pool, next);
    for (column, state) in states.iter().enumerate() {
        forward.seed(*state, BTreeMap::from([(column, one)]));
    }
    forward
}

/// Why events do not leave the uncertainty of states as it is, if they do not.
fn held_state(pool: &mut Pool, sorted: &CausalizedDae, uncertain: &[usize]) -> Option<Fault> {
    let states: Vec<VarId> = uncertain.iter().map(|place| sorted.states[*place]).collect();
    let mut next = sorted.dae.variables.len() as u32;
    let mut forward = seeded(pool, &mut next, &states);
    through_blocks(&mut forward, &sorted.event_blocks, &mut Vec::new());
    let (dae, model) = (&sorted.dae, &sorted.dae.name);
    if let Some(reinit) = dae.events.reinits.first() {
        // Also a state that is certain before: the time of the event may not be.
        let name = &dae.variable(reinit.state).name;
        return Some(fault!(
            NO_FILTER,
            "`{model}` cannot be filtered: `reinit` sets `{name}`, whose uncertainty would jump \
             with it";
            help: "describe the jump by a fast continuous change"
        ));
    }
    let is_held = |own: &VarId| {
        let variable = dae.variable(*own);
        variable.kind == VariableKind::Discrete && variable.base == BaseType::Real
    };
    let mut all = sorted.event_blocks.iter().flat_map(Block::assignments).map(|own| own.variable);
    let held = all.find(|own| is_held(own) && !forward.row_of(*own).is_empty())?;
    let name = &dae.variable(held).name;
    Some(fault!(
        NO_FILTER,
        "`{model}` cannot be filtered: `{name}` keeps a value of uncertain states between events";
        help: "compute it continuously, without `when`, or give noise to other states"
    ))
}

/// The variable in place of a parameter of this name.
fn becomes_variable(sorted: &mut CausalizedDae, name: &str) -> Result<VarId, Fault> {
    let own = variable(sorted, name)?;
    let place = &mut sorted.dae.variables[own.0 as usize];
    (place.kind, place.variability) = (VariableKind::Unknown, Variability::Continuous);
    (place.binding, place.start) = (None, None);
    sorted.parameters.retain(|parameter| *parameter != own);
    Ok(own)
}

/// Lets the system solve for these after all that they depend on, and for what depends on them after
/// that.
fn append(sorted: &mut CausalizedDae, last: &[Assignment]) {
    let first = sorted.dae.variables.len() as u32;
    for (number, own) in last.iter().filter(|own| own.variable.0 >= first).enumerate() {
        add(sorted, own.variable, format!("'derivative {number}'"));
    }
    let CausalizedDae { dae, blocks, initial_blocks, event_blocks, .. } = sorted;
    for list in [blocks, initial_blocks, event_blocks] {
        if list.is_empty() {
            continue;
        }
        let mut moved: FxHashSet<VarId> = last.iter().map(|own| own.variable).collect();
        let (mut before, mut after) = (Vec::new(), Vec::new());
        for block in std::mem::take(list) {
            if !depends(&dae.pool, &block, &moved) {
                before.push(block);
                continue;
            }
            moved.extend(block.assignments().iter().map(|own| own.variable));
            if let Block::Loop(torn) = &block {
                moved.extend(&torn.iteration);
            }
            after.push(block);
        }
        before.extend(last.iter().copied().map(Block::Assignment));
        before.extend(after);
        *list = before;
    }
}

fn depends(pool: &Pool, block: &Block, on: &FxHashSet<VarId>) -> bool {
    let mut variables = VariableCollection::new(pool);
    let mut any = false;
    let values = block.assignments().iter().map(|own| own.value).chain(block.residuals());
    for value in values {
        variables.add(value, |variable| any |= on.contains(&variable));
    }
    any
}
