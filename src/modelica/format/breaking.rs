//! Lines that are too long: annotations go to a line of their own, argument lists are divided.
//!
//! A line is divided by what is in it alone; lines that cannot be divided stay as they are. So a
//! text that was formatted is not divided further.

use super::layout::{Layout, Line};
use super::{INDENT, WIDTH};
use crate::syntax::LexemeKind;
use std::ops::Range;

/// Bytes of an argument list that is divided: nothing is won with `mod(i, 2)`.
const LEAST: usize = 40;

/// The lines, divided where they are longer than [`WIDTH`].
pub(super) fn broken(layout: &Layout<'_>, lines: Vec<Line>) -> Vec<Line> {
    let mut waiting: Vec<Line> = lines.into_iter().rev().collect();
    let mut done = Vec::with_capacity(waiting.len());
    while let Some(line) = waiting.pop() {
        match divided(layout, &line) {
            Some(parts) => waiting.extend(parts.into_iter().rev()),
            None => done.push(line),
        }
    }
    done
}

fn divided(layout: &Layout<'_>, line: &Line) -> Option<Vec<Line>> {
    let spans_lines = |at: usize| layout.lexed.str(at).contains('\n');
    if layout.code_width(line) <= WIDTH || line.lexemes.clone().any(spans_lines) {
        return None;
    }
    before_annotation(layout, line).or_else(|| arguments(layout, line))
}

/// An annotation after a declaration or an equation.
fn before_annotation(layout: &Layout<'_>, line: &Line) -> Option<Vec<Line>> {
    let is_annotation =
        |at: &usize| layout.roles[*at].depth == 0 && layout.lexed.str(*at) == "annotation";
    let at = line.lexemes.clone().skip(1).find(is_annotation)?;
    let (start, end) = (line.lexemes.start, line.lexemes.end);
    let rest = Line { lexemes: at..end, indent: line.base + INDENT, base: line.base, blank: false };
    Some(vec![Line { lexemes: start..at, ..line.clone() }, rest])
}

/// The longest of the outermost argument lists of a line: one argument a line.
fn arguments(layout: &Layout<'_>, line: &Line) -> Option<Vec<Line>> {
    let list = lists(layout, line).into_iter().max_by_key(|list| {
        let end = layout.lexed.lexemes[list.end].end;
        end - layout.lexed.lexemes[list.start].start
    })?;
    let depth = layout.roles[list.start].depth + 1;
    let mut starts = vec![line.lexemes.start];
    for at in list.start..list.end {
        let divides = match layout.lexed.lexemes[at].kind {
            LexemeKind::Comma => layout.roles[at].depth == depth,
            _ => at == list.start,
        };
        if divides && layout.lexed.lexemes[at + 1].kind != LexemeKind::LineComment {
            starts.push(at + 1);
        }
    }
    let ends = starts.iter().skip(1).copied().chain([line.lexemes.end]);
    let indent = line.indent + INDENT;
    let mut parts: Vec<Line> = starts
        .iter()
        .zip(ends)
        .map(|(start, end)| Line { lexemes: *start..end, indent, base: line.base, blank: false })
        .collect();
    parts[0] = Line { lexemes: parts[0].lexemes.clone(), ..line.clone() };
    Some(parts)
}

/// The outermost lists with several arguments that begin and end in a line, brackets included; none of
/// an annotation, whose arguments tools arrange.
fn lists(layout: &Layout<'_>, line: &Line) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for start in line.lexemes.clone() {
        let is_list = layout.lexed.str(start) == "("
            && !layout.roles[start].in_annotation
            && found.last().is_none_or(|last| start > last.end);
        if !is_list {
            continue;
        }
        let depth = layout.roles[start].depth;
        let inside = start + 1..line.lexemes.end;
        let closes = |at: &usize| {
            layout.lexed.lexemes[*at].kind == LexemeKind::Close
                && layout.roles[*at].depth == depth + 1
        };
        let Some(end) = inside.clone().find(closes) else { continue };
        let separates = |at: usize| {
            layout.lexed.lexemes[at].kind == LexemeKind::Comma
                && layout.roles[at].depth == depth + 1
        };
        let width = layout.lexed.lexemes[end].end - layout.lexed.lexemes[start].start;
        if width >= LEAST && (start + 1..end).any(separates) {
            found.push(start..end);
        }
    }
    found
}
