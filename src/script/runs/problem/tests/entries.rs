//! What is wrong with an entry of a problem file is shown at the line of that entry.

use super::*;

const PROBLEM: &str = "model = \"Tank\"
files = [\"tank.mo\"]
searches = 1
[parameters]
k = { min = 0.1, max = 5 }
area = { fixed = 2 }
[[experiment]]
data = \"d.csv\"
x = { variable = \"time\", column = \"t\" }
outputs = { h = { column = \"h\" } }
inputs = { u = { column = \"u\" } }
[method]
name = \"genetic\"
[stop]
evaluations = 20
";

/// The problem with this line in place of that of the same entry, or below the header of `table`.
fn with(table: &str, line: &str) -> String {
    let name = |line: &str| line.split(" =").next().unwrap_or_default().to_owned();
    let is_same = |own: &&str| own.contains(" =") && name(own) == name(line);
    match PROBLEM.lines().find(is_same) {
        Some(old) => PROBLEM.replace(old, line),
        None if table.is_empty() => format!("{line}\n{PROBLEM}"),
        None if PROBLEM.contains(table) => PROBLEM.replace(table, &format!("{table}\n{line}")),
        None => format!("{PROBLEM}{table}\n{line}\n"),
    }
}

/// The line of the first error, and its message.
fn wrong_line(problem: &str) -> (String, String) {
    let data = table("t,h,u,bad", |t| format!("{},1,{}", height(t, 1.0, 1.0), t - 1.0));
    let files = [("p.toml", problem.to_owned()), ("d.csv", data)];
    let mut session = Session::new(Box::new(world(&files)));
    let errors = match solve(&mut session, Path::new("p.toml"), &RunOptions::default()) {
        Ok(_) => panic!("solved: {problem}"),
        Err(errors) => errors,
    };
    let (span, message) = (errors[0].span(), errors[0].message.clone());
    let place = session.sources.line_column(span);
    let source = session.sources.get(span.source).filter(|source| &*source.name == "p.toml");
    let line = source.zip(place).and_then(|(_, place)| problem.lines().nth(place.line - 1));
    (line.unwrap_or("no line").to_owned(), message)
}

fn check(cases: &[(&str, &str)]) {
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(table, line)| {
            let (found, message) = wrong_line(&with(table, line));
            (found != *line).then(|| format!("{line}\n  is shown at {found}: {message}"))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn of_parameters() {
    check(&[
        ("", "k = { min = 1, max = 1 }"),
        ("", "k = { min = 2, max = 1 }"),
        ("", "k = { min = 0, max = 1, scale = \"log\" }"),
        ("", "k = { min = 0.1, max = 5, start = 9 }"),
        ("", "k = { min = 0.1 }"),
        ("", "k = { min = 0.1, max = inf }"),
        ("", "k = { min = 0.1, max = 5, fixed = 1 }"),
        ("", "k = { min = 0.1, max = 5, scale = \"exponential\" }"),
        ("", "k = { min = 0.1, max = 5, prior = \"flat\" }"),
        ("", "k = { min = 0.1, max = 5, prior = { mean = 1, sd = 0.1 } }"),
        ("", "k = { min = 0.1, max = 5, prior = { mean = 1, sd = 0.1, base = 10 } }"),
        (
            "",
            "k = { min = 0.1, max = 5, prior = { distribution = \"laplace\", mean = 1, sd = 2 } }",
        ),
        (
            "",
            "k = { min = 0.1, max = 5, prior = { distribution = \"uniform\", min = 2, max = 1 } }",
        ),
        ("[parameters]", "rate = { min = 0.1, max = 5 }"),
        ("[parameters]", "q = { min = 0.1, max = 5 }"),
        ("[parameters]", "gain = { tied = \"2*\" }"),
        ("[parameters]", "gain = { tied = \"2*nothing\" }"),
        ("[parameters]", "gain = { fixed = \"two\" }"),
        ("[parameters]", "q = { min = 0.1, max = 5, initial = true }"),
    ]);
    let none = PROBLEM.replace("k = { min = 0.1, max = 5 }", "k = { fixed = 1 }");
    assert_eq!(wrong_line(&none).0, "[parameters]", "{}", wrong_line(&none).1);
}

#[test]
fn of_experiments() {
    check(&[
        ("", "data = \"none.csv\""),
        ("", "x = { variable = \"time\", column = \"none\" }"),
        ("", "x = { variable = \"none\", column = \"t\" }"),
        ("", "outputs = {}"),
        ("", "outputs = { h = { column = \"none\" } }"),
        ("", "outputs = { level = { column = \"h\" } }"),
        ("", "outputs = { h = { column = \"h\", unit = \"kg\" } }"),
        ("", "outputs = { h = { column = \"h\", sigma = -1 } }"),
        ("", "outputs = { h = { column = \"h\", sigma = \"0.1*\" } }"),
        ("", "outputs = { h = { column = \"h\", weight = -1 } }"),
        ("", "outputs = { h = { column = \"h\", delay = -1 } }"),
        ("", "outputs = { h = { column = \"h\", delay = \"lag\" } }"),
        ("", "outputs = { h = { column = \"h\", error = \"cauchy\" } }"),
        ("", "outputs = { h = { column = \"h\", error = \"poisson\" } }"),
        ("", "outputs = { h = { column = \"h\", error = \"poisson\", sigma = 1 } }"),
        ("", "outputs = { h = { column = \"h\", error = \"student\", degrees_of_freedom = 0 } }"),
        ("", "outputs = { h = { column = \"h\", degrees_of_freedom = 4 } }"),
        ("", "outputs = { h = { column = \"bad\", error = \"lognormal\", sigma = 0.1 } }"),
        ("", "inputs = { w = { column = \"u\" } }"),
        ("", "inputs = { u = { column = \"none\" } }"),
        ("", "inputs = { u = { column = \"u\", interpolation = \"cubic\" } }"),
        ("[[experiment]]", "input_time = \"none\""),
        ("[[experiment]]", "set = { k = 1 }"),
        ("[[experiment]]", "set = { nothing = 1 }"),
        ("[[experiment]]", "set = \"none.ssv\""),
        ("[[experiment]]", "start = { q = 1 }"),
        ("[[experiment]]", "start = { h = \"one\" }"),
        ("[[experiment]]", "segments = [77]"),
        ("[[experiment]]", "segments = [2]"),
        ("[[experiment]]", "integrator = \"newton\""),
        ("[[experiment]]", "tolerance = 5"),
        ("[[experiment]]", "max_seconds = -1"),
        ("[[experiment]]", "start_time = 50"),
        ("[[experiment]]", "weight = -1"),
    ]);
    let no_x = PROBLEM.replace("x = { variable = \"time\", column = \"t\" }\n", "");
    assert_eq!(wrong_line(&no_x).0, "[[experiment]]", "{}", wrong_line(&no_x).1);
}

#[test]
fn of_the_rest() {
    check(&[
        ("", "model = \"Tnk\""),
        ("", "model = \"Tank(k = )\""),
        ("", "files = [\"none.mo\"]"),
        ("", "searches = 0"),
        ("", "seed = [0, 0, 0, 0, 0, 0]"),
        ("", "fitness = \"best\""),
        ("", "fitness = [\"sum_of_squares\", \"best\"]"),
        ("", "fitness = { name = \"huber\", width = 2 }"),
        ("", "constraints = [\"k < 1\", \"k == 2\"]"),
        ("", "bands = [\"nothing\"]"),
        ("", "name = \"hill_climbing\""),
        ("[method]", "selection = \"best_of_all\""),
        ("[method]", "selection = { name = \"tournament\", width = 3 }"),
        ("[stop]", "seconds = -1"),
        ("[design]", "points = 0"),
        ("[design]", "range = [2, 1]"),
        ("[design]", "outputs = { nothing = 1 }"),
        ("[bootstrap]", "samples = 1"),
        ("[bootstrap]", "resampling = \"some\""),
        ("[bootstrap]", "interval = \"wide\""),
        ("[posterior]", "samples = 1"),
    ]);
    // The table of the method, where its settings do not fit.
    let settings = with("[method]", "width = 3");
    assert_eq!(wrong_line(&settings).0, "[method]", "{}", wrong_line(&settings).1);
    let several = with("", "fitness = [\"sum_of_squares\", \"mae\"]");
    assert_eq!(wrong_line(&several).0, "[method]", "{}", wrong_line(&several).1);
}
