//! When a value may change (MLS §3.8): as the most variable of what its expression names.

use crate::functions::{self, VariabilityRule};
use crate::name::Ident;
use crate::syntax::ast::{ComponentReference, Expression, ExpressionKind, ForIndex};
use crate::syntax::visit::{Visit, walk_expression, walk_reference};

/// When a variable may change (MLS §3.8).
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
pub enum Variability {
    /// Never.
    Constant,
    /// Not during a simulation.
    Parameter,
    /// At events.
    Discrete,
    /// Always.
    Continuous,
}

/// What a caller knows of names.
pub(crate) trait VariabilityOfNames {
    /// When a variable may change; `None` if it is not known, or if the name is not of a variable.
    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Variability>;
}

/// A variable, or an operator with a meaning in time, in an expression.
pub(crate) struct Varying {
    /// Its name.
    pub(crate) name: ComponentReference,
    /// Whether it is an operator.
    pub(crate) is_operator: bool,
    /// When its value may change.
    pub(crate) variability: Variability,
}

/// What changes most often in an expression, as far as it is known.
pub(crate) fn most_variable<N: VariabilityOfNames>(
    names: &mut N,
    e: &Expression,
) -> Option<Varying> {
    let mut walk = Walk { names, iterators: Vec::new(), most: None };
    walk.expression(e);
    walk.most
}

struct Walk<'n, N> {
    names: &'n mut N,
    /// The iterators around, which hide variables of the same name.
    iterators: Vec<Ident>,
    most: Option<Varying>,
}

impl<N: VariabilityOfNames> Walk<'_, N> {
    fn meet(&mut self, name: &ComponentReference, variability: Variability, is_operator: bool) {
        if self.most.as_ref().is_none_or(|known| variability > known.variability) {
            self.most = Some(Varying { name: name.clone(), is_operator, variability });
        }
    }

    fn call(&mut self, function: &ComponentReference) -> Reads {
        let rule = match function.parts.as_slice() {
            [name] => functions::find(name.name.as_str()).map(|entry| entry.variability),
            // Operators of the graph of connections (MLS §9.4).
            [package, _] if package.name == "Connections" => Some(VariabilityRule::Never),
            _ => None,
        };
        match rule {
            Some(VariabilityRule::Never) => return Reads::Nothing,
            Some(VariabilityRule::Always) => self.meet(function, Variability::Discrete, true),
            Some(VariabilityRule::OfArguments) | None => {}
        }
        Reads::Arguments
    }

    /// Elements that iterators repeat. The last iterator is the outer one (MLS §10.4.1): the ranges
    /// of those before it may use it.
    fn iterated<'e>(
        &mut self,
        indices: &[ForIndex],
        elements: impl IntoIterator<Item = &'e Expression>,
    ) {
        let outside = self.iterators.len();
        for index in indices.iter().rev() {
            index.range.iter().for_each(|range| self.expression(range));
            self.iterators.push(index.name.node);
        }
        elements.into_iter().for_each(|element| self.expression(element));
        self.iterators.truncate(outside);
    }
}

/// What a call reads of its arguments.
#[derive(PartialEq)]
enum Reads {
    /// Their values.
    Arguments,
    /// Their sizes, or their place in the model.
    Nothing,
}

impl<N: VariabilityOfNames> Visit for Walk<'_, N> {
    fn expression(&mut self, e: &Expression) {
        match &e.kind {
            ExpressionKind::Call { function, arguments } => match self.call(function) {
                Reads::Nothing => {}
                Reads::Arguments if arguments.iterators.is_empty() => walk_expression(self, e),
                Reads::Arguments => self.iterated(&arguments.iterators, &arguments.positional),
            },
            ExpressionKind::ArrayIteration { element, indices } => {
                self.iterated(indices, [&**element]);
            }
            _ => walk_expression(self, e),
        }
    }

    fn reference(&mut self, reference: &ComponentReference) {
        let own = reference.as_ident();
        if !own.is_some_and(|name| self.iterators.contains(&name)) {
            let is_time = own.is_some_and(|name| name == "time");
            let found = self.names.of_reference(reference);
            let found = found.or(is_time.then_some(Variability::Continuous));
            found.into_iter().for_each(|found| self.meet(reference, found, false));
        }
        walk_reference(self, reference);
    }
}
