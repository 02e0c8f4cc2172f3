//! State events: the first change of sign of a crossing function within a step.
//!
//! Every function has one of three signs, so that leaving zero is an event and so is reaching it.
//! A sign counts where the function is larger than its margin, which follows from the tolerance:
//! what is smaller may be made of errors, and a function that starts at zero changes its sign at
//! random until it is larger. The event itself is located at the zero, unless the function already
//! was within the margin where the step began; then at the margin.
//!
//! The bracket of the first change is narrowed by the inverse parabolas of the functions that change
//! within it, tried a little beyond the zero as seen from the last trial, so that both ends come near; it
//! is halved where that does not shorten it. A function that changes
//! its sign twice within one step, or within one part of it where functions vary in time, is noticed
//! where the parabola through its last three values does: the step is searched at its vertex then.
//! After an event a function that is at zero has no such values: it is evaluated nearer and nearer
//! to the event, until the sign of its derivative there is clear.

use super::{Events, Failure, Integrator, Problem, Residual};

/// The width to which an event is located, relative to the step.
const WIDTH: f64 = 1e-10;
/// Times to narrow a bracket; where only halving shortens it, that needs 3 · 34.
const MAX_TRIALS: usize = 120;
/// How far beyond the estimated zero the next trial is, relative to how far the estimate has moved since
/// the last trial: more than its error where parabolas converge.
const BEYOND: f64 = 0.1;
/// Margins relative to what errors of y as large as the tolerance make of a function. Errors of y
/// are a thousandth of the tolerance where a step is short, as those after events are; with 1e-2
/// the first impacts of a ball at tolerance 1e-4 come late by more than what tests allow.
const MARGIN: f64 = 1e-3;
/// Tolerance of the uncertainty within which relations may contradict what they decide, where the
/// requested one is tighter: the contradiction of the flows that start at zero in FuelCellLib 1.0
/// does not become smaller with the tolerance.
const COARSEST: f64 = 1e-6;
/// A function that has had another sign, and has grown, at the ends of so many steps in a row changes it:
/// errors of y have no such memory, however large they may be.
const LASTING: u32 = 10;
/// The golden ratio: its multiples modulo 1 are spread evenly, so that no sum of perturbations
/// cancels by chance.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Crossing functions at both ends of a bracket, and their signs at the last event or step.
#[derive(Debug, Default)]
pub(crate) struct CrossingSearch {
    pub(super) signs: Vec<i8>,
    pub(super) left: Vec<f64>,
    right: Vec<f64>,
    trial: Vec<f64>,
    /// At the end of the bracket that was given up last.
    outside: Vec<f64>,
    /// What errors of y as large as the tolerance make of the functions.
    pub(super) uncertainty: Vec<f64>,
    /// Those that are evaluated between steps: events only where they are larger than their
    /// uncertainty.
    pub(super) followed: Vec<bool>,
    /// Whether such an error makes them larger; for functions that are the same but for their sign.
    pub(super) is_rising: Vec<bool>,
    /// Functions within their margin where the search began.
    is_near: Vec<bool>,
    /// Steps in a row at whose ends a function had another sign within its margin, and has grown.
    lasting: Vec<u32>,
    /// Whether loops are solved for them where a step is searched, if they have a solution there.
    pub(super) solves_loops: bool,
    perturbed: Vec<f64>,
    /// The functions before `left`, and when; none after an event.
    earlier: Vec<f64>,
    earlier_time: Option<f64>,
    /// The functions at the point evaluated before, after an event.
    farther: Vec<f64>,
    /// y at the end of the step, while a vertex is looked at.
    kept: Vec<f64>,
    /// The functions that change within the bracket.
    changing: Vec<usize>,
    /// The functions that changed their signs at the last event.
    pub(super) switched: Vec<usize>,
}

/// Vertices nearer to zero than this part of the values at both ends are looked at: a parabola is
/// not quite the function.
const NEAR_ZERO: f64 = 0.05;

/// Points that are evaluated after an event, and how much nearer to it each is than the one before:
/// a flight may be a small part of a step where the solution is smooth without its surface.
const MOST_POINTS: u32 = 9;
const NEARER: f64 = 0.25;
/// Difference quotients from the beginning of a step to two points within it that differ by no more
/// than this part approximate the derivative there.
const QUOTIENT_CHANGE: f64 = 0.25;

