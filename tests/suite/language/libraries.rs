//! Libraries on a disk: each script of `tests/libraries/*/` runs in a world in memory that holds
//! the files of its folder; the transcript is compared with the snapshot beside the script.

use crate::support::transcript::{transcript_of, world_of};
use gapilib::internals::name::Name;
use gapilib::internals::script::models::simulation;
use gapilib::internals::source::SourceId;
use gapilib::{Dialect, Options, Session};
use std::path::Path;

#[test]
fn scripts_load_libraries_as_recorded() {
    insta::glob!("../../libraries", "*/*.mos", |path| {
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

/// A folder on the disk with these files.
fn disk(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a writable folder");
        std::fs::write(path, text).expect("a writable folder");
    }
    folder
}

/// Exit code, standard output and standard error of the program in a folder.
fn gapi(folder: &Path, path: &str, arguments: &[&str]) -> (i32, String, String) {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_gapi"));
    let command = command.args(arguments).current_dir(folder).env("MODELICAPATH", path);
    let output = command.output().expect("the program starts");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("no signal"), text(output.stdout), text(output.stderr))
}

fn constant(package: &str, value: f64) -> String {
    format!("package {package} model M Real x = {value:?}; end M; end {package};")
}

#[test]
fn folders_of_the_command_line_come_before_those_of_the_environment() {
    let (one, two) = (constant("P", 1.0), constant("P", 2.0));
    let (three, real) = (constant("Q", 3.0), constant("GAPILib", 4.0));
    let here = disk(&[
        ("a/P/package.mo", &one),
        ("b/P/package.mo", &two),
        ("b/Q.mo", &three),
        ("b/GAPILib/package.mo", &real),
    ]);
    let flat = |arguments: &[&str]| {
        let arguments = [&["flatten", "--model"], arguments].concat();
        let (code, out, errors) = gapi(here.path(), "b", &arguments);
        assert_eq!(code, 0, "{errors}");
        out
    };
    assert!(flat(&["P.M", "--library", "a"]).contains("1.0"));
    assert!(flat(&["P.M"]).contains("2.0"));
    assert!(flat(&["Q.M", "--library", "a"]).contains("3.0"));
    // A library of the user takes the place of one in the program.
    assert!(flat(&["GAPILib.M"]).contains("4.0"));
}

/// A standard library of version 4 has no `SIunits`: models of earlier versions find them still.
#[test]
fn units_are_supplied_under_their_former_name() {
    let here = disk(&[
        (
            "Modelica 4.0.0/package.mo",
            "package Modelica annotation(version = \"4.0.0\"); end Modelica;",
        ),
        ("Modelica 4.0.0/package.order", "Units\n"),
        (
            "Modelica 4.0.0/Units.mo",
            "within Modelica; package Units package SI type Voltage = Real(unit = \"V\");
             type ThermodynamicTemperature = Real(unit = \"K\"); end SI; end Units;",
        ),
        ("M.mo", "model M Modelica.SIunits.Voltage v = 1; Modelica.SIunits.Temp_K T = 2; end M;"),
    ]);
    let (code, out, errors) = gapi(here.path(), "", &["flatten", "M.mo", "--model", "M"]);
    assert_eq!(code, 0, "{errors}");
    assert!(out.contains("unit = \"V\"") && out.contains("unit = \"K\""), "{out}");
}

#[test]
fn check_tells_the_errors_of_all_files_and_classes() {
    let here = disk(&[
        (
            "models/a.mo",
            "package A model B Real x end B; model C Real y; equation y = (1; end C; end A;",
        ),
        ("models/P/package.mo", "package P model Q parameter = 1; end Q; end P;"),
        ("models/P/R.mo", "within P; model R end S;"),
        ("good.mo", "model Good Real x = 1; end Good;"),
    ]);
    let (code, _, errors) = gapi(here.path(), "", &["check", "models", "good.mo"]);
    assert_eq!(code, 1);
    let codes = ["missing-semicolon", "unclosed-bracket", "syntax-error", "mismatched-end"];
    let found: Vec<usize> =
        codes.iter().filter_map(|code| errors.find(&format!("[{code}]"))).collect();
    assert_eq!(found.len(), codes.len(), "{errors}");
    assert_eq!(errors.matches("error[").count(), codes.len(), "{errors}");
    let (code, out, _) = gapi(here.path(), "", &["check", "good.mo"]);
    assert!(code == 0 && out.ends_with("1 class, 1 model, 0 with errors\n"), "{out}");
}

/// A file inside a package is checked as a part of it.
#[test]
fn files_find_the_package_around_them() {
    let here = disk(&[
        ("P/package.mo", "package P constant Real c = 2; end P;"),
        ("P/Q/package.mo", "within P; package Q end Q;"),
        ("P/Q/M.mo", "within P.Q; model M Real x = c; end M;"),
    ]);
    for path in ["P/Q/M.mo", "P/Q", "P/Q/package.mo", "P"] {
        let (code, out, errors) = gapi(here.path(), "", &["check", path, "--model", "P.Q.M"]);
        assert_eq!(code, 0, "{path}: {errors}");
        assert!(out.contains("unknowns 1"), "{path}: {out}");
    }
}
