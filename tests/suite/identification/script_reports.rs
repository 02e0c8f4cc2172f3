//! What scripts are told of their searches: ranges, intervals, histories, and where there is no report.

use crate::support::shipped;
use gapilib::Session;
use gapilib::world::MemoryWorld;

const DECAY: &str = "model M\n  parameter Real a = 1;\n  parameter Real k = 1;\n  \
                     output Real y = a*exp(-k*time);\n  annotation(experiment(StopTime = 4));\nend M;\n\
                     Xexp = {0,1,2,3,4};\n";

fn run(script: &str) -> shipped::Run {
    shipped::run("test.mos", script)
}

fn written(session: &Session, name: &str) -> String {
    let path = session.world.output_dir().join(name);
    String::from_utf8(session.world.read(&path).unwrap()).unwrap()
}

fn result(session: &Session) -> serde_json::Value {
    serde_json::from_str(&written(session, "result.json")).unwrap()
}

/// y = exp(-k t) with noise: k = 0.498 with a 95 % interval of 0.367 to 0.676 (the profile of the sum of
/// squares, by SciPy). The range of a few individuals that a script tries does not end it.
#[test]
fn intervals_do_not_end_where_the_individuals_of_a_script_end() {
    let data = "{1.05,0.53,0.45,0.17,0.18}";
    let eval = |individuals: &str| {
        format!(
            "{DECAY}F = Fit(Eval(\"\", \"M\", Xexp, {individuals}, {{\"k\"}}, \"time\", \"y\"), {data});\n"
        )
    };
    let refine = |individuals: &str| {
        format!(
            "{DECAY}(B, F, N) = Refine(\"\", \"M\", Xexp, {data}, {individuals}, {{0.01}}, {{10}}, \
             {{\"k\"}}, \"time\", \"y\");\n"
        )
    };
    let scripts = [
        eval("[0.5]"),
        eval("[0.48; 0.481]"),
        eval("[0.48; 0.49; 0.5; 0.51; 0.52]"),
        refine("[0.5]"),
        refine("[0.5; 3; 0.05]"),
    ];
    for script in scripts {
        let found = result(&run(&script).session);
        let own = &found["parameters"][0];
        assert_eq!((&own["determined"], &own["at_bound"]), (&true.into(), &false.into()), "{own}");
        for (end, expected) in [0.3674, 0.6759].into_iter().enumerate() {
            let end = own["interval"][end].as_f64().unwrap();
            assert!((end - expected).abs() < 2e-3, "{own}");
        }
        if script.contains("Refine") {
            assert_eq!(own["range"], serde_json::json!([0.01, 10.0]));
            let probe = found["script"]["probe"].as_str().unwrap();
            assert!(probe.starts_with("The script ended at"), "{probe}");
        }
    }
}

/// y = 1 + b t falls, b lies within 0 and 2: least squares after `Refine` stay there.
#[test]
fn the_bounds_of_refine_are_those_of_the_report() {
    let script = "model M\n  parameter Real b = 1;\n  output Real y = 1 + b*time;\n  \
                  annotation(experiment(StopTime = 4));\nend M;\n\
                  (B, F) = Refine(\"\", \"M\", {0,1,2,3,4}, {1,0.6,-0.1,-0.4,-1.1}, [0.5;1], {0}, {2}, \
                  {\"b\"}, \"time\", \"y\");\n";
    let found = result(&run(script).session);
    let own = &found["parameters"][0];
    assert_eq!((&own["value"], &own["range"]), (&0.0.into(), &serde_json::json!([0.0, 2.0])));
    assert_eq!(own["at_bound"], true);
}

