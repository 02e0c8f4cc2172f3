//! Libraries on a disk: each script of `tests/libraries/*/` runs in a world in memory that holds
//! the files of its folder; the transcript is compared with the snapshot beside the script.

use crate::transcripts::{transcript_of, world_of};
use gapilib::name::Name;
use gapilib::script::{Dialect, Options, Session, simulation};
use gapilib::source::SourceId;
use std::path::Path;

#[test]
fn scripts_load_libraries_as_recorded() {
    insta::glob!("../libraries", "*/*.mos", |path| {
        let dialect = Some(Dialect::OpenModelica);
        let transcript = transcript_of(path, Options { dialect, ..Options::default() });
        let stem = path.file_stem().expect("a stem").to_string_lossy().into_owned();
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(path.parent().expect("a folder"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_snapshot_suffix("");
        settings.set_omit_expression(true);
        settings.remove_input_file();
        settings.add_filter(r"(time\w+ = )[-+.e\d]+", "${1}[seconds]");
        settings.bind(|| insta::assert_snapshot!(stem, transcript));
    });
}

fn session(case: &str) -> Session {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/libraries").join(case);
    Session::new(Box::new(world_of(&folder)))
}

/// The files that were read, in order.
fn files_read(session: &Session) -> Vec<String> {
    let sources = (0..).map_while(|id| session.sources.get(SourceId(id)));
    let names = sources.map(|source| source.name.replace('\\', "/"));
    names.filter(|name| name.ends_with(".mo")).collect()
}

#[test]
fn only_the_files_of_the_classes_needed_are_read() {
    let mut session = session("new");
    session.library();
    simulation::translate(&mut session, "Asks.M").expect("a model");
    assert_eq!(files_read(&session), ["Asks.mo", "Ordered 1.2.0/package.mo"]);
    simulation::translate(&mut session, "Ordered.First").expect("a model");
    let more = ["First.mo", "Inner/package.mo", "Inner/Unlisted.mo", "Inner/M.mo"];
    let more = more.map(|file| format!("Ordered 1.2.0/{file}"));
    assert_eq!(files_read(&session)[2..], more);
}

/// The parser refuses two classes of one name, whenever it comes to them.
#[test]
fn a_class_that_cannot_be_read_is_an_error_every_time() {
    let mut session = session("broken");
    for _ in 0..2 {
        for model in ["Broken.Bad", "Broken.Worse", "Broken.Deep.Twins.Twin", "Broken.Deep.Bad"] {
            let errors = simulation::translate(&mut session, model).expect_err("it is broken");
            assert!(errors.iter().all(|error| error.is_error()), "{model}");
        }
    }
    assert!(session.library().contains(&Name::parse("Broken.Good")));
}
