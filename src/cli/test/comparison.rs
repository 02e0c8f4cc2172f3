//! One script: run in memory, and compared with its transcript or with the result that it embeds.

use super::collection::transcript_of;
use super::judgement::judged;
use super::settings::Settings;
use super::verdict::Verdict;
use super::wording::reduced;
use crate::options::{Freedom, Global};
use crate::run::without_folders;
use crate::scratch::{Output, ScratchWorld};
use crate::script::language::expectation::{Tolerance, difference, embedded};
use crate::script::language::parsing;
use crate::script::{Dialect, Echo, Exchange, Options, Reporting, Transcript};
use crate::terminal::Terminal;
use crate::world::SystemWorld;
use crate::{disk, limits, named, session};
use std::io;
use std::path::Path;
use std::time::Instant;

/// How a path in the folder of the script begins, which embedded results leave out.
const START: &str = "<start>/";

/// How scripts are run and compared.
pub(super) struct Comparison<'a> {
    pub freedom: &'a Freedom,
    pub global: &'a Global,
    /// What the command line asks for.
    pub asked: Settings,
    /// Whether transcripts are written.
    pub accept: bool,
}

/// What a script is compared with, in words.
pub(super) fn reference(path: &Path) -> String {
    let Ok(bytes) = named::read(path) else { return "(cannot be read)".to_owned() };
    let (script, _) = parsing::text(&bytes);
    match Settings::of_script(&script) {
        Err(message) => format!("({message})"),
        Ok(settings) if settings.skip => "(skipped)".to_owned(),
        Ok(_) if transcript_of(path).exists() => "transcript".to_owned(),
        Ok(_) if embedded(&script).is_some() => "embedded result".to_owned(),
        Ok(_) => "(nothing is recorded)".to_owned(),
    }
}

/// The transcript beside a script: the command line does not name it.
///
/// # Errors
///
/// A pipe, a device, or a link that leads out of the folder stands there; it cannot be read.
fn recorded(script: &Path) -> io::Result<Option<String>> {
    let file = transcript_of(script);
    if file.symlink_metadata().is_err() {
        return Ok(None);
    }
    let folder = script.parent().filter(|folder| !folder.as_os_str().is_empty());
    if !disk::is_file_in(folder.unwrap_or(Path::new(".")), &file) {
        let message = format!("the transcript `{}` is not a file of this folder", file.display());
        return Err(io::Error::other(message));
    }
    named::read_text(&file).map(Some)
}

impl Comparison<'_> {
    /// Runs a script and compares.
    ///
    /// # Errors
    ///
    /// The script or its transcript cannot be read or written, or its settings are wrong.
    pub(super) fn verdict(&self, path: &Path) -> io::Result<Verdict> {
        let (script, _) = parsing::text(&named::read(path)?);
        let own = Settings::of_script(&script).map_err(io::Error::other)?;
        let settings = self.asked.or(own);
        if settings.skip {
            return Ok(Verdict::Skipped);
        }
        match (recorded(path)?, embedded(&script)) {
            (None, Some(expected)) => self.compared_with_embedded(path, &expected, settings),
            (expected, _) => self.compared_with_transcript(path, expected.as_deref(), settings),
        }
    }

    fn compared_with_embedded(
        &self,
        path: &Path,
        expected: &str,
        settings: Settings,
    ) -> io::Result<Verdict> {
        let mut ran = self.run(path, settings, true)?;
        for one in &mut ran.exchanges {
            one.printed = reduced(&one.printed);
        }
        let printed = reduced(&ran.printed.replace(START, ""));
        let tolerance = settings.tolerance_or(Tolerance::EMBEDDED);
        Ok(match difference(&reduced(expected), &printed, tolerance) {
            None => Verdict::Agrees(ran.exchanges.len()),
            Some(lines) => {
                let judged = judged(&lines, &ran.exchanges);
                Verdict::DiffersFromEmbedded(lines, judged)
            }
        })
    }

    fn compared_with_transcript(
        &self,
        path: &Path,
        expected: Option<&str>,
        settings: Settings,
    ) -> io::Result<Verdict> {
        let transcript = self.run(path, settings, false)?.transcript;
        let tolerance = settings.tolerance_or(Tolerance::TRANSCRIPT);
        let lines = expected.map(|expected| difference(expected, &transcript, tolerance));
        match lines {
            Some(None) => Ok(Verdict::Agrees(0)),
            _ if self.accept => {
                disk::write_beside(&transcript_of(path), transcript.as_bytes())?;
                Ok(Verdict::accepted(&transcript))
            }
            Some(Some(lines)) => Ok(Verdict::Differs(lines, transcript)),
            None => Ok(Verdict::Unrecorded(transcript)),
        }
    }

    fn run(&self, path: &Path, settings: Settings, embedded: bool) -> io::Result<Ran> {
        let terminal = Terminal::new(self.global.color, true);
        let disk = SystemWorld::new(terminal, "results".as_ref(), None)?;
        let _watch = limits::watch(&self.freedom.limits, Instant::now(), disk.stopping())
            .map_err(|_| io::Error::other("the limits cannot be watched"))?;
        let (folder, name) = (path.parent().unwrap_or(Path::new("")), path.file_name());
        let name = name.ok_or_else(|| io::Error::other("a script has a name"))?;
        let printed = Output::default();
        let world = ScratchWorld::new(disk, folder, Output::clone(&printed));
        let options = self.freedom.options();
        let dialect = options.dialect.or(embedded.then_some(Dialect::OpenModelica));
        let echo = if embedded { Echo::Everything } else { Echo::Usual };
        let is_reported = settings.report || !embedded;
        let reporting = if is_reported { Reporting::Usual } else { Reporting::Off };
        let options = Options { dialect, echo, reporting, ..options };
        let mut session = session::open(self.global, world).with_options(options);
        // What scripts translate in temporary folders is not translated again.
        session.storage = None;
        let start = session.world.current_dir();
        let is_brief = !settings.report;
        session.output.transcript = Some(Transcript { is_brief, ..Transcript::default() });
        let status = session.run_file(Path::new(name));
        let transcript = session.output.transcript.take().unwrap_or_default();
        let text = without_folders(&transcript.to_string(), &start, &start.join("results"));
        let printed = printed.lock().map_or(String::new(), |printed| printed.clone());
        Ok(Ran {
            printed: without_folders(&printed, &start, &start.join("results")),
            transcript: format!("{text}[exit code {}]\n", status.code),
            exchanges: transcript.exchanges,
        })
    }
}

/// What a script printed, statement by statement, and its transcript.
struct Ran {
    printed: String,
    exchanges: Vec<Exchange>,
    transcript: String,
}
