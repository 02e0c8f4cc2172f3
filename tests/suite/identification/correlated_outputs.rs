//! Outputs that are measured at the same instants with correlated errors. The expected numbers were
//! computed with numpy and SciPy: generalized least squares with the covariance that is given, and with
//! RᵀR/n of the residuals, or that of the EM algorithm, iterated to the end.

use crate::support::program::written as gapi;
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

const MODEL: &str = "model Pair
  parameter Real k = 0.5;
  parameter Real c = 1;
  parameter Real d = 2;
  Real a = c*exp(-k*time);
  Real b = d*(1 - exp(-k*time));
end Pair;
";

/// k = 0.6, c = 1.5, d = 2; standard deviations 0.05 and 0.1, correlation 0.8.
const DATA: &str = "0.29999999999999999,1.2171442344059273,0.30415726516195968
0.59999999999999998,1.0654038691401679,0.55745677662903037
0.89999999999999991,0.82379392590184186,0.74943289858325324
1.2,0.73848117919610523,1.0862624784085133
1.5,0.58668109723847406,1.153863478612756
1.8,0.49427547666127397,1.3240033100075732
2.0999999999999996,0.46133275056865991,1.5040959927058952
2.3999999999999999,0.36093275911956746,1.5806566032064659
2.6999999999999997,0.30257000615666874,1.5970345932498018
2.9999999999999996,0.2881533545305161,1.7442860255250072
3.2999999999999998,0.21375732222791316,1.720017871270302
3.5999999999999996,0.091681020526584001,1.651814127384803
3.8999999999999995,0.30924028437686824,2.0560147035972478
4.2000000000000002,0.13894445077760648,1.8518034299042918
4.5,0.086085903708012348,1.8467472715015323
4.7999999999999998,0.021268862533408414,1.6649907932224903
5.0999999999999996,0.034676927806711867,1.9662464473963635
5.3999999999999995,0.014048089243883746,1.8646953949382532
5.6999999999999993,0.11308522722017392,1.9675179820759405
6,0.031004139691471172,1.9299081348467357
";
const GIVEN: &str = "[[0.0025, 0.004], [0.004, 0.01]]";

/// The data, also without some values, and in two halves.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let head = |text: &str| format!("time [s],a,b\n{text}");
    let rows: Vec<&str> = DATA.lines().collect();
    let cut = |(k, row): (usize, &&str)| {
        let cells: Vec<&str> = row.split(',').collect();
        match k {
            3 => format!("{},,{}\n", cells[0], cells[2]),
            7 | 12 => format!("{},{},\n", cells[0], cells[1]),
            _ => format!("{row}\n"),
        }
    };
    write("pair.mo", MODEL);
    write("d.csv", &head(DATA));
    write("missing.csv", &head(&rows.iter().enumerate().map(cut).collect::<String>()));
    write("first.csv", &head(&rows[..10].join("\n")));
    write("last.csv", &head(&rows[10..].join("\n")));
    folder
}

fn problem(head: &str, experiments: &str) -> String {
    format!(
        "model = \"Pair\"\nfiles = [\"pair.mo\"]\n{head}[parameters]\n\
         k = {{ min = 0.1, max = 3 }}\nc = {{ min = 0.3, max = 5 }}\nd = {{ min = 0.3, max = 5 }}\n\
         {experiments}"
    )
}

fn experiment(data: &str, entries: &str) -> String {
    format!(
        "[[experiment]]\nname = \"{data}\"\ndata = \"{data}.csv\"\n{entries}\n\
         outputs = {{ a = \"a\", b = \"b\" }}\n"
    )
}

fn solved(folder: &TempDir, text: &str) -> (Value, String) {
    fs::write(folder.path().join("p.toml"), text).unwrap();
    let (done, output) = gapi(folder.path(), &["identify", "p.toml", "--out", "o", "--plain"]);
    assert!(done, "{text}\n{output}");
    let result = fs::read_to_string(folder.path().join("o/result.json")).unwrap();
    (serde_json::from_str(&result).unwrap(), output)
}

/// What is expected: values and standard errors of k, c and d, and -log L.
struct Expected {
    values: [f64; 3],
    deviations: [f64; 3],
    log: f64,
}

impl Expected {
    #[track_caller]
    fn compare(&self, result: &Value) {
        let parameters = result["parameters"].as_array().unwrap();
        for ((own, value), deviation) in parameters.iter().zip(self.values).zip(self.deviations) {
            let near = |found: &Value, expected: f64, relative: f64| {
                let found = found.as_f64().unwrap();
                assert!((found / expected - 1.0).abs() < relative, "{found}, not {expected}");
            };
            near(&own["value"], value, 1e-7);
            near(&own["deviation"], deviation, 1e-6);
        }
        let log = result["negative_log_likelihood"].as_f64().unwrap();
        assert!((log - self.log).abs() < 1e-9, "{log}, not {}", self.log);
    }
}

