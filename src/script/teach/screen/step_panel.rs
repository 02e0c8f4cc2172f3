//! The right side: the population, or what crossover, mutation and operators by name do to genes.

use super::Screen;
use crate::ga::has_failed;
use crate::teach::explain::short;
use crate::teach::generation::{Generation, Mating, Origin, mating};
use crate::teach::operation::OperationKind;
use crate::teach::operation_table::{self, Row, Table};
use crate::teach::step::{Phase, Step};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};

/// Columns of a row before its genes, and of one gene as a number.
const BEFORE: u16 = 18;
const NUMBER: u16 = 11;

/// Columns of the population with its genes as numbers.
pub(crate) fn width_of_numbers(screen: &Screen) -> u16 {
    let n = u16::try_from(screen.walk.generation().n_genes).unwrap_or(u16::MAX);
    NUMBER.saturating_mul(n).saturating_add(BEFORE)
}

/// Lines of the panel, `width` columns wide, and the one that should be seen.
pub(crate) fn lines(screen: &Screen, width: u16) -> (Vec<Line<'static>>, usize) {
    let walk = &screen.walk;
    match walk.step() {
        Step::Cross(rank) => (crossover(screen, rank), 0),
        Step::Mutate(row) => (mutation(screen, row), 0),
        Step::Operate { kind, row, .. } => (operation(screen, kind, row), 0),
        _ => population(screen, width >= width_of_numbers(screen)),
    }
}

impl Screen {
    pub(super) fn styled(&self, colour: Color) -> Style {
        if self.colour { Style::new().fg(colour) } else { Style::new() }
    }
}

fn population(screen: &Screen, as_numbers: bool) -> (Vec<Line<'static>>, usize) {
    let walk = &screen.walk;
    let renewed = matches!(walk.step(), Step::Renew | Step::Complete(_));
    let generation = match walk.next_generation() {
        Some(next) if renewed => next,
        _ => walk.generation(),
    };
    let phase = if renewed { Phase::Drawing } else { walk.step().phase() };
    let known_fitness = phase > Phase::Judging || walk.step() == Step::Rate;
    let known_failures = known_fitness || phase == Phase::Judging;
    let order = match phase > Phase::Judging {
        true => generation.order(),
        false => (0..generation.len()).collect(),
    };
    let selects = phase == Phase::Selecting;
    let parents = generation.sorted.as_ref().filter(|_| selects).map(|sorted| sorted.parents);
    let names = names(screen, as_numbers);
    let mut lines = vec![Line::from(format!("  no    fitness  {names}"))];
    let mut shown = 0;
    for (place, &k) in order.iter().enumerate() {
        let followed = !renewed && screen.followed == Some(k);
        let newcomer = walk.step() == Step::Complete(k);
        if followed || newcomer {
            shown = place + 1;
        }
        let failed = known_failures && generation.failure(k).is_some();
        let fitness = match generation.fitness.get(k) {
            _ if failed => "failed".to_owned(),
            Some(&fitness) if known_fitness => short(fitness),
            _ => "-".to_owned(),
        };
        let pointer = if followed || newcomer { '>' } else { ' ' };
        let text = format!("{pointer}{}{:>3} {fitness:>10}  ", mark(generation, k, failed), k + 1);
        let style = if failed { screen.styled(Color::Red) } else { Style::new() };
        let mut spans = vec![Span::styled(text, style)];
        spans.extend(match as_numbers {
            true => numbers(screen, generation, k),
            false => shades(screen, generation, k),
        });
        if parents == Some(place) {
            lines.push(Line::from("- - - no parents from here on - - -"));
        }
        lines.push(Line::from(spans));
    }
    (lines, shown)
}

/// `♛` for an elite, `x` for a failed simulation, `?` for a random newcomer.
fn mark(generation: &Generation, k: usize, failed: bool) -> char {
    match generation.origins.get(k) {
        _ if failed => 'x',
        Some(Origin::Elite { .. }) => '♛',
        Some(Origin::Random) => '?',
        _ => ' ',
    }
}

/// The first letters of the parameters, over their columns; the last ones where there is more room,
/// since the names of a model often begin alike.
fn names(screen: &Screen, as_numbers: bool) -> String {
    let n = screen.walk.generation().n_genes;
    let names = screen.walk.trace().subject.parameters.iter().take(n);
    if as_numbers {
        let last = |name: &String| {
            let skipped = name.chars().count().saturating_sub(10);
            format!("{:>10} ", name.chars().skip(skipped).collect::<String>())
        };
        return names.map(last).collect();
    }
    names.map(|name| format!("{:<3}", name.chars().take(2).collect::<String>())).collect()
}

