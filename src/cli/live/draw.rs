//! The frame: heading, fit, convergence, spread of the genes, and the line of keys.

use crate::elementary;
use crate::script::runs::view::{Fitted, Spread, View};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Axis, Block, Borders, Chart, Dataset, Gauge, GraphType, Paragraph};

const KEYS: &str = "p pause and change settings   Ctrl-C stop and keep the results so far";
/// Columns of a gene's name, value and unit beside its bar.
const LABEL: usize = 34;
/// Series drawn beside each other.
const SERIES: usize = 2;

/// Draws the run; `message` is what was printed last.
pub(super) fn draw(view: &View, message: &str, frame: &mut Frame) {
    let genes = (view.spreads.len() as u16).min(frame.area().height / 3) + 2;
    let [top, bar, charts, spreads, said, keys] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Length(1),
        Constraint::Min(6),
        Constraint::Length(genes),
        Constraint::Length(1),
        Constraint::Length(1),
    ])
    .areas(frame.area());
    let bold = Style::new().add_modifier(Modifier::BOLD);
    frame.render_widget(Paragraph::new(Line::styled(view.title.as_str(), bold)), top);
    progress(view, frame, bar);
    let shown = view.fitted.len().min(SERIES);
    let columns = vec![Constraint::Fill(1); shown + 1];
    let areas = Layout::horizontal(columns).split(charts);
    convergence(&view.best, frame, areas[0]);
    for (fitted, area) in view.fitted.iter().zip(&areas[1..]) {
        fit(fitted, frame, *area);
    }
    genes_of(&view.spreads, frame, spreads);
    frame.render_widget(Paragraph::new(Line::from(message)), said);
    let dim = Style::new().add_modifier(Modifier::DIM);
    frame.render_widget(Paragraph::new(Line::styled(KEYS, dim)), keys);
}

fn progress(view: &View, frame: &mut Frame, area: Rect) {
    let progress = &view.progress;
    let best = progress.best.map_or(String::new(), |best| format!("   best {best:.4e}"));
    let count = match progress.total {
        0 => progress.done.to_string(),
        total => format!("{} of {total}", progress.done),
    };
    let label = format!("{} {count}{best}   failures {}", progress.label, progress.failures);
    let ratio = (progress.done as f64 / progress.total.max(1) as f64).clamp(0.0, 1.0);
    let ratio = if progress.total == 0 { 0.0 } else { ratio };
    let style = Style::new().fg(Color::Cyan);
    frame.render_widget(Gauge::default().gauge_style(style).ratio(ratio).label(label), area);
}

fn convergence(best: &[f64], frame: &mut Frame, area: Rect) {
    let positive = best.iter().all(|value| *value > 0.0);
    let scaled = |value: f64| if positive { elementary::log10(value) } else { value };
    let points: Vec<(f64, f64)> = best
        .iter()
        .enumerate()
        .map(|(k, value)| (k as f64 + 1.0, scaled(*value)))
        .filter(|(_, value)| value.is_finite())
        .collect();
    let title = if positive { " lg of the best fitness " } else { " best fitness " };
    let set = Dataset::default()
        .marker(Marker::Braille)
        .graph_type(GraphType::Line)
        .style(Style::new().fg(Color::Green))
        .data(&points);
    chart(vec![set], title.to_owned(), "generation", [&points, &[]], frame, area);
}

