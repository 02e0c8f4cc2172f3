//! What the integrators see: a semi-explicit system with its own workspace.

use super::Failure;

/// A system in the form
///
/// ```text
///   ẋ = f(t, x, v)      n_differential equations
///   0 = g(t, x, v)      n_algebraic equations
/// ```
///
/// with y = (x, v), zero crossings, and observed variables. Methods take `&mut self` because a
/// system owns its workspace; one compiled program gives any number of independent systems.
/// Discrete state (frozen relations, `pre` values) lives in the system and changes only in
/// [`Residual::initialize`] and [`Events::handle_event`]. Systems without events and assertions
/// leave the methods for these as they are.
pub trait DaeSystem: Residual + Sensitive + Events + Modes {}

impl<T: Residual + Sensitive + Events + Modes + ?Sized> DaeSystem for T {}

/// The equations of a [`DaeSystem`], its initial values, and what is observed.
pub trait Residual {
    /// A simulation begins: nothing is left of the one before.
    fn begin(&mut self) {}
    /// Number of differential variables x; they come first in y.
    fn n_differential(&self) -> usize;
    /// Number of algebraic variables v.
    fn n_algebraic(&self) -> usize;
    /// Of the algebraic variables the last so many, each of which follows from states and those before
    /// it, and is computed from them wherever it is read: what the integrator holds of them
    /// keeps its matrix sparse and needs no accuracy of its own.
    fn n_auxiliary(&self) -> usize {
        0
    }
    /// Asks the system to solve for v itself whenever it is evaluated, so that
    /// [`n_algebraic`](Residual::n_algebraic) is 0, or to stop doing so. A system that cannot leaves
    /// everything as it is; it cannot be simulated with explicit methods.
    fn solve_loops(&mut self, _inside: bool) {}
    /// Typical magnitude of every y; what is not positive and finite counts as 1.
    fn nominal(&self, out: &mut [f64]);
    /// Writes (f, g) at (t, y).
    fn rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure>;
    /// The sparsity pattern of ∂(f, g)/∂y, by columns.
    fn pattern(&self) -> &Pattern;
    /// Writes the nonzeros of ∂(f, g)/∂y at (t, y), in the order of the pattern.
    fn jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure>;
    /// What is known of (f, g) where it is affine in y and t between events; `None` where it is
    /// not, or this is unknown.
    fn linearity(&self) -> Option<Linearity> {
        None
    }
    /// Writes consistent initial values of y at `t` (MLS §8.6).
    fn initialize(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure>;
    /// The event at the end of a simulation (`terminal()`); whether there is one.
    fn finish(&mut self, _t: f64, _y: &mut [f64]) -> Result<bool, Failure> {
        Ok(false)
    }
    /// Checks at an accepted step what must hold there (assertions).
    fn check(&mut self, _t: f64, _y: &[f64]) -> Result<(), Failure> {
        Ok(())
    }
    /// Number of observed variables.
    fn n_observed(&self) -> usize;
    /// Writes the observed variables at (t, y).
    fn observe(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure>;
}

/// Derivatives of a [`DaeSystem`] along directions, such as parameters.
pub trait Sensitive {
    /// Number of directions along which derivatives are carried. Where there are any, the n values
    /// of y are followed by n derivatives for each direction, and observed variables are followed
    /// by their derivatives, direction by direction.
    fn n_directions(&self) -> usize {
        0
    }
    /// Writes the magnitude of what each direction changes, positive: a derivative times that is as
    /// large as y.
    fn directions(&self, _out: &mut [f64]) {}
    /// Writes the derivatives of (f, g) along each direction, those of y given (they follow y).
    fn sensitivity_rhs(&mut self, _t: f64, _y: &[f64], _out: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }
}

/// The events of a [`DaeSystem`]; without any, all methods are as they are.
pub trait Events {
    /// What leads to the event that [`Events::handle_event`] is going to handle: the crossing
    /// function that has changed its sign, or `None` if its time has come. `span` is the length of
    /// the simulation.
    fn crossed(&mut self, _crossing: Option<usize>, _span: f64) {}
    /// Number of zero-crossing functions.
    fn n_crossings(&self) -> usize {
        0
    }
    /// Writes the zero-crossing functions; an event is a change of sign, where negative, zero and
    /// positive are three signs.
    fn crossings(&mut self, _t: f64, _y: &[f64], _out: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }
    /// Writes at least these of the zero-crossing functions, ascending, where they are among all.
    fn crossings_among(
        &mut self,
        t: f64,
        y: &[f64],
        _which: &[usize],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.crossings(t, y, out)
    }
    /// Whether crossing functions vary with time alone, so that the steps, which are as long as y
    /// allows, say nothing about how often they change their signs.
    fn crossings_vary_in_time(&self) -> bool {
        false
    }
    /// How fast crossing functions oscillate at `t` by themselves, in radians per second; 0 where
    /// nothing tells.
    fn oscillation(&mut self, _t: f64) -> f64 {
        0.0
    }
    /// The next time event after `t`, if any is known.
    fn next_time_event(&self, _t: f64) -> Option<f64> {
        None
    }
    /// The mean distance of the samples of recorded inputs between two times, seconds: so often time
    /// events come. `None` where there are none.
    fn sample_distance(&self, _start: f64, _stop: f64) -> Option<f64> {
        None
    }
    /// Whether something changes right after the start that has another value at the start itself, as
    /// `time > 0` does: an event at the same time, after the initial values.
    fn has_event_at_start(&self) -> bool {
        false
    }
    /// Event iteration at (t, y) (MLS §8.5): updates the discrete state, may change x, and leaves v
    /// consistent with x (an interpolated v fulfils 0 = g only within the tolerance).
    fn handle_event(&mut self, _t: f64, _y: &mut [f64]) -> Result<EventOutcome, Failure> {
        Ok(EventOutcome::Continue { y_changed: false })
    }
    /// Asks events from here on to keep the relations of these crossing functions as they are, as long as
    /// the function is not larger than the number beside it.
    fn keep_relations(&mut self, _crossings: &[(usize, f64)]) {}
    /// Whether it needs to see its past: then it is shown every step by [`Events::remember`].
    fn remembers(&self) -> bool {
        false
    }
    /// Takes note of (t, y), which belongs to the solution; at an event once before and once after
    /// it. Times do not descend.
    fn remember(&mut self, _t: f64, _y: &[f64]) -> Result<(), Failure> {
        Ok(())
    }
    /// Whether the derivatives of the right-hand side may jump without an event, as those of `abs` and of
    /// relations inside `noEvent` do.
    fn has_kinks(&self) -> bool {
        false
    }
    /// The longest step over which the right-hand side is known without its end.
    fn longest_step(&self) -> f64 {
        f64::INFINITY
    }
    /// Notes what errors of y as large as the tolerance, at least 1e-6, make of the crossing
    /// functions.
    fn set_uncertainty(&mut self, _crossings: &[f64]) {}
}

/// How a [`DaeSystem`] continues where its events are chattering; a system that cannot leaves all
/// methods as they are.
pub trait Modes {
    /// Prepares to be evaluated on either side of surfaces, in all combinations;
    /// whether it can: not where values of events remember on which side they were before.
    fn prepare_modes(&mut self, _t: f64, _y: &[f64], _sides: &[Side]) -> Result<bool, Failure> {
        Ok(false)
    }
    /// From here on it is evaluated in one of the combinations prepared: bit i of `mode` is set on
    /// the positive side of surface i.
    fn enter_mode(&mut self, _mode: usize) {}
    /// Whether [`Modes::follow`] works for a crossing function: nothing happens at its events
    /// but that equations have other branches.
    fn can_follow(&self, _crossing: usize) -> bool {
        false
    }
    /// The same where it works for the values of events at hand only: as the last event of this
    /// function has shown, nothing follows from it but what [`Modes::can_follow`] allows.
    fn can_follow_now(&self, crossing: usize) -> bool {
        self.can_follow(crossing)
    }
    /// Whether the relation of a crossing function chooses equations of an algebraic loop, whose unknowns
    /// the other branch may leave open.
    fn is_of_loop(&self, _crossing: usize) -> bool {
        false
    }
    /// Changes branches without an event: these crossing functions are positive, or negative, from
    /// (t, y) on. Whether that was possible; if not, nothing has changed, and they need an event.
    fn follow(&mut self, _t: f64, _y: &[f64], _sides: &[(usize, bool)]) -> Result<bool, Failure> {
        Ok(false)
    }
    /// Writes left − right of the relations that have no events although the right-hand side
    /// depends on them (`noEvent`); as many at all times.
    fn literal_relations(
        &mut self,
        _t: f64,
        _y: &[f64],
        _out: &mut Vec<f64>,
    ) -> Result<(), Failure> {
        Ok(())
    }
    /// Gives events to these relations from (t, y) on until the end of the simulation; whether it
    /// can. There are more crossing functions then, and nothing else has changed.
    fn give_events(&mut self, _t: f64, _y: &[f64]) -> Result<bool, Failure> {
        Ok(false)
    }
    /// Whether the mean of values in several modes is a value of an observed variable.
    fn has_means(&self, _observed: usize) -> bool {
        true
    }
    /// Reports how the simulation continued at a crossing function, for messages to the user.
    fn note_treatment(&mut self, _t: f64, _crossing: usize, _treatment: Treatment) {}
}

/// What an event did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventOutcome {
    /// Continues; `y_changed` if continuous variables jumped or branches changed.
    Continue {
        /// Whether the integrator must restart.
        y_changed: bool,
    },
    /// Another event follows at the same time; the integrator must restart after it.
    Again,
    /// `terminate(…)` was called.
    Terminate,
}

/// What is known of a right-hand side A y + b + c t, with A, b and c constant between events.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Linearity {
    /// Whether events change A; otherwise it follows from the parameters.
    pub changes_at_events: bool,
    /// Whether c is not zero.
    pub varies_in_time: bool,
    /// Whether something is looked for between output points: events or assertions.
    pub is_watched: bool,
}

