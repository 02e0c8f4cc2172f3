//! Charts of the guide that no command writes: from the files that the examples of a chapter have made,
//! and from what its text says.

use gapilib::internals::plot::{Axis, Figure, Mark, Panel, Series};
use std::path::Path;

/// Points of a series.
type Points = Vec<(f64, f64)>;

/// The chart of this name; `here` is where the examples were carried out, `text` the chapter.
pub(crate) fn chart(name: &str, here: &Path, text: &str) -> Option<Figure> {
    Some(match name {
        "fitness" => fitness(),
        "regions" => regions(here),
        "profiles" => profiles(here),
        "switch" => switch(here),
        "scales" => scales(),
        "blend_children" => blend_children(),
        "valley" => valley(here),
        "interpolation" => interpolation(),
        "bands" => bands(here),
        "chains" => chains(here),
        "selection" => counts(text, "parents.mos"),
        "efficiency" => efficiency(text),
        "mutation" => mutation(),
        _ => return None,
    })
}

fn series(name: &str, points: &[(f64, f64)], mark: Mark, colour: usize) -> Series {
    let (x, y) = points.iter().copied().unzip();
    Series { name: name.to_owned(), x, y, mark, colour }
}

fn panel(x: Axis, y: Axis, height: f64, series: Vec<Series>) -> Panel {
    Panel { x, y, height, zero_line: false, series }
}

fn one(x: Axis, y: Axis, series: Vec<Series>) -> Figure {
    Figure { title: String::new(), panels: vec![panel(x, y, 260.0, series)] }
}

/// The columns of these names in a CSV file, row by row, in the rows that `is_kept` accepts.
fn columns<const N: usize>(
    file: &Path,
    names: [&str; N],
    is_kept: impl Fn(&csv::StringRecord) -> bool,
) -> Vec<[f64; N]> {
    let mut reader = csv::Reader::from_path(file).expect("a file of the chapter");
    let head = reader.headers().expect("a head").clone();
    let places = names.map(|name| head.iter().position(|own| own == name).expect("a column"));
    let rows = reader.records().map(|row| row.expect("a row")).filter(|row| is_kept(row));
    rows.map(|row| places.map(|at| row[at].parse().unwrap_or(f64::NAN))).collect()
}

/// Two individuals of `search.mos` against the measured points, and the residuals of which the fitness is
/// the sum of squares.
fn fitness() -> Figure {
    const MEASURED: [(f64, f64); 5] =
        [(0.0, 10.02), (2.0, 6.05), (4.0, 3.69), (6.0, 2.22), (8.0, 1.36)];
    let individuals = [(9.895, 3.163), (6.905, 3.867)];
    let at = |(v0, tau): (f64, f64), t: f64| v0 * (-t / tau).exp();
    let [time, voltage] = [Axis::linear("time", "s"), Axis::linear("v", "V")];
    let mut above = vec![series("measured", &MEASURED, Mark::Points, 0)];
    let mut below = Vec::new();
    for (k, genes) in individuals.into_iter().enumerate() {
        let name = format!("V0 = {}, tau = {}", genes.0, genes.1);
        let curve: Points =
            (0..=80).map(|k| f64::from(k) / 10.0).map(|t| (t, at(genes, t))).collect();
        above.push(series(&name, &curve, Mark::Line, k + 1));
        let shift = 0.1 * k as f64;
        let residuals: Points =
            MEASURED.iter().map(|(t, v)| (t + shift, v - at(genes, *t))).collect();
        below.push(series("", &residuals, Mark::Stems, k + 1));
    }
    let mut residuals = panel(time.clone(), Axis::linear("residual", "V"), 110.0, below);
    residuals.zero_line = true;
    Figure { title: String::new(), panels: vec![panel(time, voltage, 230.0, above), residuals] }
}

/// The measured polarization curve with the three regions of its losses.
fn regions(here: &Path) -> Figure {
    let text = std::fs::read_to_string(here.join("cell.csv")).expect("the table");
    let number = |cell: &str| cell.replace(',', ".").parse::<f64>().ok();
    let row = |line: &str| {
        let (j, u) = line.split_once(';')?;
        Some((number(j)? / 1000.0, number(u)?))
    };
    let points: Points = text.lines().filter_map(row).collect();
    let area = |name: &str, [from, to]: [f64; 2], colour| {
        series(name, &[(from, 0.2), (from, 0.92), (to, 0.92), (to, 0.2)], Mark::Area, colour)
    };
    let all = vec![
        area("activation", [0.0, 0.12], 5),
        area("ohmic resistance", [0.12, 1.15], 1),
        area("mass transport", [1.15, 1.5], 2),
        series("measured", &points, Mark::Points, 0),
    ];
    one(Axis::linear("current density", "A/cm2"), Axis::linear("voltage", "V"), all)
}

