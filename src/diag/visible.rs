//! Control characters made visible: a terminal takes them as commands, to move, to erase, to fill
//! the clipboard (ECMA-48; OSC 52).

use std::borrow::Cow;

/// The text with control characters as symbols, tabs and line ends excepted. The characters that
/// reverse the direction of writing count as well: they show another text than the one that is
/// read.
pub fn visible(text: &str) -> Cow<'_, str> {
    match text.chars().all(is_harmless) {
        true => Cow::Borrowed(text),
        false => Cow::Owned(text.chars().map(symbol).collect()),
    }
}

/// The same on one line.
pub fn visible_line(text: &str) -> String {
    let on_line = |c: char| if matches!(c, '\n' | '\t') { ' ' } else { symbol(c) };
    text.chars().map(on_line).collect()
}

fn is_harmless(c: char) -> bool {
    matches!(c, '\n' | '\t') || !(c.is_control() || turns_direction(c))
}

fn turns_direction(c: char) -> bool {
    matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

fn symbol(c: char) -> char {
    match c {
        c if is_harmless(c) => c,
        // The block of control pictures follows the order of ASCII.
        '\0'..='\u{1f}' => char::from_u32(0x2400 + c as u32).unwrap_or('\u{fffd}'),
        '\u{7f}' => '\u{2421}',
        _ => '\u{fffd}',
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_to_the_terminal_become_symbols() {
        assert_eq!(visible("\u{1b}]52;c;eA==\u{7}"), "␛]52;c;eA==␇");
        assert_eq!(visible("\u{9b}2J\u{7f}\r"), "\u{fffd}2J␡␍");
        assert_eq!(visible("a\u{202e}b"), "a\u{fffd}b");
        assert!(matches!(visible("ä\t°C\n"), Cow::Borrowed(_)));
        assert_eq!(visible_line("a\nb\u{1b}"), "a b␛");
    }
}
