//! What an SBML document contains.

use super::element::Element;
use super::mathml::{self, Lambda, Scope};
use super::units;
use crate::Refusal;
use crate::diag::Fault;
use crate::expression::Expression;
use crate::names::Names;
use crate::registry::BAD_OPTION;
use roxmltree::Document as Xml;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// A place in the document.
pub(super) type Place = Range<usize>;

/// What has a name and a value: a compartment, species, parameter or stoichiometry.
#[derive(Debug, Clone)]
pub(super) struct Quantity {
    pub(super) id: String,
    pub(super) title: String,
    pub(super) unit: String,
    pub(super) constant: bool,
    pub(super) kind: Kind,
    pub(super) value: Option<f64>,
    /// What the document says about it.
    pub(super) notes: String,
    pub(super) place: Place,
}

#[derive(Debug, Clone)]
pub(super) enum Kind {
    Parameter,
    Compartment,
    Stoichiometry,
    Species(Species),
}

#[derive(Debug, Clone)]
pub(super) struct Species {
    pub(super) compartment: String,
    /// Whether its symbol is its amount, not its concentration.
    pub(super) is_amount: bool,
    /// Whether the initial value is an amount.
    pub(super) starts_as_amount: bool,
    pub(super) boundary: bool,
    pub(super) conversion: Option<String>,
}

/// A reaction.
#[derive(Debug, Clone)]
pub(super) struct Reaction {
    pub(super) id: String,
    pub(super) title: String,
    pub(super) rate: Option<Expression>,
    pub(super) notes: String,
    pub(super) place: Place,
    /// Species with their stoichiometries; those of reactants are subtracted.
    pub(super) products: Vec<(String, Expression)>,
    pub(super) reactants: Vec<(String, Expression)>,
}

/// An equation of a rule; `variable` is empty for an algebraic rule.
#[derive(Debug, Clone)]
pub(super) struct Rule {
    pub(super) variable: String,
    pub(super) math: Expression,
    pub(super) place: Place,
}

#[derive(Debug, Clone)]
pub(super) struct Event {
    pub(super) id: String,
    pub(super) title: String,
    pub(super) trigger: Expression,
    pub(super) initial_value: bool,
    pub(super) persistent: bool,
    pub(super) uses_trigger_values: bool,
    pub(super) priority: Option<Expression>,
    pub(super) delay: Option<Expression>,
    pub(super) assignments: Vec<(String, Expression)>,
    pub(super) place: Place,
}

/// A model.
#[derive(Debug, Clone)]
pub(super) struct Document {
    pub(super) id: String,
    pub(super) title: String,
    pub(super) notes: String,
    pub(super) quantities: Vec<Quantity>,
    pub(super) reactions: Vec<Reaction>,
    pub(super) assignments: Vec<Rule>,
    pub(super) rates: Vec<Rule>,
    pub(super) algebraic: Vec<Rule>,
    pub(super) initial: Vec<Rule>,
    pub(super) events: Vec<Event>,
    pub(super) conversion: Option<String>,
    pub(super) names: Names,
}

impl Document {
    /// Applies a change to all mathematics.
    pub(super) fn change(&mut self, change: &dyn Fn(&Expression) -> Option<Expression>) {
        let rules = self.assignments.iter_mut().chain(&mut self.rates);
        let rules = rules.chain(&mut self.algebraic).chain(&mut self.initial);
        let of_rules = rules.map(|rule| &mut rule.math);
        let of_reactions = self.reactions.iter_mut().filter_map(|own| own.rate.as_mut());
        let of_events = self.events.iter_mut().flat_map(|event| {
            let values = event.assignments.iter_mut().map(|(_, math)| math);
            values.chain([&mut event.trigger]).chain(&mut event.delay).chain(&mut event.priority)
        });
        for math in of_rules.chain(of_reactions).chain(of_events) {
            *math = math.replaced(change);
        }
    }

