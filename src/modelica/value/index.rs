//! Subscripts (MLS §10.5): selecting and assigning elements and slices.

use super::array::{element_count, sizes};
use super::errors::{INDEX_OUT_OF_RANGE, SIZE_MISMATCH, TYPE_MISMATCH};
use super::{ArrayValue, Elements, Marks, Value};
use crate::bail;
use crate::diag::Fault;

/// One subscript, counted from 1.
#[derive(Debug, Clone, PartialEq)]
pub enum Index {
    /// A single position: the dimension disappears.
    One(i64),
    /// Several positions, in this order.
    Many(Vec<i64>),
    /// `:`
    All,
}

impl Index {
    /// The subscript that a value stands for: an Integer, a Boolean (`false` is 1, `true` 2), a
    /// literal of an enumeration, or a vector of one of these.
    pub fn from_value(value: Value) -> Result<Index, Fault> {
        Ok(match value {
            Value::Integer(position) => Index::One(position),
            Value::Boolean(position) => Index::One(i64::from(position) + 1),
            Value::Enumeration(position) => Index::One(position.ordinal),
            Value::Array(ArrayValue { dims, elements, .. }) if dims.len() == 1 => match elements {
                Elements::Integer(positions) => Index::Many(positions),
                Elements::Boolean(positions) => {
                    Index::Many(positions.into_iter().map(|p| i64::from(p) + 1).collect())
                }
                Elements::Enumeration(positions) => {
                    Index::Many(positions.into_iter().map(|p| p.ordinal).collect())
                }
                Elements::Real(positions) if positions.is_empty() => Index::Many(Vec::new()),
                other => bail!(
                    TYPE_MISMATCH,
                    "a subscript must be an Integer, not a {}", other.type_name();
                    help: "use `integer(x)` for the largest Integer not above `x`"
                ),
            },
            other => bail!(
                TYPE_MISMATCH,
                "a subscript must be an Integer, not a {}", other.type_name();
                help: "use `integer(x)` for the largest Integer not above `x`"
            ),
        })
    }

    fn count(&self, size: usize) -> usize {
        match self {
            Index::One(_) => 1,
            Index::Many(positions) => positions.len(),
            Index::All => size,
        }
    }
}

impl ArrayValue {
    /// The offset, counted from 0, of the element with these subscripts, counted from 1; as many
    /// as dimensions.
    pub fn offset(&self, subscripts: &[i64]) -> Result<usize, Fault> {
        if subscripts.len() != self.dims.len() {
            return Err(self.too_many(subscripts.len()));
        }
        let mut offset = 0;
        for (dimension, (position, size)) in subscripts.iter().zip(&self.dims).enumerate() {
            offset = offset * size + self.position(*position, dimension)?;
        }
        Ok(offset)
    }

    /// The element or slice that the subscripts name; dimensions without a subscript are taken
    /// whole.
    pub fn select(&self, subscripts: &[Index]) -> Result<Value, Fault> {
        let selection = self.selection(subscripts)?;
        if selection.dims.is_empty() {
            return Ok(self.elements.get(selection.offsets[0]));
        }
        let (_, size) = self.rows();
        let marks = match selection.dims.last() {
            Some(last) if *last == size => self.marks.selected(&selection.offsets, size),
            _ => Marks::default(),
        };
        let elements = self.elements.gathered(selection.offsets.into_iter());
        Ok(Value::Array(ArrayValue { dims: selection.dims, elements, marks }))
    }

    /// Overwrites the element or slice that the subscripts name; the value's sizes must be those
    /// of the slice.
    pub fn assign(&mut self, subscripts: &[Index], value: Value) -> Result<(), Fault> {
        let selection = self.selection(subscripts)?;
        match value {
            Value::Array(source) => {
                if source.dims != selection.dims {
                    bail!(
                        SIZE_MISMATCH,
                        "cannot assign an array with the sizes {} to {}",
                        sizes(&source.dims),
                        match selection.dims.is_empty() {
                            true => "a single element".to_owned(),
                            false => format!("a slice with the sizes {}", sizes(&selection.dims)),
                        }
                    );
                }
                self.elements.scatter(&selection.offsets, source.elements)?;
                self.marks.assign(self.rows(), &selection.offsets, &source.marks);
                Ok(())
            }
            scalar if selection.dims.is_empty() => {
                self.unmark(selection.offsets[0]);
                self.elements.set(selection.offsets[0], scalar)
            }
            scalar => bail!(
                SIZE_MISMATCH,
                "cannot assign a single {} to a slice with the sizes {}",
                scalar.type_name(), sizes(&selection.dims);
                help: "use `fill(x, n)` for an array with equal elements"
            ),
        }
    }

    /// Which elements the subscripts name, and the sizes of what they form.
    pub(super) fn selection(&self, subscripts: &[Index]) -> Result<Selection, Fault> {
        if subscripts.len() > self.dims.len() {
            return Err(self.too_many(subscripts.len()));
        }
        let mut dims = Vec::new();
        let mut offsets = vec![0usize];
        for (dimension, size) in self.dims.iter().copied().enumerate() {
            let index = subscripts.get(dimension).unwrap_or(&Index::All);
            let count = index.count(size);
            if !matches!(index, Index::One(_)) {
                dims.push(count);
            }
            element_count(&[offsets.len(), count])?;
            let positions = self.positions(index, dimension)?;
            offsets = offsets
                .iter()
                .flat_map(|offset| positions.iter().map(move |position| offset * size + position))
                .collect();
        }
        Ok(Selection { dims, offsets })
    }

    fn positions(&self, index: &Index, dimension: usize) -> Result<Vec<usize>, Fault> {
        match index {
            Index::One(position) => Ok(vec![self.position(*position, dimension)?]),
            Index::Many(positions) => {
                positions.iter().map(|position| self.position(*position, dimension)).collect()
            }
            Index::All => Ok((0..self.dims[dimension]).collect()),
        }
    }

    fn position(&self, position: i64, dimension: usize) -> Result<usize, Fault> {
        let size = self.dims[dimension];
        match usize::try_from(position) {
            Ok(found) if (1..=size).contains(&found) => Ok(found - 1),
            _ if self.dims.len() == 1 => {
                bail!(INDEX_OUT_OF_RANGE, "the subscript {position} is outside 1:{size}")
            }
            _ => bail!(
                INDEX_OUT_OF_RANGE,
                "the subscript {position} is outside 1:{size}, the range of dimension {} of {}",
                dimension + 1,
                self.type_name()
            ),
        }
    }

    fn too_many(&self, given: usize) -> Fault {
        Fault::new(
            INDEX_OUT_OF_RANGE,
            format!("{given} subscripts for {} with {} dimensions", self.type_name(), self.rank()),
        )
    }
}

/// Elements named by subscripts.
pub(super) struct Selection {
    /// Sizes of the slice; empty for a single element.
    pub(super) dims: Vec<usize>,
    /// Offsets of its elements, row-major.
    pub(super) offsets: Vec<usize>,
}
