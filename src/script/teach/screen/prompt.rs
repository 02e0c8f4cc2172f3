//! Questions that a key asks: which generation, which individual, until when.

use super::{Key, Screen, View, inspect};
use crate::ga::has_failed;
use crate::teach::step::Step;
use crate::teach::walk::TraceCursor;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Question {
    Generation,
    Follow,
    Inspect,
    Until,
    WhatIf,
}

/// A question and the answer so far.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Prompt {
    question: Question,
    pub(super) text: String,
}

impl Prompt {
    /// The question that a key asks.
    pub(crate) fn of(key: Key) -> Option<Prompt> {
        let question = match key {
            Key::Char('g') => Question::Generation,
            Key::Char('f') => Question::Follow,
            Key::Char('i') => Question::Inspect,
            Key::Char('u') => Question::Until,
            Key::Char('w') => Question::WhatIf,
            _ => return None,
        };
        Some(Prompt { question, text: String::new() })
    }

    /// The question as it is shown.
    pub(crate) fn shown(&self) -> String {
        let question = match self.question {
            Question::Generation => "go to generation",
            Question::Follow => "follow individual (empty: the best)",
            Question::Inspect => "inspect individual (empty: the best)",
            Question::Until => "until (better, failure, mutation, stop, or a fitness to reach)",
            Question::WhatIf => "what if, from here on (such as F_Mut := 0.5)",
        };
        format!("{question}: {}_", self.text)
    }
}

/// Does what was answered; the text says why not, or is empty.
pub(crate) fn carry_out(screen: &mut Screen, prompt: &Prompt) -> Result<String, String> {
    let text = prompt.text.trim();
    match prompt.question {
        Question::Generation => {
            let of = screen.walk.trace().generations.len();
            let number: usize = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
            match number.checked_sub(1).is_some_and(|number| screen.walk.go_to(number)) {
                true => Ok(String::new()),
                false => Err(format!("the generations are 1 to {of}")),
            }
        }
        Question::Follow => {
            let k = individual(&screen.walk, text)?;
            screen.followed = Some(k);
            Ok(format!("individual {} is followed", k + 1))
        }
        Question::Inspect => {
            let k = individual(&screen.walk, text)?;
            screen.view = View::Individual(k);
            screen.unknown = inspect::must_simulate(screen, k).then_some(k);
            Ok(String::new())
        }
        Question::Until => until(&mut screen.walk, text),
        Question::WhatIf if !text.is_empty() => {
            screen.wish = Some((screen.walk.number() + 1, text.to_owned()));
            Ok(String::new())
        }
        Question::WhatIf if screen.branch.is_some() => {
            screen.view = View::Branches;
            Ok(String::new())
        }
        Question::WhatIf => {
            Err("enter a statement that changes a variable of the script".to_owned())
        }
    }
}

/// The index of the individual that was named, from 0.
fn individual(walk: &TraceCursor, text: &str) -> Result<usize, String> {
    let generation = walk.generation();
    if text.is_empty() {
        let best = generation.best().map(|(k, _)| k);
        return best.ok_or_else(|| "the best individual is unknown".to_owned());
    }
    let number: usize = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    let exists = number >= 1 && number <= generation.len();
    exists
        .then(|| number - 1)
        .ok_or_else(|| format!("the individuals are 1 to {}", generation.len()))
}

fn until(walk: &mut TraceCursor, text: &str) -> Result<String, String> {
    let best =
        |walk: &TraceCursor| walk.generation().best().map_or(f64::INFINITY, |(_, fitness)| fitness);
    let rated = |walk: &TraceCursor| walk.step() == Step::Rate;
    let (here, now) = (walk.number(), best(walk));
    let found = match text {
        "better" => walk.until(|walk| rated(walk) && walk.number() > here && best(walk) < now),
        "failure" => walk
            .until(|walk| walk.step() == Step::Simulate && !walk.generation().failures.is_empty()),
        "mutation" => walk.until(|walk| match walk.step() {
            Step::Mutate(row) => !walk.generation().mutated_genes(row).is_empty(),
            _ => false,
        }),
        "stop" => walk.until(|walk| walk.step() == Step::Stop),
        _ => match text.parse::<f64>() {
            Ok(target) => {
                walk.until(|walk| rated(walk) && !has_failed(best(walk)) && best(walk) <= target)
            }
            Err(_) => return Err(format!("`{text}` is not a condition")),
        },
    };
    if found { Ok(String::new()) } else { Err(format!("`{text}` does not occur from here on")) }
}
