//! What two tools cannot be expected to say in the same words: their messages.
//!
//! A result embedded in a script is compared after its messages are reduced to what they mean, and
//! so is what the script prints here: the `messages` of a simulation are left out (whether it
//! failed is in its `resultFile`), and of a text of messages, as `getErrorString()` answers it,
//! only whether there are errors is kept. Blanks between values do not count either: they differ
//! from version to version.

/// The text with its messages reduced.
pub(super) fn reduced(text: &str) -> String {
    let mut reduced = String::with_capacity(text.len());
    let mut rest = text;
    while !rest.is_empty() {
        let line = rest.find('\n').map_or(rest, |end| &rest[..=end]);
        let (kept, used) = match messages(rest) {
            Some(found) => found,
            None if line.starts_with(['(', '{', '[']) => (line.replace(", ", ","), line.len()),
            None => (line.to_owned(), line.len()),
        };
        reduced.push_str(&kept);
        rest = &rest[used..];
    }
    reduced
}

/// The messages that a text begins with: what is kept of them and how long they are.
fn messages(text: &str) -> Option<(String, usize)> {
    let trimmed = text.trim_start_matches(' ');
    let indent = text.len() - trimmed.len();
    if let Some(value) = trimmed.strip_prefix("messages = \"") {
        let start = text.len() - value.len();
        let end = start + end_of_string(value)?;
        return Some((format!("{}messages = …", &text[..indent]), end));
    }
    let value = text.strip_prefix('"')?;
    let end = end_of_string(value)?;
    let said = &value[..end - 1];
    let all = said.lines().filter(|line| is_message(line, "Error"));
    let kinds = ["Error", "Warning", "Notification"];
    let first = said.lines().next().unwrap_or("");
    if !kinds.iter().any(|kind| is_message(first, kind)) {
        return None;
    }
    let kept = if all.count() > 0 { "\"errors\"" } else { "\"\"" };
    Some((kept.to_owned(), end + 1))
}

/// Whether a line is a message of this kind, with or without a place before it.
fn is_message(line: &str, kind: &str) -> bool {
    let after_place = match line.strip_prefix('[') {
        Some(place) => place.split_once("] ").map_or(line, |(_, rest)| rest),
        None => line,
    };
    after_place.strip_prefix(kind).is_some_and(|rest| rest.starts_with(':'))
}

/// Where a string ends whose opening quote comes before the text: after its closing quote.
fn end_of_string(text: &str) -> Option<usize> {
    let mut escaped = false;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'\\' if !escaped => escaped = true,
            b'"' if !escaped => return Some(at + 1),
            _ => escaped = false,
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::reduced;

    #[test]
    fn of_messages_only_their_meaning_is_compared() {
        let one = "true\n\"[a.mo:1:2-3:4:writable] Warning: a \\\"b\\\"\nError: c\n\"\n2\n";
        assert_eq!(reduced(one), "true\n\"errors\"\n2\n");
        assert_eq!(reduced("\"Warning: a\n\"\n\"\"\n"), "\"\"\n\"\"\n");
        assert_eq!(reduced("\"Error is the word\"\n"), "\"Error is the word\"\n");
        assert_eq!(reduced("\"Error: open"), "\"Error: open");
        assert_eq!(reduced("(true, {1, 2})\n"), "(true,{1,2})\n");
    }

    #[test]
    fn messages_of_simulations_are_left_out() {
        let result = "record R\n    resultFile = \"x\",\n    messages = \"a\nb\n\"\nend R;\n";
        assert_eq!(
            reduced(result),
            "record R\n    resultFile = \"x\",\n    messages = …\nend R;\n"
        );
    }
}
