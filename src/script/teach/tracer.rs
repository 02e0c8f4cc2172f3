//! Writes a trace while scripts run.

use super::event::{Event, Genes, Numbers, ScriptLine, Subject};
use super::file;
use super::operation::Operation;
use super::produced::Produced;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// A trace grows no larger than this many bytes.
const LARGEST: usize = 64 << 20;

/// Observes the calls of the paper's functions and gives the bytes of a trace, piece by piece.
#[derive(Debug)]
pub(crate) struct Tracer {
    scripts: HashMap<PathBuf, u32>,
    subject: Option<Subject>,
    /// Where the model was asked for its Y, and what was measured there.
    points: (Vec<f64>, Vec<f64>),
    produced: Produced,
    /// Whether something was simulated.
    is_run: bool,
    unwritten: Vec<u8>,
    size: usize,
    largest: usize,
    full: bool,
}

impl Default for Tracer {
    fn default() -> Tracer {
        Tracer::new(LARGEST)
    }
}

/// What `Mutation` was given.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MutationCall<'a> {
    /// Elites and children, row by row.
    pub genes: &'a [f64],
    /// One number for each gene.
    pub numbers: &'a [f64],
    /// Number of elites, which stay.
    pub elites: usize,
    /// The probability that a gene mutates.
    pub factor: f64,
    /// Lower ends of the search ranges.
    pub minima: &'a [f64],
    /// Upper ends of the search ranges.
    pub maxima: &'a [f64],
}

impl Tracer {
    /// A tracer whose trace has at most `largest` bytes.
    pub(crate) fn new(largest: usize) -> Tracer {
        let unwritten = file::heading();
        Tracer {
            scripts: HashMap::new(),
            subject: None,
            points: (Vec::new(), Vec::new()),
            produced: Produced::default(),
            is_run: false,
            size: unwritten.len(),
            unwritten,
            largest,
            full: false,
        }
    }

    /// The bytes that came since the last call, to be appended to those.
    pub(crate) fn take_bytes(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.unwritten)
    }

    /// How many bytes [`Tracer::take_bytes`] would give.
    pub(crate) fn unwritten(&self) -> usize {
        self.unwritten.len()
    }

    /// The place of a line in a script; its text is recorded when it is named first.
    pub(crate) fn place(&mut self, path: &Path, text: &str, line: usize) -> ScriptLine {
        let line = line as u32;
        if let Some(&script) = self.scripts.get(path) {
            return ScriptLine { script, line };
        }
        let script = self.scripts.len() as u32;
        self.scripts.insert(path.to_owned(), script);
        let name = path.display().to_string();
        self.push(&Event::Script { name, text: text.to_owned() });
        ScriptLine { script, line }
    }

    /// `Ram_Gen_ARENA` has drawn `count` numbers.
    pub(crate) fn drawn(&mut self, place: ScriptLine, seed: [f64; 6], count: usize) {
        self.push(&Event::Draw { place, seed, count: count as u32 });
    }

    /// `Eval` has simulated individuals, and interpolated Y at the points `x`; `failures` names
    /// those that failed, from 0, and why.
    pub(crate) fn simulated(
        &mut self,
        place: ScriptLine,
        (subject, x): (&Subject, &[f64]),
        genes: &[f64],
        failures: Vec<(u32, String)>,
    ) {
        self.is_run = true;
        if self.subject.as_ref() != Some(subject) {
            self.push(&Event::Subject(subject.clone()));
            self.subject = Some(subject.clone());
        }
        if self.points.0 != x {
            self.points = (x.to_vec(), Vec::new());
        }
        let n_genes = subject.parameters.len();
        let genes = Genes::of(genes, &self.produced.mutated, n_genes);
        self.push(&Event::Simulate { place, n_genes: n_genes as u32, genes, failures });
    }

    /// `Fit` has compared individuals with `measured`; `simulated` has one row for each.
    pub(crate) fn rated(
        &mut self,
        place: ScriptLine,
        fitness: &[f64],
        simulated: &[f64],
        measured: &[f64],
    ) {
        if self.points.0.len() == measured.len() && self.points.1 != measured {
            self.points.1 = measured.to_vec();
            let (x, y) = self.points.clone();
            self.push(&Event::Measured { x, y });
        }
        let points = simulated.len().checked_div(fitness.len()).unwrap_or(0);
        let best = crate::ga::order(fitness).first().copied();
        let best = best.filter(|&k| !crate::ga::has_failed(fitness[k]));
        let row = best.and_then(|k| simulated.get(k * points..(k + 1) * points));
        let best = row.unwrap_or_default().to_vec();
        self.push(&Event::Rate { place, fitness: fitness.to_vec(), best });
    }

    /// `Fit_Order` has sorted individuals.
    pub(crate) fn sorted(
        &mut self,
        place: ScriptLine,
        (genes, fitness): (&[f64], &[f64]),
        (parents, elites): (usize, usize),
    ) {
        self.alone(genes.len().checked_div(fitness.len()).unwrap_or(0));
        let genes = Genes::of(genes, &self.produced.simulated, self.produced.n_genes);
        let fitness = Numbers::of(fitness, &self.produced.fitness);
        let (parents, elites) = (parents as u32, elites as u32);
        self.push(&Event::Sort { place, genes, fitness, parents, elites });
    }

    /// `Cross` has made children of individuals with `n_genes` genes each.
    pub(crate) fn crossed(
        &mut self,
        place: ScriptLine,
        (genes, n_genes): (&[f64], usize),
        (parents, elites): (usize, usize),
        points: &[usize],
    ) {
        self.alone(n_genes);
        let genes = Genes::of(genes, &self.produced.sorted, self.produced.n_genes);
        let points = points.iter().map(|&point| point as u32).collect();
        let (parents, elites) = (parents as u32, elites as u32);
        self.push(&Event::Cross { place, genes, parents, elites, points });
    }

    /// `Mutation` has changed genes.
    pub(crate) fn mutated(&mut self, place: ScriptLine, call: &MutationCall) {
        self.alone(call.minima.len());
        let genes = Genes::of(call.genes, &self.produced.crossed, self.produced.n_genes);
        let numbers = Numbers::of(call.numbers, &self.produced.numbers);
        self.push(&Event::Mutate {
            place,
            genes,
            numbers,
            elites: call.elites as u32,
            factor: call.factor,
            minima: call.minima.to_vec(),
            maxima: call.maxima.to_vec(),
        });
    }

    /// Whether calls of operators by name are recorded: not where the trace has its largest size.
    pub(crate) fn takes_operations(&self) -> bool {
        !self.full
    }

    /// An operator was called by name.
    pub(crate) fn operated(&mut self, operation: Operation) {
        if self.takes_operations() {
            self.push(&Event::Operate(operation));
        }
    }

    /// An operator is called on individuals with so many genes. In a run the simulations say how many
    /// these are.
    fn alone(&mut self, n_genes: usize) {
        if !self.is_run && n_genes != self.produced.n_genes {
            self.push(&Event::Alone { n_genes: n_genes as u32 });
        }
    }

    fn push(&mut self, event: &Event) {
        if self.full {
            return;
        }
        let before = self.unwritten.len();
        file::push(&mut self.unwritten, event);
        let added = self.unwritten.len() - before;
        if self.size + added > self.largest {
            self.unwritten.truncate(before);
            self.full = true;
            file::push(&mut self.unwritten, &Event::Full);
            return;
        }
        self.size += added;
        self.produced.follow(event);
    }
}
