//! Steps as plain text, 80 columns wide: for files, for terminals without a screen, and for tests.

use super::explain::{explain, short};
use super::generation::{Generation, Origin};
use super::operation_table::{self, Row};
use super::step::Step;
use super::walk::TraceCursor;
use crate::ga::has_failed;
use std::fmt::Write as _;

/// Columns of the text.
pub const WIDTH: usize = 79;
/// No more individuals than this are listed.
const LISTED: usize = 12;
/// No more terms of a sum than this are written.
const SUMMED: usize = 4;

/// The step that `walk` stands at: its heading, its sentence, the line of the script, and a table
/// where one helps.
pub fn step(walk: &TraceCursor) -> String {
    let (at, of) = walk.progress();
    let title = title(walk);
    let heading = format!("{}, step {} of {of}: {title}", place_in_run(walk), at + 1);
    let mut text = format!("{heading}\n{}\n", "-".repeat(heading.chars().count()));
    if let Some((script, line)) = walk.line() {
        let code = script.lines.get(line - 1).map_or("", |line| line.trim());
        let _ = writeln!(text, "{}", cut(&format!("{}:{line}  {code}", script.name)));
    }
    text.push_str(&wrapped(&explain(walk)));
    text.push_str(&table(walk));
    text
}

/// Which generation it is, or which call of operators where nothing is simulated.
pub(crate) fn place_in_run(walk: &TraceCursor) -> String {
    format!("{} {}", unit(walk.generation()), walk.number() + 1)
}

/// What the parts of a trace are that are counted.
pub fn unit(generation: &Generation) -> &'static str {
    match (generation.is_call, generation.is_evaluation) {
        (true, _) => "Call",
        (_, true) => "Evaluation",
        _ => "Generation",
    }
}

/// What a step is called.
pub fn title(walk: &TraceCursor) -> &'static str {
    match walk.step() {
        Step::Draw if walk.generation().is_evaluation => "sampling",
        Step::Draw => "initial population",
        Step::Simulate => "simulation",
        Step::Rate => "fitness",
        Step::Sort => "selection",
        Step::Elite => "elite",
        Step::Cross(_) => "crossover",
        Step::Mutate(_) => "mutation",
        Step::Complete(_) => "random completion",
        Step::Renew => "next generation",
        Step::Stop => "stop",
        Step::Operate { kind, .. } => kind.title(),
    }
}

/// One line for each generation: the best fitness, the mean of those that were simulated, failures.
pub fn summary(walk: &TraceCursor) -> String {
    let generations = &walk.trace().generations;
    let unit = unit(walk.generation()).to_lowercase();
    let mut text = format!("{unit:>10}  {:>12}  {:>12}  {:>8}\n", "best", "mean", "failed");
    if generations.iter().all(|generation| generation.is_call) {
        return String::new();
    }
    for (number, generation) in generations.iter().enumerate() {
        if !is_shown(number, generations.len()) {
            continue;
        }
        let rated: Vec<f64> =
            generation.fitness.iter().copied().filter(|fitness| !has_failed(*fitness)).collect();
        let mean = match rated.len() {
            0 => "-".to_owned(),
            count => short(rated.iter().sum::<f64>() / count as f64),
        };
        let best = generation.best().filter(|(_, fitness)| !has_failed(*fitness));
        let best = best.map_or_else(|| "-".to_owned(), |(_, fitness)| short(fitness));
        let failed = generation.failures.len();
        let _ = writeln!(text, "{:>10}  {:>12}  {:>12}  {failed:>8}", number + 1, best, mean);
    }
    text
}

/// The first ten, the last, and in between 1, 2 and 5 times the powers of ten.
fn is_shown(number: usize, of: usize) -> bool {
    let count = number + 1;
    let mut leading = count;
    while leading >= 10 && leading.is_multiple_of(10) {
        leading /= 10;
    }
    count <= 10 || count == of || matches!(leading, 1 | 2 | 5)
}

fn table(walk: &TraceCursor) -> String {
    let generation = walk.generation();
    match walk.step() {
        Step::Draw => individuals(walk, generation, &in_sequence(generation), Known::Genes),
        Step::Simulate => individuals(walk, generation, &in_sequence(generation), Known::Failures),
        Step::Rate => {
            let sequence = in_sequence(generation);
            individuals(walk, generation, &sequence, Known::Fitness) + &sum_of_best(walk)
        }
        Step::Sort => individuals(walk, generation, &generation.order(), Known::Rank),
        Step::Stop if generation.fitness.is_empty() => {
            individuals(walk, generation, &in_sequence(generation), Known::Failures)
        }
        Step::Stop => individuals(walk, generation, &generation.order(), Known::Fitness),
        Step::Elite => elites(walk),
        Step::Complete(row) => completed(walk, row),
        Step::Cross(rank) => family(walk, rank),
        Step::Mutate(row) => mutation(walk, row),
        Step::Renew => match walk.next_generation() {
            Some(next) => individuals(walk, next, &in_sequence(next), Known::Genes),
            None => String::new(),
        },
        Step::Operate { row, .. } => operated(walk, row),
    }
}