    /// The names that each part mentions, with its place.
    pub(super) fn mentions(&self) -> impl Iterator<Item = (BTreeSet<String>, Place)> {
        let all = [&self.assignments, &self.rates, &self.algebraic, &self.initial];
        let rules = all.into_iter().flatten().map(|rule| {
            let variable = Some(rule.variable.clone()).filter(|own| !own.is_empty());
            (rule.math.names().into_iter().chain(variable).collect(), rule.place.clone())
        });
        let reactions = self.reactions.iter().map(|own| {
            let sides = own.products.iter().chain(&own.reactants).map(|(_, math)| math);
            let names = sides.chain(&own.rate).flat_map(Expression::names);
            (names.collect(), own.place.clone())
        });
        let events = self.events.iter().map(|own| {
            let values = own.assignments.iter().map(|(_, math)| math);
            let parts = values.chain([&own.trigger]).chain(&own.delay).chain(&own.priority);
            let targets = own.assignments.iter().map(|(name, _)| name.clone());
            (parts.flat_map(Expression::names).chain(targets).collect(), own.place.clone())
        });
        let factors = self.quantities.iter().filter_map(|own| match &own.kind {
            Kind::Species(Species { conversion: Some(factor), .. }) => {
                Some((BTreeSet::from([factor.clone()]), own.place.clone()))
            }
            _ => None,
        });
        rules.chain(reactions).chain(events).chain(factors)
    }

    /// Makes a constant one that has a value before time 0, where the model comes to rest, and another
    /// one from then on; the names of the parameters with both.
    pub(super) fn switch(&mut self, id: &str) -> [String; 2] {
        let [rest, own] = ["rest", "sim"].map(|what| self.names.fresh(&format!("{id}_{what}")));
        let pair = (Expression::name(&rest), Expression::before_zero());
        let math = Expression::Piecewise(vec![pair], Some(Box::new(Expression::name(&own))));
        self.assignments.push(Rule { variable: id.to_owned(), math, place: 0..0 });
        // Initial values are those of the steady state; parameters that depend on it follow it.
        let names = BTreeMap::from([(id.to_owned(), Expression::name(&rest))]);
        let is_fixed = |own: &Quantity| matches!(own.kind, Kind::Parameter | Kind::Compartment);
        let fixed: BTreeSet<String> = self
            .quantities
            .iter()
            .filter(|own| own.constant && is_fixed(own))
            .map(|own| own.id.clone())
            .collect();
        let depends =
            |rule: &Rule| fixed.contains(&rule.variable) && rule.math.names().contains(id);
        let (following, initial): (Vec<Rule>, Vec<Rule>) =
            self.initial.drain(..).partition(depends);
        self.initial = initial;
        self.initial.iter_mut().for_each(|rule| rule.math = rule.math.substituted(&names));
        for rule in following {
            self.quantities
                .iter_mut()
                .filter(|own| own.id == rule.variable)
                .for_each(|own| own.constant = false);
            self.assignments.push(rule);
        }
        let before = self.initial.iter().position(|rule| rule.variable == id);
        let before = before.map(|place| self.initial.remove(place));
        let Some(quantity) = self.quantities.iter_mut().find(|own| own.id == id) else {
            return [rest, own];
        };
        quantity.constant = false;
        let kind = Kind::Parameter;
        let parameter = Quantity { constant: true, kind, ..quantity.clone() };
        for name in [&rest, &own] {
            self.quantities.push(Quantity { id: name.clone(), ..parameter.clone() });
            let rule = before.clone().map(|rule| Rule { variable: name.clone(), ..rule });
            self.initial.extend(rule);
        }
        [rest, own]
    }
}

/// A document that is being read.
struct Reader {
    level: u32,
    scope: Scope,
    units: BTreeMap<String, String>,
    /// Compartments without a size: their species are amounts.
    points: BTreeSet<String>,
    document: Document,
}

fn place(element: &Element<'_, '_>) -> Place {
    element.refusal(Fault::new(BAD_OPTION, "")).place
}

fn parsed(text: &str) -> Result<Xml<'_>, Refusal> {
    Xml::parse(text).map_err(|error| {
        let position = error.pos();
        let line = text.split_inclusive('\n').take(position.row.saturating_sub(1) as usize);
        let start = line.map(str::len).sum::<usize>().min(text.len());
        let fault = Fault::new(BAD_OPTION, format!("the file is not well-formed XML: {error}"));
        Refusal::new(start..start, fault)
    })
}

