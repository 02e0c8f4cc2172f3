//! Nominal values of y.

use super::DaeSystem;
use super::norm::nominal_share;
use super::sliding::MOST_SURFACES;
use std::cell::OnceCell;

/// Nominal values of y, without and with shares of surfaces.
#[derive(Default)]
pub(crate) struct Nominals {
    plain: Vec<f64>,
    /// Those of the states alone, once loops are solved inside.
    states: OnceCell<Vec<f64>>,
    /// For both.
    with_shares: [[OnceCell<Vec<f64>>; MOST_SURFACES]; 2],
    /// That of a share.
    share: f64,
}

impl Nominals {
    /// A simulation with n unknowns begins.
    pub(super) fn begin(&mut self, system: &dyn DaeSystem, n: usize, tolerance: f64) {
        self.plain.resize(n, 1.0);
        system.nominal(&mut self.plain);
        for nominal in self.plain.iter_mut().filter(|n| !n.is_finite() || **n <= 0.0) {
            *nominal = 1.0;
        }
        self.share = nominal_share(tolerance);
        self.states.take();
        self.with_shares.iter_mut().flatten().for_each(|with| drop(with.take()));
    }

    pub fn plain(&self) -> &[f64] {
        self.states.get().unwrap_or(&self.plain)
    }

    /// Leaves out those of algebraic unknowns from now on.
    pub(crate) fn show_states(&self, n: usize) {
        self.states.get_or_init(|| self.plain[..n].to_vec());
    }

    /// With so many shares at a place.
    pub(crate) fn with_shares(&self, place: usize, k: usize) -> &[f64] {
        let slots = &self.with_shares[usize::from(self.states.get().is_some())];
        slots[k - 1].get_or_init(|| {
            let (before, after) = self.plain().split_at(place);
            [before, &vec![self.share; k], after].concat()
        })
    }
}
