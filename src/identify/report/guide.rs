//! The chapter of the guide on reading reports, as part of the page: a reader has it at hand without
//! a network, and there is one text for both.
//!
//! Of Markdown it takes what the chapter is written with: headings, paragraphs, lists, emphasis and
//! code. Blocks of code are left out, they belong to the terminal.

use maud::{Markup, html};

const CHAPTER: &str = include_str!("../docs/report.md");

/// The chapter below its title.
pub fn chapter() -> Markup {
    html! { @for block in blocks(CHAPTER) { (block.markup()) } }
}

/// The id of a section; mdBook makes the same of a heading, without what precedes it.
pub fn anchor(heading: &str) -> String {
    let letters = heading.to_lowercase();
    let kept = letters.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    format!("guide-{}", kept.collect::<String>().replace(' ', "-"))
}

#[derive(Debug, PartialEq)]
enum Block {
    Heading(usize, String),
    Paragraph(String),
    List(Vec<String>),
}

impl Block {
    fn markup(&self) -> Markup {
        match self {
            // The chapter's `##` stands below the heading of the page's section, which is an h2.
            Block::Heading(2, text) => html! { h3 id=(anchor(text)) { (text) } },
            Block::Heading(_, text) => html! { h4 id=(anchor(text)) { (text) } },
            Block::Paragraph(text) => html! { p { (inline(text)) } },
            Block::List(items) => html! { ul { @for item in items { li { (inline(item)) } } } },
        }
    }
}

fn blocks(text: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut in_code = false;
    for line in text.lines() {
        if line.starts_with("```") {
            in_code = !in_code;
            continue;
        }
        let line = line.trim();
        if in_code || line.is_empty() || line.starts_with("# ") {
            continue;
        }
        let level = line.chars().take_while(|c| *c == '#').count();
        if level > 1 {
            blocks.push(Block::Heading(level, line[level..].trim().to_owned()));
        } else if let Some(item) = line.strip_prefix("- ") {
            match blocks.last_mut() {
                Some(Block::List(items)) => items.push(item.to_owned()),
                _ => blocks.push(Block::List(vec![item.to_owned()])),
            }
        } else {
            blocks.push(Block::Paragraph(line.to_owned()));
        }
    }
    blocks
}

/// Emphasis by `*…*` and code by `` `…` ``.
fn inline(text: &str) -> Markup {
    let code: Vec<&str> = text.split('`').collect();
    html! {
        @for (k, part) in code.iter().enumerate() {
            @if k % 2 == 1 { code { (part) } } @else {
                @for (k, part) in part.split('*').enumerate() {
                    @if k % 2 == 1 { em { (part) } } @else { (part) }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
