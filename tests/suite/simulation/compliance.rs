//! The cases of the Modelica Association's compliance library, from the folder that
//! `GAPILIB_COMPLIANCE` names. A case that should pass is right if it is translated and simulated;
//! one that should fail, if it is rejected at any stage for another reason than a missing feature.

use crate::support::conformance::{
    Corpus, Ended, Failure, File, Ledger, Stage, folder, is_asked_for, judge_all, run, say,
};
use crate::support::program;
use gapilib::Diagnostic;
use gapilib::internals::external::errors::EXTERNAL_OUTSIDE;
use gapilib::internals::flatten::errors::NOT_SUPPORTED as UNSUPPORTED_LANGUAGE;
use gapilib::internals::lower::errors::NOT_SUPPORTED;
use gapilib::internals::name::Name;
use gapilib::internals::syntax::ast::{
    Annotation, Argument, Binding, ClassDefinition, ClassSpecifier, Element, ElementModification,
    ExpressionKind, Section,
};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Seconds that a case may take.
const BUDGET: f64 = 20.0;

/// The sections of the specification that the folders of the library are about, by the beginning
/// of the names of the cases; the longest one counts.
const SECTIONS: &[(&str, &str)] = &[
    ("Algorithms", "11 Statements and algorithm sections"),
    ("Annotations", "18 Annotations"),
    ("Arrays", "10 Arrays"),
    ("Arrays.Flexible", "12 Functions"),
    ("Classes", "4 Classes, predefined types and declarations"),
    ("Components", "4 Classes, predefined types and declarations"),
    ("Components.Time", "3 Operators and expressions"),
    ("Components.Variability", "3 Operators and expressions"),
    ("Connections", "9 Connectors and connections"),
    ("Connections.Stream", "15 Stream connectors"),
    ("Equations", "8 Equations"),
    ("Functions", "12 Functions"),
    ("Inheritance", "7 Inheritance, modification and redeclaration"),
    ("Modification", "7 Inheritance, modification and redeclaration"),
    ("Operators", "3 Operators and expressions"),
    ("Operators.Overloading", "14 Overloaded operators"),
    ("Packages", "13 Packages"),
    ("Redeclare", "7 Inheritance, modification and redeclaration"),
    ("Scoping", "5 Scoping, name lookup and flattening"),
    ("Scoping.NameLookup.Imports", "13 Packages"),
    ("Scoping.Visibility", "4 Classes, predefined types and declarations"),
    ("Template", "4 Classes, predefined types and declarations"),
];

struct Case {
    /// Name of its file below the library's folder.
    name: String,
    /// Its class, if the file could be loaded.
    class: Result<Name, Diagnostic>,
    should_pass: bool,
}

#[test]
fn compliance_cases_are_judged_right() {
    let Some(root) = folder("GAPILIB_COMPLIANCE") else { return };
    let mut corpus = Corpus::load(&root);
    // What is forbidden counts, though libraries do it.
    Arc::get_mut(&mut corpus.library).expect("nobody else has it").set_strict(true);
    let cases: Vec<Case> = corpus.files.iter().filter_map(case).collect();
    let cases: Vec<Case> = cases.into_iter().filter(|case| is_asked_for(&case.name)).collect();
    let ended = judge_all(
        &cases,
        |case| {
            let (library, class) = (corpus.library.clone(), case.class.clone());
            Box::new(move |progress| match class {
                Ok(class) => run(&library, &class, None, progress),
                Err(error) => {
                    Err(Failure { stage: Stage::Load, errors: vec![error], signal: None })
                }
            })
        },
        BUDGET,
    );
    let mut ledger = Ledger::read("mls.toml");
    let mut table: BTreeMap<&str, [usize; 4]> = BTreeMap::new();
    for (case, ended) in cases.iter().zip(&ended) {
        let counts = table.entry(chapter(&case.name)).or_default();
        let column = if case.should_pass { 0 } else { 2 };
        counts[column + 1] += 1;
        let judged = match needs_c(ended) {
            true => wrong_with_c(&root, case),
            false => wrong(case, ended),
        };
        match judged {
            None => counts[column] += 1,
            Some(reason) => {
                tell(&corpus, case, ended, &reason);
                ledger.note(section(&case.name), &case.name, reason);
            }
        }
    }
    tell_table(&table);
    ledger.settle(is_worse);
}

/// Whether a case calls a function in C, which only the program compiles.
fn needs_c(ended: &Ended) -> bool {
    let Ended::Judged(Err(failure)) = ended else { return false };
    failure.errors.iter().any(|error| error.code == EXTERNAL_OUTSIDE)
}

/// What is wrong with the way a case ends in the program, with functions in C allowed.
fn wrong_with_c(root: &Path, case: &Case) -> Option<String> {
    let Ok(class) = &case.class else { return None };
    let (class, library) = (class.to_string(), root.parent()?.display().to_string());
    let file = root.join(case.name.replace('.', "/")).with_extension("mo");
    let file = file.display().to_string();
    let here = program::folder(&[]);
    let arguments = ["simulate", &file, "--library", &library, "--model", &class];
    let more = ["--allow-external", "--output", "r.csv"];
    let (code, _, errors) = program::gapi(&here, &[&arguments[..], &more].concat());
    let slug = errors.split_once("error[").and_then(|(_, rest)| rest.split_once(']'));
    let slug = slug.map_or("failed", |(slug, _)| slug);
    let is_missing = [NOT_SUPPORTED.slug, UNSUPPORTED_LANGUAGE.slug].contains(&slug);
    match (code == 0, case.should_pass) {
        (true, true) => None,
        (true, false) => Some("accepted".to_owned()),
        (false, false) if !is_missing => None,
        (false, _) => Some(format!("simulate: {slug}")),
    }
}

