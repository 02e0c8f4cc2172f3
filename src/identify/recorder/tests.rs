//! Searches and generations of scripts, as the recorder finds them.

use super::*;
use crate::Quantity;
use crate::problem::{Failed, FailureKind};

fn study() -> Arc<Study> {
    let quantity = |name: &str| Quantity { name: name.to_owned(), unit: String::new() };
    Arc::new(Study {
        model: "M".to_owned(),
        parameters: vec![quantity("p")],
        x: quantity("time"),
        y: quantity("y"),
        descriptions: crate::Descriptions::default(),
        changes: 0,
    })
}

fn genomes(values: &[f64]) -> Genomes {
    Genomes::new(1, values.to_vec()).unwrap()
}

fn simulated(rows: &[f64]) -> Simulated {
    let failure =
        |row: &f64| row.is_nan().then(|| Failed::new(FailureKind::Model, "log of -1", 0.5));
    Simulated { rows: rows.to_vec(), failures: rows.iter().map(failure).collect() }
}

/// The only search of a run that has ended.
fn ended(recorder: Recorder) -> ScriptSearch {
    let mut all = recorder.finished();
    assert_eq!(all.len(), 1);
    all.pop().unwrap()
}

#[test]
fn fit_order_ends_a_generation() {
    let mut recorder = Recorder::default();
    let population = genomes(&[3.0, 1.0, 9.0]);
    let rows = simulated(&[3.0, 1.0, f64::NAN]);
    for _ in 0..2 {
        let first = recorder.evaluated(&study(), &[0.0], &population, &rows);
        recorder.rated(first..first + 3, &[0.0]);
        recorder.ordered(&population, &[9.0, 1.0, 1e60]);
    }
    let search = ended(recorder);
    assert_eq!(search.observed.history.generations.len(), 2);
    assert_eq!(search.observed.history.generations[1].failures, 1);
    assert_eq!((search.evaluations, search.observed.failures.count), (6, 2));
    assert_eq!(search.observed.failures.causes["log of -1"], 2);
    let best = search.best().unwrap();
    assert_eq!((best.genome[0], best.fitness, best.compared[0].simulated[0]), (1.0, 1.0, 1.0));
    assert_eq!(best.objective, &Objective::SumOfSquares(vec![1.0]));
    assert_eq!(best.compared[0].measured, Some(vec![0.0]));
}

/// Genes are logarithms: what counts is what was simulated, and the ranges of the genes are none
/// of the parameters.
#[test]
fn parameters_made_of_genes_are_those_that_were_simulated() {
    let mut recorder = Recorder::default();
    for generation in 0..2 {
        let first = recorder.evaluated(
            &study(),
            &[0.0],
            &genomes(&[1.0, 10.0, 100.0]),
            &simulated(&[1.0, 10.0, f64::NAN]),
        );
        recorder.rated(first..first + 3, &[0.0]);
        recorder.ordered(&genomes(&[0.0, 1.0, 2.0]), &[1.0, 100.0, 1e60]);
        recorder.searched(&[-3.0], &[3.0], &genomes(&[0.0, 1.0, 2.0]));
        assert_eq!(recorder.current().unwrap().observed.history.generations.len(), generation + 1);
    }
    let search = ended(recorder);
    let best = search.best().unwrap();
    assert_eq!((best.genome[0], best.fitness), (1.0, 1.0));
    assert_eq!(best.objective, &Objective::SumOfSquares(vec![1.0]));
    assert_eq!((&search.ranges, &search.spanned), (&None, &Some((vec![1.0], vec![100.0]))));
}

#[test]
fn genes_that_explain_no_fitness_are_not_exchanged() {
    let mut recorder = Recorder::default();
    let first =
        recorder.evaluated(&study(), &[0.0], &genomes(&[1.0, 10.0]), &simulated(&[1.0, 10.0]));
    recorder.rated(first..first + 2, &[0.0]);
    recorder.ordered(&genomes(&[0.0, 1.0]), &[5.0, 7.0]);
    assert!(ended(recorder).best().is_none());
}

