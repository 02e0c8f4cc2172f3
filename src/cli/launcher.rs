//! Whether a launcher of MPI jobs (`mpirun`, `mpiexec`, `srun`) has started several processes
//! together, recognized by the variables that it sets.

use super::terminal;
use std::process::ExitCode;

/// Set to 0, the process takes no part in a job: for programs that are MPI jobs themselves and call
/// this one.
pub(super) const SWITCH: &str = "GAPI_MPI";

/// Variables with the size of the job and the rank of the process: Open MPI; MPICH, Intel MPI and
/// Slurm's PMI; a step of Slurm, also one that was started without any of them (`--mpi=none`, the
/// setting of many clusters). Batch scripts, which run once, have no variables of a step.
const VARIABLES: [[&str; 2]; 3] = [
    ["OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"],
    ["PMI_SIZE", "PMI_RANK"],
    ["SLURM_STEP_NUM_TASKS", "SLURM_PROCID"],
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

/// Spares Open MPI the search for networks, which takes 0.2 s of 0.26 s, where the launcher says that all
/// ranks are on this machine and the user has not said how messages are to pass. Call it before there
/// are threads.
#[cfg(feature = "mpi")]
pub(super) fn keep_to_this_machine() {
    if passes_memory(|name| std::env::var(name).ok()) {
        #[allow(unsafe_code, reason = "an option of the library, set before threads begin")]
        // SAFETY: no other thread reads the environment, as there is none yet.
        unsafe {
            std::env::set_var(WAY, "ob1");
        }
    }
}

/// Which layer of Open MPI passes messages.
#[cfg(any(feature = "mpi", test))]
const WAY: &str = "OMPI_MCA_pml";

#[cfg(any(feature = "mpi", test))]
fn passes_memory(variable: impl Fn(&str) -> Option<String>) -> bool {
    let size = variable("OMPI_COMM_WORLD_SIZE");
    size.is_some() && size == variable("OMPI_COMM_WORLD_LOCAL_SIZE") && variable(WAY).is_none()
}

/// What the processes have in common that cannot take part in the job.
#[cfg(not(feature = "mpi"))]
const CAUSE: &str = "this `gapi` is built without MPI";
#[cfg(feature = "mpi")]
const CAUSE: &str = "the MPI library of this `gapi` finds one alone";
#[cfg(not(feature = "mpi"))]
const REMEDY: &str = "build it with `cargo build --release --features mpi`, or start it without the \
     launcher";
#[cfg(feature = "mpi")]
const REMEDY: &str = "start it with the launcher of the library that it was built with (`mpirun` of \
     Open MPI or MPICH; `srun` with the `--mpi` that the library asks for), or build it with the \
     library of the launcher";

/// Ends a process that cannot take part; the first one says why.
pub(super) fn refuse(job: Launched) -> ExitCode {
    if job.rank == 0 {
        terminal::eprint(&refusal(job));
    }
    ExitCode::from(2)
}

fn refusal(job: Launched) -> String {
    format!(
        "error: a launcher of parallel jobs has started {} processes, but {CAUSE}, so that each of \
         them would do the same\n  help: {REMEDY}; `gapi identify --shard 1/{}` divides a study \
         without MPI\n  help: if each process is to run alone, set {SWITCH}=0\n",
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
        assert_eq!(with(&[("SLURM_STEP_NUM_TASKS", "4"), ("SLURM_PROCID", "2")]), third);
    }

    #[test]
    fn networks_are_looked_for_where_ranks_are_elsewhere() {
        let of = |variables: &[(&str, &str)]| {
            passes_memory(|name| {
                variables.iter().find(|(own, _)| *own == name).map(|(_, text)| text.to_string())
            })
        };
        let here = [("OMPI_COMM_WORLD_SIZE", "4"), ("OMPI_COMM_WORLD_LOCAL_SIZE", "4")];
        assert!(of(&here));
        assert!(!of(&[here[0], ("OMPI_COMM_WORLD_LOCAL_SIZE", "2")]));
        assert!(!of(&[here[0], here[1], (WAY, "ucx")]), "the user has chosen");
        assert!(!of(&[("PMI_SIZE", "4")]));
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
