//! The reference of the guide: the declarations of all commands, as Markdown.

use super::{FAMILIES, Family, refused};
use crate::script::Dialect;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

const BEGINNING: &str = "\
# Reference: the commands of scripts

`gapi help --reference` has written this chapter; `gapi help NAME` tells the same of one command. A
command is declared as a Modelica function: inputs with a value after `=` need not be given. An
input of type `TypeName` or `VariableName` is a name, written without quotation marks; one of type
`Any` takes several types, and its comment says which. A command can be called by its bare name or
in full, with its package before it. Where Dymola and OpenModelica have commands of the same name
that differ, the dialect of the script decides.
";

/// All commands by packages: those of GAPILib first, the refused last.
pub fn reference() -> String {
    let mut chapters: BTreeMap<(u8, String), BTreeSet<(&str, &str)>> = BTreeMap::new();
    for family in FAMILIES {
        let commands = chapters.entry(heading(family)).or_default();
        commands.extend(family.builtins.iter().map(|one| (one.name(), one.header.trim())));
    }
    let mut text = BEGINNING.to_owned();
    for ((_, title), commands) in chapters {
        let _ = write!(text, "\n## {title}\n");
        for (name, header) in commands {
            let header = header.replace(" annotation(optional = true)", "");
            let _ = write!(text, "\n### {name}\n\n```modelica\n{header}\n```\n");
        }
    }
    text
}

/// Under what the commands of a family stand, and the order of the headings.
fn heading(family: &'static Family) -> (u8, String) {
    let package = family.packages.first().copied().unwrap_or_default();
    if family.builtins[0].name() == refused::FAMILY.builtins[0].name() {
        return (9, "Refused: these say why, and do nothing".to_owned());
    }
    match (package, family.dialect) {
        (own, _) if own.starts_with("GAPILib") => (0, format!("`{own}`")),
        ("", Some(Dialect::Dymola)) => (2, "Dymola's, without a package".to_owned()),
        ("", Some(Dialect::OpenModelica)) => (2, "OpenModelica's, without a package".to_owned()),
        ("", None) => (1, "Without a package".to_owned()),
        (package, _) => (2, format!("`{package}`")),
    }
}
