//! The flat model as text: one class of flat Modelica that reads as Modelica again. Paths are
//! quoted identifiers, because they are names and no longer ways through components.

use super::{BaseType, FlatModel, Variability, Variable};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    CausalityPrefix, ComponentReference, Expression, ExpressionKind, ReferencePart, Subscript,
};
use crate::syntax::print;
use crate::syntax::visit;
use std::fmt;

impl fmt::Display for FlatModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = quoted(&self.name);
        write!(f, "model {name}")?;
        if let Some(description) = &self.description {
            write!(f, " {}", print::string_literal(description))?;
        }
        writeln!(f)?;
        for variable in self.variables.values() {
            writeln!(f, "  {};", declaration(variable))?;
        }
        section(f, "initial equation", &self.initial_equations)?;
        section(f, "equation", &self.equations)?;
        for statements in &self.algorithms {
            writeln!(f, "algorithm")?;
            for statement in statements {
                let mut statement = statement.clone();
                visit::rewrite_statement(&mut statement, &mut flat);
                writeln!(f, "{};", indented(&print::statement(&statement)))?;
            }
        }
        writeln!(f, "end {name};")
    }
}
