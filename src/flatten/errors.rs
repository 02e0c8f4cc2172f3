//! Codes of instantiation and flattening.

crate::codes! {
    /// No class of this name.
    UNKNOWN_CLASS = "unknown-class": "## What it means\n\nNo class of this name is loaded, or none is visible from the place where it is used (MLS §5.3).\n\n## Example\n\n```modelica\nmodel M\n  Resistro r; // no class `Resistro`\nend M;\n```\n\n## What to do\n\nCorrect the name, load the file or library that defines it, or write its full name.",
    /// No component, function or constant of this name.
    UNKNOWN_NAME = "unknown-name": "## What it means\n\nNothing of this name is visible from the place where it is used (MLS §5.3).\n\n## Example\n\n```modelica\nmodel M\n  Real x = 2 * speed; // `speed` is declared nowhere\nend M;\n```\n\n## What to do\n\nCorrect the name or declare it.",
    /// A class that cannot be simulated.
    NOT_A_MODEL = "not-a-model": "## What it means\n\nOnly a model, block or class can be flattened and simulated (MLS §4.6); a package, function, type or connector cannot.\n\n## Example\n\n```text\ngapi flatten P.mo --model P   # `P` is a package\n```\n\n## What to do\n\nName a model, such as one inside of the package.",
    /// A partial class where a complete one is needed.
    PARTIAL_CLASS = "partial-class": "## What it means\n\nA `partial` class is meant to be inherited, not to be used by itself (MLS §4.6).\n\n## Example\n\n```modelica\npartial model Base\nend Base;\nmodel M\n  Base b; // partial\nend M;\n```\n\n## What to do\n\nUse a class that extends it, or redeclare the component.",
    /// A class that inherits from itself.
    CYCLIC_EXTENDS = "cyclic-extends": "## What it means\n\nFollowing the extends clauses of the class leads back to it (MLS §7.1).\n\n## Example\n\n```modelica\nmodel A\n  extends B;\nend A;\nmodel B\n  extends A;\nend B;\n```\n\n## What to do\n\nRemove one of the extends clauses.",
    /// A modification of something final.
    FINAL_OVERRIDE = "final-override": "## What it means\n\nAn element or modifier declared `final` cannot be modified (MLS §7.2.6).\n\n## Example\n\n```modelica\nmodel A\n  final parameter Real p = 1;\nend A;\nmodel M\n  A a(p = 2); // `p` is final\nend M;\n```\n\n## What to do\n\nRemove the modifier, or the `final`.",
    /// A modifier of an element that does not exist.
    UNKNOWN_ELEMENT = "unknown-element": "## What it means\n\nA modifier names an element that the class does not have (MLS §7.2).\n\n## Example\n\n```modelica\nmodel M\n  Real x(strat = 1); // the attribute is called `start`\nend M;\n```\n\n## What to do\n\nCorrect the name.",
    /// A value of the wrong type.
    TYPE_MISMATCH = "type-mismatch": "## What it means\n\nThe type of an expression does not fit where it is used (MLS §6.6).\n\n## Example\n\n```modelica\nmodel M\n  parameter Integer n = \"two\";\nend M;\n```\n\n## What to do\n\nUse an expression of the type that is needed.",
    /// An array of the wrong size.
    SIZE_MISMATCH = "size-mismatch": "## What it means\n\nThe sizes of two arrays that must agree differ (MLS §10.6).\n\n## Example\n\n```modelica\nmodel M\n  parameter Real x[3] = {1, 2};\nend M;\n```\n\n## What to do\n\nMake the sizes agree.",
    /// Numbers of unknowns and equations differ.
    UNBALANCED_MODEL = "unbalanced-model": "## What it means\n\nA model needs as many equations as it has unknowns (MLS §4.8).\n\n## Example\n\n```modelica\nmodel M\n  Real x;\n  Real y;\nequation\n  x + y = 1; // one equation for two unknowns\nend M;\n```\n\n## What to do\n\nAdd the missing equations, or remove those too many; a binding counts as an equation, and so does a connection.",
    /// Modelica that is not supported yet.
    NOT_SUPPORTED = "not-supported": "## What it means\n\nThe construct is Modelica, but this program does not support it.\n\n## Example\n\n```modelica\nconnector Port\n  stream Real h; // stream connectors are not supported\nend Port;\n```\n\n## What to do\n\nWrite the model without it.",
    /// An outer element without an inner one.
    MISSING_INNER = "missing-inner": "## What it means\n\nAn `outer` component or class refers to the `inner` one of the same name in a component that encloses it (MLS §5.4); there is none.\n\n## Example\n\n```modelica\nmodel Cell\n  outer parameter Real T;\nend Cell;\nmodel M\n  Cell c; // `M` has no `inner` element `T`\nend M;\n```\n\n## What to do\n\nDeclare the element with `inner` in the enclosing model.",
    /// A name declared twice.
    DUPLICATE_ELEMENT = "duplicate-element": "## What it means\n\nTwo different elements of a class have the same name (MLS §5.6.1), or an element is modified twice in the same modification (MLS §7.2.2).\n\n## Example\n\n```modelica\nmodel M\n  Real x;\n  Real x;\nend M;\n```\n\n## What to do\n\nRename or remove one of them.",
    /// A declaration that depends on itself.
    CYCLIC_DEFINITION = "cyclic-definition": "## What it means\n\nThe value, size or type of a component is needed to find out itself.\n\n## Example\n\n```modelica\nmodel M\n  parameter Integer n = m;\n  parameter Integer m = n;\n  Real x[n];\nend M;\n```\n\n## What to do\n\nGive one of them a value of its own.",
    /// A structural value that cannot be computed.
    NOT_EVALUABLE = "not-evaluable": "## What it means\n\nAn array size, a range, the condition of a component or another value that shapes the model must be known when the model is built (MLS §4.5, §10.1).\n\n## Example\n\n```modelica\nmodel M\n  parameter Integer n; // no value\n  Real x[n];\nend M;\n```\n\n## What to do\n\nUse constants and parameters with values.",
    /// A binding that may change more often than what it binds.
    VARIABILITY_MISMATCH = "variability-mismatch": "## What it means\n\nThe value of a constant or parameter depends on something that may change more often (MLS §3.8, §4.5).\n\n## Example\n\n```modelica\nmodel M\n  Real x = time;\n  parameter Real p = x;\nend M;\n```\n\n## What to do\n\nRemove the prefix, or use constants and parameters only.",
    /// A modification, redeclaration or class used in a way that the language forbids.
    INVALID_REDECLARATION = "invalid-redeclaration": "## What it means\n\nOnly elements declared `replaceable` can be redeclared, by an element of the same kind (MLS §7.3).\n\n## Example\n\n```modelica\nmodel A\n  Real x;\nend A;\nmodel M\n  A a(redeclare Integer x);\nend M;\n```\n\n## What to do\n\nDeclare the element `replaceable`, or do not redeclare it.",
    /// A connection that the language forbids.
    INVALID_CONNECTION = "invalid-connection": "## What it means\n\n`connect` takes two connectors of the same structure (MLS §9.1, §9.3).\n\n## Example\n\n```modelica\nconnect(resistor.p, resistor.R); // `R` is no connector\n```\n\n## What to do\n\nConnect connectors whose variables have the same names, types and sizes.",
    /// More instances, scalars or levels than the program is willing to make.
    TOO_LARGE = "too-large": "## What it means\n\nThe model has more scalars, components or levels than the program is willing to build. Often a class contains itself.\n\n## Example\n\n```modelica\nmodel M\n  M m;\nend M;\n```\n\n## What to do\n\nReduce the sizes; break the recursion.",
    /// A scalar modifier of an array without `each`.
    MISSING_EACH = "missing-each": "## What it means\n\nA modifier of an array of components gives one value for all of them without `each` (MLS §7.2.5). It is used for every element.\n\n## Example\n\n```modelica\nmodel M\n  Real x[3](start = 1);\nend M;\n```\n\n## What to do\n\nWrite `each`: `Real x[3](each start = 1)`.",
    /// A modifier of an outer component.
    MODIFIED_OUTER = "modified-outer": "## What it means\n\nAn `outer` component is declared elsewhere, so that a binding or modifier of it has no effect (MLS §5.4).\n\n## Example\n\n```modelica\nmodel Cell\n  outer parameter Real T = 300; // ignored\nend Cell;\n```\n\n## What to do\n\nRemove the modifier, or give it to the `inner` component.",
    /// A protected element used from outside.
    PROTECTED_ACCESS = "protected-access": "## What it means\n\nA protected element is used with dot notation from outside of its class, or modified there (MLS §4.1).\n\n## Example\n\n```modelica\nmodel A\nprotected\n  Real x = 1;\nend A;\nmodel M\n  A a;\n  Real y = a.x;\nend M;\n```\n\n## What to do\n\nMake the element public, or do not use it.",
    /// A class that is no function, record, connector … where one is needed.
    WRONG_RESTRICTION = "wrong-restriction": "## What it means\n\nA class of another kind is needed here, or the class holds what its kind may not hold (MLS §4.6).\n\n## Example\n\n```modelica\npackage P\nend P;\nmodel M\n  P p; // a package has no instances\nend M;\n```\n\n## What to do\n\nUse a class of the right kind.",
}
