//! A trace as one [`Page`] that needs nothing else: the data as JSON, the drawing as a script of the
//! page's own.
//!
//! A long run would make a page that no browser opens: the page has the steps of some generations
//! only, those that `kept` names, and the curve of convergence of all. Its data are compressed (gzip,
//! RFC 1952, in base64), and the browser unpacks them.

pub use super::changed_run::WhatIf;
use super::explain::explain;
use super::family::{Member, family};
use super::generation::{Generation, Origin};
use super::kept::{Kept, MOST_ROWS, kept};
use super::operation_table::{self, Row};
use super::plain::{title, unit};
use super::quiz;
use super::scaling::{Scaling, scaling};
use super::step::Step;
use super::trace::Trace;
use super::walk::TraceCursor;
use crate::page::Page;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::Compression;
use flate2::write::GzEncoder;
use maud::{Markup, html};
use serde_json::{Value, json};
use std::io::Write as _;

const STYLE: &str = include_str!("page/style.css");
const UNPACK: &str = include_str!("page/unpack.js");
const SCRIPT: &str = include_str!("page/page.js");
const PANELS: &str = include_str!("page/panels.js");
const CHARTS: &str = include_str!("page/charts.js");
const WHAT_IF: &str = include_str!("page/what_if.js");
const OPERATORS: &str = include_str!("page/operators.js");
/// Bytes of the data of a page that are there as they are; more are compressed.
const PLAIN: usize = 2_300_000;
/// Bytes of the data before they are compressed: case 4.1 with the settings of the paper (5000
/// generations of 100 individuals with 6 genes) has room for all its improvements.
pub(super) const MOST_DATA: usize = 8_000_000;
/// Bytes of the compressed data: with what else a page has, it stays below 3 MB.
const MOST_PACKED: usize = 2_300_000;
/// Points of the curve of convergence.
const CURVE_POINTS: usize = 1000;

/// The page of a trace; `result` is the content of the run's `result.json`, if there is one.
/// `what_if` is shown beside the run.
pub fn page(trace: Trace, result: Option<&str>, what_if: Option<&WhatIf>) -> String {
    let what_if = what_if.map_or(Value::Null, |what_if| what_if.data(&trace));
    let result = result.and_then(|text| serde_json::from_str(text).ok()).unwrap_or(Value::Null);
    let page = Page {
        title: &format!("{} - step by step", subject_name(&trace)),
        style: STYLE,
        scripts: &[&format!(
            "(() => {{\nconst start = DATA => {{\n{SCRIPT}\n{PANELS}\n{CHARTS}\n{WHAT_IF}\n\
             {OPERATORS}\n}};\n{UNPACK}\n}})();"
        )],
        data: &[fitting(trace, &result), ("what-if-data", what_if.to_string())],
        body: body(),
    };
    page.document()
}

/// The model, or the script where no model is simulated.
fn subject_name(trace: &Trace) -> &str {
    match (trace.subject.model.as_str(), trace.scripts.first()) {
        ("", Some(script)) => &script.name,
        (model, _) => model,
    }
}

fn body() -> Markup {
    html! {
        header {
            h1 { "A genetic algorithm, step by step" }
            p id="subject" {}
            p id="kept" hidden {}
        }
        nav aria-label="Steps" { (controls()) }
        section id="story" aria-live="polite" {
            h2 id="title" {}
            p id="text" {}
            form id="prediction" hidden {
                label { "Your answer " input id="answer" autocomplete="off"; } " "
                button id="predict" { "Answer" }
                " " span id="score" {}
            }
        }
        main {
            nav.position aria-label="Position" { (position()) }
            div.column {
                (panel("drawing", "This step"))
                (panel("fit", "Measured and simulated"))
                (landscape_panel())
            }
            div.column {
                (population_panel())
                (family_panel())
                (panel("tell", "Can the data tell?"))
            }
            div.column {
                (script_panel())
                (curve_panel())
                (what_if_panel())
            }
        }
    }
}

/// The generation at hand, and the next one as far as it is made.
fn population_panel() -> Markup {
    html! {
        section id="population-panel" {
            h3 { "The population" }
            div id="population" {}
            p.note id="heads" {}
            p id="unfolding" { label { input id="unfold" type="checkbox"; " show all individuals" } }
            p id="individual" aria-live="polite" { "\u{a0}" }
            p.legend id="legend" { (LEGEND) }
        }
    }
}

/// The fitness over two genes.
fn landscape_panel() -> Markup {
    html! {
        section id="landscape-panel" {
            h3 { "The landscape of the fitness" }
            p {
                label { "across " select id="across" {} } " "
                label { "up " select id="up" {} }
            }
            div id="landscape" {}
        }
    }
}

