//! The table of one step of a call of an operator: individuals with their genes, those that changed
//! marked. Text, screen and page show the same.

pub(super) use super::generation::mate;
use super::operation::{Action, Operation};
use serde::Serialize;

/// Individuals one below the other.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Table {
    /// What the numbers are.
    pub columns: Vec<String>,
    /// The individuals.
    pub rows: Vec<Row>,
    /// What the marks mean; empty where there are none.
    pub legend: &'static str,
}

/// One individual.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Row {
    /// What it is called.
    pub name: String,
    /// Its numbers, each with a mark or a blank.
    pub cells: Vec<(f64, char)>,
    /// What became of it.
    pub note: String,
}

/// Marks of the genes of children.
const CHILDREN: &str = "a, b: the value of that parent; =: both have it; *: neither has it";
/// Mark of the genes that a mutation changed.
const MUTATED: &str = "*: changed";

/// The table of the step at `row`; `names` are those of the genes.
pub(crate) fn table(operation: &Operation, row: usize, names: &[String]) -> Table {
    let genes = || names.iter().take(operation.n_genes as usize).cloned();
    match &operation.action {
        Action::Sampling { sampled, .. } => {
            let rows = (0..operation.count(sampled)).map(|k| {
                let name = format!("row {}", k + 1);
                Row { name, cells: unmarked(operation.row(sampled, k)), note: String::new() }
            });
            Table { columns: genes().collect(), rows: rows.collect(), legend: "" }
        }
        Action::Selection { fitness, places } => {
            let columns = vec!["fitness".to_owned()];
            Table { columns, rows: selected(fitness, places), legend: "" }
        }
        Action::Crossover { parents, children } => {
            let rows = family(operation, row, parents, children);
            let legend = if operation.count(parents) > 1 { CHILDREN } else { "" };
            Table { columns: genes().collect(), rows, legend }
        }
        Action::Mutation { before, after, .. } => {
            let rows = mutated(operation.row(before, row), operation.row(after, row));
            let is_marked = rows.iter().flat_map(|row| &row.cells).any(|(_, mark)| *mark == '*');
            let legend = if is_marked { MUTATED } else { "" };
            Table { columns: genes().collect(), rows, legend }
        }
        Action::Survival { .. } => {
            let columns = [String::from("fitness")].into_iter().chain(genes()).collect();
            Table { columns, rows: survivors(operation), legend: "" }
        }
    }
}

fn unmarked(genes: &[f64]) -> Vec<(f64, char)> {
    genes.iter().map(|&gene| (gene, ' ')).collect()
}

/// How often each row was selected, from 0.
pub(super) fn times(count: usize, places: &[u32]) -> Vec<usize> {
    let mut times = vec![0; count];
    places.iter().for_each(|&place| times[place as usize] += 1);
    times
}

/// All individuals, those first that were selected most often.
fn selected(fitness: &[f64], places: &[u32]) -> Vec<Row> {
    let times = times(fitness.len(), places);
    let mut order: Vec<usize> = (0..fitness.len()).collect();
    order.sort_by_key(|&k| std::cmp::Reverse(times[k]));
    let row = |k: usize| {
        let note = match times[k] {
            0 => "not selected".to_owned(),
            1 => "selected once".to_owned(),
            often => format!("selected {often} times"),
        };
        Row { name: format!("row {}", k + 1), cells: unmarked(&fitness[k..=k]), note }
    };
    order.into_iter().map(row).collect()
}

/// Two parents and their children; a last one without partner has one child.
fn family(operation: &Operation, row: usize, parents: &[f64], children: &[f64]) -> Vec<Row> {
    if operation.count(parents) == 0 {
        return Vec::new();
    }
    let mate = mate(row, operation.count(parents));
    let (a, b) = (operation.row(parents, row), operation.row(parents, mate));
    let parent = |letter: char, k: usize, genes: &[f64]| Row {
        name: format!("{letter}: row {}", k + 1),
        cells: unmarked(genes),
        note: String::new(),
    };
    let child = |k: usize| {
        let genes = operation.row(children, k);
        let marks = inherited(genes, a, b);
        let cells = match mate == row {
            true => unmarked(genes),
            false => genes.iter().copied().zip(marks).collect(),
        };
        Row { name: format!("child {}", k + 1), cells, note: String::new() }
    };
    let mut rows = vec![parent('a', row, a)];
    rows.extend((mate != row).then(|| parent('b', mate, b)));
    rows.push(child(row));
    rows.extend((mate > row).then(|| child(mate)));
    rows
}

/// For each gene of a child, which of its parents has the same value.
pub(super) fn inherited(child: &[f64], a: &[f64], b: &[f64]) -> Vec<char> {
    let of = |(gene, (a, b)): (&f64, (&f64, &f64))| match (same(*gene, *a), same(*gene, *b)) {
        (true, true) => '=',
        (true, false) => 'a',
        (false, true) => 'b',
        (false, false) => '*',
    };
    child.iter().zip(a.iter().zip(b)).map(of).collect()
}

/// An individual before and after, the changed genes marked.
fn mutated(before: &[f64], after: &[f64]) -> Vec<Row> {
    if before.is_empty() {
        return Vec::new();
    }
    let changed = changed(before, after);
    let mark = |j: usize| if changed.contains(&j) { '*' } else { ' ' };
    let cells = after.iter().enumerate().map(|(j, &gene)| (gene, mark(j))).collect();
    let before = Row { name: "before".to_owned(), cells: unmarked(before), note: String::new() };
    vec![before, Row { name: "after".to_owned(), cells, note: String::new() }]
}

/// Which genes differ, from 0.
pub(super) fn changed(before: &[f64], after: &[f64]) -> Vec<usize> {
    let pairs = before.iter().zip(after).enumerate();
    pairs.filter(|(_, (before, after))| !same(**before, **after)).map(|(j, _)| j).collect()
}

/// Whether two genes are the same value; two that are not a number are.
fn same(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

/// The next generation in its order, and those that do not belong to it.
fn survivors(operation: &Operation) -> Vec<Row> {
    let Action::Survival { old, fitness, offspring, fitness_offspring, survivors } =
        &operation.action
    else {
        return Vec::new();
    };
    let row = |k: usize, note: String| {
        let (name, fitness, genes) = match k.checked_sub(fitness.len()) {
            None => (format!("old {}", k + 1), fitness[k], operation.row(old, k)),
            Some(k) => {
                (format!("child {}", k + 1), fitness_offspring[k], operation.row(offspring, k))
            }
        };
        let cells = unmarked(&[&[fitness], genes].concat());
        Row { name, cells, note }
    };
    let mut lives = vec![false; fitness.len() + fitness_offspring.len()];
    survivors.iter().for_each(|&one| lives[one as usize] = true);
    let next = survivors.iter().enumerate();
    let next = next.map(|(k, &one)| row(one as usize, format!("survives as row {}", k + 1)));
    let others = (0..lives.len()).filter(|&k| !lives[k]).map(|k| row(k, "forgotten".to_owned()));
    next.chain(others).collect()
}
