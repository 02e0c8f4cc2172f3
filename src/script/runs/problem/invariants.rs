//! Linear invariants: sums of states that the equations conserve, such as the total of a substance that
//! reactions only convert.
//!
//! Right-hand sides are sums of the same terms (rates of reactions) with constant factors. The
//! invariants are the left null vectors of the matrix of these factors, which for a reaction
//! network is the stoichiometric matrix.
//!
//! Reference: [Heinrich & Schuster 1996](gapilib_base::bibliography#heinrich-schuster-1996), §3.1.

use crate::causalize::{Block, CausalizedDae};
use crate::lower::VariableKind;
use crate::symbolic::{Expr, Node, VarId, print};
use std::collections::BTreeMap;

/// Factors of a term, by their numbers, and the power 1 or −1 of each.
type Term = Vec<(usize, i32)>;
/// Nested sums are expanded so far.
const DEPTH: usize = 200;
/// Factors below this part of the others are those of rounding.
const ROUNDING: f64 = 1e-12;

/// A sum of states that is conserved.
pub(super) struct Invariant {
    /// The place of the state that its equation determines, among all states.
    pub pivot: usize,
    /// The states with their factors.
    terms: Vec<(VarId, f64)>,
}

impl Invariant {
    /// The sum, and its value at the start, as they are written.
    pub(super) fn sides(&self, model: &CausalizedDae) -> [String; 2] {
        let name = |id: VarId| model.dae.variables[id.0 as usize].name.to_string();
        let start = |id: VarId| {
            let pool = &model.dae.pool;
            let start = model.dae.variables[id.0 as usize].start;
            let start = start.filter(|start| pool.as_constant(*start) != Some(0.0));
            let text = start.map_or("0".to_owned(), |start| print(pool, start, &name));
            let is_single = text.chars().all(|c| c.is_alphanumeric() || "._".contains(c));
            if is_single { text } else { format!("({text})") }
        };
        let sum = |text: &dyn Fn(VarId) -> String| {
            let term = |(id, factor): &(VarId, f64)| match (text(*id), *factor == 1.0) {
                (text, _) if text == "0" => None,
                (text, true) => Some(text),
                (text, false) => Some(format!("({factor})*{text}")),
            };
            let terms: Vec<String> = self.terms.iter().filter_map(term).collect();
            if terms.is_empty() { "0".to_owned() } else { terms.join(" + ") }
        };
        [sum(&name), sum(&start)]
    }
}

/// The invariants of a model.
pub(super) fn invariants(model: &CausalizedDae) -> Vec<Invariant> {
    let values = assigned(model);
    let mut columns: Vec<Term> = Vec::new();
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for state in &model.states {
        let of_state =
            |variable: &crate::lower::Variable| variable.kind == VariableKind::Derivative(*state);
        let derivative = model.dae.variables.iter().position(of_state);
        let mut terms = BTreeMap::new();
        // A derivative that nothing is known of is a term of its own.
        let derivative = derivative.unwrap_or(model.dae.variables.len() + state.0 as usize);
        add_variable(model, &values, (derivative, 1.0, DEPTH), &mut terms);
        let mut row = vec![0.0; columns.len()];
        for (term, factor) in terms {
            let at = columns.iter().position(|known| *known == term).unwrap_or_else(|| {
                columns.push(term);
                columns.len() - 1
            });
            row.resize(columns.len(), 0.0);
            row[at] += factor;
        }
        rows.push(row);
    }
    rows.iter_mut().for_each(|row| row.resize(columns.len(), 0.0));
    let found = null_vectors(rows);
    let invariant = |(pivot, factors): (usize, Vec<f64>)| Invariant {
        pivot,
        terms: model.states.iter().copied().zip(factors).filter(|(_, f)| *f != 0.0).collect(),
    };
    found.into_iter().map(invariant).collect()
}

/// The variables that are assigned, by their places.
fn assigned(model: &CausalizedDae) -> BTreeMap<usize, Expr> {
    let of_block = |block: &Block| match block {
        Block::Assignment(own) => vec![(own.variable.0 as usize, own.value)],
        Block::Linear(_) | Block::Loop(_) => Vec::new(),
    };
    model.blocks.iter().flat_map(of_block).collect()
}

/// Adds the terms of `factor` times an expression.
fn add(
    model: &CausalizedDae,
    values: &BTreeMap<usize, Expr>,
    (expr, factor, depth): (Expr, f64, usize),
    terms: &mut BTreeMap<Term, f64>,
) {
    let pool = &model.dae.pool;
    let mut nested = |expr: Expr, factor: f64| match depth {
        0 => *terms.entry(vec![(expr.index(), 1)]).or_insert(0.0) += factor,
        depth => add(model, values, (expr, factor, depth - 1), terms),
    };
    match pool.node(expr) {
        Node::Add(a, b) => {
            nested(*a, factor);
            nested(*b, factor);
        }
        Node::Sub(a, b) => {
            nested(*a, factor);
            nested(*b, -factor);
        }
        Node::Neg(a) => nested(*a, -factor),
        Node::Variable(id) => {
            add_variable(model, values, (id.0 as usize, factor, depth), terms);
        }
        _ => {
            let mut factors = Vec::new();
            let size = factor * multiply(model, expr, 1, &mut factors);
            factors.sort_unstable();
            if size != 0.0 {
                *terms.entry(factors).or_insert(0.0) += size;
            }
        }
    }
}

