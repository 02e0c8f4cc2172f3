//! Help while typing: completion, colours, and whether a statement is complete.

use super::commands::COMMANDS;
use crate::script::{Session, builtins};
use crate::syntax;
use rustyline::completion::{Completer, FilenameCompleter, Pair};
use rustyline::highlight::{CmdKind, Highlighter};
use rustyline::hint::Hinter;
use rustyline::validate::{ValidationContext, ValidationResult, Validator};
use rustyline::{Context, Helper};
use std::borrow::Cow;
use std::cell::RefCell;

/// What is known when a line is read. The session is asked when something is to be completed.
pub(super) struct Assistance<'s, 'w> {
    session: &'s RefCell<&'w mut Session>,
    files: FilenameCompleter,
    colour: bool,
}

impl<'s, 'w> Assistance<'s, 'w> {
    /// Assistance by what the session knows.
    pub(super) fn of(session: &'s RefCell<&'w mut Session>, colour: bool) -> Assistance<'s, 'w> {
        Assistance { session, files: FilenameCompleter::new(), colour }
    }

    /// Functions, variables, classes and parts of the model that begin with what is typed.
    fn names(&self, typed: &str) -> Vec<String> {
        let mut session = self.session.borrow_mut();
        let mut names: Vec<String> = builtins::names().into_iter().map(str::to_owned).collect();
        names.extend(syntax::keywords().map(str::to_owned));
        names.extend(session.names_to_complete());
        if let Some((parent, _)) = typed.rsplit_once('.') {
            names.extend(session.classes_in(parent));
        }
        matching(names, typed)
    }

    /// What strings name that begins with what is typed: classes, and variables of the model.
    fn names_in_strings(&self, typed: &str) -> Vec<String> {
        let mut session = self.session.borrow_mut();
        let parent = typed.rsplit_once('.').map_or("", |(parent, _)| parent);
        let mut names = session.classes_in(parent);
        if !typed.is_empty() {
            names.extend(session.names_in_model());
        }
        matching(names, typed)
    }

    /// Names and files within a string.
    fn complete_in_string(
        &self,
        (start, typed): (usize, &str),
        (files_start, files): (usize, Vec<Pair>),
    ) -> (usize, Vec<Pair>) {
        let names = self.names_in_strings(typed);
        match names.is_empty() || files_start != start && !files.is_empty() {
            true => (files_start, files),
            false => (start, names.into_iter().map(pair).chain(files).collect()),
        }
    }
}

/// Names that begin with what is typed, sorted; of dotted names the next part only.
fn matching(mut names: Vec<String>, typed: &str) -> Vec<String> {
    names.retain(|name| name.starts_with(typed));
    for name in &mut names {
        let end = name[typed.len()..].find('.').map_or(name.len(), |at| typed.len() + at);
        name.truncate(end);
    }
    names.sort();
    names.dedup();
    names
}

/// Where the name before the cursor begins.
fn name_start(line: &str) -> usize {
    line.rfind(|c: char| !(c.is_alphanumeric() || matches!(c, '_' | '.' | ':')))
        .map_or(0, |at| at + line[at..].chars().next().map_or(1, char::len_utf8))
}

/// The function whose arguments the cursor is in.
fn enclosing_call(line: &str) -> Option<&str> {
    let mut depth = 0;
    for (at, character) in line.char_indices().rev() {
        match character {
            ')' => depth += 1,
            '(' if depth > 0 => depth -= 1,
            '(' => {
                let before = &line[..at];
                return Some(&before[name_start(before)..]);
            }
            _ => {}
        }
    }
    None
}

impl Completer for Assistance<'_, '_> {
    type Candidate = Pair;

    fn complete(
        &self,
        line: &str,
        pos: usize,
        context: &Context<'_>,
    ) -> rustyline::Result<(usize, Vec<Pair>)> {
        let before = &line[..pos];
        let start = name_start(before);
        let typed = &before[start..];
        let takes_file = [":load ", ":save ", "ls "].iter().any(|word| before.starts_with(word));
        if takes_file {
            return self.files.complete(line, pos, context);
        }
        if is_in_string(before) {
            let files = self.files.complete(line, pos, context)?;
            return Ok(self.complete_in_string((start, typed), files));
        }
        let mut pairs: Vec<Pair> = Vec::new();
        if let Some(function) = enclosing_call(before) {
            let inputs = builtins::inputs(function).into_iter();
            let inputs = inputs.filter(|input| input.starts_with(typed));
            pairs.extend(inputs.map(|input| pair(format!("{input}="))));
        }
        let own = COMMANDS.iter().filter(|name| start == 0 && name.starts_with(typed));
        let own = own.map(|name| (*name).to_owned());
        let names = if typed.is_empty() { Vec::new() } else { self.names(typed) };
        pairs.extend(own.chain(names).map(pair));
        Ok((start, pairs))
    }
}

