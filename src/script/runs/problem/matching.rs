//! Which variables of a model the columns of a data file mean: those of the same name, else those whose unit, name
//! and causality fit best. Each variable has one column, and each column one variable.

use super::flat::{attribute, unit_in};
use crate::flatten::{FlatModel, Variability, Variable};
use crate::syntax::ast::{CausalityPrefix, ExpressionKind};
use crate::units::{Unit, written};

/// A column of the data by the name that a problem gives it.
pub(super) struct DataColumn {
    pub name: String,
    pub unit: Option<String>,
    pub values: Vec<f64>,
    /// Values that are like the fault codes of instruments.
    pub codes: Vec<f64>,
}

/// What a column means.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Meaning {
    pub variable: String,
    pub is_input: bool,
    /// Whether unit or likeness decided, not the name.
    pub is_guess: bool,
}

/// A variable that a column may mean.
struct Candidate<'f> {
    variable: &'f Variable,
    role: Role,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Input,
    Output,
    State,
    Other,
}

/// Points for what column and variable have in common. The same name outweighs everything, the unit
/// any likeness of names, and likeness the role in the model.
mod points {
    pub(super) const SAME_NAME: u32 = 1000;
    pub(super) const SAME_BUT_CASE: u32 = 500;
    pub(super) const UNIT: u32 = 50;
    pub(super) const LETTER: u32 = 10;
    pub(super) const SYMBOL: u32 = 25;
    /// For each word that a column and a description have in common.
    pub(super) const WORD: u32 = 12;
    /// A name alone that begins as the other does is evidence for inputs and outputs only.
    pub(super) const ENOUGH: u32 = 26;
}

/// Usual symbols of quantities, by the words that name their columns.
const SYMBOLS: [(&str, &[&str]); 7] = [
    ("v", &["voltage", "volt", "spannung"]),
    ("u", &["voltage", "volt", "spannung"]),
    ("i", &["current", "strom"]),
    ("p", &["pressure", "power", "druck", "leistung"]),
    ("t", &["temperature", "temp", "temperatur"]),
    ("h", &["height", "level", "pegel"]),
    ("m", &["mass", "masse"]),
];

/// Words that say where something is measured: those of one line mean the same, and those of two lines
/// exclude each other. They begin longer words, too: `aussentemperatur`.
const WHERE: [&[&str]; 2] = [
    &["outdoor", "outside", "ambient", "exterior", "aussen", "außen", "umgebung"],
    &["indoor", "inside", "room", "zone", "interior", "innen", "raum"],
];

/// Words that name a column of time.
const TIME: [&str; 11] = [
    "time",
    "zeit",
    "temps",
    "tempo",
    "tiempo",
    "timestamp",
    "zeitstempel",
    "datetime",
    "date",
    "datum",
    "uhrzeit",
];

impl DataColumn {
    /// Its values, without missing ones and fault codes.
    pub(super) fn known(&self) -> impl Iterator<Item = f64> {
        let is_known = |value: &f64| value.is_finite() && !self.codes.contains(value);
        self.values.iter().copied().filter(is_known)
    }

    /// The first value and the range of all.
    pub(super) fn extent(&self) -> Option<(f64, f64)> {
        let first = self.known().next()?;
        let low = self.known().fold(first, f64::min);
        let high = self.known().fold(first, f64::max);
        Some((first, high - low))
    }

    /// Whether it holds times by its name or its unit.
    pub(super) fn is_time(&self, flat: &FlatModel) -> bool {
        if flat.variables.contains_key(self.name.as_str()) {
            return false;
        }
        let lower = self.name.to_lowercase();
        let mut words = lower.split(|letter: char| !letter.is_alphanumeric());
        let unit = self.unit.as_deref().and_then(written);
        // A first letter in front of another word is the symbol of a temperature.
        lower == "t"
            || words.any(|word| TIME.contains(&word))
            || unit.is_some_and(|unit| unit.to(Unit::SECOND).is_some())
    }

