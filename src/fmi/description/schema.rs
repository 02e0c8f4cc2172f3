//! The schemas of the standard: which elements and attributes there are, which of them must be there,
//! and of what type values are (`fmi2ModelDescription.xsd` of FMI 2.0.5, `fmi3ModelDescription.xsd` of
//! FMI 3.0.2). The order of elements is not checked, and annotations hold what they like.

use super::Version;
use super::words::{DependencyKind, Kind};
use crate::FmuError;
use crate::diag::suggest;
use crate::xml::Element;
use roxmltree::Node;

/// An element: its names, its attributes, and what is in it.
///
/// An attribute is `name`, or `name:type` if its values have a type; with `!` before the colon or at the
/// end it must be there. Types are `real`, `bool`, `int`, `uint`, `ulong`, `uints` (a list), `own` (a value of
/// the type that the element names), `owns` (a list), `kinds` (of dependences), else words between `|`.
///
/// Elements in it are `name`, or `name|name` for one of several: at most one, `!` exactly one, `*` any number,
/// `+` at least one.
struct Rule(&'static str, &'static [&'static str], &'static str);

const ROOT: &str = "fmiVersion! modelName! description author version copyright license generationTool \
                    generationDateAndTime variableNamingConvention:flat|structured";
const VARIABILITY: &str = "variability:constant|fixed|tunable|discrete|continuous";
const INITIAL: &str = "initial:exact|approx|calculated";
const NAMED: &str = "name! description";
const REAL: &str = "quantity unit displayUnit relativeQuantity:bool unbounded:bool nominal:real";
const RANGE: &str = "min:own max:own";
const DEPENDENCIES: &str = "dependencies:uints dependenciesKind:kinds";
const EXPERIMENT: Rule =
    Rule("DefaultExperiment", &["startTime:real stopTime:real tolerance:real stepSize:real"], "");
const BASE_UNIT: Rule = Rule(
    "BaseUnit",
    &["kg:int m:int s:int A:int K:int mol:int cd:int rad:int factor:real offset:real"],
    "",
);
const UNIT: Rule = Rule("Unit", &["name!"], "BaseUnit DisplayUnit*");
const UNITS: Rule = Rule("UnitDefinitions", &[], "Unit+");
const CATEGORIES: Rule = Rule("LogCategories", &[], "Category+");
const CATEGORY: Rule = Rule("Category", &[NAMED], "");
const ITEM: Rule = Rule("Item", &[NAMED, "value!:own"], "");

const INTERFACE_2: &str = "modelIdentifier! needsExecutionTool:bool canBeInstantiatedOnlyOncePerProcess:bool \
                           canNotUseMemoryManagementFunctions:bool canGetAndSetFMUstate:bool \
                           canSerializeFMUstate:bool providesDirectionalDerivative:bool";
const V2: &[Rule] = &[
    Rule(
        "fmiModelDescription",
        &[ROOT, "guid! numberOfEventIndicators:uint"],
        "ModelExchange CoSimulation UnitDefinitions TypeDefinitions LogCategories DefaultExperiment \
         ModelVariables! ModelStructure!",
    ),
    Rule("ModelExchange", &[INTERFACE_2, "completedIntegratorStepNotNeeded:bool"], "SourceFiles"),
    Rule(
        "CoSimulation",
        &[
            INTERFACE_2,
            "canHandleVariableCommunicationStepSize:bool canInterpolateInputs:bool \
             maxOutputDerivativeOrder:uint canRunAsynchronuously:bool",
        ],
        "SourceFiles",
    ),
    Rule("SourceFiles", &[], "File+"),
    Rule("File", &["name!"], ""),
    UNITS,
    UNIT,
    BASE_UNIT,
    Rule("DisplayUnit", &["name! factor:real offset:real"], ""),
    Rule("TypeDefinitions", &[], "SimpleType+"),
    Rule("SimpleType", &[NAMED], "Real|Integer|Boolean|String|Enumeration!"),
    CATEGORIES,
    CATEGORY,
    EXPERIMENT,
    Rule("ModelVariables", &[], "ScalarVariable+"),
    Rule(
        "ScalarVariable",
        &[
            NAMED,
            "valueReference!:uint canHandleMultipleSetPerTimeInstant:bool \
             causality:parameter|calculatedParameter|input|output|local|independent",
            VARIABILITY,
            INITIAL,
        ],
        "Real|Integer|Boolean|String|Enumeration!",
    ),
    Rule("Real", &["declaredType start:own derivative:uint reinit:bool", REAL, RANGE], ""),
    Rule("Integer", &["declaredType start:own quantity", RANGE], ""),
    Rule("Boolean|String", &["declaredType start:own"], ""),
    Rule("Enumeration", &["declaredType start:own quantity", RANGE], "Item*"),
    ITEM,
    Rule("ModelStructure", &[], "Outputs Derivatives InitialUnknowns"),
    Rule("Outputs|Derivatives|InitialUnknowns", &[], "Unknown+"),
    Rule("Unknown", &["index!:uint", DEPENDENCIES], ""),
];

const INTERFACE_3: &str = "modelIdentifier! needsExecutionTool:bool canBeInstantiatedOnlyOncePerProcess:bool \
                           canGetAndSetFMUState:bool canSerializeFMUState:bool \
                           providesDirectionalDerivatives:bool providesAdjointDerivatives:bool \
                           providesPerElementDependencies:bool";
const CLOCK: &str = "canBeDeactivated:bool priority:uint intervalDecimal:real shiftDecimal:real \
                     supportsFraction:bool resolution:ulong intervalCounter:ulong shiftCounter:ulong \
                     intervalVariability!:constant|fixed|tunable|changing|countdown|triggered";
const VARIABLE_3: &str = "name! valueReference!:uint description canHandleMultipleSetPerTimeInstant:bool \
                          clocks:uints declaredType \
                          causality:parameter|calculatedParameter|input|output|local|independent\
                          |structuralParameter";
const ARRAYABLE: &str = "intermediateUpdate:bool previous:uint";
const STARTS: &str = "start:owns";
const BINARY: &str = "mimeType maxSize:ulong";
const INTEGER: &str = "quantity";
const V3: &[Rule] = &[
    Rule(
        "fmiModelDescription",
        &[ROOT, "instantiationToken!"],
        "ModelExchange CoSimulation ScheduledExecution UnitDefinitions TypeDefinitions LogCategories \
         DefaultExperiment ModelVariables! ModelStructure!",
    ),
    Rule(
        "ModelExchange",
        &[INTERFACE_3, "needsCompletedIntegratorStep:bool providesEvaluateDiscreteStates:bool"],
        "",
    ),
    Rule(
        "CoSimulation",
        &[
            INTERFACE_3,
            "canHandleVariableCommunicationStepSize:bool fixedInternalStepSize:real \
             maxOutputDerivativeOrder:uint recommendedIntermediateInputSmoothness:int \
             providesIntermediateUpdate:bool mightReturnEarlyFromDoStep:bool \
             canReturnEarlyAfterIntermediateUpdate:bool hasEventMode:bool \
             providesEvaluateDiscreteStates:bool",
        ],
        "",
    ),
    Rule("ScheduledExecution", &[INTERFACE_3], ""),
    UNITS,
    UNIT,
    BASE_UNIT,
    Rule("DisplayUnit", &["name! factor:real offset:real inverse:bool"], ""),
    Rule(
        "TypeDefinitions",
        &[],
        "Float32Type|Float64Type|Int8Type|UInt8Type|Int16Type|UInt16Type|Int32Type|UInt32Type|Int64Type|\
         UInt64Type|BooleanType|StringType|BinaryType|EnumerationType|ClockType+",
    ),
    Rule("Float32Type|Float64Type", &[NAMED, REAL, RANGE], ""),
    Rule(
        "Int8Type|UInt8Type|Int16Type|UInt16Type|Int32Type|UInt32Type|Int64Type|UInt64Type",
        &[NAMED, INTEGER, RANGE],
        "",
    ),
    Rule("BooleanType|StringType", &[NAMED], ""),
    Rule("BinaryType", &[NAMED, BINARY], ""),
    Rule("EnumerationType", &[NAMED, INTEGER, RANGE], "Item+"),
    ITEM,
    Rule("ClockType", &[NAMED, CLOCK], ""),
    CATEGORIES,
    CATEGORY,
    EXPERIMENT,
    Rule(
        "ModelVariables",
        &[],
        "Float32|Float64|Int8|UInt8|Int16|UInt16|Int32|UInt32|Int64|UInt64|Boolean|String|Binary|\
         Enumeration|Clock+",
    ),
    Rule(
        "Float32|Float64",
        &[
            VARIABLE_3,
            VARIABILITY,
            INITIAL,
            ARRAYABLE,
            STARTS,
            REAL,
            RANGE,
            "derivative:uint reinit:bool",
        ],
        "Dimension* Alias*",
    ),
    Rule(
        "Int8|UInt8|Int16|UInt16|Int32|UInt32|Int64|UInt64|Enumeration",
        &[VARIABLE_3, VARIABILITY, INITIAL, ARRAYABLE, STARTS, INTEGER, RANGE],
        "Dimension* Alias*",
    ),
    Rule("Boolean", &[VARIABLE_3, VARIABILITY, INITIAL, ARRAYABLE, STARTS], "Dimension* Alias*"),
    Rule("String", &[VARIABLE_3, VARIABILITY, INITIAL, ARRAYABLE], "Dimension* Start* Alias*"),
    Rule(
        "Binary",
        &[VARIABLE_3, VARIABILITY, INITIAL, ARRAYABLE, BINARY],
        "Dimension* Start* Alias*",
    ),
    Rule("Clock", &[VARIABLE_3, VARIABILITY, CLOCK], "Alias*"),
    Rule("Dimension", &["start:ulong valueReference:uint"], ""),
    Rule("Start", &["value!:own"], ""),
    Rule("Alias", &["name! description displayUnit"], ""),
    Rule(
        "ModelStructure",
        &[],
        "Output* ContinuousStateDerivative* ClockedState* InitialUnknown* EventIndicator*",
    ),
    Rule(
        "Output|ContinuousStateDerivative|ClockedState|InitialUnknown|EventIndicator",
        &["valueReference!:uint", DEPENDENCIES],
        "",
    ),
];

/// What a description is checked against.
pub(super) struct Schema {
    rules: &'static [Rule],
    version: Version,
    /// Whether it is the whole schema: later minor versions may add to it (FMI 3.0.2 §2.6).
    is_complete: bool,
}

impl Schema {
    /// The schema of a version, as it is written.
    pub(super) fn of(version: Version, written: &str) -> Schema {
        let rules = if version == Version::V2 { V2 } else { V3 };
        Schema { rules, version, is_complete: written.split('.').nth(1) == Some("0") }
    }

    /// Checks an element and all in it.
    ///
    /// # Errors
    /// The first one that contradicts the schema, with its line.
    pub(super) fn check(&self, element: &Element) -> Result<(), FmuError> {
        let is_of = |rule: &&Rule| rule.0.split('|').any(|name| name == element.name());
        let Some(Rule(_, attributes, children)) = self.rules.iter().find(is_of) else {
            return Ok(());
        };
        let attributes = attributes.iter().flat_map(|group| group.split(' ').map(Attribute::of));
        self.check_attributes(element, &attributes.collect::<Vec<_>>())?;
        let groups: Vec<Group> = children.split_whitespace().map(Group).collect();
        self.check_children(element, &groups)
    }

    fn check_attributes(&self, element: &Element, all: &[Attribute]) -> Result<(), FmuError> {
        for own in element.0.attributes().filter(|own| own.namespace().is_none()) {
            match all.iter().find(|known| known.name == own.name()) {
                Some(known) => self.check_value(element, known, own.value())?,
                None if self.is_complete => {
                    let guess = suggest::did_you_mean(own.name(), all.iter().map(|own| own.name));
                    let of = (element.name(), "attribute");
                    return Err(self.unknown(element, of, own.name(), guess));
                }
                None => {}
            }
        }
        let mut required = all.iter().filter(|known| known.is_required);
        required.try_for_each(|known| element.required(known.name).map(|_| ()))
    }

    fn check_value(&self, of: &Element, known: &Attribute, value: &str) -> Result<(), FmuError> {
        let text = value.trim();
        let all = |is: fn(&str) -> bool| text.split_whitespace().all(is);
        let own = || kind_of(of, self.version);
        let (is_right, expected) = match known.values {
            "" => (true, ""),
            "real" => (Kind::Float64.holds(text), Kind::Float64.in_words()),
            "bool" => (Kind::Boolean.holds(text), Kind::Boolean.in_words()),
            "int" => (Kind::Int32.holds(text), Kind::Int32.in_words()),
            "uint" => (Kind::UInt32.holds(text), Kind::UInt32.in_words()),
            "ulong" => (Kind::UInt64.holds(text), Kind::UInt64.in_words()),
            "uints" => (all(|one| Kind::UInt32.holds(one)), "value references with blanks between"),
            "own" => (own().holds(text), own().in_words()),
            "owns" => (text.split_whitespace().all(|one| own().holds(one)), own().in_words()),
            "kinds" => (
                all(|one| DependencyKind::of_word(one).is_some()),
                "a list of dependent, constant, fixed, tunable, discrete",
            ),
            words => (words.split('|').any(|word| word == value), ""),
        };
        if is_right {
            return Ok(());
        }
        let expected = match expected {
            "" => format!("one of {}", known.values.replace('|', ", ")),
            expected => expected.to_owned(),
        };
        let name = owner(*of).map_or(String::new(), |name| format!(" of `{name}`"));
        let attribute = known.name;
        Err(of.error(format!(
            "`{value}` is not a value of the attribute `{attribute}`{name}, which must be {expected}"
        )))
    }

    fn check_children(&self, element: &Element, groups: &[Group]) -> Result<(), FmuError> {
        let mut counts = vec![0; groups.len()];
        for child in element.children() {
            let name = child.name();
            if name == "Annotations" || name == "VendorAnnotations" {
                continue;
            }
            match groups.iter().position(|group| group.names().any(|known| known == name)) {
                Some(at) => counts[at] += 1,
                None if self.is_complete => {
                    let known = groups.iter().flat_map(|group| group.names());
                    let guess = suggest::did_you_mean(name, known);
                    return Err(self.unknown(&child, (element.name(), "element"), name, guess));
                }
                None => {}
            }
            self.check(&child)?;
        }
        for (group, count) in groups.iter().zip(counts) {
            let (least, most) = group.bounds();
            if !(least..=most).contains(&count) {
                let name = element.name();
                let names = group.names().collect::<Vec<_>>().join("`, `");
                let count = if count == 0 { "no".to_owned() } else { format!("{count} times") };
                return Err(element.error(format!("`{name}` has {count} `{names}` in it")));
            }
        }
        Ok(())
    }

    fn unknown(
        &self,
        at: &Element,
        (of, what): (&str, &str),
        name: &str,
        guess: Option<String>,
    ) -> FmuError {
        let version = if self.version == Version::V2 { "2.0" } else { "3.0" };
        let guess = guess.map_or(String::new(), |guess| format!("; {guess}"));
        at.error(format!("`{of}` has no {what} `{name}` in FMI {version}{guess}"))
    }
}

/// An attribute of a [`Rule`].
struct Attribute {
    name: &'static str,
    is_required: bool,
    values: &'static str,
}

impl Attribute {
    fn of(written: &'static str) -> Attribute {
        let (name, values) = written.split_once(':').unwrap_or((written, ""));
        let required = name.strip_suffix('!');
        Attribute { name: required.unwrap_or(name), is_required: required.is_some(), values }
    }
}

/// Elements in another one, of a [`Rule`].
struct Group(&'static str);

impl Group {
    fn names(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.0.trim_end_matches(['!', '*', '+']).split('|')
    }

    fn bounds(&self) -> (usize, usize) {
        match self.0.chars().next_back() {
            Some('!') => (1, 1),
            Some('+') => (1, usize::MAX),
            Some('*') => (0, usize::MAX),
            _ => (0, 1),
        }
    }
}

/// The type of the values that an element speaks of.
fn kind_of(element: &Element, version: Version) -> Kind {
    let name = element.name();
    match (version, name) {
        (Version::V2, "Enumeration" | "Item") => Kind::Int32,
        (Version::V2, _) => Kind::of_word_2(name).unwrap_or_default(),
        (Version::V3, "Item") => Kind::Enumeration,
        (Version::V3, "Start") => {
            let of = element.0.parent().map(Element);
            of.map_or(Kind::String, |of| kind_of(&of, version))
        }
        (Version::V3, _) => {
            Kind::of_word(name.strip_suffix("Type").unwrap_or(name)).unwrap_or_default()
        }
    }
}

/// The name of the variable, type or unit to which an element belongs.
fn owner<'a>(element: Element<'a, '_>) -> Option<&'a str> {
    let named = |node: &Node<'a, '_>| node.attribute("name");
    named(&element.0).or_else(|| named(&element.0.parent()?))
}
