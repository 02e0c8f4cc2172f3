//! Settings that are changed during a run: a file `name = number` in each line, looked at
//! again whenever it changes.
//!
//! Names are those of the method (`mutation`, `elites`, …), `generations`, `evaluations` and
//! `seconds` of the stop conditions, and `"min NAME"` and `"max NAME"` of the search ranges.

use crate::Session;
use crate::identify::problem::Run;
use crate::runs::interaction::reason;
use crate::world::Stamp;
use indexmap::IndexMap;
use std::path::PathBuf;

/// A watched file.
pub(super) struct Watched {
    path: PathBuf,
    stamp: Option<Stamp>,
    known: IndexMap<String, f64>,
}

impl Watched {
    pub(super) fn new(path: PathBuf) -> Watched {
        Watched { path, stamp: None, known: IndexMap::new() }
    }

    /// Carries out what has changed in the file; what cannot be is reported and left.
    pub(super) fn apply(&mut self, session: &mut Session, run: &mut Run) {
        let stamp = session.world.stamp(&self.path);
        if stamp.is_none() || stamp == self.stamp {
            return;
        }
        self.stamp = stamp;
        let Ok(bytes) = session.world.read(&self.path) else { return };
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let requested: IndexMap<String, f64> = match toml::from_str(&text) {
            Ok(requested) => requested,
            Err(error) => {
                let text = format!("warning: `{}`: {}\n", self.path.display(), error.message());
                session.world.eprint(&text);
                return;
            }
        };
        for (setting, value) in requested {
            if self.known.get(&setting) == Some(&value) {
                continue;
            }
            // What is refused has been reported.
            let _ = change(session, run, &setting, value);
            self.known.insert(setting, value);
        }
    }
}

/// Changes one setting; what cannot be is reported and left.
///
/// # Errors
///
/// Why it cannot be changed.
pub(super) fn change(
    session: &mut Session,
    run: &mut Run,
    setting: &str,
    value: f64,
) -> Result<(), String> {
    let changed = run.change(setting, value).map_err(|fault| reason(&fault.message, &fault.helps));
    match &changed {
        Ok(()) => session
            .print(&format!("{setting} = {value} from generation {} on\n", run.generations() + 1)),
        Err(reason) => session.world.eprint(&format!("warning: {reason}\n")),
    }
    changed
}
