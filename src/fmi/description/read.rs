//! Reads descriptions, which have first to agree with the schema and then with the rules of the standard.
//! Annotations are passed over.

use super::rules;
use super::schema::Schema;
use super::{
    About, Attributes, BASE_UNITS, BaseUnit, Causality, ClockInterval, DefaultExperiment,
    DependencyKind, Description, Dimension, DisplayUnit, INTERNAL, Initial, Interface, Item, Kind,
    LogCategory, Structure, TypeDefinition, Unit, Unknown, Variability, Variable, VariableAlias,
    Version,
};
use crate::FmuError;
use crate::xml::{Element, decoded};
use roxmltree::Document;
use std::collections::HashMap;

/// The description in a text.
///
/// # Errors
/// It is not well-formed, is of another version than FMI 2.0 or 3.0, or contradicts the standard: with the
/// line.
pub fn read(text: impl AsRef<[u8]>) -> Result<Description, FmuError> {
    let text = decoded(text.as_ref())?;
    let document = Document::parse(&text).map_err(|error| FmuError::Xml(error.to_string()))?;
    let root = Element(document.root_element());
    if root.name() != "fmiModelDescription" {
        return Err(root.error(format!("the root is `{}`, not `fmiModelDescription`", root.name())));
    }
    let written = root.required("fmiVersion")?;
    let version = Version::of_word(written).ok_or_else(|| {
        root.error(format!("it is of FMI {written}; units of FMI 2.0 and 3.0 can be read"))
    })?;
    Schema::of(version, written).check(&root)?;
    let mut description = head(&root, version)?;
    let variables = root.child("ModelVariables").map_or(Vec::new(), |all| all.children());
    for element in &variables {
        description.variables.push(variable(element, version)?);
    }
    let places = Places::new(&description, version);
    for (at, element) in variables.iter().enumerate() {
        let element = typed(element, version)?;
        if let Some(number) = element.parsed::<u32>("derivative")? {
            description.variables[at].derivative_of = Some(places.get(&element, number)?);
        }
    }
    if let Some(element) = root.child("ModelStructure") {
        description.structure = structure(&element, version, &places)?;
    }
    rules::check(&description, &root, &variables)?;
    Ok(description)
}

/// Everything but variables and structure.
fn head(root: &Element, version: Version) -> Result<Description, FmuError> {
    let text = |name: &str| root.text(name);
    let token = if version == Version::V2 { "guid" } else { "instantiationToken" };
    let interface = |name: &str| root.child(name).map(|one| interface(&one, version)).transpose();
    let unit_definitions = root.elements("UnitDefinitions", "Unit");
    let types = match version {
        Version::V2 => root.elements("TypeDefinitions", "SimpleType"),
        Version::V3 => root.child("TypeDefinitions").map_or(Vec::new(), |all| all.children()),
    };
    let category = |one: &Element| {
        let description = one.text("description");
        Ok(LogCategory { name: one.required("name")?.to_owned(), description })
    };
    Ok(Description {
        version,
        model_name: root.required("modelName")?.to_owned(),
        token: root.required(token)?.to_owned(),
        about: About {
            description: text("description"),
            author: text("author"),
            model_version: text("version"),
            copyright: text("copyright"),
            license: text("license"),
            generation_tool: text("generationTool"),
            generation_time: text("generationDateAndTime"),
        },
        has_structured_names: root.get("variableNamingConvention") == Some("structured"),
        model_exchange: interface("ModelExchange")?,
        co_simulation: interface("CoSimulation")?,
        scheduled_execution: interface("ScheduledExecution")?,
        units: unit_definitions.iter().map(unit).collect::<Result<_, _>>()?,
        types: types
            .iter()
            .filter_map(|one| type_definition(one, version).transpose())
            .collect::<Result<_, _>>()?,
        log_categories: root
            .elements("LogCategories", "Category")
            .iter()
            .map(category)
            .collect::<Result<_, _>>()?,
        experiment: root
            .child("DefaultExperiment")
            .map_or(Ok(DefaultExperiment::default()), |one| experiment(&one))?,
        event_indicators: root.parsed("numberOfEventIndicators")?.unwrap_or(0),
        ..Description::default()
    })
}