/// Much more than rounding makes of a few products.
const ROUGHLY: f64 = 1e-9;

/// The vertex of the parabola through three points, if it lies between the last two.
fn vertex([t0, a, b]: [f64; 3], [z0, left, right]: [f64; 3]) -> Option<(f64, f64)> {
    // Most functions are monotonic: |second| is not smaller than |curvature| (b - a), seen without a
    // division.
    let (p, q) = ((left - z0) * (b - a), (right - left) * (a - t0));
    if (q * (b - t0)).abs() > (1.0 + ROUGHLY) * ((q - p) * (b - a)).abs() {
        return None;
    }
    let (first, second) = ((left - z0) / (a - t0), (right - left) / (b - a));
    let curvature = (second - first) / (b - t0);
    let t = 0.5 * (a + b - second / curvature);
    let z = left + second * (t - a) + curvature * (t - a) * (t - b);
    (t > a && t < b && z.is_finite()).then_some((t, z))
}

/// The crossing functions at (t, y), or at least some of them, with loops solved for them if that is
/// asked for and possible.
fn functions(
    problem: &mut Problem,
    solves_loops: bool,
    (t, y): (f64, &[f64]),
    which: Option<&[usize]>,
    out: &mut [f64],
) -> Result<(), Failure> {
    if solves_loops && problem.system.n_algebraic() > problem.system.n_auxiliary() {
        problem.system.solve_loops(true);
        let solved = problem.system.crossings(t, y, out);
        problem.system.solve_loops(false);
        if solved.is_ok() {
            return solved;
        }
    }
    match which {
        Some(which) => problem.system.crossings_among(t, y, which, out),
        None => problem.system.crossings(t, y, out),
    }
}

pub fn sign(z: f64) -> i8 {
    i8::from(z > 0.0) - i8::from(z < 0.0)
}

impl CrossingSearch {
    pub fn resize(&mut self, n_crossings: usize) {
        self.signs.resize(n_crossings, 0);
        self.switched.clear();
        for flags in [&mut self.followed, &mut self.is_rising, &mut self.is_near] {
            flags.clear();
            flags.resize(n_crossings, false);
        }
        let vectors = [&mut self.left, &mut self.right, &mut self.trial, &mut self.uncertainty];
        let others = [&mut self.earlier, &mut self.farther, &mut self.outside];
        for vector in vectors.into_iter().chain(others) {
            vector.resize(n_crossings, 0.0);
        }
        self.lasting.clear();
        self.lasting.resize(n_crossings, 0);
        self.earlier_time = None;
    }

    /// Takes the signs at (t, y) as those to be changed; whether they are others than before.
    pub fn start(&mut self, problem: &mut Problem, t: f64, y: &[f64]) -> Result<bool, Failure> {
        if self.signs.is_empty() {
            return Ok(false);
        }
        self.earlier_time = None;
        self.lasting.fill(0);
        let is_known = self.estimate_uncertainty(problem, t, y);
        match is_known {
            true => self.left.copy_from_slice(&self.right),
            false => problem.system.crossings(t, y, &mut self.left)?,
        }
        let changed = self.signs.iter().zip(&self.left).any(|(old, z)| *old != sign(*z));
        for (sign_of, z) in self.signs.iter_mut().zip(&self.left) {
            *sign_of = sign(*z);
        }
        Ok(changed)
    }

    /// How much the functions change with errors of y; zero where they have no value. Whether `right`
    /// has their values at (t, y).
    fn estimate_uncertainty(&mut self, problem: &mut Problem, t: f64, y: &[f64]) -> bool {
        let part = problem.settings.tolerance * MARGIN;
        self.perturbed.clear();
        let errors = y.iter().zip(problem.nominal).enumerate().map(|(at, (y, nominal))| {
            let share = 0.5 + 0.5 * (GOLDEN * (at + 1) as f64).fract();
            let signed = if (at / 2 + at).is_multiple_of(2) { share } else { -share };
            y + part * signed * y.abs().max(*nominal)
        });
        self.perturbed.extend(errors);
        let known = problem.system.crossings(t, &self.perturbed, &mut self.trial).is_ok()
            && problem.system.crossings(t, y, &mut self.right).is_ok();
        for ((uncertainty, z), perturbed) in
            self.uncertainty.iter_mut().zip(&self.right).zip(&self.trial)
        {
            let change = (perturbed - z) / MARGIN;
            *uncertainty = if known && change.is_finite() { change } else { 0.0 };
        }
        for (is_rising, change) in self.is_rising.iter_mut().zip(&mut self.uncertainty) {
            *is_rising = *change > 0.0;
            *change = change.abs();
        }
        let widen = (COARSEST / problem.settings.tolerance).max(1.0);
        for (wide, uncertainty) in self.trial.iter_mut().zip(&self.uncertainty) {
            *wide = widen * uncertainty;
        }
        problem.system.set_uncertainty(&self.trial);
        known
    }

