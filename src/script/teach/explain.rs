//! One or two sentences for each step: what happens and why, with the numbers it uses and the names
//! of the paper's Table 1.

use super::generation::{Crossed, Generation, Mating, Origin, mating};
use super::operation_text;
use super::scaling::{Scaling, scaling};
use super::step::Step;
use super::walk::TraceCursor;
use super::words::counted;
pub use super::words::short;
use crate::ga::has_failed;

/// What happens in the step that `walk` stands at, and why.
pub fn explain(walk: &TraceCursor) -> String {
    let generation = walk.generation();
    match walk.step() {
        Step::Draw => draw(walk),
        Step::Simulate => simulate(walk),
        Step::Rate => rate(walk),
        Step::Sort => sort(generation),
        Step::Elite => elite(generation),
        Step::Cross(rank) => cross(generation, rank),
        Step::Mutate(row) => mutate(walk, row),
        Step::Complete(row) => complete(walk, row),
        Step::Renew => renew(walk),
        Step::Stop => stop(walk),
        Step::Operate { row, .. } => operate(walk, row),
    }
}

fn draw(walk: &TraceCursor) -> String {
    let generation = walk.generation();
    let numbers: usize = generation.drawn.iter().map(|drawn| drawn.numbers.len()).sum();
    let individuals = counted(generation.len(), "individual");
    let who = match generation.is_evaluation {
        true if generation.len() == 1 => format!("{individuals} is sampled"),
        true => format!("{individuals} are sampled"),
        false => format!("The first population (N_Population = {}) is sampled", generation.len()),
    };
    format!(
        "{who}: Ram_Gen_ARENA returned {} between 0 and 1. {}",
        counted(numbers, "random number"),
        used(walk, numbers),
    )
}

/// What the script has done with the numbers, as far as they show it.
fn used(walk: &TraceCursor, count: usize) -> String {
    let generation = walk.generation();
    let Some(formula) = placed(walk) else {
        return "The script makes the genes of them.".to_owned();
    };
    let (own, others) = (generation.genes.len(), count - generation.genes.len());
    let each = match (own, others) {
        (1, 0) => "It sets the gene".to_owned(),
        (_, 0) => "Each number u sets one gene".to_owned(),
        (1, _) => "The other number u sets the gene".to_owned(),
        _ => format!("Each of the other {own} numbers u sets one gene"),
    };
    let first = match (others, crossing_points(walk, others)) {
        (0, _) => String::new(),
        (1, Some(points)) => {
            format!("The first one gives the crossing point (Cross_Point = {points}). ")
        }
        (_, Some(points)) => {
            format!("The first {others} give the crossing points (Cross_Point = {points}). ")
        }
        (1, None) => "The first one sets no gene. ".to_owned(),
        (_, None) => format!("The first {others} set no genes. "),
    };
    format!("{first}{each}{formula}")
}

/// The formula for a gene, as the end of a sentence; `None` where no known one gives all genes.
fn placed(walk: &TraceCursor) -> Option<String> {
    let generation = walk.generation();
    let numbers = generation.numbers_of_genes()?;
    if numbers == generation.genes {
        return Some(", as it is.".to_owned());
    }
    let Scaling { low, high } = scaling(&walk.trace().generations)?;
    let mut mutations = walk.trace().generations[walk.number()..].iter();
    let near = |a: &[f64], b: &[f64]| {
        a.len() == b.len()
            && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-6 * (a.abs() + b.abs()))
    };
    let is_searched = mutations
        .find_map(|generation| generation.mutated.as_ref())
        .is_some_and(|mutated| near(&mutated.minima, &low) && near(&mutated.maxima, &high));
    if is_searched {
        return Some(" within its range, to Param_Min + (Param_Max - Param_Min) u.".to_owned());
    }
    let names = &walk.trace().subject.parameters;
    let ends = low.iter().zip(&high).enumerate().map(|(j, (low, high))| {
        let name = names.get(j).map_or_else(|| format!("gene {}", j + 1), Clone::clone);
        format!("{name} from {} (u = 0) to {} (u = 1)", short(*low), short(*high))
    });
    Some(format!(": {}.", ends.collect::<Vec<_>>().join(", ")))
}

/// The crossing points of the run, where the first numbers give them by the formula of the paper.
fn crossing_points(walk: &TraceCursor, count: usize) -> Option<String> {
    let drawn = &walk.generation().drawn;
    let numbers = drawn.iter().flat_map(|drawn| &drawn.numbers).take(count);
    let last = walk.generation().n_genes.checked_sub(1)? as f64;
    let expected: Vec<usize> = numbers.map(|u| 1 + (last * u).floor() as usize).collect();
    let mut later = walk.trace().generations[walk.number()..].iter();
    let crossed = later.find_map(|generation| generation.crossed.as_ref())?;
    let names: Vec<String> = expected.iter().map(usize::to_string).collect();
    (crossed.points == expected).then(|| names.join(", "))
}

