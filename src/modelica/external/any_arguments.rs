//! No arguments of the right kinds make a function panic, whatever their sizes and values: they may
//! come from any model, or from a file that was damaged.

use super::call::{Call, Object, Outside, Slot, SlotKind};
use super::{Entry, FAMILIES};
use crate::diag::Fault;
use crate::external::Random;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// Numbers that code takes for sizes, positions, columns, seeds.
const NUMBERS: &[f64] = &[
    0.0,
    1.0,
    2.0,
    3.0,
    -1.0,
    0.5,
    7.0,
    33.0,
    1e-300,
    1e300,
    -1e300,
    4_503_599_627_370_496.0,
    9_223_372_036_854_775_807.0,
    -9_223_372_036_854_775_808.0,
    f64::NAN,
    f64::INFINITY,
];
/// Letters for the jobs of LAPACK, names of files and tables, what is scanned.
const STRINGS: &[&str] = &[
    "",
    "N",
    "T",
    "U",
    "L",
    "R",
    "V",
    "B",
    "S",
    "E",
    "1",
    "I",
    "F",
    "A",
    "a",
    "NoName",
    "table",
    "f.csv",
    "f.txt",
    "f.mat",
    "µ",
    "aµ",
    "-3",
    "2.5e",
    "\"µ\\",
    "mon:1 2",
    ",",
    "\u{1f600}x",
];
/// Those that most functions take.
const USUAL: &[&str] = &["NoName", "N", "table"];
const FILE: &str = "#1\ndouble table(2,2)\n0 1\n1 2\n";

/// Answers with a small file, and takes all that is written.
#[derive(Default)]
struct Generous(Random);

impl Outside for Generous {
    fn read(&mut self, _: &str) -> Result<Vec<u8>, Fault> {
        Ok(FILE.into())
    }
    fn write(&mut self, _: &str, _: &[u8]) -> Result<(), Fault> {
        Ok(())
    }
    fn append(&mut self, _: &str, _: &[u8]) -> Result<(), Fault> {
        Ok(())
    }
    fn remove(&mut self, _: &str) -> Result<(), Fault> {
        Ok(())
    }
    fn make_folder(&mut self, _: &str) -> Result<(), Fault> {
        Ok(())
    }
    fn is_folder(&mut self, _: &str) -> Result<Option<bool>, Fault> {
        Ok(None)
    }
    fn full_path(&mut self, path: &str) -> Result<String, Fault> {
        Ok(path.to_owned())
    }
    fn unix_seconds(&mut self) -> Result<u64, Fault> {
        Ok(1_700_000_000)
    }
    fn environment_variable(&mut self, _: &str) -> Result<Option<String>, Fault> {
        Ok(None)
    }
    fn print(&mut self, _: &str) -> Result<(), Fault> {
        Ok(())
    }
    fn random(&mut self) -> Result<&mut Random, Fault> {
        Ok(&mut self.0)
    }
}

/// What functions are called with; choices are taken one after the other, again and again.
struct Arguments<'c> {
    /// Rows and columns of all arrays of this call, where they are to fit together.
    common: Option<u32>,
    choices: std::iter::Cycle<std::slice::Iter<'c, u8>>,
    slots: Vec<Slot>,
    numbers: Vec<f64>,
    strings: Vec<Arc<str>>,
    objects: Vec<Object>,
}

