//! Names with subscripts, Integers and Booleans, forms of data, and what is said of mistakes. Every
//! number is that of the exact solution.

use super::*;
use crate::identify::problem::Finding;

const CLASSES: &str = include_str!("values/classes.mo");

/// The solution of a problem of the classes; each part of a problem's file as it is written.
fn found(parameters: &str, experiment: &str, data: &str) -> Result<Solution, String> {
    let problem = format!(
        "files = [\"classes.mo\"]\n{parameters}\n[[experiment]]\ndata = \"d.csv\"\n{experiment}\n\
         [stop]\nevaluations = 1500\n"
    );
    let world = match experiment.contains("inputs") {
        true => shipped(MemoryWorld::new(), Path::new("")),
        false => MemoryWorld::new(),
    };
    let world = world
        .with_file("classes.mo", CLASSES)
        .with_file("p.toml", problem)
        .with_file("d.csv", data);
    let mut session = Session::new(Box::new(world));
    solve(&mut session, Path::new("p.toml"), &RunOptions::default()).map_err(|errors| {
        let place = session.sources.text(errors[0].span()).to_owned();
        format!("{} | {} | {place}", errors[0].message, errors[0].helps.join(" | "))
    })
}

#[track_caller]
fn value(solution: &Result<Solution, String>, name: &str, exact: f64) {
    let solution = solution.as_ref().unwrap_or_else(|error| panic!("{error}"));
    let found = solution.parameters.iter().find(|p| p.name == name).expect("the parameter").value;
    assert!((found - exact).abs() < 1e-4 * exact.abs(), "{name} = {found}, exactly {exact}");
}

#[track_caller]
fn says(refused: &Result<Solution, String>, words: &[&str]) {
    let message = refused.as_ref().expect_err("a refusal");
    let missing: Vec<&&str> = words.iter().filter(|word| !message.contains(**word)).collect();
    assert!(missing.is_empty(), "{missing:?} not in: {message}");
    for own in ["GAPILib", "gapi_", "'data of", "'initial value"] {
        assert!(!message.contains(own), "{message}");
    }
}

/// exp(-0.5 t) + exp(-3 t).
fn two_cells(t: f64) -> f64 {
    (-0.5 * t).exp() + (-3.0 * t).exp()
}

#[test]
fn inputs_that_begin_late_or_end_early_and_units_without_another_are_named() {
    // y of the mixer with K = 2, u[1] = 1 from the start on, u[2] = 0.
    let exact = |t: f64| 2.0 * (1.0 - (-t).exp());
    let text = (0..17).map(|k| f64::from(k) / 4.0).map(|t| {
        let known = (1.0..=3.0).contains(&t);
        let u = if known { "1" } else { "" };
        format!("{t},{},{u},0\n", 1000.0 * exact(t))
    });
    let data = format!("time,y [mV],a,b\n{}", text.collect::<String>());
    let entries = "outputs = { y = { column = \"y\", factor = 1e-3 } }\n\
        inputs = { \"u[1]\" = \"a\", \"u[2]\" = \"b\" }";
    let problem = "model = \"Mixer\"\n[method]\nname = \"levenberg_marquardt\"\n\
        [parameters]\nK = { min = 0.1, max = 10 }";
    let solution = found(problem, entries, &data);
    value(&solution, "K", 2.0);
    let said = |solution: &Result<Solution, String>| {
        let findings = &solution.as_ref().unwrap().findings;
        findings.iter().map(|one| one.sentence.clone()).collect::<Vec<_>>().join("\n")
    };
    let notes = said(&solution);
    for words in [
        "`u[1]` has its first value in line 6, at 1 s; before that it is 1",
        "`u[1]` has its last value in line 14, at 3 s; after that it is 1",
    ] {
        assert!(notes.contains(words), "{words}: {notes}");
    }
    assert!(!notes.contains("there the input"), "none is missing inside: {notes}");
    assert!(!notes.contains("mV"), "{notes}");
    let plain = said(&found(problem, &entries.replace(", factor = 1e-3", ""), &data));
    assert!(plain.contains("`y` is in mV, but `y` has no unit"), "{plain}");
}

