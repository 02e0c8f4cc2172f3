//! What holds for every entry of the tables of operators.

use super::crossover::Parents;
use super::mutation::{Child, Course};
use super::operators::{self, KINDS, Size, kind};
use super::{Gene, Genomes, Mrg32k3a, crossover};
use crate::registry::{BAD_OPTION, Choice, UNKNOWN_CHOICE};
use proptest::prelude::*;

fn names(of: &str) -> Vec<&'static str> {
    let kind = kind(of).expect("a kind");
    (kind.entries)().iter().map(|entry| entry.name).collect()
}

fn rng(seed: u32) -> Mrg32k3a {
    Mrg32k3a::new(&[f64::from(seed) + 1.0; 6]).unwrap()
}

/// Ranges of very different sizes, one of them empty.
fn genes() -> Vec<Gene> {
    let ranges = [(0.0, 1.0), (-3e5, 2e7), (1e-9, 1e-8), (4.0, 4.0), (-2.0, -1.0)];
    ranges.map(|(min, max)| Gene::new("g", min, max).unwrap()).to_vec()
}

fn is_within(genome: &[f64]) -> bool {
    genome.iter().zip(genes()).all(|(value, gene)| (gene.min..=gene.max).contains(value))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Bounds hold, and equal random numbers give equal bits.
    #[test]
    fn crossover_and_mutation_keep_to_the_ranges(
        at in prop::collection::vec(0.0..=1.0_f64, 10),
        rate in 0.0..=1.0_f64,
        generation in 0..200_u64,
        seed in 0..1000_u32,
    ) {
        let all = genes();
        let parent = |from: usize| -> Vec<f64> {
            all.iter().zip(&at[from..]).map(|(gene, &u)| gene.at(u)).collect()
        };
        for name in names("crossover") {
            let run = || {
                let (mut rng, [mut a, mut b]) = (rng(seed), [parent(0), parent(5)]);
                let own = operators::crossover(Choice::named(name)).unwrap();
                let own = own.for_run(all.len(), &mut rng).unwrap_or(own);
                own.cross(Parents { first: &mut a, second: &mut b, genes: &all }, &mut rng).unwrap();
                (a, b)
            };
            let (a, b) = run();
            prop_assert!(is_within(&a) && is_within(&b), "{} {:?} {:?}", name, a, b);
            prop_assert_eq!(run(), (a, b));
        }
        for name in names("mutation") {
            let run = |rate: f64| {
                let (mut rng, mut genome) = (rng(seed), parent(0));
                let own = operators::mutation(Choice::named(name)).unwrap();
                let course = Course { generation, planned: None };
                own.mutate(Child { genome: &mut genome, genes: &all, rate, course }, &mut rng).unwrap();
                genome
            };
            prop_assert!(is_within(&run(rate)), "{} {:?}", name, run(rate));
            prop_assert_eq!(run(rate), run(rate));
            prop_assert_eq!(run(0.0), parent(0), "{}", name);
        }
    }

    #[test]
    fn samplings_keep_to_the_ranges(count in 0..40_usize, seed in 0..1000_u32) {
        for name in names("sampling") {
            let own = operators::sampling(Choice::named(name)).unwrap();
            let genomes = own.sample(&genes(), count, &mut rng(seed)).unwrap();
            prop_assert_eq!(genomes.len(), count);
            prop_assert!(genomes.rows().all(is_within), "{}", name);
            let other = own.sample(&genes(), count, &mut rng(seed + 1)).unwrap();
            prop_assert!(count == 0 || genomes != other, "{} does not depend on the seed", name);
        }
    }

    /// Whatever the fitness is, there are as many parents as requested; failed ones only where no
    /// other is left, except for operators that do not read the fitness.
    #[test]
    fn selections_choose_as_many_as_requested(
        fitness in prop::collection::vec(prop_oneof![
            4 => -1e3..1e3_f64, 1 => Just(f64::NAN), 1 => Just(1e60), 1 => Just(f64::MAX), 1 => Just(-1e300),
        ], 1..30),
        count in 0..50_usize,
        seed in 0..1000_u32,
    ) {
        for name in names("selection") {
            let own = operators::selection(Choice::named(name)).unwrap();
            let chosen = own.select(&fitness, count, &mut rng(seed)).unwrap();
            prop_assert_eq!(chosen.len(), count, "{}", name);
            prop_assert!(chosen.iter().all(|&k| k < fitness.len()), "{} {:?}", name, chosen);
        }
    }

    /// The genes of a pair are exchanged, nothing else.
    #[test]
    fn discrete_crossovers_exchange_genes(seed in 0..1000_u32, n in 1..9_usize) {
        let genes = vec![Gene::new("g", 0.0, 100.0).unwrap(); n];
        for name in ["uniform", "one_point", "two_point", "fixed_points"] {
            let mut rng = rng(seed);
            let own = operators::crossover(Choice::named(name)).unwrap();
            let own = own.for_run(n, &mut rng).unwrap_or(own);
            let parents = [(0..n).map(|k| k as f64).collect(), (50..50 + n).map(|k| k as f64).collect()];
            let [mut a, mut b]: [Vec<f64>; 2] = parents.clone();
            own.cross(Parents { first: &mut a, second: &mut b, genes: &genes }, &mut rng).unwrap();
            let mut borders = 0;
            for k in 0..n {
                let pair = [a[k], b[k]];
                let same = [parents[0][k], parents[1][k]];
                prop_assert!(pair == same || pair == [same[1], same[0]], "{}", name);
                borders += usize::from(k > 0 && (a[k] == same[0]) != (a[k - 1] == parents[0][k - 1]));
            }
            match name {
                "one_point" | "fixed_points" => prop_assert_eq!(borders, usize::from(n > 1)),
                "two_point" => {
                    let domain = if n > 1 { 1..=2 } else { 0..=0 };
                    prop_assert!(domain.contains(&borders));
                }
                _ => {}
            }
        }
    }
}

