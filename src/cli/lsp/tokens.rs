//! Colours by meaning: types, components, parameters, functions, and the lexemes between them.

use super::occurrences::{Entity, Occurrence};
use super::parsed::Parsed;
use crate::flatten::{Declared, Library};
use crate::source::SourceId;
use crate::syntax::ast::{Restriction, VariabilityPrefix};
use crate::syntax::{self, LexemeKind};
use lsp_types::{SemanticToken, SemanticTokenModifier, SemanticTokenType, SemanticTokensLegend};
use std::collections::BTreeMap;
use std::ops::Range;

/// The kinds of tokens, by their numbers.
const TYPES: &[SemanticTokenType] = &[
    SemanticTokenType::NAMESPACE,
    SemanticTokenType::CLASS,
    SemanticTokenType::TYPE,
    SemanticTokenType::ENUM_MEMBER,
    SemanticTokenType::FUNCTION,
    SemanticTokenType::PROPERTY,
    SemanticTokenType::VARIABLE,
    SemanticTokenType::KEYWORD,
    SemanticTokenType::COMMENT,
    SemanticTokenType::STRING,
    SemanticTokenType::NUMBER,
];

/// Bits of what is more to be said of a token.
const DECLARATION: u32 = 1;
const READONLY: u32 = 2;
const DEFAULT_LIBRARY: u32 = 4;

/// What the numbers mean.
pub(crate) fn legend() -> SemanticTokensLegend {
    SemanticTokensLegend {
        token_types: TYPES.to_vec(),
        token_modifiers: vec![
            SemanticTokenModifier::DECLARATION,
            SemanticTokenModifier::READONLY,
            SemanticTokenModifier::DEFAULT_LIBRARY,
        ],
    }
}

fn number(kind: &SemanticTokenType) -> u32 {
    TYPES.iter().position(|one| one == kind).unwrap_or(0) as u32
}

/// The tokens of a document, each in one line, as differences.
pub(crate) fn tokens(
    library: &Library,
    parsed: &Parsed,
    names: &[Occurrence],
) -> Vec<SemanticToken> {
    if parsed.document.is_toml() {
        return Vec::new();
    }
    let text = &*parsed.document.text;
    let mut found: BTreeMap<usize, (Range<usize>, u32, u32)> = BTreeMap::new();
    let lexemes = syntax::lexemes(SourceId::NONE, text, parsed.document.is_script());
    for lexeme in lexemes.unwrap_or_default() {
        let kind = match lexeme.kind {
            LexemeKind::Word if syntax::is_keyword(&text[lexeme.range()]) => {
                SemanticTokenType::KEYWORD
            }
            LexemeKind::Command => SemanticTokenType::KEYWORD,
            LexemeKind::LineComment | LexemeKind::BlockComment => SemanticTokenType::COMMENT,
            LexemeKind::String => SemanticTokenType::STRING,
            LexemeKind::Number => SemanticTokenType::NUMBER,
            _ => continue,
        };
        found.insert(lexeme.start, (lexeme.range(), number(&kind), 0));
    }
    for name in names {
        let (kind, mut modifiers) = coloured(library, name.entity);
        modifiers |= if name.is_declaration { DECLARATION } else { 0 };
        // Names in strings of scripts stay strings.
        let is_in_string = found
            .range(..name.range.start)
            .next_back()
            .is_some_and(|(_, (range, ..))| range.end >= name.range.end);
        if !is_in_string {
            found.insert(name.range.start, (name.range.clone(), number(&kind), modifiers));
        }
    }
    encoded(parsed, found.into_values())
}

fn coloured(library: &Library, entity: Entity) -> (SemanticTokenType, u32) {
    match entity {
        Entity::Declared(Declared::Class(class)) => {
            let kind = match library.definition_of(class).restriction {
                Restriction::Package => SemanticTokenType::NAMESPACE,
                Restriction::Function { .. } => SemanticTokenType::FUNCTION,
                Restriction::Type => SemanticTokenType::TYPE,
                _ => SemanticTokenType::CLASS,
            };
            (kind, 0)
        }
        Entity::Declared(Declared::Component(owner, name)) => {
            let variability = library
                .component(owner, name)
                .and_then(|(clause, _)| clause.type_prefixes.variability);
            let is_fixed = matches!(
                variability,
                Some(VariabilityPrefix::Constant | VariabilityPrefix::Parameter)
            );
            (SemanticTokenType::PROPERTY, if is_fixed { READONLY } else { 0 })
        }
        Entity::Declared(Declared::Literal(..)) => (SemanticTokenType::ENUM_MEMBER, 0),
        Entity::Declared(Declared::Predefined(_)) => (SemanticTokenType::TYPE, DEFAULT_LIBRARY),
        Entity::Loop(_) | Entity::Variable(_) => (SemanticTokenType::VARIABLE, 0),
        Entity::Function(_) => (SemanticTokenType::FUNCTION, DEFAULT_LIBRARY),
    }
}

/// Tokens as the protocol sends them: lines, columns and lengths in UTF-16 units, relative to the token
/// before. What extends over lines is divided, and what begins within another token is left out.
fn encoded(
    parsed: &Parsed,
    tokens: impl Iterator<Item = (Range<usize>, u32, u32)>,
) -> Vec<SemanticToken> {
    let document = &parsed.document;
    let (mut line, mut column, mut end) = (0, 0, 0);
    let mut encoded = Vec::new();
    for (range, token_type, token_modifiers_bitset) in tokens {
        if range.start < end {
            continue;
        }
        end = range.end;
        let first = document.lines.line_of(range.start);
        let last = document.lines.line_of(range.end.saturating_sub(1).max(range.start));
        for number in first..=last {
            let content = document.lines.content(&document.text, number);
            let part = content.start.max(range.start)..content.end.min(range.end);
            if part.is_empty() {
                continue;
            }
            let place = document.range(part);
            let same = place.start.line == line;
            encoded.push(SemanticToken {
                delta_line: place.start.line - line,
                delta_start: place.start.character - if same { column } else { 0 },
                length: place.end.character - place.start.character,
                token_type,
                token_modifiers_bitset,
            });
            (line, column) = (place.start.line, place.start.character);
        }
    }
    encoded
}
