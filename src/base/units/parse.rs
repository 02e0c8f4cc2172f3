//! Unit expressions (MLS §19.1): `N.m`, `kg.m2`, `W/(m2.K)`, `1/s`.

use super::Unit;
use super::dimension::Dimension;
use std::f64::consts::PI;

/// A symbol, its exponents, and how many of the coherent SI unit it is.
type Symbol = (&'static str, [i32; 8], f64);

/// Symbols with the exponents of kg, m, s, A, K, mol, cd, rad (MLS §19.1; SI brochure, tables 2 and 4).
/// Those of the second list take no prefix.
const PREFIXED: &[Symbol] = &[
    ("m", [0, 1, 0, 0, 0, 0, 0, 0], 1.0),
    ("g", [1, 0, 0, 0, 0, 0, 0, 0], 1e-3),
    ("s", [0, 0, 1, 0, 0, 0, 0, 0], 1.0),
    ("A", [0, 0, 0, 1, 0, 0, 0, 0], 1.0),
    ("K", [0, 0, 0, 0, 1, 0, 0, 0], 1.0),
    ("mol", [0, 0, 0, 0, 0, 1, 0, 0], 1.0),
    ("cd", [0, 0, 0, 0, 0, 0, 1, 0], 1.0),
    ("rad", [0, 0, 0, 0, 0, 0, 0, 1], 1.0),
    ("sr", [0; 8], 1.0),
    ("Hz", [0, 0, -1, 0, 0, 0, 0, 0], 1.0),
    ("N", [1, 1, -2, 0, 0, 0, 0, 0], 1.0),
    ("Pa", [1, -1, -2, 0, 0, 0, 0, 0], 1.0),
    // Not of the grammar, but what many tools write for N.m.
    ("Nm", [1, 2, -2, 0, 0, 0, 0, 0], 1.0),
    ("J", [1, 2, -2, 0, 0, 0, 0, 0], 1.0),
    ("W", [1, 2, -3, 0, 0, 0, 0, 0], 1.0),
    ("C", [0, 0, 1, 1, 0, 0, 0, 0], 1.0),
    ("V", [1, 2, -3, -1, 0, 0, 0, 0], 1.0),
    ("F", [-1, -2, 4, 2, 0, 0, 0, 0], 1.0),
    ("Ohm", [1, 2, -3, -2, 0, 0, 0, 0], 1.0),
    ("S", [-1, -2, 3, 2, 0, 0, 0, 0], 1.0),
    ("Wb", [1, 2, -2, -1, 0, 0, 0, 0], 1.0),
    ("T", [1, 0, -2, -1, 0, 0, 0, 0], 1.0),
    ("H", [1, 2, -2, -2, 0, 0, 0, 0], 1.0),
    ("lm", [0, 0, 0, 0, 0, 0, 1, 0], 1.0),
    ("lx", [0, -2, 0, 0, 0, 0, 1, 0], 1.0),
    ("Bq", [0, 0, -1, 0, 0, 0, 0, 0], 1.0),
    ("Gy", [0, 2, -2, 0, 0, 0, 0, 0], 1.0),
    ("Sv", [0, 2, -2, 0, 0, 0, 0, 0], 1.0),
    ("kat", [0, 0, -1, 0, 0, 1, 0, 0], 1.0),
    ("l", [0, 3, 0, 0, 0, 0, 0, 0], 1e-3),
    ("L", [0, 3, 0, 0, 0, 0, 0, 0], 1e-3),
    ("bar", [1, -1, -2, 0, 0, 0, 0, 0], 1e5),
    ("eV", [1, 2, -2, 0, 0, 0, 0, 0], 1.602_176_634e-19),
];
const PLAIN: &[Symbol] = &[
    ("min", [0, 0, 1, 0, 0, 0, 0, 0], 60.0),
    ("h", [0, 0, 1, 0, 0, 0, 0, 0], 3600.0),
    ("d", [0, 0, 1, 0, 0, 0, 0, 0], 86_400.0),
    ("degC", [0, 0, 0, 0, 1, 0, 0, 0], 1.0),
    ("degF", [0, 0, 0, 0, 1, 0, 0, 0], 5.0 / 9.0),
    ("deg", [0, 0, 0, 0, 0, 0, 0, 1], PI / 180.0),
    ("rev", [0, 0, 0, 0, 0, 0, 0, 1], 2.0 * PI),
    ("rpm", [0, 0, -1, 0, 0, 0, 0, 1], PI / 30.0),
];
/// Those that count revolutions or cycles: Hz without radians, the others with 2 pi of them.
const OF_REVOLUTIONS: [&str; 3] = ["Hz", "rev", "rpm"];
/// Zeros of the scales of temperature, in kelvin.
const OFFSETS: &[(&str, f64)] = &[("degC", 273.15), ("degF", 459.67 * 5.0 / 9.0)];
const PREFIXES: &[(&str, f64)] = &[
    ("da", 1e1),
    ("Y", 1e24),
    ("Z", 1e21),
    ("E", 1e18),
    ("P", 1e15),
    ("T", 1e12),
    ("G", 1e9),
    ("M", 1e6),
    ("k", 1e3),
    ("h", 1e2),
    ("d", 1e-1),
    ("c", 1e-2),
    ("m", 1e-3),
    ("u", 1e-6),
    ("n", 1e-9),
    ("p", 1e-12),
    ("f", 1e-15),
    ("a", 1e-18),
    ("z", 1e-21),
    ("y", 1e-24),
];

/// The deepest nesting of parentheses.
const MAX_DEPTH: usize = 20;

/// A unit; `None` for an empty string, for symbols that are not known and for what is not a unit
/// expression.
pub fn unit(text: &str) -> Option<Unit> {
    let mut reader = Reader { rest: text };
    let mut found = reader.expression(0)?;
    if let Some((_, offset)) = OFFSETS.iter().find(|(symbol, _)| *symbol == text) {
        found.offset = *offset;
    }
    reader.rest.is_empty().then_some(found)
}

/// The dimension of a unit, see [`unit()`].
pub fn dimension(text: &str) -> Option<Dimension> {
    unit(text).map(|unit| unit.dimension)
}

struct Reader<'a> {
    rest: &'a str,
}

