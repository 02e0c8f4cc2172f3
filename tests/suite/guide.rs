//! The guide in `docs/`: every file that it tells to save and every command that it shows is tried,
//! chapter by chapter, and says what the guide says.

use crate::cli::{folder, gapi};
use crate::shipped::project;
use tempfile::TempDir;

/// The fenced blocks of a chapter: what stands behind the fence, and the lines.
fn blocks(chapter: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut open: Option<(String, String)> = None;
    for line in chapter.lines() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(kind), None) => open = Some((kind.to_owned(), String::new())),
            (Some(_), Some(_)) => found.extend(open.take()),
            (None, Some((_, text))) => text.push_str(&format!("{line}\n")),
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a block is not closed");
    found
}

/// Gives the commands of a block, and compares each line of the block with what they say.
fn carry_out(here: &TempDir, chapter: &str, block: &str) {
    let mut said = String::new();
    for line in block.lines() {
        match line.strip_prefix("$ gapi ") {
            Some(command) => {
                let arguments: Vec<&str> = command.split_whitespace().collect();
                let (code, out, errors) = gapi(here, &arguments);
                assert_eq!(code, 0, "{chapter}: gapi {command}\n{out}{errors}");
                said = out + &errors;
            }
            None => assert!(said.contains(line), "{chapter}: `{line}` is not in\n{said}"),
        }
    }
}

#[test]
fn every_example_of_the_guide_does_what_it_says() {
    let summary = std::fs::read_to_string(project("docs/src/SUMMARY.md")).unwrap();
    let chapters: Vec<&str> = summary
        .lines()
        .filter_map(|line| Some(line.split_once("](")?.1.trim_end_matches(')')))
        .collect();
    assert!(chapters.len() >= 4, "{chapters:?}");
    for chapter in chapters {
        let text = std::fs::read_to_string(project("docs/src").join(chapter)).unwrap();
        let here = folder(&[]);
        for (kind, block) in blocks(&text) {
            match (kind.split_once(" file="), kind.as_str()) {
                (Some((_, name)), _) => std::fs::write(here.path().join(name), block).unwrap(),
                (None, "console") => carry_out(&here, chapter, &block),
                (None, _) => panic!("{chapter}: a block `{kind}` that nothing tries"),
            }
        }
    }
}