#[test]
fn a_given_covariance_weighs_both_outputs_at_once() {
    let folder = folder();
    let expected = Expected {
        values: [0.600686128230605, 1.49175032224547, 1.994423880656573],
        deviations: [0.017122139122818, 0.034267035673921, 0.032167124378999],
        log: -62.22820430833,
    };
    let covariance = format!("covariance = {GIVEN}");
    let (result, text) = solved(&folder, &problem("", &experiment("d", &covariance)));
    expected.compare(&result);
    let line = "covariance   d: sigma (given) a 0.05, b 0.1; correlation of a and b 0.8";
    assert!(text.contains(line) && text.contains("for 37 degrees of freedom"), "{text}");
    let page = fs::read_to_string(folder.path().join("o/report.html")).unwrap();
    assert!(page.contains("Covariance of d: sigma (given) a 0.05"), "no covariance in the page");
    // The same by correlations, and by names in another order.
    let sigmas = "[[experiment]]\ndata = \"d.csv\"\noutputs = { a = { column = \"a\", sigma = 0.05 }, \
                  b = { column = \"b\", sigma = 0.1 } }\n";
    let correlation = "{ outputs = [\"b\", \"a\"], correlation = [[1, 0.8], [0.8, 1]] }";
    let (result, _) = solved(&folder, &problem(&format!("covariance = {correlation}\n"), sigmas));
    expected.compare(&result);
    // Rows that lack an output have the marginal density of the other one.
    let (result, text) = solved(&folder, &problem("", &experiment("missing", &covariance)));
    let expected = Expected {
        values: [0.596372807573248, 1.489307727510634, 1.999099221422321],
        deviations: [0.017666714322604, 0.034576370492166, 0.033125420229907],
        log: -56.29043885896,
    };
    expected.compare(&result);
    assert!(text.contains("3 of 20 rows lack an output"), "{text}");
}

#[test]
fn a_covariance_is_estimated_by_the_determinant_criterion() {
    let folder = folder();
    let estimated = "covariance = \"estimate\"";
    let (result, text) = solved(&folder, &problem("", &experiment("d", estimated)));
    let expected = Expected {
        values: [0.605607898232644, 1.501659673349772, 1.988420293879219],
        deviations: [0.017509857093785, 0.036298631710272, 0.030444628197335],
        log: -63.26882936623,
    };
    expected.compare(&result);
    assert!(text.contains("correlation of a and b 0.85\n"), "{text}");
    assert_eq!(result["inferred"]["likelihood"]["estimated"], 6);
    let (result, _) = solved(&folder, &problem("", &experiment("missing", estimated)));
    let expected = Expected {
        values: [0.600294111863568, 1.498762154877799, 1.991362717004108],
        deviations: [0.019297901022594, 0.039889377725157, 0.032319197146462],
        log: -57.1787847275,
    };
    expected.compare(&result);
}

/// Different matrices of two experiments, an estimated one that they share, and one for each.
#[test]
fn experiments_have_covariances_of_their_own_or_share_one() {
    let folder = folder();
    let both = |entries: [&str; 2]| {
        problem("", &(experiment("first", entries[0]) + &experiment("last", entries[1])))
    };
    let given = format!("covariance = {GIVEN}");
    let other = "covariance = [[0.01, -0.002], [-0.002, 0.0025]]";
    let (result, _) = solved(&folder, &both([&given, other]));
    let expected = Expected {
        values: [0.606265278962593, 1.500455101625385, 1.98904879389791],
        deviations: [0.015079211739744, 0.033861002119764, 0.019297040769306],
        log: -31.03446667648,
    };
    expected.compare(&result);
    let log = |text: &str| {
        let (result, _) = solved(&folder, text);
        let count = result["covariances"].as_array().unwrap().len();
        (result["negative_log_likelihood"].as_f64().unwrap(), count)
    };
    let shared = "covariance = { matrix = \"estimate\", group = \"g\" }";
    let all = problem(
        "covariance = \"estimate\"\n",
        &(experiment("first", "") + &experiment("last", "")),
    );
    for text in [both([shared; 2]), all] {
        let (found, count) = log(&text);
        assert!((found + 63.26882936623).abs() < 1e-9 && count == 1, "{found} {count}");
    }
    let (found, count) = log(&both(["covariance = \"estimate\""; 2]));
    assert!((found + 68.034975691).abs() < 1e-8 && count == 2, "{found} {count}");
}

/// An experiment that measures one of the outputs has its variance, as if the others were not named; a name
/// that no experiment has is refused.
#[test]
fn outputs_that_were_not_measured_take_no_part() {
    let folder = folder();
    let alone = "[[experiment]]\nname = \"last\"\ndata = \"last.csv\"\noutputs = { a = ";
    let own = experiment("first", &format!("covariance = {GIVEN}"));
    let named = format!("covariance = {{ outputs = [\"a\", \"b\"], matrix = {GIVEN} }}\n");
    let (result, text) = solved(&folder, &problem(&named, &format!("{own}{alone}\"a\" }}\n")));
    assert!(!text.contains("NaN") && !text.contains("nan"), "{text}");
    let sigma = format!("{own}{alone}{{ column = \"a\", sigma = 0.05 }} }}\n");
    let (expected, _) = solved(&folder, &problem("", &sigma));
    let log = |result: &Value| result["negative_log_likelihood"].as_f64().unwrap();
    assert!((log(&result) - log(&expected)).abs() < 1e-9, "{} {}", log(&result), log(&expected));
    let wrong = problem(&named.replace("\"b\"", "\"other\""), &own);
    fs::write(folder.path().join("p.toml"), wrong + alone + "\"a\" }\n").unwrap();
    let (done, output) = gapi(folder.path(), &["identify", "p.toml", "--out", "o", "--plain"]);
    assert!(!done && output.contains("`covariance` names `other`"), "{output}");
}