fn fit(fitted: &Fitted, frame: &mut Frame, area: Rect) {
    let points = |values: &[f64]| {
        let mut points: Vec<(f64, f64)> =
            fitted.x.iter().copied().zip(values.iter().copied()).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let (measured, simulated) = (points(&fitted.measured), points(&fitted.simulated));
    let sets = vec![
        Dataset::default()
            .marker(Marker::Braille)
            .graph_type(GraphType::Line)
            .style(Style::new().fg(Color::Yellow))
            .data(&simulated),
        Dataset::default()
            .marker(Marker::Custom('o'))
            .graph_type(GraphType::Scatter)
            .style(Style::new().fg(Color::Cyan))
            .data(&measured),
    ];
    let title = format!(" {}: o measured, line simulated ", fitted.y_title);
    chart(sets, title, &fitted.x_title, [&measured, &simulated], frame, area);
}

fn chart(
    sets: Vec<Dataset<'_>>,
    title: String,
    x_name: &str,
    points: [&[(f64, f64)]; 2],
    frame: &mut Frame,
    area: Rect,
) {
    let all = || points.into_iter().flatten();
    let (x, y) = (ends(all().map(|point| point.0)), ends(all().map(|point| point.1)));
    let axis = |[low, high]: [f64; 2]| {
        Axis::default().bounds([low, high]).labels([short(low), short(high)])
    };
    // Beside the axis a title would cover the curve.
    let below = Line::from(format!(" {x_name} ")).centered();
    let chart = Chart::new(sets)
        .block(Block::new().borders(Borders::ALL).title(title).title_bottom(below))
        .x_axis(axis(x))
        .y_axis(axis(y));
    frame.render_widget(chart, area);
}

/// The smallest and the largest, apart from each other.
fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    match high - low {
        span if span > 0.0 => [low, high],
        _ if low.is_finite() => [low - 0.5, low + 0.5],
        _ => [0.0, 1.0],
    }
}

fn short(value: f64) -> Line<'static> {
    let plain = value == 0.0 || (1e-3..1e5).contains(&value.abs());
    let text = if plain { format!("{value:.4}") } else { format!("{value:.2e}") };
    Line::from(if plain {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    })
}

/// Each gene over its search range: where the generation lies, and the best.
fn genes_of(spreads: &[Spread], frame: &mut Frame, area: Rect) {
    let block = Block::new().borders(Borders::ALL).title(
        " last generation over the search ranges: ─ from least to largest, ┼ middle, ● best ",
    );
    let width = usize::from(area.width).saturating_sub(LABEL + 3).max(1);
    let line = |spread: &Spread| {
        let value = short(spread.value);
        let label = format!("{} = {value} {}", spread.name, spread.unit);
        Line::from(vec![
            Span::raw(format!("{label:<LABEL$.LABEL$} ")),
            Span::styled(bar(spread, width), Style::new().fg(Color::Cyan)),
        ])
    };
    let lines: Vec<Line<'_>> = spreads.iter().map(line).collect();
    frame.render_widget(Paragraph::new(lines).block(block), area);
}

fn bar(spread: &Spread, width: usize) -> String {
    let place =
        |fraction: f64| ((fraction * (width - 1) as f64).round().max(0.0) as usize).min(width - 1);
    let [low, middle, high] = spread.generation.map(place);
    let best = spread.best.is_finite().then(|| place(spread.best));
    let mark = |k: usize| match k {
        k if Some(k) == best => '●',
        k if k == middle => '┼',
        k if (low..=high).contains(&k) => '─',
        _ => '·',
    };
    (0..width).map(mark).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::script::runs::view::Progress;
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

    fn drawn(view: &View, width: u16, height: u16) -> String {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| draw(view, "F_Mut = 0.3 from generation 12 on", frame)).unwrap();
        terminal.backend().to_string()
    }

    #[test]
    fn a_run_is_seen_at_one_glance() {
        let spread = |name: &str, best, generation| Spread {
            name: name.to_owned(),
            unit: "V".to_owned(),
            value: 0.0285,
            best,
            generation,
        };
        let view = View {
            title: "Polarization curve".to_owned(),
            progress: Progress {
                label: "genetic".to_owned(),
                done: 300,
                total: 1000,
                best: Some(2.4e-6),
                failures: 3,
                main_cause: None,
            },
            best: (1..60).map(|k| 1.0 / f64::from(k * k)).collect(),
            spreads: vec![spread("A", 0.5, [0.4, 0.5, 0.7]), spread("B", 0.0, [0.0, 0.2, 1.0])],
            fitted: vec![Fitted {
                y_title: "voltage (V)".to_owned(),
                x_title: "current density (A/cm²)".to_owned(),
                x: (0..20).map(f64::from).collect(),
                measured: (0..20).map(|k| (f64::from(k) / 5.0).cos()).collect(),
                simulated: (0..20).map(|k| (f64::from(k) / 5.0).cos()).collect(),
            }],
        };
        insta::assert_snapshot!(drawn(&view, 100, 24));
        // Terminals may be tiny, and a run may have found nothing yet.
        drawn(&view, 7, 3);
        drawn(&View::default(), 40, 10);
    }
}
