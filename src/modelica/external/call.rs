//! The arguments of one call.

use super::Entry;
use super::c::Request;
use super::errors::{EXTERNAL_FAILED, EXTERNAL_OUTSIDE};
use super::xorshift::Random;
use crate::diag::Fault;
use crate::fault;
use std::any::Any;
use std::sync::Arc;

/// Integers beyond this do not fit into numbers.
pub(crate) const MAX_INTEGER: i64 = 1 << 53;

/// An external object: it does not change once it is made.
pub type Object = Arc<dyn Any + Send + Sync>;

/// What a slot holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum SlotKind {
    /// Numbers at a position of [`Call::numbers`].
    Number,
    /// The string at a position of [`Call::strings`], or the strings from there on.
    Text,
    /// The text whose number stands at a position of [`Call::numbers`]; a function finds it as a
    /// [`SlotKind::Text`].
    Numbered,
    /// The object whose handle stands at a position of [`Call::numbers`].
    Object,
}

/// An argument or a result: where it stands.
#[derive(Debug, Clone, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Slot {
    /// What it holds.
    pub kind: SlotKind,
    /// Its position.
    pub first: u32,
    /// Its sizes; none for a scalar.
    pub dims: Box<[u32]>,
}

impl Slot {
    /// Whether it is what a letter of a signature stands for.
    pub(super) fn fits(&self, letter: char) -> bool {
        match letter {
            'n' | 'N' => self.kind == SlotKind::Number && self.dims.is_empty(),
            'a' | 'A' => self.kind == SlotKind::Number && !self.dims.is_empty(),
            't' | 'T' | 'g' => {
                matches!(self.kind, SlotKind::Text | SlotKind::Numbered) && self.dims.is_empty()
            }
            'f' => self.kind == SlotKind::Text && self.dims.is_empty(),
            's' => self.kind == SlotKind::Text && !self.dims.is_empty(),
            'o' => self.kind == SlotKind::Object,
            _ => false,
        }
    }

    /// Number of scalars.
    pub fn len(&self) -> usize {
        self.dims.iter().map(|n| *n as usize).product()
    }

    /// Whether there are no scalars.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Answers requests to the outside world; refuses all of them by default.
pub trait Outside {
    /// The content of a file.
    fn read(&mut self, path: &str) -> Result<Vec<u8>, Fault> {
        Err(refused(&format!("to read the file `{path}`")))
    }

    /// Rewrites a file.
    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<(), Fault> {
        let _ = bytes;
        Err(refused(&format!("to write the file `{path}`")))
    }

    /// Appends to a file.
    fn append(&mut self, path: &str, bytes: &[u8]) -> Result<(), Fault> {
        let _ = bytes;
        Err(refused(&format!("to write the file `{path}`")))
    }

    /// Removes a file.
    fn remove(&mut self, path: &str) -> Result<(), Fault> {
        Err(refused(&format!("to remove the file `{path}`")))
    }

    /// Takes a line for the user.
    fn print(&mut self, text: &str) -> Result<(), Fault> {
        let _ = text;
        Err(refused("to print"))
    }

    /// Takes a line that a function in C writes besides its results.
    fn log(&mut self, text: &str) -> Result<(), Fault> {
        self.print(text)
    }

    /// Makes a folder.
    fn make_folder(&mut self, path: &str) -> Result<(), Fault> {
        Err(refused(&format!("to make the folder `{path}`")))
    }

    /// Whether a path is a file (`Some(false)`) or a folder (`Some(true)`), if it exists.
    fn is_folder(&mut self, path: &str) -> Result<Option<bool>, Fault> {
        Err(refused(&format!("to check whether `{path}` exists")))
    }

    /// The absolute path of a file or folder, or of a `modelica://` URI.
    fn full_path(&mut self, path: &str) -> Result<String, Fault> {
        Err(refused(&format!("the absolute path of `{path}`")))
    }

    /// Seconds since 1970-01-01 00:00 UTC.
    fn unix_seconds(&mut self) -> Result<u64, Fault> {
        Err(refused("to read the clock"))
    }

    /// The content of an environment variable; `None` if it is not set.
    fn environment_variable(&mut self, name: &str) -> Result<Option<String>, Fault> {
        Err(refused(&format!("to read the environment variable `{name}`")))
    }

    /// A function in C that a library brings along, compiled and loaded.
    fn c_function(&mut self, request: &Request) -> Result<&'static Entry, Fault> {
        Err(refused(&format!("to compile the C function `{}`", request.requested().function)))
    }

    /// The hidden state of the random numbers.
    fn random(&mut self) -> Result<&mut Random, Fault> {
        Err(refused("to store a random number"))
    }
}

