//! How one clock follows from another: exactly, in fractions (MLS §16.5.2).

use num_rational::Ratio;
use num_traits::{CheckedAdd, CheckedDiv, CheckedMul, CheckedSub, Zero};

/// A fraction.
pub(super) type Rational = Ratio<i128>;

/// What leads from one clock to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Conversion {
    /// `subSample(u, factor)`; `None` where the factor is inferred.
    Sub(Option<i64>),
    /// `superSample(u, factor)`; `None` where the factor is inferred.
    Super(Option<i64>),
    /// `shiftSample(u, shiftCounter, resolution)`: by so many intervals of u.
    Shift(Rational),
    /// `backSample(u, backCounter, resolution)`: by so many intervals of u.
    Back(Rational),
    /// `Clock(c, solverMethod)`: the same ticks.
    Same,
    /// `noClock(u)`: any clock of the same base.
    Any,
}

/// When a clock ticks: at shift, shift + interval, shift + 2·interval, …
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grid {
    /// In seconds, or in ticks of the base clock.
    pub(super) interval: Rational,
    /// In the same unit.
    pub(super) shift: Rational,
}

impl Conversion {
    /// The ticks of the value from those of the argument; `None` where they do not follow, `Err`
    /// where the numbers are too large.
    pub(super) fn forward(self, of: Grid) -> Option<Result<Grid, ()>> {
        let interval = of.interval;
        Some(match self {
            Conversion::Sub(factor) => scaled(of, Rational::from(i128::from(factor?))),
            Conversion::Super(factor) => scaled(of, Rational::new(1, i128::from(factor?))),
            Conversion::Shift(by) => shifted(of, interval, by),
            Conversion::Back(by) => shifted(of, interval, -by),
            Conversion::Same => Ok(of),
            Conversion::Any => return None,
        })
    }

    /// The ticks of the argument from those of the value.
    pub(super) fn backward(self, of: Grid) -> Option<Result<Grid, ()>> {
        match self {
            Conversion::Sub(factor) => Conversion::Super(factor).forward(of),
            Conversion::Super(factor) => Conversion::Sub(factor).forward(of),
            Conversion::Shift(by) => Conversion::Back(by).forward(of),
            Conversion::Back(by) => Conversion::Shift(by).forward(of),
            other => other.forward(of),
        }
    }

    /// Whether ticks of the argument and of the value can belong together, where the factor is to
    /// be inferred: it must be a whole number.
    pub(super) fn admits(self, of: Grid, value: Grid) -> bool {
        let factor = match self {
            Conversion::Sub(None) => value.interval.checked_div(&of.interval),
            Conversion::Super(None) => of.interval.checked_div(&value.interval),
            _ => return true,
        };
        factor.is_some_and(|factor| factor.is_integer()) && of.shift == value.shift
    }
}

fn scaled(grid: Grid, factor: Rational) -> Result<Grid, ()> {
    let interval = grid.interval.checked_mul(&factor).ok_or(())?;
    Ok(Grid { interval, ..grid })
}

fn shifted(grid: Grid, interval: Rational, by: Rational) -> Result<Grid, ()> {
    let distance = interval.checked_mul(&by).ok_or(())?;
    let shift = grid.shift.checked_add(&distance).ok_or(())?;
    Ok(Grid { shift, ..grid })
}

impl Grid {
    /// Ticks at 0, interval, 2·interval, …
    pub(super) fn of(interval: Rational) -> Grid {
        Grid { interval, shift: Rational::zero() }
    }

    /// By how much a clock ticks before another one of its base.
    pub(super) fn is_before_base(&self) -> bool {
        Rational::zero().checked_sub(&self.shift).is_none_or(|early| early > Rational::zero())
    }
}

/// The nearest number.
pub(super) fn number(value: Rational) -> f64 {
    *value.numer() as f64 / *value.denom() as f64
}
