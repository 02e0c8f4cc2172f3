//! Negative logarithm of the likelihood of normal errors. Some standard deviations are given, others
//! are estimated along with the parameters, one for each group of points, and others are computed by
//! the model: then the simulation has a further point for each, σᵢ.
//!
//! ```text
//! -log L = n/2 ln 2π + Σ_given ½ uᵢ² + Σ_groups n_g/2 (ln s_g² + 1) + Σ_computed (½ uᵢ² + ln σᵢ)
//!          - Σ ln wᵢ,   uᵢ = wᵢ (yᵢ − ŷᵢ), of those computed over σᵢ,   s_g² = Σ_g uᵢ² / n_g
//! ```
//!
//! The estimated deviations have been put in (the likelihood is concentrated), so that only the
//! parameters are searched. For least squares, with
//! G = exp((Σ_given uᵢ² + Σ_g n_g ln s_g² + Σ_computed (uᵢ² + 2 ln σᵢ)) / N), which grows with -log L
//! (beyond [`LINEAR`] on the tangent of this function, which does not overflow), and N the number of
//! points with those of the deviations: residuals √G κ uᵢ (estimated: uᵢ / s_g),
//! and √G κ (uᵢ² - 1)/√2 of the deviations, whose squares add up to N G; factors √G wᵢ/κ (over s_g or
//! σᵢ), and -√G √2/(κ σᵢ) of the deviations, for which the gradient is exact; where deviations are
//! computed, factors are κ² times that, so that a step from far away, where κ is small, is that of the
//! Fisher scoring;
//! κ² = N / (Σ_given uᵢ² + Σ_g n_g + Σ_computed (uᵢ² + ½ (uᵢ² - 1)²)), near 1 where the deviations
//! hold. The factors give the Fisher information: 2/σᵢ² of a deviation.
//!
//! Outputs whose errors at one instant are correlated are in `joint.rs`; where their covariance is given,
//! factors are κ² times that as well.
//!
//! Reference: [Seber & Wild 1989](gapilib_base::bibliography#seber-wild-1989), section 2.2 and chapter 11.

use super::joint::{JointGroup, JointScales, Whitening};
use super::{Fitness, Law, checked};
use crate::elementary;
use nalgebra::DMatrix;

/// Exponents beyond this are those of models that miss the measurements by ten of their deviations
/// and more, as without the noise of a process; the exponential function overflows beyond 709.
const LINEAR: f64 = 100.0;

/// G of an exponent, and by which part of itself it grows with the exponent.
fn growth(exponent: f64) -> [f64; 2] {
    match exponent > LINEAR {
        true => {
            let beyond = 1.0 + (exponent - LINEAR);
            [elementary::exp(LINEAR) * beyond, 1.0 / beyond]
        }
        false => [elementary::exp(exponent), 1.0],
    }
}

/// Twice -log L, but for a constant, where so many points have this sum of squares.
pub(crate) fn twice_negative_log(sum: f64, points: f64) -> f64 {
    let own = sum / points;
    let largest = elementary::exp(LINEAR);
    points
        * match own > largest {
            true => LINEAR + own / largest - 1.0,
            false => elementary::ln(own),
        }
}

/// The sum of squares of so many points where twice -log L is larger by `rise`.
pub(crate) fn raised(sum: f64, points: f64, rise: f64) -> f64 {
    points * growth((twice_negative_log(sum, points) + rise) / points)[0]
}

/// The standard deviation of a point, or what else the point is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Deviation {
    /// Given: the reciprocal of its weight.
    Given,
    /// Estimated, that of the group with this number.
    Group(usize),
    /// That of this output of a group with correlated errors.
    Joint(usize, usize),
    /// Computed by the model: the simulated value of the point with this number.
    Computed(usize),
    /// The point is itself the deviation of the point with this number.
    Of(usize),
}

/// The concentrated likelihood of some groups of points.
pub(crate) struct Concentrated {
    /// The density and the deviation of each point.
    points: Vec<(Law, Deviation)>,
    /// The groups.
    groups: Vec<Group>,
    /// Groups of outputs with correlated errors.
    joints: Vec<JointGroup>,
    /// Points that are measured.
    n_measured: f64,
}

