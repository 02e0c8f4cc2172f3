//! Intervals of a fit that stands at an end of the search range: a parameter there can move inwards
//! only, so that the others' intervals are those of the sum of squares within the range.
//!
//! With the weighted sensitivities J and residuals r the sum of squares about the fit is
//! S(δ) = |r − J δ|². The profile of parameter k is the least S with δₖ given and every parameter at
//! an end moving inwards or not at all; its interval ends where S has risen by t² times the variance.
//! Parameters that no end holds are eliminated; what remains is a small quadratic problem with signs,
//! solved by projected Gauss-Seidel sweeps.
//!
//! Where parameters act only together, or not at all, the data determine the others as they would
//! without them: such a group counts by an orthonormal basis of its columns, and no end holds a member
//! of it, because the other members make up for that one.
//!
//! Reference: [Walter & Pronzato 1997](gapilib_base::bibliography#walter-pronzato-1997), chapter 5.

use crate::problem::non_identifiable::NonIdentifiable;
use crate::singular_values::SingularValues;
use crate::{Uncertainty, uncertainty_given};
use nalgebra::{DMatrix, DVector};

/// Sweeps over the parameters at ends; they converge linearly, and there are few.
const SWEEPS: usize = 400;
/// Doublings that bracket the end of an interval, and halvings that locate it.
const DOUBLINGS: usize = 60;
const HALVINGS: usize = 60;
/// What the others leave of the square of a column, as a part of it, below which it may be rounding,
/// which is 1e-16 times the condition of the others: they make up for the parameter. Intervals from
/// such a remainder had no width (polarization curve of a fuel cell, two temperatures, group of three).
const INDEPENDENT: f64 = 1e-10;

/// A parameter that stands at an end of its range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::problem) struct AtEnd {
    /// Which one.
    pub parameter: usize,
    /// 1 where the range lies above the end, −1 where below.
    pub(crate) inward: f64,
    /// How far the linear fit would go beyond the end, in standard errors, if no end held any
    /// parameter.
    pub pull: f64,
}

/// What holds where some parameters stand at ends of their ranges.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::problem) struct AtBounds {
    /// Those parameters.
    pub ends: Vec<AtEnd>,
    /// By how much the weighted sum of squares is smaller where the linear fit would go.
    pub fall: f64,
    /// Standard errors and correlations of the others with those held.
    pub held: Uncertainty,
    /// How far the 95 % interval of each parameter reaches below and above, in its unit; infinitely
    /// far where the data leave it open.
    pub reach: Vec<[f64; 2]>,
}

impl AtBounds {
    /// From the weighted sensitivities, column by column, the groups that act only together, the
    /// variance, and the rise of the sum of squares that a 95 % interval allows. `None` where no
    /// parameter stands at an end that holds it, or the data leave a further direction open.
    pub fn of(
        columns: &[Vec<f64>],
        groups: &[NonIdentifiable],
        residuals: Option<&[f64]>,
        inward: &[Option<f64>],
        variances: [f64; 2],
    ) -> Option<AtBounds> {
        let determined = Determined::of(columns, groups);
        let mut own = vec![None; determined.columns.len()];
        for (place, inward) in determined.places.iter().zip(inward) {
            place.iter().for_each(|&place| own[place] = *inward);
        }
        let found = AtBounds::of_independent(&determined.columns, residuals, &own, variances)?;
        Some(found.at(&determined.places))
    }

    /// The same of all parameters, of which `places` says where they are here.
    fn at(self, places: &[Option<usize>]) -> AtBounds {
        let n = places.len();
        let parameter = |place: usize| places.iter().position(|own| *own == Some(place));
        let end = |end: AtEnd| Some(AtEnd { parameter: parameter(end.parameter)?, ..end });
        let count = self.reach.len();
        let correlation = |at: usize| {
            let pair = places[at / n].zip(places[at % n]);
            pair.map_or(f64::NAN, |(a, b)| self.held.correlations[a * count + b])
        };
        let open = [f64::INFINITY; 2];
        AtBounds {
            ends: self.ends.into_iter().filter_map(end).collect(),
            fall: self.fall,
            held: Uncertainty {
                standard_deviations: places
                    .iter()
                    .map(|own| own.map_or(f64::INFINITY, |k| self.held.standard_deviations[k]))
                    .collect(),
                correlations: (0..n * n).map(correlation).collect(),
            },
            reach: places.iter().map(|own| own.map_or(open, |k| self.reach[k])).collect(),
        }
    }

