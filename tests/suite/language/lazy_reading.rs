//! A file read class by class gives the tree of a file read at once.

use gapilib::internals::source::{SourceId, Spanned};
use gapilib::internals::syntax::ast::{ClassDefinition, ClassSpecifier, Element, Section};
use gapilib::internals::syntax::{self, Outline};
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Every `.mo` file below the folder, in order.
fn modelica_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut pending = vec![folder.to_path_buf()];
    while let Some(folder) = pending.pop() {
        for entry in std::fs::read_dir(folder).expect("the folder is readable") {
            let path = entry.expect("the entry is readable").path();
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|extension| extension == "mo") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The files of the project, and those of the folder that `GAPILIB_MSL` names.
#[allow(clippy::print_stderr, reason = "a test that is skipped in part has to say so")]
fn corpora() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = modelica_files(&root.join("models"));
    files.extend(modelica_files(&root.join("tests")));
    match std::env::var_os("GAPILIB_MSL") {
        Some(folder) => files.extend(modelica_files(Path::new(&folder))),
        None => eprintln!("skipped in part: GAPILIB_MSL names no local library"),
    }
    let read = |path: PathBuf| {
        let content = std::fs::read(&path).expect("the file is readable");
        (path, syntax::decode(&content).0)
    };
    files.into_iter().map(read).collect()
}

/// The classes of a tree as an outline has them: place of the name, and whether it is a long one.
fn classes(class: &ClassDefinition, found: &mut Vec<(usize, usize, bool)>) {
    let Spanned { span, .. } = class.name;
    let long = match &class.specifier {
        ClassSpecifier::Long(long) => Some(long),
        _ => None,
    };
    found.push((span.start as usize, span.end as usize, long.is_some()));
    for section in long.iter().flat_map(|long| &long.sections) {
        let Section::Elements { elements, .. } = section else { continue };
        for element in elements {
            if let Element::Class(nested) = element {
                classes(&nested.class, found);
            }
        }
    }
}

/// What is wrong with the outline or the lazy reading of a text that the parser accepts.
fn difference(text: &str) -> Option<String> {
    let text: Arc<str> = text.into();
    let whole = syntax::parse_stored_definition(SourceId(0), &text).ok()?;
    let mut expected = Vec::new();
    whole.classes.iter().for_each(|class| classes(class, &mut expected));
    let Some(outline) = Outline::of(&text) else { return Some("no outline".to_owned()) };
    let found: Vec<(usize, usize, bool)> = outline
        .classes
        .iter()
        .map(|class| (class.name.start, class.name.end, class.body.is_some()))
        .collect();
    if found != expected {
        return Some(format!("outlined {found:?}, parsed {expected:?}"));
    }
    match syntax::parse_stored_definition_lazily(SourceId(0), &text) {
        Ok(lazy) if lazy == whole => None,
        Ok(lazy) => Some(format!("another tree: {lazy:?}")),
        Err(error) => Some(format!("refused: {}", error.message)),
    }
}

#[test]
fn outlines_and_lazy_trees_equal_the_parsers() {
    let wrong: Vec<String> = corpora()
        .into_iter()
        .filter_map(|(path, text)| Some(format!("{}: {}", path.display(), difference(&text)?)))
        .collect();
    assert!(wrong.is_empty(), "{} files:\n{}", wrong.len(), wrong.join("\n"));
}

/// Pieces that a text of classes is put together from.
const PIECES: &[&str] = &[
    "model M ",
    "end M;",
    "package 'a b' ",
    "end 'a b';",
    "type T = Real(min = 1);",
    "\"end M; model\"",
    "// model X\n",
    "/* end M; */",
    "(",
    ")",
    "x = y[end];",
    "equation ",
    "if a then ",
    "end if;",
    "function f = der(g, x);",
    "type E = enumeration(a, b);",
    "redeclare model extends M ",
    "(p = 1)",
    "replaceable ",
    "annotation(x = \"\\\"(\");",
    "operator record R ",
    "end R;",
    "operator function ",
    "encapsulated partial ",
    "Real x;",
    "extends ",
    "connector M = input Real;",
    "constrainedby M",
    "'",
    "\"",
    "+",
    "within P;",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// What is put together at random is seldom Modelica: it shows that nothing panics, and that
    /// what the parser refuses is refused lazily too.
    #[test]
    fn arbitrary_texts_are_read_or_refused(pieces in prop::collection::vec(prop::sample::select(PIECES), 0..40)) {
        let text: Arc<str> = pieces.concat().into();
        prop_assert_eq!(difference(&text), None);
        let whole = syntax::parse_stored_definition(SourceId(0), &text);
        if let (Err(_), Ok(lazy)) = (whole, syntax::parse_stored_definition_lazily(SourceId(0), &text)) {
            prop_assert!(lazy.classes.iter().any(|class| has_error(class)), "{text} was accepted");
        }
    }
}

/// Whether a class or one in it could not be read.
fn has_error(class: &ClassDefinition) -> bool {
    let ClassSpecifier::Long(long) = &class.specifier else { return false };
    let nested = |section: &Section| match section {
        Section::Elements { elements, .. } => elements.iter().any(|element| match element {
            Element::Class(nested) => has_error(&nested.class),
            _ => false,
        }),
        _ => false,
    };
    long.sections.error().is_some() || long.sections.iter().any(nested)
}

/// An error in a class is told at its place in the file, by the class that needs it alone.
#[test]
fn errors_have_their_place_in_the_file() {
    let text: Arc<str> =
        "package P\n  model A \"a\" Real x end A;\n  model B Real y; end B;\nend P;".into();
    let file = syntax::parse_stored_definition_lazily(SourceId(0), &text).expect("the heads fit");
    let ClassSpecifier::Long(package) = &file.classes[0].specifier else { panic!("P is long") };
    assert_eq!(package.sections.error(), None);
    let Section::Elements { elements, .. } = &package.sections[0] else { panic!("two classes") };
    let errors = elements.iter().map(|element| {
        let Element::Class(nested) = element else { panic!("a class") };
        let ClassSpecifier::Long(long) = &nested.class.specifier else { panic!("a long one") };
        long.sections.error().map(|error| (error.code.slug, error.labels[0].span.start as usize))
    });
    let place = text.find(" end A").expect("it is there");
    assert_eq!(errors.collect::<Vec<_>>(), [Some(("missing-semicolon", place)), None]);
}
