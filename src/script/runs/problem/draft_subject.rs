//! What a draft knows of the model: a Modelica model, or a functional mock-up unit by its description.

use super::build;
use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::errors::BAD_FMU;
use crate::fault;
use crate::flatten::{Attribute, BaseType, FlatModel, Variability, Variable};
use crate::fmi::archive::is_unit;
use crate::fmi::description::{self, Causality, Description};
use crate::fmi::import::{Layout, Scalar, starts};
use crate::models::imported;
use crate::models::simulation::{self, Translated};
use crate::source::Span;
use crate::syntax::ast::{CausalityPrefix, Expression, ExpressionKind};
use std::path::Path;

/// What a draft is made from. Paths are written as they are given.
#[derive(Debug, Clone, Default)]
pub struct DraftOptions {
    /// The data file.
    pub data: String,
    /// The file or folder of the model, or the functional mock-up unit; empty for a class of a library.
    pub models: String,
    /// The class; empty for the only one of the file.
    pub class: String,
    /// The answer to the question that a draft without it leaves open.
    pub output: Option<String>,
}

/// The model of a draft.
pub(super) struct Subject {
    /// The class, or the path of the unit.
    pub name: String,
    pub is_unit: bool,
    /// Its variables.
    pub flat: FlatModel,
    pub states: Vec<String>,
    /// Real parameters at its top, or those of components where none is there.
    pub parameters: Vec<Estimable>,
}

/// A parameter that may be estimated.
pub(super) struct Estimable {
    pub name: String,
    pub unit: String,
    pub description: String,
    /// `-∞` without.
    pub min: f64,
    /// `∞` without.
    pub max: f64,
    /// Its value in the model; NaN if this is not known.
    pub default: f64,
    /// The table or polynomial of which it is an element, and its number of elements.
    pub table: Option<(String, usize)>,
    /// What the model computes it from.
    pub computed: Option<String>,
    /// Whether it is one of a component.
    pub is_inside: bool,
}

/// Those at the top, if there are any.
fn outermost(mut all: Vec<Estimable>) -> Vec<Estimable> {
    if all.iter().any(|own| !own.is_inside) {
        all.retain(|own| !own.is_inside);
    }
    all
}

impl Subject {
    /// The model that a draft is made for.
    ///
    /// # Errors
    /// A model that cannot be read or translated, a file with several classes of which none is named.
    pub(super) fn read(
        session: &mut Session,
        options: &DraftOptions,
    ) -> Result<Subject, Vec<Diagnostic>> {
        let one = |fault: Fault| vec![fault.at(Span::NONE)];
        let path = Path::new(&options.models);
        if is_unit(path) {
            let file = imported::read(session, path).map_err(one)?;
            imported::kind(&file, None).map_err(one)?;
            let layout = Layout::of(&file.description, &[]);
            let layout = layout.map_err(|why| one(fault!(BAD_FMU, "`{}`: {why}", file.name)))?;
            return Ok(of_unit(options.models.clone(), &file.description, &layout));
        }
        let loaded = match options.models.as_str() {
            "" => Vec::new(),
            models => session.load_path(Path::new(models))?,
        };
        let class = match options.class.as_str() {
            "" => build::only_class(&loaded).map_err(one)?,
            class => class.to_owned(),
        };
        // Its warnings come once more with the data, without those about inputs that have data then.
        let is_quiet = std::mem::replace(&mut session.options.quiet, true);
        let translated = simulation::translated(session, &class);
        session.options.quiet = is_quiet;
        let translated = translated?;
        let flat = simulation::flat_model_of(session, &translated)?.clone();
        Ok(Subject {
            name: class,
            is_unit: false,
            states: translated.state_names().map(ToString::to_string).collect(),
            parameters: parameters(&translated, &flat),
            flat,
        })
    }
}

/// The Real parameters of a model.
fn parameters(model: &Translated, flat: &FlatModel) -> Vec<Estimable> {
    let all = model.program.parameters().iter();
    let own = all.filter(|own| own.base == BaseType::Real);
    let all = own.map(|own| Estimable {
        name: own.name.to_string(),
        unit: own.unit.to_string(),
        description: own.description.to_string(),
        min: own.min,
        max: own.max,
        default: own.default,
        table: array_of(&own.name, |array| {
            model.declarations.get(array).map(|own| own.dims.clone())
        }),
        computed: computed(model, flat, &own.name),
        is_inside: !own.top_level,
    });
    outermost(all.collect())
}

