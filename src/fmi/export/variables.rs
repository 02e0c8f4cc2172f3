//! The variables of a unit.

use super::content::{Exported, Place, Setter, ValueKind};
use super::units::display;
use super::{Input, Kinds, Model};
use crate::codegen::{Access, Program, VariableInfo};
use crate::description::{
    Attributes, Causality, Initial, Item, Kind, TypeDefinition, Variability, Variable, Version,
};
use crate::diag::Fault;
use crate::fault;
use crate::flatten::{self, BaseType};
use crate::lower::errors::NOT_SUPPORTED;
use crate::sim::Residual as _;
use std::collections::BTreeMap;

/// All variables of a unit with what they stand for; a value reference is a place.
pub(super) struct Table {
    pub(super) variables: Vec<(Variable, Exported)>,
    /// The numbers that the program gives to the continuous states: not to inputs.
    pub(super) states: Vec<usize>,
    /// Their places, and those of their derivatives.
    pub(super) state_places: Vec<usize>,
    pub(super) derivatives: Vec<usize>,
    /// Numbers of states that are inputs, with the places of these.
    pub(super) inputs: Vec<(usize, usize)>,
    /// Whether there are inputs that are no states.
    pub(super) has_recorded: bool,
    pub(super) n_indicators: usize,
}

impl Table {
    pub(super) fn new(model: &Model, version: Version, kinds: Kinds) -> Result<Table, Fault> {
        let program = model.program;
        let mut table = Table {
            variables: Vec::new(),
            states: Vec::new(),
            state_places: Vec::new(),
            derivatives: Vec::new(),
            inputs: Vec::new(),
            has_recorded: false,
            n_indicators: 0,
        };
        table.add_time();
        let rows = Rows::new(model)?;
        for at in 0..program.variables().len() {
            table.add_variable(model, &rows, version, at)?;
        }
        table.add_states(model, &rows);
        table.add_strings(model);
        if kinds.model_exchange {
            table.add_indicators(program, version);
        }
        Ok(table)
    }

    pub(super) fn exported(&self) -> Vec<Exported> {
        self.variables.iter().map(|(_, exported)| exported.clone()).collect()
    }

    /// Whether all names have the structured form of the standard.
    pub(super) fn has_structured_names(&self) -> bool {
        let is_plain = |name: &str| {
            let inner = name.strip_prefix("der(").and_then(|name| name.strip_suffix(')'));
            let mut parts = inner.unwrap_or(name).split('.');
            parts.all(|part| {
                let (name, subscripts) = part.split_once('[').unwrap_or((part, "1]"));
                let starts = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
                let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
                let subscripts = subscripts.strip_suffix(']').unwrap_or("");
                let counts = |one: &str| !one.is_empty() && one.chars().all(|c| c.is_ascii_digit());
                starts && name.chars().all(word) && subscripts.split(',').all(counts)
            })
        };
        self.variables.iter().all(|(variable, _)| is_plain(&variable.name))
    }

    /// The place of a new variable.
    fn add(&mut self, variable: Variable, kind: ValueKind, place: Place, setter: Setter) -> usize {
        let at = self.variables.len();
        let name = variable.name.as_str().into();
        let variable = Variable { reference: at as u32, ..variable };
        self.variables.push((variable, Exported { name, kind, place, setter }));
        at
    }

    fn add_time(&mut self) {
        let time = Variable {
            name: "time".to_owned(),
            description: Some("Simulation time".to_owned()),
            causality: Causality::Independent,
            attributes: Attributes { unit: Some("s".to_owned()), ..Attributes::default() },
            ..Variable::default()
        };
        self.add(time, ValueKind::Real, Place::Time, Setter::None);
    }

