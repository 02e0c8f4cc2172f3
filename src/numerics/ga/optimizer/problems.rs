//! Problems with known minima, and the loop that solves them.

// What includes this file, a test or a benchmark, names these in its own way.
use super::{
    Answers, FAILED_FITNESS, Gene, Genomes, Method, Mrg32k3a, Polished, Required, Setup,
    hypervolume, survivors,
};
use crate::elementary;

/// Residuals at a point of the unit cube; `None` where it fails. The first objective is their sum
/// of squares.
pub(crate) type Residuals = dyn Fn(&[f64]) -> Option<Vec<f64>>;

/// The best sum of squares after so many evaluations.
pub(crate) fn minimum(
    method: &dyn Method,
    n: usize,
    budget: u64,
    seed: u64,
    polish: bool,
    residuals: &Residuals,
) -> f64 {
    let rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap().stream(seed);
    let genes = (0..n).map(|j| Gene::new(format!("g{j}"), 0.0, 1.0).unwrap()).collect();
    let setup = Setup {
        genes,
        scales: Vec::new(),
        n_objectives: 1,
        budget: Some(budget),
        start: None,
        noise: 1e-15,
        size: 1.0,
        rng: rng.clone(),
    };
    let mut search = method.start(setup.clone()).unwrap();
    if polish {
        search = Box::new(Polished::new(search, &setup, rng.substream(1)));
    }
    let (mut best, mut used) = (f64::INFINITY, 0);
    while used < budget {
        let mut batch = Genomes::with_capacity(n, 0);
        search.ask(&mut batch);
        if batch.is_empty() {
            break;
        }
        used += batch.len() as u64;
        let rows: Vec<Option<Vec<f64>>> = batch.rows().map(residuals).collect();
        let m = rows.iter().flatten().next().map_or(1, Vec::len);
        let fitness: Vec<f64> = rows
            .iter()
            .map(|row| row.as_ref().map_or(FAILED_FITNESS, |row| row.iter().map(|r| r * r).sum()))
            .collect();
        best = fitness.iter().copied().fold(best, f64::min);
        let rows: Vec<f64> =
            rows.into_iter().flat_map(|row| row.unwrap_or_else(|| vec![f64::NAN; m])).collect();
        let mut jacobians = Vec::new();
        if search.required() == Required::Jacobians {
            used += 2 * (n * batch.len()) as u64;
            jacobians = batch.rows().flat_map(|genome| differences(genome, m, residuals)).collect();
        }
        let answers = Answers {
            objectives: &fitness,
            n_objectives: 1,
            residuals: &rows,
            jacobians: &jacobians,
        };
        search.tell(&batch, &answers);
    }
    best
}

/// Central differences, residuals × genes; NaN where it fails.
fn differences(genome: &[f64], m: usize, residuals: &Residuals) -> Vec<f64> {
    const STEP: f64 = 6e-6;
    let n = genome.len();
    let mut jacobian = vec![f64::NAN; m * n];
    for j in 0..n {
        let moved = |by: f64| {
            let mut moved = genome.to_vec();
            moved[j] += by;
            residuals(&moved)
        };
        let (Some(low), Some(high)) = (moved(-STEP), moved(STEP)) else { continue };
        for (row, (low, high)) in low.iter().zip(&high).enumerate() {
            jacobian[row * n + j] = (high - low) / (2.0 * STEP);
        }
    }
    jacobian
}

/// The polarization curve of the case study: six genes on logarithmic scales over one decade.
pub(crate) fn polarization(genome: &[f64]) -> Option<Vec<f64>> {
    const TRUTH: [f64; 6] = [0.0390, 1.4e-3, 1.5856e-6, 0.0918, 0.7286, 0.2265];
    const OFF_CENTRE: [f64; 6] = [0.3, 0.6, 0.4, 0.7, 0.35, 0.15];
    let p: Vec<f64> =
        (0..6).map(|j| TRUTH[j] * elementary::powf(10f64, genome[j] - OFF_CENTRE[j])).collect();
    let voltage = |p: &[f64], i: f64| {
        let all = i + p[1];
        1.2 - p[4] * all - p[0] * elementary::ln(all / p[2])
            + p[3] * elementary::ln(1.0 - all / p[5])
    };
    let current = |k: usize| 0.002 + (0.22 - 0.002) * k as f64 / 29.0;
    let residuals: Vec<f64> =
        (0..30).map(|k| voltage(&p, current(k)) - voltage(&TRUTH, current(k))).collect();
    residuals.iter().all(|r| r.is_finite()).then_some(residuals)
}

/// Rosenbrock's valley in −5..10, as residuals.
pub(crate) fn rosenbrock(genome: &[f64]) -> Option<Vec<f64>> {
    let x: Vec<f64> = genome.iter().map(|u| -5.0 + 15.0 * u).collect();
    Some(x.windows(2).flat_map(|x| [10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]).collect())
}

