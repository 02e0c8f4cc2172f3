//! Machine code and the interpreter agree to the bit.

use super::super::code::{Code, Functions, Instruction};
use super::super::direct_calls::call;
use super::super::failure::Reason;
use super::super::machine::{Machine, MachineRequest, execute};
use super::super::translation::translated;
use super::*;
use crate::arithmetic::Elementary;
use crate::arithmetic::{Dual, Number, Operation, Operator};
use crate::symbolic::RelationOperator;
use crate::symbolic::function::find;
use proptest::prelude::*;

/// Registers of the random functions; the first ones are numbers, the last ones rows.
const FRAME: u32 = 24;
const BUDGET: u64 = 400;
const OPERATORS: [RelationOperator; 3] =
    [RelationOperator::Less, RelationOperator::GreaterEqual, RelationOperator::NotEqual];

/// What an instruction is made of: its kind and four numbers.
type Draw = (u8, [u8; 4]);

fn elementary(name: &str) -> &'static Elementary {
    Elementary::of(find(name).expect("a function of the table"))
}

fn instruction((kind, [a, b, c, e]): Draw, n: usize) -> Instruction {
    let [d, a, b] = [a, b, c].map(|x| u32::from(x) % 8);
    let unary = |operator| Operation::unary(operator, d, a).into();
    let binary = |operator| Operation::binary(operator, d, a, b).into();
    let target = u32::from(e) % (n as u32 + 1);
    match kind % 24 {
        0 => Instruction::Constant { d, value: f64::from(e) - 100.0 },
        1 => Instruction::Move { d, a, n: 1 },
        2 => Instruction::Move { d, a, n: 1 + u32::from(e) % 16 },
        3 => unary(Operator::Neg),
        4 => unary(Operator::Not),
        5 | 6 => binary(Operator::Add),
        7 => binary(Operator::Sub),
        8 | 9 => binary(Operator::Mul),
        10 => binary(Operator::Div),
        11 => binary(Operator::Pow),
        12 => binary(Operator::Relation(OPERATORS[e as usize % 3])),
        13 => unary(Operator::Unary(elementary("sin"))),
        14 => unary(Operator::Unary(elementary(["sqrt", "exp"][e as usize % 2]))),
        15 => binary(
            [Operator::Binary(elementary("atan2")), Operator::And, Operator::Or][e as usize % 3],
        ),
        16 => Instruction::Offset { d, subscript: a, size: 5, stride: 1 + b % 3 },
        17 => Instruction::Load { d, base: 8 + b, offset: a },
        18 => Instruction::Store { base: 8 + b, offset: d, a },
        19 => Instruction::Jump { target },
        20 | 21 => Instruction::JumpUnless { a, target },
        22 => Instruction::Check { a, n: u32::from(e) % 16 },
        _ => match e % 5 {
            0 => Instruction::Iterations { d, range: a },
            1 => Instruction::Call { function: 0, d: 8, a: 8 },
            2 => Instruction::Warn { a, message: 0 },
            3 => Instruction::Unassign { d, n: 1 + u32::from(e) % 16 },
            _ => Instruction::Assert { a, message: 0 },
        },
    }
}

fn function(draws: &[Draw]) -> Functions {
    let instructions = draws.iter().map(|draw| instruction(*draw, draws.len())).collect();
    let code = Code {
        instructions,
        n_inputs: 8,
        n_outputs: 8,
        outputs: 8,
        frame: FRAME,
        messages: vec!["no".into()],
        ..Code::default()
    };
    Functions { codes: vec![code], ..Functions::default() }
}

/// What a frame comes to: the event, the place, the budget and all parts of its numbers, without what
/// distinguishes one NaN from another.
type Outcome = (Result<Option<MachineRequest>, Reason>, usize, u64, Vec<Option<u64>>);

fn outcome<T: Number + std::fmt::Debug>(
    translated: Option<&Translated>,
    code: &Code,
    frame: &[T],
    parts_of: impl Fn(&T) -> Vec<f64>,
) -> Outcome {
    let (mut at, mut budget, mut frame) = (0, BUDGET, frame.to_vec());
    if let Some(translated) = translated {
        translated.check(frame.len(), T::PARTS);
        let (first, budget) = (frame.as_mut_ptr().cast(), &raw mut budget);
        // SAFETY: the frame has the registers of the function; no function is called.
        at = unsafe { translated.enter(at, first, f64::NAN, budget, std::ptr::null_mut()) };
    }
    let request = execute(code, &mut at, &mut frame, f64::NAN, &mut budget, 0);
    let parts = frame.iter().flat_map(parts_of);
    let bits = parts.map(|part| (!part.is_nan()).then_some(part.to_bits())).collect();
    (request, at, budget, bits)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn machine_code_does_what_the_interpreter_does(
        draws in prop::collection::vec((any::<u8>(), any::<[u8; 4]>()), 1..40),
        values in prop::collection::vec(
            prop_oneof![Just(0.0), Just(1.0), Just(2.0), Just(3.0), Just(f64::NAN), -5.0f64..9.0],
            FRAME as usize,
        ),
        tangents in prop::collection::vec(-2.0f64..2.0, FRAME as usize),
    ) {
        let functions = function(&draws);
        let code = &functions.codes[0];
        let on_values = translated::<f64>(&functions, code, call::<Machine, f64>).expect("all can be translated");
        let own = |x: &f64| vec![*x];
        prop_assert_eq!(
            outcome(Some(&on_values), code, &values, own),
            outcome(None, code, &values, own)
        );
        let on_duals = translated(&functions, code, call::<Machine, Dual<f64>>).expect("all can be translated");
        let duals: Vec<Dual<f64>> =
            values.iter().zip(&tangents).map(|(v, d)| Dual { v: *v, d: *d }).collect();
        let both = |x: &Dual<f64>| vec![x.v, x.d];
        prop_assert_eq!(
            outcome(Some(&on_duals), code, &duals, both),
            outcome(None, code, &duals, both)
        );
    }
}