#[test]
fn replicates_beside_an_input_are_compared_from_the_first_on() {
    let rows = (0..9).flat_map(|k| [f64::from(k) / 2.0; 2]).enumerate().map(|(row, t)| {
        let noise = if row % 2 == 0 { 0.01 } else { -0.01 };
        format!("{t},{},1,0\n", 2.0 * (1.0 - (-t).exp()) + noise)
    });
    let data = format!("time,y,a,b\n{}", rows.collect::<String>());
    let entries = "outputs = { y = \"y\" }\ninputs = { \"u[1]\" = \"a\", \"u[2]\" = \"b\" }";
    let problem = "model = \"Mixer\"\n[method]\nname = \"levenberg_marquardt\"\n\
        [parameters]\nK = { min = 0.1, max = 10 }";
    let solution = found(problem, entries, &data);
    value(&solution, "K", 2.0);
    assert_eq!(solution.unwrap().series[0].points.len(), 18);
}

#[test]
fn elements_are_fixed_tied_set_started_and_constrained() {
    let data = table("time,y", |t| two_cells(t).to_string());
    let outputs = "outputs = { y = \"y\" }";
    let head = "model = \"Stack\"\n[parameters]\n\"c[1].k\" = { min = 0.01, max = 10 }\n";
    let fixed = found(&format!("{head}\"c[2].k\" = {{ fixed = 3 }}"), outputs, &data);
    value(&fixed, "c[1].k", 0.5);
    for tie in ["\"6*c[1].k\"", "'6*\"c[1].k\"'"] {
        let tied = found(&format!("{head}\"c[2].k\" = {{ tied = {tie} }}"), outputs, &data);
        value(&tied, "c[1].k", 0.5);
    }
    let set = found(head, &format!("{outputs}\nset = {{ \"c[2].k\" = 3, \"p[2]\" = 1 }}"), &data);
    value(&set, "c[1].k", 0.5);
    let both = format!(
        "constraints = [\"c[1].k < c[2].k\", '\"c[1].k\" < \"c[2].k\"']\n{head}\"c[2].k\" = {{ min = 0.01, max = 10 }}"
    );
    let both = found(&both, outputs, &data);
    value(&both, "c[1].k", 0.5);
    value(&both, "c[2].k", 3.0);
    // Of the array p one element, so that the other keeps the value of the model.
    let started =
        table("time,y", |t| (4.0 * (-0.5 * t).exp() + 2.0 * (-3.0 * t).exp()).to_string());
    let parts = format!("{head}\"c[2].k\" = {{ fixed = 3 }}\n\"p[2]\" = {{ fixed = 2 }}");
    let start = found(&parts, &format!("{outputs}\nstart = {{ \"c[1].x\" = 4 }}"), &started);
    value(&start, "c[1].k", 0.5);
    let initial = format!("{parts}\n\"c[1].x\" = {{ min = 1, max = 9, initial = true }}");
    let initial = found(&initial, outputs, &started);
    value(&initial, "c[1].k", 0.5);
    value(&initial, "c[1].x", 4.0);
}

#[test]
fn initial_values_of_elements_of_one_array_are_estimated() {
    // T[1] = 2 exp(-k t), T[2]' = k (T[1] - T[2]), T[2](0) = 3.
    let t2 = |t: f64| (3.0 + 2.0 * 0.5 * t) * (-0.5 * t).exp();
    let data = table("time,a,b", |t| format!("{},{}", 2.0 * (-0.5 * t).exp(), t2(t)));
    let parameters = "model = \"Rods\"\n[parameters]\nk = { min = 0.1, max = 10 }\n\
         \"T[1]\" = { min = 0.5, max = 5, initial = true }\n\
         \"T[2]\" = { min = 0.5, max = 5, initial = true }";
    let solution = found(parameters, "outputs = { \"T[1]\" = \"a\", \"T[2]\" = \"b\" }", &data);
    value(&solution, "k", 0.5);
    value(&solution, "T[1]", 2.0);
    value(&solution, "T[2]", 3.0);
}

