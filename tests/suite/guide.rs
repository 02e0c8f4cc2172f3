//! The guide in `docs/`: every file that it tells to save and every command that it shows is tried,
//! chapter by chapter, and says what the guide says.

use crate::cli::{folder, gapi};
use crate::shipped::project;
use tempfile::TempDir;

/// The chapter that the program writes itself.
const REFERENCE: &str = "reference.md";

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

/// The words of a command; what stands in quotation marks is one.
fn words(command: &str) -> Vec<&str> {
    let parts = command.split('"').enumerate();
    let words = |(k, part)| -> Vec<&str> {
        if k % 2 == 1 { vec![part] } else { str::split_whitespace(part).collect() }
    };
    parts.flat_map(words).collect()
}

/// Pictures whose title names a file that the examples of the chapter have made: they are the same.
fn compare_figures(here: &TempDir, chapter: &str, text: &str) {
    for picture in text.lines().filter_map(|line| line.strip_prefix("![")?.split_once("](")) {
        let (file, made) = picture.1.trim_end_matches("\")").split_once(" \"").expect("a title");
        let place = project("docs/src").join(file);
        let made = std::fs::read_to_string(here.path().join(made)).unwrap();
        if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
            std::fs::write(&place, &made).unwrap();
        }
        let shown = std::fs::read_to_string(place).unwrap();
        assert!(shown == made, "{chapter}: {file} is not what the examples make");
    }
}

/// Gives the commands of a block, and compares each line of the block with what they say.
fn carry_out(here: &TempDir, chapter: &str, block: &str) {
    let mut said = String::new();
    for line in block.lines() {
        match line.strip_prefix("$ gapi ") {
            Some(line) => {
                let (command, expected) = line.split_once("# exit code ").unwrap_or((line, "0"));
                let (code, out, errors) = gapi(here, &words(command));
                let code = code.to_string();
                assert_eq!(code, expected.trim(), "{chapter}: gapi {command}\n{out}{errors}");
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
                (None, "modelica") if chapter == REFERENCE => {}
                (None, _) => panic!("{chapter}: a block `{kind}` that nothing tries"),
            }
        }
        compare_figures(&here, chapter, &text);
    }
}

#[test]
fn the_reference_is_what_the_program_says() {
    let (code, said, _) = gapi(&folder(&[]), &["help", "--reference"]);
    let chapter = std::fs::read_to_string(project("docs/src").join(REFERENCE)).unwrap();
    assert!(
        code == 0 && said == chapter,
        "write it anew: gapi help --reference > docs/src/reference.md"
    );
}
