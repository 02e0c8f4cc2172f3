//! Component clauses (MLS §A.2.4).

use super::{Comment, Constraint, ElementPrefixes, Expression, Modification, Subscript};
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};

/// `parameter Real x[3](start = 1) = y if c "text", z;`
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentClause {
    /// `redeclare final inner outer replaceable`.
    pub prefixes: ElementPrefixes,
    /// `flow`, `parameter`, `input`, ….
    pub type_prefixes: TypePrefixes,
    /// The type.
    pub type_specifier: TypeSpecifier,
    /// Dimensions written behind the type.
    pub subscripts: Vec<Subscript>,
    /// The components.
    pub components: Vec<ComponentDeclaration>,
    /// `constrainedby …`.
    pub constraint: Option<Constraint>,
    /// The whole clause.
    pub span: Span,
}

/// `type-prefix`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TypePrefixes {
    /// `flow` or `stream`.
    pub connection: Option<ConnectionPrefix>,
    /// `constant`, `parameter` or `discrete`.
    pub variability: Option<VariabilityPrefix>,
    /// `input` or `output`.
    pub causality: Option<CausalityPrefix>,
}

/// `flow` or `stream`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConnectionPrefix {
    /// Sums to zero in a connection set.
    Flow,
    /// Carried by a flow (MLS ch. 15).
    Stream,
}

/// The written variability of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VariabilityPrefix {
    /// Never changes.
    Constant,
    /// Constant during a simulation.
    Parameter,
    /// Changes at events only.
    Discrete,
}

/// `input` or `output`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CausalityPrefix {
    /// Known from outside.
    Input,
    /// Determined inside.
    Output,
}

/// A type's name with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct TypeSpecifier {
    /// The name, global if it begins with a dot.
    pub name: Name,
    /// Where it is written.
    pub span: Span,
}

/// One component of a clause.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentDeclaration {
    /// Its name.
    pub name: Spanned<Ident>,
    /// Dimensions written behind the name.
    pub subscripts: Vec<Subscript>,
    /// `(…) = e`.
    pub modification: Option<Modification>,
    /// `if c`.
    pub condition: Option<Expression>,
    /// String and annotation.
    pub comment: Comment,
    /// From the name to the end of the comment.
    pub span: Span,
}
