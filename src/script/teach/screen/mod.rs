//! The steps on a terminal of 80 × 24 or more: the script on one side, the population on the other,
//! what happens and why below. What is coloured also has a mark, so that nothing is lost without
//! colours.

mod asking;
mod compare;
mod draw;
mod inspect;
mod prompt;
mod step_panel;
#[cfg(test)]
mod tests;

use super::branches::Branches;
use super::trace::Trace;
use super::walk::TraceCursor;
use asking::Quiz;
use prompt::Prompt;

pub use draw::draw;

/// What a key means; the terminal's own names of keys are not known here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Key {
    /// A character.
    Char(char),
    /// The arrow to the left.
    Left,
    /// The arrow to the right.
    Right,
    /// Page up, or the arrow up.
    Up,
    /// Page down, or the arrow down.
    Down,
    /// The first step.
    Home,
    /// The last step.
    End,
    /// The tabulator.
    Tab,
    /// Takes back the last character of an answer.
    Backspace,
    /// Ends an answer.
    Enter,
    /// Gives an answer up.
    Escape,
}

/// What is on the screen besides the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum View {
    Steps,
    /// The simulation of an individual of this generation, from 0.
    Individual(usize),
    Help,
    /// The run and a changed one on one chart.
    Branches,
}

/// A changed run.
#[derive(Debug, Clone)]
struct Branch {
    generation: usize,
    change: String,
    /// Of the run that the walk does not go through.
    trace: Trace,
    /// Whether the walk goes through the changed run.
    is_walked: bool,
}

/// The state of the screen.
#[derive(Debug, Clone)]
pub struct Screen {
    walk: TraceCursor,
    view: View,
    /// The individual that is followed, from 0, in the generation of the walk.
    followed: Option<usize>,
    prompt: Option<Prompt>,
    /// A change that the learner requests, and from which generation on, from 1.
    wish: Option<(usize, String)>,
    branch: Option<Branch>,
    /// An individual of this generation whose curve is not known and is to be simulated.
    unknown: Option<usize>,
    /// Generation and individual that were simulated again, and their curve or why there is none.
    again: Option<(usize, usize, Result<Vec<f64>, String>)>,
    quiz: Option<Quiz>,
    /// How many rows of the population are above the panel.
    scrolled: usize,
    /// What the last key has led to, where that is not plain to see.
    message: String,
    colour: bool,
}

impl Screen {
    /// A screen at the place of `walk`.
    pub fn new(walk: TraceCursor, colour: bool) -> Screen {
        let message = String::new();
        Screen {
            walk,
            view: View::Steps,
            followed: None,
            prompt: None,
            wish: None,
            branch: None,
            unknown: None,
            again: None,
            quiz: None,
            scrolled: 0,
            message,
            colour,
        }
    }

    /// The run continues while its first generations are shown.
    #[must_use]
    pub fn while_running(mut self) -> Screen {
        let has = self.walk.trace().generations.len();
        self.message = format!("the run continues; {has} generations are recorded so far");
        self
    }

    /// Takes the whole trace when the run has ended, or says why there is none.
    pub fn ended(&mut self, run: Result<Trace, String>) {
        let trace = match run {
            Ok(trace) => trace,
            Err(why) => return self.message = why,
        };
        let (number, (step, _)) = (self.walk.number(), self.walk.progress());
        self.message = format!("the run has ended after {} generations", trace.generations.len());
        self.walk = TraceCursor::new(trace);
        self.walk.go_to(number);
        // A step of this generation, wherever the next one begins.
        while self.walk.progress().0 < step && self.walk.number() == number && self.walk.forward() {
        }
    }

    /// Answers a key; whether the learner continues.
    pub fn press(&mut self, key: Key) -> bool {
        self.message.clear();
        if self.is_asked(key) {
            return true;
        }
        if let Some(prompt) = self.prompt.take() {
            self.answer(prompt, key);
            return true;
        }
        if self.view == View::Branches && key == Key::Char('x') {
            self.exchange();
            return true;
        }
        if self.view != View::Steps {
            self.view = View::Steps;
            return true;
        }
        match key {
            Key::Char('q') => return false,
            Key::Char('g' | 'f' | 'i' | 'u' | 'w') => self.prompt = Prompt::of(key),
            Key::Char('?' | 'h') => self.view = View::Help,
            Key::Char('j') => self.scroll(1),
            Key::Char('k') => self.scroll(-1),
            _ => self.step(key),
        }
        true
    }

