//! The page of the steps of a run.

use crate::lock;
use crate::runs::Change;
use gapilib::internals::teach::{Trace, page};
use serde::{Deserialize, Serialize};
use std::sync::Mutex;

/// The run that was recorded last, and what it would have been.
static KEPT: Mutex<(Option<Recorded>, Option<Changed>)> = Mutex::new((None, None));

struct Recorded {
    trace: Vec<u8>,
    /// The content of its `result.json`.
    result: Option<String>,
}

struct Changed {
    trace: Vec<u8>,
    change: Change,
}

/// The page is asked for.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Steps {}

/// The page.
#[derive(Serialize)]
pub(crate) struct Page {
    html: String,
}

/// Keeps a trace: of a run, or of what it would have been with a change.
pub(crate) fn keep(trace: Vec<u8>, result: Option<String>, change: Option<Change>) {
    let mut kept = lock(&KEPT);
    match change {
        Some(change) => kept.1 = Some(Changed { trace, change }),
        None => *kept = (Some(Recorded { trace, result }), None),
    }
}

/// Makes the page.
pub(crate) fn answered(_: &Steps) -> Result<Page, String> {
    let kept = lock(&KEPT);
    let Some(run) = &kept.0 else { return Err("no run has been recorded".to_owned()) };
    let trace = Trace::read(&run.trace).map_err(|fault| fault.message)?;
    let changed = kept.1.as_ref().map(|changed| {
        let Change { generation, statement } = changed.change.clone();
        Ok::<_, String>(page::WhatIf {
            trace: Trace::read(&changed.trace).map_err(|fault| fault.message)?,
            generation,
            statement,
        })
    });
    let changed = changed.transpose()?;
    Ok(Page { html: page::page(trace, run.result.as_deref(), changed.as_ref()) })
}