/// Whether a case that was judged wrong is worse now.
fn is_worse(old: &str, new: &str) -> bool {
    let is_broken = |reason: &str| reason.ends_with(": panic") || reason.ends_with(": timeout");
    is_broken(new) && !is_broken(old)
}

/// What is wrong with the way a case ended.
fn wrong(case: &Case, ended: &Ended) -> Option<String> {
    match (ended, case.should_pass) {
        (Ended::Panicked(stage), _) => Some(format!("{stage}: panic")),
        (Ended::TimedOut(stage), _) => Some(format!("{stage}: timeout")),
        (Ended::Judged(Ok(())), true) => None,
        (Ended::Judged(Ok(())), false) => Some("accepted".to_owned()),
        (Ended::Judged(Err(failure)), false) if !failure.is_missing_feature() => None,
        (Ended::Judged(Err(failure)), _) => Some(failure.to_string()),
    }
}

/// With a filter, all about a case that is judged wrong.
fn tell(corpus: &Corpus, case: &Case, ended: &Ended, reason: &str) {
    if crate::support::conformance::filter().is_none() {
        return;
    }
    let should = if case.should_pass { "should pass" } else { "should fail" };
    say(&format!("{} ({should}): {reason}", case.name));
    let Ended::Judged(Err(failure)) = ended else { return };
    for error in failure.errors.iter().take(3) {
        say(&format!("    {}: {error}", corpus.sources.location(error.span())));
    }
}

fn tell_table(table: &BTreeMap<&str, [usize; 4]>) {
    say(&format!("{:14}{:>18}{:>18}{:>18}", "chapter", "should pass", "should fail", "all"));
    let mut sum = [0; 4];
    for (chapter, counts) in table {
        say(&row(chapter, counts));
        sum.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
    }
    say(&row("all", &sum));
}

fn row(name: &str, counts: &[usize; 4]) -> String {
    let share = |right: usize, all: usize| {
        let percent = 100.0 * right as f64 / all.max(1) as f64;
        format!("{right} of {all} {percent:3.0} %")
    };
    let [passed, pass, failed, fail] = *counts;
    let all = share(passed + failed, pass + fail);
    format!("{name:14}{:>18}{:>18}{all:>18}", share(passed, pass), share(failed, fail))
}

fn chapter(case: &str) -> &str {
    case.split('.').next().unwrap_or(case)
}

fn section(case: &str) -> &'static str {
    let fits = |prefix: &&(&str, &str)| case.starts_with(prefix.0);
    let found = SECTIONS.iter().filter(fits).max_by_key(|(prefix, _)| prefix.len());
    found.unwrap_or_else(|| panic!("no section for `{case}`")).1
}

/// The case of a file; none in a file that only helps.
fn case(file: &File) -> Option<Case> {
    let Ok(parsed) = &file.parsed else { return unparsed(file) };
    let within = parsed.within.as_ref().map(|within| within.node.clone()).unwrap_or_default();
    let (class, should_pass) = parsed.classes.iter().find_map(|class| test_case(&within, class))?;
    let class = file.refused.clone().map_or(Ok(class), Err);
    Some(Case { name: file.name.clone(), class, should_pass })
}

/// The case of a file that is no Modelica.
fn unparsed(file: &File) -> Option<Case> {
    let error = file.parsed.as_ref().err()?.clone();
    let (_, rest) = file.text.split_once("shouldPass")?;
    let value = rest.trim_start().strip_prefix('=')?.trim_start();
    let should_pass = value.starts_with("true");
    Some(Case { name: file.name.clone(), class: Err(error), should_pass })
}

/// The class with `__ModelicaAssociation(TestCase(shouldPass = …))`, in or below a class.
fn test_case(within: &Name, class: &ClassDefinition) -> Option<(Name, bool)> {
    let name = within.child(class.name.node);
    let ClassSpecifier::Long(long) = &class.specifier else { return None };
    long.sections.iter().find_map(|section| match section {
        Section::Annotation(annotation) => should_pass(annotation).map(|pass| (name.clone(), pass)),
        Section::Elements { elements, .. } => elements.iter().find_map(|element| match element {
            Element::Class(nested) => test_case(&name, &nested.class),
            _ => None,
        }),
        _ => None,
    })
}

fn should_pass(annotation: &Annotation) -> Option<bool> {
    let association = named(&annotation.arguments, "__ModelicaAssociation")?;
    let case = named(&association.modification.as_ref()?.arguments, "TestCase")?;
    let should_pass = named(&case.modification.as_ref()?.arguments, "shouldPass")?;
    match &should_pass.modification.as_ref()?.binding {
        Some(Binding::Expression(value)) => match value.kind {
            ExpressionKind::Boolean(value) => Some(value),
            _ => None,
        },
        _ => None,
    }
}

fn named<'a>(arguments: &'a [Argument], name: &str) -> Option<&'a ElementModification> {
    arguments.iter().find_map(|argument| match argument {
        Argument::Element(element) if element.name.node.to_string() == name => Some(element),
        _ => None,
    })
}
