//! Tests of evaluating expressions.

use super::{eval, fails, run};

#[test]
fn numbers_print_as_openmodelica_prints_them() {
    assert_eq!(eval("1+2"), "3");
    assert_eq!(eval("3/2"), "1.5");
    assert_eq!(eval("2^10"), "1024.0");
    assert_eq!(eval("1.0"), "1.0");
    assert_eq!(eval("1/3"), "0.3333333333333333");
    assert_eq!(eval("1e-7"), "1e-7");
    assert_eq!(eval("true and false"), "false");
    assert_eq!(eval("\"a\" + \"b\""), "\"ab\"");
    assert_eq!(eval(r#""line\nbreak \"q\"""#), "\"line\nbreak \\\"q\\\"\"");
}

#[test]
fn arrays_print_as_openmodelica_prints_them() {
    assert_eq!(eval("{1.0,2,3.5}"), "{1.0, 2.0, 3.5}");
    assert_eq!(eval("[1,2;3,4]"), "{{1, 2}, {3, 4}}");
    assert_eq!(eval("1:5"), "{1, 2, 3, 4, 5}");
    assert_eq!(eval("0:0.25:1"), "{0.0, 0.25, 0.5, 0.75, 1.0}");
    assert_eq!(eval("{i^2 for i in 1:4}"), "{1.0, 4.0, 9.0, 16.0}");
}

#[test]
fn the_observed_session_gives_the_observed_answers() {
    let script = "x := 3; y := x*2.5; v := {1,2,3}; m := [1,2;3,4];";
    assert_eq!(run(script, "y"), "7.5");
    assert_eq!(run(script, "v[2]"), "2");
    assert_eq!(run(script, "m[2,:]"), "{3, 4}");
    assert_eq!(run(script, "m*m"), "{{7, 10}, {15, 22}}");
    assert_eq!(run(script, "m*{1,1}"), "{3, 7}");
    assert_eq!(run(script, "size(m)"), "{2, 2}");
}

#[test]
fn an_integer_stays_integer_only_where_the_operator_allows() {
    assert_eq!(eval("6/3"), "2.0");
    assert_eq!(eval("7 - 2*3"), "1");
    assert_eq!(eval("-2^2"), "-4.0");
    assert_eq!(eval("2*{1, 2}"), "{2, 4}");
    assert_eq!(eval("{1, 2}/2"), "{0.5, 1.0}");
    assert_eq!(eval("{1, 2} .+ 0.5"), "{1.5, 2.5}");
    assert_eq!(eval("[2, 0; 0, 3]^2"), "{{4, 0}, {0, 9}}");
    assert_eq!(eval("{1, 2}*{3, 4}"), "11");
}

#[test]
fn nothing_overflows_or_becomes_infinite_silently() {
    assert!(fails("9223372036854775807 + 1").starts_with("integer-overflow"));
    assert!(fails("3037000500*3037000500").starts_with("integer-overflow"));
    assert!(fails("1/0").starts_with("division-by-zero"));
    assert!(fails("1.0/0.0").starts_with("division-by-zero"));
    assert!(fails("0.0^(-1)").starts_with("division-by-zero"));
    assert!(fails("(-8.0)^(1/3)").starts_with("domain-error"));
}

#[test]
fn operators_refuse_what_the_language_refuses() {
    assert!(fails("1 + {1, 2}").starts_with("type-mismatch"));
    assert!(fails("{1, 2} + {1, 2, 3}").starts_with("size-mismatch"));
    assert!(fails("\"a\" + 1").starts_with("type-mismatch"));
    assert!(fails("1 and true").starts_with("type-mismatch"));
    assert!(fails("{1, 2} == {1, 2}").starts_with("type-mismatch"));
    assert!(fails("(if 1 then 2 else 3)").starts_with("type-mismatch"));
    assert!(fails("1 / {1, 2}").starts_with("type-mismatch"));
}

#[test]
fn only_what_is_needed_is_evaluated() {
    assert_eq!(eval("(if true then 1 else 1/0)"), "1");
    assert_eq!(eval("false and 1/0 > 0"), "false");
    assert_eq!(eval("true or 1/0 > 0"), "true");
    assert_eq!(eval("(if false then 1/0 elseif true then 2 else 1/0)"), "2");
}

#[test]
fn relations_compare_scalars_of_simple_types() {
    assert_eq!(eval("1 < 1.5"), "true");
    assert_eq!(eval("\"abc\" < \"abd\""), "true");
    assert_eq!(eval("false < true"), "true");
    assert_eq!(eval("9007199254740993 == 9007199254740992.0"), "false");
    assert_eq!(eval("1 <> 1.0"), "false");
}

#[test]
fn ranges_count_as_people_do() {
    assert_eq!(eval("size(0:0.1:1, 1)"), "11");
    assert_eq!(eval("size(1.4e-4:0.1e-4:2.4e-4, 1)"), "11");
    assert_eq!(eval("10:-3:1"), "{10, 7, 4, 1}");
    assert_eq!(eval("size(5:1, 1)"), "0");
    assert_eq!(eval("1.0:3"), "{1.0, 2.0, 3.0}");
    assert_eq!(eval("false:true"), "{false, true}");
    assert!(fails("1:0:3").starts_with("domain-error"));
    assert!(fails("1:1000000000000").starts_with("array-too-large"));
}

#[test]
fn subscripts_select_elements_slices_and_rows() {
    let script = "m := [11, 12, 13; 21, 22, 23];";
    assert_eq!(run(script, "m[2, 3]"), "23");
    assert_eq!(run(script, "m[:, 2]"), "{12, 22}");
    assert_eq!(run(script, "m[end, end]"), "23");
    assert_eq!(run(script, "m[1, {3, 1}]"), "{13, 11}");
    assert_eq!(run(script, "m[:, 2:end]"), "{{12, 13}, {22, 23}}");
    assert_eq!(run(script, "m[2]"), "{21, 22, 23}");
    assert_eq!(run("v := {3, 1, 2}; i := {2, 3};", "v[i[end]]"), "2");
    assert_eq!(run("v := {3, 1, 2}; i := {2, 3};", "v[end - i[1] + 1]"), "1");
}

#[test]
fn a_subscript_out_of_range_names_subscript_and_size() {
    let message = |script: &str, shown: &str| match super::try_run(script, shown) {
        Err(error) => format!("{}: {}", error.code.slug, error.message),
        Ok(_) => panic!("`{shown}` has a value"),
    };
    assert_eq!(
        message("v := {1, 2, 3};", "v[4]"),
        "index-out-of-range: `v`: the subscript 4 is outside 1:3"
    );
    assert_eq!(
        message("m := [1, 2; 3, 4];", "m[1, 0]"),
        "index-out-of-range: `m`: the subscript 0 is outside 1:2, the range of dimension 2 of Integer[2, 2]"
    );
    assert!(message("m := [1, 2; 3, 4];", "m[1, 1, 1]").starts_with("index-out-of-range"));
    assert!(message("v := {1, 2, 3};", "v[1.0]").starts_with("type-mismatch"));
    assert!(message("v := {1, 2, 3};", "w[1]").starts_with("unknown-variable"));
}

#[test]
fn matrices_are_joined_from_scalars_vectors_and_matrices() {
    assert_eq!(eval("[{1, 2}, {3, 4}]"), "{{1, 3}, {2, 4}}");
    assert_eq!(eval("[[1, 2]; [3, 4]; 5, 6]"), "{{1, 2}, {3, 4}, {5, 6}}");
    assert_eq!(eval("[1, 2.5]"), "{{1.0, 2.5}}");
    assert!(fails("[1, 2; 3]").starts_with("size-mismatch"));
    assert!(fails("{{1, 2}, {3}}").starts_with("size-mismatch"));
    assert!(fails("{1, \"a\"}").starts_with("type-mismatch"));
}

#[test]
fn array_iterations_nest_with_the_last_iterator_outermost() {
    assert_eq!(eval("{10*i + j for i in 1:2, j in 1:3}"), "{{11, 21}, {12, 22}, {13, 23}}");
    assert_eq!(eval("sum(i*j for i in 1:3, j in 1:2)"), "18");
    assert_eq!(eval("product(i for i in 1:5)"), "120");
    assert_eq!(eval("max(i*(4 - i) for i in 1:3)"), "4");
    assert_eq!(eval("min(x^2 for x in {-3, 2, 5})"), "4.0");
    assert_eq!(eval("array(i for i in {true, false})"), "{true, false}");
    assert_eq!(eval("sum(i for i in 1:0)"), "0");
    assert_eq!(run("v := {1, 4, 9};", "{v[i] - 1 for i}"), "{0, 3, 8}");
}

#[test]
fn end_stands_for_the_innermost_size() {
    assert!(fails("end + 1").starts_with("misplaced") || fails("end + 1").contains("end"));
    assert_eq!(run("v := {1, 2, 3}; w := {1, 2};", "v[w[end]]"), "2");
}
