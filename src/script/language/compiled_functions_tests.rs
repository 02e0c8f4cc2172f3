//! Functions that scripts call again and again: the same values, warnings and errors as before.

use crate::Session;
use crate::value::Value;
use crate::world::MemoryWorld;

/// More calls than it takes to compile a function.
const CALLS: usize = 6;

fn session(classes: &str) -> (Session, impl Fn() -> String) {
    let world = MemoryWorld::new();
    let streams = world.streams();
    let mut session = Session::new(Box::new(world));
    session.load_text("Functions.mo", classes).expect("classes");
    (session, move || streams.output() + &streams.errors())
}

/// How many calls compiled functions answered.
fn compiled(session: &Session) -> u64 {
    session.functions.compiled.as_ref().map_or(0, |functions| functions.calls())
}

/// The value of a variable as it is written, with the sign of zero.
fn text(value: Option<&Value>) -> String {
    format!("{value:?}")
}

const FUNCTIONS: &str = include_str!("compiled_functions/functions.mo");

#[test]
fn compiled_functions_give_what_their_statements_give() {
    let calls = [
        "F.series(2.5, 40)",
        "F.sorted({3.0, -1.0, 2.0, 2.0})",
        "F.collatz(27)",
        "F.fibonacci(15)",
        "F.product([1.0, 2.0; 3.0, 4.0], {0.5, -0.5})",
        "F.sized(3)",
        "F.sized(4)",
        "F.isIn(2, {1, 2, 3})",
        "F.collatz(837799)",
        "F.zero(-3)",
        "F.exponents(3.7)",
    ];
    for call in calls {
        let (mut session, said) = session(FUNCTIONS);
        assert_eq!(session.run_text("first.mos", &format!("y := {call};\n")).code, 0, "{}", said());
        let expected = text(session.variable("y"));
        let again = format!("for i in 1:{CALLS} loop y := {call}; end for;\n");
        assert_eq!(session.run_text("again.mos", &again).code, 0, "{}", said());
        assert_eq!(text(session.variable("y")), expected, "{call}");
        assert!(compiled(&session) > 0, "{call} is not compiled");
    }
}

/// What a script says on one line, and its exit code.
fn run(script: &str) -> (u8, String) {
    let (mut session, said) = session(FUNCTIONS);
    let code = session.run_text("run.mos", script).code;
    (code, said())
}

#[test]
fn compiled_functions_fail_as_their_statements_do() {
    // The argument with which the call fails, after calls that do not.
    let calls = [
        ("F.grown(N)", "1.0", "1e300"),
        ("F.hidden(N)", "1.0", "1e200"),
        ("F.ratio(N)", "1.0", "0.0"),
        ("F.root(N)", "1.0", "-1.0"),
        ("F.checked(N)", "1.0", "-1.0"),
        ("F.unassigned(N)", "1.0", "-1.0"),
        ("F.third({1.0, 2.0, 3.0}, N)", "3", "4"),
        ("F.generator(N)", "3", "9223372036854775807"),
        ("F.generator(N)", "3", "4503599627370496"),
    ];
    for (call, good, bad) in calls {
        let (before, after) = (call.replace('N', good), call.replace('N', bad));
        let alone = run(&format!("y := {after};\n"));
        let warm: String = std::iter::repeat_n(format!("y := {before};\n"), CALLS).collect();
        let (code, said) = run(&format!("{warm}y := {after};\n"));
        assert_eq!(code, alone.0, "{call}: {said}");
        let first = |said: &str| said.lines().find(|l| l.starts_with("error")).map(str::to_owned);
        assert!(first(&said).is_some(), "{call}: {said}");
        assert_eq!(first(&said), first(&alone.1), "{call}");
    }
}

#[test]
fn a_compiled_function_warns_at_each_call() {
    let calls: String = std::iter::repeat_n("y := F.warned(-1.0);\n", CALLS).collect();
    let (code, said) = run(&calls);
    assert_eq!((code, said.matches("]: below zero").count()), (0, CALLS), "{said}");
}

#[test]
fn a_function_that_is_loaded_again_is_compiled_again() {
    let (mut session, said) = session("function f input Real x; output Real y = 2*x; end f;");
    let calls = format!("for i in 1:{CALLS} loop y := f(3.0); end for;\n");
    session.run_text("a.mos", &calls);
    assert_eq!(text(session.variable("y")), text(Some(&Value::Real(6.0))), "{}", said());
    session
        .load_text("Functions.mo", "function f input Real x; output Real y = 5*x; end f;")
        .expect("a function");
    session.run_text("b.mos", &calls);
    assert_eq!(text(session.variable("y")), text(Some(&Value::Real(15.0))), "{}", said());
    assert!(compiled(&session) > 0);
}

#[test]
fn functions_that_print_are_not_compiled() {
    let calls: String = std::iter::repeat_n("y := F.printing(1.0);\n", CALLS).collect();
    let (code, said) = run(&calls);
    assert_eq!((code, said.matches("printed").count()), (0, CALLS), "{said}");
}

#[test]
fn integers_that_reals_do_not_hold_are_exact() {
    let (mut session, said) = session(FUNCTIONS);
    let script = format!("for i in 1:{CALLS} loop y := F.generator(123456789); end for;\n");
    assert_eq!(session.run_text("run.mos", &script).code, 0, "{}", said());
    let exact = (1_103_515_245_i64 * 123_456_789 + 12_345) % 2_147_483_648;
    assert_eq!(text(session.variable("y")), text(Some(&Value::Integer(exact))));
}

#[test]
fn a_function_that_fails_when_compiled_is_left_to_its_statements() {
    let runs = |session: &Session| {
        session.functions.compiled.as_ref().map_or(0, |functions| functions.runs())
    };
    let (mut session, said) = session(FUNCTIONS);
    session.run_text("run.mos", "for i in 1:150 loop y := F.warned(-1.0); end for;\n");
    assert_eq!((runs(&session), compiled(&session)), (100, 0), "{}", said());
    // Where it has values for other arguments, it is compiled for them.
    let (mut session, said) = self::session(FUNCTIONS);
    let script = "for i in 1:150 loop y := F.warned(-1.0); y := F.warned(1.0); end for;\n";
    session.run_text("run.mos", script);
    assert_eq!((runs(&session), compiled(&session)), (298, 149), "{}", said());
}

/// Each of three functions has 48,000 instructions.
#[test]
fn the_length_of_one_function_does_not_count_for_another() {
    let function = |name: &str| {
        format!(
            "function {name} input Real x[:]; output Real y; algorithm y := sum(2*x + x .* x);
             end {name};"
        )
    };
    let names = ["first", "second", "third"];
    let classes = names.map(function).concat();
    let (mut session, said) = session(&classes);
    let calls = names.map(|name| format!("y := {name}(x);")).concat();
    let script = format!("x := ones(6000)*0.5; for i in 1:{CALLS} loop {calls} end for;\n");
    assert_eq!(session.run_text("run.mos", &script).code, 0, "{}", said());
    let answered = (CALLS - 2) * names.len();
    assert_eq!(compiled(&session), answered as u64);
}