/// Whether the end of a text lies in a string.
fn is_in_string(before: &str) -> bool {
    tokens(before).last().is_some_and(|token| token.is_open && token.kind == TokenKind::Text)
}

fn pair(text: String) -> Pair {
    Pair { display: text.clone(), replacement: text }
}

impl Hinter for Assistance<'_, '_> {
    type Hint = String;
}

impl Validator for Assistance<'_, '_> {
    fn validate(&self, context: &mut ValidationContext<'_>) -> rustyline::Result<ValidationResult> {
        Ok(match is_complete(context.input()) {
            true => ValidationResult::Valid(None),
            false => ValidationResult::Incomplete,
        })
    }
}

/// Whether brackets, strings, comments and blocks are closed. Two empty lines end any input: a
/// single one is allowed within a block.
fn is_complete(input: &str) -> bool {
    if input.trim_start().starts_with(':') || input.ends_with("\n\n") {
        return true;
    }
    let (mut brackets, mut blocks) = (0_i32, 0_i32);
    let mut previous = "";
    for token in tokens(input) {
        match token.text {
            "(" | "[" | "{" => brackets += 1,
            ")" | "]" | "}" => brackets -= 1,
            "/*" | "\"" if token.is_open => return false,
            "end" if brackets == 0 => blocks -= 1,
            "for" | "while" | "if" | "when" if starts_statement(previous) && brackets == 0 => {
                blocks += 1;
            }
            "model" | "function" | "package" | "block" | "record" | "class" | "connector"
                if previous != "end" && brackets == 0 =>
            {
                blocks += 1;
            }
            _ => {}
        }
        if token.kind != TokenKind::Blank {
            previous = token.text;
        }
    }
    brackets <= 0 && blocks <= 0
}

/// Whether a statement may begin after this token; an `if` elsewhere is an expression's.
fn starts_statement(previous: &str) -> bool {
    matches!(previous, "" | ";" | "loop" | "then" | "else" | "algorithm" | "equation")
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum TokenKind {
    Blank,
    Word,
    Number,
    Text,
    Comment,
    Other,
}

/// A piece of a line; the pieces make up the whole line.
struct Token<'t> {
    text: &'t str,
    /// The whole piece; `text` is only its beginning where it is an open string or comment.
    whole: &'t str,
    kind: TokenKind,
    is_open: bool,
}

fn tokens(input: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut rest = input;
    while let Some(first) = rest.chars().next() {
        let (kind, length, closed) = match first {
            '"' => string_length(rest),
            '/' if rest.starts_with("//") => {
                (TokenKind::Comment, rest.find('\n').unwrap_or(rest.len()), true)
            }
            '/' if rest.starts_with("/*") => match rest.find("*/") {
                Some(end) => (TokenKind::Comment, end + 2, true),
                None => (TokenKind::Comment, rest.len(), false),
            },
            c if c.is_whitespace() => {
                (TokenKind::Blank, length_of(rest, char::is_whitespace), true)
            }
            c if c.is_alphabetic() || c == '_' => {
                (TokenKind::Word, length_of(rest, |c| c.is_alphanumeric() || c == '_'), true)
            }
            c if c.is_ascii_digit() => {
                (TokenKind::Number, length_of(rest, |c| c.is_alphanumeric() || c == '.'), true)
            }
            other => (TokenKind::Other, other.len_utf8(), true),
        };
        let whole = &rest[..length];
        let text = match (closed, kind) {
            (false, TokenKind::Comment) => "/*",
            (false, _) => "\"",
            _ => whole,
        };
        tokens.push(Token { text, whole, kind, is_open: !closed });
        rest = &rest[length..];
    }
    tokens
}

fn length_of(text: &str, belongs: impl Fn(char) -> bool) -> usize {
    text.find(|c| !belongs(c)).unwrap_or(text.len())
}

fn string_length(text: &str) -> (TokenKind, usize, bool) {
    let mut escaped = false;
    for (at, character) in text.char_indices().skip(1) {
        match character {
            '"' if !escaped => return (TokenKind::Text, at + 1, true),
            _ => escaped = character == '\\' && !escaped,
        }
    }
    (TokenKind::Text, text.len(), false)
}

