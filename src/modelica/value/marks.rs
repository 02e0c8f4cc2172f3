//! Marks: what a host knows the rows of an array by. They pass on with rows that are selected,
//! assigned or put together as a whole, and everything else makes rows without marks.

use std::sync::Arc;

/// A mark for each row of an array, which are its vectors along the last dimension; no part of the
/// value, so that all marks are equal.
#[derive(Debug, Clone, Default)]
pub struct Marks(Option<Arc<Vec<u64>>>);

/// A row without a mark.
const NONE: u64 = 0;

impl PartialEq for Marks {
    fn eq(&self, _: &Marks) -> bool {
        true
    }
}

impl Marks {
    /// Rows with the numbers from `first` on, which is at least 1.
    pub fn from(first: u64, rows: usize) -> Marks {
        Marks(Some(Arc::new((first..).take(rows).collect())))
    }

    /// The mark of a row, counted from 0.
    pub fn of(&self, row: usize) -> Option<u64> {
        self.0.as_ref()?.get(row).copied().filter(|mark| *mark != NONE)
    }

    /// Those of the rows of several arrays, `count` of each, one after the other.
    pub(super) fn joined<'a>(parts: impl Iterator<Item = (&'a Marks, usize)> + Clone) -> Marks {
        if parts.clone().all(|(marks, _)| marks.0.is_none()) {
            return Marks::default();
        }
        let own = |(marks, count): (&'a Marks, usize)| {
            (0..count).map(|row| marks.of(row).unwrap_or(NONE)).collect::<Vec<u64>>()
        };
        Marks(Some(Arc::new(parts.flat_map(own).collect())))
    }

    /// Those of the elements at `offsets` of an array with rows of `size` elements, which form rows
    /// of `size` elements as well.
    pub(super) fn selected(&self, offsets: &[usize], size: usize) -> Marks {
        if self.0.is_none() {
            return Marks::default();
        }
        let own = |row: &[usize]| whole(row, size).and_then(|row| self.of(row)).unwrap_or(NONE);
        Marks(Some(Arc::new(offsets.chunks(size.max(1)).map(own).collect())))
    }

    /// The elements at `offsets` of an array with `rows` rows of `size` elements are overwritten
    /// with rows that have these marks.
    pub(super) fn assign(&mut self, (rows, size): (usize, usize), offsets: &[usize], new: &Marks) {
        if self.0.is_none() && new.0.is_none() {
            return;
        }
        let mut own: Vec<u64> = (0..rows).map(|row| self.of(row).unwrap_or(NONE)).collect();
        for (k, row) in offsets.chunks(size.max(1)).enumerate() {
            row.iter().for_each(|offset| own[offset / size.max(1)] = NONE);
            if let Some(row) = whole(row, size) {
                own[row] = new.of(k).unwrap_or(NONE);
            }
        }
        self.0 = own.iter().any(|mark| *mark != NONE).then(|| Arc::new(own));
    }
}

/// The row of an array that these offsets name, if they name a whole one.
fn whole(offsets: &[usize], size: usize) -> Option<usize> {
    let first = *offsets.first()?;
    let is_whole = offsets.len() == size && first % size == 0;
    (is_whole && offsets.windows(2).all(|pair| pair[1] == pair[0] + 1)).then(|| first / size)
}

#[cfg(test)]
mod tests {
    use super::super::{ArrayValue, Index, Value, construct};
    use super::*;

    /// A matrix of three columns whose rows have marks from `first` on.
    fn marked(first: u64, rows: usize) -> ArrayValue {
        let elements = (0..3 * rows).map(|at| at as f64).collect();
        ArrayValue { marks: Marks::from(first, rows), ..ArrayValue::matrix(rows, 3, elements) }
    }

    fn marks(value: &Value) -> Vec<Option<u64>> {
        let Value::Array(array) = value else { panic!("an array") };
        (0..array.rows().0).map(|row| array.marks.of(row)).collect()
    }

    fn selected(array: &ArrayValue, subscripts: [Index; 2]) -> Vec<Option<u64>> {
        marks(&array.select(&subscripts).unwrap())
    }

    #[test]
    fn whole_rows_keep_their_marks() {
        let array = marked(7, 4);
        assert_eq!(selected(&array, [Index::One(2), Index::All]), [Some(8)]);
        assert_eq!(selected(&array, [Index::Many(vec![4, 1]), Index::All]), [Some(10), Some(7)]);
        assert_eq!(selected(&array, [Index::One(1), Index::Many(vec![1, 2, 3])]), [Some(7)]);
        for columns in [vec![1, 2], vec![3, 2, 1], vec![1, 1, 2]] {
            let own = selected(&array, [Index::One(1), Index::Many(columns.clone())]);
            assert_eq!(own, [None], "{columns:?}");
        }
        assert_eq!(selected(&array, [Index::All, Index::One(1)]), [None], "a column");
    }

    #[test]
    fn rows_that_are_put_together_keep_their_marks() {
        let (first, other) = (Value::Array(marked(1, 2)), Value::Array(marked(9, 1)));
        let plain = Value::Array(ArrayValue::matrix(1, 3, vec![0.0; 3]));
        let joined = construct::matrix(vec![vec![first.clone()], vec![plain], vec![other]]);
        assert_eq!(marks(&joined.unwrap()), [Some(1), Some(2), None, Some(9)]);
        let Value::Array(array) = &first else { panic!("an array") };
        let row = |at| array.select(&[Index::One(at), Index::All]).unwrap();
        assert_eq!(marks(&construct::array(vec![row(2), row(1)]).unwrap()), [Some(2), Some(1)]);
        let wide = construct::cat(2, vec![first.clone(), first]).unwrap();
        assert_eq!(marks(&wide), [None, None], "other rows");
    }

    #[test]
    fn what_is_assigned_brings_its_mark_and_takes_that_of_what_was_there() {
        let mut array = marked(1, 3);
        let new = marked(5, 1).select(&[Index::One(1), Index::All]).unwrap();
        array.assign(&[Index::One(2), Index::All], new).unwrap();
        array.assign(&[Index::One(3), Index::One(1)], Value::Real(0.5)).unwrap();
        assert_eq!(marks(&Value::Array(array.clone())), [Some(1), Some(5), None]);
        array.unmark(1);
        assert_eq!(marks(&Value::Array(array)), [None, Some(5), None]);
    }
}