    /// The end of the bracket of the first event in (`a`, `b`], with y there; `None` if no sign
    /// changes, and then the search continues from `b`. y must hold y(b).
    pub(crate) fn first_event(
        &mut self,
        problem: &mut Problem,
        integrator: &dyn Integrator,
        (a, mut b): (f64, f64),
        y: &mut [f64],
    ) -> Result<Option<f64>, Failure> {
        if self.signs.is_empty() {
            return Ok(None);
        }
        let end = b;
        functions(problem, self.solves_loops, (b, y), None, &mut self.right)?;
        self.is_near.fill(true);
        self.note_lasting();
        // Also before a change of sign at b: another function may have turned twice until there.
        match self.turning_point(problem, integrator, (a, b), y)? {
            Some(vertex) => b = vertex,
            None if self.changed(&self.right) => {}
            None => {
                std::mem::swap(&mut self.earlier, &mut self.left);
                std::mem::swap(&mut self.left, &mut self.right);
                self.earlier_time = Some(a);
                return Ok(None);
            }
        }
        for at in 0..self.signs.len() {
            let z = self.left[at];
            let is_far = sign(z) == self.signs[at] && z.abs() > self.margin(at);
            self.is_near[at] = !is_far || self.followed[at];
        }
        let b = self.narrow(problem, integrator, (a, b), y)?;
        let Some(b) = self.with_loops_solved(problem, integrator, (b, end), y)? else {
            return Ok(None);
        };
        integrator.interpolate(b, y);
        self.switched.clear();
        for at in 0..self.signs.len() {
            if self.has_changed(at, self.right[at]) {
                self.switched.push(at);
            }
        }
        Ok(Some(b))
    }

    /// Narrows a bracket of the first change of sign; its later end, after the change. Of the functions
    /// those are evaluated that have changed at its end, and all of them at the end found.
    fn narrow(
        &mut self,
        problem: &mut Problem,
        integrator: &dyn Integrator,
        (mut a, mut b): (f64, f64),
        y: &mut [f64],
    ) -> Result<f64, Failure> {
        let width = WIDTH * (b - a);
        let resolution = 4.0 * f64::EPSILON * a.abs().max(b.abs());
        let width = width.max(resolution);
        let mut outside = None;
        let mut changing = std::mem::take(&mut self.changing);
        changing.clear();
        changing.extend((0..self.signs.len()).filter(|at| self.has_changed(*at, self.right[*at])));
        let end = b;
        // The last two lengths of the bracket, and the last trial.
        let (mut lengths, mut last) = ([f64::INFINITY; 2], a);
        let mut estimate = self.earliest_zero(&changing, (a, b), outside);
        for _ in 0..MAX_TRIALS {
            if b - a <= width {
                break;
            }
            let zero = self.earliest_zero(&changing, (a, b), outside);
            let moved = (zero - std::mem::replace(&mut estimate, zero)).abs();
            let beyond = (BEYOND * moved).max(0.4 * width);
            let t = if last <= a { zero + beyond } else { zero - beyond };
            let is_slow = b - a > 0.5 * lengths[1];
            let t = if t > a && t < b && !is_slow { t } else { 0.5 * (a + b) };
            lengths = [b - a, if is_slow { f64::INFINITY } else { lengths[0] }];
            integrator.interpolate(t, y);
            functions(problem, self.solves_loops, (t, y), Some(&changing), &mut self.trial)?;
            let end = if changing.iter().any(|at| self.has_changed(*at, self.trial[*at])) {
                outside = Some(std::mem::replace(&mut b, t));
                &mut self.right
            } else {
                outside = Some(std::mem::replace(&mut a, t));
                &mut self.left
            };
            std::mem::swap(end, &mut self.trial);
            std::mem::swap(&mut self.outside, &mut self.trial);
            last = t;
        }
        self.changing = changing;
        if b < end {
            integrator.interpolate(b, y);
            functions(problem, self.solves_loops, (b, y), None, &mut self.right)?;
        }
        Ok(b)
    }

