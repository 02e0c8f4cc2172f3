//! Problems in files: what experiments can set, and runs that are interrupted.

use super::*;
use crate::value::FromValue as _;
use crate::world::{Files as _, MemoryWorld};

mod entries;
mod inference;
mod laws;
mod meanings;
mod stopping;
mod values;

const MODEL: &str = include_str!("tests/model.mo");

/// h of the tank: k = 0.8, area = 2, from h0, with the inflow u.
fn height(time: f64, h0: f64, u: f64) -> f64 {
    let end = u / 0.8;
    end + (h0 - end) * (-0.4 * time).exp()
}

fn world(files: &[(&str, String)]) -> MemoryWorld {
    let world = MemoryWorld::new().with_file("tank.mo", MODEL);
    files.iter().fold(world, |world, (name, text)| world.with_file(name, text))
}

/// A world with the libraries of the program, which have the tables that inputs follow.
fn shipped(world: MemoryWorld, path: &Path) -> MemoryWorld {
    let inside = Path::new(crate::packages::FOLDER).join(path);
    if let Some(bytes) = crate::packages::read(&inside) {
        return world.with_file(path, bytes);
    }
    let names = crate::packages::list(&inside).unwrap_or_default();
    names.iter().fold(world, |world, name| shipped(world, &path.join(name)))
}

/// Times 0, 0.25 … 4 with a value each.
fn table(header: &str, mut row: impl FnMut(f64) -> String) -> String {
    let lines: Vec<String> =
        (0..17).map(|k| f64::from(k) / 4.0).map(|t| format!("{t},{}", row(t))).collect();
    format!("{header}\n{}\n", lines.join("\n"))
}

fn solved(files: &[(&str, String)]) -> Solution {
    solved_with(files, &RunOptions::default())
}

fn solved_with(files: &[(&str, String)], options: &RunOptions) -> Solution {
    let mut session = Session::new(Box::new(world(files)));
    match solve(&mut session, Path::new("p.toml"), options) {
        Ok(solution) => solution,
        Err(errors) => panic!("{}", errors[0].message),
    }
}

fn refusal(problem: &str, data: &str) -> String {
    refusal_of(&[("p.toml", problem.to_owned()), ("d.csv", data.to_owned())])
}

fn refusal_of(files: &[(&str, String)]) -> String {
    let mut session = Session::new(Box::new(world(files)));
    match solve(&mut session, Path::new("p.toml"), &RunOptions::default()) {
        Ok(_) => panic!("solved"),
        Err(errors) => errors[0].message.clone(),
    }
}

