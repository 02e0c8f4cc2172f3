//! What entries of experiments mean, and what is said where they cannot mean it.

use super::*;

/// A problem of the tank with these parameters and this experiment, and its data.
fn tank(parameters: &str, experiment: &str, data: &str) -> [(&'static str, String); 2] {
    let problem = format!(
        "model = \"Free\"\nfiles = [\"tank.mo\"]\nbands = false\n[parameters]\n{parameters}\n\
         [[experiment]]\ndata = \"d.csv\"\n{experiment}\n"
    );
    [("p.toml", problem), ("d.csv", data.to_owned())]
}

fn noisy(h0: f64) -> String {
    table("time,h", |t| (height(t, h0, 0.0) + 0.01 * (7.0 * t).sin()).to_string())
}

/// A state that an experiment sets has this start value, as it has in `gapi simulate --set`.
#[test]
fn a_state_that_is_set_begins_there() {
    let k = "k = { min = 0.1, max = 5 }\narea = { fixed = 2 }";
    let fits = ["set", "start"].map(|entry| {
        solved(&tank(k, &format!("{entry} = {{ h = 2 }}\noutputs = {{ h = \"h\" }}"), &noisy(2.0)))
    });
    assert_eq!(fits[0].fitness, fits[1].fitness);
    assert!((fits[0].parameters[0].value - 0.8).abs() < 0.01, "{}", fits[0].text());
    let files = tank(k, "set = { q = 2 }\noutputs = { h = \"h\" }", &noisy(2.0));
    let said = refusal(&files[0].1, &files[1].1);
    assert_eq!(said, "`q` is not a state of `Free`");
}

/// A name that `[parameters]` does not list is named, and not the type of a String.
#[test]
fn values_of_experiments_name_parameters() {
    let parameters = "k_a = { min = 0.1, max = 5 }\narea = { fixed = 2 }";
    let files = tank(parameters, "set = { k = \"2*k_b\" }\noutputs = { h = \"h\" }", &noisy(1.0));
    let said = refusal(&files[0].1, &files[1].1);
    assert_eq!(said, "the value of `k` names `k_b`, which is not in `[parameters]`");
    let files = tank(parameters, "set = { k = \"2 mm\" }\noutputs = { h = \"h\" }", &noisy(1.0));
    let said = refusal(&files[0].1, &files[1].1);
    assert_eq!(said, "`k` is a number, but its value is \"2 mm\"");
}

/// Delays that may be short are said to be slow.
#[test]
fn short_delays_are_said_to_be_slow() {
    for (min, is_said) in [(0.001, true), (0.1, false)] {
        let parameters = format!(
            "k = {{ min = 0.1, max = 5 }}\narea = {{ fixed = 2 }}\ntau = {{ min = {min}, max = 1 }}"
        );
        let output = "outputs = { h = { column = \"h\", delay = \"tau\" } }";
        let text = solved(&tank(&parameters, output, &noisy(1.0))).text();
        assert_eq!(
            text.contains("the range of the delay `tau` begins at 0.001"),
            is_said,
            "{text}"
        );
    }
}

/// The parts into which an experiment is cut were measured with one instrument.
#[test]
fn parts_of_an_experiment_share_a_scale() {
    let parameters = "k = { min = 0.1, max = 5 }\narea = { fixed = 2 }\n\
                      h = { min = 0.1, max = 9, initial = true }";
    let experiment = "segments = [2]\noutputs = { h = { column = \"h\", scale = \"estimate\" }, \
                      q = { column = \"q\" } }";
    let data = table("time,h,q", |t| {
        let h = height(t, 2.0, 0.0);
        format!("{},{}", 5.0 * h + 0.01 * (7.0 * t).sin(), 0.8 * h + 0.001 * (9.0 * t).sin())
    });
    let found = solved(&tank(parameters, experiment, &data));
    let scales = found.series.iter().filter_map(|own| own.scale.as_ref());
    let scales: Vec<f64> = scales.map(|own| own.value).collect();
    assert!(scales.len() == 2 && scales[0] == scales[1], "{scales:?}\n{}", found.text());
    assert!((scales[0] - 5.0).abs() < 0.05, "{scales:?}");
}

/// Errors that replicates have in common have no covariance that could be estimated.
#[test]
fn replicates_with_common_errors_are_not_given_a_covariance() {
    let k = "k = { min = 0.1, max = 5 }\narea = { fixed = 2 }";
    let errors = |t: f64| 0.1 * (7.3 * t * t).sin();
    let data = table("time,a,b", |t| {
        let h = height(t, 1.0, 0.0) + errors(t);
        format!("{},{}", h + 0.01 * (31.0 * t).sin(), h + 0.01 * (17.0 * t).sin())
    });
    let text = solved(&tank(k, "outputs = { h = [\"a\", \"b\"] }", &data)).text();
    assert!(text.contains("two replicates of experiment 1 / h are correlated"), "{text}");
    assert!(!text.contains("covariance = "), "{text}");
}
