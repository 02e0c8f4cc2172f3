//! The grammar, and the cursor over what it found.

use super::failure;
use super::place::Place;
use super::scan::{self, Dialect, Scanned};
use crate::diag::Diagnostic;
use crate::source::{SourceId, Span};
use pest::Parser as _;
use pest::iterators::{Pair, Pairs};
use rayon::prelude::*;
use std::ops::Range;

#[derive(pest_derive::Parser)]
#[grammar = "grammar/lexical.pest"]
#[grammar = "grammar/modelica.pest"]
#[grammar = "grammar/script.pest"]
struct Grammar;

/// A node of the grammar's answer.
pub(super) type Node<'i> = Pair<'i, Rule>;

/// Scans a text, reads it by `rule`, and gives the nodes inside to `lower`.
pub(super) fn parse<T>(
    place: &Place,
    text: &str,
    rule: Rule,
    dialect: Dialect,
    lower: impl FnOnce(Nodes<'_>) -> Result<T, Diagnostic>,
) -> Result<T, Diagnostic> {
    let scanned = scan::scan(place.source(), text, dialect).map_err(|e| place.relocated(e))?;
    parse_scanned(place, scanned, rule, lower)
}

fn parse_scanned<T>(
    place: &Place,
    scanned: Scanned,
    rule: Rule,
    lower: impl FnOnce(Nodes<'_>) -> Result<T, Diagnostic>,
) -> Result<T, Diagnostic> {
    let pairs = match read(rule, &scanned.text) {
        Ok(pairs) => pairs,
        Err(error) => {
            return Err(place.relocated(failure::explain(place.source(), rule, scanned, &error)));
        }
    };
    if let Some(problem) = scanned.problem {
        return Err(place.relocated(problem.diagnostic));
    }
    let whole = place.span(0, scanned.text.len());
    lower(Nodes { place, pairs, whole })
}

/// The same for a text that may be long, piece by piece, on all processors: what the grammar
/// answers takes far more memory than the text and the tree.
pub(super) fn parse_in_pieces<T: Send>(
    source: SourceId,
    text: &str,
    rule: Rule,
    dialect: Dialect,
    lower: impl Fn(Nodes<'_>) -> Result<T, Diagnostic> + Sync,
) -> Result<Vec<T>, Diagnostic> {
    let scanned = scan::scan(source, text, dialect)?;
    let pieces = scanned.pieces();
    if let [_] = pieces.as_slice() {
        let place = Place::in_source(source);
        return Ok(vec![parse_scanned(&place, scanned, rule, lower)?]);
    }
    let lowered = |piece: &Range<usize>| {
        let place = Place::part(source, piece.start);
        let part = &scanned.text[piece.clone()];
        let pairs = read(rule, part).ok()?;
        Some(lower(Nodes { place: &place, pairs, whole: place.span(0, part.len()) }))
    };
    let read: Vec<_> = pieces.par_iter().map(lowered).collect();
    let each = read.into_iter().zip(pieces).map(|(read, piece)| match read {
        Some(read) => read,
        // This thread has more stack, and the time to say what is wrong.
        None => {
            let place = Place::part(source, piece.start);
            parse_scanned(&place, Scanned::part(scanned.text[piece].to_owned()), rule, &lower)
        }
    });
    each.collect()
}

/// Reads a scanned text; the nodes are those inside `rule`.
pub(super) fn read(
    rule: Rule,
    text: &str,
) -> Result<Pairs<'_, Rule>, Box<pest::error::Error<Rule>>> {
    let mut pairs = Grammar::parse(rule, text).map_err(Box::new)?;
    Ok(pairs.next().map_or(pairs, Pair::into_inner))
}

/// The nodes inside a node, one after another. Keywords that carry no information beyond the
/// rule they stand in are skipped.
pub(super) struct Nodes<'i> {
    pub(super) place: &'i Place,
    pairs: Pairs<'i, Rule>,
    /// The node these are inside of, without white space behind it.
    pub(super) whole: Span,
}

impl<'i> Nodes<'i> {
    /// The nodes inside a node.
    pub(super) fn inside(&self, node: Node<'i>) -> Nodes<'i> {
        let whole = self.span(&node);
        Nodes { place: self.place, pairs: node.into_inner(), whole }
    }

    /// The place of a node, without the white space that the grammar includes behind it.
    pub(super) fn span(&self, node: &Node<'i>) -> Span {
        let written = node.as_str().trim_end();
        let start = node.as_span().start();
        self.place.span(start, start + written.len())
    }

    /// The rule of the next node.
    pub(super) fn peek(&mut self) -> Option<Rule> {
        loop {
            let rule = self.pairs.peek()?.as_rule();
            if !is_silent_keyword(rule) {
                return Some(rule);
            }
            self.pairs.next();
        }
    }

    /// The text of the next node, if it is of this rule.
    pub(super) fn peek_text(&mut self, rule: Rule) -> Option<&'i str> {
        (self.peek()? == rule).then(|| self.pairs.peek().map(|pair| pair.as_str())).flatten()
    }

    /// The next node.
    pub(super) fn next(&mut self) -> Option<Node<'i>> {
        self.peek()?;
        self.pairs.next()
    }

    /// The next node, if it is of this rule.
    pub(super) fn take(&mut self, rule: Rule) -> Option<Node<'i>> {
        (self.peek()? == rule).then(|| self.pairs.next()).flatten()
    }

    /// Whether the next node is of this rule; if so it is consumed.
    pub(super) fn skip(&mut self, rule: Rule) -> bool {
        self.take(rule).is_some()
    }

    /// The next node, which the grammar promises to be of this rule.
    pub(super) fn expect(&mut self, rule: Rule) -> Node<'i> {
        match self.take(rule) {
            Some(node) => node,
            None => panic!("the grammar promises {rule:?} here, found {:?}", self.peek()),
        }
    }

    /// The nodes inside the next node, which the grammar promises to be of this rule.
    pub(super) fn enter(&mut self, rule: Rule) -> Nodes<'i> {
        let node = self.expect(rule);
        self.inside(node)
    }

    /// The nodes inside the next node, if it is of this rule.
    pub(super) fn try_enter(&mut self, rule: Rule) -> Option<Nodes<'i>> {
        let node = self.take(rule)?;
        Some(self.inside(node))
    }
}

/// Keywords whose presence the rule around them tells already.
fn is_silent_keyword(rule: Rule) -> bool {
    matches!(
        rule,
        Rule::kw_algorithm
            | Rule::kw_annotation
            | Rule::kw_connect
            | Rule::kw_constrainedby
            | Rule::kw_der
            | Rule::kw_else
            | Rule::kw_elseif
            | Rule::kw_elsewhen
            | Rule::kw_end
            | Rule::kw_enumeration
            | Rule::kw_equation
            | Rule::kw_extends
            | Rule::kw_external
            | Rule::kw_for
            | Rule::kw_function
            | Rule::kw_if
            | Rule::kw_import
            | Rule::kw_in
            | Rule::kw_loop
            | Rule::kw_protected
            | Rule::kw_public
            | Rule::kw_then
            | Rule::kw_when
            | Rule::kw_while
            | Rule::kw_within
            | Rule::EOI
    )
}
