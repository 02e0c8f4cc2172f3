//! Linear invariants: sums of states that the equations conserve, such as the total of a substance that
//! reactions only convert.
//!
//! Right-hand sides are expanded to sums of the same terms with factors of numbers and parameters. The
//! invariants are the left null vectors of the matrix of these factors, which for a reaction network
//! is the stoichiometric matrix. The rank of the Jacobian shows whether one was missed.
//!
//! Reference: [Heinrich & Schuster 1996](gapilib_base::bibliography#heinrich-schuster-1996), §3.1.

use crate::causalize::{Block, CausalizedDae};
use crate::codegen::Program;
use crate::elementary;
use crate::flatten::BaseType;
use crate::lower::VariableKind;
use crate::sim::Residual as _;
use crate::symbolic::{Expr, Node, VarId, print};
use nalgebra::{DMatrix, DVector};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::LN_2;
use std::sync::Arc;

/// Factors of a term, by their numbers, ascending, and the power of each.
type Term = Vec<(usize, i32)>;
/// Sums of terms with their constant factors.
type Terms = BTreeMap<Term, f64>;
/// Nested expressions are expanded so far.
const DEPTH: usize = 200;
/// Products of sums with more terms than this are a factor of their own.
const MOST_TERMS: usize = 1_000;
/// Factors below this part of the others are those of rounding.
const ROUNDING: f64 = 1e-12;

/// A sum of states that is conserved.
pub(super) struct Invariant {
    /// The place of the state that its equation determines, among all states.
    pub pivot: usize,
    /// The states with their factors.
    terms: Vec<(VarId, Weight)>,
}

/// A constant times powers of parameters.
struct Weight {
    constant: f64,
    powers: Vec<(VarId, i32)>,
}

impl Weight {
    /// As it is written before a state; empty for 1.
    fn text(&self, name: &dyn Fn(VarId) -> String) -> String {
        let Weight { constant, powers } = self;
        let of = |(id, power): &(VarId, i32)| match power.unsigned_abs() {
            1 => name(*id),
            power => format!("{}^{power}", name(*id)),
        };
        let is_above = |own: &&(VarId, i32)| own.1 > 0;
        let mut above: Vec<String> = powers.iter().filter(is_above).map(of).collect();
        let below = powers.iter().filter(|own| own.1 < 0).map(|own| format!("/{}", of(own)));
        let below: String = below.collect();
        match *constant {
            1.0 if !above.is_empty() => {}
            1.0 if below.is_empty() => return String::new(),
            constant if constant < 0.0 => above.insert(0, format!("({constant})")),
            constant => above.insert(0, constant.to_string()),
        }
        format!("{}{below}*", above.join("*"))
    }
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
            let own = self.terms.iter().map(|(id, weight)| (text(*id), weight));
            let own = own.filter(|(text, _)| text != "0");
            let terms: Vec<String> =
                own.map(|(text, weight)| format!("{}{text}", weight.text(&name))).collect();
            if terms.is_empty() { "0".to_owned() } else { terms.join(" + ") }
        };
        [sum(&name), sum(&start)]
    }
}

/// The invariants of a model; `varied`: parameters that are not 0 although the model has them so. `None`
/// where a factor is not a number times powers of parameters.
pub(super) fn invariants(model: &CausalizedDae, varied: &[VarId]) -> Option<Vec<Invariant>> {
    let expansion = Expansion { model, values: assigned(model), varied };
    let derivatives: Vec<Terms> = model
        .states
        .iter()
        .map(|state| {
            let of_state = |variable: &crate::lower::Variable| {
                variable.kind == VariableKind::Derivative(*state)
            };
            let derivative = model.dae.variables.iter().position(of_state);
            // A derivative that nothing is known of is a term of its own.
            let derivative = derivative.unwrap_or(model.dae.variables.len() + state.0 as usize);
            expansion.of_variable(derivative, DEPTH)
        })
        .collect();
    let parameters = parameters_of(model, &derivatives);
    let at = |values: &[f64]| {
        let known = parameters.iter().copied().zip(values.iter().copied()).collect();
        null_vectors(rows(&derivatives, &known))
    };
    // The factors are those of all values: at one of them, and where each parameter changes.
    let values: Vec<f64> = (0..parameters.len()).map(|k| generic(k, 0)).collect();
    let found = at(&values);
    let changed: Vec<_> = (0..parameters.len())
        .map(|k| {
            let mut values = values.clone();
            values[k] *= 2.0;
            at(&values)
        })
        .collect();
    let others: Vec<f64> = (0..parameters.len()).map(|k| generic(k, 1)).collect();
    let checked = at(&others);
    let weight = |number: usize, state: usize| -> Option<Weight> {
        let size = found[number].1[state];
        let mut weight = Weight { constant: size, powers: Vec::new() };
        let mut expected = 1.0;
        for (k, parameter) in parameters.iter().enumerate() {
            let (pivot, row) = changed[k].get(number)?;
            let power = elementary::ln(row[state] / size) / LN_2;
            if *pivot != found[number].0 || (power - power.round()).abs() > SAME {
                return None;
            }
            let power = power.round() as i32;
            if power != 0 {
                weight.constant /= elementary::powi(values[k], power);
                expected *= elementary::powi(others[k], power);
                weight.powers.push((VarId((usize::MAX - parameter) as u32), power));
            }
        }
        weight.constant = without_rounding(weight.constant);
        let own = checked.get(number).map_or(f64::NAN, |(_, row)| row[state]);
        ((own - weight.constant * expected).abs() <= SAME * own.abs()).then_some(weight)
    };
    let invariant = |(number, (pivot, row)): (usize, &(usize, Vec<f64>))| {
        let nonzero = (0..row.len()).filter(|state| row[*state] != 0.0);
        let terms = nonzero.map(|state| Some((model.states[state], weight(number, state)?)));
        Some(Invariant { pivot: *pivot, terms: terms.collect::<Option<_>>()? })
    };
    found.iter().enumerate().map(invariant).collect()
}

