//! Numbers as laboratories write them: decimal points and commas, marks between thousands.
//!
//! `1.234` may be 1.234 or 1234. What the mark means is decided by the other cells of the column,
//! then by those of the file; where they contradict it, the cell is refused, never guessed.

/// What a cell can be as a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// No marks at all.
    Integer,
    /// This mark is the decimal one: `0.5`, `12,75`.
    Decimal(char),
    /// One mark with three digits after it: decimal, or between thousands.
    Ambiguous(char),
    /// Marks between thousands, and the decimal one if there is one: `1.300,5`, `1 013 250`.
    Grouped { group: char, decimal: Option<char> },
}

/// Marks that only ever stand between thousands.
const ONLY_GROUPS: [char; 6] = ['\'', '’', ' ', '\u{a0}', '\u{202f}', '\u{2009}'];

/// The form of a cell; `None` where it is not a number.
pub(crate) fn form(cell: &str) -> Option<Form> {
    let digits = cell.strip_prefix(['+', '-', '−']).unwrap_or(cell);
    let (mantissa, exponent) = match digits.find(['e', 'E', 'd', 'D']) {
        Some(at) => (&digits[..at], Some(&digits[at + 1..])),
        None => (digits, None),
    };
    if let Some(exponent) = exponent {
        let exponent = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
        if exponent.is_empty() || !exponent.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
    }
    if mantissa.bytes().all(|byte| byte.is_ascii_digit()) {
        return (!mantissa.is_empty()).then_some(Form::Integer);
    }
    let is_mark = |c: char| c == '.' || c == ',' || ONLY_GROUPS.contains(&c);
    let known = mantissa.chars().all(|c| c.is_ascii_digit() || is_mark(c));
    if !known || !mantissa.contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    marked(mantissa, exponent.is_some())
}

fn marked(mantissa: &str, has_exponent: bool) -> Option<Form> {
    let count = |mark: char| mantissa.matches(mark).count();
    let (points, commas) = (count('.'), count(','));
    let group = mantissa.chars().find(|c| ONLY_GROUPS.contains(c));
    let last = mantissa.rfind(['.', ',']);
    let decimal_at = |at: usize| (&mantissa[..at], mantissa[at..].chars().next().unwrap_or('.'));
    match (points, commas, group, last) {
        (0, 0, Some(group), _) => {
            is_grouped(mantissa, group).then_some(Form::Grouped { group, decimal: None })
        }
        (1, 0, None, Some(at)) | (0, 1, None, Some(at)) => {
            let (before, mark) = decimal_at(at);
            let after = mantissa.len() - at - 1;
            let thousands = after == 3 && (1..=3).contains(&before.len());
            let ambiguous = thousands && !before.starts_with('0') && !has_exponent;
            Some(if ambiguous { Form::Ambiguous(mark) } else { Form::Decimal(mark) })
        }
        (_, 0, None, _) => {
            is_grouped(mantissa, '.').then_some(Form::Grouped { group: '.', decimal: None })
        }
        (0, _, None, _) => {
            is_grouped(mantissa, ',').then_some(Form::Grouped { group: ',', decimal: None })
        }
        (_, _, group, Some(at)) => {
            let (before, mark) = decimal_at(at);
            let other = if mark == '.' { ',' } else { '.' };
            let group = group.unwrap_or(other);
            let is_number = is_grouped(before, group);
            is_number.then_some(Form::Grouped { group, decimal: Some(mark) })
        }
        _ => None,
    }
}

/// Whether all parts between the marks have three digits, the first one to three.
fn is_grouped(text: &str, mark: char) -> bool {
    let mut parts = text.split(mark);
    let is_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let first = parts.next().unwrap_or_default();
    (1..=3).contains(&first.len())
        && is_digits(first)
        && parts.all(|part| part.len() == 3 && is_digits(part))
}

impl Form {
    /// The decimal mark that this form is evidence of.
    pub(crate) fn decimal(self) -> Option<char> {
        match self {
            Form::Decimal(mark) | Form::Grouped { decimal: Some(mark), .. } => Some(mark),
            Form::Grouped { group: '.', .. } => Some(','),
            Form::Grouped { group: ',', .. } => Some('.'),
            _ => None,
        }
    }
}

