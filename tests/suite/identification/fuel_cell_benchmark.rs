//! The table of the guide's chapter on the fuel-cell benchmark: what `gapi identify` says of the shipped
//! stacks, written between two comments of the chapter.

use crate::support::program::gapi;
use crate::support::shipped::project;
use regex::Regex;
use serde_json::Value;
use std::fs;

const CHAPTER: &str = "docs/src/fuel_cell_benchmark.md";
/// The comments around the table.
const MARKS: [&str; 2] = ["<!-- table: stacks -->\n", "<!-- end -->"];

/// Problems, their stacks, and the smallest sums of squares that are published for these ranges.
const STACKS: [(&str, &str, f64); 4] = [
    ("ballard_mark_v", "Ballard Mark V", 0.813_911_703),
    ("bcs_500w", "BCS 500 W", 0.011_697_780_7),
    ("sr12", "SR-12, lambda from 13", 1.056_628_35),
    ("nedstack_ps6", "NedStack PS6", 2.065_556_91),
];

/// What the report says of a parameter: the interval as far as the data end it.
fn limits(all: &[Value], name: &str) -> String {
    let own = all.iter().find(|own| own["name"] == name).expect("the parameter");
    let ends = own["interval"].as_array().map(|ends| [&ends[0], &ends[1]]);
    let number = |end: &Value| {
        let digits = format!("{:.2e}", end.as_f64().expect("a number"));
        let value: f64 = digits.parse().expect("a number");
        if value.abs() < 1e-2 { format!("{value:e}") } else { value.to_string() }
    };
    match (ends, own["open"].as_str()) {
        (None, _) => "-".to_owned(),
        (Some(_), Some("both")) => "any value".to_owned(),
        (Some([low, _]), Some("above")) => format!("at least {}", number(low)),
        (Some([_, high]), Some("below")) => format!("at most {}", number(high)),
        (Some([low, high]), _) => format!("{} .. {}", number(low), number(high)),
    }
}

/// How many combinations of the seven parameters the data determine: "Fix 2 of them" leaves five.
fn rank(said: &str, count: usize) -> usize {
    let fix =
        Regex::new(r"structurally non-identifiable[^\n]*Fix (\w+) of them").expect("a pattern");
    let excess = |found: regex::Captures<'_>| found[1].parse().unwrap_or(1);
    count - fix.captures(said).map_or(0, excess)
}

/// The row of a stack.
fn row(name: &str, stack: &str, published: f64) -> String {
    let here = tempfile::tempdir().expect("a folder");
    let problem = project(&format!("scripts/problems/{name}.toml")).display().to_string();
    let allowed = concat!("--allow-read=", env!("CARGO_MANIFEST_DIR"));
    let (code, said, errors) = gapi(&here, &["identify", &problem, "--out", "out", allowed]);
    assert_eq!(code, 0, "{said}{errors}");
    let result = fs::read_to_string(here.path().join("out/result.json")).expect("a result");
    let result: Value = serde_json::from_str(&result).expect("JSON");
    let sum = result["fitness"].as_f64().expect("a sum of squares");
    assert!((sum / published - 1.0).abs() < 1e-6, "{stack}: {sum}");
    let points = result["series"][0]["points"].as_array().expect("points").len();
    let all = result["parameters"].as_array().expect("parameters");
    let [xi4, lambda, contacts, mass] = ["xi4", "lambda", "Rc", "B"].map(|name| limits(all, name));
    let rank = rank(&said, all.len());
    format!(
        "| {stack} | {points} | {sum:.7} | {published} | {rank} | {xi4} | {lambda} | {contacts} | \
         {mass} |\n"
    )
}

#[test]
fn the_table_of_the_stacks_is_what_the_program_says() {
    let place = project(CHAPTER);
    let chapter = fs::read_to_string(&place).expect("the chapter");
    let (before, rest) = chapter.split_once(MARKS[0]).expect("the table begins");
    let (shown, after) = rest.split_once(MARKS[1]).expect("the table ends");
    let mut table = String::from(
        "| stack | points | sum reached, V² | published, V² | determined of 7 | xi4, V/K | lambda | \
         Rc, Ohm | B, V |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for (name, stack, published) in STACKS {
        table += &row(name, stack, published);
    }
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        let [begin, end] = MARKS;
        fs::write(&place, format!("{before}{begin}{table}{end}{after}")).expect("written");
        return;
    }
    assert!(shown == table, "{CHAPTER}: run this test with INSTA_UPDATE=always\n{table}");
}
