//! Parts of values: `a[2].b[1, :]` read and overwritten in place (MLS §10.5, slices of arrays of
//! records included).

use super::errors::TYPE_MISMATCH;
use super::{ArrayValue, Elements, Index, RecordValue, Value, construct};
use crate::diag::{Fault, suggest};
use crate::name::Ident;
use crate::{bail, fault};

/// One step into a value.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// `.name`
    Field(Ident),
    /// `[i, :]`
    Index(Vec<Index>),
}

impl Value {
    /// The part at the end of the path. A field of an array of records is the array of the fields.
    pub fn part(&self, path: &[Step]) -> Result<Value, Fault> {
        let Some((step, rest)) = path.split_first() else { return Ok(self.clone()) };
        match (step, self) {
            (Step::Field(name), Value::Record(record)) => record.field(*name)?.part(rest),
            (
                Step::Field(name),
                Value::Array(ArrayValue { dims, elements: Elements::Record(records), .. }),
            ) => {
                let part = |record: &RecordValue| record.field(*name)?.part(rest);
                let parts = records.iter().map(part).collect::<Result<Vec<_>, Fault>>()?;
                construct::shaped(dims, parts)
            }
            (Step::Index(subscripts), Value::Array(array)) if rest.is_empty() => {
                array.select(subscripts)
            }
            (Step::Index(subscripts), Value::Array(array)) => {
                if let (Elements::Record(records), Some(offset)) =
                    (&array.elements, array.single(subscripts)?)
                {
                    return records[offset].part(rest);
                }
                array.select(subscripts)?.part(rest)
            }
            (step, value) => Err(no_such_part(step, value)),
        }
    }

    /// Overwrites the part at the end of the path; of a slice of records, each one's share.
    pub(crate) fn set_part(&mut self, path: &[Step], new: Value) -> Result<(), Fault> {
        let Some((step, rest)) = path.split_first() else {
            *self = new;
            return Ok(());
        };
        match (step, self) {
            (Step::Field(name), Value::Record(record)) => record.set_part(*name, rest, new),
            (Step::Field(_), Value::Array(array)) => {
                let all = array.selection(&[])?;
                set_each(array, &all.dims, &all.offsets, path, new)
            }
            (Step::Index(subscripts), Value::Array(array)) => {
                if rest.is_empty() {
                    return array.assign(subscripts, new);
                }
                let chosen = array.selection(subscripts)?;
                set_each(array, &chosen.dims, &chosen.offsets, rest, new)
            }
            (step, value) => Err(no_such_part(step, value)),
        }
    }
}

impl ArrayValue {
    /// The offset, if the subscripts name a single element.
    fn single(&self, subscripts: &[Index]) -> Result<Option<usize>, Fault> {
        let positions: Option<Vec<i64>> = subscripts
            .iter()
            .map(|index| match index {
                Index::One(position) => Some(*position),
                _ => None,
            })
            .collect();
        match positions {
            Some(positions) if positions.len() == self.rank() => self.offset(&positions).map(Some),
            _ => Ok(None),
        }
    }
}

impl RecordValue {
    /// The component of this name.
    pub fn field(&self, name: Ident) -> Result<&Value, Fault> {
        self.fields.get(&name).ok_or_else(|| self.no_such_field(name))
    }

    fn part(&self, path: &[Step]) -> Result<Value, Fault> {
        match path.split_first() {
            Some((Step::Field(name), rest)) => self.field(*name)?.part(rest),
            Some((Step::Index(_), _)) => Err(fault!(
                TYPE_MISMATCH,
                "a record of type `{}` has no subscripts",
                self.type_name
            )),
            None => Ok(Value::Record(self.clone())),
        }
    }

    fn set_part(&mut self, name: Ident, rest: &[Step], new: Value) -> Result<(), Fault> {
        let Some(field) = self.fields.get_mut(&name) else { return Err(self.no_such_field(name)) };
        if rest.is_empty() {
            *field = super::cast::like(field, new)?;
            return Ok(());
        }
        field.set_part(rest, new)
    }

    fn no_such_field(&self, name: Ident) -> Fault {
        fault!(TYPE_MISMATCH, "the record `{}` has no component `{name}`", self.type_name).help_if(
            suggest::did_you_mean(name.as_str(), self.fields.keys().map(|field| field.as_str())),
        )
    }
}

/// Gives each of the chosen records its share of `new`, whose leading dimensions are `dims`.
fn set_each(
    array: &mut ArrayValue,
    dims: &[usize],
    offsets: &[usize],
    path: &[Step],
    new: Value,
) -> Result<(), Fault> {
    let type_name = array.type_name();
    let (Elements::Record(records), Some((Step::Field(name), rest))) =
        (&mut array.elements, path.split_first())
    else {
        bail!(TYPE_MISMATCH, "{type_name} has no components")
    };
    if dims.is_empty() {
        return records[offsets[0]].set_part(*name, rest, new);
    }
    let shares = construct::split(dims, new)?;
    for (offset, share) in offsets.iter().zip(shares) {
        records[*offset].set_part(*name, rest, share)?;
    }
    Ok(())
}

fn no_such_part(step: &Step, value: &Value) -> Fault {
    match step {
        Step::Field(name) => {
            fault!(TYPE_MISMATCH, "a value of type {} has no component `{name}`", value.type_name())
        }
        Step::Index(_) => {
            fault!(TYPE_MISMATCH, "a value of type {} has no subscripts", value.type_name())
        }
    }
}
