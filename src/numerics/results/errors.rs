//! Codes of this folder.

use crate::codes;

codes! {
    /// A file that does not hold results of a simulation.
    BAD_RESULT_FILE = "bad-result-file":
        "## What it means\n\nThe file can be read, but it does not have the layout of simulation results, or its parts are inconsistent.\n\n## Example\n\n`readTrajectory(\"measured.mat\", {\"v\"}, 10)` of a file with plain matrices\n\n## What to do\n\nUse the result file of a simulation. Read plain matrices with `readMatrix`.",
    /// A variable that the results do not hold.
    UNKNOWN_RESULT_VARIABLE = "unknown-result-variable":
        "## What it means\n\nThe results do not contain a variable of this name.\n\n## Example\n\n`readTrajectory(\"dsres.mat\", {\"cell.volts\"}, 10)` of a model with `cell.v`\n\n## What to do\n\nUse one of the names in the file; `readTrajectoryNames` lists them.",
    /// A time before the first or after the last point.
    OUTSIDE_RESULTS = "outside-results":
        "## What it means\n\nA value was requested at a time that was not simulated. Values are interpolated, never extrapolated.\n\n## Example\n\n`val(x, 2.0)` after a simulation that stopped at 1\n\n## What to do\n\nSimulate the whole interval, or use a time within it.",
    /// A table whose parts do not fit together.
    BAD_RESULT_TABLE = "bad-result-table":
        "## What it means\n\nThe results cannot be written: a variable has more or fewer values than there are time points, time decreases, two variables have the same name, or an alias refers to a missing variable.\n\n## Example\n\n`writeTrajectory(\"out.mat\", {\"time\", \"x\"}, [1, 5; 0, 6])`\n\n## What to do\n\nGive one value per time point, and time points that do not decrease.",
    /// A reference that results cannot be compared with.
    BAD_REFERENCE = "bad-reference":
        "## What it means\n\nResults cannot be compared with this reference: it has no time points, or lacks a signal to be compared.\n\n## Example\n\n`gapi compare result.mat reference.csv --signals signals.txt` where `signals.txt` names a variable that is not in `reference.csv`\n\n## What to do\n\nList signals of the reference, or omit the list to compare all of them.",
}
