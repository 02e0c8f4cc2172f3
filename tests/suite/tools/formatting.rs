//! `gapi fmt`: layouts, what is never changed, and files.

use crate::support::program::{command, folder, gapi};
use crate::support::shipped::project;
use gapilib::internals::diag::render::render;
use gapilib::internals::format::{Failure, Language, format};
use gapilib::internals::source::{SourceId, SourceMap};
use gapilib::internals::syntax::visit::{WithoutSpans, rewrite_script, rewrite_stored_definition};
use gapilib::internals::syntax::{self, LexemeKind};
use proptest::prelude::*;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// Every Modelica file and script below a folder, or the file itself.
fn files(path: &Path, found: &mut Vec<PathBuf>) {
    if path.is_dir() {
        let entries = fs::read_dir(path).expect("the folder is readable");
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        paths.iter().filter(|path| !path.is_symlink()).for_each(|path| files(path, found));
    } else if Language::of_name(&path.to_string_lossy()).is_some() {
        found.push(path.to_owned());
    }
}

/// A text as its tokens and comments, and the tree it is read as.
fn read(text: &str, language: Language) -> (Vec<String>, String) {
    let is_script = language == Language::Script;
    let lexemes = syntax::lexemes(SourceId::NONE, text, is_script).expect("tokens");
    let tokens = lexemes.iter().map(|one| text[one.range()].to_owned()).collect();
    let tree = if is_script {
        let mut tree = syntax::parse_script(SourceId::NONE, text).expect("a script");
        rewrite_script(&mut WithoutSpans, &mut tree);
        format!("{tree:?}")
    } else {
        let mut tree = syntax::parse_stored_definition(SourceId::NONE, text).expect("classes");
        rewrite_stored_definition(&mut WithoutSpans, &mut tree);
        format!("{tree:?}")
    };
    (tokens, tree)
}

/// What is wrong with the formatted version of a text; `None` also where it cannot be read.
fn fault(text: &str, language: Language) -> Option<String> {
    let formatted = match format(SourceId::NONE, text, language) {
        Ok(formatted) => formatted,
        Err(Failure::Syntax(_)) => return None,
        Err(Failure::Changed) => return Some("the tokens change".to_owned()),
    };
    if read(text, language) != read(&formatted, language) {
        return Some(format!("another tree:\n{formatted}"));
    }
    match format(SourceId::NONE, &formatted, language) {
        Ok(again) if again == formatted => None,
        Ok(again) => Some(format!("not idempotent:\n{formatted}\nthen\n{again}")),
        Err(_) => Some("the formatted text cannot be read".to_owned()),
    }
}

/// The texts below a folder, with their languages.
fn texts(path: &Path) -> Vec<(PathBuf, String, Language)> {
    let mut found = Vec::new();
    files(path, &mut found);
    let text = |path: PathBuf| {
        let text = syntax::decode(&fs::read(&path).expect("the file is readable")).0;
        let language = Language::of_name(&path.to_string_lossy()).expect("a language");
        (path, text, language)
    };
    found.into_iter().map(text).collect()
}

