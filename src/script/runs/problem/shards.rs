//! A study divided into shards: each solves the problem and leaves its parts of what follows in a file;
//! the merged run takes them from there.

use super::RunOptions;
use crate::Session;
use crate::access::policy::Grant;
use crate::diag::Fault;
use crate::identify::problem::{
    Journal, Origins, Parts, Run, Shard, ShardFile, decode, listed, missing_shards, without_times,
};
use crate::registry::BAD_OPTION;
use crate::{bail, fault};
use std::path::{Path, PathBuf};

/// The file with the parts of a shard.
const FILE: &str = "shard.part";

/// How a study is divided.
#[derive(Debug, Clone, Default)]
pub enum Division {
    /// Not at all.
    #[default]
    Whole,
    /// This is one shard.
    Shard(Shard),
    /// The parts of all shards are known.
    Merged(Vec<ShardFile>),
}

impl Division {
    /// The parts that the run has to compute.
    pub(super) fn parts(&self) -> Parts {
        match self {
            Division::Whole => Parts::default(),
            Division::Shard(shard) => Parts::of(*shard),
            Division::Merged(files) => Parts::merged(files),
        }
    }

    /// Whether nothing is divided.
    pub(super) fn is_whole(&self) -> bool {
        matches!(self, Division::Whole)
    }

    /// The journal of the search, where it is known.
    pub(super) fn journal(&self) -> Option<&[u8]> {
        match self {
            Division::Merged(files) => files.first().map(|file| file.journal.as_slice()),
            Division::Whole | Division::Shard(_) => None,
        }
    }
}

/// Writes the parts of a shard beside its results; `journal` is the file of the search.
pub(super) fn keep(
    session: &mut Session,
    run: &Run,
    (problem, journal, folder): (&Path, &Path, &Path),
    (origins, options): (&Origins, &RunOptions),
) -> Result<(), Fault> {
    let Division::Shard(shard) = options.division else { return Ok(()) };
    let problem = problem.to_string_lossy();
    let mut file = ShardFile::new(&run.evaluation.parts, shard, origins, &problem);
    file.requested = requested(options);
    // How long it took differs between equal runs.
    file.journal = without_times(&session.world.read_bytes(journal)?);
    session.world.write_safely(&folder.join(FILE), &file.to_bytes())
}

/// What is asked for beyond the fit.
type Requested = ([bool; 4], Option<String>, usize, Option<u64>, Option<usize>);

fn requested(options: &RunOptions) -> Vec<u8> {
    let RunOptions { profile, design, bootstrap, posterior, .. } = *options;
    let RunOptions { sensitivity, samples, evaluations, searches, .. } = options;
    let parts = [profile, design, bootstrap, posterior];
    let all: Requested = (parts, sensitivity.clone(), *samples, *evaluations, *searches);
    // Names and numbers only.
    postcard::to_allocvec(&all).unwrap_or_default()
}

/// Reads the shards in these folders: the problem, and the options that merge them.
///
/// # Errors
///
/// `bad-option` where files are missing, damaged, of different studies or of one shard, or where
/// shards are missing.
pub fn read_shards(
    session: &mut Session,
    folders: &[PathBuf],
) -> Result<(PathBuf, RunOptions), Fault> {
    let mut files: Vec<(PathBuf, ShardFile)> = Vec::new();
    for folder in folders {
        let path = folder.join(FILE);
        session.world.grant(Grant::Found(&path));
        if !session.world.exists(&path) {
            bail!(BAD_OPTION, "`{}` contains no shard", folder.display(); help: "give the folders that `gapi identify --shard` has written with `--out`, and wait until all shards have ended");
        }
        let bytes = session.world.read_bytes(&path)?;
        let file = ShardFile::from_bytes(&bytes).ok_or_else(
            || fault!(BAD_OPTION, "`{}` is damaged", path.display(); help: "compute this shard again"),
        )?;
        let file = agreeing(file, &path, &files)?;
        files.push((path, file));
    }
    let Some((_, first)) = files.first() else { bail!(BAD_OPTION, "there are no shards") };
    let problem = PathBuf::from(&first.problem);
    let options: Option<Requested> = postcard::from_bytes(&first.requested).ok();
    let Some((parts, sensitivity, samples, evaluations, searches)) = options else {
        bail!(BAD_OPTION, "the shards were written by another version of gapilib");
    };
    let count = first.shard.count;
    let files: Vec<ShardFile> = files.into_iter().map(|(_, file)| file).collect();
    let missing = missing_shards(&files, count);
    if !missing.is_empty() {
        let names: Vec<String> = missing.iter().map(|number| format!("{number}/{count}")).collect();
        bail!(
            BAD_OPTION,
            "{} of {count} shards {} missing: {}",
            missing.len(),
            if missing.len() == 1 { "is" } else { "are" },
            names.join(", ");
            help: "compute them with the options of the others: `gapi identify {} --shard {} …`", problem.display(), names[0]
        );
    }
    let division = Division::Merged(files);
    let [profile, design, bootstrap, posterior] = parts;
    let requested =
        RunOptions { profile, design, bootstrap, posterior, sensitivity, ..RunOptions::default() };
    Ok((problem, RunOptions { samples, evaluations, searches, division, fresh: true, ..requested }))
}

/// The file, if it belongs to those that were read before.
fn agreeing(
    file: ShardFile,
    path: &Path,
    before: &[(PathBuf, ShardFile)],
) -> Result<ShardFile, Fault> {
    let Some((first_path, first)) = before.first() else { return Ok(file) };
    let changed = file.origins.changed_since(&first.origins);
    let records = |file: &ShardFile| {
        let records = decode(&file.journal).map(Journal::records).unwrap_or_default();
        records.into_iter().map(|record| (record.asked, record.answered)).collect::<Vec<_>>()
    };
    let differs = if !changed.is_empty() {
        Some(format!("these differ: {}", listed(&changed)))
    } else if file.shard.count != first.shard.count {
        Some(format!("{} shards, and {}", first.shard.count, file.shard.count))
    } else if file.requested != first.requested || records(&file) != records(first) {
        Some("the options or the searches differ".to_owned())
    } else {
        None
    };
    if let Some(differs) = differs {
        bail!(
            BAD_OPTION,
            "`{}` and `{}` are not shards of one study: {differs}",
            first_path.display(),
            path.display();
            help: "compute all shards with the same problem, options and program"
        );
    }
    if let Some((twice, _)) = before.iter().find(|(_, known)| known.shard == file.shard) {
        bail!(
            BAD_OPTION,
            "`{}` and `{}` are both shard {}/{}",
            twice.display(),
            path.display(),
            file.shard.number,
            file.shard.count
        );
    }
    Ok(file)
}
