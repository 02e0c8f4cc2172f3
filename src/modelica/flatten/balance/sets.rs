//! The sets that some connections make by themselves.

use super::super::connections::ScalarPair;
use crate::flatten::connections::sets::ConnectorSide;
use indexmap::IndexMap;
use rustc_hash::FxHashMap;

/// The connected sides, in sets of two or more.
pub(crate) fn of_edges(edges: &[ScalarPair]) -> Vec<Vec<ConnectorSide>> {
    let mut number: FxHashMap<ConnectorSide, usize> = FxHashMap::default();
    let mut sides = Vec::new();
    let mut parent: Vec<usize> = Vec::new();
    for edge in edges {
        let ends = edge.sides.map(|side| {
            *number.entry(side).or_insert_with(|| {
                sides.push(side);
                parent.push(parent.len());
                parent.len() - 1
            })
        });
        let [one, other] = ends.map(|at| find(&mut parent, at));
        parent[one.max(other)] = one.min(other);
    }
    let mut sets: IndexMap<usize, Vec<ConnectorSide>> = IndexMap::new();
    for (at, side) in sides.into_iter().enumerate() {
        sets.entry(find(&mut parent, at)).or_default().push(side);
    }
    sets.into_values().filter(|set| set.len() > 1).collect()
}

fn find(parent: &mut [usize], mut at: usize) -> usize {
    while parent[at] != at {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    at
}