/// Powers and constants are compared so exactly.
const SAME: f64 = 1e-9;
/// Decimals that numbers of models have, at most so many.
const DECIMALS: f64 = 1e9;

/// The decimal number that rounding errors have made it of.
fn without_rounding(x: f64) -> f64 {
    let decimal = (x * DECIMALS).round() / DECIMALS;
    if (decimal - x).abs() <= 1e-3 * SAME * x.abs() { decimal } else { x }
}

/// How many sums of states the equations conserve, or let grow without end, by the rank of the Jacobian
/// where states and parameters have numbers of no special meaning; `None` where it has no value.
pub(super) fn count(program: &Arc<Program>, varied: &[VarId]) -> Option<usize> {
    let mut system = program.system();
    system.solve_loops(true);
    for (at, parameter) in program.parameters().iter().enumerate() {
        let is_nonzero = parameter.default != 0.0 || varied.contains(&parameter.variable);
        if parameter.base == BaseType::Real && is_nonzero {
            let value = generic(at, 2).clamp(parameter.min, parameter.max);
            system.set_parameter(at, value).ok()?;
        }
    }
    let n = system.n_differential();
    system.initialize(0.0, &mut vec![0.0; n]).ok()?;
    let pattern = system.pattern().clone();
    let mut columns = Vec::new();
    for series in 3..6 {
        let y: Vec<f64> = (0..n).map(|k| generic(k, series)).collect();
        let mut values = vec![0.0; pattern.rows.len()];
        system.jacobian(0.0, &y, &mut values).ok()?;
        for column in 0..n {
            let mut own = DVector::zeros(n);
            pattern.column(column).for_each(|at| own[pattern.rows[at]] = values[at]);
            columns.push(own);
        }
    }
    let mut matrix = DMatrix::from_columns(&columns);
    for mut row in matrix.row_iter_mut() {
        let most = row.amax();
        if most > 0.0 {
            row /= most;
        }
    }
    let found = matrix.iter().all(|value| value.is_finite()).then(|| matrix.singular_values())?;
    let largest = found.max();
    Some(found.iter().filter(|value| **value <= RANK * largest).count())
}

/// Singular values below this part of the largest are zero: Jacobians with loops are differences.
const RANK: f64 = 1e-7;

/// A number of no special meaning from 0.7 to 1.7.
fn generic(number: usize, series: usize) -> f64 {
    0.7 + (0.618_033_988_749_895 * (number + 1) as f64 + 0.414_213_562 * series as f64).fract()
}

/// The parameters among the factors of terms, by their numbers.
fn parameters_of(model: &CausalizedDae, derivatives: &[Terms]) -> Vec<usize> {
    let is_parameter = |factor: &usize| {
        let variable = model.dae.variables.get(usize::MAX - factor);
        variable.is_some_and(|own| matches!(own.kind, VariableKind::Parameter { .. }))
    };
    let terms = derivatives.iter().flat_map(Terms::keys).flatten();
    let found: BTreeSet<usize> = terms.map(|(factor, _)| *factor).filter(is_parameter).collect();
    found.into_iter().collect()
}

/// The constant factors of terms by states, the parameters having values.
fn rows(derivatives: &[Terms], known: &BTreeMap<usize, f64>) -> Vec<Vec<f64>> {
    let mut columns: BTreeMap<Term, usize> = BTreeMap::new();
    let mut rows = Vec::new();
    for terms in derivatives {
        let mut row = vec![0.0; columns.len()];
        for (term, size) in terms {
            let (of_parameters, others): (Term, Term) =
                term.iter().copied().partition(|(factor, _)| known.contains_key(factor));
            let next = columns.len();
            let at = *columns.entry(others).or_insert(next);
            row.resize(columns.len(), 0.0);
            let power = |(factor, power): &(usize, i32)| elementary::powi(known[factor], *power);
            row[at] += size * of_parameters.iter().map(power).product::<f64>();
        }
        rows.push(row);
    }
    rows.iter_mut().for_each(|row| row.resize(columns.len(), 0.0));
    rows
}