/// Points with one deviation, which is estimated.
struct Group {
    /// Points.
    count: f64,
    /// The smallest deviation: that of the simulation's own errors.
    floor: f64,
    /// The points of it where some are not normal, so that the deviation has to be searched.
    searched: Vec<usize>,
}

/// What one simulation has.
struct Scales {
    /// Σ 2ρ of the given, and of those of searched groups.
    given: f64,
    /// Σ of the squares of the residuals of those, by G κ².
    given_squares: f64,
    /// s_g² of the groups.
    variance: Vec<f64>,
    /// Σ (2ρ + 2 ln σ) of those computed by the model.
    computed: f64,
    /// Σ of the squares of the residuals of those, by G κ².
    computed_squares: f64,
    /// Those of outputs with correlated errors.
    joints: Vec<JointScales>,
}

impl Concentrated {
    /// `floor`: the smallest standard deviation of each group, in units of the weighted points.
    pub fn new(points: Vec<(Law, Deviation)>, floor: Vec<f64>) -> Concentrated {
        let group = |floor| Group { count: 0.0, floor, searched: Vec::new() };
        let mut groups: Vec<Group> = floor.into_iter().map(group).collect();
        let mut n_measured = 0.0;
        for (law, own) in &points {
            match own {
                Deviation::Group(group) => groups[*group].count += law.densities(),
                Deviation::Of(_) => continue,
                Deviation::Given | Deviation::Computed(_) | Deviation::Joint(..) => {}
            }
            n_measured += 1.0;
        }
        for (number, group) in groups.iter_mut().enumerate() {
            let own = points.iter().enumerate();
            let own = own.filter(|(_, (_, own))| *own == Deviation::Group(number));
            let is_normal = own.clone().all(|(_, (law, _))| *law == Law::Normal);
            group.searched = if is_normal { Vec::new() } else { own.map(|own| own.0).collect() };
        }
        Concentrated { points, groups, joints: Vec::new(), n_measured }
    }

    /// The same with groups of outputs with correlated errors.
    pub fn with_joints(self, joints: Vec<JointGroup>) -> Concentrated {
        Concentrated { joints, ..self }
    }

    /// Groups of outputs with correlated errors at a simulation.
    fn joint_scales(&self, [simulated, measured, weights]: [&[f64]; 3]) -> Vec<JointScales> {
        if self.joints.is_empty() {
            return Vec::new();
        }
        let residuals: Vec<f64> = super::differences(simulated, measured, weights).collect();
        self.joints.iter().map(|joint| joint.scales(&residuals)).collect()
    }

    /// Those of a simulation; with corners of densities rounded off, as steps of least squares need it.
    fn scales(&self, [simulated, measured, weights]: [&[f64]; 3], is_rounded: bool) -> Scales {
        let joints = self.joint_scales([simulated, measured, weights]);
        let mut scales = Scales {
            given: 0.0,
            given_squares: joints.iter().map(|own| own.square).sum(),
            variance: vec![0.0; self.groups.len()],
            computed: 0.0,
            computed_squares: 0.0,
            joints,
        };
        let twice = |law: Law, u: f64| if is_rounded { law.rounded(u) } else { law.twice(u) };
        let differences = super::differences(simulated, measured, weights);
        for (k, (difference, (law, own))) in differences.zip(&self.points).enumerate() {
            let u = -difference;
            match *own {
                Deviation::Given if *law == Law::Poisson => {
                    scales.given += Law::twice_of_count(simulated[k], measured[k]);
                    let root = root_of_count(simulated[k]);
                    scales.given_squares +=
                        elementary::powi((simulated[k] - measured[k]) / root, 2);
                }
                Deviation::Given => {
                    scales.given += twice(*law, u);
                    scales.given_squares += law.square(u, is_rounded);
                }
                Deviation::Group(group) => scales.variance[group] += u * u,
                Deviation::Computed(at) => {
                    let sigma = simulated[at];
                    let own = u / sigma;
                    // The logarithm of what is no deviation is not a number: the simulation has failed.
                    let of_density = law.densities() * 2.0 * elementary::ln(sigma);
                    scales.computed += twice(*law, own) + of_density;
                    let excess = law.moment(own, is_rounded) - law.densities();
                    let of_scale = excess * excess / law.information_of_scale();
                    scales.computed_squares += law.square(own, is_rounded) + of_scale;
                }
                Deviation::Of(_) | Deviation::Joint(..) => {}
            }
        }
        for (variance, group) in scales.variance.iter_mut().zip(&self.groups) {
            // Not `max`, which would let NaN, the mark of a failed simulation, pass.
            let own = *variance / group.count;
            *variance =
                if own < group.floor * group.floor { group.floor * group.floor } else { own };
            if group.searched.is_empty() {
                scales.given_squares += group.count;
                continue;
            }
            let u = |k: &usize| (self.points[*k].0, weights[*k] * (simulated[*k] - measured[*k]));
            let points: Vec<(Law, f64)> = group.searched.iter().map(u).collect();
            let scale = likeliest(&points, group.floor, variance.sqrt(), is_rounded);
            *variance = scale * scale;
            for (law, u) in points {
                scales.given += twice(law, u / scale) - law.densities();
                scales.given_squares += law.square(u / scale, is_rounded);
            }
        }
        scales
    }

