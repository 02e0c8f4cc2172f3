//! The switches of crossing functions: rows of them without a move in between (chattering), and
//! intervals that become shorter as a geometric series does (accumulation, Zeno behaviour).

/// Length of a row that is chattering. A relation that is reached and left again at once, such as
/// the limit of a two-point controller, switches twice.
pub(crate) const ROW: u32 = 4;
/// Events of a row whose density tells whether the simulation gets on.
const LONG_ROW: u32 = 200;
/// The most events of a row in a whole simulation. Switching that noise causes stays far below it, and
/// a relay that remembers its side, which switches at both margins of its crossing, far above.
const MOST_EVENTS: f64 = 1e6;
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

/// The switches of a crossing function one after the other, between which it stayed small.
#[derive(Debug, Clone, Copy, Default)]
pub struct Row {
    pub(super) length: u32,
    /// When the first switch happened, and every further [`LONG_ROW`]th.
    mark: f64,
    /// The time that the last [`LONG_ROW`] switches took.
    duration: Option<f64>,
}

impl Row {
    pub fn end(&mut self) {
        *self = Row::default();
    }

    pub(crate) fn lengthen(&mut self, t: f64) {
        if self.length > 0 && self.length.is_multiple_of(LONG_ROW) {
            self.duration = Some(t - self.mark);
        }
        if self.length.is_multiple_of(LONG_ROW) {
            self.mark = t;
        }
        self.length += 1;
    }

    /// Whether it would need too many switches for a time as long as `span`.
    pub fn is_endless(&self, span: f64) -> bool {
        let switches = |duration: f64| f64::from(LONG_ROW) * span / duration;
        self.duration.is_some_and(|duration| switches(duration) > MOST_EVENTS)
    }

    pub fn is_due(&self) -> bool {
        self.length >= ROW && self.length.is_multiple_of(ROW)
    }
}

/// What is known of the switches of crossing functions.
#[derive(Debug, Default)]
pub struct Watch {
    /// For every crossing function its row.
    pub(super) rows: Vec<Row>,
    pub(super) switches: Vec<Switches>,
    /// Steps since a function that is followed has changed its sign.
    pub(super) quiet: Vec<u32>,
    /// Whether a row has begun.
    pub(super) is_alert: bool,
    pub(super) sides: Vec<(usize, bool)>,
    pub(super) z: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// The states before the event at hand, and by how much it has changed those that it has.
    pub(super) before: Vec<f64>,
    pub(super) jump: Vec<(usize, f64)>,
    /// The crossing functions that led to it, but for those of contacts, which tell of forces.
    pub(super) impacts: Vec<usize>,
}

impl Watch {
    pub fn resize(&mut self, n_crossings: usize) {
        self.rows.clear();
        self.rows.resize(n_crossings, Row::default());
        self.quiet.clear();
        self.quiet.resize(n_crossings, 0);
        self.switches.clear();
        self.switches.resize(n_crossings, Switches::default());
        self.is_alert = false;
        self.z.resize(n_crossings, 0.0);
    }

    /// Notes by how much an event that a crossing function led to has changed the states.
    pub(crate) fn note_jump(&mut self, y: &[f64]) {
        self.jump.clear();
        let changes = y.iter().zip(&self.before).map(|(y, before)| y - before).enumerate();
        self.jump.extend(changes.filter(|(_, change)| *change != 0.0));
    }
}

/// When a crossing function changed its sign last, and whether these times have a limit.
///
/// The interval I from one but the last change to the last one is compared with the one before, which
/// ends where it begins: ratios q = I/I' are steady also where ups and downs differ in length. With
/// a steady q < 1 the times tend to t + I q/(1 − q).
#[derive(Debug, Clone, Copy)]
pub struct Switches {
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
    pub fn accumulate(&self, reach: f64) -> bool {
        let interval = self.intervals[0];
        let remaining = interval * (1.0 - self.decrease[0]) / self.decrease[0];
        self.steady >= STEADY_RATIOS && interval <= SHRUNK * self.longest && remaining <= reach
    }

    pub fn note(&mut self, t: f64, was_above: bool) {
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
