//! Accumulation of events (Zeno behaviour): infinitely many within a finite time.
//!
//! Impacts that change states and follow each other faster and faster, such as those of a ball on
//! the ground, come to an end: where the next flight would stay within the uncertainty of its
//! crossing function z, the solution rests at z = 0. With w = dz/dt and the direction d in which the
//! impact changed the states
//!
//! ```text
//! the states are moved along d until w = 0
//! from then on a force along d keeps w at zero (`sliding`), as long as it need not pull
//! ```
//!
//! Where nothing can hold the solution, the simulation ends with an error: there is none beyond.

use super::chattering::ROW;
use super::displacement::HEIGHT;
use super::simulator::Run;
use super::sliding::Contact;
use super::{DaeSystem, SimErrorKind, Treatment};

/// Half the length of the difference that gives w, relative to the time in which y changes.
const DIFFERENCE: f64 = 1e-4;
/// ω relative to the rate that makes z as large as its uncertainty in the whole simulation, where
/// the tolerance is tighter than this: differences of differences are as inexact.
const COARSEST: f64 = 1e-6;
/// τ relative to the simulated interval. A force μ keeps the solution ω τ μ away from where it rested
/// first. Errors of z are errors of the force, divided by ω τ: with 1e-4 a ball on a plate that shakes
/// takes 18,952 steps at the tolerance 1e-6 instead of 406.
const RETURN: f64 = 1e-2;
/// Ratios of intervals in a row that are steady before events accumulate.
const STEADY_RATIOS: u32 = 12;
/// Intervals have become shorter by this factor by then. Together with [`BAND`] it tells a geometric
/// series, which has a limit, from intervals c/k, whose ratios are nearly steady as well, for a while.
const SHRUNK: f64 = 1e-3;
/// Factor between the smallest and the largest 1 − q of steady ratios q. Ratios that come by chance, as
/// in noise, stay within it so often in a row less than once in two million.
const BAND: f64 = 1.5;
/// Factor between the smallest and the largest q: intervals that differ by many decades have ratios
/// whose 1 − q are all nearly 1.
const RATIO_BAND: f64 = 3.0;
/// The limit of the series is within reach: so near relative to the simulated interval. Events go on
/// before that, as they do for a clock whose ticks merely become shorter for a while.
const REACH: f64 = 1e-6;

/// When a crossing function changed its sign last, and whether these times have a limit.
///
/// The interval I from one but the last change to the last one is compared with the one before, which
/// ends where it begins: ratios q = I/I' are steady also where ups and downs differ in length. With
/// a steady q < 1 the times tend to t + I q/(1 − q).
#[derive(Debug, Clone, Copy)]
pub(super) struct Switches {
    last: f64,
    before: f64,
    /// The last interval, and the one that ended a change earlier.
    intervals: [f64; 2],
    /// How many ratios in a row were steady.
    steady: u32,
    /// The interval before these.
    longest: f64,
    /// Smallest and largest 1 − q of these.
    decrease: [f64; 2],
    /// Smallest and largest q of these.
    ratio: [f64; 2],
    /// Whether it was positive before the last change.
    pub(super) was_above: bool,
}

impl Default for Switches {
    fn default() -> Switches {
        let never = f64::NEG_INFINITY;
        Switches {
            last: never,
            before: never,
            intervals: [f64::INFINITY; 2],
            steady: 0,
            longest: f64::INFINITY,
            decrease: [1.0, 0.0],
            ratio: [f64::INFINITY, 0.0],
            was_above: false,
        }
    }
}

impl Switches {
    /// Whether the times of the changes have a limit that is nearer than `reach`.
    fn accumulate(&self, reach: f64) -> bool {
        let interval = self.intervals[0];
        let remaining = interval * (1.0 - self.decrease[0]) / self.decrease[0];
        self.steady >= STEADY_RATIOS && interval <= SHRUNK * self.longest && remaining <= reach
    }

    pub(super) fn note(&mut self, t: f64, was_above: bool) {
        let interval = t - self.before;
        let [last, before] = self.intervals;
        self.note_ratio(interval, before);
        self.intervals = [interval, last];
        (self.before, self.last) = (self.last, t);
        self.was_above = was_above;
    }

    /// Takes note of two intervals one after the other.
    fn note_ratio(&mut self, interval: f64, before: f64) {
        let ratio = interval / before;
        let widened = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
        let (decreases, ratios) = (widened(self.decrease, 1.0 - ratio), widened(self.ratio, ratio));
        let is_steady = decreases[1] <= BAND * decreases[0] && ratios[1] <= RATIO_BAND * ratios[0];
        if ratio < 1.0 && before.is_finite() && is_steady {
            self.steady += 1;
            (self.decrease, self.ratio) = (decreases, ratios);
        } else {
            (self.steady, self.longest) = (0, interval);
            (self.decrease, self.ratio) = ([1.0, 0.0], [f64::INFINITY, 0.0]);
        }
    }
}

