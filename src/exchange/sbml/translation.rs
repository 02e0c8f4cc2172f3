//! A model of SBML as Modelica text.

use super::document::{Document, Kind, Quantity, Rule, Species};
use super::mathml::MOST_PARTS;
use super::roles::{Role, Roles, definition, reached};
use crate::Refusal;
use crate::diag::Fault;
use crate::expression::{Context, Expression, Function, printed};
use crate::names::{identifier, quoted};
use crate::registry::BAD_OPTION;
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// The parts of a class.
#[derive(Debug, Default)]
pub(super) struct Class {
    pub(super) declarations: Vec<String>,
    pub(super) initial: Vec<String>,
    pub(super) equations: Vec<String>,
    pub(super) algorithm: Vec<String>,
}

/// A model that is being translated.
pub(super) struct Translation<'a> {
    pub(super) document: Document,
    pub(super) roles: Roles,
    /// The names of stored amounts of species whose symbols are concentrations.
    amounts: BTreeMap<String, String>,
    /// Quantities whose initial values are parameters.
    initial_parameters: &'a BTreeMap<String, Initial>,
    /// The initial value of each stored quantity.
    pub(super) start: BTreeMap<String, Expression>,
    /// Parameters that are known before the simulation.
    bound: BTreeSet<String>,
    /// How many parts definitions in place of names have become.
    parts: Cell<usize>,
    pub(super) class: Class,
}

/// The parameters for an initial value.
#[derive(Debug, Clone)]
pub(super) struct Initial {
    /// The value.
    pub(super) value: String,
    /// Whether it counts, where the model computes another one from variables: 0 or 1.
    pub(super) is_set: Option<String>,
}

/// What comes after a declaration: the name and the unit.
fn comment(title: &str, id: &str, unit: &str) -> String {
    let title = if title == id { "" } else { title };
    let text = match (title, unit) {
        (title, "") => title.to_owned(),
        ("", unit) => format!("[{unit}]"),
        (title, unit) => format!("{title} [{unit}]"),
    };
    if text.is_empty() { text } else { format!(" {}", quoted(&text)) }
}

pub(super) fn real(expression: &Expression) -> String {
    printed(expression, Context::Real)
}

impl<'a> Translation<'a> {
    /// Prepares the translation.
    ///
    /// # Errors
    ///
    /// Names that nothing declares, and initial values that nothing gives.
    pub(super) fn new(
        mut document: Document,
        initial_parameters: &'a BTreeMap<String, Initial>,
    ) -> Result<Translation<'a>, Refusal> {
        let roles = Roles::of(&document);
        let stored = document.quantities.iter().filter(|own| roles.stores_amount(own));
        let stored: Vec<String> = stored.map(|own| own.id.clone()).collect();
        let amounts = stored.into_iter().map(|id| {
            let amount = document.names.fresh(&format!("{id}_amount"));
            (id, amount)
        });
        let amounts = amounts.collect();
        let mut own = Translation {
            document,
            roles,
            amounts,
            initial_parameters,
            start: BTreeMap::new(),
            bound: BTreeSet::new(),
            parts: Cell::new(0),
            class: Class::default(),
        };
        own.check_names()?;
        own.check_rules()?;
        own.check_cycles()?;
        own.check_algebraic()?;
        own.derivatives();
        own.delays();
        own.check_size()?;
        own.initial_values();
        own.check_initial_values()?;
        Ok(own)
    }

    /// The text of the class `name`.
    pub(super) fn finish(mut self, name: &str) -> String {
        self.quantities();
        self.relations();
        self.text(name)
    }
}

