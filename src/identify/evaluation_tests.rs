//! Populations of a model written in Rust.

use super::errors::*;
use super::problems::Decay;
use super::{Evaluator, Question};
use crate::diag::Code;
use crate::ga::Genomes;
use crate::ga::errors::{BAD_RANGE, SIZE_MISMATCH};
use crate::registry::BAD_OPTION;
use std::sync::Arc;

fn question(x_name: &str, x: &[f64]) -> Question {
    Question { x_name: x_name.to_owned(), x: x.to_vec(), ..Question::default() }
}

fn genomes(values: &[f64]) -> Genomes {
    Genomes::new(2, values.to_vec()).unwrap()
}

fn simulate(x_name: &str, x: &[f64]) -> Vec<f64> {
    let evaluator = Evaluator::new(Arc::new(Decay), question(x_name, x), 1).unwrap();
    evaluator.evaluate(&genomes(&[0.7, 3.0])).unwrap().rows
}

fn assert_close(found: &[f64], expected: impl Fn(usize) -> f64, tolerance: f64) {
    for (k, found) in found.iter().enumerate() {
        let expected = expected(k);
        assert!((found - expected).abs() < tolerance, "point {k}: {found} {expected}");
    }
}

#[test]
fn points_over_time_and_over_a_ramp_are_met_exactly() {
    let x = [1.3, 0.0, 0.1, 2.0];
    assert_close(&simulate("time", &x), |k| 3.0 * (-0.7 * x[k]).exp(), 1e-6);
    assert_close(&simulate("i", &x), |k| 3.0 * (-0.7 * x[k] / 2.0).exp(), 1e-6);
}

#[test]
fn points_over_a_simulated_variable_are_interpolated() {
    // s = 2 t + 3 exp(−0.7 t) rises from t = 0.07 on; its inverse by Newton's method.
    let x = [3.0, 4.0, 4.5];
    let time_of = |s: f64| {
        (0..50).fold(1.5, |t: f64, _| {
            t - (2.0 * t + 3.0 * (-0.7 * t).exp() - s) / (2.0 - 2.1 * (-0.7 * t).exp())
        })
    };
    let found = simulate("s", &x[1..]);
    assert_close(&found, |k| 3.0 * (-0.7 * time_of(x[k + 1])).exp(), 1e-4);
    let evaluator = Evaluator::new(Arc::new(Decay), question("s", &[9.0]), 1).unwrap();
    let failed = evaluator.evaluate(&genomes(&[0.7, 3.0])).unwrap();
    assert!(failed.messages()[0].contains("`s` = 9"), "{:?}", failed.failures);
}

#[test]
fn a_failed_individual_does_not_disturb_the_others() {
    let evaluator = Evaluator::new(Arc::new(Decay), question("time", &[0.0, 1.0]), 1).unwrap();
    let simulated = evaluator.evaluate(&genomes(&[1.0, 2.0, 11.0, 2.0, 1.0, 4.0])).unwrap();
    assert!(simulated.rows[2].is_nan() && simulated.rows[3].is_nan());
    let messages = simulated.messages();
    assert!(messages[1].contains("Assertion") && messages[1].ends_with("(at 0 s)"));
    assert_eq!((messages[0].as_str(), messages[2].as_str()), ("", ""));
    assert_eq!(simulated.rows[4], 4.0);
}

#[test]
fn threads_do_not_change_a_bit() {
    let values: Vec<f64> = (0..80).map(|k| 0.1 + 0.137 * f64::from(k)).collect();
    let all = |threads| {
        let evaluator =
            Evaluator::new(Arc::new(Decay), question("i", &[0.5, 1.5]), threads).unwrap();
        let simulated = evaluator.evaluate(&genomes(&values)).unwrap();
        let bits: Vec<u64> = simulated.rows.iter().map(|value| value.to_bits()).collect();
        (bits, simulated.failures)
    };
    assert_eq!(all(1), all(2));
    assert_eq!(all(1), all(7));
}

#[test]
fn wrong_questions_are_refused() {
    let code = |change: fn(&mut Question)| -> Code {
        let mut question = question("time", &[0.0, 1.0]);
        change(&mut question);
        Evaluator::new(Arc::new(Decay), question, 1).err().unwrap().code
    };
    assert_eq!(code(|q| q.parameters = vec!["c".into()]), PARAMETER_NOT_FOUND);
    assert_eq!(code(|q| q.parameters = vec!["n".into()]), FIXED_PARAMETER);
    assert_eq!(code(|q| q.parameters = ["b", "a", "b"].map(String::from).to_vec()), BAD_OPTION);
    assert_eq!(code(|q| q.y_name = "w".into()), UNKNOWN_OUTPUT);
    assert_eq!(code(|q| q.x_name = "w".into()), UNKNOWN_OUTPUT);
    assert_eq!(code(|q| q.x = vec![]), BAD_DATA);
    assert_eq!(code(|q| q.x = vec![f64::NAN]), BAD_DATA);
    assert_eq!(code(|q| q.x = vec![3.0]), POINTS_OUTSIDE);
    assert_eq!(code(|q| (q.x, q.x_name) = (vec![1.0, 4.5], "i".into())), POINTS_OUTSIDE);
}

#[test]
fn wrong_populations_are_refused() {
    let evaluator = Evaluator::new(Arc::new(Decay), question("time", &[0.0, 1.0]), 1).unwrap();
    let three = Genomes::new(3, vec![1.0; 3]).unwrap();
    assert_eq!(evaluator.evaluate(&three).unwrap_err().code, SIZE_MISMATCH);
    let fault = evaluator.evaluate(&genomes(&[1.0, 2.0, 1.0, 101.0])).unwrap_err();
    assert_eq!(fault.code, BAD_RANGE);
    assert!(fault.message.contains("individual 2 has `b` = 101"), "{}", fault.message);
}
