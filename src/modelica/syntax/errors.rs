//! What can be wrong with a text.

use crate::codes;

codes! {
    /// Anything the grammar does not allow that has no code of its own.
    SYNTAX_ERROR = "syntax-error":
        "## What it means\n\nThe text violates the Modelica grammar (MLS appendix A) at the position shown.\n\n## Example\n\n`x = 1 + ;`\n\n## What to do\n\nThe message shows what was found and what is allowed there.",
    /// A statement, equation or element without its terminator.
    MISSING_SEMICOLON = "missing-semicolon":
        "## What it means\n\nAn element, equation or statement is not closed by `;`. In a script, a line break also ends a statement; in a class it does not.\n\n## Example\n\n`Real x` followed by `Real y;`\n\n## What to do\n\nWrite `;` at the position shown.",
    /// A bracket without its partner.
    UNCLOSED_BRACKET = "unclosed-bracket":
        "## What it means\n\nA bracket `(`, `[` or `{` has no closing partner, or a closing one has no opening partner, or the two are of different kinds.\n\n## Example\n\n`y = sin(x;`\n\n## What to do\n\nClose the bracket shown, or remove it.",
    /// `end` with a wrong name or keyword, or without one.
    MISMATCHED_END = "mismatched-end":
        "## What it means\n\nThe name or keyword after `end` does not match the class, loop or clause that it closes, or a construct is never closed.\n\n## Example\n\n`model Cell ... end Stack;`\n\n## What to do\n\nClose constructs in reverse order of opening; repeat the name of the class after `end`.",
    /// A string or quoted identifier or comment that the text ends in.
    UNCLOSED_STRING = "unclosed-string":
        "## What it means\n\nA string, a quoted identifier or a comment `/*` has no end.\n\n## Example\n\n`resultFile = \"run1;`\n\n## What to do\n\nWrite the closing `\"`, `'` or `*/`.",
    /// A character that no Modelica text may hold outside strings and comments.
    BAD_CHARACTER = "bad-character":
        "## What it means\n\nA character is not allowed in Modelica code. Outside strings, comments and quoted identifiers, only the letters `a`-`z`, digits, `_` and the operators are allowed.\n\n## Example\n\n`a != b`\n\n## What to do\n\nWrite the Modelica form named in the message, or quote the identifier.",
    /// Brackets, blocks or operators inside each other beyond what is read.
    NESTING_TOO_DEEP = "nesting-too-deep":
        "## What it means\n\nExpressions, brackets or blocks are nested more deeply than this program supports.\n\n## Example\n\nA thousand parentheses inside each other. A sum, a product or operands of `and` and `or` are a list, which may have any length.\n\n## What to do\n\nSplit the expression: assign parts of it to variables.",
    /// Data that carries the ending of a script.
    NOT_A_SCRIPT = "not-a-script":
        "## What it means\n\nThe file is a table of numbers (`#1`, `double name(rows,columns)`), as weather data has, not a script.\n\n## Example\n\n`RunScript(\"weather.mos\")`\n\n## What to do\n\nRead it as data, for instance with `readMatrix`, and run another file.",
    /// A text whose places do not fit in 32 bits.
    TEXT_TOO_LARGE = "text-too-large":
        "## What it means\n\nThe Modelica text has 4 GiB or more.\n\n## Example\n\nA result file given instead of a script.\n\n## What to do\n\nCheck the file name, or split the text into several files.",
    /// A text that is not UTF-8 (a warning).
    NOT_UTF8 = "not-utf8":
        "## What it means\n\nModelica files are UTF-8 (MLS §13.4). This one is not; it was read as Latin-1, so characters may be wrong.\n\n## Example\n\nA file saved by an old editor with `\u{b0}C` in a comment.\n\n## What to do\n\nSave the file as UTF-8.",
}