    /// Whether its unit, where it has one, is one of times.
    pub(super) fn may_be_times(&self) -> bool {
        let unit = self.unit.as_deref().and_then(written);
        unit.is_none_or(|unit| unit.to(Unit::SECOND).is_some())
    }

    /// Whether its values increase from row to row.
    pub(super) fn increases(&self) -> bool {
        let known: Vec<f64> = self.known().collect();
        known.len() > 1 && known.windows(2).all(|pair| pair[0] < pair[1])
    }
}

/// The meanings of the columns, in their order.
pub(super) fn meanings(
    columns: &[DataColumn],
    flat: &FlatModel,
    states: &[&str],
) -> Vec<Option<Meaning>> {
    let candidates = candidates(flat, states);
    let mut pairs = Vec::new();
    for (at, column) in columns.iter().enumerate().filter(|(_, column)| !column.is_time(flat)) {
        let scored = candidates.iter().enumerate();
        pairs.extend(
            scored.filter_map(|(k, candidate)| Some((score(column, candidate, flat)?, at, k))),
        );
    }
    pairs.sort_by_key(|(score, ..)| std::cmp::Reverse(*score));
    let mut found: Vec<Option<Meaning>> = vec![None; columns.len()];
    let mut is_taken = vec![false; candidates.len()];
    for (score, at, k) in pairs {
        if found[at].is_none() && !is_taken[k] {
            is_taken[k] = true;
            found[at] = Some(Meaning {
                variable: candidates[k].variable.name.to_string(),
                is_input: candidates[k].role == Role::Input,
                is_guess: score < points::SAME_BUT_CASE,
            });
        }
    }
    found
}

/// What a column without a telling name or unit may hold: the output of the model, else the state, that
/// begins nearest to a column. All that come into question, the best one first, and the place of the column.
pub(super) fn output_by_start(
    columns: &[&DataColumn],
    flat: &FlatModel,
    states: &[&str],
) -> Option<(Vec<String>, usize)> {
    let of = |role: Role| {
        let all = candidates(flat, states);
        all.into_iter().filter(move |one| one.role == role).collect::<Vec<_>>()
    };
    let states_of_components = || {
        let scalar = |name: &&&str| flat.variables.get(**name).is_some_and(|v| v.dims.is_empty());
        states.iter().filter(scalar).map(ToString::to_string).collect::<Vec<_>>()
    };
    let names = |role| of(role).iter().map(|one| one.variable.name.to_string()).collect::<Vec<_>>();
    let mut names = [names(Role::Output), names(Role::State), states_of_components()]
        .into_iter()
        .find(|names| !names.is_empty())?;
    let mut best = (f64::INFINITY, 0, 0);
    for (k, name) in names.iter().enumerate() {
        for (at, column) in columns.iter().enumerate() {
            let Some((first, range)) = column.extent() else { continue };
            let start = start(flat, name).unwrap_or(0.0);
            let far = (first - start).abs() / range.max(f64::MIN_POSITIVE);
            if far < best.0 {
                best = (far, k, at);
            }
        }
    }
    let (_, k, at) = best;
    let chosen = names.remove(k);
    names.insert(0, chosen);
    Some((names, at))
}

/// The start value of a variable: a number, or the value of the parameter that it names.
fn start(flat: &FlatModel, name: &str) -> Option<f64> {
    let number = |kind: &ExpressionKind| match kind {
        ExpressionKind::Real(value) => Some(*value),
        ExpressionKind::Integer(value) => Some(*value as f64),
        _ => None,
    };
    let start = attribute(flat, name, "start")?;
    match &start.kind {
        ExpressionKind::Reference(_) => number(
            &flat.variables.get(parameter_of_start(flat, name)?.as_str())?.binding.as_ref()?.kind,
        ),
        kind => number(kind),
    }
}

/// The parameter that gives a variable its start value.
pub(super) fn parameter_of_start(flat: &FlatModel, name: &str) -> Option<String> {
    match &attribute(flat, name, "start")?.kind {
        ExpressionKind::Reference(reference) => Some(reference.name().to_string()),
        _ => None,
    }
}