/// `for i in 1 : n loop y := f(y) + i*x; end for`, where `f(y) = y/2`.
fn a_loop() -> Functions {
    let half = Code {
        instructions: vec![Operation::binary(Operator::Mul, 1, 0, 2).into()],
        n_inputs: 1,
        outputs: 1,
        n_outputs: 1,
        frame: 3,
        constants: vec![(2, 0.5)],
        ..Code::default()
    };
    // x 0, n 1, y 2, i 3, 1 4, condition 5, f(y) 6, i*x 7
    let instructions = vec![
        Operation::binary(Operator::Relation(RelationOperator::LessEqual), 5, 3, 1).into(),
        Instruction::JumpUnless { a: 5, target: 7 },
        Instruction::Call { function: 1, d: 6, a: 2 },
        Operation::binary(Operator::Mul, 7, 3, 0).into(),
        Operation::binary(Operator::Add, 2, 6, 7).into(),
        Operation::binary(Operator::Add, 3, 3, 4).into(),
        Instruction::Jump { target: 0 },
    ];
    let sum = Code {
        instructions,
        n_inputs: 2,
        outputs: 2,
        n_outputs: 1,
        frame: 8,
        constants: vec![(2, 0.0), (3, 1.0), (4, 1.0)],
        ..Code::default()
    };
    Functions { codes: vec![sum, half], ..Functions::default() }
}

/// y and dy/dx of [`a_loop`], with y' = y/2 + i from x = 1.
fn expected(x: f64, n: u32) -> (f64, f64) {
    let step = |(y, tangent), i| (y * 0.5 + f64::from(i) * x, tangent * 0.5 + f64::from(i));
    (1..=n).fold((0.0, 0.0), step)
}

#[test]
fn a_function_becomes_machine_code_while_it_runs() {
    let functions = a_loop();
    let mut machine = Machine::default();
    for n in [3, 10, 300_000, 20] {
        let arguments = [0.75, f64::from(n)];
        let (y, tangent) = expected(0.75, n);
        assert_eq!(machine.call(&functions, 0, arguments.into_iter()), Ok(&[y][..]));
        assert_eq!(machine.partial(&functions, 0, &[0], arguments.into_iter()), Ok(&[tangent][..]));
        let is_translated = |code: &Code| {
            [0, 1].map(|parts| matches!(code.machine_code[parts].translated.get(), Some(Some(_))))
        };
        assert_eq!(is_translated(&functions.codes[0]), [n > 10; 2]);
    }
}

/// `f(n, x) = if n < 1 then sqrt(x) else f(n - 1, x - 1) + f(n - 1, x)`.
fn a_recursion() -> Functions {
    // n 0, x 1, f 2, 1 3, condition 4, arguments 5 and 6, results 7 and 8
    let call = |d| Instruction::Call { function: 0, d, a: 5 };
    let instructions = vec![
        Operation::binary(Operator::Relation(RelationOperator::Less), 4, 0, 3).into(),
        Instruction::JumpUnless { a: 4, target: 4 },
        Operation::unary(Operator::Unary(elementary("sqrt")), 2, 1).into(),
        Instruction::Jump { target: 10 },
        Operation::binary(Operator::Sub, 5, 0, 3).into(),
        Operation::binary(Operator::Sub, 6, 1, 3).into(),
        call(7),
        Instruction::Move { d: 6, a: 1, n: 1 },
        call(8),
        Operation::binary(Operator::Add, 2, 7, 8).into(),
    ];
    let code = Code {
        instructions,
        n_inputs: 2,
        outputs: 2,
        n_outputs: 1,
        frame: 9,
        constants: vec![(3, 1.0)],
        ..Code::default()
    };
    Functions { codes: vec![code], ..Functions::default() }
}

#[test]
fn machine_code_calls_as_the_interpreter_does() {
    let translated = a_recursion();
    let mut machine = Machine::default();
    for _ in 0..4 {
        machine.call(&translated, 0, [12.0, 20.0].into_iter()).expect("a value");
        machine.partial(&translated, 0, &[1], [12.0, 20.0].into_iter()).expect("a derivative");
    }
    for machine_code in &translated.codes[0].machine_code {
        assert!(matches!(machine_code.translated.get(), Some(Some(_))));
    }
    // The third fails in a call 12 deep; the fourth is nested too deep.
    for arguments in [[3.0, 7.0], [11.0, 20.0], [12.0, 11.5], [3_000.0, 9_000.0]] {
        // A new machine has a stack that grows while machine code runs.
        let outcome = |functions: &Functions| {
            let mut machine = Machine::default();
            let value = machine.call(functions, 0, arguments.into_iter()).map(|y| y[0]);
            let spent = machine.spent();
            let partial = machine.partial(functions, 0, &[1], arguments.into_iter()).map(|y| y[0]);
            (value, spent, partial, machine.spent())
        };
        let interpreted = a_recursion();
        assert_eq!(outcome(&translated), outcome(&interpreted));
        assert!(interpreted.codes[0].machine_code[0].translated.get().is_none());
    }
}