impl<'c> Arguments<'c> {
    fn new(choices: &'c [u8]) -> Arguments<'c> {
        let objects = vec![Arc::new(0_u8) as Object];
        let choices = choices.iter().cycle();
        Arguments {
            common: None,
            choices,
            slots: vec![],
            numbers: vec![],
            strings: vec![],
            objects,
        }
    }

    fn choice(&mut self, end: usize) -> usize {
        *self.choices.next().unwrap_or(&0) as usize % end
    }

    fn dims(&mut self) -> Box<[u32]> {
        if self.choice(32) == 0 {
            // Arrays without elements have any sizes.
            return [[0, u32::MAX], [u32::MAX, 0]][self.choice(2)].into();
        }
        if let Some(n) = self.common {
            let rank = 1 + self.choice(2);
            return vec![n; rank].into();
        }
        let rank = [1, 2, 2, 3][self.choice(4)];
        (0..rank).map(|_| [0, 1, 2, 2, 3, 3, 4, 33][self.choice(8)]).collect()
    }

    fn number(&mut self) -> f64 {
        match (self.choice(4), self.common) {
            // In the first array they increase: it may be a table.
            (_, Some(n)) if self.numbers.len() <= (n * n) as usize => self.numbers.len() as f64,
            (1.., Some(n)) => f64::from(1 + self.numbers.len() as u32 % n),
            (0, _) => NUMBERS[self.choice(NUMBERS.len())],
            _ => self.choice(9) as f64 - 2.0,
        }
    }

    fn slot(&mut self, letter: char) -> Slot {
        let dims = match letter {
            'a' | 'A' | 's' => self.dims(),
            _ => Box::default(),
        };
        let n: usize = dims.iter().map(|size| *size as usize).product();
        let kind = match letter {
            't' | 'T' | 'f' | 'g' | 's' => SlotKind::Text,
            'o' => SlotKind::Object,
            _ => SlotKind::Number,
        };
        let first =
            if kind == SlotKind::Text { self.strings.len() } else { self.numbers.len() } as u32;
        for _ in 0..n {
            match kind {
                SlotKind::Text => {
                    let strings = if self.common.is_some() { USUAL } else { STRINGS };
                    let text = strings[self.choice(strings.len())];
                    self.strings.push(text.into());
                }
                SlotKind::Object => {
                    let newest = self.objects.len() - 1;
                    let handle = [newest, self.choice(newest + 2)][self.choice(2)];
                    self.numbers.push(handle as f64);
                }
                _ => {
                    let number = self.number();
                    self.numbers.push(number);
                }
            }
        }
        Slot { kind, first, dims }
    }

    /// Calls a function; whether it did what it does.
    fn call(&mut self, entry: &'static Entry) -> bool {
        let (letters, result) = entry.signature.split_once("->").unwrap_or((entry.signature, ""));
        self.numbers.clear();
        self.strings.clear();
        self.common = [None, Some(2), Some(3), Some(33)][self.choice(4)];
        self.slots = letters.chars().map(|letter| self.slot(letter)).collect();
        let result = result.chars().next().map(|letter| self.slot(letter));
        assert!(entry.check(&self.slots, result.as_ref()).is_ok(), "{}", entry.name);
        let mut call = Call {
            name: entry.name,
            arguments: &self.slots,
            result: result.as_ref(),
            numbers: &mut self.numbers,
            strings: &self.strings,
            written: &mut Vec::new(),
            objects: &mut self.objects,
            outside: &mut Generous::default(),
        };
        entry.call(&mut call).is_ok()
    }
}

/// Calls of each function.
const CALLS: usize = 600;

#[test]
fn no_function_panics() {
    let choices = choices(100_003);
    let mut arguments = Arguments::new(&choices);
    let mut panics = Vec::new();
    for entry in FAMILIES.iter().copied().flatten() {
        for _ in 0..CALLS {
            let called = catch_unwind(AssertUnwindSafe(|| arguments.call(entry)));
            if called.is_err() {
                let (slots, strings) = (&arguments.slots, &arguments.strings);
                panics.push(format!("{}: {slots:?} {strings:?}", entry.name));
                break;
            }
        }
    }
    assert!(panics.is_empty(), "{}", panics.join("\n"));
}

/// Bytes that look random and are the same at every run.
fn choices(n: u32) -> Vec<u8> {
    (0..n).map(|k| (k.wrapping_mul(2_654_435_761) >> 13) as u8 ^ (k >> 7) as u8).collect()
}

/// Else nothing but refusals is tested above.
#[test]
fn many_functions_take_some_of_these_arguments() {
    let choices = choices(100_003);
    let mut arguments = Arguments::new(&choices);
    let all = FAMILIES.iter().copied().flatten();
    let (taken, never): (Vec<_>, Vec<_>) =
        all.partition(|entry| (0..CALLS).any(|_| arguments.call(entry)));
    let never: Vec<_> = never.iter().map(|entry| entry.name).collect();
    assert!(taken.len() > 3 * never.len(), "never: {never:?}");
}
