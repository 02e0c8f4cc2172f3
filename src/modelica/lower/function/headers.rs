//! What is known of functions without their statements.

use crate::eval::{Function, FunctionBody};
use crate::flatten::FlatModel;
use crate::name::Ident;
use crate::syntax::ast::ComponentReference;
use crate::syntax::visit::Visit;
use rustc_hash::FxHashSet;
use std::sync::Arc;

/// The functions of a model alone.
pub(in crate::lower) fn library_of(flat: &FlatModel, strict: bool) -> Arc<FlatModel> {
    let (functions, resources) = (flat.functions.clone(), flat.resources.clone());
    Arc::new(FlatModel { functions, resources, strict, ..FlatModel::default() })
}

/// The function without its statements, whose outputs have the declared sizes: what declares them must
/// need no more than the inputs and a few of its protected variables.
pub(super) fn header_of(function: &Function) -> Function {
    let mut header = function.clone();
    header.outputs.iter_mut().for_each(|output| output.binding = None);
    header.locals.clear();
    let needed = names_in_sizes(&header);
    header.locals = function.locals.clone();
    header.locals.retain(|local| needed.contains(&local.name));
    header.body = FunctionBody::Algorithm(Vec::new());
    header
}

/// The names in the sizes of the outputs and local variables of a function.
pub(super) fn names_in_sizes(function: &Function) -> FxHashSet<Ident> {
    struct Names(FxHashSet<Ident>);
    impl Visit for Names {
        fn reference(&mut self, reference: &ComponentReference) {
            self.0.extend(reference.parts.first().map(|part| part.name));
        }
    }
    let mut names = Names(FxHashSet::default());
    for component in function.outputs.iter().chain(&function.locals) {
        component.sizes().for_each(|size| names.expression(size));
    }
    names.0
}
