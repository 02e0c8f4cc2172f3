//! Numbers as sentences and tables have them.

use crate::elementary;

/// A number as short as it can be read.
pub fn short(value: f64) -> String {
    let magnitude = value.abs();
    match value {
        _ if value == 0.0 => "0".to_owned(),
        _ if !value.is_finite() => format!("{value}"),
        _ if !(1e-3..1e5).contains(&magnitude) => format!("{value:.3e}"),
        _ => {
            let digits = (3 - elementary::log10(magnitude).floor() as i32).clamp(0, 6) as usize;
            format!("{value:.digits$}")
        }
    }
}

/// `1 individual`, `2 individuals`.
pub(super) fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}
