//! Codes of this folder.

use crate::codes;

codes! {
    /// A file that is not what it claims to be.
    BAD_MAT_FILE = "bad-mat-file":
        "## What it means\n\nA MAT file is truncated, or contains an invalid size, type or offset. Nothing was read from it.\n\n## Example\n\nA `.mat` file whose download was interrupted.\n\n## What to do\n\nCopy or export the file again. If another program can read it, save it again there with `save -v7` and report the original file.",
    /// A kind of file that is not read.
    UNSUPPORTED_MAT_FILE = "unsupported-mat-file":
        "## What it means\n\nThe file format is not supported: Octave's text or HDF5 format, or a version 4 file with VAX or Cray numbers. Nothing was read from it.\n\n## Example\n\nOctave's `save -text data.mat x y`\n\n## What to do\n\nSave the data in version 7: `save -v7 data.mat x y`, or as CSV.",
    /// A matrix that the file does not hold.
    UNKNOWN_MATRIX = "unknown-matrix":
        "## What it means\n\nThe file does not contain a matrix (or, in a CSV file, a column) of this name.\n\n## Example\n\n`readMatrix(\"data.mat\", \"curent\")` for a file with `current` and `voltage`\n\n## What to do\n\nUse one of the names that the message lists. Names are case-sensitive; fields of a structure are written with dots, as in `run.current`.",
    /// A variable that is there and cannot be a matrix.
    UNREADABLE_MATRIX = "unreadable-matrix":
        "## What it means\n\nThe file contains a variable of this name, but it is not a real matrix: complex, sparse, an object, an array of more than two dimensions, or a cell array or an array of structures as a whole.\n\n## Example\n\n`save -v7 data.mat z` with `z = 1 + 2i`\n\n## What to do\n\nConvert the variable before saving: `real(z)` and `imag(z)`, `full(s)`, or `squeeze(a(:, :, 1))`. Name an element of a cell array, `c{1}`, or of an array of structures, `run(1).t`.",
    /// A text matrix or table with a malformed line.
    BAD_TABLE = "bad-table":
        "## What it means\n\nA line of a numeric text file (CSV, or the `#1` format) is invalid. The message gives line and column.\n\n## Example\n\nA CSV file with two columns in its header and three cells in line 7.\n\n## What to do\n\nCorrect the line. A header row with names precedes the data, optionally followed by a row of units; every other line has one cell per column, empty where the value is missing. Lines that start with `#` are comments. A number such as `1.234` next to `1.300,5` is an error because it is ambiguous: 1.234 or 1234.",
    /// Something in a data file was read in a way that should be known.
    DATA_NOTE = "data-note":
        "## What it means\n\nThe data were read; notes say what was changed or left out, warnings what may change the result: missing values, a converted unit, dates converted to seconds, skipped lines, or a unit that is not known. The message gives the details.\n\n## Example\n\nA CSV file with empty cells: those points are omitted from the fit.\n\n## What to do\n\nNothing, if this is intended. Otherwise correct the file.",
    /// A matrix that the format cannot hold.
    UNWRITABLE_MATRIX = "unwritable-matrix":
        "## What it means\n\nThe matrix cannot be written in the requested format: its name is not a letter followed by at most 62 letters, digits and underscores, its size exceeds the limit of the format, or the format cannot represent its characters.\n\n## Example\n\n`writeMatrix(\"out.mat\", \"cell.v\", [1, 2])`\n\n## What to do\n\nUse a shorter or simpler name, or write fewer rows.",
}
