//! Codes of this stage.

crate::codes! {
    /// Not as many equations as unknowns.
    UNBALANCED_MODEL = "unbalanced-model":
        "## What it means\nThe model has not as many equations as unknowns, so it has no solution or many.\n\n\
         ## Example\n`model M Real x; Real y; equation x = 1; end M;` has two unknowns and one equation.\n\n\
         ## What to do\nAdd an equation for the variables named, give one a binding, or remove one of the equations named.",
    /// As many equations as unknowns, but they do not determine each other.
    SINGULAR_SYSTEM = "singular-system":
        "## What it means\nThe numbers of equations and unknowns agree, but some variables are determined by no equation while others are determined by too many.\n\n\
         ## Example\n`x = 1; x = 2;` with unknowns `x` and `y`.\n\n\
         ## What to do\nLook at the equations and variables named: one equation is superfluous, and another is missing.",
    /// Something of the language that the compiler cannot treat.
    NOT_SUPPORTED = "not-supported":
        "## What it means\nThe model uses a part of the language that this program does not treat in equations. It refuses rather than giving wrong numbers.\n\n\
         ## Example\n`y = spatialDistribution(…);`\n\n\
         ## What to do\nWrite the model without it; the message names the place and the reason.",
    /// A parameter that depends on itself.
    PARAMETER_CYCLE = "parameter-cycle":
        "## What it means\nThe bindings of parameters depend on each other in a circle, so none can be computed.\n\n\
         ## Example\n`parameter Real a = b; parameter Real b = a;`\n\n\
         ## What to do\nGive one of the parameters named a value of its own.",
    /// A parameter without a value.
    PARAMETER_WITHOUT_VALUE = "parameter-without-value":
        "## What it means\nA parameter that the equations use has neither a binding nor a start value.\n\n\
         ## Example\n`parameter Real R; equation v = R*i;`\n\n\
         ## What to do\nGive the parameter a value in its declaration or in a modification.",
    /// An array of the wrong size, a subscript outside, an operand of the wrong kind.
    ARRAY_MISMATCH = "array-mismatch":
        "## What it means\nThe sizes of arrays do not fit each other, or a subscript lies outside its array.\n\n\
         ## Example\n`{1, 2} + {1, 2, 3}`\n\n\
         ## What to do\nCompare the sizes named with the declarations.",
    /// A name that the flat model does not hold.
    UNRESOLVED_REFERENCE = "unresolved-reference":
        "## What it means\nAn equation refers to a variable or function that the flat model does not hold.\n\n\
         ## Example\nAn equation uses `y` where only `x` is declared.\n\n\
         ## What to do\nDeclare the variable or the function, or correct its name.",
    /// A binding of a constant, an array size or a start value that is no number.
    NO_CONSTANT_VALUE = "no-constant-value":
        "## What it means\nA range, a subscript or a size in an equation must be known when the model is compiled, and this one is not.\n\n\
         ## Example\n`fill(0.0, n)` where `n` is a variable, or `x[n]` where it varies between events.\n\n\
         ## What to do\nUse a constant, or a parameter that is `final` or has `annotation(Evaluate = true)`.",
    /// Start values that are not fixed are taken as if they were.
    MISSING_INITIAL_CONDITION = "missing-initial-condition":
        "## What it means\nThe initial equations and fixed start values of a model do not determine all its states, so the start values of the states named hold although they are not fixed.\n\n\
         ## Example\n`Real x(start = 1, fixed = true); Real y(start = 2);` with `der(x) = y; der(y) = -x;`: nothing fixes `y`.\n\n\
         ## What to do\nGive the variables named `fixed = true`, or write an initial equation for each.",
}
