//! One or two sentences for each step: what happens and why, with the numbers it uses and the names
//! of the paper's Table 1.

use super::generation::{Generation, mate};
use super::operation_text;
use super::step::Step;
use super::walk::Walk;
use super::words::counted;
pub use super::words::short;
use crate::ga::has_failed;

/// What happens in the step that `walk` stands at, and why.
pub fn explain(walk: &Walk) -> String {
    let generation = walk.generation();
    match walk.step() {
        Step::Draw => draw(generation),
        Step::Simulate => simulate(walk),
        Step::Rate => rate(walk),
        Step::Sort => sort(generation),
        Step::Elite => elite(generation),
        Step::Cross(rank) => cross(generation, rank),
        Step::Mutate(row) => mutate(walk, row),
        Step::Complete(row) => complete(walk, row),
        Step::Renew => renew(walk),
        Step::Stop => stop(walk),
        Step::Operate(_, row) => operate(walk, row),
    }
}

fn draw(generation: &Generation) -> String {
    let numbers: usize = generation.drawn.iter().map(|drawn| drawn.numbers.len()).sum();
    format!(
        "The first population (N_Population = {}) is sampled: Ram_Gen_ARENA returned {} between \
         0 and 1. Each number u sets one gene within its range, to Param_Min + (Param_Max - \
         Param_Min) u.",
        generation.len(),
        counted(numbers, "random number"),
    )
}

fn simulate(walk: &Walk) -> String {
    let generation = walk.generation();
    let (individuals, failed) = (generation.len(), generation.failures.len());
    let subject = &walk.trace().subject;
    let shown = format!(
        "Eval simulates `{}` once for each of {}; each row of genes is one set of values of {}.",
        subject.model,
        counted(individuals, "individual"),
        subject.parameters.join(", "),
    );
    match generation.failures.first() {
        None => shown,
        Some((k, cause)) => format!(
            "{shown} {failed} of them cannot be simulated, the first is individual {}: {cause}.",
            k + 1
        ),
    }
}

fn rate(walk: &Walk) -> String {
    let generation = walk.generation();
    let points = walk.trace().measured.1.len();
    match generation.best() {
        Some((k, fitness)) if !has_failed(fitness) && generation.best_simulated.is_empty() => {
            format!(
                "The fitness measures the distance between simulation and measurement: smaller \
                 is better. The best of the generation is individual {} with {}.",
                k + 1,
                short(fitness)
            )
        }
        Some((k, fitness)) if !has_failed(fitness) => format!(
            "Fit is the sum of squared residuals, measurement minus simulation, over {}: smaller \
             is better. The best of the generation is individual {} with {}.",
            counted(points, "point"),
            k + 1,
            short(fitness)
        ),
        _ => "No individual could be simulated, so there is no best one.".to_owned(),
    }
}

fn sort(generation: &Generation) -> String {
    let Some(sorted) = &generation.sorted else { return String::new() };
    format!(
        "Fit_Order sorts them by fitness, best first. The best {} (N_Parents) will be parents, \
         the other {} are discarded (truncation selection).",
        sorted.parents,
        generation.len().saturating_sub(sorted.parents)
    )
}

fn elite(generation: &Generation) -> String {
    let Some(crossed) = &generation.crossed else { return String::new() };
    let best = match generation.best() {
        Some((_, fitness)) => format!(", {},", short(fitness)),
        None => String::new(),
    };
    format!(
        "The best {} (N_Elitism) {} unchanged (elitism), so the best fitness{best} never gets \
         worse.",
        crossed.elites,
        if crossed.elites == 1 { "survives" } else { "survive" },
    )
}

fn cross(generation: &Generation, rank: usize) -> String {
    let Some(crossed) = &generation.crossed else { return String::new() };
    let mate = mate(rank, crossed.parents);
    let points: Vec<String> = crossed.points.iter().map(usize::to_string).collect();
    let children = if mate < rank { "a child" } else { "two children" };
    format!(
        "Ranks {} and {} have {children}: they exchange the genes after gene {} (Cross_Point).",
        rank + 1,
        mate + 1,
        points.join(" and after gene ")
    )
}

fn mutate(walk: &Walk, row: usize) -> String {
    let generation = walk.generation();
    let Some(mutated) = &generation.mutated else { return String::new() };
    let names = &walk.trace().subject.parameters;
    let n = generation.n_genes;
    let changes: Vec<String> = generation
        .mutated_genes(row)
        .into_iter()
        .map(|j| {
            let at = row * n + j;
            let (u, value) = (mutated.numbers[at], mutated.after.get(at).copied());
            let name = names.get(j).map_or_else(|| format!("gene {}", j + 1), Clone::clone);
            let value = short(value.unwrap_or(f64::NAN));
            format!("{name} (u = {u:.3}, below F_Mut = {}) becomes {value}", mutated.factor)
        })
        .collect();
    let child = row + 1 - mutated.elites;
    match changes.is_empty() {
        true if n == 1 => format!(
            "Child {child} keeps its gene: its random number is not below F_Mut = {}.",
            mutated.factor
        ),
        true => format!(
            "Child {child} keeps its genes: none of its {n} random numbers is below F_Mut = {}.",
            mutated.factor
        ),
        false => format!(
            "Child {child} mutates: {}. The new value is Param_Min + (Param_Max - Param_Min) u/F_Mut.",
            changes.join("; ")
        ),
    }
}

fn complete(walk: &Walk, row: usize) -> String {
    let numbers: Vec<String> = walk
        .next_generation()
        .and_then(|next| next.random_numbers(row))
        .map(|numbers| numbers.iter().map(|u| format!("{u:.3}")).collect())
        .unwrap_or_default();
    let drawn = match numbers.is_empty() {
        true => String::new(),
        false => format!(" (u = {})", numbers.join(", ")),
    };
    format!(
        "Individual {} of the next generation is sampled at random between Param_Min and \
         Param_Max{drawn}. Such immigrants maintain diversity and prevent premature convergence.",
        row + 1
    )
}

fn renew(walk: &Walk) -> String {
    let next = walk.next_generation().map_or(0, Generation::len);
    format!(
        "Elites, children and random individuals form the next generation: {}. The stop \
         condition is not yet met.",
        counted(next, "individual")
    )
}

fn operate(walk: &Walk, row: usize) -> String {
    let Some(operation) = &walk.generation().operation else { return String::new() };
    let text = operation_text::text(operation, row, &walk.trace().subject.parameters);
    match walk.is_last() && walk.trace().full {
        true => format!("{text} The trace reached its maximum size and ends here."),
        false => text,
    }
}

fn stop(walk: &Walk) -> String {
    if walk.generation().is_call {
        return "The operator leaves all individuals as they are.".to_owned();
    }
    let why = match (walk.trace().full, walk.trace().cut) {
        (true, _) => "The trace reached its maximum size and ends here; the run continued",
        (_, true) => "The run was interrupted here",
        _ => "The stop condition is met: the run ends",
    };
    let generations = walk.trace().generations.len();
    match walk.generation().best() {
        Some((k, fitness)) => format!(
            "{why}, after {}. The best individual is number {} with the fitness {}.",
            counted(generations, "generation"),
            k + 1,
            short(fitness)
        ),
        None => format!("{why}, after {}.", counted(generations, "generation")),
    }
}