impl Run<'_> {
    /// Lets the solution rest if the event just handled was the last impact that can be told from
    /// rest; whether the integrator was restarted for it.
    pub(super) fn rest_after_impact(&mut self) -> Result<bool, SimErrorKind> {
        let Some(crossing) = self.watch.impacts.first().copied() else { return Ok(false) };
        if self.watch.jump.is_empty() {
            return Ok(false);
        }
        let (surfaces, mut contacts) = self.end_slide();
        let was_constrained = !surfaces.is_empty() || !contacts.is_empty();
        let found = self.contact(crossing, &contacts);
        let rests = found.is_some();
        if let Some(contact) = found {
            self.refuse_with_directions()?;
            contacts.push(contact);
            self.watch.rows[crossing].end();
        } else if !was_constrained {
            return Ok(false);
        }
        self.go_on_constrained(&surfaces, contacts)?;
        if rests && !self.problem.system.is_constrained() {
            // Too many surfaces, or no method that knows forces: rebounds too low to be seen would
            // carry the solution through the surface.
            return Err(SimErrorKind::Accumulation);
        }
        if rests {
            self.problem.statistics.accumulations += 1;
            self.problem.system.note_treatment(self.t, crossing, Treatment::Rests);
        }
        Ok(true)
    }

    /// The contact at a crossing function at which the states just jumped; they are moved to where
    /// it rests. `None` if the solution does not stay there.
    fn contact(&mut self, crossing: usize, others: &[Contact]) -> Option<Contact> {
        let settings = self.problem.settings;
        let span = settings.stop - settings.start;
        let uncertainty = self.crossings.uncertainty[crossing];
        let mut contact = Contact {
            crossing,
            is_free_above: self.watch.switches[crossing].was_above,
            direction: self.watch.jump.clone(),
            force: 1.0,
            width: uncertainty / span * (COARSEST / settings.tolerance).max(1.0),
            value: self.crossings.left[crossing],
            return_time: RETURN * span,
            uncertainty,
            ahead: DIFFERENCE / self.fastest_rate(1.0 / span)?,
        };
        let gap = self.problem.system.look_at_gap(&contact, others, self.t, self.y);
        let (gap, rest) = gap.ok()?;
        if !gap.is_held() || uncertainty <= 0.0 || gap.height() > HEIGHT * uncertainty {
            return None;
        }
        let force = -gap.acceleration / gap.effect;
        contact.direction.iter_mut().for_each(|(_, d)| *d *= force);
        self.y.copy_from_slice(&rest);
        Some(contact)
    }

    /// An error if events at a crossing function accumulate and nothing could be done about it.
    pub(super) fn watch_for_accumulation(&self) -> Result<(), SimErrorKind> {
        let settings = self.problem.settings;
        let reach = REACH * (settings.stop - settings.start);
        let accumulates = |at: &usize| {
            let is_row = self.watch.rows[*at].length >= ROW;
            is_row && self.watch.switches[*at].accumulate(reach)
        };
        match self.crossings.switched.iter().any(accumulates) {
            true => Err(SimErrorKind::Accumulation),
            false => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Switches;

    /// Whether changes with these intervals are ever said to accumulate within a millionth of 1 s.
    fn accumulate(intervals: impl Iterator<Item = f64>) -> bool {
        let (mut switches, mut t) = (Switches::default(), 0.0);
        intervals.into_iter().any(|interval| {
            t += interval;
            switches.note(t, true);
            switches.accumulate(1e-6)
        })
    }

    fn geometric(start: f64, ratio: f64) -> impl Iterator<Item = f64> {
        std::iter::successors(Some(start), move |interval| Some(interval * ratio)).take(2000)
    }

    #[test]
    fn a_geometric_series_has_a_limit() {
        for ratio in [0.1, 0.5, 0.9, 0.99] {
            assert!(accumulate(geometric(1.0, ratio)), "{ratio}");
        }
    }

    #[test]
    fn ups_and_downs_may_differ_in_length() {
        let pairs = geometric(0.7, 0.6).flat_map(|up| [up, 0.05 * up]);
        assert!(accumulate(pairs));
    }

    #[test]
    fn a_chirp_has_no_limit() {
        for power in [0.5, 1.0] {
            let intervals = (1..1_000_000).map(|k| 1e-3 / f64::from(k).powf(power));
            assert!(!accumulate(intervals), "{power}");
        }
    }

    #[test]
    fn equal_intervals_have_no_limit() {
        assert!(!accumulate(std::iter::repeat_n(1e-9, 100_000)));
    }

    #[test]
    fn a_series_that_comes_to_rest_before_its_limit_has_none() {
        let slower = geometric(1.0, 0.5).take(18).chain(std::iter::repeat_n(4e-6, 1000));
        assert!(!accumulate(slower));
    }

    #[test]
    fn intervals_that_come_by_chance_have_no_limit() {
        // Over ten decades, so that short rows become shorter by large factors.
        let mut state = 2006_u64;
        let intervals = (0..2_000_000).map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            10f64.powf(-10.0 * (state >> 11) as f64 / (1u64 << 53) as f64)
        });
        assert!(!accumulate(intervals));
    }
}