/// Refuses everything.
impl Outside for () {}

fn refused(what: &str) -> Fault {
    fault!(EXTERNAL_OUTSIDE, "an external function needs {what}, which is not allowed here")
}

/// A function that is called as external ones are, though it is written in Modelica.
pub(crate) trait Callable: Send + Sync {
    /// Carries out a call.
    ///
    /// # Errors
    /// What the function says.
    fn call(&self, call: &mut Call<'_>) -> Result<(), Fault>;
}

/// A call: positions of its arguments and what stands there.
pub struct Call<'a> {
    /// The external name.
    pub name: &'static str,
    /// The arguments in the order of the call.
    pub arguments: &'a [Slot],
    /// The result.
    pub result: Option<&'a Slot>,
    /// All numbers.
    pub numbers: &'a mut [f64],
    /// All strings; arguments are read here.
    pub strings: &'a [Arc<str>],
    /// Strings written, with their positions.
    pub written: &'a mut Vec<(u32, Arc<str>)>,
    /// All objects, by handle.
    pub objects: &'a mut Vec<Object>,
    /// Who answers requests to the outside world.
    pub outside: &'a mut dyn Outside,
}

/// Reads and writes arguments by their position in the call. [`Entry::check`](super::Entry::check)
/// has made sure that they are of the right kinds.
impl Call<'_> {
    /// A fault of this function.
    pub(super) fn fault(&self, reason: impl std::fmt::Display) -> Fault {
        fault!(EXTERNAL_FAILED, "`{}`: {reason}", self.name)
    }

    /// A number.
    pub(super) fn number(&self, argument: usize) -> f64 {
        self.numbers[self.arguments[argument].first as usize]
    }

    /// A whole number; beyond those that are exact, the last of them.
    pub(super) fn whole(&self, argument: usize) -> i64 {
        (self.number(argument) as i64).clamp(-MAX_INTEGER, MAX_INTEGER)
    }

    /// A truth value.
    pub(super) fn truth(&self, argument: usize) -> bool {
        self.number(argument) != 0.0
    }

    /// A text.
    pub(super) fn text(&self, argument: usize) -> &str {
        &self.strings[self.arguments[argument].first as usize]
    }

    /// The numbers of an array, row-major.
    pub(super) fn array(&self, argument: usize) -> &[f64] {
        let slot = &self.arguments[argument];
        &self.numbers[slot.first as usize..][..slot.len()]
    }

    /// The sizes of an array.
    pub(super) fn dims(&self, argument: usize) -> &[u32] {
        &self.arguments[argument].dims
    }

    /// The numbers of an array to be written.
    pub(super) fn array_mut(&mut self, argument: usize) -> &mut [f64] {
        let slot = &self.arguments[argument];
        &mut self.numbers[slot.first as usize..][..slot.len()]
    }

    /// An object of a certain type.
    pub(super) fn object<T: Any + Send + Sync>(&self, argument: usize) -> Result<&T, Fault> {
        let handle = self.number(argument);
        let object = match handle >= 0.0 && handle.fract() == 0.0 {
            true => self.objects.get(handle as usize),
            false => None,
        };
        object
            .and_then(|object| object.downcast_ref())
            .ok_or_else(|| self.fault("the object has the wrong type for this function"))
    }

    /// Writes a number.
    pub(super) fn set(&mut self, argument: usize, value: f64) {
        self.numbers[self.arguments[argument].first as usize] = value;
    }

    /// Writes a text.
    pub(super) fn set_text(&mut self, argument: usize, text: &str) {
        self.written.push((self.arguments[argument].first, text.into()));
    }

    /// Gives the result.
    pub(super) fn give(&mut self, value: f64) -> Result<(), Fault> {
        if let Some(result) = self.result {
            self.numbers[result.first as usize] = value;
        }
        Ok(())
    }

    /// Gives a text as result.
    pub(super) fn give_text(&mut self, text: &str) -> Result<(), Fault> {
        if let Some(result) = self.result {
            self.written.push((result.first, text.into()));
        }
        Ok(())
    }

    /// Gives a new object as result.
    pub(super) fn give_object<T: Any + Send + Sync>(&mut self, object: T) -> Result<(), Fault> {
        self.give_shared(Arc::new(object));
        Ok(())
    }

    /// Gives an object as result that others hold too.
    pub(super) fn give_shared(&mut self, object: Object) {
        self.objects.push(object);
        if let Some(result) = self.result {
            self.numbers[result.first as usize] = (self.objects.len() - 1) as f64;
        }
    }
}
