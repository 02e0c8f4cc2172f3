//! Functions that run as bytecode in models: their values are those of the interpreter, their
//! derivatives those of its differences.

use crate::support::simulated::simulated;
use gapilib::Diagnostic;
use gapilib::Session;
use gapilib::Value;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::Program;
use gapilib::internals::eval::{Arguments, Callee, Function, Host, call_function};
use gapilib::internals::flatten::{Library, flatten};
use gapilib::internals::name::Name;
use gapilib::internals::runtime::System;
use gapilib::internals::sim::{Failure, Residual, Settings, simulate};
use gapilib::internals::source::{SourceId, Span};
use gapilib::internals::syntax::{ast::ComponentReference, parse_stored_definition};
use gapilib::world::MemoryWorld;
use indexmap::IndexMap;
use proptest::prelude::*;
use std::sync::Arc;

/// Functions `f` of a Real `u` and an Integer `n` with a Real output `y`; `{h}` is this interface.
const CORPUS: &[(&str, &str)] = &[
    (
        "a while loop with an exit",
        "function f {h} protected Integer k = 0; algorithm y := 1; while true loop \
         y := y - (y^3 - u^2 - 1)/(3*y^2); k := k + 1; if k > 40 + n then break; end if; \
         end while; end f;",
    ),
    (
        "a return inside two loops",
        "function f {h} algorithm y := 0; for i in 1:10 loop for j in 1:i loop \
         y := y + u*i/j; if y > 5 + n then return; end if; end for; end for; y := -u; end f;",
    ),
    (
        "short loops over known ranges",
        "function f {h} protected constant Real p[5] = {0.5, -2, 3, 0.25, -1}; Real z; Integer k = 0; \
         algorithm y := p[5]; z := 0; for i in 1:4 loop y := p[5 - i] + u*y; end for; \
         for i in 5:-2:1 loop z := z*u + p[i]; end for; for i in 1:0 loop z := 1/(i - i); end for; \
         for i in 0:2 loop if i > 0 then z := z + p[i]*sin(u)*cos(u); end if; end for; \
         for i in 0:2 loop if u > 1e9 then z := z + p[6 - i]; end if; end for; \
         while k < n loop k := k + 1; for i in 1:3 loop for j in 2:3 loop \
         if j*u > i + k then break; end if; z := z + u*i*j; end for; end for; \
         for i in {0.5, 1.5} loop y := y + i*z; if y > 40 then return; end if; end for; \
         end while; end f;",
    ),
    (
        "subscripts that are computed",
        "function f {h} protected Real a[3, 4]; Integer at; algorithm for i in 1:3 loop \
         for j in 1:4 loop a[i, j] := sin(i*u) + j; end for; end for; \
         at := 1 + integer(mod(abs(u), 3)); a[at, 2] := a[at, 2]^2; \
         a[at, :] := a[at, {4, 3, 2, 1}]; a[:, 3] := 2*a[:, at]; y := sum(a[at, :]) + a[3, at]; \
         end f;",
    ),
    (
        "recursion",
        "function f {h} algorithm if n <= 0 then y := u; elseif n == 1 then y := u*u; else \
         y := f(u/2, n - 1) + sin(f(u, n - 2)); end if; end f;",
    ),
    (
        "vectors of any size and their search",
        "function find input Real x[:]; input Real y[size(x, 1)]; input Real u; output Real v; \
         output Integer at; algorithm at := 1; while at < size(x, 1) - 1 and u > x[at + 1] loop \
         at := at + 1; end while; \
         v := y[at] + (y[at + 1] - y[at])*(u - x[at])/(x[at + 1] - x[at]); end find; \
         function f {h} protected Real v; Integer at; algorithm \
         (v, at) := find({-2, -0.5, 0, 1, 3}, {1, 4, 2, n, 3}, u); y := v*at; end f;",
    ),
    (
        "records in and out",
        "record R Real a; Real b[2]; end R; function g input R r; input Integer n; output R s; \
         algorithm s := r; for k in 1:n loop s.a := s.a*r.b[1]; s.b[2] := s.b[2] + s.a; end for; \
         end g; function f {h} protected R r; algorithm r := g(R(u, {cos(u), 2}), n); \
         y := r.a + r.b[2]; end f;",
    ),
    (
        "arrays of records",
        "record R Real a; Real b[2]; end R; function total input R r[:]; output Real t = 0; \
         output R last; algorithm for i in 1:size(r, 1) loop t := t + r[i].a*r[i].b[2]; end for; \
         last := r[end]; end total; function f {h} protected R v[3]; R last; Real t; \
         Integer k = 0; algorithm for i in 1:3 loop v[i] := R(i*u, {cos(u), i}); end for; \
         v[2].a := u^2; v[3].b[1] := n; while k < 3 and u < 1000 loop k := k + 1; \
         v[k].b[2] := v[k].b[2] + k; end while; (t, last) := total(v); \
         y := t + last.b[1] + sum(v.a); end f;",
    ),
    (
        "sizes that depend on a known argument",
        "function powers input Real u; input Integer m; output Real p[m]; algorithm p[1] := u; \
         for i in 2:m loop p[i] := p[i - 1]*u; end for; end powers; \
         function f {h} protected Integer k = 0; algorithm y := 0; while k < n loop k := k + 1; \
         y := y + sum(powers(u/3, 4)); end while; end f;",
    ),
    (
        "a size that the value in the declaration has",
        "function bent input Real v[:]; output Real w[:] = 2*v; protected Real s[:, :] = [v, v]; \
         Integer k = 0; algorithm while k < 3 and v[1] > -9 loop k := k + 1; w[k] := w[k] + s[k, 2]*k; \
         end while; end bent; function f {h} algorithm y := sum(bent({u, sin(u), n})); end f;",
    ),
    (
        "slices that change from turn to turn",
        "function f {h} protected Real v[4] = {u, 2, 3*u, n}; Real s = 0; algorithm \
         for i in 1:4 loop s := s + sum(v[i:4])*i; if s > 40 then break; end if; end for; \
         y := s; end f;",
    ),
    (
        "conditions that guard each other",
        "function f {h} protected Real v[3] = {1, 2, u}; Integer i = 1; algorithm \
         while i <= 3 and v[min(i, 3)] > 0 loop i := i + 1; end while; \
         y := if i > 3 or v[i] < -1 then i*u else u^2; end f;",
    ),
    (
        "powers, roots and quotients",
        "function f {h} protected Integer k = 0; algorithm y := 1 + u^2; while k < n loop \
         y := sqrt(y)^1.5/(1 + exp(-u)) + log(y) + atan2(y, u) + max(y, u)^k; k := k + 1; \
         end while; end f;",
    ),
    (
        "loops over elements and backwards",
        "function f {h} protected Real e; algorithm y := 0; for x in {u, n, 2.5} loop \
         for i in 5:-2:n loop y := y + x*i; if y > 100 then return; end if; end for; end for; \
         for x in 0.5:0.25:1 + u^2 loop y := y + x; end for; end f;",
    ),
    (
        "records with texts",
        "record D String name; Real a; Real b[2]; end D; constant D d[2] = {D(\"one\", 2, {3, 4}), \
         D(\"two\", 5, {6, 7})}; function scaled input D d; input Real u; output D e; algorithm \
         e := d; e.a := if d.name == \"one\" then d.a*u else -u; end scaled; \
         function f {h} protected Integer k = 0; D e = scaled(d[1], u); D g; algorithm y := 0; \
         while k < min(n, 2) loop k := k + 1; g := if u > 0 then e else d[2]; y := g.a + d[k].b[k]; \
         end while; e := scaled(d[2], u); y := y + e.a*e.b[1]; end f;",
    ),
    (
        "sizes that assignments give",
        "record R Real p; Real X[:]; end R; function two input Real u; output Real y[:]; algorithm \
         if u > 0 then y := {u, 2*u}; else y := {0, u}; end if; end two; \
         function made input Real u; output R r; algorithm r.p := u; r.X := cat(1, two(u), {3}); \
         end made; function f {h} protected Real X[:]; Real Z[:]; R r; Integer k = 0; algorithm \
         while k < n loop k := k + 1; Z := 2*X; X := two(k*u); end while; X := two(u); r := made(u); \
         y := sum(X) + r.X[3]*r.p + sum(r.X); end f;",
    ),
    (
        "records that are assigned in part",
        "record R Real a; Real b; Real c = 4; end R; function part input Real u; output R r; \
         protected Integer k = 0; algorithm r.a := u^2; while k < 2 loop k := k + 1; \
         if u < -9 then r.b := 1; end if; end while; end part; \
         function f {h} protected R r; algorithm r := part(u); y := r.a*r.c + n; end f;",
    ),
    (
        "a subscript outside an array that is never reached",
        "function third input Real v[:]; output Real y; protected Integer k = 0; algorithm y := 0; \
         while k < 1 loop k := k + 1; if v[1] > 99 then y := v[3]; end if; end while; end third; \
         function f {h} algorithm y := u + third({u, n}); end f;",
    ),
    (
        "values that swap places",
        "function f {h} protected Real v[3] = {1, u, n}; Integer k = 0; algorithm \
         while k < n loop v := {v[3], v[1] + u, v[2]}; (v[1], v[2]) := swap(v[1], v[2]); \
         k := k + 1; end while; y := v*{1, 10, 100}; end f; function swap input Real a; \
         input Real b; output Real c; output Real d; algorithm c := b; d := a; end swap;",
    ),
    (
        "records of which modifiers give a part and defaults name other components",
        "record R Integer k; Real w[k]; Real m = 4; Real q = 12/m; Real z; end R; \
         function g input Real u; input Integer n; output R r(k = 3); protected Integer i = 0; \
         algorithm r.w := {u, 2*u, u^2}; r.z := r.q*u; while i < n loop i := i + 1; \
         r.z := r.z + r.q; end while; end g; \
         function f {h} protected R r(k = 3); algorithm r := g(u, n); y := sum(r.w) + r.z*r.q; \
         end f;",
    ),
];