/// The names that the formulas of a model mention.
///
/// # Errors
///
/// Text that is not XML.
pub(crate) fn mentioned(text: &str) -> Result<BTreeSet<String>, Refusal> {
    let xml = parsed(text)?;
    let names = xml.descendants().filter(|node| node.tag_name().name() == "ci");
    Ok(names.filter_map(|node| Some(node.text()?.trim().to_owned())).collect())
}

/// The model in the text of a document.
pub(super) fn read(text: &str) -> Result<Document, Refusal> {
    let xml = parsed(text)?;
    let root = Element(xml.root_element());
    if root.name() != "sbml" {
        return Err(root.wrong(format!("the element is `{}`, not `sbml`", root.name())));
    }
    let level = root.number("level")?.unwrap_or(0.0) as u32;
    if ![2, 3].contains(&level) {
        return Err(root.unsupported(&format!("level {level} of SBML")));
    }
    packages(&root)?;
    let Some(model) = root.child("model") else {
        return Err(root.wrong("the document has no model"));
    };
    let mut reader = Reader::new(&model, level);
    reader.read(&model)?;
    Ok(reader.document)
}

/// Refuses packages without which the model has another meaning.
fn packages(root: &Element<'_, '_>) -> Result<(), Refusal> {
    let required = root.0.attributes().find(|attribute| {
        attribute.name() == "required"
            && attribute.namespace().is_some()
            && attribute.value() == "true"
    });
    let Some(space) = required.and_then(|attribute| attribute.namespace()) else { return Ok(()) };
    let is_used = |node: &roxmltree::Node<'_, '_>| {
        let mut attributes = node.attributes();
        let is_of_it = node.tag_name().namespace() == Some(space);
        is_of_it || *node != root.0 && attributes.any(|own| own.namespace() == Some(space))
    };
    // Programs declare packages that the model does not use.
    let Some(used) = root.0.descendants().find(is_used) else { return Ok(()) };
    let words: Vec<&str> = space.split('/').collect();
    let name = words.iter().rev().nth(1).copied().unwrap_or_default();
    Err(Element(used).unsupported(&format!("the package `{name}` of SBML")))
}

impl Reader {
    fn new(model: &Element<'_, '_>, level: u32) -> Reader {
        let id = model.text("id").or_else(|| model.text("name")).filter(|id| !id.is_empty());
        let document = Document {
            id: id.unwrap_or_else(|| "Model".to_owned()),
            title: model.text("name").unwrap_or_default(),
            notes: model.notes(),
            quantities: Vec::new(),
            reactions: Vec::new(),
            assignments: Vec::new(),
            rates: Vec::new(),
            algebraic: Vec::new(),
            initial: Vec::new(),
            events: Vec::new(),
            conversion: model.text("conversionFactor"),
            names: Names::default(),
        };
        Reader {
            level,
            scope: Scope::default(),
            units: BTreeMap::new(),
            points: BTreeSet::new(),
            document,
        }
    }

    fn read(&mut self, model: &Element<'_, '_>) -> Result<(), Refusal> {
        self.take_names(model);
        self.units = units::definitions(model)?;
        for own in model.list("listOfFunctionDefinitions") {
            let lambda: Lambda = mathml::lambda(&own, &self.scope)?;
            self.scope.functions.insert(own.required("id")?, lambda);
        }
        for own in model.list("listOfCompartments") {
            let size = own.number("size")?;
            if own.number("spatialDimensions")? == Some(0.0) && size.is_none() {
                self.points.insert(own.required("id")?);
                continue;
            }
            let quantity = self.quantity(&own, Kind::Compartment, "units", size)?;
            self.document.quantities.push(quantity);
        }
        model.list("listOfSpecies").iter().try_for_each(|own| self.species(own))?;
        for own in model.list("listOfParameters") {
            let value = own.number("value")?;
            let quantity = self.quantity(&own, Kind::Parameter, "units", value)?;
            self.document.quantities.push(quantity);
        }
        for own in model.list("listOfInitialAssignments") {
            let rules = self.rule(&own, own.required("symbol")?)?;
            self.document.initial.extend(rules);
        }
        model.list("listOfRules").iter().try_for_each(|own| self.any_rule(own))?;
        if let Some(own) = model.list("listOfConstraints").first() {
            return Err(own.unsupported("a constraint"));
        }
        model.list("listOfReactions").iter().try_for_each(|own| self.reaction(own))?;
        let events = model.list("listOfEvents");
        events.iter().try_for_each(|own| self.event(own))
    }