/// The array of which a parameter is an element, and its number of elements, where these are a table
/// or a polynomial rather than quantities to be estimated one by one: matrices, and vectors of more
/// than a few.
fn array_of(
    element: &str,
    dims: impl FnOnce(&str) -> Option<Vec<usize>>,
) -> Option<(String, usize)> {
    /// Longer vectors are tables.
    const FEW: usize = 4;
    let (array, _) = element.strip_suffix(']')?.rsplit_once('[')?;
    let dims = dims(array)?;
    let elements = dims.iter().product();
    (dims.len() > 1 || elements > FEW).then(|| (array.to_owned(), elements))
}

/// What the model computes a parameter from; `None` where it depends on no other one.
fn computed(model: &Translated, flat: &FlatModel, name: &str) -> Option<String> {
    let declared =
        model.declarations.get(name).filter(|declared| !declared.computed_from.is_empty());
    let binding = declared.and_then(|_| flat.variables.get(name)?.binding.as_ref());
    binding.map(crate::syntax::print::expression)
}

fn of_unit(name: String, description: &Description, layout: &Layout) -> Subject {
    let own = |scalar: &Scalar| &description.variables[scalar.place.variable];
    let derivatives = description.structure.derivatives.iter();
    let states: Vec<usize> = derivatives
        .filter_map(|unknown| description.variables[unknown.variable].derivative_of)
        .collect();
    let all = layout.scalars();
    let is_state = |scalar: &&Scalar| states.contains(&scalar.place.variable);
    let flat = FlatModel {
        name: name.clone(),
        variables: all
            .iter()
            .map(|scalar| flat_variable(description, layout, scalar))
            .map(|variable| (variable.name.clone(), variable))
            .collect(),
        ..FlatModel::default()
    };
    let is_estimable = |scalar: &&Scalar| {
        own(scalar).causality == Causality::Parameter && own(scalar).kind.is_float()
    };
    let estimable = |scalar: &Scalar| estimable(description, layout, scalar);
    let parameters = all.iter().filter(is_estimable).map(estimable);
    Subject {
        name,
        is_unit: true,
        flat,
        states: all.iter().filter(is_state).map(|scalar| scalar.name.clone()).collect(),
        parameters: outermost(parameters.collect()),
    }
}

/// The value that a scalar starts with, if the description gives one.
fn start(description: &Description, layout: &Layout, scalar: &Scalar) -> Option<f64> {
    let variable = &description.variables[scalar.place.variable];
    let starts = starts(variable, layout.count(scalar.place.variable));
    starts.get(scalar.place.element).copied().filter(|_| !variable.start.is_empty())
}

fn estimable(description: &Description, layout: &Layout, scalar: &Scalar) -> Estimable {
    let variable = &description.variables[scalar.place.variable];
    let attributes = description.attributes_of(variable);
    Estimable {
        name: scalar.name.clone(),
        unit: attributes.unit.unwrap_or_default(),
        description: variable.description.clone().unwrap_or_default(),
        min: attributes.min.unwrap_or(f64::NEG_INFINITY),
        max: attributes.max.unwrap_or(f64::INFINITY),
        default: start(description, layout, scalar).unwrap_or(f64::NAN),
        table: array_of(&scalar.name, |_| description.sizes(variable, |_| None).ok()),
        computed: None,
        is_inside: scalar.name.contains('.'),
    }
}

/// A scalar of a unit as a variable of Modelica.
fn flat_variable(description: &Description, layout: &Layout, scalar: &Scalar) -> Variable {
    let own = &description.variables[scalar.place.variable];
    let attribute = |kind| Attribute { value: Expression::new(kind, Span::NONE), is_final: false };
    let unit = description.attributes_of(own).unit;
    let unit = unit.map(|unit| ("unit", attribute(ExpressionKind::String(unit.into()))));
    let start = start(description, layout, scalar);
    let start = start.map(|start| ("start", attribute(ExpressionKind::Real(start))));
    Variable {
        name: scalar.name.as_str().into(),
        base: if own.kind.is_float() { BaseType::Real } else { BaseType::Integer },
        dims: Vec::new(),
        variability: match own.variability {
            description::Variability::Constant => Variability::Constant,
            description::Variability::Fixed | description::Variability::Tunable => {
                Variability::Parameter
            }
            description::Variability::Discrete => Variability::Discrete,
            description::Variability::Continuous => Variability::Continuous,
        },
        causality: match own.causality {
            Causality::Input => Some(CausalityPrefix::Input),
            Causality::Output => Some(CausalityPrefix::Output),
            _ => None,
        },
        is_input: own.causality == Causality::Input,
        is_final: false,
        protected: false,
        evaluate: false,
        is_relative: description.attributes_of(own).is_relative.unwrap_or(false),
        structural: own.causality == Causality::StructuralParameter,
        top_level: !scalar.name.contains('.'),
        attributes: unit.into_iter().chain(start).collect(),
        binding: None,
        description: own.description.as_deref().map(Into::into),
        span: Span::NONE,
    }
}
