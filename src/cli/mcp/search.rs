//! Search in the classes of libraries: by words of their names, descriptions and documentation.

use super::process::Stop;
use crate::lsp::described;
use crate::packages;
use crate::source::SourceId;
use crate::syntax;
use crate::syntax::ast::{ClassDefinition, StoredDefinition};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Files that are read, at most.
const MOST_FILES: usize = 20_000;
/// Classes in an answer, at most.
const MOST: usize = 20;
/// Characters of the documentation of one class among several.
const BRIEF: usize = 240;

/// A class that was found.
#[derive(Debug)]
pub(super) struct Found {
    name: String,
    keyword: &'static str,
    comment: String,
    documentation: String,
    score: usize,
}

/// The classes in these folders that have all words, those first that have them in their names; the
/// class alone that has the name.
pub(super) fn classes(folders: &[PathBuf], query: &str, stop: &Stop) -> Vec<Found> {
    let words: Vec<String> = query.split_whitespace().map(str::to_lowercase).collect();
    if words.is_empty() {
        return Vec::new();
    }
    let mut files = BTreeSet::new();
    folders.iter().for_each(|folder| collect(folder, &mut files));
    let mut found: Vec<Found> = Vec::new();
    for file in files {
        if stop.is_asked() {
            break;
        }
        let Some(text) = text_of(&file) else { continue };
        // All parts of the name of a class are in its file: the packages after `within`.
        let lower = text.to_lowercase();
        let is_there = |word: &String| word.split('.').all(|part| lower.contains(part));
        if words.iter().all(is_there)
            && let Ok(tree) = syntax::parse_all_of_stored_definition(SourceId::NONE, &text)
        {
            found.extend(in_file(&tree, &words));
        }
    }
    if let Some(exact) = found.iter().position(|one| one.name.to_lowercase() == words.join(" ")) {
        return vec![found.swap_remove(exact)];
    }
    found.sort_by(|a, b| b.score.cmp(&a.score).then_with(|| a.name.cmp(&b.name)));
    found.dedup_by(|a, b| a.name == b.name);
    found.truncate(MOST);
    found
}

/// What was found, in words.
pub(super) fn text(found: &[Found]) -> String {
    let is_one = found.len() == 1;
    let one = |one: &Found| {
        let comment = match one.comment.is_empty() {
            true => String::new(),
            false => format!(": {}", one.comment),
        };
        let documentation = match is_one {
            true => one.documentation.clone(),
            false => brief(&one.documentation),
        };
        format!("{} {}{comment}\n{documentation}", one.keyword, one.name).trim_end().to_owned()
    };
    found.iter().map(one).collect::<Vec<_>>().join("\n\n") + "\n"
}

fn brief(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(BRIEF) {
        Some((end, _)) => format!("  {}…", &line[..end]),
        None if line.is_empty() => String::new(),
        None => format!("  {line}"),
    }
}

/// Modelica files in a folder and those in it; links are not followed.
fn collect(folder: &Path, files: &mut BTreeSet<PathBuf>) {
    if let Some(names) = packages::list(folder) {
        return names.iter().for_each(|name| collect_one(&folder.join(name), false, files));
    }
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let Ok(kind) = entry.file_type() else { continue };
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        if !kind.is_symlink() && !is_hidden {
            collect_one(&entry.path(), kind.is_dir(), files);
        }
    }
}

fn collect_one(path: &Path, is_folder: bool, files: &mut BTreeSet<PathBuf>) {
    if files.len() >= MOST_FILES {
        return;
    }
    if path.extension().is_some_and(|extension| extension == "mo") {
        files.insert(path.to_owned());
    } else if is_folder || packages::list(path).is_some() {
        collect(path, files);
    }
}

fn text_of(file: &Path) -> Option<String> {
    let bytes = match packages::read(file) {
        Some(bytes) => bytes.to_vec(),
        None => fs::read(file).ok()?,
    };
    Some(syntax::decode(&bytes).0)
}

fn in_file(tree: &StoredDefinition, words: &[String]) -> Vec<Found> {
    let within = tree.within.as_ref().map(|within| within.node.to_string()).unwrap_or_default();
    let mut found = Vec::new();
    tree.classes.iter().for_each(|class| in_class(&within, class, words, &mut found));
    found
}

fn in_class(package: &str, class: &ClassDefinition, words: &[String], found: &mut Vec<Found>) {
    let own = class.name.node.to_string();
    let name = if package.is_empty() { own.clone() } else { format!("{package}.{own}") };
    let described = described(class);
    let shown = [own.to_lowercase(), name.to_lowercase(), described.comment.to_lowercase()];
    let documentation = described.documentation.to_lowercase();
    // What is in a name counts more than what is in a text about it.
    let score = |word: &String| match shown.iter().position(|text| text.contains(word.as_str())) {
        Some(place) => [16, 6, 4][place],
        None => usize::from(documentation.contains(word.as_str())),
    };
    let scores: Vec<usize> = words.iter().map(score).collect();
    if scores.iter().all(|score| *score > 0) {
        found.push(Found {
            name: name.clone(),
            keyword: described.keyword,
            comment: described.comment,
            documentation: described.documentation,
            score: scores.iter().sum(),
        });
    }
    described.nested.iter().for_each(|nested| in_class(&name, nested, words, found));
}