fn assert_kept(path: &Path, least: usize) {
    let texts = texts(path);
    assert!(texts.len() >= least, "{} has {} files", path.display(), texts.len());
    let faults = texts.iter().filter_map(|(path, text, language)| {
        fault(text, *language).map(|fault| format!("{}: {fault}", path.display()))
    });
    let faults: Vec<String> = faults.collect();
    assert!(faults.is_empty(), "{} files\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn the_corpora_keep_their_trees() {
    assert_kept(&project("tests/grammar"), 40);
    assert_kept(&project("tests/transcripts"), 100);
    assert_kept(&project("tests/diagnostics"), 100);
    assert_kept(&project("tests/flattening"), 90);
    assert_kept(&project("models"), 50);
    assert_kept(&project("scripts"), 4);
}

/// The libraries in the folder that `GAPILIB_MODELICA_LIBRARY` names.
#[test]
#[allow(clippy::print_stderr, reason = "a test that is skipped has to say so")]
fn local_library_keeps_its_trees() {
    match std::env::var_os("GAPILIB_MODELICA_LIBRARY") {
        Some(folder) => assert_kept(Path::new(&folder), 1),
        None => eprintln!("skipped: GAPILIB_MODELICA_LIBRARY names no local library"),
    }
}

#[test]
fn layouts() {
    for (path, text, language) in texts(&project("tests/formatting")) {
        let sources = SourceMap::default();
        let source = sources.add(path.display().to_string(), text.as_str());
        let formatted = match format(source, &text, language) {
            Ok(formatted) => formatted,
            Err(Failure::Syntax(error)) => panic!("{}", render(&error, &sources, false)),
            Err(Failure::Changed) => panic!("{}: the tokens change", path.display()),
        };
        assert_eq!(fault(&text, language), None, "{}", path.display());
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(path.parent().expect("a folder"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        settings.bind(|| insta::assert_snapshot!(name, formatted));
    }
}

/// Classes with other white space between their tokens, which means the same.
fn spaced_differently(text: &str, gaps: &[&str]) -> String {
    let lexemes = syntax::lexemes(SourceId::NONE, text, false).expect("tokens");
    let mut out = String::new();
    let mut last = 0;
    for (at, lexeme) in lexemes.iter().enumerate() {
        let joined = last == lexeme.start;
        let gap = gaps[at % gaps.len()];
        let ends_line = at > 0 && lexemes[at - 1].kind == LexemeKind::LineComment;
        match (ends_line, joined, gap) {
            (true, _, _) => out.push('\n'),
            // Joined operators such as `.*` stay one.
            (_, true, _) => {}
            (_, false, "") => out.push(' '),
            (_, false, gap) => out.push_str(gap),
        }
        out.push_str(&text[lexeme.range()]);
        last = lexeme.end;
    }
    out
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn white_space_means_nothing_in_classes(
        gaps in prop::collection::vec(
            prop::sample::select(vec!["", " ", "  ", "\t", "\n", "\n\n\n", "\r\n", " \n   "]), 1..40,
        ),
        file in prop::sample::select(vec![
            "tests/formatting/classes.mo", "tests/formatting/package.mo",
            "tests/grammar/valid/classes.mo", "tests/grammar/valid/equations.mo",
            "tests/grammar/valid/comments.mo", "tests/grammar/valid/modifications.mo",
        ]),
    ) {
        let text = fs::read_to_string(project(file)).unwrap();
        let changed = spaced_differently(&text, &gaps);
        prop_assert_eq!(fault(&changed, Language::Modelica), None);
        prop_assert_eq!(
            read(&changed, Language::Modelica).1, read(&text, Language::Modelica).1
        );
    }
}

const UNTIDY: &str = "model M\nReal x=1 ;   \nend M;";
const TIDY: &str = "model M\n  Real x=1;\nend M;\n";

#[test]
fn files_are_written_once_and_keep_their_mode_and_encoding() {
    let here = folder(&[("b.mo", TIDY), ("c.txt", UNTIDY)]);
    let path = |name: &str| here.path().join(name);
    let crlf = "\u{feff}model M\r\nReal x \"ä\";\r\nend M;\r\n";
    fs::write(path("a.mo"), crlf).unwrap();
    fs::write(path("l.mo"), b"model L \"\xe4\"\nReal x;\nend L;\n").unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        fs::set_permissions(path("a.mo"), fs::Permissions::from_mode(0o640)).unwrap();
    }
    let before = fs::metadata(path("b.mo")).unwrap();
    let (code, out, error) = gapi(&here, &["fmt", "."]);
    assert_eq!((code, out.as_str()), (0, ""), "{error}");
    assert_eq!(error, "2 formatted, 1 unchanged, 0 with errors\n");
    let formatted = "\u{feff}model M\r\n  Real x \"ä\";\r\nend M;\r\n";
    assert_eq!(fs::read_to_string(path("a.mo")).unwrap(), formatted);
    assert_eq!(fs::read(path("l.mo")).unwrap(), b"model L \"\xe4\"\n  Real x;\nend L;\n");
    assert_eq!(fs::read_to_string(path("c.txt")).unwrap(), UNTIDY);
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt as _;
        assert_eq!(fs::metadata(path("a.mo")).unwrap().mode() & 0o777, 0o640);
        assert_eq!(fs::metadata(path("b.mo")).unwrap().ino(), before.ino());
    }
    assert_eq!(fs::metadata(path("b.mo")).unwrap().modified().ok(), before.modified().ok());
    assert_eq!(fs::read_dir(here.path()).unwrap().count(), 4);
}

#[test]
fn what_cannot_be_read_is_left_alone_and_named() {
    let broken = "model M\n  Real x\nend M;\n";
    let here = folder(&[("a.mo", broken), ("b.mo", UNTIDY), ("t.mos", "#1\ndouble t(1,1)\n1\n")]);
    let (code, _, error) = gapi(&here, &["fmt", "."]);
    assert_eq!(code, 1);
    assert!(error.contains("error[missing-semicolon]") && error.contains("a.mo:2:9"), "{error}");
    assert!(error.ends_with("1 formatted, 0 unchanged, 1 with errors\n"), "{error}");
    assert_eq!(fs::read_to_string(here.path().join("a.mo")).unwrap(), broken);
    assert_eq!(fs::read_to_string(here.path().join("b.mo")).unwrap(), TIDY);
    assert_eq!(gapi(&here, &["fmt", "none.mo"]).0, 1);
    assert_eq!(gapi(&here, &["fmt", "Cargo.toml"]).0, 2);
}

#[test]
fn check_and_diff_write_nothing() {
    let here = folder(&[("a.mo", UNTIDY)]);
    let (code, out, _) = gapi(&here, &["fmt", "--check", "a.mo"]);
    assert_eq!((code, out.as_str()), (1, "a.mo\n"));
    let (code, out, _) = gapi(&here, &["fmt", "--diff", "a.mo"]);
    let diff = "--- a.mo\n+++ a.mo\n@@ -1,3 +1,3 @@\n model M\n-Real x=1 ;   \n-end M;\n\
                \\ No newline at end of file\n+  Real x=1;\n+end M;\n";
    assert_eq!((code, out.as_str()), (0, diff));
    assert_eq!(fs::read_to_string(here.path().join("a.mo")).unwrap(), UNTIDY);
    assert_eq!(gapi(&here, &["fmt", "a.mo"]).0, 0);
    assert_eq!(gapi(&here, &["fmt", "--check", "."]).0, 0);
}

/// The difference is what `patch` needs to make one text of the other.
#[test]
fn differences_apply() {
    use gapilib::internals::format::diff::changes;
    for (path, text, language) in texts(&project("tests/formatting")) {
        let formatted = format(SourceId::NONE, &text, language).expect("it can be read");
        let (old, new): (Vec<&str>, Vec<&str>) =
            (text.split_inclusive('\n').collect(), formatted.split_inclusive('\n').collect());
        let (mut made, mut at) = (String::new(), 0);
        for change in changes(&old, &new) {
            made.extend(old[at..change.old.start].iter().copied());
            made.extend(new[change.new.clone()].iter().copied());
            at = change.old.end;
        }
        made.extend(old[at..].iter().copied());
        assert_eq!(made, formatted, "{}", path.display());
    }
}

#[test]
fn standard_input_goes_to_standard_output() {
    let here = folder(&[]);
    for (arguments, text, expected) in [
        (&["fmt", "-"][..], UNTIDY, TIDY),
        (&["fmt", "-", "--stdin-name", "a.mos"][..], "x=1\nf( 2 )", "x = 1\nf(2)\n"),
        (&["fmt", "-"][..], "x=1", "x = 1\n"),
    ] {
        let mut command = command(here.path(), arguments);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success());
        assert_eq!(String::from_utf8(output.stdout).unwrap(), expected);
    }
}
