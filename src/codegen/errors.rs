//! Codes of this stage.

crate::codes! {
    /// A value outside a function's domain.
    DOMAIN_ERROR = "domain-error":
        "## What it means\nDuring the simulation an operation had no finite value: a logarithm of a number that is not positive, a division by zero, an overflow.\n\n\
         ## Example\n`y = log(1 - x)` once `x` has reached 1.\n\n\
         ## What to do\nLook at the equation named. Keep its argument inside the domain: correct the parameters, or guard it with an if-expression or an `assert`.",
    /// An assert that does not hold.
    ASSERTION_FAILED = "assertion-failed":
        "## What it means\nAn `assert` of the model does not hold; the simulation cannot go on.\n\n\
         ## Example\n`assert(i < Ilim, \"the current exceeds its limit\");`\n\n\
         ## What to do\nThe text is the model author's; check parameters and inputs.",
    /// A simulation that could not be finished.
    SIMULATION_FAILED = "simulation-failed":
        "## What it means\nThe simulation could not be finished: the step became too small, a loop did not converge, or a budget is used up.\n\n\
         ## Example\nA pole of the solution at the time named.\n\n\
         ## What to do\nLook at the time and the equations named; loosen the tolerance, give start values, or check the parameters.",
    /// A relation that would cause events without end.
    CHATTERING = "chattering":
        "## What it means\nA relation would switch again and again at one place. The simulation goes on: the relation is evaluated between steps, or the solution slides along it with the mean of both branches (Filippov), or it rests where impacts have accumulated.\n\n\
         ## Example\n`der(x) = if x > 0 then -1 else 1` stays at `x = 0`.\n\n\
         ## What to do\nNothing, if this is what the model means. Otherwise write a hysteresis, `smooth` or `noEvent`; `method` and tolerance do not change it.",
    /// Initial values that could not be found.
    INITIALIZATION_FAILED = "initialization-failed":
        "## What it means\nNo consistent values could be found for the start of the simulation.\n\n\
         ## Example\nA nonlinear equation whose variables have no good start values.\n\n\
         ## What to do\nGive the variables named `start` values near the solution.",
    /// Equations that depend on each other and leave unknowns open.
    UNDETERMINED = "undetermined":
        "## What it means\nThe model has as many equations as unknowns, but some of the equations follow from others, so that they do not determine the unknowns named. They agree with each other, and the simulation goes on: of all solutions of a linear loop it takes the one of least norm (in all of its unknowns, of which those that are equal count once, if the loop is singular with the default parameters and not only at times, else in its tearing variables), of a nonlinear loop at the start the one near the start values.\n\n\
         ## Example\n`a + b = 1; 2*a + 2*b = 2;` holds for any `a`.\n\n\
         ## What to do\nReplace the redundant equation by one that determines the unknowns: a ground, a reference value, another load path. Values of the unknowns named mean nothing before that, and what depends on them neither.",
    /// A variable that the model does not have.
    UNKNOWN_VARIABLE = "unknown-variable":
        "## What it means\nThe model has no variable of this name.\n\n\
         ## Example\nAsking for `Cell.v` where the model declares `cell.v`.\n\n\
         ## What to do\nUse a name that the model declares; capital letters count.",
    /// A parameter that the model does not have.
    UNKNOWN_PARAMETER = "unknown-parameter":
        "## What it means\nThe model has no parameter of this name.\n\n\
         ## Example\nSetting `r` where the model declares `R`.\n\n\
         ## What to do\nUse a name that the model declares; capital letters count.",
    /// A parameter that cannot be set without compiling again.
    STRUCTURAL_PARAMETER = "structural-parameter":
        "## What it means\nThe parameter shaped the compiled model (an array size, a chosen branch) or is final, so it has no slot to write to.\n\n\
         ## Example\nIdentifying the number of control volumes `n`.\n\n\
         ## What to do\nChange it with a modification when translating the model.",
}
