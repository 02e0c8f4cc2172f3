//! Files of scripts: finding them by the names that scripts use, reading each once, and the dialect
//! that they show.

use super::parsed_scripts::Parsed;
use super::script_search::ScriptSearch;
use crate::diag::{Diagnostic, Fault};
use crate::errors::{CONTINUED_LINE, SCRIPT_NOT_FOUND};
use crate::models::imported::refuse_as_text;
use crate::source::{SourceId, Span};
use crate::syntax::continuing_signs;
use crate::{Dialect, Session};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl Session {
    /// The dialect that a text shows by what only one of them has.
    pub fn looks_like(&self, text: &str) -> Option<Dialect> {
        let script = Parsed::read(SourceId::NONE, text).ok()?;
        script.dialect().or(script.dialect_of_running())
    }

    /// The dialect that a script in a folder shows, or else the scripts that it runs.
    pub(super) fn shown_dialect(
        &mut self,
        script: &Parsed,
        folder: &Path,
        seen: &mut HashSet<PathBuf>,
    ) -> Option<Dialect> {
        if let Some(dialect) = script.dialect() {
            return Some(dialect);
        }
        for name in script.scripts_run() {
            let search = ScriptSearch::new(&self.world, folder, name);
            let Some(path) = search.exact() else { continue };
            if !seen.insert(path.clone()) {
                continue;
            }
            // What is wrong with it is reported where it is run.
            let Ok(inner) = self.parsed_script(&path) else { continue };
            let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
            let found = self.shown_dialect(&inner, &folder, seen);
            if found.is_some() {
                return found;
            }
        }
        script.dialect_of_running()
    }

    /// The script of this name: in the folder of the calling script, then in the working
    /// directory; with and without the ending; at last with other letter cases.
    pub(crate) fn find_script(&mut self, name: &str) -> Result<PathBuf, Fault> {
        let folder = self.world.folders().next().map(Path::to_path_buf).unwrap_or_default();
        let key = (folder, self.world.current_dir(), name.to_owned());
        if let Some(path) = self.parsed.found(&key)
            && self.world.sees(path)
        {
            return Ok(path.clone());
        }
        let path = self.search_script(&key.0, name)?;
        self.parsed.keep_found(key, path.clone());
        Ok(path)
    }

    fn search_script(&mut self, folder: &Path, name: &str) -> Result<PathBuf, Fault> {
        let search = ScriptSearch::new(&self.world, folder, name);
        if let Some(path) = search.exact() {
            return Ok(path);
        }
        let Some(path) = search.in_other_case() else { return Err(search.missing()) };
        let found = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into());
        let message = format!("`{name}` is interpreted as `{found}`: upper and lower case differ");
        self.note(SCRIPT_NOT_FOUND, message);
        Ok(path)
    }

    pub(super) fn parsed_script(&mut self, path: &Path) -> Result<Arc<Parsed>, Vec<Diagnostic>> {
        let stamp = self.world.stamp(path);
        if let Some(script) = self.parsed.get(path, stamp) {
            return Ok(script);
        }
        let refused = refuse_as_text(path, "a script");
        let added = refused.and_then(|()| self.add_file(path));
        let (source, text) = added.map_err(|fault| vec![fault.at(Span::NONE)])?;
        let script = Arc::new(Parsed::read(source, &text).map_err(|error| vec![error])?);
        self.note_continuing_signs(source, &text);
        self.parsed.keep(path, stamp, &script);
        Ok(script)
    }

    /// Says of lines that begin with a sign that they continue the line before.
    pub(super) fn note_continuing_signs(&mut self, source: SourceId, text: &str) {
        for sign in continuing_signs(source, text) {
            let message =
                "this line continues the expression of the line before, which has no semicolon";
            let help = "write a semicolon at the end of the line before if this is a statement of its \
                        own, or a blank after the sign if it is not";
            self.report(Fault::new(CONTINUED_LINE, message).help(help).at(sign).note());
        }
    }
}
