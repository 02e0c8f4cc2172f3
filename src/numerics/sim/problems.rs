//! Systems with known solutions.

use super::{EventOutcome, Events, Failure, Modes, Pattern, Residual, Sensitive};
use crate::elementary;

/// A system given by closures over (t, y), all of y observed; Jacobian by differences.
pub(crate) struct TestProblem {
    pub initial: Vec<f64>,
    pub n_differential: usize,
    pub nominal: Vec<f64>,
    pub rhs: fn(f64, &[f64], &[f64], &mut [f64]),
    /// Crossing functions of (t, y, discrete).
    pub crossings: fn(f64, &[f64], &[f64], &mut [f64]),
    pub n_crossings: usize,
    pub time_events: Vec<f64>,
    pub event: fn(f64, &mut [f64], &mut [f64]) -> EventOutcome,
    pub discrete: Vec<f64>,
    pub assertion: fn(&[f64]) -> bool,
    /// Whether nothing follows from its crossing functions but other branches.
    pub only_branches: bool,
    /// All of y unless set.
    pub observed: Option<fn(f64, &[f64]) -> f64>,
    pattern: Pattern,
    start_discrete: Vec<f64>,
}

impl TestProblem {
    pub fn new(
        initial: &[f64],
        n_differential: usize,
        rhs: fn(f64, &[f64], &[f64], &mut [f64]),
    ) -> TestProblem {
        let n = initial.len();
        TestProblem {
            initial: initial.to_vec(),
            n_differential,
            nominal: vec![1.0; n],
            rhs,
            crossings: |_, _, _, _| {},
            n_crossings: 0,
            time_events: Vec::new(),
            event: |_, _, _| EventOutcome::Continue { y_changed: false },
            discrete: Vec::new(),
            assertion: |_| true,
            only_branches: false,
            observed: None,
            pattern: Pattern {
                n,
                column_starts: (0..=n).map(|j| j * n).collect(),
                rows: (0..n).flat_map(|_| 0..n).collect(),
            },
            start_discrete: Vec::new(),
        }
    }

    fn difference_scale(&self, j: usize) -> f64 {
        let nominal = self.nominal[j];
        if nominal > 0.0 && nominal.is_finite() { nominal } else { 1.0 }
    }

    pub fn with_branches(mut self) -> TestProblem {
        self.only_branches = true;
        self
    }

    pub fn with_discrete(mut self, discrete: &[f64]) -> TestProblem {
        self.discrete = discrete.to_vec();
        self.start_discrete = discrete.to_vec();
        self
    }

    pub(crate) fn with_crossings(
        mut self,
        n: usize,
        crossings: fn(f64, &[f64], &[f64], &mut [f64]),
        event: fn(f64, &mut [f64], &mut [f64]) -> EventOutcome,
    ) -> TestProblem {
        self.n_crossings = n;
        self.crossings = crossings;
        self.event = event;
        self
    }
}

impl Residual for TestProblem {
    fn n_differential(&self) -> usize {
        self.n_differential
    }

    fn n_algebraic(&self) -> usize {
        self.initial.len() - self.n_differential
    }

    fn nominal(&self, out: &mut [f64]) {
        out.copy_from_slice(&self.nominal);
    }

    fn rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        (self.rhs)(t, y, &self.discrete, out);
        Ok(())
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        let n = y.len();
        let mut moved = y.to_vec();
        let (mut plus, mut minus) = (vec![0.0; n], vec![0.0; n]);
        for j in 0..n {
            let h = 1e-6 * y[j].abs().max(self.difference_scale(j));
            moved[j] = y[j] + h;
            (self.rhs)(t, &moved, &self.discrete, &mut plus);
            moved[j] = y[j] - h;
            (self.rhs)(t, &moved, &self.discrete, &mut minus);
            moved[j] = y[j];
            for i in 0..n {
                values[j * n + i] = (plus[i] - minus[i]) / (2.0 * h);
            }
        }
        Ok(())
    }

    fn initialize(&mut self, _: f64, y: &mut [f64]) -> Result<(), Failure> {
        y.copy_from_slice(&self.initial);
        self.discrete.copy_from_slice(&self.start_discrete);
        Ok(())
    }

    fn check(&mut self, _: f64, y: &[f64]) -> Result<(), Failure> {
        if (self.assertion)(y) { Ok(()) } else { Err(Failure::Assertion { assertion: 0 }) }
    }

    fn n_observed(&self) -> usize {
        if self.observed.is_some() { 1 } else { self.initial.len() }
    }

    fn observe(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        match self.observed {
            Some(observed) => out[0] = observed(t, y),
            None => out.copy_from_slice(y),
        }
        Ok(())
    }
}

