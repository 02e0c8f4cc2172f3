//! The spectrum of a model: its response to small oscillations of an input at an operating point, as
//! a [`Model`] whose trajectories run over the frequency.
//!
//! ```text
//!   simulation to the operating point ─▶ Jacobian there ─▶ H(jω) = factor · y/u, and its derivatives
//! ```
//!
//! The Jacobian and its derivatives by parameters are exact: the compiler has made them variables of
//! the model ([`LinearPart`](crate::codegen::LinearPart)), and they follow the operating point where that moves with a parameter.

use super::model::{Instance, Model, Parameter, PortableModel, Spectrum};
use super::program::CompiledModel;
use crate::codegen::ORDERS;
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::frequency::{LinearSystem, Number, Response};
use crate::registry::BAD_OPTION;
use crate::sim::{
    DaeSystem, Failure, OutputGrid, Settings, SimError, SimErrorKind, Simulator, Statistics,
    Trajectory,
};
use nalgebra::DMatrix;
use std::f64::consts::TAU;

/// X of a spectrum, in Hz.
pub const FREQUENCY: &str = "frequency";
/// What a spectrum consists of.
pub const PARTS: [&str; 3] = ["real", "imaginary", "magnitude"];

/// A model and one of its spectra.
pub struct SpectrumModel {
    model: CompiledModel,
    spectrum: Spectrum,
}

impl SpectrumModel {
    /// The model is compiled with the linear part of the spectrum.
    pub fn new(model: CompiledModel, spectrum: Spectrum) -> SpectrumModel {
        SpectrumModel { model, spectrum }
    }
}

impl Model for SpectrumModel {
    fn name(&self) -> &str {
        self.model.name()
    }

    fn parameters(&self) -> Vec<Parameter> {
        self.model.parameters()
    }

    fn outputs(&self) -> Vec<String> {
        PARTS.map(str::to_owned).into()
    }

    fn names(&self) -> Vec<String> {
        self.model.names()
    }

    fn unit(&self, variable: &str) -> Option<String> {
        match variable {
            FREQUENCY => Some("Hz".to_owned()),
            part if PARTS.contains(&part) => Some(self.spectrum.unit.clone()),
            other => self.model.unit(other),
        }
    }

    fn description(&self, variable: &str) -> Option<String> {
        let words = match variable {
            FREQUENCY => "frequency",
            "real" => "real part",
            "imaginary" => "imaginary part",
            "magnitude" => "magnitude",
            other => return self.model.description(other),
        };
        Some(words.to_owned())
    }

    fn depends_on_time_alone(&self, _: &str, _: &[String]) -> bool {
        false
    }

    fn abscissa(&self) -> Option<&str> {
        Some(FREQUENCY)
    }

    fn settings(&self) -> Settings {
        self.model.settings()
    }

    fn has_stop_time(&self) -> bool {
        false
    }

    fn portable(&self) -> Result<PortableModel, String> {
        let spectrum = Some(self.spectrum.clone());
        Ok(PortableModel { spectrum, ..self.model.portable()? })
    }

    fn instance(&self, varied: &[String], observed: &[String]) -> Result<Box<dyn Instance>, Fault> {
        let part = |name: &String| match PARTS.iter().position(|part| part == name) {
            Some(part) => Ok(part),
            None => Err(
                fault!(BAD_OPTION, "a spectrum has no `{name}`"; help: "its parts are `real`, `imaginary` and `magnitude`"),
            ),
        };
        let parts: Vec<usize> = observed.iter().map(part).collect::<Result<_, _>>()?;
        let spectrum = self.spectrum.clone();
        let mut entries = Vec::new();
        let n = spectrum.linear.n_states + spectrum.linear.n_algebraic;
        let mut jacobian = DMatrix::zeros(n + 1, n + ORDERS);
        for entry in &spectrum.linear.entries {
            match &entry.value {
                Ok(name) => entries.push(((entry.row, entry.column), name.clone())),
                Err(number) => jacobian[(entry.row, entry.column)] = *number,
            }
        }
        let (places, names): (Vec<(usize, usize)>, Vec<String>) = entries.into_iter().unzip();
        let system = LinearSystem { n_states: spectrum.linear.n_states, jacobian };
        Ok(Box::new(SpectrumInstance {
            instance: self.model.instance(varied, &names)?,
            spectrum,
            system,
            places,
            parts,
            n_derivatives: None,
            n_varied: varied.len(),
            trajectory: Trajectory::default(),
            row: Vec::new(),
            cause: None,
        }))
    }
}

