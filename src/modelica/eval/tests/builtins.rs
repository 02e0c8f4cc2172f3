//! Tests of the functions of the language.

use super::{eval, fails};
use crate::functions;
use crate::value::Value;

#[test]
fn rounding_and_division() {
    assert_eq!(eval("mod(-7, 3)"), "2");
    assert_eq!(eval("rem(-7, 3)"), "-1");
    assert_eq!(eval("div(7, 2)"), "3");
    assert_eq!(eval("div(-7, 2)"), "-3");
    assert_eq!(eval("mod(7, -3)"), "-2");
    assert_eq!(eval("mod(-1.4, 3)"), "1.6");
    assert_eq!(eval("integer(3.7)"), "3");
    assert_eq!(eval("integer(-3.7)"), "-4");
    assert_eq!(eval("floor(-3.7)"), "-4.0");
    assert_eq!(eval("ceil(3.2)"), "4.0");
    assert_eq!(eval("abs(-3)"), "3");
    assert_eq!(eval("abs(-3.5)"), "3.5");
    assert_eq!(eval("sign({-2, 0, 3})"), "{-1, 0, 1}");
    assert_eq!(eval("mod(9007199254740993, 2)"), "1");
    assert!(fails("mod(1, 0)").starts_with("division-by-zero"));
    assert!(fails("div(1.0, 0.0)").starts_with("division-by-zero"));
}

#[test]
fn scalar_functions_come_from_the_table_and_take_arrays() {
    assert_eq!(eval("sqrt({1, 4, 9})"), "{1.0, 2.0, 3.0}");
    assert_eq!(eval("exp(0)"), "1.0");
    assert_eq!(eval("atan2(0, 1)"), "0.0");
    assert_eq!(eval("atan2({0, 0}, 1)"), "{0.0, 0.0}");
    assert!(fails("log(-1)").starts_with("domain-error"));
    assert!(fails("sqrt(-1)").starts_with("domain-error"));
    assert!(fails("asin(2)").starts_with("domain-error"));
    assert!(fails("sin(\"a\")").starts_with("type-mismatch"));
    assert_eq!(eval("semiLinear(-2, 3, 5)"), "-10.0");
    assert_eq!(eval("noEvent(smooth(1, 3))"), "3");
}

#[test]
fn every_function_of_the_table_is_callable() {
    for (_, function) in crate::symbolic::function::functions() {
        let arguments = vec![Value::Real(0.5); function.arity()];
        let value = functions::call(function.name, &arguments).expect(function.name);
        let expected = function.value.of(&vec![0.5; function.arity()]);
        assert_eq!(value.as_real(), Some(expected), "{}", function.name);
    }
    let names: Vec<&str> = functions::names().collect();
    let distinct: std::collections::BTreeSet<&str> = names.iter().copied().collect();
    assert_eq!(names.len(), distinct.len());
}

#[test]
fn numbers_as_strings() {
    assert_eq!(eval("String(3.14159265)"), "\"3.14159\"");
    assert_eq!(eval("String(1.5, significantDigits=3)"), "\"1.5\"");
    assert_eq!(eval("String(5, minimumLength=6)"), "\"5     \"");
    assert_eq!(eval("String(5, minimumLength=6, leftJustified=false)"), "\"     5\"");
    assert_eq!(eval("String(12.5, format=\"8.2f\")"), "\"   12.50\"");
    assert_eq!(eval("String(12.5, \"-10.3e\")"), "\"1.250e+01 \"");
    assert_eq!(eval("String(7, format=\"03d\")"), "\"007\"");
    assert_eq!(eval("String(true)"), "\"true\"");
    assert_eq!(eval("String(1e10)"), "\"1e+10\"");
    assert_eq!(eval("String(0.0001)"), "\"0.0001\"");
    assert_eq!(eval("String(0.00001)"), "\"1e-05\"");
    assert_eq!(eval("String(123456789.0)"), "\"1.23457e+08\"");
    assert!(fails("String(1.5, format=\"d\")").starts_with("type-mismatch"));
    assert!(fails("String(1.5, format=\"*f\")").starts_with("domain-error"));
    assert!(fails("String(1.5, minimumLength=-1)").starts_with("domain-error"));
}

#[test]
fn shapes_and_construction() {
    assert_eq!(eval("ndims([1, 2])"), "2");
    assert_eq!(eval("size(zeros(2, 3), 2)"), "3");
    assert!(fails("size({1}, 2)").starts_with("domain-error"));
    assert_eq!(eval("scalar({{7}})"), "7");
    assert_eq!(eval("vector([1; 2; 3])"), "{1, 2, 3}");
    assert_eq!(eval("matrix({1, 2})"), "{{1}, {2}}");
    assert_eq!(eval("identity(2)"), "{{1, 0}, {0, 1}}");
    assert_eq!(eval("diagonal({1.5, 2})"), "{{1.5, 0.0}, {0.0, 2.0}}");
    assert_eq!(eval("fill(0.5, 2, 2)"), "{{0.5, 0.5}, {0.5, 0.5}}");
    assert_eq!(eval("fill({1, 2}, 2)"), "{{1, 2}, {1, 2}}");
    assert_eq!(eval("ones(3)"), "{1, 1, 1}");
    assert_eq!(eval("linspace(0, 1, 5)"), "{0.0, 0.25, 0.5, 0.75, 1.0}");
    assert_eq!(eval("cat(1, {1, 2}, {3})"), "{1, 2, 3}");
    assert_eq!(eval("cat(2, [1; 2], [3.0; 4])"), "{{1.0, 3.0}, {2.0, 4.0}}");
    assert_eq!(eval("promote({1, 2}, 2)"), "{{1}, {2}}");
    assert!(fails("zeros(-1)").starts_with("domain-error"));
    assert!(fails("zeros(100000, 100000)").starts_with("array-too-large"));
    assert!(fails("linspace(0, 1, 1)").starts_with("domain-error"));
    assert!(fails("scalar({1, 2})").starts_with("size-mismatch"));
}

#[test]
fn reductions() {
    assert_eq!(eval("min({3, 1, 2})"), "1");
    assert_eq!(eval("max([1, 9; 3, 4])"), "9");
    assert_eq!(eval("max(1, 2.5)"), "2.5");
    assert_eq!(eval("min(1, 2.5)"), "1.0");
    assert_eq!(eval("sum([1, 2; 3, 4])"), "10");
    assert_eq!(eval("product({1, 2, 3.5})"), "7.0");
    assert_eq!(eval("max(fill(1, 0))"), "-9223372036854775808");
    assert_eq!(eval("min(fill(true, 0))"), "true");
    assert_eq!(eval("max(i for i in 1:0)"), "-9223372036854775808");
    assert!(fails("sum({9223372036854775807, 1})").starts_with("integer-overflow"));
}

#[test]
fn linear_algebra() {
    assert_eq!(eval("transpose([1, 2, 3; 4, 5, 6])"), "{{1, 4}, {2, 5}, {3, 6}}");
    assert_eq!(eval("outerProduct({1, 2}, {3, 4})"), "{{3, 4}, {6, 8}}");
    assert_eq!(eval("symmetric([1, 2; 3, 4])"), "{{1, 2}, {2, 4}}");
    assert_eq!(eval("cross({1, 0, 0}, {0, 1, 0})"), "{0, 0, 1}");
    assert_eq!(eval("skew({1, 2, 3})*{4, 5, 6} - cross({1, 2, 3}, {4, 5, 6})"), "{0, 0, 0}");
    assert!(fails("[1, 2]*[3, 4]").starts_with("size-mismatch"));
}
