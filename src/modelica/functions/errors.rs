//! Codes of calls.

use crate::codes;

codes! {
    /// A name that stands for no function.
    UNKNOWN_FUNCTION = "unknown-function":
        "## What it means\n\nA call names a function that is neither built in nor loaded.\n\n## Example\n\n`simulateModle(\"M\")`\n\n## What to do\n\nCorrect the name, or load the file that defines the function first.",
    /// Arguments that do not fit the inputs of a function.
    WRONG_ARGUMENTS = "wrong-arguments":
        "## What it means\n\nA call has too many arguments, omits a required argument, names an input that does not exist, or specifies one twice (MLS §12.4.1).\n\n## Example\n\n`sin(1, 2)`\n\n## What to do\n\nCompare the call with the inputs of the function, which the message names.",
}
