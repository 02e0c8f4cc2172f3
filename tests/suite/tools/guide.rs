//! The guide in `docs/`: every file that it tells to save and every command that it shows is tried,
//! chapter by chapter, and says what the guide says.

use crate::support::guide::blocks;
use crate::support::program::{folder, gapi};
use crate::support::shipped::project;
use crate::support::{guide_charts, guide_diagrams};
use tempfile::TempDir;

/// Where the chapters are that the program writes itself.
const REFERENCE: &str = "reference";

/// The words of a command; what stands in quotation marks is one.
fn words(command: &str) -> Vec<&str> {
    let parts = command.split('"').enumerate();
    let words = |(k, part)| -> Vec<&str> {
        if k % 2 == 1 { vec![part] } else { str::split_whitespace(part).collect() }
    };
    parts.flat_map(words).collect()
}

/// Pictures of a chapter: one whose title names a file is the file that the examples have made; the
/// others are drawn here, by their names.
fn compare_figures(here: &TempDir, chapter: &str, text: &str) {
    for picture in text.lines().filter_map(|line| line.strip_prefix("![")?.split_once("](")) {
        let (file, title) = match picture.1.trim_end_matches(')').split_once(' ') {
            Some((file, title)) => (file, Some(title.trim_matches('"'))),
            None => (picture.1.trim_end_matches(')'), None),
        };
        let place = project("docs/src").join(file);
        let name = place.file_stem().unwrap().to_string_lossy().into_owned();
        let made = match title {
            Some(made) => std::fs::read_to_string(here.path().join(made)).unwrap(),
            None => guide_charts::chart(&name, here.path(), text)
                .map(|chart| chart.svg())
                .or_else(|| guide_diagrams::diagram(&name))
                .unwrap_or_else(|| panic!("{chapter}: nothing draws {file}")),
        };
        if is_update() {
            std::fs::write(&place, &made).unwrap();
        }
        let shown = std::fs::read_to_string(place).unwrap();
        assert!(shown == made, "{chapter}: {file} is not what the examples make");
    }
}

/// Whether the snapshots are written anew.
fn is_update() -> bool {
    std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always")
}

/// Lines of a command that the guide shows in full; of longer output it shows parts, with `...`.
const WHOLE: usize = 45;

/// What a command prints, but for the time that it took, and for how far it was after a while.
fn without_time(said: &str) -> String {
    let progress = regex::Regex::new(r"(?m)^run \d+ of \d+, .*: \d+ s\n").unwrap();
    let time = regex::Regex::new(r"(?m)^(  time +)[0-9.]+ s$").unwrap();
    let said = progress.replace_all(said, "");
    time.replace_all(&said, "${1}0.12 s").trim_end().to_owned()
}

/// Whether these lines are the whole output: a line `...` stands for any number of lines.
fn is_whole(shown: &[&str], said: &[&str]) -> bool {
    match (shown, said) {
        ([], said) => said.is_empty(),
        (["...", rest @ ..], said) => (0..=said.len()).any(|k| is_whole(rest, &said[k..])),
        ([first, rest @ ..], [line, said @ ..]) => {
            first.trim_end() == line.trim_end() && is_whole(rest, said)
        }
        ([_, ..], []) => false,
    }
}

/// The output as the guide shows it, where what it has shown so far is no longer true.
fn shown_anew(shown: &[&str], said: &[&str]) -> String {
    if said.len() <= WHOLE {
        return said.iter().map(|line| format!("{}\n", line.trim_end())).collect();
    }
    let mut text = String::new();
    let mut left_out = false;
    for line in said {
        let wanted = |part: &&&str| **part != "..." && line.contains(part.trim_end());
        if shown.iter().find(wanted).is_some() {
            text += &format!("{}{}\n", if left_out { "...\n" } else { "" }, line.trim_end());
        }
        left_out = !shown.iter().any(|part| *part != "..." && line.contains(part.trim_end()));
    }
    text + if left_out { "...\n" } else { "" }
}

/// Gives the commands of a block, and compares the block with what they say. Returns the block as it
/// should be.
fn carry_out(here: &TempDir, chapter: &str, block: &str) -> String {
    let mut text = String::new();
    let mut lines = block.lines().peekable();
    while let Some(line) = lines.next() {
        let given = line.strip_prefix("$ gapi ");
        let given = given.unwrap_or_else(|| panic!("{chapter}: `{line}` is behind no command"));
        let (command, expected) = given.split_once("# exit code ").unwrap_or((given, "0"));
        let (code, out, errors) = gapi(here, &words(command));
        let code = code.to_string();
        assert_eq!(code, expected.trim(), "{chapter}: gapi {command}\n{out}{errors}");
        let mut shown = Vec::new();
        while let Some(line) = lines.next_if(|line| !line.starts_with("$ ")) {
            shown.push(line);
        }
        let folder = format!("{}/", here.path().canonicalize().unwrap().display());
        let said = without_time(&(out + &errors)).replace(&folder, "");
        let said: Vec<&str> = said.trim_start().lines().collect();
        let own = shown.iter().map(|line| format!("{line}\n")).collect();
        let is_true = is_whole(&shown, &said);
        assert!(
            is_true || is_update(),
            "{chapter}: gapi {command}\nshown\n{own}\nsaid\n{}",
            said.join("\n")
        );
        text += &format!("{line}\n{}", if is_true { own } else { shown_anew(&shown, &said) });
    }
    text
}

