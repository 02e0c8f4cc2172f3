//! What the grammar could not read, in Modelica words.
//!
//! The grammar says how far it came and which rules it tried there. A small repair at that place
//! — a `;` more, `:=` for `=` — that lets it come further is the remedy; without one the message
//! names what was found and what is allowed there.

use super::errors::{MISSING_SEMICOLON, NESTING_TOO_DEEP, SYNTAX_ERROR};
use super::foreign::Surroundings;
use super::grammar::{self, Rule};
use super::keywords::{is_keyword, keywords};
use super::scan::Scanned;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::fault;
use crate::source::{SourceId, Span};
use pest::error::{Error, ErrorVariant, InputLocation};

/// The diagnostic for a text that `rule` did not match.
pub(super) fn explain(
    source: SourceId,
    rule: Rule,
    scanned: Scanned,
    error: &Error<Rule>,
) -> Diagnostic {
    let at = position(error);
    if let Some(problem) = scanned.problem
        && problem.from <= at
    {
        return problem.diagnostic;
    }
    let stop = Stop::new(source, &scanned.text, at);
    if let ErrorVariant::CustomError { .. } = error.variant {
        // Only the parser's own guard of the stack ends here.
        return fault!(NESTING_TOO_DEEP, "this is nested too deeply for the memory available")
            .help("split it: assign parts of the expression to variables")
            .at(stop.found);
    }
    stop.written_otherwise(error)
        .or_else(|| stop.misspelt_keyword())
        .or_else(|| stop.repaired(rule))
        .unwrap_or_else(|| stop.unexpected(error))
}

fn position(error: &Error<Rule>) -> usize {
    match error.location {
        InputLocation::Pos(at) => at,
        InputLocation::Span((start, _)) => start,
    }
}

/// The place where the grammar stopped.
struct Stop<'t> {
    source: SourceId,
    text: &'t str,
    /// Where the token begins that does not fit.
    at: usize,
    /// That token.
    found: Span,
    /// Where the token before it ends.
    before: usize,
}

impl<'t> Stop<'t> {
    fn new(source: SourceId, text: &'t str, at: usize) -> Stop<'t> {
        let at = text.len() - text[at..].trim_start_matches(is_blank).len();
        let before = text[..at].trim_end_matches(is_blank).len();
        let length = token_length(&text[at..]);
        Stop { source, text, at, found: Span::new(source, at, at + length), before }
    }

    fn found_text(&self) -> &'t str {
        &self.text[self.found.start as usize..self.found.end as usize]
    }

