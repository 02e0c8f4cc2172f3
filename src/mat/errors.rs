//! Codes of this folder.

use crate::codes;

codes! {
    /// A file that is not what it claims to be.
    BAD_MAT_FILE = "bad-mat-file":
        "## What it means\n\nA MAT file ends too early, or a size, type or offset in it cannot be right. Nothing was read from it.\n\n## Example\n\nA `.mat` file whose download was interrupted.\n\n## What to do\n\nCopy or export the file again. If another program reads it, save it there once more with `save -v7` and report the original.",
    /// A kind of file that is not read.
    UNSUPPORTED_MAT_FILE = "unsupported-mat-file":
        "## What it means\n\nThe file is of a kind that is not read: Octave's text or HDF5 format, or a version 4 file with numbers of a VAX or Cray. Nothing was read from it.\n\n## Example\n\nOctave's `save -text data.mat x y`\n\n## What to do\n\nSave the data in version 7: `save -v7 data.mat x y`, or as CSV.",
    /// A matrix that the file does not hold.
    UNKNOWN_MATRIX = "unknown-matrix":
        "## What it means\n\nThe file holds no matrix (or, in a CSV file, no column) of this name.\n\n## Example\n\n`readMatrix(\"data.mat\", \"curent\")` of a file with `current` and `voltage`\n\n## What to do\n\nUse one of the names that the message lists. Upper and lower case count; fields of a structure are named with dots, as in `run.current`.",
    /// A variable that is there and cannot be a matrix.
    UNREADABLE_MATRIX = "unreadable-matrix":
        "## What it means\n\nThe file holds a variable of this name, but it is not a real matrix: complex, sparse, a cell array, an object, or an array of more than two dimensions.\n\n## Example\n\n`save -v7 data.mat z` with `z = 1 + 2i`\n\n## What to do\n\nConvert the variable before saving: `real(z)` and `imag(z)`, `full(s)`, `c{1}`, or `squeeze(a(:, :, 1))`.",
    /// A text matrix or table with a malformed line.
    BAD_TABLE = "bad-table":
        "## What it means\n\nA text file with numbers (CSV, or the `#1` format) has a line that does not fit. The message names line and column.\n\n## Example\n\nA CSV file with two columns in its header and three cells in line 7.\n\n## What to do\n\nCorrect the line. A row of names stands above the data, and one of units may follow it; every other line holds one cell per column, empty where the value is missing. Lines that start with `#` are comments. A number such as `1.234` beside `1.300,5` is refused, because it may be 1.234 or 1234.",
    /// Something in a data file was read in a way that should be known.
    DATA_NOTE = "data-note":
        "## What it means\n\nThe data were read, and something in them should be known: values that are missing, a unit that was converted, dates that became seconds, lines that were left out. The message says what.\n\n## Example\n\nA CSV file with empty cells: those points are left out of the fit.\n\n## What to do\n\nNothing, if that is what the file means. Otherwise correct the file.",
    /// A matrix that the format cannot hold.
    UNWRITABLE_MATRIX = "unwritable-matrix":
        "## What it means\n\nThe matrix cannot be written in the format asked for: its name is not a letter followed by at most 62 letters, digits and underscores, its size exceeds what the format counts, or its characters do not fit.\n\n## Example\n\n`writeMatrix(\"out.mat\", \"cell.v\", [1, 2])`\n\n## What to do\n\nUse a shorter or simpler name, or write fewer rows.",
}
