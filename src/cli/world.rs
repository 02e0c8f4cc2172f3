//! The world of a real run: disk, clock, environment, terminal, Ctrl-C.

use super::c_compiler;
use super::disk::{Disk, real_path};
use super::fmu;
use super::hangup;
use super::interrupts::Caught;
use super::limits::Stopping;
use super::lock::Lock;
use super::output::Output;
use super::terminal::Terminal;
use crate::external::c::CCompiler;
use crate::fmi::import::Host;
use crate::packages;
use crate::script::access::policy::{Access, Grant};
use crate::script::runs::view::Progress;
use crate::script::runs::view::View;
use crate::script::world::{Content, Environment, FileAccess, FileReader, Files, Screen, Stamp};
use gapilib_identify::problem::Status;
use gapilib_identify::ranks::Ranks;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, OnceLock};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// How often a timer looks whether the user asked to stop.
const TICK: Duration = Duration::from_millis(50);

/// The operating system as scripts see it. The working directory is the session's own, so that
/// `cd` in a script changes nothing outside it.
pub(super) struct SystemWorld {
    screen: Box<dyn Screen>,
    current: PathBuf,
    output: PathBuf,
    threads: usize,
    ranks: Option<Arc<Ranks>>,
    started: Instant,
    stopping: Stopping,
    /// Whether the folder for the results says whose they are.
    claimed: bool,
    /// How often it has written a file.
    changes: u64,
    disk: Arc<Disk>,
    /// The folder for the results, and the lock on it once it is there.
    results: Option<(Output, Option<Lock>)>,
    /// Until the end of the world, interrupts ask its run to stop.
    caught: OnceLock<Caught>,
}

impl SystemWorld {
    /// A world that writes its results below `output` and computes with `threads` threads.
    pub(super) fn new(
        terminal: Terminal,
        output: &Path,
        threads: Option<usize>,
    ) -> io::Result<Self> {
        let interrupt = terminal.interrupt();
        SystemWorld::with_screen(Box::new(terminal), interrupt, output, threads)
    }

    /// The same with any screen; `interrupt` becomes true when the user asks to stop.
    pub(super) fn with_screen(
        screen: Box<dyn Screen>,
        interrupt: Arc<AtomicBool>,
        output: &Path,
        threads: Option<usize>,
    ) -> io::Result<Self> {
        let current = std::env::current_dir().map_err(|error| {
            io::Error::new(error.kind(), format!("the working directory cannot be read: {error}"))
        })?;
        let ranks = super::ranks();
        let available = std::thread::available_parallelism().map_or(1, usize::from);
        let disk = Disk::default();
        disk.grant(Grant::Create(&current));
        Ok(SystemWorld {
            output: current.join(output),
            current,
            stopping: Stopping { flag: interrupt, ..Stopping::default() },
            screen,
            // Each rank of an MPI job has a thread of its own, as many as the user gave cores.
            threads: threads.unwrap_or(if ranks.is_some() { 1 } else { available }).max(1),
            ranks,
            started: Instant::now(),
            claimed: false,
            changes: 0,
            disk: Arc::new(disk),
            results: None,
            caught: OnceLock::new(),
        })
    }

    /// A world whose folder for results says whose they are when the first is written.
    pub(super) fn for_results(
        terminal: Terminal,
        output: Output,
        threads: Option<usize>,
    ) -> io::Result<Self> {
        let interrupt = terminal.interrupt();
        SystemWorld::on_screen(Box::new(terminal), interrupt, output, threads)
    }

    /// The same with any screen; `interrupt` becomes true when the user asks to stop.
    pub(super) fn on_screen(
        screen: Box<dyn Screen>,
        interrupt: Arc<AtomicBool>,
        output: Output,
        threads: Option<usize>,
    ) -> io::Result<Self> {
        let world = SystemWorld::with_screen(screen, interrupt, &output.folder, threads)?;
        world.own_output();
        if !world.disk.owns(&output.real) {
            let folder = output.folder.display();
            return Err(io::Error::other(format!("a link has taken the place of `{folder}`")));
        }
        let lock = output.lock_if_there()?;
        Ok(SystemWorld { results: Some((output, lock)), ..world })
    }

    /// The output folder belongs to the run: what is in it may be replaced.
    pub(super) fn own_output(&self) {
        self.disk.grant(Grant::Own(&self.output));
    }

    /// The same for the default one, unless a link leads out of the working folder.
    pub(super) fn own_default_output(&self) {
        if real_path(&self.output).starts_with(real_path(&self.current)) {
            self.own_output();
        }
    }