#[test]
fn integers_and_booleans_are_values() {
    let parameters = "model = \"Rods\"\n[parameters]\nk = { min = 0.1, max = 10 }\n";
    let outputs = "outputs = { y = \"y\" }";
    // Three pieces at 1: y = (1 + k t + (k t)^2/2) exp(-k t) with k = 2.
    let cold = |t: f64| (1.0 + 2.0 * t + 2.0 * t * t) * (-2.0 * t).exp();
    let data = table("time,y", |t| cold(t).to_string());
    let set = found(parameters, &format!("{outputs}\nset = {{ n = 3 }}"), &data);
    value(&set, "k", 2.0);
    let fixed = found(&format!("{parameters}n = {{ fixed = 3.0 }}"), outputs, &data);
    value(&fixed, "k", 2.0);
    // Heated, of one piece: T' = 1 - k T.
    let warm = table("time,y", |t| (0.5 + 0.5 * (-2.0 * t).exp()).to_string());
    let set = found(parameters, &format!("{outputs}\nset = {{ heated = true, n = 1 }}"), &warm);
    value(&set, "k", 2.0);
    let wrong = found(parameters, &format!("{outputs}\nset = {{ n = 2.5 }}"), &data);
    says(&wrong, &["the value of `n` is Real, expected Integer", "2.5"]);
    let wrong = found(parameters, &format!("{outputs}\nset = {{ heated = 1 }}"), &data);
    says(&wrong, &["`heated` is Boolean", "1"]);
    let infinite = found(&format!("{parameters}n = {{ fixed = inf }}"), outputs, &data);
    says(&infinite, &["`n` is inf", "finite"]);
}

#[test]
fn what_cannot_be_estimated_is_refused_before_the_first_simulation() {
    let data = table("time,y", |t| (-t).exp().to_string());
    let outputs = "outputs = { y = \"y\" }";
    let with = |entry: &str, outputs: &str| {
        found(&format!("model = \"Rods\"\n[parameters]\n{entry}"), outputs, &data)
    };
    says(&with("n = { min = 1, max = 9 }", outputs), &["`n` is Integer", "fixed = ", "{ min = 1"]);
    says(&with("heated = { min = 0, max = 1 }", outputs), &["`heated` is Boolean", "{ min = 0"]);
    says(&with("other = { min = 0, max = 1 }", outputs), &["`other`", "`final`"]);
    says(&with("kk = { min = 0, max = 1 }", outputs), &["`Rods` has no parameter `kk`", "`k`"]);
    says(&with("y = { min = 0, max = 1 }", outputs), &["`y` is a variable", "initial = true"]);
    let k = "k = { min = 0.1, max = 9 }";
    let other = with(&format!("{k}\ntwice = {{ min = 1, max = 9, initial = true }}"), outputs);
    says(&other, &["`twice` is not a state", "`T[1]`", "`T[2]`"]);
    let dated = found(
        &format!("model = \"Rods\"\n[parameters]\n{k}"),
        "x = \"Zeit\"\noutputs = { y = \"y\" }",
        &table("Zeit,y", |t| (-t).exp().to_string()),
    );
    says(&dated, &["`x = { variable = \"time\", column = \"Zeit\" }`"]);
    says(&with(k, "outputs = { yy = \"y\" }"), &["`Rods` has no variable `yy`", "`y`"]);
    says(&with(k, "outputs = { T = \"y\" }"), &["no variable `T`", "`\"T[1]\"`"]);
    says(
        &with(k, "x = { variable = \"t\", column = \"time\" }\noutputs = { y = \"y\" }"),
        &["`t`", "did you mean `time`?"],
    );
    says(
        &with(&format!("{k}\nother = {{ fixed = 2 }}"), outputs),
        &["`other` is final", "{ fixed = 2 }"],
    );
    says(&with(&format!("{k}\nheat = {{ fixed = 2 }}"), outputs), &["`heat`", "{ fixed = 2 }"]);
    says(
        &with(&format!("{k}\n\"T[7]\" = {{ fixed = 2, initial = true }}"), outputs),
        &["`T`", "[7]"],
    );
    let model = found(&format!("model = \"Rods.mo\"\n[parameters]\n{k}"), outputs, &data);
    says(&model, &["`Rods.mo`", "`Rods`"]);
}