/// Where the best comes from.
fn family_panel() -> Markup {
    html! {
        section id="family-panel" {
            h3 { "The family of the best" }
            p {
                label {
                    "of "
                    select id="whose" {
                        option value="now" { "this generation" }
                        option value="winner" { "the whole run" }
                    }
                }
            }
            div id="family" {}
        }
    }
}

/// The script with the line of this step.
fn script_panel() -> Markup {
    html! {
        section id="script-panel" {
            h3 { "The script" }
            p id="script-name" {}
            pre id="script" tabindex="0" {}
        }
    }
}

/// What the reader changes, and both runs beside each other.
fn what_if_panel() -> Markup {
    html! {
        section id="what-if-panel" {
            h3 { "What if?" }
            form id="what-if" {
                label {
                    "from this generation on, "
                    select id="changed" {
                        option value="F_Mut" { "F_Mut" }
                        option value="N_Parents" { "N_Parents" }
                        option value="N_Elitism" { "N_Elitism" }
                        option value="Seed" { "Seed" }
                    }
                }
                label { " := " input id="changed-to" autocomplete="off" size="6" aria-label="New value"; } " "
                button id="run-what-if" { "Compare" }
            }
            p id="what-if-said" aria-live="polite" {}
            div id="both" {}
        }
    }
}

/// The curve up to now, and the switch for the rest.
fn curve_panel() -> Markup {
    html! {
        section id="curve-panel" {
            h3 id="curve-heading" { "Best fitness over the generations" }
            p { label { input id="future" type="checkbox"; " show how it continues" } }
            div id="curve" {}
        }
    }
}

const LEGEND: &str = "Each row is one individual, each column one gene: dark is the lower end of its \
    range, light the upper. \u{265b} elite, \u{2715} failed simulation, \u{25cf} changed by mutation; \
    below the dashed line of the selection there are no parents. Point at a row to read its numbers, \
    or reach the rows with the tab key and go through them with the arrows up and down.";

/// A section that the script fills.
fn panel(id: &str, heading: &str) -> Markup {
    html! {
        section id={ (id) "-panel" } {
            h3 { (heading) }
            div id=(id) {}
        }
    }
}

/// Buttons and sliders that choose the step.
fn controls() -> Markup {
    let button = |id: &str, title: &str, label: &str, sign: &str| {
        html! { button id=(id) title=(title) aria-label=(label) { (sign) } }
    };
    html! {
        (button("first", "First step (Home)", "First step", "|\u{25c0}"))
        (button(
            "previous-generation",
            "Previous generation (Page Up)",
            "Previous generation",
            "\u{25c0}\u{25c0}",
        ))
        (button("back", "Back (left arrow)", "One step back", "\u{25c0}"))
        button id="play" title="Play or pause (space)" aria-pressed="false" { "Play" }
        (button("next", "Next (right arrow)", "One step on", "\u{25b6}"))
        (button(
            "next-generation",
            "Next generation (Page Down)",
            "Next generation",
            "\u{25b6}\u{25b6}",
        ))
        (button("last", "Last step (End)", "Last step", "\u{25b6}|"))
        label {
            "Play "
            select id="pace" {
                option value="1" { "every step" }
                option value="2" { "every part" }
                option value="3" { "every generation" }
            }
        }
    }
}

/// Which step it is, and how the page asks.
fn position() -> Markup {
    html! {
        label { input id="predicting" type="checkbox"; " predict first" }
        a id="link" href="#" { "link to this step" }
        div.sliders {
            label.slide {
                span id="unit" { "Generation" } " "
                input id="generations" type="range" min="1" value="1" aria-label="Generation";
                " "
                input id="generation" type="number" min="1" value="1"
                    aria-label="Number of the generation";
                " "
                output id="jump" {}
            }
            label.slide {
                "Step "
                input id="slider" type="range" min="1" value="1"
                    aria-label="Step of this generation";
                " "
                output id="step" {}
            }
        }
    }
}

/// Whether `result`, the content of a `result.json`, reports the run of this trace: model, number of
/// generations and best fitness agree.
pub fn belongs(trace: &Trace, result: &str) -> bool {
    let Ok(result) = serde_json::from_str::<Value>(result) else { return false };
    let best = trace.generations.iter().filter_map(Generation::best);
    let best = best.map(|(_, fitness)| fitness).min_by(f64::total_cmp);
    result["model"] == json!(trace.subject.model)
        && result["generations"] == json!(trace.generations.len())
        && best.is_some_and(|best| result["script"]["fitness"] == json!(best))
}

