//! What a report says of parameters, where a careless tool claims too much: each problem of
//! `tests/claims` has its files and what is true, which `make.py` beside them has computed without the
//! program. `gapi identify` has to say it.

use crate::support::guide::blocks;
use crate::support::program::{folder, gapi};
use crate::support::shipped::files;
use regex::Regex;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// What is true of a problem, and what must not be said.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Claims {
    /// Whether the problem has to be refused.
    #[serde(default)]
    fails: bool,
    /// Patterns that the output contains.
    #[serde(default)]
    says: Vec<String>,
    /// Patterns that it does not contain.
    #[serde(default)]
    never: Vec<String>,
    #[serde(default)]
    reads: Vec<Reading>,
    #[serde(default)]
    parameters: BTreeMap<String, Parameter>,
}

/// A number in the output: the group of the pattern.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Reading {
    pattern: String,
    is: f64,
    within: f64,
}

/// What is true of a parameter. Pairs are a value and its tolerance.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameter {
    /// Verdicts of `result.json`, of which each is true; all are if the list is empty.
    verdict: Vec<String>,
    value: Option<[f64; 2]>,
    least: Option<End>,
    most: Option<End>,
    /// Whether there is an interval.
    interval: Option<bool>,
    /// The separate parts of the interval, whose ends lie `within` this.
    parts: Option<Vec<[f64; 2]>>,
    within: Option<f64>,
}

/// An end of an interval.
#[derive(Deserialize)]
#[serde(untagged)]
enum End {
    At([f64; 2]),
    /// The data do not bound it: `"open"`.
    Open(String),
}

/// Adds what is wrong to a list.
macro_rules! check {
    ($wrong:expr, $holds:expr, $($said:tt)+) => {
        if !$holds {
            $wrong.push(format!($($said)+));
        }
    };
}

fn found(pattern: &str, text: &str) -> bool {
    Regex::new(pattern).expect("a pattern").is_match(text)
}

/// What is wrong with the output.
fn wrong_sentences(claims: &Claims, said: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    for pattern in &claims.says {
        check!(wrong, found(pattern, said), "does not say `{pattern}`");
    }
    for pattern in &claims.never {
        check!(wrong, !found(pattern, said), "says `{pattern}`");
    }
    for Reading { pattern, is, within } in &claims.reads {
        let group = Regex::new(pattern).expect("a pattern").captures(said);
        let number = group.and_then(|group| group[1].parse::<f64>().ok());
        let holds = number.is_some_and(|number| (number - is).abs() <= *within);
        check!(wrong, holds, "`{pattern}` reads {number:?}, right: {is} ± {within}");
    }
    wrong
}

fn pair(value: &Value) -> Option<[f64; 2]> {
    serde_json::from_value(value.clone()).ok()
}

/// What is wrong with a parameter of `result.json`.
fn wrong_parameter(name: &str, claim: &Parameter, own: &Value) -> Vec<String> {
    let mut wrong = Vec::new();
    let verdict = own["verdict"].as_str().unwrap_or("none");
    let is_right = claim.verdict.is_empty() || claim.verdict.iter().any(|right| right == verdict);
    check!(wrong, is_right, "{name}: {verdict}, right: {:?}", claim.verdict);
    let value = own["value"].as_f64().expect("a value");
    if let Some([right, within]) = claim.value {
        let is_near = (value - right).abs() <= within;
        check!(wrong, is_near, "{name} = {value}, right: {right}");
    }
    let interval = pair(&own["interval"]);
    if let Some(expected) = claim.interval {
        check!(wrong, interval.is_some() == expected, "{name} in {interval:?}");
    }
    let open = own["open"].as_str().expect("sides");
    for (side, (end, names)) in
        [(&claim.least, ["below", "both"]), (&claim.most, ["above", "both"])].iter().enumerate()
    {
        let is_open = interval.is_some() && names.contains(&open);
        let holds = match (end, interval) {
            (None, _) => true,
            (Some(End::Open(word)), _) => word == "open" && is_open,
            (Some(End::At([right, within])), Some(ends)) => {
                !is_open && (ends[side] - right).abs() <= *within
            }
            (Some(End::At(_)), None) => false,
        };
        let side = ["least", "most"][side];
        check!(wrong, holds, "{name} at {side}: {interval:?}, open: {open}");
    }
    if let Some(parts) = &claim.parts {
        let pieces = own["pieces"].as_array().cloned().unwrap_or_default();
        let pieces: Vec<[f64; 2]> = pieces.iter().filter_map(pair).collect();
        let within = claim.within.expect("a tolerance of the parts");
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= within;
        let holds = pieces.len() == parts.len()
            && pieces.as_flattened().iter().zip(parts.as_flattened()).all(is_near);
        check!(wrong, holds, "{name} in {pieces:?}, right: {parts:?}");
    }
    wrong
}

/// What is wrong with the report on a problem.
fn wrong_claims(file: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(file).expect("a readable file");
    let here = folder(&[]);
    let mut claims: Option<Claims> = None;
    for (kind, block) in blocks(&text) {
        match kind.split_once(",file=") {
            Some((_, name)) => std::fs::write(here.path().join(name), block).expect("written"),
            None => claims = Some(toml::from_str(&block).expect("claims")),
        }
    }
    let claims = claims.expect("a block of claims");
    let (code, out, errors) = gapi(&here, &["identify", "p.toml", "--out", "out"]);
    let said = out + &errors;
    let mut wrong = wrong_sentences(&claims, &said);
    check!(wrong, claims.fails == (code != 0), "exit code {code}\n{said}");
    if let Ok(result) = std::fs::read_to_string(here.path().join("out/result.json")) {
        let result: Value = serde_json::from_str(&result).expect("JSON");
        let parameters = result["parameters"].as_array().expect("parameters");
        for (name, claim) in &claims.parameters {
            let own = parameters.iter().find(|own| own["name"] == name.as_str());
            wrong.extend(wrong_parameter(name, claim, own.expect("the parameter")));
        }
    }
    wrong
}

#[test]
fn reports_claim_what_is_true() {
    let problems: Vec<_> = files("tests/claims", "md");
    let problems: Vec<_> = problems.iter().filter(|file| !file.ends_with("README.md")).collect();
    assert!(problems.len() >= 40, "{}", problems.len());
    let mut report = String::new();
    for file in problems {
        for wrong in wrong_claims(file) {
            report += &format!("{}: {wrong}\n", file.display());
        }
    }
    assert!(report.is_empty(), "{report}");
}