#[test]
fn individuals_evaluated_one_by_one_make_one_generation() {
    let mut recorder = Recorder::default();
    for generation in 0..2 {
        for k in 0..3 {
            let value = [f64::from(3 - k - generation)];
            let one = recorder.evaluated(&study(), &[0.0], &genomes(&value), &simulated(&value));
            recorder.rated([one], &[0.0]);
        }
        let population = genomes(&[3, 2, 1].map(|value| f64::from(value - generation)));
        recorder.ordered(&population, population.values());
    }
    let search = ended(recorder);
    assert_eq!(search.observed.history.generations.len(), 2);
    assert_eq!(search.best().unwrap().fitness, 0.0);
}

#[test]
fn another_run_has_its_own_seed() {
    let seed = |entry: f64| [entry; 6];
    let mut recorder = Recorder::default();
    recorder.seeded(seed(1.0), seed(2.0), 1);
    recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[7.0]));
    recorder.seeded(seed(2.0), seed(4.0), 2);
    recorder.ordered(&genomes(&[5.0]), &[42.0]);
    recorder.seeded(seed(7.0), seed(8.0), 1);
    let before = recorder.begin_next().pop().unwrap();
    assert_eq!((before.seed, before.evaluations), (Some(seed(1.0)), 1));
    recorder.seeded(seed(8.0), seed(10.0), 1);
    assert_eq!((recorder.seeds.seed, recorder.tally.simulations), (Some(seed(7.0)), 0));
}

/// Two populations are simulated before either is compared, and compared the other way round.
#[test]
fn genes_belong_to_the_individuals_that_fit_was_given() {
    let mut recorder = Recorder::default();
    recorder.evaluated(&study(), &[0.0], &genomes(&[1.1]), &simulated(&[1.1]));
    recorder.evaluated(&study(), &[0.0], &genomes(&[2.0, 3.0, 4.0]), &simulated(&[2.0, 3.0, 4.0]));
    recorder.rated(2..=4, &[3.0]);
    assert!(recorder.generations == 0);
    recorder.rated([1], &[3.0]);
    let search = ended(recorder);
    let best = search.best().unwrap();
    assert_eq!((best.genome[0], best.fitness, best.compared[0].simulated[0]), (3.0, 0.0, 3.0));
    assert_eq!(search.observed.history.generations.len(), 1);
}

/// Some individuals of an `Eval`, and those of several put together, are known as well.
#[test]
fn individuals_are_known_wherever_they_stand() {
    let mut recorder = Recorder::default();
    recorder.evaluated(&study(), &[0.0], &genomes(&[1.0, 2.0]), &simulated(&[1.0, 2.0]));
    recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[5.0]));
    recorder.rated([3, 2], &[4.0]);
    assert!(!recorder.pending.is_rated(), "one of three was not compared");
    recorder.rated([17], &[4.0]);
    assert!(!recorder.pending.is_rated(), "that individual is not known");
    recorder.rated([1], &[4.0]);
    let search = ended(recorder);
    let best = search.best().unwrap();
    assert_eq!((best.genome[0], best.fitness), (5.0, 1.0));
}

/// A copy is that of all individuals with its numbers: elites are simulated again in each generation.
#[test]
fn copies_belong_to_the_individuals_with_their_numbers() {
    let mut recorder = Recorder::default();
    let (genes, rows) = (genomes(&[1.0, 1.0, 2.0]), simulated(&[5.0, 5.0, f64::NAN]));
    recorder.evaluated(&study(), &[0.0], &genes, &rows);
    let copied = [5.0, f64::NAN].map(|value| recorder.copied(&[value])).concat();
    assert_eq!(copied, [1, 2, 3]);
    assert!(recorder.copied(&[6.0]).is_empty() && recorder.copied(&[5.0, 5.0]).is_empty());
    recorder.rated(copied, &[4.0]);
    assert!(recorder.pending.is_rated());
}