/// The genes as numbers; changed ones are marked.
fn numbers(screen: &Screen, generation: &Generation, k: usize) -> Vec<Span<'static>> {
    let changed = changed(generation, k);
    let number = |(j, gene): (usize, &f64)| match changed.contains(&j) {
        true => Span::styled(format!("{:>10}*", short(*gene)), screen.styled(Color::Yellow)),
        false => Span::raw(format!("{:>10} ", short(*gene))),
    };
    generation.genome(k).iter().enumerate().map(number).collect()
}

/// The genes of an individual that mutated when it came to be.
fn changed(generation: &Generation, k: usize) -> &[usize] {
    match generation.origins.get(k) {
        Some(Origin::Child { mutated, .. }) => mutated,
        _ => &[],
    }
}

/// A block for each gene, fuller the higher it lies within the population; changed genes are marked.
fn shades(screen: &Screen, generation: &Generation, k: usize) -> Vec<Span<'static>> {
    let changed = changed(generation, k);
    let shade = |(j, gene): (usize, &f64)| {
        let column = || generation.genes.iter().skip(j).step_by(generation.n_genes.max(1));
        let low = column().copied().fold(f64::INFINITY, f64::min);
        let high = column().copied().fold(f64::NEG_INFINITY, f64::max);
        let part = if high > low { (gene - low) / (high - low) } else { 0.5 };
        let block = ["·", "░", "▒", "▓", "█"][((part * 5.0) as usize).min(4)];
        match changed.contains(&j) {
            true => Span::styled(format!("{block}* "), screen.styled(Color::Yellow)),
            false => Span::raw(format!("{block}{block} ")),
        }
    };
    generation.genome(k).iter().enumerate().map(shade).collect()
}

fn gene_name(screen: &Screen, j: usize) -> String {
    let name = screen.walk.trace().subject.parameters.get(j);
    let name = name.cloned().unwrap_or_else(|| format!("gene {}", j + 1));
    name.chars().take(7).collect()
}

/// One gene a line: two parents, two children; each child's gene in the colour and with the mark of
/// the parent it comes from.
fn crossover(screen: &Screen, rank: usize) -> Vec<Line<'static>> {
    let generation = screen.walk.generation();
    let Some(crossed) = &generation.crossed else { return Vec::new() };
    let Mating { parents, children } = mating(rank, crossed.parents);
    let order = generation.order();
    let at = |rank: &usize| order.get(*rank).copied();
    let Some(sources) = parents.iter().map(at).collect::<Option<Vec<usize>>>() else {
        return Vec::new();
    };
    let n = generation.n_genes;
    let exchanged = crossed.exchanged(n);
    let styles = [screen.styled(Color::Cyan), screen.styled(Color::Yellow)];
    let marks = ['a', 'b'];
    let mut heading = vec![Span::raw(format!("{:<7}", ""))];
    heading.extend(parents.iter().enumerate().map(|(from, rank)| {
        let name = format!("{}:rank{}", marks[from], rank + 1);
        Span::styled(format!("{name:>8}"), styles[from])
    }));
    let named = |child: &usize| Span::raw(format!("{:>8}", format!("child{}", child + 1)));
    heading.extend(children.iter().map(named));
    let mut lines = vec![Line::from(heading)];
    let child = |row: usize, j: usize| crossed.rows.get((crossed.elites + row) * n + j).copied();
    for (j, &is_exchanged) in exchanged.iter().enumerate() {
        if j > 0 && parents.len() > 1 && crossed.points.contains(&j) {
            lines.push(Line::from("- - - - - - exchanged after this gene - - -"));
        }
        let swapped = usize::from(is_exchanged && parents.len() > 1);
        let cell = |value: f64, from: usize| {
            Span::styled(format!("{:>7}{}", narrow(value), marks[from]), styles[from])
        };
        let mut spans = vec![Span::raw(format!("{:<7}", gene_name(screen, j)))];
        let own = sources.iter().enumerate();
        spans.extend(own.map(|(from, &k)| cell(generation.genome(k)[j], from)));
        for (which, &row) in children.iter().enumerate() {
            let from = if which == 0 { swapped } else { 1 - swapped };
            spans.extend(child(row, j).map(|value| cell(value, from)));
        }
        lines.push(Line::from(spans));
    }
    lines
}

