//! Modifications (MLS §A.2.5, ch. 7).

use super::{ClassElement, ComponentClause, Expression};
use crate::name::Name;
use crate::source::{Span, Spanned};
use std::sync::Arc;

/// `(a = 1, b(c = 2)) = e`: arguments, a binding, or both.
#[derive(Debug, Clone, PartialEq)]
pub struct Modification {
    /// What stands in the parentheses, in order.
    pub arguments: Vec<Argument>,
    /// What stands behind `=` or `:=`.
    pub binding: Option<Binding>,
    /// The whole modification.
    pub span: Span,
}

/// What stands behind the `=` of a modification.
#[derive(Debug, Clone, PartialEq)]
pub enum Binding {
    /// `= e`
    Expression(Expression),
    /// `= break`: removes the binding (MLS §7.2.7).
    Break(Span),
}

/// One argument of a class modification.
#[derive(Debug, Clone, PartialEq)]
pub enum Argument {
    /// `each final a.b(…) = e "text"`
    Element(ElementModification),
    /// `redeclare …` or `replaceable …`
    Redeclaration(ElementRedeclaration),
}

/// `each final a.b(…) = e "text"`.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementModification {
    /// `each`
    pub each: bool,
    /// `final`
    pub is_final: bool,
    /// The element modified; dotted only in the old style `a.b = 1`.
    pub name: Spanned<Name>,
    /// What it is modified by.
    pub modification: Option<Modification>,
    /// The string behind it.
    pub description: Option<Arc<str>>,
    /// The whole argument.
    pub span: Span,
}

/// `redeclare each final replaceable …`.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementRedeclaration {
    /// `each`
    pub each: bool,
    /// What is declared anew; its prefixes hold `redeclare`, `final` and `replaceable`.
    pub element: RedeclaredElement,
    /// The whole argument.
    pub span: Span,
}

/// A class or a component (a clause with exactly one component).
#[derive(Debug, Clone, PartialEq)]
pub enum RedeclaredElement {
    /// `redeclare package Medium = Water`
    Class(Box<ClassElement>),
    /// `redeclare Resistor r(R = 2)`
    Component(Box<ComponentClause>),
}