    fn add_variable(
        &mut self,
        model: &Model,
        rows: &Rows,
        version: Version,
        at: usize,
    ) -> Result<(), Fault> {
        let info = &model.program.variables()[at];
        let name = &*info.name;
        if info.access == Access::Time || model.hidden.contains(name) {
            return Ok(());
        }
        let (state, derivative) = (rows.state(name), rows.derivative(name));
        let Some(kind) = value_kind(&info.base) else { return Ok(()) };
        // The derivatives of inputs are none of the model's.
        let is_of_input = derivative.is_some_and(|state| rows.is_input[state]);
        if is_of_input || info.protected && state.is_none() && derivative.is_none() {
            return Ok(());
        }
        let input = model.inputs.get(name).map(|input| rows.setter(model, name, input));
        let input = input.transpose()?;
        let (causality, variability, initial, setter, start) = match input {
            Some((setter, start)) => {
                let variability = variability_of(info, kind);
                (Causality::Input, variability, None, setter, Some(start))
            }
            None => part_of(model, info, kind),
        };
        let own = model.program.attributes(at);
        let mut attributes = attributes(model, info, kind, &own);
        attributes.nominal = rows.nominal_of(state).or(attributes.nominal);
        let variable = Variable {
            name: name.to_owned(),
            description: Some(info.description.to_string()).filter(|text| !text.is_empty()),
            kind: kind_of(kind, version),
            causality,
            variability,
            initial,
            declared_type: match &info.base {
                BaseType::Enumeration(definition) => Some(definition.name.to_string()),
                _ => None,
            },
            attributes,
            start: start.map(|value| written(value, kind)).into_iter().collect(),
            is_reinitialized: state.is_some_and(|state| rows.is_own(state)),
            ..Variable::default()
        };
        let place = match (state.filter(|state| rows.is_own(*state)), derivative) {
            (Some(state), _) => Place::State(state),
            (None, Some(state)) if rows.is_own(state) => Place::Derivative(state),
            _ => Place::Variable(at),
        };
        let found = self.add(variable, kind, place, setter);
        match setter {
            Setter::Input { state, .. } => self.inputs.push((state, found)),
            Setter::Recorded { .. } => self.has_recorded = true,
            _ => {}
        }
        Ok(())
    }

    /// The states in their order, and their derivatives, with new variables for those without.
    fn add_states(&mut self, model: &Model, rows: &Rows) {
        for state in (0..model.program.n_states()).filter(|state| rows.is_own(*state)) {
            let name = rows.names[state].clone();
            let find = |table: &Table, place: Place| {
                table.variables.iter().position(|(_, exported)| exported.place == place)
            };
            let added = |name: String| Variable {
                name,
                initial: Some(Initial::Calculated),
                ..Variable::default()
            };
            let at = find(self, Place::State(state)).unwrap_or_else(|| {
                let variable = Variable { is_reinitialized: true, ..added(name.clone()) };
                self.add(variable, ValueKind::Real, Place::State(state), Setter::None)
            });
            let slot = find(self, Place::Derivative(state)).unwrap_or_else(|| {
                let place = Place::Derivative(state);
                self.add(added(format!("der({name})")), ValueKind::Real, place, Setter::None)
            });
            self.variables[slot].0.derivative_of = Some(at);
            self.states.push(state);
            self.state_places.push(at);
            self.derivatives.push(slot);
        }
    }

    /// Strings, which are constants.
    fn add_strings(&mut self, model: &Model) {
        for (at, (name, text)) in model.strings.iter().enumerate() {
            let variable = Variable {
                name: name.clone(),
                description: text.description.clone(),
                kind: Kind::String,
                variability: Variability::Constant,
                initial: Some(Initial::Exact),
                start: vec![text.value.clone()],
                ..Variable::default()
            };
            self.add(variable, ValueKind::String, Place::Text(at), Setter::None);
        }
    }

    /// Event indicators; FMI 3.0 knows them as variables.
    fn add_indicators(&mut self, program: &Program, version: Version) {
        self.n_indicators = program.n_indicators();
        if version == Version::V2 {
            return;
        }
        for at in 0..self.n_indicators {
            let variable = Variable {
                name: format!("event_indicator[{}]", at + 1),
                is_internal: true,
                initial: Some(Initial::Calculated),
                ..Variable::default()
            };
            self.add(variable, ValueKind::Real, Place::Indicator(at), Setter::None);
        }
    }
}

