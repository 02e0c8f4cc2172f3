//! Words that messages, help, README and guide do not use, each with the term of the field that
//! takes its place; and those that must disappear from identifiers and comments as well.

use crate::support::shipped::project;
use proc_macro2::{TokenStream, TokenTree};
use std::cmp::Ordering;
use std::fs;
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};
use syn::{Attribute, ItemFn, ItemMod, Lit, LitStr, Macro};

/// A phrase, what to use instead, and how often it occurs.
type Word = (&'static str, &'static str, usize);

/// What must not come back, with what to use instead and how often `src` still has it in identifiers
/// and comments. The counts only fall.
const GONE: &[Word] = &[
    ("told", "reported, given, shown", 4),
    ("slope of", "derivative of", 0),
    ("slopes", "derivatives, Jacobian entries", 2),
    ("carried out", "executed, evaluated", 0),
    ("cannot stand", "is not allowed, cannot be mixed", 0),
    ("stand in", "are in, are allowed in", 1),
    ("stands in", "is in, belongs to", 2),
    ("stands behind", "follows", 1),
    ("stands before", "precedes", 0),
    ("may stand", "is allowed", 0),
    ("take it away", "remove it", 0),
    ("nobody", "no one is a person here: name the cause", 0),
    ("goes on", "continues", 18),
    ("went on", "continued", 0),
    ("comes back", "returns", 1),
    ("anew", "again", 12),
    ("came upon", "found", 0),
    ("of one's own", "user-defined, your own", 0),
    ("function of yours", "your own function", 0),
    ("has not as many", "has different numbers of", 0),
    ("hardly told apart", "strongly correlated", 0),
    ("data leave open", "not identifiable from the data", 1),
    ("shaped the", "structural parameter", 0),
    ("behind", "after, past, following", 2),
    ("settled", "evaluated", 8),
    ("held unknowns", "tearing variables", 0),
    ("lagged", "value of the previous iterate", 0),
    ("culprit", "offending variable", 0),
    ("inseparable", "structurally non-identifiable", 1),
    ("comprehension", "array constructor with iterators", 0),
    ("deselection", "selective model extension", 0),
    ("habits", "legacy constructs", 1),
    ("wishes", "simulation options", 0),
    ("two-faced", "inside and outside connector", 0),
    ("texts", "strings", 0),
    ("change places", "are exchanged", 0),
    ("new blood", "immigrants", 0),
    ("fitted anew", "refitted", 0),
    ("is taken to be", "is interpreted as", 0),
    ("leave it out", "remove it, omit it", 0),
    ("looks into", "accesses", 0),
    ("points in time", "time points", 0),
    ("gapi lets it", "gapi permits", 0),
    ("step became too small", "step size became too small", 0),
    ("which is no", "which is not a", 0),
    ("this is no", "this is not a", 0),
    ("equations of texts", "equations of Strings", 0),
    ("turns of a loop", "iterations", 0),
    ("into a folder of its own", "a separate folder", 0),
    ("file of its own", "a separate file", 0),
    ("go on where", "continue where", 0),
    ("gives no number", "does not return a number", 0),
    ("a text stands", "expected a number, got a String", 0),
];

/// Words of which the guide may have the usual sense: a slope of a line, what readers want.
const GONE_FROM_SOURCES: &[Word] = &[
    ("slope", "derivative, Jacobian entry, rate; the slope of a line", 60),
    ("turns", "iterations, passes, rotates", 10),
    ("restless", "inconsistent", 0),
    ("somebody", "another user, another program, the caller", 0),
    ("whoever", "the user, the caller, the host", 0),
    ("want", "request, require, expect", 0),
    ("wants", "needs, requires, expects", 0),
    ("wanted", "requested, required, expected, target", 0),
];

/// Finds string literals, also in the arguments of macros; not those of tests and comments.
#[derive(Default)]
struct Literals {
    found: Vec<(usize, String)>,
}

impl Literals {
    fn tokens(&mut self, tokens: TokenStream) {
        // Comments for documentation in the arguments of a macro.
        let mut first = tokens.clone().into_iter();
        if matches!(first.next(), Some(TokenTree::Ident(name)) if name == "doc") {
            return;
        }
        for tree in tokens {
            match tree {
                TokenTree::Group(group) => self.tokens(group.stream()),
                TokenTree::Literal(literal) => {
                    if let Lit::Str(text) = Lit::new(literal) {
                        self.visit_lit_str(&text);
                    }
                }
                TokenTree::Ident(_) | TokenTree::Punct(_) => {}
            }
        }
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    let of_tests = |attribute: &Attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg")
                && attribute.meta.require_list().is_ok_and(|list| list.tokens.to_string() == "test")
    };
    attributes.iter().any(of_tests)
}

impl<'ast> Visit<'ast> for Literals {
    fn visit_lit_str(&mut self, text: &'ast LitStr) {
        self.found.push((text.span().start().line, text.value()));
    }
    fn visit_macro(&mut self, call: &'ast Macro) {
        self.tokens(call.tokens.clone());
    }
    fn visit_attribute(&mut self, attribute: &'ast Attribute) {
        if !attribute.path().is_ident("doc") {
            visit::visit_attribute(self, attribute);
        }
    }
    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        if !is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }
    fn visit_item_fn(&mut self, function: &'ast ItemFn) {
        if !is_test(&function.attrs) {
            visit::visit_item_fn(self, function);
        }
    }
}

