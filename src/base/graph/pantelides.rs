//! Which equations to differentiate so that the highest derivatives can be solved for.
//!
//! ```text
//! for each equation e
//!     until e, or its derivative, can be matched to a variable without derivative:
//!         differentiate every variable and every equation that the search has met;
//!         match the new variables as their originals were; continue with the derivative of e
//! ```
//!
//! Reference: [Pantelides 1988](crate::bibliography#pantelides-1988).

use super::{Bipartite, Matching, match_equations};

/// The differentiated system. Equations and variables beyond those given are derivatives, numbered
/// in the order in which they were made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Differentiated {
    /// The equation that is the derivative of each equation.
    pub eq_to_derivative: Vec<Option<usize>>,
    /// The variable that is the derivative of each variable.
    pub var_to_derivative: Vec<Option<usize>>,
    /// For every variable the equation that determines it; `None` for those that have a derivative
    /// and for those that no equation needs.
    pub var_to_equation: Vec<Option<usize>>,
}

/// Differentiates as little as makes the system structurally regular in its highest derivatives.
/// `graph` holds all variables, derivatives among them; `var_to_derivative` says which.
///
/// # Errors
/// If no number of differentiations helps: the matching, as large as possible, of the equations to
/// the variables with every derivative standing for its variable.
pub fn differentiate_equations(
    graph: &Bipartite,
    var_to_derivative: &[Option<usize>],
) -> Result<Differentiated, Matching> {
    let regular = match_equations(&without_derivatives(graph, var_to_derivative));
    if regular.equation_to_unknown.iter().any(Option::is_none) {
        return Err(regular);
    }
    let mut search = Reduction {
        equations: (0..graph.n_equations()).map(|e| graph.unknowns(e).to_vec()).collect(),
        eq_to_derivative: vec![None; graph.n_equations()],
        var_to_derivative: var_to_derivative.to_vec(),
        var_to_equation: vec![None; graph.n_unknowns()],
        met_equation: vec![false; graph.n_equations()],
        met_variable: vec![false; graph.n_unknowns()],
    };
    for equation in 0..graph.n_equations() {
        let mut equation = equation;
        while !search.augment(equation) {
            search.differentiate_what_was_met();
            equation = search.eq_to_derivative[equation].expect("the search met its root");
        }
    }
    Ok(Differentiated {
        eq_to_derivative: search.eq_to_derivative,
        var_to_derivative: search.var_to_derivative,
        var_to_equation: search.var_to_equation,
    })
}

/// The same graph with every derivative replaced by the variable it comes from.
fn without_derivatives(graph: &Bipartite, var_to_derivative: &[Option<usize>]) -> Bipartite {
    let mut origin: Vec<usize> = (0..graph.n_unknowns()).collect();
    let mut is_derivative = vec![false; graph.n_unknowns()];
    var_to_derivative.iter().flatten().for_each(|derivative| is_derivative[*derivative] = true);
    for first in (0..graph.n_unknowns()).filter(|v| !is_derivative[*v]) {
        let mut variable = first;
        while let Some(derivative) = var_to_derivative[variable] {
            origin[derivative] = first;
            variable = derivative;
        }
    }
    let row = |e: usize| graph.unknowns(e).iter().map(|v| origin[*v]).collect::<Vec<_>>();
    Bipartite::new(graph.n_unknowns(), (0..graph.n_equations()).map(row))
}

struct Reduction {
    equations: Vec<Vec<usize>>,
    eq_to_derivative: Vec<Option<usize>>,
    var_to_derivative: Vec<Option<usize>>,
    var_to_equation: Vec<Option<usize>>,
    /// What the last search has met.
    met_equation: Vec<bool>,
    met_variable: Vec<bool>,
}

impl Reduction {
    /// Matches the equation to a highest derivative, others being rematched if need be.
    fn augment(&mut self, root: usize) -> bool {
        self.met_equation.fill(false);
        self.met_variable.fill(false);
        self.met_equation[root] = true;
        // Equations from the root down, each with the variable tried and where to continue.
        let mut path = vec![(root, 0)];
        while let Some((equation, next)) = path.last_mut() {
            let Some(&variable) = self.equations[*equation].get(*next) else {
                path.pop();
                continue;
            };
            *next += 1;
            if self.var_to_derivative[variable].is_some() || self.met_variable[variable] {
                continue;
            }
            self.met_variable[variable] = true;
            match self.var_to_equation[variable] {
                Some(owner) => {
                    self.met_equation[owner] = true;
                    path.push((owner, 0));
                }
                None => {
                    for (equation, next) in path {
                        let variable = self.equations[equation][next - 1];
                        self.var_to_equation[variable] = Some(equation);
                    }
                    return true;
                }
            }
        }
        false
    }

