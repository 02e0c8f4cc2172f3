//! Functions that scripts call again and again, compiled for the sizes at hand.

use crate::Dialect;
use crate::eval::Function;
use crate::flatten::FlatModel;
use crate::lower::CompiledFunctions;
use crate::models::classes::Classes;
use crate::value::Value;
use std::sync::Arc;

#[cfg(test)]
#[path = "compiled_functions_tests.rs"]
mod tests;

/// Compiled functions, for as long as no name changes what it stands for.
#[derive(Default)]
pub(crate) struct ScriptFunctions {
    compiled: Option<CompiledFunctions>,
    /// The classes and the dialect that they were compiled with.
    names: (u64, Dialect),
}

impl ScriptFunctions {
    /// The outputs of a function for values of its inputs, if it is compiled and gives them.
    pub(super) fn call(
        &mut self,
        function: &Arc<Function>,
        inputs: &[&Value],
        classes: &mut Classes,
        dialect: Dialect,
    ) -> Option<Vec<Value>> {
        let names = (classes.revision(), dialect);
        if self.names != names {
            *self = ScriptFunctions { compiled: None, names };
        }
        let compiled = self.compiled.get_or_insert_with(CompiledFunctions::of_scripts);
        compiled.call(function, inputs, || {
            let functions = classes.library.function(&function.name).ok().flatten()?;
            let is_complete = classes.library.take_problems().is_empty();
            let library = FlatModel { functions, strict: true, ..FlatModel::default() };
            is_complete.then(|| Arc::new(library))
        })
    }
}
