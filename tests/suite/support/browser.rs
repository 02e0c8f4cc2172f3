//! A real browser for pages. `GAPILIB_CHROMIUM` names it; else `chromium`, `chromium-browser` or
//! `google-chrome` on the path is taken if it reports its version: some systems have a script there
//! that asks to install one.

use std::path::PathBuf;
use std::process::Command;

pub(crate) fn chromium() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("GAPILIB_CHROMIUM") {
        return Some(PathBuf::from(named));
    }
    let folders: Vec<PathBuf> =
        std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()).collect();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let mut all = names.iter().flat_map(|name| folders.iter().map(move |f| f.join(name)));
    all.find(|path| {
        Command::new(path).arg("--version").output().is_ok_and(|out| out.status.success())
    })
}

/// What the script of the test has reported: one line for each check.
pub(crate) fn reports(dom: &str) -> Vec<String> {
    let inner = dom.split_once("[[").and_then(|(_, rest)| Some(rest.split_once("]]")?.0));
    inner.unwrap_or_else(|| panic!("no report in\n{dom}")).lines().map(str::to_owned).collect()
}