#[test]
fn values_that_a_record_keeps_are_refused() {
    let data = table("time,y", |t| (6.0 * (1.0 - (-0.5 * t).exp())).to_string());
    let head = "model = \"Sized\"\n[parameters]\nk = { min = 0.1, max = 10 }\n";
    let outputs = "outputs = { y = \"y\" }";
    value(&found(&format!("{head}\"free.a\" = {{ fixed = 3 }}"), outputs, &data), "k", 0.5);
    let kept = found(&format!("{head}\"own.a\" = {{ fixed = 6 }}"), outputs, &data);
    says(&kept, &["`own.a` cannot be set to 6", "its value 2", "{ fixed = 6 }"]);
    let kept = found(head, &format!("{outputs}\nset = {{ \"own.a\" = 6 }}"), &data);
    says(&kept, &["`own.a` cannot be set to 6", "| 6"]);
}

/// A parameter that only `set` uses need not be one of the model; one that initial equations determine keeps
/// their value.
#[test]
fn parameters_of_the_problem_alone_are_values_of_experiments() {
    let data = table("time,y", |t| (-0.5 * t).exp().to_string());
    let head = "model = \"Cell\"\n[parameters]\nhalf = { min = 0.1, max = 10 }\n\
                other = { min = 0.1, max = 10 }\n";
    let outputs = "outputs = { x = \"y\" }\n";
    let both = format!(
        "{outputs}set = {{ k = \"2*half\" }}\n[[experiment]]\ndata = \"d.csv\"\n{outputs}\
         start = {{ x = \"2*other\" }}\nset = {{ k = \"half + 0.25*other^0\" }}\n"
    );
    let found = found(head, &both, &data);
    value(&found, "half", 0.25);
    value(&found, "other", 0.5);
    let data = table("time,y", |_| "1".to_owned());
    let kept = self::found(
        "model = \"Rest\"\n[parameters]\nk = { min = 0.1, max = 10 }\nq = { fixed = 1.5 }\n",
        "outputs = { y = \"y\" }\n",
        &data,
    );
    says(&kept, &["`q` cannot be set", "initial equations", "{ fixed = 1.5 }"]);
}

/// y of the valve with K = 2, T = 1.5, open from 1 to 3.
fn opened(t: f64, level: f64) -> f64 {
    let rise = |t: f64| 2.0 * level * (1.0 - (-t / 1.5).exp());
    match t {
        t if t <= 1.0 => 0.0,
        t if t <= 3.0 => rise(t - 1.0),
        t => rise(2.0) * (-(t - 3.0) / 1.5).exp(),
    }
}

#[test]
fn boolean_and_integer_inputs_follow_columns_of_words_and_numbers() {
    let parameters = "model = \"Valve\"\n[parameters]\nK = { min = 0.1, max = 10 }\n\
                      T = { min = 0.1, max = 10 }";
    let experiment = "outputs = { y = \"y\" }\ninputs = { open = \"open\", level = \"level\" }";
    for words in [["FALSE", "TRUE"], ["0", "1"], ["off", "On"]] {
        let is_open = |t: f64| words[usize::from((1.0..3.0).contains(&t))];
        let data = table("time,open,level,y", |t| format!("{},2,{}", is_open(t), opened(t, 2.0)));
        let solution = found(parameters, experiment, &data);
        value(&solution, "K", 2.0);
        value(&solution, "T", 1.5);
    }
    let data = table("time,open,level,y", |t| format!("{t},2,{}", opened(t, 2.0)));
    says(&found(parameters, experiment, &data), &["`open` is Boolean", "0.25", "line 3"]);
    let linear = experiment
        .replace("level = \"level\"", "level = { column = \"level\", interpolation = \"linear\" }");
    let data = table("time,open,level,y", |t| format!("1,2,{}", opened(t, 2.0)));
    says(&found(parameters, &linear, &data), &["`level`", "interpolated linearly"]);
    let wrong = experiment.replace("open =", "K = \"y\", open =");
    says(&found(parameters, &wrong, &data), &["`K` is a parameter", "`open`, `level`"]);
}

