//! How near a loop that could not be solved came to a solution.

use super::system::System;
use crate::causalize::Block;
use crate::codegen::code::Step;
use crate::diag::Diagnostic;
use crate::sim::{Failure, SimError, SimErrorKind};

/// More unknowns are counted only.
const MOST_NAMES: usize = 6;

/// The steps of the blocks at the start, or of those after it.
#[derive(Clone, Copy, PartialEq)]
enum When {
    Start,
    Later,
}

impl System {
    /// A failed simulation in the model's words, with what is known of the loop that failed.
    pub fn explain(&self, error: &SimError) -> Diagnostic {
        let said = self.program().explain_with(error, self.external_words(error));
        let diagnostic = self.with_values(said, error);
        let failed = match error.kind {
            SimErrorKind::Evaluation(Failure::Initialization { block })
            | SimErrorKind::Initialization(Failure::Initialization { block }) => {
                Some((block, When::Start))
            }
            SimErrorKind::Evaluation(Failure::Newton { block })
            | SimErrorKind::Initialization(Failure::Newton { block }) => Some((block, When::Later)),
            _ => None,
        };
        match failed {
            Some((block, when)) => self.with_nearest(diagnostic, block, when),
            None => diagnostic,
        }
    }

    /// The same in words that are equal for equal causes: `…` stands for the numbers in them.
    pub fn explain_cause(&self, error: &SimError) -> Diagnostic {
        let said = self.external_words(error).map(without_numbers);
        self.program().explain_with(error, said.as_deref())
    }

    /// What the external function says that has failed with the present values of the parameters.
    fn external_words(&self, error: &SimError) -> Option<&str> {
        let (SimErrorKind::Evaluation(failure) | SimErrorKind::Initialization(failure)) =
            error.kind
        else {
            return None;
        };
        let last = self.registers.calls.failure?;
        (failure == Failure::from(&last)).then(|| self.registers.calls.message())
    }

    /// The diagnostic with the point at which least squares ended, and the equation that is
    /// fulfilled worst there.
    fn with_nearest(&self, diagnostic: Diagnostic, block: u32, when: When) -> Diagnostic {
        let Some((unknowns, residuals)) = self.nearest(block, when) else { return diagnostic };
        let sorted = self.program.sorted();
        let block = match when {
            When::Start => sorted.initial_blocks.get(block as usize),
            When::Later => sorted.blocks.iter().chain(&sorted.event_blocks).nth(block as usize),
        };
        let Some(Block::Loop(torn)) = block else { return diagnostic };
        let values = torn.iteration.iter().zip(unknowns);
        let shown = values.take(MOST_NAMES).map(|(variable, value)| {
            format!("`{}` = {}", sorted.dae.variable(*variable).name, short(*value))
        });
        let shown = shown.collect::<Vec<_>>().join(", ");
        let more = match torn.iteration.len().saturating_sub(MOST_NAMES) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let worst = torn.residuals.iter().zip(residuals);
        let Some(((_, equation), residual)) =
            worst.max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()))
        else {
            return diagnostic;
        };
        let place = self.program.place(*equation as u32);
        diagnostic
            .related(place, format!("residual {} at the nearest point", short(*residual)))
            .help(format!("the nearest point that was found: {shown}{more}"))
    }

    /// Where least squares ended in a loop, and the residuals there.
    fn nearest(&self, block: u32, when: When) -> Option<(&[f64], &[f64])> {
        let program = self.program();
        let steps_and_solvers = match when {
            When::Start => vec![(&program.initial_steps, &self.loops.initial_solvers)],
            When::Later => {
                vec![
                    (&program.steps, &self.loops.solvers),
                    (&program.events.steps, &self.loops.event_solvers),
                ]
            }
        };
        steps_and_solvers.into_iter().find_map(|(steps, solvers)| {
            let loops = steps.iter().filter_map(|step| match step {
                Step::Solve(torn) => Some(torn),
                Step::Run(_) => None,
            });
            let found = loops.zip(solvers).find(|(torn, _)| torn.block == block);
            found.and_then(|(_, solver)| solver.nearest())
        })
    }
}

/// A number with four digits.
fn short(value: f64) -> String {
    match value.abs() {
        size if size != 0.0 && !(1e-3..1e5).contains(&size) => format!("{value:.3e}"),
        _ => {
            let text = format!("{value:.4}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
    }
}

/// A sentence with `…` for each number.
fn without_numbers(sentence: &str) -> String {
    let word = |word: &str| {
        let number = word.trim_end_matches([',', ';', '.', ':']);
        match number.parse::<f64>() {
            Ok(_) => format!("…{}", &word[number.len()..]),
            Err(_) => word.to_owned(),
        }
    };
    sentence.split(' ').map(word).collect::<Vec<_>>().join(" ")
}