/// Rastrigin's function in −5.12..5.12, minimum at 0.3 + 0.01 j.
pub(crate) fn rastrigin(genome: &[f64]) -> Option<Vec<f64>> {
    let term = |(j, u): (usize, &f64)| {
        let x = -5.12 + 10.24 * u - (0.3 + 0.01 * j as f64);
        (x * x + 10.0 * (1.0 - elementary::cos(std::f64::consts::TAU * x))).max(0.0).sqrt()
    };
    Some(genome.iter().enumerate().map(term).collect())
}

/// Ackley's function in −32..32, minimum at 0.3 + 0.01 j.
pub(crate) fn ackley(genome: &[f64]) -> Option<Vec<f64>> {
    let n = genome.len() as f64;
    let x: Vec<f64> = genome
        .iter()
        .enumerate()
        .map(|(j, u)| -32.0 + 64.0 * u - (0.3 + 0.01 * j as f64))
        .collect();
    let square = x.iter().map(|x| x * x).sum::<f64>() / n;
    let cosine = x.iter().map(|x| elementary::cos(std::f64::consts::TAU * x)).sum::<f64>() / n;
    let value = -20.0 * elementary::exp(-0.2 * square.sqrt()) - elementary::exp(cosine)
        + 20.0
        + std::f64::consts::E;
    Some(vec![value.max(0.0).sqrt()])
}

/// Several objectives of a point of the unit cube.
pub(crate) type Objectives = fn(&[f64]) -> Vec<f64>;

/// The volume that the population dominates after so many evaluations, up to 1.1 in each objective.
pub(crate) fn dominated(
    method: &dyn Method,
    population: usize,
    n: usize,
    budget: usize,
    seed: u64,
    objectives: Objectives,
) -> f64 {
    let rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap().stream(seed);
    let genes = (0..n).map(|j| Gene::new(format!("g{j}"), 0.0, 1.0).unwrap()).collect();
    let n_objectives = objectives(&vec![0.5; n]).len();
    let budget_known = Some(budget as u64);
    let setup = Setup {
        genes,
        scales: Vec::new(),
        n_objectives,
        budget: budget_known,
        start: None,
        noise: 1e-15,
        size: 1.0,
        rng,
    };
    let mut search = method.start(setup).unwrap();
    let (mut members, mut used): (Vec<f64>, usize) = (Vec::new(), 0);
    while used < budget {
        let mut batch = Genomes::with_capacity(n, 0);
        search.ask(&mut batch);
        used += batch.len();
        let found: Vec<f64> = batch.rows().flat_map(objectives).collect();
        search.tell(
            &batch,
            &Answers { objectives: &found, n_objectives, residuals: &[], jacobians: &[] },
        );
        // Population and offspring compete as they do within the method.
        members.extend(found);
        let kept = survivors(&members, n_objectives, population);
        let row = |place: usize| members[place * n_objectives..(place + 1) * n_objectives].to_vec();
        members = kept.into_iter().flat_map(|survivor| row(survivor.place)).collect();
    }
    hypervolume(&members, n_objectives, &vec![1.1; n_objectives])
}

fn zdt(genome: &[f64], shape: fn(f64, f64) -> f64) -> Vec<f64> {
    let rest = &genome[1..];
    let g = 1.0 + 9.0 * rest.iter().sum::<f64>() / rest.len() as f64;
    vec![genome[0], g * shape(genome[0], g)]
}

/// Convex front.
pub(crate) fn zdt1(genome: &[f64]) -> Vec<f64> {
    zdt(genome, |f, g| 1.0 - (f / g).sqrt())
}

/// Front that is not convex.
pub(crate) fn zdt2(genome: &[f64]) -> Vec<f64> {
    zdt(genome, |f, g| 1.0 - elementary::powi(f / g, 2))
}

/// Front in five pieces.
pub(crate) fn zdt3(genome: &[f64]) -> Vec<f64> {
    zdt(genome, |f, g| {
        1.0 - (f / g).sqrt() - f / g * elementary::sin(10.0 * std::f64::consts::PI * f)
    })
}

/// A part of a sphere, three objectives.
pub(crate) fn dtlz2(genome: &[f64]) -> Vec<f64> {
    let g: f64 = genome[2..].iter().map(|u| elementary::powi(u - 0.5, 2)).sum();
    let [a, b] = [genome[0], genome[1]].map(|u| u * std::f64::consts::FRAC_PI_2);
    let size = 1.0 + g;
    vec![
        size * elementary::cos(a) * elementary::cos(b),
        size * elementary::cos(a) * elementary::sin(b),
        size * elementary::sin(a),
    ]
}