/// Times in minutes that are read as seconds let the estimates end at their bounds.
#[test]
fn columns_that_are_read_wrongly_come_first_and_are_found() {
    let parameters = "model = \"Valve\"\n[parameters]\nK = { min = 0.1, max = 3 }\n\
                      T = { min = 10, max = 1000 }";
    let experiment = "outputs = { y = \"y\" }\ninputs = { open = \"open\", level = \"level\" }";
    let data = |sign: f64| {
        table("time,open,level,y", |t| {
            format!("{},2,{}", (1.0..3.0).contains(&t), sign * opened(t, 2.0))
        })
    };
    let minutes = found(parameters, experiment, &data(1.0)).unwrap();
    let first = &minutes.findings[0].sentence;
    assert!(first.contains("check how the data are read"), "{first}");
    assert!(
        first.contains("with the times `time` multiplied by 60, as if they were in minutes"),
        "{first}"
    );
    assert!(!minutes.text().contains("Widen the range"), "{}", minutes.text());
    let page = minutes.html();
    assert!(!page.contains("parameters are identifiable from"), "{page}");
    let parameters = parameters.replace("10, max = 1000", "0.1, max = 10");
    let sign = found(&parameters, experiment, &data(-1.0)).unwrap();
    let first = &sign.findings[0].sentence;
    assert!(first.contains("the other sign of the column `y` (output `y`)"), "{first}");
    let right = found(&parameters, experiment, &data(1.0)).unwrap();
    assert!(!right.may_be_misread(), "{:?}", right.findings);
    // A single parameter at an end: a wider range is as good an explanation as another unit.
    let data = table("time,x", |t| format!("{}", (-0.5 * t).exp()));
    let parameters = "model = \"Cell\"\n[parameters]\nk = { min = 1e-4, max = 0.05 }";
    let single = found(parameters, "outputs = { x = \"x\" }", &data).unwrap();
    let [range, columns] = [0, 1].map(|k| &single.findings[k].sentence);
    assert!(range.contains("Widen the range"), "{range}");
    assert!(columns.contains("in minutes (R² 1)"), "{columns}");
}

#[test]
fn measured_booleans_are_compared() {
    let parameters =
        "model = \"Valve\"\n[parameters]\nK = { fixed = 2 }\nT = { min = 0.1, max = 10 }";
    let experiment = "outputs = { y = \"y\", high = \"high\" }\n\
                      inputs = { open = \"open\", level = \"level\" }";
    let data = table("time,open,level,y,high", |t| {
        let y = opened(t, 2.0);
        format!("{},2,{y},{}", u8::from((1.0..3.0).contains(&t)), y > 1.0)
    });
    let solution = found(parameters, experiment, &data);
    value(&solution, "T", 1.5);
    assert_eq!(solution.unwrap().series[1].rmse, 0.0);
}

#[test]
fn elements_of_input_arrays_follow_columns() {
    // y' = K (1 + 2*2) - y
    let data = table("time,a,b,y", |t| format!("1,2,{}", 15.0 * (1.0 - (-t).exp())));
    let parameters = "model = \"Mixer\"\n[parameters]\nK = { min = 0.1, max = 10 }";
    let outputs = "outputs = { y = \"y\" }";
    let both = found(
        parameters,
        &format!("{outputs}\ninputs = {{ \"u[1]\" = \"a\", \"u[2]\" = \"b\" }}"),
        &data,
    );
    value(&both, "K", 3.0);
    let one = found(parameters, &format!("{outputs}\ninputs = {{ \"u[1]\" = \"a\" }}"), &data);
    says(&one, &["only some elements of `u`", "`u[2]`"]);
}

