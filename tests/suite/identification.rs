//! Whole identifications, shortened by an INI of the test's own.

use crate::shipped;
use gapilib::script::Session;
use std::path::Path;

/// Runs the scripts of an entry (a folder of `scripts/`, empty for the main one) with few
/// generations; `change` comes behind their INI.
fn shortened(entry: &str, cycles: usize, change: &str) -> shipped::Run {
    let cycle = if entry.is_empty() { "GAPILib_CYCLE.mos" } else { "../GAPILib_CYCLE.mos" };
    let script = format!(
        "RunScript(\"GAPILib_INI.mos\")\nN_Cycle = {cycles}\n{change}\nRunScript(\"{cycle}\")\n"
    );
    shipped::run(&format!("scripts/{entry}/test.mos"), &script)
}

fn run(entry: &str, cycles: usize, change: &str) -> Session {
    let run = shortened(entry, cycles, change);
    assert_eq!(run.errors, "");
    run.session
}

fn written(session: &Session, name: &str) -> String {
    let path = session.world.output_dir().join(name);
    String::from_utf8(session.world.read(&path).unwrap()).unwrap()
}

fn result(session: &Session) -> serde_json::Value {
    serde_json::from_str(&written(session, "result.json")).unwrap()
}

#[test]
fn the_main_job_writes_what_it_promises() {
    let session = run("", 4, "");
    let result = result(&session);
    assert_eq!(result["generations"], 4);
    assert_eq!(result["evaluations"], 400);
    assert_eq!(result["model"], "CaseStudies.PolarizationCurve(i_max=1.46)");
    assert_eq!(result["seed"][5], 12345.0);
    assert_eq!(result["details"][5]["unit"], "A/cm2");
    assert_eq!(result["details"][5]["range"][0], 1.47);
    let history = written(&session, "history.csv");
    assert_eq!(history.lines().next(), Some("generation,best,mean,worst,failures"));
    assert_eq!(history.lines().count(), 5);
    let best: Vec<f64> = history
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(1).unwrap().parse().unwrap())
        .collect();
    assert!(best.is_sorted_by(|a, b| a >= b), "elitism loses nothing: {best:?}");
    assert_eq!(written(&session, "fit.csv").lines().count(), 15);
    for figure in ["fit.svg", "convergence.svg"] {
        assert!(written(&session, figure).contains("<svg"), "{figure}");
    }
}

/// The sum of squares of the best individual, computed here from its parameters and the data.
#[test]
fn the_reported_fit_is_that_of_the_reported_parameters() {
    let session = run("", 3, "");
    let result = result(&session);
    let value = |name: &str| result["parameters"][name].as_f64().unwrap();
    let [a, i_n, io, b, r, ilim] = ["A", "In", "Io", "B", "R", "Ilim"].map(value);
    let voltage = |i: f64| {
        let total = i + i_n;
        1.2 - r * total - a * (total / io).ln() + b * (1.0 - total / ilim).ln()
    };
    let data = shipped::project("scripts/data/ecsim_nafion112/c12_n20_rh50_p15psig.csv");
    let sum: f64 = std::fs::read_to_string(data)
        .unwrap()
        .lines()
        .skip(1)
        .map(|line| line.split_once(',').unwrap())
        .map(|(i, v)| (i.parse::<f64>().unwrap(), v.parse::<f64>().unwrap()))
        .map(|(i, measured)| (measured - voltage(i)).powi(2))
        .sum();
    let best_fit = result["best_fit"].as_f64().unwrap();
    assert!((best_fit - sum).abs() < 1e-12 * sum.max(1.0), "{best_fit} {sum}");
    let rmse = result["rmse"].as_f64().unwrap();
    assert!((rmse - (sum / 14.0).sqrt()).abs() < 1e-12);
}

#[test]
fn fifty_generations_fit_the_measured_curve_roughly() {
    let best = result(&run("", 50, ""))["best_fit"].as_f64().unwrap();
    // The least-squares optimum is 2.462e-6; nothing can be better.
    assert!((2.46e-6..5e-3).contains(&best), "{best}");
}

#[test]
fn the_twin_is_fitted_and_its_resistance_called_not_determined() {
    let session = run("twin", 50, "");
    let result = result(&session);
    assert!(result["best_fit"].as_f64().unwrap() < 2e-2);
    assert!(result["failures"].as_u64().unwrap() > 0, "a range that reaches into failures");
    let resistance = &result["details"][4];
    assert_eq!((&resistance["name"], &resistance["determined"]), (&"R".into(), &false.into()));
}

#[test]
fn the_noise_free_twin_has_its_optimum_at_the_published_values() {
    let published =
        "New_Generation[1,:] := {0.0390, 1.4e-3, 1.5856e-6, 0.0918, 7.2860e-4, 0.2265};";
    let best = result(&run("twin", 1, published))["best_fit"].as_f64().unwrap();
    assert!(best < 1e-27, "{best}");
}