    /// The same, where every column has a direction of its own.
    fn of_independent(
        columns: &[Vec<f64>],
        residuals: Option<&[f64]>,
        inward: &[Option<f64>],
        [variance, rise]: [f64; 2],
    ) -> Option<AtBounds> {
        let n = columns.len();
        let at_ends: Vec<usize> = (0..n).filter(|&k| inward[k].is_some()).collect();
        if at_ends.is_empty() {
            return None;
        }
        let full = uncertainty_given(columns, variance)?;
        if !full.standard_deviations.iter().all(|own| own.is_finite()) {
            return None;
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // Elsewhere the sum is at its minimum, but for rounding.
        let component = |k: usize| {
            residuals.filter(|_| inward[k].is_some()).map_or(0.0, |r| dot(&columns[k], r))
        };
        let quadratic = Quadratic {
            gradient: (0..n).map(component).collect(),
            gram: DMatrix::from_fn(n, n, |k, l| dot(&columns[k], &columns[l])),
            inward: inward.to_vec(),
        };
        // H⁻¹ s in standard errors. Ends together hold what each does: a parameter may only stand at
        // its end because others do at theirs.
        let step = |k: usize| {
            let of = |l: usize| full.correlations[k * n + l] * full.standard_deviations[l];
            (0..n).map(|l| of(l) * quadratic.gradient[l]).sum::<f64>() / variance
        };
        let fall =
            at_ends.iter().map(|&k| quadratic.gradient[k] * step(k) * full.standard_deviations[k]);
        let fall = fall.sum();
        let pull = |k: usize| -inward[k].unwrap_or(0.0) * step(k);
        let ends = at_ends.iter().map(|&k| AtEnd {
            parameter: k,
            inward: inward[k].unwrap_or(0.0),
            pull: pull(k),
        });
        let held = others_alone(columns, variance, inward)?;
        let sides = |k: usize| -> Option<[f64; 2]> {
            let first = full.standard_deviations[k];
            Some([quadratic.reach(k, -1.0, first, rise)?, quadratic.reach(k, 1.0, first, rise)?])
        };
        let reach: Option<Vec<[f64; 2]>> = (0..n).map(sides).collect();
        Some(AtBounds { ends: ends.collect(), fall, held, reach: reach? })
    }
}

/// What the data determine.
struct Determined {
    /// The columns of parameters by themselves, and bases of the groups.
    columns: Vec<Vec<f64>>,
    /// Which of them is that of each parameter; `None` for members of groups and those without effect.
    places: Vec<Option<usize>>,
}

impl Determined {
    fn of(columns: &[Vec<f64>], groups: &[NonIdentifiable]) -> Determined {
        let is_member = |k: usize| groups.iter().any(|group| group.parameters.contains(&k));
        let has_effect = |k: usize| columns[k].iter().any(|value| *value != 0.0);
        let mut found = Determined { columns: Vec::new(), places: vec![None; columns.len()] };
        for k in (0..columns.len()).filter(|&k| has_effect(k) && !is_member(k)) {
            found.places[k] = Some(found.columns.len());
            found.columns.push(columns[k].clone());
        }
        for group in groups {
            found.columns.extend(basis(columns, group));
        }
        found
    }
}

/// An orthonormal basis of what the columns of a group determine together.
fn basis(columns: &[Vec<f64>], group: &NonIdentifiable) -> Vec<Vec<f64>> {
    let members = &group.parameters;
    let points = columns.first().map_or(0, Vec::len);
    let norm = |k: usize| columns[k].iter().map(|v| v * v).sum::<f64>().sqrt();
    let norms: Vec<f64> = members.iter().map(|&k| norm(k)).collect();
    let rows = points.max(members.len());
    let scaled = DMatrix::from_fn(rows, members.len(), |j, k| {
        columns[members[k]].get(j).map_or(0.0, |value| value / norms[k])
    });
    let Some(found) = SingularValues::of(&scaled) else { return Vec::new() };
    let rank = members.len().saturating_sub(group.excess);
    (0..rank).map(|d| (0..points).map(|j| found.u[(j, d)]).collect()).collect()
}

/// Standard errors of the parameters that no end holds, in the order of all parameters; the others
/// have infinite ones.
fn others_alone(
    columns: &[Vec<f64>],
    variance: f64,
    inward: &[Option<f64>],
) -> Option<Uncertainty> {
    let n = columns.len();
    let free: Vec<usize> = (0..n).filter(|&k| inward[k].is_none()).collect();
    let (mut standard_deviations, mut correlations) =
        (vec![f64::INFINITY; n], vec![f64::NAN; n * n]);
    if free.is_empty() {
        return Some(Uncertainty { standard_deviations, correlations });
    }
    let own: Vec<Vec<f64>> = free.iter().map(|&k| columns[k].clone()).collect();
    let found = uncertainty_given(&own, variance)?;
    for (a, &k) in free.iter().enumerate() {
        standard_deviations[k] = found.standard_deviations[a];
        for (b, &l) in free.iter().enumerate() {
            correlations[k * n + l] = found.correlations[a * free.len() + b];
        }
    }
    Some(Uncertainty { standard_deviations, correlations })
}

/// S(δ) − S(0) = δᵀHδ − 2 sᵀδ.
struct Quadratic {
    gram: DMatrix<f64>,
    gradient: Vec<f64>,
    inward: Vec<Option<f64>>,
}

impl Quadratic {
    /// How far parameter `k` can go to this side before the least sum has risen by `rise`; `first`: the
    /// distance to begin with.
    fn reach(&self, k: usize, side: f64, first: f64, rise: f64) -> Option<f64> {
        if self.inward[k].is_some_and(|inward| inward != side) {
            return Some(0.0);
        }
        let reduced = self.reduced(k)?;
        let is_inside = |distance: f64| reduced.least(side * distance) <= rise;
        let (mut inside, mut outside) = (0.0, first);
        let mut doublings = 0;
        while is_inside(outside) {
            (inside, outside) = (outside, 2.0 * outside);
            doublings += 1;
            if doublings > DOUBLINGS || !outside.is_finite() {
                return None;
            }
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            *(if is_inside(middle) { &mut inside } else { &mut outside }) = middle;
        }
        Some(inside)
    }

