//! The process in which a unit runs: what it is asked, what it answers. Each message is preceded by its
//! length, 4 bytes with the lowest first.

use super::LogMessage;
use super::failure::SimulationFailure;
use super::plan::Plan;
#[cfg(feature = "host")]
use super::{binary::flush_printed, unit::Unit};
#[cfg(feature = "host")]
use crate::sim::Trajectory;
use crate::sim::{PortableSettings, Statistics};
use serde::{Deserialize, Serialize};
#[cfg(feature = "host")]
use std::collections::BTreeMap;
use std::io::{self, Read, Write};
#[cfg(feature = "host")]
use std::sync::atomic::{AtomicBool, Ordering};
#[cfg(feature = "host")]
use std::sync::{Arc, mpsc::channel};

/// A message of more bytes is none of ours.
const LONGEST: u32 = 1 << 31;

/// What a worker is asked.
#[derive(Debug, Serialize, Deserialize)]
pub enum Request {
    /// Keeps a plan under a number.
    Plan(u64, Plan),
    /// Simulates with a plan.
    Simulate {
        /// Its number.
        plan: u64,
        /// Values of what varies.
        values: Vec<f64>,
        /// How it is simulated.
        settings: PortableSettings,
    },
}

/// What a worker answers to [`Request::Simulate`].
#[derive(Debug, Serialize, Deserialize)]
pub struct Answer {
    /// The rows up to the end, or to the failure.
    pub time: Vec<f64>,
    /// The columns.
    pub columns: Vec<Vec<f64>>,
    /// What it cost, or why it failed.
    pub result: Result<Statistics, SimulationFailure>,
    /// What the unit says.
    pub messages: Vec<LogMessage>,
}

/// Writes a message.
///
/// # Errors
/// Those of the writer; a message that is too long.
pub fn send(to: &mut impl Write, message: &impl Serialize) -> io::Result<()> {
    let bytes = postcard::to_allocvec(message).map_err(io::Error::other)?;
    let length = u32::try_from(bytes.len()).ok().filter(|length| *length < LONGEST);
    let length = length.ok_or_else(|| io::Error::other("the message is too long"))?;
    to.write_all(&length.to_le_bytes())?;
    to.write_all(&bytes)?;
    to.flush()
}

/// Reads a message; `None` at the end.
///
/// # Errors
/// Those of the reader; messages of another version.
pub fn receive<T: for<'de> Deserialize<'de>>(from: &mut impl Read) -> io::Result<Option<T>> {
    let mut length = [0; 4];
    match from.read_exact(&mut length) {
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
        other => other?,
    }
    let length = u32::from_le_bytes(length);
    if length >= LONGEST {
        return Err(io::Error::other("this is not a message"));
    }
    let mut bytes = Vec::new();
    if from.take(u64::from(length)).read_to_end(&mut bytes)? < length as usize {
        return Ok(None);
    }
    postcard::from_bytes(&bytes).map(Some).map_err(io::Error::other)
}

/// Answers requests until there are no more; their end cancels the simulation that is running.
/// `before_answer` is called before an answer is sent: what the unit has printed until then belongs to it.
///
/// # Errors
/// Those of reading and writing; a request that makes no sense.
#[cfg(feature = "host")]
pub fn serve(
    unit: &mut Unit,
    clock: fn() -> f64,
    before_answer: fn(),
    (mut from, to): (impl Read + Send + 'static, &mut impl Write),
) -> io::Result<()> {
    let mut plans: BTreeMap<u64, Plan> = BTreeMap::new();
    let mut trajectory = Trajectory::default();
    let (sender, requests) = channel();
    let is_over = Arc::new(AtomicBool::new(false));
    let cancel = is_over.clone();
    std::thread::spawn(move || {
        loop {
            let request = receive::<Request>(&mut from);
            let is_request = matches!(request, Ok(Some(_)));
            if sender.send(request).is_err() || !is_request {
                break is_over.store(true, Ordering::Relaxed);
            }
        }
    });
    while let Some(request) = requests.recv().map_err(io::Error::other)?? {
        match request {
            Request::Plan(number, plan) => _ = plans.insert(number, plan),
            Request::Simulate { plan, values, settings } => {
                let plan = plans.get(&plan).ok_or_else(|| io::Error::other("no such plan"))?;
                let mut settings =
                    settings.settings(clock).map_err(|fault| io::Error::other(fault.message))?;
                settings.cancel = Some(cancel.clone());
                let mut messages = Vec::new();
                let asked = (plan, values.as_slice());
                let result = unit.simulate(asked, &settings, &mut trajectory, &mut messages);
                let columns = 0..trajectory.n_columns();
                let answer = Answer {
                    time: trajectory.time().to_vec(),
                    columns: columns.map(|column| trajectory.column(column).to_vec()).collect(),
                    result,
                    messages,
                };
                flush_printed();
                before_answer();
                send(to, &answer)?;
            }
        }
    }
    Ok(())
}