#[test]
fn own_fitness_and_own_stop_condition_replace_those_of_the_library() {
    let script = "RunScript(\"GAPILib_INI.mos\")\nN_Cycle = 200\nFit_Target = 0.2\n\
                  RunScript(\"GAPILib_CYCLE.mos\")\n";
    let shipped::Run { session, errors, .. } = shipped::run("scripts/own_fitness/test.mos", script);
    assert_eq!(errors, "");
    let result = result(&session);
    let best = result["best_fit"].as_f64().unwrap();
    let worst = written(&session, "fit.csv")
        .lines()
        .skip(1)
        .map(|line| line.rsplit(',').next().unwrap().parse::<f64>().unwrap().abs())
        .fold(0.0, f64::max);
    assert!((best - worst).abs() < 1e-15, "the fitness is the largest distance: {best} {worst}");
    assert!(best <= 0.2);
    assert!(result["generations"].as_u64().unwrap() < 200, "the stop condition ended it");
    assert_eq!(result["fitness"], "function of the script");
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_others() {
    let files = |seed: &str| {
        let change = format!("Seed = [{seed}, {seed}, {seed}, {seed}, {seed}, {seed}]");
        let session = run("", 3, &change);
        ["history.csv", "fit.csv"].map(|name| written(&session, name))
    };
    assert_eq!(files("777"), files("777"));
    assert_ne!(files("777"), files("778"));
}

#[test]
fn an_interrupted_run_writes_what_it_has_and_says_so() {
    let script = "RunScript(\"GAPILib_INI.mos\")\nRunScript(\"GAPILib_CYCLE.mos\")\n";
    let world = shipped::world().with_file("scripts/test.mos", script).interrupted_after(3000);
    let run = shipped::run_in(world, "scripts/test.mos");
    assert!(run.status.interrupted && run.status.code == 130);
    let result = result(&run.session);
    assert_eq!(result["interrupted"], true);
    let generations = result["generations"].as_u64().unwrap();
    assert!((1..5000).contains(&generations), "{generations}");
    assert_eq!(written(&run.session, "history.csv").lines().count() as u64, generations + 1);
}

#[test]
fn two_runs_of_one_session_have_a_report_each() {
    let script = "RunScript(\"GAPILib_INI.mos\")\nN_Cycle = 2\nRunScript(\"GAPILib_CYCLE.mos\")\n\
                  RunScript(\"GAPILib_INI.mos\")\nN_Cycle = 3\nRunScript(\"GAPILib_CYCLE.mos\")\n";
    let run = shipped::run("scripts/test.mos", script);
    assert_eq!(run.errors, "");
    assert_eq!(result(&run.session)["generations"], 2);
    let second = written(&run.session, "run-2/history.csv");
    assert_eq!(second.lines().count(), 4);
    assert!(second.starts_with(&written(&run.session, "history.csv")), "from the same seed");
}

#[test]
fn other_names_of_variables_do_the_same() {
    let script = "\
        RunScript(\"GAPILib_INI.mos\")\n\
        poblacion := New_Generation\n\
        for g in 1:3 loop\n  \
          curvas := GAPILib.Basics.Eval(SimuPath, SimuCaseStudyName, Xexp, poblacion, Parameter_Names, X_Name, Y_Name)\n  \
          error := GAPILib.Basics.Fit(curvas, Yexp)\n  \
          ordenada := GAPILib.Basics.Fit_Order(poblacion, error, 100, 70, 1)\n  \
          poblacion := [GAPILib.Basics.Cross(70, 1, ordenada); ordenada[1:29,:]]\n\
        end for\n";
    let shipped::Run { session, errors, .. } = shipped::run("scripts/test.mos", script);
    assert_eq!(errors, "");
    assert_eq!(result(&session)["generations"], 3);
}

/// The script of a case that begins from ten seeds, with two generations: ten reports with ten
/// seeds, the first as `GAPILib.mos` gives it, and nothing lost by least squares.
#[test]
fn ten_seeds_give_ten_runs() {
    let ini = "scripts/twin/GAPILib_INI.mos";
    let text = std::fs::read_to_string(shipped::project(ini)).unwrap();
    let world = shipped::world().with_file(ini, text.replace("N_Cycle = 5000", "N_Cycle = 2"));
    let shipped::Run { session, errors, .. } = shipped::run_in(world, "scripts/twin/ten_seeds.mos");
    assert_eq!(errors, "");
    let read = |name: &str| -> serde_json::Value {
        serde_json::from_str(&written(&session, name)).unwrap()
    };
    let mut seeds = vec![read("result.json")["seed"].to_string()];
    seeds.extend((2..=10).map(|k| read(&format!("run-{k}/result.json"))["seed"].to_string()));
    seeds.sort();
    seeds.dedup();
    assert_eq!(seeds.len(), 10);
    let alone = run("twin", 2, "");
    let two = |text: String| text.lines().take(3).map(str::to_owned).collect::<Vec<String>>();
    assert_eq!(two(written(&session, "history.csv")), two(written(&alone, "history.csv")));
    let fits = |name: &str| -> Vec<f64> {
        let runs = session.variable(name).expect("assigned").as_reals().expect("numbers");
        runs.chunks(8).map(|run| run[6]).collect()
    };
    let (found, refined) = (fits("Runs"), fits("RefinedRuns"));
    assert_eq!(found.len(), 10);
    assert!(found.iter().zip(&refined).all(|(found, refined)| refined <= found));
}

/// Whether the shipped scripts with a changed INI end with this code.
fn assert_refused(change: &str, code: &str) {
    let run = shortened("", 1, change);
    assert_eq!(run.status.code, 1, "{change}");
    assert!(run.codes().contains(&code), "{change}: {}", run.errors);
}

#[test]
fn wrong_settings_are_refused_with_their_codes() {
    for (change, code) in [
        ("SimuCaseStudyName = \"CaseStudies.PolarisationCurve\"", "unknown-class"),
        ("Parameter_Names = {\"A\", \"In\", \"Io\", \"B\", \"R\", \"Il\"}", "parameter-not-found"),
        ("Parameter_Names = {\"A\", \"In\", \"Io\", \"B\", \"R\", \"Eoc\"}", "fixed-parameter"),
        ("Parameter_Names = {\"A\"}", "population-size-mismatch"),
        ("X_Name = \"j\"", "unknown-output"),
        ("Y_Name = \"U\"", "unknown-output"),
        ("SimuCaseStudyName = \"CaseStudies.PolarizationCurve\"", "points-outside"),
        ("New_Generation[3,6] := 11.0", "bad-range"),
        ("N_Parents = 100", "bad-population"),
        ("F_Mut = 25", "bad-mutation-factor"),
        ("Param_Min[2] := 1.0", "bad-range"),
        ("Seed = [1, 2, 3, 0, 0, 0]", "bad-seed"),
        ("Xexp[2] := 0/0", "division-by-zero"),
    ] {
        assert_refused(change, code);
    }
}

#[test]
fn wrong_data_are_refused_with_their_codes() {
    let read = |file: &str, x: &str, y: &str| {
        format!("(ok, sizes, Xexp, Yexp) := Exp_Adq_SISO(\"{file}\", \"{x}\", \"{y}\")")
    };
    let good = "data/ecsim_nafion112/c12_n20_rh50_p15psig.mat";
    for (change, code) in [
        (read("data/missing.mat", "i", "V"), "file-error"),
        (read(good, "j", "V"), "unknown-matrix"),
    ] {
        assert_refused(&change, code);
    }
    let codes = |file: &str, bytes: &[u8]| {
        let world =
            shipped::world().with_file(file, bytes).with_file("test.mos", read(file, "i", "V"));
        let run = shipped::run_in(world, "test.mos");
        run.codes().iter().map(|&code| code.to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(codes("d.csv", b"i,V\n0,1\n0.1,NaN\n"), ["data-note"]);
    assert_eq!(codes("d.csv", b"i,V\n0,NaN\n0.1,\n"), ["bad-data"]);
    let mat = |x: usize, y: usize| {
        let [x, y] = [x, y].map(|n| gapilib::mat::Matrix::column_vector(vec![1.0; n]));
        gapilib::mat::write_v4([("i", &x), ("V", &y)]).unwrap()
    };
    assert_eq!(codes("d.mat", &mat(3, 2)), ["data-sizes-differ"]);
    assert_eq!(codes("d.mat", &mat(3, 3)), [] as [&str; 0]);
}

/// The command itself, so that threads are real.
#[test]
fn one_thread_and_two_write_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let scripts = shipped::project("scripts");
    let script = folder.path().join("short.mos");
    let text = format!(
        "RunScript(\"{0}/GAPILib_INI.mos\")\nN_Cycle = 5\nRunScript(\"{0}/GAPILib_CYCLE.mos\")\n",
        scripts.display()
    );
    std::fs::write(&script, text).unwrap();
    let run = |threads: &str| {
        let out = folder.path().join(threads);
        let status = std::process::Command::new(env!("CARGO_BIN_EXE_gapi"))
            .arg("run")
            .arg(&script)
            .args(["--quiet", "--threads", threads, "--out"])
            .arg(&out)
            .output()
            .unwrap();
        assert!(status.status.success(), "{}", String::from_utf8_lossy(&status.stderr));
        files(&out)
    };
    let (one, two) = (run("1"), run("2"));
    assert_eq!(one.len(), 5, "{:?}", one.iter().map(|(name, _)| name).collect::<Vec<_>>());
    for ((name, one), (_, two)) in one.iter().zip(&two) {
        assert_eq!(one, two, "{name}");
    }
}

/// Names and contents of the files of a folder, without the line that tells the time.
fn files(folder: &Path) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            let lines: Vec<&str> =
                text.lines().filter(|line| !line.contains("wall_seconds")).collect();
            (path.file_name().unwrap().to_string_lossy().into_owned(), lines.join("\n"))
        })
        .collect();
    found.sort();
    found
}
