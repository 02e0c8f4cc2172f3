//! Models in the Systems Biology Markup Language (SBML, levels 2 and 3, without packages), as
//! Modelica text.
//!
//! A species is its concentration, or its amount where it has only substance units; where the size of
//! its compartment changes, its amount is the state. Reactions are variables with their names. Events
//! are when-equations; where several may happen at one time, or later than their triggers, they are
//! one algorithm in the order of their priorities.

mod document;
mod element;
mod events;
mod mathml;
mod roles;
mod translation;
mod units;

use crate::Refusal;
use crate::expression::Expression;
use document::{Document, Kind, Quantity, Rule};
use roles::{Role, Roles};
use std::collections::{BTreeMap, BTreeSet};
use translation::{Initial, Translation};

pub(crate) use document::mentioned;

/// A model in Modelica.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Model {
    /// The name of the class.
    pub name: String,
    /// The text of the class.
    pub text: String,
}

/// A name, a title and a value.
type NewParameter = (String, String, Option<f64>);
/// A name, a title and what it is equal to.
type NewVariable = (String, String, Expression);

/// What is added to a model.
#[derive(Debug, Clone, Default)]
pub(crate) struct Additions {
    /// Parameters with other values, or new ones.
    pub(crate) parameters: Vec<NewParameter>,
    /// Variables with their titles and expressions.
    pub(crate) variables: Vec<NewVariable>,
    /// What an experiment may set: species and others whose initial values become parameters.
    pub(crate) set: Vec<String>,
    /// Whether simulations come to rest before time 0.
    pub(crate) rests: bool,
    /// What has another value until then.
    pub(crate) switched: Vec<String>,
}

/// A model with additions, and the parameters that set what was asked for.
pub(crate) struct Extended {
    pub(crate) model: Model,
    pub(crate) set: BTreeMap<String, String>,
    /// Parameters that are 1 where such a value counts.
    pub(crate) flags: BTreeMap<String, String>,
    /// Those of the time before 0.
    pub(crate) at_rest: BTreeMap<String, String>,
}

/// The names that formulas can use, and whether each has an initial value: species, and what rules or
/// reactions change.
pub(crate) fn symbols(text: &str) -> Result<BTreeMap<String, bool>, Refusal> {
    let document = document::read(text)?;
    let roles = Roles::of(&document);
    let quantities = document.quantities.iter().map(|own| {
        let varies = roles.get(&own.id) != Role::Constant;
        (own.id.clone(), varies || matches!(own.kind, Kind::Species(_)))
    });
    let reactions = document.reactions.iter().map(|own| (own.id.clone(), false));
    Ok(quantities.chain(reactions).collect())
}

/// What rules determine throughout.
pub(crate) fn computed(text: &str) -> Result<BTreeSet<String>, Refusal> {
    let document = document::read(text)?;
    let roles = Roles::of(&document);
    let own = document.quantities.iter().map(|own| own.id.clone());
    Ok(own.filter(|id| [Role::Assigned, Role::Algebraic].contains(&roles.get(id))).collect())
}

/// Adds parameters and variables.
fn add(document: &mut Document, parameters: Vec<NewParameter>, variables: Vec<NewVariable>) {
    let quantity = |id: &str, title: &str, constant: bool, value: Option<f64>| Quantity {
        id: id.to_owned(),
        title: title.to_owned(),
        unit: String::new(),
        constant,
        kind: Kind::Parameter,
        value,
        notes: String::new(),
        place: 0..0,
    };
    for (id, title, value) in parameters {
        match document.quantities.iter_mut().find(|own| own.id == id) {
            Some(own) => {
                own.value = value.or(own.value);
                if value.is_some() {
                    document.initial.retain(|rule| rule.variable != id);
                }
            }
            None => {
                document.names.fresh(&id);
                document.quantities.push(quantity(&id, &title, true, value));
            }
        }
    }
    for (id, title, math) in variables {
        document.names.fresh(&id);
        document.quantities.push(quantity(&id, &title, false, None));
        document.assignments.push(Rule { variable: id, math, place: 0..0 });
    }
}

/// The model in an SBML document, with additions.
pub(crate) fn extended(text: &str, additions: Additions) -> Result<Extended, Refusal> {
    let mut document = document::read(text)?;
    let Additions { parameters, variables, set: requested, rests, switched } = additions;
    add(&mut document, parameters, variables);
    if rests {
        document.change(&|part| match part {
            // Time stands still where the model comes to rest.
            Expression::Time => {
                let pair = (Expression::Number(0.0), Expression::before_zero());
                Some(Expression::Piecewise(vec![pair], Some(Box::new(Expression::Time))))
            }
            _ => None,
        });
    }
    let roles = Roles::of(&document);
    let (mut set, mut at_rest, mut flags) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
    let plain = BTreeMap::new();
    let from_variables: Vec<String> = {
        let plain = Translation::new(document.clone(), &plain)?;
        requested.iter().filter(|id| plain.starts_from_variables(id)).cloned().collect()
    };
    for id in requested {
        if switched.contains(&id) {
            let [rest, own] = document.switch(&id);
            at_rest.insert(id.clone(), rest);
            set.insert(id, own);
            continue;
        }
        let own = match roles.get(&id) {
            Role::Constant if !from_variables.contains(&id) => id.clone(),
            _ => document.names.fresh(&format!("{id}_0")),
        };
        if from_variables.contains(&id) {
            flags.insert(id.clone(), document.names.fresh(&format!("{id}_is_set")));
        }
        set.insert(id, own);
    }
    let name = document.id.clone();
    let initial = set.iter().filter(|(id, own)| id != own && !at_rest.contains_key(*id));
    let initial: BTreeMap<String, Initial> = initial
        .map(|(id, own)| {
            let initial = Initial { value: own.clone(), is_set: flags.get(id).cloned() };
            (id.clone(), initial)
        })
        .collect();
    let mut translation = Translation::new(document, &initial)?;
    events::translate(&mut translation)?;
    let text = translation.finish(&name);
    Ok(Extended { model: Model { name, text }, set, flags, at_rest })
}

/// The model in an SBML document.
///
/// # Errors
///
/// What is wrong in the document, or not supported, at its place.
pub fn import(text: &str) -> Result<Model, Refusal> {
    extended(text, Additions::default()).map(|own| own.model)
}