/// What an operator was given and what it returned: one gene a line for a family, whose rows are
/// few, else one individual a line.
fn operation(screen: &Screen, kind: OperationKind, row: usize) -> Vec<Line<'static>> {
    let Some(operation) = screen.walk.operation() else { return Vec::new() };
    let table = operation_table::table(operation, row, &screen.walk.trace().subject.parameters);
    let mut lines = match kind {
        OperationKind::Crossover | OperationKind::Mutation => genes_down(screen, &table),
        OperationKind::Sampling | OperationKind::Selection | OperationKind::Survival => {
            rows_down(&table)
        }
    };
    lines.extend(table.legend.split("; ").map(Line::from).filter(|line| line.width() > 0));
    lines
}

/// One gene a line, marked as the table has it.
fn genes_down(screen: &Screen, table: &Table) -> Vec<Line<'static>> {
    let names = table.rows.iter().map(|row| format!("{:>8}", row.name.replace(' ', "")));
    let mut lines = vec![Line::from(format!("{:<7}{}", "", names.collect::<String>()))];
    let style = |mark: char| match mark {
        'a' => screen.styled(Color::Cyan),
        'b' => screen.styled(Color::Yellow),
        '*' => screen.styled(Color::Yellow).add_modifier(Modifier::BOLD),
        _ => Style::new(),
    };
    for j in 0..table.columns.len() {
        let cells = table.rows.iter().map(|row| row.cells[j]);
        let cells = cells
            .map(|(value, mark)| Span::styled(format!("{:>7}{mark}", narrow(value)), style(mark)));
        let name = Span::raw(format!("{:<7}", gene_name(screen, j)));
        lines.push(Line::from([vec![name], cells.collect()].concat()));
    }
    lines
}

/// One individual a line; its outcome precedes its genes, which may be many.
fn rows_down(table: &Table) -> Vec<Line<'static>> {
    let wide = table.rows.iter().map(|row| row.note.chars().count()).max().unwrap_or(0);
    let line = |name: &str, cells: &[String], note: &str| {
        let (first, rest) = if wide == 0 { (0, cells) } else { (1, &cells[1..]) };
        let number = |cell: &String| format!("{cell:>11}");
        let first: String = cells[..first].iter().map(number).collect();
        let rest: String = rest.iter().map(number).collect();
        let note = if wide == 0 { String::new() } else { format!(" {note:<wide$}") };
        Line::from(format!("{name:<9}{first}{note}{rest}"))
    };
    let last = |name: &String| {
        let skipped = name.chars().count().saturating_sub(10);
        name.chars().skip(skipped).collect::<String>()
    };
    let heads: Vec<String> = table.columns.iter().map(last).collect();
    let mut lines = vec![line("", &heads, "")];
    lines.extend(table.rows.iter().map(|Row { name, cells, note }| {
        let cells: Vec<String> = cells.iter().map(|(value, _)| short(*value)).collect();
        line(name, &cells, note)
    }));
    lines
}

/// At most seven columns.
fn narrow(value: f64) -> String {
    let text = short(value);
    if text.chars().count() <= 7 { text } else { format!("{value:.1e}") }
}

/// One gene a line: its random number and what it decides.
fn mutation(screen: &Screen, row: usize) -> Vec<Line<'static>> {
    let generation = screen.walk.generation();
    let Some(mutated) = &generation.mutated else { return Vec::new() };
    let n = generation.n_genes;
    let changed = generation.mutated_genes(row);
    let title = format!("{:<7}{:>7}{:>11}{:>11}", "", "u", "before", "after");
    let mut lines = vec![Line::from(title)];
    for j in 0..n {
        let at = row * n + j;
        let (Some(u), Some(before), Some(after)) =
            (mutated.numbers.get(at), mutated.before.get(at), mutated.after.get(at))
        else {
            continue;
        };
        let hit = changed.contains(&j);
        let sign = if hit { '<' } else { ' ' };
        let text = format!(
            "{:<7}{u:>7.3}{sign}{:>10}{:>11}{}",
            gene_name(screen, j),
            short(*before),
            short(*after),
            if hit { '*' } else { ' ' }
        );
        let style = if hit {
            screen.styled(Color::Yellow).add_modifier(Modifier::BOLD)
        } else {
            Style::new()
        };
        lines.push(Line::styled(text, style));
    }
    lines.push(Line::from(""));
    lines.push(Line::from(format!("< u is below F_Mut = {}   * changed", mutated.factor)));
    let fitness =
        generation.best().map(|(_, fitness)| fitness).filter(|fitness| !has_failed(*fitness));
    if let Some(fitness) = fitness {
        lines.push(Line::from(format!("best fitness so far: {}", short(fitness))));
    }
    lines
}