    /// The word that ends where the token before it ends.
    fn word_before(&self) -> &'t str {
        let head = &self.text[..self.before];
        &head[head.trim_end_matches(is_word).len()..]
    }

    /// What other languages write so.
    fn written_otherwise(&self, error: &Error<Rule>) -> Option<Diagnostic> {
        let surroundings = Surroundings {
            head: &self.text[..self.before],
            gap: &self.text[self.before..self.at],
            found: self.found_text(),
            tail: &self.text[self.found.end as usize..],
            expected: &expected(error),
        };
        let remedy = surroundings.remedy()?;
        Some(self.fault(&remedy.message).help(remedy.help).at(self.found))
    }

    /// `modle M`: a word at the start of a line that is almost a keyword.
    fn misspelt_keyword(&self) -> Option<Diagnostic> {
        let here = (self.found_text(), self.at);
        let before = (self.word_before(), self.before - self.word_before().len());
        [before, here, self.first_of_statement()]
            .into_iter()
            .find_map(|(word, at)| self.misspelt(word, at))
    }

    /// The first word of the line or statement that the grammar stopped in.
    fn first_of_statement(&self) -> (&'t str, usize) {
        let head = &self.text[..self.before];
        let start = head.rfind(['\n', ';', '\u{1e}']).map_or(0, |end| end + 1);
        let start = self.text.len() - self.text[start..].trim_start_matches(is_blank).len();
        let rest = &self.text[start..];
        (&rest[..rest.len() - rest.trim_start_matches(is_word).len()], start)
    }

    fn misspelt(&self, word: &str, at: usize) -> Option<Diagnostic> {
        if word.len() < 3 || is_keyword(word) {
            return None;
        }
        let help = suggest::did_you_mean(word, keywords())?;
        let line_start = self.text[..at].trim_end_matches([' ', '\t']);
        let begins = line_start.is_empty() || line_start.ends_with(['\n', ';', '\u{1e}']);
        let follows = self.text[at + word.len()..].trim_start_matches(is_blank);
        let name_follows = follows.starts_with(is_word) || follows.is_empty();
        (begins && name_follows).then(|| {
            fault!(SYNTAX_ERROR, "unknown keyword `{word}`").help(help).at(Span::new(
                self.source,
                at,
                at + word.len(),
            ))
        })
    }

    /// The diagnostic of the first repair that brings the grammar further.
    fn repaired(&self, rule: Rule) -> Option<Diagnostic> {
        let reached: Vec<(usize, &Repair)> = REPAIRS
            .iter()
            .filter(|repair| self.fits(repair))
            .filter_map(|repair| Some((self.reaches(rule, repair)?, repair)))
            .collect();
        let furthest = reached.iter().map(|(reached, _)| *reached).max()?;
        let (_, repair) = reached.into_iter().find(|(reached, _)| *reached == furthest)?;
        Some(self.remedy(repair))
    }

    fn fits(&self, repair: &Repair) -> bool {
        self.text[self.at..].starts_with(repair.found)
            && (repair.found.is_empty()
                || token_length(&self.text[self.at..]) == repair.found.len())
    }

    /// How far the grammar comes with the repair, if that is beyond the token that did not fit.
    fn reaches(&self, rule: Rule, repair: &Repair) -> Option<usize> {
        let rest = &self.text[self.at + repair.found.len()..];
        let (head, gap) = match repair.found {
            "" => (&self.text[..self.before], &self.text[self.before..self.at]),
            _ => (&self.text[..self.at], ""),
        };
        let text = format!("{head}{}{gap}{rest}", repair.write);
        let grown = repair.write.len() - repair.found.len().min(repair.write.len());
        let shrunk = repair.found.len().saturating_sub(repair.write.len());
        match grammar::read(rule, &text) {
            Ok(_) => Some(usize::MAX),
            Err(error) => {
                let reached = (position(&error) + shrunk).saturating_sub(grown);
                (reached > self.found.end as usize).then_some(reached)
            }
        }
    }

    fn remedy(&self, repair: &Repair) -> Diagnostic {
        let missing = repair.write.trim();
        let gap = Span::new(self.source, self.before, self.before);
        match (repair.found, missing) {
            ("", ";") => fault!(MISSING_SEMICOLON, "a `;` is missing")
                .help("write `;` here")
                .labelled(gap, "the construct that ends here is not closed"),
            ("", _) => fault!(SYNTAX_ERROR, "`{missing}` is missing")
                .help(format!("write `{missing}` here"))
                .labelled(gap, format!("expected `{missing}`")),
            (found, _) => self
                .fault(&format!("unexpected `{found}`"))
                .help(format!("write `{missing}`{}", repair.because))
                .at(self.found),
        }
    }

    fn fault(&self, message: &str) -> Fault {
        fault!(SYNTAX_ERROR, "{message}")
    }

    fn unexpected(&self, error: &Error<Rule>) -> Diagnostic {
        let found = match self.found_text() {
            "" => "the end of the text".to_owned(),
            "\u{1e}" => "the end of the line".to_owned(),
            text if text.starts_with('"') => "this string".to_owned(),
            text => format!("`{text}`"),
        };
        let expected = expected(error);
        let fault = fault!(SYNTAX_ERROR, "unexpected {found}");
        let fault = match expected.as_str() {
            "" => fault,
            words => fault.help(format!("expected: {words}")),
        };
        match is_keyword(self.found_text()) && expected.contains("identifier") {
            true => fault.help("a keyword is not a name; quote it to use it as one: `'...'`"),
            false => fault,
        }
        .at(self.found)
    }
}

/// Text that may be missing (`found` is empty) or written wrong, and what to write.
struct Repair {
    found: &'static str,
    write: &'static str,
    because: &'static str,
}

/// In order of preference where several bring the grammar equally far.
const REPAIRS: &[Repair] = &[
    Repair { found: "=", write: ":=", because: ": `=` is not an assignment inside an algorithm" },
    Repair { found: ":=", write: "=", because: ": `:=` assigns; use `=` in an equation" },
    Repair { found: "==", write: "=", because: ": `==` compares; use `=` in an equation" },
    Repair { found: "=", write: "==", because: " to compare" },
    Repair { found: "", write: ";", because: "" },
    Repair { found: "", write: ",", because: "" },
    Repair { found: "", write: " then ", because: "" },
    Repair { found: "", write: " loop ", because: "" },
    Repair { found: "", write: " in ", because: "" },
];

