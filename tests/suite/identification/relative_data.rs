//! Data in arbitrary units: scales and offsets that are estimated are those of a model that has them as
//! parameters, with the same minimum, standard errors, profiles and bands.

use crate::support::program::written as gapi;
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

const MODEL: &str = include_str!("../../data/models/relative_data_model.mo");

/// Times with z of k = 0.6 and q = 0.25 times 37 plus 4, and x times 37 plus 1, both with errors, and
/// z times 37 times errors.
fn data() -> String {
    let mut text = String::from("time,blot,other,ratio\n");
    let errors =
        [0.3, -0.5, 0.2, 0.6, -0.4, -0.1, 0.5, -0.7, 0.1, 0.4, -0.3, 0.2, -0.6, 0.3, 0.1, -0.2];
    let (k, q): (f64, f64) = (0.6, 0.25);
    for (j, e) in errors.iter().enumerate() {
        let t = 0.5 * (j + 1) as f64;
        let x = (-k * t).exp();
        let z = k / (q - k) * (x - (-q * t).exp());
        let other = errors[(7 * j + 3) % 16];
        text += &format!(
            "{t},{:.5},{:.5},{:.5}\n",
            37.0 * z + 4.0 + e,
            37.0 * x + 1.0 + 3.0 * other,
            37.0 * z * (0.08 * other).exp()
        );
    }
    text
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("chain.mo"), MODEL).unwrap();
    fs::write(folder.path().join("d.csv"), data()).unwrap();
    folder
}

fn problem(parameters: &str, outputs: &str) -> String {
    format!(
        "model = \"Chain\"\nfiles = [\"chain.mo\"]\n[parameters]\nk = {{ min = 0.3, max = 1.5 }}\n\
         q = {{ min = 0.05, max = 0.6 }}\n{parameters}[[experiment]]\nname = \"run\"\n\
         data = \"d.csv\"\ntolerance = 1e-10\noutputs = {{ {outputs} }}\n"
    )
}

fn solved(folder: &TempDir, name: &str, text: &str) -> (Value, String) {
    let file = format!("{name}.toml");
    fs::write(folder.path().join(&file), text).unwrap();
    let (done, output) =
        gapi(folder.path(), &["identify", &file, "--out", name, "--profile", "--plain"]);
    assert!(done, "{output}");
    let text = fs::read_to_string(folder.path().join(name).join("result.json")).unwrap();
    (serde_json::from_str(&text).unwrap(), output)
}

fn parameter<'a>(result: &'a Value, name: &str) -> &'a Value {
    let all = result["parameters"].as_array().unwrap();
    all.iter().find(|own| own["name"] == name).unwrap()
}

#[track_caller]
fn near(a: &Value, b: &Value, relative: f64) {
    // The ends of what is not bounded are no numbers in both.
    if a == b {
        return;
    }
    let [a, b] = [a, b].map(|own| own.as_f64().unwrap());
    assert!((a - b).abs() <= relative * b.abs(), "{a} and {b}");
}

/// The same numbers as those of a model that has the coefficients of the series as parameters.
fn are_alike(relative: &Value, explicit: &Value, coefficients: &[(usize, &str, &str)]) {
    for name in ["k", "q"] {
        let [one, other] = [relative, explicit].map(|own| parameter(own, name));
        near(&one["value"], &other["value"], 1e-7);
        near(&one["deviation"], &other["deviation"], 1e-6);
        for end in 0..2 {
            near(&one["interval"][end], &other["interval"][end], 1e-6);
        }
        let profile = |result: &Value| {
            let all = result["profiles"]["profiles"].as_array().unwrap();
            all.iter().find(|own| own["name"] == name).unwrap()["interval"].clone()
        };
        let [one, other] = [relative, explicit].map(profile);
        for end in 0..2 {
            near(&one[end], &other[end], 1e-6);
        }
    }
    near(&relative["negative_log_likelihood"], &explicit["negative_log_likelihood"], 1e-9);
    near(&relative["degrees_of_freedom"], &explicit["degrees_of_freedom"], 0.0);
    assert_eq!(
        relative["inferred"]["likelihood"]["estimated"],
        explicit["inferred"]["likelihood"]["estimated"]
    );
    for (series, what, name) in coefficients {
        let (one, other) = (&relative["series"][series][what], parameter(explicit, name));
        near(&one["value"], &other["value"], 1e-6);
        near(&one["deviation"], &other["deviation"], 1e-6);
    }
    let bands = |result: &Value| result["inferred"]["bands"].as_array().unwrap().clone();
    for (one, other) in bands(relative).iter().zip(bands(explicit)) {
        for place in [20, 50, 90] {
            let [one, other] = [one, &other].map(|own| own["points"][place].clone());
            near(&one["y"], &other["y"], 1e-6);
            near(&one["confidence"], &other["confidence"], 1e-6);
        }
    }
}