impl Sensitive for TestProblem {}

impl Events for TestProblem {
    fn n_crossings(&self) -> usize {
        self.n_crossings
    }

    fn crossings(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        (self.crossings)(t, y, &self.discrete, out);
        Ok(())
    }

    fn next_time_event(&self, t: f64) -> Option<f64> {
        self.time_events.iter().copied().find(|event| *event > t)
    }

    fn handle_event(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        Ok((self.event)(t, y, &mut self.discrete))
    }
}

impl Modes for TestProblem {
    fn can_follow(&self, _: usize) -> bool {
        self.only_branches
    }
}

/// x' = −x, x(0) = 1: x = exp(−t).
pub fn decay() -> TestProblem {
    TestProblem::new(&[1.0], 1, |_, y, _, out| out[0] = -y[0])
}

/// x'' = −x: (cos t, −sin t).
pub fn oscillator() -> TestProblem {
    TestProblem::new(&[1.0, 0.0], 2, |_, y, _, out| {
        out[0] = y[1];
        out[1] = -y[0];
    })
}

/// x' = −1e4 (x − cos t) − sin t, x(0) = 1: x = cos t (Prothero & Robinson).
pub(crate) fn stiff_linear() -> TestProblem {
    TestProblem::new(&[1.0], 1, |t, y, _, out| {
        out[0] = -1e4 * (y[0] - elementary::cos(t)) - elementary::sin(t)
    })
}

/// Robertson's reaction with the sum of concentrations as algebraic equation. At t = 40:
/// y = (0.7158270687, 0.9185534764e-5, 0.2841637457), computed by the authors of LSODE, table in
/// Hairer & Wanner and in the documentation of SUNDIALS.
pub fn robertson() -> TestProblem {
    let mut problem = TestProblem::new(&[1.0, 0.0, 0.0], 2, |_, y, _, out| {
        out[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
        out[1] = 0.04 * y[0] - 1e4 * y[1] * y[2] - 3e7 * y[1] * y[1];
        out[2] = y[0] + y[1] + y[2] - 1.0;
    });
    problem.nominal = vec![1.0, 1e-5, 1.0];
    problem
}

/// Van der Pol's equation with ε = 1e-6, x(0) = (2, 0); at t = 2:
/// (0.1706167732170469e1, −0.8928097010248125) (test set of Bari).
pub fn van_der_pol() -> TestProblem {
    TestProblem::new(&[2.0, 0.0], 2, |_, y, _, out| {
        out[0] = y[1];
        out[1] = ((1.0 - y[0] * y[0]) * y[1] - y[0]) / 1e-6;
    })
}

/// Chemistry of eight species (HIRES); the values at t = 321.8122 are [`HIRES_END`].
pub fn hires() -> TestProblem {
    let start = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057];
    let mut problem = TestProblem::new(&start, 8, |_, y, _, out| {
        out[0] = -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007;
        out[1] = 1.71 * y[0] - 8.75 * y[1];
        out[2] = -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4];
        out[3] = 8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3];
        out[4] = -1.745 * y[4] + 0.43 * y[5] + 0.43 * y[6];
        let bound = 280.0 * y[5] * y[7];
        out[5] = -bound + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6];
        out[6] = bound - 1.81 * y[6];
        out[7] = -out[6];
    });
    problem.nominal = vec![1e-3; 8];
    problem
}

