//! Classes (MLS §A.2.1, A.2.2).

use super::{
    Argument, ComponentClause, ComponentReference, Equation, Expression, Statement, Subscript,
    TypePrefixes, TypeSpecifier,
};
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::lazy::Sections;
use std::sync::Arc;

/// A whole `.mo` file.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredDefinition {
    /// `within A.B;`: `None` without the clause, the empty name for a bare `within;`.
    pub within: Option<Spanned<Name>>,
    /// The classes, in order; a file of the standard form has one.
    pub classes: Vec<Arc<ClassDefinition>>,
    /// The whole text.
    pub span: Span,
}

/// `class-definition`.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassDefinition {
    /// The class's own name.
    pub name: Spanned<Ident>,
    /// `final` before a class of a stored definition.
    pub is_final: bool,
    /// `encapsulated`.
    pub encapsulated: bool,
    /// `partial`.
    pub partial: bool,
    /// `model`, `package`, ….
    pub restriction: Restriction,
    /// What stands behind the name.
    pub specifier: ClassSpecifier,
    /// The whole definition.
    pub span: Span,
}

/// The keyword of a class (`class-prefixes`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Restriction {
    /// `class`
    Class,
    /// `model`
    Model,
    /// `block`
    Block,
    /// `record`
    Record,
    /// `operator record`
    OperatorRecord,
    /// `connector`
    Connector,
    /// `expandable connector`
    ExpandableConnector,
    /// `type`
    Type,
    /// `package`
    Package,
    /// `function`, `pure function`, `impure function`, `operator function`
    Function {
        /// `pure` or `impure` where written.
        purity: Option<Purity>,
        /// `operator function`.
        operator: bool,
    },
    /// `operator`
    Operator,
}

/// `pure` or `impure` (MLS §12.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Purity {
    /// Same inputs, same outputs, no effects.
    Pure,
    /// Anything else.
    Impure,
}

/// What stands behind a class's name (`class-specifier`).
#[derive(Debug, Clone, PartialEq)]
pub enum ClassSpecifier {
    /// `M … end M`, or `extends M(…) … end M`.
    Long(LongClass),
    /// `T = Base(…)`.
    Short(ShortClass),
    /// `E = enumeration(…)`.
    Enumeration(EnumerationClass),
    /// `F = der(f, x)`: a partial derivative of a function (MLS §12.7.2).
    Derivative(DerivativeClass),
}

/// The body of a long class.
#[derive(Debug, Clone, PartialEq)]
pub struct LongClass {
    /// `Some` for `extends M(…)` (class extends, MLS §7.3.1): its modification arguments.
    pub class_extends: Option<Vec<Argument>>,
    /// The string behind the name.
    pub description: Option<Arc<str>>,
    /// Sections in the order written; the first is [`Section::Elements`] without a keyword, if
    /// anything stands before the first keyword.
    pub sections: Sections,
    /// The name behind `end`.
    pub end_name: Spanned<Ident>,
}

/// One section of a composition. Old libraries write annotations anywhere and more than once, so
/// an annotation is a section of its own.
#[derive(Debug, Clone, PartialEq)]
pub enum Section {
    /// Elements under `public`, `protected` or (at the start) no keyword.
    Elements {
        /// The keyword; `None` at the start of a class.
        visibility: Option<Visibility>,
        /// The elements.
        elements: Vec<Element>,
    },
    /// `equation` or `initial equation`.
    Equations {
        /// With `initial`.
        initial: bool,
        /// The equations.
        equations: Vec<Equation>,
        /// The section with its keyword.
        span: Span,
    },
    /// `algorithm` or `initial algorithm`.
    Algorithm {
        /// With `initial`.
        initial: bool,
        /// The statements.
        statements: Vec<Statement>,
        /// The section with its keyword.
        span: Span,
    },
    /// `external …`.
    External(External),
    /// `annotation(…);` of the class.
    Annotation(Annotation),
}

/// `public` or `protected`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Visibility {
    /// Accessible with dot notation.
    Public,
    /// Not accessible from outside.
    Protected,
}

/// `annotation(…)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Annotation {
    /// The arguments.
    pub arguments: Vec<Argument>,
    /// The whole annotation.
    pub span: Span,
}

