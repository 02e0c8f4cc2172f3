//! Whole identifications, shortened by an INI of the test's own.

use crate::support::shipped;
use gapilib::Session;
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
    assert_eq!(result["parameters"][5]["unit"], "A/cm2");
    assert_eq!(result["parameters"][5]["range"][0], 1.47);
    let history = written(&session, "history.csv");
    assert_eq!(
        history.lines().next(),
        Some("generation,best,mean,worst,failures,A,In,Io,B,R,Ilim")
    );
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

/// The sums of squares of the script's best individual and of the minimum, computed here from their
/// parameters and the data.
#[test]
fn the_reported_objective_values_are_those_of_the_reported_parameters() {
    let session = run("", 3, "");
    let result = result(&session);
    let sum = |value: &dyn Fn(&str) -> f64| -> f64 {
        let [a, i_n, io, b, r, ilim] = ["A", "In", "Io", "B", "R", "Ilim"].map(value);
        let voltage = |i: f64| {
            let total = i + i_n;
            1.2 - r * total - a * (total / io).ln() + b * (1.0 - total / ilim).ln()
        };
        let data = shipped::project("scripts/data/ecsim_nafion112/c12_n20_rh50_p15psig.csv");
        let text = std::fs::read_to_string(data).unwrap();
        let points = text.lines().skip(1).map(|line| line.split_once(',').unwrap());
        points
            .map(|(i, v)| (i.parse::<f64>().unwrap(), v.parse::<f64>().unwrap()))
            .map(|(i, measured)| (measured - voltage(i)).powi(2))
            .sum()
    };
    let script = &result["script"];
    let best = script["fitness"].as_f64().unwrap();
    let expected = sum(&|name| script["parameters"][name].as_f64().unwrap());
    assert!((best - expected).abs() < 1e-12 * expected.max(1.0), "{best} {expected}");
    let parameters = result["parameters"].as_array().unwrap();
    let of = |name: &str| parameters.iter().find(|own| own["name"] == name).unwrap();
    let least = result["fitness"].as_f64().unwrap();
    let expected = sum(&|name| of(name)["value"].as_f64().unwrap());
    assert!((least - expected).abs() < 1e-9 * expected, "{least} {expected}");
    let rmse = result["series"][0]["rmse"].as_f64().unwrap();
    assert!((rmse - (expected / 14.0).sqrt()).abs() < 1e-9 * rmse);
}

/// The minimum of the shipped curve and its standard errors, computed independently with scipy
/// (`least_squares` with `x_scale = 'jac'`, and `s² (JᵀJ)⁻¹`): the script ends beside it, and its
/// own values stay what they are.
#[test]
fn least_squares_from_the_script_s_best_individual_reach_the_minimum() {
    let with = run("", 50, "");
    let found = result(&with);
    let best = found["script"]["fitness"].as_f64().unwrap();
    assert!((3e-6..5e-3).contains(&best), "{best}");
    let least = found["fitness"].as_f64().unwrap();
    assert!((least - 2.462_09e-6).abs() < 1e-10, "{least}");
    let probe = found["script"]["probe"].as_str().unwrap();
    assert!(probe.contains("least squares from there reaches 2.4621e-6"), "{probe}");
    assert!(probe.contains("This is a minimum"), "{probe}");
    for (k, value, percent) in [(3, 0.10642, 32.0), (4, 0.255_86, 7.3), (5, 2.0283, 7.3)] {
        let own = &found["parameters"][k];
        let [at, error] = ["value", "deviation"].map(|key| own[key].as_f64().unwrap());
        assert!((at - value).abs() < 2e-3 * value, "{own}");
        assert!((100.0 * error / at - percent).abs() < 0.02 * percent, "{own}");
        assert_eq!(own["determined"], true, "{own}");
    }
    // Profile likelihoods, computed with scipy as well: the model is far from linear in these three.
    let profiles = [(3, [0.055_365, 0.267_66]), (4, [0.189_98, 0.288_82]), (5, [1.7799, 2.5870])];
    for (k, ends) in profiles {
        let own = &found["parameters"][k];
        assert_eq!(own["by_profile"], true, "{own}");
        for (end, expected) in ends.into_iter().enumerate() {
            let end = own["interval"][end].as_f64().unwrap();
            assert!((end - expected).abs() < 1e-3 * expected, "{own}");
        }
    }
    let text = "RunScript(\"GAPILib_INI.mos\")\nN_Cycle = 50\nRunScript(\"GAPILib_CYCLE.mos\")\n";
    let world = shipped::world().with_file("scripts/test.mos", text);
    let options =
        gapilib::Options { probe: gapilib::internals::identify::Probe::Off, ..Default::default() };
    let mut without = Session::new(Box::new(world)).with_options(options);
    without.run_file(Path::new("scripts/test.mos"));
    assert_eq!(written(&with, "history.csv"), written(&without, "history.csv"));
    let alone = result(&without);
    assert_eq!(alone["script"]["parameters"], found["script"]["parameters"]);
    assert_eq!(alone["fitness"], found["script"]["fitness"]);
    for own in alone["parameters"].as_array().unwrap() {
        assert!(own["deviation"].is_null() && own["determined"].is_null(), "{own}");
        assert!(own["interval"].is_null(), "{own}");
    }
}

