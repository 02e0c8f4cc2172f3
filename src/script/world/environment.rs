//! Clocks, the process, its environment variables, and requests to stop.

use crate::external::c::CCompiler;
use crate::fmi::import::Host;
use crate::identify::ranks::{Processors, Ranks};
use std::collections::BTreeMap;
use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Keeps from one process to the next what can be made again, by names that are made of letters and
/// digits. Implementations answer with nothing where what is there is damaged or was kept by
/// another version of this program.
pub trait Store: Send + Sync {
    /// What is kept under a name.
    fn find(&self, name: &str) -> Option<Vec<u8>>;
    /// Keeps something under a name, if there is room.
    fn keep(&self, name: &str, bytes: &[u8]);
}

/// The process and the machine that a script runs on.
pub trait Environment {
    /// An environment variable that scripts may see.
    fn env(&self, name: &str) -> Option<String>;
    /// The environment variables for models, which cannot ask the world, if there are some.
    fn env_reader(&self) -> Option<fn(&str) -> Option<String>> {
        None
    }
    /// Seconds since an arbitrary moment, never decreasing.
    fn monotonic_seconds(&self) -> f64;
    /// Seconds since an arbitrary moment for work that cannot ask the world, if there is a clock.
    fn clock(&self) -> Option<fn() -> f64> {
        None
    }
    /// Seconds since 1970-01-01 00:00 UTC. Nothing that must be reproducible may depend on it.
    fn unix_seconds(&self) -> u64;
    /// The number of this process, 0 where there is none.
    fn process_id(&self) -> u32 {
        0
    }
    /// Whether the user asked to stop.
    fn is_interrupted(&self) -> bool;
    /// What becomes true when the user asks to stop, for work that cannot ask the world.
    fn interrupt_flag(&self) -> Option<Arc<AtomicBool>> {
        None
    }
    /// What becomes true when the user asks to stop or so many seconds have passed; `None` where
    /// there is no clock that could.
    fn flag_after(&self, _seconds: f64) -> Option<Arc<AtomicBool>> {
        None
    }
    /// Why the run has to stop without a request, such as a limit of time.
    fn stop_reason(&self) -> Option<String> {
        None
    }
    /// Who compiles the C functions of libraries, if the user allows it.
    fn c_compiler(&self) -> Option<Arc<dyn CCompiler>> {
        None
    }
    /// Who runs functional mock-up units; `None` where there are no processes.
    fn fmu_host(&self) -> Option<Arc<dyn Host>> {
        None
    }
    /// Runs a command of the operating system with these environment variables besides its own;
    /// its exit status and what it printed.
    fn run_command(
        &mut self,
        _command: &str,
        _environment: &BTreeMap<String, String>,
    ) -> io::Result<(i32, Vec<u8>)> {
        Err(io::Error::new(
            io::ErrorKind::Unsupported,
            "there is no operating system in this environment",
        ))
    }
    /// The shared library that simulates the models in exported units.
    ///
    /// # Errors
    /// There is none beside the program, or it cannot be read.
    fn unit_runtime(&self) -> io::Result<Vec<u8>> {
        Err(io::Error::new(io::ErrorKind::NotFound, "there is none in this environment"))
    }
    /// Number of threads to use, at least 1.
    fn threads(&self) -> usize;
    /// Other processes that simulate.
    fn ranks(&self) -> Option<Arc<Ranks>> {
        None
    }
    /// What simulates.
    fn processors(&self) -> Processors {
        Processors { threads: self.threads(), ranks: self.ranks() }
    }
}
