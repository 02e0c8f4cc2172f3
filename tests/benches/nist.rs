//! The 27 problems of NIST StRD: the default search, and least squares alone from both starts of
//! NIST. `cargo bench --bench nist`; behind `--` the name of a method (`genetic`, `multistart`, `lm`),
//! a number of seeds, or a part of the names of the problems.

#![allow(clippy::disallowed_methods, reason = "figures need not have every digit")]
#![allow(clippy::print_stdout, reason = "it prints a table")]

#[path = "../nist/mod.rs"]
mod nist;

use gapilib::internals::identify::problem::EndingKind;
use nist::{Dataset, MODELS};

/// Simulations that the default search may take.
const BUDGET: u64 = 20_000;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let is = |word: &&str| words.iter().any(|own| own == *word);
    let methods: Vec<&str> = ["genetic", "multistart", "lm"].into_iter().filter(is).collect();
    let methods = if methods.is_empty() { vec!["genetic", "lm"] } else { methods };
    let seeds = words.iter().find_map(|word| word.parse().ok()).unwrap_or(1);
    let names: Vec<&String> = words
        .iter()
        .filter(|w| w.parse::<u32>().is_err() && !methods.contains(&w.as_str()))
        .collect();
    for method in methods {
        let cases: Vec<(Option<usize>, u32)> = match method {
            "lm" => vec![(Some(1), 0), (Some(0), 0)],
            _ => (0..seeds).map(|seed| (None, seed)).collect(),
        };
        for (start, seed) in cases {
            println!("\n{method} start {:?} seed {seed}", start.map(|start| start + 1));
            let (mut count, mut reached, mut wrong) = (0, 0, 0);
            for (name, _) in MODELS {
                if names.is_empty() || names.iter().any(|part| name.contains(part.as_str())) {
                    let [is_reached, is_wrong] = one(name, method, start, seed);
                    count += 1;
                    reached += usize::from(is_reached);
                    wrong += usize::from(is_wrong);
                }
            }
            println!("{reached} of {count} reached, {wrong} false minima");
        }
    }
}

/// Solves one and prints a row: whether the certified minimum was reached, and whether something else
/// was called a minimum without the certified one being known.
fn one(name: &str, method: &str, start: Option<usize>, seed: u32) -> [bool; 2] {
    let dataset = Dataset::read(name);
    let found = dataset.solve(method, start, seed, BUDGET);
    let digits = dataset.digits(&found);
    let reached = digits[0] > 4.0;
    let said = found.outcome.ending.kind == EndingKind::Minimum;
    println!(
        "{name:<10} {} digits {:5.1} {:5.1} sum {:.10e} ({:.4}) offset {:8.1e} {:>6} simulations {:?} {}",
        if reached { "reached" } else { "MISSED " },
        digits[0],
        digits[1],
        found.fitness,
        found.fitness / dataset.sum,
        found.outcome.ending.relative_offset.unwrap_or(f64::NAN),
        found.effort.simulations,
        found.outcome.ending.kind,
        found.outcome.ending.reached.map_or_else(String::new, |[n, of]| format!("{n} of {of}")),
    );
    [reached, said && !reached]
}