    /// Twice the part of -log L that depends on the parameters, but for a constant.
    fn exponent(&self, scales: &Scales) -> f64 {
        let groups = scales.variance.iter().zip(&self.groups);
        let of_groups = groups.map(|(variance, own)| own.count * elementary::ln(*variance));
        let of_joint = |(scales, own): (&JointScales, &JointGroup)| {
            let expected = if own.given.is_none() { own.count() } else { 0.0 };
            scales.log_determinants + scales.square - expected
        };
        let of_joints: f64 = scales.joints.iter().zip(&self.joints).map(of_joint).sum();
        scales.given + scales.computed + of_groups.sum::<f64>() + of_joints
    }
}

/// The standard deviation of a count; not 0, by which residuals are divided.
fn root_of_count(expected: f64) -> f64 {
    if expected < f64::MIN_POSITIVE { f64::MIN_POSITIVE.sqrt() } else { expected.sqrt() }
}

/// The most likely scale of points, Σ u ψ(u) = n with u in units of it and n values that were measured, but not less than `floor`. The
/// sum falls with the scale, so that the root is between two scales, and halving finds it.
fn likeliest(points: &[(Law, f64)], floor: f64, start: f64, is_rounded: bool) -> f64 {
    let excess = |scale: f64| {
        let one = |(law, u): &(Law, f64)| law.moment(u / scale, is_rounded) - law.densities();
        points.iter().map(one).sum::<f64>()
    };
    if start.is_nan() || excess(floor) <= 0.0 {
        return if start.is_nan() { f64::NAN } else { floor };
    }
    let (mut low, mut high) = (floor, start);
    while excess(high) > 0.0 && high < f64::MAX {
        (low, high) = (high, 2.0 * high);
    }
    loop {
        let middle = (low * high).sqrt();
        if middle <= low || middle >= high {
            return high;
        }
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
}

impl Fitness for Concentrated {
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        let scales = self.scales([simulated, measured, weights], false);
        let of_points = weights.iter().zip(measured).zip(&self.points);
        let of_points = of_points.filter(|(_, (_, own))| !matches!(own, Deviation::Of(_)));
        let densities = of_points.clone().filter(|(_, (law, _))| !law.is_censored());
        let is_normal = |law: Law| law == Law::Normal;
        let others = of_points.clone().filter(|(_, (law, _))| !is_normal(*law));
        let others = others.map(|((_, y), (law, _))| law.constant(*y) - Law::Normal.constant(*y));
        let estimated = self.joints.iter().filter(|own| own.given.is_none());
        let constant: f64 = self.groups.iter().map(|own| own.count).sum::<f64>()
            + estimated.map(JointGroup::count).sum::<f64>()
            + self.n_measured * Law::Normal.constant(0.0)
            - 2.0 * densities.map(|((w, _), _)| elementary::ln(*w)).sum::<f64>()
            + others.sum::<f64>();
        checked(0.5 * (self.exponent(&scales) + constant))
    }

    fn least_squares(&self, _: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
        Some(weights.to_vec())
    }

    fn scaled(
        &self,
        [simulated, measured, weights]: [&[f64]; 3],
        residuals: &mut [f64],
        factors: &mut [f64],
    ) -> bool {
        let scales = self.scales([simulated, measured, weights], true);
        let n = measured.len() as f64;
        let [growth, part] = growth(self.exponent(&scales) / n);
        let root = growth.sqrt();
        let kappa = (n / (scales.given_squares + scales.computed_squares)).sqrt();
        let is_computed = self.n_measured < n;
        // Far away κ is small, and steps were by κ² too short.
        let is_given = self.joints.iter().any(|own| own.given.is_some());
        let per = if is_computed || is_given { 1.0 / kappa } else { kappa / part };
        for (k, &(law, deviation)) in self.points.iter().enumerate() {
            if let Deviation::Of(point) = deviation {
                let sigma = simulated[k];
                let u = weights[point] / sigma * (simulated[point] - measured[point]);
                let information = law.information_of_scale().sqrt();
                let excess = law.moment(u, true) - law.densities();
                residuals[k] = root * kappa * excess / information;
                factors[k] = -root / per * information / sigma;
                continue;
            }
            let own = self.own_scale(k, (simulated, weights), &scales);
            let u = weights[k] / own * (simulated[k] - measured[k]);
            let factor = law.factor(u);
            residuals[k] = match law.is_censored() {
                true => root * kappa * law.residual(u),
                false => root * kappa * weights[k] / own * factor * (simulated[k] - measured[k]),
            };
            factors[k] = root / per * weights[k] / own * factor;
        }
        whitening(&scales.joints).apply(residuals);
        true
    }

    fn whitening(&self, compared: [&[f64]; 3]) -> Option<Whitening> {
        let all = self.joint_scales(compared);
        (!all.is_empty()).then(|| whitening(&all))
    }

    fn covariances(&self, compared: [&[f64]; 3]) -> Vec<DMatrix<f64>> {
        self.joint_scales(compared).into_iter().map(|own| own.covariance).collect()
    }

    fn error_weights(
        &self,
        simulated: &[f64],
        measured: &[f64],
        weights: &[f64],
    ) -> Option<Vec<f64>> {
        let scales = self.scales([simulated, measured, weights], false);
        let own = |(k, (law, deviation)): (usize, &(Law, Deviation))| match deviation {
            Deviation::Of(_) => law.information_of_scale().sqrt() / simulated[k],
            _ => {
                let per = weights[k] / self.own_scale(k, (simulated, weights), &scales);
                per * law.root_information(per * (simulated[k] - measured[k]))
            }
        };
        Some(self.points.iter().enumerate().map(own).collect())
    }
}

