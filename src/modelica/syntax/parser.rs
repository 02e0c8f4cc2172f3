//! The cursor over what the grammar found.

use super::failure;
use super::grammar::read;
pub(super) use super::grammar::{Node, Rule};
use super::place::TextOrigin;
use super::scan::{self, Dialect, Scanned};
use crate::diag::Diagnostic;
use crate::source::{SourceId, Span};
use pest::iterators::Pairs;
use rayon::prelude::*;
use std::ops::Range;

/// Scans a text, reads it by `rule`, and gives the nodes inside to `lower`.
pub(super) fn parse<T>(
    place: &TextOrigin,
    text: &str,
    rule: Rule,
    dialect: Dialect,
    lower: impl FnOnce(Nodes<'_>) -> Result<T, Diagnostic>,
) -> Result<T, Diagnostic> {
    let scanned = scan::scan(place.source(), text, dialect).map_err(|e| place.relocated(e))?;
    parse_scanned(place, scanned, rule, lower)
}

fn parse_scanned<T>(
    place: &TextOrigin,
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

/// A long text, ready for the grammar piece by piece: what the grammar answers takes far more memory
/// than the text and the tree.
#[derive(Debug)]
pub(super) struct Pieces {
    source: SourceId,
    rule: Rule,
    text: String,
    ranges: Vec<Range<usize>>,
}

impl Pieces {
    /// Scans a text and lowers each of its pieces, whose numbers `lower` gets, on all processors.
    ///
    /// # Errors
    /// The first error of the text.
    pub(super) fn read<T: Send>(
        source: SourceId,
        text: &str,
        rule: Rule,
        dialect: Dialect,
        lower: impl Fn(usize, Nodes<'_>) -> Result<T, Diagnostic> + Sync,
    ) -> Result<(Pieces, Vec<T>), Diagnostic> {
        let scanned = scan::scan(source, text, dialect)?;
        let ranges = scanned.pieces();
        if scanned.problem.is_some() {
            let place = TextOrigin::in_source(source);
            let whole = parse_scanned(&place, scanned, rule, |nodes| lower(0, nodes))?;
            return Ok((Pieces { source, rule, text: String::new(), ranges }, vec![whole]));
        }
        let pieces = Pieces { source, rule, text: scanned.text, ranges };
        let lowered = pieces.lowered(0..pieces.count(), lower)?;
        Ok((pieces, lowered))
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.ranges.len()
    }

    /// Lowers some of the pieces, on all processors if they are many.
    ///
    /// # Errors
    /// The first error in them.
    pub(super) fn lowered<T: Send>(
        &self,
        range: Range<usize>,
        lower: impl Fn(usize, Nodes<'_>) -> Result<T, Diagnostic> + Sync,
    ) -> Result<Vec<T>, Diagnostic> {
        let read: Vec<Option<_>> = match range.len() {
            1 => vec![self.attempt(range.start, &lower)],
            _ => range.clone().into_par_iter().map(|at| self.attempt(at, &lower)).collect(),
        };
        let each = read.into_iter().zip(range).map(|(read, at)| match read {
            Some(read) => read,
            // This thread has more stack, and the time to say what is wrong.
            None => {
                let part = self.text[self.ranges[at].clone()].to_owned();
                let place = TextOrigin::part(self.source, self.ranges[at].start);
                parse_scanned(&place, Scanned::part(part), self.rule, |nodes| lower(at, nodes))
            }
        });
        each.collect()
    }

    /// Lowers a piece, if the grammar reads it.
    fn attempt<T>(
        &self,
        at: usize,
        lower: &impl Fn(usize, Nodes<'_>) -> Result<T, Diagnostic>,
    ) -> Option<Result<T, Diagnostic>> {
        let range = self.ranges[at].clone();
        let place = TextOrigin::part(self.source, range.start);
        let part = &self.text[range];
        let pairs = read(self.rule, part).ok()?;
        Some(lower(at, Nodes { place: &place, pairs, whole: place.span(0, part.len()) }))
    }
}

/// The nodes inside a node, one after another. Keywords that carry no information beyond their rule
/// are skipped.
pub(super) struct Nodes<'i> {
    pub(super) place: &'i TextOrigin,
    pairs: Pairs<'i, Rule>,
    /// The node these are inside of, without trailing white space.
    pub(super) whole: Span,
}

impl<'i> Nodes<'i> {
    /// The nodes inside a node.
    pub(super) fn inside(&self, node: Node<'i>) -> Nodes<'i> {
        let whole = self.span(&node);
        Nodes { place: self.place, pairs: node.into_inner(), whole }
    }

    /// The place of a node, without the trailing white space that the grammar includes.
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
