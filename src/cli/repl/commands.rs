//! What is typed at the prompt: statements, and commands that begin with a colon.

use super::terminal;
use crate::script::models::{checking, simulation};
use crate::script::{Dialect, Session, builtins};
use std::path::Path;
use std::time::Instant;

const HELP: &str = "\
Each statement is executed and its result is shown. An open bracket or a `for` continues on the \
                    next line; two empty lines end it.
  :help [NAME]   this text, or the declaration of a command or a function
  :vars          the variables
  :type EXPR     the type of an expression's value
  :load FILE     run a script, or load a Modelica file
  :dump [CLASS]  a model, or the last translated one, after causalization (BLT)
  :time STMT     execute a statement and show the time it took
  :dialect [D]   the dialect of the commands: dymola or openmodelica
  :quit          leave (also Ctrl-D); Ctrl-C stops what is running
";

/// Does what is asked; the exit code if the session ends.
pub(super) fn answer(session: &mut Session, input: &str) -> Option<u8> {
    let Some(command) = input.trim().strip_prefix(':') else { return run(session, input) };
    let (word, rest) = command.split_once(char::is_whitespace).unwrap_or((command, ""));
    let rest = rest.trim();
    match word {
        "quit" | "q" | "exit" => return Some(0),
        "help" | "h" if rest.is_empty() => terminal::print(HELP),
        "help" | "h" => help(session, rest),
        "vars" => terminal::print(&session.listed_variables()),
        "type" => type_of(session, rest),
        "load" => return load(session, rest),
        "dump" => dump(session, rest),
        "dialect" => dialect(session, rest),
        "time" => {
            let started = Instant::now();
            let ended = run(session, rest);
            terminal::print(&format!("{:.3} s\n", started.elapsed().as_secs_f64()));
            return ended;
        }
        other => terminal::eprint(&format!("error: there is no command `:{other}`; see :help\n")),
    }
    None
}

fn run(session: &mut Session, text: &str) -> Option<u8> {
    if let Some(other) = session.looks_like(text).filter(|other| *other != session.dialect()) {
        let name = other.name();
        let hint = format!("note: this looks like {name}; `:dialect {}`\n", name.to_lowercase());
        terminal::eprint(&hint);
    }
    let status = session.run_text("prompt", text);
    // What was shown at the prompt has been read.
    session.output.messages.forget_unread();
    status.exit.map(|_| status.code)
}

fn dialect(session: &mut Session, name: &str) {
    let all = [Dialect::Dymola, Dialect::OpenModelica];
    match all.into_iter().find(|dialect| dialect.name().eq_ignore_ascii_case(name)) {
        Some(dialect) => session.set_dialect(dialect),
        None if name.is_empty() => {}
        None => {
            terminal::eprint("error: there are two dialects: dymola and openmodelica\n");
            return;
        }
    }
    terminal::print(&format!("{}\n", session.dialect().name()));
}

fn help(session: &mut Session, name: &str) {
    let declarations = builtins::declarations(name);
    if declarations.is_empty() {
        match session.declaration(name) {
            Some(text) => terminal::print(&format!("{text}\n")),
            None => terminal::eprint(&format!("error: there is no command or class `{name}`\n")),
        }
    }
    declarations.iter().for_each(|text| terminal::print(&format!("{text}\n")));
}

fn type_of(session: &mut Session, text: &str) {
    match session.value_of("prompt", text) {
        Ok(value) => terminal::print(&format!("{}\n", value.type_name())),
        Err(error) => session.report(error),
    }
}

fn load(session: &mut Session, file: &str) -> Option<u8> {
    let file = file.trim_matches('"');
    if file.ends_with(".mos") {
        let status = session.run_file(Path::new(file));
        return status.exit.map(|_| status.code);
    }
    match session.load_path(Path::new(file)) {
        Ok(names) => {
            names.iter().for_each(|name| terminal::print(&format!("{name}\n")));
        }
        Err(errors) => errors.into_iter().for_each(|error| session.report(error)),
    }
    None
}

fn dump(session: &mut Session, class: &str) {
    let found = match session.last_model().filter(|_| class.is_empty()) {
        Some(last) => Ok(last),
        None if class.is_empty() => {
            return terminal::eprint("error: no model has been translated; write `:dump CLASS`\n");
        }
        None => simulation::translated(session, class),
    };
    match found {
        Ok(model) => {
            let report = checking::report(session, &model);
            terminal::print(&report);
        }
        Err(errors) => errors.into_iter().for_each(|error| session.report(error)),
    }
}
