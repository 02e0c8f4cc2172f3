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
//! F = … + μ m d,    0 = w(t, y)/ω + (μ − 1)
//! ```
//!
//! It ends where the force would have to pull.
//!
//! References: [Filippov 1988](crate::bibliography#filippov-1988);
//! [Piiroinen & Kuznetsov 2008](crate::bibliography#piiroinen-kuznetsov-2008).

use super::{DaeSystem, EventOutcome, Failure, Pattern, Side, Treatment};

/// The most surfaces at once: every one doubles the number of fields.
pub(super) const MOST_SURFACES: usize = 5;
/// How far a share may be outside 0 … 1: more than rounding.
const OUTSIDE: f64 = 1e-6;
/// Increment of y for the derivatives of z, relative to y.
const INCREMENT: f64 = 1e-7;
/// The same for the derivatives of rates, which are differences themselves.
const SPEED_INCREMENT: f64 = 1e-5;

/// A system that may slide; otherwise it is the system within.
pub(super) struct Sliding<'a> {
    inner: &'a mut dyn DaeSystem,
    slide: Option<Slide>,
    /// y of the system within, and what it writes.
    y: Vec<f64>,
    out: Vec<f64>,
    values: Vec<f64>,
    z: Vec<f64>,
    z_moved: Vec<f64>,
}

/// Where a solution begins to slide.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Surface {
    /// The crossing function.
    pub(super) crossing: usize,
    /// The share of its positive side.
    pub(super) share: f64,
    /// Its value.
    pub(super) value: f64,
    /// The width of the layer.
    pub(super) width: f64,
    /// Other crossing functions that are zero on it.
    pub(super) companions: Vec<usize>,
}

/// Where a solution rests on a surface after impacts.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Contact {
    /// The crossing function.
    pub(super) crossing: usize,
    /// Whether its positive side is free.
    pub(super) is_free_above: bool,
    /// What the force does to the states: position and m d.
    pub(super) direction: Vec<(usize, f64)>,
    /// The force μ, which is 1 at the beginning.
    pub(super) force: f64,
    /// ω.
    pub(super) width: f64,
    /// Half the length of the difference that gives the rate, seconds.
    pub(super) ahead: f64,
}

struct Slide {
    surfaces: Vec<Surface>,
    contacts: Vec<Contact>,
    /// Where the shares stand in y: behind the algebraic unknowns that are tested.
    at: usize,
    pattern: Pattern,
    /// Nominal values of the y within.
    nominal: Vec<f64>,
}