    fn differentiate_what_was_met(&mut self) {
        let met = |flags: &[bool]| (0..flags.len()).filter(|i| flags[*i]).collect::<Vec<_>>();
        let (variables, equations) = (met(&self.met_variable), met(&self.met_equation));
        for variable in &variables {
            self.derivative_of_variable(*variable);
        }
        for equation in equations {
            let mut row = self.equations[equation].clone();
            for variable in self.equations[equation].clone() {
                row.push(self.derivative_of_variable(variable));
            }
            row.sort_unstable();
            row.dedup();
            self.eq_to_derivative[equation] = Some(self.equations.len());
            self.equations.push(row);
            self.eq_to_derivative.push(None);
            self.met_equation.push(false);
        }
        for variable in variables {
            let derivative = self.derivative_of_variable(variable);
            let owner = self.var_to_equation[variable].take();
            self.var_to_equation[derivative] = owner.and_then(|e| self.eq_to_derivative[e]);
        }
    }

    fn derivative_of_variable(&mut self, variable: usize) -> usize {
        if let Some(derivative) = self.var_to_derivative[variable] {
            return derivative;
        }
        let derivative = self.var_to_derivative.len();
        self.var_to_derivative[variable] = Some(derivative);
        self.var_to_derivative.push(None);
        self.var_to_equation.push(None);
        self.met_variable.push(false);
        derivative
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// How often each of the first `n` equations is differentiated.
    fn orders(result: &Differentiated, n: usize) -> Vec<usize> {
        let order = |mut equation: usize| {
            let mut order = 0;
            while let Some(next) = result.eq_to_derivative[equation] {
                (equation, order) = (next, order + 1);
            }
            order
        };
        (0..n).map(order).collect()
    }

    #[test]
    fn pendulum_has_index_three() {
        // Variables x y u v λ x' y' u' v'.
        let derivatives = [Some(5), Some(6), Some(7), Some(8), None, None, None, None, None];
        let graph = Bipartite::new(
            9,
            [
                vec![5, 2],    // x' = u
                vec![6, 3],    // y' = v
                vec![7, 0, 4], // u' = -λ x
                vec![8, 1, 4], // v' = -λ y - g
                vec![0, 1],    // x² + y² = 1
            ],
        );
        let result = differentiate_equations(&graph, &derivatives).unwrap();
        assert_eq!(orders(&result, 5), vec![1, 1, 0, 0, 2]);
    }

    #[test]
    fn a_system_of_index_one_is_left_alone() {
        // x' = v; 0 = g(x, v)
        let graph = Bipartite::new(3, [vec![2, 1], vec![0, 1]]);
        let result = differentiate_equations(&graph, &[Some(2), None, None]).unwrap();
        assert_eq!(result.eq_to_derivative, vec![None, None]);
        assert_eq!(result.var_to_equation, vec![None, Some(1), Some(0)]);
    }

    #[test]
    fn a_singular_system_is_refused() {
        // Two equations for x alone, none for y.
        let graph = Bipartite::new(2, [vec![0], vec![0]]);
        let matching = differentiate_equations(&graph, &[None, None]).unwrap_err();
        assert_eq!(matching.len(), 1);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn the_last_derivatives_are_matched(
            rows in prop::collection::vec(prop::collection::vec(0usize..10, 1..4), 5),
            shift in 0usize..5,
        ) {
            // Variables 0..5 with derivatives 5..10; each equation has its own variable.
            let row = |(e, row): (usize, Vec<usize>)| {
                row.into_iter().chain([(e + shift) % 5]).collect::<Vec<_>>()
            };
            let graph = Bipartite::new(10, rows.into_iter().enumerate().map(row));
            let derivatives: Vec<_> = (0..10).map(|v| (v < 5).then_some(v + 5)).collect();
            let result = differentiate_equations(&graph, &derivatives).unwrap();
            for (variable, equation) in result.var_to_equation.iter().enumerate() {
                if equation.is_some() {
                    prop_assert!(result.var_to_derivative[variable].is_none());
                }
            }
            let mut matched = vec![0; result.eq_to_derivative.len()];
            result.var_to_equation.iter().flatten().for_each(|e| matched[*e] += 1);
            for (equation, derivative) in result.eq_to_derivative.iter().enumerate() {
                prop_assert_eq!(matched[equation], usize::from(derivative.is_none()));
            }
        }
    }
}
