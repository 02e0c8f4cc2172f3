//! Units as laboratories write them: `mA/cm²`, `°C`, `W m^-2 K^-1`, `sec`.

use super::Unit;
use super::parse::unit;

/// Words for units, in lower case, and their symbols.
const WORDS: &[(&str, &str)] = &[
    ("sec", "s"),
    ("secs", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("mins", "min"),
    ("minute", "min"),
    ("minutes", "min"),
    ("hr", "h"),
    ("hrs", "h"),
    ("hour", "h"),
    ("hours", "h"),
    ("day", "d"),
    ("days", "d"),
    ("sekunde", "s"),
    ("sekunden", "s"),
    ("minuten", "min"),
    ("stunde", "h"),
    ("stunden", "h"),
    ("tage", "d"),
    ("volt", "V"),
    ("volts", "V"),
    ("amp", "A"),
    ("amps", "A"),
    ("ampere", "A"),
    ("watt", "W"),
    ("watts", "W"),
    ("ohm", "Ohm"),
    ("ohms", "Ohm"),
    ("kelvin", "K"),
    ("celsius", "degC"),
    ("degc", "degC"),
    ("degf", "degF"),
    ("kwh", "kW.h"),
    ("wh", "W.h"),
    ("ah", "A.h"),
    ("mah", "mA.h"),
    ("sccm", "cm3/min"),
    ("msec", "ms"),
];

/// Parts of a whole. `ppt` is not among them: it stands for 1e-12 and for 1e-3.
const PARTS: &[(&str, f64)] = &[
    ("%", 1e-2),
    ("‰", 1e-3),
    ("ppm", 1e-6),
    ("ppmv", 1e-6),
    ("ppmw", 1e-6),
    ("ppb", 1e-9),
    ("ppbv", 1e-9),
    ("ppbw", 1e-9),
];

/// A unit as a laboratory writes it; `None` where it is not known.
pub fn written(text: &str) -> Option<Unit> {
    let text = text.trim();
    let lower = text.to_lowercase();
    if let Some((_, factor)) = PARTS.iter().find(|(name, _)| *name == lower) {
        return Some(Unit { factor: *factor, ..Unit::ONE });
    }
    if text == "-" {
        return Some(Unit::ONE);
    }
    unit(&normalized(text))
}

/// The unit in the grammar of Modelica, where it can be brought into it.
pub fn normalized(text: &str) -> String {
    let lower = text.trim().to_lowercase();
    if let Some((_, symbol)) = WORDS.iter().find(|(word, _)| *word == lower) {
        return (*symbol).to_owned();
    }
    let mut plain = String::with_capacity(text.len());
    for c in text.trim().chars() {
        match c {
            '°' | 'º' => plain.push_str("deg"),
            '℃' => plain.push_str("degC"),
            'µ' | 'μ' => plain.push('u'),
            'Ω' | '\u{2126}' => plain.push_str("Ohm"),
            '²' => plain.push('2'),
            '³' => plain.push('3'),
            '¹' => plain.push('1'),
            '⁻' | '−' => plain.push('-'),
            '·' | '⋅' | '*' | ' ' | '\u{a0}' => {
                if !plain.ends_with(['.', '/']) {
                    plain.push('.');
                }
            }
            '^' => {}
            '/' => {
                if plain.ends_with('.') {
                    plain.pop();
                }
                plain.push('/');
            }
            c => plain.push(c),
        }
    }
    quotients_joined(plain)
}

/// `W/m2/K`, which the grammar does not have, as `W/(m2.K)`.
fn quotients_joined(text: String) -> String {
    let mut parts = text.split('/');
    let (Some(first), rest) = (parts.next(), parts.collect::<Vec<_>>()) else { return text };
    if rest.len() < 2 || text.contains('(') {
        return text;
    }
    format!("{first}/({})", rest.join("."))
}

/// The unit that a name ends in: `mV` in `U_mV`, `minutes` in `Elapsed minutes`. A guess, for a
/// message only.
pub fn suggested(name: &str) -> Option<&str> {
    let (front, unit) = name.trim().rsplit_once(['_', ' '])?;
    let has_name = front.chars().any(char::is_alphabetic);
    (has_name && !["-", "1"].contains(&unit) && written(unit).is_some()).then_some(unit)
}

/// The unit for a message: as written, or words where there is none.
pub fn in_words(unit: &str) -> &str {
    if unit.is_empty() { "no unit" } else { unit }
}
