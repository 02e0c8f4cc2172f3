//! `tests/checking/*.mo`: what is wrong with each class of a file by its text and the names in it,
//! whatever is made of it.

use gapilib::internals::diag::render::render;
use gapilib::internals::flatten::{Library, check};
use gapilib::internals::source::{SourceMap, Span};
use gapilib::internals::syntax::ast::{
    ClassDefinition, ClassSpecifier, ComponentReference, Element, Modification, Section,
    StoredDefinition,
};
use gapilib::internals::syntax::parse_stored_definition;
use gapilib::internals::syntax::visit::{self, Visit};
use std::path::{Path, PathBuf};

fn parsed(sources: &SourceMap, name: &str, text: &str) -> StoredDefinition {
    parse_stored_definition(sources.add(name, text), text).expect("Modelica")
}

fn library(file: &StoredDefinition) -> Library {
    let mut library = Library::new();
    library.load(file).expect("a loadable file");
    library
}

/// The errors of all classes of a text.
fn errors(library: &Library, sources: &SourceMap) -> Vec<String> {
    let all = library.all().into_iter().flat_map(|class| check(library, &class));
    all.map(|error| render(&error, sources, false)).collect()
}

#[test]
fn corpus() {
    insta::glob!("../../checking", "*.mo", |path| {
        insta::with_settings!({
            snapshot_path => path.parent().expect("a folder"),
            prepend_module_to_snapshot => false,
            snapshot_suffix => "",
            omit_expression => true,
        }, {
            let stem = path.file_stem().expect("a file name").to_string_lossy().into_owned();
            let text = std::fs::read_to_string(path).expect("a readable file");
            let sources = SourceMap::default();
            let file = parsed(&sources, &format!("{stem}.mo"), &text);
            let found = errors(&library(&file), &sources);
            insta::assert_snapshot!(stem, found.join("\n"));
        });
    });
}

/// Models of one file that are simulated elsewhere in these tests.
fn right_models() -> Vec<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let folders = ["simulation", "structure"].map(|folder| here.join(folder));
    let entries = folders.iter().flat_map(|folder| std::fs::read_dir(folder).expect("a folder"));
    let mut found: Vec<PathBuf> = entries
        .map(|entry| entry.expect("a readable entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "mo"))
        .collect();
    found.sort();
    found
}

#[test]
fn models_that_are_simulated_have_no_unknown_names() {
    for path in right_models() {
        let text = std::fs::read_to_string(&path).expect("a readable file");
        let sources = SourceMap::default();
        let library = library(&parsed(&sources, &path.display().to_string(), &text));
        let all = library.all().into_iter().flat_map(|class| check(&library, &class));
        let wrong: Vec<String> =
            all.filter(|one| one.is_error()).map(|error| render(&error, &sources, false)).collect();
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}

/// The places of the first names of all references in a class and those in it.
#[derive(Default)]
struct Places(Vec<Span>);

impl Visit for Places {
    fn reference(&mut self, reference: &ComponentReference) {
        self.0.push(reference.span);
        visit::walk_reference(self, reference);
    }
}

impl Places {
    fn class(&mut self, class: &ClassDefinition) {
        let ClassSpecifier::Long(long) = &class.specifier else { return };
        for section in &long.sections {
            match section {
                Section::Elements { elements, .. } => {
                    elements.iter().for_each(|element| self.element(element));
                }
                Section::Equations { equations, .. } => {
                    equations.iter().for_each(|one| self.equation(one));
                }
                Section::Algorithm { statements, .. } => {
                    statements.iter().for_each(|one| self.statement(one));
                }
                _ => {}
            }
        }
    }

    fn element(&mut self, element: &Element) {
        match element {
            Element::Class(nested) => self.class(&nested.class),
            Element::Extends(extends) => {
                self.0.push(extends.base.span);
                let (arguments, span) = (extends.modification.clone(), extends.span);
                let modification = Modification { arguments, binding: None, span };
                visit::walk_modification(self, &modification);
            }
            Element::Component(clause) => {
                self.0.push(clause.type_specifier.span);
                for component in &clause.components {
                    let modification = component.modification.iter();
                    modification.for_each(|one| visit::walk_modification(self, one));
                    component.condition.iter().for_each(|one| self.expression(one));
                }
            }
            Element::Import(_) => {}
        }
    }
}

/// Every name of the models, one after the other, replaced by one that nothing declares.
#[test]
fn every_wrong_name_is_found() {
    let unknown = "thisIsNotDeclared";
    let (mut tried, mut missed) = (0, Vec::new());
    for path in right_models() {
        let text = std::fs::read_to_string(&path).expect("a readable file");
        let sources = SourceMap::default();
        let mut places = Places::default();
        let file = parsed(&sources, "right.mo", &text);
        file.classes.iter().for_each(|class| places.class(class));
        for place in places.0 {
            let (start, end) = (place.start as usize, place.end as usize);
            let first = text[start..end].split(['.', '[', '(', ' ']).next().unwrap_or_default();
            if first.is_empty() {
                continue;
            }
            tried += 1;
            let wrong = format!("{}{unknown}{}", &text[..start], &text[start + first.len()..]);
            let sources = SourceMap::default();
            let Ok(file) = parse_stored_definition(sources.add("wrong.mo", &*wrong), &wrong) else {
                continue;
            };
            let found = errors(&library(&file), &sources);
            if !found.iter().any(|error| error.contains(unknown)) {
                missed.push(format!("{}: `{first}` at {start}", path.display()));
            }
        }
    }
    assert!(tried > 600, "{tried} names");
    assert!(missed.is_empty(), "{tried} names, not found:\n{}", missed.join("\n"));
}
