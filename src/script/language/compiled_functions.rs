//! Functions that scripts call again and again, compiled for the sizes at hand.

use crate::eval::{Function, RunCompiled};
use crate::flatten::FlatModel;
use crate::lower::CompiledFunctions;
use crate::value::Value;
use crate::{Dialect, Session};
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

impl RunCompiled for Session {
    fn run_compiled(&mut self, function: &Arc<Function>, inputs: &[&Value]) -> Option<Vec<Value>> {
        let names = (self.classes.revision(), self.dialect());
        if self.functions.names != names {
            self.functions = ScriptFunctions { compiled: None, names };
        }
        let compiled = self.functions.compiled.get_or_insert_with(CompiledFunctions::of_scripts);
        compiled.call(function, inputs, || {
            let functions = self.classes.library.function(&function.name).ok().flatten()?;
            let is_complete = self.classes.library.take_problems().is_empty();
            let library = FlatModel { functions, strict: true, ..FlatModel::default() };
            is_complete.then(|| Arc::new(library))
        })
    }
}
