//! Whatever a script asks of a loaded package is answered: every function of every package is called,
//! those that packages inherit as well, and every replaceable element is redeclared in the string of
//! a problem. An error is an answer; a panic or an endless loop is not. `GAPILIB_MSL` names the
//! standard library, which is asked besides the shipped packages.

use crate::support::conformance::{
    Corpus, Ended, Failure, filter, folder, is_asked_for, judge_all, say,
};
use crate::support::shipped::project;
use gapilib::Session;
use gapilib::internals::flatten::Library;
use gapilib::internals::name::Name;
use gapilib::internals::script::models::checking;
use gapilib::internals::syntax::ast::{
    CausalityPrefix, ClassDefinition, ClassSpecifier, ComponentClause, Element, Restriction,
    Section, VariabilityPrefix,
};
use gapilib::world::MemoryWorld;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Seconds that all calls of one function, or all redeclarations in one class, may take.
const BUDGET: f64 = 300.0;

/// Arguments that are given to every function: numbers, vectors, matrices and strings.
const ARGUMENTS: [&str; 14] = [
    "",
    "0.5",
    "2",
    "{0.5, 0.25}",
    "[1, 0.5; 0.25, 2]",
    "\"a\"",
    "true",
    "0.5, 0.25",
    "1, 2, 3",
    "300, 400, 0.5, 1e5",
    "{0.5, 0.25}, {1, 2}",
    "[1, 0.5; 0.25, 2], {1, 2}",
    "[1, 0.5; 0.25, 2], [1, 2; 3, 4]",
    "\"a\", \"b\"",
];

/// A case: its name, and what the session is asked.
struct Case {
    name: String,
    asked: Vec<String>,
}

#[test]
fn every_function_answers() {
    let corpora = corpora();
    for corpus in &corpora {
        let mut cases = Vec::new();
        for name in corpus.library.all() {
            let Some(class) = corpus.library.definition(&name) else { continue };
            match class.restriction {
                Restriction::Function { .. } => cases.push(calls(&name, Some(&class))),
                Restriction::Package => {
                    let inherited = inherited_functions(&corpus.library, &name, &class);
                    cases.extend(inherited.iter().map(|name| calls(name, None)));
                }
                _ => {}
            }
        }
        let answered = ask(corpus, &cases, |session, call| {
            let before = session.run_text("before.mos", "").errors;
            session.run_text("call.mos", &format!("answer := {call};")).errors == before
        });
        // Many functions take none of these arguments: those of partial packages, of records.
        assert!(filter().is_some() || answered * 10 > cases.len(), "{answered} of {}", cases.len());
    }
}

#[test]
fn every_replaceable_element_is_redeclared() {
    let mut corpora = corpora();
    let here = tempfile::tempdir().expect("a folder");
    std::fs::write(here.path().join("Replaced.mo"), REPLACED).expect("a file");
    corpora.push(Corpus::load(here.path()));
    for corpus in &corpora {
        let classes = corpus.library.all().into_iter().filter_map(|name| {
            let class = corpus.library.definition(&name)?;
            let asked = redeclarations(&corpus.library, &name, &class);
            (!asked.is_empty()).then(|| Case { name: name.to_string(), asked })
        });
        let cases: Vec<Case> = classes.collect();
        let answered =
            ask(corpus, &cases, |session, problem| checking::flat_model(session, problem).is_ok());
        say(&format!("{answered} of {} classes have a redeclaration that fits", cases.len()));
    }
}

/// Replaceable elements of every kind.
const REPLACED: &str = include_str!("../../data/models/every_element_replaced.mo");

/// The shipped packages together, and the standard library if it is named.
fn corpora() -> Vec<Corpus> {
    let shipped = Corpus::load(&project("models"));
    std::iter::once(shipped)
        .chain(folder("GAPILIB_MSL").map(|root| Corpus::load(Path::new(&root))))
        .collect()
}

/// Asks a session of its own for every case; how many cases have an answer that is no error.
///
/// # Panics
/// If one panics or does not end in time.
fn ask(corpus: &Corpus, cases: &[Case], question: fn(&mut Session, &str) -> bool) -> usize {
    let cases: Vec<&Case> = cases.iter().filter(|case| is_asked_for(&case.name)).collect();
    let answered = Arc::new(AtomicUsize::new(0));
    let ended = judge_all(
        &cases,
        |case| {
            let (library, asked) = (corpus.library.clone(), case.asked.clone());
            let answered = answered.clone();
            Box::new(move |_| {
                let mut session = Session::new(Box::new(MemoryWorld::new()));
                *session.library() = (*library).clone();
                let good = asked.iter().filter(|text| question(&mut session, text)).count();
                answered.fetch_add(usize::from(good > 0), Ordering::Relaxed);
                Ok::<(), Failure>(())
            })
        },
        BUDGET,
    );
    let (count, answered) = (cases.len(), answered.load(Ordering::Relaxed));
    say(&format!("{count} cases, of which {answered} have an answer without error"));
    let wrong: Vec<String> = (cases.iter().zip(ended))
        .filter_map(|(case, ended)| match ended {
            Ended::Judged(_) => None,
            Ended::Panicked(_) => Some(format!("{} panics", case.name)),
            Ended::TimedOut(_) => Some(format!("{} does not end", case.name)),
        })
        .collect();
    assert!(wrong.is_empty(), "{} cases: {}", wrong.len(), wrong.join("\n"));
    answered
}

