//! What a user sees: each script of `tests/transcripts/*/` is run in a world in memory that holds
//! the files of its folder; the transcript is compared with the snapshot beside the script.

use crate::support::transcript::transcript_of;
use gapilib::{Options, Permissions};

#[test]
fn scripts_answer_as_recorded() {
    insta::glob!("../../transcripts", "*/*.mos", |path| {
        let stem = path.file_stem().expect("a stem").to_string_lossy().into_owned();
        // Most of these scripts write what they read afterwards, scripts and models too.
        let write = !["permissions", "external_files"].contains(&stem.as_str());
        let permissions = Permissions { write, ..Permissions::default() };
        let transcript = transcript_of(path, Options { permissions, ..Options::default() });
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(path.parent().expect("a folder"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_snapshot_suffix("");
        settings.set_omit_expression(true);
        settings.remove_input_file();
        settings.bind(|| insta::assert_snapshot!(stem, transcript));
    });
}
