//! Results of a problem that has changed since: its new results do not replace them.

use crate::Session;
use crate::diag::Fault;
use crate::identify::problem::{Origins, listed};
use crate::runs::checkpoint::numbered;
use std::path::Path;

/// What the results in a folder depend on.
const INPUTS: &str = "inputs.json";
/// The folder for former results, before its number.
const FORMER: &str = "former";

/// Keeps the results of a problem with other inputs under a number, and notes what the next ones depend
/// on.
///
/// # Errors
///
/// A file cannot be read or written.
pub(super) fn keep(session: &mut Session, folder: &Path, origins: &Origins) -> Result<(), Fault> {
    let path = folder.join(INPUTS);
    let before = match session.world.exists(&path) {
        true => serde_json::from_slice(&session.world.read_bytes(&path)?).ok(),
        false => None,
    };
    if session.world.exists(&folder.join("result.json"))
        && let Some(before) = before
    {
        let changed = origins.inputs_changed_since(&before);
        if !changed.is_empty() {
            set_aside(session, folder, &changed)?;
        }
    }
    let text = serde_json::to_string_pretty(origins).unwrap_or_default();
    session.world.write_file(&path, (text + "\n").as_bytes())
}

fn set_aside(session: &mut Session, folder: &Path, changed: &[String]) -> Result<(), Fault> {
    let kept = numbered(session, &folder.join(FORMER));
    for name in session.world.list_dir(folder).unwrap_or_default() {
        let path = folder.join(&name);
        let is_result = [".json", ".csv", ".svg", ".html", ".mo", ".mos"];
        if is_result.iter().any(|ending| name.ends_with(ending)) && !session.world.is_dir(&path) {
            let bytes = session.world.read_bytes(&path)?;
            session.world.write_file(&kept.join(&name), &bytes)?;
        }
    }
    let here = session.world.current_dir();
    let shown = kept.strip_prefix(&here).unwrap_or(&kept).display().to_string();
    let changed = listed(changed);
    session.print(&format!(
        "\n  the former results are kept in {shown}: these have changed since: {changed}\n"
    ));
    Ok(())
}
