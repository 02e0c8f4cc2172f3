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
    /// An access to files, the screen or the clock that is not granted.
    EXTERNAL_OUTSIDE = "external-outside":
        "## What it means\nAn external function needs to read a file, to print or to read the clock, where that cannot be granted: inside a model that is simulated many times.\n\n\
         ## Example\nA table is read from a file whose name is known only when the simulation \
         starts.\n\n\
         ## What to do\nGive the values as parameters, or read the file in a script.",
    /// A C function of a library that the user has not allowed.
    EXTERNAL_REFUSED = "external-refused":
        "## What it means\nA library contains an external C function. Compiling and calling it lets the library do anything on this machine that you may do, so it is not done without your permission. The message names the files.\n\n\
         ## Example\n`external \"C\" y = f(x) annotation(Include = \"#include <f.c>\");`\n\n\
         ## What to do\nIf you trust the library, allow it with `--allow-external`. A C compiler is needed.",
    /// C code of a library that cannot be compiled or loaded.
    EXTERNAL_COMPILER = "external-compiler":
        "## What it means\nThe C code of a library was not compiled: there is no C compiler, or it refuses the code, or a library that it needs is missing.\n\n\
         ## Example\n`external \"C\" y = f(x) annotation(Library = \"missing\");`\n\n\
         ## What to do\nInstall a C compiler (`apt install gcc`, `xcode-select --install`), or name one in the environment variable `CC`. Correct what the compiler complains about: its words are in the message.",
    /// A declaration that has no equivalent in C.
    EXTERNAL_DECLARATION = "external-declaration":
        "## What it means\nAn `external` declaration cannot be called: it is in a language other than C, or has arguments that are not passed to C here: records, expressions other than names, constants and sizes.\n\n\
         ## Example\n`external \"FORTRAN 77\" f(x, y);`\n\n\
         ## What to do\nWrite a function in C that calls it, with numbers, strings, arrays and external objects as arguments.",
    /// What functions print while a model is translated (a note).
    PRINTED = "printed-at-translation":
        "## What it means\n\nA function is called while the model is translated, because an array size, a condition of a component or another property of the structure depends on its value, and it prints. The simulation does not call it again.\n\n## Example\n\n`parameter Integer n = layers(\"wall.txt\"); Real T[n];`, where `layers` prints the name of the file.\n\n## What to do\n\nNothing, or remove the output from the function.",
}
