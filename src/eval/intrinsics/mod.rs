//! Functions of MLS §3.7 and §10.3 that need nothing but the values of their arguments; one file
//! per family. The mathematical functions of scalars are those of
//! [`symbolic::function`](crate::symbolic::function).

mod arrays;
mod conversion;
mod linear_algebra;
mod mathematics;
mod reduction;

use super::Intrinsic;
use super::errors::{UNKNOWN_FUNCTION, WRONG_ARGUMENTS};
use super::special;
use crate::diag::Fault;
use crate::fault;
use crate::symbolic::function as mathematical;
use crate::value::Value;
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// A function of this folder.
pub(super) struct Entry {
    /// Its name.
    pub(super) name: &'static str,
    /// The fewest arguments it takes.
    least: usize,
    /// The most arguments it takes.
    most: usize,
    run: Run,
}

#[derive(Clone, Copy)]
enum Run {
    /// Of the arguments as they are.
    Values(Intrinsic),
    /// Of scalars; arrays are gone through element by element.
    Scalars(Intrinsic),
    /// A function of the mathematical table.
    Mathematical(mathematical::FunctionId),
}

impl Entry {
    const fn of_values(name: &'static str, least: usize, most: usize, run: Intrinsic) -> Entry {
        Entry { name, least, most, run: Run::Values(run) }
    }

    const fn of_scalars(name: &'static str, count: usize, run: Intrinsic) -> Entry {
        Entry { name, least: count, most: count, run: Run::Scalars(run) }
    }

    /// Checks the number of arguments and runs the function.
    pub(super) fn call(&self, arguments: &[Value]) -> Result<Value, Fault> {
        if !(self.least..=self.most).contains(&arguments.len()) {
            return Err(self.wrong_count(arguments.len()));
        }
        match self.run {
            Run::Values(run) => run(arguments),
            Run::Scalars(run) => mathematics::each(self.name, arguments, &run),
            Run::Mathematical(function) => mathematics::call(function, arguments),
        }
    }

    fn wrong_count(&self, given: usize) -> Fault {
        let wanted = match (self.least, self.most) {
            (1, 1) => "one argument".to_owned(),
            (least, most) if least == most => format!("{least} arguments"),
            (least, usize::MAX) => format!("at least {least} arguments"),
            (least, most) => format!("{least} to {most} arguments"),
        };
        fault!(WRONG_ARGUMENTS, "`{}` takes {wanted}, not {given}", self.name)
    }
}

const FAMILIES: &[&[Entry]] = &[
    arrays::FUNCTIONS,
    conversion::FUNCTIONS,
    linear_algebra::FUNCTIONS,
    mathematics::FUNCTIONS,
    reduction::FUNCTIONS,
];

static MATHEMATICAL: LazyLock<Vec<Entry>> = LazyLock::new(|| {
    mathematical::functions()
        .flat_map(|(id, function)| {
            let names = std::iter::once(&function.name).chain(function.aliases);
            let arity = function.arity();
            names.map(move |name| Entry {
                name,
                least: arity,
                most: arity,
                run: Run::Mathematical(id),
            })
        })
        .collect()
});

/// Own entries win over the mathematical table: `max` takes arrays too.
static BY_NAME: LazyLock<FxHashMap<&'static str, &'static Entry>> = LazyLock::new(|| {
    let own = FAMILIES.iter().flat_map(|family| family.iter());
    MATHEMATICAL.iter().chain(own).map(|entry| (entry.name, entry)).collect()
});

/// The function of this name.
pub(super) fn find(name: &str) -> Option<&'static Entry> {
    BY_NAME.get(name).copied()
}

/// Whether the language has a function or an operator of this name.
pub fn is_builtin(name: &str) -> bool {
    find(name).is_some() || special::find(name).is_some()
}

/// Calls the function of this name, which takes positional arguments only.
pub fn call_intrinsic(name: &str, arguments: &[Value]) -> Result<Value, Fault> {
    match find(name) {
        Some(entry) => entry.call(arguments),
        None => Err(fault!(UNKNOWN_FUNCTION, "there is no function `{name}`")),
    }
}

/// Names of all functions and operators that evaluation knows by itself, in a fixed order.
pub fn intrinsic_names() -> impl Iterator<Item = &'static str> {
    let own = FAMILIES.iter().flat_map(|family| family.iter());
    let scalar = MATHEMATICAL.iter().filter(|entry| {
        !FAMILIES.iter().flat_map(|family| family.iter()).any(|own| own.name == entry.name)
    });
    own.chain(scalar).map(|entry| entry.name).chain(special::NAMES.iter().copied())
}