#[test]
fn replicates_are_series_of_one_variable() {
    let parameters = "model = \"Rods(n = 1)\"\n[parameters]\nk = { min = 0.1, max = 10 }";
    // The mean of both columns is the exact solution, so that least squares find it.
    let y = |t: f64| (-2.0 * t).exp();
    let data = table("time,y1,y2", |t| {
        let error = 0.01 * (5.0 * t).sin();
        format!("{},{}", y(t) + error, y(t) - error)
    });
    for outputs in [
        "outputs = { y = [\"y1\", \"y2\"] }",
        "outputs = { y = { columns = [\"y1\", \"y2\"], sigma = 0.01 } }",
    ] {
        let solution = found(parameters, outputs, &data);
        value(&solution, "k", 2.0);
        let solution = solution.unwrap();
        assert_eq!(solution.series.len(), 2);
        assert_eq!(solution.series.iter().map(|one| one.points.len()).sum::<usize>(), 34);
    }
}

#[test]
fn points_without_sigma_are_omitted_and_named() {
    let parameters = "model = \"Rods(n = 1)\"\n[parameters]\nk = { min = 0.1, max = 10 }";
    let outputs = "outputs = { y = { column = \"y\", sigma = \"s\" } }";
    let data = table("time,y,s", |t| {
        let sigma = if t == 0.5 { "" } else { "0.01" };
        let y = if t == 0.5 { 7.0 } else { (-2.0 * t).exp() };
        format!("{y},{sigma}")
    });
    let solution = found(parameters, outputs, &data);
    value(&solution, "k", 2.0);
    let solution = solution.unwrap();
    assert_eq!(solution.series[0].points.len(), 16);
    let said = |finding: &Finding| {
        finding.sentence.contains("1 point of `y` without a sigma omitted: line 4")
    };
    assert!(solution.findings.iter().any(said));
    let zero = data.replace(",0.01\n1,", ",0\n1,");
    says(&found(parameters, outputs, &zero), &["the sigma of `y` is 0", "line 5"]);
}

#[test]
fn simulations_that_all_fail_end_the_search_with_equation_time_and_values() {
    let data = table("time,y", |t| (1.0 / (t + 0.3)).to_string());
    let data = data.replace("\n0,", "\n0.1,");
    let parameters = "model = \"Early\"\n[parameters]\na = { min = 0.1, max = 10 }";
    let refused = found(parameters, "outputs = { y = \"y\" }", &data);
    says(&refused, &["none of the first", "t = 0", "1/(a*time)", "a = ", "start_time = 0.1"]);
    let count = refused.err().and_then(|message| {
        message.split("the first ").nth(1)?.split(' ').next()?.parse::<u64>().ok()
    });
    assert!(count.is_some_and(|count| count < 600), "{count:?}");
}

#[test]
fn results_of_a_simulation_are_data() {
    let mut table = crate::results::ResultTable::new((0..17).map(|k| f64::from(k) / 4.0).collect());
    let y = table.time.iter().map(|t| (-2.0 * t).exp()).collect();
    let series = |name: &str, values| crate::results::Series::new(name, values);
    table.series.push(series("k", crate::results::Values::Constant(2.0)));
    table.series.push(series("y", crate::results::Values::Trajectory(y)));
    let alias = crate::results::Values::Alias { of: 1, negated: true };
    table.series.push(series("minus", alias));
    let bytes = crate::results::format("mat").and_then(|format| format.write(&table)).unwrap();
    let data = crate::results::read_data("r.mat", &bytes).unwrap();
    assert_eq!(data.column("k").unwrap().values, [2.0; 17]);
    let column = |name: &str| data.column(name).unwrap().values;
    assert!(column("y").iter().zip(column("minus")).all(|(y, minus)| *y == -minus));
    let problem = "model = \"Rods(n = 1)\"\nfiles = [\"classes.mo\"]\n[parameters]\n\
                   k = { min = 0.1, max = 10 }\n[[experiment]]\ndata = \"r.mat\"\noutputs = { y = \"y\" }\n";
    let world = MemoryWorld::new()
        .with_file("classes.mo", CLASSES)
        .with_file("p.toml", problem)
        .with_file("r.mat", bytes);
    let mut session = Session::new(Box::new(world));
    let solution = solve(&mut session, Path::new("p.toml"), &RunOptions::default());
    value(&solution.map_err(|errors| errors[0].message.clone()), "k", 2.0);
}

