//! Entries that can be written in several ways: a number, a text, a list or a table. Where an entry
//! is written in none of them, the message says what was expected.

use super::file::{
    BandsEntry, Column, ColumnEntry, CovarianceEntry, CovarianceTable, DelayEntry, FitnessEntry,
    LimitEntry, MatrixEntry, NoiseEntry, NoiseTable, OffsetEntry, OneOrMany, OperatorEntry,
    ParameterEntry, ParameterTable, PriorEntry, PriorNumbers, ScaleEntry, ScaleTable,
    SegmentsEntry, SetEntry, SigmaEntry, ValueEntry, WeightEntry,
};
use indexmap::IndexMap;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, IgnoredAny, MapAccess, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// Makes an entry of the rows of a matrix.
type FromMatrix<T> = fn(Vec<Vec<f64>>) -> T;

/// The ways to write an entry `T`; `M` is what its table holds.
struct Forms<T, M = IgnoredAny> {
    expected: &'static str,
    number: Option<fn(f64) -> T>,
    text: Option<fn(String) -> T>,
    truth: Option<fn(bool) -> T>,
    list: Option<fn(Vec<String>) -> T>,
    matrix: Option<FromMatrix<T>>,
    table: Option<fn(M) -> T>,
}

impl<T, M> Forms<T, M> {
    fn new(expected: &'static str) -> Forms<T, M> {
        Forms {
            expected,
            number: None,
            text: None,
            truth: None,
            list: None,
            matrix: None,
            table: None,
        }
    }
}