/// Profiles of the parameters of the fit with known `i0`, over multiples of their best values.
fn profiles(here: &Path) -> Figure {
    let file = here.join("results/fixed/profiles.csv");
    let mut all = Vec::new();
    for (k, name) in ["A", "loss", "iL", "B"].into_iter().enumerate() {
        let rows = columns(&file, ["value", "sum_of_squares"], |row| &row[0] == name);
        let best = rows.iter().min_by(|a, b| a[1].total_cmp(&b[1])).expect("a profile")[0];
        let points: Points = rows.iter().map(|[value, sum]| (value / best, *sum)).collect();
        all.push(series(name, &points, Mark::Line, k + 1));
    }
    let limit = columns(&file, ["limit"], |_| true)[0][0];
    all.push(series("95 % limit", &[(0.5, limit), (2.5, limit)], Mark::Dashed, 0));
    one(Axis::logarithmic("value / best value", ""), Axis::linear("sum of squares", ""), all)
}

/// The plate about the instant at which the heater was switched, measured and fitted with both times.
fn switch(here: &Path) -> Figure {
    let is_near = |[x, _]: &[f64; 2]| (600.0..=900.0).contains(x);
    let near = |file: &str, names, of: &str| -> Points {
        let rows = columns(&here.join(file), names, |row| &row[1] == of);
        rows.into_iter().filter(is_near).map(|[x, y]| (x, y)).collect()
    };
    let curve = ["x", "y"];
    let all = vec![
        series("switched at 720 s", &near("results/step/bands.csv", curve, "T"), Mark::Line, 2),
        series("switched at 700 s", &near("results/logged/bands.csv", curve, "T"), Mark::Line, 1),
        series("measured", &near("results/step/fit.csv", ["x", "measured"], "T"), Mark::Points, 0),
    ];
    one(Axis::linear("time", "s"), Axis::linear("temperature", "degC"), all)
}

/// Twenty samples of a range, on its linear and on its logarithmic scale.
fn scales() -> Figure {
    let at = |k: i32| (f64::from(k) + 0.5) / 20.0;
    let linear: Points = (0..20).map(|k| (10.0 + 190.0 * at(k), 2.0)).collect();
    let logarithmic: Points = (0..20).map(|k| (10.0 * 20f64.powf(at(k)), 1.0)).collect();
    let all = vec![
        series("10 + 190 u", &linear, Mark::Points, 2),
        series("10 * 20^u", &logarithmic, Mark::Points, 1),
        series("", &[(10.0, 0.5), (10.0, 2.5)], Mark::Dashed, 0),
    ];
    let mut drawn = one(Axis::logarithmic("sampled value", ""), Axis::linear("", ""), all);
    drawn.panels[0].height = 110.0;
    drawn
}

/// The children of two individuals by the operator of `blend.mos`, and by one-point crossover.
fn blend_children() -> Figure {
    let [better, worse] = [(9.0_f64, 5.0_f64), (12.0, 2.0)];
    let beyond = |a: f64, b: f64| a + (a - b) / 3.0;
    let blend = [
        ((better.0 + worse.0) / 2.0, (better.1 + worse.1) / 2.0),
        (beyond(better.0, worse.0), beyond(better.1, worse.1)),
    ];
    let exchanged = [(better.0, worse.1), (worse.0, better.1)];
    let all = vec![
        series("", &[blend[1], worse], Mark::Thin, 0),
        series("parents, the better one on the left", &[better, worse], Mark::Points, 0),
        series("children of this Cross", &blend, Mark::Crosses, 1),
        series("children of one-point crossover", &exchanged, Mark::Crosses, 2),
    ];
    one(Axis::linear("V0", ""), Axis::linear("tau", ""), all)
}

/// Individuals of the search whose fitness is near the best: only a ratio is determined.
fn valley(here: &Path) -> Figure {
    let rows =
        columns(&here.join("results/tank/individuals.csv"), ["area", "hole", "fitness"], |_| true);
    let split = |is_good: bool| -> Points {
        let own = rows.iter().filter(|[_, _, fitness]| (*fitness < 100.0) == is_good);
        own.map(|[area, hole, _]| (*area, *hole)).collect()
    };
    let line: Points = [0.1, 10.0].map(|area| (area, area / 675.2)).to_vec();
    let all = vec![
        series("other individuals", &split(false), Mark::Dots, 6),
        series("sum of squares below 100", &split(true), Mark::Points, 2),
        series("area/hole = 675.2", &line, Mark::Line, 1),
    ];
    one(Axis::logarithmic("area", "m2"), Axis::logarithmic("hole", "m2"), all)
}

