//! Prediction: before a step the learner says what will happen.
//!
//! Asked are the selection, the first crossover and the first mutation of a generation, where the
//! run has them: who becomes a parent, which genes a child gets from whom, whether a gene mutates.

use super::explain::short;
use super::generation::{Generation, mate};
use super::step::Step;
use super::walk::Walk;
use serde::Serialize;

/// Up to so many parents the learner names all of them.
const MOST_NAMED: usize = 8;

/// A question, and what is right.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Question {
    /// The question, with all that is needed to answer it.
    pub text: String,
    answer: Answer,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
enum Answer {
    Individuals(Vec<usize>),
    Letters(String),
    Decision(bool),
}

/// What became of an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// Whether it was right.
    pub right: bool,
    /// The verdict in words, with the right answer.
    pub text: String,
}

/// How many answers there were, and how many were right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Score {
    /// Answers.
    pub asked: usize,
    /// Right ones.
    pub right: usize,
}

impl Score {
    /// Counts an answer.
    pub fn count(&mut self, verdict: &Verdict) {
        self.asked += 1;
        self.right += usize::from(verdict.right);
    }
}

impl std::fmt::Display for Score {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.asked {
            0 => write!(f, "No question was answered."),
            asked => write!(f, "{} of {asked} answers were correct.", self.right),
        }
    }
}

/// The question before the step that `walk` stands at, if there is one.
pub fn question(walk: &Walk) -> Option<Question> {
    let generation = walk.generation();
    match walk.step() {
        Step::Sort => selection(generation),
        Step::Cross(0) => crossover(walk),
        Step::Mutate(row) if generation.mutated.as_ref()?.elites == row => mutation(walk, row),
        _ => None,
    }
}

impl Question {
    /// Whether an answer is right.
    pub fn judge(&self, answer: &str) -> Verdict {
        let answer = answer.trim().to_lowercase();
        let (right, solution) = match &self.answer {
            Answer::Individuals(expected) => {
                let numbers = answer.split(|c: char| !c.is_ascii_digit());
                let mut named: Vec<usize> = numbers.filter_map(|word| word.parse().ok()).collect();
                named.sort_unstable();
                named.dedup();
                let names: Vec<String> = expected.iter().map(usize::to_string).collect();
                (named == *expected, names.join(" "))
            }
            Answer::Letters(expected) => {
                let letters: String = answer.chars().filter(char::is_ascii_alphabetic).collect();
                (letters == *expected, expected.clone())
            }
            Answer::Decision(expected) => {
                let said = match answer.chars().next() {
                    Some('y') => Some(true),
                    Some('n') => Some(false),
                    _ => None,
                };
                (said == Some(*expected), if *expected { "yes" } else { "no" }.to_owned())
            }
        };
        let text = match right {
            true => "Right.".to_owned(),
            false => format!("No: the answer is {solution}."),
        };
        Verdict { right, text }
    }
}

fn selection(generation: &Generation) -> Option<Question> {
    let sorted = generation.sorted.as_ref()?;
    (generation.fitness.len() == generation.len()).then_some(())?;
    let order = generation.order();
    let parents = order.get(..sorted.parents)?;
    if parents.len() <= MOST_NAMED {
        let mut expected: Vec<usize> = parents.iter().map(|k| k + 1).collect();
        expected.sort_unstable();
        let text = format!(
            "Which {} individuals become parents? Enter their numbers (smaller fitness is better):",
            parents.len()
        );
        return Some(Question { text, answer: Answer::Individuals(expected) });
    }
    let asked = generation.len() / 2;
    let fitter =
        (0..generation.len()).filter(|&k| generation.fitness[k] < generation.fitness[asked]);
    let text = format!(
        "Individual {} has the fitness {}; {} of {} are better. {} become parents (N_Parents): \
         does it become one? (y/n)",
        asked + 1,
        short(generation.fitness[asked]),
        fitter.count(),
        generation.len(),
        parents.len()
    );
    Some(Question { text, answer: Answer::Decision(parents.contains(&asked)) })
}

fn crossover(walk: &Walk) -> Option<Question> {
    let generation = walk.generation();
    let crossed = generation.crossed.as_ref()?;
    let order = generation.order();
    let (a, b) = (*order.first()?, *order.get(mate(0, crossed.parents))?);
    let letter = |j: usize| {
        let swaps = crossed.points.iter().filter(|&&point| point <= j).count();
        if swaps % 2 == 0 { 'a' } else { 'b' }
    };
    let points: Vec<String> = crossed.points.iter().map(usize::to_string).collect();
    let genes = |k: usize| {
        let genes = generation.genome(k).iter().map(|gene| short(*gene));
        genes.collect::<Vec<_>>().join("  ")
    };
    let text = format!(
        "Parent a, rank 1, has the genes  {}\nParent b, rank 2, has the genes  {}\nThey exchange \
         the genes after gene {}. From which parent is each gene of the first child? One letter \
         per gene, such as {}:",
        genes(a),
        genes(b),
        points.join(" and after gene "),
        "ab".repeat(generation.n_genes.div_ceil(2))[..generation.n_genes].to_owned()
    );
    Some(Question { text, answer: Answer::Letters((0..generation.n_genes).map(letter).collect()) })
}

fn mutation(walk: &Walk, row: usize) -> Option<Question> {
    let generation = walk.generation();
    let mutated = generation.mutated.as_ref()?;
    let j = walk.number() % generation.n_genes;
    let u = mutated.numbers.get(row * generation.n_genes + j)?;
    let name = walk.trace().subject.parameters.get(j)?;
    let text = format!(
        "The random number of gene {name} of child 1 is {u:.3}, and F_Mut = {}. Does the gene mutate? \
         (y/n)",
        mutated.factor
    );
    Some(Question { text, answer: Answer::Decision(*u < mutated.factor) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teach::sample;

    /// The questions of the first generation, and whether these answers are right.
    fn answered(answers: [&str; 3]) -> (Vec<String>, Score) {
        let (mut walk, mut score, mut replies) = (sample::walk(), Score::default(), Vec::new());
        let mut answers = answers.into_iter();
        while walk.number() == 0 {
            if let Some(question) = question(&walk) {
                let verdict = question.judge(answers.next().unwrap());
                replies.push(format!("{}\n{}", question.text, verdict.text));
                score.count(&verdict);
            }
            walk.forward();
        }
        (replies, score)
    }

    #[test]
    fn right_answers_count() {
        let (replies, score) = answered(["6 3 4, 5", "AB", "no"]);
        assert_eq!(score, Score { asked: 3, right: 3 }, "{replies:?}");
        assert_eq!(score.to_string(), "3 of 3 answers were correct.");
    }

    #[test]
    fn wrong_answers_are_put_right() {
        let (replies, score) = answered(["1 2", "aa", ""]);
        assert_eq!(score, Score { asked: 3, right: 0 });
        assert!(replies[0].ends_with("No: the answer is 3 4 5 6."), "{}", replies[0]);
        assert!(replies[1].ends_with("No: the answer is ab."), "{}", replies[1]);
        assert!(replies[2].ends_with("No: the answer is no."), "{}", replies[2]);
    }
}