#[test]
fn every_example_of_the_guide_does_what_it_says() {
    let summary = std::fs::read_to_string(project("docs/src/SUMMARY.md")).unwrap();
    let chapters: Vec<&str> = summary
        .lines()
        .filter_map(|line| Some(line.split_once("](")?.1.trim_end_matches(')')))
        .collect();
    assert!(chapters.len() >= 20, "{chapters:?}");
    let with_pictures = chapters.iter().filter(|chapter| {
        let text = std::fs::read_to_string(project("docs/src").join(chapter)).unwrap();
        text.lines().any(|line| line.starts_with("!["))
    });
    assert!(with_pictures.count() >= 20, "a chapter that shows something has a picture");
    let only = std::env::var("GAPILIB_CHAPTER").ok();
    for chapter in chapters {
        if only.as_ref().is_some_and(|only| only != chapter) {
            continue;
        }
        let mut text = std::fs::read_to_string(project("docs/src").join(chapter)).unwrap();
        let here = folder(&[]);
        for (kind, block) in blocks(&text) {
            match (kind.split_once(",file="), kind.as_str()) {
                (Some((_, name)), _) => std::fs::write(here.path().join(name), block).unwrap(),
                (None, "console") => {
                    let anew = carry_out(&here, chapter, &block);
                    text = text.replace(
                        &format!("```console\n{block}```"),
                        &format!("```console\n{anew}```"),
                    );
                }
                (None, "modelica") if chapter.starts_with(REFERENCE) => {}
                // The tests of the package run them: `bindings/python/tests/test_guide.py`.
                (None, "python") if chapter == "python.md" => {}
                (None, _) => panic!("{chapter}: a block `{kind}` that nothing tries"),
            }
        }
        if is_update() {
            std::fs::write(project("docs/src").join(chapter), &text).unwrap();
        }
        compare_figures(&here, chapter, &text);
    }
}

/// The pages of the reference: names of their files, and texts. Each group has one.
fn reference_pages(said: &str) -> Vec<(String, String)> {
    let mut groups = said.split("\n## ");
    let first = groups.next().expect("the beginning").trim_end();
    let mut list = format!("{first}\n\n| group | commands |\n|---|---|\n");
    let mut pages = Vec::new();
    for group in groups {
        let (title, text) = group.split_once('\n').expect("a heading");
        let file = title.split(':').next().unwrap_or(title).replace('`', "").replace(' ', "_");
        let file = format!("reference/{file}.md");
        let names: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("### ")).collect();
        let some = names.iter().take(8).map(|name| format!("`{name}`"));
        let mut some = some.collect::<Vec<_>>().join(", ");
        if names.len() > 8 {
            some += &format!(" and {} more", names.len() - 8);
        }
        list += &format!("| [{title}]({file}) | {some} |\n");
        let text = text.replace("\n### ", "\n## ");
        pages.push((file, format!("# {title}\n{}\n", text.trim_end())));
    }
    pages.insert(0, ("reference.md".to_owned(), list));
    pages
}

#[test]
fn the_reference_is_what_the_program_says() {
    let (code, said, _) = gapi(&folder(&[]), &["help", "--reference"]);
    assert_eq!(code, 0);
    let summary = std::fs::read_to_string(project("docs/src/SUMMARY.md")).unwrap();
    for (file, text) in reference_pages(&said) {
        let place = project("docs/src").join(&file);
        if is_update() {
            std::fs::create_dir_all(place.parent().unwrap()).unwrap();
            std::fs::write(&place, &text).unwrap();
        }
        let chapter = std::fs::read_to_string(&place).unwrap_or_default();
        assert!(
            chapter == text,
            "{file} is not what `gapi help --reference` says: run this test with INSTA_UPDATE=always"
        );
        assert!(summary.contains(&format!("]({file})")), "SUMMARY.md does not list {file}");
    }
}

/// All texts of the guide, and the README: paths from the project's folder.
fn texts() -> Vec<String> {
    let mut found = vec!["README.md".to_owned()];
    let mut folders = vec!["docs/src".to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(project(&folder)).unwrap() {
            let entry = entry.unwrap();
            let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
            match entry.file_type().unwrap().is_dir() {
                true => folders.push(path),
                false if path.ends_with(".md") => found.push(path),
                false => {}
            }
        }
    }
    found
}

/// The anchor of a heading as mdBook makes it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().chars().filter_map(|letter| match letter {
        ' ' => Some('-'),
        '-' | '_' => Some(letter),
        _ if letter.is_alphanumeric() => Some(letter.to_ascii_lowercase()),
        _ => None,
    });
    kept.collect()
}

