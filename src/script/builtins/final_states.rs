//! The file `dsfinal.txt`, in which the end of the last simulation is kept, and copies of it.

use crate::Session;
use crate::access::policy::Grant;
use crate::bail;
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::models::final_state::{self, FinalState};
use crate::world::Stamp;
use std::path::{Path, PathBuf};

/// The file in which the end of the last simulation is kept.
pub(super) const FINAL: &str = "dsfinal.txt";

/// The file as the last simulation has left it, whether it could write it or not.
#[derive(Default)]
struct LastFinal {
    file: Option<(PathBuf, Option<Stamp>)>,
    /// Whether it was said that it cannot be written.
    has_warned: bool,
}

/// Writes the end of the last simulation into the working directory.
pub(super) fn write_final(session: &mut Session) {
    let Some(text) = session.models.end.as_ref().map(FinalState::text) else { return };
    let path = session.world.absolute(Path::new(FINAL));
    let beginning = session.world.read_start(&path, final_state::BEGINNING);
    if beginning.is_ok_and(|bytes| FinalState::is_in(&bytes)) {
        session.world.grant(Grant::Replace(&path));
    }
    if let Err(fault) = session.world.write_file(&path, text.as_bytes())
        && !std::mem::replace(&mut session.extension::<LastFinal>().has_warned, true)
    {
        let text = "`importInitial()` continues from the last simulation all the same";
        session.report(fault.help(text).at(session.call_site()).warning());
    }
    let stamp = session.world.stamp(&path);
    session.extension::<LastFinal>().file = Some((path, stamp));
}

/// The state in a file; that of the last simulation as it is in memory.
pub(super) fn final_state(session: &mut Session, file: &str) -> Result<FinalState, Fault> {
    let found = session.world.find_file(Path::new(file));
    let known = &session.extension::<LastFinal>().file;
    let is_last = match (known, &found) {
        (Some((path, _)), Some(found)) if path != found => false,
        (Some((path, stamp)), Some(_)) => {
            let (path, stamp) = (path.clone(), *stamp);
            session.world.stamp(&path) == stamp
        }
        (_, Some(_)) => false,
        (_, None) => file == FINAL,
    };
    match session.models.end.as_ref() {
        Some(end) if is_last => Ok(end.clone()),
        None if is_last => bail!(
            BAD_ARGUMENT,
            "there is no final state to continue from: no model has been simulated, or the last \
             simulation failed"
        ),
        _ => FinalState::read(file, &session.world.read_bytes(Path::new(file))?),
    }
}