    /// The change that is to be tried now, and from which generation on, counted from 1.
    pub fn take_change(&mut self) -> Option<(usize, String)> {
        self.wish.take()
    }

    /// The genes of an individual whose simulation is to be shown, but is not in the trace.
    pub fn take_unknown(&mut self) -> Option<Vec<f64>> {
        let k = self.unknown.take()?;
        self.again = Some((self.walk.number(), k, Err(String::new())));
        Some(self.walk.generation().genome(k).to_vec())
    }

    /// The simulation of [`Screen::take_unknown`], Y at every measured point, or why there is none.
    pub fn simulated(&mut self, row: Result<Vec<f64>, String>) {
        if let Some((_, _, known)) = &mut self.again {
            *known = row;
        }
    }

    /// Shows what has become of a change, or why it could not be tried.
    pub fn branched(&mut self, generation: usize, change: String, run: Result<Trace, String>) {
        match run {
            Ok(trace) => {
                if self.branch.as_ref().is_some_and(|branch| branch.is_walked) {
                    self.exchange();
                }
                self.branch = Some(Branch { generation, change, trace, is_walked: false });
                self.view = View::Branches;
                self.message = "x steps through the changed run; any other key returns".to_owned();
            }
            Err(why) => self.message = why,
        }
    }

    /// The walk continues in the other run.
    fn exchange(&mut self) {
        let Some(branch) = &mut self.branch else { return };
        let number = self.walk.number();
        let mut walk = TraceCursor::new(branch.trace.clone());
        walk.go_to(number.min(branch.trace.generations.len() - 1));
        branch.trace = std::mem::replace(&mut self.walk, walk).into_trace();
        branch.is_walked = !branch.is_walked;
        self.followed = None;
        self.view = View::Steps;
        self.message = "this is the changed run; w without a statement compares again".to_owned();
    }

    /// The run and the changed one.
    fn branches(&self) -> Option<Branches<'_>> {
        let Branch { generation, change, trace, is_walked } = self.branch.as_ref()?;
        let (original, changed) = match is_walked {
            true => (trace, self.walk.trace()),
            false => (self.walk.trace(), trace),
        };
        Some(Branches { original, changed, generation: *generation, change })
    }

    /// Moves the panel over the rows of the population.
    fn scroll(&mut self, rows: isize) {
        let last = step_panel::lines(self, 0).0.len().saturating_sub(1);
        self.scrolled = self.scrolled.saturating_add_signed(rows).min(last);
    }

    fn step(&mut self, key: Key) {
        let before = self.walk.number();
        let moved = match key {
            Key::Right | Key::Char(' ' | 'n') | Key::Enter => self.walk.forward(),
            Key::Left | Key::Char('b') => self.walk.back(),
            Key::Down => self.walk.forward_generation(),
            Key::Up => before > 0 && self.walk.go_to(before - 1),
            Key::Tab => self.walk.forward_phase(),
            Key::Home => self.walk.go_to(0),
            Key::End => {
                let last = self.walk.trace().generations.len() - 1;
                self.walk.go_to(last);
                while self.walk.forward() {}
                true
            }
            _ => {
                self.message = "unknown key; ? shows the keys".to_owned();
                return;
            }
        };
        if !moved {
            self.message = "this is the last step".to_owned();
        }
        let is_forward =
            !matches!(key, Key::Left | Key::Char('b') | Key::Up | Key::Home | Key::End);
        if moved && is_forward {
            self.ask();
        }
        self.keep_following(before);
    }

    /// The followed individual lives on in the next generation as elite or in its first child.
    fn keep_following(&mut self, before: usize) {
        let Some(followed) = self.followed else { return };
        if self.walk.number() == before {
            return;
        }
        self.followed = (self.walk.number() == before + 1)
            .then(|| self.walk.generation().successor(followed))
            .flatten();
        self.message = match self.followed {
            Some(k) => format!("followed on as individual {}", k + 1),
            None => format!("individual {} has no descendant here; tracking ends", followed + 1),
        };
    }

    fn answer(&mut self, mut prompt: Prompt, key: Key) {
        match key {
            Key::Escape => return,
            Key::Backspace => {
                prompt.text.pop();
            }
            Key::Char(c) => prompt.text.push(c),
            Key::Enter => {
                let before = self.walk.number();
                self.message = prompt::carry_out(self, &prompt).unwrap_or_else(|why| why);
                if self.message.is_empty() {
                    self.keep_following(before);
                }
                return;
            }
            _ => {}
        }
        self.prompt = Some(prompt);
    }
}
