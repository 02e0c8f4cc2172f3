//! The frame: heading, script, panel, explanation, and the line of keys.

use super::{Screen, View, compare, inspect, step_panel};
use crate::teach::explain::explain;
use crate::teach::plain::{place_in_run, title};
use crate::teach::step::Step;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Borders, Paragraph, Wrap};

const KEYS: &str =
    "→ next ← back ↓↑ generation Tab part g go f follow i inspect u until w if ? help";
const HELP: &str = "\
→ space n Enter   the next step
← b               one step back
Tab               the next phase: from crossover to mutation, and so on
↓ ↑ Page down, up the next generation, the one before
Home, End         the first step, the last step
g                 go to a generation
f                 follow an individual through the generations
i                 inspect the simulation of an individual
u                 continue until a condition is met
w                 what if: run again with a change from here on, and compare
j k               further down in the population, further up
q                 end
Marks: > followed or new, ♛ elite, x failed, ? drawn at random, * mutated.
Each block is a gene: · low, █ high within this generation.";

/// Draws the screen.
pub fn draw(screen: &Screen, frame: &mut Frame) {
    let question = screen.question();
    let [top, body, story, bottom] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Min(6),
        Constraint::Length(if question.is_some() { 9 } else { 6 }),
        Constraint::Length(1),
    ])
    .areas(frame.area());
    frame.render_widget(Paragraph::new(heading(screen)), top);
    match screen.view {
        View::Steps => step(screen, frame, body),
        View::Individual(k) => inspect::draw(screen, k, frame, body),
        View::Branches => compare::draw(screen, frame, body),
        View::Help => {
            frame.render_widget(Paragraph::new(HELP).block(titled(" keys; any key returns ")), body)
        }
    }
    let block = Block::new().borders(Borders::TOP);
    let message = question.unwrap_or_else(|| explain(&screen.walk));
    let text = Paragraph::new(message).wrap(Wrap { trim: true }).block(block);
    frame.render_widget(text, story);
    frame.render_widget(Paragraph::new(last_line(screen)), bottom);
}

fn heading(screen: &Screen) -> Line<'static> {
    let walk = &screen.walk;
    let (at, of) = walk.progress();
    let text = format!(
        "{} of {}, step {} of {of}: {}",
        place_in_run(walk),
        walk.trace().generations.len(),
        at + 1,
        title(walk)
    );
    Line::styled(text, Style::new().add_modifier(Modifier::BOLD))
}

fn last_line(screen: &Screen) -> Line<'static> {
    if let Some(keys) = screen.answer_keys() {
        return Line::styled(keys, screen.styled(Color::Yellow));
    }
    match (&screen.prompt, screen.message.as_str()) {
        (Some(prompt), _) => Line::styled(prompt.shown(), screen.styled(Color::Yellow)),
        (None, "") => Line::styled(KEYS, Style::new().add_modifier(Modifier::DIM)),
        (None, message) => Line::styled(message.to_owned(), screen.styled(Color::Yellow)),
    }
}

fn titled(title: &str) -> Block<'_> {
    Block::new().borders(Borders::ALL).title(title)
}

fn step(screen: &Screen, frame: &mut Frame, area: Rect) {
    let width = panel_width(screen, area.width);
    let [left, right] =
        Layout::horizontal([Constraint::Min(20), Constraint::Length(width)]).areas(area);
    script(screen, frame, left);
    let (lines, shown) = step_panel::lines(screen, right.width.saturating_sub(2));
    let height = usize::from(right.height.saturating_sub(2));
    let needed = if shown >= height { shown + 1 - height } else { 0 };
    // No further than to the last row.
    let offset = (needed + screen.scrolled).min(lines.len().saturating_sub(height));
    let what = match screen.walk.step() {
        Step::Operate { kind, .. } => format!(" {} ", kind.command()),
        _ => " population ".to_owned(),
    };
    let panel = Paragraph::new(lines).block(titled(&what)).scroll((offset as u16, 0));
    frame.render_widget(panel, right);
}

/// Columns of the panel: more than 42 where the genes are numbers then and the script keeps 44.
fn panel_width(screen: &Screen, all: u16) -> u16 {
    let numbers = step_panel::width_of_numbers(screen) + 2;
    if numbers + 44 <= all { numbers.max(42) } else { 42 }
}

/// The lines around the current one.
fn script(screen: &Screen, frame: &mut Frame, area: Rect) {
    let Some((script, now)) = screen.walk.line() else {
        let note = Paragraph::new("no line is known").block(titled(" script "));
        frame.render_widget(note, area);
        return;
    };
    let height = usize::from(area.height.saturating_sub(2));
    let first = now.saturating_sub(1 + height / 2).min(script.lines.len().saturating_sub(height));
    let width = usize::from(area.width.saturating_sub(7)).max(1);
    let lines = script.lines.iter().enumerate().skip(first).flat_map(|(k, text)| {
        let current = k + 1 == now;
        let pointer = if current { '>' } else { ' ' };
        let style = match current {
            true => screen.styled(Color::Yellow).add_modifier(Modifier::BOLD),
            false => Style::new(),
        };
        // The current line is shown whole.
        let pieces = if current { pieces(text, width) } else { vec![text.clone()] };
        let row = move |(part, piece): (usize, String)| {
            let number = if part == 0 { format!("{:>3}", k + 1) } else { " ".repeat(3) };
            Line::from(Span::styled(format!("{pointer}{number} {piece}"), style))
        };
        pieces.into_iter().enumerate().map(row)
    });
    let lines = lines.take(height);
    let name = script.name.rsplit('/').next().unwrap_or_default();
    let title = format!(" {name} ");
    frame.render_widget(Paragraph::new(lines.collect::<Vec<_>>()).block(titled(&title)), area);
}

/// A line in rows of at most `width` characters.
fn pieces(text: &str, width: usize) -> Vec<String> {
    let characters: Vec<char> = text.chars().collect();
    let rows: Vec<String> = characters.chunks(width).map(|row| row.iter().collect()).collect();
    if rows.is_empty() { vec![String::new()] } else { rows }
}