    /// The integrator knows the unknowns of algebraic loops to its tolerance alone, and an event that
    /// lies in this error is undone when the loops are solved for it. The event at `found`, or the
    /// first one from there to `end` where a sign changes with loops solved; `None` if there is
    /// none, and then the search continues from `end`, with y there.
    fn with_loops_solved(
        &mut self,
        problem: &mut Problem,
        integrator: &dyn Integrator,
        (found, end): (f64, f64),
        y: &mut [f64],
    ) -> Result<Option<f64>, Failure> {
        if problem.system.n_algebraic() == problem.system.n_auxiliary() {
            return Ok(Some(found));
        }
        problem.system.solve_loops(true);
        let event = self.confirmed(problem, integrator, (found, end), y);
        problem.system.solve_loops(false);
        event
    }

    fn confirmed(
        &mut self,
        problem: &mut Problem,
        integrator: &dyn Integrator,
        (found, end): (f64, f64),
        y: &mut [f64],
    ) -> Result<Option<f64>, Failure> {
        integrator.interpolate(found, y);
        let is_solved = problem.system.crossings(found, y, &mut self.trial).is_ok();
        if !is_solved || self.changed(&self.trial) || found >= end {
            return Ok(Some(found));
        }
        std::mem::swap(&mut self.left, &mut self.trial);
        y.copy_from_slice(&self.kept);
        if problem.system.crossings(end, y, &mut self.trial).is_err() {
            return Ok(Some(found));
        }
        if !self.changed(&self.trial) {
            std::mem::swap(&mut self.left, &mut self.trial);
            self.earlier_time = None;
            return Ok(None);
        }
        std::mem::swap(&mut self.right, &mut self.trial);
        self.narrow(problem, integrator, (found, end), y).map(Some)
    }

    /// Counts the steps at whose ends a function has kept another sign and grown.
    fn note_lasting(&mut self) {
        let ends = self.left.iter().zip(&self.right).zip(&self.signs);
        for (count, ((left, right), old)) in self.lasting.iter_mut().zip(ends) {
            let grows = sign(*left) == sign(*right) && right.abs() > left.abs();
            let other = sign(*right) != 0 && sign(*right) != *old;
            *count = if grows && other { *count + 1 } else { 0 };
        }
    }

    /// A time within (`a`, `b`) where a sign has changed although it has not at `b`; `right` has the
    /// functions there then. y is y(b) before and, if there is none, afterwards.
    fn turning_point(
        &mut self,
        problem: &mut Problem,
        integrator: &dyn Integrator,
        (a, b): (f64, f64),
        y: &mut [f64],
    ) -> Result<Option<f64>, Failure> {
        self.kept.clear();
        self.kept.extend_from_slice(y);
        if self.earlier_time.is_none()
            && let Some(found) = self.look_after_event(problem, integrator, (a, b), y)?
        {
            return Ok(Some(found));
        }
        let Some(vertex) = self.earliest_vertex(a, b) else {
            y.copy_from_slice(&self.kept);
            return Ok(None);
        };
        integrator.interpolate(vertex, y);
        functions(problem, self.solves_loops, (vertex, y), None, &mut self.trial)?;
        if self.changed(&self.trial) {
            std::mem::swap(&mut self.right, &mut self.trial);
            return Ok(Some(vertex));
        }
        y.copy_from_slice(&self.kept);
        Ok(None)
    }

