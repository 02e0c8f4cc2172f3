//! The fuzz targets with fixed seeds: a corpus of small inputs, and mutations of it that are the same
//! at every run. `GAPILIB_CASES` says how many mutations each target gets for each of its inputs.

use crate::support::shipped::project;
use gapilib::internals::identify::problem::{Origins, Record, encode, header};
use std::fs;
use std::panic::catch_unwind;

#[path = "../../fuzz/targets.rs"]
mod targets;

/// What stands in inputs of all kinds.
const WORDS: &[&str] = &[
    "model",
    "end",
    "equation",
    "algorithm",
    "extends",
    "replaceable",
    "redeclare",
    "function",
    "record",
    "package",
    "connect",
    "der",
    "when",
    "then",
    "if",
    "for",
    "loop",
    "while",
    "in",
    "each",
    "final",
    "inner",
    "outer",
    "input",
    "output",
    "parameter",
    "constant",
    "Real",
    "Integer",
    "Boolean",
    "String",
    "time",
    "initial",
    "sample",
    "pre",
    "size",
    "fill",
    "sum",
    "0",
    "1",
    "-1",
    "1e308",
    "2147483648",
    "9223372036854775807",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ";",
    ":",
    "=",
    ":=",
    "==",
    "<",
    "+",
    "*",
    "/",
    "^",
    ".",
    "\"",
    "'",
    "\n",
    "\0",
    "µ",
    "NaN",
    "annotation",
];

/// Numbers that look random and are the same at every run (xorshift, Marsaglia 2003).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end.max(1) as u64) as usize
    }
}

/// An input with some changes.
fn mutated(input: &[u8], others: &[Vec<u8>], numbers: &mut Numbers) -> Vec<u8> {
    let mut bytes = input.to_vec();
    for _ in 0..=numbers.below(4) {
        let (from, length) = (numbers.below(bytes.len()), 1 + numbers.below(24));
        let to = (from + length).min(bytes.len());
        match numbers.below(7) {
            0 => drop(bytes.drain(from..to)),
            1 => {
                let copy = bytes[from..to].to_vec();
                let at = numbers.below(bytes.len());
                bytes.splice(at..at, copy);
            }
            2 if from < bytes.len() => bytes[from] ^= 1 << numbers.below(8),
            3 if from < bytes.len() => bytes[from] = [0, 1, 0x7f, 0x80, 0xff][numbers.below(5)],
            4 => {
                let other = &others[numbers.below(others.len())];
                let start = numbers.below(other.len());
                let end = (start + 4 * length).min(other.len());
                bytes.splice(from..to, other[start..end].iter().copied());
            }
            5 => bytes.truncate(to),
            _ => {
                let word = WORDS[numbers.below(WORDS.len())].as_bytes();
                bytes.splice(from..to.min(from + 6), word.iter().copied());
            }
        }
    }
    bytes
}

/// The files of a folder of the project, those of these endings.
fn files(folder: &str, endings: &[&str]) -> Vec<Vec<u8>> {
    let mut paths: Vec<_> = fs::read_dir(project(folder))
        .unwrap_or_else(|error| panic!("{folder}: {error}"))
        .map(|entry| entry.unwrap().path())
        .filter(|path| endings.iter().any(|end| path.to_string_lossy().ends_with(end)))
        .collect();
    paths.sort();
    let small = paths.into_iter().map(|path| fs::read(path).unwrap());
    let inputs: Vec<_> = small.filter(|bytes| bytes.len() < 20_000).collect();
    assert!(!inputs.is_empty(), "{folder} holds no inputs");
    inputs
}

/// Tries a target with all inputs and with `each` mutations of each.
fn fuzz(target: fn(&[u8]), inputs: &[Vec<u8>], each: usize) {
    let factor = std::env::var("GAPILIB_CASES").ok().and_then(|n| n.parse::<usize>().ok());
    let each = factor.unwrap_or(each);
    for (at, input) in inputs.iter().enumerate() {
        let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15 ^ at as u64);
        try_one(target, input);
        for _ in 0..each {
            try_one(target, &mutated(input, inputs, &mut numbers));
        }
    }
}

fn try_one(target: fn(&[u8]), input: &[u8]) {
    // A thread of its own stack, as the program has.
    if let Some(file) = std::env::var_os("GAPILIB_FUZZ_LAST") {
        fs::write(file, input).unwrap();
    }
    if catch_unwind(|| target(input)).is_err() {
        panic!("this input panics:\n{}", String::from_utf8_lossy(input));
    }
}

/// Runs with as much stack as the program's own thread has.
fn deep(work: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(256 << 20);
    let ended = thread.spawn(|| gapilib::with_stack(128 << 20, work)).unwrap().join();
    if let Err(panic) = ended {
        std::panic::resume_unwind(panic);
    }
}

#[test]
fn parsers() {
    deep(|| {
        let mut inputs = files("tests/fuzz/seeds/models", &[".mo"]);
        inputs.extend(files("tests/grammar/valid", &[".mo", ".mos"]));
        fuzz(targets::parse_model, &inputs, 30);
        fuzz(targets::run_parser_of_scripts, &inputs, 30);
        fuzz(targets::print_and_parse, &inputs, 20);
    });
}

#[test]
fn flattening() {
    deep(|| fuzz(targets::flatten_model, &files("tests/fuzz/seeds/models", &[".mo"]), 40));
}

#[test]
fn simulations() {
    deep(|| fuzz(targets::simulate_model, &files("tests/fuzz/seeds/models", &[".mo"]), 12));
}

#[test]
fn scripts() {
    deep(|| fuzz(targets::run_script, &files("tests/fuzz/seeds/scripts", &[".mos"]), 40));
}

#[test]
fn data_files() {
    deep(|| {
        let tables = files("tests/fuzz/seeds/csv", &[".csv", ".txt"]);
        fuzz(targets::read_csv, &tables, 150);
        let matrices = files("tests/data/mat", &[".mat"]);
        fuzz(targets::read_mat, &matrices, 40);
        fuzz(targets::read_results, &matrices, 20);
        fuzz(targets::read_spreadsheet, &files("tests/data/spreadsheet", &[".xlsx"]), 60);
    });
}

#[test]
fn problem_files() {
    deep(|| fuzz(targets::solve_problem, &files("tests/fuzz/seeds/problems", &[".toml"]), 25));
}

#[test]
fn journals() {
    let mut journal = header(&Origins::default());
    for asked in 0..3 {
        let mut record = Record { seconds: 0.5, asked, ..Record::default() };
        record.changes.push(("population".to_owned(), 20.0));
        record.answered.objectives = vec![1.0, 2.0, f64::NAN];
        journal.extend(encode(&record));
    }
    fuzz(targets::read_journal, &[journal], 2000);
}

#[test]
fn editors() {
    deep(|| fuzz(targets::serve_editor, &files("tests/fuzz/seeds/models", &[".mo"]), 6));
}

/// Trees and scripts are chosen by bytes that look random.
#[test]
#[cfg(unix)]
fn strangers() {
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
    let mut input = || (0..120).map(|_| numbers.below(256) as u8).collect::<Vec<u8>>();
    let inputs: Vec<_> = (0..30).map(|_| input()).collect();
    deep(move || fuzz(targets::visit_stranger, &inputs, 2));
}

/// Their code is right here: what is wrong in them must be found when they are read.
#[test]
fn cache_entries() {
    deep(|| {
        let entry = targets::cache_entry();
        assert!(targets::is_taken(&entry), "an entry that is whole is translated again");
        fuzz(targets::read_cache_entry, &[entry], 100);
    });
}