const INTERFACE: &str = "input Real u; input Integer n; output Real y;";

/// The classes of a text around `package P`.
pub(super) fn library(functions: &str) -> Library {
    let functions = functions.replace("{h}", INTERFACE);
    let text = format!(
        "package P {functions} model Main Real x(start = 1, fixed = true); \
         parameter Integer n = 2; equation der(x) = f(x, n); end Main; end P;"
    );
    let file = parse_stored_definition(SourceId::NONE, &text).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    library
}

pub(super) fn compiled(library: &Library) -> Result<Arc<Program>, Diagnostic> {
    let flat = flatten(library, &Name::parse("P.Main"), &[])
        .map_err(|errors| errors.into_iter().next().expect("an error"))?;
    Program::compile(causalize(&flat.model)?)
}

/// f(u, n) and ∂f/∂u as the model computes them.
pub(super) fn of_model(system: &mut System, u: f64, n: i64) -> Result<(f64, f64), Failure> {
    system.set_parameter(0, n as f64).expect("a parameter");
    let (mut value, mut slope) = ([0.0], [0.0]);
    system.initialize(0.0, &mut [0.0])?;
    system.rhs(0.0, &[u], &mut value)?;
    system.jacobian(0.0, &[u], &mut slope)?;
    Ok((value[0], slope[0]))
}

