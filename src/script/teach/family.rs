//! The family tree of an individual: where it and its forebears came into being.

use super::generation::{Generation, Origin};

/// So many generations of forebears are named.
const MOST_DEPTH: usize = 5;
/// So many forebears are named of each of them.
const MOST_ACROSS: usize = 10;

/// One member of a family. An elite lives through several generations; named is the first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member {
    /// The generation it came into being in, from 0.
    pub generation: usize,
    /// Its number there, from 0.
    pub number: usize,
    /// How many generations of the family it is away from the descendant, on the longest way.
    pub depth: usize,
    /// Its parents as places in the family; `None` for one that is not named any more.
    pub parents: Vec<Option<usize>>,
}

/// The individual `number` of a generation and its forebears, the descendant first.
pub fn family(generations: &[Generation], generation: usize, number: usize) -> Vec<Member> {
    let (generation, number) = born(generations, generation, number);
    let mut found = vec![Member { generation, number, depth: 0, parents: Vec::new() }];
    let mut at = 0;
    while at < found.len() {
        let parents = parents(generations, &found[at]);
        let depth = found[at].depth + 1;
        for (generation, number) in parents {
            let parent =
                place(&mut found, Member { generation, number, depth, parents: Vec::new() });
            found[at].parents.push(parent);
        }
        at += 1;
    }
    put_in_layers(&mut found);
    found
}

/// Puts each member deeper than all its children: parents always came into being earlier.
fn put_in_layers(family: &mut [Member]) {
    let mut latest_first: Vec<usize> = (0..family.len()).collect();
    latest_first.sort_by_key(|&k| std::cmp::Reverse(family[k].generation));
    for k in latest_first {
        let depth = family[k].depth + 1;
        for parent in family[k].parents.clone().into_iter().flatten() {
            family[parent].depth = family[parent].depth.max(depth);
        }
    }
}

/// The position of a member in the family; it joins if there is room for it.
fn place(family: &mut Vec<Member>, new: Member) -> Option<usize> {
    let same = |old: &Member| (old.generation, old.number) == (new.generation, new.number);
    if let Some(known) = family.iter().position(same) {
        return Some(known);
    }
    let across = family.iter().filter(|old| old.depth == new.depth).count();
    let fits = new.depth <= MOST_DEPTH && across < MOST_ACROSS;
    fits.then(|| family.push(new)).map(|()| family.len() - 1)
}

/// Where the parents came into being.
fn parents(generations: &[Generation], member: &Member) -> Vec<(usize, usize)> {
    let origin = generations[member.generation].origins.get(member.number);
    match (origin, member.generation.checked_sub(1)) {
        (Some(&Origin::Child { parent, mate, .. }), Some(before)) => {
            // A single parent is named once.
            let both = [parent, mate].into_iter().take(if mate == parent { 1 } else { 2 });
            both.map(|number| born(generations, before, number)).collect()
        }
        _ => Vec::new(),
    }
}

/// The generation and the number in which an individual came into being: an elite did so earlier.
fn born(generations: &[Generation], generation: usize, number: usize) -> (usize, usize) {
    let (mut generation, mut number) = (generation, number);
    while let Some(&Origin::Elite { from }) = generations[generation].origins.get(number) {
        let Some(before) = generation.checked_sub(1) else { break };
        (generation, number) = (before, from);
    }
    (generation, number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn generation(origins: Vec<Origin>) -> Generation {
        Generation { n_genes: 1, genes: vec![0.0; origins.len()], origins, ..Generation::default() }
    }

    fn child(parent: usize, mate: usize) -> Origin {
        Origin::Child { parent, mate, mutated: Vec::new() }
    }

    #[test]
    fn an_elite_is_named_where_it_came_into_being() {
        let generations = [
            generation(vec![Origin::Script, Origin::Script]),
            generation(vec![child(0, 1), Origin::Random]),
            generation(vec![Origin::Elite { from: 0 }, child(0, 1)]),
            generation(vec![child(1, 0)]),
        ];
        let found = family(&generations, 3, 0);
        let named: Vec<_> = found.iter().map(|m| (m.generation, m.number, m.depth)).collect();
        // The elite of generation 2 is the child of generation 1, which is grandparent as well.
        assert_eq!(named, [(3, 0, 0), (2, 1, 1), (1, 0, 2), (1, 1, 2), (0, 0, 3), (0, 1, 3)]);
        assert_eq!(found[0].parents, [Some(1), Some(2)]);
        assert_eq!(found[1].parents, [Some(2), Some(3)]);
        assert_eq!(found[2].parents, [Some(4), Some(5)]);
        assert!(found[3..].iter().all(|member| member.parents.is_empty()));
    }

    #[test]
    fn a_family_stays_small() {
        let wide = || generation((0..64).map(|k| child(k, (k + 1) % 64)).collect());
        let generations: Vec<Generation> = (0..40).map(|_| wide()).collect();
        let found = family(&generations, 39, 0);
        assert!(found.len() <= 1 + MOST_DEPTH * MOST_ACROSS, "{}", found.len());
        let deeper = |m: &Member| m.parents.iter().flatten().all(|&k| found[k].depth > m.depth);
        assert!(found.iter().all(deeper));
        assert!(found.iter().flat_map(|m| &m.parents).flatten().all(|&k| k < found.len()));
    }
}