    /// The sum as a function of parameter `k`, first, and of those at ends, the others at their best.
    fn reduced(&self, k: usize) -> Option<Reduced> {
        let n = self.gradient.len();
        let kept: Vec<usize> = std::iter::once(k)
            .chain((0..n).filter(|&l| l != k && self.inward[l].is_some()))
            .collect();
        let free: Vec<usize> = (0..n).filter(|l| !kept.contains(l)).collect();
        let part = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |a, b| self.gram[(rows[a], columns[b])])
        };
        let mut gram = part(&kept, &kept);
        if !free.is_empty() {
            let across = part(&free, &kept);
            let solved = part(&free, &free).cholesky()?.solve(&across);
            gram -= across.tr_mul(&solved);
        }
        let is_open = |(at, &l): (usize, &usize)| {
            gram[(at, at)].is_nan() || gram[(at, at)] <= INDEPENDENT * self.gram[(l, l)]
        };
        if kept.iter().enumerate().any(is_open) {
            return None;
        }
        // The gradient components of the free ones are zero.
        let gradient = DVector::from_iterator(kept.len(), kept.iter().map(|&l| self.gradient[l]));
        let signs = kept.iter().skip(1).map(|&l| self.inward[l].unwrap_or(0.0)).collect();
        Some(Reduced { gram, gradient, signs })
    }
}