impl Highlighter for Assistance<'_, '_> {
    fn highlight<'l>(&self, line: &'l str, _pos: usize) -> Cow<'l, str> {
        if !self.colour {
            return Cow::Borrowed(line);
        }
        let mut painted = String::with_capacity(line.len() * 2);
        for token in tokens(line) {
            let code = match token.kind {
                TokenKind::Word if syntax::is_keyword(token.whole) => "1;34",
                TokenKind::Word if builtins::names().binary_search(&token.whole).is_ok() => "36",
                TokenKind::Number => "35",
                TokenKind::Text => "32",
                TokenKind::Comment => "2",
                _ => "",
            };
            match code {
                "" => painted.push_str(token.whole),
                code => painted.push_str(&format!("\x1b[{code}m{}\x1b[0m", token.whole)),
            }
        }
        Cow::Owned(painted)
    }

    fn highlight_char(&self, _line: &str, _pos: usize, kind: CmdKind) -> bool {
        self.colour && kind != CmdKind::MoveCursor
    }
}

impl Helper for Assistance<'_, '_> {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_statement_is_complete_when_everything_is_closed() {
        for (input, expected) in [
            ("x = 1", true),
            ("x = {1,", false),
            ("x = {1,\n2}", true),
            ("for i in 1:3 loop", false),
            ("for i in 1:3 loop\nx = i;\nend for", true),
            ("x = if a then 1 else 2", true),
            ("model M", false),
            ("model M end M;", true),
            ("f(\"open", false),
            ("/* open", false),
            ("x = sum(i for i in 1:3)", true),
            (":load x", true),
            ("for i in\n\n", true),
        ] {
            assert_eq!(is_complete(input), expected, "{input:?}");
        }
    }

    #[test]
    fn arguments_belong_to_the_innermost_open_call() {
        assert_eq!(enclosing_call("x = simulateModel(\"M\", sto"), Some("simulateModel"));
        assert_eq!(enclosing_call("f(g(1), "), Some("f"));
        assert_eq!(enclosing_call("f(1)"), None);
    }

    #[test]
    fn of_dotted_names_the_next_part_is_offered() {
        let matching = |typed: &str| {
            super::matching(["a.x", "a.b.c", "ab", "a.b.d"].map(str::to_owned).to_vec(), typed)
        };
        assert_eq!(matching("a"), ["a", "ab"]);
        assert_eq!(matching("a."), ["a.b", "a.x"]);
    }

    fn completed(assistance: &Assistance<'_, '_>, line: &str) -> Vec<String> {
        let history = rustyline::history::MemHistory::new();
        let context = Context::new(&history);
        let (_, pairs) = assistance.complete(line, line.len(), &context).expect("no terminal");
        pairs.into_iter().map(|pair| pair.replacement).collect()
    }

    #[test]
    fn arguments_classes_components_variables_and_files_are_completed() {
        let library = "package Lib package Math package Vectors end Vectors; end Math; end Lib;";
        let world = crate::script::world::MemoryWorld::new().with_file("Lib.mo", library);
        let mut session = Session::new(Box::new(world));
        let text = "model Plant Real level; parameter Real gain = 2; equation level = gain; \
                    end Plant;\nplanet = 3;\ntranslateModel(\"Plant\");";
        assert_eq!(session.run_text("m.mos", text).code, 0);
        let session = RefCell::new(&mut session);
        let assistance = Assistance::of(&session, false);
        assert_eq!(completed(&assistance, "simulateModel(stopT"), ["stopTime="]);
        assert_eq!(completed(&assistance, "x = plan"), ["planet"]);
        assert_eq!(completed(&assistance, "x = Plan"), ["Plant"]);
        assert_eq!(completed(&assistance, "getParameterValue(Plant.g"), ["Plant.gain"]);
        assert_eq!(completed(&assistance, "lev"), ["level"]);
        assert_eq!(completed(&assistance, ":ti"), [":time"]);
        assert_eq!(completed(&assistance, "simulateModel(\"Pla"), ["Plant"]);
        assert_eq!(completed(&assistance, "plot({\"lev"), ["level"]);
        // A library is loaded when one of its classes is completed.
        assert_eq!(completed(&assistance, "simulateModel(\"Lib.Ma"), ["Lib.Math"]);
        assert_eq!(completed(&assistance, "Lib.Math.Vec"), ["Lib.Math.Vectors"]);
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("results.mat"), "").expect("writable");
        let line = format!("readTrajectoryNames(\"{}/res", folder.path().display());
        let files = completed(&assistance, &line);
        assert!(files.len() == 1 && files[0].ends_with("results.mat"), "{files:?}");
    }
}
