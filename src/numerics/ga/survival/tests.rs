//! Each way of survival against what defines it.

use super::*;
use crate::ga::operators;
use crate::registry::Choice;

const OLD: [f64; 4] = [4.0, 1.0, f64::NAN, 3.0];
const YOUNG: [f64; 4] = [2.0, 5.0, 0.5, 3.5];

/// Four old ones at 0.1, 0.2, 0.3, 0.4 and children at 0.9, 0.11, 0.31, 0.45 of the pairs (1, 2)
/// and (3, 4).
fn survivors(name: &str, sizes: Sizes) -> Vec<Survivor> {
    let old = Genomes::new(1, vec![0.1, 0.2, 0.3, 0.4]).unwrap();
    let young = Genomes::new(1, vec![0.9, 0.11, 0.31, 0.45]).unwrap();
    let brood = Brood {
        old: Rated { genomes: &old, fitness: &OLD },
        ages: &[0, 3, 0, 1],
        offspring: Rated { genomes: &young, fitness: &YOUNG },
        parents: &[[0, 1], [0, 1], [2, 3], [2, 3]],
        genes: &[Gene::new("g", 0.0, 1.0).unwrap()],
    };
    let survival = operators::survival(Choice::named(name)).unwrap();
    survival.survivors(&brood, sizes).unwrap()
}

fn sizes(population: usize, elites: usize) -> Sizes {
    Sizes { population, elites }
}

#[test]
fn elites_and_offspring_stand_in_order() {
    use Survivor::{Offspring, Old};
    let all = [Offspring(2), Old(1), Offspring(0), Offspring(3), Offspring(1)];
    assert_eq!(survivors("elitism", sizes(5, 1)), all);
    assert_eq!(survivors("elitism", sizes(4, 0))[3], Offspring(1));
    assert_eq!(survivors("elitism", sizes(4, 4)), survivors("plus", sizes(4, 0)));
}

#[test]
fn the_offspring_replace_everyone() {
    let expected: Vec<Survivor> = (0..4).map(Survivor::Offspring).collect();
    assert_eq!(survivors("generational", sizes(4, 1)), expected);
}

#[test]
fn the_best_of_both_generations_survive() {
    use Survivor::{Offspring, Old};
    let expected = [Offspring(2), Old(1), Offspring(0), Old(3)];
    assert_eq!(survivors("mu_plus_lambda", sizes(4, 0)), expected);
}

/// 0.11 is like 0.1 and worse, 0.9 is left for 0.2 and worse than it; 0.31 is like 0.3, whose
/// fitness is not a number, and 0.45 is worse than 0.4.
#[test]
fn children_compete_with_the_parent_that_they_are_like() {
    use Survivor::{Offspring, Old};
    assert_eq!(survivors("crowding", sizes(4, 1)), [Old(0), Old(1), Offspring(2), Old(3)]);
}

#[test]
fn a_function_of_the_user_says_who_survives() {
    use Survivor::{Offspring, Old};
    let old = Genomes::new(1, vec![0.0; 4]).unwrap();
    let rated = |fitness| Rated { genomes: &old, fitness };
    let brood = Brood {
        old: rated(&OLD),
        ages: &[0, 3, 0, 1],
        offspring: rated(&YOUNG),
        parents: &[[0, 1]; 4],
        genes: &[],
    };
    let mut oldest = |inputs: &[f64]| Ok(vec![-inputs[3]]);
    let found = survivors_by(&mut oldest, &brood, sizes(3, 0)).unwrap();
    assert_eq!(found, [Old(1), Old(3), Old(0)]);
    let mut ranked = |inputs: &[f64]| Ok(vec![inputs[1]]);
    let found = survivors_by(&mut ranked, &brood, sizes(2, 0)).unwrap();
    assert_eq!(found, [Offspring(2), Old(1)]);
    let error = survivors_by(&mut |_| Ok(vec![f64::NAN]), &brood, sizes(2, 0)).unwrap_err();
    assert_eq!(error.code, crate::ga::errors::BAD_OPERATOR);
}