/// Test set of Bari.
pub(crate) const HIRES_END: [f64; 8] = [
    0.7371312573325668e-3,
    0.1442485726316185e-3,
    0.5888729740967575e-4,
    0.1175651343283149e-2,
    0.2386356198831331e-2,
    0.6238968252742796e-2,
    0.2849998395185769e-2,
    0.2850001604814231e-2,
];

/// The Oregonator of Field and Noyes; at t = 360: [`OREGONATOR_END`].
pub(crate) fn oregonator() -> TestProblem {
    TestProblem::new(&[1.0, 2.0, 3.0], 3, |_, y, _, out| {
        out[0] = 77.27 * (y[1] + y[0] * (1.0 - 8.375e-6 * y[0] - y[1]));
        out[1] = (y[2] - (1.0 + y[0]) * y[1]) / 77.27;
        out[2] = 0.161 * (y[0] - y[2]);
    })
}

/// Test set of Bari.
pub(crate) const OREGONATOR_END: [f64; 3] =
    [0.1000814870318523e1, 0.1228178521549917e4, 0.1320554942846706e3];

/// A source x = sin t in series with 100 Ω and a diode: 0 = (10 x − v)/100 − 1e-9 (exp(v/0.025) −
/// 1).
pub fn diode() -> TestProblem {
    TestProblem::new(&[0.0, 0.0], 1, |t, y, _, out| {
        out[0] = elementary::cos(t);
        out[1] = (10.0 * y[0] - y[1]) / 100.0 - 1e-9 * (elementary::exp(y[1] / 0.025) - 1.0);
    })
}

/// A pendulum of length 1, g = 9.81, in index-1 form: (φ, ω) differential, Cartesian (x, y) and the
/// force λ of the rod algebraic. Starts horizontally at rest.
pub fn pendulum() -> TestProblem {
    TestProblem::new(&[std::f64::consts::FRAC_PI_2, 0.0, 1.0, 0.0, 0.0], 2, |_, y, _, out| {
        let &[angle, speed, px, py, force] = y else { panic!("five unknowns") };
        out[0] = speed;
        out[1] = -9.81 * px;
        out[2] = px - elementary::sin(angle);
        out[3] = py + elementary::cos(angle);
        out[4] = force - speed * speed + 9.81 * py;
    })
}

/// x' = v, 0 = v + x − 2 exp(−t), x(0) = 0: x = 2 t exp(−t), v = 2 (1 − t) exp(−t).
pub fn algebraic() -> TestProblem {
    TestProblem::new(&[0.0, 2.0], 1, |t, y, _, out| {
        out[0] = y[1];
        out[1] = y[1] + y[0] - 2.0 * elementary::exp(-t);
    })
}

/// x' = 2 t x (1 − x) + (w − exp(−t)), w' = −w, x(0) = 1/2: x = 1/(1 + exp(−t²)), w = exp(−t).
pub(crate) fn driven_logistic() -> TestProblem {
    TestProblem::new(&[0.5, 1.0], 2, |t, y, _, out| {
        out[0] = 2.0 * t * y[0] * (1.0 - y[0]) + (y[1] - elementary::exp(-t));
        out[1] = -y[1];
    })
}

/// A ball from height 1 with restitution 0.7 and g = 9.81.
pub(crate) fn bouncing_ball() -> TestProblem {
    TestProblem::new(&[1.0, 0.0], 2, |_, y, _, out| {
        out[0] = y[1];
        out[1] = -9.81;
    })
    .with_crossings(
        1,
        |_, y, _, out| out[0] = y[0],
        |_, y, _| {
            let bounces = y[0] <= 0.0 && y[1] < 0.0;
            if bounces {
                y[1] *= -0.7;
            }
            EventOutcome::Continue { y_changed: bounces }
        },
    )
}

/// x' = u − x with u = 1 before t = 0.5 and −1 after, a time event.
pub(crate) fn switched_input() -> TestProblem {
    let mut problem =
        TestProblem::new(&[0.0], 1, |_, y, discrete, out| out[0] = discrete[0] - y[0])
            .with_discrete(&[1.0]);
    problem.time_events = vec![0.5];
    problem.event = |_, _, discrete| {
        discrete[0] = -1.0;
        EventOutcome::Continue { y_changed: true }
    };
    problem
}

