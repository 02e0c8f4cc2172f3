//! Reference results: folders of a collection, each named like the model that it belongs to.

use gapilib::internals::name::Name;
use gapilib::results::{self, ResultTable};
use std::fs;
use std::path::{Path, PathBuf};

/// Reference results of one model.
pub(crate) struct Reference {
    /// All of them.
    pub(crate) table: ResultTable,
    /// Those that count.
    pub(crate) signals: Vec<String>,
}

impl Reference {
    /// The reference results of a model; `None` if the collection holds none for it.
    pub(crate) fn of(class: &Name, collection: &Path) -> Option<Reference> {
        let path = Reference::path(class, collection);
        let bytes = fs::read(&path).ok()?;
        let format = results::format("csv").expect("a known format");
        let table = format.read(&bytes).unwrap_or_else(|fault| panic!("{class}: {fault:?}"));
        let list = fs::read_to_string(path.with_file_name("comparisonSignals.txt")).ok();
        let signals = results::signals_to_compare(&table, list.as_deref());
        Some(Reference { table, signals })
    }

    /// Where the reference results of a model are, if there are some.
    pub(crate) fn path(class: &Name, collection: &Path) -> PathBuf {
        let text = class.to_string();
        let folder = text.split('.').fold(collection.to_owned(), |path, part| path.join(part));
        let last = class.last().map_or("", |last| last.as_str());
        folder.join(format!("{last}.csv"))
    }
}
