//! Which unknowns occur in which equations.

/// Equations × unknowns, stored by equations.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bipartite {
    n_unknowns: usize,
    /// Where each equation's unknowns start; one more than there are equations.
    starts: Vec<usize>,
    unknowns: Vec<usize>,
}

impl Bipartite {
    /// The graph whose equation i contains the unknowns `rows[i]`, each less than `n_unknowns`.
    pub fn new<Row>(n_unknowns: usize, rows: impl IntoIterator<Item = Row>) -> Bipartite
    where
        Row: IntoIterator<Item = usize>,
    {
        let (mut starts, mut unknowns) = (vec![0], Vec::new());
        for row in rows {
            unknowns.extend(row);
            starts.push(unknowns.len());
        }
        assert!(unknowns.iter().all(|u| *u < n_unknowns), "every unknown is less than n_unknowns");
        Bipartite { n_unknowns, starts, unknowns }
    }

    /// Number of equations.
    pub fn n_equations(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of unknowns.
    pub(crate) fn n_unknowns(&self) -> usize {
        self.n_unknowns
    }

    /// The unknowns of an equation, in the order given.
    pub fn unknowns(&self, equation: usize) -> &[usize] {
        &self.unknowns[self.starts[equation]..self.starts[equation + 1]]
    }

    /// The same graph seen from the unknowns: its "equation" j lists the equations that contain
    /// unknown j, ascending.
    pub fn transposed(&self) -> Bipartite {
        let mut starts = vec![0; self.n_unknowns + 1];
        for unknown in &self.unknowns {
            starts[unknown + 1] += 1;
        }
        for unknown in 0..self.n_unknowns {
            starts[unknown + 1] += starts[unknown];
        }
        let mut next = starts.clone();
        let mut equations = vec![0; self.unknowns.len()];
        for equation in 0..self.n_equations() {
            for unknown in self.unknowns(equation) {
                equations[next[*unknown]] = equation;
                next[*unknown] += 1;
            }
        }
        Bipartite { n_unknowns: self.n_equations(), starts, unknowns: equations }
    }
}