fn search(genes: &str, parameters: &str, elites: usize) -> String {
    format!(
        "{DECAY}Yexp = {{2.02,1.2,0.75,0.43,0.28}};\n{genes}N = 12;\n\
         Seed := [12345, 12345, 12345, 12345, 12345, 12345];\nPop := zeros(N, 2);\n\
         for j in 1:N loop\n  (r, Seed) := Ram_Gen_ARENA(Seed, 2);\n  \
         Pop[j,:] := Lo + (Hi - Lo).*r[1,:];\nend for;\n\
         for Cycle in 1:12 loop\n  \
         F := Fit(Eval(\"\", \"M\", Xexp, {parameters}, {{\"a\",\"k\"}}, \"time\", \"y\"), Yexp);\n  \
         (PO, FO) := Fit_Order(Pop, F, N, N - {elites}, {elites});\n  \
         C := Cross(N - {elites}, {elites}, PO, {{1}});\n  \
         (rm, Seed) := Ram_Gen_ARENA(Seed, 2*N);\n  \
         Pop := Mutation(C, 0.4, rm, Lo, Hi, {elites});\nend for;\n"
    )
}

/// The genes are logarithms, or fractions of ranges: what is reported is what the model got, whose least
/// squares are a = 2.02 and k = 0.51 (SciPy).
#[test]
fn parameters_made_of_genes_are_reported_as_the_model_got_them() {
    let logarithms = search("Lo = {-1,-3}; Hi = {1,1};\n", "10.0 .^ Pop", 1);
    let fractions = search(
        "Lo = {0,0}; Hi = {1,1}; From = {0.1,0.01}; To = {10,3};\n",
        "{From + (To - From).*Pop[j,:] for j in 1:N}",
        1,
    );
    for script in [logarithms, fractions] {
        let run = run(&script);
        assert_eq!(run.errors, "");
        let found = result(&run.session);
        assert_eq!((&found["generations"], &found["evaluations"]), (&12.into(), &144.into()));
        for (k, expected) in [2.02, 0.51].into_iter().enumerate() {
            let own = &found["parameters"][k];
            assert!((own["value"].as_f64().unwrap() / expected - 1.0).abs() < 0.02, "{own}");
        }
    }
}

#[test]
fn a_run_without_a_report_says_why() {
    let script = search("Lo = {-1,-3}; Hi = {1,1};\n", "10.0 .^ Pop", 1)
        .replace("F := Fit(", "F := 2.0 .+ sin(Fit(")
        .replace(", Yexp);\n", ", Yexp));\n");
    let run = run(&script);
    assert!(run.errors.contains("there is no report of 144 simulations"), "{}", run.errors);
}

/// Without elites a generation may be worse than the one before: each row of the history belongs to the
/// best individual of its generation, whose sum of squares is computed here.
#[test]
fn the_history_has_the_parameters_of_its_objectives() {
    let run = run(&search("Lo = {0.1,0.01}; Hi = {10,3};\n", "Pop", 0));
    let text = written(&run.session, "history.csv");
    let mut bests = Vec::new();
    for line in text.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let (best, a, k) = (row[1], row[5], row[6]);
        let simulated = |t: f64| a * (-k * t).exp();
        let data = [2.02, 1.2, 0.75, 0.43, 0.28];
        let sum: f64 =
            data.iter().zip(0..).map(|(y, t)| (y - simulated(f64::from(t))).powi(2)).sum();
        assert!((sum - best).abs() < 1e-9 * best, "{line}: {sum}");
        bests.push(best);
    }
    assert!(!bests.is_sorted_by(|a, b| a >= b), "a generation is worse: {bests:?}");
    let found = result(&run.session);
    let probe = found["script"]["probe"].as_str().unwrap();
    let least = bests.iter().copied().fold(f64::INFINITY, f64::min);
    let ended = bests[bests.len() - 1];
    assert_eq!(probe.contains(" and ended at "), ended > least, "{probe}");
}

/// Parameters of the reports of a run: the first one's, and those of the others in their folders.
fn reported(session: &Session, name: &str) -> (serde_json::Value, [f64; 2]) {
    let found: serde_json::Value = serde_json::from_str(&written(session, name)).unwrap();
    let value = |k: usize| found["parameters"][k]["value"].as_f64().unwrap();
    let values = [value(0), value(1)];
    (found, values)
}

