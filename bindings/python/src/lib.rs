//! gapilib for Python: sessions, models, simulations, identifications and searches.
//!
//! A [`session::Session`] lives on a thread of its own, which alone touches it; Python's threads hand
//! it work and wait without the global lock. Numbers cross the border as NumPy arrays that own what
//! the simulator has made.

mod errors;
mod fmu;
mod forked;
mod identification;
mod inputs;
mod model;
mod operators;
mod run;
mod screen;
mod search;
mod session;
mod simulator;
mod stored;
mod values;
mod watch;
mod worker;

use pyo3::prelude::*;

/// Runs the command line; its exit code.
#[pyfunction]
fn command(py: Python<'_>, arguments: Vec<std::ffi::OsString>) -> PyResult<u8> {
    let _at_work = forked::AtWork::begin(py)?;
    Ok(py.detach(|| gapilib::embedding::command(arguments)))
}

#[pymodule]
fn _gapilib(module: &Bound<'_, PyModule>) -> PyResult<()> {
    gapilib::internals::budget::allow_long_calls();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("GapilibError", module.py().get_type::<errors::GapilibError>())?;
    module.add_function(wrap_pyfunction!(command, module)?)?;
    module.add_function(wrap_pyfunction!(run::run, module)?)?;
    module.add_function(wrap_pyfunction!(identification::identify, module)?)?;
    module.add_class::<session::Session>()?;
    module.add_class::<model::Model>()?;
    module.add_class::<fmu::Fmu>()?;
    module.add_class::<model::SimulationResult>()?;
    module.add_class::<simulator::Simulator>()?;
    module.add_class::<search::Optimizer>()?;
    module.add_class::<operators::Random>()?;
    module.add_function(wrap_pyfunction!(stored::restored, module)?)?;
    operators::add(module)
}
