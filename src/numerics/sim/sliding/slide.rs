//! Surfaces, contacts, and the weights of the fields around them.

use crate::sim::Pattern;

/// Where a solution begins to slide.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::sim) struct Surface {
    /// The crossing function.
    pub(in crate::sim) crossing: usize,
    /// The share of its positive side.
    pub(in crate::sim) share: f64,
    /// Its value.
    pub(in crate::sim) value: f64,
    /// The width of the layer.
    pub(in crate::sim) width: f64,
    /// Other crossing functions that are zero on it.
    pub(in crate::sim) companions: Vec<usize>,
}

/// Where a solution rests on a surface after impacts.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::sim) struct Contact {
    /// The crossing function.
    pub(in crate::sim) crossing: usize,
    /// Whether its positive side is free.
    pub(in crate::sim) is_free_above: bool,
    /// What the force does to the states: position and m d.
    pub(in crate::sim) direction: Vec<(usize, f64)>,
    /// The force μ, which is 1 at the beginning.
    pub(in crate::sim) force: f64,
    /// ω.
    pub(in crate::sim) width: f64,
    /// z⁰.
    pub(in crate::sim) value: f64,
    /// τ, seconds.
    pub(in crate::sim) return_time: f64,
    /// The uncertainty of z.
    pub(in crate::sim) uncertainty: f64,
    /// Half the length of the difference that gives the rate, seconds.
    pub(in crate::sim) ahead: f64,
}

/// A slide in progress.
pub(super) struct Slide {
    pub(super) surfaces: Vec<Surface>,
    pub(super) contacts: Vec<Contact>,
    /// Position of the shares in y: after the algebraic unknowns that are tested.
    pub(super) at: usize,
    pub(super) pattern: Pattern,
    /// Nominal values of the y within.
    pub(super) nominal: Vec<f64>,
    /// The length of the simulation.
    pub(super) span: f64,
}

impl Slide {
    pub(super) fn k(&self) -> usize {
        self.surfaces.len() + self.contacts.len()
    }

    pub(super) fn shares<'y>(&self, y: &'y [f64]) -> &'y [f64] {
        &y[self.at..][..self.surfaces.len()]
    }

    pub(super) fn forces<'y>(&self, y: &'y [f64]) -> &'y [f64] {
        &y[self.at + self.surfaces.len()..][..self.contacts.len()]
    }

    pub(super) fn n_modes(&self) -> usize {
        1 << self.surfaces.len()
    }

    pub(super) fn nearest_mode(&self, y: &[f64]) -> usize {
        nearest_mode(self.shares(y))
    }

    /// Writes the y within.
    pub(super) fn unwrap(&self, y: &[f64], inner: &mut [f64]) {
        let (first, last) = inner.split_at_mut(self.at);
        first.copy_from_slice(&y[..self.at]);
        last.copy_from_slice(&y[self.at + self.k()..]);
    }
}

/// The mode with the largest weight.
pub(crate) fn nearest_mode(shares: &[f64]) -> usize {
    let sides = shares.iter().enumerate();
    sides.filter(|(_, share)| **share > 0.5).map(|(bit, _)| 1 << bit).sum()
}

/// The weight of a mode.
pub fn weight(mode: usize, shares: &[f64]) -> f64 {
    let factor = |(bit, share): (usize, &f64)| match mode >> bit & 1 {
        1 => *share,
        _ => 1.0 - share,
    };
    shares.iter().enumerate().map(factor).product()
}

/// The derivative of a weight by a share.
pub(crate) fn weight_by_share(mode: usize, shares: &[f64], by: usize) -> f64 {
    let factor = |(bit, share): (usize, &f64)| match (bit == by, mode >> bit & 1) {
        (true, 1) => 1.0,
        (true, _) => -1.0,
        (false, 1) => *share,
        (false, _) => 1.0 - share,
    };
    shares.iter().enumerate().map(factor).product()
}

/// Position of a component of y in the y within.
pub(crate) fn inner_place(place: usize, at: usize, k: usize) -> Option<usize> {
    match place {
        place if place < at => Some(place),
        place if place < at + k => None,
        place => Some(place - k),
    }
}