/// Files below a folder that end so.
fn files(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            files(&path, ending, found);
        } else if path.to_string_lossy().ends_with(ending) {
            found.push(path);
        }
    }
}

/// Whether a source consists of tests.
fn holds_tests(path: &Path) -> bool {
    path.components().any(|part| part.as_os_str() == "tests")
        || path.to_string_lossy().ends_with("tests.rs")
}

/// The line within a text in which a phrase stands as whole words, from 0.
fn line_of(phrase: &str, text: &str) -> Option<usize> {
    let lower = text.to_lowercase();
    let is_word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '`');
    let mut places = lower.match_indices(phrase);
    let (place, _) = places.find(|(place, _)| {
        !is_word(lower[..*place].chars().next_back())
            && !is_word(lower[place + phrase.len()..].chars().next())
    })?;
    Some(lower[..place].matches('\n').count())
}

#[test]
fn words_that_are_gone_do_not_come_back() {
    let mut texts = Vec::new();
    let mut sources = Vec::new();
    files(&project("src"), ".rs", &mut sources);
    assert!(sources.len() > 100, "the sources were not found");
    let root = project("src");
    let own = |path: &PathBuf| !holds_tests(path.strip_prefix(&root).unwrap_or(path));
    for path in sources.into_iter().filter(own) {
        let source = fs::read_to_string(&path).unwrap();
        let mut literals = Literals::default();
        let file = syn::parse_file(&source).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        literals.visit_file(&file);
        texts.extend(literals.found.into_iter().map(|(line, text)| (path.clone(), line, text)));
    }
    assert!(texts.len() > 5000, "the messages were not found: {}", texts.len());
    let mut chapters = vec![project("README.md")];
    files(&project("docs/src"), ".md", &mut chapters);
    assert!(chapters.len() > 10, "the guide was not found");
    for path in chapters {
        let text = fs::read_to_string(&path).unwrap();
        texts.push((path, 1, text));
    }
    let mut wrong = Vec::new();
    for (path, line, text) in &texts {
        for (phrase, instead, _) in GONE {
            if let Some(below) = line_of(phrase, text) {
                let line = line + below;
                wrong.push(format!("{}:{line}: `{phrase}`: use {instead}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The words of a source in lower case, with their lines from 1: identifiers are divided at
/// underscores and capitals.
fn words(source: &str) -> Vec<(usize, String)> {
    let mut found: Vec<(usize, String)> = Vec::new();
    for (line, text) in (1..).zip(source.lines()) {
        let mut before = ' ';
        for c in text.chars() {
            let begins = !before.is_alphabetic() || before.is_lowercase() && c.is_uppercase();
            match found.last_mut() {
                Some((_, word)) if c.is_alphabetic() && !begins => word.extend(c.to_lowercase()),
                _ if c.is_alphabetic() => found.push((line, c.to_lowercase().collect())),
                _ => {}
            }
            before = c;
        }
    }
    found
}

/// The lines on which a phrase begins.
fn lines_of<'w>(phrase: &str, words: &'w [(usize, String)]) -> impl Iterator<Item = usize> + 'w {
    let phrase: Vec<String> = self::words(phrase).into_iter().map(|(_, word)| word).collect();
    let length = phrase.len();
    let same = move |window: &&[(usize, String)]| window.iter().map(|(_, word)| word).eq(&phrase);
    words.windows(length).filter(same).map(|window| window[0].0)
}

#[test]
fn words_disappear_from_identifiers_and_comments() {
    let mut sources = Vec::new();
    files(&project("src"), ".rs", &mut sources);
    assert!(sources.len() > 100, "the sources were not found");
    let read = |path: PathBuf| {
        let source = fs::read_to_string(&path).unwrap();
        (path, words(&source))
    };
    let sources: Vec<_> = sources.into_iter().map(read).collect();
    let mut wrong = Vec::new();
    for (phrase, instead, most) in GONE.iter().chain(GONE_FROM_SOURCES) {
        let places = sources.iter().flat_map(|(path, words)| {
            lines_of(phrase, words).map(|line| format!("{}:{line}", path.display()))
        });
        let places: Vec<String> = places.collect();
        match places.len().cmp(most) {
            Ordering::Greater => wrong.push(format!(
                "`{phrase}` occurs {} times, at most {most} are allowed: use {instead}\n    {}",
                places.len(),
                places.join("\n    ")
            )),
            Ordering::Less => {
                wrong.push(format!("`{phrase}` occurs {} times: lower its count", places.len()));
            }
            Ordering::Equal => {}
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn identifiers_are_divided_into_words() {
    let source = "fn wants_view(RunTimeTexts, MAX_TURNS) // Nobody's\ncarried out carried\nout";
    let words = words(source);
    let lines = |phrase| lines_of(phrase, &words).collect::<Vec<usize>>();
    assert_eq!(["wants", "texts", "turns", "nobody"].map(lines), [[1], [1], [1], [1]]);
    assert_eq!(lines("carried out"), [2, 2]);
    assert!(lines("want").is_empty());
}

#[test]
fn whole_words_are_found() {
    assert_eq!(line_of("is told", "a\nwhat Is told."), Some(1));
    assert_eq!(line_of("told", "retold and `told`"), None);
}
