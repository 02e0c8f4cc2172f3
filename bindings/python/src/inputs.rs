//! Inputs that follow data: columns of a file, or of data in memory.

use gapilib::Session as Engine;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// The name of data in memory.
const GIVEN: &str = "inputs.csv";

/// Where the data are, and how inputs continue between their rows.
pub(crate) struct Inputs {
    path: PathBuf,
    /// The content of data in memory.
    bytes: Option<Vec<u8>>,
    interpolation: Option<String>,
}

impl Inputs {
    /// Data that Python gives: a file by its name, or what an experiment of a problem takes in memory.
    pub(crate) fn of(
        given: Option<Bound<'_, PyAny>>,
        interpolation: Option<String>,
    ) -> PyResult<Option<Inputs>> {
        let Some(given) = given else { return Ok(None) };
        if let Ok(path) = given.extract::<PathBuf>() {
            return Ok(Some(Inputs { path, bytes: None, interpolation }));
        }
        let text = given.py().import("gapilib._data")?.call_method1("text_of", (given,))?;
        let bytes = Some(text.extract::<String>()?.into_bytes());
        Ok(Some(Inputs { path: PathBuf::from(GIVEN), bytes, interpolation }))
    }

    /// Lets the session read them; the file and the interpolation.
    pub(crate) fn open(&self, engine: &mut Engine) -> (&Path, Option<&str>) {
        match &self.bytes {
            Some(bytes) => engine.world.give(&self.path, bytes.clone()),
            None => engine.world.grant_input(&self.path),
        }
        (&self.path, self.interpolation.as_deref())
    }
}
