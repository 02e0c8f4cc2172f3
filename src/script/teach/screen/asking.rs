//! Prediction on the screen: before a step the question, the answer by keys, then whether it was
//! right, why, and the score.

use super::{Key, Screen};
use crate::teach::explain::explain;
use crate::teach::quiz::{self, Question, Score};
use std::collections::BTreeSet;

/// The questions of a walk.
#[derive(Debug, Clone, Default)]
pub(crate) struct Quiz {
    score: Score,
    /// Generation and step, from 0, of what has been asked: nothing is asked twice.
    asked: BTreeSet<(usize, usize)>,
    asking: Option<Asking>,
}

/// A question before the next step.
#[derive(Debug, Clone)]
struct Asking {
    question: Question,
    answer: String,
    /// What to enter, where the answer was none.
    again: Option<String>,
    /// Whether it was right, and the sentence of the step that was asked about.
    verdict: Option<String>,
}

impl Screen {
    /// Asks before each step that has a question.
    pub fn with_quiz(mut self) -> Screen {
        self.quiz = Some(Quiz::default());
        self
    }

    /// How many answers were right; `None` where nothing is asked.
    pub fn score(&self) -> Option<Score> {
        self.quiz.as_ref().map(|quiz| quiz.score)
    }

    /// After a step forward: asks what it has done, from the step before, if there is a question.
    pub(super) fn ask(&mut self) {
        let Some(quiz) = &mut self.quiz else { return };
        let place = (self.walk.number(), self.walk.progress().0);
        let Some(question) = quiz::question(&self.walk) else { return };
        if !quiz.asked.insert(place) {
            return;
        }
        quiz.asking = Some(Asking { question, answer: String::new(), again: None, verdict: None });
        self.walk.back();
    }

    /// Whether a question is on the screen; if so, the key was part of its answer.
    pub(super) fn is_asked(&mut self, key: Key) -> bool {
        let Some(quiz) = &mut self.quiz else { return false };
        let Some(mut asking) = quiz.asking.take() else { return false };
        let answers = asking.verdict.is_none();
        match key {
            Key::Escape => return true,
            _ if !answers => {
                self.walk.forward();
                return true;
            }
            Key::Enter => match asking.question.judge(&asking.answer) {
                Ok(verdict) => {
                    quiz.score.count(&verdict);
                    self.walk.forward();
                    let reason = explain(&self.walk);
                    self.walk.back();
                    asking.again = None;
                    asking.verdict = Some(format!("{} {reason}", verdict.text));
                }
                Err(again) => {
                    asking.answer.clear();
                    asking.again = Some(again);
                }
            },
            Key::Backspace => {
                asking.answer.pop();
            }
            Key::Char(c) => asking.answer.push(c),
            _ => {}
        }
        quiz.asking = Some(asking);
        true
    }

    /// What is asked, and what became of the answer, in place of the sentence of the step.
    pub(super) fn question(&self) -> Option<String> {
        let asking = self.quiz.as_ref()?.asking.as_ref()?;
        let Asking { question, answer, again, verdict } = asking;
        let answered = match verdict {
            None => {
                format!("{answer}_{}", again.iter().map(|a| format!("\n{a}")).collect::<String>())
            }
            Some(verdict) => format!("{answer}\n{verdict}"),
        };
        Some(format!("{} {answered}", question.text))
    }

    /// The line of keys while something is asked.
    pub(super) fn answer_keys(&self) -> Option<String> {
        let quiz = self.quiz.as_ref()?;
        let keys = match quiz.asking.as_ref()?.verdict {
            None => "type the answer, then Enter; Esc: no answer",
            Some(_) => "press any key to show the step",
        };
        let score = (quiz.score.asked > 0).then(|| format!("   {}", quiz.score));
        Some(format!("{keys}{}", score.unwrap_or_default()))
    }
}
