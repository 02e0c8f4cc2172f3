//! Sliding along discontinuities: Filippov's convex combination.
//!
//! Where the vector fields on both sides of z(t, y) = 0 point at each other, the solution stays on
//! the surface and moves with the mean of the fields that is tangential to it. With k surfaces, the
//! share λᵢ of the positive side of each, and the 2ᵏ fields F_c:
//!
//! ```text
//! F = Σ_c w_c F_c,    w_c = Π (λᵢ where c is on the positive side of surface i, else 1 − λᵢ)
//! 0 = (zᵢ(t, y) − zᵢ⁰)/εᵢ − (λᵢ − λᵢ⁰)
//! ```
//!
//! The shares are further algebraic unknowns. Their equations are those of a layer around the
//! surface in which the fields are blended; its width ε is what errors of y as large as the tolerance
//! make of z. (z⁰, λ⁰) are the values at the beginning, so that the blended field has no transient.
//! The solution leaves a surface where a share leaves 0 … 1.
//!
//! A contact, where impacts have accumulated, is a surface of which the rate of change w = dz/dt is
//! kept at zero by a force μ along the direction d in which the impacts changed the states:
//!
//! ```text
//! F = … + μ m d,    0 = (w(t, y) + (z − z⁰)/τ)/ω + (μ − 1)
//! ```
//!
//! It ends where the force would have to pull, or where an event displaces the states or the surface
//! (`contact`).
//!
//! References: [Filippov 1988](gapilib_base::bibliography#filippov-1988);
//! [Piiroinen & Kuznetsov 2008](gapilib_base::bibliography#piiroinen-kuznetsov-2008).

mod blend;
mod bordered;
mod contact;
mod interface;
mod jacobian;
mod shares;
mod slide;
mod within;

use self::bordered::bordered;
use self::slide::{Slide, nearest_mode};
use self::within::SystemWithin;
use super::DaeSystem;

pub(super) use self::shares::{attract, balanced};
pub(super) use self::slide::{Contact, Surface};

/// The most surfaces at once: every one doubles the number of fields.
pub(crate) const MOST_SURFACES: usize = 5;

/// A system that may slide; otherwise it is the system within.
pub(super) struct Sliding<'a> {
    pub(super) within: SystemWithin<'a>,
    slide: Option<Slide>,
}

impl<'a> Sliding<'a> {
    pub(super) fn new(system: &'a mut dyn DaeSystem) -> Sliding<'a> {
        Sliding { within: SystemWithin::new(system), slide: None }
    }

    /// Whether it slides along a surface or rests at one.
    pub(super) fn is_constrained(&self) -> bool {
        self.slide.is_some()
    }

    /// Whether it rests at a crossing function.
    pub(super) fn rests_at(&self, crossing: usize) -> bool {
        let mut contacts = self.slide.iter().flat_map(|slide| &slide.contacts);
        contacts.any(|contact| contact.crossing == crossing)
    }

    /// Number of shares and forces in y.
    fn n_shares(&self) -> usize {
        self.slide.as_ref().map_or(0, Slide::k)
    }

    /// Position of the shares in y.
    pub(super) fn place_of_shares(&self) -> usize {
        let system = &self.within.system;
        system.n_differential() + system.n_algebraic() - system.n_auxiliary()
    }

    /// Slides from here on; the modes of these surfaces are prepared. `nominal` are those of the y
    /// within, `span` the length of the simulation.
    pub(super) fn begin(
        &mut self,
        surfaces: Vec<Surface>,
        contacts: Vec<Contact>,
        nominal: &[f64],
        span: f64,
    ) {
        let at = self.place_of_shares();
        let k = surfaces.len() + contacts.len();
        self.within.resize(nominal.len());
        let pattern = bordered(self.within.system.pattern(), at, k);
        let nominal = nominal.to_vec();
        self.slide = Some(Slide { surfaces, contacts, at, pattern, nominal, span });
    }

    /// Ends sliding and takes the shares out of y: the system within is in the mode that they are
    /// nearest to. The crossing functions of surfaces that the solution has not left, and all
    /// contacts with their forces.
    pub(super) fn end(&mut self, t: f64, y: &mut Vec<f64>) -> (Vec<usize>, Vec<Contact>) {
        let Some(mut slide) = self.slide.take() else { return Default::default() };
        slide.unwrap(y, &mut self.within.y);
        let shares = self.within.exact_shares(&slide, t, y);
        self.within.enter(&slide, nearest_mode(&shares));
        let forces = slide.forces(y).to_vec();
        for (contact, force) in slide.contacts.iter_mut().zip(forces) {
            contact.force = force;
        }
        let shares = shares.iter().zip(&slide.surfaces);
        let inside = shares.filter(|(share, _)| (0.0..=1.0).contains(*share));
        let surfaces = inside.map(|(_, surface)| surface.crossing).collect();
        y.drain(slide.at..slide.at + slide.k());
        (surfaces, slide.contacts)
    }
}
