//! What can be wrong with a text.

use crate::codes;

codes! {
    /// Anything the grammar does not allow that has no code of its own.
    SYNTAX_ERROR = "syntax-error":
        "## What it means\n\nThe text does not follow the grammar of Modelica (MLS appendix A) at the place shown.\n\n## Example\n\n`x = 1 + ;`\n\n## What to do\n\nThe message names what was found and what may stand there.",
    /// A statement, equation or element without its terminator.
    MISSING_SEMICOLON = "missing-semicolon":
        "## What it means\n\nAn element, equation or statement is not closed by `;`. In a script a line end closes a statement too, in a class it does not.\n\n## Example\n\n`Real x` followed by `Real y;`\n\n## What to do\n\nWrite `;` at the place shown.",
    /// A bracket without its partner.
    UNCLOSED_BRACKET = "unclosed-bracket":
        "## What it means\n\nA bracket `(`, `[` or `{` has no closing partner, or a closing one has no opening partner, or the two are of different kinds.\n\n## Example\n\n`y = sin(x;`\n\n## What to do\n\nClose the bracket shown, or take it away.",
    /// `end` with a wrong name or keyword, or without one.
    MISMATCHED_END = "mismatched-end":
        "## What it means\n\nThe name or keyword behind `end` is not that of the class, loop or clause it closes, or something is never closed.\n\n## Example\n\n`model Cell ... end Stack;`\n\n## What to do\n\nClose what was opened last first; repeat the class's name behind `end`.",
    /// A string or quoted identifier or comment that the text ends in.
    UNCLOSED_STRING = "unclosed-string":
        "## What it means\n\nA string, a quoted identifier or a comment `/*` has no end.\n\n## Example\n\n`resultFile = \"run1;`\n\n## What to do\n\nWrite the closing `\"`, `'` or `*/`.",
    /// A character that no Modelica text may hold outside strings and comments.
    BAD_CHARACTER = "bad-character":
        "## What it means\n\nA character stands where only Modelica's own may: letters `a`-`z`, digits, `_` and the operators. Others are allowed in strings, comments and quoted identifiers.\n\n## Example\n\n`a != b`\n\n## What to do\n\nWrite the Modelica form named in the message, or quote the identifier.",
    /// Brackets, blocks or operators inside each other beyond what is read.
    NESTING_TOO_DEEP = "nesting-too-deep":
        "## What it means\n\nExpressions, brackets or blocks lie inside each other deeper than this program reads.\n\n## Example\n\nA sum of a thousand terms without parentheses or arrays.\n\n## What to do\n\nSplit the expression: give parts of it a name, or use `sum({...})`.",
    /// Data that carries the ending of a script.
    NOT_A_SCRIPT = "not-a-script":
        "## What it means\n\nThe file is a table of numbers (`#1`, `double name(rows,columns)`), as weather data has, not a script.\n\n## Example\n\n`RunScript(\"weather.mos\")`\n\n## What to do\n\nRead it as data, for instance with `readMatrix`, and run another file.",
    /// A text whose places do not fit in 32 bits.
    TEXT_TOO_LARGE = "text-too-large":
        "## What it means\n\nA text of 4 GiB or more was to be read as Modelica.\n\n## Example\n\nA result file given instead of a script.\n\n## What to do\n\nCheck the file name, or split the text into several files.",
    /// A text that is not UTF-8 (a warning).
    NOT_UTF8 = "not-utf8":
        "## What it means\n\nModelica texts are UTF-8 (MLS §13.4). This one is not; it was read as Latin-1, which gives every byte a character, perhaps not the one meant.\n\n## Example\n\nA file saved by an old editor with `\u{b0}C` in a comment.\n\n## What to do\n\nSave the file as UTF-8.",
}
