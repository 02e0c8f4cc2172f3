//! The reference of the guide: the declarations of all commands, as Markdown.

use super::{FAMILIES, Family, refused};
use crate::Dialect;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

const BEGINNING: &str = "\
# Reference: the commands of scripts

`gapi help --reference` writes this chapter; `gapi help NAME` shows one command. Each command is \
                         declared as a Modelica function: inputs with a value after `=` are \
                         optional. An input of type `TypeName` or `VariableName` is a name \
                         without quotation marks; an input of type `Any` accepts the types \
                         listed in its comment. A command can be called by its short name or \
                         by its full name with the package. Where Dymola and OpenModelica have \
                         different commands of the same name, the dialect of the script decides.
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
        return (9, "Not supported: these fail with the reason".to_owned());
    }
    match (package, family.dialect) {
        (own, _) if own.starts_with("GAPILib") => (0, format!("`{own}`")),
        ("", Some(Dialect::Dymola)) => (2, "Dymola's, without a package".to_owned()),
        ("", Some(Dialect::OpenModelica)) => (2, "OpenModelica's, without a package".to_owned()),
        ("", None) => (1, "Without a package".to_owned()),
        (package, _) => (2, format!("`{package}`")),
    }
}
