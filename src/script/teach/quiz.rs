//! Prediction: before a step the learner says what will happen.
//!
//! Asked are the selection, crossovers and the first mutation of a generation, where the run has
//! them: who becomes a parent, who mates with whom, where two parents were cut, which genes a child
//! gets from whom, whether a gene mutates. An answer that is not one is asked for again.

use super::explain::short;
use super::generation::{Generation, Mating, mating};
use super::step::Step;
use super::walk::TraceCursor;
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
    /// The numbers of these individuals, of so many.
    Individuals { right: Vec<usize>, of: usize },
    /// A letter for each gene.
    Letters { right: String },
    /// Yes or no.
    Decision { right: bool },
    /// One number from 1 to `of`.
    Number { right: usize, of: usize },
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
pub fn question(walk: &TraceCursor) -> Option<Question> {
    let generation = walk.generation();
    let is_even = walk.number().is_multiple_of(2);
    match walk.step() {
        Step::Sort => selection(walk),
        Step::Cross(0) if is_even => pair(generation),
        Step::Cross(0) => heritage(generation, 0),
        Step::Cross(2) if is_even => cut(generation),
        Step::Mutate(row) if generation.mutated.as_ref()?.elites == row => mutation(walk, row),
        _ => None,
    }
}

impl Question {
    /// Whether an answer is right.
    ///
    /// # Errors
    ///
    /// It is not an answer; the message says what to enter.
    pub fn judge(&self, answer: &str) -> Result<Verdict, String> {
        let answer = answer.trim().to_lowercase();
        let (right, solution) = match &self.answer {
            Answer::Individuals { right, of } => {
                let named = numbers(&answer).filter(|n| n.iter().all(|n| (1..=*of).contains(n)));
                let named = named.filter(|named| named.len() == right.len());
                let named = named.ok_or_else(|| match right.len() {
                    1 => format!("Enter one number from 1 to {of}."),
                    count => format!("Enter {count} different numbers from 1 to {of}."),
                })?;
                let names: Vec<String> = right.iter().map(usize::to_string).collect();
                (named == *right, names.join(" "))
            }
            Answer::Letters { right } => {
                let letters: String = answer.chars().filter(|c| !c.is_whitespace()).collect();
                let fits =
                    letters.len() == right.len() && letters.chars().all(|c| "ab".contains(c));
                fits.then_some(()).ok_or_else(|| {
                    format!("Enter {} letters, each of them a or b.", right.len())
                })?;
                (letters == *right, right.clone())
            }
            Answer::Decision { right } => {
                let said = match answer.as_str() {
                    "y" | "yes" => true,
                    "n" | "no" => false,
                    _ => return Err("Enter y for yes or n for no.".to_owned()),
                };
                (said == *right, if *right { "yes" } else { "no" }.to_owned())
            }
            Answer::Number { right, of } => match numbers(&answer).as_deref() {
                Some([number]) if (1..=*of).contains(number) => {
                    (number == right, right.to_string())
                }
                _ => return Err(format!("Enter one number from 1 to {of}.")),
            },
        };
        let text = match right {
            true => "Right.".to_owned(),
            false => format!("No: the answer is {solution}."),
        };
        Ok(Verdict { right, text })
    }
}

/// The numbers of an answer, sorted, each once; `None` where there is something else.
fn numbers(answer: &str) -> Option<Vec<usize>> {
    let words = answer.split(|c: char| c.is_whitespace() || ",;".contains(c));
    let words = words.filter(|word| !word.is_empty() && *word != "and");
    let mut named = words.map(|word| word.parse().ok()).collect::<Option<Vec<usize>>>()?;
    named.sort_unstable();
    named.dedup();
    Some(named)
}

fn selection(walk: &TraceCursor) -> Option<Question> {
    let generation = walk.generation();
    let sorted = generation.sorted.as_ref()?;
    (generation.fitness.len() == generation.len()).then_some(())?;
    let order = generation.order();
    let parents = order.get(..sorted.parents)?;
    // Where all or none become parents there is nothing to find out.
    (!parents.is_empty() && parents.len() < order.len()).then_some(())?;
    if parents.len() <= MOST_NAMED {
        let mut right: Vec<usize> = parents.iter().map(|k| k + 1).collect();
        right.sort_unstable();
        let text = match parents.len() {
            1 => "Which individual becomes the parent? Enter its number (smaller fitness is \
                  better):"
                .to_owned(),
            count => format!(
                "Which {count} individuals become parents? Enter their numbers (smaller fitness is \
                 better):"
            ),
        };
        let answer = Answer::Individuals { right, of: generation.len() };
        return Some(Question { text, answer });
    }
    // Another rank in each generation: parents and others.
    let asked = *order.get((7 * walk.number() + order.len() / 3) % order.len())?;
    let text = format!(
        "Individual {} has the fitness {}. {} of {} become parents (N_Parents); smaller is better. \
         Compare it with the others: does it become one? (y/n)",
        asked + 1,
        short(generation.fitness[asked]),
        parents.len(),
        generation.len(),
    );
    Some(Question { text, answer: Answer::Decision { right: parents.contains(&asked) } })
}