/// A crossing function that is zero on a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Side {
    /// The function.
    pub crossing: usize,
    /// The number of the surface.
    pub surface: usize,
    /// Whether it is positive on the negative side of the surface.
    pub is_reversed: bool,
}

/// How a simulation continues where events are chattering.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Treatment {
    /// The branches change between steps, without events.
    Followed,
    /// The solution slides along the zeros of the crossing function, with the mean of both sides.
    Slides,
    /// Impacts that accumulate are over: the solution rests at the zero of the crossing function.
    Rests,
}

/// A sparsity pattern in compressed columns.
#[derive(Debug, Clone, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub struct Pattern {
    /// Rows and columns.
    pub n: usize,
    /// Start of every column in `rows`; `n + 1` numbers.
    pub column_starts: Vec<usize>,
    /// Row of every nonzero, ascending within a column.
    pub rows: Vec<usize>,
}

impl Pattern {
    /// That of a full matrix of n rows and columns.
    #[must_use]
    pub fn full(n: usize) -> Pattern {
        Pattern {
            n,
            column_starts: (0..=n).map(|column| column * n).collect(),
            rows: (0..n).flat_map(|_| 0..n).collect(),
        }
    }

    /// The nonzeros of a column: positions in `rows` and in the values.
    #[inline]
    pub fn column(&self, column: usize) -> std::ops::Range<usize> {
        self.column_starts[column]..self.column_starts[column + 1]
    }
}
