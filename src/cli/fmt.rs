//! `gapi fmt`: the layout of Modelica files and scripts.

use super::{disk, terminal};
use crate::format::{self, Failure, Language, diff};
use crate::script::access::faults::cannot;
use crate::source::{SourceId, SourceMap};
use crate::syntax;
use crate::syntax::errors::NOT_A_SCRIPT;
use clap::{Args, ValueHint};
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of `gapi fmt`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi fmt models scripts          format all .mo and .mos files in two folders
  gapi fmt --check .               exit code 1 if a file is not formatted
  gapi fmt --diff Cell.mo          show what would change
  gapi fmt - --stdin-name a.mos    from standard input to standard output

Exit code: 0 on success; 1 on an error, or with --check if a file is not formatted; 2 for an invalid
command line.")]
pub(super) struct FmtArgs {
    /// Modelica files, scripts, folders with them, or `-` for standard input
    #[arg(required = true, value_name = "FILE|FOLDER", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// Write nothing; list the files that are not formatted, with exit code 1 if there are any
    #[arg(long)]
    pub check: bool,
    /// Write nothing; show what would change, as a unified diff
    #[arg(long)]
    pub diff: bool,
    /// The name of what standard input contains: its ending, `.mo` or `.mos`, selects the language
    #[arg(long, value_name = "NAME")]
    pub(crate) stdin_name: Option<String>,
}

/// What became of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Unchanged,
    Changed,
    /// It is a table of numbers, which has the ending of a script.
    Data,
    Failed,
}

/// A file that was read.
struct Input {
    name: String,
    text: String,
    language: Language,
    /// A byte-order mark precedes the text.
    marked: bool,
    /// The bytes were not UTF-8.
    latin: bool,
}

impl Input {
    fn of(name: &str, bytes: &[u8], language: Language) -> Input {
        let (text, warning) = syntax::decode(bytes);
        let marked = bytes.starts_with(b"\xef\xbb\xbf");
        Input { name: name.to_owned(), text, language, marked, latin: warning.is_some() }
    }

    /// The bytes of a text in the encoding of the file.
    fn encoded(&self, text: &str) -> Vec<u8> {
        let mark: &[u8] = if self.marked { b"\xef\xbb\xbf" } else { b"" };
        match self.latin {
            // Every character was one byte.
            true => text.chars().map(|character| character as u8).collect(),
            false => [mark, text.as_bytes()].concat(),
        }
    }

    /// The formatted text; what is wrong is reported.
    fn formatted(&self) -> Result<String, Outcome> {
        let sources = SourceMap::default();
        let source = sources.add(self.name.as_str(), self.text.as_str());
        format::format(source, &self.text, self.language).map_err(|failure| match failure {
            Failure::Syntax(error) if error.code == NOT_A_SCRIPT => Outcome::Data,
            Failure::Syntax(error) => {
                terminal::eprint(&terminal::rendered(&error, &sources));
                Outcome::Failed
            }
            Failure::Changed => {
                terminal::eprint(&format!(
                    "error: `{}` is not formatted: its tokens would change\nhelp: report this \
                     with the file: it is a fault of gapi\n",
                    self.name
                ));
                Outcome::Failed
            }
        })
    }
}

/// Formats files; exit code 1 if one cannot be read, or with `--check` is not formatted.
pub(super) fn fmt(arguments: &FmtArgs) -> ExitCode {
    if arguments.files == [Path::new("-")] {
        return standard_input(arguments);
    }
    let files = match files(&arguments.files) {
        Ok(files) => files,
        Err(code) => return code,
    };
    let outcomes: Vec<Outcome> =
        files.iter().map(|(path, language)| one(arguments, path, *language)).collect();
    let count = |kind| outcomes.iter().filter(|outcome| **outcome == kind).count();
    let (changed, failed) = (count(Outcome::Changed), count(Outcome::Failed));
    if !arguments.diff {
        let verb = if arguments.check { "not formatted" } else { "formatted" };
        terminal::eprint(&format!(
            "{changed} {verb}, {} unchanged, {failed} with errors\n",
            count(Outcome::Unchanged)
        ));
    }
    match failed > 0 || arguments.check && changed > 0 {
        true => ExitCode::FAILURE,
        false => ExitCode::SUCCESS,
    }
}

