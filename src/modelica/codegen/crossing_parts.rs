//! Code for a few crossing functions at a time.
//!
//! The search for an event narrows a step around the functions that have changed their signs. Each of
//! them needs a small part of the model: the flow between two volumes, not all flows of a layer.
//! Narrowing takes half of the instructions then in FC3Layer of FuelCellLib 1.0, which has 136 functions.

use super::code::CrossingPart;
use super::hoist::Hoisting;
use super::registers::Registers;
use super::sequence::{compile_continuous, slice};
use crate::causalize::Assignment;
use crate::symbolic::{Expr, Pool, VarId};
use rustc_hash::FxHashSet;

/// Functions times assignments of a model, which slicing goes through. Chosen, not measured.
const MOST_WORK: usize = 10_000_000;
/// Assignments of all parts relative to those of all functions at once. Where parts have more in common,
/// all are evaluated at once. Chosen, not measured.
const MOST_REPEATED: usize = 2;
/// Assignments that a function shares with a part, for each that it adds to it. Chosen, not measured.
const MOST_OWN: usize = 4;

/// The parts of the crossing functions of relations, of which these are the sides, two for each; none where
/// they would not be smaller.
pub(super) fn crossing_parts(
    pool: &Pool,
    registers: &mut Registers,
    sequence: &[Assignment],
    sides: &[Expr],
) -> Vec<CrossingPart> {
    if sides.len() <= 2 || sides.len() / 2 * sequence.len() > MOST_WORK {
        return Vec::new();
    }
    let groups = groups(pool, sequence, sides);
    let all = slice(pool, sequence, sides).len();
    let repeated: usize = groups.iter().map(|group| group.needed.len()).sum();
    if groups.len() < 2 || repeated > MOST_REPEATED * all {
        return Vec::new();
    }
    let part = |group: &Group| {
        let own = &sides[2 * group.first..2 * group.end];
        let code = compile_continuous(pool, registers, sequence, own, Hoisting::Total);
        CrossingPart { first: group.first, code }
    };
    groups.iter().map(part).collect()
}

/// Functions from `first` to before `end`, and the variables that they need.
struct Group {
    first: usize,
    end: usize,
    needed: FxHashSet<VarId>,
}

fn groups(pool: &Pool, sequence: &[Assignment], sides: &[Expr]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (number, both) in sides.chunks_exact(2).enumerate() {
        let needed = slice(pool, sequence, both);
        if let Some(last) = groups.last_mut() {
            let shared = needed.iter().filter(|a| last.needed.contains(&a.variable)).count();
            if MOST_OWN * (needed.len() - shared) <= shared {
                last.needed.extend(needed.iter().map(|a| a.variable));
                last.end = number + 1;
                continue;
            }
        }
        let needed = needed.into_iter().map(|a| a.variable).collect();
        groups.push(Group { first: number, end: number + 1, needed });
    }
    groups
}

#[cfg(test)]
mod tests {
    use crate::causalize::causalize;
    use crate::codegen::Program;
    use crate::flatten::{Library, flatten};
    use crate::sim::{Events, Residual};
    use crate::source::SourceId;
    use crate::syntax::parse_stored_definition;

    const CHAIN: &str = "model M Real x[6](start = {1, 3, 2, 5, 4, 6}, each fixed = true); Real q[5]; \
        equation for i in 1:5 loop q[i] = exp(x[i]) - exp(x[i + 1]); end for; der(x[1]) = -q[1]; \
        for i in 2:5 loop der(x[i]) = if q[i] > 0.1 then q[i - 1] - 2*q[i] else q[i - 1] - q[i]; end for; \
        der(x[6]) = if q[1] > 0 then q[5] else 0; end M;";

    #[test]
    fn each_part_gives_the_bits_of_all_functions() {
        let file = parse_stored_definition(SourceId::NONE, CHAIN).expect("Modelica");
        let mut library = Library::new();
        let names = library.load(&file).expect("a loadable file");
        let flat = flatten(&library, &names[0], &[]).expect("a model").model;
        let program = Program::compile(causalize(&flat).expect("it can be sorted"));
        let program = program.expect("it compiles");
        let mut system = program.system();
        let (n, parts) = (system.n_crossings(), program.switching.crossing_parts.len());
        assert_eq!((n, parts), (5, 5), "relations share no flow");
        let mut y = vec![0.0; system.n_differential()];
        system.initialize(0.0, &mut y).expect("start values");
        let (mut all, mut one) = (vec![0.0; n], vec![0.0; n]);
        system.crossings(0.0, &y, &mut all).expect("values");
        for which in [vec![0], vec![3], vec![1, 4]] {
            one.fill(f64::NAN);
            system.crossings_among(0.0, &y, &which, &mut one).expect("values");
            for at in 0..n {
                let expected = if which.contains(&at) { all[at] } else { f64::NAN };
                assert_eq!(one[at].to_bits(), expected.to_bits(), "{at} of {which:?}");
            }
        }
    }
}
