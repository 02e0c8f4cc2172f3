//! Codes of the identification.

use crate::codes;

codes! {
    /// A parameter that the model does not have.
    PARAMETER_NOT_FOUND = "parameter-not-found":
        "## What it means\n\nA name given as parameter to identify is no parameter of the model.\n\n## Example\n\n`Parameter_Names = {\"A\", \"Ilimit\"}` for a model whose parameter is named `Ilim`.\n\n## What to do\n\nUse a name that the message lists; parameters of components are written with dots, such as `cell.R`.",
    /// A parameter whose value is fixed when the model is translated.
    FIXED_PARAMETER = "fixed-parameter":
        "## What it means\n\nThe parameter exists, but its value is fixed when the model is translated: it is final, has `annotation(Evaluate = true)`, or shaped the model (an array size, a condition). It cannot differ between individuals.\n\n## Example\n\n`parameter Integer n = 3; Real x[n];` with `n` as parameter to identify.\n\n## What to do\n\nIdentify other parameters, or set this one by a modification of the model: `\"M(n = 4)\"`.",
    /// A variable that the model does not have.
    UNKNOWN_OUTPUT = "unknown-output":
        "## What it means\n\nThe variable that the experiment measured (`Y_Name`), or the one it is plotted over (`X_Name`), is no Real variable of the model.\n\n## Example\n\n`Y_Name = \"U\"` for a model whose voltage is named `V`.\n\n## What to do\n\nUse the name of a variable of the model.",
    /// No output was named and the model does not have exactly one.
    AMBIGUOUS_OUTPUT = "ambiguous-output":
        "## What it means\n\n`Y_Name` was not given, and the model has no top-level output, or several, so that it is not clear which variable was measured.\n\n## Example\n\nA model with `output Real V; output Real P;`\n\n## What to do\n\nGive the name as the argument `Y_Name` of `Eval`.",
    /// Measured points that the simulation does not reach.
    POINTS_OUTSIDE = "points-outside":
        "## What it means\n\nThe simulated X does not reach all measured X values, so there is nothing to compare those points with. The message names them.\n\n## Example\n\nMeasured up to 1.46 A/cm2, simulated up to 0.22 A/cm2.\n\n## What to do\n\nSimulate further (the stop time, or the end of the ramp), or leave those points out.",
    /// X takes a measured value at more than one time.
    NOT_MONOTONE = "not-monotone":
        "## What it means\n\nThe simulated X takes a measured value at several times (or stays at it), so that it is not clear which of the simulated values belongs to the measured one.\n\n## Example\n\nA current that rises and falls again, used as X.\n\n## What to do\n\nUse `time` as X, or an experiment in which X only rises or only falls.",
    /// Measured data that are not finite.
    BAD_DATA = "bad-data":
        "## What it means\n\nThe measured data contain NaN or an infinite value, or hold no points at all.\n\n## Example\n\nA matrix exported with an empty cell.\n\n## What to do\n\nRemove or correct the point that the message names.",
    /// A measured column in another unit than the variable beside it (a note).
    UNITS_DIFFER = "units-differ":
        "## What it means\n\nA script compares a measured column with a variable of the model in another unit. Scripts compute with the numbers of their files as they are, so nothing is converted; a problem file converts.\n\n## Example\n\nA column `V [mV]` beside an output `V` in volts.\n\n## What to do\n\nMultiply the column in the script by the factor that the message names, or change the heading if it names the wrong unit.",
    /// Sizes of measured X and Y differ.
    DATA_SIZES_DIFFER = "data-sizes-differ":
        "## What it means\n\nThe matrices of X and Y values have different numbers of elements, so they are not pairs of one experiment.\n\n## Example\n\n`Exp_Adq_SISO(\"data.mat\", \"t\", \"V\")` where `t` has 100 elements and `V` has 99.\n\n## What to do\n\nCorrect the file or the names of the matrices.",
    /// No parameters to identify.
    NO_PARAMETERS = "no-parameters":
        "## What it means\n\nThere is nothing to identify: no names were given and the model has no tunable parameter at its top level, or the population has no columns.\n\n## Example\n\nA model without parameters.\n\n## What to do\n\nName the parameters with the argument `Parameter_Names` of `Eval`.",
}
