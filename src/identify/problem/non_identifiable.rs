//! Parameters that no data can tell apart: the sensitivities have not full rank, at the best point
//! and elsewhere.
//!
//! A direction Δ in which the parameters may change together without any effect has J Δ = 0. Where
//! the same Δ has no effect at other points of the search space, only sums of the parameters
//! matter; where the same relative changes have none, only products do. What is determined then
//! are the combinations orthogonal to all such directions.
//!
//! Reference: [Walter & Pronzato 1997](gapilib_base::bibliography#walter-pronzato-1997), chapter 2.

use super::sensitivities::Sensitivities;
use super::separable::Combination;
use crate::singular_values::SingularValues;
use nalgebra::DMatrix;

/// Parts of a direction below this are none.
const PART: f64 = 0.02;

/// How the parameters of a group work together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Only sums of them matter, everywhere.
    Sum,
    /// Only products of their powers matter, everywhere.
    Product,
    /// Only a function of them matters, everywhere.
    Function,
    /// Known of the best point alone.
    Local,
}

/// Parameters that cannot be determined separately.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NonIdentifiable {
    /// Their places.
    pub parameters: Vec<usize>,
    /// How many of them must be fixed.
    pub excess: usize,
    /// How they work together.
    pub form: Form,
    /// What is determined: factors of a sum or exponents of a product, for each of `parameters`.
    /// Of a group known locally, relative changes that together have no effect.
    pub combinations: Vec<Vec<f64>>,
    /// The function that is determined, where its form is known.
    pub function: Option<Combination>,
    /// Changes of the parameters that together have no effect as far as derivatives tell; relative
    /// ones of a product.
    pub directions: Vec<Vec<f64>>,
}

/// What the sensitivities tell of the rank.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rank {
    /// Groups without full rank.
    pub(crate) non_identifiable: Vec<NonIdentifiable>,
    /// Parameters without any effect.
    pub(crate) without_effect: Vec<usize>,
    /// Condition number, columns of unit length; `None` where there is none.
    pub condition: Option<f64>,
}

/// The rank at `best`, and how far it holds at the points `others`. Singular values below
/// `tolerance` times the largest are none.
pub fn rank(best: &Sensitivities, others: &[Sensitivities], tolerance: f64) -> Rank {
    let finite = best.columns.iter().flatten().all(|value| value.is_finite());
    let points = best.columns.first().map_or(0, Vec::len);
    if points == 0 || !finite {
        return Rank::default();
    }
    let norms: Vec<f64> = best.columns.iter().map(|column| norm(column)).collect();
    let without_effect: Vec<usize> = (0..norms.len()).filter(|&k| norms[k] == 0.0).collect();
    let used: Vec<usize> = (0..norms.len()).filter(|&k| norms[k] > 0.0).collect();
    if used.is_empty() {
        return Rank { without_effect, ..Rank::default() };
    }
    let rows = points.max(used.len());
    let scaled = DMatrix::from_fn(rows, used.len(), |row, k| {
        best.columns[used[k]].get(row).map_or(0.0, |value| value / norms[used[k]])
    });
    let Some(SingularValues { s, v_t: right, .. }) = SingularValues::of(&scaled) else {
        return Rank { without_effect, ..Rank::default() };
    };
    let condition = Some(s[0] / s[s.len() - 1]);
    let null: Vec<usize> = (0..s.len()).filter(|&d| s[d] <= tolerance * s[0]).collect();
    // The projection onto what has no effect; which directions span it is chance.
    let projector = DMatrix::from_fn(used.len(), used.len(), |k, l| {
        null.iter().map(|&d| right[(d, k)] * right[(d, l)]).sum::<f64>()
    });
    let groups = components(&projector);
    let group = |members: &Vec<usize>| {
        let parameters: Vec<usize> = members.iter().map(|&k| used[k]).collect();
        let own = projector.select_rows(members).select_columns(members);
        non_identifiable(best, others, &norms, parameters, own, tolerance)
    };
    Rank { non_identifiable: groups.iter().map(group).collect(), without_effect, condition }
}