/// How much of a generation is known at a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Known {
    Genes,
    Failures,
    Fitness,
    Rank,
}

fn in_sequence(generation: &Generation) -> Vec<usize> {
    (0..generation.len()).collect()
}

/// A table of individuals in this order, with no more than is known.
fn individuals(
    walk: &TraceCursor,
    generation: &Generation,
    order: &[usize],
    known: Known,
) -> String {
    let last = if known == Known::Rank { "becomes" } else { "origin" };
    let mut text = heading(walk, &["no", "fitness"], last);
    for (rank, &k) in order.iter().take(LISTED).enumerate() {
        let fitness = match generation.fitness.get(k) {
            _ if known >= Known::Failures && generation.failure(k).is_some() => "failed".to_owned(),
            Some(&fitness) if known >= Known::Fitness => short(fitness),
            _ => "-".to_owned(),
        };
        let genes = cells(generation.genome(k));
        let note = match known {
            Known::Rank => role(generation, rank).to_owned(),
            _ => origin(generation, k),
        };
        let _ = writeln!(text, "{:>5} {fitness:>10}{genes}  {note}", k + 1);
    }
    if order.len() > LISTED {
        let _ = writeln!(text, "  ... and {} more", order.len() - LISTED);
    }
    text
}

/// What becomes of the individual of this rank, from 0.
fn role(generation: &Generation, rank: usize) -> &'static str {
    let (parents, elites) = match &generation.sorted {
        Some(sorted) => (sorted.parents, sorted.elites),
        None => (0, 0),
    };
    match (rank < elites, rank < parents) {
        (true, true) => "elite and parent",
        (true, false) => "elite",
        (false, true) => "parent",
        (false, false) => "forgotten",
    }
}

/// How the best individual got its fitness, as a sum. Nothing where another function than the
/// built-in `Fit` has computed it.
fn sum_of_best(walk: &TraceCursor) -> String {
    let (Some((k, fitness)), measured) = (walk.generation().best(), &walk.trace().measured.1)
    else {
        return String::new();
    };
    let simulated = &walk.generation().best_simulated;
    if simulated.len() != measured.len() || simulated.is_empty() {
        return String::new();
    }
    let terms: Vec<String> = simulated
        .iter()
        .zip(measured)
        .take(SUMMED)
        .map(|(simulated, measured)| format!("({} - {})^2", short(*simulated), short(*measured)))
        .collect();
    let more = if measured.len() > SUMMED { " + ..." } else { "" };
    let terms = terms.join(" + ");
    wrapped(&format!("fitness of {} = {terms}{more} = {}", k + 1, short(fitness)))
}

fn elites(walk: &TraceCursor) -> String {
    let generation = walk.generation();
    let Some(crossed) = &generation.crossed else { return String::new() };
    let order = generation.order();
    let elites = &order[..crossed.elites.min(order.len())];
    individuals(walk, generation, elites, Known::Fitness)
}

/// The random numbers of one individual and the genes they give.
fn completed(walk: &TraceCursor, row: usize) -> String {
    let Some(next) = walk.next_generation() else { return String::new() };
    let mut text = heading(walk, &["", ""], "");
    if let Some(numbers) = next.random_numbers(row) {
        let _ = writeln!(text, "{:<16}{}", "u", cells(&numbers));
    }
    let _ = writeln!(text, "{:<16}{}", "genes", cells(next.genome(row)));
    text
}

fn origin(generation: &Generation, k: usize) -> String {
    match generation.origins.get(k) {
        Some(Origin::Elite { from }) => format!("elite, was {}", from + 1),
        Some(Origin::Child { parent, mate, mutated }) => {
            let both = match mate == parent {
                true => String::new(),
                false => format!(" and {}", mate + 1),
            };
            let changed = match mutated.len() {
                0 => String::new(),
                count => format!(", {count} mutated"),
            };
            format!("child of {}{both}{changed}", parent + 1)
        }
        Some(Origin::Random) => "random".to_owned(),
        Some(Origin::Script) | None => "set by the script".to_owned(),
    }
}