/// x' = 1 if x < 0.5, otherwise −1, without any hysteresis: nothing but events from t = 0.5 on.
pub fn chattering() -> TestProblem {
    TestProblem::new(&[0.0], 1, |_, _, discrete, out| out[0] = discrete[0])
        .with_discrete(&[1.0])
        .with_crossings(
            1,
            |_, y, _, out| out[0] = y[0] - 0.5,
            |_, y, discrete| {
                discrete[0] = if y[0] < 0.5 { 1.0 } else { -1.0 };
                EventOutcome::Continue { y_changed: true }
            },
        )
}

/// x' = x², x(0) = 1: x = 1 / (1 − t), which ends at t = 1.
pub(crate) fn blow_up() -> TestProblem {
    TestProblem::new(&[1.0], 1, |_, y, _, out| out[0] = y[0] * y[0])
}

/// x' = −1 − √x, x(0) = 1: √x − log(1 + √x) = (1 − log 2) − t/2, which reaches 0, where the root
/// ends, at t = 2 (1 − log 2).
pub(crate) fn end_of_domain() -> TestProblem {
    TestProblem::new(&[1.0], 1, |_, y, _, out| out[0] = -1.0 - y[0].sqrt())
}

/// Heat conduction: x'_i = k (x_{i−1} − 2 x_i + x_{i+1}) with zero at both ends, started in its
/// slowest mode, which decays by exp(−rate t) as a whole.
pub(crate) struct HeatRod {
    pattern: Pattern,
    n: usize,
}

impl HeatRod {
    pub fn new(n: usize) -> HeatRod {
        let mut pattern = Pattern { n, column_starts: vec![0], rows: Vec::new() };
        for j in 0..n {
            pattern.rows.extend(j.saturating_sub(1)..(j + 2).min(n));
            pattern.column_starts.push(pattern.rows.len());
        }
        HeatRod { pattern, n }
    }

    fn angle(&self) -> f64 {
        std::f64::consts::PI / (self.n as f64 + 1.0)
    }

    fn conductance(&self) -> f64 {
        0.1 * elementary::powi(self.n as f64 + 1.0, 2)
    }

    pub fn rate(&self) -> f64 {
        self.conductance() * (2.0 - 2.0 * elementary::cos(self.angle()))
    }

    pub fn start(&self, i: usize) -> f64 {
        elementary::sin((i as f64 + 1.0) * self.angle())
    }
}

impl Residual for HeatRod {
    fn n_differential(&self) -> usize {
        self.n
    }

    fn n_algebraic(&self) -> usize {
        0
    }

    fn nominal(&self, out: &mut [f64]) {
        out.fill(1.0);
    }

    fn rhs(&mut self, _: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        let k = self.conductance();
        let at = |i: Option<usize>| i.and_then(|i| y.get(i)).copied().unwrap_or(0.0);
        for (i, out) in out.iter_mut().enumerate() {
            *out = k * (at(i.checked_sub(1)) - 2.0 * y[i] + at(Some(i + 1)));
        }
        Ok(())
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn jacobian(&mut self, _: f64, _: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        let k = self.conductance();
        let columns = (0..self.n).flat_map(|j| self.pattern.column(j).map(move |_| j));
        for ((value, row), column) in values.iter_mut().zip(&self.pattern.rows).zip(columns) {
            *value = if *row == column { -2.0 * k } else { k };
        }
        Ok(())
    }

    fn initialize(&mut self, _: f64, y: &mut [f64]) -> Result<(), Failure> {
        (0..self.n).for_each(|i| y[i] = self.start(i));
        Ok(())
    }

    fn n_observed(&self) -> usize {
        self.n
    }

    fn observe(&mut self, _: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        out.copy_from_slice(y);
        Ok(())
    }
}

impl Sensitive for HeatRod {}

impl Events for HeatRod {}

impl Modes for HeatRod {}