/// Rows without any digit of their own: whose they are, their numbers say.
#[test]
fn failed_individuals_belong_to_their_experiment() {
    let mut recorder = Recorder::default();
    let failed = simulated(&[f64::NAN, f64::NAN]);
    let first = recorder.evaluated(&study(), &[0.0], &genomes(&[1.0, 2.0]), &failed);
    let other = recorder.evaluated(&second(), &[0.0], &genomes(&[1.0, 2.0]), &failed);
    recorder.rated([first, first + 1], &[4.0]);
    assert!(!recorder.pending.is_rated(), "the other experiment was not compared");
    recorder.rated([other, other + 1], &[4.0]);
    assert!(recorder.pending.is_rated());
    recorder.begin_next();
    let later = recorder.evaluated(&study(), &[0.0], &genomes(&[1.0]), &simulated(&[1.0]));
    assert_eq!(later, 5, "no number comes twice");
}

fn second() -> Arc<Study> {
    Arc::new(Study { model: "M2".to_owned(), ..(*study()).clone() })
}

/// Two experiments a generation, whose sums the script adds; `total` is what it adds up.
fn two_experiments(total: fn(f64, f64) -> f64) -> ScriptSearch {
    let mut recorder = Recorder::default();
    for generation in 0..3 {
        let genes: Vec<f64> = [1.0, 2.0, 3.0, 4.0, 5.0].map(|g| g + f64::from(generation)).into();
        let (first, other): (Vec<f64>, Vec<f64>) = genes.iter().map(|g| (*g, 2.0 * g)).unzip();
        let all = |first: u64| first..first + 5;
        let own = recorder.evaluated(&study(), &[0.0], &genomes(&genes), &simulated(&first));
        recorder.rated(all(own), &[4.0]);
        let own = recorder.evaluated(&second(), &[0.0], &genomes(&genes), &simulated(&other));
        recorder.rated(all(own), &[9.0]);
        let sums = genes.iter().map(|g| total((g - 4.0).powi(2), (2.0 * g - 9.0).powi(2)));
        recorder.ordered(&genomes(&genes), &sums.collect::<Vec<f64>>());
    }
    ended(recorder)
}

#[test]
fn a_generation_with_several_experiments_is_one() {
    let search = two_experiments(|a, b| a + b);
    assert_eq!((search.observed.history.generations.len(), search.evaluations), (3, 30));
    assert_eq!(search.observed.history.generations[0].best, 1.0, "not a partial sum");
    let best = search.best().unwrap();
    assert_eq!((best.genome[0], best.fitness), (4.0, 1.0));
    assert_eq!(best.objective, &Objective::SumOfSquares(vec![1.0, 1.0]));
    let models: Vec<&str> = best.compared.iter().map(|c| c.study.model.as_str()).collect();
    assert_eq!((models, best.sum_of_squares()), (vec!["M", "M2"], Some(1.0)));
}

#[test]
fn the_weights_of_the_script_are_found() {
    let search = two_experiments(|a, b| a + 0.25 * b);
    let best = search.best().unwrap();
    let Objective::SumOfSquares(weights) = best.objective else { panic!("{best:?}") };
    assert!((weights[0] - 1.0).abs() < 1e-9 && (weights[1] - 0.25).abs() < 1e-9);
    assert_eq!(*two_experiments(|a, b| a + b * b).best().unwrap().objective, Objective::Script);
}

#[test]
fn a_check_with_other_data_is_no_generation() {
    let mut recorder = Recorder::default();
    recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
    recorder.rated([1], &[0.0]);
    recorder.ordered(&genomes(&[5.0]), &[9.0]);
    recorder.evaluated(&study(), &[1.0], &genomes(&[5.0]), &simulated(&[3.0]));
    recorder.rated([2], &[3.0]);
    let search = ended(recorder);
    assert_eq!(search.observed.history.generations.len(), 1);
    assert_eq!(search.best().unwrap().fitness, 9.0);
    assert_eq!(search.best().unwrap().compared[0].measured, Some(vec![0.0]));
}

#[test]
fn own_sorting_ends_a_generation_with_the_next_simulation() {
    let mut recorder = Recorder::default();
    for value in [3.0, 2.0] {
        let one = recorder.evaluated(&study(), &[0.0], &genomes(&[value]), &simulated(&[value]));
        recorder.rated([one], &[0.0]);
    }
    assert_eq!(recorder.current().unwrap().observed.history.generations.len(), 1);
    let search = ended(recorder);
    assert_eq!(search.observed.history.generations.len(), 2);
    assert_eq!(search.best().unwrap().genome, [2.0]);
}

