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

/// The same, where colours that the program itself has set (`ESC [ … m`) remain.
pub fn visible_coloured(text: &str) -> Cow<'_, str> {
    if text.chars().all(is_harmless) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('\u{1b}') {
        shown.push_str(&visible(&rest[..at]));
        let colour = colour_length(&rest[at..]);
        match colour {
            0 => shown.push(symbol('\u{1b}')),
            length => shown.push_str(&rest[at..at + length]),
        }
        rest = &rest[at + colour.max(1)..];
    }
    shown.push_str(&visible(rest));
    Cow::Owned(shown)
}

/// The length of the colour that a text begins with; 0 if it begins otherwise.
fn colour_length(text: &str) -> usize {
    let Some(rest) = text.strip_prefix("\u{1b}[") else { return 0 };
    let parameters = rest.find(|c: char| !(c.is_ascii_digit() || c == ';')).unwrap_or(rest.len());
    if rest[parameters..].starts_with('m') { 2 + parameters + 1 } else { 0 }
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

    #[test]
    fn of_commands_to_the_terminal_only_colours_remain() {
        let text = "\u{1b}[1;31merror\u{1b}[0m \u{1b}]52;c;eA==\u{7}\u{1b}[2J\u{1b}[31";
        let shown = "\u{1b}[1;31merror\u{1b}[0m ␛]52;c;eA==␇␛[2J␛[31";
        assert_eq!(visible_coloured(text), shown);
        assert!(matches!(visible_coloured("plain\n"), Cow::Borrowed(_)));
    }
}