fn norm(column: &[f64]) -> f64 {
    column.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Which parameters the directions connect.
fn components(projector: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let n = projector.nrows();
    let mut left: Vec<usize> = (0..n).filter(|&k| projector[(k, k)] > PART * PART).collect();
    let mut groups = Vec::new();
    while let Some(first) = left.first().copied() {
        let mut group = vec![first];
        let mut at = 0;
        while at < group.len() {
            let k = group[at];
            let near = |l: &usize| projector[(k, *l)].abs() > PART * PART && !group.contains(l);
            let found: Vec<usize> = left.iter().copied().filter(near).collect();
            group.extend(found);
            at += 1;
        }
        group.sort_unstable();
        left.retain(|k| !group.contains(k));
        groups.push(group);
    }
    groups
}

fn non_identifiable(
    best: &Sensitivities,
    others: &[Sensitivities],
    norms: &[f64],
    parameters: Vec<usize>,
    projector: DMatrix<f64>,
    tolerance: f64,
) -> NonIdentifiable {
    let n = parameters.len();
    let eigen = projector.symmetric_eigen();
    let null: Vec<usize> = (0..n).filter(|&d| eigen.eigenvalues[d] > 0.5).collect();
    // From columns of unit length to changes of the parameters, and to relative ones.
    let change = |d: usize, k: usize| eigen.eigenvectors[(k, d)] / norms[parameters[k]];
    let changes: Vec<Vec<f64>> =
        null.iter().map(|&d| (0..n).map(|k| change(d, k)).collect()).collect();
    let relative = |change: &Vec<f64>| -> Vec<f64> {
        change.iter().zip(&parameters).map(|(c, &k)| c / nonzero(best.values[k])).collect()
    };
    let relative: Vec<Vec<f64>> = changes.iter().map(relative).collect();
    let everywhere = |directions: &[Vec<f64>], scale: &dyn Fn(&Sensitivities, usize) -> f64| {
        let without = |point: &Sensitivities, direction: &Vec<f64>| {
            let change = |k: usize| direction[k] * scale(point, parameters[k]);
            is_without_effect(point, &parameters, &change, 100.0 * tolerance)
        };
        !others.is_empty()
            && others.iter().all(|point| directions.iter().all(|d| without(point, d)))
    };
    let form = if everywhere(&changes, &|_, _| 1.0) {
        Form::Sum
    } else if everywhere(&relative, &|point, k| nonzero(point.values[k])) {
        Form::Product
    } else {
        Form::Local
    };
    let combinations = match form {
        Form::Sum => orthogonal(&changes, n),
        Form::Product => orthogonal(&relative, n),
        Form::Function | Form::Local => {
            relative.iter().map(|direction| largest_is_one(direction)).collect()
        }
    };
    let directions = if form == Form::Product { relative } else { changes };
    let excess = null.len();
    NonIdentifiable { excess, parameters, form, combinations, function: None, directions }
}

impl Sensitivities {
    /// Whether some parameters have no full rank here, either.
    pub fn is_deficient(&self, group: &NonIdentifiable, tolerance: f64) -> bool {
        let members = group.parameters.iter();
        let columns = members.map(|&k| self.columns[k].clone()).collect();
        let own = Sensitivities { values: Vec::new(), columns };
        let found = rank_alone(&own, tolerance);
        found.is_some_and(|rank| rank + group.excess <= group.parameters.len())
    }
}

/// How many directions have an effect, columns of unit length.
fn rank_alone(point: &Sensitivities, tolerance: f64) -> Option<usize> {
    let norms: Vec<f64> = point.columns.iter().map(|column| norm(column)).collect();
    let is_usable = norms.iter().all(|norm| norm.is_finite() && *norm > 0.0);
    let n = norms.len();
    let rows = point.columns.first().map_or(0, Vec::len).max(n);
    let scaled = DMatrix::from_fn(rows, n, |row, k| {
        point.columns[k].get(row).map_or(0.0, |value| value / norms[k])
    });
    let found = SingularValues::of(&scaled).filter(|_| is_usable)?;
    Some(found.s.iter().filter(|own| **own > tolerance * found.largest()).count())
}

fn nonzero(value: f64) -> f64 {
    if value == 0.0 { 1.0 } else { value }
}

/// Whether the effects of the changes of the parameters cancel each other.
fn is_without_effect(
    point: &Sensitivities,
    parameters: &[usize],
    change: &dyn Fn(usize) -> f64,
    tolerance: f64,
) -> bool {
    let points = point.columns.first().map_or(0, Vec::len);
    let (mut sum, mut size) = (vec![0.0; points], 0.0);
    for (k, &parameter) in parameters.iter().enumerate() {
        let column = &point.columns[parameter];
        size += norm(column) * change(k).abs();
        sum.iter_mut().zip(column).for_each(|(sum, value)| *sum += change(k) * value);
    }
    norm(&sum) <= tolerance * size
}

/// Combinations orthogonal to the directions, in row echelon form: each of the first parameters
/// with factor 1 in one of them.
fn orthogonal(directions: &[Vec<f64>], n: usize) -> Vec<Vec<f64>> {
    // Columns of equal size make the choice of pivots fair.
    let size: Vec<f64> = (0..n)
        .map(|k| nonzero(directions.iter().map(|d| d[k].abs()).fold(0.0, f64::max)))
        .collect();
    let mut rows: Vec<Vec<f64>> =
        directions.iter().map(|d| d.iter().zip(&size).map(|(d, s)| d / s).collect()).collect();
    // Solved for the last parameters: what remains is free and spans the complement.
    let mut pivots = Vec::new();
    for row in 0..rows.len() {
        let open = (0..n).rev().filter(|k| !pivots.contains(k));
        let Some(pivot) = open.max_by(|a, b| {
            rows[row][*a]
                .abs()
                .partial_cmp(&rows[row][*b].abs())
                .unwrap_or(std::cmp::Ordering::Equal)
        }) else {
            break;
        };
        let divisor = rows[row][pivot];
        rows[row].iter_mut().for_each(|value| *value /= divisor);
        for other in (0..rows.len()).filter(|other| *other != row) {
            let factor = rows[other][pivot];
            let own = rows[row].clone();
            rows[other].iter_mut().zip(own).for_each(|(value, own)| *value -= factor * own);
        }
        pivots.push(pivot);
    }
    let free = (0..n).filter(|k| !pivots.contains(k));
    let combination = |k: usize| {
        let mut combination = vec![0.0; n];
        combination[k] = 1.0 / size[k];
        for (row, &pivot) in rows.iter().zip(&pivots) {
            combination[pivot] = -row[k] / size[pivot];
        }
        let first = combination.iter().copied().find(|c| c.abs() > 1e-12 / size[k]);
        combination.iter().map(|c| c / first.unwrap_or(1.0)).collect()
    };
    free.map(combination).collect()
}

fn largest_is_one(direction: &[f64]) -> Vec<f64> {
    let most =
        direction.iter().copied().fold(0.0, |m: f64, v| if v.abs() > m.abs() { v } else { m });
    direction.iter().map(|value| value / nonzero(most)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sensitivities of a formula by its gradient at points x = 1, 2, 3, 4.
    fn at(values: &[f64], gradient: fn(&[f64], f64) -> Vec<f64>) -> Sensitivities {
        let rows: Vec<Vec<f64>> = (1..5).map(|x| gradient(values, f64::from(x))).collect();
        let columns = (0..values.len()).map(|k| rows.iter().map(|row| row[k]).collect()).collect();
        Sensitivities { values: values.to_vec(), columns }
    }

    fn found(gradient: fn(&[f64], f64) -> Vec<f64>, points: &[&[f64]]) -> Rank {
        let all: Vec<Sensitivities> = points.iter().map(|point| at(point, gradient)).collect();
        rank(&all[0], &all[1..], 1e-9)
    }

    #[test]
    fn powers_that_work_as_a_product_are_named() {
        // y = a b² x + c, and d without effect.
        let gradient = |p: &[f64], x: f64| vec![p[1] * p[1] * x, 2.0 * p[0] * p[1] * x, 1.0, 0.0];
        let rank = found(gradient, &[&[2.0, 5.0, 1.0, 1.0], &[3.0, 1.0, 2.0, 0.5]]);
        assert_eq!(rank.without_effect, [3]);
        let [group] = &rank.non_identifiable[..] else { panic!("{rank:?}") };
        assert_eq!((&group.parameters[..], group.excess), (&[0, 1][..], 1));
        assert_eq!(group.form, Form::Product);
        let [exponents] = &group.combinations[..] else { panic!("{group:?}") };
        assert!((exponents[0] - 1.0).abs() < 1e-9 && (exponents[1] - 2.0).abs() < 1e-9);
    }

    #[test]
    fn constants_of_a_sum_are_named() {
        // y = a + 300 b + 4 c + d x: two of three constants are too many.
        let gradient = |_: &[f64], x: f64| vec![1.0, 300.0, 4.0, x];
        let rank = found(gradient, &[&[1.0, 2.0, 3.0, 4.0], &[5.0, 1.0, 2.0, 0.5]]);
        let [group] = &rank.non_identifiable[..] else { panic!("{rank:?}") };
        assert_eq!((&group.parameters[..], group.excess), (&[0, 1, 2][..], 2));
        assert_eq!(group.form, Form::Sum);
        let [factors] = &group.combinations[..] else { panic!("{group:?}") };
        for (factor, expected) in factors.iter().zip([1.0, 300.0, 4.0]) {
            assert!((factor - expected).abs() < 1e-6 * expected, "{factors:?}");
        }
    }

    #[test]
    fn two_groups_are_two() {
        let gradient = |p: &[f64], x: f64| vec![p[1] * x, p[0] * x, p[3], p[2]];
        let rank = found(gradient, &[&[2.0, 5.0, 1.0, 3.0], &[3.0, 1.0, 2.0, 0.5]]);
        let groups: Vec<_> = rank.non_identifiable.iter().map(|g| g.parameters.clone()).collect();
        assert_eq!(groups, [vec![0, 1], vec![2, 3]]);
    }

    #[test]
    fn what_holds_at_the_best_point_alone_is_said_so() {
        // y = (a² + b²) x: neither a sum nor a product of powers of a and b.
        let gradient = |p: &[f64], x: f64| vec![2.0 * p[0] * x, 2.0 * p[1] * x];
        let rank = found(gradient, &[&[1.0, 2.0], &[3.0, 0.5]]);
        assert_eq!(rank.non_identifiable[0].form, Form::Local);
        let full = found(|p, x| vec![x, p[0] * x * x], &[&[1.0, 2.0], &[3.0, 0.5]]);
        assert!(full.non_identifiable.is_empty() && full.condition.is_some());
    }
}
