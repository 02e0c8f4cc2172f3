//! Tests of executing statements.

use super::host::TestHost;
use super::{Scope, run, run_fails, run_in};
use crate::name::Ident;
use crate::value::Value;

#[test]
fn loops_branches_and_break() {
    assert_eq!(run("s := 0; for i in 1:10 loop s := s + i; end for;", "s"), "55");
    assert_eq!(run("s := 0; while s < 7 loop s := s + 2; end while;", "s"), "8");
    let script = "s := 0; for i in 1:10 loop if i > 3 then break; end if; s := s + i; end for;";
    assert_eq!(run(script, "s"), "6");
    let script = "s := 0; for i in 1:3, j in 1:i loop s := s + j; end for;";
    assert_eq!(run(script, "s"), "10");
    let script = "t := 0.0; for x in 0:0.5:1 loop t := t + x; end for;";
    assert_eq!(run(script, "t"), "1.5");
    let script = "t := \"\"; for s in {\"a\", \"b\"} loop t := t + s; end for;";
    assert_eq!(run(script, "t"), "\"ab\"");
}

#[test]
fn a_loop_range_is_deduced_from_subscripts() {
    let script = "v := {1, 2, 3}; w := {0, 0, 0}; for i loop w[i] := 2*v[i]; end for;";
    assert_eq!(run(script, "w"), "{2, 4, 6}");
    let script = "m := [1, 2, 3; 4, 5, 6]; s := 0; for i, j loop s := s + m[i, j]; end for;";
    assert_eq!(run(script, "s"), "21");
    assert!(run_fails("for i loop x := i; end for;").starts_with("misplaced"));
    let script = "v := {1, 2}; w := {1, 2, 3}; for i loop w[i] := v[i]; end for;";
    assert!(run_fails(script).starts_with("misplaced"));
}

#[test]
fn elements_and_slices_are_assigned_in_place() {
    assert_eq!(run("v := {1, 2, 3}; v[2] := 7;", "v"), "{1, 7, 3}");
    assert_eq!(run("m := zeros(2, 3); m[:, 2] := {8, 9};", "m"), "{{0, 8, 0}, {0, 9, 0}}");
    assert_eq!(run("m := zeros(2, 2); m[1, :] := {1, 2};", "m"), "{{1, 2}, {0, 0}}");
    assert_eq!(run("v := 1:5; v[2:3] := {0, 0};", "v"), "{1, 0, 0, 4, 5}");
    assert_eq!(run("v := {1, 2}; v[end] := 5;", "v"), "{1, 5}");
    assert_eq!(run("v := {1, 2}; v[1] := 0.5;", "v"), "{0.5, 2.0}");
    assert!(run_fails("v := {1, 2}; v[3] := 0;").starts_with("index-out-of-range: `v`"));
    assert!(run_fails("v := {1, 2}; v[1:2] := {1, 2, 3};").starts_with("size-mismatch"));
    assert!(run_fails("v := {1, 2}; v[1] := \"a\";").starts_with("type-mismatch"));
    assert!(run_fails("v := {1, 2}; v[1] := {1};").starts_with("size-mismatch"));
}

#[test]
fn a_declared_variable_keeps_its_type() {
    assert_eq!(run("Real x = 1; x := 2;", "x"), "2.0");
    assert!(run_fails("Integer n = 1; n := 2.5;").starts_with("type-mismatch: `n`"));
    assert!(run_fails("Real v[2]; v := {1, 2, 3};").starts_with("size-mismatch: `v`"));
    assert_eq!(run("Real v[2]; v[1] := 1; v[2] := 2;", "v"), "{1.0, 2.0}");
    assert!(run_fails("Real v[2]; v[1] := 1; w := v;").starts_with("no-value-yet"));
    assert_eq!(run("Real v[2]; v[1] := 3; w := v[1];", "w"), "3.0");
    assert!(run_fails("Integer v[2] = {1, 2}; v[1] := 0.5;").starts_with("type-mismatch"));
    assert_eq!(run("x := 1; x := \"now a text\";", "x"), "\"now a text\"");
}

#[test]
fn a_loop_variable_hides_and_cannot_be_assigned() {
    assert_eq!(run("i := 7; for i in 1:2 loop x := i; end for;", "{i, x}"), "{7, 2}");
    assert!(run_fails("for i in 1:2 loop i := 3; end for;").starts_with("not-assignable"));
}

#[test]
fn the_host_gets_dotted_targets_and_iterations_of_outermost_loops() {
    let mut host = TestHost::default();
    let mut scope = Scope::script();
    let script = "for i in 1:2 loop for j in 1:5 loop x := j; end for; end for; M.p := 3;";
    run_in(script, &mut scope, &mut host).expect("runs");
    assert_eq!(host.iterations, [(0, Some(2)), (1, Some(2))]);
    assert_eq!(host.assigned, [("M.p".to_owned(), Value::Integer(3))]);
    assert_eq!(scope.get(Ident::new("x")), Some(&Value::Integer(5)));
    assert!(!scope.contains(Ident::new("i")));
}

#[test]
fn an_endless_loop_can_be_interrupted() {
    let mut host = TestHost::patient(100);
    let result = run_in("while true loop x := 1; end while;", &mut Scope::script(), &mut host);
    assert_eq!(result.expect_err("stops").code.slug, "stopped");
    let mut host = TestHost::patient(100);
    let script = "for i in 1:1000000000000 loop end for;";
    let result = run_in(script, &mut Scope::script(), &mut host);
    assert_eq!(result.expect_err("stops").code.slug, "stopped");
}

#[test]
fn several_outputs_need_a_call() {
    assert!(run_fails("(a, b) := (1, 2);").starts_with("wrong-outputs"));
    assert!(run_fails("(a, b) := sin(1);").starts_with("wrong-outputs"));
}

/// Every statement of a script is an event, so the body of a `when` is executed where the condition
/// holds.
#[test]
fn a_when_of_a_script_is_a_branch() {
    let script = "x := 2; when x > 3 then y := 1; elsewhen x > 1 then y := 2; end when;";
    assert_eq!(run(script, "y"), "2");
    assert_eq!(run("y := 0; when false then y := 1; end when;", "y"), "0");
}

#[test]
fn what_belongs_to_models_is_refused() {
    assert!(run_fails("x := 1; y := der(x);").starts_with("model-only"));
    let script =
        "function f output Real y; algorithm when true then y := 1; end when; end f; x := f();";
    assert!(run_fails(script).starts_with("model-only"));
    assert!(run_fails("if true then break; end if;").starts_with("misplaced"));
}

#[test]
fn the_range_of_a_loop_that_fills_an_output_is_deduced() {
    let script = "
function squares input Real x[:]; output Real y[size(x, 1)];
algorithm for i loop y[i] := x[i]*x[i]; end for; end squares;
";
    assert_eq!(run(script, "squares({1, 2, 3})"), "{1.0, 4.0, 9.0}");
}
