//! What does not obey the habits yet, or cannot. Nothing is added without its reason; what has become
//! better is taken out, or the test fails.

/// Folders with larger cycles of files than three: the sizes of these cycles, and what ties the
/// files together.
pub(super) const CYCLES: &[(&str, &[usize], &str)] = &[];

const BY_EXPRESSION: &str = "what an expression is follows from the expressions in it";

/// Types whose methods call each other over more than two files: over how many, and why.
pub(super) const CALL_CYCLES: &[(&str, usize, &str)] = &[
    (
        "Instantiation",
        15,
        "a member is made when an expression first needs it, and its sizes need expressions",
    ),
    ("Lowering", 12, BY_EXPRESSION),
    ("Evaluator", 11, BY_EXPRESSION),
    ("Builder", 3, BY_EXPRESSION),
    ("Body", 6, BY_EXPRESSION),
    ("NameCheck", 5, "what a class declares holds classes"),
    ("Classes", 5, "a base class is looked up in the classes around, which have base classes"),
    ("Instances", 3, "a function is compiled together with its derivatives and inverses"),
    ("OccurrenceSearch", 3, "classes hold expressions, which hold modifications of classes"),
    ("Library", 4, "classes are read when they are first asked for"),
];

const PER_CASE: &str = "one arm for every case of the enumeration, each short";
const IN_ORDER: &str = "steps in their order that share many values";

/// Functions of more than 60 lines: file, name, reason.
pub(super) const LONG_FUNCTIONS: &[(&str, &str, &str)] = &[
    ("modelica/bytecode/machine.rs", "execute", PER_CASE),
    ("modelica/codegen/compilation.rs", "relations", IN_ORDER),
    ("modelica/codegen/event_code.rs", "compile_events", IN_ORDER),
    ("modelica/codegen/sequence.rs", "compile_steps", IN_ORDER),
    ("modelica/flatten/expressions/resolve.rs", "resolve_kind", PER_CASE),
    ("modelica/lower/expressions/expression.rs", "lower_kind", PER_CASE),
    ("modelica/syntax/failure.rs", "described", PER_CASE),
    ("modelica/syntax/print/expression.rs", "expression", PER_CASE),
];
