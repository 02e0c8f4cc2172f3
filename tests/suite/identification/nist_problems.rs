//! Problems of NIST StRD against their certified values: models, derivatives, descents, statistics and
//! endings together. All 27 with the default search are measured by `cargo bench --bench nist`.

use crate::nist::{Dataset, MODELS};
use gapilib::internals::identify::problem::EndingKind;

/// Values to 6 digits; standard errors to 5, where residuals are not those of rounding.
fn assert_certified(name: &str, method: &str, start: Option<usize>, budget: u64) {
    let dataset = Dataset::read(name);
    let found = dataset.solve(method, start, 0, budget);
    let [values, errors] = dataset.digits(&found);
    assert_eq!(
        found.outcome.ending.kind,
        EndingKind::Minimum,
        "{name}: {}",
        found.outcome.ending.words
    );
    assert!(values >= 6.0, "{name}: {values} digits");
    assert!(errors >= 5.0 || dataset.sum < 1e-20, "{name}: {errors} digits of standard errors");
}

#[test]
fn least_squares_reach_the_certified_values_from_the_nearer_start() {
    assert_eq!(MODELS.len(), 27);
    for (name, _) in MODELS {
        assert_certified(name, "lm", Some(1), 20_000);
    }
}

#[test]
fn the_default_search_reaches_certified_values_without_a_start() {
    for name in ["Misra1a", "Chwirut2", "DanWood", "Nelson", "BoxBOD", "MGH10", "Eckerle4"] {
        assert_certified(name, "genetic", None, 20_000);
    }
}

/// MGH17 from the far start ends on a plateau, with a sum 20,000 times larger.
#[test]
fn a_plateau_is_not_called_a_minimum() {
    let dataset = Dataset::read("MGH17");
    let found = dataset.solve("lm", Some(0), 0, 20_000);
    let is_reached = dataset.digits(&found)[0] > 4.0;
    assert!(
        is_reached || found.outcome.ending.kind != EndingKind::Minimum,
        "{}",
        found.outcome.ending.words
    );
}
