//! The sparsity pattern of a system with shares and forces.

use crate::sim::Pattern;

/// A pattern with k full rows and columns more at a place.
pub fn bordered(inner: &Pattern, at: usize, k: usize) -> Pattern {
    let n = inner.n + k;
    let mut pattern = Pattern { n, column_starts: vec![0], rows: Vec::new() };
    for column in 0..n {
        match column.checked_sub(at) {
            Some(share) if share < k => pattern.rows.extend(0..n),
            _ => {
                let column = if column < at { column } else { column - k };
                let rows = &inner.rows[inner.column(column)];
                let (before, after) = rows.split_at(rows.partition_point(|row| *row < at));
                pattern.rows.extend(before);
                pattern.rows.extend(at..at + k);
                pattern.rows.extend(after.iter().map(|row| row + k));
            }
        }
        pattern.column_starts.push(pattern.rows.len());
    }
    pattern
}
