//! What determines the value of each quantity of a model.

use super::document::{Document, Kind, Quantity, Species};
use crate::expression::Expression;
use std::collections::{BTreeMap, BTreeSet};

/// What determines the value of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// It keeps its initial value.
    Constant,
    /// An assignment rule.
    Assigned,
    /// A rate rule or reactions.
    State,
    /// Events alone.
    Discrete,
    /// An algebraic rule.
    Algebraic,
}

/// The roles of all quantities.
#[derive(Debug, Clone)]
pub(super) struct Roles(BTreeMap<String, Role>);

impl Roles {
    pub(super) fn of(document: &Document) -> Roles {
        let targets: BTreeSet<&str> = document
            .events
            .iter()
            .flat_map(|event| event.assignments.iter().map(|(name, _)| name.as_str()))
            .collect();
        let mut roles: BTreeMap<String, Role> = document
            .quantities
            .iter()
            .map(|own| (own.id.clone(), role(document, own, &targets)))
            .collect();
        for name in algebraic(document, &roles) {
            roles.insert(name, Role::Algebraic);
        }
        Roles(roles)
    }

    /// The role; names that are no quantities are those of reactions.
    pub(super) fn get(&self, name: &str) -> Role {
        self.0.get(name).copied().unwrap_or(Role::Assigned)
    }

    /// Whether the amount of the species is stored, although its symbol is the concentration: where
    /// the size of its compartment changes, the amount is what stays.
    pub(super) fn stores_amount(&self, own: &Quantity) -> bool {
        let Kind::Species(Species { compartment, is_amount: false, .. }) = &own.kind else {
            return false;
        };
        let own = self.get(&own.id);
        self.get(compartment) != Role::Constant && ![Role::Assigned, Role::Algebraic].contains(&own)
    }
}

fn role(document: &Document, own: &Quantity, targets: &BTreeSet<&str>) -> Role {
    let has = |rules: &[super::document::Rule]| rules.iter().any(|rule| rule.variable == own.id);
    let reacts = || {
        let is_own = |(species, _): &(String, Expression)| *species == own.id;
        document.reactions.iter().any(|r| r.products.iter().chain(&r.reactants).any(is_own))
    };
    match &own.kind {
        _ if has(&document.assignments) => Role::Assigned,
        _ if has(&document.rates) => Role::State,
        Kind::Species(species) if !species.boundary && !own.constant && reacts() => Role::State,
        _ if targets.contains(own.id.as_str()) => Role::Discrete,
        _ => Role::Constant,
    }
}

/// The quantities that algebraic rules determine: one for each, by an augmenting path.
fn algebraic(document: &Document, roles: &BTreeMap<String, Role>) -> Vec<String> {
    let is_open = |own: &&Quantity| {
        !own.constant && [Role::Constant, Role::Discrete].contains(&roles[&own.id])
    };
    let open: BTreeSet<&str> =
        document.quantities.iter().filter(is_open).map(|own| own.id.as_str()).collect();
    let candidates: Vec<Vec<&str>> = document
        .algebraic
        .iter()
        .map(|rule| {
            let names = reached(document, &rule.math);
            let mut names: Vec<&str> =
                open.iter().copied().filter(|name| names.contains(*name)).collect();
            // Those that no event changes come first.
            names.sort_by_key(|name| roles[*name] == Role::Discrete);
            names
        })
        .collect();
    let mut owner: BTreeMap<&str, usize> = BTreeMap::new();
    for rule in 0..candidates.len() {
        augment(rule, &candidates, &mut owner, &mut BTreeSet::new());
    }
    owner.into_keys().map(str::to_owned).collect()
}

fn augment<'a>(
    rule: usize,
    candidates: &[Vec<&'a str>],
    owner: &mut BTreeMap<&'a str, usize>,
    seen: &mut BTreeSet<&'a str>,
) -> bool {
    candidates[rule].iter().any(|name| {
        if !seen.insert(name) {
            return false;
        }
        let is_free =
            owner.get(name).copied().is_none_or(|other| augment(other, candidates, owner, seen));
        if is_free {
            owner.insert(name, rule);
        }
        is_free
    })
}

/// The names that an expression depends on, through assignment rules and rates of reactions.
pub(super) fn reached(document: &Document, expression: &Expression) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut open: Vec<String> = expression.names().into_iter().collect();
    while let Some(name) = open.pop() {
        if names.insert(name.clone()) {
            open.extend(definition(document, &name).into_iter().flat_map(Expression::names));
        }
    }
    names
}

/// The expression that a name stands for: that of an assignment rule, or the rate of a reaction.
pub(super) fn definition<'a>(document: &'a Document, name: &str) -> Option<&'a Expression> {
    let rule =
        document.assignments.iter().find(|rule| rule.variable == name).map(|rule| &rule.math);
    let reaction = || document.reactions.iter().find(|own| own.id == name)?.rate.as_ref();
    rule.or_else(reaction)
}