fn one(arguments: &FmtArgs, path: &Path, language: Language) -> Outcome {
    let name = path.display().to_string();
    let failed = |doing: &str, error: std::io::Error| {
        terminal::eprint(&format!("error: {}\n", cannot(doing, path, &error).message));
        Outcome::Failed
    };
    let bytes = match disk::read_named(path) {
        Ok(bytes) => bytes,
        Err(error) => return failed("read", error),
    };
    let input = Input::of(&name, &bytes, language);
    let formatted = match input.formatted() {
        Ok(formatted) => formatted,
        Err(outcome) => return outcome,
    };
    let encoded = input.encoded(&formatted);
    if encoded == bytes {
        return Outcome::Unchanged;
    }
    if arguments.diff {
        terminal::print(&diff::unified(&name, &input.text, &formatted));
    } else if arguments.check {
        terminal::print(&format!("{name}\n"));
    } else if let Err(error) = disk::write_atomically(path, &encoded) {
        return failed("write", error);
    }
    Outcome::Changed
}

/// From standard input to standard output.
fn standard_input(arguments: &FmtArgs) -> ExitCode {
    let mut bytes = Vec::new();
    if let Err(error) = std::io::stdin().lock().read_to_end(&mut bytes) {
        terminal::eprint(&format!("error: cannot read standard input: {error}\n"));
        return ExitCode::FAILURE;
    }
    let name = arguments.stdin_name.as_deref().unwrap_or("<stdin>");
    let text = syntax::decode(&bytes).0;
    let language = Language::of_name(name).unwrap_or_else(|| {
        let classes = syntax::parse_stored_definition(SourceId::NONE, &text).is_ok();
        if classes { Language::Modelica } else { Language::Script }
    });
    let input = Input::of(name, &bytes, language);
    let Ok(formatted) = input.formatted() else { return ExitCode::FAILURE };
    let changed = formatted != input.text;
    if arguments.diff {
        terminal::print(&diff::unified(name, &input.text, &formatted));
    } else if !arguments.check {
        terminal::print(&formatted);
    }
    match arguments.check && changed {
        true => ExitCode::FAILURE,
        false => ExitCode::SUCCESS,
    }
}

/// The files that are named, and those below folders, sorted.
fn files(paths: &[PathBuf]) -> Result<Vec<(PathBuf, Language)>, ExitCode> {
    let mut found = Vec::new();
    for path in paths {
        let name = path.to_string_lossy();
        if path.is_dir() {
            collect(path, &mut found);
        } else if let Some(language) = Language::of_name(&name) {
            found.push((path.clone(), language));
        } else {
            terminal::eprint(&format!(
                "error: `{name}` is neither a Modelica file nor a script\nhelp: give files that \
                 end in `.mo` or `.mos`, or folders with them\n"
            ));
            return Err(ExitCode::from(2));
        }
    }
    found.sort_by(|one, other| one.0.cmp(&other.0));
    found.dedup();
    Ok(found)
}

fn collect(folder: &Path, found: &mut Vec<(PathBuf, Language)>) {
    let names = match disk::list_named(folder) {
        Ok(names) => names,
        Err(error) => {
            return terminal::eprint(&format!(
                "warning: cannot read `{}`: {error}\n",
                folder.display()
            ));
        }
    };
    for path in names.iter().map(|name| folder.join(name)) {
        if path.is_symlink() {
            continue;
        }
        if path.is_dir() {
            collect(&path, found);
        } else if let Some(language) = Language::of_name(&path.to_string_lossy()) {
            found.push((path, language));
        }
    }
}