#[test]
fn scripts_have_covariances() {
    let folder = folder();
    let script = |entries: &str| {
        format!(
            "problem = GAPILib.Problem(modelName = \"Pair\", files = {{\"pair.mo\"}}, parameters = {{\
             GAPILib.Free(\"k\", min = 0.1, max = 3), GAPILib.Free(\"c\", min = 0.3, max = 5), \
             GAPILib.Free(\"d\", min = 0.3, max = 5)}}, experiments = {{GAPILib.Experiment(\
             data = \"d.csv\", outputs = {{\"a\", \"b\"}}, {entries})}});\nidentify(problem);\n"
        )
    };
    for (entries, expected) in [
        ("covariance = [0.0025, 0.004; 0.004, 0.01]", -62.22820430833),
        ("sigmas = {0.05, 0.1}, correlation = [1, 0.8; 0.8, 1]", -62.22820430833),
        ("estimatedCovariance = \"estimate\"", -63.26882936623),
    ] {
        fs::write(folder.path().join("s.mos"), script(entries)).unwrap();
        let (done, text) = gapi(folder.path(), &["run", "s.mos"]);
        assert!(done, "{text}");
        let result = fs::read_to_string(folder.path().join("results/s/result.json")).unwrap();
        let result: Value = serde_json::from_str(&result).unwrap();
        let found = result["negative_log_likelihood"].as_f64().unwrap();
        assert!((found - expected).abs() < 1e-8, "{found}, not {expected}\n{text}");
    }
}

#[test]
fn what_is_no_covariance_is_refused_at_its_place() {
    let folder = folder();
    let own = |entry: &str| problem("", &experiment("d", entry));
    let outputs = |covariance: &str, a: &str| {
        problem(
            "",
            &format!(
                "[[experiment]]\ndata = \"d.csv\"\ncovariance = {covariance}\noutputs = {{ a = {{ \
                 column = \"a\", {a} }}, b = \"b\" }}\n"
            ),
        )
    };
    let apart = "time [s],a,b\n1,0.9,\n2,,1.3\n3,0.3,\n4,,1.8\n5,0.1,\n";
    fs::write(folder.path().join("apart.csv"), apart).unwrap();
    fs::write(folder.path().join("few.csv"), "time [s],a,b\n1,0.9,0.8\n2,0.5,1.3\n3,0.3,1.5\n")
        .unwrap();
    for (text, words) in [
        (own("covariance = [[1, 2], [2, 1]]"), "not positive definite"),
        (own("covariance = [[1, 0.2], [0.3, 1]]"), "not symmetric: 0.3 and 0.2 for `b` and `a`"),
        (own("covariance = [[1]]"), "does not have 2 rows and columns"),
        (
            own("covariance = { outputs = [\"a\", \"z\"], matrix = \"estimate\" }"),
            "is not an output",
        ),
        (own("covariance = { outputs = [\"a\"], matrix = \"estimate\" }"), "at least two outputs"),
        (own("covariance = { correlation = [[1, 0.5], [0.5, 1]] }"), "but no given sigma"),
        (own("covariance = { correlation = [[2, 0.5], [0.5, 1]] }"), "with itself is 2"),
        (own("covariance = \"estimated\""), "has to say one thing"),
        (own("covariance = { outputs = [\"a\", \"b\"] }"), "has to say one thing"),
        (own("covariance = 2"), "expected a matrix"),
        (
            own("") + &experiment("first", "validation = true\ncovariance = \"estimate\""),
            "is for validation",
        ),
        (outputs(GIVEN, "sigma = 0.1"), "its variance is in `covariance`"),
        (outputs("\"estimate\"", "sigma = 0.1"), "and its covariance is estimated"),
        (outputs("\"estimate\"", "error = \"student\""), "neither normal nor log-normal"),
        (outputs("\"estimate\"", "below = 0.5"), "values beyond a limit"),
        (outputs("\"estimate\"", "weight = 2"), "has a `weight`"),
        (own("covariance = \"estimate\"").replace("d.csv", "apart.csv"), "at different instants"),
        (own("covariance = \"estimate\"").replace("d.csv", "few.csv"), "from 3 complete rows"),
        (
            problem("fitness = \"huber\"\n", &experiment("d", "covariance = \"estimate\"")),
            "minimize the negative log-likelihood",
        ),
    ] {
        fs::write(folder.path().join("p.toml"), &text).unwrap();
        let (done, output) = gapi(folder.path(), &["identify", "p.toml", "--out", "o", "--plain"]);
        assert!(!done && output.contains(words), "{words}\n{text}\n{output}");
        assert!(output.contains("p.toml:"), "no place: {output}");
    }
}
