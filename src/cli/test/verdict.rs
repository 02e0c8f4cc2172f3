//! What came of a script.

use crate::diag::Code;
use crate::script::language::expectation::Line;
use std::path::PathBuf;

/// A statement compared with the result that its script embeds.
#[derive(Debug, PartialEq)]
pub(super) struct Judged {
    pub statement: String,
    pub judgement: Judgement,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Judgement {
    Agrees,
    Differs,
    /// It differs because of something that is not there.
    Unsupported(Code),
}

/// How a script did.
#[derive(Debug, PartialEq)]
pub(super) enum Verdict {
    /// With this number of statements compared one by one.
    Agrees(usize),
    /// The transcript was written; whether the script ends with an error.
    Accepted {
        is_failing: bool,
    },
    /// Its settings say that it is not a test.
    Skipped,
    /// There is nothing to compare this transcript with.
    Unrecorded(String),
    /// It does not agree with its transcript, which would be the second string.
    Differs(Vec<Line>, String),
    /// It does not agree with the result that it embeds; what each statement did.
    DiffersFromEmbedded(Vec<Line>, Vec<Judged>),
    Failed(String),
}

impl Verdict {
    /// That this transcript was written.
    pub(super) fn accepted(transcript: &str) -> Verdict {
        Verdict::Accepted { is_failing: !transcript.ends_with("[exit code 0]\n") }
    }

    pub(super) fn is_good(&self) -> bool {
        matches!(self, Verdict::Agrees(_) | Verdict::Accepted { .. })
    }
}

/// A script that was tested.
pub(super) struct Tested {
    pub path: PathBuf,
    pub verdict: Verdict,
    /// How long it took.
    pub seconds: f64,
}