#[test]
fn drafts_name_columns_of_matrices_and_leave_out_what_is_computed() {
    let rows: Vec<Vec<f64>> = (0..5).map(|k| vec![f64::from(k), 2.0 * f64::from(k), 1.0]).collect();
    let bytes = crate::mat::write_v5([("meas", &crate::mat::Matrix::from_rows(&rows))]).unwrap();
    let model = include_str!("values/matrices.mo");
    let world = MemoryWorld::new()
        .with_file("meas.mat", bytes)
        .with_file("T.csv", "time,T,Tm\n0,20,20\n1,19,19\n")
        .with_file("Oven.mo", model);
    let mut session = Session::new(Box::new(world));
    let mut drafted = |data: &str| {
        let options = DraftOptions {
            data: data.to_owned(),
            models: "Oven.mo".to_owned(),
            ..DraftOptions::default()
        };
        draft(&mut session, &options).unwrap_or_else(|errors| panic!("{}", errors[0].message))
    };
    let of_matrix = drafted("meas.mat");
    let text = &of_matrix.text;
    assert!(text.contains("x = { variable = \"time\", column = \"meas[:,1]\" }"), "{text}");
    assert!(
        text.contains("\noutputs.Tm = { column = \"meas[:,") && text.contains("a guess"),
        "{text}"
    );
    assert!(of_matrix.incomplete.is_none(), "{:?}", of_matrix.incomplete);
    let of_table = drafted("T.csv");
    assert!(
        of_table.text.contains("# tau = ")
            && of_table.text.contains("the model computes it: C / G"),
        "{}",
        of_table.text
    );
    assert!(of_table.text.contains("\noutputs.Tm") && !of_table.text.contains("\noutputs.T "));
    assert!(of_table.incomplete.is_none(), "{:?}", of_table.incomplete);
}

#[test]
fn the_calibrated_model_has_what_the_file_fixes_and_ties() {
    let data = table("time,y", |t| two_cells(t).to_string());
    let parameters = "model = \"Stack\"\n[parameters]\n\"c[1].k\" = { min = 0.01, max = 10 }\n\
                      \"c[2].k\" = { tied = \"6*c[1].k\" }\n\"p[1]\" = { fixed = 1 }";
    let solution = found(parameters, "outputs = { y = \"y\" }", &data).unwrap();
    let text = solution.modelica();
    let k = solution.parameters[0].value;
    assert!(text.contains(&format!("c(k = {{{k}, 6*c[1].k}})")), "{text}");
    assert!(text.contains("p = {1, 1}"), "{text}");
    let rods = "model = \"Rods\"\n[parameters]\nk = { min = 0.1, max = 10 }\nn = { fixed = 2 }\n\
                \"T[1]\" = { fixed = 2, initial = true }\n\"T[2]\" = { fixed = 3, initial = true }";
    let data = table("time,y", |t| ((3.0 + t) * (-0.5 * t).exp()).to_string());
    let solution = found(rods, "outputs = { y = \"y\" }", &data);
    value(&solution, "k", 0.5);
    let text = solution.unwrap().modelica();
    assert!(
        text.contains("T(start = {2, 3}, each fixed = true)") && text.contains("n = 2"),
        "{text}"
    );
}

