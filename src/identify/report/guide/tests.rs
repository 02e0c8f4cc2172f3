//! Every explanation has its section in the guide.

use super::super::explanations::ALL;
use super::*;

#[test]
fn the_guide_has_a_section_on_every_statistic() {
    let headings: Vec<String> = blocks(CHAPTER)
        .iter()
        .filter_map(|block| match block {
            Block::Heading(_, text) => Some(anchor(text)),
            _ => None,
        })
        .collect();
    for explanation in ALL {
        assert!(headings.contains(&explanation.anchor()), "{}", explanation.topic);
    }
}

#[test]
fn markdown_of_the_chapter_is_read() {
    let text = "# T\n\n## A b\n\nOne *two* `x*y` < 3.\n\n- p\n- q\n\n```console\n$ z\n```\n";
    let read = blocks(text);
    assert_eq!(read.len(), 3, "{read:?}");
    let all: String = read.iter().map(|block| block.markup().into_string()).collect();
    let expected = "<h3 id=\"guide-a-b\">A b</h3><p>One <em>two</em> <code>x*y</code> &lt; 3.</p>\
                  <ul><li>p</li><li>q</li></ul>";
    assert_eq!(all, expected);
}