/// What belongs to the states of a program.
struct Rows {
    names: Vec<String>,
    by_name: BTreeMap<String, usize>,
    /// Whether each is an input.
    is_input: Vec<bool>,
    /// Their nominal values, as integrators use them: those of the model, else the magnitudes of start values.
    nominal: Vec<f64>,
}

impl Rows {
    fn new(model: &Model) -> Result<Rows, Fault> {
        let program = model.program;
        let n = program.n_states();
        let names: Vec<String> =
            (0..n).filter_map(|at| Some(program.unknown_name(at)?.to_string())).collect();
        let by_name = names.iter().cloned().zip(0..).collect();
        let mut nominal = vec![1.0; n];
        program.system().nominal(&mut nominal);
        let mut rows = Rows { is_input: vec![false; n], names, by_name, nominal };
        for (name, input) in &model.inputs {
            if let Input::State { .. } = input {
                let (state, _) = rows.state_of_input(model, name)?;
                rows.is_input[state] = true;
            }
        }
        Ok(rows)
    }

    fn is_own(&self, state: usize) -> bool {
        !self.is_input[state]
    }

    /// The nominal value of a state of the model, if it is not 1, which holds where nothing is said.
    fn nominal_of(&self, state: Option<usize>) -> Option<f64> {
        let state = state.filter(|state| self.is_own(*state))?;
        Some(self.nominal[state]).filter(|nominal| *nominal != 1.0)
    }

