//! The archive of a functional mock-up unit: a ZIP file.
//!
//! The bytes of an archive that is written follow from its files alone: they are sorted by their
//! paths and carry no times.

use crate::FmuError;
use std::collections::BTreeMap;
use std::io::{Cursor, Read, Seek, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

/// Whether a path is that of a unit.
pub fn is_unit(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("fmu"))
}

/// The path of the description.
pub const DESCRIPTION: &str = "modelDescription.xml";
/// Files of an archive that are read, all together: many times what a unit holds, and less than
/// what a small archive made for the purpose unpacks to.
const MOST_BYTES: u64 = 4 << 30;

/// The files of a unit by their paths, with `/` between the names.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Archive {
    files: BTreeMap<String, Vec<u8>>,
}

impl Archive {
    /// An archive with nothing in it.
    pub fn new() -> Archive {
        Archive::default()
    }

    /// Adds a file, or replaces it.
    pub fn insert(&mut self, path: impl Into<String>, content: impl Into<Vec<u8>>) {
        self.files.insert(path.into(), content.into());
    }

    /// The content of a file.
    ///
    /// # Errors
    /// [`FmuError::Missing`].
    pub fn file(&self, path: &str) -> Result<&[u8], FmuError> {
        let found = self.files.get(path).map(Vec::as_slice);
        found.ok_or_else(|| FmuError::Missing(path.to_owned()))
    }

    /// All files by their paths, in the order of these.
    pub fn files(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.files.iter().map(|(path, content)| (path.as_str(), content.as_slice()))
    }

    /// Reads an archive.
    ///
    /// # Errors
    /// It is not a ZIP file, is damaged, unpacks to more than 4 GiB, or has a path that leads out of it.
    pub fn read(source: impl Read + Seek) -> Result<Archive, FmuError> {
        let mut zip = ZipArchive::new(source).map_err(of_zip)?;
        let mut archive = Archive::new();
        let mut remaining = MOST_BYTES;
        for at in 0..zip.len() {
            let mut file = zip.by_index(at).map_err(of_zip)?;
            if file.is_dir() {
                continue;
            }
            let path = file.name().map_err(of_zip)?.replace('\\', "/");
            if file.enclosed_name().is_none() {
                return Err(FmuError::Archive(format!(
                    "the path `{path}` leads out of the archive"
                )));
            }
            let mut content = Vec::new();
            let read = (&mut file).take(remaining.saturating_add(1)).read_to_end(&mut content);
            read.map_err(|error| FmuError::Archive(format!("`{path}` is damaged: {error}")))?;
            remaining = remaining
                .checked_sub(content.len() as u64)
                .ok_or_else(|| FmuError::Archive("it unpacks to more than 4 GiB".to_owned()))?;
            archive.files.insert(path, content);
        }
        Ok(archive)
    }

    /// The archive as bytes.
    ///
    /// # Errors
    /// A file is too large for the format.
    pub fn to_bytes(&self) -> Result<Vec<u8>, FmuError> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        for (path, content) in &self.files {
            // Executable, as shared libraries are: some importers keep the permissions.
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Deflated)
                .last_modified_time(DateTime::default())
                .unix_permissions(0o755);
            zip.start_file(path.as_str(), options).map_err(of_zip)?;
            zip.write_all(content).map_err(|error| FmuError::Archive(error.to_string()))?;
        }
        Ok(zip.finish().map_err(of_zip)?.into_inner())
    }
}

fn of_zip(error: zip::result::ZipError) -> FmuError {
    FmuError::Archive(format!("it is not a ZIP archive that can be read: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_archive_is_what_was_written_in_any_order() {
        let mut one = Archive::new();
        one.insert("resources/b", *b"two");
        one.insert("modelDescription.xml", *b"one");
        let mut other = Archive::new();
        other.insert("modelDescription.xml", *b"one");
        other.insert("resources/b", *b"two");
        let bytes = one.to_bytes().unwrap();
        assert_eq!(bytes, other.to_bytes().unwrap());
        let read = Archive::read(Cursor::new(bytes)).unwrap();
        assert_eq!(read, one);
        assert_eq!(read.file("resources/b").unwrap(), b"two");
        assert_eq!(read.file("c"), Err(FmuError::Missing("c".to_owned())));
    }

    #[test]
    fn what_is_no_archive_and_what_leads_out_is_refused() {
        let read = Archive::read(Cursor::new(b"no zip at all".to_vec()));
        assert!(matches!(read, Err(FmuError::Archive(_))), "{read:?}");
        let mut outside = Archive::new();
        outside.insert("../outside", *b"x");
        let read = Archive::read(Cursor::new(outside.to_bytes().unwrap()));
        assert!(
            matches!(&read, Err(FmuError::Archive(why)) if why.contains("leads out")),
            "{read:?}"
        );
    }
}