#[test]
fn own_fitness_is_taken_from_fit_order() {
    let mut recorder = Recorder::default();
    recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[7.0]));
    recorder.ordered(&genomes(&[5.0]), &[42.0]);
    let search = ended(recorder);
    assert_eq!(search.best().unwrap().fitness, 42.0);
    assert_eq!(search.best().unwrap().objective, &Objective::Script);
}

#[test]
fn with_own_fitness_and_own_sorting_the_sum_of_squares_is_assumed() {
    let mut recorder = Recorder::default();
    recorder.measured(Measurement { file: "d.mat".into(), x: vec![0.0], y: vec![1.0] });
    recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
    let search = ended(recorder);
    assert_eq!(search.best().unwrap().fitness, 4.0);
    assert_eq!(search.best().unwrap().objective, &Objective::Assumed);
}

#[test]
fn an_interrupted_generation_without_fitness_does_not_count() {
    let mut recorder = Recorder::default();
    recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
    recorder.ordered(&genomes(&[5.0]), &[9.0]);
    recorder.evaluated(&study(), &[0.0], &genomes(&[4.0]), &simulated(&[3.0]));
    let search = ended(recorder);
    assert_eq!(search.observed.history.generations.len(), 1);
    assert_eq!(search.evaluations, 2);
}

/// One generation of a search: individuals whose simulations are their genes.
fn generation_of(recorder: &mut Recorder, study: &Arc<Study>, genes: &[f64], measured: f64) {
    let population = genomes(genes);
    let first = recorder.evaluated(study, &[0.0], &population, &simulated(genes));
    recorder.rated(first..first + genes.len() as u64, &[measured]);
    let fitness: Vec<f64> = genes.iter().map(|gene| (gene - measured).powi(2)).collect();
    recorder.ordered(&population, &fitness);
}

/// Genes of the best individual, its fitness, generations and simulations of each search.
fn found(recorder: Recorder) -> Vec<(f64, f64, u64, u64)> {
    let one = |search: &ScriptSearch| {
        let best = search.best().unwrap();
        (best.genome[0], best.fitness, search.observed.generations(), search.evaluations)
    };
    recorder.finished().iter().map(one).collect()
}

/// The first search fits better: its best individual is none of the second.
#[test]
fn other_measured_values_are_another_search() {
    let mut recorder = Recorder::default();
    for generation in [0.0, 0.5] {
        generation_of(&mut recorder, &study(), &[3.0 - generation, 5.0, 4.0], 2.0);
    }
    for generation in [0.0, 0.5, 1.0] {
        generation_of(&mut recorder, &study(), &[3.0, 1.0, 4.0 + generation], 9.0);
    }
    assert_eq!(found(recorder), [(2.5, 0.25, 2, 6), (5.0, 16.0, 3, 9)]);
}

#[test]
fn searches_may_alternate_in_one_loop() {
    let mut recorder = Recorder::default();
    for generation in [0.0, 1.0] {
        generation_of(&mut recorder, &study(), &[3.0 - generation, 5.0], 1.0);
        recorder.searched(&[0.0], &[9.0], &genomes(&[2.0, 5.0]));
        generation_of(&mut recorder, &second(), &[30.0 - generation, 50.0, 60.0], 20.0);
        recorder.searched(&[0.0], &[90.0], &genomes(&[29.0, 50.0, 60.0]));
    }
    let searches = recorder.clone().finished();
    assert_eq!(found(recorder), [(2.0, 1.0, 2, 4), (29.0, 81.0, 2, 6)]);
    let ranges = |k: usize| searches[k].ranges.as_ref().unwrap().1[0];
    assert_eq!((ranges(0), ranges(1)), (9.0, 90.0));
}