fn experiment(element: &Element) -> Result<DefaultExperiment, FmuError> {
    Ok(DefaultExperiment {
        start: element.parsed("startTime")?,
        stop: element.parsed("stopTime")?,
        tolerance: element.parsed("tolerance")?,
        step: element.parsed("stepSize")?,
    })
}

/// What a unit is able to. The attributes of both versions differ in name only.
fn interface(element: &Element, version: Version) -> Result<Interface, FmuError> {
    let any = |names: &[&str]| {
        names.iter().try_fold(false, |found, name| Ok(found | element.is_true(name)?))
    };
    let files = element.elements("SourceFiles", "File");
    let needs_completed_step = element.name() == "ModelExchange"
        && match version {
            Version::V2 => !element.is_true("completedIntegratorStepNotNeeded")?,
            Version::V3 => element.is_true("needsCompletedIntegratorStep")?,
        };
    Ok(Interface {
        model_identifier: element.required("modelIdentifier")?.to_owned(),
        needs_execution_tool: element.is_true("needsExecutionTool")?,
        is_single_instance: element.is_true("canBeInstantiatedOnlyOncePerProcess")?,
        can_get_and_set_state: any(&["canGetAndSetFMUstate", "canGetAndSetFMUState"])?,
        can_serialize_state: any(&["canSerializeFMUstate", "canSerializeFMUState"])?,
        provides_directional_derivatives: any(&[
            "providesDirectionalDerivative",
            "providesDirectionalDerivatives",
        ])?,
        provides_adjoint_derivatives: element.is_true("providesAdjointDerivatives")?,
        needs_completed_step,
        provides_evaluate_discrete_states: element.is_true("providesEvaluateDiscreteStates")?,
        can_handle_variable_steps: element.is_true("canHandleVariableCommunicationStepSize")?,
        fixed_internal_step: element.parsed("fixedInternalStepSize")?,
        max_output_derivative_order: element.parsed("maxOutputDerivativeOrder")?.unwrap_or(0),
        can_interpolate_inputs: element.is_true("canInterpolateInputs")?,
        provides_intermediate_update: element.is_true("providesIntermediateUpdate")?,
        might_return_early: element.is_true("mightReturnEarlyFromDoStep")?,
        can_return_early: element.is_true("canReturnEarlyAfterIntermediateUpdate")?,
        has_event_mode: element.is_true("hasEventMode")?,
        source_files: files
            .iter()
            .map(|file| Ok(file.required("name")?.to_owned()))
            .collect::<Result<_, FmuError>>()?,
    })
}

/// A unit, as FMI and SSP write it.
pub(crate) fn unit(element: &Element) -> Result<Unit, FmuError> {
    let display = |one: &Element| {
        Ok(DisplayUnit {
            name: one.required("name")?.to_owned(),
            factor: one.parsed("factor")?.unwrap_or(1.0),
            offset: one.parsed("offset")?.unwrap_or(0.0),
            is_inverse: one.is_true("inverse")?,
        })
    };
    let base = |one: Element| {
        let mut exponents = [0; 8];
        for (exponent, name) in exponents.iter_mut().zip(BASE_UNITS) {
            *exponent = one.parsed(name)?.unwrap_or(0);
        }
        let factor = one.parsed("factor")?.unwrap_or(1.0);
        Ok(BaseUnit { exponents, factor, offset: one.parsed("offset")?.unwrap_or(0.0) })
    };
    let shown = element.children();
    let shown = shown.iter().filter(|one| one.name() == "DisplayUnit");
    Ok(Unit {
        name: element.required("name")?.to_owned(),
        base: element.child("BaseUnit").map(base).transpose()?,
        display_units: shown.map(display).collect::<Result<_, FmuError>>()?,
    })
}

/// A type; `None` for what is not a type.
fn type_definition(
    element: &Element,
    version: Version,
) -> Result<Option<TypeDefinition>, FmuError> {
    let typed = typed(element, version)?;
    let kind = match version {
        Version::V2 => Kind::of_word_2(typed.name()),
        Version::V3 => typed.name().strip_suffix("Type").and_then(Kind::of_word),
    };
    let Some(kind) = kind else { return Ok(None) };
    let item = |one: &Element| {
        Ok(Item {
            name: one.required("name")?.to_owned(),
            value: one.parsed("value")?.unwrap_or(0),
            description: one.text("description"),
        })
    };
    let items = typed.children();
    let items = items.iter().filter(|one| one.name() == "Item");
    Ok(Some(TypeDefinition {
        name: element.required("name")?.to_owned(),
        kind,
        description: element.text("description"),
        attributes: attributes(&typed)?,
        items: items.map(item).collect::<Result<_, FmuError>>()?,
    }))
}

