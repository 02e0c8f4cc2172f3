//! Where the entries of a problem's file are written. Read apart from the entries, because what is
//! collected by `flatten` or chosen by `untagged` has lost its places.

use crate::source::{SourceId, Span};
use indexmap::IndexMap;
use serde::Deserialize;
use serde::de::IgnoredAny;
use toml::Spanned;

/// The places of a file.
#[derive(Debug, Default)]
pub(super) struct Places {
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
}

impl Default for ExperimentPlaces {
    fn default() -> ExperimentPlaces {
        ExperimentPlaces { data: Span::NONE, x: Span::NONE, columns: IndexMap::new() }
    }
}

impl ExperimentPlaces {
    /// The output or input of this name.
    pub(super) fn column(&self, name: &str) -> Span {
        self.columns.get(name).copied().unwrap_or(Span::NONE)
    }
}

type Place = Option<Spanned<IgnoredAny>>;

#[derive(Debug, Default, Deserialize)]
struct File {
    #[serde(default)]
    method: Method,
    #[serde(default)]
    experiment: Vec<Experiment>,
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
    outputs: IndexMap<String, Spanned<IgnoredAny>>,
    #[serde(default)]
    inputs: IndexMap<String, Spanned<IgnoredAny>>,
}

/// The places in a text that has been read as a problem: what could be read once can be read again.
pub(super) fn places(source: SourceId, text: &str) -> Places {
    let File { method, experiment } = toml::from_str(text).unwrap_or_default();
    let span = |place: &Spanned<IgnoredAny>| {
        let range = place.span();
        Span::new(source, range.start, range.end)
    };
    let of = |place: &Place| place.as_ref().map_or(Span::NONE, span);
    let kinds = [
        ("sampling", &method.sampling),
        ("selection", &method.selection),
        ("crossover", &method.crossover),
        ("mutation", &method.mutation),
        ("survival", &method.survival),
    ];
    let operators =
        kinds.into_iter().filter_map(|(kind, place)| Some((kind, span(place.as_ref()?))));
    let experiments = experiment.iter().map(|experiment| {
        let columns = experiment.outputs.iter().chain(&experiment.inputs);
        ExperimentPlaces {
            data: of(&experiment.data),
            x: of(&experiment.x),
            columns: columns.map(|(name, place)| (name.clone(), span(place))).collect(),
        }
    });
    Places { operators: operators.collect(), experiments: experiments.collect() }
}