/// Both populations are simulated and compared before either is sorted; at first they are the same.
#[test]
fn searches_may_be_sorted_after_both_were_compared() {
    let mut recorder = Recorder::default();
    let fitness = |genes: &[f64], measured: f64| -> Vec<f64> {
        genes.iter().map(|gene| (gene - measured).powi(2)).collect()
    };
    for generation in 0..3 {
        let one = [1.0, 2.0, 3.0, 4.0, 5.0 + f64::from(generation)];
        let other = if generation == 0 { one } else { [6.0, 7.0, 8.0, 9.0, 10.5] };
        let all = |first: u64| first..first + 5;
        let first = recorder.evaluated(&study(), &[0.0], &genomes(&one), &simulated(&one));
        recorder.rated(all(first), &[2.5]);
        let first = recorder.evaluated(&second(), &[0.0], &genomes(&other), &simulated(&other));
        recorder.rated(all(first), &[20.5]);
        recorder.ordered(&genomes(&one), &fitness(&one, 2.5));
        recorder.ordered(&genomes(&other), &fitness(&other, 20.5));
    }
    assert_eq!(found(recorder), [(2.0, 0.25, 3, 15), (10.5, 100.0, 3, 15)]);
}

/// The values of two models, compared by hand.
#[test]
fn models_that_are_simulated_once_each_are_two_searches() {
    for others in [[7.0, 8.0], [2.0, 1.0]] {
        let mut recorder = Recorder::default();
        for (study, genes) in [(study(), [1.0, 2.0]), (second(), others)] {
            let first = recorder.evaluated(&study, &[0.0], &genomes(&genes), &simulated(&genes));
            recorder.rated(first..first + 2, &[4.0]);
        }
        let other = (others[0], (others[0] - 4.0).powi(2), 1, 2);
        assert_eq!(found(recorder), [(2.0, 4.0, 1, 2), other]);
    }
}

/// The whole population is compared with data that do not count in its fitness, in some generations.
#[test]
fn data_that_do_not_count_are_no_search() {
    let mut recorder = Recorder::default();
    let genes = [1.0, 2.0, 3.0, 4.0, 5.0];
    for generation in 0..4 {
        if generation % 2 == 1 {
            let first = recorder.evaluated(&study(), &[7.0], &genomes(&genes), &simulated(&genes));
            recorder.rated(first..first + 5, &[8.5]);
        }
        generation_of(&mut recorder, &study(), &genes, 2.5);
    }
    assert_eq!(found(recorder), [(2.0, 0.25, 4, 30)]);
}

/// The second begins with another seed, which is none that the first continued with.
#[test]
fn each_search_has_the_seed_that_it_began_with() {
    let seed = |entry: f64| [entry; 6];
    let mut recorder = Recorder::default();
    for (measured, first) in [(2.0, 10.0), (9.0, 70.0)] {
        recorder.seeded(seed(first), seed(first + 1.0), 1);
        for generation in 1..=3 {
            generation_of(&mut recorder, &study(), &[3.0, 1.0, 4.0], measured);
            let state = first + f64::from(generation);
            recorder.seeded(seed(state), seed(state + 1.0), 2);
        }
    }
    let searches = recorder.finished();
    let seeds: Vec<_> = searches.iter().map(|search| search.seed).collect();
    assert_eq!(seeds, [Some(seed(10.0)), Some(seed(70.0))]);
    assert!(searches.iter().all(|search| search.changes.is_empty()));
}

/// Simulates and compares a population with these measured values.
fn compare(recorder: &mut Recorder, genes: &[f64], measured: f64) {
    let first = recorder.evaluated(&study(), &[0.0], &genomes(genes), &simulated(genes));
    recorder.rated(first..first + genes.len() as u64, &[measured]);
}

fn sort(recorder: &mut Recorder, genes: &[f64], fitness: impl Fn(f64) -> f64) {
    let fitness: Vec<f64> = genes.iter().map(|gene| fitness(*gene)).collect();
    recorder.ordered(&genomes(genes), &fitness);
}

fn square(measured: f64) -> impl Fn(f64) -> f64 {
    move |gene| (gene - measured).powi(2)
}

/// The same model at the same points, with other measured values; the first populations are the same.
#[test]
fn data_sets_may_be_sorted_after_both_were_compared() {
    let mut recorder = Recorder::default();
    for generation in 0..3 {
        let one = [1.0, 2.0, 3.0, 4.0, 5.0 + f64::from(generation)];
        let other = if generation == 0 { one } else { [6.0, 7.0, 2.0, 9.0, 10.5] };
        compare(&mut recorder, &one, 2.25);
        compare(&mut recorder, &other, 20.5);
        sort(&mut recorder, &one, square(2.25));
        sort(&mut recorder, &other, square(20.5));
    }
    assert_eq!(found(recorder), [(2.0, 0.0625, 3, 15), (10.5, 100.0, 3, 15)]);
}

