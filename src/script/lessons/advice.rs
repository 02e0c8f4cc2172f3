//! What beginners write where they mean something else: said when a script ends with an error, beside
//! the error.

use super::shipped::Lesson;
use crate::syntax::is_keyword;
use regex::Regex;
use std::sync::LazyLock;

/// A way of writing, and what to write instead.
struct Habit {
    pattern: LazyLock<Option<Regex>>,
    advice: &'static str,
}

static COMMA: Habit = Habit {
    pattern: LazyLock::new(|| Regex::new(r"^\s*\w+\s*:?=\s*-?\d+,\d+\s*;?\s*$").ok()),
    advice: "Numbers are written with a point: 3.5, not 3,5.",
};
static POWER: Habit = Habit {
    pattern: LazyLock::new(|| Regex::new("[²³]|\\*\\*").ok()),
    advice: "The square of x is written x^2.",
};
static PRODUCT: Habit = Habit {
    pattern: LazyLock::new(|| Regex::new(r"(?:\)|\b\d+(?:\.\d+)?)\s*([A-DF-Za-df-z_]\w*)").ok()),
    advice: "A product needs a star: (a + b)*u and 2*u, not (a + b)u and 2u.",
};
static CALL: LazyLock<Option<Regex>> = LazyLock::new(|| Regex::new(r"\b([A-Za-z_]\w*)\s*\(").ok());
static ARRAY: LazyLock<Option<Regex>> =
    LazyLock::new(|| Regex::new(r"\b(?:Real|Integer)\s+(\w+)\s*\[").ok());

/// What may be meant in the lines that the learner has changed; empty where nothing is known.
pub fn advice(lesson: &Lesson, text: &str) -> Vec<String> {
    let shipped: Vec<&str> = lesson.text.lines().map(str::trim).collect();
    let own = text.lines().map(str::trim).filter(|line| !shipped.contains(line));
    let mut all: Vec<String> = own.flat_map(|line| of_line(line, text)).collect();
    all.dedup();
    all
}

fn of_line(line: &str, text: &str) -> Vec<String> {
    // Without comments and without what is between quotation marks.
    let code = line.split("//").next().unwrap_or_default();
    let code = &code.split('"').step_by(2).collect::<Vec<_>>().join("\"\"");
    let found = |habit: &Habit| habit.pattern.as_ref().is_some_and(|p| p.is_match(code));
    let simple = [&COMMA, &POWER].into_iter().filter(|habit| found(habit));
    let mut all: Vec<String> = simple.map(|habit| habit.advice.to_owned()).collect();
    if lacks_star(code) {
        all.push(PRODUCT.advice.to_owned());
    }
    let arrays = names(&ARRAY, text);
    let called = names(&CALL, code).into_iter().find(|name| arrays.contains(name));
    all.extend(called.map(|name| {
        format!("An element of an array is written with brackets: {name}[k], not {name}(k).")
    }));
    all
}

fn lacks_star(code: &str) -> bool {
    let Some(pattern) = PRODUCT.pattern.as_ref() else { return false };
    let followers = pattern.captures_iter(code).filter_map(|found| found.get(1));
    followers.map(|word| word.as_str()).any(|word| !is_keyword(word))
}

/// The names that a pattern finds.
fn names<'t>(pattern: &LazyLock<Option<Regex>>, text: &'t str) -> Vec<&'t str> {
    let Some(pattern) = pattern.as_ref() else { return Vec::new() };
    pattern.captures_iter(text).filter_map(|found| Some(found.get(1)?.as_str())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lessons::all;

    #[test]
    fn what_is_written_in_other_ways_is_recognized() {
        let of = |number: usize, old: &str, new: &str| {
            let lesson = &all()[number - 1];
            assert!(lesson.text.contains(old), "{old}");
            advice(lesson, &lesson.text.replace(old, new)).join(" ")
        };
        assert!(of(1, "Guess := 2;", "Guess := 3,5;").contains("with a point"));
        assert!(of(2, "total + residual;", "total + residual²;").contains("x^2"));
        assert!(of(3, "value := u;", "value := low + (high - low)u;").contains("a star"));
        assert!(of(3, "value := u;", "value := 2u;").contains("a star"));
        assert!(of(4, "if j <> k", "if fitness(j) < fitness[k]").contains("fitness[k], not"));
        assert_eq!(of(8, "Penalty := 0;", "Penalty := 1e60;"), "");
    }

    #[test]
    fn nothing_is_said_of_solutions() {
        for lesson in all() {
            let (text, _) = lesson.solved();
            assert_eq!(advice(lesson, &text), Vec::<String>::new(), "lesson {}", lesson.number);
            let other = Lesson { text: String::new(), ..lesson.clone() };
            assert_eq!(advice(&other, &text), Vec::<String>::new(), "lesson {}", lesson.number);
        }
    }
}
