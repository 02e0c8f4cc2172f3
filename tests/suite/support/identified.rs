//! Problems that the program identifies, and what it says of them.

use super::program::{folder, gapi};
use serde_json::Value;

/// The result of a problem, and everything that was printed.
pub(crate) fn solved(files: &[(&str, &str)]) -> (Value, String) {
    let folder = folder(files);
    let (code, out, error) = gapi(&folder, &["identify", "p.toml", "--out", "o", "--plain"]);
    assert_eq!(code, 0, "{out}{error}");
    let text = std::fs::read_to_string(folder.path().join("o/result.json")).unwrap();
    (serde_json::from_str(&text).unwrap(), out + &error)
}

/// What was said of a problem that is refused.
pub(crate) fn refused(files: &[(&str, &str)]) -> String {
    let (code, out, error) = gapi(&folder(files), &["identify", "p.toml", "--out", "o", "--plain"]);
    assert_ne!(code, 0, "{out}");
    error
}

/// Value and standard error of a parameter; an exact fit has none.
pub(crate) fn parameter(result: &Value, name: &str) -> [f64; 2] {
    let all = result["parameters"].as_array().unwrap();
    let found = all.iter().find(|own| own["name"] == name).unwrap_or_else(|| panic!("{name}"));
    ["value", "deviation"].map(|key| found[key].as_f64().unwrap_or(f64::NAN))
}

#[track_caller]
pub(crate) fn assert_near(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} is not {expected}");
}