    /// All identifiers of the model: names that are made must differ from them.
    fn take_names(&mut self, model: &Element<'_, '_>) {
        let is_local = |node: &roxmltree::Node<'_, '_>| {
            node.ancestors().any(|above| above.tag_name().name() == "kineticLaw")
        };
        for node in model.0.descendants().filter(|node| node.is_element() && !is_local(node)) {
            if let Some(id) = node.attribute("id").filter(|_| node != model.0) {
                self.document.names.fresh(id.trim());
            }
        }
    }

    fn quantity(
        &self,
        own: &Element<'_, '_>,
        kind: Kind,
        units: &str,
        value: Option<f64>,
    ) -> Result<Quantity, Refusal> {
        let unit = own.get(units).unwrap_or_default().trim();
        Ok(Quantity {
            id: own.required("id")?,
            title: own.text("name").unwrap_or_default(),
            unit: self.units.get(unit).cloned().unwrap_or_else(|| unit.to_owned()),
            constant: own.truth("constant", !matches!(kind, Kind::Species(_)))?,
            kind,
            value,
            notes: own.notes(),
            place: place(own),
        })
    }

    /// Whether something of this name and kind is declared before.
    fn declares(&self, id: &str, is: fn(&Kind) -> bool) -> bool {
        self.document.quantities.iter().any(|other| other.id == id && is(&other.kind))
    }

    fn species(&mut self, own: &Element<'_, '_>) -> Result<(), Refusal> {
        let (amount, concentration) =
            (own.number("initialAmount")?, own.number("initialConcentration")?);
        let compartment = own.required("compartment")?;
        let is_point = self.points.contains(&compartment);
        if !is_point && !self.declares(&compartment, |kind| matches!(kind, Kind::Compartment)) {
            return Err(own.wrong(format!("no compartment `{compartment}` is declared")));
        }
        let species = Species {
            compartment,
            is_amount: own.truth("hasOnlySubstanceUnits", false)? || is_point,
            starts_as_amount: amount.is_some() || is_point,
            boundary: own.truth("boundaryCondition", false)?,
            conversion: own.text("conversionFactor"),
        };
        let value = amount.or(concentration);
        let compartment = species.compartment.clone();
        let is_amount = species.is_amount;
        let mut quantity = self.quantity(own, Kind::Species(species), "substanceUnits", value)?;
        let size = self.document.quantities.iter().find(|other| other.id == compartment);
        if let Some(size) =
            size.filter(|size| !is_amount && !size.unit.is_empty() && !quantity.unit.is_empty())
        {
            quantity.unit = format!("{}/{}", quantity.unit, size.unit);
        }
        self.document.quantities.push(quantity);
        Ok(())
    }

    /// The rule of an element; `None` where it has no mathematics.
    fn rule(&self, own: &Element<'_, '_>, variable: String) -> Result<Option<Rule>, Refusal> {
        let math = mathml::math(own, &self.scope)?;
        Ok(math.map(|math| Rule { variable, math, place: place(own) }))
    }

    fn any_rule(&mut self, own: &Element<'_, '_>) -> Result<(), Refusal> {
        match own.name() {
            "assignmentRule" => {
                let rule = self.rule(own, own.required("variable")?)?;
                self.document.assignments.extend(rule);
            }
            "rateRule" => {
                let rule = self.rule(own, own.required("variable")?)?;
                self.document.rates.extend(rule);
            }
            "algebraicRule" => {
                let rule = self.rule(own, String::new())?;
                self.document.algebraic.extend(rule);
            }
            other => return Err(own.unsupported(&format!("`{other}`"))),
        }
        Ok(())
    }

