//! Flat models in OpenModelica's words: a line for each scalar, names without quotes.

mod equations;
mod functions;
mod numbers;
mod operations;
mod parts;
mod trivial;

pub(crate) use trivial::trivial_equations;

use crate::flatten::{Attribute, BaseType, FlatModel, Variability, Variable};
use crate::name::Ident;
use crate::syntax::ast::{
    CausalityPrefix, ComponentReference, Equation, Expression, ExpressionKind, ReferencePart,
    Statement, Subscript,
};
use crate::syntax::print;
use crate::syntax::visit::Rewrite;
use functions::{function_text, is_of_language};
use numbers::Numbers;
use parts::{Apart, selected};

/// Attributes in the order in which they are printed.
const ATTRIBUTES: &[&str] =
    &["quantity", "unit", "displayUnit", "min", "max", "start", "fixed", "nominal", "stateSelect"];

/// A flat model as text.
pub(crate) fn flat_text(model: &FlatModel) -> String {
    let writer = Writer { apart: Apart(model), numbers: Numbers(model) };
    let functions = model.functions.values().filter(|function| !is_of_language(function));
    let mut text: String = functions.map(|function| function_text(function)).collect();
    text += &format!("class {}{}\n", model.name, comment(model.description.as_deref()));
    for variable in model.variables.values() {
        text.extend(writer.declarations(variable).iter().map(|line| format!("  {line};\n")));
    }
    text += &writer.equations("initial equation", &model.initial_equations);
    text += &writer.equations("equation", &model.equations);
    for statements in &model.initial_algorithms {
        text += &writer.algorithm("initial algorithm", statements);
    }
    for statements in &model.algorithms {
        text += &writer.algorithm("algorithm", statements);
    }
    format!("{text}end {};\n", model.name)
}

struct Writer<'m> {
    apart: Apart<'m>,
    numbers: Numbers<'m>,
}

impl Writer<'_> {
    /// A line for each scalar of a variable.
    fn declarations(&self, variable: &Variable) -> Vec<String> {
        let prefixes = prefixes(variable);
        let comment = comment(variable.description.as_deref());
        let line = |at: &[usize]| {
            let subscripts: Vec<String> = at.iter().map(usize::to_string).collect();
            let name = match at {
                [] => variable.name.to_string(),
                _ => format!("{}[{}]", variable.name, subscripts.join(",")),
            };
            let attributes = self.attributes(variable, at);
            let binding = match &variable.binding {
                Some(binding) => format!(" = {}", self.element(variable, binding, at)),
                None => String::new(),
            };
            format!("{prefixes}{name}{attributes}{binding}{comment}")
        };
        positions(&variable.dims).iter().map(|at| line(at)).collect()
    }

    fn attributes(&self, variable: &Variable, at: &[usize]) -> String {
        let given = ATTRIBUTES.iter().filter_map(|name| {
            let Attribute { value, .. } = variable.attributes.get(name)?;
            let text = match (*name, &value.kind) {
                ("stateSelect", ExpressionKind::Integer(ordinal)) => state_select(*ordinal),
                _ => self.element(variable, value, at),
            };
            Some(format!("{name} = {text}"))
        });
        match given.collect::<Vec<_>>() {
            none if none.is_empty() => none.concat(),
            some => format!("({})", some.join(", ")),
        }
    }

    /// The value at a position of a binding or an attribute, which may be a scalar for all.
    fn element(&self, variable: &Variable, value: &Expression, at: &[usize]) -> String {
        let element = match self.apart.parts(value) {
            Some(parts) if parts.dims.is_empty() => parts.scalars[0].clone(),
            Some(parts) if parts.dims == variable.dims => {
                let offset =
                    at.iter().zip(&parts.dims).fold(0, |offset, (i, size)| offset * size + i - 1);
                parts.scalars[offset].clone()
            }
            _ if at.is_empty() => value.clone(),
            _ => selected(value, at),
        };
        if let (BaseType::Enumeration(definition), ExpressionKind::Integer(ordinal)) =
            (&variable.base, &element.kind)
        {
            let literal = usize::try_from(*ordinal - 1).ok();
            let literal = literal.and_then(|literal| definition.literals.get(literal));
            return literal.map_or(ordinal.to_string(), |l| format!("{}.{l}", definition.name));
        }
        let is_real = variable.base == BaseType::Real;
        print::expression(&dense(self.numbers.converted(&element, is_real)))
    }

    fn equations(&self, keyword: &str, equations: &[Equation]) -> String {
        let mut text = String::new();
        for mut equation in self.apart.equations(equations) {
            self.numbers.convert_equation(&mut equation);
            Dense.equation(&mut equation);
            text += &indented(&print::equation(&equation));
        }
        if text.is_empty() { text } else { format!("{keyword}\n{text}") }
    }

    fn algorithm(&self, keyword: &str, statements: &[Statement]) -> String {
        let mut text = format!("{keyword}\n");
        for statement in statements {
            let mut statement = statement.clone();
            self.numbers.convert_statement(&mut statement);
            Dense.statement(&mut statement);
            text += &indented(&print::statement(&statement));
        }
        text
    }
}