/// The element that names the predefined type: in FMI 2.0 it is inside.
fn typed<'a, 'i>(element: &Element<'a, 'i>, version: Version) -> Result<Element<'a, 'i>, FmuError> {
    if version == Version::V3 {
        return Ok(*element);
    }
    let mut inside = element.children().into_iter();
    inside
        .find(|one| Kind::of_word_2(one.name()).is_some())
        .ok_or_else(|| element.error(format!("`{}` has no type", element.name())))
}

fn attributes(element: &Element) -> Result<Attributes, FmuError> {
    Ok(Attributes {
        quantity: element.text("quantity"),
        unit: element.text("unit"),
        display_unit: element.text("displayUnit"),
        is_relative: element.truth("relativeQuantity")?,
        is_unbounded: element.truth("unbounded")?,
        min: element.parsed("min")?,
        max: element.parsed("max")?,
        nominal: element.parsed("nominal")?,
    })
}

fn variable(element: &Element, version: Version) -> Result<Variable, FmuError> {
    let typed = typed(element, version)?;
    let kind = match version {
        Version::V2 => Kind::of_word_2(typed.name()),
        Version::V3 => Kind::of_word(typed.name()),
    };
    let kind =
        kind.ok_or_else(|| typed.error(format!("`{}` is not a type of variables", typed.name())))?;
    let causality = element.word("causality", Causality::of_word)?.unwrap_or_default();
    let variability = element
        .word("variability", Variability::of_word)?
        .unwrap_or_else(|| default_variability(causality, kind));
    let initial = element.word("initial", Initial::of_word)?;
    let alias = |one: &Element| {
        Ok(VariableAlias {
            name: one.required("name")?.to_owned(),
            description: one.text("description"),
            display_unit: one.text("displayUnit"),
        })
    };
    let children = typed.children();
    let named = |name: &'static str| children.iter().filter(move |one| one.name() == name);
    Ok(Variable {
        name: element.required("name")?.to_owned(),
        reference: element.needed("valueReference")?,
        description: element.text("description"),
        kind,
        causality,
        variability,
        initial: initial.or_else(|| default_initial(causality, variability)),
        declared_type: typed.text("declaredType"),
        dimensions: named("Dimension").map(dimension).collect::<Result<_, _>>()?,
        attributes: attributes(&typed)?,
        start: start(&typed, kind)?,
        derivative_of: None,
        is_reinitialized: typed.is_true("reinit")?,
        can_be_set_repeatedly: element.truth("canHandleMultipleSetPerTimeInstant")?,
        has_intermediate_update: element.is_true("intermediateUpdate")?,
        previous: element.parsed("previous")?,
        clocks: element.list("clocks")?.unwrap_or_default(),
        aliases: named("Alias").map(alias).collect::<Result<_, FmuError>>()?,
        clock: (kind == Kind::Clock).then(|| clock(element)).transpose()?,
        is_internal: element
            .elements("Annotations", "Annotation")
            .iter()
            .any(|own| own.get("type") == Some(INTERNAL)),
    })
}

fn default_variability(causality: Causality, kind: Kind) -> Variability {
    match causality {
        Causality::Parameter | Causality::CalculatedParameter | Causality::StructuralParameter => {
            Variability::Fixed
        }
        _ if kind.is_float() => Variability::Continuous,
        _ => Variability::Discrete,
    }
}

/// What the standard says where nothing is said; `None` for inputs and time.
fn default_initial(causality: Causality, variability: Variability) -> Option<Initial> {
    match causality {
        Causality::Parameter | Causality::StructuralParameter => Some(Initial::Exact),
        Causality::Input | Causality::Independent => None,
        _ if variability == Variability::Constant => Some(Initial::Exact),
        _ => Some(Initial::Calculated),
    }
}

fn dimension(element: &Element) -> Result<Dimension, FmuError> {
    match (element.parsed("start")?, element.parsed("valueReference")?) {
        (Some(size), None) => Ok(Dimension::Fixed(size)),
        (None, Some(reference)) => Ok(Dimension::Variable(reference)),
        _ => Err(element.error(
            "`Dimension` must have one of the attributes `start` and `valueReference`".into(),
        )),
    }
}

