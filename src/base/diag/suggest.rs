//! "Did you mean": the nearest name.

/// Longer names are not compared, in bytes.
const LONGEST: usize = 300;

/// Edits that are surely typing errors: with more, a candidate that the name ends with is nearer.
const SLIPS: usize = 2;

/// Letters of such a candidate at least.
const PART: usize = 6;

/// The candidate nearest to `misspelt`, if it is close enough for a typing error: at most
/// one edit in three letters, case not counted. For a single letter only the case may differ. A name that
/// ends with a candidate, as `outputColumns` with `columns`, may mean that.
pub fn nearest<'a>(
    misspelt: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let lower = misspelt.to_lowercase();
    let length = misspelt.chars().count();
    let limit = (length / 3).max(1);
    // Names have no such length, and a comparison takes the product of the lengths.
    let is_short = |name: &str| name.len() <= LONGEST;
    let rank = |candidate: &str| {
        let own = candidate.to_lowercase();
        let edits = distance(&lower, &own);
        let is_part = own.len() >= PART && lower.ends_with(&own);
        match edits <= limit && (edits == 0 || limit < length) {
            true if edits <= SLIPS || !is_part => Some((edits, 0)),
            _ => is_part.then(|| (SLIPS, lower.len() - own.len())),
        }
    };
    candidates
        .into_iter()
        .filter(|candidate| *candidate != misspelt && is_short(candidate) && is_short(misspelt))
        .filter_map(|candidate| Some((rank(candidate)?, candidate)))
        .min_by_key(|(rank, _)| *rank)
        .map(|(_, candidate)| candidate)
}

/// The sentence for a diagnostic: ``did you mean `Resistor`?``.
pub fn did_you_mean<'a>(
    misspelt: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    nearest(misspelt, candidates).map(|candidate| format!("did you mean `{candidate}`?"))
}

/// `1 run`, `2 runs`
pub fn counted(count: u64, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// At most a dozen names.
pub fn listed(names: &[&str]) -> String {
    const SHOWN: usize = 12;
    let shown: Vec<String> = names.iter().take(SHOWN).map(|name| format!("`{name}`")).collect();
    let more = if names.len() > SHOWN { ", …" } else { "" };
    format!("{}{more}", shown.join(", "))
}

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`
/// (optimal string alignment distance).
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before: Vec<usize> = Vec::new();
    let mut previous: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut current = vec![i];
        for j in 1..=b.len() {
            let replace = previous[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replace.min(previous[j] + 1).min(current[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(before[j - 2] + 1);
            }
            current.push(best);
        }
        before = std::mem::replace(&mut previous, current);
    }
    previous[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_finds_a_slip_and_refuses_a_stranger() {
        let names = ["Fit_Order", "Mutation", "Cross"];
        assert_eq!(nearest("Mutaton", names), Some("Mutation"));
        assert_eq!(nearest("fit_ordre", names), Some("Fit_Order"));
        assert_eq!(nearest("simulate", names), None);
        let columns = ["outputs", "inputColumns", "columns"];
        assert_eq!(nearest("outputColumns", columns), Some("columns"));
        assert_eq!(nearest("inputcolumn", columns), Some("inputColumns"));
    }

    #[test]
    fn distance_counts_a_swap_as_one() {
        assert_eq!(distance("abcd", "abdc"), 1);
        assert_eq!(distance("", "abc"), 3);
    }
}
