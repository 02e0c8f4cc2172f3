//! Statements compared with the result that their script embeds, one by one.

use super::verdict::{Judged, Judgement, Tested, Verdict};
use crate::diag::visible;
use crate::script::Exchange;
use crate::script::errors::OUT_OF_REACH;
use crate::script::language::expectation::{Line, agreeing};
use std::fmt::{self, Write as _};

pub(super) fn judged(lines: &[Line], exchanges: &[Exchange]) -> Vec<Judged> {
    let counts: Vec<usize> = exchanges.iter().map(|one| one.printed.lines().count()).collect();
    let judgements = agreeing(lines, &counts).into_iter().zip(exchanges).map(|(agrees, one)| {
        let missing = one.codes.iter().find(|code| OUT_OF_REACH.contains(code));
        let judgement = match (agrees, missing) {
            (true, _) => Judgement::Agrees,
            (false, Some(code)) => Judgement::Unsupported(*code),
            (false, None) => Judgement::Differs,
        };
        Judged { statement: one.input.clone(), judgement }
    });
    judgements.collect()
}

/// How many statements agree, which commands are not there; empty without statements.
pub(super) fn summary(judged: &[Judged]) -> String {
    if judged.is_empty() {
        return String::new();
    }
    let counts = Counts::of(judged.iter().map(|one| one.judgement));
    let mut text = format!("  {counts}\n");
    for one in judged {
        if let Judgement::Unsupported(code) = one.judgement {
            let statement = visible(one.statement.lines().next().unwrap_or(""));
            let _ = writeln!(text, "  unsupported [{}]: {statement}", code.slug);
        }
    }
    text
}

/// Numbers of statements.
#[derive(Default)]
pub(super) struct Counts {
    agreed: usize,
    differ: usize,
    unsupported: usize,
}

impl Counts {
    fn of(judgements: impl Iterator<Item = Judgement>) -> Counts {
        let mut counts = Counts::default();
        for judgement in judgements {
            match judgement {
                Judgement::Agrees => counts.agreed += 1,
                Judgement::Differs => counts.differ += 1,
                Judgement::Unsupported(_) => counts.unsupported += 1,
            }
        }
        counts
    }

    /// Those of all scripts with embedded results.
    pub(super) fn of_all(results: &[Tested]) -> Counts {
        let mut all = Counts::default();
        for tested in results {
            match &tested.verdict {
                Verdict::Agrees(statements) => all.agreed += statements,
                Verdict::DiffersFromEmbedded(_, judged) => {
                    let counts = Counts::of(judged.iter().map(|one| one.judgement));
                    all.agreed += counts.agreed;
                    all.differ += counts.differ;
                    all.unsupported += counts.unsupported;
                }
                _ => {}
            }
        }
        all
    }

    pub(super) fn total(&self) -> usize {
        self.agreed + self.differ + self.unsupported
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Counts { agreed, differ, unsupported } = self;
        write!(
            f,
            "{} statements: {agreed} agreed, {differ} differ, {unsupported} unsupported",
            self.total()
        )
    }
}
