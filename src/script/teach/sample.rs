//! A small run for the tests: two genes, a straight line to fit, the paper's loop.

use super::event::ScriptLine;
use super::operation::{Action, Operation};
use super::tracer::{MutationCall, Tracer};
use super::{Subject, Trace, TraceCursor};
use crate::elementary;
use crate::ga::{Gene, Genomes, Mrg32k3a, crossover, mutation, survival};
use std::path::Path;

/// Individuals of a generation.
pub(super) const POPULATION: usize = 6;
const PARENTS: usize = 4;
const ELITES: usize = 1;
const MINIMA: [f64; 2] = [0.0, 1.0];
const MAXIMA: [f64; 2] = [2.0, 5.0];
const FACTOR: f64 = 0.25;
const X: [f64; 3] = [0.0, 1.0, 2.0];
const Y: [f64; 3] = [1.0, 4.0, 7.0];
const SCRIPT: &str =
    "// a sample\nloop\n  draw\n  Eval\n  Fit\n  Fit_Order\n  Cross\n  Mutation\nend\n";

/// What the run has done, generation by generation.
pub(super) struct Run {
    /// The bytes of the trace.
    pub(super) bytes: Vec<u8>,
    /// The genes that were simulated.
    pub(super) simulated: Vec<Vec<f64>>,
}

/// Runs some generations; an individual whose first gene is above 1.9 fails.
pub(super) fn run(generations: usize, seed: f64) -> Run {
    let mut tracer = Tracer::default();
    let mut place = |line| tracer_place(line);
    let mut rng = Mrg32k3a::new(&[seed; 6]).expect("a valid seed");
    let mut population = Genomes::new(2, Vec::new()).expect("two genes");
    let mut simulated = Vec::new();
    let begin = tracer.place(Path::new("scripts/sample.mos"), SCRIPT, 3);
    complete(&mut population, &mut rng, &mut tracer, begin);
    for _ in 0..generations {
        simulated.push(population.values().to_vec());
        let (rows, fitness) = simulate(&population, &mut tracer, &mut place);
        tracer.rated(place(5), &fitness, &rows, &Y);
        tracer.sorted(place(6), (population.values(), &fitness), (PARENTS, ELITES));
        let (sorted, _) = crate::ga::sort_by_fitness(&population, &fitness).expect("same sizes");
        tracer.crossed(place(7), (sorted.values(), 2), (PARENTS, ELITES), &[1]);
        let mut parents = Genomes::with_capacity(2, PARENTS);
        sorted.rows().take(PARENTS).for_each(|row| parents.push(row));
        let children = crossover::cross_adjacent(&parents, &[1]);
        population = survival::elites_first(&sorted, ELITES, &children);
        mutate(&mut population, &mut rng, &mut tracer, place(8));
        complete(&mut population, &mut rng, &mut tracer, place(3));
    }
    Run { bytes: tracer.take_bytes(), simulated }
}

/// Snapshots lie beside those of the other tests.
pub(super) fn snapshots() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/teach"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings
}

/// A walk at the first step of three generations.
pub(super) fn walk() -> TraceCursor {
    TraceCursor::new(Trace::read(&run(3, 12345.0).bytes).expect("a trace"))
}

fn tracer_place(line: u32) -> ScriptLine {
    ScriptLine { script: 0, line }
}

fn drawn(count: usize, rng: &mut Mrg32k3a, tracer: &mut Tracer, place: ScriptLine) -> Vec<f64> {
    tracer.drawn(place, rng.state(), count);
    (0..count).map(|_| rng.uniform()).collect()
}

fn complete(population: &mut Genomes, rng: &mut Mrg32k3a, tracer: &mut Tracer, place: ScriptLine) {
    while population.len() < POPULATION {
        let u = drawn(2, rng, tracer, place);
        let gene = |j: usize| MINIMA[j] + (MAXIMA[j] - MINIMA[j]) * u[j];
        population.push(&[gene(0), gene(1)]);
    }
}

fn simulate(
    population: &Genomes,
    tracer: &mut Tracer,
    place: &mut impl FnMut(u32) -> ScriptLine,
) -> (Vec<f64>, Vec<f64>) {
    let subject = Subject {
        model: "Line".to_owned(),
        parameters: vec!["a".to_owned(), "slope".to_owned()],
        units: vec!["V".to_owned(), String::new()],
        x_name: "time".to_owned(),
        y_name: "y".to_owned(),
    };
    let fails = |row: &[f64]| row[0] > 1.9;
    let failed = population.rows().enumerate().filter(|(_, row)| fails(row));
    let failures = failed.map(|(k, _)| (k as u32, "a is too large".to_owned())).collect();
    tracer.simulated(place(4), (&subject, &X), population.values(), failures);
    let row =
        |genes: &[f64]| X.map(|x| if fails(genes) { f64::NAN } else { genes[0] + genes[1] * x });
    let rows: Vec<f64> = population.rows().flat_map(row).collect();
    let fitness = |row: &[f64]| {
        let sum: f64 = row.iter().zip(&Y).map(|(s, m)| elementary::powi(s - m, 2)).sum();
        if sum.is_nan() { 1e60 } else { sum }
    };
    let fitness = rows.chunks_exact(3).map(fitness).collect();
    (rows, fitness)
}

fn mutate(population: &mut Genomes, rng: &mut Mrg32k3a, tracer: &mut Tracer, place: ScriptLine) {
    let numbers = drawn(population.values().len(), rng, tracer, place);
    let call = MutationCall {
        genes: population.values(),
        numbers: &numbers,
        elites: ELITES,
        factor: FACTOR,
        minima: &MINIMA,
        maxima: &MAXIMA,
    };
    tracer.mutated(place, &call);
    let genes = [0, 1].map(|j| Gene::new(format!("{j}"), MINIMA[j], MAXIMA[j]).expect("a range"));
    mutation::mutate_uniform(population, ELITES, &genes, FACTOR, &numbers);
}

/// The bytes of a trace of three calls of operators by name: on three parents with two genes, on two
/// individuals, and the survival of both.
pub(super) fn operators() -> Vec<u8> {
    let mut tracer = Tracer::default();
    let place = tracer.place(Path::new("scripts/sample.mos"), SCRIPT, 3);
    let (parents, children) =
        (vec![1.0, 2.0, 3.0, 4.0, 5.0, 2.0], vec![1.0, 4.0, 2.5, 2.0, 5.0, 2.0]);
    let after = vec![1.0, 4.0, 0.25, 2.0];
    let actions = [
        ("one_point", Action::Crossover { parents: parents.clone(), children: children.clone() }),
        (
            "uniform",
            Action::Mutation {
                before: children[..4].to_vec(),
                after: after.clone(),
                elites: 0,
                factor: 0.5,
            },
        ),
        (
            "mu_plus_lambda",
            Action::Survival {
                old: parents,
                fitness: vec![3.0, 1.0, f64::NAN],
                offspring: after,
                fitness_offspring: vec![0.5, 9.0],
                survivors: vec![3, 1, 0],
            },
        ),
    ];
    for (operator, action) in actions {
        let operator = operator.to_owned();
        tracer.operated(Operation { place, operator, is_own: false, n_genes: 2, action });
    }
    tracer.take_bytes()
}
