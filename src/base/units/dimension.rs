//! Dimensions: products of powers of the base units of the SI.

use std::fmt;

/// Exponents are counted in parts of this, so that roots of units stay exact.
const PARTS: i32 = 60;

const SYMBOLS: [&str; 7] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// What a unit measures: exponents of kg, m, s, A, K, mol, cd and rad; factors such as that of `kPa`
/// do not matter. Radians are numbers where dimensions are compared or printed (SI brochure §2.3.4);
/// their exponent distinguishes rad/s from Hz in the definitions of units that FMI has. Neither are
/// revolutions compared, whose exponent tells whether a unit counts them, as rpm and Hz do.
#[derive(Debug, Clone, Copy, Default)]
pub struct Dimension([i32; 9]);

/// Where the exponents of radians and of revolutions are.
const RADIANS: usize = 7;
const REVOLUTIONS: usize = 8;

impl PartialEq for Dimension {
    fn eq(&self, other: &Dimension) -> bool {
        self.0[..SYMBOLS.len()] == other.0[..SYMBOLS.len()]
    }
}

impl Eq for Dimension {}

impl Dimension {
    /// That of a pure number.
    pub(crate) const ONE: Dimension = Dimension([0; 9]);

    /// The dimension with whole exponents.
    pub const fn new(exponents: [i32; 8]) -> Dimension {
        let mut parts = [0; 9];
        let mut at = 0;
        while at < 8 {
            parts[at] = exponents[at] * PARTS;
            at += 1;
        }
        Dimension(parts)
    }

    /// The exponents of kg, m, s, A, K, mol, cd and rad; `None` where one is broken.
    pub fn exponents(self) -> Option<[i32; 8]> {
        let mut own = [0; 8];
        own.copy_from_slice(&self.0[..REVOLUTIONS]);
        let is_whole = own.iter().all(|parts| parts % PARTS == 0);
        is_whole.then(|| own.map(|parts| parts / PARTS))
    }

    /// The same for a unit that counts revolutions.
    pub(super) const fn of_revolutions(self) -> Dimension {
        let mut parts = self.0;
        parts[REVOLUTIONS] = PARTS;
        Dimension(parts)
    }

    /// The exponents of radians and of revolutions; `None` where one is broken.
    pub(super) fn of_angles(self) -> Option<[i32; 2]> {
        let [radians, revolutions] = [self.0[RADIANS], self.0[REVOLUTIONS]];
        let is_whole = radians % PARTS == 0 && revolutions % PARTS == 0;
        is_whole.then_some([radians / PARTS, revolutions / PARTS])
    }

    /// The sum of the exponents.
    pub fn times(self, other: Dimension) -> Option<Dimension> {
        self.zip(other, i32::checked_add)
    }

    /// The difference of the exponents.
    pub fn over(self, other: Dimension) -> Option<Dimension> {
        self.zip(other, i32::checked_sub)
    }

    /// The power; `None` if an exponent is not a multiple of 1/60.
    pub fn power(self, exponent: f64) -> Option<Dimension> {
        let mut out = [0; 9];
        for (out, part) in out.iter_mut().zip(self.0) {
            let value = f64::from(part) * exponent;
            if value.fract() != 0.0 || value.abs() > 1e6 {
                return None;
            }
            *out = value as i32;
        }
        Some(Dimension(out))
    }

    fn zip(self, other: Dimension, f: fn(i32, i32) -> Option<i32>) -> Option<Dimension> {
        let mut out = [0; 9];
        for (at, out) in out.iter_mut().enumerate() {
            *out = f(self.0[at], other.0[at])?;
        }
        Some(Dimension(out))
    }
}

impl fmt::Display for Dimension {
    /// As a unit of the Modelica grammar (MLS ch. 19), such as `kg.m/s2` or `1`; broken exponents
    /// in parentheses.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let power = |(symbol, parts): (&str, i32)| match (parts / PARTS, parts % PARTS) {
            (1, 0) => symbol.to_owned(),
            (whole, 0) => format!("{symbol}{whole}"),
            _ => format!("{symbol}({parts}/{PARTS})"),
        };
        let all = || SYMBOLS.into_iter().zip(self.0);
        let above: Vec<String> = all().filter(|(_, n)| *n > 0).map(power).collect();
        let below: Vec<String> =
            all().filter(|(_, n)| *n < 0).map(|(symbol, n)| power((symbol, -n))).collect();
        f.write_str(&if above.is_empty() { "1".to_owned() } else { above.join(".") })?;
        match below.len() {
            0 => Ok(()),
            1 => write!(f, "/{}", below[0]),
            _ => write!(f, "/({})", below.join(".")),
        }
    }
}
