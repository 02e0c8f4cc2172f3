//! Codes of scripts.

use crate::codes;
use crate::diag::Code;
use crate::{eval, flatten, lower};

/// Codes that say that something is not there, rather than that something is wrong.
pub const OUT_OF_REACH: &[Code] = &[
    eval::errors::UNKNOWN_FUNCTION,
    eval::errors::MODEL_ONLY,
    REFUSED,
    lower::errors::NOT_SUPPORTED,
    flatten::errors::NOT_SUPPORTED,
];

codes! {
    /// A script to run does not exist.
    SCRIPT_NOT_FOUND = "script-not-found":
        "## What it means\n\n`RunScript` or the command line names a script that was not found. The search covers the folder of the calling script, then the working directory, each with and without the extension `.mos`.\n\n## Example\n\n`RunScript(\"GAPILib_INT.mos\")`\n\n## What to do\n\nCorrect the name, or write the path relative to the folder of the calling script.",
    /// A line that begins with a sign and continues the line before (a note).
    CONTINUED_LINE = "continued-line":
        "## What it means\n\nA line of a script begins with `+` or `-`, and the line before has no semicolon. As in Modelica, where line ends mean nothing, the expression continues. The note is for lines that look like a statement of their own: no blank follows the sign, and the line is not indented deeper than the statement.\n\n## Example\n\n`a = 4` and in the next line `-1`: a is 3.\n\n## What to do\n\nWrite a semicolon at the end of the line before if this is a statement of its own. If the expression continues, write a blank after the sign, indent the line, or put brackets around the expression.",
    /// A file cannot be read or written.
    FILE_ERROR = "file-error":
        "## What it means\n\nA file is missing, or the system refuses to read or write it.\n\n## Example\n\n`readMatrix(\"missing.mat\", \"A\", 3, 3)`\n\n## What to do\n\nCorrect the path. Relative paths start from the working directory, which `cd()` shows.",
    /// A functional mock-up unit that cannot be used, or not so.
    BAD_FMU = "bad-fmu":
        "## What it means\n\nThe file is not a functional mock-up unit (FMU) of version 2.0 or 3.0, its description contradicts the standard, it has no binary for this machine, it needs what is not supported (clocks in model exchange or co-simulation), a variable does not exist or cannot be set, or its simulation failed. The message says which.\n\n## Example\n\n`gapi simulate Pump.fmu` on Linux, where the FMU has a binary for Windows alone.\n\n## What to do\n\nExport the FMU for this machine with the tool that has made it. Where the simulation fails, the message has what the FMU itself says; set its parameters within their ranges.",
    /// A message of a functional mock-up unit (a note).
    FMU_MESSAGE = "fmu-message":
        "## What it means\n\nA functional mock-up unit (FMU) has written a log message, or printed something. Each message is shown once, whatever number of simulations has led to it.\n\n## Example\n\nA warning of the FMU that a table is extrapolated.\n\n## What to do\n\nNothing, unless the message says so. Placeholders such as `%s` in messages of FMI 2.0 are not filled in.",
    /// Scripts that call each other without end.
    SCRIPTS_TOO_DEEP = "scripts-too-deep":
        "## What it means\n\nScripts call each other (or themselves) more than 64 levels deep.\n\n## Example\n\nA script `a.mos` that holds `RunScript(\"a.mos\");`\n\n## What to do\n\nEnd the recursion with a condition, or use a loop.",
    /// An assignment to a name of the model before any model was translated.
    NO_TRANSLATED_MODEL = "no-translated-model":
        "## What it means\n\nA dotted name was assigned or read, which stands for a parameter or variable of the last translated model; but no model has been translated yet.\n\n## Example\n\n`RL1.R = 0.5;` as the first statement\n\n## What to do\n\nLoad and translate the model first: `openModel(\"file.mo\"); translateModel(\"Package.Model\");`.",
    /// What is to be changed in the middle of a run cannot be changed there.
    CANNOT_BRANCH = "cannot-branch":
        "## What it means\n\n`gapi teach --what-if` changes variables of the script as soon as `Eval` has simulated a generation. Here `Eval` is called in a function, whose variables cannot be changed from outside.\n\n## Example\n\n`gapi teach my.mos --what-if \"F_Mut := 0.5\"` where a function of `my.mos` calls `Eval`\n\n## What to do\n\nCall `Eval` from the script itself, or change the function.",
    /// A change of a run that continues is not possible.
    BAD_CHANGE = "bad-change":
        "## What it means\n\nA statement that is to change a run between two generations, typed in a pause or given with `gapi teach --what-if`, names a variable that the script does not have, or gives a variable a value that the run cannot continue with. The run continues without it; with `--what-if` the changed run ends.\n\n## Example\n\n`F_mut := 0.5` where the script has `F_Mut`; `F_Mut := \"high\"`; `N_Population := 50` in the middle of a run\n\n## What to do\n\nAssign a variable of the script, and keep its type and size.",
    /// A name that the translated model does not have, or that is not a parameter.
    UNKNOWN_PARAMETER = "unknown-parameter":
        "## What it means\n\nThe model translated last has no parameter or start value of this name.\n\n## Example\n\n`Decay.k = 2;` where the model declares `rate`\n\n## What to do\n\nUse a name of the model as its flat form shows it (`gapi flatten FILE --model CLASS`).",
    /// A value that does not fit a parameter of the model.
    BAD_PARAMETER_VALUE = "bad-parameter-value":
        "## What it means\n\nThe value assigned to a parameter of the translated model has another type or size than the parameter, or the parameter cannot be set.\n\n## Example\n\n`R = {1, 2};` for a scalar parameter `R`\n\n## What to do\n\nAssign a value of the parameter's type and size.",
    /// An argument outside what a command accepts.
    BAD_ARGUMENT = "bad-argument":
        "## What it means\n\nThe value of an argument has the right type but is outside what the command accepts.\n\n## Example\n\n`Modelica.Utilities.Strings.substring(\"abc\", 3, 9)`\n\n## What to do\n\nCorrect the value; the message names the argument and what is accepted.",
    /// A script variable with the name of a parameter.
    SHARED_NAME = "shared-name":
        "## What it means\n\nA script assigns to a name that a parameter at the top level of the last translated model has. The parameter is set, as in Dymola, and the name means the parameter from then on. A variable that a script declared, or assigned before the model was translated, stays the script's own: then the parameter keeps its value. Reported once for each name.\n\n## Example\n\n`translateModel(\"Decay\"); k = 2;` where `Decay` has a parameter `k`\n\n## What to do\n\nNothing, if you meant the parameter; otherwise rename the variable.",
    /// A function with the name of a command (a note).
    OWN_FUNCTION = "own-function":
        "## What it means\n\nA function of a loaded package has the full name of a built-in command. The function is called in its place, by its full name and by its bare one; of several functions of a bare name, the one loaded last. Reported once.\n\n## Example\n\n`openModel(\"GAPILib.mo\"); f = Fit(D, Y);` where `GAPILib.mo` defines `GAPILib.Basics.Fit`\n\n## What to do\n\nNothing, if you meant the function; otherwise rename it, or do not load it.",
    /// A command that the program does not carry out.
    REFUSED = "refused-command":
        "## What it means\n\nThe command is not permitted, or it exists in other tools and is not supported here; the message says which, and why.\n\n## Example\n\n`system(\"rm -rf results\")`, `readFile(\"/etc/hosts\")`\n\n## What to do\n\nPermit it with the option that the message names: `--allow-read=DIR` and `--allow-write=DIR` for files outside the folders of the script, `--allow-system` for programs and environment variables. What is not supported must be done outside the script.",
    /// A command that only concerns a graphical window.
    NO_WINDOW = "no-window":
        "## What it means\n\nThe command concerns a window of a graphical tool, so it has no effect here. Reported once per command.\n\n## Example\n\n`animationSetup()`\n\n## What to do\n\nNothing; the results are not affected.",
    /// An integration method of another tool, in whose place one of this program is taken.
    METHOD_REPLACED = "method-replaced":
        "## What it means\n\nThe script selects an integration method of OpenModelica that is not available. `dassl` is used with the same tolerance. Reported once for each method.\n\n## Example\n\n`simulate(M, method = \"gbode\");`\n\n## What to do\n\nNothing, if only the tolerance matters; otherwise select `dassl`, `radau`, `rodas4`, `dopri5`, `dop853`, `rungekutta` or `euler`.",
    /// A statement that could not be done because an earlier one failed.
    FOLLOW_UP = "follow-up":
        "## What it means\n\nA statement uses a variable that has no value because an earlier statement that assigns it failed. The cause is reported at that statement; its consequences are not reported one by one.\n\n## Example\n\n`a = 1/\"x\"; b = a + 1;`\n\n## What to do\n\nCorrect the first error.",
    /// The user stopped the script.
    INTERRUPTED = "interrupted":
        "## What it means\n\nThe script was stopped with Ctrl-C.\n\n## Example\n\nCtrl-C during a long run\n\n## What to do\n\nNothing; files written up to that point are kept.",
    /// A script took more time or memory than it was allowed.
    LIMIT_REACHED = "limit-reached":
        "## What it means\n\nThe script took more time or memory than `--time-limit` or `--memory-limit` allow, and was stopped.\n\n## Example\n\n`while true loop end while;` with `--time-limit 1`\n\n## What to do\n\nRaise the limit, or reduce the work of the script. Files written up to that point are kept.",
    /// A script raised an error by itself.
    SCRIPT_ERROR = "script-error":
        "## What it means\n\nThe script or a function called `Modelica.Utilities.Streams.error` (or `error`).\n\n## Example\n\n`Modelica.Utilities.Streams.error(\"no data\")`\n\n## What to do\n\nThe message comes from the author of the script; it says what is wrong.",
    /// A structural parameter was given a value (a note).
    TRANSLATED_AGAIN = "translated-again":
        "## What it means\n\nA script sets a structural parameter, whose value determines the equations of the model, such as an array size. The translated model has no slot for it, so the model is translated again before the next simulation. Reported once for each name.\n\nOr classes of the translated model were loaded again with another text: it is translated again, and what scripts had set by hand is set again.\n\n## Example\n\n`n = 5;` for a model with `parameter Integer n = 3; Real x[n];`\n\n## What to do\n\nNothing; in a loop over many values, each value costs one translation.",
    /// Values of a model are gone because another one was translated (a note).
    VALUES_DROPPED = "values-dropped":
        "## What it means\n\nParameters of a translated model were set by hand, then another model took its place, and now the first one is simulated again. As in Dymola there is one translated model: what was set by hand belongs to it, and went with it.\n\n## Example\n\n`simulateModel(\"A\"); k = 2; simulateModel(\"B\"); simulateModel(\"A\");`\n\n## What to do\n\nSet the values again after the model was translated again, or give them with it: `simulateModel(\"A(k = 2)\")`.",
    /// States that begin without a value of their own (a note).
    START_VALUES_MISSING = "start-values-missing":
        "## What it means\n\nA simulation is to begin where another one ended, but the file or the result does not have all states and discrete variables of the model. Those that it does not have start as the model says. `gapi simulate` also names the states of a model that begin at 0 because neither a start value nor an initial equation says where they begin.\n\n## Example\n\n`importInitial(\"other.txt\")` where `other.txt` is the final state of a smaller model\n\n## What to do\n\nUse the final state of the same model, or give the missing variables start values, `x.start = 2`.",
    /// A start value that the model does not begin with (a note).
    START_IS_GUESS = "start-is-guess":
        "## What it means\n\nA script sets the start value of a state that does not begin with it: initial equations of the model, or start values of other variables, determine where the state begins. The start value is the first guess of the solution of these equations (MLS §8.6). Reported once for each name.\n\n## Example\n\n`x.start = 3;` for a model with `initial equation der(x) = 0;`\n\n## What to do\n\nChange what determines the initial value, or declare `x(fixed = true)` and remove the initial equation.",
    /// An import that names nothing.
    BAD_IMPORT = "bad-import":
        "## What it means\n\nAn import clause in a script names a package or class that is neither loaded nor a package of built-in commands.\n\n## Example\n\n`import Modelica.Utilties.Streams;`\n\n## What to do\n\nCorrect the name, or load the library first.",
    /// A library of another version than the one asked for (a warning).
    OTHER_VERSION = "other-version":
        "## What it means\n\nThe `uses` annotation of a package states the library version that it needs (MLS §18.8.3). That version was not found; the version that was found is older or has another major version. It is used without conversion.\n\n## Example\n\n`annotation(uses(Modelica(version = \"3.2.3\")));` where `MODELICAPATH` contains only `Modelica 4.0.0`\n\n## What to do\n\nGive the folder of the required version with `--library`, or convert the package.",
}