/// The text without its blocks of code and its spans of code.
fn prose(text: &str) -> String {
    let mut is_code = false;
    let lines = text.lines().filter(|line| {
        let is_fence = line.starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    });
    let lines: Vec<&str> = lines.collect();
    regex::Regex::new("`[^`\n]*`").unwrap().replace_all(&lines.join("\n"), "``").into_owned()
}

/// The example of the README is run with the table of the guide's first chapter.
#[test]
fn the_example_of_the_readme_is_true() {
    let readme = std::fs::read_to_string(project("README.md")).unwrap();
    let first = std::fs::read_to_string(project("docs/src/first_fit.md")).unwrap();
    let here = folder(&[]);
    let saved = blocks(&first).into_iter().chain(blocks(&readme));
    let saved = saved.filter_map(|(kind, text)| {
        let (_, name) = kind.split_once(",file=")?;
        matches!(name, "measured.csv" | "fit.mos").then(|| (name.to_owned(), text))
    });
    for (name, text) in saved {
        std::fs::write(here.path().join(name), text).unwrap();
    }
    let script = std::fs::read_to_string(here.path().join("fit.mos")).unwrap();
    assert!(script.starts_with("model Discharge") && script.lines().count() == 10);
    let shown = blocks(&readme).into_iter().find(|(kind, _)| kind == "console").unwrap().1;
    let anew = carry_out(&here, "README.md", &shown);
    if is_update() {
        std::fs::write(project("README.md"), readme.replace(&shown, &anew)).unwrap();
    }
}

/// The first picture of the README is that of the problem whose data it shows; the second is compared
/// with the chapter that makes it.
#[test]
fn the_pictures_of_the_readme_are_those_of_the_program() {
    let here = folder(&[]);
    let problem = project("scripts/problems/polarization.toml");
    let data = format!("--allow-read={}", project("scripts").display());
    let problem = problem.to_str().unwrap();
    let arguments = ["identify", problem, &data, "--plain", "--out", "results"];
    let (code, _, errors) = gapi(&here, &arguments);
    assert_eq!(code, 0, "{errors}");
    let made = std::fs::read_to_string(here.path().join("results/fit.svg")).unwrap();
    if is_update() {
        std::fs::write(project("docs/fit.svg"), &made).unwrap();
    }
    let shown = std::fs::read_to_string(project("docs/fit.svg")).unwrap();
    assert!(shown == made, "docs/fit.svg is not what `gapi identify` makes");
    let readme = std::fs::read_to_string(project("README.md")).unwrap();
    let chapter = std::fs::read_to_string(project("docs/src/genetic_algorithm.md")).unwrap();
    assert!(readme.contains("(docs/src/figures/population.svg)"));
    assert!(chapter.contains("(figures/population.svg \""));
}

#[test]
fn every_link_leads_somewhere() {
    let link = regex::Regex::new(r#"\]\(([^)\s]+)(?: "[^"]*")?\)"#).unwrap();
    let mut seen = 0;
    for file in texts() {
        let text = std::fs::read_to_string(project(&file)).unwrap();
        for found in link.captures_iter(&prose(&text)) {
            let target = &found[1];
            if target.starts_with("https:") {
                continue;
            }
            seen += 1;
            let (path, to) = target.split_once('#').unwrap_or((target, ""));
            let folder = project(&file).parent().unwrap().to_owned();
            let place = if path.is_empty() { project(&file) } else { folder.join(path) };
            assert!(place.exists(), "{file}: `{target}` leads to no file");
            if !to.is_empty() {
                let text = std::fs::read_to_string(&place).unwrap();
                let headings = text.lines().filter(|line| line.starts_with('#'));
                let anchors: Vec<String> =
                    headings.map(|line| anchor(line.trim_start_matches('#'))).collect();
                assert!(anchors.iter().any(|one| one == to), "{file}: `{target}`: {anchors:?}");
            }
        }
    }
    assert!(seen > 100, "{seen} links");
}

#[test]
fn every_text_of_the_guide_is_in_its_summary() {
    let summary = std::fs::read_to_string(project("docs/src/SUMMARY.md")).unwrap();
    for file in texts().iter().filter_map(|file| file.strip_prefix("docs/src/")) {
        let is_listed = file == "SUMMARY.md" || summary.contains(&format!("]({file})"));
        assert!(is_listed, "SUMMARY.md does not list {file}");
    }
}

/// The chapter on the numbers explains each label that the report of a run has in front of one.
#[test]
fn every_number_of_a_report_is_explained() {
    let chapter = std::fs::read_to_string(project("docs/src/every_number.md")).unwrap();
    let (_, block) =
        blocks(&chapter).into_iter().find(|(kind, _)| kind == "console").expect("a report");
    let lines = block.lines().skip_while(|line| !line.starts_with("  model "));
    let labels: Vec<&str> = lines
        .take_while(|line| !line.is_empty())
        .filter_map(|line| Some(line.strip_prefix("  ")?.split_once("  ")?.0))
        .filter(|label| !label.is_empty())
        .collect();
    assert!(labels.len() >= 10, "{labels:?}");
    for label in labels {
        assert!(chapter.contains(&format!("`{label}`")), "`{label}` is not explained");
    }
}
