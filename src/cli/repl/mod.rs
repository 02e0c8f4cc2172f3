//! `gapi repl`: a prompt.

mod assistance;
mod commands;
mod record;

use super::limits::Stopping;
use super::options::{Freedom, Global, Limits};
use super::output::REPL_RESULTS;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use super::{limits, session};
use crate::script::world::Screen as _;
use crate::script::{Dialect, Echo, Options, Session};
use assistance::Assistance;
use clap::{Args, ValueHint};
use commands::Dialogue;
use rustyline::error::ReadlineError;
use rustyline::history::FileHistory;
use rustyline::{CompletionType, Config, Editor};
use std::cell::RefCell;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Arguments of `gapi repl`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi repl
  gapi repl --dialect openmodelica --library ~/libraries
  gapi repl < statements.txt

`:help` lists the commands of the prompt.

Exit code: 0 after :quit or Ctrl-D, the argument of `exit(…)`, or 1 if statements that do not come from \
                        a terminal had errors.")]
pub(crate) struct ReplArgs {
    /// Folder for results and figures [default: results/repl]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// A script to run first
    #[arg(value_hint = ValueHint::FilePath)]
    pub script: Option<PathBuf>,
    /// Permissions of scripts
    #[command(flatten)]
    pub freedom: Freedom,
}

/// What the prompt begins with.
const BANNER: &str =
    concat!("gapilib ", env!("CARGO_PKG_VERSION"), "; :help lists the commands, :quit exits");

/// Reads statements and shows their answers until the input ends.
pub(super) fn repl(arguments: &ReplArgs, global: &Global) -> ExitCode {
    let terminal = Terminal::new(global.color, false);
    let colour = terminal.colour();
    let out = arguments.out.as_deref();
    let world = match SystemWorld::new(terminal, out.unwrap_or(REPL_RESULTS.as_ref()), None) {
        Ok(world) => world,
        Err(error) => {
            terminal::eprint(&format!("error: {error}\n"));
            return ExitCode::FAILURE;
        }
    };
    match out {
        Some(_) => world.own_output(),
        None => world.own_default_output(),
    }
    world.catch_interrupts();
    let stopping = world.stopping();
    let options = arguments.freedom.options();
    let dialect = Some(options.dialect.unwrap_or(Dialect::Dymola));
    let mut session = session::open(global, world).with_options(Options {
        dialect,
        echo: Echo::Dialogue,
        ..options
    });
    let mut dialogue = Dialogue::default();
    if session::lists_permissions(&mut session, global) {
        return ExitCode::SUCCESS;
    }
    if let Some(script) = &arguments.script {
        let _watch =
            match limits::watch(&arguments.freedom.limits, Instant::now(), stopping.clone()) {
                Ok(watch) => watch,
                Err(code) => return code,
            };
        dialogue.load(&mut session, &script.to_string_lossy());
    }
    let is_typed = std::io::stdin().is_terminal();
    if is_typed {
        let dialect = session.dialect().name();
        terminal::print(&format!("{BANNER} (commands of {dialect})\n"));
    }
    let limits = (&arguments.freedom.limits, &stopping);
    match talk(&mut session, &mut dialogue, limits, colour) {
        // Input from a file has no reader of errors: the exit code says that there were some.
        Ok(Ok(0)) if dialogue.has_failed && !is_typed => ExitCode::FAILURE,
        Ok(Ok(code)) => ExitCode::from(code),
        Ok(Err(code)) => code,
        Err(error) => {
            terminal::eprint(&format!("error: the terminal cannot be read: {error}\n"));
            ExitCode::FAILURE
        }
    }
}

/// Each input has its own limits.
fn talk(
    session: &mut Session,
    dialogue: &mut Dialogue,
    (limits, stopping): (&Limits, &Stopping),
    colour: bool,
) -> rustyline::Result<Result<u8, ExitCode>> {
    let config = Config::builder()
        .completion_type(CompletionType::List)
        .history_ignore_space(true)
        .max_history_size(10_000)?
        .build();
    let session = RefCell::new(session);
    let mut editor: Editor<Assistance<'_, '_>, FileHistory> = Editor::with_config(config)?;
    editor.set_helper(Some(Assistance::of(&session, colour)));
    let history = history_file();
    if let Some(file) = &history {
        // A first session has no history yet.
        let _ = editor.load_history(file);
    }
    let ended = loop {
        match editor.readline("> ") {
            Ok(input) if input.trim().is_empty() => {}
            Ok(input) => {
                let _ = editor.add_history_entry(input.trim_end());
                // Ctrl-C ends what is running now, not what comes next.
                stopping.forget();
                let _watch = match limits::watch(limits, Instant::now(), stopping.clone()) {
                    Ok(watch) => watch,
                    Err(code) => return Ok(Err(code)),
                };
                if let Some(code) = dialogue.answer(&mut session.borrow_mut(), &input) {
                    break Ok(code);
                }
            }
            Err(ReadlineError::Interrupted) => {}
            Err(ReadlineError::Eof) => break Ok(0),
            Err(error) => break Err(error),
        }
    };
    if let Some(file) = &history {
        let _ = editor.save_history(file);
    }
    ended.map(Ok)
}

/// `GAPI_HISTORY`, else a file in the user's state folder.
fn history_file() -> Option<PathBuf> {
    if let Some(file) = std::env::var_os("GAPI_HISTORY") {
        return (!file.is_empty()).then(|| PathBuf::from(file));
    }
    let folder = match std::env::var_os("XDG_STATE_HOME") {
        Some(folder) => PathBuf::from(folder),
        None => PathBuf::from(std::env::var_os("HOME")?).join(".local/state"),
    };
    std::fs::create_dir_all(folder.join("gapi")).ok()?;
    Some(folder.join("gapi/history"))
}
