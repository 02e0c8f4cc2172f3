//! `gapi help`: the commands of scripts, and the ledger of compatibility.

use super::options::DialectName;
use super::terminal;
use crate::ga::operators::{self, OperatorKind};
use crate::registry::Setting;
use crate::script::builtins;
use clap::Args;
use std::process::ExitCode;

/// Arguments of `gapi help`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi help simulateModel
  gapi help --compat
  gapi help --compat dymola

Exit code: 0 on success, 1 for an unknown script command, 2 for an invalid command line.")]
pub(super) struct HelpArgs {
    /// A script command; if omitted, all commands are listed
    pub name: Option<String>,
    /// Compatibility with other tools: supported, partial, absent, and the differences
    #[arg(long, value_enum, value_name = "DIALECT", num_args = 0..=1)]
    pub compat: Option<Option<DialectName>>,
    /// Declarations of all commands, as a chapter of the guide
    #[arg(long, conflicts_with_all = ["name", "compat"])]
    pub reference: bool,
    /// Operators of the genetic algorithm, with settings and sources; optionally one KIND: `crossover`
    #[arg(long, value_name = "KIND", num_args = 0..=1, conflicts_with_all = ["name", "compat", "reference"])]
    pub operators: Option<Option<String>>,
}

/// The ledgers, as they are in the repository.
const LEDGERS: [(DialectName, &str, &str); 2] = [
    (DialectName::Dymola, "Dymola", include_str!("compat/dymola.toml")),
    (DialectName::Openmodelica, "OpenModelica", include_str!("compat/openmodelica.toml")),
];

/// Prints what is asked for.
pub(super) fn help(arguments: &HelpArgs, program: &clap::Command) -> ExitCode {
    if let Some(name) = arguments.compat {
        let all = LEDGERS.iter().filter(|(known, ..)| name.is_none_or(|name| name == *known));
        all.for_each(|(_, title, ledger)| terminal::print_report(&table(title, ledger)));
        return ExitCode::SUCCESS;
    }
    if arguments.reference {
        terminal::print(&builtins::reference());
        return ExitCode::SUCCESS;
    }
    if let Some(kind) = &arguments.operators {
        return operators_of(kind.as_deref());
    }
    match &arguments.name {
        None => {
            let names: String = builtins::names().iter().map(|name| format!("{name}\n")).collect();
            terminal::print(&names);
            ExitCode::SUCCESS
        }
        Some(name) => match builtins::declarations(name).as_slice() {
            [] => {
                let known = builtins::names();
                let hint = command_help(name, program)
                    .or_else(|| crate::diag::suggest::did_you_mean(name, known.iter().copied()));
                let hint = hint.map_or(String::new(), |hint| format!(": {hint}"));
                terminal::eprint(&format!("error: there is no script command `{name}`{hint}\n"));
                ExitCode::FAILURE
            }
            all => {
                all.iter().for_each(|header| terminal::print_report(&format!("{header}\n")));
                ExitCode::SUCCESS
            }
        },
    }
}

/// Where the help of a command of the program is, which is not a command of scripts.
fn command_help(name: &str, program: &clap::Command) -> Option<String> {
    let mut commands = program.get_subcommands().map(clap::Command::get_name);
    let command = commands.find(|known| *known == name)?;
    Some(format!("it is a command of gapi: `gapi {command} --help`"))
}

/// The operators of one kind, or of all.
fn operators_of(name: Option<&str>) -> ExitCode {
    let kinds = operators::KINDS.iter();
    let chosen = kinds.filter(|kind| name.is_none_or(|name| name == kind.name));
    let text: Vec<String> = chosen.map(described).collect();
    if text.is_empty() {
        let known = operators::KINDS.iter().map(|kind| kind.name).collect::<Vec<_>>().join(", ");
        terminal::eprint(&format!("error: there is no such kind of operator; known: {known}\n"));
        return ExitCode::FAILURE;
    }
    terminal::print_report(&text.join("\n"));
    ExitCode::SUCCESS
}

/// A kind of operator: its entries with their settings and sources, and the declaration of a
/// function of the user.
fn described(kind: &OperatorKind) -> String {
    let mut text = format!("{}: {}\n", kind.name, kind.summary);
    for entry in (kind.entries)() {
        let aliases = match entry.aliases {
            [] => String::new(),
            aliases => format!(" ({})", aliases.join(", ")),
        };
        text += &format!("  {}{aliases}: {} [{}]\n", entry.name, entry.summary, entry.reference);
        for Setting { name, default, domain } in entry.settings {
            let (low, high) = (domain.start(), domain.end());
            text += &format!("    {name} = {default}, {low} to {high}\n");
        }
    }
    if let Some((name, summary)) = kind.frequency {
        text += &format!("  each of them in [method]:\n    {name}: {summary}\n");
    }
    let declaration = kind.declaration().replace('\n', "\n    ");
    text + &format!("  your own function:\n    {}\n", declaration.trim_end())
}

/// One row a line: name, status, difference.
fn table(title: &str, ledger: &str) -> String {
    let mut text = format!("{title}\n");
    for block in ledger.split("\n\n") {
        let mut lines = block.lines().filter(|line| !line.starts_with('#'));
        let Some(name) = lines.next().and_then(|line| line.strip_prefix('[')) else { continue };
        let value = |key: &str| {
            let line = block.lines().find(|line| line.starts_with(&format!("{key} = ")))?;
            Some(line.split_once(" = ")?.1.trim_matches('"').replace("\\\"", "\""))
        };
        let status = value("status").unwrap_or_default();
        let row = format!(
            "  {:28} {status:10} {}",
            name.trim_end_matches(']').trim_matches('"'),
            value("difference").unwrap_or_default()
        );
        text.push_str(row.trim_end());
        text.push('\n');
    }
    text
}
