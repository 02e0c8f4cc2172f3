//! The classes of a session: those of its scripts, of loaded files and of libraries.

use super::Session;
use crate::diag::{Diagnostic, Fault};
use crate::eval::{Function, ValueType};
use crate::fault;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{ClassDefinition, ComponentReference};
use crate::value::Value;
use std::path::PathBuf;
use std::sync::Arc;

#[derive(Default)]
pub(super) struct Classes {
    revision: u64,
}
impl Classes {
    pub(super) fn revision(&self) -> u64 {
        self.revision
    }
    pub(super) fn function_names(&self) -> Vec<String> {
        Vec::new()
    }
}
pub(super) fn autoload(_: &mut Session, _: &Name) -> Result<(), Fault> {
    Ok(())
}
impl Session {
    pub(super) fn class_exists(&mut self, _: &Name) -> bool {
        false
    }
    pub(super) fn define_class(&mut self, class: &Arc<ClassDefinition>) -> Result<(), Diagnostic> {
        Err(fault!(super::errors::REFUSED, "classes are not supported yet").at(class.span))
    }
    pub(super) fn forget_classes(&mut self) {
        self.callees.clear();
    }
    pub(super) fn class_type(&mut self, name: &Name) -> Result<ValueType, Fault> {
        Err(fault!(super::errors::REFUSED, "no type `{name}`"))
    }
    pub(super) fn loaded_function(&mut self, _: &Name) -> Result<Option<Arc<Function>>, Fault> {
        Ok(None)
    }
    pub(super) fn constant(&mut self, name: &Name) -> Result<Option<Value>, Fault> {
        Ok(super::builtins::constant(name))
    }
    pub(super) fn model_value(
        &mut self,
        _: &ComponentReference,
    ) -> Result<Option<Value>, Diagnostic> {
        Ok(None)
    }
    pub(super) fn assign_dotted(
        &mut self,
        target: &ComponentReference,
        value: Value,
        _: Span,
    ) -> Result<bool, Diagnostic> {
        if self.set_flag(target, &value) {
            return Ok(true);
        }
        Err(self.nothing_translated(target).at(target.span))
    }
    pub(super) fn resource(&mut self, uri: &str) -> Result<PathBuf, Fault> {
        self.find_file(uri.as_ref()).ok_or_else(|| self.missing_file(uri.as_ref()))
    }
}
