//! A run and what it would have been, on one chart: the run as a line, the changed one as dots, so
//! that they are distinguished without colours too.

use super::Screen;
use crate::elementary;
use crate::teach::explain::short;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Color;
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::{Axis, Block, Borders, Chart, Dataset, GraphType, Paragraph};

/// Draws both runs, and what came of the change below.
pub(crate) fn draw(screen: &Screen, frame: &mut Frame, area: Rect) {
    let Some(branches) = screen.branches() else { return };
    let [above, below] = Layout::vertical([Constraint::Min(4), Constraint::Length(2)]).areas(area);
    let [original, changed] = branches.curves();
    let logarithm = |curve: &[(f64, f64)]| -> Vec<(f64, f64)> {
        let positive = curve.iter().filter(|(_, fitness)| *fitness > 0.0);
        positive.map(|(generation, fitness)| (*generation, elementary::log10(*fitness))).collect()
    };
    let (original, changed) = (logarithm(&original), logarithm(&changed));
    let sets = vec![
        Dataset::default()
            .marker(Marker::Braille)
            .graph_type(GraphType::Line)
            .style(screen.styled(Color::Cyan))
            .data(&original),
        Dataset::default()
            .marker(Marker::Custom('o'))
            .graph_type(GraphType::Scatter)
            .style(screen.styled(Color::Yellow))
            .data(&changed),
    ];
    let both = || original.iter().chain(&changed);
    let x = bounds(both().map(|point| point.0));
    let y = bounds(both().map(|point| point.1));
    let title = format!(" what if {} from generation {} ", branches.change, branches.generation);
    let chart = Chart::new(sets)
        .block(Block::new().borders(Borders::ALL).title(title))
        .x_axis(axis("generation", x, |value| format!("{value:.0}")))
        .y_axis(axis("best fitness", y, |value| short(elementary::powf(10f64, value))));
    frame.render_widget(chart, above);
    let legend = "Line: original script, o: changed.";
    frame.render_widget(Paragraph::new(format!("{legend}\n{}", branches.verdict())), below);
}

fn axis(title: &str, (low, high): (f64, f64), shown: fn(f64) -> String) -> Axis<'static> {
    let labels = [low, (low + high) / 2.0, high].map(|value| Line::from(shown(value)));
    Axis::default().title(title.to_owned()).bounds([low, high]).labels(labels)
}

/// The least and the greatest, apart.
fn bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    match values.fold(ends, |(low, high), value| (low.min(value), high.max(value))) {
        (low, high) if low < high => (low, high),
        (low, _) if low.is_finite() => (low - 0.5, low + 0.5),
        _ => (0.0, 1.0),
    }
}
