//! Each code has a script `tests/diagnostics/<slug>.mos` that makes it happen; what the user sees
//! is the snapshot beside it.

use crate::support::transcript::world_of;
use gapilib::internals::script::codes;
use gapilib::{Session, Transcript};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Codes that no script shows yet. A code that is listed here and has a script fails, and so does
/// one that has none and is not listed.
const WITHOUT_SCRIPT: &[&str] = &[
    // A world in memory has no limits; `tests/suite/tools/cli.rs` shows it.
    "limit-reached",
    // `gapi teach` reports it, no script: see `teach.rs`.
    "bad-trace",
    // `gapi teach --what-if` reports it: see `teach.rs`.
    "cannot-branch",
    // A pause or `gapi teach --what-if` reports it: see `watching.rs`.
    "bad-change",
    // `gapi compare` reports it, no script: see `cli.rs`.
    "bad-reference",
    // A result table is checked before it is written; only a fault of the program can raise it.
    "bad-result-table",
    // A world in memory has no compiler: see `c_functions.rs`.
    "external-compiler",
    // Scripts grant what external functions want; models without files do not: see `external.rs`.
    "external-outside",
    // Problems report it, and a world in memory has no package `GAPILib`: see `process_noise.rs`.
    "no-filter",
    // Scripts meet `bad-parameter-value` first.
    "structural-parameter",
    // A world in memory has no processes for units: see `fmus.rs`.
    "bad-fmu",
    "fmu-message",
    // Only several processes can differ: see `ranks.rs`.
    "ranks-differ",
    "ranks-idle",
    // It takes two runs in one folder: see `script_reports.rs`.
    "earlier-results",
    // It follows twenty reports: see `script_reports.rs`.
    "several-searches",
    // It takes a text of four gibibytes.
    "text-too-large",
    // Flattening reports `unknown-name` first.
    "unresolved-reference",
];

#[test]
fn scripts_show_their_codes() {
    insta::glob!("../../diagnostics", "*.mos", |path| {
        let slug = path.file_stem().expect("a stem").to_string_lossy().into_owned();
        let mut world = world_of(path.parent().expect("a folder"));
        if slug == "interrupted" {
            world = world.interrupted_after(20);
        }
        let mut session = Session::new(Box::new(world));
        session.output.transcript = Some(Transcript::default());
        let status = session.run_file(Path::new(path.file_name().expect("a name")));
        let shown = session.output.transcript.take().unwrap_or_default().to_string();
        assert!(shown.contains(&format!("[{slug}]")), "`{slug}` is not shown:\n{shown}");
        let asked = session.output.messages.take_text(&session.sources, false);
        let text = format!("{shown}[exit code {}]\n\ngetErrorString():\n{asked}", status.code);
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(path.parent().expect("a folder"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_snapshot_suffix("");
        settings.set_omit_expression(true);
        settings.remove_input_file();
        settings.bind(|| insta::assert_snapshot!(slug, text));
    });
}

#[test]
fn every_code_has_a_script_or_is_listed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/diagnostics");
    let entries = fs::read_dir(folder).expect("a readable folder");
    let shown: BTreeSet<String> = entries
        .map(|entry| entry.expect("a readable entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "mos"))
        .map(|path| path.file_stem().expect("a stem").to_string_lossy().into_owned())
        .collect();
    let known: BTreeSet<String> = codes::all().iter().map(|code| code.slug.to_owned()).collect();
    let listed: BTreeSet<String> = WITHOUT_SCRIPT.iter().map(|slug| (*slug).to_owned()).collect();
    let strangers: Vec<&String> = shown.difference(&known).collect();
    assert!(strangers.is_empty(), "scripts for codes that do not exist: {strangers:?}");
    let missing: BTreeSet<String> = known.difference(&shown).cloned().collect();
    assert_eq!(missing, listed, "codes without a script");
}

#[test]
fn every_explanation_has_its_headings() {
    for code in codes::all() {
        for heading in ["## What it means", "## Example", "## What to do"] {
            assert!(code.explanation.contains(heading), "`{}` lacks `{heading}`", code.slug);
        }
    }
}

/// Each table of codes in the sources is one that `gapi explain` knows.
#[test]
fn every_code_of_the_sources_is_explained() {
    fn slugs_below(folder: &Path, slugs: &mut BTreeSet<String>) {
        for entry in fs::read_dir(folder).expect("a readable folder") {
            let path = entry.expect("a readable entry").path();
            if path.is_dir() {
                slugs_below(&path, slugs);
                continue;
            }
            if path.extension().is_none_or(|extension| extension != "rs") {
                continue;
            }
            let text = fs::read_to_string(&path).expect("a readable file");
            for table in text.split("codes! {\n    /// ").skip(1) {
                let table = table.split("\n}").next().unwrap_or_default();
                let lines =
                    table.lines().filter_map(|line| line.split_once(" = \"")?.1.split_once("\":"));
                slugs.extend(
                    lines.map(|(slug, _)| slug.to_owned()).filter(|slug| !slug.contains(' ')),
                );
            }
        }
    }
    let mut written = BTreeSet::new();
    slugs_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut written);
    let known: BTreeSet<String> = codes::all().iter().map(|code| code.slug.to_owned()).collect();
    assert_eq!(written, known, "codes in tables of the sources, and those that are explained");
}