/// A straight line by a script: bands and profiles have a closed form (Bates and Watts 1988, §1.2),
/// `t s sqrt(1/n + (x - x̄)²/Sxx)` for the curve and `t s sqrt(1 + 1/n + ...)` for new points.
#[test]
fn a_script_s_minimum_has_bands_and_profiles() {
    let model = "model Line\n  parameter Real a = 0;\n  parameter Real b = 1;\n  \
                 output Real y = a + b*time;\n  annotation(experiment(StopTime = 4));\nend Line;\n";
    let script = "X := {0.0, 1.0, 2.0, 3.0, 4.0};\nY := {1.1, 2.9, 5.2, 6.8, 9.0};\n\
                  D := Eval(\"Line.mo\", \"Line\", X, {{1.5, 1.5}, {0.5, 2.5}}, {\"a\", \"b\"}, \"time\", \"y\");\n\
                  F := Fit(D, Y);\n";
    let run_with = |probe| {
        let world = shipped::world().with_file("Line.mo", model).with_file("test.mos", script);
        let options = gapilib::Options { probe, ..Default::default() };
        let mut session = Session::new(Box::new(world)).with_options(options);
        session.run_file(Path::new("test.mos"));
        session
    };
    let session = run_with(gapilib::internals::identify::Probe::Profiles);
    let found = result(&session);
    // Sums by hand: x̄ = 2, Sxx = 10, ȳ = 5, Sxy = 19.7.
    let (b, a) = (1.97, 5.0 - 1.97 * 2.0);
    let measured = [1.1, 2.9, 5.2, 6.8, 9.0];
    let squares = measured.iter().zip(0..).map(|(y, x)| (y - a - b * f64::from(x)).powi(2));
    let s = (squares.sum::<f64>() / 3.0).sqrt();
    let t = 3.182_446_305_284_263; // 97.5 % of Student's distribution, 3 degrees of freedom
    let half = |x: f64| t * s * (0.2 + (x - 2.0).powi(2) / 10.0).sqrt();
    let bands = written(&session, "bands.csv");
    let rows: Vec<Vec<f64>> = bands
        .lines()
        .skip(1)
        .map(|line| line.split(',').skip(2).map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert!(rows.len() > 50, "{bands}");
    for row in &rows {
        let [x, y, confidence, prediction] = row[..] else { panic!("{row:?}") };
        assert!((y - a - b * x).abs() < 1e-6, "{row:?}");
        assert!((confidence - half(x)).abs() < 1e-4 * half(x), "{row:?} {}", half(x));
        let new = half(x).hypot(t * s);
        assert!((prediction - new).abs() < 1e-4 * new, "{row:?} {new}");
    }
    let profiles = &found["profiles"]["profiles"];
    for (k, value, width) in [(0, a, half(0.0)), (1, b, t * s / 10.0_f64.sqrt())] {
        let ends = &profiles[k]["interval"];
        let [low, high] = [0, 1].map(|end| ends[end].as_f64().unwrap());
        assert!((low - value + width).abs() < 2e-3 * width, "{ends} {value} {width}");
        assert!((high - value - width).abs() < 2e-3 * width, "{ends} {value} {width}");
    }
    assert!(!written(&session, "profiles.csv").is_empty());
    let plain = run_with(gapilib::internals::identify::Probe::LeastSquares);
    assert_eq!(written(&plain, "bands.csv"), bands);
    assert!(result(&plain)["profiles"].is_null());
}

/// A script that names no ranges, and whose individuals span a box beside the minimum: the box is
/// none of the user's bounds.
#[test]
fn ranges_that_no_one_named_bound_nothing() {
    let model = "model Line\n  parameter Real a = 0;\n  parameter Real b(min = 0) = 1;\n  \
                 output Real y = a + b*time;\n  annotation(experiment(StopTime = 4));\nend Line;\n";
    let script = "X := {0.0, 1.0, 2.0, 3.0, 4.0};\nY := {-1.1, 0.9, 3.2, 4.8, 7.0};\n\
                  D := Eval(\"Line.mo\", \"Line\", X, {{3.0, 5.0}, {4.0, 6.0}}, {\"a\", \"b\"}, \"time\", \"y\");\n\
                  F := Fit(D, Y);\n";
    let solved = |script: &str| {
        let world = shipped::world().with_file("Line.mo", model).with_file("test.mos", script);
        result(&shipped::run_in(world, "test.mos").session)
    };
    let close = |found: &serde_json::Value, k: usize, value: f64| {
        let at = found["parameters"][k]["value"].as_f64().unwrap();
        assert!((at - value).abs() < 1e-6, "{k}: {at} {value}");
    };
    let found = solved(script);
    assert_eq!(found["ending"]["kind"], "minimum", "{}", found["ending"]);
    close(&found, 0, 2.96 - 2.01 * 2.0);
    close(&found, 1, 2.01);
    assert_eq!(found["parameters"][0]["at_bound"], false);
    // The model's own limit is one: b would be negative.
    let falling = script.replace("{-1.1, 0.9, 3.2, 4.8, 7.0}", "{7.0, 4.8, 3.2, 0.9, -1.1}");
    let found = solved(&falling);
    close(&found, 0, 2.96);
    close(&found, 1, 0.0);
    assert_eq!(found["parameters"][1]["at_bound"], true);
    // One individual spans nothing at all.
    let found = solved(&script.replace(", {4.0, 6.0}", ""));
    close(&found, 0, 2.96 - 2.01 * 2.0);
    close(&found, 1, 2.01);
}

#[test]
fn the_twin_is_fitted_by_the_script_as_ever() {
    let result = result(&run("twin", 50, ""));
    assert!(result["script"]["fitness"].as_f64().unwrap() < 2e-2);
    let failed: u64 = result["failures"]["simulation"].as_u64().unwrap();
    assert!(failed > 0, "a range that reaches into failures");
}

/// Two populations are simulated before either is compared, the second is compared first: the
/// parameters belong to the rows that `Fit` was given.
#[test]
fn parameters_belong_to_the_rows_that_fit_was_given() {
    let model = "model Line \"y = a t\"\n  parameter Real a = 1;\n  output Real y = a*time;\n  \
                 annotation(experiment(StopTime = 1));\nend Line;\n";
    let script = "X := {0.0, 0.5, 1.0};\nY := {0.0, 1.55, 2.95};\n\
                  D1 := Eval(\"Line.mo\", \"Line\", X, {{1.1}}, {\"a\"}, \"time\", \"y\");\n\
                  D2 := Eval(\"Line.mo\", \"Line\", X, {{2.0}, {3.0}, {4.0}}, {\"a\"}, \"time\", \"y\");\n\
                  F2 := Fit(D2, Y);\nF1 := Fit(D1, Y);\n";
    let world = shipped::world().with_file("Line.mo", model).with_file("test.mos", script);
    let run = shipped::run_in(world, "test.mos");
    assert_eq!(run.errors, "");
    let result = result(&run.session);
    assert_eq!(result["script"]["parameters"]["a"], 3.0);
    let best = result["script"]["fitness"].as_f64().unwrap();
    assert!((best - 0.005).abs() < 1e-12, "{best}");
    assert_eq!((&result["generations"], &result["evaluations"]), (&1.into(), &4.into()));
}

/// Two curves with one slope: the script adds up what `Fit` says of both. One row of history for
/// each generation, and statistics over all points.
#[test]
fn several_experiments_in_a_generation_are_one_generation() {
    let models = "model Line\n  parameter Real a = 1;\n  output Real y = a*time;\n  \
                  annotation(experiment(StopTime = 1));\nend Line;\n\
                  model Square\n  parameter Real a = 1;\n  output Real y = a*time^2;\n  \
                  annotation(experiment(StopTime = 1));\nend Square;\n";
    let script = "loadModel(\"Both.mo\");\nX1 := {0.0, 0.5, 1.0};\nY1 := {0.1, 1.4, 3.1};\n\
                  X2 := {0.25, 0.5, 0.75, 1.0};\nY2 := {0.2, 0.8, 1.6, 3.0};\n\
                  pop := {{1.0}, {2.0}, {2.5}, {4.0}, {5.0}};\nfor g in 1:3 loop\n  \
                  D1 := Eval(\"\", \"Line\", X1, pop, {\"a\"}, \"time\", \"y\");\n  \
                  F1 := Fit(D1, Y1);\n  \
                  D2 := Eval(\"\", \"Square\", X2, pop, {\"a\"}, \"time\", \"y\");\n  \
                  F2 := Fit(D2, Y2);\n  \
                  (pop, F) := Fit_Order(pop, F1 + F2, 5, 3, 1);\n  \
                  pop[5,1] := 2.5 + 0.1*g;\nend for;\n";
    let script = script.replace("loadModel(\"Both.mo\")", "openModel(\"Both.mo\")");
    let world = shipped::world().with_file("Both.mo", models).with_file("test.mos", script);
    let run = shipped::run_in(world, "test.mos");
    assert_eq!(run.errors, "");
    let result = result(&run.session);
    assert_eq!((&result["generations"], &result["evaluations"]), (&3.into(), &30.into()));
    assert_eq!(written(&run.session, "history.csv").lines().count(), 4);
    assert_eq!(result["script"]["fitness_name"], "sum of squares");
    // Least squares over both series, by hand: Σ x y / Σ x².
    let points =
        [(0.0, 0.1), (0.5, 1.4), (1.0, 3.1), (0.0625, 0.2), (0.25, 0.8), (0.5625, 1.6), (1.0, 3.0)];
    let [xy, xx, yy]: [f64; 3] =
        points.iter().fold([0.0; 3], |[xy, xx, yy], (x, y)| [xy + x * y, xx + x * x, yy + y * y]);
    let (slope, least) = (xy / xx, yy - xy * xy / xx);
    let own = &result["parameters"][0];
    assert!((own["value"].as_f64().unwrap() - slope).abs() < 1e-6 * slope, "{own} {slope}");
    assert!((result["fitness"].as_f64().unwrap() - least).abs() < 1e-9, "{least}");
    // Seven points, one parameter.
    let error = (least / 6.0 / xx).sqrt();
    assert!((own["deviation"].as_f64().unwrap() - error).abs() < 1e-4 * error, "{own} {error}");
    assert_eq!(result["series"].as_array().unwrap().len(), 2);
}

/// A run restores population and seed from files behind its initialization, as a script does that
/// goes on where another has ended: the seed reported is the restored one.
#[test]
fn a_restored_seed_is_the_one_that_is_reported() {
    let restored = "writeMatrix(\"seed.mat\", \"Seed\", [1, 2, 3, 4, 5, 6]);\n\
                    Seed := readMatrix(\"seed.mat\", \"Seed\", 1, 6);";
    let result = result(&run("", 3, restored));
    assert_eq!(result["seed"], serde_json::json!([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    // In one session, with the state that the first run has left.
    let script = "RunScript(\"GAPILib_INI.mos\")\nN_Cycle = 3\nRunScript(\"GAPILib_CYCLE.mos\")\n\
                  writeMatrix(\"seed.mat\", \"Seed\", Seed);\n\
                  Seed := readMatrix(\"seed.mat\", \"Seed\", 1, 6);\nSaved := Seed;\n\
                  for k in 1:N_Population loop\n  (Ram_list, Seed) := Ram_Gen_ARENA(Seed, N_Parameters);\n  \
                  New_Generation[k,:] := Param_Min + (Param_Max - Param_Min).*Ram_list[1,:];\nend for\n\
                  (State_Exp_Adq, SizeMatrix, Xexp, Yexp) := Exp_Adq_SISO(\"data/ecsim_nafion112/c12_n20_rh50_p15psig.mat\", \"i\", \"V\");\n\
                  RunScript(\"GAPILib_CYCLE.mos\")\n";
    let run = shipped::run("scripts/test.mos", script);
    assert_eq!(run.errors, "");
    let read = |name: &str| -> serde_json::Value {
        serde_json::from_str(&written(&run.session, name)).unwrap()
    };
    assert_eq!(read("result.json")["seed"][0], 12345.0);
    let saved = run.session.variable("Saved").expect("assigned").as_reals().expect("numbers");
    assert_eq!(read("run-2/result.json")["seed"], serde_json::json!(saved));
}

#[test]
fn the_noise_free_twin_has_its_optimum_at_the_published_values() {
    let published =
        "New_Generation[1,:] := {0.0390, 1.4e-3, 1.5856e-6, 0.0918, 7.2860e-4, 0.2265};";
    let result = result(&run("twin", 1, published));
    let best = result["script"]["fitness"].as_f64().unwrap();
    assert!(best < 1e-27, "{best}");
    assert!(result["fitness"].as_f64().unwrap() < 1e-27, "nothing is lost");
}

#[test]
fn own_fitness_and_own_stop_condition_replace_those_of_the_library() {
    let script = "RunScript(\"GAPILib_INI.mos\")\nN_Cycle = 200\nFit_Target = 0.2\n\
                  RunScript(\"GAPILib_CYCLE.mos\")\n";
    let shipped::Run { session, errors, .. } = shipped::run("scripts/own_fitness/test.mos", script);
    assert_eq!(errors, "");
    let result = result(&session);
    let best = result["fitness"].as_f64().unwrap();
    let worst = written(&session, "fit.csv")
        .lines()
        .skip(1)
        .map(|line| line.rsplit(',').next().unwrap().parse::<f64>().unwrap().abs())
        .fold(0.0, f64::max);
    assert!((best - worst).abs() < 1e-15, "the fitness is the largest distance: {best} {worst}");
    assert!(best <= 0.2);
    assert!(result["generations"].as_u64().unwrap() < 200, "the stop condition ended it");
    assert_eq!(result["script"]["fitness_name"], "function of the script");
    let probe = result["script"]["probe"].as_str().unwrap();
    assert!(probe.contains("its own function, not a sum of squares"), "{probe}");
    assert!(result["parameters"][0]["deviation"].is_null());
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
    assert_eq!(result["script"]["interrupted"], true);
    assert!(result["parameters"][0]["determined"].is_null(), "no verdict");
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
    let world = shipped::world().with_file("d.csv", b"i,V\n0,1\n0.1,NaN\n");
    let run = shipped::run_in(world.with_file("test.mos", read("d.csv", "i", "V")), "test.mos");
    assert!(run.codes().is_empty() && run.errors.contains("note[data-note]"), "{}", run.errors);
    assert_eq!(codes("d.csv", b"i,V\n0,NaN\n0.1,\n"), ["bad-data"]);
    let mat = |x: usize, y: usize| {
        let [x, y] = [x, y].map(|n| gapilib::internals::mat::Matrix::column_vector(vec![1.0; n]));
        gapilib::internals::mat::write_v4([("i", &x), ("V", &y)]).unwrap()
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
    let names: Vec<&str> = one.iter().map(|(name, _)| name.as_str()).collect();
    let expected = [
        "Calibrated.mo",
        "bands.csv",
        "calibrated.mos",
        "convergence.svg",
        "fit.csv",
        "fit.svg",
        "history.csv",
        "individuals.csv",
        "origin.json",
        "parameters.ssv",
        "report.html",
        "result.json",
        "run.lock",
    ];
    assert_eq!(names, expected);
    assert!(folder.path().join("1/timing.json").is_file(), "the time is in a file of its own");
    for ((name, one), (_, two)) in one.iter().zip(&two) {
        assert_eq!(one, two, "{name}");
    }
}

/// Names and contents of the files of a folder, without the one that holds the time.
fn files(folder: &Path) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            (path.file_name().unwrap().to_string_lossy().into_owned(), text)
        })
        .filter(|(name, _)| name != "timing.json")
        .collect();
    found.sort();
    found
}