/// The parents above their children, `|` at the crossing points.
fn family(walk: &TraceCursor, rank: usize) -> String {
    let generation = walk.generation();
    let Some(crossed) = &generation.crossed else { return String::new() };
    let mating = super::generation::mating(rank, crossed.parents);
    let order = generation.order();
    let mut text = heading(walk, &["", ""], "");
    for parent in mating.parents {
        if let Some(&k) = order.get(parent) {
            let genes = divided(generation.genome(k), &crossed.points);
            let _ = writeln!(text, "rank {:>3}        {genes}", parent + 1);
        }
    }
    for child in mating.children {
        let row = crossed.elites + child;
        if let Some(genes) = crossed.rows.chunks_exact(generation.n_genes).nth(row) {
            let genes = divided(genes, &crossed.points);
            let _ = writeln!(text, "child {:>3}       {genes}", child + 1);
        }
    }
    text
}

/// The numbers of one child, and its genes before and after.
fn mutation(walk: &TraceCursor, row: usize) -> String {
    let generation = walk.generation();
    let Some(mutated) = &generation.mutated else { return String::new() };
    let n = generation.n_genes;
    let range = row * n..(row + 1) * n;
    let (Some(numbers), Some(before), Some(after)) = (
        mutated.numbers.get(range.clone()),
        mutated.before.get(range.clone()),
        mutated.after.get(range),
    ) else {
        return String::new();
    };
    let mut text = heading(walk, &["", ""], "");
    for (name, values) in [("u", numbers), ("before", before), ("after", after)] {
        let _ = writeln!(text, "{name:<16}{}", cells(values));
    }
    let changed = generation.mutated_genes(row);
    let marks = (0..n).map(|j| if changed.contains(&j) { "          *" } else { "           " });
    let marks: String = marks.collect();
    if !changed.is_empty() {
        let _ = writeln!(text, "{}", format!("{:<16}{marks}", "").trim_end());
    }
    text
}

/// What an operator was given and what it returned.
fn operated(walk: &TraceCursor, row: usize) -> String {
    let Some(operation) = walk.operation() else { return String::new() };
    let table = operation_table::table(operation, row, &walk.trace().subject.parameters);
    if table.rows.is_empty() {
        return String::new();
    }
    let names = table.columns.iter().map(|name| format!("{:>10} ", shortened(name)));
    let line = format!("{:<10}{}", "", names.collect::<String>());
    let mut text = format!("{}\n", line.trim_end());
    for Row { name, cells, note } in table.rows.iter().take(LISTED) {
        let cells = cells.iter().map(|(value, mark)| format!("{:>10}{mark}", short(*value)));
        let line = format!("{name:<10}{}  {note}", cells.collect::<String>());
        let _ = writeln!(text, "{}", line.trim_end());
    }
    if let Some(more @ 1..) = table.rows.len().checked_sub(LISTED) {
        let _ = writeln!(text, "  ... and {more} more");
    }
    if !table.legend.is_empty() {
        let _ = writeln!(text, "{}", table.legend);
    }
    text
}

fn heading(walk: &TraceCursor, first: &[&str; 2], last: &str) -> String {
    let names = walk.trace().subject.parameters.iter().take(walk.generation().n_genes);
    let names: String = names.map(|name| format!(" {:>10}", shortened(name))).collect();
    let line = format!("{:>5} {:>10}{names}  {last}", first[0], first[1]);
    format!("{}\n", line.trim_end())
}

fn shortened(name: &str) -> String {
    let count = name.chars().count();
    name.chars().skip(count.saturating_sub(10)).collect()
}

fn cells(genes: &[f64]) -> String {
    genes.iter().map(|gene| format!(" {:>10}", short(*gene))).collect()
}

fn divided(genes: &[f64], points: &[usize]) -> String {
    let bar = |j: usize| if points.contains(&j) { '|' } else { ' ' };
    genes.iter().enumerate().map(|(j, gene)| format!("{}{:>10}", bar(j), short(*gene))).collect()
}

/// The text up to [`WIDTH`] columns.
fn cut(text: &str) -> String {
    match text.chars().count() {
        count if count <= WIDTH => text.to_owned(),
        _ => text.chars().take(WIDTH - 3).chain("...".chars()).collect(),
    }
}

/// The text in lines of at most [`WIDTH`] columns.
pub fn wrapped(text: &str) -> String {
    let (mut out, mut column) = (String::new(), 0);
    for word in text.split_whitespace() {
        let width = word.chars().count();
        if column > 0 && column + 1 + width > WIDTH {
            out.push('\n');
            column = 0;
        } else if column > 0 {
            out.push(' ');
            column += 1;
        }
        out.push_str(word);
        column += width;
    }
    out.push('\n');
    out
}