/// Every place of a cut is as likely as the others; a gene changes places with the probability
/// `swap`.
#[test]
fn cuts_are_uniform() {
    let genes = vec![Gene::new("g", 0.0, 1.0).unwrap(); 5];
    let mut rng = rng(1);
    let one_point = operators::crossover(Choice::named("one_point")).unwrap();
    let uniform = operators::crossover(Choice::parse("uniform(swap = 0.2)").unwrap()).unwrap();
    let (mut cuts, mut swapped) = ([0.0; 5], 0.0);
    for _ in 0..8000 {
        let [mut a, mut b] = [vec![0.0; 5], vec![1.0; 5]];
        one_point
            .cross(Parents { first: &mut a, second: &mut b, genes: &genes }, &mut rng)
            .unwrap();
        cuts[a.iter().position(|value| *value == 1.0).unwrap()] += 1.0;
        let [mut a, mut b] = [vec![0.0; 5], vec![1.0; 5]];
        uniform.cross(Parents { first: &mut a, second: &mut b, genes: &genes }, &mut rng).unwrap();
        swapped += a.iter().sum::<f64>() / 5.0;
    }
    assert_eq!(cuts[0], 0.0);
    assert!(cuts[1..].iter().all(|count| (count - 2000.0_f64).abs() < 200.0), "{cuts:?}");
    assert!((swapped / 8000.0 - 0.2).abs() < 0.01, "{swapped}");
}

/// Arithmetic children keep the sum of their parents and lie between them; those of BLX-α are
/// uniform over the widened interval.
#[test]
fn children_lie_where_the_papers_say() {
    let genes = vec![Gene::new("g", -10.0, 10.0).unwrap()];
    let mut rng = rng(2);
    let arithmetic = operators::crossover(Choice::named("arithmetic")).unwrap();
    let blend = operators::crossover(Choice::parse("blx(alpha = 0.5)").unwrap()).unwrap();
    let mut all = Vec::new();
    for _ in 0..2000 {
        let [mut a, mut b] = [[1.0], [2.0]];
        arithmetic
            .cross(Parents { first: &mut a, second: &mut b, genes: &genes }, &mut rng)
            .unwrap();
        assert!((a[0] + b[0] - 3.0).abs() < 1e-14 && (1.0..=2.0).contains(&a[0]));
        let [mut a, mut b] = [[1.0], [2.0]];
        blend.cross(Parents { first: &mut a, second: &mut b, genes: &genes }, &mut rng).unwrap();
        all.extend([a[0], b[0]]);
    }
    all.sort_by(f64::total_cmp);
    // Kolmogorov-Smirnov at 0.1 %.
    let gap = |(k, value): (usize, &f64)| {
        ((k as f64 + 0.5) / all.len() as f64 - (value - 0.5) / 2.0).abs()
    };
    let largest = all.iter().enumerate().map(gap).fold(0.0, f64::max);
    assert!(largest < 1.95 / (all.len() as f64).sqrt(), "{largest}");
}

#[test]
fn an_odd_last_parent_mates_with_the_first() {
    let parents = Genomes::new(1, vec![1.0, 2.0, 3.0]).unwrap();
    let mut pairs = Vec::new();
    let children = crossover::cross_rows(&parents, |a, b| {
        pairs.push([a[0], b[0]]);
        a.swap_with_slice(b);
        Ok(())
    });
    assert_eq!(children.unwrap().values(), [2.0, 1.0, 1.0]);
    assert_eq!(pairs, [[1.0, 2.0], [3.0, 1.0]]);
}

/// Every setting of every entry refuses what is not a number and what is far outside its domain.
#[test]
fn settings_are_checked() {
    let fails = |kind: &str, choice: Choice| match kind {
        "sampling" => operators::sampling(choice).err(),
        "selection" => operators::selection(choice).err(),
        "crossover" => operators::crossover(choice).err(),
        "mutation" => operators::mutation(choice).err(),
        _ => operators::survival(choice).err(),
    };
    for kind in &KINDS {
        let misspelt = fails(kind.name, Choice::named("rouletta")).unwrap();
        assert_eq!(misspelt.code, UNKNOWN_CHOICE);
        for entry in (kind.entries)() {
            assert!(fails(kind.name, Choice::named(entry.name)).is_none(), "{}", entry.name);
            let strange =
                fails(kind.name, Choice::parse(&format!("{}(x = 1)", entry.name)).unwrap());
            assert!(strange.unwrap().message.contains("unknown option `x`"), "{}", entry.name);
            for setting in entry.settings {
                for value in [f64::NAN, f64::INFINITY, -1e300] {
                    let mut choice = Choice::named(entry.name);
                    choice.options.set(&setting.name, value);
                    let fault = fails(kind.name, choice).expect("a value outside the domain");
                    assert_eq!(fault.code, BAD_OPTION);
                    assert!(fault.message.contains(&setting.name), "{}", fault.message);
                }
            }
        }
    }
    let help = fails("selection", Choice::named("rouletta")).unwrap().helps;
    assert!(help[0].contains("`roulette`") && help[1].contains("tournament"), "{help:?}");
}

#[test]
fn declarations_of_own_operators_have_the_sizes_of_their_signatures() {
    for kind in &KINDS {
        let declaration = kind.declaration();
        for (name, size) in kind.signature.inputs.iter().chain(kind.signature.outputs) {
            let dims = match size {
                Size::One => "",
                Size::Genes => "[:]",
                Size::Random => "[:,3]",
            };
            assert!(declaration.contains(&format!(" Real {name}{dims};\n")), "{declaration}");
        }
    }
}
