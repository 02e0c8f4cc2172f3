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
        "## What it means\n\n`RunScript` or the command line names a script that is in none of the places searched: the folder of the calling script, then the working directory, each with and without the ending `.mos`.\n\n## Example\n\n`RunScript(\"GAPILib_INT.mos\")`\n\n## What to do\n\nCorrect the name, or write the path from the folder of the script that calls.",
    /// A file cannot be read or written.
    FILE_ERROR = "file-error":
        "## What it means\n\nA file is missing, or the system refuses to read or write it.\n\n## Example\n\n`readMatrix(\"missing.mat\", \"A\", 3, 3)`\n\n## What to do\n\nCorrect the path. Relative paths start from the working directory, which `cd()` shows.",
    /// Scripts that call each other without end.
    SCRIPTS_TOO_DEEP = "scripts-too-deep":
        "## What it means\n\nScripts call each other (or themselves) more than 64 levels deep.\n\n## Example\n\nA script `a.mos` that holds `RunScript(\"a.mos\");`\n\n## What to do\n\nEnd the recursion with a condition, or use a loop.",
    /// An assignment to a name of the model before any model was translated.
    NO_TRANSLATED_MODEL = "no-translated-model":
        "## What it means\n\nA dotted name was assigned or read, which stands for a parameter or variable of the model translated last; but no model has been translated yet.\n\n## Example\n\n`RL1.R = 0.5;` as the first statement\n\n## What to do\n\nLoad and translate the model first: `openModel(\"file.mo\"); translateModel(\"Package.Model\");`.",
    /// What is to be changed in the middle of a run cannot be changed there.
    CANNOT_BRANCH = "cannot-branch":
        "## What it means\n\n`gapi teach --what-if` changes variables of the script as soon as `Eval` has simulated a generation. Here `Eval` is called in a function, whose variables nothing else can change.\n\n## Example\n\n`gapi teach my.mos --what-if \"F_Mut := 0.5\"` where a function of `my.mos` calls `Eval`\n\n## What to do\n\nCall `Eval` from the script itself, or change the function.",
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
        "## What it means\n\nA script variable was assigned whose name is also that of a parameter at the top level of the model translated last. Both get the value, as in Dymola. Said once for each name.\n\n## Example\n\n`translateModel(\"Decay\"); k = 2;` where `Decay` has a parameter `k`\n\n## What to do\n\nNothing if the parameter was meant; else give the variable another name.",
    /// A command that the program does not carry out.
    REFUSED = "refused-command":
        "## What it means\n\nThe command exists in other tools but is not carried out here, for the reason given in the message.\n\n## Example\n\n`system(\"rm -rf results\")`\n\n## What to do\n\nRemove the call, or do what it did outside of the script.",
    /// A command that only concerns a graphical window.
    NO_WINDOW = "no-window":
        "## What it means\n\nThe command concerns a window of a graphical tool. There is none here, so it has no effect. Said once per command.\n\n## Example\n\n`animationSetup()`\n\n## What to do\n\nNothing; results are not affected.",
    /// An integration method of another tool, in whose place one of this program is taken.
    METHOD_REPLACED = "method-replaced":
        "## What it means\n\nThe script asks for an integration method of OpenModelica that is not here. `dassl` is taken with the same tolerance. Said once for each method.\n\n## Example\n\n`simulate(M, method = \"gbode\");`\n\n## What to do\n\nNothing where the tolerance is what matters; else name `dassl`, `radau`, `rodas4`, `dopri5`, `rungekutta` or `euler`.",
    /// A statement that could not be done because an earlier one failed.
    FOLLOW_UP = "follow-up":
        "## What it means\n\nA statement uses a variable that has no value because the statement that should have given it one failed before. The cause is reported where it happened; later consequences are not reported one by one.\n\n## Example\n\n`a = 1/\"x\"; b = a + 1;`\n\n## What to do\n\nCorrect the first error.",
    /// The user stopped the script.
    INTERRUPTED = "interrupted":
        "## What it means\n\nThe script was stopped with Ctrl-C.\n\n## Example\n\nCtrl-C during a long run\n\n## What to do\n\nNothing; what had been written until then is kept.",
    /// A script took more time or memory than it was allowed.
    LIMIT_REACHED = "limit-reached":
        "## What it means\n\nThe script took more time or memory than `--time-limit` or `--memory-limit` allow, and was stopped.\n\n## Example\n\n`while true loop end while;` with `--time-limit 1`\n\n## What to do\n\nRaise the limit, or let the script do less. What had been written until then is kept.",
    /// A script raised an error by itself.
    SCRIPT_ERROR = "script-error":
        "## What it means\n\nThe script or a function called `Modelica.Utilities.Streams.error` (or `error`).\n\n## Example\n\n`Modelica.Utilities.Streams.error(\"no data\")`\n\n## What to do\n\nThe message is the author's; it says what is wrong.",
    /// A structural parameter was given a value (a note).
    TRANSLATED_AGAIN = "translated-again":
        "## What it means\n\nA script gave a value to a parameter whose value shapes the equations of the model, such as an array size. It has no slot in the translated model, which is therefore translated again before the next simulation. Said once for each name.\n\n## Example\n\n`n = 5;` for a model with `parameter Integer n = 3; Real x[n];`\n\n## What to do\n\nNothing; in a loop over many values each of them costs a translation.",
    /// An import that names nothing.
    BAD_IMPORT = "bad-import":
        "## What it means\n\nAn import clause of a script names a package or class that is not loaded and is no package of built-in commands.\n\n## Example\n\n`import Modelica.Utilties.Streams;`\n\n## What to do\n\nCorrect the name, or load the library first.",
    /// A library of another version than the one asked for (a warning).
    OTHER_VERSION = "other-version":
        "## What it means\n\nA package says in its annotation `uses` which version of a library it needs (MLS §18.8.3). No folder of that version was found, and the one that was found is older or has another main version. It is used as it is.\n\n## Example\n\n`annotation(uses(Modelica(version = \"3.2.3\")));` with `Modelica 4.0.0` as the only one in `MODELICAPATH`\n\n## What to do\n\nName the folder that has the version with `--library`, or convert the package.",
}