impl<'a> Sliding<'a> {
    pub(super) fn new(inner: &'a mut dyn DaeSystem) -> Sliding<'a> {
        Sliding {
            inner,
            slide: None,
            y: Vec::new(),
            out: Vec::new(),
            values: Vec::new(),
            z: Vec::new(),
            z_moved: Vec::new(),
        }
    }

    /// Whether it slides along a surface or rests at one.
    pub(super) fn is_constrained(&self) -> bool {
        self.slide.is_some()
    }

    /// Number of shares and forces in y.
    fn n_shares(&self) -> usize {
        self.slide.as_ref().map_or(0, Slide::k)
    }

    /// Where the shares stand in y.
    pub(super) fn place_of_shares(&self) -> usize {
        let inner = &self.inner;
        inner.n_differential() + inner.n_algebraic() - inner.n_auxiliary()
    }

    /// Slides from here on; the modes of these surfaces are prepared. `nominal` are those of the y
    /// within.
    pub(super) fn begin(
        &mut self,
        surfaces: Vec<Surface>,
        contacts: Vec<Contact>,
        nominal: &[f64],
    ) {
        let at = self.place_of_shares();
        let k = surfaces.len() + contacts.len();
        self.y.resize(nominal.len(), 0.0);
        self.out.resize(nominal.len(), 0.0);
        self.values.resize(self.inner.pattern().rows.len(), 0.0);
        self.z.resize(self.inner.n_crossings(), 0.0);
        self.z_moved.resize(self.inner.n_crossings(), 0.0);
        let pattern = bordered(self.inner.pattern(), at, k);
        self.slide = Some(Slide { surfaces, contacts, at, pattern, nominal: nominal.to_vec() });
    }

    /// Ends sliding and takes the shares out of y: the system within is in the mode that they are
    /// nearest to. What the solution has not left: crossing functions of surfaces, and contacts.
    pub(super) fn end(&mut self, y: &mut Vec<f64>) -> (Vec<usize>, Vec<Contact>) {
        let Some(mut slide) = self.slide.take() else { return Default::default() };
        if !slide.surfaces.is_empty() {
            self.inner.enter_mode(slide.nearest_mode(y));
        }
        let forces = slide.forces(y).to_vec();
        for (contact, force) in slide.contacts.iter_mut().zip(forces) {
            contact.force = force;
        }
        let shares = slide.shares(y).iter().zip(&slide.surfaces);
        let inside = shares.filter(|(share, _)| (0.0..=1.0).contains(*share));
        let surfaces = inside.map(|(_, surface)| surface.crossing).collect();
        slide.contacts.retain(|contact| contact.force > 0.0);
        y.drain(slide.at..slide.at + slide.k());
        (surfaces, slide.contacts)
    }

    /// The rate of change of the crossing function of a contact without its force, at (t, y) of the
    /// system within, positive away from the surface.
    pub(super) fn speed(&mut self, contact: &Contact, t: f64, y: &[f64]) -> Result<f64, Failure> {
        let n = self.inner.n_differential();
        let mut f = vec![0.0; y.len()];
        let mut z = vec![0.0; self.inner.n_crossings()];
        self.inner.rhs(t, y, &mut f)?;
        let mut moved = y.to_vec();
        let mut ends = [0.0; 2];
        for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
            let ahead = sign * contact.ahead;
            let points = moved.iter_mut().zip(y).zip(&f).take(n);
            points.for_each(|((moved, y), f)| *moved = y + ahead * f);
            self.inner.crossings(t + ahead, &moved, &mut z)?;
            *end = z[contact.crossing];
        }
        let speed = (ends[0] - ends[1]) / (2.0 * contact.ahead);
        Ok(if contact.is_free_above { speed } else { -speed })
    }
}

impl Slide {
    fn k(&self) -> usize {
        self.surfaces.len() + self.contacts.len()
    }

    fn shares<'y>(&self, y: &'y [f64]) -> &'y [f64] {
        &y[self.at..][..self.surfaces.len()]
    }

    fn forces<'y>(&self, y: &'y [f64]) -> &'y [f64] {
        &y[self.at + self.surfaces.len()..][..self.contacts.len()]
    }

    fn n_modes(&self) -> usize {
        1 << self.surfaces.len()
    }

    fn nearest_mode(&self, y: &[f64]) -> usize {
        let sides = self.shares(y).iter().enumerate();
        sides.filter(|(_, share)| **share > 0.5).map(|(bit, _)| 1 << bit).sum()
    }

    /// Writes the y within.
    fn unwrap(&self, y: &[f64], inner: &mut [f64]) {
        let (first, last) = inner.split_at_mut(self.at);
        first.copy_from_slice(&y[..self.at]);
        last.copy_from_slice(&y[self.at + self.k()..]);
    }
}

/// The weight of a mode.
pub(super) fn weight(mode: usize, shares: &[f64]) -> f64 {
    let factor = |(bit, share): (usize, &f64)| match mode >> bit & 1 {
        1 => *share,
        _ => 1.0 - share,
    };
    shares.iter().enumerate().map(factor).product()
}

/// The derivative of a weight by a share.
pub(super) fn weight_by_share(mode: usize, shares: &[f64], by: usize) -> f64 {
    let factor = |(bit, share): (usize, &f64)| match (bit == by, mode >> bit & 1) {
        (true, 1) => 1.0,
        (true, _) => -1.0,
        (false, 1) => *share,
        (false, _) => 1.0 - share,
    };
    shares.iter().enumerate().map(factor).product()
}

