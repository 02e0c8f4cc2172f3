//! Names and lines of any length in messages that people can read.

use super::Diagnostic;
use std::borrow::Cow;

/// Characters that a word of a message may have; the longest names of generated models have about
/// 150.
const MAX_WORD: usize = 300;

/// Characters kept of a longer word, at its beginning and at its end.
const KEPT: (usize, usize) = (80, 20);

/// The text, with the middle of very long words left out.
pub fn shortened(text: &str) -> Cow<'_, str> {
    if !text.split(char::is_whitespace).any(is_long) {
        return Cow::Borrowed(text);
    }
    let words = text.split_inclusive(char::is_whitespace);
    Cow::Owned(
        words.map(|word| if is_long(word) { middle_left_out(word) } else { word.into() }).collect(),
    )
}

fn is_long(word: &str) -> bool {
    word.len() > MAX_WORD && word.chars().count() > MAX_WORD
}

fn middle_left_out(word: &str) -> Cow<'_, str> {
    let count = word.chars().count();
    let start: String = word.chars().take(KEPT.0).collect();
    let end: String = word.chars().skip(count - KEPT.1).collect();
    Cow::Owned(format!("{start}…{end}"))
}

impl Diagnostic {
    /// The same without the middle of very long words.
    #[must_use]
    pub fn shortened(mut self) -> Diagnostic {
        let report = &mut *self.0;
        let labels = report.labels.iter_mut().map(|label| &mut label.text);
        let frames = report.trace.iter_mut().map(|frame| &mut frame.what);
        let strings = std::iter::once(&mut report.message).chain(&mut report.helps);
        for text in strings.chain(labels).chain(frames) {
            if let Cow::Owned(short) = shortened(text) {
                *text = short;
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_middle_of_very_long_words_is_left_out() {
        assert!(matches!(shortened("there is no variable `x` here"), Cow::Borrowed(_)));
        let long = format!("no `{}` here", "a".repeat(1_000_000));
        let short = shortened(&long);
        assert!(short.starts_with("no `aaa") && short.ends_with("a` here"), "{short}");
        assert!(short.contains("a…a") && short.len() < 200, "{short}");
        let line = "many short words ".repeat(100);
        assert_eq!(shortened(&line), line);
    }
}
