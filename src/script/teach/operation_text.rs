//! A step of a call of an operator in words: the operator with its settings, what it was given and
//! what it returned.

use super::operation::{Action, Operation};
use super::operation_table::{changed, inherited, mate, times};
use super::words::{counted, short};
use crate::ga::{has_failed, order};

/// No more numbers than this are listed in a sentence.
const LISTED: usize = 12;

/// What the step at `row` of the call did; `names` are those of the genes.
pub(crate) fn text(operation: &Operation, row: usize, names: &[String]) -> String {
    let named = named(operation);
    match &operation.action {
        Action::Sampling { sampled, minima, maxima } => {
            sampling(&named, operation, sampled, (minima, maxima))
        }
        Action::Selection { fitness, places } => selection(&named, fitness, places),
        Action::Crossover { parents, children } => {
            let text = crossover(operation, row, parents, children);
            format!("{named} {text}")
        }
        Action::Mutation { before, after, elites, factor } => {
            let count = operation.count(before);
            if count == 0 {
                return format!("{named} is given no individuals and returns none.");
            }
            if *elites as usize >= count {
                let (given, elites) = (counted(count, "individual"), *elites);
                return format!(
                    "{named} is given {given} and returns {} unchanged: Elitism is {elites}.",
                    if count == 1 { "it" } else { "them" }
                );
            }
            let changes = mutation(operation.row(before, row), operation.row(after, row), names);
            format!("{named} and F_Mut = {factor}: row {} {changes}", row + 1)
        }
        Action::Survival { .. } => format!("{named} {}", survival(operation)),
    }
}

/// The command and the operator that it was given.
fn named(operation: &Operation) -> String {
    let command = operation.kind().command();
    match operation.is_own {
        true => format!("{command} with your own function `{}`", operation.operator),
        false => format!("{command} with `{}`", operation.operator),
    }
}

fn sampling(
    named: &str,
    operation: &Operation,
    sampled: &[f64],
    (minima, maxima): (&[f64], &[f64]),
) -> String {
    if sampled.is_empty() {
        return format!("{named} returns no individuals.");
    }
    format!(
        "{named} returns {}, one in each row: {} each, for Param_Min = {} and Param_Max = {}.",
        counted(operation.count(sampled), "individual"),
        counted(operation.n_genes as usize, "gene"),
        listed(minima),
        listed(maxima),
    )
}

/// Numbers as an array of the language.
fn listed(values: &[f64]) -> String {
    let mut shown: Vec<String> = values.iter().take(LISTED).map(|value| short(*value)).collect();
    shown.extend((values.len() > LISTED).then(|| "...".to_owned()));
    format!("{{{}}}", shown.join(", "))
}

fn selection(named: &str, fitness: &[f64], places: &[u32]) -> String {
    let given = format!(
        "{named} is given the fitness of {} (smaller is better) and returns {}",
        counted(fitness.len(), "individual"),
        counted(places.len(), "parent"),
    );
    let times = times(fitness.len(), places);
    let different = times.iter().filter(|&&often| often > 0).count();
    match places.len() {
        0 => format!("{given}."),
        1..=LISTED => {
            let rows: Vec<String> = places.iter().map(|place| (place + 1).to_string()).collect();
            let mates = match places.len() {
                1 => "",
                _ => {
                    " In this order the first and the second mate, the third and the fourth, and \
                      so on."
                }
            };
            let word = if places.len() == 1 { "row" } else { "rows" };
            let missing = counted(fitness.len() - different, "individual");
            format!("{given}: {word} {}.{mates} Not selected: {missing}.", rows.join(", "))
        }
        _ => format!(
            "{given}. These are {different} different rows; the other {} are not selected.",
            fitness.len() - different
        ),
    }
}

