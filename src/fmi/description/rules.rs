//! What the text of the standard requires beyond its schemas: names that are unique, references that lead
//! somewhere, attributes that go together (FMI 2.0.5 §2.2, FMI 3.0.2 §2.4).

use super::{
    Attributes, Causality, Description, Dimension, Initial, Kind, TypeDefinition, Unit, Unknown,
    Variability, Variable, Version,
};
use crate::FmuError;
use crate::xml::{Element, real};
use std::collections::HashMap;
use std::fmt::Display;
use std::hash::Hash;

/// A description with its elements in the document.
struct Checked<'d, 'a, 'i> {
    description: &'d Description,
    /// Those of the variables.
    elements: &'d [Element<'a, 'i>],
    units: HashMap<&'d str, &'d Unit>,
    types: HashMap<&'d str, &'d TypeDefinition>,
    /// The places of variables by their value references.
    places: HashMap<u32, usize>,
}

/// Checks a description that agrees with its schema; `elements` are those of its variables.
///
/// # Errors
/// The first rule that is broken, with the line.
pub(super) fn check(
    description: &Description,
    root: &Element,
    elements: &[Element],
) -> Result<(), FmuError> {
    names(root, elements)?;
    let variables = description.variables.iter().enumerate();
    let checked = Checked {
        description,
        elements,
        units: description.units.iter().map(|own| (own.name.as_str(), own)).collect(),
        types: description.types.iter().map(|own| (own.name.as_str(), own)).collect(),
        places: variables.map(|(at, own)| (own.reference, at)).collect(),
    };
    checked.types(root)?;
    for at in 0..elements.len() {
        checked.variable(at)?;
    }
    match description.version {
        Version::V2 => checked.aliases(),
        Version::V3 => checked.value_references(),
    }?;
    checked.independent(root)?;
    checked.experiment(root)?;
    checked.structure(root)?;
    checked.is_complete()
}

/// The elements of a list: in FMI 2.0 they are in a group, in FMI 3.0 they have a name of their own.
pub(super) fn unknowns_of<'a, 'i>(
    structure: &Element<'a, 'i>,
    version: Version,
    (group, name): (&str, &str),
) -> Vec<Element<'a, 'i>> {
    match version {
        Version::V2 => structure.elements(group, "Unknown"),
        Version::V3 => structure.children().into_iter().filter(|one| one.name() == name).collect(),
    }
}

/// Refuses what two elements have though it must differ.
fn unique<'a, 'i: 'a, K: Eq + Hash + Display>(
    what: &str,
    all: impl Iterator<Item = (Element<'a, 'i>, K)>,
) -> Result<(), FmuError> {
    let mut known: HashMap<K, Element> = HashMap::new();
    for (element, key) in all {
        if key.to_string().is_empty() {
            return Err(element.error(format!("the {what} is empty")));
        }
        if let Some(first) = known.get(&key) {
            let line = first.line();
            return Err(element.error(format!("the {what} `{key}` is in line {line} already")));
        }
        known.insert(key, element);
    }
    Ok(())
}

/// Refuses values of an attribute that two elements have.
fn differ(what: &str, attribute: &str, all: &[Element]) -> Result<(), FmuError> {
    unique(what, all.iter().map(|one| (*one, one.get(attribute).unwrap_or_default())))
}

/// The elements of a name in some elements.
fn inside<'a, 'i: 'a>(all: &[Element<'a, 'i>], name: &str) -> Vec<Element<'a, 'i>> {
    let children = all.iter().flat_map(Element::children);
    children.filter(|one| one.name() == name).collect()
}