/// An external function's clause (MLS §12.9).
#[derive(Debug, Clone, PartialEq)]
pub struct External {
    /// `"C"`, `"FORTRAN 77"`, `"builtin"`, …
    pub language: Option<Arc<str>>,
    /// Left side of the call.
    pub output: Option<ComponentReference>,
    /// Name of the external function.
    pub function: Option<Spanned<Ident>>,
    /// Its arguments.
    pub arguments: Vec<Expression>,
    /// `annotation(Library = …)`.
    pub annotation: Option<Annotation>,
    /// The whole clause.
    pub span: Span,
}

/// An element of a class.
#[derive(Debug, Clone, PartialEq)]
pub enum Element {
    /// `import …`.
    Import(Import),
    /// `extends …`.
    Extends(Extends),
    /// A class.
    Class(ClassElement),
    /// Components.
    Component(ComponentClause),
}

/// `import …` (MLS §13.2.1).
#[derive(Debug, Clone, PartialEq)]
pub struct Import {
    /// Which form.
    pub kind: ImportKind,
    /// String and annotation behind it.
    pub comment: Comment,
    /// The whole clause.
    pub span: Span,
}

/// The forms of an import.
#[derive(Debug, Clone, PartialEq)]
pub enum ImportKind {
    /// `import A.B;`
    Qualified(Name),
    /// `import C = A.B;`
    Renaming(Ident, Name),
    /// `import A.B.*;`
    Unqualified(Name),
    /// `import A.B.{C, D};`
    Group(Name, Vec<Ident>),
}

/// `extends Base(…)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Extends {
    /// The base class.
    pub base: TypeSpecifier,
    /// Its modification (no binding); `break` deselections are in [`Extends::deselected`].
    pub modification: Vec<Argument>,
    /// `break name` and `break connect(a, b)` (MLS §7.4).
    pub deselected: Vec<Deselection>,
    /// `annotation(…)`.
    pub annotation: Option<Annotation>,
    /// The whole clause.
    pub span: Span,
}

/// Something that an extends clause leaves out.
#[derive(Debug, Clone, PartialEq)]
pub enum Deselection {
    /// `break name`
    Component(Spanned<Ident>),
    /// `break connect(a, b)`
    Connection(ComponentReference, ComponentReference),
}

/// The prefixes of a class or component element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ElementPrefixes {
    /// `redeclare`
    pub redeclare: bool,
    /// `final`
    pub is_final: bool,
    /// `inner`
    pub inner: bool,
    /// `outer`
    pub outer: bool,
    /// `replaceable`
    pub replaceable: bool,
}

/// A class as an element.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassElement {
    /// `redeclare final inner outer replaceable`.
    pub prefixes: ElementPrefixes,
    /// The class.
    pub class: Arc<ClassDefinition>,
    /// `constrainedby …`.
    pub constraint: Option<Constraint>,
}

/// `constrainedby Type(…) "comment"`.
#[derive(Debug, Clone, PartialEq)]
pub struct Constraint {
    /// The constraining type.
    pub target: TypeSpecifier,
    /// Its modification.
    pub modification: Vec<Argument>,
    /// String and annotation behind it.
    pub comment: Comment,
    /// The whole clause.
    pub span: Span,
}

/// `T = prefixes Base[…](…) "comment"`.
#[derive(Debug, Clone, PartialEq)]
pub struct ShortClass {
    /// `input`, `output`, `flow`, ….
    pub prefixes: TypePrefixes,
    /// The base.
    pub target: TypeSpecifier,
    /// Array dimensions.
    pub subscripts: Vec<Subscript>,
    /// Modification arguments.
    pub modification: Vec<Argument>,
    /// String and annotation.
    pub comment: Comment,
}

/// `E = enumeration(a, b)`; `None` for `enumeration(:)`.
#[derive(Debug, Clone, PartialEq)]
pub struct EnumerationClass {
    /// The literals.
    pub literals: Option<Vec<EnumerationLiteral>>,
    /// String and annotation.
    pub comment: Comment,
}

/// One literal of an enumeration.
#[derive(Debug, Clone, PartialEq)]
pub struct EnumerationLiteral {
    /// Its name.
    pub name: Spanned<Ident>,
    /// String and annotation.
    pub comment: Comment,
}

/// `F = der(f, x, y)`.
#[derive(Debug, Clone, PartialEq)]
pub struct DerivativeClass {
    /// The function.
    pub target: TypeSpecifier,
    /// The inputs to differentiate by.
    pub variables: Vec<Spanned<Ident>>,
    /// String and annotation.
    pub comment: Comment,
}

/// `"text" annotation(…)` behind an element, equation or statement.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Comment {
    /// The string.
    pub text: Option<Arc<str>>,
    /// The annotation.
    pub annotation: Option<Annotation>,
}
