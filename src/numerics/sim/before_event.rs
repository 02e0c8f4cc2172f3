//! The right-hand side on both sides of an event.

/// The part of the tolerance that a jump of the derivatives may make of a step.
const SHARE: f64 = 0.1;

/// The system right before an event, and its derivatives there with the branches before and after it.
#[derive(Debug, Default)]
pub(crate) struct BeforeEvent {
    /// Whether it is known.
    pub(super) is_known: bool,
    pub(super) y: Vec<f64>,
    pub(super) before: Vec<f64>,
    pub(super) after: Vec<f64>,
    /// The crossing functions at which something has jumped.
    pub(super) jumped: Vec<bool>,
}

impl BeforeEvent {
    /// A simulation with so many crossing functions begins.
    pub(super) fn resize(&mut self, n_crossings: usize) {
        self.is_known = false;
        self.jumped.clear();
        self.jumped.resize(n_crossings, false);
    }

    /// Something jumps at the events of these crossing functions.
    pub(super) fn note_jump(&mut self, switched: &[usize]) {
        switched.iter().for_each(|at| self.jumped[*at] = true);
    }

    /// Whether its n states are still those of y.
    pub(super) fn has_states(&self, y: &[f64], n: usize) -> bool {
        self.y.len() == y.len() && self.y[..n] == y[..n]
    }

    /// The longest step in which the jump of the derivatives of n states makes no more than a share of the
    /// tolerance; `None` if it has no value, or algebraic unknowns, up to those that are tested, have
    /// jumped to y.
    pub(super) fn longest_step(
        &self,
        y: &[f64],
        (n, tested): (usize, usize),
        nominal: &[f64],
        tolerance: f64,
    ) -> Option<f64> {
        let part =
            |at: usize, change: f64| change.abs() / (tolerance * y[at].abs().max(nominal[at]));
        let mut moved = (n..tested).map(|at| part(at, y[at] - self.y[at]));
        if moved.any(|part| part.is_nan() || part > 1.0) {
            return None;
        }
        let jumps = (0..n).map(|at| part(at, self.after[at] - self.before[at]));
        let largest = jumps.fold(0.0, |largest: f64, jump| largest.max(jump));
        let mut derivatives = self.before[..n].iter().chain(&self.after[..n]);
        derivatives.all(|f| f.is_finite()).then(|| SHARE / largest)
    }
}
