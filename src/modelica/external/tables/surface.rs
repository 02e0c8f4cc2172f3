//! A smooth function of two variables through the points of a grid: on every cell a polynomial of
//! third degree in each variable, with Akima's derivatives ([Akima
//! 1974](gapilib_base::bibliography#akima-1974)).

use super::spline::{Spline, difference, extended, shares};

/// Value, both first derivatives and the mixed derivative at every point of the grid, row-major.
#[derive(Debug)]
pub(crate) struct Surface {
    nodes: Vec<[f64; 4]>,
}

/// Where an abscissa lies in an interval of its axis: weights of the values and of the derivatives
/// at both ends for the value, the first and the second derivative.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Basis {
    low: usize,
    high: usize,
    /// By order of the derivative: low value, low derivative, high value, high derivative.
    weights: [[f64; 4]; 3],
}

impl Basis {
    /// In the interval `low` of the abscissae; an axis of one point has no intervals.
    pub(crate) fn new(x: &[f64], low: usize, u: f64) -> Basis {
        if x.len() == 1 {
            let value = [1.0, 0.0, 0.0, 0.0];
            return Basis { low: 0, high: 0, weights: [value, [0.0; 4], [0.0; 4]] };
        }
        let h = x[low + 1] - x[low];
        let t = (u - x[low]) / h;
        let s = 1.0 - t;
        let value =
            [s * s * (1.0 + 2.0 * t), h * t * s * s, t * t * (3.0 - 2.0 * t), -h * t * t * s];
        let first = [-6.0 * t * s / h, s * (1.0 - 3.0 * t), 6.0 * t * s / h, t * (3.0 * t - 2.0)];
        let second = [
            (12.0 * t - 6.0) / (h * h),
            (6.0 * t - 4.0) / h,
            (6.0 - 12.0 * t) / (h * h),
            (6.0 * t - 2.0) / h,
        ];
        Basis { low, high: low + 1, weights: [value, first, second] }
    }
}

impl Surface {
    /// Through `z`, row-major over `x`, then `y`.
    pub(crate) fn new(x: &[f64], y: &[f64], z: &[f64]) -> Surface {
        let (rows, columns) = (x.len(), y.len());
        let column = |j: usize| (0..rows).map(|i| z[i * columns + j]).collect::<Vec<f64>>();
        let by_x: Vec<Line> = (0..columns).map(|j| Line::new(x, &column(j))).collect();
        let by_y: Vec<Line> =
            (0..rows).map(|i| Line::new(y, &z[i * columns..][..columns])).collect();
        let mixed = mixed_secants(x, y, z);
        let mut nodes = Vec::with_capacity(z.len());
        for i in 0..rows {
            for j in 0..columns {
                let (a, b) = (by_x[j].shares[i], by_y[i].shares[j]);
                let twist = |p: usize, q: usize| a[p] * b[q] * mixed[i + p][j + q];
                let zxy = match rows > 1 && columns > 1 {
                    true => twist(0, 0) + twist(0, 1) + twist(1, 0) + twist(1, 1),
                    false => 0.0,
                };
                nodes.push([
                    z[i * columns + j],
                    by_x[j].derivatives[i],
                    by_y[i].derivatives[j],
                    zxy,
                ]);
            }
        }
        Surface { nodes }
    }

    /// A derivative of orders `p` and `q`, at most 2 each.
    pub(crate) fn derivative(
        &self,
        columns: usize,
        a: &Basis,
        b: &Basis,
        p: usize,
        q: usize,
    ) -> f64 {
        let (wa, wb) = (&a.weights[p], &b.weights[q]);
        let corner = |i: usize, wa: &[f64], j: usize, wb: &[f64]| {
            let [z, zx, zy, zxy] = self.nodes[i * columns + j];
            wa[0] * (wb[0] * z + wb[1] * zy) + wa[1] * (wb[0] * zx + wb[1] * zxy)
        };
        corner(a.low, &wa[..2], b.low, &wb[..2])
            + corner(a.low, &wa[..2], b.high, &wb[2..])
            + corner(a.high, &wa[2..], b.low, &wb[..2])
            + corner(a.high, &wa[2..], b.high, &wb[2..])
    }
}

/// A line of the grid: derivatives at its points, and the shares of the secants in them.
struct Line {
    derivatives: Vec<f64>,
    shares: Vec<[f64; 2]>,
}

impl Line {
    fn new(x: &[f64], z: &[f64]) -> Line {
        if x.len() == 1 {
            return Line { derivatives: vec![0.0], shares: vec![[0.5, 0.5]] };
        }
        let shares = extended(&secants(x, z)).windows(4).map(|m| shares(m, difference)).collect();
        Line { derivatives: Spline::Akima.derivatives(x, z), shares }
    }
}

fn secants(x: &[f64], z: &[f64]) -> Vec<f64> {
    z.windows(2).zip(x.windows(2)).map(|(z, x)| (z[1] - z[0]) / (x[1] - x[0])).collect()
}

/// Mixed divided differences of the cells, with one more cell at every border: `[i][j]` is that of
/// the cell before point `i` and before point `j`.
fn mixed_secants(x: &[f64], y: &[f64], z: &[f64]) -> Vec<Vec<f64>> {
    let (rows, columns) = (x.len(), y.len());
    if rows < 2 || columns < 2 {
        return Vec::new();
    }
    let along_y: Vec<Vec<f64>> = z.chunks(columns).map(|row| secants(y, row)).collect();
    let bordered = |line: &[f64]| extended(line)[1..line.len() + 3].to_vec();
    let by_columns: Vec<Vec<f64>> = (0..columns - 1)
        .map(|j| {
            let line: Vec<f64> = along_y.iter().map(|row| row[j]).collect();
            bordered(&secants(x, &line))
        })
        .collect();
    (0..=rows)
        .map(|i| bordered(&by_columns.iter().map(|line| line[i]).collect::<Vec<f64>>()))
        .collect()
}
