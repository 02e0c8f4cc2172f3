//! Models as `gapi check` and `gapi flatten` show them.

use super::simulation::{self, Translated};
use crate::Session;
use crate::causalize;
use crate::diag::Diagnostic;
use crate::flatten::FlatModel;
use crate::name::Name;
use crate::syntax::ast::Restriction;

/// Says whether what the specification forbids but libraries do is an error.
pub fn set_strict(session: &mut Session, strict: bool) {
    session.classes.library.set_strict(strict);
}

/// Counts, alias sets and sorted blocks of a translated model.
pub fn report(session: &mut Session, model: &Translated) -> String {
    let report = causalize::report(model.program.sorted());
    let (name, rest) = report.split_once('\n').unwrap_or((&report, ""));
    let classes = session.library().number_read();
    let unknowns = model.unknowns();
    format!("{name}\n  classes read {classes}\n  unknowns {unknowns}\n{rest}")
}

/// The counts of a report in one line: `2 unknowns, 1 state, 2 equations, 2 blocks, no algebraic loops`.
/// What there is none of is left out, but for the loops.
pub fn summary(session: &mut Session, model: &Translated) -> String {
    let report = report(session, model);
    let counts = report.lines().skip(2).take_while(|line| line.starts_with("  "));
    let counts = counts.filter_map(|line| match line.trim().rsplit_once(' ')? {
        (what @ "algebraic loops", "0") => Some(format!("no {what}")),
        (_, "0") => None,
        ("aliases", "1") => Some("1 alias".to_owned()),
        (what, "1") => Some(format!("1 {}", what.trim_end_matches('s'))),
        (what, count) => Some(format!("{count} {what}")),
    });
    counts.collect::<Vec<_>>().join(", ")
}

/// The flat model of a class, which may carry a modification.
///
/// # Errors
/// Everything that is wrong with it.
pub fn flat_model(session: &mut Session, problem: &str) -> Result<FlatModel, Vec<Diagnostic>> {
    simulation::flat_model(session, problem)
}

/// The local balance (MLS §4.8) of a class that is no system by itself, a component with open
/// connectors; `None` for any other class.
pub fn component_balance(session: &mut Session, problem: &str) -> Option<String> {
    let flattened = simulation::flattened(session, problem).ok()?;
    let balance = flattened.balance?.of_component()?;
    Some(format!("{}: {balance}", flattened.model.name))
}

/// These classes and all in them, in order of loading.
pub fn classes(session: &mut Session, loaded: &[Name]) -> Vec<Name> {
    let library = session.library();
    loaded.iter().flat_map(|name| library.all_in(name)).collect()
}

/// Whether a class can be simulated: a model or a block that is not partial.
pub fn is_model(session: &mut Session, class: &Name) -> bool {
    session.library().definition(class).is_some_and(|class| {
        matches!(class.restriction, Restriction::Model | Restriction::Block) && !class.partial
    })
}
