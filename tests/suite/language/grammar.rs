//! The grammar: corpora with their trees and errors, printing and reading again.

use crate::support::shipped::project;
use gapilib::Diagnostic;
use gapilib::internals::diag::render::render;
use gapilib::internals::source::{SourceId, SourceMap};
use gapilib::internals::syntax::ast::{
    InteractiveKind, InteractiveStatement, Script, StoredDefinition,
};
use gapilib::internals::syntax::visit::{WithoutSpans, rewrite_script, rewrite_stored_definition};
use gapilib::internals::syntax::{self, is_keyword, keywords, print};
use regex::Regex;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Every `.mo` file below the folder.
fn modelica_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the folder is readable") {
        let path = entry.expect("the entry is readable").path();
        if path.is_dir() {
            modelica_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "mo") {
            found.push(path);
        }
    }
}

/// What a text is read as.
#[derive(Debug, PartialEq)]
enum Tree {
    Classes(StoredDefinition),
    Script(Script),
}

impl Tree {
    fn parse(source: SourceId, text: &str, is_script: bool) -> Result<Tree, Diagnostic> {
        if is_script {
            syntax::parse_script(source, text).map(Tree::Script)
        } else {
            syntax::parse_stored_definition(source, text).map(Tree::Classes)
        }
    }

    fn printed(&self) -> String {
        match self {
            Tree::Classes(definition) => print::stored_definition(definition),
            Tree::Script(script) => print::script(script),
        }
    }

    fn without_spans(mut self) -> Tree {
        match &mut self {
            Tree::Classes(definition) => rewrite_stored_definition(&mut WithoutSpans, definition),
            Tree::Script(script) => rewrite_script(&mut WithoutSpans, script),
        }
        self
    }

    /// What is wrong if the printed text does not read back as the same tree.
    fn reads_back_differently(self) -> Option<String> {
        let text = self.printed();
        let sources = SourceMap::default();
        let source = sources.add("printed", text.as_str());
        let again = match Tree::parse(source, &text, matches!(self, Tree::Script(_))) {
            Ok(again) => again,
            Err(error) => return Some(render(&error, &sources, false)),
        };
        let same = self.without_spans() == again.without_spans();
        (!same).then(|| format!("another tree:\n{text}"))
    }
}

/// Reads a file of a corpus under its own name.
fn parse(path: &Path) -> (SourceMap, Result<Tree, Diagnostic>) {
    let content = std::fs::read(path).expect("the file is readable");
    let (text, _) = syntax::decode(&content);
    let sources = SourceMap::default();
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let source = sources.add(name.as_ref(), text.as_str());
    let is_script = path.extension().is_some_and(|extension| extension == "mos");
    (sources, Tree::parse(source, &text, is_script))
}

/// Asserts a snapshot that lies beside the file and has its name.
fn assert_beside(path: &Path, content: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(path.parent().expect("a file lies in a folder"));
    settings.set_prepend_module_to_snapshot(false);
    settings.remove_snapshot_suffix();
    settings.set_omit_expression(true);
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    settings.bind(|| insta::assert_snapshot!(name.as_ref(), content));
}

/// One line per statement of a script: its form and whether a semicolon ends it.
fn forms(script: &Script) -> String {
    let form = |statement: &InteractiveStatement| match &statement.kind {
        InteractiveKind::Statement(_) => "statement",
        InteractiveKind::Expression(_) => "expression",
        InteractiveKind::Declaration(_) => "declaration",
        InteractiveKind::Class(_) => "class",
        InteractiveKind::Import(_) => "import",
        InteractiveKind::Command { .. } => "command",
    };
    let end = |statement: &InteractiveStatement| if statement.semicolon { ";" } else { "" };
    script.statements.iter().map(|one| format!("{}{}\n", form(one), end(one))).collect()
}

/// The texts of the local library that `GAPILIB_MODELICA_LIBRARY` names; `None`, and a word about
/// it, where it is not set.
#[allow(clippy::print_stderr, reason = "a test that is skipped has to say so")]
fn local_library() -> Option<Vec<(PathBuf, String)>> {
    let Some(folder) = std::env::var_os("GAPILIB_MODELICA_LIBRARY") else {
        eprintln!("skipped: GAPILIB_MODELICA_LIBRARY names no local library");
        return None;
    };
    let mut files = Vec::new();
    modelica_files(Path::new(&folder), &mut files);
    files.sort();
    let read = |path: PathBuf| {
        let content = std::fs::read(&path).expect("the file is readable");
        (path, syntax::decode(&content).0)
    };
    Some(files.into_iter().map(read).collect())
}