/// A pattern with k full rows and columns more at a place.
fn bordered(inner: &Pattern, at: usize, k: usize) -> Pattern {
    let n = inner.n + k;
    let mut pattern = Pattern { n, column_starts: vec![0], rows: Vec::new() };
    for column in 0..n {
        match column.checked_sub(at) {
            Some(share) if share < k => pattern.rows.extend(0..n),
            _ => {
                let column = if column < at { column } else { column - k };
                let rows = &inner.rows[inner.column(column)];
                let (before, behind) = rows.split_at(rows.partition_point(|row| *row < at));
                pattern.rows.extend(before);
                pattern.rows.extend(at..at + k);
                pattern.rows.extend(behind.iter().map(|row| row + k));
            }
        }
        pattern.column_starts.push(pattern.rows.len());
    }
    pattern
}

/// The state of a slide taken out of its system for an evaluation.
macro_rules! sliding {
    ($self:ident, $y:ident, $slide:ident, $plain:expr) => {
        let Some($slide) = $self.slide.take() else { return $plain };
        $slide.unwrap($y, &mut $self.y);
    };
}

impl Sliding<'_> {
    /// Without surfaces there is but one mode, the one at hand.
    fn enter(&mut self, slide: &Slide, mode: usize) {
        if !slide.surfaces.is_empty() {
            self.inner.enter_mode(mode);
        }
    }

    fn blended_rhs(&mut self, slide: &Slide, t: f64, y: &[f64], out: &mut [f64]) -> Evaluated {
        let (at, k, shares) = (slide.at, slide.k(), slide.shares(y));
        out.fill(0.0);
        for mode in 0..slide.n_modes() {
            self.enter(slide, mode);
            self.inner.rhs(t, &self.y, &mut self.out)?;
            let weight = weight(mode, shares);
            let outer = (0..at).chain(at + k..y.len());
            for (row, value) in outer.zip(&self.out) {
                out[row] += weight * value;
            }
        }
        self.enter(slide, slide.nearest_mode(y));
        self.inner.crossings(t, &self.y, &mut self.z)?;
        for (i, (surface, share)) in slide.surfaces.iter().zip(shares).enumerate() {
            let z = self.z[surface.crossing];
            out[at + i] = (z - surface.value) / surface.width - (share - surface.share);
        }
        let inner = std::mem::take(&mut self.y);
        let first = at + shares.len();
        for (i, (contact, force)) in slide.contacts.iter().zip(slide.forces(y)).enumerate() {
            for (state, effect) in &contact.direction {
                out[*state] += force * effect;
            }
            let speed = self.speed(contact, t, &inner);
            out[first + i] = speed.unwrap_or(f64::NAN) / contact.width + force - 1.0;
        }
        self.y = inner;
        Ok(())
    }

    fn blended_jacobian(
        &mut self,
        slide: &Slide,
        t: f64,
        y: &[f64],
        values: &mut [f64],
    ) -> Evaluated {
        let (at, k, shares) = (slide.at, slide.k(), slide.shares(y));
        values.fill(0.0);
        for mode in 0..slide.n_modes() {
            self.enter(slide, mode);
            self.inner.jacobian(t, &self.y, &mut self.values)?;
            self.inner.rhs(t, &self.y, &mut self.out)?;
            let weight = weight(mode, shares);
            for column in 0..y.len() {
                let entries = &mut values[slide.pattern.column(column)];
                let Some(inner) = inner_place(column, at, k) else {
                    if column - at >= shares.len() {
                        continue;
                    }
                    let by_share = weight_by_share(mode, shares, column - at);
                    for (row, value) in (0..at).chain(at + k..y.len()).zip(&self.out) {
                        entries[row] += by_share * value;
                    }
                    continue;
                };
                let pattern = self.inner.pattern();
                let known = &self.values[pattern.column(inner)];
                let rows = &slide.pattern.rows[slide.pattern.column(column)];
                let of_system = entries
                    .iter_mut()
                    .zip(rows)
                    .filter(|(_, row)| inner_place(**row, at, k).is_some());
                for ((entry, _), value) in of_system.zip(known) {
                    *entry += weight * value;
                }
            }
        }
        self.jacobian_of_layers(slide, t, y, values)?;
        self.jacobian_of_contacts(slide, t, y, values)
    }

    /// The rows of the forces and their effects.
    fn jacobian_of_contacts(
        &mut self,
        slide: &Slide,
        t: f64,
        y: &[f64],
        values: &mut [f64],
    ) -> Evaluated {
        let (at, k, n_shares) = (slide.at, slide.k(), slide.surfaces.len());
        let mut inner_y = self.y.clone();
        for (i, contact) in slide.contacts.iter().enumerate() {
            let place = at + n_shares + i;
            let speed = self.speed(contact, t, &inner_y)?;
            for column in 0..y.len() {
                let entries = &mut values[slide.pattern.column(column)];
                let rows = &slide.pattern.rows[slide.pattern.column(column)];
                let own = rows.partition_point(|row| *row < place);
                let Some(inner) = inner_place(column, at, k) else {
                    if column == place {
                        entries[own] = 1.0;
                        contact.direction.iter().for_each(|(state, m)| entries[*state] += m);
                    }
                    continue;
                };
                let kept = inner_y[inner];
                inner_y[inner] = kept + SPEED_INCREMENT * kept.abs().max(slide.nominal[inner]);
                let increment = inner_y[inner] - kept;
                let moved = self.speed(contact, t, &inner_y)?;
                inner_y[inner] = kept;
                entries[own] = (moved - speed) / increment / contact.width;
            }
        }
        Ok(())
    }

    /// The rows of the shares.
    fn jacobian_of_layers(
        &mut self,
        slide: &Slide,
        t: f64,
        y: &[f64],
        values: &mut [f64],
    ) -> Evaluated {
        let (at, k) = (slide.at, slide.k());
        self.enter(slide, slide.nearest_mode(y));
        if slide.surfaces.is_empty() {
            return Ok(());
        }
        self.inner.crossings(t, &self.y, &mut self.z)?;
        for column in 0..y.len() {
            let entries = &mut values[slide.pattern.column(column)];
            let rows = &slide.pattern.rows[slide.pattern.column(column)];
            let first = rows.partition_point(|row| *row < at);
            let Some(inner) = inner_place(column, at, k) else {
                if column - at < slide.surfaces.len() {
                    entries[first + column - at] = -1.0;
                }
                continue;
            };
            let kept = self.y[inner];
            let increment = INCREMENT * kept.abs().max(slide.nominal[inner]);
            self.y[inner] = kept + increment;
            let moved = self.inner.crossings(t, &self.y, &mut self.z_moved);
            let increment = self.y[inner] - kept;
            self.y[inner] = kept;
            moved?;
            for (entry, surface) in entries[first..].iter_mut().zip(&slide.surfaces) {
                let change = self.z_moved[surface.crossing] - self.z[surface.crossing];
                *entry = change / increment / surface.width;
            }
        }
        Ok(())
    }

    fn blended_observation(
        &mut self,
        slide: &Slide,
        t: f64,
        y: &[f64],
        out: &mut [f64],
    ) -> Evaluated {
        let nearest = slide.nearest_mode(y);
        let mut values = vec![0.0; out.len()];
        out.fill(0.0);
        for mode in 0..slide.n_modes() {
            self.enter(slide, mode);
            self.inner.observe(t, &self.y, &mut values)?;
            let weight = weight(mode, slide.shares(y));
            for (column, (out, value)) in out.iter_mut().zip(&values).enumerate() {
                match self.inner.has_means(column) {
                    true => *out += weight * value,
                    false if mode == nearest => *out = *value,
                    false => {}
                }
            }
        }
        Ok(())
    }
}