fn near(values: [f64; 2], expected: [f64; 2]) -> bool {
    values.iter().zip(expected).all(|(value, expected)| (value / expected - 1.0).abs() < 2e-3)
}

/// Least squares by SciPy (`curve_fit`) of the two series: a = 0.99966, k = 1.0178 and a = 2.0149,
/// k = 0.50489. The second fits worse: its individuals are worse than all of the first.
#[test]
fn each_set_of_data_of_a_script_has_a_report() {
    let one = search("Lo = {0.5,0.1}; Hi = {3,2};\n", "Pop", 1);
    let (declared, rest) = one.split_once("Yexp = ").unwrap();
    let (_, rest) = rest.split_once('\n').unwrap();
    let script = format!(
        "{declared}for f in 1:2 loop\nYexp := if f == 1 then {{1.0,0.36,0.13,0.05,0.02}} else \
         {{2.02,1.2,0.75,0.43,0.28}};\n{rest}end for;\n"
    );
    let run = run(&script);
    assert_eq!(run.errors, "");
    let expected = [("result.json", [0.99966, 1.0178]), ("run-2/result.json", [2.0149, 0.50489])];
    for (number, (name, expected)) in expected.into_iter().enumerate() {
        let (found, values) = reported(&run.session, name);
        assert!(near(values, expected), "{name}: {values:?}");
        assert_eq!((&found["generations"], &found["evaluations"]), (&12.into(), &144.into()));
        assert_eq!(found["seed"], serde_json::json!(vec![12345.0; 6]));
        let title = format!("Identified parameters of M, search {} of 2", number + 1);
        assert_eq!(found["title"], title);
    }
}

/// A file with a model that the script writes anew: two models of one name, whose values are not those
/// of one search.
#[test]
fn a_model_that_was_changed_is_searched_anew() {
    let model = |equation: &str| {
        format!(
            "Modelica.Utilities.Streams.print(\"model W parameter Real a = 1; parameter Real k = 1; \
             output Real y = {equation}; end W;\", \"W.mo\");\n"
        )
    };
    let eval = "F = Fit(Eval(\"W.mo\", \"W\", {0,1,2,3}, [2.0,0.5; 1.9,0.6; 2.1,0.4], {\"a\",\"k\"}, \
                \"time\", \"y\"), {2.0,1.21,0.74,0.44});\n";
    let [one, other] = ["a*exp(-k*time)", "a*exp(-2*k*time)"].map(model);
    let remove = "Modelica.Utilities.Files.remove(\"W.mo\");\n";
    let run = run(&[one.as_str(), eval, remove, &other, eval].concat());
    let [(_, first), (_, second)] =
        ["result.json", "run-2/result.json"].map(|name| reported(&run.session, name));
    assert!((first[1] / second[1] / 2.0 - 1.0).abs() < 1e-3, "{first:?} {second:?}");
}

#[test]
fn an_error_belongs_to_the_search_that_it_ended() {
    let eval = |data: &str| {
        format!(
            "F = Fit(Eval(\"\", \"M\", Xexp, [2.0,0.5; 1.9,0.6; 2.1,0.4; 1.0,0.9], {{\"a\",\"k\"}}, \
             \"time\", \"y\"), {data});\n"
        )
    };
    let [one, other] = ["{2.02,1.2,0.75,0.43,0.28}", "{1.0,0.36,0.13,0.05,0.02}"].map(eval);
    let run = run(&format!("{DECAY}{one}{other}x = unknown_name;\n"));
    let (first, _) = reported(&run.session, "result.json");
    let (second, _) = reported(&run.session, "run-2/result.json");
    assert_eq!(
        (&first["script"]["error"], second["script"]["error"].is_object()),
        (&().into(), true)
    );
    assert!(
        first["stop"].as_str().unwrap().starts_with("the search has ended"),
        "{}",
        first["stop"]
    );
}

