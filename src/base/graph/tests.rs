//! Tests of the graph algorithms against brute force and invariants.

use super::*;
use proptest::prelude::*;

/// Up to six equations and unknowns; each pair occurs or not.
fn small_graph() -> impl Strategy<Value = Bipartite> {
    (0usize..=6, 0usize..=6).prop_flat_map(|(rows, columns)| {
        prop::collection::vec(prop::collection::vec(prop::bool::weighted(0.35), columns), rows)
            .prop_map(move |table| {
                let row =
                    |row: Vec<bool>| (0..columns).filter(move |j| row[*j]).collect::<Vec<_>>();
                Bipartite::new(columns, table.into_iter().map(row))
            })
    })
}

/// Size of a maximum matching of equations from `first` on, by trying everything.
fn largest(graph: &Bipartite, first: usize, taken: u32) -> usize {
    if first == graph.n_equations() {
        return 0;
    }
    let skip = largest(graph, first + 1, taken);
    let free = graph.unknowns(first).iter().filter(|u| taken & (1 << **u) == 0);
    free.map(|u| 1 + largest(graph, first + 1, taken | (1 << u))).fold(skip, usize::max)
}

fn is_consistent(graph: &Bipartite, matching: &Matching) -> bool {
    let forward = matching.equation_to_unknown.iter().enumerate().all(|(equation, unknown)| {
        unknown.is_none_or(|unknown| {
            graph.unknowns(equation).contains(&unknown)
                && matching.unknown_to_equation[unknown] == Some(equation)
        })
    });
    forward && matching.unknown_to_equation.iter().flatten().count() == matching.len()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn matching_is_maximal(graph in small_graph()) {
        let matching = match_equations(&graph);
        prop_assert!(is_consistent(&graph, &matching));
        prop_assert_eq!(matching.len(), largest(&graph, 0, 0));
    }

    #[test]
    fn decomposition_separates_the_parts(graph in small_graph()) {
        let matching = match_equations(&graph);
        let parts = dulmage_mendelsohn(&graph, &matching);
        let equations = parts.over_equations.len() + parts.under_equations.len()
            + parts.well_equations.len();
        prop_assert_eq!(equations, graph.n_equations());
        let surplus = matching.equation_to_unknown.iter().filter(|u| u.is_none()).count();
        prop_assert_eq!(parts.over_equations.len(), parts.over_unknowns.len() + surplus);
        let missing = matching.unknown_to_equation.iter().filter(|e| e.is_none()).count();
        prop_assert_eq!(parts.under_unknowns.len(), parts.under_equations.len() + missing);
        for equation in &parts.over_equations {
            for unknown in graph.unknowns(*equation) {
                prop_assert!(parts.over_unknowns.contains(unknown));
            }
        }
        for equation in &parts.well_equations {
            let unknown = matching.equation_to_unknown[*equation].unwrap();
            prop_assert!(!parts.over_unknowns.contains(&unknown));
            prop_assert!(!parts.under_unknowns.contains(&unknown));
        }
    }

    #[test]
    fn components_are_those_of_mutual_reachability(
        edges in prop::collection::vec((0usize..6, 0usize..6), 0..18)
    ) {
        let mut successors = vec![Vec::new(); 6];
        let mut reach = [[false; 6]; 6];
        for (a, b) in edges {
            successors[a].push(b);
            reach[a][b] = true;
        }
        for (i, row) in reach.iter_mut().enumerate() {
            row[i] = true;
        }
        for k in 0..6 {
            for i in 0..6 {
                for j in 0..6 {
                    reach[i][j] |= reach[i][k] && reach[k][j];
                }
            }
        }
        let components = strongly_connected(6, |node| &successors[node]);
        let mut position = [usize::MAX; 6];
        for (i, component) in components.iter().enumerate() {
            for node in component {
                prop_assert_eq!(position[*node], usize::MAX);
                position[*node] = i;
            }
        }
        for i in 0..6 {
            for j in 0..6 {
                prop_assert_eq!(position[i] == position[j], reach[i][j] && reach[j][i]);
                prop_assert!(!reach[i][j] || position[j] <= position[i]);
            }
        }
    }

    #[test]
    fn blocks_can_be_solved_in_order(
        extra in prop::collection::vec(prop::collection::vec(0usize..6, 0..3), 6),
        shift in 0usize..6,
    ) {
        // Unknown i + shift occurs in equation i, so a perfect matching exists.
        let row = |(i, extra): (usize, Vec<usize>)| {
            extra.into_iter().chain([(i + shift) % 6]).collect::<Vec<_>>()
        };
        let graph = Bipartite::new(6, extra.into_iter().enumerate().map(row));
        let matching = match_equations(&graph);
        prop_assert!(matching.is_perfect());
        let mut known = vec![false; graph.n_unknowns()];
        for block in blocks(&graph, &matching) {
            for equation in &block {
                known[matching.equation_to_unknown[*equation].unwrap()] = true;
            }
            for equation in &block {
                prop_assert!(graph.unknowns(*equation).iter().all(|u| known[*u]));
            }
        }
        prop_assert!(known.into_iter().all(|known| known));
    }

    #[test]
    fn torn_blocks_can_be_solved_in_order(graph in small_graph(), pattern in any::<u64>()) {
        let solvable = |e: usize, u: usize| pattern >> (6 * e + u) & 1 == 1;
        let tearing = tear(&graph, solvable);
        let mut known = vec![false; graph.n_unknowns()];
        for unknown in &tearing.iteration_unknowns {
            prop_assert!(!std::mem::replace(&mut known[*unknown], true));
        }
        for (equation, unknown) in &tearing.assignments {
            prop_assert!(solvable(*equation, *unknown));
            prop_assert!(graph.unknowns(*equation).contains(unknown));
            prop_assert!(!std::mem::replace(&mut known[*unknown], true));
            prop_assert!(graph.unknowns(*equation).iter().all(|u| known[*u]));
        }
        prop_assert!(known.iter().all(|known| *known));
        let used = tearing.assignments.len();
        prop_assert_eq!(used + tearing.residual_equations.len(), graph.n_equations());
        prop_assert_eq!(used + tearing.iteration_unknowns.len(), graph.n_unknowns());
        prop_assert_eq!(tearing.iteration_unknowns, greedy(&graph, solvable));
    }
}