/// Answers calls among the functions of a library.
struct Functions(IndexMap<Name, Arc<Function>>);

impl Host for Functions {
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        Ok(self.0.get(name).cloned().map(Callee::Function))
    }

    fn variable(&mut self, _: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
        Ok(None)
    }
}

/// f(u, n) as the interpreter computes it.
pub(super) fn interpreted(library: &Library, u: f64, n: i64) -> f64 {
    let name = Name::parse("P.f");
    let functions = library.function(&name).expect("ready").expect("declared");
    let function = functions[&name].clone();
    let positional = vec![Value::Real(u), Value::Integer(n)];
    let arguments = Arguments { positional, ..Arguments::default() };
    let outputs = call_function(&function, arguments, Span::NONE, &mut Functions(functions));
    match outputs.expect("a value").as_slice() {
        [Value::Real(value), ..] => *value,
        other => panic!("{other:?} is not a number"),
    }
}

#[test]
fn values_and_slopes_are_those_of_the_interpreter() {
    for (what, functions) in CORPUS {
        let library = library(functions);
        let program = compiled(&library).unwrap_or_else(|e| panic!("{what}: {e}"));
        assert!(!program.sorted().dae.functions.codes.is_empty(), "{what} is not a bytecode");
        let mut system = program.system();
        for n in 0..5 {
            for u in [-1.7, -0.6, 0.37, 0.9, 2.3] {
                let (value, slope) = of_model(&mut system, u, n)
                    .unwrap_or_else(|e| panic!("{what}: {e:?} at u = {u}, n = {n}"));
                let expected = interpreted(&library, u, n);
                assert!(
                    (value - expected).abs() <= 1e-12 * expected.abs().max(1.0),
                    "{what}: {value} instead of {expected} at u = {u}, n = {n}"
                );
                let h = 1e-5;
                let difference =
                    (interpreted(&library, u + h, n) - interpreted(&library, u - h, n)) / (2.0 * h);
                assert!(
                    (slope - difference).abs() <= 1e-6 * difference.abs().max(1.0),
                    "{what}: slope {slope} instead of {difference} at u = {u}, n = {n}"
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    #[test]
    fn random_arguments_give_the_values_of_the_interpreter(
        which in 0..CORPUS.len(), u in -3.0f64..3.0, n in 0i64..6
    ) {
        let library = library(CORPUS[which].1);
        let program = compiled(&library).expect("it compiles");
        let (value, _) = of_model(&mut program.system(), u, n).expect("a value");
        let expected = interpreted(&library, u, n);
        prop_assert!((value - expected).abs() <= 1e-12 * expected.abs().max(1.0));
    }
}

/// What ends a simulation of `der(x) = f(x, n)` in strict mode.
pub(super) fn failure(functions: &str) -> String {
    let mut library = library(functions);
    library.set_strict(true);
    let program = compiled(&library).expect("it compiles");
    let result = simulate(&mut program.system(), &Settings { stop: 1.0, ..Settings::default() });
    let error = result.expect_err("the simulation fails");
    let diagnostic = program.explain(&error);
    format!("{}: {}", diagnostic.code.slug, diagnostic.message)
}

#[test]
fn failures_inside_functions_say_why() {
    let cases = [
        (
            "function f {h} algorithm y := 1; while y < n loop y := y + u; end while; \
             assert(y < 2, \"too large\"); end f;",
            "assertion-failed: too large (at t = 0)",
        ),
        (
            "function f {h} protected Real v[2] = {u, u}; Integer i = n; algorithm \
             while i > 0 loop y := v[i + 1]; i := i - 1; end while; end f;",
            "domain-error: a subscript lies outside its array in the function `P.f` (at t = 0)",
        ),
        (
            "function f {h} algorithm if u > 5 then y := 1; return; end if; \
             while u > 5 loop y := 2; end while; end f;",
            "domain-error: a variable has no value in the function `P.f` (at t = 0)",
        ),
        (
            "function f {h} protected Real v[2] = {u, n}; Integer k = 0; algorithm \
             while k < 2 loop k := k + 1; y := v[3]; end while; end f;",
            "domain-error: a subscript lies outside its array in the function `P.f` (at t = 0)",
        ),
        (
            "record R Real a; Real b; end R; function part input Real u; output R r; \
             protected Integer k = 0; algorithm while k < 2 loop k := k + 1; r.a := u; end while; \
             end part; function f {h} protected R r; Integer k = 0; algorithm r := part(u); y := 0; \
             while k < n loop k := k + 1; y := max(r.a, r.b); end while; end f;",
            "domain-error: a variable has no value in the function `P.f` (at t = 0)",
        ),
        (
            "function f {h} protected Integer k = 0; algorithm y := u; while k < n loop \
             y := log(-y); k := k + 1; end while; end f;",
            "domain-error: `log` has no value: the argument must be positive in the function \
             `P.f` (at t = 0)",
        ),
        (
            "function f {h} algorithm y := f(u, n + 1); end f;",
            "domain-error: calls are nested too deeply in the function `P.f` (at t = 0)",
        ),
        (
            "function f {h} algorithm y := u; while y > 0 loop y := y + 1; end while; end f;",
            "domain-error: more than 20 million instructions in the function `P.f` \
             (`--instruction-limit` allows more) (at t = 0)",
        ),
    ];
    for (functions, expected) in cases {
        assert_eq!(failure(functions), expected);
    }
}

#[test]
fn messages_show_what_is_known_when_compiling() {
    // In a loop of one function, in statements of another, in a model.
    let looping = "constant Real limit = 0.25; function f {h} protected Integer k = 0; \
        algorithm y := u; while k < n loop k := k + 1; \
        assert(y < limit, \"above \" + String(limit) + \" (\" + String(n) + \")\"); \
        end while; end f;";
    assert_eq!(failure(looping), "assertion-failed: above 0.25 (…) (at t = 0)");
    let texts = "type Kind = enumeration(low, high); \
        function f {h} protected constant Kind kind = Kind.high; algorithm \
        assert(u < 0, \"kind \" + String(kind) + \", \" + String(3*7) + \", \" + \
        String(true) + \", \" + String(2/3, significantDigits = 3) + \", \" + \
        String(7, minimumLength = 3, leftJustified = false) + \", \" + \
        String(1/3, format = \".2f\")); y := u; end f;";
    assert_eq!(
        failure(texts),
        "assertion-failed: kind high, 21, true, 0.667,   7, 0.33 (at t = 0)"
    );
}

#[test]
fn a_parameter_that_gives_a_size_is_settled() {
    // Σ u^i, i = 1 … n
    let functions = "function f {h} protected Real p[n]; Integer k = 0; algorithm \
        while k < n loop k := k + 1; p[k] := u^k; end while; y := sum(p); end f;";
    let program = compiled(&library(functions)).expect("it compiles");
    assert!(program.parameters().is_empty(), "`n` cannot be set any more");
    let mut value = [0.0];
    let mut system = program.system();
    system.initialize(0.0, &mut [1.0]).expect("initial values");
    system.rhs(0.0, &[0.5], &mut value).expect("a value");
    assert_eq!(value, [0.75]);
}

#[test]
fn a_warning_does_not_end_a_simulation() {
    let warning = "function f {h} algorithm y := -u; \
        assert(u < 0, \"not below zero\", AssertionLevel.warning); end f;";
    let program = compiled(&library(warning)).expect("it compiles");
    simulate(&mut program.system(), &Settings { stop: 1.0, ..Settings::default() })
        .expect("it goes on");
}

#[test]
fn a_function_with_bound_inputs_is_passed_to_loops() {
    // The mean of a u + b over {1, 2, 3}, with a = n and b = u.
    let functions = "partial function Of input Real u; output Real y; end Of; \
        function line extends Of; input Real a; input Real b; algorithm y := a*u + b; end line; \
        function mean input Of g; output Real y; protected Integer k = 0; algorithm y := 0; \
        while k < 3 loop k := k + 1; y := y + g(k)/3; end while; end mean; \
        function f {h} algorithm y := mean(function line(a = n, b = u)); end f;";
    let library = library(functions);
    let program = compiled(&library).expect("it compiles");
    let mut system = program.system();
    assert_eq!(of_model(&mut system, 0.5, 4).expect("a value"), (8.5, 1.0));
}

#[test]
fn a_partial_application_may_bind_an_input_that_is_a_function() {
    // Twice a u + b at 3, with a = n and b = u.
    let functions = "partial function Of input Real u; output Real y; end Of; \
        function line extends Of; input Real a; input Real b; algorithm y := a*u + b; end line; \
        function scaled extends Of; input Of g; input Real k; algorithm y := k*g(u); end scaled; \
        function at3 input Of g; output Real y; algorithm y := g(3); end at3; \
        function twice input Of g; output Real y; \
        algorithm y := at3(function scaled(g = g, k = 2)); end twice; \
        function f {h} algorithm y := twice(function line(a = n, b = u)); end f;";
    let program = compiled(&library(functions)).expect("it compiles");
    assert_eq!(of_model(&mut program.system(), 0.5, 4).expect("a value"), (25.0, 2.0));
}

#[test]
fn what_cannot_be_compiled_is_run_for_known_arguments() {
    // The size of `kept` is that of what is assigned to it.
    let functions = "function positive input Real v[:]; output Real s; protected Real kept[:]; \
        algorithm kept := v; s := sum(kept); end positive; \
        function f {h} algorithm y := u + positive({1, 2, 4}); end f;";
    let program = compiled(&library(functions)).expect("it compiles");
    assert_eq!(of_model(&mut program.system(), 0.5, 4).expect("a value"), (7.5, 1.0));
}

#[test]
fn the_second_derivative_function_is_used() {
    // Of sin(k u), where the functions say 7 times as much: nobody else would.
    let model = include_str!("../../data/models/functions_second_derivative.mo");
    let run = simulated(model, 1.0);
    let column = |name: &str| run.values(name)[0];
    let (speed, bent) = (1.0 + 0.3, 1.0 + 0.3);
    let (sin, cos) = 0.6f64.sin_cos();
    assert!((column("w") - 14.0 * cos * speed).abs() < 1e-12);
    // The part of the second derivative is the first function's.
    let second = -2800.0 * sin * speed * speed + 14.0 * cos * bent;
    assert!((column("a") - second).abs() < 1e-9, "{} is not {second}", column("a"));
}

/// A table as an external object, with the derivative that its library declares.
const TABLE: &str = include_str!("../../data/models/functions_table.mo");

#[test]
fn a_table_is_an_object_that_parameters_make_anew() {
    let file = parse_stored_definition(SourceId::NONE, TABLE).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let program = compiled(&library).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(program.parameters().len(), 1, "the object is none that can be set");
    let codes = &program.sorted().dae.functions.codes;
    assert!(codes.iter().any(|code| code.derivative.is_some()), "the annotation counts");
    let mut system = program.system();
    for k in [3.0, 5.0, 3.0] {
        system.set_parameter(0, k).expect("a parameter");
        system.initialize(0.0, &mut [1.0]).expect("initial values");
        let (mut value, mut slope) = ([0.0], [0.0]);
        for (u, expected, exact) in [(0.5, k / 2.0, k), (1.5, (k + 4.0) / 2.0, 4.0 - k)] {
            system.rhs(0.0, &[u], &mut value).expect("a value");
            system.jacobian(0.0, &[u], &mut slope).expect("a slope");
            assert!((value[0] - expected).abs() < 1e-14 && (slope[0] - exact).abs() < 1e-13);
        }
    }
}

#[test]
fn components_without_value_are_faults_of_who_reads_them() {
    // At the top level, of a call whose function is too long to be carried out on expressions.
    let text = |read: &str| {
        format!(
            "package P record R Real a; Real b; end R; function part input Real u; output R r; \
             protected Integer k = 0; algorithm while k < u loop k := k + 1; r.a := k; end while; \
             end part; function chosen input R r; output Real y = r.{read}; algorithm end chosen; \
             model Main Real y = chosen(part(time + 2)); end Main; end P;"
        )
    };
    let run = |text: &str, strict: bool| {
        let file = parse_stored_definition(SourceId::NONE, text).expect("Modelica");
        let mut library = Library::new();
        library.set_strict(strict);
        library.load(&file).expect("a loadable file");
        let program = compiled(&library).expect("it compiles");
        let settings = Settings { stop: 0.5, ..Settings::default() };
        let mut system = program.system();
        let result = simulate(&mut system, &settings);
        let result = result.map_err(|error| program.explain(&error).message.clone());
        result.map(|_| system.notices().len())
    };
    assert_eq!(run(&text("a"), true), Ok(0));
    let expected = "a variable has no value in the function `P.part` (at t = 0)";
    assert_eq!(run(&text("b"), true).unwrap_err(), expected);
    // Zero with a warning, as for other variables of functions.
    assert_eq!(run(&text("b"), false), Ok(1));
}

/// A parameter that a function leaves without value is a fault of the equations that read it.
#[test]
fn parameters_without_value_are_faults_of_who_reads_them() {
    let text = |value: &str| {
        format!(
            "model M record R Real a; Real b; end R; \
             function part input Real u; output R r; algorithm r.a := u; \
             if u > 5 then r.b := 2; end if; end part; \
             function chosen input R r; input Boolean c; output Real y; algorithm y := r.a; \
             if c then y := y + r.b; end if; end chosen; \
             parameter Real u = 1; final parameter R r = part(u); Real y = {value}; end M;"
        )
    };
    let run = simulated(&text("time + chosen(r, false)"), 1.0);
    assert_eq!(run.at("y", 1.0), 2.0);
    for reading in ["chosen(r, true)", "time + r.b", "chosen(r, time > 0.5)"] {
        let (program, _, _, ended) = crate::support::simulated::attempt(&text(reading), 1.0);
        let message = program.explain(&ended.expect_err(reading)).message.clone();
        assert!(message.contains("a variable has no value in the function `M.part`"), "{message}");
        let warnings: Vec<&str> = program.warnings().iter().map(|w| w.message.as_str()).collect();
        let expected = "the parameter `r.b` has no value: the function `M.part` gives it none";
        assert!(warnings.contains(&expected), "{warnings:?}");
    }
}

/// Two functions have the same arguments under one condition, which another condition computes in
/// between.
#[test]
fn arguments_are_computed_again_where_another_branch_has_computed_them() {
    let model = include_str!("../../data/models/functions_branches.mo");
    let world = MemoryWorld::new().with_file("M.mo", model);
    let streams = world.streams();
    let script = "openModel(\"M.mo\");
        simulateModel(\"Branches\", stopTime = 1, resultFile = \"r\");
        all := readTrajectory(\"r.mat\", {\"u\", \"v\", \"w\"}, readTrajectorySize(\"r.mat\"));
        last := all[:, end];";
    let mut session = Session::new(Box::new(world));
    session.run_text("s.mos", script);
    assert_eq!(streams.errors(), "");
    let last = session.variable("last").and_then(|last| last.as_reals().map(|v| v.into_owned()));
    let a = 2.0 * 1f64.sin();
    let (u, g) = (a + 1.0 - 2.0, a - 1.0);
    for (found, expected) in last.expect("values").iter().zip([u, a * u, g + a * u]) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}

/// `der(f, x)` is a function, of loops, of several inputs and inside of others (MLS §12.7.2).
#[test]
fn partial_derivatives_are_functions() {
    let text = include_str!("../../data/models/functions_partial_derivatives.mo");
    let run = simulated(text, 1.0);
    for t in [0.0, 0.4, 1.0_f64] {
        let expected = [
            ("a", 6.0 * t + t.cos()),
            ("b", 2.0 * t),
            ("c", 1.0 + 2.0 * t + 3.0 * t * t + 4.0 * t.powi(3)),
            ("d", 12.0 * t + 3.0 * t.cos()),
            ("e", 0.5),
        ];
        for (name, value) in expected {
            assert!((run.at(name, t) - value).abs() < 1e-9, "{name} = {} at {t}", run.at(name, t));
        }
    }
    let negative = text.replace("fx(time, 3)", "fx(-time - 1, 3)");
    let error =
        crate::support::simulated::attempt(&negative, 1.0).3.expect_err("the assertion of f");
    assert!(format!("{error:?}").contains("Assert"), "{error:?}");
}

#[test]
fn partial_derivatives_need_scalar_real_inputs() {
    for (input, by) in [("Integer k", "k"), ("Real k[2]", "k"), ("Real x", "other")] {
        let text = format!(
            "model M function f input {input}; output Real z; algorithm z := 2; end f; \
             function g = der(f, {by}); Real a = g(1); end M;"
        );
        let error =
            crate::support::simulated::compiled(&text).map(|_| ()).expect_err("no derivative");
        assert!(error.message.contains("is not a scalar Real input of `M.f`"), "{}", error.message);
    }
}

/// What a partial application binds need not be the last inputs (MLS §12.4.2.1).
#[test]
fn partial_applications_bind_any_inputs() {
    let model = include_str!("../../data/models/functions_bound_inputs.mo");
    let world = MemoryWorld::new().with_file("M.mo", model);
    let streams = world.streams();
    let script = "openModel(\"M.mo\");
        simulateModel(\"Partial\", stopTime = 1, resultFile = \"r\");
        all := readTrajectory(\"r.mat\", {\"area\", \"twice\"}, readTrajectorySize(\"r.mat\"));
        last := all[:, end];";
    let mut session = Session::new(Box::new(world));
    session.run_text("s.mos", script);
    assert_eq!(streams.errors(), "");
    let last = session.variable("last").and_then(|last| last.as_reals().map(|v| v.into_owned()));
    assert_eq!(last, Some(vec![8.0, 10.0]));
}

#[test]
fn what_a_partial_application_binds_may_have_sizes_of_other_inputs() {
    let model = include_str!("../../data/models/functions_bound_sizes.mo");
    let file = parse_stored_definition(SourceId::NONE, model).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let flat = flatten(&library, &Name::parse("Sizes"), &[]).expect("a model").model;
    let program = Program::compile(causalize(&flat).expect("a model")).expect("a model");
    let mut system = program.system();
    let [z, v] = ["z", "v[4]"].map(|name| program.find_variable(name).expect(name));
    system.observe_only(&[z, v]);
    system.initialize(0.0, &mut []).expect("a start");
    let mut out = [0.0; 2];
    system.observe(3.0, &[], &mut out).expect("values");
    assert_eq!(out, [6.0, 3.0]);
}

/// The least and the greatest of nothing are the ends of the type (MLS §10.3.4.1).
#[test]
fn the_least_of_no_elements_is_the_greatest_value_of_their_type() {
    let model = include_str!("../../data/models/functions_extremes.mo");
    let file = parse_stored_definition(SourceId::NONE, model).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let flat = flatten(&library, &Name::parse("Ends"), &[]).expect("a model").model;
    let program = Program::compile(causalize(&flat).expect("a model")).expect("a model");
    let mut system = program.system();
    system.observe_only(&[program.find_variable("x").expect("x")]);
    system.initialize(0.0, &mut []).expect("a start");
    let mut out = [0.0];
    system.observe(0.0, &[], &mut out).expect("a value");
    assert_eq!(out, [4.0]);
}