    fn reaction(&mut self, own: &Element<'_, '_>) -> Result<(), Refusal> {
        let id = own.required("id")?;
        if own.truth("fast", false)? {
            return Err(own.unsupported("a fast reaction"));
        }
        let mut rate = None;
        if let Some(law) = &own.child("kineticLaw") {
            let mut scope = self.scope.clone();
            let list = if self.level == 2 { "listOfParameters" } else { "listOfLocalParameters" };
            for local in law.list(list) {
                let name = local.required("id")?;
                let value = local.number("value")?;
                let mut quantity = self.quantity(&local, Kind::Parameter, "units", value)?;
                quantity.constant = true;
                quantity.id = self.document.names.fresh(&format!("{id}_{name}"));
                scope.local.insert(name, quantity.id.clone());
                self.document.quantities.push(quantity);
            }
            rate = mathml::math(law, &scope)?;
        }
        if rate.is_none() {
            let fault = Fault::new(BAD_OPTION, format!("the reaction `{id}` has no kinetic law"))
                .help("give it a `kineticLaw` with mathematics, or remove it");
            return Err(own.refusal(fault));
        }
        for modifier in own.list("listOfModifiers") {
            self.species_of(&modifier)?;
        }
        let mut sides = Vec::new();
        for list in ["listOfProducts", "listOfReactants"] {
            let references = own.list(list);
            let side: Result<Vec<_>, Refusal> =
                references.iter().map(|reference| self.reference(reference)).collect();
            sides.push(side?);
        }
        let reactants = sides.pop().unwrap_or_default();
        let products = sides.pop().unwrap_or_default();
        let title = own.text("name").unwrap_or_default();
        let (notes, place) = (own.notes(), place(own));
        let reaction = Reaction { id, title, rate, notes, place, products, reactants };
        self.document.reactions.push(reaction);
        Ok(())
    }

    /// The species that a reference names.
    fn species_of(&self, own: &Element<'_, '_>) -> Result<String, Refusal> {
        let species = own.required("species")?;
        match self.declares(&species, |kind| matches!(kind, Kind::Species(_))) {
            true => Ok(species),
            false => Err(own.wrong(format!("no species `{species}` is declared"))),
        }
    }

    /// A species with its stoichiometry.
    fn reference(&mut self, own: &Element<'_, '_>) -> Result<(String, Expression), Refusal> {
        let species = self.species_of(own)?;
        if let Some(element) = own.child("stoichiometryMath")
            && let Some(math) = mathml::math(&element, &self.scope)?
        {
            return Ok((species, math));
        }
        let default = (self.level == 2).then_some(1.0);
        let below = own.number("denominator")?.unwrap_or(1.0);
        let value = own.number("stoichiometry")?.or(default).map(|value| value / below);
        let Some(id) = own.text("id") else {
            let missing = || own.wrong("the stoichiometry has no value");
            return Ok((species, Expression::Number(value.ok_or_else(missing)?)));
        };
        let mut quantity = self.quantity(own, Kind::Stoichiometry, "", value)?;
        quantity.constant = own.truth("constant", true)? && self.level == 3;
        self.document.quantities.push(quantity);
        Ok((species, Expression::Name(id)))
    }

    fn event(&mut self, own: &Element<'_, '_>) -> Result<(), Refusal> {
        let part = |name: &str| match own.child(name) {
            Some(part) => mathml::math(&part, &self.scope),
            None => Ok(None),
        };
        let Some(trigger) = part("trigger")? else { return Ok(()) };
        let (delay, priority) = (part("delay")?, part("priority")?);
        let element = own.child("trigger").unwrap_or(*own);
        let mut assignments = Vec::new();
        for assignment in own.list("listOfEventAssignments") {
            if let Some(math) = mathml::math(&assignment, &self.scope)? {
                assignments.push((assignment.required("variable")?, math));
            }
        }
        let number = self.document.events.len() + 1;
        let id =
            own.text("id").unwrap_or_else(|| self.document.names.fresh(&format!("event_{number}")));
        self.document.events.push(Event {
            id,
            title: own.text("name").unwrap_or_default(),
            trigger,
            initial_value: element.truth("initialValue", true)?,
            persistent: element.truth("persistent", true)?,
            uses_trigger_values: own.truth("useValuesFromTriggerTime", true)?,
            priority,
            delay,
            assignments,
            place: place(own),
        });
        Ok(())
    }
}
