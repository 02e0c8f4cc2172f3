//! Codes of this stage.

crate::codes! {
    /// A value outside a function's domain.
    DOMAIN_ERROR = "domain-error":
        "## What it means\nDuring the simulation, an operation had no finite result: a logarithm of a number that is not positive, a division by zero, an overflow.\n\n\
         ## Example\n`y = log(1 - x)` once `x` has reached 1.\n\n\
         ## What to do\nLook at the equation named. Keep its argument inside the domain: correct the parameters, or guard it with an if-expression or an `assert`.",
    /// An assert that does not hold.
    ASSERTION_FAILED = "assertion-failed":
        "## What it means\nAn `assert` of the model fails; the simulation stops.\n\n\
         ## Example\n`assert(i < Ilim, \"the current exceeds its limit\");`\n\n\
         ## What to do\nThe text comes from the author of the model; check parameters and inputs.",
    /// A simulation that could not be finished.
    SIMULATION_FAILED = "simulation-failed":
        "## What it means\nThe simulation could not be completed: the step size became too small, an algebraic loop did not converge, or a limit was reached.\n\n\
         ## Example\nThe solution grows without bound at this time.\n\n\
         ## What to do\nCheck the time and the equations in the message; first check parameters and start values; loosen the tolerance last.",
    /// A relation that would cause events without end.
    CHATTERING = "chattering":
        "## What it means\nA relation is chattering: it would switch repeatedly at one point. The simulation continues: the relation is evaluated between steps, or the solution slides along it with the mean of both branches (sliding mode, Filippov), or it stays at rest where impacts accumulate (Zeno behaviour).\n\n\
         ## Example\n`der(x) = if x > 0 then -1 else 1` stays at `x = 0`.\n\n\
         ## What to do\nNothing, if the model intends it. Otherwise use a hysteresis, `smooth` or `noEvent`; another method or tolerance does not help.",
    /// Initial values that could not be found.
    INITIALIZATION_FAILED = "initialization-failed":
        "## What it means\nNo consistent values could be found for the start of the simulation.\n\n\
         ## Example\nA nonlinear equation whose variables have no good start values.\n\n\
         ## What to do\nGive the variables listed `start` values near the solution.",
    /// Equations that depend on each other and leave unknowns open.
    UNDETERMINED = "undetermined":
        "## What it means\nThe model has as many equations as unknowns, but some equations follow from others, so they do not determine the unknowns listed. The equations are consistent, and the simulation continues. Of the solutions of a linear loop, it uses the one with the smallest values (minimum norm); of those of a nonlinear loop at the start, one near the start values.\n\n\
         ## Example\n`a + b = 1; 2*a + 2*b = 2;` holds for any `a`.\n\n\
         ## What to do\nReplace the redundant equation by one that determines the unknowns: a ground, a reference value, another load path. Until then, the values of the unknowns listed, and all values that depend on them, are meaningless.",
    /// A model that has no linear part.
    NOT_LINEARIZED = "not-linearized":
        "## What it means\nThe model cannot be linearized as a system from the input to the output: its states determine the input, it chooses its states at run time, or an equation depends on a derivative of the input that the linear system does not have.\n\n\
         ## Example\nThe voltage of a capacitor as an input, where the current is the output.\n\n\
         ## What to do\nTake the other variable of the connection as the input, or filter the input with a first-order block.",
    /// A model whose states a Kalman filter cannot move.
    NO_FILTER = "no-filter":
        "## What it means\nProcess noise is requested for a model that a Kalman filter cannot follow: noise acts on a variable that is not a state, `reinit` sets an uncertain state, a discrete variable keeps a value of uncertain states, or the model has delays or chooses its states at run time.\n\n\
         ## Example\n`[noise]` for the position of a ball whose velocity `reinit` reverses.\n\n\
         ## What to do\nGive noise to states alone, and describe what happens at events by continuous equations.",
    /// A variable that the model does not have.
    UNKNOWN_VARIABLE = "unknown-variable":
        "## What it means\nThe model has no variable of this name.\n\n\
         ## Example\nAsking for `Cell.v` where the model declares `cell.v`.\n\n\
         ## What to do\nUse a name that the model declares; names are case-sensitive.",
    /// A parameter that the model does not have.
    UNKNOWN_PARAMETER = "unknown-parameter":
        "## What it means\nThe model has no parameter of this name.\n\n\
         ## Example\nSetting `r` where the model declares `R`.\n\n\
         ## What to do\nUse a name that the model declares; names are case-sensitive.",
    /// A parameter that cannot be set without compiling again.
    STRUCTURAL_PARAMETER = "structural-parameter":
        "## What it means\nThe parameter is structural, that is, evaluated at translation (an array size, a selected branch), or it is final. It is fixed at translation.\n\n\
         ## Example\nIdentifying the number of control volumes `n`.\n\n\
         ## What to do\nSet a structural parameter with a modification, `model = \"M(n = 3)\"`; a final one cannot be changed.",
}
