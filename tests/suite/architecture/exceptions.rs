//! What does not obey the habits yet, or cannot. Nothing is added without its reason; what has become
//! better is taken out, or the test fails.

/// Folders with larger cycles of files than three: the sizes of these cycles, and what ties the
/// files together.
pub(super) const CYCLES: &[(&str, &[usize], &str)] = &[
    (
        "codegen",
        &[6, 7],
        "`Program` holds the code of its parts, and parts make programs of their own (`noEvent`); \
         a tape solves linear systems whose matrices are tapes",
    ),
    (
        "eval",
        &[9],
        "a function holds its compiled form, which calls intrinsics, which ask the host for \
         functions",
    ),
    ("identify", &[11], "the summary of a run is made by the steps that conclude it"),
    (
        "lower",
        &[20],
        "`Builder` is the target of all lowering, and lowers functions through itself",
    ),
    ("script", &[11], "`Session` has the state of all its parts in one structure"),
];

const PER_CASE: &str = "one arm for every case of the enumeration, each short";
const ONE_TABLE: &str = "one row for every name";
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
    ("eval/external.rs", "external", ONE_TABLE),
    ("flatten/expressions/resolve.rs", "resolve_kind", PER_CASE),
    ("flatten/shapes.rs", "call_shape", ONE_TABLE),
    ("identify/problem/statistics/distributions.rs", "normal_quantile", "coefficients"),
    ("identify/problem/statistics/mod.rs", "at", IN_ORDER),
    ("identify/problem/summary.rs", "of", IN_ORDER),
    ("identify/problem/text.rs", "facts", ONE_TABLE),
    ("lower/build.rs", "build", IN_ORDER),
    ("lower/expressions/calls.rs", "user_call", IN_ORDER),
    ("lower/expressions/calls.rs", "array_function", ONE_TABLE),
    ("lower/expressions/expression.rs", "lower_kind", PER_CASE),
    ("lower/inline.rs", "statement", PER_CASE),
    ("mat/v73.rs", "dataset", IN_ORDER),
    ("script/runs/problem/build.rs", "build", IN_ORDER),
    ("script/runs/problem/build.rs", "experiment", IN_ORDER),
    ("script/runs/problem/draft.rs", "experiment", IN_ORDER),
    ("script/runs/problem/mod.rs", "solve_built", IN_ORDER),
    ("sim/event.rs", "first_event", IN_ORDER),
    ("sim/integrators/radau.rs", "step", IN_ORDER),
    ("syntax/failure.rs", "described", PER_CASE),
    ("syntax/print/expression.rs", "expression", PER_CASE),
];
