//! Units in heads: `U [V]`, `U (V)`, `U/V`, `U, V`, `U in V`, or a row of their own.

use crate::units;

/// What stands for a unit and is none that converts.
const OTHER: [&str; 8] = ["#", "-", "1", "bits", "a.u.", "arb.u.", "counts", "pH"];

/// The name and the unit of a column's head. The unit is one that is known; any other text in
/// brackets belongs to the header, but the name alone denotes the column, too.
pub(crate) fn split(head: &str) -> (Option<&str>, Option<String>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        let Some(inner) = head.strip_suffix(close) else { continue };
        let Some((name, unit)) = inner.rsplit_once(open) else { continue };
        // `x[2]` and `der(s)` are names of variables.
        let is_apart = name.ends_with([' ', '\u{a0}']);
        let is_subscript =
            unit.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b',' | b' ' | b':'));
        let known = known(unit);
        if is_subscript || !is_apart && (known.is_none() || name == "der") || name.trim().is_empty()
        {
            continue;
        }
        return (Some(name.trim()), known);
    }
    for mark in [" in ", "/", ","] {
        let Some((name, unit)) = head.split_once(mark) else { continue };
        let unit = known(unit);
        if unit.is_some() && !name.trim().is_empty() {
            return (Some(name.trim()), unit);
        }
    }
    (None, None)
}

/// What a head has in brackets or a row of units has in its cell, where it is not known.
pub(crate) fn unknown(head: &str, cell: Option<&str>) -> Option<String> {
    let in_brackets = match split(head) {
        (Some(name), None) => head.trim().strip_prefix(name),
        _ => None,
    };
    let found = cell.or(in_brackets).map(|text| without_brackets(text.trim()));
    let is_unknown =
        |text: &&str| !text.is_empty() && !OTHER.contains(text) && known(text).is_none();
    found.filter(is_unknown).map(str::to_owned)
}

/// The unit of a cell in a row of units; none where it does not convert.
pub(crate) fn of_cell(cell: &str) -> Option<String> {
    known(without_brackets(cell))
}

/// Whether a cell of the row below the names may be a unit.
pub(crate) fn is_unit(cell: &str) -> bool {
    let inner = without_brackets(cell);
    OTHER.contains(&inner) || inner.len() < cell.len() || known(inner).is_some()
}

/// A unit that is known, by itself or followed by words: `V vs. Ref.`.
fn known(text: &str) -> Option<String> {
    let text = text.trim();
    let is_known = |text: &str| !text.is_empty() && text != "1" && units::written(text).is_some();
    if is_known(text) {
        return Some(text.to_owned());
    }
    let (first, rest) = text.split_once(' ')?;
    let is_remark = rest.starts_with("vs") || rest.starts_with('(');
    (is_remark && is_known(first)).then(|| first.to_owned())
}

/// `[V]`, `(V)` and `<I>` without the brackets.
pub(crate) fn without_brackets(text: &str) -> &str {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some(inner) = text.strip_prefix(open).and_then(|rest| rest.strip_suffix(close)) {
            return inner.trim();
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_are_split() {
        let owned = |name, unit: &str| (Some(name), Some(unit.to_owned()));
        for (head, expected) in [
            ("t [s]", owned("t", "s")),
            ("U (V)", owned("U", "V")),
            ("I(mA)", owned("I", "mA")),
            ("Ewe/V", owned("Ewe", "V")),
            ("i/mA cm^-2", owned("i", "mA cm^-2")),
            ("T/°C", owned("T", "°C")),
            ("U, V", owned("U", "V")),
            ("Leistung / W", owned("Leistung", "W")),
            ("Zeit in s", owned("Zeit", "s")),
            ("Temperatur in \u{b0}C", owned("Temperatur", "\u{b0}C")),
            ("Globalstrahlung in W/m2", owned("Globalstrahlung", "W/m2")),
            ("Zeit in Minuten", owned("Zeit", "Minuten")),
            ("change in x", (None, None)),
            ("Vf [V vs. Ref.]", owned("Vf", "V")),
            ("U (old)", (Some("U"), None)),
            ("x[2]", (None, None)),
            ("der(s)", (None, None)),
            ("V(t)", (None, None)),
            ("U/I", (None, None)),
            ("U", (None, None)),
        ] {
            assert_eq!(split(head), expected, "{head}");
        }
        let none = |head: &str| unknown(head, None);
        assert_eq!(none("u [hp]").as_deref(), Some("hp"));
        assert_eq!(unknown("u", Some("gpm")).as_deref(), Some("gpm"));
        assert_eq!(
            [none("u [W]"), none("V(t)"), none("u"), unknown("u", Some("-"))],
            [const { None }; 4]
        );
    }
}
