//! The grammar.

use pest::Parser as _;
use pest::iterators::{Pair, Pairs};

#[derive(pest_derive::Parser)]
#[grammar = "grammar/lexical.pest"]
#[grammar = "grammar/modelica.pest"]
#[grammar = "grammar/script.pest"]
struct Grammar;

/// A node of the grammar's answer.
pub(super) type Node<'i> = Pair<'i, Rule>;

/// Reads a scanned text; the nodes are those inside `rule`.
pub(super) fn read(
    rule: Rule,
    text: &str,
) -> Result<Pairs<'_, Rule>, Box<pest::error::Error<Rule>>> {
    let mut pairs = Grammar::parse(rule, text).map_err(Box::new)?;
    Ok(pairs.next().map_or(pairs, Pair::into_inner))
}
