//! Codes of this stage.

crate::codes! {
    /// The numbers of equations and unknowns differ.
    UNBALANCED_MODEL = "unbalanced-model":
        "## What it means\nThe numbers of equations and unknowns of the model differ, so it has no solution or many solutions.\n\n\
         ## Example\n`model M Real x; Real y; equation x = 1; end M;` has two unknowns and one equation.\n\n\
         ## What to do\nAdd an equation for one of the variables listed, give it a binding, or remove one of the equations listed.",
    /// As many equations as unknowns, but they do not determine each other.
    SINGULAR_SYSTEM = "singular-system":
        "## What it means\nThe model is structurally singular: the numbers of equations and unknowns agree, but no equation determines some of the variables, while too many determine others.\n\n\
         ## Example\n`x = 1; x = 2;` with unknowns `x` and `y`.\n\n\
         ## What to do\nCheck the equations and variables listed: one equation is redundant, and another is missing.",
    /// Something of the language that the compiler cannot treat.
    NOT_SUPPORTED = "not-supported":
        "## What it means\nThe model uses a part of the language that this program does not support in equations. It reports an error rather than wrong numbers.\n\n\
         ## Example\n`Clock(Clock(1, 10), \"ExplicitRungeKutta4\")`\n\n\
         ## What to do\nRewrite the model without it; the message gives the position and the reason.",
    /// An input that nothing determines.
    INPUT_WITHOUT_DATA = "input-without-data":
        "## What it means\nAn input of the model has neither a connection nor data, and keeps its start value.\n\n\
         ## Example\n`model M input Real u; Real x; equation der(x) = u; end M;` is simulated without data for `u`.\n\n\
         ## What to do\nGive it data with `inputs` of a problem file or `gapi simulate --input`, or connect it.",
    /// Clocks that do not go together, or one that nothing gives.
    CLOCK_CONFLICT = "clock-conflict":
        "## What it means\nThe clocks of a model cannot be inferred, or contradict each other: variables in one equation belong to one clock, and what is clocked meets continuous time only through `sample` and `hold`.\n\n\
         ## Example\n`y = sample(u, Clock(1, 10)) + sample(v, Clock(1, 3));`\n\n\
         ## What to do\nUse one clock for both, or `subSample`, `superSample` and `shiftSample` between clocks of one base, and `hold` and `sample` between others.",
    /// A state machine that breaks the rules of MLS §17.1.
    INVALID_STATE_MACHINE = "invalid-state-machine":
        "## What it means\nThe equations `transition` and `initialState` do not make a state machine: it must have exactly one initial state, and all transitions that leave one state must have different priorities. `activeState`, `ticksInState` and `timeInState` are about states of state machines only.\n\n\
         ## Example\n`initialState(a); initialState(b); transition(a, b, x > 1);`\n\n\
         ## What to do\nRemove or add `initialState`, or give each transition its `priority`.",
    /// A parameter that depends on itself.
    PARAMETER_CYCLE = "parameter-cycle":
        "## What it means\nThe bindings of parameters form a cycle, so none can be computed.\n\n\
         ## Example\n`parameter Real a = b; parameter Real b = a;`\n\n\
         ## What to do\nGive one of the parameters listed an independent value.",
    /// A parameter without a value.
    PARAMETER_WITHOUT_VALUE = "parameter-without-value":
        "## What it means\nA parameter that the equations use has neither a binding nor a start value.\n\n\
         ## Example\n`parameter Real R; equation v = R*i;`\n\n\
         ## What to do\nGive the parameter a value in its declaration or in a modification.",
    /// An array of the wrong size, a subscript outside, an operand of the wrong kind.
    ARRAY_MISMATCH = "array-mismatch":
        "## What it means\nThe sizes of arrays do not match, or a subscript is out of range.\n\n\
         ## Example\n`{1, 2} + {1, 2, 3}`\n\n\
         ## What to do\nCompare the sizes in the message with the declarations.",
    /// A name that the flat model does not hold.
    UNRESOLVED_REFERENCE = "unresolved-reference":
        "## What it means\nAn equation refers to a variable or function that is not in the flat model.\n\n\
         ## Example\nAn equation uses `y` where only `x` is declared.\n\n\
         ## What to do\nDeclare the variable or the function, or correct its name.",
    /// A binding of a constant, an array size or a start value that is not a number.
    NO_CONSTANT_VALUE = "no-constant-value":
        "## What it means\nA range, a subscript or a size in an equation must be known when the model is translated, but this one is not.\n\n\
         ## Example\n`fill(0.0, n)` where `n` is a variable, or `x[n]` where it varies between events.\n\n\
         ## What to do\nUse a constant, or a parameter that is `final` or has `annotation(Evaluate = true)`.",
    /// Start values that are not fixed are taken as if they were.
    MISSING_INITIAL_CONDITION = "missing-initial-condition":
        "## What it means\nThe initial equations and fixed start values do not determine all states of the model, so the start values of the states listed are used although they are not fixed.\n\n\
         ## Example\n`Real x(start = 1, fixed = true); Real y(start = 2);` with `der(x) = y; der(y) = -x;`: nothing fixes `y`.\n\n\
         ## What to do\nSet `fixed = true` for the variables listed, or write an initial equation for each.",
    /// An attribute `stateSelect` that cannot be obeyed.
    STATE_SELECT = "state-select":
        "## What it means\nThe choice of states cannot obey an attribute `stateSelect` (MLS §4.9.7.1): a variable with `StateSelect.never` is the only one that can be a state, or one with `StateSelect.always` cannot be a state, because its derivative does not occur.\n\n\
         ## Example\n`Real x(stateSelect = StateSelect.never); equation der(x) = 1;`\n\n\
         ## What to do\nRemove the attribute, or write the equations so that the variables that are to be states are differentiated, and others are not.",
    /// What is discrete, but not by a discrete-time expression.
    NOT_DISCRETE = "not-discrete":
        "## What it means\nAn Integer, Boolean or enumeration variable, or a variable of a when-clause, must have discrete-time expressions (MLS §3.8.4): they change at events only. Relations and `integer` in functions and in `noEvent` cause no events.\n\n\
         ## Example\n`Integer n = f(time);` with `function f input Real x; output Integer y; algorithm y := integer(x); end f;`\n\n\
         ## What to do\nWrite the relation, `integer` or `floor` in the model, outside of functions and `noEvent`.",
    /// A value outside the interval of `min` and `max`.
    OUTSIDE_RANGE = "outside-range":
        "## What it means\nA value lies outside the interval that the attributes `min` and `max` of its variable declare (MLS §4.9): that of a constant or parameter, a fixed start value, or one that a simulation has led to. The simulation continues with it.\n\n\
         ## Example\n`parameter Real p(min = 0) = -1;`\n\n\
         ## What to do\nCorrect the value, or the attribute. A variable that leaves its interval shows that the model is used where it does not hold; write an `assert` where that is an error.",
}
