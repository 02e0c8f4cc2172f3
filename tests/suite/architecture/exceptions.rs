//! What does not obey the habits yet, or cannot. Nothing is added without its reason; what has become
//! better is taken out, or the test fails.

/// Folders with larger cycles of files than three: the sizes of these cycles, and what ties the
/// files together.
pub(super) const CYCLES: &[(&str, &[usize], &str)] = &[];

const PER_CASE: &str = "one arm for every case of the enumeration, each short";
const IN_ORDER: &str = "steps in their order that share many values";

/// Functions of more than 60 lines: file, name, reason.
pub(super) const LONG_FUNCTIONS: &[(&str, &str, &str)] = &[
    ("bytecode/machine.rs", "run_at", PER_CASE),
    ("bytecode/machine.rs", "execute", PER_CASE),
    ("codegen/compilation.rs", "relations", IN_ORDER),
    ("codegen/event_code.rs", "compile_events", IN_ORDER),
    ("codegen/sequence.rs", "compile_steps", IN_ORDER),
    ("codegen/tape.rs", "run", PER_CASE),
    ("codegen/tape_builder.rs", "instruction", PER_CASE),
    ("codegen/translation.rs", "instruction", PER_CASE),
    ("flatten/expressions/resolve.rs", "resolve_kind", PER_CASE),
    ("lower/expressions/expression.rs", "lower_kind", PER_CASE),
    ("lower/inline.rs", "statement", PER_CASE),
    ("syntax/failure.rs", "described", PER_CASE),
    ("syntax/print/expression.rs", "expression", PER_CASE),
];