fn crossover(operation: &Operation, row: usize, parents: &[f64], children: &[f64]) -> String {
    if operation.count(parents) == 0 {
        return "is given no parents and returns no children.".to_owned();
    }
    let mate = mate(row, operation.count(parents));
    let (a, b) = (operation.row(parents, row), operation.row(parents, mate));
    let (pair, born) = match mate.cmp(&row) {
        std::cmp::Ordering::Greater => (
            format!("rows {} (a) and {} (b) have two children", row + 1, mate + 1),
            vec![row, mate],
        ),
        // A single parent mates with itself: a child without changes is its copy.
        std::cmp::Ordering::Equal => {
            let marks = inherited(operation.row(children, row), a, b);
            let child = match marks.iter().filter(|&&mark| mark == '*').count() {
                0 => "is a copy of it".to_owned(),
                new => format!("has {} with a value of its own", counted(new, "gene")),
            };
            return format!("is given 1 parent: row 1 has a child, which {child}.");
        }
        std::cmp::Ordering::Less => (
            format!("row {} (a), the last, mates with row 1 (b) and has a child", row + 1),
            vec![row],
        ),
    };
    let each = born.iter().map(|&k| {
        let marks = inherited(operation.row(children, k), a, b);
        format!("Child {} {}", k + 1, heritage(&marks))
    });
    format!("is given {}: {pair}. {}", counted(operation.count(parents), "parent"), joined(each))
}

fn joined(sentences: impl Iterator<Item = String>) -> String {
    sentences.collect::<Vec<_>>().join(" ")
}

/// Where the genes of a child come from.
fn heritage(marks: &[char]) -> String {
    let count = |mark: char| marks.iter().filter(|&&found| found == mark).count();
    let (a, b, both, new) = (count('a'), count('b'), count('='), count('*'));
    if both == marks.len() {
        return "is equal to both parents.".to_owned();
    }
    if both + a == marks.len() || both + b == marks.len() {
        return format!("is equal to parent {}.", if b == 0 { 'a' } else { 'b' });
    }
    let parts = [
        (a, "of parent a"),
        (b, "of parent b"),
        (both, "that both have"),
        (new, "with a value that neither has"),
    ];
    let parts = parts.iter().filter(|(count, _)| *count > 0);
    let parts: Vec<String> =
        parts.map(|(count, whose)| format!("{} {whose}", counted(*count, "gene"))).collect();
    format!("has {}.", parts.join(", "))
}

fn mutation(before: &[f64], after: &[f64], names: &[String]) -> String {
    let changed = changed(before, after);
    let change = |&j: &usize| {
        let name = names.get(j).map_or_else(|| format!("gene {}", j + 1), Clone::clone);
        format!("{name} from {} to {}", short(before[j]), short(after[j]))
    };
    match changed.len() {
        0 if before.len() == 1 => "keeps its gene.".to_owned(),
        0 => format!("keeps all {} genes.", before.len()),
        count => {
            let changes: Vec<String> = changed.iter().take(LISTED).map(change).collect();
            let more = if count > LISTED { "; ..." } else { "" };
            let all = counted(before.len(), "gene");
            format!("changes in {count} of {all}: {}{more}.", changes.join("; "))
        }
    }
}

fn survival(operation: &Operation) -> String {
    let Action::Survival { fitness, fitness_offspring, survivors, .. } = &operation.action else {
        return String::new();
    };
    let all = [fitness.as_slice(), fitness_offspring].concat();
    let next: Vec<f64> = survivors.iter().map(|&one| all[one as usize]).collect();
    let old = survivors.iter().filter(|&&one| (one as usize) < fitness.len()).count();
    let kept = format!(
        "is given {} of the old generation and {} of the offspring, and returns {}: {old} of the \
         old generation and {} of the offspring.",
        counted(fitness.len(), "individual"),
        fitness_offspring.len(),
        next.len(),
        next.len() - old,
    );
    match (best(fitness), best(&next)) {
        (Some(before), Some(after)) => format!(
            "{kept} The best fitness of the old generation is {}, that of the next one {}.",
            short(before),
            short(after)
        ),
        _ => kept,
    }
}

/// The best fitness, if one was simulated.
fn best(fitness: &[f64]) -> Option<f64> {
    let best = order(fitness).first().map(|&k| fitness[k]);
    best.filter(|best| !has_failed(*best))
}
