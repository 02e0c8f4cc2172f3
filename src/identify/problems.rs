//! Models written in Rust, to test the identification without the compiler.

use super::{Instance, Model, Parameter};
use crate::diag::Fault;
use crate::sim::{
    DaeSystem, EventOutcome, Events, Failure, Modes, Pattern, Residual, Sensitive, Settings,
    SimError, Simulator, Statistics, Trajectory,
};

/// dv/dt = −a v, v(0) = b, with the ramp i = 2 t and the sum s = i + v. Fails for a > 10.
pub(super) struct Decay;

#[derive(Clone)]
struct DecaySystem {
    a: f64,
    b: f64,
    observed: Vec<String>,
    pattern: Pattern,
}

fn parameter(name: &str, tunable: bool) -> Parameter {
    let unit = if name == "a" { "1/s" } else { "V" }.to_owned();
    Parameter { name: name.to_owned(), unit, min: 0.0, max: 100.0, tunable, top_level: true }
}

impl Model for Decay {
    fn name(&self) -> &str {
        "Decay"
    }
    fn parameters(&self) -> Vec<Parameter> {
        vec![parameter("a", true), parameter("b", true), parameter("n", false)]
    }
    fn outputs(&self) -> Vec<String> {
        vec!["v".to_owned()]
    }
    fn names(&self) -> Vec<String> {
        ["v", "i", "s", "a", "b", "n"].map(str::to_owned).to_vec()
    }
    fn unit(&self, variable: &str) -> Option<String> {
        ["v", "i", "s"].contains(&variable).then(|| "V".to_owned())
    }
    fn depends_on_time_alone(&self, variable: &str, _: &[String]) -> bool {
        variable == "i"
    }
    fn settings(&self) -> Settings {
        Settings { stop: 2.0, tolerance: 1e-8, ..Settings::default() }
    }
    fn instance(&self, _: &[String], observed: &[String]) -> Result<Box<dyn Instance>, Fault> {
        let pattern = Pattern { n: 1, column_starts: vec![0, 1], rows: vec![0] };
        Ok(Box::new(DecaySystem { a: 1.0, b: 1.0, observed: observed.to_vec(), pattern }))
    }
}

impl Instance for DecaySystem {
    fn set(&mut self, genome: &[f64]) -> Result<(), Fault> {
        [self.a, self.b] = [genome[0], genome[1]];
        Ok(())
    }
    fn simulate(
        &mut self,
        simulator: &mut Simulator,
        settings: &Settings,
        out: &mut Trajectory,
    ) -> Result<Statistics, SimError> {
        simulator.run(self, settings, out)
    }
    fn is_static(&mut self) -> bool {
        self.n_differential() == 0
    }
    fn system(&mut self) -> Option<&mut dyn DaeSystem> {
        Some(self)
    }
    fn explain(&self, error: &SimError) -> String {
        format!("{:?}", error.kind)
    }
}

impl Residual for DecaySystem {
    fn n_differential(&self) -> usize {
        1
    }

    fn n_algebraic(&self) -> usize {
        0
    }

    fn nominal(&self, out: &mut [f64]) {
        out.fill(1.0);
    }

    fn rhs(&mut self, _: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        out[0] = -self.a * y[0];
        Ok(())
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn jacobian(&mut self, _: f64, _: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        values[0] = -self.a;
        Ok(())
    }

    fn initialize(&mut self, _: f64, y: &mut [f64]) -> Result<(), Failure> {
        y[0] = self.b;
        if self.a > 10.0 { Err(Failure::Assertion { assertion: 0 }) } else { Ok(()) }
    }

    fn check(&mut self, _: f64, _: &[f64]) -> Result<(), Failure> {
        Ok(())
    }

    fn n_observed(&self) -> usize {
        self.observed.len()
    }

    fn observe(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        for (value, name) in out.iter_mut().zip(&self.observed) {
            *value = match name.as_str() {
                "v" => y[0],
                "i" => 2.0 * t,
                _ => 2.0 * t + y[0],
            };
        }
        Ok(())
    }
}

impl Sensitive for DecaySystem {}

impl Events for DecaySystem {
    fn n_crossings(&self) -> usize {
        0
    }

    fn crossings(&mut self, _: f64, _: &[f64], _: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }

    fn next_time_event(&self, _: f64) -> Option<f64> {
        None
    }

    fn handle_event(&mut self, _: f64, _: &mut [f64]) -> Result<EventOutcome, Failure> {
        Ok(EventOutcome::Continue { y_changed: false })
    }
}

impl Modes for DecaySystem {}
