//! Results of calls between functions, kept until the next call of the same function.
//!
//! Properties of a medium are functions of its state, each of which begins with the same long
//! computation (`rho_ph` and `T_ph` of water both call `waterBaseProp_ph`). A call with the bits of
//! the arguments of the one before has its results, and is charged for the same instructions.

use super::code::{Code, Functions, Instruction};
use crate::arithmetic::{Dual, Number};

/// Functions with fewer instructions, which call nothing, are computed again: keeping costs as much.
const FEWEST: usize = 48;

/// The last call of each function, for each kind of number.
#[derive(Debug, Clone, Default)]
pub(crate) struct Memos {
    pub(super) values: Memo<f64>,
    pub(super) first: Memo<Dual<f64>>,
    pub(super) second: Memo<Dual<Dual<f64>>>,
    /// How many calls had the results of the one before.
    pub(super) recalled: u64,
}

/// The last call of each function.
#[derive(Debug, Clone)]
pub(crate) struct Memo<T> {
    known: Vec<Option<Known<T>>>,
}

impl<T> Default for Memo<T> {
    fn default() -> Memo<T> {
        Memo { known: Vec::new() }
    }
}

/// A call.
#[derive(Debug, Clone)]
struct Known<T> {
    arguments: Vec<T>,
    results: Vec<T>,
    cost: u64,
}

/// Numbers for which calls are kept.
pub(super) trait Kept: Number {
    /// The calls that a machine keeps for them.
    fn memo(memos: &mut Memos) -> &mut Memo<Self>;
}

impl Kept for f64 {
    fn memo(memos: &mut Memos) -> &mut Memo<f64> {
        &mut memos.values
    }
}

impl Kept for Dual<f64> {
    fn memo(memos: &mut Memos) -> &mut Memo<Dual<f64>> {
        &mut memos.first
    }
}

impl Kept for Dual<Dual<f64>> {
    fn memo(memos: &mut Memos) -> &mut Memo<Dual<Dual<f64>>> {
        &mut memos.second
    }
}

impl<T: Number> Memo<T> {
    /// Results and cost of the last call of a function, if it had these arguments.
    pub(super) fn find(&self, function: u32, arguments: &[T]) -> Option<(&[T], u64)> {
        let known = self.known.get(function as usize)?.as_ref()?;
        let pairs = || known.arguments.iter().zip(arguments);
        pairs().all(|(a, b)| a.has_bits_of(*b)).then_some((&known.results, known.cost))
    }

    /// Keeps a call in the place of the one before.
    pub(super) fn keep(&mut self, function: u32, arguments: &[T], results: &[T], cost: u64) {
        let at = function as usize;
        if self.known.len() <= at {
            self.known.resize_with(at + 1, || None);
        }
        let known = self.known[at].get_or_insert_with(|| Known {
            arguments: Vec::new(),
            results: Vec::new(),
            cost: 0,
        });
        known.arguments.clear();
        known.arguments.extend_from_slice(arguments);
        known.results.clear();
        known.results.extend_from_slice(results);
        known.cost = cost;
    }
}

/// For each function whether its calls are worth keeping: long, and made of nothing but arguments.
pub(super) fn worth_keeping(functions: &Functions) -> Box<[bool]> {
    let codes = &functions.codes;
    let callees = |code: &Code| -> Vec<usize> {
        let calls = code.instructions.iter().filter_map(|instruction| match instruction {
            Instruction::Call { function, .. } => Some(*function as usize),
            _ => None,
        });
        calls.collect()
    };
    let callees: Vec<Vec<usize>> = codes.iter().map(callees).collect();
    let is_plain = |code: &Code| {
        let has_values = code.externals.iter().all(|call| call.only_fails());
        !code.impure && !code.writes && has_values
    };
    let mut pure: Vec<bool> = codes.iter().map(is_plain).collect();
    // What calls an impure function is impure, at any depth.
    loop {
        let spoilt = |at: &usize| pure[*at] && callees[*at].iter().any(|callee| !pure[*callee]);
        let spoilt: Vec<usize> = (0..codes.len()).filter(spoilt).collect();
        if spoilt.is_empty() {
            break;
        }
        spoilt.into_iter().for_each(|at| pure[at] = false);
    }
    let is_long = |at: usize| codes[at].instructions.len() >= FEWEST || !callees[at].is_empty();
    (0..codes.len()).map(|at| pure[at] && is_long(at)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::Machine;
    use super::*;
    use crate::arithmetic::{Operation, Operator};

    /// x^65 in `long`, and `f(x, y) = long(x) + long(y)`.
    fn functions(impure: bool) -> Functions {
        let multiply: Instruction = Operation::binary(Operator::Mul, 1, 1, 0).into();
        let mut instructions = vec![Instruction::Move { d: 1, a: 0, n: 1 }];
        instructions.extend([multiply; 64]);
        let long = Code { instructions, impure, ..one_output(1, 1, 2) };
        let calls = [
            Instruction::Call { function: 0, d: 3, a: 0 },
            Instruction::Call { function: 0, d: 4, a: 1 },
            Operation::binary(Operator::Add, 2, 3, 4).into(),
        ];
        let both = Code { instructions: calls.to_vec(), ..one_output(2, 2, 5) };
        Functions { codes: vec![long, both], ..Functions::default() }
    }

    fn one_output(n_inputs: u32, outputs: u32, frame: u32) -> Code {
        Code { n_inputs, outputs, n_outputs: 1, frame, ..Code::default() }
    }

    /// The value, what it cost, and how often a call was known.
    fn call(machine: &mut Machine, functions: &Functions, x: f64, y: f64) -> (f64, u64, u64) {
        let before = machine.recalled();
        let value = machine.call(functions, 1, [x, y].into_iter()).expect("a value")[0];
        (value, machine.spent(), machine.recalled() - before)
    }

    #[test]
    fn a_call_with_the_arguments_of_the_one_before_is_not_repeated() {
        let functions = functions(false);
        let (mut plain, mut keeping) = (Machine::default(), Machine::of_fixed_functions());
        for (x, y, recalled) in [(1.25, 1.25, 1), (1.25, 1.5, 1), (1.25, 1.5, 0), (0.0, -0.0, 0)] {
            let (value, cost, repeated) = call(&mut plain, &functions, x, y);
            assert_eq!(repeated, 0);
            assert_eq!(call(&mut keeping, &functions, x, y), (value, cost, recalled));
        }
    }

    #[test]
    fn derivatives_are_kept_apart_from_values() {
        let functions = functions(false);
        let mut machine = Machine::of_fixed_functions();
        call(&mut machine, &functions, 1.0, 1.0);
        let partial = |machine: &mut Machine, input| {
            machine
                .partial(&functions, 1, &[input], [1.0, 1.0].into_iter())
                .expect("a partial derivative")[0]
        };
        assert_eq!((partial(&mut machine, 0), partial(&mut machine, 1)), (65.0, 65.0));
    }

    #[test]
    fn impure_functions_are_called_every_time() {
        let mut machine = Machine::of_fixed_functions();
        assert_eq!(call(&mut machine, &functions(true), 1.25, 1.25).2, 0);
    }
}
