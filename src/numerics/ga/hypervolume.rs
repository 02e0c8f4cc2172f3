//! The volume that a front dominates, up to a reference point: the larger the better the front.
//!
//! By slices along the last objective, each the volume of a front with one objective less.
//!
//! Reference: [Deb et al. 2002](gapilib_base::bibliography#deb-2002) (the fronts).

/// The hypervolume of points with `m` objectives each, all minimized; points beyond the reference
/// count nothing.
pub fn hypervolume(objectives: &[f64], m: usize, reference: &[f64]) -> f64 {
    let points: Vec<&[f64]> = objectives
        .chunks_exact(m)
        .filter(|point| point.iter().zip(reference).all(|(value, end)| value < end))
        .collect();
    volume(points, m, reference)
}

fn volume(mut points: Vec<&[f64]>, m: usize, reference: &[f64]) -> f64 {
    if m == 1 {
        let lowest = points.iter().map(|point| point[0]).fold(reference[0], f64::min);
        return reference[0] - lowest;
    }
    points.sort_by(|a, b| a[m - 1].total_cmp(&b[m - 1]));
    let mut sum = 0.0;
    for k in 0..points.len() {
        let end = points.get(k + 1).map_or(reference[m - 1], |next| next[m - 1]);
        let height = end - points[k][m - 1];
        if height > 0.0 {
            sum += height * volume(points[..=k].to_vec(), m - 1, reference);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_and_volumes_of_steps() {
        assert_eq!(hypervolume(&[0.0, 0.5, 0.5, 0.0], 2, &[1.0, 1.0]), 0.75);
        assert_eq!(hypervolume(&[0.0, 0.0, 0.5, 0.5], 2, &[1.0, 1.0]), 1.0, "dominated");
        assert_eq!(hypervolume(&[2.0, 0.0], 2, &[1.0, 1.0]), 0.0, "beyond the reference");
        let three = [0.5, 0.0, 0.0, 0.0, 0.5, 0.5];
        assert_eq!(hypervolume(&three, 3, &[1.0, 1.0, 1.0]), 0.5 + 0.25 - 0.125);
    }
}