/// Writes literal subscripts without blanks between them, `A[1,2]`: they are part of a name.
struct Dense;

impl Rewrite for Dense {
    fn reference(&mut self, reference: &mut ComponentReference) {
        let subscripts = || reference.parts.iter().flat_map(|part| &part.subscripts);
        let is_literal = |subscript: &Subscript| match subscript {
            Subscript::Index(index) => matches!(index.kind, ExpressionKind::Integer(_)),
            Subscript::All(_) => false,
        };
        if subscripts().next().is_none() || !subscripts().all(is_literal) {
            return;
        }
        let name = Ident::new(&print::reference(reference).replace(", ", ","));
        reference.parts = vec![ReferencePart { name, subscripts: Vec::new() }];
    }
}

fn dense(mut e: Expression) -> Expression {
    Dense.expression(&mut e);
    e
}

fn indented(text: &str) -> String {
    let text = text.trim_end().trim_end_matches(';');
    let lines: Vec<String> = text.lines().map(|line| format!("  {line}")).collect();
    lines.join("\n") + ";\n"
}

fn comment(description: Option<&str>) -> String {
    description.map_or(String::new(), |text| format!(" {}", print::string_literal(text)))
}

/// Everything in front of the name.
fn prefixes(variable: &Variable) -> String {
    let mut text = String::new();
    if variable.protected {
        text += "protected ";
    }
    if (variable.is_final || variable.structural) && variable.variability == Variability::Parameter
    {
        text += "final ";
    }
    text += match variable.variability {
        Variability::Constant => "constant ",
        Variability::Parameter => "parameter ",
        Variability::Discrete if variable.base == BaseType::Real => "discrete ",
        Variability::Discrete | Variability::Continuous => "",
    };
    text += match variable.causality {
        Some(CausalityPrefix::Input) => "input ",
        Some(CausalityPrefix::Output) => "output ",
        None => "",
    };
    text += &type_name(&variable.base);
    text + " "
}

fn type_name(base: &BaseType) -> String {
    match base {
        BaseType::Real => "Real".into(),
        BaseType::Integer => "Integer".into(),
        BaseType::Boolean => "Boolean".into(),
        BaseType::String => "String".into(),
        BaseType::Enumeration(definition) => {
            let literals: Vec<&str> = definition.literals.iter().map(|l| l.as_str()).collect();
            format!("enumeration({})", literals.join(", "))
        }
        BaseType::ExternalObject(name) => name.to_string(),
        BaseType::Clock => "Clock".into(),
    }
}

fn state_select(ordinal: i64) -> String {
    let names = ["never", "avoid", "default", "prefer", "always"];
    let at = usize::try_from(ordinal - 1).ok();
    let name = at.and_then(|at| names.get(at));
    name.map_or(ordinal.to_string(), |name| format!("StateSelect.{name}"))
}

/// Subscripts of all elements, the last fastest.
fn positions(dims: &[usize]) -> Vec<Vec<usize>> {
    dims.iter().fold(vec![Vec::new()], |before, size| {
        let extended = |at: &Vec<usize>| {
            (1..=*size).map(|i| [at.as_slice(), &[i]].concat()).collect::<Vec<_>>()
        };
        before.iter().flat_map(extended).collect()
    })
}

#[cfg(test)]
mod tests {
    use crate::Session;
    use crate::value::Value;
    use crate::world::MemoryWorld;

    fn instantiated(model: &str) -> String {
        let mut session = Session::new(Box::new(MemoryWorld::new()));
        session.load_text("m", model).expect("a model");
        session.run_text("s.mos", "text := OpenModelica.Scripting.instantiateModel(M);");
        match session.variable("text") {
            Some(Value::String(text)) => text.to_string(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_would_grow_without_bound_stays_whole() {
        let text = instantiated(
            "model M parameter Real A[9, 9] = identity(9); Real x[9]; \
             equation x = A*A*A*A*A*A*{time for i in 1:9}; end M;",
        );
        assert!(text.contains("x = A * A"), "{text}");
    }

    #[test]
    fn parts_of_arrays_are_named_one_by_one() {
        let text = instantiated(
            "model M Real x[2, 3]; Real y[3]; Integer k = 2; equation \
             x[1, :] = {time, 2, 3}; x[2, 1:2] = fill(time, 2); x[2, 3] = y[k]; \
             y = {{x[2, 1], time}*{1, 2}, -x[1, 2], if time > 1 then 1 else 2}; end M;",
        );
        assert!(text.contains("x[2,2] = time;"), "{text}");
        assert!(text.contains("x[2,3] = y[k];"), "{text}");
        assert!(text.contains("y[1] = x[2,1] * 1.0 + time * 2.0;"), "{text}");
        assert!(text.contains("y[3] = if time > 1.0 then 1.0 else 2.0;"), "{text}");
    }
}