/// Who mates with the best.
fn pair(generation: &Generation) -> Option<Question> {
    let crossed = generation.crossed.as_ref()?;
    let order = generation.order();
    if crossed.parents < 3 {
        return heritage(generation, 0);
    }
    let (a, b) = (*order.first()?, *order.get(1)?);
    let text = format!(
        "Individual {} has rank 1. Parents of neighbouring ranks mate. Enter the number of the \
         individual that it mates with:",
        a + 1
    );
    Some(Question { text, answer: Answer::Number { right: b + 1, of: generation.len() } })
}

/// Two parents and their first child: where they were cut.
fn cut(generation: &Generation) -> Option<Question> {
    let crossed = generation.crossed.as_ref()?;
    let order = generation.order();
    let Mating { parents, children } = mating(2, crossed.parents);
    let [rank_a, rank_b] = parents[..] else { return None };
    let (a, b) = (*order.get(rank_a)?, *order.get(rank_b)?);
    let n = generation.n_genes;
    // Two genes can be cut at one place only.
    if n < 3 {
        return heritage(generation, 2);
    }
    let child = crossed.rows.chunks_exact(n).nth(crossed.elites + 2)?;
    let (a, b) = (generation.genome(a), generation.genome(b));
    let [point] = crossed.points[..] else { return None };
    // Equal genes at the cut leave open where it is.
    (point > 0 && point < n && a[point - 1] != b[point - 1] && a[point] != b[point])
        .then_some(())?;
    let text = format!(
        "Rank {} has the genes  {}\nRank {} has the genes  {}\n{}    {}\nAfter \
         which gene were they cut? Enter its number:",
        rank_a + 1,
        row(a),
        rank_b + 1,
        row(b),
        if children.len() == 2 { "Their first child has" } else { "Their child has      " },
        row(child)
    );
    Some(Question { text, answer: Answer::Number { right: point, of: n - 1 } })
}

/// The genes of an individual in one line.
fn row(genes: &[f64]) -> String {
    genes.iter().map(|gene| short(*gene)).collect::<Vec<_>>().join("  ")
}

/// Which genes the first child of the parent of this rank has from whom.
fn heritage(generation: &Generation, rank: usize) -> Option<Question> {
    let crossed = generation.crossed.as_ref()?;
    let order = generation.order();
    let Mating { parents, children } = mating(rank, crossed.parents);
    let [_, other] = parents[..] else { return None };
    let (a, b) = (*order.get(rank)?, *order.get(other)?);
    let exchanged = crossed.exchanged(generation.n_genes);
    // A child that has all genes from one parent is its copy, and no question.
    (exchanged.contains(&true) && exchanged.contains(&false)).then_some(())?;
    let points: Vec<String> = crossed.points.iter().map(usize::to_string).collect();
    let text = format!(
        "Parent a, rank {}, has the genes  {}\nParent b, rank {}, has the genes  {}\nThey exchange \
         the genes after gene {}. From which parent is each gene of the {}? One letter \
         per gene, such as {}:",
        rank + 1,
        row(generation.genome(a)),
        other + 1,
        row(generation.genome(b)),
        points.join(" and after gene "),
        if children.len() == 2 { "first child" } else { "child" },
        "ab".repeat(generation.n_genes.div_ceil(2))[..generation.n_genes].to_owned()
    );
    let right = exchanged.iter().map(|&other| if other { 'b' } else { 'a' }).collect();
    Some(Question { text, answer: Answer::Letters { right } })
}

