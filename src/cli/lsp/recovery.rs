//! Reading text that someone is typing: lines that cannot be read are left out. They are replaced by
//! blanks, so that all other places stay where they are.

use super::lines::Lines;
use crate::diag::Diagnostic;
use crate::source::SourceId;
use crate::syntax;
use crate::syntax::ast::{Script, StoredDefinition};
use std::ops::Range;

/// Lines that are left out at most.
const MOST_LINES: usize = 8;

/// Bytes that are read at most, all attempts together: a large text costs half a second for each.
const MOST_BYTES: usize = 2_000_000;

/// What a document contains.
#[derive(Debug)]
pub enum Tree {
    /// A `.mo` file.
    Classes(StoredDefinition),
    /// A `.mos` file.
    Script(Script),
}

impl Tree {
    fn of(source: SourceId, text: &str, is_script: bool) -> Result<Tree, Vec<Diagnostic>> {
        match is_script {
            true => syntax::parse_script(source, text).map(Tree::Script).map_err(|e| vec![e]),
            false => syntax::parse_all_of_stored_definition(source, text).map(Tree::Classes),
        }
    }
}

/// A text as far as it could be read.
#[derive(Debug)]
pub(crate) struct Read {
    /// What it contains, lines that cannot be read left out; `None` if that does not help.
    pub tree: Option<Tree>,
    /// Its syntax errors.
    pub errors: Vec<Diagnostic>,
}

/// Reads a text.
pub(crate) fn read(source: SourceId, text: &str, is_script: bool) -> Read {
    match Tree::of(source, text, is_script) {
        Ok(tree) => Read { tree: Some(tree), errors: Vec::new() },
        Err(errors) => {
            let tree = Attempt { source, is_script, left: MOST_BYTES }.recovered(text, &errors);
            Read { tree, errors }
        }
    }
}

/// Reads a text without one of its lines, which someone is typing; else as [`read`].
pub(crate) fn read_without_line(
    source: SourceId,
    text: &str,
    is_script: bool,
    line: usize,
) -> Read {
    let content = Lines::of(text).content(text, line);
    match Tree::of(source, &without(text, content), is_script) {
        Ok(tree) => Read { tree: Some(tree), errors: Vec::new() },
        Err(_) => read(source, text, is_script),
    }
}

struct Attempt {
    source: SourceId,
    is_script: bool,
    /// Bytes that may still be read.
    left: usize,
}

impl Attempt {
    fn recovered(&mut self, text: &str, errors: &[Diagnostic]) -> Option<Tree> {
        let mut text = text.to_owned();
        let mut errors = errors.to_vec();
        for _ in 0..MOST_LINES {
            let mut best: Option<(usize, String, Vec<Diagnostic>)> = None;
            for line in suspects(&text, &errors) {
                self.left = self.left.checked_sub(text.len())?;
                let attempt = without(&text, line);
                match Tree::of(self.source, &attempt, self.is_script) {
                    // A file without its classes says nothing.
                    Ok(Tree::Classes(file)) if file.classes.is_empty() => {}
                    Ok(tree) => return Some(tree),
                    Err(errors) => {
                        let reached = place(&errors);
                        if best.as_ref().is_none_or(|(known, ..)| reached > *known) {
                            best = Some((reached, attempt, errors));
                        }
                    }
                }
            }
            (_, text, errors) = best?;
        }
        None
    }
}

/// Where the first error is.
fn place(errors: &[Diagnostic]) -> usize {
    errors.first().map_or(0, |error| error.span().start as usize)
}

/// The lines that may be the reason of the first error: its own, that of what precedes it, and the
/// line above its own. The end of a class is none.
fn suspects(text: &str, errors: &[Diagnostic]) -> Vec<Range<usize>> {
    let at = place(errors).min(text.len());
    let Some(head) = text.get(..at) else { return Vec::new() };
    let lines = Lines::of(text);
    let mut found = Vec::new();
    let own = lines.content(text, lines.line_of(at)).start;
    let above = text.get(..own).unwrap_or(head);
    for offset in
        [at, head.trim_end().len().saturating_sub(1), above.trim_end().len().saturating_sub(1)]
    {
        let line = lines.content(text, lines.line_of(offset));
        let written = text[line.clone()].trim();
        let is_frame = written.starts_with("end ") && !written.starts_with("end if");
        if !written.is_empty() && !is_frame && !found.contains(&line) {
            found.push(line);
        }
    }
    found
}

/// The text with blanks instead of some bytes.
fn without(text: &str, bytes: Range<usize>) -> String {
    let mut changed = text.to_owned();
    changed.replace_range(bytes.clone(), &" ".repeat(bytes.len()));
    changed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::ast::{ClassSpecifier, Element, Section};

    /// The names of the components that are found in a half-typed class.
    fn components(text: &str) -> Option<Vec<String>> {
        let read = read(SourceId::NONE, text, false);
        assert!(!read.errors.is_empty());
        let Tree::Classes(file) = read.tree? else { return None };
        let ClassSpecifier::Long(long) = &file.classes[0].specifier else { return None };
        let elements = long.sections.iter().flat_map(|section| match section {
            Section::Elements { elements, .. } => elements.as_slice(),
            _ => &[],
        });
        let names = elements.filter_map(|element| match element {
            Element::Component(clause) => Some(clause.components[0].name.node.to_string()),
            _ => None,
        });
        Some(names.collect())
    }

    #[test]
    fn half_typed_lines_are_left_out() {
        for line in ["  Real", "  Real z(", "  Real z = a.", "  Real z = \"", "  if"] {
            let text =
                format!("model M\n  Real x;\n{line}\n  Real y;\nequation\n  x = y;\nend M;\n");
            let expected = Some(vec!["x".to_owned(), "y".to_owned()]);
            assert_eq!(components(&text), expected, "{line}");
        }
        let equation = "model M\n  Real x;\nequation\n  x = \n  der(x) = a.;\nend M;\n";
        assert_eq!(components(equation), Some(vec!["x".to_owned()]));
    }

    #[test]
    fn what_has_no_end_is_not_read() {
        assert_eq!(components("model M\n  Real x;\n"), None);
    }

    #[test]
    fn a_script_is_read_without_its_wrong_lines() {
        let read = read(SourceId::NONE, "x = 1;\ny = f(;\nz = 2;\n", true);
        let Some(Tree::Script(script)) = read.tree else { panic!("no tree") };
        assert_eq!((script.statements.len(), read.errors.len()), (2, 1));
    }
}