/// Samples of a step, held and interpolated.
fn interpolation() -> Figure {
    let samples =
        [(0.0, 0.0), (60.0, 0.0), (120.0, 15.0), (180.0, 15.0), (240.0, 5.0), (300.0, 5.0)];
    let held: Points = samples.windows(2).flat_map(|two| [two[0], (two[1].0, two[0].1)]).collect();
    let all = vec![
        series("interpolation = \"hold\"", &held, Mark::Line, 1),
        series("interpolation = \"linear\"", &samples, Mark::Dashed, 2),
        series("rows of the table", &samples, Mark::Points, 0),
    ];
    one(Axis::linear("time", "s"), Axis::linear("input", ""), all)
}

/// Both variables of the decay with their bands.
fn bands(here: &Path) -> Figure {
    let file = here.join("results/decay/bands.csv");
    let mut all = Vec::new();
    for (k, name) in ["c", "product"].into_iter().enumerate() {
        let rows = columns(&file, ["x", "y", "confidence_95"], |row| &row[1] == name);
        let edge = |side: f64| move |[x, y, half]: &[f64; 3]| (*x, y + side * half);
        let area: Points =
            rows.iter().map(edge(1.0)).chain(rows.iter().rev().map(edge(-1.0))).collect();
        let curve: Points = rows.iter().map(|[x, y, _]| (*x, *y)).collect();
        all.push(series(&format!("95 % confidence band of {name}"), &area, Mark::Area, k + 1));
        all.push(series(name, &curve, Mark::Line, k + 1));
    }
    let measured = columns(&here.join("results/decay/fit.csv"), ["x", "measured"], |_| true);
    let measured: Points = measured.into_iter().map(|[x, y]| (x, y)).collect();
    all.push(series("measured c", &measured, Mark::Points, 0));
    let wanted = [(0.0, 0.0), (3.9, 0.0)];
    all.push(series("where D-optimal points lie", &wanted, Mark::Crosses, 3));
    one(Axis::linear("time", "s"), Axis::linear("concentration", "mol/l"), all)
}

/// The draws of k of the four chains, one chain after another.
fn chains(here: &Path) -> Figure {
    let draws = columns(&here.join("posterior/posterior.csv"), ["k"], |_| true);
    let length = draws.len() / 4;
    let chain = |k: usize| {
        let own = draws[k * length..(k + 1) * length].iter().enumerate().step_by(4);
        let points: Points = own.map(|(at, [value])| (at as f64, *value)).collect();
        series(&format!("chain {}", k + 1), &points, Mark::Dots, k + 1)
    };
    one(Axis::linear("draw", ""), Axis::linear("k", "1/s"), (0..4).map(chain).collect())
}

/// The counts that the output of a script shows, as lines over the rank.
fn counts(text: &str, script: &str) -> Figure {
    let after = text.split_once(&format!("$ gapi run {script}\n")).expect("the output").1;
    let lines = after.lines().take_while(|line| !line.starts_with("```"));
    let line = |(k, line): (usize, &str)| {
        let (name, counts) = line.split_once(": ").expect("a name");
        let counts = counts.split(' ').map(|count| count.parse::<f64>().expect("a count"));
        let points: Points = counts.enumerate().map(|(k, count)| (k as f64 + 1.0, count)).collect();
        [series(name, &points, Mark::Line, k), series("", &points, Mark::Dots, k)]
    };
    let all = lines.enumerate().flat_map(line).collect();
    one(Axis::linear("individual, the best first", ""), Axis::linear("times a parent", ""), all)
}

/// The table of efficiencies.
fn efficiency(text: &str) -> Figure {
    let after = text.split_once("| ranks |").expect("the table").1;
    let mut lines = after.lines();
    let names: Vec<&str> = lines.next().expect("the heads").split('|').map(str::trim).collect();
    let number =
        |cell: &str| cell.trim().trim_end_matches(" %").replace(',', "").parse::<f64>().ok();
    let rows: Vec<Vec<f64>> = lines
        .skip(1)
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.split('|').filter_map(number).collect())
        .collect();
    let names = names.into_iter().filter(|name| !name.is_empty()).enumerate();
    let line = |(k, name): (usize, &str)| {
        let points: Points = rows.iter().map(|row| (row[0], row[k + 1])).collect();
        series(&format!("{name} each"), &points, Mark::Line, k)
    };
    let all = names.map(line).collect();
    one(Axis::logarithmic("ranks", ""), Axis::linear("parallel efficiency", "%"), all)
}

/// The new value of a gene over the random number: mutation below `F_Mut` = 0.3.
fn mutation() -> Figure {
    let all = vec![
        series("the gene mutates", &[(0.0, 5.0), (0.3, 20.0)], Mark::Line, 2),
        series("the gene keeps its value", &[(0.3, 11.0), (1.0, 11.0)], Mark::Line, 1),
        series("F_Mut", &[(0.3, 5.0), (0.3, 20.0)], Mark::Dashed, 0),
    ];
    one(Axis::linear("random number u", ""), Axis::linear("gene", ""), all)
}