#[test]
fn scale_and_offset_are_those_of_a_model_with_parameters() {
    let folder = folder();
    let (s, b) = ("s = { min = 1, max = 1000 }\n", "b = { min = -50, max = 50 }\n");
    let estimated = "scale = \"estimate\", offset = \"estimate\"";
    let (one, text) = solved(
        &folder,
        "linear",
        &problem("", &format!("signal = {{ column = \"blot\", {estimated} }}")),
    );
    assert!(text.contains(", scale 3") && text.contains(", offset "), "{text}");
    let explicit = problem(&format!("{s}{b}"), "scaled = \"blot\"");
    let (other, _) = solved(&folder, "explicit", &explicit);
    are_alike(&one, &other, &[(0, "scale", "s"), (0, "offset", "b")]);
    // Of the logarithm a scale is a shift.
    let error = "column = \"ratio\", error = \"lognormal\", sigma = \"estimate\"";
    let relative = format!("signal = {{ {error}, scale = \"estimate\" }}");
    let (one, _) = solved(&folder, "logarithm", &problem("", &relative));
    // The curve goes through the simulated points.
    let series = &one["series"][0];
    let curve = series["curve"].as_array().unwrap();
    let at = curve.iter().find(|point| point[0] == series["points"][4][0]).unwrap();
    near(&at[1], &series["points"][4][2], 1e-9);
    let explicit = problem(s, &format!("scaled = {{ {error} }}"));
    let (other, _) = solved(&folder, "explicit", &explicit);
    are_alike(&one, &other, &[(0, "scale", "s")]);
}

/// Its weights depend on the standard deviations, and these on it.
#[test]
fn a_scale_is_shared_by_series_with_deviations_of_their_own() {
    let folder = folder();
    let sigma = "sigma = \"estimate\"";
    let outputs = |names: [&str; 2], own: [&str; 2]| {
        format!(
            "{} = {{ column = \"blot\", {sigma}{} }}, {} = {{ column = \"other\", {sigma}{} }}",
            names[0], own[0], names[1], own[1]
        )
    };
    let shared = ", scale = \"gel\", offset = \"estimate\"";
    let relative = problem("", &outputs(["signal", "second"], [shared; 2]));
    let (one, text) = solved(&folder, "relative", &relative);
    assert!(text.contains("scale gel 3"), "{text}");
    let ranges =
        "s = { min = 1, max = 1000 }\nb = { min = -50, max = 50 }\nc = { min = -50, max = 50 }\n";
    let explicit = problem(ranges, &outputs(["scaled", "rescaled"], [""; 2]));
    let (other, _) = solved(&folder, "explicit", &explicit);
    let coefficients =
        [(0, "scale", "s"), (1, "scale", "s"), (0, "offset", "b"), (1, "offset", "c")];
    are_alike(&one, &other, &coefficients);
}