type Evaluated = Result<(), Failure>;

/// Where a component of y stands in the y within.
fn inner_place(place: usize, at: usize, k: usize) -> Option<usize> {
    match place {
        place if place < at => Some(place),
        place if place < at + k => None,
        place => Some(place - k),
    }
}

impl DaeSystem for Sliding<'_> {
    fn n_differential(&self) -> usize {
        self.inner.n_differential()
    }

    fn n_algebraic(&self) -> usize {
        self.inner.n_algebraic() + self.n_shares()
    }

    fn n_auxiliary(&self) -> usize {
        self.inner.n_auxiliary()
    }

    fn solve_loops(&mut self, inside: bool) {
        self.inner.solve_loops(inside);
    }

    fn nominal(&self, out: &mut [f64]) {
        self.inner.nominal(out);
    }

    fn rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        sliding!(self, y, slide, self.inner.rhs(t, y, out));
        let evaluated = self.blended_rhs(&slide, t, y, out);
        self.slide = Some(slide);
        evaluated
    }

    fn pattern(&self) -> &Pattern {
        self.slide.as_ref().map_or(self.inner.pattern(), |slide| &slide.pattern)
    }

    fn jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        sliding!(self, y, slide, self.inner.jacobian(t, y, values));
        let evaluated = self.blended_jacobian(&slide, t, y, values);
        self.slide = Some(slide);
        evaluated
    }

    fn initialize(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        self.inner.initialize(t, y)
    }

    /// Derivatives are carried as long as nothing slides: [`Run::slide`](super::simulator::Run)
    /// refuses them.
    fn n_directions(&self) -> usize {
        self.inner.n_directions()
    }

    fn directions(&self, out: &mut [f64]) {
        self.inner.directions(out);
    }

    fn sensitivity_rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.inner.sensitivity_rhs(t, y, out)
    }

    fn crossed(&mut self, crossing: Option<usize>, span: f64) {
        self.inner.crossed(crossing, span);
    }

    fn n_crossings(&self) -> usize {
        self.inner.n_crossings()
    }

    /// Those of the surfaces are positive as long as their shares are between 0 and 1.
    fn crossings(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        sliding!(self, y, slide, self.inner.crossings(t, y, out));
        self.enter(&slide, slide.nearest_mode(y));
        let evaluated = self.inner.crossings(t, &self.y, out);
        for (surface, share) in slide.surfaces.iter().zip(slide.shares(y)) {
            out[surface.crossing] = share.min(1.0 - share) + OUTSIDE;
            surface.companions.iter().for_each(|companion| out[*companion] = 1.0);
        }
        for (contact, force) in slide.contacts.iter().zip(slide.forces(y)) {
            out[contact.crossing] = force + OUTSIDE;
        }
        self.slide = Some(slide);
        evaluated
    }

    fn crossings_vary_in_time(&self) -> bool {
        self.inner.crossings_vary_in_time()
    }

    fn next_time_event(&self, t: f64) -> Option<f64> {
        self.inner.next_time_event(t)
    }

    fn handle_event(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        self.inner.handle_event(t, y)
    }

    fn remembers(&self) -> bool {
        self.inner.remembers()
    }

    fn remember(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.inner.remember(t, y)
    }

    fn longest_step(&self) -> f64 {
        self.inner.longest_step()
    }

    fn set_uncertainty(&mut self, crossings: &[f64]) {
        self.inner.set_uncertainty(crossings);
    }

    fn prepare_modes(&mut self, t: f64, y: &[f64], sides: &[Side]) -> Result<bool, Failure> {
        self.inner.prepare_modes(t, y, sides)
    }

    fn enter_mode(&mut self, mode: usize) {
        self.inner.enter_mode(mode);
    }

    fn can_follow(&self, crossing: usize) -> bool {
        self.inner.can_follow(crossing)
    }

    fn follow(&mut self, t: f64, y: &[f64], sides: &[(usize, bool)]) -> Result<(), Failure> {
        self.inner.follow(t, y, sides)
    }

    fn note_treatment(&mut self, t: f64, crossing: usize, treatment: Treatment) {
        self.inner.note_treatment(t, crossing, treatment);
    }

    fn finish(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Failure> {
        self.inner.finish(t, y)
    }

    fn check(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        sliding!(self, y, slide, self.inner.check(t, y));
        self.enter(&slide, slide.nearest_mode(y));
        let checked = self.inner.check(t, &self.y);
        self.slide = Some(slide);
        checked
    }

    fn n_observed(&self) -> usize {
        self.inner.n_observed()
    }

    fn observe(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        sliding!(self, y, slide, self.inner.observe(t, y, out));
        let observed = self.blended_observation(&slide, t, y, out);
        self.slide = Some(slide);
        observed
    }
}