    /// After an event: a function that has left zero may be back beyond it. Evaluates the middle of
    /// the step, and nearer to its beginning as long as it is not clear in which direction the functions
    /// go from there; `earlier` has the functions in the middle then. A time at which a sign has
    /// changed, with the functions there in `right`.
    fn look_after_event(
        &mut self,
        problem: &mut Problem,
        integrator: &dyn Integrator,
        (a, b): (f64, f64),
        y: &mut [f64],
    ) -> Result<Option<f64>, Failure> {
        if !(0..self.signs.len()).any(|at| self.is_at_zero(at)) {
            return Ok(None);
        }
        let mut farther = b - a;
        self.farther.copy_from_slice(&self.right);
        let mut distance = 0.5 * (b - a);
        for point in 0..MOST_POINTS {
            integrator.interpolate(a + distance, y);
            functions(problem, self.solves_loops, (a + distance, y), None, &mut self.trial)?;
            if self.changed(&self.trial) {
                std::mem::swap(&mut self.right, &mut self.trial);
                return Ok(Some(a + distance));
            }
            let is_clear = (0..self.signs.len()).all(|at| {
                let quotient = |distance: f64, z: f64| (z - self.left[at]) / distance;
                let (far, near) =
                    (quotient(farther, self.farther[at]), quotient(distance, self.trial[at]));
                !self.is_at_zero(at) || (far - near).abs() <= QUOTIENT_CHANGE * near.abs()
            });
            if point == 0 {
                self.earlier.copy_from_slice(&self.trial);
                self.earlier_time = Some(a + distance);
            }
            if is_clear {
                break;
            }
            farther = distance;
            distance *= NEARER;
            self.farther.copy_from_slice(&self.trial);
        }
        Ok(None)
    }

    /// Whether a function is at zero where the search begins after an event: within its margin, or
    /// as near as the event was located. The latter is more than the margin where steps are long and
    /// the tolerance is tight, as for a ball with `radau5` at the tolerance 1e-8, which is below its floor
    /// at both ends of a step that is as long as a flight.
    fn is_at_zero(&self, at: usize) -> bool {
        let is_within = self.uncertainty[at] > 0.0 && self.left[at].abs() <= self.margin(at);
        is_within || self.switched.contains(&at)
    }

    /// The earliest vertex of the parabolas of the functions that lies at zero or beyond.
    fn earliest_vertex(&self, a: f64, b: f64) -> Option<f64> {
        let earlier = self.earlier_time?;
        let vertices = (0..self.signs.len()).filter_map(|at| {
            let values = [self.earlier[at], self.left[at], self.right[at]];
            let (t, z) = vertex([earlier, a, b], values)?;
            let nearest = values[1].abs().min(values[2].abs());
            let sign_of = f64::from(self.signs[at]);
            let touches = match earlier < a {
                true => z * sign_of < NEAR_ZERO * nearest,
                false => self.is_at_zero(at) && z * sign_of < 0.0,
            };
            touches.then_some(t)
        });
        vertices.min_by(f64::total_cmp)
    }

    /// A function that changed its sign at the last event.
    pub fn last(&self) -> Option<usize> {
        self.switched.first().copied()
    }

    /// The functions at the last event.
    pub(crate) fn at_event(&self) -> &[f64] {
        &self.right
    }

    pub fn margin(&self, at: usize) -> f64 {
        match (self.followed[at], self.lasting[at] >= LASTING) {
            (true, _) => self.uncertainty[at],
            (false, true) => 0.0,
            (false, false) => self.uncertainty[at] * MARGIN,
        }
    }

    fn has_changed(&self, at: usize, z: f64) -> bool {
        let (old, new) = (self.signs[at], sign(z));
        if old == new {
            return false;
        }
        if new == 0 {
            return !self.followed[at];
        }
        !self.is_near[at] || z.abs() > self.margin(at)
    }

    fn changed(&self, z: &[f64]) -> bool {
        z.iter().enumerate().any(|(at, z)| self.has_changed(at, *z))
    }

    /// The earliest zero of those of these functions that change between a and b, each by the inverse
    /// parabola through its values there and `outside`, or by its secant.
    fn earliest_zero(&self, among: &[usize], (a, b): (f64, f64), outside: Option<f64>) -> f64 {
        let among = among.iter().copied();
        let changing = among.filter(|at| self.has_changed(*at, self.right[*at]));
        let zero = |at: usize| {
            let (left, right) = (self.left[at], self.right[at]);
            // Where the function passes its margin, if it was within.
            let level = match self.is_near[at] {
                true => right.signum() * self.margin(at),
                false => 0.0,
            };
            let (left, right) = (left - level, right - level);
            let secant = a + (b - a) * left / (left - right);
            let parabola = outside.map(|c| {
                let z = self.outside[at] - level;
                a * (right * z) / ((left - right) * (left - z))
                    + b * (left * z) / ((right - left) * (right - z))
                    + c * (left * right) / ((z - left) * (z - right))
            });
            parabola.filter(|zero| *zero > a && *zero < b).unwrap_or(secant)
        };
        changing.map(zero).filter(|zero| zero.is_finite()).fold(b, f64::min)
    }
}
