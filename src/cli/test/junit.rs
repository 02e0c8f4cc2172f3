//! The report that build servers read.

use super::Verdict;
use super::judgement::{Judged, Judgement};
use crate::script::language::expectation::shown;
use maud::Render;
use std::fmt::Write as _;
use std::path::PathBuf;

/// The report in the format of JUnit: a case for each script, and one for each statement of a script
/// with an embedded result that differs.
pub(super) fn report(results: &[(PathBuf, Verdict)]) -> String {
    let mut report = Junit::default();
    for (path, verdict) in results {
        let name = path.to_string_lossy();
        match verdict {
            Verdict::Agrees(_) | Verdict::Accepted => report.case("gapi", &name, None),
            Verdict::Unrecorded => report.failure("gapi", &name, "nothing is recorded"),
            Verdict::Failed(message) => report.failure("gapi", &name, message),
            Verdict::Differs(lines, judged) => {
                report.failure("gapi", &name, &shown(lines, false));
                for (at, one) in judged.iter().enumerate() {
                    report.statement(&name, at + 1, one);
                }
            }
        }
    }
    report.finish()
}

#[derive(Default)]
struct Junit {
    cases: String,
    tests: usize,
    failures: usize,
    skipped: usize,
}

impl Junit {
    fn case(&mut self, class: &str, name: &str, outcome: Option<String>) {
        self.tests += 1;
        let (class, name) = (escaped(class), escaped(name));
        let _ = match outcome {
            None => writeln!(self.cases, "  <testcase classname=\"{class}\" name=\"{name}\"/>"),
            Some(outcome) => writeln!(
                self.cases,
                "  <testcase classname=\"{class}\" name=\"{name}\">\n    {outcome}\n  </testcase>"
            ),
        };
    }

    fn failure(&mut self, class: &str, name: &str, text: &str) {
        self.failures += 1;
        self.case(class, name, Some(format!("<failure>{}</failure>", escaped(text))));
    }

    fn statement(&mut self, script: &str, number: usize, judged: &Judged) {
        let first = judged.statement.lines().next().unwrap_or("");
        let name = format!("{number}: {first}");
        match judged.judgement {
            Judgement::Agrees => self.case(script, &name, None),
            Judgement::Differs => self.failure(script, &name, "the output differs"),
            Judgement::Unsupported(code) => {
                self.skipped += 1;
                self.case(script, &name, Some(format!("<skipped message=\"{}\"/>", code.slug)));
            }
        }
    }

    fn finish(self) -> String {
        let Junit { cases, tests, failures, skipped } = self;
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"gapi\" tests=\"{tests}\" failures=\"{failures}\" skipped=\"{skipped}\">\n{cases}</testsuite>\n"
        )
    }
}

/// Text as XML holds it; control characters cannot stand in it.
fn escaped(text: &str) -> String {
    let allowed = |c: char| if c.is_control() && !matches!(c, '\n' | '\t') { '?' } else { c };
    text.chars().map(allowed).collect::<String>().render().into_string()
}
