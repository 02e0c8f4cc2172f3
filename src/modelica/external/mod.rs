//! Functions that Modelica libraries declare `external`, in Rust, under their external names (MLS
//! §12.9): the same for the interpreter and for compiled functions.
//!
//! ```text
//! external "C" y = ModelicaStandardTables_CombiTable1D_getValue(tableID, icol, u);
//!              │                │                                       │
//!        Call::result       find(name)                           Call::arguments
//! ```
//!
//! Numbers are `f64` (Integers exact up to 2⁵³, Booleans 0 and 1), arrays row-major whatever the
//! language of the call says. External objects (MLS §12.9.7) are values of this module, named by
//! handles; they do not change once they are made. The one hidden state is that of [`Random`].
//! Callers refuse an external name that is not here.
//!
//! LAPACK's routines use the LU, the triangular solutions, the balancing and the Schur iteration of
//! nalgebra, which is built without SIMD kernels and threads, with elementary functions in Rust: the
//! same bits on every machine. faer is not used: it chooses its kernels by the features of the
//! processor while the program runs. What nalgebra does not have, or has less accurately, is
//! written here; each module says why. `tests/suite/language/lapack_accuracy.rs` compares all with
//! LAPACK.

#[cfg(test)]
mod any_arguments;
mod at_translation;
mod balancing;
mod buildings;
pub mod c;
mod call;
mod eigenvalues;
mod eigenvectors;
pub mod errors;
mod fourier;
mod generalized;
mod householder;
mod journal;
mod least_squares;
mod linear_systems;
mod matrices;
mod messages;
mod objects;
mod parts;
mod quasi_triangular;
mod random;
mod resources;
mod schur;
mod strings;
mod sylvester;
mod tables;
mod xorshift;

pub(crate) use at_translation::AtTranslation;
pub use call::{Call, Object, Outside, Slot, SlotKind};
pub(crate) use call::{Callable, MAX_INTEGER};
pub use journal::Journal;
pub use messages::date_and_time;
pub use objects::Objects;
pub(crate) use parts::{COMPOSE, FAIL, PRINT};
pub use resources::{Contents, Provide, Resources};
pub(crate) use tables::names_a_file;
pub use xorshift::Random;

use crate::diag::Fault;
use errors::EXTERNAL_CALL;
use std::sync::{Mutex, PoisonError};

/// What an external function is implemented by.
pub(crate) type Native = fn(&mut Call<'_>) -> Result<(), Fault>;

/// A function that is external in Modelica.
pub struct Entry {
    /// Its external name.
    pub name: &'static str,
    /// One letter an argument: `n` number, `a` array of numbers, `t` string, `f` string that names
    /// a file to be read, `g` one that may name one, `s` array of strings, `o` object; capital
    /// letters for those that are written to. a `*` after them stands for any number of parts of a
    /// string. `->` and a letter if it has a result.
    pub signature: &'static str,
    /// What it does besides giving results.
    pub effect: Effect,
    /// Whether its results change in steps only, so that derivatives are zero.
    pub in_steps: bool,
    /// Whether its result is 1 after every call that does not fail, and only confirms that it was
    /// executed.
    pub(crate) confirms: bool,
    /// A file that the declaration must include for this function to be meant, where its name alone
    /// could be anybody's; empty otherwise.
    pub(crate) stands_for: &'static str,
    /// What it does.
    pub run: Native,
    /// The function in C that is called instead.
    pub c: Option<&'static c::CFunction>,
}

/// A function of the tables in a file: its name, and the file that must be included for it. One in
/// C cannot be written.
pub(crate) mod by_name {
    use super::{Entry, FAMILIES};
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de, ser};

    pub(crate) fn serialize<S: Serializer>(
        entry: &&'static Entry,
        target: S,
    ) -> Result<S::Ok, S::Error> {
        if entry.c.is_some() {
            return Err(ser::Error::custom("a function in C"));
        }
        (entry.name, entry.stands_for).serialize(target)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        source: D,
    ) -> Result<&'static Entry, D::Error> {
        let (name, stands_for) = <(String, String)>::deserialize(source)?;
        let own = [&super::COMPOSE, &super::FAIL, &super::PRINT];
        let mut entries = FAMILIES.iter().copied().flatten().chain(own);
        entries
            .find(|entry| entry.name == name && entry.stands_for == stands_for)
            .ok_or_else(|| de::Error::custom("there is no such function"))
    }
}

