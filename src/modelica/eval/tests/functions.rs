//! Tests of calling functions.

use super::host::TestHost;
use super::{Scope, run, run_fails, run_in, try_run};
use crate::value::Value;

const QUADRATIC: &str = "
function f \"r and n\"
  input Real x;
  input Real w = 2*x;
  output Real r = x + w;
  output Integer n = 7;
algorithm
end f;
";

#[test]
fn arguments_go_to_inputs_by_place_and_by_name() {
    assert_eq!(run(QUADRATIC, "f(3, w=4) + 0"), "7.0");
    assert_eq!(run(QUADRATIC, "f(3) + 0"), "9.0");
    assert_eq!(run(QUADRATIC, "f(w=1, x=2) + 0"), "3.0");
    assert_eq!(
        run(&format!("{QUADRATIC} (a, b) := f(1); (, c) := f(2);"), "{a, b, c}"),
        "{3.0, 7.0, 7.0}"
    );
}

#[test]
fn wrong_calls_say_what_is_wrong() {
    let with = |call: &str| run_fails(&format!("{QUADRATIC} y := {call};"));
    assert_eq!(with("f(1, 2, 3)"), "wrong-arguments: `f` takes at most 2 arguments");
    assert_eq!(with("f()"), "wrong-arguments: the input `x` of `f` is missing and has no default");
    assert_eq!(with("f(1, v=2)"), "wrong-arguments: `f` has no input `v`");
    assert_eq!(with("f(1, x=2)"), "wrong-arguments: the input `x` of `f` is specified twice");
    assert_eq!(with("f(\"a\")"), "type-mismatch: `x`: expected a value of type Real, got String");
    assert_eq!(with("g(1)"), "unknown-function: there is no function `g`");
    assert!(with("sin(1, 2)").starts_with("wrong-arguments"));
}

#[test]
fn errors_inside_a_function_carry_the_calls() {
    let script = "
function divide input Real x; output Real y; algorithm y := 1/x; end divide;
function call input Real x; output Real y; algorithm y := divide(x - x); end call;
";
    let error = try_run(script, "call(2)").expect_err("divides by zero");
    assert_eq!(error.code.slug, "division-by-zero");
    let frames: Vec<&str> = error.trace.iter().map(|frame| frame.what.as_str()).collect();
    assert_eq!(frames, ["function `divide`", "function `call`"]);
}

#[test]
fn sizes_of_locals_follow_the_inputs() {
    let script = include_str!("functions/sizes.mo");
    assert_eq!(run(script, "doubled({1, 2, 3})"), "{2.0, 4.0, 6.0}");
    assert_eq!(run(script, "doubled(fill(1.0, 0))"), "{}");
    assert!(run_fails(&format!("{script} y := doubled(1);")).starts_with("size-mismatch: `x`"));
}

#[test]
fn declarations_may_come_in_any_order_but_not_need_each_other() {
    let script = "
function f output Real y; protected Real a = 2*b; Real b = 3; algorithm y := a; end f;
function g output Real y; protected Real a = 2*b; Real b = a; algorithm y := a; end g;
";
    assert_eq!(run(script, "f()"), "6.0");
    assert!(run_fails(&format!("{script} y := g();")).starts_with("misplaced"));
}

#[test]
fn nothing_is_read_before_it_has_a_value() {
    let script = "
function whole output Real y; algorithm end whole;
function some output Real y[3]; algorithm y[1] := 1; y[3] := 3; end some;
function all output Real y[3]; algorithm y[1] := 1; y[3] := 3; y[2] := y[1] + y[3]; end all;
function early output Real y; protected Real t[2]; algorithm t[1] := 1; y := t[2]; end early;
";
    assert!(run_fails(&format!("{script} y := whole();")).starts_with("no-value-yet: `y`"));
    assert!(run_fails(&format!("{script} y := some();")).starts_with("no-value-yet: `y`"));
    assert_eq!(run(script, "all()"), "{1.0, 4.0, 3.0}");
    assert!(run_fails(&format!("{script} y := early();")).starts_with("no-value-yet: `t`"));
}

