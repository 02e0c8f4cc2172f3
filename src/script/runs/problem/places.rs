//! Where the entries of a problem's file are written. Read apart from the entries, because what is
//! collected by `flatten` or chosen by `untagged` has lost its places.

use crate::source::{SourceId, Span};
use indexmap::IndexMap;
use serde::de::value::MapAccessDeserializer;
use serde::de::{IgnoredAny, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use toml::Spanned;

/// The places of a file.
#[derive(Debug, Clone, Default)]
pub(super) struct Places {
    /// The class of the model, without its quotation marks.
    pub model: Option<Span>,
    /// Expressions of tied parameters, without their quotation marks, by the names of these.
    pub tied: IndexMap<String, Span>,
    parameters: IndexMap<String, Span>,
    /// The operators of the method by their kinds.
    pub operators: IndexMap<&'static str, Span>,
    /// The experiments, in their order.
    pub experiments: Vec<ExperimentPlaces>,
}

/// The places of an experiment.
#[derive(Debug, Clone)]
pub(super) struct ExperimentPlaces {
    /// The name of its file.
    pub data: Span,
    /// Its X.
    pub x: Span,
    columns: IndexMap<String, Span>,
    values: IndexMap<String, Span>,
}

impl Default for ExperimentPlaces {
    fn default() -> ExperimentPlaces {
        let (columns, values) = (IndexMap::new(), IndexMap::new());
        ExperimentPlaces { data: Span::NONE, x: Span::NONE, columns, values }
    }
}

impl ExperimentPlaces {
    /// The output or input of this name.
    pub(super) fn column(&self, name: &str) -> Span {
        self.columns.get(name).copied().unwrap_or(Span::NONE)
    }

    /// The parameter or initial value of this name that the experiment sets.
    pub(super) fn value(&self, name: &str) -> Span {
        self.values.get(name).copied().unwrap_or(Span::NONE)
    }
}

impl Places {
    /// The parameter of this name.
    pub(super) fn parameter(&self, name: &str) -> Span {
        self.parameters.get(name).copied().unwrap_or(Span::NONE)
    }
}

type Place = Option<Spanned<IgnoredAny>>;
type Named = IndexMap<String, Spanned<IgnoredAny>>;

#[derive(Debug, Default, Deserialize)]
struct File {
    model: Place,
    #[serde(default)]
    parameters: IndexMap<String, Spanned<Parameter>>,
    #[serde(default)]
    method: Method,
    #[serde(default)]
    experiment: Vec<Experiment>,
}

#[derive(Debug, Default, Deserialize)]
struct Parameter {
    tied: Place,
}

#[derive(Debug, Default, Deserialize)]
struct Method {
    sampling: Place,
    selection: Place,
    crossover: Place,
    mutation: Place,
    survival: Place,
}

#[derive(Debug, Default, Deserialize)]
struct Experiment {
    data: Place,
    x: Place,
    #[serde(default)]
    outputs: Named,
    #[serde(default)]
    inputs: Named,
    #[serde(default)]
    set: Set,
    #[serde(default)]
    start: Named,
}

/// The values of a table; none where a file is named.
#[derive(Debug, Default)]
struct Set(Named);

impl<'de> Deserialize<'de> for Set {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Set, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = Set;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a table, or the name of a file")
            }

            fn visit_str<E>(self, _: &str) -> Result<Set, E> {
                Ok(Set::default())
            }

            fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<Set, A::Error> {
                Named::deserialize(MapAccessDeserializer::new(entries)).map(Set)
            }
        }
        reader.deserialize_any(Either)
    }
}

/// The places in a text that has been read as a problem: what could be read once can be read again.
pub(super) fn places(source: SourceId, text: &str) -> Places {
    let File { model, parameters, method, experiment } = toml::from_str(text).unwrap_or_default();
    let of_range = |range: std::ops::Range<usize>| Span::new(source, range.start, range.end);
    let span = |place: &Spanned<IgnoredAny>| of_range(place.span());
    let of = |place: &Place| place.as_ref().map_or(Span::NONE, span);
    // Text in escapes would have other places than what it stands for.
    let quoted = |place: &Place| {
        let range = place.as_ref()?.span();
        let inner = text.get(range.start + 1..range.end.checked_sub(1)?)?;
        let is_plain = !inner.contains(['\\', '\n', '"', '\'']);
        is_plain.then(|| of_range(range.start + 1..range.end - 1))
    };
    let kinds = [
        ("sampling", &method.sampling),
        ("selection", &method.selection),
        ("crossover", &method.crossover),
        ("mutation", &method.mutation),
        ("survival", &method.survival),
    ];
    let operators =
        kinds.into_iter().filter_map(|(kind, place)| Some((kind, span(place.as_ref()?))));
    let all = |first: &Named, second: &Named| {
        let both = first.iter().chain(second);
        both.map(|(name, place)| (name.clone(), span(place))).collect()
    };
    let experiments = experiment.iter().map(|experiment| ExperimentPlaces {
        data: of(&experiment.data),
        x: of(&experiment.x),
        columns: all(&experiment.outputs, &experiment.inputs),
        values: all(&experiment.set.0, &experiment.start),
    });
    let tied = parameters
        .iter()
        .filter_map(|(name, one)| Some((name.clone(), quoted(&one.get_ref().tied)?)));
    Places {
        model: quoted(&model),
        tied: tied.collect(),
        parameters: parameters
            .iter()
            .map(|(name, one)| (name.clone(), of_range(one.span())))
            .collect(),
        operators: operators.collect(),
        experiments: experiments.collect(),
    }
}
