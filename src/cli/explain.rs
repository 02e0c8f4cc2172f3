//! `gapi explain CODE`: what a diagnostic's code means.

use super::terminal;
use crate::diag::suggest;
use crate::script::codes;
use clap::Args;
use std::process::ExitCode;

/// Arguments of `gapi explain`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi explain unknown-class
  gapi explain

Exit code: 0 on success, 2 for an unknown code.")]
pub(super) struct ExplainArgs {
    /// The code in brackets after `error`; if omitted, all codes are listed
    pub code: Option<String>,
}

/// Markdown as text for a terminal: headings without signs, what is below them indented, code farther.
fn plain(markdown: &str) -> String {
    let mut text = String::new();
    let mut is_code = false;
    let mut is_below_heading = false;
    for line in markdown.lines() {
        if std::mem::take(&mut is_below_heading) && line.is_empty() {
            continue;
        }
        if line.starts_with("```") {
            is_code = !is_code;
            continue;
        }
        let (indent, line) = match line.strip_prefix("## ") {
            Some(heading) if !is_code => {
                is_below_heading = true;
                ("", heading)
            }
            _ if is_code => ("    ", line),
            _ => ("  ", line),
        };
        text += format!("{indent}{line}").trim_end();
        text.push('\n');
    }
    text
}

/// Prints the explanation of one code, or the list of all.
pub(super) fn explain(arguments: &ExplainArgs) -> ExitCode {
    let Some(slug) = &arguments.code else {
        let list: String = codes::all().iter().map(|code| format!("{}\n", code.slug)).collect();
        terminal::print(&list);
        return ExitCode::SUCCESS;
    };
    if let Some(code) = codes::all().into_iter().find(|code| code.slug == slug) {
        terminal::print_report(&format!("{}\n\n{}", code.slug, plain(code.explanation.trim())));
        return ExitCode::SUCCESS;
    }
    let slugs: Vec<&str> = codes::all().iter().map(|code| code.slug).collect();
    let hint = suggest::did_you_mean(slug, slugs)
        .unwrap_or_else(|| "`gapi explain` lists all codes".to_owned());
    terminal::eprint(&format!("error: there is no code `{slug}`\nhelp: {hint}\n"));
    ExitCode::from(2)
}