/// The value of a cell whose decimal mark is known.
pub(crate) fn value(cell: &str, decimal: char) -> Option<f64> {
    // The common case allocates nothing.
    if decimal == '.'
        && let Ok(value) = cell.parse()
    {
        return Some(value);
    }
    let mut plain = String::with_capacity(cell.len());
    for c in cell.chars() {
        match c {
            c if c == decimal => plain.push('.'),
            'd' | 'D' => plain.push('e'),
            '−' => plain.push('-'),
            c if c == '.' || c == ',' || ONLY_GROUPS.contains(&c) => {}
            c => plain.push(c),
        }
    }
    plain.parse().ok()
}

/// What stands for a value that is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Missing {
    /// An empty cell, `NaN`, `n/a`, dashes.
    Nothing,
    /// An instrument or a spreadsheet says why: `OVRFLW`, `#DIV/0!`.
    Reason,
}

/// Whether a cell says that there is no value.
pub(crate) fn missing(cell: &str) -> Option<Missing> {
    const NOTHING: [&str; 12] = [
        "nan", "n/a", "na", "#n/a", "#nv", "#n/v", "n.a.", "null", "none", "missing", "nil", "n.d.",
    ];
    const REASON: [&str; 20] = [
        "ovrflw",
        "overflow",
        "ovfl",
        "ovld",
        "overload",
        "overrange",
        "over",
        "undrflw",
        "underflow",
        "underrange",
        "o.l.",
        "ol",
        "#div/0!",
        "#value!",
        "#wert!",
        "#num!",
        "#zahl!",
        "1.#qnan",
        "1.#ind",
        "1.#inf",
    ];
    if cell.is_empty() || cell.chars().all(|c| matches!(c, '-' | '–' | '—')) {
        return Some(Missing::Nothing);
    }
    // The longest word has nine letters.
    if cell.len() > 12 || !cell.is_ascii() {
        return None;
    }
    let lower = cell.to_ascii_lowercase();
    let bare = lower.strip_prefix(['+', '-']).unwrap_or(&lower);
    if NOTHING.contains(&bare) {
        return Some(Missing::Nothing);
    }
    REASON.contains(&bare).then_some(Missing::Reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms() {
        for (cell, expected) in [
            ("12", Some(Form::Integer)),
            ("-0.5", Some(Form::Decimal('.'))),
            ("0,998", Some(Form::Decimal(','))),
            ("1,234", Some(Form::Ambiguous(','))),
            ("1.234", Some(Form::Ambiguous('.'))),
            ("1.234E+02", Some(Form::Decimal('.'))),
            ("1.2345", Some(Form::Decimal('.'))),
            ("1234.567", Some(Form::Decimal('.'))),
            ("5.", Some(Form::Decimal('.'))),
            (".5", Some(Form::Decimal('.'))),
            ("1.300,5", Some(Form::Grouped { group: '.', decimal: Some(',') })),
            ("1.013.250", Some(Form::Grouped { group: '.', decimal: None })),
            ("1'013'250.25", Some(Form::Grouped { group: '\'', decimal: Some('.') })),
            ("1 013,2", Some(Form::Grouped { group: ' ', decimal: Some(',') })),
            ("1.5D-3", Some(Form::Decimal('.'))),
            ("1.1o2", None),
            ("05.03.2024", None),
            ("1,2,3", None),
            ("1.23,4.5", None),
            ("1e", None),
            ("e5", None),
            (".", None),
            ("-", None),
            ("", None),
        ] {
            assert_eq!(form(cell), expected, "{cell}");
        }
    }

    #[test]
    fn values() {
        assert_eq!(value("1.013.250,5", ','), Some(1_013_250.5));
        assert_eq!(value("1,013,250.5", '.'), Some(1_013_250.5));
        assert_eq!(value("−1'000,5E+2", ','), Some(-100_050.0));
        assert_eq!(value("1.5D-3", '.'), Some(1.5e-3));
        assert_eq!(value("0.1", '.'), Some(0.1));
    }

    #[test]
    fn words_for_missing_values() {
        for cell in ["", "-", "---", "NaN", "n/a", "NA", "#N/A", "-nan"] {
            assert_eq!(missing(cell), Some(Missing::Nothing), "{cell}");
        }
        for cell in ["OVRFLW", "+over", "#DIV/0!"] {
            assert_eq!(missing(cell), Some(Missing::Reason), "{cell}");
        }
        for cell in ["0", "nano", "rest", "+", "inf", "#REF!"] {
            assert_eq!(missing(cell), None, "{cell}");
        }
    }
}
