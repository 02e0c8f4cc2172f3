//! Which part of a system has too many equations, which too few, and which as many as unknowns.
//!
//! Reference: [Dulmage & Mendelsohn 1958](crate::bibliography#dulmage-mendelsohn-1958).

use super::{Bipartite, Matching};

/// The coarse decomposition; all lists ascending.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DulmageMendelsohn {
    /// Equations of the over-determined part: more than its unknowns.
    pub over_equations: Vec<usize>,
    /// Unknowns of the over-determined part.
    pub over_unknowns: Vec<usize>,
    /// Equations of the under-determined part: fewer than its unknowns.
    pub under_equations: Vec<usize>,
    /// Unknowns of the under-determined part.
    pub under_unknowns: Vec<usize>,
    /// Equations of the well-determined part, which are matched to the unknowns not in the others.
    pub(crate) well_equations: Vec<usize>,
}

/// Takes a system apart, given a maximum matching: the over-determined part is what alternating
/// paths reach from unmatched equations, the under-determined part what they reach from unmatched
/// unknowns.
pub fn dulmage_mendelsohn(graph: &Bipartite, matching: &Matching) -> DulmageMendelsohn {
    let (over_equations, over_unknowns) =
        reach(graph, &matching.equation_to_unknown, &matching.unknown_to_equation);
    let (under_unknowns, under_equations) =
        reach(&graph.transposed(), &matching.unknown_to_equation, &matching.equation_to_unknown);
    let well_equations = (0..graph.n_equations())
        .filter(|e| over_equations.binary_search(e).is_err())
        .filter(|e| under_equations.binary_search(e).is_err())
        .collect();
    DulmageMendelsohn {
        over_equations,
        over_unknowns,
        under_equations,
        under_unknowns,
        well_equations,
    }
}

/// What alternating paths from the unmatched nodes of one side reach: nodes of that side, nodes of
/// the other side.
fn reach(
    graph: &Bipartite,
    partner: &[Option<usize>],
    partner_of_other: &[Option<usize>],
) -> (Vec<usize>, Vec<usize>) {
    let mut reached: Vec<bool> = partner.iter().map(Option::is_none).collect();
    let mut other_reached = vec![false; partner_of_other.len()];
    let mut pending: Vec<usize> = (0..partner.len()).filter(|node| reached[*node]).collect();
    while let Some(node) = pending.pop() {
        for other in graph.unknowns(node) {
            if std::mem::replace(&mut other_reached[*other], true) {
                continue;
            }
            let owner = partner_of_other[*other].expect("a maximum matching has no free path");
            if !std::mem::replace(&mut reached[owner], true) {
                pending.push(owner);
            }
        }
    }
    (positions(&reached), positions(&other_reached))
}

fn positions(flags: &[bool]) -> Vec<usize> {
    (0..flags.len()).filter(|i| flags[*i]).collect()
}