fn is_blank(character: char) -> bool {
    matches!(character, ' ' | '\n' | '\r' | '\t' | '\u{0b}' | '\u{0c}')
}

fn is_word(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_'
}

/// Bytes of the token that a text begins with.
fn token_length(text: &str) -> usize {
    let word = text.len() - text.trim_start_matches(is_word).len();
    if word > 0 {
        return word;
    }
    if ["==", ":=", "<=", ">=", "<>", ".+", ".-", ".*", "./", ".^"]
        .iter()
        .any(|operator| text.starts_with(operator))
    {
        return 2;
    }
    match text.chars().next() {
        Some(quote @ ('"' | '\'')) => text[1..].find(quote).map_or(text.len(), |end| end + 2),
        Some(other) => other.len_utf8(),
        None => 0,
    }
}

/// What the grammar tried, each kind once, in Modelica words.
fn expected(error: &Error<Rule>) -> String {
    let ErrorVariant::ParsingError { positives, .. } = &error.variant else { return String::new() };
    let mut words: Vec<&str> = Vec::new();
    for word in positives.iter().filter_map(|rule| described(*rule)) {
        if !words.contains(&word) {
            words.push(word);
        }
    }
    if words.contains(&"an expression") {
        words.retain(|word| !PARTS_OF_EXPRESSIONS.contains(word));
    }
    words.join(", ")
}

/// What `an expression` says already.
const PARTS_OF_EXPRESSIONS: &[&str] = &["a name", "a string", "an identifier"];

/// A rule in Modelica words; `None` for rules that say nothing to a reader.
fn described(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::EOI => "the end of the text",
        Rule::IDENT | Rule::name | Rule::import_renaming => "an identifier",
        Rule::component_reference | Rule::type_specifier => "a name",
        Rule::STRING | Rule::description_string => "a string",
        Rule::annotation_clause | Rule::kw_annotation => "`annotation`",
        Rule::expression
        | Rule::if_expression
        | Rule::unsigned_number
        | Rule::parenthesized
        | Rule::array
        | Rule::matrix
        | Rule::boolean_literal
        | Rule::keyword_function
        | Rule::end_subscript
        | Rule::unary_operator
        | Rule::matrix_row => "an expression",
        Rule::binary_operator | Rule::range_operator => "an operator",
        Rule::array_subscripts => "subscripts `[...]`",
        Rule::function_call_args => "arguments `(...)`",
        Rule::modification | Rule::class_modification => "a modification `(...)`",
        Rule::class_or_inheritance_modification => "a modification `(...)`",
        Rule::condition_attribute => "a condition `if`",
        Rule::for_indices | Rule::for_index => "a loop variable",
        Rule::class_definition
        | Rule::restriction
        | Rule::kw_encapsulated
        | Rule::kw_partial
        | Rule::short_class_definition => "a class",
        Rule::component_clause | Rule::component_clause1 | Rule::type_prefix => "a component",
        Rule::declared_element | Rule::component_declaration | Rule::component_declaration1 => {
            "a component"
        }
        Rule::kw_redeclare
        | Rule::kw_final
        | Rule::kw_inner
        | Rule::kw_outer
        | Rule::kw_replaceable => "a component",
        Rule::import_clause => "`import`",
        Rule::extends_clause => "`extends`",
        Rule::constraining_clause => "`constrainedby`",
        Rule::public_section | Rule::protected_section => "`public` or `protected`",
        Rule::equation_section | Rule::kw_equation => "`equation`",
        Rule::algorithm_section | Rule::kw_algorithm => "`algorithm`",
        Rule::kw_initial => "`initial`",
        Rule::external_clause => "`external`",
        Rule::some_equation => "an equation",
        Rule::statement | Rule::script_statement | Rule::interactive_statement => "a statement",
        Rule::within_clause => "`within`",
        Rule::terminator => "`;` or a new line",
        Rule::kw_end => "`end`",
        Rule::kw_then => "`then`",
        Rule::kw_loop => "`loop`",
        Rule::kw_else => "`else`",
        Rule::kw_elseif => "`elseif`",
        Rule::kw_elsewhen => "`elsewhen`",
        Rule::kw_if => "`if`",
        Rule::kw_for => "`for`",
        Rule::kw_in => "`in`",
        Rule::kw_when => "`when`",
        Rule::kw_while => "`while`",
        Rule::kw_break => "`break`",
        Rule::kw_extends => "`extends`",
        Rule::kw_constrainedby => "`constrainedby`",
        _ => return None,
    })
}