impl Reader<'_> {
    fn eat(&mut self, c: char) -> bool {
        let rest = self.rest.strip_prefix(c);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    /// `numerator [ "/" denominator ]`, the denominator a single factor.
    fn expression(&mut self, depth: usize) -> Option<Unit> {
        let mut product = self.factor(depth)?;
        while self.eat('.') {
            product = product.times(self.factor(depth)?)?;
        }
        if self.eat('/') {
            product = product.over(self.factor(depth)?)?;
        }
        Some(product)
    }

    fn factor(&mut self, depth: usize) -> Option<Unit> {
        if depth > MAX_DEPTH {
            return None;
        }
        if self.eat('(') {
            let inner = self.expression(depth + 1)?;
            return self.eat(')').then_some(inner);
        }
        if self.eat('1') {
            return Some(Unit::ONE);
        }
        let end = self.rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(self.rest.len());
        let (symbol, rest) = self.rest.split_at(end);
        self.rest = rest;
        let base = of_symbol(symbol)?;
        match self.exponent()? {
            Some(exponent) => base.power(exponent),
            None => Some(base),
        }
    }

    fn exponent(&mut self) -> Option<Option<f64>> {
        let digits = self.rest.strip_prefix(['+', '-']).unwrap_or(self.rest);
        let signed = digits.len() < self.rest.len();
        let count = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
        if count == 0 {
            return (!signed).then_some(None);
        }
        let (text, rest) = self.rest.split_at(count + usize::from(signed));
        self.rest = rest;
        text.parse().ok().filter(|n: &f64| n.abs() < 100.0).map(Some)
    }
}

/// A symbol by itself, else one with a prefix.
fn of_symbol(symbol: &str) -> Option<Unit> {
    let known = |list: &[Symbol], symbol: &str| {
        let (_, exponents, factor) = list.iter().find(|(name, ..)| *name == symbol)?;
        let plain = Dimension::new(*exponents);
        let dimension =
            if OF_REVOLUTIONS.contains(&symbol) { plain.of_revolutions() } else { plain };
        Some(Unit { dimension, factor: *factor, offset: 0.0 })
    };
    known(PREFIXED, symbol).or_else(|| known(PLAIN, symbol)).or_else(|| {
        let split = |(prefix, factor): &(&str, f64)| Some((symbol.strip_prefix(prefix)?, *factor));
        let with = |(rest, factor)| {
            let unit = known(PREFIXED, rest)?;
            Some(Unit { factor: unit.factor * factor, ..unit })
        };
        PREFIXES.iter().filter_map(split).filter_map(with).next()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_one_dimension_are_equal() {
        let pairs = [
            ("N.m", "J"),
            ("kg.m/s2", "N"),
            ("W/(m2.K)", "kg.s-3.K-1"),
            ("V/A", "kOhm"),
            ("1/s", "Hz"),
            ("rad/s", "rpm"),
            ("mm2", "m2"),
            ("dam", "km"),
            ("bar", "mPa"),
            ("cd.sr", "lm"),
            ("C/mol", "A.s/mol"),
            ("(kg.m)/(s.s)", "N"),
            ("kNm/rad", "N.m"),
        ];
        for (one, other) in pairs {
            assert!(dimension(one).is_some(), "{one}");
            assert_eq!(dimension(one), dimension(other), "{one} {other}");
        }
        assert_ne!(dimension("m"), dimension("m2"));
        assert_ne!(dimension("min"), dimension("m"));
    }

    #[test]
    fn what_is_no_known_unit_has_no_dimension() {
        for text in ["", "foo", "m/", "m/s/s", "m s", "(m", "m-", "m2.", "%", "kmin", "m999", "ü"]
        {
            assert_eq!(dimension(text), None, "{text}");
        }
        assert_eq!(dimension(&"(".repeat(10_000)), None);
    }

    #[test]
    fn dimensions_print_as_units() {
        for text in ["kg.m/s2", "1/s", "1", "kg/(s3.K)", "m2"] {
            assert_eq!(dimension(text).unwrap().to_string(), text);
        }
    }
}