#[test]
fn inputs_are_not_assigned() {
    let script = "function f input Real x; output Real y; algorithm x := 1; y := x; end f;";
    assert!(run_fails(&format!("{script} y := f(1);")).starts_with("not-assignable"));
    let script = "function f input Real x[2]; output Real y; algorithm x[1] := 1; y := 1; end f;";
    assert!(run_fails(&format!("{script} y := f({{1, 2}});")).starts_with("not-assignable"));
}

#[test]
fn functions_do_not_see_the_variables_of_the_script() {
    let script = "a := 5; function f output Real y; algorithm y := a; end f;";
    assert!(run_fails(&format!("{script} y := f();")).starts_with("unknown-variable"));
}

#[test]
fn recursion_works_and_ends() {
    let script = "
function factorial input Integer n; output Integer y;
algorithm y := if n <= 1 then 1 else n*factorial(n - 1); end factorial;
function endless input Integer n; output Integer y; algorithm y := endless(n + 1); end endless;
";
    assert_eq!(run(script, "factorial(20)"), "2432902008176640000");
    assert!(run_fails(&format!("{script} y := factorial(21);")).starts_with("integer-overflow"));
    assert!(run_fails(&format!("{script} y := endless(1);")).starts_with("recursion-limit"));
}

#[test]
fn return_leaves_the_function() {
    let script = include_str!("functions/return.mo");
    assert_eq!(run(script, "first({-1, 0, 5, 6})"), "3");
    assert_eq!(run(script, "first({-1})"), "0");
}

#[test]
fn functions_of_scalars_take_arrays() {
    assert_eq!(run(QUADRATIC, "f({1, 2, 3}) .+ 0"), "{3.0, 6.0, 9.0}");
    assert_eq!(run(QUADRATIC, "f({1, 2}, {10, 20}) .+ 0"), "{11.0, 22.0}");
    assert_eq!(run(QUADRATIC, "f([1, 2; 3, 4], 0) .+ 0"), "{{1.0, 2.0}, {3.0, 4.0}}");
    assert!(
        run_fails(&format!("{QUADRATIC} y := f({{1, 2}}, {{1, 2, 3}});"))
            .starts_with("size-mismatch")
    );
}

#[test]
fn functions_are_arguments() {
    let script = "
function apply input FunctionType g; input Real x; output Real y; algorithm y := g(x); end apply;
function line input Real x; input Real a = 1; input Real b = 0; output Real y = a*x + b; algorithm end line;
";
    assert_eq!(run(script, "apply(line, 3)"), "3.0");
    assert_eq!(run(script, "apply(function line(a = 2, b = 1), 3)"), "7.0");
    assert_eq!(run(script, "apply(sqrt, 9)"), "3.0");
}

#[test]
fn records_are_made_read_and_changed() {
    let script = "
record P Real x; Integer n = 2; Real v[2] = {1, 2}; end P;
function origin output P p; algorithm p.x := 0; end origin;
function moved input P p; input Real d; output P q; algorithm q := p; q.x := p.x + d; q.v[1] := 9; end moved;
p := P(1.5);
q := moved(p, 1);
";
    assert_eq!(run(script, "p"), "record P\n    x = 1.5,\n    n = 2,\n    v = {1.0, 2.0}\nend P;");
    assert_eq!(run(script, "{q.x, q.v[1], q.v[end]}"), "{2.5, 9.0, 2.0}");
    assert_eq!(run(&format!("{script} r := origin();"), "r.x"), "0.0");
    assert!(run_fails(&format!("{script} y := p.z;")).contains("no component `z`"));
    assert!(run_fails(&format!("{script} p.n := 2.5;")).starts_with("type-mismatch"));
}

#[test]
fn slices_go_through_arrays_of_records() {
    let script = "
record P Real x; Real v[2]; end P;
a := {P(1, {1, 2}), P(2, {3, 4}), P(3, {5, 6})};
";
    assert_eq!(run(script, "a.x"), "{1.0, 2.0, 3.0}");
    assert_eq!(run(script, "a[2].v[1]"), "3.0");
    assert_eq!(run(script, "a.v[end]"), "{2.0, 4.0, 6.0}");
    assert_eq!(run(script, "a[2:3].x"), "{2.0, 3.0}");
    assert_eq!(run(script, "a[{3, 1}].v[:]"), "{{5.0, 6.0}, {1.0, 2.0}}");
    assert_eq!(run(&format!("{script} a[2].v[1] := 9;"), "a[2].v"), "{9.0, 4.0}");
    assert_eq!(run(&format!("{script} a.x := {{7, 8, 9}};"), "a[2].x"), "8.0");
    assert_eq!(run(&format!("{script} a[1:2].x := {{7, 8}};"), "a.x"), "{7.0, 8.0, 3.0}");
}

