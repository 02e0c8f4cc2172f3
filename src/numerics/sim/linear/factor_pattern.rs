//! Where the nonzeros of a sparse matrix and of its factors are.

/// Where the nonzeros of a matrix and of its factors are.
pub(super) struct Shape<'a> {
    pub rows: &'a [u32],
    pub columns: &'a [u32],
    pub(crate) entry_starts: &'a [u32],
    pub entries: &'a [(u32, u32)],
    pub lower: &'a Rows,
    pub upper: &'a Rows,
    /// Rows with sparse pivots.
    pub(crate) n_sparse: usize,
}

impl Shape<'_> {
    /// Column of the permuted matrix and position in the values of the entries of row i.
    pub(crate) fn row_entries(&self, i: usize) -> &[(u32, u32)] {
        &self.entries[row(self.entry_starts, i)]
    }

    /// Products that row i of the factors takes.
    pub fn products(&self, i: usize) -> usize {
        let of = |(k, _): &(u32, f64)| 1 + self.upper.row(*k as usize).len();
        self.lower.row(i).iter().map(of).sum::<usize>() + self.row_entries(i).len()
    }
}

/// Columns and values by rows. Side by side: rows are short, and to find both in two places costs as
/// much as what is computed with them.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    /// Where every row begins and ends.
    ranges: Vec<(u32, u32)>,
    entries: Vec<(u32, f64)>,
}

impl Rows {
    /// With values of zero.
    pub fn of(columns: impl Iterator<Item = Vec<u32>>) -> Rows {
        let (mut ranges, mut entries) = (Vec::new(), Vec::new());
        for row in columns {
            let begin = entries.len() as u32;
            entries.extend(row.into_iter().map(|column| (column, 0.0)));
            ranges.push((begin, entries.len() as u32));
        }
        Rows { ranges, entries }
    }

    pub fn row(&self, i: usize) -> &[(u32, f64)] {
        &self.entries[self.range(i)]
    }

    /// The places of row i.
    pub fn range(&self, i: usize) -> std::ops::Range<usize> {
        let (begin, end) = self.ranges[i];
        begin as usize..end as usize
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    pub fn row_mut(&mut self, i: usize) -> &mut [(u32, f64)] {
        let (begin, end) = self.ranges[i];
        &mut self.entries[begin as usize..end as usize]
    }
}

/// The places of row i.
pub(super) fn row(starts: &[u32], i: usize) -> std::ops::Range<usize> {
    starts[i] as usize..starts[i + 1] as usize
}
