//! The report that build servers read.

use super::verdict::{Judged, Judgement};
use super::verdict::{Tested, Verdict};
use crate::script::language::expectation::shown;
use maud::Render;
use std::fmt::Write as _;

/// The report in the format of JUnit: a case for each script, and one for each statement of a script
/// with an embedded result that differs.
pub(super) fn report(results: &[Tested]) -> String {
    let mut report = Junit::default();
    for Tested { path, verdict, seconds } in results {
        let case = Case { class: "gapi", name: &path.to_string_lossy(), seconds: Some(*seconds) };
        match verdict {
            Verdict::Agrees(_) | Verdict::Accepted { .. } => report.case(&case, None),
            Verdict::Skipped => report.skipped(&case, "its settings say that it is not a test"),
            Verdict::Unrecorded(_) => report.failure(&case, "nothing is recorded"),
            Verdict::Failed(message) => report.failure(&case, message),
            Verdict::Differs(lines, _) => report.failure(&case, &shown(lines, false)),
            Verdict::DiffersFromEmbedded(lines, judged) => {
                report.failure(&case, &shown(lines, false));
                for (at, one) in judged.iter().enumerate() {
                    report.statement(case.name, at + 1, one);
                }
            }
        }
    }
    report.seconds = results.iter().map(|tested| tested.seconds).sum();
    report.finish()
}

/// What identifies a case.
struct Case<'a> {
    class: &'a str,
    name: &'a str,
    /// How long it took; statements have no time of their own.
    seconds: Option<f64>,
}

#[derive(Default)]
struct Junit {
    cases: String,
    tests: usize,
    failures: usize,
    skipped: usize,
    seconds: f64,
}

impl Junit {
    fn case(&mut self, case: &Case<'_>, outcome: Option<String>) {
        self.tests += 1;
        let (class, name) = (escaped(case.class), escaped(case.name));
        let time = case.seconds.map_or(String::new(), |seconds| format!(" time=\"{seconds:.3}\""));
        let head = format!("  <testcase classname=\"{class}\" name=\"{name}\"{time}");
        let _ = match outcome {
            None => writeln!(self.cases, "{head}/>"),
            Some(outcome) => writeln!(self.cases, "{head}>\n    {outcome}\n  </testcase>"),
        };
    }

    fn failure(&mut self, case: &Case<'_>, text: &str) {
        self.failures += 1;
        self.case(case, Some(format!("<failure>{}</failure>", escaped(text))));
    }

    fn skipped(&mut self, case: &Case<'_>, why: &str) {
        self.skipped += 1;
        self.case(case, Some(format!("<skipped message=\"{}\"/>", escaped(why))));
    }

    fn statement(&mut self, script: &str, number: usize, judged: &Judged) {
        let first = judged.statement.lines().next().unwrap_or("");
        let case = Case { class: script, name: &format!("{number}: {first}"), seconds: None };
        match judged.judgement {
            Judgement::Agrees => self.case(&case, None),
            Judgement::Differs => self.failure(&case, "the output differs"),
            Judgement::Unsupported(code) => self.skipped(&case, code.slug),
        }
    }

    fn finish(self) -> String {
        let Junit { cases, tests, failures, skipped, seconds } = self;
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"gapi\" tests=\"{tests}\" \
             failures=\"{failures}\" skipped=\"{skipped}\" time=\"{seconds:.3}\">\n{cases}</testsuite>\n"
        )
    }
}

/// Text as XML holds it; control characters are not allowed in it.
fn escaped(text: &str) -> String {
    let allowed = |c: char| if c.is_control() && !matches!(c, '\n' | '\t') { '?' } else { c };
    text.chars().map(allowed).collect::<String>().render().into_string()
}
