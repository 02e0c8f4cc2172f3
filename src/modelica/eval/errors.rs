//! Codes of evaluation.

use crate::codes;
pub use crate::functions::errors::{UNKNOWN_FUNCTION, WRONG_ARGUMENTS};

/// What to do about a variable of a function that is used before it is assigned.
pub(crate) const ASSIGN_BEFORE: &str = "assign it before, or give it a value in its declaration";

codes! {
    /// A name that stands for no variable.
    UNKNOWN_VARIABLE = "unknown-variable":
        "## What it means\n\nA name does not refer to a variable, constant or parameter in the scope where it is used.\n\n## Example\n\n`y := X + 1` where only `x` was declared.\n\n## What to do\n\nCorrect the name, or declare or assign the variable first. Functions can access their own variables and constants of packages, but not the variables of the calling script.",
    /// A variable or output that is read before anything was assigned to it.
    NO_VALUE_YET = "no-value-yet":
        "## What it means\n\nA variable, an element of an array or an output is used before it has a value. In scripts it is never replaced by zero. In a function called by a model, 0 is used, with a warning; `--strict` makes it an error (MLS §12.4.4). A partially assigned record can be read as a whole: its Real elements without a value are NaN.\n\n## Example\n\n`function f output Real y; algorithm end f;` never assigns `y`.\n\n## What to do\n\nAssign the variable on every path through the function, or give it a binding in its declaration.",
    /// An assignment to what cannot be assigned.
    NOT_ASSIGNABLE = "not-assignable":
        "## What it means\n\nThe left side of an assignment is an input of the function, a constant, a loop variable, or not an assignable variable.\n\n## Example\n\n`u := 2` where `u` is declared `input Real u`.\n\n## What to do\n\nAssign to a protected variable or an output instead.",
    /// Calls nested too deeply.
    RECURSION_LIMIT = "recursion-limit":
        "## What it means\n\nFunctions call each other, or expressions are nested, more deeply than the program can follow.\n\n## Example\n\n`function f … y := f(x); end f;` without a terminating condition.\n\n## What to do\n\nCheck the condition that ends the recursion; a loop needs no nesting.",
    /// `assert` with a false condition.
    ASSERTION_FAILED = "assertion-failed":
        "## What it means\n\nThe condition of an `assert` is false; the message is the text of the `assert` (MLS §8.3.7).\n\n## Example\n\n`assert(T > 0, \"temperature must be positive\")`\n\n## What to do\n\nCheck the values that the condition compares.",
    /// `terminate` outside of a simulation.
    TERMINATED = "terminated":
        "## What it means\n\n`terminate` was called outside a simulation; it ends the evaluation with its message (MLS §8.3.8).\n\n## Example\n\n`terminate(\"done\")`\n\n## What to do\n\nUse `return` in functions and `exit` in scripts.",
    /// What has a meaning in the equations of a model only.
    MODEL_ONLY = "model-only":
        "## What it means\n\nAn operator or a statement is meaningful only in a simulated model, not in a script or function.\n\n## Example\n\n`der(x)` in a script.\n\n## What to do\n\nMove it into a model, or compute the value another way.",
    /// Too few or too many outputs.
    WRONG_OUTPUTS = "wrong-outputs":
        "## What it means\n\nA call requests more results than the function has outputs, or uses the value of a function without outputs.\n\n## Example\n\n`(a, b) := sin(1)`\n\n## What to do\n\nCompare the left side with the outputs of the function.",
    /// `end` outside of subscripts, a loop without a range, `break` outside of a loop.
    MISPLACED = "misplaced":
        "## What it means\n\n`end` is used outside of subscripts, `break` outside a loop, or a loop has no range and none can be deduced from the subscripts in its body (MLS §11.2.2.1).\n\n## Example\n\n`x := end;`\n\n## What to do\n\nMove it to a place where it is allowed; write the range of the loop.",
    /// A loop of a script that does not end.
    ENDLESS_LOOP = "endless-loop":
        "## What it means\n\nThe condition of a `while` loop of a script is true, and no statement in the loop changes the variables that it reads: the loop runs until it is interrupted or fails.\n\n## Example\n\n`while Best > 0.1 loop Bset := Best/2; end while;`\n\n## What to do\n\nAssign to a variable of the condition in the loop; look for a misspelt name.",
    /// A function that is not written in Modelica.
    EXTERNAL_FUNCTION = "external-function":
        "## What it means\n\nThe function is implemented outside Modelica (`external`), and this program does not implement it.\n\n## Example\n\n`external \"C\" y = my_function(x);`\n\n## What to do\n\nWrite its algorithm in Modelica.",
}