/// The data of the page with the id of their element: as they are, or compressed, with as many
/// generations as there is room for.
fn fitting(trace: Trace, result: &Value) -> (&'static str, String) {
    let mut walk = TraceCursor::new(trace);
    let mut most = MOST_DATA;
    loop {
        let kept = kept(&walk.trace().generations, most);
        let data = data(&mut walk, &kept, result).to_string();
        if data.len() <= PLAIN {
            return ("data", data);
        }
        let packed = packed(&data);
        if packed.len() <= MOST_PACKED || kept.numbers.len() <= 2 {
            return ("packed-data", packed);
        }
        // The size is nearly in proportion; a little less, so that the next one fits.
        most = most * 9 / 10 * MOST_PACKED / packed.len();
    }
}

/// A string of JSON that stands for the data.
fn packed(data: &str) -> String {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::new(9));
    let written = encoder.write_all(data.as_bytes()).and_then(|()| encoder.finish());
    // Writing to a vector does not fail.
    format!("\"{}\"", BASE64.encode(written.unwrap_or_default()))
}

fn data(walk: &mut TraceCursor, chosen: &Kept, result: &Value) -> Value {
    let kept = &chosen.numbers;
    let steps: Vec<Value> = (0..kept.len()).flat_map(|g| steps(walk, kept, g)).collect();
    let trace = walk.trace();
    let subject = &trace.subject;
    let (minima, maxima) = ranges(&trace.generations);
    let scripts: Vec<Value> =
        trace.scripts.iter().map(|s| json!({"name": s.name, "lines": s.lines})).collect();
    let generations: Vec<Value> =
        kept.iter().map(|&at| generation(at, &trace.generations[at])).collect();
    let (families, family_of, winner) = families(&trace.generations, kept);
    json!({
        "model": subject.model,
        "parameters": subject.parameters,
        "units": subject.units,
        "x_name": subject.x_name,
        "y_name": subject.y_name,
        "x": rounded(&trace.measured.0),
        "y": rounded(&trace.measured.1),
        "minima": rounded(&minima),
        "maxima": rounded(&maxima),
        "scripts": scripts,
        "generations": generations,
        "of": trace.generations.len(),
        "kept": {
            "first": chosen.first,
            "improvements": chosen.improvements,
            "of": chosen.all_improvements,
        },
        "curve": curve(&trace.generations),
        "families": families,
        "family_of": family_of,
        "winner": winner,
        "steps": steps,
        "result": result,
    })
}

/// The families of the best of the generations that are shown and of the best of all, each once;
/// which of them belongs to which generation; which belongs to the best of all.
fn families(generations: &[Generation], kept: &[usize]) -> (Vec<Value>, Vec<Value>, Value) {
    let mut found: Vec<Vec<Member>> = Vec::new();
    let mut place = |generation: usize, number: usize| {
        let family = family(generations, generation, number);
        let known = found.iter().rposition(|known| known[0] == family[0]);
        known.unwrap_or_else(|| {
            found.push(family);
            found.len() - 1
        })
    };
    let best = |generation: usize| generations[generation].best();
    let of = kept.iter().map(|&g| json!(best(g).map(|(number, _)| place(g, number)))).collect();
    let all = (0..generations.len()).filter_map(|g| best(g).map(|(number, f)| (g, number, f)));
    let winner = all.min_by(|a, b| a.2.total_cmp(&b.2)).map(|(g, number, _)| place(g, number));
    let members = |family: &Vec<Member>| {
        family.iter().map(|member| relative(member, &generations[member.generation])).collect()
    };
    (found.iter().map(members).collect(), of, json!(winner))
}

fn relative(member: &Member, generation: &Generation) -> Value {
    json!({
        "g": member.generation,
        "k": member.number,
        "depth": member.depth,
        "from": member.parents,
        "genes": rounded(generation.genome(member.number)),
        "fitness": generation.fitness.get(member.number).copied().map(six_digits),
        "origin": generation.origins.get(member.number).map(origin),
    })
}

/// The steps of the kept generation `g`. Where the one after it is not on the page, how that came to
/// be is not shown.
fn steps(walk: &mut TraceCursor, kept: &[usize], g: usize) -> Vec<Value> {
    let number = kept[g];
    walk.go_to(number);
    let of = walk.trace().generations.len();
    let has_next = kept.get(g + 1) == Some(&(number + 1)) || number + 1 == of;
    let mut steps = Vec::new();
    while walk.number() == number {
        let is_shown = has_next || !matches!(walk.step(), Step::Complete(_) | Step::Renew);
        steps.extend(is_shown.then(|| step(walk, g)));
        if !walk.forward() {
            break;
        }
    }
    steps
}

