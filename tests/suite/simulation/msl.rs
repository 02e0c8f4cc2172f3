//! The Modelica Standard Library, from the folder that `GAPILIB_MSL` names, which holds `Modelica`,
//! `ModelicaServices` and `Complex.mo`: every file is parsed, and the examples are
//! translated and simulated. Where `GAPILIB_REFERENCES` names the collection of
//! reference results (a folder with `Modelica/Blocks/Examples/…`), they are compared with them; an
//! example without a reference is right when it is simulated.

use crate::support::conformance::{
    Corpus, Ended, Ledger, Reference, Stage, filter, folder, is_asked_for, judge_all, run, say,
};
use gapilib::internals::flatten::{self, Library};
use gapilib::internals::name::Name;
use gapilib::internals::syntax::ast::{Argument, ClassSpecifier, Restriction, Section};
use std::collections::BTreeMap;

/// Seconds that an example may take.
const BUDGET: f64 = 60.0;

/// The packages with examples.
const PACKAGES: &[&str] = &[
    "Modelica.Blocks",
    "Modelica.Clocked",
    "Modelica.ComplexBlocks",
    "Modelica.Electrical.Analog",
    "Modelica.Electrical.Batteries",
    "Modelica.Electrical.Digital",
    "Modelica.Electrical.Machines",
    "Modelica.Electrical.Polyphase",
    "Modelica.Electrical.PowerConverters",
    "Modelica.Electrical.QuasiStatic",
    "Modelica.Electrical.Spice3",
    "Modelica.Fluid",
    "Modelica.Magnetic",
    "Modelica.Math",
    "Modelica.Mechanics.MultiBody",
    "Modelica.Mechanics.Rotational",
    "Modelica.Mechanics.Translational",
    "Modelica.Media",
    "Modelica.StateGraph",
    "Modelica.Thermal",
    "Modelica.Utilities",
];

/// Examples, and how many of them got beyond each stage.
#[derive(Default)]
struct Counts {
    all: usize,
    beyond: [usize; 4],
    /// With a reference, and in agreement with it.
    judged: usize,
    agreed: usize,
}

const STAGES: [Stage; 4] = [Stage::Flatten, Stage::Sort, Stage::Compile, Stage::Simulate];

#[test]
fn standard_library_is_read_and_its_examples_are_flattened() {
    let Some(root) = folder("GAPILIB_MSL") else { return };
    let references = folder("GAPILIB_REFERENCES");
    let corpus = Corpus::load(&root);
    let mut ledger = Ledger::read("msl.toml");
    read_files(&corpus, &mut ledger);
    let examples = examples(&corpus.library);
    let ended = judge_all(
        &examples,
        |example| {
            let (library, class) = (corpus.library.clone(), example.clone());
            let references = references.clone();
            Box::new(move |progress| {
                let reference = references.and_then(|folder| Reference::of(&class, &folder));
                run(&library, &class, reference.as_ref(), progress)
            })
        },
        BUDGET,
    );
    let mut table: BTreeMap<&str, Counts> = BTreeMap::new();
    for (example, ended) in examples.iter().zip(&ended) {
        let package = package(example).expect("an example lies in a package");
        let (stuck, reason) = stuck(ended);
        let path = references.as_ref().map(|folder| Reference::path(example, folder));
        let is_judged = path.is_some_and(|path| path.is_file());
        table.entry(package).or_default().count(stuck, is_judged);
        if let Some(reason) = reason {
            tell(&corpus, example, ended, &reason);
            ledger.note(package, &example.to_string(), reason);
        }
    }
    tell_table(&table);
    if references.is_none() {
        ledger.keep(|reason| reason.starts_with("differs:"));
    }
    ledger.settle(is_worse);
}

