//! The operators that users choose: what kinds there are, what each is called, and how a choice
//! becomes an operator.
//!
//! A choice names an entry of the table of its kind, with settings of that entry, or a function
//! that the user wrote with the [`Signature`] of the kind.

use super::crossover::{self, CROSSOVERS, Crossover};
use super::mutation::{self, MUTATIONS, Mutation};
use super::sampling::{self, SAMPLINGS, Sampling};
use super::selection::{self, SELECTIONS, Selection};
use super::survival::{self, SURVIVALS, Survival};
use super::{Gene, errors::BAD_OPERATOR};
use crate::bail;
use crate::diag::Fault;
use crate::registry::{self, Choice, Entry, Options, Setting, UserFunction};
use std::sync::Arc;

/// Numbers of an input or an output of a user's operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// One number.
    One,
    /// One number for each gene.
    Genes,
    /// Random numbers, uniform between 0 and 1, three for each gene: a matrix genes × 3.
    Random,
}

impl Size {
    /// How many numbers these are for so many genes.
    pub fn count(self, n_genes: usize) -> usize {
        match self {
            Size::One => 1,
            Size::Genes => n_genes,
            Size::Random => NUMBERS * n_genes,
        }
    }
}

/// Random numbers for each gene of a user's operator.
pub const NUMBERS: usize = 3;

/// The inputs and outputs of a user's operator, in their order. All are Real.
#[derive(Debug, Clone, Copy)]
pub struct Signature {
    /// Inputs with their sizes.
    pub inputs: &'static [(&'static str, Size)],
    /// Outputs with their sizes.
    pub outputs: &'static [(&'static str, Size)],
}

/// A user's operator as it is called: numbers of the inputs, numbers of the outputs.
pub type Call<'a> = &'a mut dyn FnMut(&[f64]) -> Result<Vec<f64>, Fault>;

/// What is listed of an operator.
#[derive(Debug, Clone)]
pub struct Listed {
    /// The name to choose it by.
    pub name: &'static str,
    /// Other names.
    pub aliases: &'static [&'static str],
    /// What it does.
    pub summary: &'static str,
    /// Where it is defined: a key of [`gapilib_base::bibliography`].
    pub reference: &'static str,
    /// Its settings.
    pub settings: Vec<Setting>,
}

/// A kind of operator.
pub struct OperatorKind {
    /// What it is called, in problem files as well.
    pub name: &'static str,
    /// What it does.
    pub summary: &'static str,
    /// A setting that every choice of this kind has in a method, and what it says; a number in
    /// place of a name is its value for the usual operator.
    pub frequency: Option<(&'static str, &'static str)>,
    /// Inputs and outputs of a function that takes the place of an entry.
    pub signature: Signature,
    /// The entries of its table.
    pub entries: fn() -> Vec<Listed>,
}

/// All kinds, in the order of a generation.
pub const KINDS: [OperatorKind; 5] = [
    OperatorKind {
        name: "sampling",
        summary: "draws the first generation",
        frequency: None,
        signature: sampling::SIGNATURE,
        entries: || listed(SAMPLINGS),
    },
    OperatorKind {
        name: "selection",
        summary: "selects the parents",
        frequency: None,
        signature: selection::SIGNATURE,
        entries: || listed(SELECTIONS),
    },
    OperatorKind {
        name: "crossover",
        summary: "creates two children from two parents",
        frequency: Some(("probability", "probability that a pair is crossed")),
        signature: crossover::SIGNATURE,
        entries: || listed(CROSSOVERS),
    },
    OperatorKind {
        name: "mutation",
        summary: "changes genes of children at random",
        frequency: Some((
            "rate",
            "probability that a gene mutates; 0 means one gene per individual on average in \
             genetic and nsga2",
        )),
        signature: mutation::SIGNATURE,
        entries: || listed(MUTATIONS),
    },
    OperatorKind {
        name: "survival",
        summary: "selects the individuals of the next generation",
        frequency: None,
        signature: survival::SIGNATURE,
        entries: || listed(SURVIVALS),
    },
];

/// The kind of this name.
pub fn kind(name: &str) -> Option<&'static OperatorKind> {
    KINDS.iter().find(|kind| kind.name == name)
}

impl OperatorKind {
    /// Whether its table has an entry of this name or alias.
    pub fn has(&self, name: &str) -> bool {
        let same = |known: &str| known.eq_ignore_ascii_case(name);
        (self.entries)().iter().any(|e| same(e.name) || e.aliases.iter().any(|alias| same(alias)))
    }

    /// A function of the user that takes the place of an entry, as it is declared.
    pub fn declaration(&self) -> String {
        let declared = |causality: &str, (name, size): &(&str, Size)| {
            let dims = match size {
                Size::One => "",
                Size::Genes => "[:]",
                Size::Random => "[:,3]",
            };
            format!("  {causality} Real {name}{dims};\n")
        };
        let inputs = self.signature.inputs.iter().map(|one| declared("input", one));
        let outputs = self.signature.outputs.iter().map(|one| declared("output", one));
        let lines: String = inputs.chain(outputs).collect();
        format!("function {}\n{lines}", self.name)
    }
}

