//! Whether a launcher of MPI jobs (`mpirun`, `mpiexec`, `srun`) has started several processes
//! together, told from the variables that it sets.

/// Set to 0, the process takes no part in a job: for programs that are MPI jobs themselves and call
/// this one.
const SWITCH: &str = "GAPI_MPI";

/// Variables with the size of the job and the rank of the process: Open MPI; MPICH, Intel MPI and
/// Slurm's PMI; Slurm's PMIx, whose size is that of the step.
const VARIABLES: [[&str; 2]; 3] = [
    ["OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"],
    ["PMI_SIZE", "PMI_RANK"],
    ["SLURM_STEP_NUM_TASKS", "PMIX_RANK"],
];

/// The place of this process in a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Launched {
    /// Number of processes, at least 2.
    pub size: usize,
    /// The number of this one, from 0.
    pub rank: usize,
}

/// The job that this process belongs to, if it is not alone.
pub(super) fn launched() -> Option<Launched> {
    of(|name| std::env::var(name).ok())
}

fn of(variable: impl Fn(&str) -> Option<String>) -> Option<Launched> {
    if variable(SWITCH).is_some_and(|value| value.trim() == "0") {
        return None;
    }
    let number = |name: &str| variable(name)?.trim().parse::<usize>().ok();
    let job = VARIABLES
        .iter()
        .find_map(|[size, rank]| Some(Launched { size: number(size)?, rank: number(rank)? }))?;
    (job.size > 1).then_some(job)
}

/// What a process says that cannot take part.
#[cfg(not(feature = "mpi"))]
pub(super) fn refusal(job: Launched) -> String {
    format!(
        "error: an MPI launcher has started {} processes, but this `gapi` is built without MPI, so \
         that each of them would do the same\n  help: build it with `cargo build --release \
         --features mpi`, or start it without the launcher; `gapi identify --shard 1/{}` divides a \
         study without MPI\n  help: if each process is to run alone, set {SWITCH}=0\n",
        job.size, job.size
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(variables: &[(&str, &str)]) -> Option<Launched> {
        of(|name| variables.iter().find(|(own, _)| *own == name).map(|(_, text)| text.to_string()))
    }

    #[test]
    fn launchers_are_known_by_their_variables() {
        let third = Some(Launched { size: 4, rank: 2 });
        assert_eq!(with(&[("OMPI_COMM_WORLD_SIZE", "4"), ("OMPI_COMM_WORLD_RANK", "2")]), third);
        assert_eq!(with(&[("PMI_SIZE", "4"), ("PMI_RANK", "2")]), third);
        assert_eq!(with(&[("SLURM_STEP_NUM_TASKS", "4"), ("PMIX_RANK", "2")]), third);
    }

    #[test]
    fn a_process_that_is_alone_is_no_job() {
        assert_eq!(with(&[]), None);
        assert_eq!(with(&[("OMPI_COMM_WORLD_SIZE", "1"), ("OMPI_COMM_WORLD_RANK", "0")]), None);
        // Slurm sets it in every batch script, where the script itself runs once.
        assert_eq!(with(&[("SLURM_NTASKS", "16"), ("SLURM_PROCID", "0")]), None);
        assert_eq!(with(&[("PMI_SIZE", "many"), ("PMI_RANK", "0")]), None);
        let job = [("PMI_SIZE", "4"), ("PMI_RANK", "2"), ("GAPI_MPI", "0")];
        assert_eq!(with(&job), None, "it was asked to run alone");
    }
}