#[test]
fn local_library_reads_back() {
    let mut failures = Vec::new();
    for (path, text) in local_library().unwrap_or_default() {
        let sources = SourceMap::default();
        let source = sources.add(path.display().to_string(), text.as_str());
        match Tree::parse(source, &text, false) {
            Ok(tree) => failures.extend(tree.reads_back_differently()),
            // The compliance library marks the models that a tool must refuse.
            Err(_) if text.contains("shouldPass = false") => {}
            Err(error) => failures.push(render(&error, &sources, false)),
        }
    }
    assert!(failures.is_empty(), "{} texts:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn shipped_models_read_back() {
    for path in crate::support::shipped::files("models", "mo") {
        let (sources, answer) = parse(&path);
        let tree = answer.unwrap_or_else(|error| panic!("{}", render(&error, &sources, false)));
        assert_eq!(tree.reads_back_differently(), None, "{}", path.display());
    }
}

/// Megabytes a second; run with `--release -- --ignored --nocapture`.
#[test]
#[ignore = "measures, and asserts nothing but that every text is read"]
#[allow(clippy::print_stderr, reason = "the measurement is the result")]
fn local_library_speed() {
    let texts = local_library().unwrap_or_default();
    let bytes: usize = texts.iter().map(|(_, text)| text.len()).sum();
    let start = std::time::Instant::now();
    let read = texts.iter().filter(|(_, text)| Tree::parse(SourceId::NONE, text, false).is_ok());
    let read = read.count();
    let seconds = start.elapsed().as_secs_f64();
    let megabytes = bytes as f64 / 1e6;
    eprintln!("{read} files, {megabytes:.2} MB, {seconds:.2} s, {:.1} MB/s", megabytes / seconds);
    assert_eq!(read, texts.len());
}

/// The first error of each text in `invalid/`, as the user sees it.
#[test]
fn invalid_texts_name_place_and_remedy() {
    insta::glob!("../../grammar/invalid", "*.{mo,mos}", |path| {
        let (sources, answer) = parse(path);
        let error = answer.expect_err("the text is invalid");
        assert_beside(path, &render(&error, &sources, false));
    });
}

/// The tree of each text in `valid/`, printed; of a script also the form of its statements.
#[test]
fn valid_texts_have_these_trees() {
    insta::glob!("../../grammar/valid", "*.{mo,mos}", |path| {
        let (sources, answer) = parse(path);
        let tree = answer.unwrap_or_else(|error| panic!("{}", render(&error, &sources, false)));
        let printed = tree.printed();
        let shown = match &tree {
            Tree::Classes(_) => printed,
            Tree::Script(script) => format!("{printed}\n{}", forms(script)),
        };
        assert_eq!(tree.reads_back_differently(), None);
        assert_beside(path, &shown);
    });
}

/// The words that a pattern finds in a text.
fn words_in(pattern: &str, text: &str) -> BTreeSet<String> {
    let pattern = Regex::new(pattern).unwrap();
    pattern.captures_iter(text).map(|found| found[1].to_owned()).collect()
}

/// The words of the grammar's rule, which share their beginnings: `"e" ~ ("ach" | "nd")`.
fn keywords_of_the_grammar() -> BTreeSet<String> {
    let grammar = std::fs::read_to_string(project("grammar/lexical.pest")).unwrap();
    let begin = grammar.find("keyword_to_f = ").unwrap();
    let rules = &grammar[begin..grammar.find("kw_algorithm").unwrap()];
    let shared = Regex::new(r#""([a-z]+)"\s*~\s*\(([^)]*)\)"#).unwrap();
    let word = r#""([a-z]+)""#;
    let begun = shared.captures_iter(rules).flat_map(|found| {
        let ends = words_in(word, &found[2]).into_iter();
        ends.map(|end| format!("{}{end}", &found[1])).collect::<Vec<String>>()
    });
    begun.chain(words_in(word, &shared.replace_all(rules, ""))).collect()
}

/// One table of keywords: what the grammar and the modes of the editors spell for themselves is equal.
#[test]
fn keywords_are_the_same_everywhere() {
    let all: BTreeSet<String> = keywords().map(str::to_owned).collect();
    assert_eq!(keywords_of_the_grammar(), all);
    assert!(all.iter().all(|word| is_keyword(word)) && !is_keyword("elsewhere"));
    let read = |file: &str| std::fs::read_to_string(project(file)).unwrap();
    let emacs = read("editors/emacs/gapilib.el");
    let begin = emacs.find("(defconst gapilib-keywords").unwrap();
    let list = emacs[begin..].split("))").next().unwrap();
    assert_eq!(words_in(r#""([a-z]+)""#, list), all, "editors/emacs/gapilib.el");
    let vscode = read("editors/vscode/syntaxes/modelica.tmLanguage.json");
    let groups = words_in(r"\(\?:([A-Za-z0-9_|]+)\)", &vscode);
    let coloured = groups.iter().flat_map(|group| group.split('|')).map(str::to_owned).collect();
    let missing: Vec<&String> = all.difference(&coloured).collect();
    assert!(missing.is_empty(), "editors/vscode: {missing:?}");
}
