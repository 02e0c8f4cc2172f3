//! Files of scripts: finding them by the names that scripts use, reading each once, and the dialect
//! that they show.

use super::parsed_scripts::Parsed;
use crate::access::faults::{escape_help, shown};
use crate::access::policy::Access;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::errors::SCRIPT_NOT_FOUND;
use crate::models::imported::refuse_as_text;
use crate::source::{SourceId, Span};
use crate::world::normalized;
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
            let plain = self.world.expanded(Path::new(&**name));
            let Some(path) = self.exact_script(folder, &plain) else { continue };
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
        let plain = self.world.expanded(Path::new(name));
        if let Some(path) = self.exact_script(folder, &plain) {
            return Ok(path);
        }
        let candidates = self.script_candidates(folder, &plain);
        let other_case = candidates.iter().find_map(|path| self.other_case(path));
        if let Some(path) = other_case {
            let found = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into());
            let message =
                format!("`{name}` is interpreted as `{found}`: upper and lower case differ");
            self.note(SCRIPT_NOT_FOUND, message);
            return Ok(path);
        }
        // Whether there is a file that may not be read stays unknown.
        for place in &candidates {
            self.world.may(Access::Read, place)?;
        }
        let folders = [self.world.absolute(folder), self.world.current_dir()];
        let written = Path::new(name);
        let message = format!("there is no script `{}`", shown(written));
        let fault = Fault::new(SCRIPT_NOT_FOUND, message).help_if(escape_help(written));
        let [own, working] = folders.each_ref().map(|folder| folder.display());
        let is_one = normalized(&folders[0]) == normalized(&folders[1]);
        let searched = match Path::new(name).is_absolute() {
            true => "an absolute path is not searched for elsewhere".to_owned(),
            false if is_one => format!("searched in the working directory `{working}`"),
            false => format!("searched in `{own}` and in the working directory `{working}`"),
        };
        Err(fault.help_if(self.similar_script(&folders[0].join(&plain))).help(searched))
    }

    /// Where a script of this name may lie, in the order of precedence.
    fn script_candidates(&self, folder: &Path, name: &Path) -> [PathBuf; 4] {
        let mut with_ending = name.to_path_buf().into_os_string();
        with_ending.push(".mos");
        let (own, working) = (self.world.absolute(folder), self.world.current_dir());
        let path =
            |folder: &Path, name: &Path| normalized(&self.world.absolute(&folder.join(name)));
        let with_ending = Path::new(&with_ending);
        [
            path(&own, name),
            path(&own, with_ending),
            path(&working, name),
            path(&working, with_ending),
        ]
    }

    /// The script of exactly this name, with or without the ending.
    fn exact_script(&self, folder: &Path, name: &Path) -> Option<PathBuf> {
        let is_file = |path: &PathBuf| self.world.sees(path) && !self.world.is_dir(path);
        self.script_candidates(folder, name).into_iter().find(is_file)
    }

    fn similar_script(&self, path: &Path) -> Option<String> {
        let nearby = self.world.list_dir(path.parent()?).ok()?;
        let scripts: Vec<&str> = nearby.iter().filter_map(|e| e.strip_suffix(".mos")).collect();
        suggest::did_you_mean(&path.file_stem()?.to_string_lossy(), scripts)
    }

    /// The file of this path, letter case not counted in any of its parts.
    fn other_case(&self, path: &Path) -> Option<PathBuf> {
        let mut found = PathBuf::new();
        for component in normalized(&self.world.absolute(path)).components() {
            let exact = found.join(component);
            if self.world.exists(&exact) {
                found = exact;
                continue;
            }
            let name = component.as_os_str().to_string_lossy().into_owned();
            let entries = self.world.list_dir(&found).ok()?;
            found.push(entries.iter().find(|entry| entry.eq_ignore_ascii_case(&name))?);
        }
        (self.world.sees(&found) && !self.world.is_dir(&found)).then_some(found)
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
        self.parsed.keep(path, stamp, &script);
        Ok(script)
    }
}