fn simulate(walk: &TraceCursor) -> String {
    let generation = walk.generation();
    let (individuals, failed) = (generation.len(), generation.failures.len());
    let subject = &walk.trace().subject;
    let names = subject.parameters.join(", ");
    let shown = match individuals {
        1 => format!("Eval simulates `{}` once, with one set of values of {names}.", subject.model),
        _ => format!(
            "Eval simulates `{}` once for each of {individuals} individuals; each row of genes is \
             one set of values of {names}.",
            subject.model,
        ),
    };
    match generation.failures.first() {
        None => shown,
        Some((_, cause)) if individuals == 1 => format!("{shown} It cannot be simulated: {cause}."),
        Some((k, cause)) if failed == 1 => {
            format!("{shown} Individual {} cannot be simulated: {cause}.", k + 1)
        }
        Some((k, cause)) => format!(
            "{shown} {failed} of them cannot be simulated, the first is individual {}: {cause}.",
            k + 1
        ),
    }
}

fn rate(walk: &TraceCursor) -> String {
    let generation = walk.generation();
    let Some((k, fitness)) = generation.best().filter(|(_, fitness)| !has_failed(*fitness)) else {
        return "No individual could be simulated, so there is no best one.".to_owned();
    };
    let points = walk.trace().measured.1.len();
    let measure = match generation.best_simulated.is_empty() || points == 0 {
        true => "The fitness measures the distance between simulation and measurement".to_owned(),
        false => format!(
            "Fit is the sum of squared residuals, measurement minus simulation, over {}",
            counted(points, "point")
        ),
    };
    let best = match (generation.len(), generation.is_evaluation) {
        (1, _) => format!("Here it is {}.", short(fitness)),
        (_, true) => format!("The best of these is individual {} with {}.", k + 1, short(fitness)),
        _ => format!("The best of the generation is individual {} with {}.", k + 1, short(fitness)),
    };
    let again = match generation.more_ratings {
        0 => String::new(),
        more => format!(
            " The script computes {} of the same individuals; shown is the first.",
            match more {
                1 => "another fitness".to_owned(),
                _ => format!("{more} other ones"),
            }
        ),
    };
    format!("{measure}: smaller is better. {best}{again}")
}

fn sort(generation: &Generation) -> String {
    let Some(sorted) = &generation.sorted else { return String::new() };
    let (parents, all) = (sorted.parents, generation.len());
    let chosen = match parents {
        0 => {
            return "Fit_Order sorts them by fitness, best first. None becomes a parent \
                     (N_Parents = 0)."
                .to_owned();
        }
        1 if all <= 1 => "The only one (N_Parents = 1) will be the parent".to_owned(),
        1 => "The best one (N_Parents = 1) will be the parent".to_owned(),
        _ if parents >= all => format!("All {all} (N_Parents = {parents}) will be parents"),
        _ => format!("The best {parents} (N_Parents) will be parents"),
    };
    // An elite that is not a parent passes on.
    let fate = |is: &str| match sorted.elites > parents {
        true => "will not".to_owned(),
        false => format!("{is} discarded (truncation selection)"),
    };
    let others = match all.saturating_sub(parents) {
        0 => String::new(),
        1 => format!(", the other one {}", fate("is")),
        others => format!(", the other {others} {}", fate("are")),
    };
    format!("Fit_Order sorts them by fitness, best first. {chosen}{others}.")
}

fn elite(generation: &Generation) -> String {
    let Some(crossed) = &generation.crossed else { return String::new() };
    let best = match generation.best() {
        Some((_, fitness)) => format!(", {},", short(fitness)),
        None => String::new(),
    };
    let count = crossed.elites;
    let survivors = match count {
        1 => "individual (N_Elitism = 1) survives".to_owned(),
        _ => format!("{count} individuals (N_Elitism = {count}) survive"),
    };
    format!("The best {survivors} unchanged (elitism), so the best fitness{best} never gets worse.")
}

fn cross(generation: &Generation, rank: usize) -> String {
    let Some(crossed) = &generation.crossed else { return String::new() };
    let Mating { parents, children } = mating(rank, crossed.parents);
    let [a, b] = parents[..] else {
        return "The only parent has no partner to exchange genes with: its child is a copy of it."
            .to_owned();
    };
    let points: Vec<String> = crossed.points.iter().map(usize::to_string).collect();
    let have = format!("Parents {} and {} (by rank) have", a + 1, b + 1);
    let is_pair = children.len() == 2;
    if let Some(what) = whole_genomes(crossed, generation.n_genes) {
        let copied = if what.all { b } else { a };
        return match is_pair {
            true => {
                format!("{have} two children: {}, so each is a copy of one of them.", what.text)
            }
            false => format!("{have} a child: {}, so it is a copy of {}.", what.text, copied + 1),
        };
    }
    format!(
        "{have} {} exchange the genes after gene {} (Cross_Point).",
        if is_pair { "two children that" } else { "a child: they" },
        points.join(" and after gene ")
    )
}

