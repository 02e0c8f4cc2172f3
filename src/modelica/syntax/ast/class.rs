//! Classes and all that they contain (MLS §A.2.1 to §A.2.6): components, modifications, equations
//! and statements. Any of them may carry an annotation, whose modifications may redeclare classes:
//! one recursive tree.

use super::{ComponentReference, Expression, ForIndex, Subscript};
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::lazy::Lazy;
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

/// The sections of a long class. Those of a class of a lazily read file are read at the first
/// access.
pub type Sections = Lazy<Section>;

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
    /// What follows the name.
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

impl Restriction {
    /// The keyword, without prefixes of functions.
    pub fn keyword(self) -> &'static str {
        match self {
            Restriction::Class => "class",
            Restriction::Model => "model",
            Restriction::Block => "block",
            Restriction::Record => "record",
            Restriction::OperatorRecord => "operator record",
            Restriction::Connector => "connector",
            Restriction::ExpandableConnector => "expandable connector",
            Restriction::Type => "type",
            Restriction::Package => "package",
            Restriction::Operator => "operator",
            Restriction::Function { .. } => "function",
        }
    }
}

/// `pure` or `impure` (MLS §12.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Purity {
    /// Same inputs, same outputs, no effects.
    Pure,
    /// Anything else.
    Impure,
}

/// What follows a class's name (`class-specifier`).
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
    /// The description string after the name.
    pub description: Option<Arc<str>>,
    /// Sections in the order written; the first is [`Section::Elements`] without a keyword, if
    /// anything precedes the first keyword.
    pub sections: Sections,
    /// The name after `end`.
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
    /// Its description string and annotation.
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
    /// Its modification (no binding); those excluded by `break` (selective model extension, MLS
    /// §7.4) are in [`Extends::excluded`].
    pub modification: Vec<Argument>,
    /// `break name` and `break connect(a, b)` (MLS §7.4).
    pub excluded: Vec<Exclusion>,
    /// `annotation(…)`.
    pub annotation: Option<Annotation>,
    /// The whole clause.
    pub span: Span,
}

/// Something that an extends clause leaves out.
#[derive(Debug, Clone, PartialEq)]
pub enum Exclusion {
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
    /// Its description string and annotation.
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

/// `"description" annotation(…)` after an element, equation or statement.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Comment {
    /// The string.
    pub text: Option<Arc<str>>,
    /// The annotation.
    pub annotation: Option<Annotation>,
}

/// `parameter Real x[3](start = 1) = y if c "text", z;`
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentClause {
    /// `redeclare final inner outer replaceable`.
    pub prefixes: ElementPrefixes,
    /// `flow`, `parameter`, `input`, ….
    pub type_prefixes: TypePrefixes,
    /// The type.
    pub type_specifier: TypeSpecifier,
    /// Dimensions written after the type.
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
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
    /// Dimensions written after the name.
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

/// `(a = 1, b(c = 2)) = e`: arguments, a binding, or both.
#[derive(Debug, Clone, PartialEq)]
pub struct Modification {
    /// The contents of the parentheses, in order.
    pub arguments: Vec<Argument>,
    /// What follows `=` or `:=`.
    pub binding: Option<Binding>,
    /// The whole modification.
    pub span: Span,
}

/// What follows the `=` of a modification.
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
    /// Its description string.
    pub description: Option<Arc<str>>,
    /// The whole argument.
    pub span: Span,
}

/// `redeclare each final replaceable …`.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementRedeclaration {
    /// `each`
    pub each: bool,
    /// What is redeclared; its prefixes contain `redeclare`, `final` and `replaceable`.
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

/// An equation with its comment.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// What it says.
    pub kind: EquationKind,
    /// String and annotation.
    pub comment: Comment,
    /// The equation without its semicolon.
    pub span: Span,
}

/// The forms of equations.
#[derive(Debug, Clone, PartialEq)]
pub enum EquationKind {
    /// `a = b`
    Equal {
        /// Left side.
        left: Expression,
        /// Right side.
        right: Expression,
    },
    /// `if c then … elseif … else … end if`
    If {
        /// Conditions with their equations.
        branches: Vec<(Expression, Vec<Equation>)>,
        /// Equations after `else`; empty without it.
        otherwise: Vec<Equation>,
    },
    /// `for i in 1:n loop … end for`
    For {
        /// Loop variables.
        indices: Vec<ForIndex>,
        /// The equations.
        body: Vec<Equation>,
    },
    /// `connect(a, b)`
    Connect {
        /// First connector.
        left: ComponentReference,
        /// Second connector.
        right: ComponentReference,
    },
    /// `when c then … elsewhen … end when`
    When {
        /// Conditions with their equations.
        branches: Vec<(Expression, Vec<Equation>)>,
    },
    /// A call without a value: `assert(…)`, `terminate(…)`, `reinit(…)`, `Connections.root(…)`;
    /// always an [`ExpressionKind::Call`](super::ExpressionKind::Call).
    Call(Expression),
}

/// A statement with its comment.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// What it does.
    pub kind: StatementKind,
    /// String and annotation.
    pub comment: Comment,
    /// The statement without its terminator.
    pub span: Span,
}

/// The forms of statements.
#[derive(Debug, Clone, PartialEq)]
pub enum StatementKind {
    /// `a := e`
    Assign {
        /// Left side.
        target: ComponentReference,
        /// Right side.
        value: Expression,
    },
    /// `(a, , b) := f(x)`
    MultiAssign {
        /// Left sides; `None` where an output is skipped.
        targets: Vec<Option<ComponentReference>>,
        /// The call; in a script any expression, so that `(a, b) := (1, 2)` can be refused by name.
        value: Expression,
    },
    /// A call whose value is not used; in a script any expression.
    Call(Expression),
    /// `if c then … end if`
    If {
        /// Conditions with their statements.
        branches: Vec<(Expression, Vec<Statement>)>,
        /// Statements after `else`; empty without it.
        otherwise: Vec<Statement>,
    },
    /// `for i in 1:n loop … end for`
    For {
        /// Loop variables.
        indices: Vec<ForIndex>,
        /// The statements.
        body: Vec<Statement>,
    },
    /// `while c loop … end while`
    While {
        /// Condition.
        condition: Expression,
        /// The statements.
        body: Vec<Statement>,
    },
    /// `when c then … elsewhen … end when`
    When {
        /// Conditions with their statements.
        branches: Vec<(Expression, Vec<Statement>)>,
    },
    /// `break`
    Break,
    /// `return`
    Return,
}
