//! The difference of two files in the unified format.

use std::fmt::Write as _;
use std::ops::Range;

/// Lines shown before and after a change.
const CONTEXT: usize = 3;

/// A place where the files differ: lines of the first, and lines of the second that replace them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// Lines of the first text, from 0.
    pub old: Range<usize>,
    /// Lines of the second text, from 0.
    pub new: Range<usize>,
}

/// The places where two lists of lines differ, in their order.
///
/// ```
/// use gapilib_modelica::format::diff::changes;
///
/// let found = changes(&["a", "b", "c"], &["a", "x", "y", "c"]);
/// assert_eq!((found[0].old.clone(), found[0].new.clone()), (1..2, 1..3));
/// ```
pub fn changes(old: &[&str], new: &[&str]) -> Vec<Change> {
    let mut found = Vec::new();
    compare(old, new, 0, 0, &mut found);
    found
}

/// As many steps of the search for the next common line as a formatted text needs.
const FURTHEST: usize = 400;

/// Walks along both lists; where they differ, goes to the nearest pair of equal lines.
fn compare(old: &[&str], new: &[&str], mut i: usize, mut j: usize, found: &mut Vec<Change>) {
    while i < old.len() || j < new.len() {
        if i < old.len() && j < new.len() && old[i] == new[j] {
            i += 1;
            j += 1;
            continue;
        }
        let (k, l) = next_common(&old[i..], &new[j..]);
        found.push(Change { old: i..i + k, new: j..j + l });
        i += k;
        j += l;
    }
}

/// The nearest pair of equal lines, as numbers of lines to skip in both lists.
fn next_common(old: &[&str], new: &[&str]) -> (usize, usize) {
    for distance in 1..FURTHEST {
        for k in 0..=distance {
            let l = distance - k;
            if k < old.len() && l < new.len() && old[k] == new[l] && !old[k].trim().is_empty() {
                return (k, l);
            }
        }
    }
    (old.len(), new.len())
}

/// The difference as `diff -u` shows it; empty if there is none.
///
/// ```
/// use gapilib_modelica::format::diff::unified;
///
/// let shown = unified("a.mo", "x\ny\n", "x\nz\n");
/// assert_eq!(shown, "--- a.mo\n+++ a.mo\n@@ -1,2 +1,2 @@\n x\n-y\n+z\n");
/// ```
pub fn unified(name: &str, old: &str, new: &str) -> String {
    let old: Vec<&str> = old.split_inclusive('\n').collect();
    let new: Vec<&str> = new.split_inclusive('\n').collect();
    let changes = changes(&old, &new);
    if changes.is_empty() {
        return String::new();
    }
    let mut shown = format!("--- {name}\n+++ {name}\n");
    let mut first = 0;
    while first < changes.len() {
        let mut last = first;
        while last + 1 < changes.len()
            && changes[last + 1].old.start <= changes[last].old.end + 2 * CONTEXT
        {
            last += 1;
        }
        hunk(&mut shown, &old, &new, &changes[first..=last]);
        first = last + 1;
    }
    shown
}

/// Changes that are near to each other, with the lines around them.
fn hunk(shown: &mut String, old: &[&str], new: &[&str], changes: &[Change]) {
    let (Some(first), Some(last)) = (changes.first(), changes.last()) else { return };
    let before = first.old.start.min(CONTEXT);
    let after = (old.len() - last.old.end).min(CONTEXT);
    let (i, j) = (first.old.start - before, first.new.start - before);
    let (k, l) = (last.old.end + after, last.new.end + after);
    let place = |from: usize, to: usize| match to - from {
        0 => format!("{from},0"),
        count => format!("{},{count}", from + 1),
    };
    _ = writeln!(shown, "@@ -{} +{} @@", place(i, k), place(j, l));
    let mut at = i;
    for change in changes {
        old[at..change.old.start].iter().for_each(|line| push(shown, ' ', line));
        old[change.old.clone()].iter().for_each(|line| push(shown, '-', line));
        new[change.new.clone()].iter().for_each(|line| push(shown, '+', line));
        at = change.old.end;
    }
    old[at..k].iter().for_each(|line| push(shown, ' ', line));
}

fn push(shown: &mut String, mark: char, line: &str) {
    shown.push(mark);
    shown.push_str(line);
    if !line.ends_with('\n') {
        shown.push_str("\n\\ No newline at end of file\n");
    }
}