/// A crossover that exchanges all genes, or none.
struct Whole {
    all: bool,
    text: String,
}

/// Whether the parents exchange all of their genes or none, and why; `None` where only some.
fn whole_genomes(crossed: &Crossed, n_genes: usize) -> Option<Whole> {
    let exchanged = crossed.exchanged(n_genes);
    let all = exchanged.iter().all(|&one| one);
    if !all && exchanged.contains(&true) {
        return None;
    }
    let points: Vec<String> = crossed.points.iter().map(usize::to_string).collect();
    let given = match points.is_empty() {
        true => "there is no crossing point".to_owned(),
        false => format!("Cross_Point = {}", points.join(", ")),
    };
    let text = match (all, n_genes) {
        (true, 1) => format!("they exchange their only gene ({given})"),
        (true, _) => format!("they exchange all genes ({given})"),
        (false, 1) => format!("they do not exchange their only gene ({given})"),
        (false, _) => format!("they exchange no gene ({given})"),
    };
    Some(Whole { all, text })
}

fn mutate(walk: &TraceCursor, row: usize) -> String {
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

fn complete(walk: &TraceCursor, row: usize) -> String {
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

fn renew(walk: &TraceCursor) -> String {
    let Some(next) = walk.next_generation() else { return String::new() };
    let individuals = counted(next.len(), "individual");
    if next.has_parents() {
        return format!(
            "{} the next generation: {individuals}. The stop condition is not yet met.",
            formed_by(next)
        );
    }
    match next.is_drawn() {
        true => format!(
            "Another search begins: the {individuals} of the next generation are drawn at random; \
             none descends from this one."
        ),
        false => format!("The script makes the next generation: {individuals}."),
    }
}

/// Of which individuals a generation consists, with the verb.
fn formed_by(next: &Generation) -> String {
    let kinds = [
        ("elite", "elites"),
        ("child", "children"),
        ("random individual", "random individuals"),
        ("individual of the script", "individuals of the script"),
    ];
    let mut counts = [0_usize; 4];
    for origin in &next.origins {
        counts[match origin {
            Origin::Elite { .. } => 0,
            Origin::Child { .. } => 1,
            Origin::Random => 2,
            Origin::Script => 3,
        }] += 1;
    }
    let present = kinds.iter().zip(counts).filter(|(_, count)| *count > 0);
    let named = present
        .map(|((one, many), count)| format!("{count} {}", if count == 1 { one } else { many }));
    let mut named: Vec<String> = named.collect();
    let verb = if next.origins.len() == 1 { "forms" } else { "form" };
    match (named.pop(), named.is_empty()) {
        (Some(last), false) => format!("{} and {last} {verb}", named.join(", ")),
        (last, _) => format!("{} {verb}", last.unwrap_or_default()),
    }
}

fn operate(walk: &TraceCursor, row: usize) -> String {
    let Some(operation) = walk.operation() else { return String::new() };
    let text = operation_text::text(operation, row, &walk.trace().subject.parameters);
    match walk.is_last() && walk.trace().full {
        true => format!("{text} The trace reached its maximum size and ends here."),
        false => text,
    }
}

fn stop(walk: &TraceCursor) -> String {
    if walk.generation().is_call {
        return "The operator leaves all individuals as they are.".to_owned();
    }
    if walk.generation().is_evaluation {
        return last_evaluation(walk);
    }
    let why = match (walk.trace().full, walk.trace().cut) {
        (true, _) => "The trace reached its maximum size and ends here; the run continued",
        (_, true) => "The run was interrupted here",
        _ => "The run ends here",
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

/// The end of a script that simulates and compares, without a genetic algorithm.
fn last_evaluation(walk: &TraceCursor) -> String {
    let all = &walk.trace().generations;
    let individuals: usize = all.iter().map(Generation::len).sum();
    let best = all.iter().enumerate().filter_map(|(number, g)| Some((number, g.best()?)));
    let best = best.min_by(|a, b| a.1.1.total_cmp(&b.1.1)).filter(|best| !has_failed(best.1.1));
    let why = match (walk.trace().full, walk.trace().cut) {
        (true, _) => "The trace reached its maximum size and ends here; the run continued",
        (_, true) => "The run was interrupted here",
        _ => "The script simulates nothing further",
    };
    let what = format!("{why}: {} in all.", counted(individuals, "individual"));
    match best {
        Some((_, (_, fitness))) if individuals == 1 => {
            format!("{what} Its fitness is {}.", short(fitness))
        }
        Some((number, (k, fitness))) => format!(
            "{what} The best is individual {} of evaluation {} with the fitness {}.",
            k + 1,
            number + 1,
            short(fitness)
        ),
        None => format!("{what} No fitness was computed."),
    }
}
