//! Columns of words that name values, such as the literals of an enumeration.

use super::errors::BAD_TABLE;
use super::matrix::{About, Column, MatFile, missing};
use super::words::Words;
use crate::diag::Fault;
use crate::fault;

impl MatFile {
    /// Whether there is a column of this name, of numbers or of words.
    pub fn has_column(&self, name: &str) -> bool {
        let own = self.own_name(name).unwrap_or(name);
        self.words.contains_key(own) || self.column(name).is_ok()
    }

    /// A column in which values have these names: each cell is a name, also with what comes before its last
    /// point, as in `Mode.on`, or a number.
    ///
    /// # Errors
    /// As [`MatFile::column`]; cells with other words.
    pub fn named_values(&self, name: &str, known: &[(f64, String)]) -> Result<Column, Fault> {
        let own = self.own_name(name)?;
        let Some(Words { cells, lines }) = self.words.get(own) else { return self.column(name) };
        let value = |cell: &str| {
            let bare = cell.trim_matches(['\'', '"']);
            let last = bare.rsplit('.').next().unwrap_or(bare);
            let named = known.iter().find(|(_, literal)| *literal == bare);
            let named = named.or_else(|| known.iter().find(|(_, literal)| *literal == last));
            named.map(|(value, _)| *value).or_else(|| bare.parse().ok())
        };
        let rows_before = self.rows_before;
        let about = About { lines: lines.clone(), rows_before, ..About::default() };
        let mut column = Column { values: Vec::with_capacity(cells.len()), about, missing: None };
        for (row, cell) in cells.iter().enumerate() {
            let found = cell.as_ref().map_or(Some(f64::NAN), |cell| value(cell));
            let Some(found) = found else {
                let (cell, place) = (cell.as_deref().unwrap_or_default(), column.place(row));
                let names: Vec<&str> = known.iter().map(|(_, name)| name.as_str()).collect();
                let fault =
                    fault!(BAD_TABLE, "{place}: `{cell}` in `{own}` is not one of its values");
                return Err(self.located(fault.help(format!("write {}", names.join(", ")))));
            };
            column.values.push(found);
        }
        column.missing = missing(name, &column.values, rows_before);
        Ok(column)
    }
}

#[cfg(test)]
mod tests {
    use crate::mat::table::read_text;

    #[test]
    fn literals_of_enumerations_are_values() {
        let known = [(1.0, "off".to_owned()), (2.0, "on".to_owned()), (4.0, "max".to_owned())];
        let text = "t,a,b,c,d\n0,Mode.on,on,2,off\n1,P.Mode.max,off,1,on\n2,,2,4,slow\n";
        let file = read_text(text.as_bytes(), false).unwrap();
        let values = |name: &str| file.named_values(name, &known).unwrap().values;
        assert_eq!(values("a")[..2], [2.0, 4.0]);
        assert!(values("a")[2].is_nan());
        assert_eq!(values("b"), [2.0, 1.0, 2.0]);
        assert_eq!(values("c"), [2.0, 1.0, 4.0]);
        let wrong = file.named_values("d", &known).unwrap_err();
        assert_eq!(wrong.message, "line 4: `slow` in `d` is not one of its values");
        assert!(file.has_column("a") && file.has_column("c") && !file.has_column("e"));
        let part = file.rows(1..3, 3).named_values("b", &known).unwrap();
        assert_eq!((part.values.as_slice(), part.place(0)), (&[1.0, 2.0][..], "line 3".to_owned()));
    }
}