impl<'de, T, M: Deserialize<'de>> Visitor<'de> for Forms<T, M> {
    type Value = T;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.expected)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<T, E> {
        match self.number {
            Some(number) => Ok(number(value)),
            None => Err(E::invalid_type(Unexpected::Float(value), &self)),
        }
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<T, E> {
        match self.number {
            Some(number) => Ok(number(value as f64)),
            None => Err(E::invalid_type(Unexpected::Signed(value), &self)),
        }
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<T, E> {
        match self.text {
            Some(text) => Ok(text(value.to_owned())),
            None => Err(E::invalid_type(Unexpected::Str(value), &self)),
        }
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<T, E> {
        match self.truth {
            Some(truth) => Ok(truth(value)),
            None => Err(E::invalid_type(Unexpected::Bool(value), &self)),
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<T, A::Error> {
        if let Some(matrix) = self.matrix {
            let mut rows = Vec::new();
            while let Some(row) = items.next_element()? {
                rows.push(row);
            }
            return Ok(matrix(rows));
        }
        let Some(list) = self.list else {
            return Err(Error::invalid_type(Unexpected::Seq, &self));
        };
        let mut names = Vec::new();
        while let Some(name) = items.next_element()? {
            names.push(name);
        }
        Ok(list(names))
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<T, A::Error> {
        let Some(table) = self.table else {
            return Err(Error::invalid_type(Unexpected::Map, &self));
        };
        M::deserialize(MapAccessDeserializer::new(entries)).map(table)
    }
}

/// Reads an entry in the ways that its forms allow.
macro_rules! in_forms {
    ($entry:ty, $forms:expr) => {
        impl<'de> Deserialize<'de> for $entry {
            fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<$entry, D::Error> {
                reader.deserialize_any($forms)
            }
        }
    };
}

in_forms!(
    ParameterEntry,
    Forms::<_, ParameterTable> {
        table: Some(ParameterEntry),
        ..Forms::new("a range, `{ min = 0.1, max = 10 }`, a value, `{ fixed = 2 }`, or `tied`")
    }
);

in_forms!(
    ValueEntry,
    Forms::<_> {
        number: Some(ValueEntry::Number),
        truth: Some(ValueEntry::Truth),
        text: Some(ValueEntry::Text),
        ..Forms::new("a number, `true`, `false` or a text")
    }
);

in_forms!(
    Column,
    Forms::<_, ColumnEntry> {
        text: Some(Column::Name),
        list: Some(Column::Replicates),
        table: Some(|entry| Column::More(Box::new(entry))),
        ..Forms::new(
            "the name of a column, or a table such as `{ column = \"T\", sigma = 0.2 }`, one for \
             each variable"
        )
    }
);

in_forms!(
    DelayEntry,
    Forms::<_> {
        number: Some(DelayEntry::Seconds),
        text: Some(DelayEntry::Parameter),
        ..Forms::new("a number of seconds or the name of a parameter")
    }
);

impl<'de> Deserialize<'de> for SegmentsEntry {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<SegmentsEntry, D::Error> {
        reader.deserialize_any(SegmentsVisitor)
    }
}

struct SegmentsVisitor;

impl<'de> Visitor<'de> for SegmentsVisitor {
    type Value = SegmentsEntry;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("\"auto\", or the times of the cuts in seconds, such as [3600, 7200]")
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<SegmentsEntry, E> {
        match word {
            "auto" => Ok(SegmentsEntry::Auto),
            _ => Err(E::invalid_value(Unexpected::Str(word), &self)),
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<SegmentsEntry, A::Error> {
        let mut times = Vec::new();
        while let Some(time) = list.next_element()? {
            times.push(time);
        }
        Ok(SegmentsEntry::Times(times))
    }
}

in_forms!(
    SigmaEntry,
    Forms::<_> {
        number: Some(SigmaEntry::Number),
        text: Some(SigmaEntry::Words),
        ..Forms::new("a number, the name of a column, a formula, or \"estimate\"")
    }
);

in_forms!(
    NoiseEntry,
    Forms::<_, NoiseTable> {
        number: Some(NoiseEntry::Number),
        text: Some(NoiseEntry::Words),
        table: Some(NoiseEntry::More),
        ..Forms::new("a number, \"estimate\", or a range, `{ min = 1e-4, max = 1e-1 }`")
    }
);

in_forms!(
    OneOrMany,
    Forms::<_, FitnessEntry> {
        text: Some(OneOrMany::One),
        list: Some(OneOrMany::Many),
        table: Some(OneOrMany::Set),
        ..Forms::new("the name of a fitness function, such as \"huber\", or a list of names")
    }
);

in_forms!(
    OperatorEntry,
    Forms::<_, FitnessEntry> {
        number: Some(OperatorEntry::Frequency),
        text: Some(OperatorEntry::Name),
        table: Some(OperatorEntry::Set),
        ..Forms::new("an operator, such as \"sbx\" or { name = \"sbx\", eta = 5 }, or a number")
    }
);

in_forms!(
    BandsEntry,
    Forms::<_> {
        truth: Some(BandsEntry::Requested),
        list: Some(BandsEntry::Variables),
        ..Forms::new("`true`, `false`, or a list of variables")
    }
);

in_forms!(
    CovarianceEntry,
    Forms::<_, CovarianceTable> {
        text: Some(CovarianceEntry::Estimated),
        matrix: Some(CovarianceEntry::Given),
        table: Some(CovarianceEntry::More),
        ..Forms::new(
            "a matrix, `[[1e-4, 2e-5], [2e-5, 4e-4]]`, \"estimate\", or a table such as `{ outputs = \
             [\"a\", \"b\"], correlation = [[1, 0.5], [0.5, 1]] }`",
        )
    }
);

in_forms!(
    MatrixEntry,
    Forms::<_> {
        text: Some(MatrixEntry::Estimated),
        matrix: Some(MatrixEntry::Given),
        ..Forms::new("a matrix, `[[1e-4, 2e-5], [2e-5, 4e-4]]`, or \"estimate\"")
    }
);

in_forms!(
    ScaleEntry,
    Forms::<_, ScaleTable> {
        text: Some(ScaleEntry::Words),
        table: Some(ScaleEntry::More),
        ..Forms::new(
            "\"estimate\", a name that outputs share, or a table such as `{ name = \"s1\", sign = \
             \"any\" }`; what is known is a `factor` of the data",
        )
    }
);

in_forms!(
    OffsetEntry,
    Forms::<_> {
        text: Some(OffsetEntry),
        ..Forms::new("\"estimate\", or a name that outputs share")
    }
);

in_forms!(
    LimitEntry,
    Forms::<_> {
        number: Some(LimitEntry::Number),
        text: Some(LimitEntry::Column),
        ..Forms::new("a number, or the name of a column")
    }
);

in_forms!(
    PriorEntry,
    Forms::<_, PriorNumbers> {
        text: Some(PriorEntry::Name),
        table: Some(PriorEntry::Numbers),
        ..Forms::new("\"uniform\", `{ mean = 2, sd = 0.1 }` or `{ median = 2, factor = 1.5 }`")
    }
);

in_forms!(
    WeightEntry,
    Forms::<_> {
        number: Some(WeightEntry),
        ..Forms::new(
            "a number, the `weight` of the whole series; for points of different precision, name \
             a column of standard deviations, `sigma = \"s\"`",
        )
    }
);

in_forms!(
    SetEntry,
    Forms {
        text: Some(|file: String| SetEntry { file: Some(file.into()), ..SetEntry::default() }),
        table: Some(|values: IndexMap<String, ValueEntry>| SetEntry {
            values,
            ..SetEntry::default()
        }),
        ..Forms::new("a table of parameters with their values, or the name of a file `.ssv`")
    }
);
