//! The Jacobian of the blended right-hand side.

use super::slide::{Contact, Slide, inner_place, weight, weight_by_share};
use super::within::{Evaluated, SystemWithin};
use crate::sim::Failure;

/// Increment of y for the derivatives of z, relative to y.
const INCREMENT: f64 = 1e-7;
/// The same for the derivatives of rates, which are differences themselves.
const SPEED_INCREMENT: f64 = 1e-5;

impl SystemWithin<'_> {
    pub(super) fn blended_jacobian(
        &mut self,
        slide: &Slide,
        t: f64,
        y: &[f64],
        values: &mut [f64],
    ) -> Evaluated {
        values.fill(0.0);
        for mode in 0..slide.n_modes() {
            self.enter(slide, mode);
            self.system.jacobian(t, &self.y, &mut self.values)?;
            self.system.rhs(t, &self.y, &mut self.out)?;
            self.add_mode(slide, mode, y, values);
        }
        self.jacobian_of_layers(slide, t, y, values)?;
        self.jacobian_of_contacts(slide, t, y, values)
    }

    /// Adds the derivatives of w_c F_c, F_c and its own derivatives given.
    fn add_mode(&self, slide: &Slide, mode: usize, y: &[f64], values: &mut [f64]) {
        let (at, k, shares) = (slide.at, slide.k(), slide.shares(y));
        let weight = weight(mode, shares);
        for column in 0..y.len() {
            let entries = &mut values[slide.pattern.column(column)];
            match inner_place(column, at, k) {
                Some(inner) => self.add_derivatives(slide, (column, inner), weight, entries),
                None if column - at < shares.len() => {
                    let by_share = weight_by_share(mode, shares, column - at);
                    for (row, value) in (0..at).chain(at + k..y.len()).zip(&self.out) {
                        entries[row] += by_share * value;
                    }
                }
                None => {}
            }
        }
    }

    /// Adds w_c ∂F_c/∂y of a column, which is `inner` in the system within.
    fn add_derivatives(
        &self,
        slide: &Slide,
        (column, inner): (usize, usize),
        weight: f64,
        entries: &mut [f64],
    ) {
        let known = &self.values[self.system.pattern().column(inner)];
        let rows = &slide.pattern.rows[slide.pattern.column(column)];
        let is_inner = |row: usize| inner_place(row, slide.at, slide.k()).is_some();
        let of_system = entries.iter_mut().zip(rows).filter(|(_, row)| is_inner(**row));
        for ((entry, _), value) in of_system.zip(known) {
            *entry += weight * value;
        }
    }

    /// The rows of the shares.
    fn jacobian_of_layers(
        &mut self,
        slide: &Slide,
        t: f64,
        y: &[f64],
        values: &mut [f64],
    ) -> Evaluated {
        if slide.surfaces.is_empty() {
            return Ok(());
        }
        self.enter(slide, slide.nearest_mode(y));
        self.system.crossings(t, &self.y, &mut self.z)?;
        for column in 0..y.len() {
            let entries = &mut values[slide.pattern.column(column)];
            let rows = &slide.pattern.rows[slide.pattern.column(column)];
            let own = &mut entries[rows.partition_point(|row| *row < slide.at)..];
            match inner_place(column, slide.at, slide.k()) {
                Some(inner) => self.layer_derivatives(slide, t, inner, own)?,
                None if column - slide.at < slide.surfaces.len() => own[column - slide.at] = -1.0,
                None => {}
            }
        }
        Ok(())
    }

    /// The derivatives of all layers by a component of the y within.
    fn layer_derivatives(
        &mut self,
        slide: &Slide,
        t: f64,
        at: usize,
        entries: &mut [f64],
    ) -> Evaluated {
        let kept = self.y[at];
        self.y[at] = kept + INCREMENT * kept.abs().max(slide.nominal[at]);
        let increment = self.y[at] - kept;
        let moved = self.system.crossings(t, &self.y, &mut self.z_moved);
        self.y[at] = kept;
        moved?;
        for (entry, surface) in entries.iter_mut().zip(&slide.surfaces) {
            let change = self.z_moved[surface.crossing] - self.z[surface.crossing];
            *entry = change / increment / surface.width;
        }
        Ok(())
    }

    /// The rows of the forces and their effects.
    fn jacobian_of_contacts(
        &mut self,
        slide: &Slide,
        t: f64,
        y: &[f64],
        values: &mut [f64],
    ) -> Evaluated {
        let first = slide.at + slide.surfaces.len();
        let mut inner = self.y.clone();
        for (place, contact) in (first..).zip(&slide.contacts) {
            let speed = self.speed_towards_rest(contact, t, &inner)?;
            for column in 0..y.len() {
                let entries = &mut values[slide.pattern.column(column)];
                let rows = &slide.pattern.rows[slide.pattern.column(column)];
                let own = rows.partition_point(|row| *row < place);
                match inner_place(column, slide.at, slide.k()) {
                    Some(at) => {
                        let nominal = slide.nominal[at];
                        let derivative =
                            self.speed_derivative(contact, t, &mut inner, (at, nominal), speed)?;
                        entries[own] = derivative / contact.width;
                    }
                    None if column == place => {
                        entries[own] = 1.0;
                        contact.direction.iter().for_each(|(state, m)| entries[*state] += m);
                    }
                    None => {}
                }
            }
        }
        Ok(())
    }

    /// The derivative of the speed by a component of the y within, of this nominal value.
    fn speed_derivative(
        &mut self,
        contact: &Contact,
        t: f64,
        y: &mut [f64],
        (at, nominal): (usize, f64),
        speed: f64,
    ) -> Result<f64, Failure> {
        let kept = y[at];
        y[at] = kept + SPEED_INCREMENT * kept.abs().max(nominal);
        let increment = y[at] - kept;
        let moved = self.speed_towards_rest(contact, t, y);
        y[at] = kept;
        Ok((moved? - speed) / increment)
    }
}