#[test]
fn standard_library_breaks_no_rule() {
    let Some(root) = folder("GAPILIB_MSL") else { return };
    let corpus = Corpus::load(&root);
    let mut wrong = Vec::new();
    let classes = corpus.library.all();
    say(&format!("{} classes", classes.len()));
    for class in classes {
        for error in flatten::check(&corpus.library, &class) {
            let place = corpus.sources.location(error.span());
            wrong.push(format!("{place}: {}: {error}", error.code.slug));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn read_files(corpus: &Corpus, ledger: &mut Ledger) {
    for file in corpus.files.iter().filter(|file| is_asked_for(&file.name)) {
        let error = file.parsed.as_ref().err().or(file.refused.as_ref());
        if let Some(error) = error {
            let place = corpus.sources.location(error.span());
            say(&format!("{place}: {}: {error}", error.code.slug));
            ledger.note("files", &file.name, format!("load: {}", error.code.slug));
        }
    }
    say(&format!("{} files", corpus.files.len()));
}

/// The models below a package `Examples` that have an experiment annotation.
fn examples(library: &Library) -> Vec<Name> {
    let is_example = |name: &Name| {
        let text = name.to_string();
        package(name).is_some()
            && text.contains(".Examples.")
            && is_asked_for(&text)
            && is_experiment(library, name)
    };
    library.all().into_iter().filter(is_example).collect()
}

fn package(name: &Name) -> Option<&'static str> {
    let text = name.to_string();
    let contains =
        |package: &&&str| text.strip_prefix(**package).is_some_and(|rest| rest.starts_with('.'));
    PACKAGES.iter().find(contains).copied()
}

/// Whether a class is a model, not partial, with an experiment annotation of its own.
pub(crate) fn is_experiment(library: &Library, name: &Name) -> bool {
    let Some(definition) = library.definition(name) else { return false };
    let is_model = matches!(
        definition.restriction,
        Restriction::Model | Restriction::Block | Restriction::Class
    );
    let annotations: Vec<_> = match &definition.specifier {
        ClassSpecifier::Long(long) => long
            .sections
            .iter()
            .filter_map(|section| match section {
                Section::Annotation(annotation) => Some(annotation),
                _ => None,
            })
            .collect(),
        ClassSpecifier::Short(short) => short.comment.annotation.iter().collect(),
        _ => Vec::new(),
    };
    let says_experiment = annotations.iter().flat_map(|annotation| &annotation.arguments).any(
        |argument| matches!(argument, Argument::Element(e) if e.name.node.to_string() == "experiment"),
    );
    is_model && !definition.partial && says_experiment
}

/// The stage that was not passed, and what the ledger says of it.
fn stuck(ended: &Ended) -> (Option<Stage>, Option<String>) {
    match ended {
        Ended::Judged(Ok(())) => (None, None),
        Ended::Judged(Err(failure)) => (Some(failure.stage), Some(failure.to_string())),
        Ended::Panicked(stage) => (Some(*stage), Some(format!("{stage}: panic"))),
        Ended::TimedOut(stage) => (Some(*stage), Some(format!("{stage}: timeout"))),
    }
}

impl Counts {
    fn count(&mut self, stuck: Option<Stage>, is_judged: bool) {
        self.all += 1;
        self.judged += usize::from(is_judged);
        self.agreed += usize::from(is_judged && stuck.is_none());
        for (beyond, stage) in self.beyond.iter_mut().zip(STAGES) {
            *beyond += usize::from(stuck.is_none_or(|stuck| stuck > stage));
        }
    }
}

/// Whether an example gets less far than the ledger says. A trajectory that is wrong and was not
/// known to be so is worse than an error.
fn is_worse(old: &str, new: &str) -> bool {
    if new.starts_with("differs:") {
        return !old.starts_with("differs:");
    }
    let stage = |reason: &str| Stage::named(reason.split(':').next().unwrap_or(""));
    stage(new) < stage(old)
}

fn tell(corpus: &Corpus, example: &Name, ended: &Ended, reason: &str) {
    if filter().is_none() {
        return;
    }
    say(&format!("{example}: {reason}"));
    let Ended::Judged(Err(failure)) = ended else { return };
    for error in failure.errors.iter().take(3) {
        say(&format!("    {}: {error}", corpus.sources.location(error.span())));
    }
}

fn tell_table(table: &BTreeMap<&str, Counts>) {
    let heads = ["examples", "flattened", "sorted", "compiled", "simulated", "judged", "agreed"];
    let heads: String = heads.iter().map(|head| format!("{head:>12}")).collect();
    say(&format!("{:34}{heads}", "package"));
    let mut sum = Counts::default();
    for (package, counts) in table {
        say(&row(package, counts));
        sum.all += counts.all;
        sum.judged += counts.judged;
        sum.agreed += counts.agreed;
        sum.beyond.iter_mut().zip(counts.beyond).for_each(|(sum, count)| *sum += count);
    }
    say(&row("all", &sum));
}

fn row(name: &str, counts: &Counts) -> String {
    let share = |count: usize| {
        let percent = 100.0 * count as f64 / counts.all.max(1) as f64;
        format!("{:>12}", format!("{count} {percent:3.0} %"))
    };
    let beyond: String = counts.beyond.iter().map(|count| share(*count)).collect();
    format!("{name:34}{:>12}{beyond}{:>12}{:>12}", counts.all, counts.judged, counts.agreed)
}
