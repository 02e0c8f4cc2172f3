//! Codes of external functions.

crate::codes! {
    /// A call that an external function cannot take.
    EXTERNAL_CALL = "external-call":
        "## What it means\nThe arguments of an `external` declaration do not match the implementation in this program.\n\n\
         ## Example\n`external \"C\" n = ModelicaStrings_length(a, b);`\n\n\
         ## What to do\nUse the declaration of the Modelica Standard Library.",
    /// An external function that has no result for these arguments.
    EXTERNAL_FAILED = "external-failed":
        "## What it means\nAn external function has no result for its arguments: a table that is not sorted, a string without a number, a matrix of the wrong size.\n\n\
         ## Example\nA table whose first column is `{0, 2, 1}`.\n\n\
         ## What to do\nThe message names the function and the reason; correct the arguments.",
    /// A request to the outside world that nobody grants.
    EXTERNAL_OUTSIDE = "external-outside":
        "## What it means\nAn external function wants to read a file, to print or to read the clock, where that cannot be granted: inside a model that is simulated many times.\n\n\
         ## Example\nA table is read from a file whose name is known only when the simulation \
         starts.\n\n\
         ## What to do\nGive the values as parameters, or read the file in a script.",
}