/// Start values as they are written; those of Strings in FMI 3.0 are elements.
fn start(element: &Element, kind: Kind) -> Result<Vec<String>, FmuError> {
    let inside = element.children();
    let inside: Vec<_> = inside.iter().filter(|one| one.name() == "Start").collect();
    if !inside.is_empty() {
        return inside.iter().map(|one| Ok(one.required("value")?.to_owned())).collect();
    }
    Ok(match element.get("start") {
        Some(text) if matches!(kind, Kind::String | Kind::Binary) => vec![text.to_owned()],
        Some(text) => text.split_whitespace().map(str::to_owned).collect(),
        None => Vec::new(),
    })
}

fn clock(element: &Element) -> Result<ClockInterval, FmuError> {
    Ok(ClockInterval {
        variability: element.required("intervalVariability")?.to_owned(),
        decimal: element.parsed("intervalDecimal")?,
        shift: element.parsed("shiftDecimal")?,
        resolution: element.parsed("resolution")?,
        counter: element.parsed("intervalCounter")?,
        shift_counter: element.parsed("shiftCounter")?,
        supports_fraction: element.is_true("supportsFraction")?,
        priority: element.parsed("priority")?,
        can_be_deactivated: element.is_true("canBeDeactivated")?,
    })
}

fn structure(element: &Element, version: Version, places: &Places) -> Result<Structure, FmuError> {
    let all = |group: &str, name: &str| {
        let found = rules::unknowns_of(element, version, (group, name));
        found.iter().map(|one| unknown(one, version, places)).collect::<Result<Vec<_>, _>>()
    };
    Ok(Structure {
        outputs: all("Outputs", "Output")?,
        derivatives: all("Derivatives", "ContinuousStateDerivative")?,
        clocked_states: all("", "ClockedState")?,
        initial_unknowns: all("InitialUnknowns", "InitialUnknown")?,
        event_indicators: all("", "EventIndicator")?,
    })
}

fn unknown(element: &Element, version: Version, places: &Places) -> Result<Unknown, FmuError> {
    let own = if version == Version::V2 { "index" } else { "valueReference" };
    let variable = places.get(element, element.needed(own)?)?;
    let Some(on) = element.list::<u32>("dependencies")? else {
        if element.get("dependenciesKind").is_some() {
            return Err(element.error("`dependenciesKind` needs `dependencies` beside it".into()));
        }
        return Ok(Unknown { variable, dependencies: None });
    };
    let kinds = element.get("dependenciesKind").map(|kinds| {
        let word = |word| {
            DependencyKind::of_word(word)
                .ok_or_else(|| element.error(format!("`{word}` is no kind of dependence")))
        };
        kinds.split_whitespace().map(word).collect::<Result<Vec<_>, _>>()
    });
    let kinds = kinds.transpose()?.unwrap_or_else(|| vec![DependencyKind::Dependent; on.len()]);
    if kinds.len() != on.len() {
        return Err(element.error("`dependencies` and `dependenciesKind` differ in number".into()));
    }
    let on = on.into_iter().map(|number| places.get(element, number));
    let on = on.collect::<Result<Vec<_>, _>>()?;
    Ok(Unknown { variable, dependencies: Some(on.into_iter().zip(kinds).collect()) })
}

/// Finds variables by what others refer to them.
struct Places {
    /// Value references; `None` where numbers count variables from 1.
    by_reference: Option<HashMap<u32, usize>>,
    n: usize,
}

impl Places {
    fn new(description: &Description, version: Version) -> Places {
        let variables = &description.variables;
        let numbered = variables.iter().enumerate().map(|(at, one)| (one.reference, at));
        let by_reference = (version == Version::V3).then(|| numbered.collect());
        Places { by_reference, n: variables.len() }
    }

    fn get(&self, element: &Element, number: u32) -> Result<usize, FmuError> {
        let found = match &self.by_reference {
            Some(known) => known.get(&number).copied(),
            None => (number as usize).checked_sub(1).filter(|at| *at < self.n),
        };
        found.ok_or_else(|| element.error(format!("there is no variable {number}")))
    }
}
