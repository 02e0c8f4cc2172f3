//! The steps from clocked operators to equations at events, one after the other.

use crate::diag::Diagnostic;
use crate::lower::builder::Builder;

impl Builder<'_> {
    /// Makes equations at events of all that is clocked.
    pub(in crate::lower) fn partition_clocks(&mut self) -> Result<(), Diagnostic> {
        if self.clocks.is_empty() {
            return Ok(());
        }
        self.add_state_machines()?;
        let made = std::mem::take(&mut self.clocks.equations);
        self.dae.equations.extend(made);
        let mut partitions = self.clock_partitions()?;
        self.infer_intervals(&mut partitions)?;
        self.infer_solver_methods(&mut partitions)?;
        self.write_clocked(partitions)
    }
}
