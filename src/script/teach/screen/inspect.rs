//! One individual: its genes, and its simulation against what was measured.

use super::Screen;
use crate::teach::explain::short;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Color;
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::{Axis, Block, Borders, Chart, Dataset, GraphType, Paragraph, Wrap};

/// Draws individual `k` of the generation.
pub(crate) fn draw(screen: &Screen, k: usize, frame: &mut Frame, area: Rect) {
    let [left, right] =
        Layout::horizontal([Constraint::Min(30), Constraint::Length(36)]).areas(area);
    let (x, y) = &screen.walk.trace().measured;
    let simulated = simulated(screen, k);
    plot(screen, (x, y), simulated, frame, left);
    let title = format!(" individual {} ", k + 1);
    let block = Block::new().borders(Borders::ALL).title(title);
    let text = Paragraph::new(shortened(
        numbers(screen, k, simulated),
        usize::from(right.height.saturating_sub(2)),
    ))
    .wrap(Wrap { trim: false })
    .block(block);
    frame.render_widget(text, right);
}

/// The simulated points: the trace keeps those of the best of each generation, others are simulated
/// again.
fn simulated(screen: &Screen, k: usize) -> Option<&[f64]> {
    match &screen.again {
        Some((generation, known, row)) if (*generation, *known) == (screen.walk.number(), k) => {
            row.as_deref().ok()
        }
        _ => kept(screen, k),
    }
}

/// The simulated points that the trace has.
fn kept(screen: &Screen, k: usize) -> Option<&[f64]> {
    let generation = screen.walk.generation();
    let row = generation.best_simulated.as_slice();
    let (best, _) = generation.best()?;
    let is_best = generation.genome(best) == generation.genome(k);
    let fits = row.len() == screen.walk.trace().measured.1.len() && !row.is_empty();
    (is_best && fits).then_some(row)
}

/// Whether the curve of an individual is known from a simulation alone.
pub(crate) fn must_simulate(screen: &Screen, k: usize) -> bool {
    kept(screen, k).is_none() && screen.walk.generation().failure(k).is_none()
}

fn plot(
    screen: &Screen,
    (x, y): (&[f64], &[f64]),
    simulated: Option<&[f64]>,
    frame: &mut Frame,
    area: Rect,
) {
    let points = |values: &[f64]| x.iter().copied().zip(values.iter().copied()).collect::<Vec<_>>();
    let (measured, curve) = (points(y), points(simulated.unwrap_or_default()));
    let all = y.iter().chain(simulated.unwrap_or_default());
    let (x_ends, y_ends) = (ends(x.iter(), 0.0), ends(all, 0.03));
    let sets = vec![
        Dataset::default()
            .marker(Marker::Braille)
            .graph_type(GraphType::Line)
            .style(screen.styled(Color::Yellow))
            .data(&curve),
        Dataset::default()
            .marker(Marker::Custom('o'))
            .graph_type(GraphType::Scatter)
            .style(screen.styled(Color::Cyan))
            .data(&measured),
    ];
    let subject = &screen.walk.trace().subject;
    let axis = |title: &str, (low, high): (f64, f64)| {
        let labels = [low, (low + high) / 2.0, high].map(|value| Line::from(short(value)));
        Axis::default().title(title.to_owned()).bounds([low, high]).labels(labels)
    };
    let chart = Chart::new(sets)
        .block(Block::new().borders(Borders::ALL).title(" o measured, line: simulated "))
        .x_axis(axis(&subject.x_name, x_ends))
        .y_axis(axis(&subject.y_name, y_ends));
    frame.render_widget(chart, area);
}

/// The smallest and the largest of the values, and a margin beyond them in parts of their span.
fn ends<'a>(values: impl Iterator<Item = &'a f64>, margin: f64) -> (f64, f64) {
    let finite = values.copied().filter(|value| value.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    match high - low {
        span if span > 0.0 => (low - margin * span, high + margin * span),
        _ if low.is_finite() => (low - 0.5, low + 0.5),
        _ => (0.0, 1.0),
    }
}

/// At most so many lines: where there are more, some before the last, which has the sum, are left
/// out.
fn shortened(mut lines: Vec<Line<'static>>, most: usize) -> Vec<Line<'static>> {
    if let (Some(left_out @ 1..), Some(last)) = (lines.len().checked_sub(most), most.checked_sub(2))
    {
        let note = Line::from(format!("{:>9} more", format!("... {}", left_out + 1)));
        lines.splice(last..lines.len() - 1, [note]);
    }
    lines
}

fn numbers(screen: &Screen, k: usize, simulated: Option<&[f64]>) -> Vec<Line<'static>> {
    let (walk, generation) = (&screen.walk, screen.walk.generation());
    let subject = &walk.trace().subject;
    let mut lines = Vec::new();
    for (j, gene) in generation.genome(k).iter().enumerate() {
        let name = subject.parameters.get(j).cloned().unwrap_or_default();
        let unit = subject.units.get(j).cloned().unwrap_or_default();
        lines.push(Line::from(format!("{name} = {} {unit}", short(*gene))));
    }
    if let Some(cause) = generation.failure(k) {
        lines.push(Line::styled(format!("failed: {cause}"), screen.styled(Color::Red)));
        return lines;
    }
    if let Some(fitness) = generation.fitness.get(k) {
        lines.push(Line::from(format!("fitness {}", short(*fitness))));
    }
    let Some(simulated) = simulated else {
        if let Some((_, _, Err(why))) = &screen.again {
            lines.push(Line::from(why.clone()));
        }
        return lines;
    };
    lines.push(Line::from(format!("{:>9} {:>10} {:>10}", "residual", "squared", "sum")));
    let mut sum = 0.0;
    for (simulated, measured) in simulated.iter().zip(&walk.trace().measured.1) {
        let residual = simulated - measured;
        sum += residual * residual;
        let square = short(residual * residual);
        lines.push(Line::from(format!("{:>9} {square:>10} {:>10}", short(residual), short(sum))));
    }
    lines
}
