//! What a Modelica declaration says of a function in C.

use crate::external::Effect;
use std::collections::BTreeSet;

/// A type of C (MLS §12.9.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Scalar {
    /// `double`
    Real,
    /// `int`: Integer, Boolean, enumeration.
    Whole,
    /// `const char *`
    Text,
    /// `void *`: an external object.
    Object,
}

/// How an argument is passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Argument {
    /// By value.
    Value(Scalar),
    /// `size_t`
    Size,
    /// By pointer, to be written.
    Output(Scalar),
    /// An array, row-major.
    Array(Scalar),
}

impl Argument {
    /// The letter of [`Entry::signature`](crate::external::Entry::signature).
    fn letter(self) -> char {
        match self {
            Argument::Value(Scalar::Text) => 't',
            Argument::Output(Scalar::Text) => 'T',
            Argument::Value(Scalar::Object) | Argument::Output(Scalar::Object) => 'o',
            Argument::Value(_) | Argument::Size => 'n',
            Argument::Output(_) => 'N',
            Argument::Array(Scalar::Text) => 's',
            Argument::Array(_) => 'a',
        }
    }
}

/// A function in C.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Declaration {
    /// Full name of the Modelica function.
    pub class: String,
    /// Name of the C function.
    pub function: String,
    /// Its arguments.
    pub arguments: Vec<Argument>,
    /// Its result.
    pub result: Option<Scalar>,
    /// The Modelica function that frees the object which this one makes (MLS §12.9.7).
    pub destructor: Option<String>,
    /// The class of each argument that is an external object, followed by that of the result.
    pub objects: Vec<Option<String>>,
    /// What calls do besides giving results.
    pub effect: Effect,
    /// `Include`
    pub include: Option<String>,
    /// `IncludeDirectory`, or the folder that holds without it.
    pub include_directory: String,
    /// `Library`
    pub libraries: Vec<String>,
    /// `LibraryDirectory`, or the folder that holds without it.
    pub library_directory: String,
}

impl Declaration {
    /// As in [`Entry::signature`](crate::external::Entry::signature).
    pub fn signature(&self) -> String {
        let mut letters: String = self.arguments.iter().map(|a| a.letter()).collect();
        letters += match self.result {
            None => "",
            Some(Scalar::Real | Scalar::Whole) => "->n",
            Some(Scalar::Text) => "->t",
            Some(Scalar::Object) => "->o",
        };
        letters
    }

    /// What two functions have in common that share variables in C: a source (`f.c` and `f.h` are
    /// one), text of its own, a library, a class of external objects.
    pub fn sources(&self) -> BTreeSet<String> {
        let stem = |name: &str| name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned();
        let folder = &self.include_directory;
        let mut sources: BTreeSet<String> =
            self.included().map(|name| format!("{folder}/{}", stem(name))).collect();
        if let (Some(text), true) = (&self.include, sources.is_empty()) {
            sources.insert(text.clone());
        }
        sources.extend(self.libraries.iter().map(|library| format!("-l{library}")));
        sources.extend(self.objects.iter().flatten().map(|class| format!("object {class}")));
        sources
    }

    /// The names after `#include` in its annotation.
    pub fn included(&self) -> impl Iterator<Item = &str> {
        let lines = self.include.as_deref().unwrap_or_default().lines();
        lines.filter_map(|line| {
            let rest = line.trim().strip_prefix('#')?.trim_start().strip_prefix("include")?.trim();
            let end = rest.get(1..)?.find(['"', '>'])? + 1;
            rest.get(1..end)
        })
    }
}