/// Calls of a function; with values of the declared types if it is known how it is declared.
fn calls(name: &Name, class: Option<&ClassDefinition>) -> Case {
    let typed = class.map(|class| {
        let inputs = clauses(class)
            .filter(|clause| clause.type_prefixes.causality == Some(CausalityPrefix::Input));
        let values = inputs.flat_map(|clause| {
            clause.components.iter().map(|component| {
                let dimensions = clause.subscripts.len() + component.subscripts.len();
                value(&clause.type_specifier.name.to_string(), dimensions)
            })
        });
        values.collect::<Vec<_>>().join(", ")
    });
    let arguments = ARGUMENTS.iter().map(|text| (*text).to_owned()).chain(typed);
    Case {
        name: name.to_string(),
        asked: arguments.map(|arguments| format!("{name}({arguments})")).collect(),
    }
}

/// A value of a type as Modelica text.
fn value(class: &str, dimensions: usize) -> String {
    let scalar = match class.rsplit('.').next().unwrap_or_default() {
        "Integer" => "2",
        "Boolean" => "true",
        "String" => "\"a\"",
        _ => "0.5",
    };
    (0..dimensions).fold(scalar.to_owned(), |entry, _| format!("{{{entry}, {entry}}}"))
}

/// The functions that a package has from those that it extends, by its own name.
fn inherited_functions(library: &Library, name: &Name, class: &ClassDefinition) -> Vec<Name> {
    let mut found = Vec::new();
    for base in bases(class).filter_map(|base| resolved(library, name, &base)) {
        for child in library.children(&base) {
            let function = base.child(child);
            let is_function = library
                .definition(&function)
                .is_some_and(|class| matches!(class.restriction, Restriction::Function { .. }));
            if is_function {
                found.push(name.child(child));
            }
        }
    }
    found
}

/// What a class extends, as it is written.
fn bases(class: &ClassDefinition) -> impl Iterator<Item = Name> {
    let short = match &class.specifier {
        ClassSpecifier::Short(short) => Some(short.target.name.clone()),
        _ => None,
    };
    let written = elements(class).filter_map(|element| match element {
        Element::Extends(extends) => Some(extends.base.name.clone()),
        _ => None,
    });
    short.into_iter().chain(written)
}

/// A name as a class or one of those around it sees it.
fn resolved(library: &Library, scope: &Name, name: &Name) -> Option<Name> {
    let mut around = scope.clone();
    while !around.parts.is_empty() {
        let found = name.parts.iter().fold(around.clone(), |name, part| name.child(*part));
        if library.contains(&found) {
            return Some(found);
        }
        around = around.parent();
    }
    library.contains(name).then(|| name.clone())
}

/// Problems that redeclare what is replaceable in a class: as what it is, as something that fits
/// by name only, as the class itself, and as nothing that exists.
fn redeclarations(library: &Library, name: &Name, class: &ClassDefinition) -> Vec<String> {
    let mut asked = Vec::new();
    let targets = |base: &Name| {
        let itself = resolved(library, name, base).unwrap_or_else(|| base.clone());
        [
            itself.to_string(),
            base.to_string(),
            name.to_string(),
            "No.Such.Class".to_owned(),
            "Real".to_owned(),
        ]
    };
    for element in elements(class) {
        match element {
            Element::Class(inner) if inner.prefixes.replaceable => {
                let own = inner.class.name.node;
                let keyword = keyword(inner.class.restriction);
                let of = match &inner.class.specifier {
                    ClassSpecifier::Short(short) => short.target.name.clone(),
                    _ => name.child(own),
                };
                for target in targets(&of) {
                    asked.push(format!("{name}(redeclare {keyword} {own} = {target})"));
                    asked.push(format!("{name}(redeclare package {own} = {target})"));
                }
                asked.push(format!("{name}({own}(x = 1))"));
                asked.push(format!("{name}({own} = 1)"));
            }
            Element::Component(clause) if clause.prefixes.replaceable => {
                let prefix = match clause.type_prefixes.variability {
                    Some(VariabilityPrefix::Parameter) => "parameter ",
                    Some(VariabilityPrefix::Constant) => "constant ",
                    _ => "",
                };
                for component in &clause.components {
                    let own = component.name.node;
                    for target in targets(&clause.type_specifier.name) {
                        asked.push(format!("{name}(redeclare {prefix}{target} {own})"));
                        asked.push(format!("{name}(redeclare {target} {own}[2](x = 1))"));
                    }
                    asked.push(format!("{name}({own} = 1)"));
                }
            }
            _ => {}
        }
    }
    asked
}

fn keyword(restriction: Restriction) -> &'static str {
    match restriction {
        Restriction::Function { .. } => "function",
        Restriction::Package => "package",
        Restriction::Record => "record",
        Restriction::Type => "type",
        Restriction::Connector => "connector",
        Restriction::Block => "block",
        _ => "model",
    }
}

fn clauses(class: &ClassDefinition) -> impl Iterator<Item = &ComponentClause> {
    elements(class).filter_map(|element| match element {
        Element::Component(clause) => Some(clause),
        _ => None,
    })
}

fn elements(class: &ClassDefinition) -> impl Iterator<Item = &Element> {
    let sections = match &class.specifier {
        ClassSpecifier::Long(long) => Some(long.sections.iter()),
        _ => None,
    };
    sections.into_iter().flatten().flat_map(|section| match section {
        Section::Elements { elements, .. } => elements.as_slice(),
        _ => &[],
    })
}
