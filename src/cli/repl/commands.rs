//! What is typed at the prompt: statements, commands that begin with a colon, and a few words that other
//! prompts have.

use super::record::Record;
use crate::script::access::faults::cannot;
use crate::script::access::policy::Grant;
use crate::script::models::{checking, simulation};
use crate::script::{Dialect, RunStatus, Session, builtins};
use crate::terminal;
use std::path::{Path, PathBuf};
use std::time::Instant;

const HELP: &str = "\
Each statement is executed and its result is shown; `ans` is the value of the last expression. After a \
                    simulation, the name of a variable shows its value at the end. An open bracket or a \
                    `for` continues on the next line; two empty lines end it.
  :help [NAME]   this text, or the declaration of a command or a function; also ?NAME
  :vars          the variables
  :type EXPR     the type of an expression's value
  :load FILE     run a script, or load a Modelica file
  :save FILE     save the statements of this session as a script
  :dump [CLASS]  a model, or the last translated one, after causalization (BLT)
  :time STMT     execute a statement and show the time it took
  :dialect [D]   the dialect of the commands: dymola or openmodelica
  :quit          leave (also Ctrl-D); Ctrl-C stops what is running
  ls [DIR], pwd  the files of the working directory or of DIR; the working directory
";

/// The commands of the prompt, to be completed.
pub(super) const COMMANDS: &[&str] =
    &[":dialect", ":dump", ":help", ":load", ":quit", ":save", ":time", ":type", ":vars"];

/// A dialogue: what was typed, and whether something failed.
#[derive(Default)]
pub(super) struct Dialogue {
    record: Record,
    saved: Option<PathBuf>,
    pub has_failed: bool,
}

impl Dialogue {
    /// Does what is asked; the exit code if the session ends.
    pub(super) fn answer(&mut self, session: &mut Session, input: &str) -> Option<u8> {
        let text = input.trim();
        if let Some(name) = text.strip_prefix('?') {
            self.help(session, name.trim());
            return None;
        }
        match text.strip_prefix(':') {
            Some(command) => self.command(session, command),
            None if self.answer_word(session, text) => None,
            None => self.run(session, input),
        }
    }

    fn command(&mut self, session: &mut Session, command: &str) -> Option<u8> {
        let (word, rest) = command.split_once(char::is_whitespace).unwrap_or((command, ""));
        let rest = rest.trim();
        match word {
            "quit" | "q" | "exit" => return Some(0),
            "help" | "h" => self.help(session, rest),
            "vars" => terminal::print(&session.listed_variables()),
            "type" => self.type_of(session, rest),
            "load" => return self.load(session, rest),
            "save" => self.save(session, rest),
            "dump" => self.dump(session, rest),
            "dialect" => self.dialect(session, rest),
            "time" => {
                let started = Instant::now();
                let ended = self.run(session, rest);
                terminal::print(&format!("{:.3} s\n", started.elapsed().as_secs_f64()));
                return ended;
            }
            other => self.refuse(&format!("there is no command `:{other}`; see :help")),
        }
        None
    }

    /// Executes statements.
    fn run(&mut self, session: &mut Session, text: &str) -> Option<u8> {
        if let Some(other) = session.looks_like(text).filter(|other| *other != session.dialect()) {
            let name = other.name();
            let hint =
                format!("note: this looks like {name}; `:dialect {}`\n", name.to_lowercase());
            terminal::eprint(&hint);
        }
        let status = session.run_text("prompt", text);
        self.note(session, text, status)
    }

    /// Notes how statements ended.
    pub(super) fn note(
        &mut self,
        session: &mut Session,
        statements: &str,
        status: RunStatus,
    ) -> Option<u8> {
        self.has_failed |= status.errors > 0;
        self.record.note(statements, status.errors > 0 || status.interrupted);
        // What was shown at the prompt has been read.
        session.output.messages.forget_unread();
        status.exit.map(|_| status.code)
    }

    /// Whether the text is a word of the prompt, or the name of a variable of the last simulation, and was
    /// answered. What scripts have a variable for is theirs.
    fn answer_word(&mut self, session: &mut Session, text: &str) -> bool {
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        match word {
            _ if session.variable(word).is_some() => return false,
            "pwd" if rest.is_empty() => {
                terminal::print(&format!("{}\n", session.world.current_dir().display()));
            }
            "ls" if !rest.contains(['=', '(']) => self.list(session, rest.trim()),
            _ => return self.show_end_value(session, text),
        }
        true
    }

    fn list(&mut self, session: &mut Session, folder: &str) {
        let folder = if folder.is_empty() { "." } else { folder.trim_matches('"') };
        match session.world.list_dir(&session.world.absolute(Path::new(folder))) {
            Ok(names) => names.iter().for_each(|name| terminal::print(&format!("{name}\n"))),
            Err(error) => self.refuse(&cannot("list", Path::new(folder), &error).message),
        }
    }

