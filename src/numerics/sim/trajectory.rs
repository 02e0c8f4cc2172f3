//! The result of a simulation.

/// Columns of numbers over time. Time does not decrease; an event has two rows of the same time,
/// one before and one after it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trajectory {
    time: Vec<f64>,
    columns: Vec<Vec<f64>>,
    /// Which columns are kept; of the others only the last value is. All where there is nothing.
    kept: Vec<bool>,
}

impl Trajectory {
    /// An empty trajectory with so many columns beside time.
    pub fn new(n_columns: usize) -> Trajectory {
        Trajectory { columns: vec![Vec::new(); n_columns], ..Trajectory::default() }
    }

    /// Removes all rows and keeps the memory.
    pub fn reset(&mut self, n_columns: usize) {
        self.time.clear();
        self.columns.resize_with(n_columns, Vec::new);
        self.columns.iter_mut().for_each(Vec::clear);
    }

    /// Appends a row: `values` are the columns in order.
    ///
    /// # Panics
    /// If the numbers of values and columns differ.
    pub fn push(&mut self, time: f64, values: &[f64]) {
        assert_eq!(values.len(), self.columns.len(), "a row has one value for each column");
        self.time.push(time);
        for (at, (column, value)) in self.columns.iter_mut().zip(values).enumerate() {
            if self.kept.get(at) == Some(&false) {
                column.clear();
            }
            column.push(*value);
        }
    }

    /// Removes the rows after a time.
    pub fn end_at(&mut self, time: f64) {
        let rows = self.time.partition_point(|row| *row <= time);
        self.time.truncate(rows);
        self.columns.iter_mut().for_each(|column| column.truncate(rows));
    }

    /// Puts rows in the place of all there are.
    ///
    /// # Panics
    /// If a column has another length than the time.
    pub fn replace(&mut self, time: Vec<f64>, columns: Vec<Vec<f64>>) {
        let fits = columns.iter().all(|column| column.len() == time.len());
        assert!(fits, "a column has one value for each row");
        (self.time, self.columns) = (time, columns);
    }

    /// An empty trajectory that keeps all values of these columns, and of others the last one.
    pub fn keeping(kept: Vec<bool>) -> Trajectory {
        Trajectory { kept, ..Trajectory::default() }
    }

    /// Takes the values of a column out.
    pub fn take_column(&mut self, column: usize) -> Vec<f64> {
        std::mem::take(&mut self.columns[column])
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Number of columns beside time.
    pub fn n_columns(&self) -> usize {
        self.columns.len()
    }

    /// Times of the rows, seconds.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// All values of a column.
    pub fn column(&self, column: usize) -> &[f64] {
        &self.columns[column]
    }

    /// The value of a column at a time, linear between rows; after the event where there is one;
    /// `None` outside the simulated interval.
    pub fn at(&self, column: usize, time: f64) -> Option<f64> {
        interpolate(&self.time, &self.columns[column], time)
    }
}

/// For ascending abscissas.
fn interpolate(abscissas: &[f64], ordinates: &[f64], x: f64) -> Option<f64> {
    let before = abscissas.partition_point(|a| *a <= x);
    let last = before.checked_sub(1)?;
    let (a, fa) = (abscissas[last], ordinates[last]);
    if a == x {
        return Some(fa);
    }
    let (b, fb) = (*abscissas.get(before)?, ordinates[before]);
    Some(fa + (fb - fa) * ((x - a) / (b - a)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sawtooth() -> Trajectory {
        let mut trajectory = Trajectory::new(2);
        for (t, row) in
            [(0.0, [0.0, 4.0]), (1.0, [2.0, 3.0]), (1.0, [-1.0, 3.0]), (2.0, [1.0, 1.0])]
        {
            trajectory.push(t, &row);
        }
        trajectory
    }

    #[test]
    fn values_between_rows_are_linear_and_those_at_events_come_after() {
        let trajectory = sawtooth();
        assert_eq!(trajectory.at(0, 0.5), Some(1.0));
        assert_eq!(trajectory.at(0, 1.0), Some(-1.0));
        assert_eq!(trajectory.at(0, 2.0), Some(1.0));
        assert_eq!(trajectory.at(0, 2.5), None);
        assert_eq!(trajectory.at(0, -0.1), None);
        assert_eq!(trajectory.at(0, f64::NAN), None);
    }

    #[test]
    fn reset_leaves_no_rows() {
        let mut trajectory = sawtooth();
        trajectory.reset(1);
        assert!(trajectory.is_empty());
        assert_eq!(trajectory.n_columns(), 1);
        assert_eq!(trajectory.at(0, 0.0), None);
    }
}