struct Reduced {
    gram: DMatrix<f64>,
    gradient: DVector<f64>,
    /// Directions in which all but the first may move.
    signs: Vec<f64>,
}

impl Reduced {
    /// The least sum, less that of the fit, where the first parameter has moved by `distance`.
    fn least(&self, distance: f64) -> f64 {
        let n = self.gradient.len();
        let mut by = DVector::zeros(n);
        by[0] = distance;
        for _ in 0..if n > 1 { SWEEPS } else { 0 } {
            for k in 1..n {
                let rest = self.gram.row(k).dot(&by.transpose()) - self.gram[(k, k)] * by[k];
                let minimum = (self.gradient[k] - rest) / self.gram[(k, k)];
                by[k] = if minimum * self.signs[k - 1] > 0.0 { minimum } else { 0.0 };
            }
        }
        (&self.gram * &by).dot(&by) - 2.0 * self.gradient.dot(&by)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two parameters with unit variance and correlation c of their estimates: H = [1 c; c 1] up to
    /// the sign, columns of length one at the angle acos(c).
    fn columns(c: f64) -> Vec<Vec<f64>> {
        vec![vec![1.0, 0.0, 0.0], vec![c, (1.0 - c * c).sqrt(), 0.0]]
    }

    /// The second parameter at its lower end with no pull: where the first moves so that the second
    /// would follow outwards, the interval is that with the second held (half-width t/|column|); to
    /// the other side it is the whole one.
    #[test]
    fn an_interval_is_narrow_on_the_side_where_the_end_holds() {
        let c = 0.8;
        let found =
            AtBounds::of(&columns(c), &[], Some(&[0.0, 0.0, 1.0]), &[None, Some(1.0)], [1.0, 4.0])
                .unwrap();
        let [below, above] = found.reach[0];
        // δ₂ follows −c δ₁: upwards it would leave the range.
        assert!((above - 2.0).abs() < 1e-9, "{above}");
        assert!((below - 2.0 / (1.0 - c * c).sqrt()).abs() < 1e-9, "{below}");
        assert_eq!(found.reach[1][0], 0.0);
        let inwards = found.reach[1][1];
        assert!((inwards - 2.0 / (1.0 - c * c).sqrt()).abs() < 1e-9, "{inwards}");
        assert!((found.held.standard_deviations[0] - 1.0).abs() < 1e-12);
        assert!(found.held.standard_deviations[1].is_infinite());
    }

    /// An end against which the data press: the other's interval is that with it held, on both
    /// sides, and the pull is the distance of the linear minimum in standard errors.
    #[test]
    fn a_pressed_end_holds_on_both_sides() {
        let columns = columns(0.5);
        // The gradient s = Jᵀr presses the second parameter downwards, out of its range.
        let residuals = [0.0, -20.0, 0.0];
        let found =
            AtBounds::of(&columns, &[], Some(&residuals), &[None, Some(1.0)], [1.0, 4.0]).unwrap();
        for side in found.reach[0] {
            assert!((side - 2.0).abs() < 1e-9, "{side}");
        }
        assert!((found.ends[0].pull - 20.0).abs() < 1e-9, "{:?}", found.ends);
        assert!(found.reach[1][1] < 0.12, "{:?}", found.reach);
    }

    /// y = a + b t with data whose fit is a = 1.04 ± 0.0849 and b = -0.52 ± 0.0346 (numpy), within
    /// a ≥ 1.2 and b ≥ -0.4: the linear fit without the ends is that fit, and its sum of squares 0.036.
    #[test]
    fn several_ends_are_left_together() {
        let t = [0.0, 1.0, 2.0, 3.0, 4.0];
        let residuals: Vec<f64> =
            [1.0, 0.6, -0.1, -0.4, -1.1].iter().zip(t).map(|(y, t)| y - (1.2 - 0.4 * t)).collect();
        let square: f64 = residuals.iter().map(|r| r * r).sum();
        let variances = [square / 3.0, 10.0 * square / 3.0];
        let inward = [Some(1.0), Some(1.0)];
        let columns = [vec![1.0; 5], t.to_vec()];
        let found = AtBounds::of(&columns, &[], Some(&residuals), &inward, variances).unwrap();
        assert!((square - found.fall - 0.036).abs() < 1e-12, "{}", found.fall);
        let scale = (square / 0.036).sqrt();
        for (end, expected) in found.ends.iter().zip([0.16 / 0.084_853, 0.12 / 0.034_641]) {
            assert!((end.pull * scale - expected).abs() < 1e-4 * expected, "{end:?}");
        }
    }

    #[test]
    fn without_an_end_or_with_an_open_direction_there_is_nothing() {
        assert_eq!(AtBounds::of(&columns(0.5), &[], None, &[None, None], [1.0, 4.0]), None);
        let open = [vec![1.0, 1.0, 1.0], vec![1.0, 1.0, 1.0]];
        let found = AtBounds::of(&open, &[], None, &[Some(1.0), None], [1.0, 4.0]);
        assert_eq!(found, None);
        // Open but for rounding, at a point that is a minimum but for rounding.
        let (a, b) = ([1.0, 0.3, 0.1, 0.7], [0.2, 1.0, 0.4, 0.1]);
        let sum = [a[0] + b[0], a[1] + b[1], a[2] + b[2] + 1e-9, a[3] + b[3]];
        let columns = [sum.to_vec(), a.to_vec(), b.to_vec(), vec![0.0, 0.0, 1.0, 2.0]];
        let residuals = [1e-3, -1e-3, 2e-3, 1e-3];
        let inward = [Some(1.0), None, None, None];
        assert_eq!(AtBounds::of(&columns, &[], Some(&residuals), &inward, [1e-6, 4e-6]), None);
    }

    /// Two parameters of which only the sum acts, and one without effect, beside a pair with an end:
    /// the pair has the intervals that it has with one parameter in place of the two.
    #[test]
    fn what_acts_only_together_does_not_hide_the_ends_of_others() {
        use crate::problem::non_identifiable::{NonIdentifiable, rank};
        use crate::problem::sensitivities::Sensitivities;
        let [a, b] = [[1.0, 0.3, 0.0, 0.7], [0.2, 1.0, 0.4, 0.1]].map(Vec::from);
        let sum = vec![0.3, 0.1, 1.0, 0.2];
        let residuals = [0.0, -1.0, 0.0, 0.5];
        let of = |columns: &[Vec<f64>], groups: &[NonIdentifiable], inward: &[Option<f64>]| {
            AtBounds::of(columns, groups, Some(&residuals), inward, [1.0, 4.0])
        };
        let alone = [a.clone(), b.clone(), sum.clone()];
        let expected = of(&alone, &[], &[None, Some(1.0), None]).unwrap();
        let twice: Vec<f64> = sum.iter().map(|v| 2.0 * v).collect();
        let columns = [sum, a, vec![0.0; 4], b, twice];
        let best = Sensitivities { values: vec![1.0; 5], columns: columns.to_vec() };
        let groups = rank(&best, &[], 1e-9).non_identifiable;
        let inward = [Some(1.0), None, Some(1.0), Some(1.0), None];
        let found = of(&columns, &groups, &inward).unwrap();
        for (own, other) in [(1, 0), (3, 1)] {
            for side in 0..2 {
                let [own, other] = [found.reach[own][side], expected.reach[other][side]];
                assert!((own - other).abs() <= 1e-9 * other, "{own} {other}");
            }
        }
        let deviation = found.held.standard_deviations[1] / expected.held.standard_deviations[0];
        assert!((deviation - 1.0).abs() < 1e-12, "{deviation}");
        for open in [0, 2, 4] {
            assert_eq!(found.reach[open], [f64::INFINITY; 2]);
            assert!(found.held.standard_deviations[open].is_infinite());
        }
        let held: Vec<usize> = found.ends.iter().map(|end| end.parameter).collect();
        assert_eq!(held, [3], "the other members make up for the first");
    }
}