    fn state(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    fn derivative(&self, name: &str) -> Option<usize> {
        self.state(name.strip_prefix("der(")?.strip_suffix(')')?)
    }

    /// The state that an input is, and whether with the opposite sign.
    fn state_of_input(&self, model: &Model, name: &str) -> Result<(usize, bool), Fault> {
        let program = model.program;
        let access = |name: &str| {
            let at = program.find_variable(name).ok()?;
            match program.variables()[at].access {
                Access::Observed { column, negated } => Some((column, negated)),
                _ => None,
            }
        };
        let own = access(name);
        let found = self.names.iter().enumerate().find_map(|(at, state)| {
            let ((column, negated), (of, sign)) = (own?, access(state)?);
            (column == of).then_some((at, negated != sign))
        });
        found.ok_or_else(|| {
            fault!(
                NOT_SUPPORTED,
                "`{}` cannot be exported: its states determine its input `{name}`",
                model.name
            )
        })
    }

    /// How an input is set, and its start value.
    fn setter(&self, model: &Model, name: &str, input: &Input) -> Result<(Setter, f64), Fault> {
        let program = model.program;
        let lost = || fault!(NOT_SUPPORTED, "the input `{name}` is not part of the equations");
        match input {
            Input::State { parameter, start: value } => {
                let (state, is_negated) = self.state_of_input(model, name)?;
                let start = program.find_parameter(parameter)?;
                Ok((Setter::Input { state, is_negated, start }, *value))
            }
            Input::Recorded(start) => {
                let input = program.recorded_input(name).ok_or_else(lost)?;
                Ok((Setter::Recorded { input, start: *start }, *start))
            }
        }
    }
}

type Part = (Causality, Variability, Option<Initial>, Setter, Option<f64>);

/// What a variable that is no input is: with its setter, and its start value.
fn part_of(model: &Model, info: &VariableInfo, kind: ValueKind) -> Part {
    let program = model.program;
    let parameter = |name: &str| program.parameters().iter().position(|own| *own.name == *name);
    let own = |name: &str| parameter(name).and_then(|at| Some((at, model.own_value(at)?)));
    match info.access {
        Access::Constant(value) => {
            let exact = Some(Initial::Exact);
            (Causality::Local, Variability::Constant, exact, Setter::None, Some(value))
        }
        Access::Parameter => match own(&info.name) {
            Some((at, value)) => {
                let (exact, setter) = (Some(Initial::Exact), Setter::Parameter(at));
                (Causality::Parameter, Variability::Fixed, exact, setter, Some(value))
            }
            None => {
                let part = Causality::CalculatedParameter;
                (part, Variability::Fixed, Some(Initial::Calculated), Setter::None, None)
            }
        },
        Access::Time | Access::Observed { .. } => {
            let causality = if info.is_output() { Causality::Output } else { Causality::Local };
            let variability = variability_of(info, kind);
            match model.starts.get(&*info.name).and_then(|name| own(name)) {
                Some((start, value)) => {
                    let (exact, setter) = (Some(Initial::Exact), Setter::Parameter(start));
                    (causality, variability, exact, setter, Some(value))
                }
                None => (causality, variability, Some(Initial::Calculated), Setter::None, None),
            }
        }
    }
}

fn variability_of(info: &VariableInfo, kind: ValueKind) -> Variability {
    let is_continuous =
        info.variability == flatten::Variability::Continuous && kind == ValueKind::Real;
    if is_continuous { Variability::Continuous } else { Variability::Discrete }
}

fn value_kind(base: &BaseType) -> Option<ValueKind> {
    match base {
        BaseType::Real => Some(ValueKind::Real),
        BaseType::Integer => Some(ValueKind::Integer),
        BaseType::Boolean => Some(ValueKind::Boolean),
        BaseType::Enumeration(_) => Some(ValueKind::Enumeration),
        BaseType::String | BaseType::ExternalObject(_) | BaseType::Clock => None,
    }
}

fn kind_of(kind: ValueKind, version: Version) -> Kind {
    match kind {
        ValueKind::Real => Kind::Float64,
        ValueKind::Integer if version == Version::V2 => Kind::Int32,
        ValueKind::Integer => Kind::Int64,
        ValueKind::Boolean => Kind::Boolean,
        ValueKind::Enumeration => Kind::Enumeration,
        ValueKind::String => Kind::String,
    }
}

/// A value as a description has it.
fn written(value: f64, kind: ValueKind) -> String {
    match kind {
        ValueKind::Real => format!("{value:?}"),
        ValueKind::Integer | ValueKind::Enumeration => format!("{value:.0}"),
        ValueKind::Boolean => (value != 0.0).to_string(),
        // Their strings are written as they are.
        ValueKind::String => String::new(),
    }
}

fn attributes(
    model: &Model,
    info: &VariableInfo,
    kind: ValueKind,
    own: &crate::codegen::Attributes,
) -> Attributes {
    let quantity = model.quantities.get(&*info.name).cloned();
    let filled = |text: &str| Some(text.to_owned()).filter(|text| !text.is_empty());
    match kind {
        ValueKind::Real => {
            let unit = filled(&info.unit);
            let shown = filled(info.display_unit());
            let is_known =
                |shown: &String| unit.as_ref().is_some_and(|unit| display(unit, shown).is_some());
            Attributes {
                quantity,
                display_unit: shown.filter(is_known),
                is_relative: info.is_relative.then_some(true).filter(|_| unit.is_some()),
                unit,
                min: own.min,
                max: own.max,
                nominal: own.nominal.map(f64::abs).filter(|nominal| *nominal > 0.0),
                ..Attributes::default()
            }
        }
        ValueKind::Integer => {
            Attributes { quantity, min: own.min, max: own.max, ..Attributes::default() }
        }
        ValueKind::Boolean | ValueKind::Enumeration | ValueKind::String => Attributes::default(),
    }
}

/// The enumerations of the variables.
pub(super) fn enumerations(program: &Program, table: &Table) -> Vec<TypeDefinition> {
    let mut known: BTreeMap<String, TypeDefinition> = BTreeMap::new();
    let named: Vec<&String> = table
        .variables
        .iter()
        .filter_map(|(variable, _)| variable.declared_type.as_ref())
        .collect();
    for info in program.variables() {
        let BaseType::Enumeration(definition) = &info.base else { continue };
        let name = definition.name.to_string();
        if !named.contains(&&name) {
            continue;
        }
        let items = definition.literals.iter().enumerate();
        let item = |(at, literal): (usize, &_)| Item {
            name: format!("{literal}"),
            value: at as i64 + 1,
            description: definition.descriptions.get(at).filter(|own| !own.is_empty()).cloned(),
        };
        known.entry(name.clone()).or_insert_with(|| TypeDefinition {
            name,
            kind: Kind::Enumeration,
            items: items.map(item).collect(),
            ..TypeDefinition::default()
        });
    }
    known.into_values().collect()
}