fn step(walk: &TraceCursor, g: usize) -> Value {
    let step = walk.step();
    let place = walk.place();
    let of = match step {
        Step::Cross(k) | Step::Mutate(k) | Step::Complete(k) => Some(k),
        Step::Operate { row, .. } => Some(row),
        _ => None,
    };
    let mut shown = json!({
        "g": g,
        "title": title(walk),
        "of": of,
        "place": place.map(|place| (place.script, place.line)),
        "text": explain(walk),
        "question": quiz::question(walk).map(|question| json!(question)),
    });
    if let Step::Operate { row, .. } = step {
        shown["table"] = table(walk, row);
    }
    shown
}

/// What an operator was given and what it returned.
fn table(walk: &TraceCursor, row: usize) -> Value {
    let Some(operation) = walk.operation() else { return Value::Null };
    let table = operation_table::table(operation, row, &walk.trace().subject.parameters);
    let row = |row: &Row| {
        let cells = row.cells.iter().map(|&(value, mark)| (six_digits(value), mark));
        Row { cells: cells.collect(), ..row.clone() }
    };
    let rows: Vec<Row> = table.rows.iter().take(MOST_ROWS).map(row).collect();
    json!({
        "columns": table.columns,
        "rows": rows,
        "left": table.rows.len() - rows.len(),
        "legend": table.legend,
    })
}

fn generation(at: usize, generation: &Generation) -> Value {
    let origins: Vec<Value> = generation.origins.iter().map(origin).collect();
    let (sorted, crossed) = (generation.sorted.as_ref(), generation.crossed.as_ref());
    let mutated = generation.mutated.as_ref();
    // An operator alone has what it was given.
    let children = crossed.map(|c| &c.rows).or(mutated.map(|m| &m.before));
    let elites = sorted.map(|s| s.elites).or(crossed.map(|c| c.elites));
    json!({
        "number": at + 1,
        "n": generation.n_genes,
        "call": generation.is_call,
        "unit": unit(generation),
        "genes": rounded(&generation.genes),
        "fitness": rounded(&generation.fitness),
        "origins": origins,
        "failures": generation.failures,
        "order": generation.order(),
        "parents": sorted.map(|s| s.parents).or(crossed.map(|c| c.parents)),
        "elites": elites.or(mutated.map(|m| m.elites)),
        "best": rounded(&generation.best_simulated),
        "points": crossed.map(|c| &c.points),
        "children": children.map(|rows| rounded(rows)),
        "u": mutated.map(|m| rounded(&m.numbers)),
        "after": mutated.map(|m| rounded(&m.after)),
        "factor": mutated.map(|m| m.factor),
    })
}

fn origin(origin: &Origin) -> Value {
    match origin {
        Origin::Elite { from } => json!({"elite": from}),
        Origin::Child { parent, mate, mutated } => {
            json!({"of": [parent, mate], "mutated": mutated})
        }
        Origin::Random => json!({"random": true}),
        Origin::Script => json!({"script": true}),
    }
}

/// The search ranges of the first mutation that names some; else those in which the genes were drawn at
/// random; else what all individuals span.
fn ranges(generations: &[Generation]) -> (Vec<f64>, Vec<f64>) {
    if let Some(mutated) = generations.iter().find_map(|generation| generation.mutated.as_ref()) {
        return (mutated.minima.clone(), mutated.maxima.clone());
    }
    if let Some(Scaling { low, high }) = scaling(generations) {
        let ends = low.iter().zip(&high).map(|(low, high)| (low.min(*high), low.max(*high)));
        return ends.unzip();
    }
    let Some(first) = generations.first() else { return (Vec::new(), Vec::new()) };
    let n = first.n_genes;
    let rows = || {
        let alike = generations.iter().filter(move |generation| generation.n_genes == n);
        alike.flat_map(move |generation| generation.genes.chunks_exact(n.max(1)))
    };
    let extreme = |start: f64, extreme: fn(f64, f64) -> f64| -> Vec<f64> {
        let over = |j: usize| rows().map(|row| row[j]).fold(start, extreme);
        (0..n).map(over).collect()
    };
    (extreme(f64::INFINITY, f64::min), extreme(f64::NEG_INFINITY, f64::max))
}

/// Number and best fitness of generations, thinned out to [`CURVE_POINTS`].
pub(super) fn curve(generations: &[Generation]) -> Vec<Value> {
    let every = generations.len().div_ceil(CURVE_POINTS).max(1);
    let last = generations.len().saturating_sub(1);
    let point = |(k, generation): (usize, &Generation)| {
        let best = generation.best().map(|(_, fitness)| six_digits(fitness));
        (k % every == 0 || k == last).then(|| json!([k + 1, best]))
    };
    generations.iter().enumerate().filter_map(point).collect()
}

pub(super) fn rounded(values: &[f64]) -> Vec<f64> {
    values.iter().copied().map(six_digits).collect()
}

/// Six significant digits: what can be seen, at half the size.
fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
