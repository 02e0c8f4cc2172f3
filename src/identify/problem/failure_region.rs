//! Where in the search space simulations fail: the half of the range of one parameter that tells
//! failures best from successes.

use super::Free;
use crate::elementary;
use crate::ga::has_failed;
use serde::{Deserialize, Serialize};

/// Fewer failures than these have no region.
const FEW: usize = 10;
/// Inside, failures are at least so many times as frequent as outside.
const DENSER: f64 = 3.0;
/// Knowing the side tells at least this part of what there is to know about failures.
const TELLING: f64 = 0.2;
/// Places at which a range is divided.
const CUTS: usize = 20;

/// Where failures cluster.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FailureRegion {
    /// The parameter.
    pub parameter: String,
    /// The part of its range.
    pub range: [f64; 2],
    /// Which part of the individuals failed there, and elsewhere.
    pub failed: [f64; 2],
    /// Which part of all failures lies there.
    pub share: f64,
}

/// The region that tells failures best from successes; `None` where none does. `individuals`:
/// values and fitness.
pub fn failure_region(
    parameters: &[Free],
    individuals: &[(Vec<f64>, f64)],
) -> Option<FailureRegion> {
    let failed: Vec<bool> = individuals.iter().map(|(_, fitness)| has_failed(*fitness)).collect();
    let count = failed.iter().filter(|failed| **failed).count();
    if count < FEW || count == failed.len() {
        return None;
    }
    let mut best: Option<(f64, FailureRegion)> = None;
    for (k, free) in parameters.iter().enumerate() {
        let places: Vec<f64> =
            individuals.iter().map(|(values, _)| free.fraction(values[k])).collect();
        for cut in (1..CUTS).map(|cut| cut as f64 / CUTS as f64) {
            for below in [true, false] {
                let inside = |place: f64| (place < cut) == below;
                let tally = Tally::of(places.iter().map(|place| inside(*place)).zip(&failed));
                let Some(gain) = tally.gain() else { continue };
                if best.as_ref().is_none_or(|(known, _)| gain > *known) {
                    let middle = free.value(cut);
                    let range = if below { [free.min, middle] } else { [middle, free.max] };
                    best = Some((gain, tally.region(&free.name, range)));
                }
            }
        }
    }
    best.map(|(_, region)| tightened(parameters, individuals, &failed, region))
}

/// The region without the part of it at its inner end in which nothing failed: the cut lies on a
/// grid, the first failure need not.
fn tightened(
    parameters: &[Free],
    individuals: &[(Vec<f64>, f64)],
    failed: &[bool],
    region: FailureRegion,
) -> FailureRegion {
    let Some(k) = parameters.iter().position(|free| free.name == region.parameter) else {
        return region;
    };
    let below = region.range[0] == parameters[k].min;
    let inside = |value: f64| (region.range[0]..=region.range[1]).contains(&value);
    let failures =
        individuals.iter().zip(failed).filter(|(one, failed)| **failed && inside(one.0[k]));
    let values = failures.map(|(one, _)| one.0[k]);
    let range = match below {
        true => [region.range[0], values.fold(f64::NEG_INFINITY, f64::max)],
        false => [values.fold(f64::INFINITY, f64::min), region.range[1]],
    };
    let within = |value: f64| (range[0]..=range[1]).contains(&value);
    let places = individuals.iter().map(|(values, _)| within(values[k]));
    Tally::of(places.zip(failed)).region(&region.parameter, range)
}

/// Individuals and failures inside and outside.
#[derive(Default)]
struct Tally {
    all: [f64; 2],
    failed: [f64; 2],
}

impl Tally {
    fn of<'a>(individuals: impl Iterator<Item = (bool, &'a bool)>) -> Tally {
        let mut tally = Tally::default();
        for (inside, failed) in individuals {
            let side = usize::from(!inside);
            tally.all[side] += 1.0;
            tally.failed[side] += f64::from(u8::from(*failed));
        }
        tally
    }

    fn parts(&self) -> [f64; 2] {
        [0, 1].map(|side| self.failed[side] / self.all[side].max(1.0))
    }

    fn share(&self) -> f64 {
        self.failed[0] / (self.failed[0] + self.failed[1])
    }

    /// Which part of the uncertainty about failures is gone when the side is known; `None` where
    /// that is no cluster.
    fn gain(&self) -> Option<f64> {
        let [inside, outside] = self.parts();
        let all = self.all[0] + self.all[1];
        let before = entropy((self.failed[0] + self.failed[1]) / all);
        let after = (self.all[0] * entropy(inside) + self.all[1] * entropy(outside)) / all;
        let gain = 1.0 - after / before;
        (inside >= DENSER * outside && gain >= TELLING).then_some(gain)
    }

    fn region(&self, parameter: &str, range: [f64; 2]) -> FailureRegion {
        let (failed, share) = (self.parts(), self.share());
        FailureRegion { parameter: parameter.to_owned(), range, failed, share }
    }
}

/// Uncertainty about an event of this probability, in nats.
fn entropy(p: f64) -> f64 {
    let term = |p: f64| if p > 0.0 { -p * elementary::ln(p) } else { 0.0 };
    term(p) + term(1.0 - p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ga::FAILED_FITNESS;

    fn grid(fails: impl Fn(f64, f64) -> bool) -> Vec<(Vec<f64>, f64)> {
        let place = |k: usize| (k as f64 + 0.5) / 30.0;
        let one = |(j, k): (usize, usize)| {
            let (a, b) = (place(j), 10.0 * place(k));
            (vec![a, b], if fails(a, b) { FAILED_FITNESS } else { 1.0 })
        };
        (0..30).flat_map(|j| (0..30).map(move |k| (j, k))).map(one).collect()
    }

    fn free() -> [Free; 2] {
        let free = |name: &str, max| Free::new(name, "", [0.0, max], Some(false), None).unwrap();
        [free("a", 1.0), free("b", 10.0)]
    }

    #[test]
    fn the_half_in_which_simulations_fail_is_found() {
        let found = failure_region(&free(), &grid(|_, b| b > 7.4)).unwrap();
        assert_eq!(found.parameter, "b");
        // The first failure of the grid.
        assert!((found.range[0] - 7.5).abs() < 1e-9 && found.range[1] == 10.0, "{found:?}");
        assert!(found.share == 1.0 && found.failed == [1.0, 0.0]);
    }

    #[test]
    fn failures_everywhere_have_no_region() {
        let scattered = grid(|a, b| ((100.0 * a + 7.0 * b) as u32).is_multiple_of(5));
        assert!(failure_region(&free(), &scattered).is_none());
        assert!(failure_region(&free(), &grid(|_, _| false)).is_none());
    }
}