/// A function in Modelica has no name by which it could be found again: it cannot be written.
pub(crate) mod none {
    use super::Callable;
    use serde::{Deserializer, Serializer, ser};
    use std::sync::Arc;

    pub(crate) fn serialize<S: Serializer>(
        function: &Option<Arc<dyn Callable>>,
        target: S,
    ) -> Result<S::Ok, S::Error> {
        match function {
            None => target.serialize_unit(),
            Some(_) => Err(ser::Error::custom("a function in Modelica")),
        }
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        source: D,
    ) -> Result<Option<Arc<dyn Callable>>, D::Error> {
        serde::Deserialize::deserialize(source).map(|()| None)
    }
}

/// What calls of a function do besides giving results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Nothing: equal arguments give equal results; files count as unchanged.
    None,
    /// They read or change the [hidden state](Random) of the simulation.
    State,
    /// They change the outside world: in a simulation, what they do is [written down](Journal).
    Writes,
    /// They learn from the outside world what changes by itself.
    Outside,
}

impl Entry {
    /// A function in Modelica that is called as external ones are.
    pub(crate) fn in_modelica(
        name: &'static str,
        signature: &'static str,
        effect: Effect,
    ) -> &'static Entry {
        static KNOWN: Mutex<Vec<&'static Entry>> = Mutex::new(Vec::new());
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        let is_it = |entry: &&&Entry| {
            entry.name == name && entry.signature == signature && entry.effect == effect
        };
        match known.iter().find(is_it) {
            Some(entry) => entry,
            None => {
                let entry = Entry { effect, ..Entry::pure(name, signature, in_modelica) };
                known.push(Box::leak(Box::new(entry)));
                known[known.len() - 1]
            }
        }
    }

    /// A function without effects.
    const fn pure(name: &'static str, signature: &'static str, run: Native) -> Entry {
        let effect = Effect::None;
        Entry {
            name,
            signature,
            effect,
            in_steps: false,
            confirms: false,
            stands_for: "",
            run,
            c: None,
        }
    }

    /// A function without effects whose results change in steps only.
    const fn stepwise(name: &'static str, signature: &'static str, run: Native) -> Entry {
        Entry { in_steps: true, ..Entry::pure(name, signature, run) }
    }

    /// A function with a hidden state.
    const fn stateful(name: &'static str, signature: &'static str, run: Native) -> Entry {
        Entry { effect: Effect::State, ..Entry::pure(name, signature, run) }
    }

    /// A function that writes.
    pub(crate) const fn writing(name: &'static str, signature: &'static str, run: Native) -> Entry {
        Entry { effect: Effect::Writes, ..Entry::pure(name, signature, run) }
    }

    /// A function that writes, and whose result says that it has.
    const fn confirming(name: &'static str, signature: &'static str, run: Native) -> Entry {
        Entry { confirms: true, ..Entry::writing(name, signature, run) }
    }

    /// The same for declarations that include a certain file.
    const fn for_source(self, stands_for: &'static str) -> Entry {
        Entry { stands_for, ..self }
    }

    /// Calls it.
    ///
    /// # Errors
    /// What the function says.
    pub fn call(&self, call: &mut Call<'_>) -> Result<(), Fault> {
        match self.c {
            Some(function) => function.call(call),
            None => (self.run)(call),
        }
    }

    /// A function that learns from outside.
    const fn impure(name: &'static str, signature: &'static str, run: Native) -> Entry {
        Entry { effect: Effect::Outside, ..Entry::pure(name, signature, run) }
    }

    /// Whether the result is a new object.
    pub(crate) fn makes_object(&self) -> bool {
        self.signature.ends_with("->o")
    }

    /// The arguments that name files to be read.
    pub fn files(&self) -> impl Iterator<Item = usize> {
        self.places_of('f')
    }

    /// The arguments that may name files to be read.
    pub(crate) fn possible_files(&self) -> impl Iterator<Item = usize> {
        self.places_of('g')
    }

    fn places_of(&self, expected: char) -> impl Iterator<Item = usize> {
        let letters = self.signature.char_indices();
        letters.filter(move |(_, letter)| *letter == expected).map(|(at, _)| at)
    }

    /// Whether it has so many arguments, and a result or none.
    pub fn takes(&self, arguments: usize, has_result: bool) -> bool {
        let (expected, result) = match self.signature.split_once("->") {
            Some((expected, result)) => (expected, !result.is_empty()),
            None => (self.signature, false),
        };
        expected.len() == arguments && result == has_result
    }

    /// Whether the arguments and the result are of the kinds that the function expects.
    pub fn check(&self, arguments: &[Slot], result: Option<&Slot>) -> Result<(), Fault> {
        let (expected, expected_result) = match self.signature.split_once("->") {
            Some((expected, result)) => (expected, result.chars().next()),
            None => (self.signature, None),
        };
        let (expected, arguments, parts) = match expected.strip_suffix(parts::PARTS) {
            Some(expected) if expected.len() <= arguments.len() => {
                let (arguments, parts) = arguments.split_at(expected.len());
                (expected, arguments, parts)
            }
            _ => (expected, arguments, &[][..]),
        };
        if expected.len() != arguments.len() || expected_result.is_some() != result.is_some() {
            return Err(crate::fault!(
                EXTERNAL_CALL,
                "the external function `{}` is called with {} arguments{}, not with {}{}",
                self.name,
                arguments.len(),
                with_result(result.is_some()),
                expected.len(),
                with_result(expected_result.is_some())
            ));
        }
        let wrong = expected.chars().zip(arguments).position(|(letter, slot)| !slot.fits(letter));
        let wrong = wrong.or_else(|| (!parts::are_parts(parts)).then_some(expected.len()));
        if let Some(position) = wrong {
            return Err(crate::fault!(
                EXTERNAL_CALL,
                "argument {} of the external function `{}` has a different type",
                position + 1,
                self.name
            ));
        }
        match (expected_result, result) {
            (Some(letter), Some(slot)) if !slot.fits(letter) => Err(crate::fault!(
                EXTERNAL_CALL,
                "the result of the external function `{}` has a different type",
                self.name
            )),
            _ => Ok(()),
        }
    }
}