struct SpectrumInstance {
    /// Observes the entries of the Jacobian that are no numbers.
    instance: Box<dyn Instance>,
    spectrum: Spectrum,
    /// The Jacobian, with its numbers.
    system: LinearSystem,
    /// Where the observed entries stand.
    places: Vec<(usize, usize)>,
    /// The observed parts, by their places in [`PARTS`].
    parts: Vec<usize>,
    n_varied: usize,
    /// The number of parameters by which it is differentiated.
    n_derivatives: Option<usize>,
    trajectory: Trajectory,
    row: Vec<f64>,
    /// Why the last simulation failed, if not for one of the model.
    cause: Option<String>,
}

impl SpectrumInstance {
    /// The response at all frequencies as rows.
    fn respond(&mut self, frequencies: &[f64], out: &mut Trajectory) -> Result<(), String> {
        let n_parameters = self.n_derivatives.unwrap_or(0);
        let last =
            self.trajectory.len().checked_sub(1).ok_or("the operating point is not reached")?;
        for (column, place) in self.places.iter().enumerate() {
            self.system.jacobian[*place] = self.trajectory.column(column)[last];
        }
        let response = Response::new(&self.system)
            .ok_or("the equations are singular at the operating point")?;
        out.reset(self.parts.len() * (n_parameters + 1));
        for frequency in frequencies {
            let omega = TAU * frequency;
            let pole = || format!("the response has a pole at {frequency} Hz");
            let point = match n_parameters {
                0 => None,
                _ => Some(response.at(omega).ok_or_else(pole)?),
            };
            let value = point.as_ref().map_or_else(|| response.value(omega), |own| Some(own.value));
            let factor = self.spectrum.factor;
            let value = value.ok_or_else(pole)? * factor;
            self.row.clear();
            self.row.extend(self.parts.iter().map(|part| read(*part, value)));
            let with_derivatives =
                point.iter().flat_map(|own| (0..n_parameters).map(move |k| (k, own)));
            for (parameter, point) in with_derivatives {
                let first = self.places.len() * (parameter + 1);
                let terms = self.places.iter().enumerate().map(|(at, (row, column))| {
                    let derivative = self.trajectory.column(first + at)[last];
                    // Where nothing depends on the parameter, what it meets may be infinite.
                    match derivative == 0.0 {
                        true => Number::default(),
                        false => point.by_entry(*row, *column) * derivative,
                    }
                });
                let derivative = terms.sum::<Number>() * factor;
                self.row
                    .extend(self.parts.iter().map(|part| differential(*part, value, derivative)));
            }
            out.push(*frequency, &self.row);
        }
        Ok(())
    }
}

/// A part of a complex number.
fn read(part: usize, value: Number) -> f64 {
    match part {
        0 => value.re,
        1 => value.im,
        _ => value.norm_sqr().sqrt(),
    }
}

/// The derivative of a part.
fn differential(part: usize, value: Number, derivative: Number) -> f64 {
    match part {
        0 => derivative.re,
        1 => derivative.im,
        _ => (value.re * derivative.re + value.im * derivative.im) / value.norm_sqr().sqrt(),
    }
}

impl Instance for SpectrumInstance {
    fn set(&mut self, genome: &[f64]) -> Result<(), Fault> {
        self.instance.set(genome)
    }

    fn simulate(
        &mut self,
        simulator: &mut Simulator,
        settings: &Settings,
        out: &mut Trajectory,
    ) -> Result<Statistics, SimError> {
        self.cause = None;
        let [start, stop] = self.spectrum.times;
        let OutputGrid::At(frequencies) = &settings.output else {
            return Err(failed(stop, SimErrorKind::Settings));
        };
        let to_point =
            Settings { start, stop, output: OutputGrid::At(vec![stop]), ..settings.clone() };
        let mut trajectory = std::mem::take(&mut self.trajectory);
        let run = self.instance.simulate(simulator, &to_point, &mut trajectory);
        self.trajectory = trajectory;
        let statistics = run?;
        self.respond(frequencies, out).map_err(|cause| {
            self.cause = Some(cause);
            failed(stop, SimErrorKind::Evaluation(Failure::Singular { block: 0 }))
        })?;
        Ok(statistics)
    }

    fn is_static(&mut self) -> bool {
        false
    }

    fn system(&mut self) -> Option<&mut dyn DaeSystem> {
        None
    }

    fn differentiate(&mut self, with_derivatives: bool) -> Result<(), String> {
        self.n_derivatives = None;
        self.instance.differentiate(with_derivatives)?;
        self.n_derivatives = with_derivatives.then_some(self.n_varied);
        Ok(())
    }

    fn sensitivity_refusal(&self) -> Option<String> {
        self.instance.sensitivity_refusal()
    }

    fn explain(&self, error: &SimError) -> String {
        self.cause.clone().unwrap_or_else(|| self.instance.explain(error))
    }

    fn diagnostic(&self, error: &SimError) -> Option<Diagnostic> {
        match self.cause {
            Some(_) => None,
            None => self.instance.diagnostic(error),
        }
    }
}

fn failed(time: f64, kind: SimErrorKind) -> SimError {
    SimError { time, kind, offending: None }
}