/// A strong pattern makes the readings be tried although no estimate lies at an end; where none is better,
/// nothing is said of them, and the verdicts say what they assume.
#[test]
fn residuals_with_a_strong_pattern_condition_the_verdicts() {
    let parameters = "model = \"Valve\"\n[parameters]\nK = { fixed = 2 }\n\
                      T = { min = 0.1, max = 1e6 }";
    let experiment = "outputs = { y = \"y\" }\ninputs = { open = \"open\", level = \"level\" }";
    let data = table("time,open,level,y", |t| {
        format!("{},2,{}", (1.0..3.0).contains(&t), 1e-3 * opened(t, 2.0))
    });
    let milli = found(parameters, experiment, &data).unwrap();
    assert!(milli.parameters.iter().all(|own| !own.at_bound), "{}", milli.text());
    let text = milli.text();
    assert!(text.contains("the column `y` (output `y`) multiplied by 1000 (R² 1)"), "{text}");
    assert!(milli.to_json().contains("\"verdicts_assume\": \"if the data are read correctly\""));
    let data = table("time,x", |t| format!("{}", (-0.5 * t).exp() + 0.2 * (2.0 * t).sin()));
    let parameters = "model = \"Cell\"\n[parameters]\nk = { min = 1e-3, max = 10 }";
    let other = found(parameters, "outputs = { x = \"x\" }", &data).unwrap();
    assert!(!other.text().contains("short fit"), "{}", other.text());
    let page = other.html();
    assert!(page.contains("does not describe these data within their noise"), "{page}");
    assert!(page.contains("identifiable from these data, if the model is right"), "{page}");
    assert!(other.to_json().contains("\"verdicts_assume\": \"if the model is right\""));
}

/// Times in minutes and an output in thousandths: neither change alone explains these data.
#[test]
fn two_columns_that_are_read_wrongly_are_found_together() {
    let parameters = "model = \"Valve\"\n[parameters]\nK = { fixed = 2 }\n\
                      T = { min = 0.5, max = 100 }";
    let experiment = "x = { variable = \"time\", column = \"Zeit\" }\noutputs = { y = \"y\" }\n\
                      inputs = { open = \"open\", level = \"level\" }";
    let row = |k: u32| {
        let t = f64::from(k) / 4.0;
        format!("{},{},2,{}\n", t / 60.0, (1.0..3.0).contains(&t), 1e-3 * opened(t, 2.0))
    };
    let data = "Zeit,open,level,y\n".to_owned() + &(0..17).map(row).collect::<String>();
    let solution = found(parameters, experiment, &data).unwrap();
    let text = solution.text();
    let pair = "the times `Zeit` multiplied by 60, as if they were in minutes and the column `y` \
                (output `y`) multiplied by 1000";
    assert!(text.contains(pair), "{text}");
    assert!(text.contains("`Zeit` has no unit, and is read in seconds"), "{text}");
}

#[test]
fn parameters_without_effect_are_no_missed_minimum() {
    let parameters = "model = \"Valve\"\n[parameters]\nK = { min = 0.1, max = 10 }\n\
                      T = { min = 0.1, max = 10 }";
    let data = table("time,y", |t| format!("{}", opened(t, 2.0)));
    let text = found(parameters, "outputs = { y = \"y\" }", &data).unwrap().text();
    assert!(text.contains("No parameter changes the simulated values"), "{text}");
    assert!(!text.contains("not a minimum"), "{text}");
}

/// A parameter has no initial value: neither in `start` nor as one that is estimated.
#[test]
fn initial_values_of_parameters_are_refused() {
    let model = "model Own\n  parameter Real k = 1, A = 2;\n  Real x(start = A, fixed = true);\nequation\n  \
                 der(x) = -k*x;\nend Own;\n";
    let data = table("time,x", |t| (-t).exp().to_string());
    for (parameter, start) in
        [("A = { min = 1, max = 3, initial = true }", ""), ("", "start = { A = 3 }")]
    {
        let problem = format!(
            "model = \"Own\"\nfiles = [\"m.mo\"]\n[parameters]\nk = {{ min = 0.1, max = 10 }}\n\
             {parameter}\n[[experiment]]\ndata = \"d.csv\"\noutputs = {{ x = \"x\" }}\n{start}\n"
        );
        let files = [("p.toml", problem), ("d.csv", data.clone()), ("m.mo", model.to_owned())];
        let said = refusal_of(&files);
        assert!(said.contains("`A` is a parameter of `Own`, which has a value"), "{said}");
    }
}
