//! Ranges of axes, their ticks and labels.

use super::figure::Scale;
use crate::elementary;

/// An axis with its range decided.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ticks {
    pub(super) scale: Scale,
    pub(super) low: f64,
    pub(super) high: f64,
    /// Values with a label.
    pub(super) major: Vec<(f64, String)>,
    /// Values without.
    pub(super) minor: Vec<f64>,
    /// Power of ten by which labels are divided.
    pub(super) exponent: i32,
}

impl Ticks {
    /// Ticks for these values, about `count` of them; values that cannot be shown do not count.
    pub(crate) fn new(values: impl Iterator<Item = f64>, scale: Scale, count: usize) -> Ticks {
        let shown = values.filter(|value| is_shown(*value, scale));
        let range = shown.fold(None, |range: Option<(f64, f64)>, value| {
            let (low, high) = range.unwrap_or((value, value));
            Some((low.min(value), high.max(value)))
        });
        match scale {
            Scale::Linear => (count..)
                .map(|count| linear(range.unwrap_or((0.0, 1.0)), count))
                .find(|ticks| ticks.major.len() > 2)
                .expect("more steps give more ticks"),
            Scale::Logarithmic => logarithmic(range.unwrap_or((1.0, 10.0)), count),
        }
    }

    /// The same range without ticks.
    pub(super) fn unlabelled(self) -> Ticks {
        Ticks { major: Vec::new(), minor: Vec::new(), ..self }
    }

    /// The place of a value between 0 and 1; `None` if it cannot be shown.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        if !is_shown(value, self.scale) {
            return None;
        }
        Some(match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Logarithmic => {
                (elementary::log10(value) - elementary::log10(self.low))
                    / (elementary::log10(self.high) - elementary::log10(self.low))
            }
        })
    }
}

/// Values beyond 1e150 are not data; leaving them out keeps differences finite.
fn is_shown(value: f64, scale: Scale) -> bool {
    match scale {
        Scale::Linear => value.abs() <= 1e150,
        Scale::Logarithmic => (1e-150..=1e150).contains(&value),
    }
}

fn linear((low, high): (f64, f64), count: usize) -> Ticks {
    const MARGIN: f64 = 0.04;
    let smallest = 1e-9 * low.abs().max(high.abs()).max(1e-150);
    let width = if high - low > smallest { high - low } else { low.abs().max(1e-12) };
    let middle = 0.5 * (low + high);
    let half = width * (0.5 + MARGIN);
    let (low, high) = (middle - half, middle + half);
    let (mantissa, power) = nice_step((high - low) / count as f64);
    let step = f64::from(mantissa) * elementary::powi(10f64, power);
    let exponent = label_exponent(low.abs().max(high.abs()));
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    let decimals = (exponent - power).clamp(0, 17) as usize;
    let major = (first..=last)
        .map(|k| {
            let scaled = k as f64 * f64::from(mantissa) * elementary::powi(10f64, power - exponent);
            (k as f64 * step, signed(&format!("{scaled:.decimals$}")))
        })
        .collect();
    Ticks { scale: Scale::Linear, low, high, major, minor: Vec::new(), exponent }
}

/// 1, 2 or 5 and a power of ten: the smallest such step that is not less than `rough`.
fn nice_step(rough: f64) -> (i32, i32) {
    let power = elementary::log10(rough).floor() as i32;
    let mantissa = rough / elementary::powi(10f64, power);
    match [1, 2, 5].into_iter().find(|nice| f64::from(*nice) >= mantissa * (1.0 - 1e-9)) {
        Some(nice) => (nice, power),
        None => (1, power + 1),
    }
}

/// A multiple of three for values that are awkward to write out, else 0.
fn label_exponent(largest: f64) -> i32 {
    if (0.05..1e5).contains(&largest) {
        return 0;
    }
    3 * (elementary::log10(largest) / 3.0).floor() as i32
}

fn signed(text: &str) -> String {
    text.replace('-', "\u{2212}")
}

fn logarithmic((low, high): (f64, f64), count: usize) -> Ticks {
    let margin = (0.04 * elementary::log10(high / low)).max(0.02);
    let (low, high) =
        (low * elementary::powf(10f64, -margin), high * elementary::powf(10f64, margin));
    let decades = |value: f64| elementary::log10(value);
    let (first, last) = (decades(low).ceil() as i32, decades(high).floor() as i32);
    if last - first < 1 {
        let narrow = linear_within(low, high, count);
        return Ticks { scale: Scale::Logarithmic, low, high, ..narrow };
    }
    let every = (last - first) as usize / (count + 1) + 1;
    let major = (first..=last)
        .filter(|decade| decade.rem_euclid(every as i32) == 0)
        .map(|decade| (elementary::powi(10f64, decade), power_of_ten(decade)))
        .collect();
    let minor = if every > 1 {
        (first..=last).map(|decade| elementary::powi(10f64, decade)).collect()
    } else {
        (first - 1..=last)
            .flat_map(|decade| (2..10).map(move |k| f64::from(k) * elementary::powi(10f64, decade)))
            .filter(|value| (low..=high).contains(value))
            .collect()
    };
    Ticks { scale: Scale::Logarithmic, low, high, major, minor, exponent: 0 }
}

/// Linear ticks without a margin: for a logarithmic axis of less than a decade.
fn linear_within(low: f64, high: f64, count: usize) -> Ticks {
    let mut ticks = linear((low, high), count);
    ticks.major.retain(|(value, _)| (low..=high).contains(value));
    ticks
}

/// `10^{−3}`, in the form that [`super::svg::Svg::text`] raises.
pub(crate) fn power_of_ten(exponent: i32) -> String {
    signed(&format!("10^{{{exponent}}}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(values: [f64; 2], scale: Scale) -> Vec<String> {
        Ticks::new(values.into_iter(), scale, 5).major.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn linear_ticks_are_round_and_within_the_range() {
        assert_eq!(labels([0.0, 1.0], Scale::Linear), ["0.0", "0.5", "1.0"]);
        assert_eq!(labels([0.3, 0.9], Scale::Linear), ["0.4", "0.6", "0.8"]);
        assert_eq!(labels([-3e-3, 4e-3], Scale::Linear), ["−2", "0", "2", "4"]);
        assert_eq!(labels([2.0, 2.0], Scale::Linear), ["1.0", "1.5", "2.0", "2.5", "3.0"]);
    }

    #[test]
    fn logarithmic_ticks_are_decades() {
        assert_eq!(labels([2e-6, 3e-3], Scale::Logarithmic), ["10^{−5}", "10^{−4}", "10^{−3}"]);
        assert_eq!(labels([2.0, 5.0], Scale::Logarithmic), ["2", "3", "4", "5"]);
    }

    #[test]
    fn what_cannot_be_shown_has_no_place() {
        let ticks = Ticks::new([1e-3, -1.0, f64::NAN].into_iter(), Scale::Logarithmic, 5);
        assert_eq!(ticks.place(0.0), None);
        assert_eq!(ticks.place(f64::INFINITY), None);
        assert!((ticks.place(1e-3).unwrap() - 0.5).abs() < 1e-9);
    }
}