/// With a covariance that is given or estimated, also where a value is missing.
#[test]
fn scales_of_correlated_outputs_are_those_of_a_model_with_parameters() {
    let folder = folder();
    let cut = |(k, line): (usize, &str)| {
        let cells: Vec<&str> = line.split(',').collect();
        match k {
            5 => format!("{},,{}\n", cells[0], cells[2]),
            9 => format!("{},{},\n", cells[0], cells[1]),
            _ => format!("{},{},{}\n", cells[0], cells[1], cells[2]),
        }
    };
    let rows: String = data().lines().enumerate().map(cut).collect();
    fs::write(folder.path().join("d.csv"), rows).unwrap();
    let ranges =
        "s = { min = 1, max = 1000 }\nb = { min = -50, max = 50 }\nc = { min = -50, max = 50 }\n";
    let outputs = |names: [&str; 2], own: &str| {
        format!(
            "{} = {{ column = \"blot\"{own} }}, {} = {{ column = \"other\"{own} }}",
            names[0], names[1]
        )
    };
    let scale = ", scale = \"gel\", offset = \"estimate\"";
    for covariance in ["\"estimate\"", "[[0.2, 0.3], [0.3, 1.5]]"] {
        let of = |text: String| {
            text.replace(
                "[[experiment]]\n",
                &format!("[[experiment]]\ncovariance = {covariance}\n"),
            )
        };
        let relative = of(problem("", &outputs(["signal", "second"], scale)));
        let (one, _) = solved(&folder, "relative", &relative);
        let explicit = of(problem(ranges, &outputs(["scaled", "rescaled"], "")));
        let (other, _) = solved(&folder, "explicit", &explicit);
        let coefficients =
            [(0, "scale", "s"), (1, "scale", "s"), (0, "offset", "b"), (1, "offset", "c")];
        are_alike(&one, &other, &coefficients);
    }
}

#[test]
fn what_a_scale_makes_up_for_is_not_determined() {
    let folder = folder();
    let output = "signal = { column = \"blot\", scale = \"estimate\", offset = \"estimate\" }";
    let (result, text) = solved(&folder, "p", &problem("a = { min = 0.1, max = 10 }\n", output));
    assert!(text.contains("The data do not determine a: it does the same as"), "{text}");
    assert_eq!(parameter(&result, "a")["determined"], false);
    assert_eq!(result["degrees_of_freedom"], 12.0);
    assert!(result["series"][0]["scale"]["deviation"].is_null());
}

/// A signal that falls where the model rises has a scale of 0, and a negative one only where it may.
/// The start and the end of a relaxation, of which the scale is a difference that must stay positive:
/// neither is bounded, as each can follow the other.
#[test]
fn what_positive_scales_limit_is_not_called_a_bound() {
    let folder = folder();
    let model = "model Relax\n  parameter Real k = 1, a = 2, b = 0.3;\n  Real c(start = a, fixed = true);\n\
                 equation\n  der(c) = b - k*c;\nend Relax;\n";
    fs::write(folder.path().join("chain.mo"), model).unwrap();
    let text = "model = \"Relax\"\nfiles = [\"chain.mo\"]\n[parameters]\nk = { min = 0.3, max = 1.5 }\n\
                a = { min = 0.2, max = 20 }\nb = { min = 0.03, max = 3 }\n[[experiment]]\ndata = \"d.csv\"\n\
                outputs = { c = { column = \"other\", scale = \"estimate\", offset = \"estimate\" } }\n";
    let (result, said) = solved(&folder, "relax", text);
    for name in ["a", "b"] {
        let expected =
            format!("The data do not determine {name}: it does the same as an estimated");
        assert!(said.contains(&expected) && !said.contains("at least"), "{said}");
        assert!(parameter(&result, name)["standard_error"].is_null(), "{said}");
    }
}

#[test]
fn a_scale_is_positive_unless_it_may_have_any_sign() {
    let folder = folder();
    let rows = data();
    let negative = rows.lines().skip(1).map(|line| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        format!("{},{}\n", cells[0], 50.0 - cells[1])
    });
    let negative: String = negative.collect();
    fs::write(folder.path().join("d.csv"), format!("time,blot\n{negative}")).unwrap();
    let output = |scale: &str| {
        format!("signal = {{ column = \"blot\", scale = {scale}, offset = \"estimate\" }}")
    };
    let (any, _) = solved(&folder, "any", &problem("", &output("{ sign = \"any\" }")));
    let scale = any["series"][0]["scale"]["value"].as_f64().unwrap();
    assert!((scale + 38.0).abs() < 3.0, "{scale}");
    let (positive, _) = solved(&folder, "positive", &problem("", &output("\"estimate\"")));
    let scale = positive["series"][0]["scale"]["value"].as_f64().unwrap();
    assert!(scale >= 0.0, "{scale}");
    assert!(positive["fitness"].as_f64() > any["fitness"].as_f64());
    // What only falls follows no rise.
    let rises: String =
        (0..12).map(|t| format!("{t},{}\n", 5.0 - 4.0 * (-0.4 * f64::from(t)).exp())).collect();
    fs::write(folder.path().join("d.csv"), format!("time,blot\n{rises}")).unwrap();
    let falling = output("\"estimate\"").replace("signal", "second");
    let (zero, text) = solved(&folder, "zero", &problem("", &falling));
    assert_eq!(zero["series"][0]["scale"]["value"], 0.0);
    assert!(text.contains("The scale of run / second is 0: no positive one"), "{text}");
}