    /// Before a file is written: wherever it lies, the output folder gets results or the record of
    /// the file. A folder that was removed meanwhile is made again.
    fn claim(&mut self, path: &Path) -> io::Result<()> {
        self.changes += 1;
        self.stopping.begun.store(true, Ordering::Relaxed);
        let Some((output, lock)) = &mut self.results else { return Ok(()) };
        let is_claimed = self.claimed && self.output.is_dir();
        if !is_claimed && self.disk.permits(path, Access::Write).is_ok() {
            *lock = Some(output.claim(lock.take())?);
            self.claimed = true;
        }
        Ok(())
    }

    /// What stops the run when it is set, and why it was.
    pub(super) fn stopping(&self) -> Stopping {
        self.stopping.clone()
    }

    /// Makes Ctrl-C and the requests of the system to end ask the run to stop; a second one ends the
    /// process at once.
    pub(super) fn catch_interrupts(&self) {
        self.caught.get_or_init(|| Caught::by(&self.stopping.flag));
        hangup::watch(&self.stopping.flag, self.stopping.noticed.clone());
        if let Some(ranks) = &self.ranks {
            ranks.stop_by(Arc::clone(&self.stopping.flag));
        }
    }

    fn at(&self, path: &Path) -> PathBuf {
        self.current.join(path)
    }
}

impl FileAccess for SystemWorld {
    fn grant(&mut self, grant: Grant<'_>) {
        let path = grant.path().map(|path| self.at(path)).unwrap_or_default();
        self.disk.grant(grant.with_path(&path));
    }

    fn permissions(&self) -> Vec<(String, String)> {
        self.disk.permissions()
    }

    fn permits(&self, path: &Path, access: Access) -> io::Result<()> {
        self.disk.permits(&self.at(path), access)
    }
}

impl Files for SystemWorld {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.disk.read(&self.at(path))
    }

    fn read_start(&self, path: &Path, most: usize) -> io::Result<Vec<u8>> {
        self.disk.read_start(&self.at(path), most)
    }

    fn write(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let path = self.at(path);
        self.claim(&path)?;
        self.disk.write(&path, bytes)
    }

    fn write_with(&mut self, path: &Path, content: Content<'_>) -> io::Result<()> {
        let path = self.at(path);
        self.claim(&path)?;
        self.disk.write_with(&path, content)
    }

    fn append(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let path = self.at(path);
        self.claim(&path)?;
        self.disk.append(&path, bytes)
    }

    fn sync(&mut self, path: &Path) -> io::Result<()> {
        self.disk.sync(&self.at(path))
    }

    fn remove(&mut self, path: &Path) -> io::Result<()> {
        self.disk.remove(&self.at(path))
    }

    fn is_link(&self, path: &Path) -> bool {
        self.at(path).is_symlink()
    }

    fn exists(&self, path: &Path) -> bool {
        packages::read(path).is_some() || packages::list(path).is_some() || self.at(path).exists()
    }

    fn is_dir(&self, path: &Path) -> bool {
        packages::list(path).is_some() || self.at(path).is_dir()
    }

    fn stamp(&self, path: &Path) -> Option<Stamp> {
        let metadata = fs::metadata(self.at(path)).ok()?;
        let modified = metadata.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        // Two writes of one size within a tick of the disk's clock look the same to the disk.
        Some(Stamp(modified.as_nanos() as u64, metadata.len(), self.changes))
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        self.disk.list_dir(&self.at(path))
    }

    fn reader(&self) -> Arc<dyn FileReader> {
        self.disk.clone()
    }

    fn create_dirs(&mut self, path: &Path) -> io::Result<()> {
        self.disk.create_folders(&self.at(path))
    }

    fn current_dir(&self) -> PathBuf {
        self.current.clone()
    }

    fn set_current_dir(&mut self, path: &Path) -> io::Result<()> {
        let folder = self.absolute(path);
        if !folder.is_dir() {
            return Err(io::Error::new(io::ErrorKind::NotFound, "no such directory"));
        }
        self.current = folder;
        Ok(())
    }

    fn output_dir(&self) -> PathBuf {
        self.output.clone()
    }
}

/// The name of the shared library that simulates the models in exported units.
fn runtime_name() -> String {
    let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    format!("{prefix}gapilib_fmu{suffix}")
}

impl Environment for SystemWorld {
    fn unit_runtime(&self) -> io::Result<Vec<u8>> {
        let file = match std::env::var_os("GAPILIB_FMU_RUNTIME") {
            Some(file) => PathBuf::from(file),
            None => {
                let program = std::env::current_exe()?;
                let beside = program.with_file_name(runtime_name());
                // As packages of systems have it: `bin` and `lib` side by side.
                let folder = program.parent().and_then(Path::parent);
                let library = folder.map(|folder| folder.join("lib/gapi").join(runtime_name()));
                library.filter(|library| library.is_file() && !beside.is_file()).unwrap_or(beside)
            }
        };
        fs::read(&file)
            .map_err(|error| io::Error::new(error.kind(), format!("`{}`: {error}", file.display())))
    }

