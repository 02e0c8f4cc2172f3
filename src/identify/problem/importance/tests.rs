//! Against functions whose effects and shares are known exactly.

use super::*;
use crate::fitness::FITNESSES;
use crate::problem::{Failed, FailureKind, Free, Series, Simulate, Stop};

struct Formula<F>(F);

impl<F: Fn(&[f64]) -> f64 + Send> Simulate for Formula<F> {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        let value = (self.0)(parameters);
        if !value.is_finite() {
            let cause = "not finite".to_owned();
            return Err(Failed::new(FailureKind::Points, cause, 1.0));
        }
        out.fill(value);
        Ok(())
    }
}

fn analysed(
    name: &str,
    range: [f64; 2],
    formula: impl Fn(&[f64]) -> f64 + Copy + Send + Sync + 'static,
) -> Importance {
    let free = |name| Free::new(name, "", range, Some(false), None).unwrap();
    let method = crate::ga::optimizer::METHODS[0];
    let problem = Problem {
        text: String::new(),
        descriptions: crate::Descriptions::default(),
        title: String::new(),
        model: String::new(),
        parameters: ["a", "b", "c"].map(free).to_vec(),
        series: vec![Series {
            experiment: String::new(),
            y_name: "y".into(),
            y_unit: String::new(),
            x_name: "x".into(),
            x_unit: String::new(),
            file: String::new(),
            x: vec![0.0, 1.0],
            y: vec![0.0, 0.0],
            weight: 2.0,
            role: Default::default(),
            relative: Vec::new(),
            sigma: crate::problem::Sigma::Unknown,
            law: crate::fitness::Law::Normal,
            censored: Vec::new(),
            column: String::new(),
            x_column: String::new(),
            rows: Vec::new(),
            missing: Vec::new(),
            scaling: Default::default(),
            joint: None,
        }],
        objectives: vec![("sse".into(), (FITNESSES[0].make)(&mut Options::default()).unwrap())],
        method_name: method.name.to_owned(),
        method: (method.make)(&mut Options::default()).unwrap(),
        polish: false,
        seed: [12345.0; 6],
        stop: Stop::default(),
        noise: 1e-15,
        inference: crate::problem::Inference::default(),
        simulator: Box::new(move || Ok(Box::new(Formula(formula)))),
    };
    let evaluation = Evaluation::new(&problem, 2).unwrap();
    analysis(name).unwrap().importance(&problem, &evaluation, 0).unwrap().unwrap()
}

/// Shares of sin a + 7 sin² b + 0.1 c⁴ sin a over −π..π, integrated in closed form.
#[test]
fn shares_of_the_ishigami_function() {
    let pi = std::f64::consts::PI;
    let ishigami =
        |p: &[f64]| p[0].sin() + 7.0 * p[1].sin().powi(2) + 0.1 * p[2].powi(4) * p[0].sin();
    let found = analysed("sobol", [-pi, pi], ishigami);
    let (v1, v2) = (0.5 * (1.0 + 0.1 * pi.powi(4) / 5.0).powi(2), 49.0 / 8.0);
    let v13 = 0.01 * pi.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
    let all = v1 + v2 + v13;
    let exact = [[v1, v1 + v13], [v2, v2], [0.0, v13]];
    for (parameter, exact) in found.parameters.iter().zip(exact) {
        for (k, exact) in exact.iter().enumerate() {
            let share = parameter.figures[k].unwrap();
            assert!((share - exact / all).abs() < 0.06, "{parameter:?} {}", exact / all);
            assert!(parameter.errors[k].unwrap() < 0.1);
        }
    }
    assert_eq!((found.simulations, found.failed), (512 * 5, 0));
}

/// A line has the same effect everywhere: slope times range times weight.
#[test]
fn effects_of_a_line_are_its_slopes() {
    let found = analysed("morris", [0.0, 2.0], |p| 3.0 * p[0] - 0.5 * p[1]);
    let expected = [6.0, 1.0, 0.0];
    for (parameter, expected) in found.parameters.iter().zip(expected) {
        assert!((parameter.figures[0].unwrap() - 2.0 * expected).abs() < 1e-12, "{parameter:?}");
        assert!(parameter.figures[1].unwrap() < 1e-12);
    }
    assert_eq!(found.hardly_matter(), ["c"]);
    assert!(found.text().contains("c hardly matters"));
    assert_eq!(found.csv().lines().count(), 4);
}

#[test]
fn failed_simulations_are_left_out() {
    let half = |p: &[f64]| if p[2] > 0.8 { f64::NAN } else { p[0] };
    for name in ["morris", "sobol"] {
        let found = analysed(name, [0.0, 1.0], half);
        assert!(found.failed > 0, "{name}");
        assert!(found.parameters[0].figures[0].unwrap() > 0.5, "{found:?}");
        assert!(found.parameters[1].figures[0].unwrap().abs() < 0.1, "{found:?}");
    }
    assert!(analysis("other").is_err());
}