#[test]
fn validation_has_the_scale_of_what_was_fitted_and_scripts_have_the_same() {
    let folder = folder();
    let output = "signal = { column = \"blot\", scale = \"gel\", offset = \"ground\" }";
    let fitted = problem("", output);
    let kept = format!(
        "{fitted}[[experiment]]\nname = \"kept\"\ndata = \"d.csv\"\nvalidation = true\n\
         tolerance = 1e-10\noutputs = {{ {output} }}\n"
    );
    let (result, _) = solved(&folder, "kept", &kept);
    near(&result["validation"][0]["rmse"], &result["series"][0]["rmse"], 1e-6);
    let script = "problem = GAPILib.Problem(modelName = \"Chain\", files = {\"chain.mo\"},
  parameters = {GAPILib.Free(\"k\", min = 0.3, max = 1.5), GAPILib.Free(\"q\", min = 0.05, max = 0.6)},
  experiments = {GAPILib.Experiment(data = \"d.csv\", outputs = {\"signal\"}, columns = {\"blot\"},
    scales = {\"gel of any sign\"}, offsets = {\"ground\"}, tolerance = 1e-10)});
identify(problem);
";
    fs::write(folder.path().join("s.mos"), script).unwrap();
    let (done, text) = gapi(folder.path(), &["run", "s.mos"]);
    assert!(done, "{text}");
    let text = fs::read_to_string(folder.path().join("results/s/result.json")).unwrap();
    let other: Value = serde_json::from_str(&text).unwrap();
    near(&other["series"][0]["scale"]["value"], &result["series"][0]["scale"]["value"], 1e-7);
}

#[test]
fn what_scales_cannot_be_combined_with_is_refused_at_its_place() {
    let folder = folder();
    let scale = "scale = \"estimate\"";
    let both = |errors: [&str; 2]| {
        let own = |name: &str, column: &str, error: &str| {
            format!("{name} = {{ column = \"{column}\", scale = \"gel\"{error} }}")
        };
        format!("{}, {}", own("signal", "blot", errors[0]), own("second", "other", errors[1]))
    };
    let one = |own: &str| format!("signal = {{ column = \"blot\", {scale}, {own} }}");
    for (problem, words) in [
        (problem("", &one("error = \"student\"")), "its scale cannot be estimated"),
        (problem("", &one("sigma = 1, below = 20")), "values beyond a limit"),
        (problem("d = { min = 0.1, max = 2 }\n", &one("sigma = \"d*signal\"")), "a sigma that the"),
        (problem("", &one("error = \"lognormal\", offset = \"b\"")), "an offset cannot be"),
        (problem("", &both(["", ", error = \"lognormal\""])), "normal and with log-normal errors"),
        (problem("", "signal = { column = \"blot\", scale = \"gel 2\" }"), "is `gel 2`"),
        (problem("", "signal = { column = \"blot\", scale = 2 }"), "what is known is a `factor`"),
        (
            format!("fitness = \"huber\"\n{}", problem("", &one("offset = \"estimate\""))),
            "by least squares, not with `huber`",
        ),
        (
            format!(
                "{}[[experiment]]\ndata = \"d.csv\"\nvalidation = true\noutputs = {{ {} }}\n",
                problem("", "signal = \"blot\""),
                one("offset = \"estimate\"")
            ),
            "is for validation",
        ),
        (
            format!("{}[noise]\nz = \"estimate\"\n", problem("", &one("sigma = \"estimate\""))),
            "together with process noise",
        ),
    ] {
        fs::write(folder.path().join("p.toml"), &problem).unwrap();
        let (done, text) = gapi(folder.path(), &["identify", "p.toml", "--out", "o", "--plain"]);
        assert!(!done && text.contains(words), "{words}\n{problem}\n{text}");
        assert!(text.contains("p.toml:"), "no place: {text}");
    }
}