fn mutation(walk: &TraceCursor, row: usize) -> Option<Question> {
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
    Some(Question { text, answer: Answer::Decision { right: *u < mutated.factor } })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teach::sample;

    /// The questions of a generation, and what becomes of these answers.
    fn answered(generation: usize, answers: &[&str]) -> (Vec<String>, Score) {
        let (mut walk, mut score, mut replies) = (sample::walk(), Score::default(), Vec::new());
        walk.go_to(generation);
        let mut answers = answers.iter();
        while walk.number() == generation {
            if let Some(question) = question(&walk) {
                let verdict = question.judge(answers.next().expect("an answer for each question"));
                match verdict {
                    Ok(verdict) => {
                        replies.push(format!("{}\n{}", question.text, verdict.text));
                        score.count(&verdict);
                    }
                    Err(again) => replies.push(again),
                }
            }
            walk.forward();
        }
        assert!(answers.next().is_none(), "{replies:?}");
        (replies, score)
    }

    #[test]
    fn right_answers_count() {
        let (replies, score) = answered(0, &["6 3 4, 5", "3", "a b", "no"]);
        assert_eq!(score, Score { asked: 4, right: 4 }, "{replies:?}");
        assert_eq!(score.to_string(), "4 of 4 answers were correct.");
        assert!(replies[1].contains("mates with") && replies[2].contains("Parent a, rank 3"));
        assert_eq!(answered(1, &["1 2 3 4", " A b", "y"]).1.asked, 3);
    }

    #[test]
    fn wrong_answers_are_put_right() {
        let (replies, score) = answered(0, &["1 2 3 4", "2", "ab", "yes"]);
        assert_eq!(score, Score { asked: 4, right: 1 });
        assert!(replies[0].ends_with("No: the answer is 3 4 5 6."), "{}", replies[0]);
        assert!(replies[3].ends_with("No: the answer is no."), "{}", replies[3]);
    }

    #[test]
    fn what_is_no_answer_is_asked_again_and_not_counted() {
        let (replies, score) = answered(0, &["1 2", "perhaps", "1.5", ""]);
        assert_eq!(score, Score::default());
        assert_eq!(
            replies,
            [
                "Enter 4 different numbers from 1 to 6.",
                "Enter one number from 1 to 6.",
                "Enter 2 letters, each of them a or b.",
                "Enter y for yes or n for no.",
            ]
        );
        assert_eq!(answered(1, &["1 2 3 9", "abc", "nonsense"]).1, Score::default());
    }

    /// Two genes can be cut at one place only: where it is would be no question.
    #[test]
    fn where_parents_were_cut_is_asked_of_three_genes() {
        let crossed = |n: usize| super::super::generation::Crossed {
            place: crate::teach::ScriptLine::default(),
            parents: 4,
            elites: 0,
            points: vec![n - 1],
            rows: vec![0.5; 4 * n],
        };
        let generation = |n: usize| Generation {
            n_genes: n,
            genes: (0..4 * n).map(|k| k as f64).collect(),
            fitness: vec![1.0, 2.0, 3.0, 4.0],
            crossed: Some(crossed(n)),
            ..Generation::default()
        };
        let question = cut(&generation(3)).expect("a question");
        assert_eq!(question.answer, Answer::Number { right: 2, of: 2 });
        let question = cut(&generation(2)).expect("a question");
        assert!(question.text.starts_with("Parent a, rank 3, has"), "{}", question.text);
        assert_eq!(question.answer, Answer::Letters { right: "ab".to_owned() });
    }

    /// Of many parents one individual is asked about; how many are better would be the answer.
    #[test]
    fn the_question_about_many_parents_does_not_give_its_answer() {
        let generation = |parents| crate::teach::Generation {
            n_genes: 1,
            genes: vec![0.5; 20],
            fitness: (0..20).map(f64::from).collect(),
            origins: vec![crate::teach::Origin::Script; 20],
            sorted: Some(super::super::generation::Sorted {
                place: crate::teach::ScriptLine::default(),
                order: (0..20).collect(),
                parents,
                elites: 1,
            }),
            ..crate::teach::Generation::default()
        };
        let generations: Vec<_> = (0..12).map(|_| generation(12)).collect();
        let mut walk = TraceCursor::new(crate::teach::Trace { generations, ..Default::default() });
        let mut answers = Vec::new();
        loop {
            if let Some(question) = question(&walk) {
                assert!(!question.text.contains("are better"), "{}", question.text);
                let Answer::Decision { right } = question.answer else { panic!("yes or no") };
                answers.push(right);
            }
            if !walk.forward() {
                break;
            }
        }
        assert_eq!(answers.len(), 12);
        assert!(answers.contains(&true) && answers.contains(&false), "{answers:?}");
    }
}
