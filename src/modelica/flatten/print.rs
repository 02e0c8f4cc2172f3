//! The flat model as text: one class of flat Modelica that reads as Modelica again. Paths are
//! written as quoted identifiers, because they are names and no longer ways through components.

use super::types::type_name;
use super::{BaseType, FlatModel, Variability, Variable};
use crate::name::Ident;
use crate::syntax::ast::{
    Arguments, CausalityPrefix, ComponentReference, Equation, Expression, ExpressionKind,
    ReferencePart, Statement,
};
use crate::syntax::print;
use crate::syntax::visit::{self, Rewrite};
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
        equations(f, "initial equation", &self.initial_equations)?;
        equations(f, "equation", &self.equations)?;
        for statements in &self.initial_algorithms {
            algorithm(f, "initial algorithm", statements)?;
        }
        for statements in &self.algorithms {
            algorithm(f, "algorithm", statements)?;
        }
        writeln!(f, "end {name};")
    }
}

fn equations(f: &mut fmt::Formatter<'_>, keyword: &str, all: &[Equation]) -> fmt::Result {
    if !all.is_empty() {
        writeln!(f, "{keyword}")?;
    }
    for equation in all {
        let mut equation = equation.clone();
        Flat.equation(&mut equation);
        writeln!(f, "{};", indented(&print::equation(&equation)))?;
    }
    Ok(())
}

fn algorithm(f: &mut fmt::Formatter<'_>, keyword: &str, all: &[Statement]) -> fmt::Result {
    writeln!(f, "{keyword}")?;
    for statement in all {
        let mut statement = statement.clone();
        Flat.statement(&mut statement);
        writeln!(f, "{};", indented(&print::statement(&statement)))?;
    }
    Ok(())
}

fn indented(text: &str) -> String {
    let lines: Vec<String> = text.trim_end().lines().map(|line| format!("  {line}")).collect();
    lines.join("\n").trim_end_matches(';').to_owned()
}

fn declaration(variable: &Variable) -> String {
    let mut text = String::new();
    if variable.is_final {
        text.push_str("final ");
    }
    text.push_str(match variable.variability {
        Variability::Constant => "constant ",
        Variability::Parameter => "parameter ",
        Variability::Discrete if variable.base == BaseType::Real => "discrete ",
        Variability::Discrete | Variability::Continuous => "",
    });
    text.push_str(match variable.causality {
        Some(CausalityPrefix::Input) => "input ",
        Some(CausalityPrefix::Output) => "output ",
        None => "",
    });
    text.push_str(&type_name(&variable.base));
    if !variable.dims.is_empty() {
        let sizes: Vec<String> = variable.dims.iter().map(usize::to_string).collect();
        text.push_str(&format!("[{}]", sizes.join(", ")));
    }
    text.push_str(&format!(" {}", quoted(&variable.name)));
    let attributes: Vec<String> = variable
        .attributes
        .iter()
        .map(|(name, attribute)| {
            let is_final = if attribute.is_final { "final " } else { "" };
            format!("{is_final}{name} = {}", flat_text(&attribute.value))
        })
        .collect();
    if !attributes.is_empty() {
        text.push_str(&format!("({})", attributes.join(", ")));
    }
    if let Some(binding) = &variable.binding {
        text.push_str(&format!(" = {}", flat_text(binding)));
    }
    if let Some(description) = &variable.description {
        text.push_str(&format!(" {}", print::string_literal(description)));
    }
    text
}

fn flat_text(e: &Expression) -> String {
    let mut e = e.clone();
    Flat.expression(&mut e);
    print::expression(&e)
}

/// A path as an identifier: quoted if it is more than one.
fn quoted(path: &str) -> String {
    let simple = path.chars().all(|c| c.is_alphanumeric() || c == '_');
    if simple || (path.starts_with('\'') && !path[1..path.len() - 1].contains('\'')) {
        return path.to_owned();
    }
    format!("'{}'", path.replace('\'', "\\'"))
}

/// Makes one identifier of the path of every variable.
struct Flat;

impl Rewrite for Flat {
    fn expression(&mut self, e: &mut Expression) {
        if let ExpressionKind::Call { arguments, .. } = &mut e.kind {
            // The name of a function is not a path.
            self.arguments(arguments);
            return;
        }
        visit::rewrite_expression(self, e);
    }

    fn reference(&mut self, reference: &mut ComponentReference) {
        visit::rewrite_reference(self, reference);
        if reference.parts.len() < 2 {
            return;
        }
        let Some(mut last) = reference.parts.pop() else { return };
        let subscripts = std::mem::take(&mut last.subscripts);
        reference.parts.push(last);
        let path = print::reference(reference).replace(", ", ",");
        let name = Ident::new(&quoted(&path));
        reference.parts = vec![ReferencePart { name, subscripts }];
    }
}

impl Flat {
    fn arguments(&mut self, arguments: &mut Arguments) {
        arguments.positional.iter_mut().for_each(|e| self.expression(e));
        arguments.named.iter_mut().for_each(|argument| self.expression(&mut argument.value));
        arguments
            .iterators
            .iter_mut()
            .filter_map(|index| index.range.as_mut())
            .for_each(|range| self.expression(range));
    }
}
