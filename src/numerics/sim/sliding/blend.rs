//! The blended right-hand side and its observed variables.

use super::slide::{Slide, nearest_mode, weight};
use super::within::{Evaluated, SystemWithin};

impl SystemWithin<'_> {
    pub(super) fn blended_rhs(
        &mut self,
        slide: &Slide,
        t: f64,
        y: &[f64],
        out: &mut [f64],
    ) -> Evaluated {
        self.blend_fields(slide, t, y, out)?;
        self.add_layers(slide, t, y, out)?;
        self.add_contacts(slide, t, y, out);
        Ok(())
    }

    /// Σ_c w_c F_c
    fn blend_fields(&mut self, slide: &Slide, t: f64, y: &[f64], out: &mut [f64]) -> Evaluated {
        let (at, k, shares) = (slide.at, slide.k(), slide.shares(y));
        out.fill(0.0);
        for mode in 0..slide.n_modes() {
            self.enter(slide, mode);
            self.system.rhs(t, &self.y, &mut self.out)?;
            let weight = weight(mode, shares);
            let outer = (0..at).chain(at + k..y.len());
            for (row, value) in outer.zip(&self.out) {
                out[row] += weight * value;
            }
        }
        Ok(())
    }

    /// The equations of the shares.
    fn add_layers(&mut self, slide: &Slide, t: f64, y: &[f64], out: &mut [f64]) -> Evaluated {
        self.enter(slide, slide.nearest_mode(y));
        self.system.crossings(t, &self.y, &mut self.z)?;
        let layers = slide.surfaces.iter().zip(slide.shares(y));
        for (residual, (surface, share)) in out[slide.at..].iter_mut().zip(layers) {
            let z = self.z[surface.crossing];
            *residual = (z - surface.value) / surface.width - (share - surface.share);
        }
        Ok(())
    }

    /// The forces and their equations.
    fn add_contacts(&mut self, slide: &Slide, t: f64, y: &[f64], out: &mut [f64]) {
        let inner = std::mem::take(&mut self.y);
        let first = slide.at + slide.surfaces.len();
        for (i, (contact, force)) in slide.contacts.iter().zip(slide.forces(y)).enumerate() {
            for (state, effect) in &contact.direction {
                out[*state] += force * effect;
            }
            let speed = self.speed_towards_rest(contact, t, &inner);
            out[first + i] = speed.unwrap_or(f64::NAN) / contact.width + force - 1.0;
        }
        self.y = inner;
    }

    pub(super) fn blended_observation(
        &mut self,
        slide: &Slide,
        t: f64,
        y: &[f64],
        out: &mut [f64],
    ) -> Evaluated {
        let shares = self.exact_shares(slide, t, y);
        let nearest = nearest_mode(&shares);
        let mut values = vec![0.0; out.len()];
        out.fill(0.0);
        for mode in 0..slide.n_modes() {
            self.enter(slide, mode);
            self.system.observe(t, &self.y, &mut values)?;
            let weight = weight(mode, &shares);
            for (column, (out, value)) in out.iter_mut().zip(&values).enumerate() {
                match self.system.has_means(column) {
                    true => *out += weight * value,
                    false if mode == nearest => *out = *value,
                    false => {}
                }
            }
        }
        Ok(())
    }
}