/// What stands for a function in Modelica that is not there.
fn in_modelica(call: &mut Call<'_>) -> Result<(), Fault> {
    Err(call.fault("it is written in Modelica"))
}

fn with_result(is_there: bool) -> &'static str {
    if is_there { " and a result" } else { "" }
}

const FAMILIES: &[&[Entry]] = &[
    tables::ENTRIES,
    strings::ENTRIES,
    random::ENTRIES,
    linear_systems::ENTRIES,
    least_squares::ENTRIES,
    eigenvalues::ENTRIES,
    generalized::ENTRIES,
    householder::ENTRIES,
    fourier::ENTRIES,
    messages::ENTRIES,
    buildings::ENTRIES,
];

/// The function of this external name, declared with an annotation `Include`; `None` where that text
/// defines another function of the name.
///
/// ```
/// use gapilib_modelica::external::find_declared;
///
/// let is_ours = |include| find_declared("getTimeSpan", include).is_some();
/// assert!(is_ours("#include \"getTimeSpan.c\""));
/// assert!(!is_ours("static void getTimeSpan (const char *name) {}"));
/// ```
pub fn find_declared(name: &str, include: &str) -> Option<&'static Entry> {
    find(name).filter(|entry| include.contains(entry.stands_for) && !defines(include, name))
}

/// Whether C code has a function of this name, rather than the name of a file that has it.
fn defines(code: &str, name: &str) -> bool {
    code.match_indices(name).any(|(at, _)| {
        let begins = !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        begins && code[at + name.len()..].trim_start().starts_with('(')
    })
}

/// The function of this external name.
///
/// ```
/// let entry = gapilib_modelica::external::find("ModelicaStrings_length").expect("it is there");
/// assert_eq!(entry.signature, "t->n");
/// assert!(gapilib_modelica::external::find("my_own_c_function").is_none());
/// ```
pub fn find(name: &str) -> Option<&'static Entry> {
    FAMILIES.iter().flat_map(|family| family.iter()).find(|entry| entry.name == name)
}

/// All external names.
pub fn names() -> impl Iterator<Item = &'static str> {
    FAMILIES.iter().flat_map(|family| family.iter()).map(|entry| entry.name)
}