/// Adds the terms of `factor` times a variable: those of its value, where it is assigned.
fn add_variable(
    model: &CausalizedDae,
    values: &BTreeMap<usize, Expr>,
    (variable, factor, depth): (usize, f64, usize),
    terms: &mut BTreeMap<Term, f64>,
) {
    let alias = model.aliases.get(variable).and_then(Option::as_ref);
    let (variable, factor) = match alias {
        Some(alias) => (alias.of.0 as usize, if alias.negated { -factor } else { factor }),
        None => (variable, factor),
    };
    match values.get(&variable).filter(|_| depth > 0) {
        Some(value) => add(model, values, (*value, factor, depth - 1), terms),
        // What is solved for otherwise, or known, is a term of its own.
        None => *terms.entry(vec![(usize::MAX - variable, 1)]).or_insert(0.0) += factor,
    }
}

/// Splits a product into its factors; the constant one.
fn multiply(model: &CausalizedDae, expr: Expr, power: i32, factors: &mut Term) -> f64 {
    let pool = &model.dae.pool;
    if let Some(constant) = pool.as_constant(expr).filter(|own| *own != 0.0 || power > 0) {
        return if power > 0 { constant } else { constant.recip() };
    }
    match pool.node(expr) {
        Node::Mul(a, b) => {
            multiply(model, *a, power, factors) * multiply(model, *b, power, factors)
        }
        Node::Div(a, b) => {
            multiply(model, *a, power, factors) * multiply(model, *b, -power, factors)
        }
        Node::Neg(a) => -multiply(model, *a, power, factors),
        _ => {
            factors.push((expr.index(), power));
            1.0
        }
    }
}

/// Left null vectors of a matrix in reduced form: each with factor 1 at a place of its own.
fn null_vectors(rows: Vec<Vec<f64>>) -> Vec<(usize, Vec<f64>)> {
    let n = rows.len();
    // Rows beside the combination of the original ones that they are.
    let unit = |k: usize| (0..n).map(|l| f64::from(u8::from(k == l))).collect::<Vec<f64>>();
    let mut left: Vec<(Vec<f64>, Vec<f64>)> =
        rows.into_iter().enumerate().map(|(k, row)| (row, unit(k))).collect();
    let mut null: Vec<Vec<f64>> = Vec::new();
    while let Some((row, own)) = left.pop() {
        let size = row.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let at = row.iter().position(|value| value.abs() > ROUNDING * size.max(1.0));
        let Some(at) = at else {
            null.push(own);
            continue;
        };
        for (other, combination) in &mut left {
            let by = other[at] / row[at];
            other.iter_mut().zip(&row).for_each(|(a, b)| *a -= by * b);
            combination.iter_mut().zip(&own).for_each(|(a, b)| *a -= by * b);
        }
    }
    reduced(null)
}

/// Vectors in reduced row echelon form, with their pivots.
fn reduced(mut vectors: Vec<Vec<f64>>) -> Vec<(usize, Vec<f64>)> {
    let mut found: Vec<(usize, Vec<f64>)> = Vec::new();
    while let Some(mut own) = vectors.pop() {
        let most = own.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        own.iter_mut().filter(|v| v.abs() <= ROUNDING * most).for_each(|v| *v = 0.0);
        let Some(pivot) = own.iter().position(|value| *value != 0.0) else { continue };
        let divisor = own[pivot];
        own.iter_mut().for_each(|value| *value /= divisor);
        let known = found.iter_mut().map(|(_, known)| known);
        for other in vectors.iter_mut().chain(known) {
            let by = other[pivot];
            other.iter_mut().zip(&own).for_each(|(a, b)| *a -= by * b);
        }
        found.push((pivot, own));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn null_vectors_are_the_conserved_sums() {
        // a ⇌ b and c → 2 d beside a constant e.
        let rows = vec![
            vec![-1.0, 1.0, 0.0],
            vec![1.0, -1.0, 0.0],
            vec![0.0, 0.0, -1.0],
            vec![0.0, 0.0, 2.0],
            vec![0.0, 0.0, 0.0],
        ];
        let mut found = null_vectors(rows);
        found.sort_by_key(|(pivot, _)| *pivot);
        let expected = [
            (0, vec![1.0, 1.0, 0.0, 0.0, 0.0]),
            (2, vec![0.0, 0.0, 1.0, 0.5, 0.0]),
            (4, vec![0.0, 0.0, 0.0, 0.0, 1.0]),
        ];
        assert_eq!(found, expected);
        assert!(null_vectors(vec![vec![1.0, 0.0], vec![1.0, 1.0]]).is_empty());
    }
}