/// Names that must differ.
fn names(root: &Element, variables: &[Element]) -> Result<(), FmuError> {
    let aliases = inside(variables, "Alias");
    differ("variable name", "name", &[variables, &aliases].concat())?;
    let groups = |name: &str| root.child(name).map_or(Vec::new(), |group| group.children());
    differ("name of a log category", "name", &groups("LogCategories"))?;
    let units = groups("UnitDefinitions");
    differ("name of a unit", "name", &units)?;
    for unit in units {
        differ("name of a display unit", "name", &inside(&[unit], "DisplayUnit"))?;
    }
    let types = groups("TypeDefinitions");
    differ("name of a type", "name", &types)?;
    for own in types {
        // In FMI 2.0 one element further inside.
        let items = [inside(&[own], "Item"), inside(&own.children(), "Item")].concat();
        differ("name of an item", "name", &items)?;
        differ("value of an item", "value", &items)?;
    }
    Ok(())
}

impl Checked<'_, '_, '_> {
    /// An error at a variable.
    fn at(&self, variable: usize, message: impl Display) -> FmuError {
        let name = &self.description.variables[variable].name;
        self.elements[variable].error(format!("`{name}` {message}"))
    }

    fn types(&self, root: &Element) -> Result<(), FmuError> {
        for element in root.child("TypeDefinitions").map_or(Vec::new(), |all| all.children()) {
            let own = element.get("name").and_then(|name| self.types.get(name));
            if let Some(why) = own.and_then(|own| self.wrong_attributes(&own.attributes)) {
                return Err(element.error(format!("the type {why}")));
            }
        }
        Ok(())
    }

    /// What is wrong with attributes, as the end of a sentence.
    fn wrong_attributes(&self, own: &Attributes) -> Option<String> {
        let unit = own.unit.as_deref();
        if let Some(name) = unit.filter(|name| !self.units.contains_key(name)) {
            return Some(format!("has the unit `{name}`, which `UnitDefinitions` does not have"));
        }
        if let Some(shown) = &own.display_unit {
            let unit = unit.and_then(|name| self.units.get(name));
            let is_known =
                unit.is_some_and(|unit| unit.display_units.iter().any(|one| one.name == *shown));
            if !is_known {
                return Some(format!(
                    "has the display unit `{shown}`, which its unit does not have"
                ));
            }
        }
        if own.min.zip(own.max).is_some_and(|(min, max)| min > max) {
            return Some("has a `min` that is larger than its `max`".to_owned());
        }
        own.nominal.filter(|nominal| *nominal == 0.0).map(|_| "has the nominal value 0".to_owned())
    }

    fn variable(&self, at: usize) -> Result<(), FmuError> {
        let own = &self.description.variables[at];
        let wrong = |why: String| Err(self.at(at, why));
        if let Some(name) = &own.declared_type {
            match self.types.get(name.as_str()) {
                None => {
                    return wrong(format!(
                        "has the type `{name}`, which `TypeDefinitions` does not have"
                    ));
                }
                Some(found) if found.kind != own.kind => {
                    let (own, found) = (own.kind.word(), found.kind.word());
                    return wrong(format!("is {own}, but its type `{name}` is {found}"));
                }
                Some(_) => {}
            }
        } else if own.kind == Kind::Enumeration {
            return wrong("is an enumeration without `declaredType`".to_owned());
        }
        if let Some(why) = self.wrong_attributes(&self.description.attributes_of(own)) {
            return wrong(why);
        }
        if own.variability == Variability::Continuous && !own.kind.is_float() {
            return wrong(format!("is {} and cannot be continuous", own.kind.word()));
        }
        self.causality(at)?;
        self.references(at)?;
        self.start(at)
    }

    /// Whether causality, variability and initial go together (FMI 2.0.5 and 3.0.2, the tables of their
    /// combinations).
    fn causality(&self, at: usize) -> Result<(), FmuError> {
        use {Causality as C, Initial as I, Variability as V};
        let own = &self.description.variables[at];
        let (causality, variability, initial) = (own.causality, own.variability, own.initial);
        let has_place = match (causality, variability) {
            (C::StructuralParameter | C::Parameter, V::Fixed | V::Tunable)
            | (C::Output | C::Local, V::Constant) => initial == Some(I::Exact),
            (C::CalculatedParameter | C::Local, V::Fixed | V::Tunable) => {
                matches!(initial, Some(I::Calculated | I::Approx))
            }
            (C::Input, V::Discrete | V::Continuous) => matches!(initial, None | Some(I::Exact)),
            (C::Output | C::Local, V::Discrete | V::Continuous) => true,
            (C::Independent, V::Continuous) => initial.is_none(),
            _ => false,
        };
        if has_place {
            return Ok(());
        }
        let initial = initial.map_or(String::new(), |own| format!(" with initial {}", own.word()));
        let (causality, variability) = (causality.word(), variability.word());
        Err(self.at(at, format!("cannot be {causality} and {variability}{initial}")))
    }

    /// Whether what a variable refers to is there.
    fn references(&self, at: usize) -> Result<(), FmuError> {
        let variables = &self.description.variables;
        let own = &variables[at];
        let wrong = |why: String| Err(self.at(at, why));
        let find = |what: &str, reference: u32| {
            let found = self.places.get(&reference).copied();
            found.ok_or_else(|| {
                let none = "which no variable has";
                self.at(at, format!("has in `{what}` the value reference {reference}, {none}"))
            })
        };
        if let Some(of) = own.derivative_of
            && (of == at || !variables[of].kind.is_float())
        {
            return wrong(format!("cannot be the derivative of `{}`", variables[of].name));
        }
        if let Some(reference) = own.previous {
            let previous = find("previous", reference)?;
            let of = &variables[previous];
            if previous == at || of.kind != own.kind || of.causality == Causality::Input {
                return wrong(format!("cannot have the previous value `{}`", of.name));
            }
        }
        for reference in &own.clocks {
            let clock = &variables[find("clocks", *reference)?];
            if clock.kind != Kind::Clock {
                return wrong(format!("belongs to `{}`, which is not a clock", clock.name));
            }
        }
        for dimension in &own.dimensions {
            let Dimension::Variable(reference) = dimension else { continue };
            let size = &variables[find("Dimension", *reference)?];
            let is_structural = size.causality == Causality::StructuralParameter
                || size.variability == Variability::Constant;
            if size.kind != Kind::UInt64 || !is_structural || !size.dimensions.is_empty() {
                let name = &size.name;
                return wrong(format!(
                    "has the size `{name}`, which is not a structural parameter of the type UInt64"
                ));
            }
        }
        self.clock(at)
    }

    fn clock(&self, at: usize) -> Result<(), FmuError> {
        let Some(own) = &self.description.variables[at].clock else { return Ok(()) };
        let is_constant = own.variability == "constant";
        if is_constant && own.decimal.is_none() && own.counter.is_none() {
            return Err(self.at(at, "is a constant clock without `intervalDecimal`"));
        }
        let is_zero = own.resolution == Some(0) || own.counter == Some(0);
        if is_zero || own.decimal.is_some_and(|interval| interval <= 0.0) {
            return Err(self.at(at, "is a clock whose interval is not larger than 0"));
        }
        if own.counter.is_some() && own.resolution.is_none() {
            return Err(self.at(at, "is a clock with `intervalCounter` and without `resolution`"));
        }
        Ok(())
    }

    fn start(&self, at: usize) -> Result<(), FmuError> {
        let own = &self.description.variables[at];
        let wrong = |why: String| Err(self.at(at, why));
        let is_given = matches!(own.initial, Some(Initial::Exact | Initial::Approx))
            || own.causality == Causality::Input;
        let sizes = self.description.sizes(own, |_| None);
        let count: usize = sizes.map_err(|why| self.elements[at].error(why))?.iter().product();
        if own.start.is_empty() && is_given && own.kind != Kind::Clock && count > 0 {
            let what = match own.causality {
                Causality::Input | Causality::Parameter => own.causality.word(),
                _ => own.initial.unwrap_or_default().word(),
            };
            return wrong(format!("has no start value, which it must have because it is `{what}`"));
        }
        let has_none =
            own.initial == Some(Initial::Calculated) || own.causality == Causality::Independent;
        if !own.start.is_empty() && has_none {
            return wrong(
                "has a start value, which it cannot have because it is computed".to_owned(),
            );
        }
        let given = own.start.len();
        if given > 1 && given != count {
            return wrong(format!("has {given} start values, but {count} elements"));
        }
        let items = own.declared_type.as_deref().and_then(|name| self.types.get(name));
        let items = items.map_or(&[][..], |found| &found.items[..]);
        let has_item = |start: &&String| {
            let number = start.parse::<i64>().ok();
            items.iter().any(|item| Some(item.value) == number)
        };
        if own.kind == Kind::Enumeration
            && let Some(start) = own.start.iter().find(|start| !has_item(start))
        {
            let all: Vec<String> =
                items.iter().map(|item| format!("{} ({})", item.value, item.name)).collect();
            return wrong(format!("starts with {start}, but its values are {}", all.join(", ")));
        }
        self.range(at)
    }

    /// Whether what an importer may set starts within its range.
    fn range(&self, at: usize) -> Result<(), FmuError> {
        let own = &self.description.variables[at];
        let Attributes { min, max, .. } = self.description.attributes_of(own);
        let [min, max] = [min.unwrap_or(f64::NEG_INFINITY), max.unwrap_or(f64::INFINITY)];
        let is_set = own.causality == Causality::Input || own.initial == Some(Initial::Exact);
        let is_outside =
            |start: &&String| real(start).is_some_and(|start| start < min || start > max);
        match own.start.iter().filter(|_| is_set).find(is_outside) {
            Some(start) => {
                Err(self.at(at, format!("starts with {start}, outside its range {min} to {max}")))
            }
            None => Ok(()),
        }
    }

    /// Whether the experiment ends after its start.
    fn experiment(&self, root: &Element) -> Result<(), FmuError> {
        let own = &self.description.experiment;
        let (start, element) = (own.start.unwrap_or(0.0), root.child("DefaultExperiment"));
        match (element, own.stop) {
            (Some(element), Some(stop)) if stop < start => {
                Err(element
                    .error(format!("the `stopTime` {stop} is before the `startTime` {start}")))
            }
            _ => Ok(()),
        }
    }

    /// Aliases of FMI 2.0.5, variables of one base type with one value reference: not two of them can be set,
    /// constants are aliases of equal constants alone, and units agree (§2.2.7).
    fn aliases(&self) -> Result<(), FmuError> {
        let mut first: HashMap<(Kind, u32), usize> = HashMap::new();
        for (at, own) in self.description.variables.iter().enumerate() {
            let base = if own.kind == Kind::Enumeration { Kind::Int32 } else { own.kind };
            let known = *first.entry((base, own.reference)).or_insert(at);
            if known == at {
                continue;
            }
            let other = &self.description.variables[known];
            let unit = |of: &Variable| self.description.attributes_of(of).unit;
            let is_constant = |of: &Variable| of.variability == Variability::Constant;
            let is_set =
                |of: &Variable| matches!(of.causality, Causality::Parameter | Causality::Input);
            let starts = own.start.first().zip(other.start.first());
            let differ = |(a, b): (&String, &String)| match real(a).zip(real(b)) {
                Some((a, b)) => a != b,
                None => a != b,
            };
            let why = if is_set(own) && is_set(other) {
                "both can be set"
            } else if is_constant(own) != is_constant(other) {
                "one of them alone is constant"
            } else if starts.is_some_and(differ) {
                "they have different start values"
            } else if unit(own) != unit(other) {
                "they have different units"
            } else {
                continue;
            };
            let (name, reference) = (&other.name, own.reference);
            return Err(
                self.at(at, format!("has the value reference {reference} of `{name}`, but {why}"))
            );
        }
        Ok(())
    }

    /// In FMI 3.0 no two variables have one value reference.
    fn value_references(&self) -> Result<(), FmuError> {
        let variables = self.elements.iter().zip(&self.description.variables);
        unique("value reference", variables.map(|(element, own)| (*element, own.reference)))
    }

    /// At most one variable is the independent one, in FMI 3.0 exactly one; it is a real number.
    fn independent(&self, root: &Element) -> Result<(), FmuError> {
        let all = self.description.variables.iter().enumerate();
        let mut own = all.filter(|(_, own)| own.causality == Causality::Independent);
        let Some((first, variable)) = own.next() else {
            return match self.description.version {
                Version::V2 => Ok(()),
                Version::V3 => Err(root.error("there is no independent variable".to_owned())),
            };
        };
        if !variable.kind.is_float() {
            return Err(self.at(first, "is the independent variable, but not a real number"));
        }
        match own.next() {
            None => Ok(()),
            Some((second, _)) => {
                let name = &variable.name;
                Err(self.at(second, format!("is independent, and `{name}` as well")))
            }
        }
    }

    /// Whether the lists of the structure hold what they are for, each variable once.
    fn structure(&self, root: &Element) -> Result<(), FmuError> {
        let Some(element) = root.child("ModelStructure") else { return Ok(()) };
        let of = &self.description.structure;
        type Is = fn(&Variable) -> bool;
        let lists: [(&str, &str, &[Unknown], Is, &str); 5] = [
            (
                "Outputs",
                "Output",
                &of.outputs,
                |own| own.causality == Causality::Output,
                "an output",
            ),
            (
                "Derivatives",
                "ContinuousStateDerivative",
                &of.derivatives,
                |own| own.derivative_of.is_some(),
                "a variable with the attribute `derivative`",
            ),
            (
                "",
                "ClockedState",
                &of.clocked_states,
                |own| own.previous.is_some(),
                "a variable with the attribute `previous`",
            ),
            ("InitialUnknowns", "InitialUnknown", &of.initial_unknowns, |_| true, ""),
            (
                "",
                "EventIndicator",
                &of.event_indicators,
                |own| own.kind.is_float(),
                "a real number",
            ),
        ];
        for (group, name, unknowns, is, what) in lists {
            let elements = unknowns_of(&element, self.description.version, (group, name));
            let listed = elements.iter().zip(unknowns);
            let named = |own: &Unknown| &self.description.variables[own.variable];
            if let Some((element, own)) = listed.clone().find(|(_, own)| !is(named(own))) {
                let name = &named(own).name;
                return Err(element.error(format!("`{name}` is listed here, but is not {what}")));
            }
            let names = listed.map(|(element, own)| (*element, named(own).name.as_str()));
            unique("the variable", names)?;
        }
        Ok(())
    }

    /// Whether all outputs are in the structure, and the derivatives of the states, without which an importer
    /// does not integrate them. Derivatives of variables that are computed may be missing: these are no states
    /// where others are chosen.
    fn is_complete(&self) -> Result<(), FmuError> {
        let Description { variables, structure, model_exchange, .. } = self.description;
        let is_listed = |list: &[Unknown], at: usize| list.iter().any(|own| own.variable == at);
        let are_integrated = model_exchange.is_some();
        for (at, own) in variables.iter().enumerate() {
            let is_output = own.causality == Causality::Output && own.kind != Kind::Clock;
            if is_output && !is_listed(&structure.outputs, at) {
                return Err(self.at(at, "is an output that `ModelStructure` does not list"));
            }
            let is_state = |of: usize| {
                structure.derivatives.is_empty() || variables[of].initial == Some(Initial::Exact)
            };
            if are_integrated
                && own.derivative_of.is_some_and(is_state)
                && !is_listed(&structure.derivatives, at)
            {
                return Err(self.at(at, "is a derivative that `ModelStructure` does not list"));
            }
        }
        Ok(())
    }
}
