//! The state of one instantiation: the classes with the instance tree, functions and values. Each is
//! built as the others need it: a parameter that gives a size may be declared after the array that
//! it sizes.

use super::growth::Growth;
use crate::external::AtTranslation;
use crate::flatten::connections::sets::Connections;
use crate::flatten::expressions::values::Values;
use crate::flatten::functions::table::FunctionTable;
use crate::flatten::library::Library;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::record_values::RecordValues;
use crate::flatten::types::Types;
use crate::flatten::warnings::Warnings;
use std::rc::Rc;

/// The parts of an instantiation.
pub(crate) struct Instantiation<'a> {
    pub classes: Classes<'a>,
    pub functions: FunctionTable,
    pub values: Values,
    /// All connections, as soon as the tree is whole.
    pub connections: Option<Rc<Connections>>,
    pub warnings: Warnings,
    /// How deep expressions are being resolved.
    pub depth: usize,
    /// The components that are being completed, outermost first.
    pub growth: Growth,
    /// Values of records, which their components share.
    pub(crate) record_values: RecordValues,
}

impl<'a> Instantiation<'a> {
    /// A tree with the instance of the top scope alone.
    pub(crate) fn new(library: &'a Library) -> Instantiation<'a> {
        Instantiation {
            classes: Classes::new(library),
            functions: FunctionTable::default(),
            values: Values {
                outside: AtTranslation::new(library.resources().clone()),
                ..Values::default()
            },
            connections: None,
            warnings: Warnings::default(),
            depth: 0,
            growth: Growth::default(),
            record_values: RecordValues::default(),
        }
    }

    /// The types of resolved expressions.
    pub(crate) fn types(&self) -> Types<'_> {
        Types { tree: &self.classes.tree, functions: &self.functions }
    }
}
