//! Where the entries of a problem's file are written. They are read apart from the entries, because
//! what is collected by `flatten` or chosen by its form has lost its places.

use crate::source::{SourceId, Span};
use indexmap::IndexMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The place of an entry, and those of the entries within it. The elements of an array are named by their
/// numbers, from 0.
#[derive(Debug, Clone)]
pub(super) struct Places {
    own: Span,
    /// The text without its quotation marks. In escapes it would have other places than what it means.
    text: Option<Span>,
    within: IndexMap<String, Places>,
}

impl Default for Places {
    fn default() -> Places {
        Places { own: Span::NONE, text: None, within: IndexMap::new() }
    }
}

impl Places {
    /// The places of a text; none where it is not TOML.
    pub(super) fn of(source: SourceId, text: &str) -> Places {
        let file = DeTable::parse(text).map(Spanned::into_inner).unwrap_or_default();
        let span = |from: usize, to: usize| Span::new(source, from, to);
        Places { within: tables(&file, text, &span), ..Places::default() }
    }

    /// The entry to which these names lead, or the innermost one on the way that there is.
    pub(super) fn at(&self, names: &[&str]) -> Span {
        let next =
            names.split_first().and_then(|(name, rest)| Some((self.within.get(*name)?, rest)));
        next.map_or(self.own, |(entry, rest)| entry.at(rest))
    }

    /// The text of the entry to which these names lead.
    pub(super) fn text(&self, names: &[&str]) -> Option<Span> {
        self.within(names)?.text
    }

    /// The entry to which these names lead, with all within it.
    pub(super) fn within(&self, names: &[&str]) -> Option<&Places> {
        names.iter().try_fold(self, |entry, name| entry.within.get(*name))
    }

    /// Gives an entry of a table the places of another entry.
    pub(super) fn put(&mut self, [table, name]: &[&str; 2], others: &Places, way: &[&str]) {
        if let Some(places) = others.within(way) {
            let table = self.within.entry((*table).to_owned()).or_default();
            table.within.insert((*name).to_owned(), places.clone());
        }
    }

    /// The parameter of this name.
    pub(super) fn parameter(&self, name: &str) -> Span {
        self.at(&["parameters", name])
    }
}

type MakeSpan<'a> = &'a dyn Fn(usize, usize) -> Span;

fn tables(table: &DeTable<'_>, text: &str, span: MakeSpan<'_>) -> IndexMap<String, Places> {
    let one = |(name, value): (&Spanned<_>, _)| {
        (AsRef::<str>::as_ref(name.get_ref()).to_owned(), entry(value, text, span))
    };
    table.iter().map(one).collect()
}

fn entry(value: &Spanned<DeValue<'_>>, text: &str, span: MakeSpan<'_>) -> Places {
    let range = value.span();
    let own = span(range.start, range.end);
    match value.get_ref() {
        DeValue::Table(table) => Places { own, text: None, within: tables(table, text, span) },
        DeValue::Array(values) => {
            let elements = values.iter().enumerate();
            let within = elements.map(|(k, value)| (k.to_string(), entry(value, text, span)));
            Places { own, text: None, within: within.collect() }
        }
        DeValue::String(_) => {
            let inner = range.end.checked_sub(1).and_then(|end| text.get(range.start + 1..end));
            let is_plain = |inner: &&str| !inner.contains(['\\', '\n', '"', '\'']);
            let inner = inner.filter(is_plain).map(|_| span(range.start + 1, range.end - 1));
            Places { own, text: inner, within: IndexMap::new() }
        }
        _ => Places { own, ..Places::default() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_has_the_place_of_what_it_is_missing_in() {
        let text = "model = \"A\"\n[parameters]\nk = { min = 1 }\n[[experiment]]\ndata = 'd'\n\
                    outputs.V = [\"a\", \"b\"]\n";
        let places = Places::of(SourceId::NONE, text);
        let at = |names: &[&str]| {
            let span = places.at(names);
            &text[span.start as usize..span.end as usize]
        };
        assert_eq!(at(&["parameters", "k", "min"]), "1");
        assert_eq!(at(&["parameters", "k", "max"]), "{ min = 1 }");
        assert_eq!(at(&["experiment", "0", "data"]), "'d'");
        assert_eq!(at(&["experiment", "0", "outputs", "V", "1"]), "\"b\"");
        assert_eq!(at(&["experiment", "0", "x"]), "[[experiment]]");
        assert_eq!(places.at(&["seed"]), Span::NONE);
        assert_eq!(places.text(&["model"]).map(|span| span.end - span.start), Some(1));
    }
}
