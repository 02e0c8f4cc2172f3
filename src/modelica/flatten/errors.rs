//! Codes of this stage.

use crate::codes;

codes! {
    /// A class that nothing declares.
    UNKNOWN_CLASS = "unknown-class":
        "## What it means\n\nA class is not loaded, or not visible in the scope where it is used (MLS §5.3).\n\n## Example\n\n```modelica\nmodel M\n  Resistr r;\nend M;\n```\n\n## What to do\n\nCorrect the name, or load the file that declares the class: `openModel(\"file.mo\")` in a script, the file on the command line, or `--library DIR`.",
    /// A name that is neither a component nor a constant nor a function.
    UNKNOWN_NAME = "unknown-name":
        "## What it means\n\nAn expression uses a name that is neither a component of its class nor a constant or function of a package (MLS §5.3).\n\n## Example\n\n```modelica\nmodel M\n  Real x;\nequation\n  der(x) = -k*x;\nend M;\n```\n\n## What to do\n\nDeclare it, or correct its name.",
    /// A modifier of a component that does not exist.
    UNKNOWN_ELEMENT = "unknown-element":
        "## What it means\n\nA modification names an element that the modified class does not have (MLS §7.2).\n\n## Example\n\n`Resistor r(Rr = 2);`\n\n## What to do\n\nCorrect the name; the message suggests the nearest one.",
    /// Something that is not a model was to be simulated.
    NOT_A_MODEL = "not-a-model":
        "## What it means\n\nOnly a model, a block or a class can be simulated; packages, functions, records, types and connectors cannot.\n\n## Example\n\n`simulateModel(\"CaseStudies\")`\n\n## What to do\n\nName a model inside the package.",
    /// A partial class was to be instantiated.
    PARTIAL_CLASS = "partial-class":
        "## What it means\n\nA `partial` class is intentionally incomplete and cannot be instantiated (MLS §4.7).\n\n## Example\n\n```modelica\npartial model P\n  Real x;\nend P;\n```\n\n## What to do\n\nUse a class that extends it.",
    /// A class that extends or contains itself.
    CYCLIC_CLASS = "cyclic-class":
        "## What it means\n\nA class extends itself or contains a component of its own class, directly or through others.\n\n## Example\n\n```modelica\nmodel M\n  M m;\nend M;\n```\n\n## What to do\n\nBreak the cycle.",
    /// A modification of something final.
    FINAL_OVERRIDE = "final-override":
        "## What it means\n\nAn element or attribute declared `final` cannot be modified (MLS §7.2.6).\n\n## Example\n\n`type Voltage = Real(final unit = \"V\"); Voltage v(unit = \"mV\");`\n\n## What to do\n\nRemove the modifier.",
    /// A protected component used from outside.
    PROTECTED_ACCESS = "protected-access":
        "## What it means\n\nA component declared after `protected` is used outside its class, where only public components are visible (MLS §4.1).\n\n## Example\n\n```modelica\nmodel A\nprotected\n  Real x = 1;\nend A;\nmodel M\n  A a;\n  Real y = a.x;\nend M;\n```\n\n## What to do\n\nUse a public variable, or move the declaration before `protected`.",
    /// A value of the wrong type.
    TYPE_MISMATCH = "type-mismatch":
        "## What it means\n\nThe type of a value does not match its context (MLS §6.7).\n\n## Example\n\n`parameter Integer n = 1.5;`\n\n## What to do\n\nGive a value of the type that the message names.",
    /// Sizes that differ.
    SIZE_MISMATCH = "size-mismatch":
        "## What it means\n\nThe size of an array does not match its declaration or its equation (MLS §10.1, §10.6).\n\n## Example\n\n`Real x[3] = {1, 2};`\n\n## What to do\n\nUse matching sizes.",
    /// Something needed at translation that is not constant.
    NOT_CONSTANT = "not-constant":
        "## What it means\n\nAn array size, a loop's range or a constant must be known when the model is translated, but the expression is not.\n\n## Example\n\n`Real x[integer(time)];`\n\n## What to do\n\nUse constants and parameters with values.",
    /// Without a value of a parameter, constant or array the structure of the model is open.
    VALUE_NEEDED = "value-needed":
        "## What it means\n\nA parameter or constant has no value, but the structure of the model depends on it: an array size, a condition of a component, a loop's range. Or an array that is declared with `[:]` has no value that gives its size. A parameter that has a start value takes that one, with a warning (MLS §8.6).\n\n## Example\n\n`parameter Integer n; Real x[n];`\n\n## What to do\n\nGive it a value in its declaration, or by a modifier where the class is used.",
    /// An `outer` component without its `inner` one.
    MISSING_INNER = "missing-inner":
        "## What it means\n\nAn `outer` component refers to the `inner` component of the same name in a model around it (MLS §5.4), and there is none. Where the class of the component allows it, the model gets one with default values.\n\n## Example\n\n`outer World world;` in a part, which is used in a model without `inner World world;`.\n\n## What to do\n\nDeclare the component with `inner` in the model.",
    /// An element declared twice with different declarations.
    DUPLICATE_ELEMENT = "duplicate-element":
        "## What it means\n\nA class has two elements with the same name (MLS §7.1).\n\n## Example\n\n`Real x; Real x;`\n\n## What to do\n\nRename or remove one of them.",
    /// A connection that cannot be made.
    INVALID_CONNECTION = "invalid-connection":
        "## What it means\n\nA `connect` equation is invalid: the connectors have different types or sizes, an argument is not a connector, or connections are not allowed at this place (MLS §9.3).\n\n## Example\n\n`connect(resistor.p, thermometer.port)` where one is an electrical pin and the other a heat port.\n\n## What to do\n\nConnect connectors with the same components, at the level of equations of a class.",
    /// A name that the language keeps for itself.
    RESERVED_NAME = "reserved-name":
        "## What it means\n\nAn element has the name of a predefined type (MLS §4.9), or an enumeration literal that of an attribute of enumerations (§4.9.5).\n\n## Example\n\n```modelica\nmodel M\n  parameter Boolean Real = true;\nend M;\n```\n\n## What to do\n\nChoose another name.",
    /// A specialized class with contents that it cannot have.
    CLASS_RESTRICTION = "class-restriction":
        "## What it means\n\nA record, connector, block, package, type or operator contains an element that its kind of class cannot have (MLS §4.7): equations in a record, variables in a package, acausal connectors in a block.\n\n## Example\n\n```modelica\nrecord R\n  Real x;\nequation\n  x = 1;\nend R;\n```\n\n## What to do\n\nMove it elsewhere, or change the kind of class: a model can contain everything.",
    /// A prefix where it has no meaning.
    ILLEGAL_PREFIX = "illegal-prefix":
        "## What it means\n\nA component has a prefix that its type cannot have, or two prefixes contradict each other (MLS §4.4.2.2, §9.3, §15.1).\n\n## Example\n\n```modelica\nconnector C\n  flow Boolean on;\nend C;\n```\n\n## What to do\n\nRemove the prefix, or change the declaration of the component.",
    /// A class that cannot be extended, or not together with what else there is.
    ILLEGAL_EXTENDS = "illegal-extends":
        "## What it means\n\nA class extends one that cannot be extended here: a replaceable class (MLS §7.1.4), an operator record (§14.1), or, beside other contents, an array class, a class with a prefix or a predefined type (§4.6.2).\n\n## Example\n\n```modelica\nmodel M\n  extends Modelica.Units.SI.Voltage;\n  Real x;\nend M;\n```\n\n## What to do\n\nDeclare a component of that class instead.",
    /// An import clause that cannot be.
    ILLEGAL_IMPORT = "illegal-import":
        "## What it means\n\nAn import clause imports from a class that is not a package, or two import clauses import the same name (MLS §13.2).\n\n## Example\n\n```modelica\nimport Modelica.Math.sin;\nimport sin = MyLibrary.sin;\n```\n\n## What to do\n\nRename one of the imports, or move the imported element into a package.",
    /// A name that accesses a class that cannot be accessed.
    ILLEGAL_ACCESS = "illegal-access":
        "## What it means\n\nA qualified name accesses an element that is not encapsulated in a class that is not a package (MLS §5.3.2), or an element of a partial class.\n\n## Example\n\n```modelica\nmodel A\n  Real x = 1;\n  model B\n    Real y = 2;\n  end B;\nend A;\nmodel M\n  A.B b;\nend M;\n```\n\n## What to do\n\nMove the element into a package, or declare it `encapsulated`.",
    /// An operator function that no operator can call.
    ILLEGAL_OPERATOR = "illegal-operator":
        "## What it means\n\nA function of an operator record has inputs or outputs that do not match its operator, or two functions match the same call (MLS §14.2 to §14.5).\n\n## Example\n\n```modelica\noperator record Pair\n  Real a;\n  encapsulated operator function '+'\n    import Pair;\n    input Pair x;\n    output Pair y = x;\n  end '+';\nend Pair;\n```\n\n## What to do\n\nGive it the inputs and the one output of its operator.",
    /// A redeclaration of something that cannot be redeclared, or not so.
    ILLEGAL_REDECLARATION = "illegal-redeclaration":
        "## What it means\n\nA redeclaration replaces an element that is not replaceable, or a constant, or it makes a protected element public or a public one protected (MLS §7.3).\n\n## Example\n\n```modelica\nmodel A\n  Real x = 1;\nend A;\nmodel M\n  A a(redeclare Integer x);\nend M;\n```\n\n## What to do\n\nDeclare the element `replaceable`, or modify it without `redeclare`.",
    /// A conditional component used where it may be absent.
    CONDITIONAL_COMPONENT = "conditional-component":
        "## What it means\n\nA conditional component is used in an equation or an expression; it would not exist if its condition were false. It can only be connected, modified, and used in modifiers of other conditional components (MLS §4.4.5).\n\n## Example\n\n```modelica\nmodel M\n  parameter Boolean on = true;\n  Real x if on;\nequation\n  x = 1;\nend M;\n```\n\n## What to do\n\nMake the variable a connector and connect it, or declare it without a condition.",
    /// An argument that an operator cannot have.
    ILLEGAL_ARGUMENT = "illegal-argument":
        "## What it means\n\nAn operator has an argument of the wrong kind: `der` of something that is not a continuous Real variable, `reinit` of a parameter, `sample` or `delay` with times that change during the simulation, `inStream` of a variable that is not a stream variable (MLS §3.7, §15.2).\n\n## Example\n\n```modelica\nmodel M\n  Integer n = 1;\n  Real x = der(n);\nend M;\n```\n\n## What to do\n\nUse an argument of the kind that the operator requires.",
    /// An equation or a statement in a place where it has no meaning.
    MISPLACED = "misplaced-equation":
        "## What it means\n\nAn equation or a statement is not allowed at this place: a when-clause inside another one or in a function (MLS §8.3.5.2, §12.2), `connect` in a when-clause or under a condition that changes during the simulation (§9.1), `break` outside a loop (§11.2.4), `return` outside a function (§11.2.5).\n\n## Example\n\n```modelica\nwhen x > 1 then\n  when y > 1 then\n    n = pre(n) + 1;\n  end when;\nend when;\n```\n\n## What to do\n\nMove it to a place where it is allowed; combine the conditions of nested when-clauses.",
    /// A part of the language that is not built yet.
    NOT_SUPPORTED = "unsupported-language":
        "## What it means\n\nThe model uses a valid part of Modelica that this program does not translate yet. The message names it.\n\n## Example\n\n`Real x = tick();`, where `tick` is an impure function\n\n## What to do\n\nRewrite the model without it.",
    /// A class that is balanced only together with others.
    UNBALANCED_CLASS = "unbalanced-class":
        "## What it means\n\nA class used in the model is not locally balanced: the numbers of its equations and unknowns differ, where its connectors contribute one equation for each flow variable and each input (MLS §4.8). The model as a whole is balanced and can be simulated, but the class cannot be used elsewhere. Libraries from before Modelica 3 do not follow this rule; the warning is given once for each library.\n\n## Example\n\n```modelica\nmodel A\n  Real x;\nend A;\nmodel M\n  A a;\nequation\n  a.x = 1;\nend M;\n```\n\n## What to do\n\nGive the class the equations for its own variables, or declare variables determined from outside as inputs.",
    /// Units that do not fit.
    INCONSISTENT_UNITS = "inconsistent-units":
        "## What it means\n\nThe operands of a sum or a relation, the sides of an equation, or a variable and its value have units of different dimensions (MLS ch. 19). Only dimensions are compared, not factors such as that of `kPa`; numbers, `time` and variables without `unit` match every unit. The model is simulated nevertheless; for a library in old Modelica the warning is given once.\n\n## Example\n\n```modelica\nmodel M\n  Real v(unit = \"m/s\") = 1;\n  Real a(unit = \"m/s2\") = v;\nend M;\n```\n\n## What to do\n\nCorrect the equation or the unit.",
    /// A number of equations other than that of unknowns.
    UNBALANCED_MODEL = "unbalanced-model":
        "## What it means\n\nThe numbers of equations and unknowns of a model differ (MLS §4.8).\n\n## Example\n\n```modelica\nmodel M\n  Real x;\n  Real y;\nequation\n  x = 1;\nend M;\n```\n\n## What to do\n\nAdd the missing equations, or remove the redundant ones.",
    /// A model larger than the program is ready to build.
    TOO_LARGE = "too-large":
        "## What it means\n\nThe model has more variables or deeper nesting than the program allows.\n\n## Example\n\n`Real x[100000, 100000];`\n\n## What to do\n\nCheck the array sizes; a missing factor or a wrong unit can make them very large.",
    /// What an old library does otherwise (a warning).
    OLD_LIBRARY = "old-library":
        "## What it means\n\nA library uses legacy constructs that current Modelica does not allow: files without `within`, folders or files whose names differ from their contents (MLS §13.4), annotations anywhere in a class, graphics of Modelica 1 or 2, values of `outer` components (§5.4). The library works nevertheless. The warning is given once for each library and construct, at the first occurrence.\n\n## Example\n\nA folder `CaseStudies` whose `package.mo` has `package casestudies`.\n\n## What to do\n\nNothing, or follow the message in all files of the library.",
    /// A conversion of a library to newer versions of those that it uses.
    CONVERSION = "conversion":
        "## What it means\n\nA library says by `uses` that it was written for an older version of another one, and the rules by which the newer version converts it (MLS §18.8) are not there, are no rules, or say that it cannot be converted.\n\n## Example\n\n`convertMessage(\"Pumps.Old\", \"use Pumps.New, which needs a nominal flow\")` in the conversion script of a library, and a model with `Pumps.Old pump`.\n\n## What to do\n\nFollow the message, or load the version that the library was written for.",
}