/// The variables that are assigned, by their places.
fn assigned(model: &CausalizedDae) -> BTreeMap<usize, Expr> {
    let of_block = |block: &Block| match block {
        Block::Assignment(own) => vec![(own.variable.0 as usize, own.value)],
        Block::Linear(_) | Block::Loop(_) => Vec::new(),
    };
    model.blocks.iter().flat_map(of_block).collect()
}

/// Expressions as sums of products.
struct Expansion<'a> {
    model: &'a CausalizedDae,
    values: BTreeMap<usize, Expr>,
    varied: &'a [VarId],
}

impl Expansion<'_> {
    fn of(&self, expr: Expr, depth: usize) -> Terms {
        let pool = &self.model.dae.pool;
        let itself = || Terms::from([(vec![(expr.index(), 1)], 1.0)]);
        let Some(depth) = depth.checked_sub(1) else { return itself() };
        if let Some(constant) = pool.as_constant(expr) {
            return Terms::from([(Term::new(), constant)]);
        }
        match pool.node(expr) {
            Node::Add(a, b) => sum(self.of(*a, depth), &self.of(*b, depth), 1.0),
            Node::Sub(a, b) => sum(self.of(*a, depth), &self.of(*b, depth), -1.0),
            Node::Neg(a) => sum(Terms::new(), &self.of(*a, depth), -1.0),
            Node::Variable(id) => self.of_variable(id.0 as usize, depth),
            Node::Mul(a, b) => {
                let (a, b) = (self.of(*a, depth), self.of(*b, depth));
                product(&a, &b).unwrap_or_else(itself)
            }
            Node::Div(a, b) => {
                let divisor = inverse(&self.of(*b, depth))
                    .unwrap_or_else(|| Terms::from([(vec![(b.index(), -1)], 1.0)]));
                product(&self.of(*a, depth), &divisor).unwrap_or_else(itself)
            }
            _ => itself(),
        }
    }

    /// The terms of a variable: those of its value, where it is assigned. What is solved for otherwise,
    /// or known, is a term of its own.
    fn of_variable(&self, variable: usize, depth: usize) -> Terms {
        let alias = self.model.aliases.get(variable).and_then(Option::as_ref);
        let (variable, sign) = match alias {
            Some(alias) => (alias.of.0 as usize, if alias.negated { -1.0 } else { 1.0 }),
            None => (variable, 1.0),
        };
        let own = match self.values.get(&variable) {
            Some(value) => self.of(*value, depth),
            None if self.is_zero(variable) => Terms::new(),
            None => Terms::from([(vec![(usize::MAX - variable, 1)], 1.0)]),
        };
        sum(Terms::new(), &own, sign)
    }

    /// Whether it is a parameter that stays 0.
    fn is_zero(&self, variable: usize) -> bool {
        let dae = &self.model.dae;
        let Some(own) = dae.variables.get(variable) else { return false };
        matches!(own.kind, VariableKind::Parameter { .. })
            && own.binding.is_some_and(|value| dae.pool.as_constant(value) == Some(0.0))
            && !self.varied.contains(&VarId(variable as u32))
    }
}

/// a + factor b
fn sum(mut a: Terms, b: &Terms, factor: f64) -> Terms {
    for (term, size) in b {
        *a.entry(term.clone()).or_insert(0.0) += factor * size;
    }
    a.retain(|_, size| *size != 0.0);
    a
}

/// `None` where there would be too many terms.
fn product(a: &Terms, b: &Terms) -> Option<Terms> {
    if a.len() * b.len() > MOST_TERMS {
        return None;
    }
    let mut found = Terms::new();
    for (left, x) in a {
        for (right, y) in b {
            let mut factors: BTreeMap<usize, i32> = left.iter().copied().collect();
            for (factor, power) in right {
                *factors.entry(*factor).or_insert(0) += power;
            }
            let term = factors.into_iter().filter(|(_, power)| *power != 0).collect();
            *found.entry(term).or_insert(0.0) += x * y;
        }
    }
    Some(found)
}

/// One over a single term.
fn inverse(terms: &Terms) -> Option<Terms> {
    let (term, size) = terms.first_key_value().filter(|_| terms.len() == 1)?;
    let term = term.iter().map(|(factor, power)| (*factor, -power)).collect();
    (*size != 0.0).then(|| Terms::from([(term, size.recip())]))
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
