//! Checks a learner's script: runs it in memory, as it is and with other values, and asks what must
//! hold.

use super::shipped::{Check, Claim, Lesson};
use super::variant;
use crate::value::Value;
use crate::value::show::{Style, show};
use crate::world::MemoryWorld;
use crate::{Echo, Options, Reporting, Session, Strictness};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// How often a run in memory asks whether to stop before it is considered endless: the longest
/// solution, that of lesson 14, asks 1.0e5 times.
const PATIENCE: u64 = 20_000_000;

/// What the check of a lesson has found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// All checks hold.
    Passed,
    /// Something does not hold; the text says what, and in which direction to think.
    NotYet(String),
    /// The user has stopped the check.
    Stopped,
}

/// Checks the learner's script, whose companions lie beside it.
pub fn check(lesson: &Lesson, text: &str, companions: &[(String, String)]) -> Verdict {
    check_until(&Arc::default(), lesson, text, companions)
}

/// The same until `stop` is set.
pub fn check_until(
    stop: &Arc<AtomicBool>,
    lesson: &Lesson,
    text: &str,
    companions: &[(String, String)],
) -> Verdict {
    let failed = lesson.checks.iter().find_map(|check| {
        let done = Run { lesson, check, companions, stop }.done(text);
        done.err()
    });
    match failed {
        _ if stop.load(Ordering::Relaxed) => Verdict::Stopped,
        Some(why) => Verdict::NotYet(why),
        None => Verdict::Passed,
    }
}

/// One run of the learner's script.
struct Run<'a> {
    lesson: &'a Lesson,
    check: &'a Check,
    companions: &'a [(String, String)],
    stop: &'a Arc<AtomicBool>,
}

impl Run<'_> {
    /// Runs the script and asks the claims; what to say to the learner where one does not hold.
    fn done(&self, text: &str) -> Result<(), String> {
        let text = match self.check.settings.is_empty() {
            true => self.varied(text)?,
            false => self.varied(&self.shipped_with_settings(text)?)?,
        };
        let mut session = self.ended(&text)?;
        self.check.claims.iter().try_for_each(|claim| asked(&mut session, claim))
    }

    /// The shipped script with the settings of the learner's one.
    fn shipped_with_settings(&self, text: &str) -> Result<String, String> {
        let own = Run { check: &Check::default(), ..*self }.ended(text)?;
        self.check.settings.iter().try_fold(self.lesson.text.clone(), |shipped, name| {
            let value = own.variable(name).map(|value| show(value, Style::Dymola));
            let value = value.ok_or_else(|| lacking(&format!("it has no `{name}`")))?;
            variant::assigned(&shipped, name, &value)
                .ok_or_else(|| lacking(&format!("the lesson has no `{name} := ...`")))
        })
    }

    /// The session of the script when it has ended, and what the check prepares in it.
    fn ended(&self, text: &str) -> Result<Session, String> {
        let world = self.world(text);
        let streams = world.streams();
        let reporting = match self.lesson.report {
            Some(_) => Reporting::Usual,
            None => Reporting::Off,
        };
        let options = Options {
            echo: Echo::Nothing,
            strictness: Strictness::Strict,
            quiet: true,
            reporting,
            ..Options::default()
        };
        let mut session = Session::new(Box::new(world)).with_options(options);
        let status = session.run_file(Path::new(&self.lesson.file));
        if status.interrupted {
            return Err(format!("The script does not end{}.", self.circumstances()));
        }
        if status.code != 0 {
            let error = streams.errors();
            return Err(format!(
                "The script ends with an error{}:\n\n{}",
                self.circumstances(),
                error.trim_end()
            ));
        }
        if session.run_text("check", &self.check.prepare).code != 0 {
            return Err(lacking(&streams.errors()));
        }
        Ok(session)
    }

    /// The script with the values of this check.
    fn varied(&self, text: &str) -> Result<String, String> {
        let give = |text: String, (name, value): (&String, &String)| {
            variant::assigned(&text, name, value).ok_or_else(|| {
                format!(
                    "The check gives `{name}` other values, but the script has no line \
                     `{name} := ...` any more. Write it again, or start the lesson again."
                )
            })
        };
        self.check.with.iter().try_fold(text.to_owned(), give)
    }

    fn world(&self, text: &str) -> MemoryWorld {
        let world = MemoryWorld::new().interrupted_after(PATIENCE).stopped_by(self.stop);
        let world = world.with_file(&self.lesson.file, text);
        let own = self.companions.iter().map(|(name, text)| (name, text));
        own.chain(&self.check.files).fold(world, |world, (name, text)| world.with_file(name, text))
    }

    /// With which values the script ran, where they are not the learner's.
    fn circumstances(&self) -> String {
        let values: Vec<String> =
            self.check.with.iter().map(|(name, value)| format!("{name} := {value}")).collect();
        match (values.is_empty(), self.check.files.is_empty()) {
            (true, true) => String::new(),
            (true, false) => " when the check gives it another file".to_owned(),
            (false, _) => format!(" when the check sets {}", values.join(", ")),
        }
    }
}

/// Asks one claim.
fn asked(session: &mut Session, claim: &Claim) -> Result<(), String> {
    match value(session, &claim.holds)? {
        Value::Boolean(true) => Ok(()),
        _ => Err(filled(session, &claim.otherwise)?),
    }
}

fn value(session: &mut Session, expression: &str) -> Result<Value, String> {
    session.value_of("check", expression).map_err(|diagnostic| lacking(&diagnostic.message))
}

/// The text with the values of the expressions in braces.
fn filled(session: &mut Session, text: &str) -> Result<String, String> {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, (expression, after))) =
        rest.split_once('{').and_then(|(before, rest)| Some((before, rest.split_once('}')?)))
    {
        out.push_str(before);
        let shown = match value(session, expression)? {
            Value::Real(_) => rounded(session, expression)?,
            value => show(&value, Style::Dymola).trim_matches('"').to_owned(),
        };
        out.push_str(&shown);
        rest = after;
    }
    out.push_str(rest);
    Ok(out)
}

/// The value of an expression in four digits.
fn rounded(session: &mut Session, expression: &str) -> Result<String, String> {
    match value(session, &format!("String({expression}, significantDigits = 4)"))? {
        Value::String(text) => Ok(text.to_string()),
        other => Ok(show(&other, Style::Transcript)),
    }
}

/// What to say where the script lacks what the check asks for.
fn lacking(error: &str) -> String {
    format!(
        "The check cannot use the script: {}\n\nKeep the names of functions and variables and \
         their sizes as the lesson has them, or start the lesson again.",
        error.trim_end()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lessons::all;

    #[test]
    fn a_check_that_is_stopped_says_so() {
        let (text, companions) = all()[0].solved();
        assert_eq!(check(&all()[0], &text, &companions), Verdict::Passed);
        let stop = Arc::new(AtomicBool::new(true));
        assert_eq!(check_until(&stop, &all()[0], &text, &companions), Verdict::Stopped);
    }
}