/// Evaluated before the loop and after each mutation, so that the last generation is not sorted.
#[test]
fn populations_that_wait_are_sorted_by_their_searches() {
    let mut recorder = Recorder::default();
    let one = |k: i32| [1.0, 2.0, 3.0, 5.0 - f64::from(k)];
    let other = |k: i32| [6.0, 7.0, 8.0 + f64::from(k)];
    compare(&mut recorder, &one(0), 2.25);
    compare(&mut recorder, &other(0), 20.5);
    for k in 0..3 {
        sort(&mut recorder, &one(k), square(2.25));
        compare(&mut recorder, &one(k + 1), 2.25);
        sort(&mut recorder, &other(k), square(20.5));
        compare(&mut recorder, &other(k + 1), 20.5);
    }
    assert_eq!(found(recorder), [(2.0, 0.0625, 4, 16), (11.0, 90.25, 4, 12)]);
}

#[test]
fn individuals_of_two_searches_may_be_simulated_one_by_one() {
    let mut recorder = Recorder::default();
    for k in 0..3 {
        let one = [1.0, 2.0, 3.0 + f64::from(k)];
        let other = [6.0, 7.0, 8.0 + f64::from(k)];
        for (a, b) in one.into_iter().zip(other) {
            compare(&mut recorder, &[a], 2.25);
            compare(&mut recorder, &[b], 20.5);
        }
        sort(&mut recorder, &one, square(2.25));
        sort(&mut recorder, &other, square(20.5));
    }
    assert_eq!(found(recorder), [(2.0, 0.0625, 3, 9), (10.0, 110.25, 3, 9)]);
}

#[test]
fn islands_are_one_search() {
    let mut recorder = Recorder::default();
    for k in 0..3 {
        let one = [1.0, 5.0, 6.0];
        let other = if k == 0 { one } else { [2.0, 7.0, 8.0] };
        compare(&mut recorder, &one, 2.25);
        compare(&mut recorder, &other, 2.25);
        sort(&mut recorder, &one, square(2.25));
        sort(&mut recorder, &other, square(2.25));
    }
    assert_eq!(found(recorder), [(2.0, 0.0625, 6, 18)]);
}

#[test]
fn other_weights_are_another_function() {
    let mut recorder = Recorder::default();
    for generation in 0..4 {
        let genes = [1.0, 2.0, 3.0, 4.0 + f64::from(generation)];
        compare(&mut recorder, &genes, 2.25);
        let weight = if generation < 2 { 1.0 } else { 10.0 };
        sort(&mut recorder, &genes, |gene| weight * (gene - 2.25).powi(2));
    }
    assert_eq!(found(recorder), [(2.0, 0.0625, 2, 8), (2.0, 0.625, 2, 8)]);
}

/// Some individuals of later generations have a penalty: the script minimizes something else than a sum
/// of squares.
#[test]
fn a_penalty_makes_a_function_of_the_script() {
    let mut recorder = Recorder::default();
    for generation in 0..4 {
        let genes = [1.0, 2.0, 3.0, 4.0, 5.0];
        compare(&mut recorder, &genes, 2.25);
        let penalty = |gene: f64| if generation > 1 { (gene - 2.5).max(0.0) } else { 0.0 };
        sort(&mut recorder, &genes, |gene| (gene - 2.25).powi(2) + penalty(gene));
    }
    let search = ended(recorder);
    assert_eq!(search.best().unwrap().objective, &Objective::Script);
}

/// A script that narrows its ranges has searched in all of them.
#[test]
fn ranges_are_those_of_all_generations() {
    let mut recorder = Recorder::default();
    for generation in 0..4 {
        let genes = [1.0, 2.0, 3.0, 4.0];
        generation_of(&mut recorder, &study(), &genes, 2.25);
        let end = 9.0 - f64::from(generation);
        recorder.searched(&[1.0 / end], &[end], &genomes(&genes));
    }
    assert_eq!(ended(recorder).ranges, Some((vec![1.0 / 9.0], vec![9.0])));
}
