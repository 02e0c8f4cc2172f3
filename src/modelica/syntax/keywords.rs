//! The keywords of Modelica (MLS §2.3.3), and what those who read a text without the grammar need to
//! know of each. The grammar spells them for itself, in `grammar/lexical.pest`.

/// Neither begins a statement nor closes one's block.
pub(crate) const CONTINUES: u8 = 1;
/// A statement is not complete after it.
pub(crate) const LEAVES_OPEN: u8 = 2;
/// A blank separates it from a bracket before and after it.
pub(crate) const SET_OFF: u8 = 4;

/// In the order of the alphabet.
const KEYWORDS: [(&str, u8); 59] = [
    ("algorithm", LEAVES_OPEN),
    ("and", CONTINUES | LEAVES_OPEN | SET_OFF),
    ("annotation", CONTINUES | LEAVES_OPEN | SET_OFF),
    ("block", LEAVES_OPEN),
    ("break", 0),
    ("class", LEAVES_OPEN),
    ("connect", 0),
    ("connector", LEAVES_OPEN),
    ("constant", LEAVES_OPEN),
    ("constrainedby", CONTINUES | LEAVES_OPEN | SET_OFF),
    ("der", LEAVES_OPEN),
    ("discrete", LEAVES_OPEN),
    ("each", LEAVES_OPEN | SET_OFF),
    ("else", LEAVES_OPEN | SET_OFF),
    ("elseif", LEAVES_OPEN | SET_OFF),
    ("elsewhen", LEAVES_OPEN | SET_OFF),
    ("encapsulated", LEAVES_OPEN),
    ("end", 0),
    ("enumeration", 0),
    ("equation", LEAVES_OPEN),
    ("expandable", LEAVES_OPEN),
    ("extends", LEAVES_OPEN | SET_OFF),
    ("external", LEAVES_OPEN | SET_OFF),
    ("false", 0),
    ("final", LEAVES_OPEN | SET_OFF),
    ("flow", LEAVES_OPEN),
    ("for", SET_OFF),
    ("function", LEAVES_OPEN),
    ("if", SET_OFF),
    ("import", LEAVES_OPEN | SET_OFF),
    ("impure", LEAVES_OPEN),
    ("in", CONTINUES | LEAVES_OPEN | SET_OFF),
    ("initial", LEAVES_OPEN),
    ("inner", LEAVES_OPEN),
    ("input", LEAVES_OPEN),
    ("loop", CONTINUES | LEAVES_OPEN | SET_OFF),
    ("model", LEAVES_OPEN),
    ("not", LEAVES_OPEN | SET_OFF),
    ("operator", LEAVES_OPEN),
    ("or", CONTINUES | LEAVES_OPEN | SET_OFF),
    ("outer", LEAVES_OPEN),
    ("output", LEAVES_OPEN),
    ("package", LEAVES_OPEN),
    ("parameter", LEAVES_OPEN),
    ("partial", LEAVES_OPEN),
    ("protected", LEAVES_OPEN),
    ("public", LEAVES_OPEN),
    ("pure", LEAVES_OPEN),
    ("record", LEAVES_OPEN),
    ("redeclare", LEAVES_OPEN),
    ("replaceable", LEAVES_OPEN),
    ("return", 0),
    ("stream", LEAVES_OPEN),
    ("then", CONTINUES | LEAVES_OPEN | SET_OFF),
    ("true", 0),
    ("type", LEAVES_OPEN),
    ("when", SET_OFF),
    ("while", SET_OFF),
    ("within", LEAVES_OPEN),
];

/// All keywords, in the order of the alphabet.
pub fn keywords() -> impl Iterator<Item = &'static str> {
    KEYWORDS.iter().map(|(word, _)| *word)
}

/// Whether a word is a keyword (MLS §2.3.3).
///
/// ```
/// use gapilib_modelica::syntax::is_keyword;
///
/// assert!(is_keyword("elsewhen") && !is_keyword("elsewhere"));
/// ```
pub fn is_keyword(word: &str) -> bool {
    find(word).is_some()
}

/// Whether a word is a keyword of which this is known.
pub(crate) fn has(word: &str, what: u8) -> bool {
    find(word).is_some_and(|known| known & what != 0)
}

fn find(word: &str) -> Option<u8> {
    let place = KEYWORDS.binary_search_by(|(known, _)| (*known).cmp(word)).ok()?;
    Some(KEYWORDS[place].1)
}