/// Other data in each evaluation: the last of them are reported, and that there are more is said.
#[test]
fn of_many_searches_some_are_reported_and_the_others_named() {
    let script = format!(
        "{DECAY}for f in 1:23 loop\n  F := Fit(Eval(\"\", \"M\", Xexp, [1.0,0.5; 1.1,0.4; 0.9,0.6], \
         {{\"a\",\"k\"}}, \"time\", \"y\"), (1 + f/100)*{{1.01,0.6,0.37,0.22,0.14}});\nend for;\n"
    );
    let run = run(&script);
    assert!(run.errors.contains("compared 23 different models or sets"), "{}", run.errors);
    let titles = ["result.json", "run-20/result.json"]
        .map(|name| reported(&run.session, name).0["title"].clone());
    assert_eq!(titles[0], "Identified parameters of M, search 4 of 23");
    assert_eq!(titles[1], "Identified parameters of M, search 23 of 23");
}

/// All individuals of the second model fail, those of the first do not.
#[test]
fn a_search_without_a_result_is_named() {
    let script = format!(
        "{DECAY}model L parameter Real a = 1; parameter Real k = 1; output Real y = log(-1 - a^2); end L;\n\
         P = [2.0,0.5; 1.9,0.6; 2.1,0.4];\n\
         for name in {{\"M\", \"L\"}} loop\n  F := Fit(Eval(\"\", name, Xexp, P, {{\"a\",\"k\"}}, \"time\", \"y\"), \
         {{2.02,1.2,0.75,0.43,0.28}});\n  (Q, G) := Fit_Order(P, F, 3, 2, 1);\nend for;\n"
    );
    let run = run(&script);
    assert!(run.errors.contains("the search of L has no result: none of 3"), "{}", run.errors);
    assert!(near(reported(&run.session, "result.json").1, [2.0149, 0.50489]));
}

/// The weights of the sum fail with the second model, whatever the first does.
#[test]
fn a_sum_with_a_model_that_fails_says_so() {
    let script = format!(
        "{DECAY}model L parameter Real a = 1; parameter Real k = 1; output Real y = log(-1 - a^2); end L;\n\
         P = [2.0,0.5; 1.9,0.6; 2.1,0.4];\nY = {{2.02,1.2,0.75,0.43,0.28}};\n\
         F = Fit(Eval(\"\", \"M\", Xexp, P, {{\"a\",\"k\"}}, \"time\", \"y\"), Y) + \
         Fit(Eval(\"\", \"L\", Xexp, P, {{\"a\",\"k\"}}, \"time\", \"y\"), Y);\n\
         (Q, G) = Fit_Order(P, F, 3, 2, 1);\n"
    );
    let said = run(&script).errors;
    assert!(said.contains("the search of M, L has no result") && said.contains("log"), "{said}");
}

/// A script that had two searches has one now: what is left of the second is of the run before.
#[test]
fn results_of_an_earlier_run_are_named() {
    let eval = |data: &str| {
        format!(
            "F = Fit(Eval(\"\", \"M\", Xexp, [2.0,0.5; 1.9,0.6; 2.1,0.4], {{\"a\",\"k\"}}, \"time\", \
             \"y\"), {data});\n"
        )
    };
    let script = format!("{DECAY}{}", eval("{2.02,1.2,0.75,0.43,0.28}"));
    let earlier = MemoryWorld::new().with_file("results/run-2/result.json", b"{}");
    for (world, is_said) in [(MemoryWorld::new(), false), (earlier, true)] {
        let streams = world.streams();
        let mut session = Session::new(Box::new(world));
        session.run_text("test.mos", &script);
        let said = streams.errors() + &streams.output();
        assert_eq!(said.contains("run-2` has results of an earlier run"), is_said, "{said}");
    }
}
