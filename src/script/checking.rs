//! Models as `gapi check` and `gapi flatten` show them.

use super::Session;
use super::simulation::{self, Translated};
use crate::dae;
use crate::diag::Diagnostic;
use crate::flatten::FlatModel;
use crate::name::Name;
use crate::syntax::ast::Restriction;

/// Counts, alias sets and sorted blocks of a translated model.
pub fn report(model: &Translated) -> String {
    dae::report(model.program.sorted())
}

/// The flat model of a class, which may carry a modification.
///
/// # Errors
/// Everything that is wrong with it.
pub fn flat_model(session: &mut Session, problem: &str) -> Result<FlatModel, Vec<Diagnostic>> {
    simulation::flat_model(session, problem)
}

/// The loaded classes that can be simulated: models and blocks that are not partial, in order of
/// loading, and how many classes there are in all.
pub fn models(session: &mut Session) -> (Vec<Name>, usize) {
    let library = session.library();
    let all = library.all();
    let count = all.len();
    let is_model = |name: &Name| {
        library.definition(name).is_some_and(|class| {
            matches!(class.restriction, Restriction::Model | Restriction::Block) && !class.partial
        })
    };
    (all.into_iter().filter(is_model).collect(), count)
}