fn listed<T: ?Sized>(table: &[&'static Entry<T>]) -> Vec<Listed> {
    let one = |entry: &&'static Entry<T>| Listed {
        name: entry.name,
        aliases: entry.aliases,
        summary: entry.summary,
        reference: entry.reference,
        settings: registry::settings(entry),
    };
    table.iter().map(one).collect()
}

/// A crossover that was chosen.
///
/// # Errors
///
/// `unknown-choice` for a name that is not in the table, `bad-option` for settings that do not fit;
/// the same for all kinds.
pub fn crossover(choice: Choice) -> Result<Arc<dyn Crossover>, Fault> {
    made("crossover", CROSSOVERS, choice, |function| Box::new(crossover::Own(function)))
}

/// A mutation that was chosen.
///
/// # Errors
///
/// As [`crossover()`].
pub fn mutation(choice: Choice) -> Result<Arc<dyn Mutation>, Fault> {
    made("mutation", MUTATIONS, choice, |function| Box::new(mutation::Own(function)))
}

/// A selection that was chosen.
///
/// # Errors
///
/// As [`crossover()`].
pub fn selection(choice: Choice) -> Result<Arc<dyn Selection>, Fault> {
    made("selection", SELECTIONS, choice, |function| Box::new(selection::Own(function)))
}

/// A survival that was chosen.
///
/// # Errors
///
/// As [`crossover()`].
pub fn survival(choice: Choice) -> Result<Arc<dyn Survival>, Fault> {
    made("survival", SURVIVALS, choice, |function| Box::new(survival::Own(function)))
}

/// A sampling that was chosen.
///
/// # Errors
///
/// As [`crossover()`].
pub fn sampling(choice: Choice) -> Result<Arc<dyn Sampling>, Fault> {
    made("sampling", SAMPLINGS, choice, |function| Box::new(sampling::Own(function)))
}

fn made<T: ?Sized>(
    kind: &'static str,
    table: &[&Entry<T>],
    choice: Choice,
    own: fn(Arc<dyn UserFunction>) -> Box<T>,
) -> Result<Arc<T>, Fault> {
    let Choice { name, mut options, function } = choice;
    let made = match function {
        Some(function) => own(Arc::new(Named { kind, name: name.clone(), function })),
        None => {
            let entry = registry::find(kind, table, &name).map_err(|fault| {
                let help = format!("or write a {kind} in Modelica: `gapi help --operators`");
                fault.help(help)
            })?;
            (entry.make)(&mut options).map_err(|fault| of(kind, &name, fault))?
        }
    };
    options.finish().map_err(|fault| of(kind, &name, fault))?;
    Ok(Arc::from(made))
}

/// A function of the user that says who it is when it fails.
struct Named {
    kind: &'static str,
    name: String,
    function: Arc<dyn UserFunction>,
}

impl UserFunction for Named {
    fn call(&self, inputs: &[f64]) -> Result<Vec<f64>, Fault> {
        self.function
            .call(inputs)
            .map_err(|fault| {
                Fault::new(BAD_OPERATOR, fault.message.clone())
                    .help_if(fault.helps.into_iter().next())
            })
            .map_err(|fault| of(self.kind, &self.name, fault))
    }
}

/// The fault with the operator that it is about.
fn of(kind: &str, name: &str, mut fault: Fault) -> Fault {
    fault.message = format!("{kind} `{name}`: {}", fault.message);
    fault
}

/// An operator by name, for methods whose usual operators are named in their code.
pub(super) fn usual(name: &str, settings: &[(&str, f64)]) -> Choice {
    let mut options = Options::default();
    settings.iter().for_each(|(name, value)| options.set(name, *value));
    Choice { options, ..Choice::named(name) }
}

/// What a user's operator has answered, within the ranges of the genes.
///
/// # Errors
///
/// `bad-operator` where a value is not a number, or there are too many or too few.
pub(super) fn within(kind: &str, values: &[f64], genes: &[Gene]) -> Result<Vec<f64>, Fault> {
    if values.len() != genes.len() {
        let (found, expected) = (values.len(), genes.len());
        bail!(BAD_OPERATOR, "the {kind} returns {found} genes instead of {expected}");
    }
    if let Some(k) = values.iter().position(|value| value.is_nan()) {
        bail!(
            BAD_OPERATOR,
            "the {kind} returns NaN for the gene {}", genes[k].name;
            help: "return a number for every gene; numbers outside the range are clipped to it"
        );
    }
    Ok(values.iter().zip(genes).map(|(value, gene)| value.clamp(gene.min, gene.max)).collect())
}

/// The ends of the ranges: all minima, then all maxima.
pub(super) fn ranges(genes: &[Gene]) -> impl Iterator<Item = f64> {
    genes.iter().map(|gene| gene.min).chain(genes.iter().map(|gene| gene.max))
}