fn candidates<'f>(flat: &'f FlatModel, states: &[&str]) -> Vec<Candidate<'f>> {
    // A column is one number per row, not an array.
    let is_measured =
        |one: &&Variable| one.variability >= Variability::Discrete && one.dims.is_empty();
    let candidate = |variable: &'f Variable| {
        let is_open = variable.binding.is_none();
        let role = match variable.causality {
            Some(CausalityPrefix::Input) if is_open => Role::Input,
            Some(CausalityPrefix::Output) => Role::Output,
            _ if variable.top_level && states.contains(&&*variable.name) => Role::State,
            _ => Role::Other,
        };
        Candidate { variable, role }
    };
    flat.variables.values().filter(is_measured).map(candidate).collect()
}

/// How well a column fits a variable; `None` where nothing speaks for it, or the units contradict it.
fn score(column: &DataColumn, candidate: &Candidate<'_>, flat: &FlatModel) -> Option<u32> {
    let name = &*candidate.variable.name;
    if column.name == name {
        return Some(points::SAME_NAME);
    }
    let (own, other) = (column.name.to_lowercase(), name.to_lowercase());
    if own == other {
        return Some(points::SAME_BUT_CASE);
    }
    let role = match candidate.role {
        Role::Output => 8,
        Role::Input => 6,
        Role::State => 2,
        Role::Other => return None,
    };
    let measured = column.unit.as_deref().and_then(written);
    let unit = match (measured, written(&unit_in(flat, name))) {
        (Some(from), Some(to)) => from.to(to).map(|_| points::UNIT)?,
        _ => 0,
    };
    let description = candidate.variable.description.as_deref().unwrap_or_default();
    let about = format!("{other} {}", description.to_lowercase());
    let likeness = likeness(&own, &other) + common_words(&own, &about)? * points::WORD;
    let evidence = if candidate.role == Role::State { unit } else { unit + likeness };
    (unit > 0 || evidence + role >= points::ENOUGH).then_some(unit + likeness + role)
}

/// How many words of a column the name and the description of a variable have, the place of a measurement
/// for some; `None` where the places exclude each other.
fn common_words(column: &str, about: &str) -> Option<u32> {
    const MOST: usize = 2;
    /// A common place counts as so many words.
    const PLACE: u32 = 2;
    let place = |text: &str| {
        let mut words = text.split(|letter: char| !letter.is_alphanumeric());
        words.find_map(|own| {
            WHERE.iter().position(|place| place.iter().any(|word| own.starts_with(word)))
        })
    };
    let places = match (place(column), place(about)) {
        (Some(own), Some(other)) if own != other => return None,
        (Some(_), Some(_)) => PLACE,
        _ => 0,
    };
    let is_word = |word: &&str| word.chars().count() >= 4;
    let words = |text: &'_ str| -> Vec<String> {
        let words = text.split(|letter: char| !letter.is_alphanumeric());
        words.filter(is_word).map(str::to_owned).collect()
    };
    let described = words(about);
    let common = words(column).iter().filter(|word| described.contains(word)).count();
    Some(places + common.min(MOST) as u32)
}

/// How much the names have in common: letters at their beginning where one begins as the whole other, or the
/// quantity that one names and the other abbreviates.
fn likeness(column: &str, variable: &str) -> u32 {
    const MOST: usize = 4;
    let letters = |text: &str| text.chars().filter(|c| c.is_alphanumeric()).collect::<String>();
    let symbol = variable.chars().next().map(String::from).unwrap_or_default();
    let names_quantity =
        |word: &str| SYMBOLS.iter().any(|(own, words)| *own == symbol && words.contains(&word));
    let words = column.split(|letter: char| !letter.is_alphanumeric());
    let quantity = if words.into_iter().any(names_quantity) { points::SYMBOL } else { 0 };
    let (a, b) = (letters(column), letters(variable));
    let shorter = a.chars().count().min(b.chars().count());
    let begins = shorter > 0 && (a.starts_with(&b) || b.starts_with(&a));
    let common = if begins { shorter.min(MOST) as u32 + 1 } else { 0 };
    quantity.max(points::LETTER * common)
}