    fn show_end_value(&mut self, session: &mut Session, name: &str) -> bool {
        let name = name.trim_end_matches(';');
        if !is_name(name) || session.value_of("prompt", name).is_ok() {
            return false;
        }
        let value = session.shown_end_value(name);
        if let Some(value) = &value {
            terminal::print(&format!(" = {value}\n"));
        }
        value.is_some()
    }

    fn refuse(&mut self, message: &str) {
        self.has_failed = true;
        terminal::eprint(&format!("error: {message}\n"));
    }

    fn dialect(&mut self, session: &mut Session, name: &str) {
        let all = [Dialect::Dymola, Dialect::OpenModelica];
        match all.into_iter().find(|dialect| dialect.name().eq_ignore_ascii_case(name)) {
            Some(dialect) => session.set_dialect(dialect),
            None if name.is_empty() => {}
            None => return self.refuse("there are two dialects: dymola and openmodelica"),
        }
        terminal::print(&format!("{}\n", session.dialect().name()));
    }

    fn help(&mut self, session: &mut Session, name: &str) {
        if name.is_empty() {
            return terminal::print(HELP);
        }
        let declarations = builtins::declarations(name);
        if declarations.is_empty() {
            match session.declaration(name) {
                Some(text) => terminal::print(&format!("{text}\n")),
                None => self.refuse(&format!("there is no command or class `{name}`")),
            }
        }
        declarations.iter().for_each(|text| terminal::print(&format!("{text}\n")));
    }

    fn type_of(&mut self, session: &mut Session, text: &str) {
        match session.value_of("prompt", text) {
            Ok(value) => terminal::print(&format!("{}\n", value.type_name())),
            Err(error) => {
                self.has_failed = true;
                session.report(error);
            }
        }
    }

    /// Runs a script, or loads a Modelica file.
    pub(super) fn load(&mut self, session: &mut Session, file: &str) -> Option<u8> {
        let file = file.trim_matches('"');
        let is_dymola = session.dialect() == Dialect::Dymola;
        let called = |[dymola, openmodelica]: [&str; 2]| {
            format!("{}(\"{file}\")", if is_dymola { dymola } else { openmodelica })
        };
        if !file.ends_with(".mo") && !session.world.is_dir(Path::new(file)) {
            let status = session.run_file(Path::new(file));
            return self.note(session, &called(["RunScript", "runScript"]), status);
        }
        let loaded = session.load_path(Path::new(file));
        self.has_failed |= loaded.is_err();
        self.record.note(called(["openModel", "loadFile"]), loaded.is_err());
        match loaded {
            Ok(names) => names.iter().for_each(|name| terminal::print(&format!("{name}\n"))),
            Err(errors) => errors.into_iter().for_each(|error| session.report(error)),
        }
        None
    }

    /// Saves the session. A file that it has not saved itself is not replaced.
    fn save(&mut self, session: &mut Session, file: &str) {
        let file = file.trim_matches('"');
        if file.is_empty() {
            return self.refuse("which file? write `:save x.mos`");
        }
        let path = session.world.absolute(Path::new(file));
        if session.world.exists(&path) && self.saved.as_ref() != Some(&path) {
            return self.refuse(&format!(
                "`{file}` exists already\n = help: choose another name, or remove the file"
            ));
        }
        session.world.grant(Grant::Named(&path));
        match session.world.write(&path, self.record.script().as_bytes()) {
            Ok(()) => {
                self.saved = Some(path);
                terminal::print(&format!("saved to {file}\n"));
            }
            Err(error) => self.refuse(&cannot("write", Path::new(file), &error).message),
        }
    }

    fn dump(&mut self, session: &mut Session, class: &str) {
        let found = match session.last_model().filter(|_| class.is_empty()) {
            Some(last) => Ok(last),
            None if class.is_empty() => {
                return self.refuse("no model has been translated; write `:dump CLASS`");
            }
            None => simulation::translated(session, class),
        };
        match found {
            Ok(model) => {
                let report = checking::report(session, &model);
                terminal::print(&report);
            }
            Err(errors) => {
                self.has_failed = true;
                errors.into_iter().for_each(|error| session.report(error));
            }
        }
    }
}

/// Whether a text reads as the name of a variable in results: `a.b[2].c`, `der(x)`.
fn is_name(text: &str) -> bool {
    let inner = text.strip_prefix("der(").and_then(|rest| rest.strip_suffix(')')).unwrap_or(text);
    inner.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && inner.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']' | ','))
}