    fn env(&self, name: &str) -> Option<String> {
        std::env::var(name).ok()
    }

    fn env_reader(&self) -> Option<fn(&str) -> Option<String>> {
        Some(|name| std::env::var(name).ok())
    }

    fn monotonic_seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    fn clock(&self) -> Option<fn() -> f64> {
        static STARTED: LazyLock<Instant> = LazyLock::new(Instant::now);
        Some(|| STARTED.elapsed().as_secs_f64())
    }

    fn unix_seconds(&self) -> u64 {
        SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs())
    }

    fn process_id(&self) -> u32 {
        std::process::id()
    }

    fn is_interrupted(&self) -> bool {
        let is_asked = self.stopping.flag.load(Ordering::Relaxed);
        if is_asked {
            self.stopping.noticed.store(true, Ordering::Relaxed);
        }
        is_asked
    }

    fn interrupt_flag(&self) -> Option<Arc<AtomicBool>> {
        Some(Arc::clone(&self.stopping.flag))
    }

    fn flag_after(&self, seconds: f64) -> Option<Arc<AtomicBool>> {
        let (flag, stopping) = (Arc::new(AtomicBool::new(false)), Arc::clone(&self.stopping.flag));
        let end = Duration::try_from_secs_f64(seconds.max(0.0)).ok()?;
        let (begin, raised) = (Instant::now(), Arc::downgrade(&flag));
        std::thread::spawn(move || {
            // Without anybody left who asks, it ends.
            while let Some(flag) = raised.upgrade() {
                let is_over = begin.elapsed() >= end || stopping.load(Ordering::Relaxed);
                flag.store(is_over, Ordering::Relaxed);
                drop(flag);
                if is_over {
                    break;
                }
                std::thread::sleep(TICK.min(end.saturating_sub(begin.elapsed())));
            }
        });
        Some(flag)
    }

    fn stop_reason(&self) -> Option<String> {
        self.stopping.reason.lock().ok()?.clone()
    }

    fn c_compiler(&self) -> Option<Arc<dyn CCompiler>> {
        let allowed = self.disk.external_code();
        allowed.is_allowed().then(|| c_compiler::for_libraries(allowed))
    }

    fn fmu_host(&self) -> Option<Arc<dyn Host>> {
        Some(Arc::new(fmu::LocalHost::new(self.disk.external_code())))
    }

    fn run_command(
        &mut self,
        command: &str,
        environment: &BTreeMap<String, String>,
    ) -> io::Result<(i32, Vec<u8>)> {
        let (shell, flag) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
        let output = std::process::Command::new(shell)
            .args([flag, command])
            .current_dir(&self.current)
            .envs(environment)
            .stderr(std::process::Stdio::inherit())
            .output()?;
        Ok((output.status.code().unwrap_or(-1), output.stdout))
    }

    fn threads(&self) -> usize {
        self.threads
    }

    fn ranks(&self) -> Option<Arc<Ranks>> {
        self.ranks.clone()
    }
}

impl Screen for SystemWorld {
    fn print(&mut self, text: &str) {
        self.screen.print(text);
    }

    fn print_of_script(&mut self, text: &str) {
        self.screen.print_of_script(text);
    }

    fn eprint(&mut self, text: &str) {
        self.screen.eprint(text);
    }

    fn columns(&self) -> Option<usize> {
        self.screen.columns()
    }

    fn is_one_screen(&self) -> bool {
        self.screen.is_one_screen()
    }

    fn progress(&mut self, progress: &Progress) {
        self.screen.progress(progress);
    }

    fn status(&mut self) -> Option<Status> {
        self.screen.status()
    }

    fn is_view_due(&mut self) -> bool {
        self.screen.is_view_due()
    }

    fn show_view(&mut self, view: &View) {
        self.screen.show_view(view);
    }

    fn end_view(&mut self) {
        self.screen.end_view();
    }

    fn is_pause_requested(&mut self) -> bool {
        self.screen.is_pause_requested()
    }

    fn begin_pause(&mut self, help: &str) {
        self.screen.begin_pause(help);
    }

    fn ask(&mut self, prompt: &str) -> Option<String> {
        self.screen.ask(prompt)
    }

    fn changed(&mut self, line: &str, outcome: Result<(), &str>) {
        self.screen.changed(line, outcome);
    }

    fn colour(&self) -> bool {
        self.screen.colour()
    }
}