#[test]
fn two_experiments_with_ties_initial_states_and_missing_points() {
    let problem = "
model = \"Free\"
files = [\"tank.mo\"]
[parameters]
k = { min = 0.1, max = 5 }
area = { tied = \"2.5*k\" }
gain = { fixed = 3 }
h = { min = 0.1, max = 10, initial = true, per_experiment = true }
[[experiment]]
name = \"empties\"
data = \"a.csv\"
outputs = { q = \"q\", p = { column = \"p_milli\", factor = 1e-3, weight = 2 } }
tolerance = 1e-9
[[experiment]]
name = \"fills\"
data = \"b.csv\"
outputs = { q = \"q\" }
tolerance = 1e-9
[stop]
evaluations = 1500
";
    let first = table("time,q,p_milli", |t| {
        let h = height(t, 2.0, 0.0);
        let p = if t == 1.0 { "NaN".to_owned() } else { (3000.0 * h).to_string() };
        format!("{},{p}", 0.8 * h)
    });
    let second = table("time,q", |t| (0.8 * height(t, 0.3, 0.0)).to_string());
    let solution = solved(&[("p.toml", problem.to_owned()), ("a.csv", first), ("b.csv", second)]);
    let value = |name: &str| solution.parameters.iter().find(|p| p.name == name).unwrap().value;
    assert!((value("k") - 0.8).abs() < 1e-5, "{}", value("k"));
    assert!((value("h@empties") - 2.0).abs() < 1e-4, "{}", value("h@empties"));
    assert!((value("h@fills") - 0.3).abs() < 1e-4, "{}", value("h@fills"));
    assert_eq!(solution.parameters[0].unit, "1/s");
    assert_eq!(solution.series[1].points.len(), 16, "one point is missing");
    assert!(solution.html().contains("<svg"));
}

const SIMPLE: &str = "
model = \"Free\"
files = [\"tank.mo\"]
[parameters]
k = { min = 0.1, max = 5 }
h = { min = 0.1, max = 10, initial = true }
[[experiment]]
data = \"d.csv\"
outputs = { q = \"q\" }
[checkpoint]
generations = 1
[stop]
evaluations = 600
";

#[test]
fn validation_is_compared_but_not_fitted() {
    let problem = SIMPLE.replace(
        "[checkpoint]",
        "[[experiment]]\nvalidation = true\ndata = \"v.csv\"\noutputs = { q = \"q\" }\n[checkpoint]",
    );
    let data = table("time,q", |t| (3.0 * (-t).exp()).to_string());
    let other = table("time,q", |t| (3.0 * (-t).exp() + 0.5).to_string());
    let solution = solved(&[("p.toml", problem), ("d.csv", data), ("v.csv", other)]);
    assert!(solution.series[0].rmse < 1e-3);
    assert!((solution.validation[0].rmse - 0.5).abs() < 1e-3);
}

#[test]
fn what_is_wrong_is_told() {
    let data = "time,q\n0,1\n1,0.5\n2,0.3\n";
    assert!(refusal(&SIMPLE.replace("k = {", "kk = {"), data).contains("kk"));
    assert!(refusal(&SIMPLE.replace("max = 5", "max = 0.01"), data).contains("empty"));
    assert!(refusal(&SIMPLE.replace("= \"q\" }", "= \"Q\" }"), data).contains("no column `Q`"));
    assert!(
        refusal(&SIMPLE.replace("[checkpoint]", "[checkpoints]"), data).contains("checkpoints")
    );
    assert!(refusal(&SIMPLE.replace("evaluations", "evaluation"), data).contains("evaluation"));
    let slow = SIMPLE.replace("[stop]", "[method]\npopulatin = 3\n[stop]");
    assert!(refusal(&slow, data).contains("populatin"));
    let two = SIMPLE.replace("[stop]", "[method]\nname = \"lshade\"\n[stop]");
    let two = format!("fitness = [\"sse\", \"mae\"]\n{two}");
    assert!(refusal(&two, data).contains("minimizes one fitness function"));
}

#[test]
fn an_unfinished_run_is_never_overwritten_and_resumes_to_the_same_end() {
    resumes_to_the_same_end(SIMPLE);
}

/// The same with operators that depend on the course of the run, and on functions in Modelica.
#[test]
fn a_run_with_chosen_operators_resumes_to_the_same_end() {
    let text = MEAN.to_owned();
    let problem = SIMPLE.replace("[\"tank.mo\"]", "[\"tank.mo\", \"mean.mo\"]");
    for operators in [
        "crossover = \"mean\"\nmutation = \"non_uniform\"\nselection = \"sus\"\nsampling = \"halton\"",
        "survival = \"crowding\"\ncrossover = \"blend\"\nmutation = \"gaussian\"",
        "name = \"gapilib2006\"\npopulation = 40\nparents = 30\nselection = \"roulette\"\ncrossover = \"mean\"",
    ] {
        let method = format!("[method]\n{operators}\npolish = false\n[stop]");
        resumes_with(&problem.replace("[stop]", &method), ("mean.mo", text.clone()));
    }
}

const MEAN: &str = "function mean
  input Real first[:];
  input Real second[:];
  input Real minimum[:];
  input Real maximum[:];
  input Real random[:,3];
  output Real child1[size(first, 1)] = (first + second)/2;
  output Real child2[size(first, 1)] = first + random[:,2].*(second - first);
end mean;";

fn resumes_to_the_same_end(problem: &str) {
    resumes_with(problem, ("other.mo", String::new()));
}

fn resumes_with(problem: &str, other: (&str, String)) {
    let data = table("time,q", |t| (3.0 * (-t).exp() + 0.01 * (7.0 * t).sin()).to_string());
    let files = [("p.toml", problem.to_owned()), ("d.csv", data), other];
    let run = |world: MemoryWorld, options: &RunOptions| {
        let mut session = Session::new(Box::new(world));
        let solution = solve(&mut session, Path::new("p.toml"), options);
        solution.map(|solution| solution.to_json()).map_err(|errors| errors[0].message.clone())
    };
    let whole = run(world(&files), &RunOptions::default()).unwrap();
    // The journal of a run that was cut short, by its own means.
    let mut session = Session::new(Box::new(world(&files)));
    let text = files[0].1.clone();
    let source = session.sources.add("p.toml", text.as_str());
    let mut file = file::read(source, &text).unwrap();
    let built = build::build(&mut session, &mut file, Path::new("p.toml"))
        .unwrap_or_else(|e| panic!("{}", e[0].message));
    let mut journal = solving::header(&built.origins);
    let mut run_of = Run::new(built.problem, 1).unwrap();
    for k in 0..9 {
        assert!(run_of.stop().is_none());
        journal.extend(solving::encode(&run_of.step(f64::from(k)).unwrap()));
    }
    let resume = RunOptions { resume: true, ..RunOptions::default() };
    let begin = solving::header(&built.origins).len();
    for cut in [journal.len(), journal.len() - 1, journal.len() / 2, begin] {
        let with_journal = || {
            let world = world(&files);
            let path = world.output_dir().join(JOURNAL);
            world.with_file(path, &journal[..cut])
        };
        let refused = run(with_journal(), &RunOptions::default()).unwrap_err();
        assert!(refused.contains("did not finish"), "{refused}");
        assert_eq!(run(with_journal(), &resume).unwrap(), whole, "cut at {cut}");
    }
    // With other data it cannot be resumed: it is put aside.
    let mut changed = files.clone();
    changed[1].1 += "100,0\n";
    let changed = world(&changed);
    let path = changed.output_dir().join(JOURNAL);
    assert!(run(changed.with_file(path, &*journal), &RunOptions::default()).is_ok());
    let other = world(&files);
    let path = other.output_dir().join(JOURNAL);
    let other = other.with_file(path, "something");
    assert!(run(other, &resume).unwrap_err().contains("not a checkpoint"));
}

/// The record of a script, the file and the report of both are the same problem.
/// Dymola's result files name time `Time`.
#[test]
fn a_result_file_of_dymola_gives_its_parameters_back() {
    let simulate = "openModel(\"tank.mo\"); simulateModel(\"Free(h(start = 3))\", stopTime = 4, \
        tolerance = 1e-9, resultFile = \"d\")";
    for x in ["", "x = \"time\"\n"] {
        let problem = SIMPLE.replace("data = \"d.csv\"\n", &format!("data = \"d.mat\"\n{x}"));
        let mut session = Session::new(Box::new(world(&[("p.toml", problem)])));
        let status = session.run_text("s.mos", simulate);
        assert_eq!(status.code, 0);
        let solution = solve(&mut session, Path::new("p.toml"), &RunOptions::default());
        let solution = solution.unwrap_or_else(|errors| panic!("{x}: {}", errors[0].message));
        let found: Vec<f64> = solution.parameters.iter().map(|p| p.value).collect();
        assert!((found[0] - 1.0).abs() < 1e-5 && (found[1] - 3.0).abs() < 1e-4, "{found:?}");
    }
}

/// A world with the records that scripts put problems together from.
fn with_records(world: MemoryWorld) -> MemoryWorld {
    ["package.mo", "Problem.mo", "Free.mo", "Experiment.mo"].iter().fold(world, |world, name| {
        let path = Path::new("GAPILib").join(name);
        let bytes = crate::packages::read(&Path::new(crate::packages::FOLDER).join(&path)).unwrap();
        world.with_file(path, bytes)
    })
}

#[test]
fn records_of_scripts_begin_and_cut_experiments() {
    let data = table("time,q", |t| (3.0 * (-t).exp()).to_string());
    let mut session = Session::new(Box::new(with_records(world(&[("d.csv", data)]))));
    let problem = |options: &str| {
        format!(
            "identify(GAPILib.Problem(modelName = \"Free\", files = {{\"tank.mo\"}}, parameters = \
             {{GAPILib.Free(\"k\", min = 0.1, max = 5), GAPILib.Free(\"h\", min = 0.1, max = 10, \
             initialValue = true)}}, experiments = {{GAPILib.Experiment(data = \"d.csv\", outputs = \
             {{\"q\"}}, tolerance = 1e-9, {options})}}, method = \"levenberg_marquardt\"))"
        )
    };
    // Parts with separate initial values begin where their first rows are.
    for (options, expected) in [
        ("startTime = {-1}", vec![1.0, 3.0 * 1.0f64.exp()]),
        ("startTime = {0}", vec![1.0, 3.0]),
        ("cutTimes = {2}", vec![1.0, 3.0, 3.0 * (-2.0f64).exp()]),
    ] {
        let status = session.run_text("s.mos", &format!("(found, f, d) = {}", problem(options)));
        assert_eq!(status.code, 0, "{options}");
        let found = Vec::<f64>::from_value(session.variable("found").unwrap().clone()).unwrap();
        assert_eq!(found.len(), expected.len(), "{options}: {found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-5 * expected, "{options}: {found}, {expected}");
        }
    }
    let both = problem("cutAtGaps = true, cutTimes = {2}");
    assert_ne!(session.run_text("s.mos", &both).code, 0);
}

#[test]
fn records_of_scripts_are_the_problems_of_files() {
    let data = table("time,q", |t| (3.0 * (-t).exp() + 0.01 * (7.0 * t).sin()).to_string());
    let world = with_records(world(&[("p.toml", SIMPLE.to_owned()), ("d.csv", data)]));
    let streams = world.streams();
    let mut session = Session::new(Box::new(world));
    let script = "
problem = GAPILib.Problem(modelName = \"Free\", files = {\"tank.mo\"},
  parameters = {GAPILib.Free(\"k\", min = 0.1, max = 5), GAPILib.Free(\"h\", min = 0.1, max = 10, initialValue = true)},
  experiments = {GAPILib.Experiment(data = \"d.csv\", outputs = {\"q\"})},
  evaluations = 600)
(values, fitness, deviations) = identify(problem, folder = \"record\")
(others, same, alike) = identify(\"p.toml\", folder = \"file\", profile = true, sensitivity = \"morris\")
";
    let status = session.run_text("s.mos", script);
    assert_eq!(status.code, 0, "{}", streams.output() + &streams.errors());
    for (record, file) in [("values", "others"), ("fitness", "same"), ("deviations", "alike")] {
        assert_eq!(session.variable(record), session.variable(file), "{record}");
        assert!(session.variable(record).is_some());
    }
    for name in ["profiles.csv", "sensitivity.csv", "report.html"] {
        let path = session.world.output_dir().join("file").join(name);
        assert!(session.world.exists(&path), "{name}");
    }
}

#[test]
fn what_is_changed_in_a_pause_is_recorded_and_done_again() {
    let data = table("time,q", |t| (3.0 * (-t).exp() + 0.01 * (7.0 * t).sin()).to_string());
    let files = [("p.toml", SIMPLE.to_owned()), ("d.csv", data)];
    let lines =
        ["mutation = 0.5", "min k = 0.2", "colour = 3", "nothing", "evaluations = 400", "stop"];
    let run = |world: MemoryWorld, resume: bool| {
        let streams = world.streams();
        let mut session = Session::new(Box::new(world));
        let options = RunOptions { resume, ..RunOptions::default() };
        let solution = solve(&mut session, Path::new("p.toml"), &options);
        let text = streams.output() + &streams.errors();
        (solution.unwrap_or_else(|errors| panic!("{}", errors[0].message)), text, session)
    };
    let (whole, text, _) = run(world(&files).paused_after(4, &lines[..5]), false);
    let changes: Vec<_> =
        whole.effort.changes.iter().map(|(at, what, _)| (*at, what.as_str())).collect();
    assert_eq!(changes, [(4, "mutation"), (4, "min k"), (4, "evaluations")]);
    assert!(text.contains("mutation = 0.5 from generation 5 on"), "{text}");
    assert!(text.contains("`colour`") && text.contains("expected NAME = NUMBER"), "{text}");
    assert_eq!(whole.parameters[0].range, [0.2, 5.0]);
    // Ended in a later pause, it continues from there with the changes that were made.
    let twice = world(&files).paused_after(4, &lines);
    let (ended, text, session) = run(twice, false);
    assert!(
        ended.effort.evaluations < whole.effort.evaluations && text.contains("--resume"),
        "{text}"
    );
    let path = session.world.output_dir().join(JOURNAL);
    let journal = session.world.read(&path).unwrap();
    let (_, _, session) = run(world(&files).with_file(&path, journal), true);
    assert!(!session.world.exists(&path));
}

const DATA: fn(f64) -> String = |t| (3.0 * (-t).exp() + 0.01 * (7.0 * t).sin()).to_string();

#[test]
fn fitness_may_be_a_function_written_in_modelica() {
    let functions = include_str!("tests/fitness.mo");
    let with = |name: &str| {
        let own = format!("fitness = \"{name}\"\nfiles = [\"tank.mo\", \"f.mo\"]\n");
        let problem = SIMPLE.replace("files = [\"tank.mo\"]\n", &own);
        assert!(problem.contains("f.mo"), "{problem}");
        [("p.toml", problem), ("d.csv", table("time,q", DATA)), ("f.mo", functions.to_owned())]
    };
    let own = solved(&with("squares"));
    let sum: f64 = own.series[0].points.iter().map(|p| (p[1] - p[2]).powi(2)).sum();
    assert!((own.fitness - sum).abs() < 1e-12 && sum < 0.01, "{} {sum}", own.fitness);
    // That it is a sum of squares is not known, so least squares do not refine it.
    assert!(
        own.subject.method == "genetic" && own.subject.fitness_name == "squares",
        "{}",
        own.subject.method
    );
    let largest = solved(&with("distance"));
    let points = largest.series[0].points.iter();
    let expected = points.map(|p| (p[1] - p[2]).abs()).fold(0.0, f64::max);
    assert!((largest.fitness - expected).abs() < 1e-12, "{} {expected}", largest.fitness);
    for (name, reason) in [("undecided", "has 1 inputs"), ("sqares", "unknown fitness function")] {
        let mut session = Session::new(Box::new(world(&with(name))));
        let wrong = solve(&mut session, Path::new("p.toml"), &RunOptions::default()).unwrap_err();
        assert!(wrong[0].message.contains(reason), "{}", wrong[0].message);
    }
}

#[test]
fn simulations_that_cost_too_much_are_failures() {
    let data = table("time,q", DATA);
    let limited =
        |limit: &str| SIMPLE.replace("[[experiment]]", &format!("[[experiment]]\n{limit}"));
    let text = refusal(&limited("max_steps = 3"), &data);
    assert!(text.contains("none of") && text.contains("steps"), "{text}");
    let text = refusal(&limited("max_seconds = -1"), &data);
    assert!(text.contains("`max_seconds` is -1"), "{text}");
    let text = refusal(&format!("{SIMPLE}seconds = -1\n"), &data);
    assert!(text.contains("`seconds` of the stop conditions is -1"), "{text}");
    // Here the clock stands still, so nothing is late.
    solved(&[("p.toml", limited("max_seconds = 1e-9")), ("d.csv", data)]);
}

/// They would reach the terminal of the user who prints a table of results.
#[test]
fn strings_of_problems_have_no_control_characters() {
    let data = table("time,q", DATA);
    let with = |entry: &str| SIMPLE.replace("[[experiment]]", &format!("[[experiment]]\n{entry}"));
    let text = refusal(&with(r#"name = "a\u001b[2Jb""#), &data);
    assert!(text.contains(r#""a\u{1b}[2Jb" contains the control character U+001B"#), "{text}");
    let text = refusal(&format!("title = \"a\\u0007\"\n{SIMPLE}"), &data);
    assert!(text.contains("U+0007"), "{text}");
    solved(&[("p.toml", with(r#"name = "a\tb\nc""#)), ("d.csv", data)]);
}

/// The sensitivities of simulations tell products, too, although they are not exact.
#[test]
fn a_product_in_a_dynamic_model_is_named() {
    let problem = SIMPLE.replace("k = {", "gain = {").replace("q = \"q\"", "p = \"q\"");
    let solution = solved(&[("p.toml", problem), ("d.csv", table("time,q", DATA))]);
    let note = &solution.findings[0].sentence;
    assert!(note.starts_with("gain, h are structurally non-identifiable from data"), "{note}");
    assert!(note.contains("depends only on gain*h"), "{note}");
}
