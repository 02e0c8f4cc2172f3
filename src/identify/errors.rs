//! Codes of the identification.

use crate::codes;

codes! {
    /// A parameter that the model does not have.
    PARAMETER_NOT_FOUND = "parameter-not-found":
        "## What it means\n\nA parameter to be estimated is not a parameter of the model.\n\n## Example\n\n`Parameter_Names = {\"A\", \"Ilimit\"}` for a model whose parameter is named `Ilim`.\n\n## What to do\n\nUse a name that the message lists; parameters of components are written with dots, such as `cell.R`.",
    /// A parameter whose value is fixed when the model is translated.
    FIXED_PARAMETER = "fixed-parameter":
        "## What it means\n\nThe parameter exists, but its value is fixed when the model is translated: it is final, has `annotation(Evaluate = true)`, or is structural (an array size, a condition). It cannot differ between individuals.\n\n## Example\n\n`parameter Integer n = 3; Real x[n];` with `n` as a parameter to be estimated.\n\n## What to do\n\nEstimate other parameters, or set this one by a modification of the model: `\"M(n = 4)\"`.",
    /// A variable that the model does not have.
    UNKNOWN_OUTPUT = "unknown-output":
        "## What it means\n\nThe variable that the experiment measured (`Y_Name`), or the one it is plotted over (`X_Name`), is not a Real variable of the model.\n\n## Example\n\n`Y_Name = \"U\"` for a model whose voltage is named `V`.\n\n## What to do\n\nUse the name of a variable of the model.",
    /// No output was named and the model does not have exactly one.
    AMBIGUOUS_OUTPUT = "ambiguous-output":
        "## What it means\n\n`Y_Name` is missing, and the model has no top-level output or several, so the measured variable is ambiguous.\n\n## Example\n\nA model with `output Real V; output Real P;`\n\n## What to do\n\nPass the name as argument `Y_Name` of `Eval`.",
    /// Measured points that the simulation does not reach.
    POINTS_OUTSIDE = "points-outside":
        "## What it means\n\nThe simulated X does not reach all measured X values, so there is no simulated value for those points. The message lists them.\n\n## Example\n\nMeasured up to 1.46 A/cm2, simulated up to 0.22 A/cm2.\n\n## What to do\n\nExtend the simulation (the stop time, or the end of the ramp), or remove those points.",
    /// X takes a measured value at more than one time.
    NOT_MONOTONE = "not-monotone":
        "## What it means\n\nThe simulated X takes a measured value at several times, so the corresponding simulated value is ambiguous. Where it is held at this value, as after the end of a ramp, the first of these times counts.\n\n## Example\n\nA current that increases and decreases again, used as X.\n\n## What to do\n\nUse `time` as X, or an experiment in which X is monotonic.",
    /// Measured data that are not finite.
    BAD_DATA = "bad-data":
        "## What it means\n\nThe measured data contain NaN or an infinite value, or no points at all.\n\n## Example\n\nA matrix exported with an empty cell.\n\n## What to do\n\nRemove or correct the point given in the message.",
    /// A measured column in another unit than the variable beside it (a note).
    UNITS_DIFFER = "units-differ":
        "## What it means\n\nA script compares a measured column with a model variable in a different unit. `Eval`, `Fit` and `Refine` convert the column for the comparison, as a problem file does; the arrays of the script keep the numbers of the file. Functions of the script that compare these arrays themselves do not convert.\n\n## Example\n\nA column `V [mV]` beside an output `V` in volts.\n\n## What to do\n\nNothing if the conversion is right. Correct the unit in the header if it is wrong; a function of your own needs the column times the factor given in the message.",
    /// Sizes of measured X and Y differ.
    DATA_SIZES_DIFFER = "data-sizes-differ":
        "## What it means\n\nThe matrices of X and Y values have different numbers of elements, so they do not form pairs of one experiment.\n\n## Example\n\n`Exp_Adq_SISO(\"data.mat\", \"t\", \"V\")` where `t` has 100 elements and `V` has 99.\n\n## What to do\n\nCorrect the file or the names of the matrices.",
    /// More searches of a script than are reported (a note).
    SEVERAL_SEARCHES = "several-searches":
        "## What it means\n\nWhat a generation compares, the model and the measured points, says which search it belongs to; each search has a report of its own, because fitness values of different data cannot be compared. This script has more searches than are reported.\n\n## Example\n\nA loop that fits a model to each of 1000 simulated data sets, or measured points that change in each generation.\n\n## What to do\n\nNothing, if the script prints what it finds. A report of each search is written where each has a script of its own, or reads its data by `Exp_Adq_SISO`.",
    /// Results of a search that the script does not make any more (a note).
    EARLIER_RESULTS = "earlier-results":
        "## What it means\n\nThe folder of the results has a folder of a further search that an earlier run of the script has made, and this run has not. It is left as it is.\n\n## Example\n\nA script that fitted two data sets and now fits one: `run-2` is of the run before.\n\n## What to do\n\nRemove the folder, or keep it elsewhere.",
    /// Ranks of one job that do not fit each other.
    RANKS_DIFFER = "ranks-differ":
        "## What it means\n\nThe processes of an MPI job run different versions of the program, or one of them cannot make the simulator that rank 0 has sent. The message names the rank and its machine.\n\n## Example\n\nAn older `gapi` in the search path of one machine.\n\n## What to do\n\nStart the same program file on all machines, for example by its full path on a shared file system.",
    /// Ranks that have nothing to do (a note).
    RANKS_IDLE = "ranks-idle":
        "## What it means\n\nThe other ranks of an MPI job take no part in the simulations, because the model cannot be sent to them. Rank 0 simulates alone; the results are the same.\n\n## Example\n\nA model that calls a function in C of a library.\n\n## What to do\n\nUse the threads of one machine (`--threads`), or divide the study into shards, each of which compiles the model (`gapi identify --shard 1/4`).",
    /// No parameters to identify.
    NO_PARAMETERS = "no-parameters":
        "## What it means\n\nThere is nothing to estimate: no names are given and the model has no tunable top-level parameter, or the population has no columns.\n\n## Example\n\nA model without parameters.\n\n## What to do\n\nPass the parameter names as argument `Parameter_Names` of `Eval`.",
}