impl Translation<'_> {
    pub(super) fn quantity(&self, name: &str) -> Option<&Quantity> {
        self.document.quantities.iter().find(|own| own.id == name)
    }

    /// The name of what is stored for a quantity: itself, or its amount.
    pub(super) fn stored(&self, name: &str) -> String {
        self.amounts.get(name).cloned().unwrap_or_else(|| name.to_owned())
    }

    /// The size of the compartment where an amount is stored for a concentration.
    pub(super) fn size_of(&self, name: &str) -> Option<Expression> {
        let Kind::Species(species) = &self.quantity(name)?.kind else { return None };
        self.amounts.contains_key(name).then(|| Expression::name(&species.compartment))
    }

    /// Refuses names that nothing declares, in all mathematics.
    fn check_names(&self) -> Result<(), Refusal> {
        let document = &self.document;
        let reactions = document.reactions.iter().map(|own| own.id.as_str());
        let known: BTreeSet<&str> =
            document.quantities.iter().map(|own| own.id.as_str()).chain(reactions).collect();
        for (names, place) in document.mentions() {
            if let Some(name) = names.iter().find(|name| !known.contains(name.as_str())) {
                let fault = Fault::new(BAD_OPTION, format!("nothing declares `{name}`"));
                return Err(Refusal::new(place, fault));
            }
        }
        Ok(())
    }

    /// Refuses two rules of one kind for a name, and rules for species that reactions change.
    fn check_rules(&self) -> Result<(), Refusal> {
        let document = &self.document;
        let refuse = |rule: &Rule, message: String, help: &str| {
            Err(Refusal::new(rule.place.clone(), Fault::new(BAD_OPTION, message).help(help)))
        };
        let rules: Vec<&Rule> = document.assignments.iter().chain(&document.rates).collect();
        let initial: Vec<&Rule> = document.initial.iter().collect();
        for all in [&rules, &initial] {
            for (place, rule) in all.iter().enumerate() {
                if all[..place].iter().any(|other| other.variable == rule.variable) {
                    let message = format!("`{}` has a rule above", rule.variable);
                    return refuse(rule, message, "remove one of the two");
                }
            }
        }
        let reacts = |name: &str| {
            let is_own = |(species, _): &(String, Expression)| species == name;
            document
                .reactions
                .iter()
                .any(|own| own.products.iter().chain(&own.reactants).any(is_own))
        };
        for rule in rules {
            let quantity = self.quantity(&rule.variable);
            let is_inner = quantity.is_some_and(
                |own| matches!(&own.kind, Kind::Species(species) if !species.boundary),
            );
            if is_inner && reacts(&rule.variable) {
                let message = format!("`{}` has a rule, and reactions change it", rule.variable);
                return refuse(
                    rule,
                    message,
                    "a species with a rule needs `boundaryCondition=\"true\"`",
                );
            }
        }
        Ok(())
    }

    /// Refuses assignment rules and rates of reactions that depend on themselves.
    fn check_cycles(&self) -> Result<(), Refusal> {
        let document = &self.document;
        let rules = document.assignments.iter().map(|own| (&own.variable, &own.math, &own.place));
        let rates = document.reactions.iter().filter_map(|own| {
            let rate = own.rate.as_ref()?;
            Some((&own.id, rate, &own.place))
        });
        for (name, math, place) in rules.chain(rates) {
            if reached(document, math).contains(name) {
                let fault = Fault::new(BAD_OPTION, format!("`{name}` depends on itself"))
                    .help("state such an equation as an algebraic rule");
                return Err(Refusal::new(place.clone(), fault));
            }
        }
        Ok(())
    }

    /// Refuses rules that are inserted into each other until they fill the memory.
    pub(super) fn check_size(&self) -> Result<(), Refusal> {
        if self.parts.get() <= MOST_PARTS {
            return Ok(());
        }
        let fault = Fault::new(
            BAD_OPTION,
            "delays and events depend on rules that become too many terms in each other",
        );
        let place = self.document.assignments.first().map_or(0..0, |rule| rule.place.clone());
        Err(Refusal::new(place, fault))
    }

    /// Refuses what changes from a value on that nothing gives.
    fn check_initial_values(&self) -> Result<(), Refusal> {
        let is_open = |own: &&Quantity| {
            let role = self.roles.get(&own.id);
            let is_parameter = role == Role::Constant && matches!(own.kind, Kind::Parameter);
            let has_value =
                self.start.contains_key(&own.id) || self.initial_parameters.contains_key(&own.id);
            !is_parameter && ![Role::Assigned, Role::Algebraic].contains(&role) && !has_value
        };
        let Some(open) = self.document.quantities.iter().find(is_open) else { return Ok(()) };
        let fault =
            Fault::new(BAD_OPTION, format!("`{}` has no initial value", open.id)).help(match open
                .kind
            {
                Kind::Species(_) => "give it an `initialAmount` or `initialConcentration`",
                Kind::Compartment => "give it a `size`",
                Kind::Stoichiometry => "give it a `stoichiometry`",
                Kind::Parameter => "give it a `value`",
            });
        Err(Refusal::new(open.place.clone(), fault))
    }

    /// Refuses algebraic rules that determine nothing.
    fn check_algebraic(&self) -> Result<(), Refusal> {
        let document = &self.document;
        let open = document.algebraic.len()
            != document
                .quantities
                .iter()
                .filter(|own| self.roles.get(&own.id) == Role::Algebraic)
                .count();
        if let Some(rule) = document.algebraic.first().filter(|_| open) {
            let fault = Fault::new(BAD_OPTION, "algebraic rules determine no variable").help(
                "declare a variable in it that is not constant and that nothing else determines",
            );
            return Err(Refusal::new(rule.place.clone(), fault));
        }
        Ok(())
    }

    /// Applies a change to all mathematics.
    fn change(&mut self, change: &dyn Fn(&Translation<'_>, &Expression) -> Option<Expression>) {
        let mut document = self.document.clone();
        document.change(&|part| change(self, part));
        self.document = document;
    }

    /// Derivatives of what does not change between events are 0.
    fn derivatives(&mut self) {
        self.change(&|own, part| {
            let Expression::Derivative(inner) = part else { return None };
            let Expression::Name(name) = &**inner else { return None };
            let role = own.roles.get(name);
            [Role::Constant, Role::Discrete].contains(&role).then_some(Expression::Number(0.0))
        });
    }

    /// Before the start, states have their initial values, their derivatives are 0, and time runs.
    fn delays(&mut self) {
        self.change(&|own, part| {
            let Expression::Delay(parts) = part else { return None };
            let [math, delay] = &**parts;
            let expanded = own.defined(math, &|_| true);
            let varies = |name: &String| own.roles.get(name) != Role::Constant;
            let is_implicit = expanded
                .any(&|part| matches!(part, Expression::Delay(_) | Expression::Derivative(_)));
            let earlier = Expression::sum(vec![Expression::Time, delay.clone().negative()]);
            let assigned = own.before_start(math, &earlier);
            if assigned.is_none() && !is_implicit && !expanded.names().iter().any(varies) {
                return Some(at_time(&expanded, &earlier));
            }
            let is_derivative = math.any(&|part| matches!(part, Expression::Derivative(_)));
            let before = assigned.or(is_derivative.then_some(Expression::Number(0.0)))?;
            let begun =
                Expression::call(Function::GreaterOrEqual, vec![Expression::Time, delay.clone()]);
            Some(Expression::Piecewise(vec![(part.clone(), begun)], Some(Box::new(before))))
        });
    }

    /// What a variable was before the start: an initial assignment that depends on time holds there, too.
    fn before_start(&self, math: &Expression, earlier: &Expression) -> Option<Expression> {
        let Expression::Name(name) = math else { return None };
        let rule = self.document.initial.iter().find(|rule| rule.variable == *name)?;
        let depends = rule.math.any(&|part| *part == Expression::Time);
        depends.then(|| at_time(&rule.math, earlier))
    }

    /// The initial values of what is stored.
    fn initial_values(&mut self) {
        for own in &self.document.quantities {
            let rule = self.document.initial.iter().find(|rule| rule.variable == own.id);
            let value = match (rule, &own.kind) {
                (Some(rule), _) => match self.size_of(&own.id) {
                    Some(size) => Some(rule.math.clone().times(size)),
                    None => Some(rule.math.clone()),
                },
                (None, Kind::Species(species)) => own
                    .value
                    .map(|value| species_start(species, value, self.amounts.contains_key(&own.id))),
                (None, _) => own.value.map(Expression::Number),
            };
            if let Some(value) = value {
                self.start.insert(own.id.clone(), value);
            }
        }
        self.find_bound();
    }

    /// Parameters whose values follow from numbers and from others of them.
    fn find_bound(&mut self) {
        let constants: Vec<String> = self.constants().map(|own| own.id.clone()).collect();
        self.bound = constants.iter().cloned().collect();
        loop {
            let is_open = |id: &&String| {
                self.bound.contains(*id)
                    && self.start.get(*id).is_some_and(|value| !self.is_bound(value))
            };
            let Some(open) = constants.iter().find(is_open).cloned() else { break };
            self.bound.remove(&open);
        }
    }

    fn constants(&self) -> impl Iterator<Item = &Quantity> {
        self.document.quantities.iter().filter(|own| {
            self.roles.get(&own.id) == Role::Constant && !self.amounts.contains_key(&own.id)
        })
    }

    /// Whether an expression is known before the simulation.
    pub(super) fn is_bound(&self, expression: &Expression) -> bool {
        let varies = |part: &Expression| match part {
            Expression::Name(name) => !self.bound.contains(name),
            Expression::Time | Expression::Derivative(_) | Expression::Delay(_) => true,
            _ => false,
        };
        !expression.any(&varies)
    }

    /// Declares all quantities.
    fn quantities(&mut self) {
        let all = self.document.quantities.clone();
        // Parameters come first, as readers expect them.
        let (constants, others): (Vec<_>, Vec<_>) =
            all.iter().partition(|own| self.roles.get(&own.id) == Role::Constant);
        constants.into_iter().chain(others).for_each(|own| self.declare(own));
    }

    fn declare(&mut self, own: &Quantity) {
        let comment = comment(&own.title, &own.id, &own.unit);
        self.class.declarations.extend(remarks(&own.notes));
        let name = identifier(&own.id);
        let role = self.roles.get(&own.id);
        if let Some(size) = self.size_of(&own.id) {
            self.class.declarations.push(format!("Real {name}{comment};"));
            let amount = Expression::name(self.stored(&own.id));
            self.class.equations.push(format!("{name} = {};", real(&amount.over(size))));
        }
        let (stored, comment) = match self.amounts.get(&own.id) {
            Some(amount) => (identifier(amount), format!(" \"amount of {}\"", own.id)),
            None => (name, comment),
        };
        let mut start = self.start.get(&own.id).cloned();
        if let Some(initial) = self.initial_parameters.get(&own.id) {
            let symbol = start.map(|value| self.of_symbol(&own.id, value));
            let value = self.initial_parameter(&own.id, initial, symbol);
            start = Some(match self.size_of(&own.id) {
                Some(size) => value.times(size),
                None => value,
            });
        }
        let text = match role {
            Role::Assigned => format!("Real {stored}{comment};"),
            Role::Algebraic => match start {
                Some(value) if self.is_bound(&value) => {
                    format!("Real {stored}(start = {}){comment};", real(&value))
                }
                _ => format!("Real {stored}{comment};"),
            },
            Role::Constant => self.parameter(own, &stored, start, &comment),
            Role::State => self.varying("Real", &stored, start, &comment),
            Role::Discrete => self.varying("discrete Real", &stored, start, &comment),
        };
        self.class.declarations.push(text);
    }

    /// The value of a symbol for that of what is stored for it.
    fn of_symbol(&self, name: &str, stored: Expression) -> Expression {
        match self.size_of(name) {
            Some(size) => stored.over(size),
            None => stored,
        }
    }

    /// Whether the initial value of a quantity depends on variables.
    pub(super) fn starts_from_variables(&self, name: &str) -> bool {
        let start = self.start.get(name).cloned();
        start.is_some_and(|value| !self.is_bound(&self.of_symbol(name, value)))
    }

    /// Declares the parameters for an initial value, which is `usual` unless set; the value.
    fn initial_parameter(
        &mut self,
        name: &str,
        initial: &Initial,
        usual: Option<Expression>,
    ) -> Expression {
        let value = Expression::name(&initial.value);
        let parameter = identifier(&initial.value);
        self.bound.insert(initial.value.clone());
        let (Some(is_set), Some(usual)) = (&initial.is_set, &usual) else {
            let usual = usual.map_or(String::new(), |own| format!(" = {}", real(&own)));
            let text = format!("parameter Real {parameter}{usual} \"initial value of {name}\";");
            self.class.declarations.push(text);
            return value;
        };
        let flag = identifier(is_set);
        self.class.declarations.push(format!(
            "parameter Real {parameter} = 0 \"initial value of {name}, where {is_set} is 1\";"
        ));
        self.class.declarations.push(format!("parameter Real {flag} = 0;"));
        self.bound.insert(is_set.clone());
        let one = Expression::Number(1.0);
        let condition =
            Expression::call(Function::GreaterOrEqual, vec![Expression::name(is_set), one]);
        Expression::Piecewise(vec![(value, condition)], Some(Box::new(usual.clone())))
    }

    /// What keeps its initial value.
    fn parameter(
        &mut self,
        own: &Quantity,
        stored: &str,
        start: Option<Expression>,
        comment: &str,
    ) -> String {
        match start {
            None => format!("parameter Real {stored}{comment};"),
            Some(value) if self.is_bound(&value) => {
                self.bound.insert(own.id.clone());
                format!("parameter Real {stored} = {}{comment};", real(&value))
            }
            Some(value) => {
                self.class.initial.push(format!("{stored} = {};", real(&value)));
                format!("parameter Real {stored}(fixed = false){comment};")
            }
        }
    }

    /// What changes, from its initial value on.
    fn varying(
        &mut self,
        kind: &str,
        stored: &str,
        start: Option<Expression>,
        comment: &str,
    ) -> String {
        match start {
            None => format!("{kind} {stored}(start = 0, fixed = true){comment};"),
            Some(value) if self.is_bound(&value) => {
                format!("{kind} {stored}(start = {}, fixed = true){comment};", real(&value))
            }
            Some(value) => {
                let left =
                    if kind == "Real" { stored.to_owned() } else { format!("pre({stored})") };
                self.class.initial.push(format!("{left} = {};", real(&value)));
                format!("{kind} {stored}{comment};")
            }
        }
    }

    /// The equations of rules and reactions.
    fn relations(&mut self) {
        for own in &self.document.reactions {
            let comment = comment(&own.title, &own.id, "");
            let name = identifier(&own.id);
            self.class.declarations.extend(remarks(&own.notes));
            self.class.declarations.push(format!("Real {name}{comment};"));
            let rate = own.rate.clone().unwrap_or(Expression::Number(0.0));
            self.class.equations.push(format!("{name} = {};", real(&rate)));
        }
        for rule in &self.document.assignments {
            let name = identifier(&rule.variable);
            self.class.equations.push(format!("{name} = {};", real(&rule.math)));
        }
        for rule in &self.document.algebraic {
            self.class.equations.push(format!("0 = {};", real(&rule.math)));
        }
        let states: Vec<&Quantity> = self
            .document
            .quantities
            .iter()
            .filter(|own| self.roles.get(&own.id) == Role::State)
            .collect();
        for own in states {
            let stored = identifier(&self.stored(&own.id));
            let rule = self.document.rates.iter().find(|rule| rule.variable == own.id);
            let rate = match (rule, &own.kind) {
                (Some(rule), _) => self.of_rate_rule(&own.id, rule.math.clone()),
                (None, Kind::Species(species)) => self.of_reactions(own, species),
                (None, _) => Expression::Number(0.0),
            };
            self.class.equations.push(format!("der({stored}) = {};", real(&rate)));
        }
    }

    /// The derivative of what is stored, where a rule gives that of the symbol.
    fn of_rate_rule(&self, name: &str, rate: Expression) -> Expression {
        let Some(size) = self.size_of(name) else { return rate };
        let change = rate.times(size.clone());
        let Expression::Name(compartment) = &size else { return change };
        if self.roles.get(compartment) == Role::Discrete {
            return change;
        }
        let growth = Expression::name(name).times(Expression::Derivative(Box::new(size)));
        Expression::sum(vec![change, growth])
    }

    /// The derivative of a species by its reactions.
    fn of_reactions(&self, own: &Quantity, species: &Species) -> Expression {
        let mut terms = Vec::new();
        for reaction in &self.document.reactions {
            let flux = || Expression::name(&reaction.id);
            let here = |side: &[(String, Expression)]| -> Vec<Expression> {
                let mine = side.iter().filter(|(name, _)| *name == own.id);
                mine.map(|(_, stoichiometry)| stoichiometry.clone().times(flux())).collect()
            };
            terms.extend(here(&reaction.products));
            terms.extend(here(&reaction.reactants).into_iter().map(Expression::negative));
        }
        let mut rate = Expression::sum(terms);
        if let Some(factor) = species.conversion.as_ref().or(self.document.conversion.as_ref()) {
            rate = rate.times(Expression::name(factor));
        }
        match species.is_amount || self.amounts.contains_key(&own.id) {
            true => rate,
            false => rate.over(Expression::name(&species.compartment)),
        }
    }

    /// An expression with the rules in place of names that depend on one of `names`.
    pub(super) fn expanded(&self, own: &Expression, names: &BTreeSet<String>) -> Expression {
        self.defined(own, &|math| {
            let mut reached = reached(&self.document, math).into_iter();
            reached.any(|name| names.contains(&name) || names.contains(&self.stored(&name)))
        })
    }

    /// An expression with definitions in place of names, of those that `is` holds for.
    fn defined(&self, own: &Expression, is: &dyn Fn(&Expression) -> bool) -> Expression {
        self.defined_below(&[], own, is)
    }

    /// The same within the definitions of `names`: the size of a compartment may depend on a concentration in it.
    fn defined_below(
        &self,
        names: &[&str],
        own: &Expression,
        is: &dyn Fn(&Expression) -> bool,
    ) -> Expression {
        own.replaced(&|part| {
            let Expression::Name(name) = part else { return None };
            if names.contains(&name.as_str()) || self.parts.get() > MOST_PARTS {
                return None;
            }
            let math = self.symbol_definition(name).filter(is)?;
            self.parts.set(self.parts.get().saturating_add(math.size()));
            Some(self.defined_below(&[names, &[name.as_str()]].concat(), &math, is))
        })
    }

    /// What a symbol is computed from.
    fn symbol_definition(&self, name: &str) -> Option<Expression> {
        if let Some(size) = self.size_of(name) {
            return Some(Expression::name(self.stored(name)).over(size));
        }
        definition(&self.document, name).cloned()
    }

    /// The text of the class.
    fn text(&self, name: &str) -> String {
        let mut text = String::new();
        let document = &self.document;
        for line in remarks(&document.notes) {
            _ = writeln!(text, "{line}");
        }
        let title = comment(&document.title, name, "");
        _ = writeln!(text, "model {}{title}", identifier(name));
        if self
            .class
            .declarations
            .iter()
            .chain(&self.class.equations)
            .chain(&self.class.algorithm)
            .any(|line| line.contains("factorial("))
        {
            text += FACTORIAL;
        }
        let sections = [
            ("", &self.class.declarations),
            ("initial equation\n", &self.class.initial),
            ("equation\n", &self.class.equations),
            ("algorithm\n", &self.class.algorithm),
        ];
        for (heading, lines) in sections.iter().filter(|(_, lines)| !lines.is_empty()) {
            text += heading;
            for line in lines.iter() {
                _ = writeln!(text, "  {line}");
            }
        }
        _ = writeln!(text, "end {};", identifier(name));
        text
    }
}

const FACTORIAL: &str = "  function factorial
    input Real n;
    output Real y = 1;
  algorithm
    for k in 2:integer(n + 0.5) loop
      y := y*k;
    end for;
  end factorial;
";

/// An expression at another time.
fn at_time(math: &Expression, time: &Expression) -> Expression {
    math.replaced(&|part| (*part == Expression::Time).then(|| time.clone()))
}

/// The initial value of what is stored for a species.
fn species_start(species: &Species, value: f64, stores_amount: bool) -> Expression {
    let value = Expression::Number(value);
    let size = Expression::name(&species.compartment);
    let is_amount = species.is_amount || stores_amount;
    match (species.starts_as_amount, is_amount) {
        _ if value == Expression::Number(0.0) => value,
        (true, false) => value.over(size),
        (false, true) => value.times(size),
        _ => value,
    }
}

/// Lines of a comment.
fn remarks(text: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut().filter(|line| line.len() + word.len() < 98) {
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(format!("// {word}")),
        }
    }
    lines
}