impl Concentrated {
    /// The scale of the errors of a measured point, in units of the weighted points.
    fn own_scale(&self, k: usize, (simulated, weights): (&[f64], &[f64]), scales: &Scales) -> f64 {
        match self.points[k] {
            (Law::Poisson, _) => weights[k] * root_of_count(simulated[k]),
            (_, Deviation::Group(group)) => scales.variance[group].sqrt(),
            (_, Deviation::Joint(joint, member)) => {
                scales.joints[joint].covariance[(member, member)].sqrt()
            }
            (_, Deviation::Computed(at)) => simulated[at],
            (_, Deviation::Given | Deviation::Of(_)) => 1.0,
        }
    }
}

fn whitening(joints: &[JointScales]) -> Whitening {
    let mut found = Whitening::default();
    joints.iter().for_each(|own| found.add(own));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::SQRT_2;

    fn cases() -> [Concentrated; 3] {
        let all = |g: [Deviation; 6], n| {
            Concentrated::new(g.map(|own| (Law::Normal, own)).to_vec(), vec![1e-9; n])
        };
        let (a, b, given) = (Deviation::Group(0), Deviation::Group(1), Deviation::Given);
        [all([a; 6], 1), all([a, a, a, b, b, b], 2), all([given, given, a, a, a, a], 1)]
    }

    const MEASURED: [f64; 6] = [1.0, 2.0, 3.0, 10.0, 20.0, 30.0];
    const WEIGHTS: [f64; 6] = [10.0, 5.0, 1.0, 1.0, 1.0, 0.5];

    fn simulated(p: f64) -> [f64; 6] {
        [1.1 + p, 1.8, 3.3 - p, 11.0 + p * p, 19.0 - 2.0 * p, 31.0 + p]
    }

    /// -log L as the sum of logarithms of normal densities with the maximum likelihood deviations.
    #[test]
    fn the_value_is_the_sum_of_the_logarithms_of_the_densities() {
        let s = simulated(0.2);
        for own in cases() {
            let weights = own.error_weights(&s, &MEASURED, &WEIGHTS).unwrap();
            let density = |k: usize| {
                let u = weights[k] * (MEASURED[k] - s[k]);
                0.5 * u * u - weights[k].ln() + 0.5 * std::f64::consts::TAU.ln()
            };
            let expected: f64 = (0..6).map(density).sum();
            let found = own.fitness(&s, &MEASURED, &WEIGHTS);
            assert!((found - expected).abs() < 1e-10, "{found} {expected}");
        }
    }

    /// Σ r² = n exp(2 (-log L - constant)/n), and its derivative is 2 Σ f r ∂ŷ/∂p.
    #[test]
    fn squares_and_their_gradient_are_those_of_the_likelihood() {
        for own in cases() {
            let (mut r, mut f) = ([0.0; 6], [0.0; 6]);
            let mut square = |p: f64| {
                assert!(own.scaled([&simulated(p), &MEASURED, &WEIGHTS], &mut r, &mut f));
                (r.iter().map(|r| r * r).sum::<f64>(), r, f)
            };
            let value = |p: f64| own.fitness(&simulated(p), &MEASURED, &WEIGHTS);
            let (a, b) = (square(0.2).0, square(0.3).0);
            let ratio = (value(0.3) - value(0.2)) / 3.0;
            assert!(((b / a).ln() - ratio).abs() < 1e-10, "{} {ratio}", (b / a).ln());
            let h = 1e-6;
            let expected = (square(0.2 + h).0 - square(0.2 - h).0) / (2.0 * h);
            let (_, r, f) = square(0.2);
            let derivative = [1.0, 0.0, -1.0, 0.4, -2.0, 1.0];
            let found: f64 = (0..6).map(|k| 2.0 * f[k] * r[k] * derivative[k]).sum();
            assert!((found - expected).abs() < 1e-6 * expected.abs(), "{found} {expected}");
        }
    }

    /// Two measured points whose deviations the model computes, beside one with a given one.
    #[test]
    fn deviations_that_the_model_computes_are_points_of_their_own() {
        let own = Concentrated::new(
            [
                Deviation::Computed(3),
                Deviation::Computed(4),
                Deviation::Given,
                Deviation::Of(0),
                Deviation::Of(1),
            ]
            .map(|own| (Law::Normal, own))
            .to_vec(),
            Vec::new(),
        );
        let (measured, weights) = ([1.0, 2.0, 3.0, 0.0, 0.0], [1.0, 0.5, 2.0, 1.0, 1.0]);
        let simulated = |p: f64| [1.1 + p, 2.3, 3.3 - p, 0.2 + p * p, 0.5 - 0.3 * p];
        let value = |p: f64| own.fitness(&simulated(p), &measured, &weights);
        let density = |e: f64, sigma: f64| {
            0.5 * (e / sigma).powi(2) + sigma.ln() + 0.5 * std::f64::consts::TAU.ln()
        };
        let s = simulated(0.2);
        let expected =
            density(s[0] - 1.0, s[3]) + density(s[1] - 2.0, 2.0 * s[4]) + density(s[2] - 3.0, 0.5);
        assert!((value(0.2) - expected).abs() < 1e-12, "{} {expected}", value(0.2));
        let weights_there = own.error_weights(&s, &measured, &weights).unwrap();
        assert!((weights_there[1] - 0.5 / s[4]).abs() < 1e-15);
        assert!((weights_there[3] - SQRT_2 / s[3]).abs() < 1e-12);
        let (mut r, mut f) = ([0.0; 5], [0.0; 5]);
        let mut square = |p: f64| {
            assert!(own.scaled([&simulated(p), &measured, &weights], &mut r, &mut f));
            (r.iter().map(|r| r * r).sum::<f64>(), r, f)
        };
        let ratio = (value(0.3) - value(0.2)) / 2.5;
        assert!(((square(0.3).0 / square(0.2).0).ln() - ratio).abs() < 1e-12);
        let h = 1e-6;
        let expected = (square(0.2 + h).0 - square(0.2 - h).0) / (2.0 * h);
        let (_, r, f) = square(0.2);
        let derivative = [1.0, 0.0, -1.0, 0.4, -0.3];
        // The factors have κ² besides those of the gradient.
        let residuals = [(s[0] - 1.0) / s[3], 0.5 * (s[1] - 2.0) / s[4], 2.0 * (s[2] - 3.0)];
        let squares: f64 = residuals.iter().map(|u| u * u).sum();
        let excess: f64 = residuals[..2].iter().map(|u| 0.5 * (u * u - 1.0).powi(2)).sum();
        let kappa_squared = 5.0 / (squares + excess);
        let found: f64 =
            (0..5).map(|k| 2.0 * f[k] * r[k] * derivative[k]).sum::<f64>() / kappa_squared;
        assert!((found - expected).abs() < 1e-7 * expected.abs(), "{found} {expected}");
        // What is no deviation has failed.
        let negative = [1.0, 2.0, 3.0, -0.1, 0.5];
        assert_eq!(own.fitness(&negative, &measured, &weights), crate::ga::FAILED_FITNESS);
    }

    /// Far away, where an exponential function overflows, the sum still falls with -log L, by the
    /// gradient of the factors.
    #[test]
    fn sums_of_measurements_that_are_missed_by_thousands_of_deviations_are_finite() {
        let own = Concentrated::new(vec![(Law::Normal, Deviation::Given); 6], Vec::new());
        let weights = [1e4; 6];
        let (mut r, mut f) = ([0.0; 6], [0.0; 6]);
        let mut square = |p: f64| {
            assert!(own.scaled([&simulated(p), &MEASURED, &weights], &mut r, &mut f));
            (r.iter().map(|r| r * r).sum::<f64>(), r, f)
        };
        let value = |p: f64| own.fitness(&simulated(p), &MEASURED, &weights);
        let (sum, r, f) = square(0.2);
        assert!(sum.is_finite(), "{sum}");
        let rise = 2.0 * (value(0.3) - value(0.2));
        let other = square(0.3).0;
        assert!((raised(sum, 6.0, rise) - other).abs() < 1e-9 * other, "{other}");
        let h = 1e-6;
        let expected = (square(0.2 + h).0 - square(0.2 - h).0) / (2.0 * h);
        let derivative = [1.0, 0.0, -1.0, 0.4, -2.0, 1.0];
        let found: f64 = (0..6).map(|k| 2.0 * f[k] * r[k] * derivative[k]).sum();
        assert!((found - expected).abs() < 1e-6 * expected.abs(), "{found} {expected}");
        // Where it does not overflow, the sum is the exponential function.
        assert!((raised(6.0, 6.0, 3.0) - 6.0 * 0.5_f64.exp()).abs() < 1e-12);
    }

    #[test]
    fn an_exact_fit_is_not_infinitely_likely_and_a_failed_one_is_worst() {
        for own in cases() {
            assert!(own.fitness(&MEASURED, &MEASURED, &WEIGHTS).is_finite());
            let failed = own.fitness(&[f64::NAN; 6], &MEASURED, &WEIGHTS);
            assert_eq!(failed, crate::ga::FAILED_FITNESS);
        }
    }
}