/// Iteration unknowns by the definition of the greedy choice, everything counted at every choice.
fn greedy(graph: &Bipartite, solvable: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let (mut known, mut used) = (vec![false; graph.n_unknowns()], vec![false; graph.n_equations()]);
    let mut chosen = Vec::new();
    let left = |known: &[bool], e: usize| -> Vec<usize> {
        graph.unknowns(e).iter().copied().filter(|u| !known[*u]).collect()
    };
    loop {
        let determines = |known: &[bool], used: &[bool]| {
            (0..graph.n_equations()).filter(|e| !used[*e]).find_map(|e| match left(known, e)[..] {
                [u] if solvable(e, u) => Some((e, u)),
                _ => None,
            })
        };
        while let Some((e, u)) = determines(&known, &used) {
            (used[e], known[u]) = (true, true);
        }
        let gain = |u: usize| {
            let open = (0..graph.n_equations()).filter(|e| !used[*e]);
            let open: Vec<usize> = open.filter(|e| graph.unknowns(*e).contains(&u)).collect();
            let releases = |e: &&usize| {
                let others: Vec<usize> =
                    left(&known, **e).into_iter().filter(|other| *other != u).collect();
                matches!(others[..], [other] if solvable(**e, other))
            };
            let never = !open.iter().any(|e| solvable(*e, u));
            (open.iter().filter(releases).count(), never, open.len())
        };
        let undetermined = (0..graph.n_unknowns()).filter(|u| !known[*u]);
        let Some(best) = undetermined.max_by_key(|u| (gain(*u), std::cmp::Reverse(*u))) else {
            return chosen;
        };
        known[best] = true;
        chosen.push(best);
    }
}

#[test]
fn a_ring_tears_to_one_unknown() {
    let n = 50;
    let ring = Bipartite::new(n, (0..n).map(|i| vec![i, (i + 1) % n]));
    let tearing = tear(&ring, |_, _| true);
    assert_eq!(tearing.iteration_unknowns.len(), 1);
    assert_eq!(tearing.residual_equations.len(), 1);
}

#[test]
fn an_unknown_that_no_equation_can_be_solved_for_is_iterated() {
    // x0 and x1 in both equations, both solvable for x1 only.
    let graph = Bipartite::new(2, [vec![0, 1], vec![0, 1]]);
    let tearing = tear(&graph, |_, unknown| unknown == 1);
    assert_eq!(tearing.iteration_unknowns, vec![0]);
    assert_eq!(tearing.assignments, vec![(0, 1)]);
    assert_eq!(tearing.residual_equations, vec![1]);
}

#[test]
fn long_chains_need_no_deep_stack() {
    let n = 200_000;
    // Equation i contains i and i - 1; in reverse so that augmenting paths are long.
    let chain = Bipartite::new(n, (0..n).map(|i| if i == 0 { vec![0] } else { vec![i - 1, i] }));
    let matching = match_equations(&chain);
    assert!(matching.is_perfect());
    let blocks = blocks(&chain, &matching);
    assert_eq!(blocks.len(), n);
    assert_eq!(blocks[0], vec![0]);
    let loop_back: Vec<Vec<usize>> = (0..n).map(|i| vec![(i + 1) % n]).collect();
    assert_eq!(strongly_connected(n, |i| &loop_back[i]).len(), 1);
}

#[test]
fn a_singular_system_names_its_parts() {
    // x0 = 1; x0 = 2; x1 + x2 = 0; x3 = x0
    let graph = Bipartite::new(4, [vec![0], vec![0], vec![1, 2], vec![3, 0]]);
    let parts = dulmage_mendelsohn(&graph, &match_equations(&graph));
    assert_eq!(parts.over_equations, vec![0, 1]);
    assert_eq!(parts.over_unknowns, vec![0]);
    assert_eq!(parts.under_equations, vec![2]);
    assert_eq!(parts.under_unknowns, vec![1, 2]);
    assert_eq!(parts.well_equations, vec![3]);
}
