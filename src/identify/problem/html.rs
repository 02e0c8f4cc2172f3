//! The solution as one HTML page that needs nothing else.

use super::{Solution, SolvedSeries};
use crate::identify::table::significant;
use crate::plot::{self, Comparison};
use std::fmt::Write;

const STYLE: &str = "body{font:15px/1.5 sans-serif;max-width:62em;margin:2em auto;padding:0 1em;color:#222}\
table{border-collapse:collapse;margin:1em 0}td,th{padding:.2em .8em;border-bottom:1px solid #ddd;text-align:left}\
.note{border-left:4px solid #c60;padding:.2em 1em;background:#fff6ee;margin:.4em 0}svg{max-width:100%;height:auto}\
.cell{width:2.6em;height:2.6em;text-align:center;font-size:11px}figure{margin:1em 0}";
/// Individuals drawn in a landscape.
const DRAWN: usize = 1500;

impl Solution {
    /// `report.html`: fits with residuals, convergence, parameters, correlations, landscape,
    /// front, and every number of the text.
    pub fn html(&self) -> String {
        let mut page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title><style>{STYLE}</style></head><body>\n<h1>{0}</h1>\n",
            escaped(&self.title)
        );
        for finding in &self.findings {
            // Writing into a String cannot fail.
            _ = writeln!(page, "<p class=\"note\">{}</p>", escaped(&finding.sentence));
        }
        _ = writeln!(page, "<pre>{}</pre>", escaped(self.text().trim()));
        page += "<h2>Fit and residuals</h2>\n";
        self.series.iter().for_each(|series| page += &fit(series, "fit"));
        self.validation.iter().for_each(|series| page += &fit(series, "validation"));
        page += "<h2>Convergence</h2>\n<figure>";
        let best: Vec<f64> = self.history.iter().map(|generation| generation.best).collect();
        let mean: Vec<f64> = self.history.iter().map(|generation| generation.mean).collect();
        page += &plot::convergence("", &best, &mean).svg();
        page += "</figure>\n";
        page += &self.traces();
        page += &self.correlation_table();
        page += &self.profile_figures();
        if let Some(importance) = &self.importance {
            _ = writeln!(page, "<h2>Sensitivity</h2><pre>{}</pre>", escaped(&importance.text()));
        }
        page += &self.landscapes();
        page += &self.front_figure();
        page += &self.tables();
        page += "</body></html>\n";
        page
    }

    /// Each parameter against the generations, within its range.
    fn traces(&self) -> String {
        let mut html = String::from("<h2>Best values over the generations</h2>\n");
        for (k, parameter) in self.parameters.iter().enumerate() {
            let values: Vec<(f64, f64)> = self
                .trace
                .iter()
                .enumerate()
                .filter_map(|(generation, values)| Some((generation as f64, *values.get(k)?)))
                .collect();
            let place = |(x, value): &(f64, f64)| {
                let x = 20.0 + 560.0 * x / (self.trace.len().max(2) - 1) as f64;
                format!("{x:.1},{:.1}", 70.0 - 60.0 * fraction(parameter, *value))
            };
            let points: Vec<String> = values.iter().map(place).collect();
            _ = writeln!(
                html,
                "<div>{} = {} {}</div><svg viewBox=\"0 0 600 80\" width=\"600\"><rect x=\"20\" y=\"10\" width=\"560\" height=\"60\" fill=\"#f6f6f6\"/><polyline fill=\"none\" stroke=\"#06c\" points=\"{}\"/></svg>",
                escaped(&parameter.name),
                significant(parameter.value, 5),
                escaped(&parameter.unit),
                points.join(" ")
            );
        }
        html
    }

    /// Every generation and the problem as it was written.
    fn tables(&self) -> String {
        let names: String =
            self.parameters.iter().map(|p| format!("<th>{}</th>", escaped(&p.name))).collect();
        let mut html = format!(
            "<h2>Everything</h2>\n<details><summary>Generations</summary><table><tr><th>generation</th><th>best</th><th>mean</th><th>worst</th><th>failures</th>{names}</tr>\n"
        );
        let every = self.history.len().div_ceil(DRAWN).max(1);
        for (k, generation) in self.history.iter().enumerate().step_by(every) {
            let crate::ga::Generation { best, mean, worst, failures } = generation;
            _ = write!(
                html,
                "<tr><td>{}</td><td>{best:.6e}</td><td>{mean:.6e}</td><td>{worst:.6e}</td><td>{failures}</td>",
                k + 1
            );
            let values = self.trace.get(k).into_iter().flatten();
            values.for_each(|value| _ = write!(html, "<td>{}</td>", significant(*value, 7)));
            html += "</tr>\n";
        }
        html += "</table></details>\n";
        if !self.problem.is_empty() {
            _ = writeln!(
                html,
                "<details><summary>The problem as it was written</summary><pre>{}</pre></details>",
                escaped(&self.problem)
            );
        }
        html
    }

    fn correlation_table(&self) -> String {
        let Some(rows) = &self.correlations else { return String::new() };
        let mut html = String::from("<h2>Correlations</h2>\n<table><tr><th></th>");
        self.parameters.iter().for_each(|p| _ = write!(html, "<th>{}</th>", escaped(&p.name)));
        html += "</tr>\n";
        for (parameter, row) in self.parameters.iter().zip(rows) {
            _ = write!(html, "<tr><th>{}</th>", escaped(&parameter.name));
            for entry in row {
                match entry {
                    Some(c) => {
                        let hue = if *c > 0.0 { "200,80,0" } else { "0,90,200" };
                        _ = write!(
                            html,
                            "<td class=\"cell\" style=\"background:rgba({hue},{:.2})\">{c:.2}</td>",
                            c.abs() * 0.8
                        );
                    }
                    None => html += "<td class=\"cell\">-</td>",
                }
            }
            html += "</tr>\n";
        }
        html + "</table>\n"
    }

    /// The smallest sum of squares against each parameter, and the limit of the 95 % interval.
    fn profile_figures(&self) -> String {
        let Some(found) = &self.profiles else { return String::new() };
        let mut html = String::from(
            "<h2>Profiles</h2><p>Smallest sum of squares with one parameter held; below the line: 95 %.</p>\n",
        );
        for (parameter, profile) in self.parameters.iter().zip(&found.profiles) {
            let sums = || profile.points.iter().map(|point| point[1]);
            let low = sums().fold(f64::INFINITY, f64::min);
            let high = 3.0f64.mul_add(profile.limit - low, low).max(f64::MIN_POSITIVE);
            let [from, to] = [profile.points.first(), profile.points.last()]
                .map(|end| end.map_or(0.0, |end| fraction(parameter, end[0])));
            let up = |sum: f64| 140.0 - 130.0 * ((sum - low) / (high - low)).clamp(0.0, 1.0);
            let place = |point: &[f64; 2]| {
                let across = (fraction(parameter, point[0]) - from) / (to - from).max(1e-300);
                format!("{:.1},{:.1}", 20.0 + 360.0 * across, up(point[1]))
            };
            let points: Vec<String> = profile.points.iter().map(place).collect();
            let ends = [profile.points.first(), profile.points.last()]
                .map(|end| end.map_or(String::new(), |end| significant(end[0], 4)));
            let limit = up(profile.limit);
            _ = writeln!(
                html,
                "<div>{}: {} to {}</div><svg viewBox=\"0 0 400 150\" width=\"400\"><rect x=\"20\" y=\"10\" width=\"360\" height=\"130\" fill=\"#f6f6f6\"/><line x1=\"20\" x2=\"380\" y1=\"{limit:.1}\" y2=\"{limit:.1}\" stroke=\"#c60\"/><polyline fill=\"none\" stroke=\"#06c\" points=\"{}\"/></svg>",
                escaped(&parameter.name),
                ends[0],
                ends[1],
                points.join(" ")
            );
        }
        html
    }

    /// What was evaluated, for pairs of neighbouring parameters; darker is better, red failed.
    fn landscapes(&self) -> String {
        let mut html = String::from("<h2>Individuals</h2><p>Darker is better, red failed.</p>\n");
        let mut fitness: Vec<f64> =
            self.individuals.iter().map(|individual| individual.1).collect();
        fitness.sort_by(f64::total_cmp);
        let every = self.individuals.len().div_ceil(DRAWN).max(1);
        for k in 1..self.parameters.len() {
            let (px, py) = (&self.parameters[k - 1], &self.parameters[k]);
            _ = write!(
                html,
                "<figure><div>{} (across), {} (up)</div><svg viewBox=\"0 0 300 300\" width=\"300\"><rect width=\"300\" height=\"300\" fill=\"#f6f6f6\"/>",
                escaped(&px.name),
                escaped(&py.name)
            );
            for (values, own) in self.individuals.iter().step_by(every) {
                let (x, y) =
                    (300.0 * fraction(px, values[k - 1]), 300.0 - 300.0 * fraction(py, values[k]));
                let colour = match crate::ga::has_failed(*own) {
                    true => "#d00".to_owned(),
                    false => {
                        let rank =
                            fitness.partition_point(|f| f < own) as f64 / fitness.len() as f64;
                        format!("hsl(210,60%,{:.0}%)", 15.0 + 75.0 * rank)
                    }
                };
                _ = write!(html, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2\" fill=\"{colour}\"/>");
            }
            html += "</svg></figure>\n";
        }
        html
    }

    fn front_figure(&self) -> String {
        if self.front.len() < 2 || self.objectives.len() != 2 {
            return String::new();
        }
        let end = |j: usize, f: fn(f64, f64) -> f64, from: f64| {
            self.front.iter().map(|p| p.1[j]).fold(from, f)
        };
        let (low, high) = (
            [0, 1].map(|j| end(j, f64::min, f64::INFINITY)),
            [0, 1].map(|j| end(j, f64::max, f64::NEG_INFINITY)),
        );
        let mut html = format!(
            "<h2>Front</h2><div>{} (across), {} (up)</div><svg viewBox=\"-10 -10 420 320\" width=\"420\">",
            escaped(&self.objectives[0]),
            escaped(&self.objectives[1])
        );
        for (k, (_, point)) in self.front.iter().enumerate() {
            let place = |j: usize| (point[j] - low[j]) / (high[j] - low[j]).max(f64::MIN_POSITIVE);
            let (radius, colour) = if self.knee == Some(k) { (6, "#c60") } else { (3, "#06c") };
            _ = write!(
                html,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"{colour}\"/>",
                400.0 * place(0),
                300.0 - 300.0 * place(1)
            );
        }
        html + "</svg>\n"
    }
}

fn fraction(parameter: &super::SolvedParameter, value: f64) -> f64 {
    let [min, max] = parameter.range;
    let fraction = match parameter.logarithmic {
        true => (value / min).ln() / (max / min).ln(),
        false => (value - min) / (max - min),
    };
    fraction.clamp(0.0, 1.0)
}

fn fit(series: &SolvedSeries, kind: &str) -> String {
    let column = |j: usize| series.points.iter().map(|point| point[j]).collect::<Vec<f64>>();
    let (x, measured, simulated) = (column(0), column(1), column(2));
    if simulated.iter().any(|value| !value.is_finite()) {
        return format!(
            "<p class=\"note\">{}: the simulation failed</p>\n",
            escaped(&series.experiment)
        );
    }
    let title = format!("{} ({kind})", series.experiment);
    let figure = plot::fit(&Comparison {
        title: &title,
        x_label: (&series.x[0], &series.x[1]),
        y_label: (&series.y[0], &series.y[1]),
        x: &x,
        measured: &measured,
        simulated: &simulated,
        curve: (&[], &[]),
    });
    format!("<figure>{}</figure>\n", figure.svg())
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
