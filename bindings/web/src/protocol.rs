//! Requests and answers.

use crate::{lessons, runs, steps};
use serde::{Deserialize, Serialize};

/// What `gapilib.js` can ask.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum Request {
    /// Runs a script.
    Run(runs::Run),
    /// The page of the steps of the last run that was recorded.
    Steps(steps::Steps),
    /// All lessons.
    Lessons(lessons::Lessons),
    /// Checks the solution of a lesson.
    Check(lessons::Check),
}

/// Answers a request; an error of the request itself is `{"refused": MESSAGE}`.
pub(crate) fn answer(request: &[u8]) -> Vec<u8> {
    let request = serde_json::from_slice::<Request>(request).map_err(text);
    let written = request.and_then(|request| match request {
        Request::Run(run) => json(&runs::answered(run)?),
        Request::Steps(asked) => json(&steps::answered(&asked)?),
        Request::Lessons(_) => json(&lessons::all()),
        Request::Check(check) => json(&lessons::checked(&check)?),
    });
    written.unwrap_or_else(|message| {
        serde_json::json!({ "refused": message }).to_string().into_bytes()
    })
}

fn json(answer: &impl Serialize) -> Result<Vec<u8>, String> {
    serde_json::to_vec(answer).map_err(text)
}

pub(crate) fn text(error: impl ToString) -> String {
    error.to_string()
}
