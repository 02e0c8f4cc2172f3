//! `gapi fmu-worker`: the process in which a unit runs.

use crate::fmi::description;
use crate::fmi::import::{CallWatch, Unit, serve};
use crate::limits;
use crate::options::Limits;
use crate::signals;
use crate::terminal;
use clap::Args;
use std::fs::File;
use std::io::{self, BufReader, BufWriter};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

/// The exit code of a process in which a call does not return.
pub(super) const HUNG: u8 = 124;
/// The line after what a unit has printed for an answer: this comes by another stream.
pub(super) const ANSWERED: &str = "gapi fmu-worker: answered";
/// How many seconds a call may take unless the environment says otherwise: initializations of large
/// models take seconds.
const PATIENCE: f64 = 60.0;
/// The environment variable that says otherwise.
const VARIABLE: &str = "GAPILIB_FMU_CALL_SECONDS";
/// How often calls are looked at.
const TICK: Duration = Duration::from_millis(100);

/// Arguments of `gapi fmu-worker`.
#[derive(Debug, Args)]
pub(crate) struct FmuWorkerArgs {
    /// The folder into which the unit was unpacked
    folder: PathBuf,
}

/// Answers the requests on its standard input.
pub(crate) fn worker(arguments: &FmuWorkerArgs) -> ExitCode {
    let _watch = match limits::enforce(&Limits::default()) {
        Ok(watch) => watch,
        Err(code) => return code,
    };
    match work(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            terminal::eprint(&format!("{error}\n"));
            ExitCode::FAILURE
        }
    }
}

fn work(arguments: &FmuWorkerArgs) -> io::Result<()> {
    let to = own_output()?;
    let text = std::fs::read(arguments.folder.join("modelDescription.xml"))?;
    let description = description::read(&text).map_err(io::Error::other)?;
    // What it writes without a folder is removed with the folder.
    let working = super::working_folder(&arguments.folder);
    std::fs::create_dir_all(&working)?;
    std::env::set_current_dir(&working)?;
    let calls = Arc::new(CallWatch::default());
    let watched = calls.clone();
    let patience = patience()?;
    std::thread::spawn(move || watch(&watched, patience));
    let mut unit = Unit::new(&arguments.folder, description, calls);
    // Who asks is interrupted as well, and then says what becomes of the simulation.
    signals::survive_interrupts();
    let (from, mut to) = (BufReader::new(io::stdin()), BufWriter::new(to));
    static STARTED: LazyLock<Instant> = LazyLock::new(Instant::now);
    let clock = || STARTED.elapsed().as_secs_f64();
    serve(&mut unit, clock, || terminal::eprint(&format!("{ANSWERED}\n")), (from, &mut to))
}

/// The standard output for the answers alone; what the unit prints goes to the error output.
#[cfg(unix)]
fn own_output() -> io::Result<File> {
    use std::os::fd::AsFd as _;
    let own = io::stdout().as_fd().try_clone_to_owned()?;
    rustix::stdio::dup2_stdout(io::stderr().as_fd())?;
    Ok(File::from(own))
}

#[cfg(windows)]
fn own_output() -> io::Result<File> {
    use std::os::windows::io::AsHandle as _;
    Ok(File::from(io::stdout().as_handle().try_clone_to_owned()?))
}

/// How long a call may take.
fn patience() -> io::Result<Duration> {
    let Some(text) = std::env::var_os(VARIABLE) else {
        return Ok(Duration::from_secs_f64(PATIENCE));
    };
    let seconds = text.to_str().and_then(|text| text.trim().parse::<f64>().ok());
    let seconds = seconds.filter(|seconds| *seconds > 0.0);
    seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()).ok_or_else(|| {
        io::Error::other(format!("the environment variable {VARIABLE} is not a number of seconds"))
    })
}

/// Ends the process where a call does not return.
fn watch(calls: &CallWatch, patience: Duration) {
    let mut before: Option<(u64, Instant)> = None;
    loop {
        std::thread::sleep(TICK);
        let Some((call, function)) = calls.running() else {
            before = None;
            continue;
        };
        let since = match before {
            Some((number, since)) if number == call => since,
            _ => Instant::now(),
        };
        before = Some((call, since));
        if since.elapsed() > patience {
            terminal::eprint(&format!(
                "a call of `{function}` has not returned for {} s ({VARIABLE} allows more)\n",
                patience.as_secs_f64()
            ));
            #[allow(clippy::exit, reason = "the thread that works does not come back")]
            std::process::exit(i32::from(HUNG));
        }
    }
}
