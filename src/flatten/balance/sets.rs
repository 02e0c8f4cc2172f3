//! The sets that some connections make by themselves.

use super::super::connections::ScalarPair;
use crate::flatten::connections::sets::Face;
use indexmap::IndexMap;
use rustc_hash::FxHashMap;

/// The connected faces, in sets of two or more.
pub fn of_edges(edges: &[ScalarPair]) -> Vec<Vec<Face>> {
    let mut number: FxHashMap<Face, usize> = FxHashMap::default();
    let mut faces = Vec::new();
    let mut parent: Vec<usize> = Vec::new();
    for edge in edges {
        let ends = edge.faces.map(|face| {
            *number.entry(face).or_insert_with(|| {
                faces.push(face);
                parent.push(parent.len());
                parent.len() - 1
            })
        });
        let [one, other] = ends.map(|at| find(&mut parent, at));
        parent[one.max(other)] = one.min(other);
    }
    let mut sets: IndexMap<usize, Vec<Face>> = IndexMap::new();
    for (at, face) in faces.into_iter().enumerate() {
        sets.entry(find(&mut parent, at)).or_default().push(face);
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