#[test]
fn a_record_output_is_complete_when_all_its_components_are() {
    let script = "
record P Real x; Real v[2]; end P;
function full output P p; algorithm p.x := 1; for i in 1:2 loop p.v[i] := i; end for; end full;
function half output P p; algorithm p.x := 1; p.v[1] := 1; end half;
record C Real x; Boolean b; end C;
function undecided output C c; algorithm c.x := 1; end undecided;
function none output P p; algorithm end none;
function many output P p[2]; algorithm for i in 1:2 loop p[i].x := i; p[i].v := {i, i}; end for; end many;
";
    assert_eq!(run(&format!("{script} r := full();"), "r.v"), "{1.0, 2.0}");
    // Real scalars can be NaN, others cannot.
    assert_eq!(run(&format!("{script} r := half();"), "r.v"), "{1.0, NaN}");
    assert!(run_fails(&format!("{script} y := undecided();")).starts_with("no-value-yet: `c`"));
    assert!(run_fails(&format!("{script} y := none();")).starts_with("no-value-yet: `p`"));
    assert_eq!(run(&format!("{script} r := many();"), "r.x"), "{1.0, 2.0}");
}

#[test]
fn enumerations_index_compare_and_convert() {
    let script = "
type E = enumeration(one, two, three);
function weigh input E e; output Real y; protected Real w[E] = {10, 20, 30}; algorithm y := w[e]; end weigh;
s := 0; for e in E loop s := s + Integer(e); end for;
";
    assert_eq!(run(script, "E.two"), "E.two");
    assert_eq!(run(script, "weigh(E.three)"), "30.0");
    assert_eq!(run(script, "E.one < E.two"), "true");
    assert_eq!(run(script, "s"), "6");
    assert_eq!(run(script, "E(3)"), "E.three");
    assert_eq!(run(script, "String(E.one)"), "\"one\"");
    assert!(run_fails(&format!("{script} y := E(4);")).starts_with("index-out-of-range"));
}

#[test]
fn builtins_get_names_unevaluated_and_rows_as_vectors() {
    let script = "
function look input VariableName v; input TypeName t = A.B; input Real x[:] = {1}; output Boolean b; external; end look;
function show input VariableName v[:]; output Boolean b; external; end show;
look(a.b[2], M.N, [1, 2, 3]);
look(der(x));
show({x, y[1]});
show(x);
";
    let mut host = TestHost::default();
    run_in(script, &mut Scope::script(), &mut host).expect("runs");
    let name = |text: &str| Value::VariableName(text.into());
    let class = |text: &str| Value::TypeName(crate::name::Name::parse(text));
    assert_eq!(
        host.builtin_calls,
        [
            vec![name("a.b[2]"), class("M.N"), Value::reals(vec![1.0, 2.0, 3.0])],
            vec![name("der(x)"), class("A.B"), Value::reals(vec![1.0])],
            vec![vec!["x".to_owned(), "y[1]".to_owned()].into()],
            vec![vec!["x".to_owned()].into()],
        ]
    );
}

#[test]
fn assertions_fail_or_warn() {
    assert_eq!(run_fails("assert(1 > 2, \"no: \" + String(1));"), "assertion-failed: no: 1");
    let mut host = TestHost::default();
    let script = "assert(false, \"careful\", AssertionLevel.warning); assert(true, \"fine\");";
    run_in(script, &mut Scope::script(), &mut host).expect("only warns");
    assert_eq!(host.warnings.len(), 1);
    assert_eq!(host.warnings[0].message, "careful");
}

#[test]
fn a_size_may_be_another_one_of_the_same_input() {
    let script = "
function trace input Real A[:, size(A, 1)]; output Real y;
algorithm y := sum(A[i, i] for i in 1:size(A, 1)); end trace;
";
    assert_eq!(run(&format!("{script} y := trace([1, 2; 3, 4]);"), "y"), "5.0");
    assert!(run_fails(&format!("{script} y := trace([1, 2, 3; 3, 4, 5]);")).contains("size"));
}
