//! Parameters that shaped the equations cannot be set afterwards; those that only choose values
//! can, and what is simulated with a function is what the interpreter computes with it.

use gapilib::Value;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::{Access, Program};
use gapilib::internals::eval::{Arguments, Callee, Function, Host, call_function};
use gapilib::internals::flatten::{Library, flatten};
use gapilib::internals::name::Name;
use gapilib::internals::sim::{Settings, simulate};
use gapilib::internals::source::{SourceId, Span};
use gapilib::internals::syntax::{ast::ComponentReference, parse_stored_definition};
use indexmap::IndexMap;
use std::sync::Arc;

/// The class `name` of a text, flattened and compiled.
fn compiled_class(text: &str, name: &str) -> Arc<Program> {
    let file = parse_stored_definition(SourceId::NONE, text).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let flat = flatten(&library, &Name::parse(name), &[]).expect("a model").model;
    Program::compile(causalize(&flat).expect("it can be sorted")).expect("it compiles")
}

fn compiled(text: &str) -> Arc<Program> {
    compiled_class(text, "M")
}

/// The value of `x` at the end, with parameters set.
fn x_with(program: &Arc<Program>, settings: &[(&str, f64)]) -> f64 {
    let mut system = program.system();
    for (name, value) in settings {
        let at = program.find_parameter(name).expect("a parameter that can be set");
        system.set_parameter(at, *value).expect("a number");
    }
    let to_one = Settings { stop: 1.0, ..Settings::default() };
    let trajectory = simulate(&mut system, &to_one).expect("a simulation").0;
    let at = program.find_variable("x").expect("there is an x");
    match program.variables()[at].access {
        Access::Observed { column, negated } => {
            let value = trajectory.column(column)[trajectory.len() - 1];
            if negated { -value } else { value }
        }
        _ => system.value(at).expect("x has a value"),
    }
}

#[test]
fn a_condition_of_an_if_expression_can_be_set() {
    let program = compiled(
        "model M parameter Boolean b = true; parameter Real k = 1; Real x = if b then k else 10; \
         end M;",
    );
    assert_eq!(x_with(&program, &[]), 1.0);
    assert_eq!(x_with(&program, &[("k", 3.0)]), 3.0);
    assert_eq!(x_with(&program, &[("b", 0.0)]), 10.0);
}

#[test]
fn a_condition_that_holds_of_time_too_can_be_set() {
    let program = compiled(
        "model M parameter Real k = 1; Real x; equation if k > 2 and time >= 0 then x = 1; \
         else x = 10; end if; end M;",
    );
    assert_eq!(x_with(&program, &[]), 10.0);
    assert_eq!(x_with(&program, &[("k", 3.0)]), 1.0);
}

#[test]
fn parameters_that_chose_equations_or_sizes_cannot_be_set() {
    for text in [
        "model M parameter Integer p = 1; Real x; equation if p == 1 then x = 1; else x = 2; \
         end if; end M;",
        "model M parameter Integer p = 2; Real y[p] = fill(1.0, p); Real x = sum(y); end M;",
        "model M parameter Integer p = 2; parameter Integer q = 2*p; Real y[q] = fill(1.0, q); \
         Real x = sum(y); end M;",
        "model M parameter Integer p = 2; Real y[3]; Real x = y[1]; equation for i in 1:p loop \
         y[i] = 1; end for; y[3] = 2; end M;",
        "model M parameter Boolean p = true; Real y = 1 if p; Real x = 1; end M;",
    ] {
        let program = compiled(text);
        let fault = program.find_parameter("p").expect_err(text);
        assert!(fault.to_string().contains("structural"), "{text}: {fault}");
    }
}

/// Answers calls among the functions of a library.
struct Functions(IndexMap<Name, Arc<Function>>);

impl Host for Functions {
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, gapilib::Diagnostic> {
        Ok(self.0.get(name).cloned().map(Callee::Function))
    }

    fn variable(&mut self, _: &ComponentReference) -> Result<Option<Value>, gapilib::Diagnostic> {
        Ok(None)
    }
}

/// What the interpreter computes for `P.f(u)`.
fn interpreted(text: &str, u: f64) -> f64 {
    let file = parse_stored_definition(SourceId::NONE, text).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let name = Name::parse("P.f");
    let functions = library.function(&name).expect("ready").expect("declared");
    let function = functions[&name].clone();
    let arguments = Arguments { positional: vec![Value::Real(u)], ..Arguments::default() };
    let outputs = call_function(&function, arguments, Span::NONE, &mut Functions(functions));
    match outputs.expect("a value").as_slice() {
        [Value::Real(value), ..] => *value,
        other => panic!("{other:?} is not a number"),
    }
}

#[test]
fn functions_compute_the_same_in_models_and_scripts() {
    let header = "input Real u; output Real y;";
    for functions in [
        // Default inputs and named arguments.
        format!(
            "function g {header} input Real a = 2; input Real b = a + 1; algorithm \
                 y := u*a + b; end g; function f {header} algorithm y := g(u) + g(u, b = 5); end f;"
        ),
        // Several outputs.
        format!(
            "function g input Real u; output Real a; output Real b; algorithm a := u + 1; \
                 b := u*u; end g; function f {header} protected Real a; Real b; algorithm \
                 (a, b) := g(u); y := a*b; (, b) := g(y); y := y + b; end f;"
        ),
        // Records.
        format!(
            "record R Real a; Real b = 4; end R; function g input R r; output R s; algorithm \
                 s := r; s.a := r.b*r.a; end g; function f {header} protected R r; algorithm \
                 r := g(R(u)); y := r.a + r.b; end f;"
        ),
        // Arrays of any size.
        format!(
            "function g input Real v[:]; output Real y = 0; algorithm for i in 1:size(v, 1) \
                 loop y := y + i*v[i]; end for; end g; function f {header} algorithm \
                 y := g({{u, 2*u, 3}}) + g({{u}}); end f;"
        ),
        // Recursion.
        format!(
            "function g input Integer n; input Real u; output Real y; algorithm \
                 y := if n <= 0 then 1 else u*g(n - 1, u); end g; function f {header} algorithm \
                 y := g(5, u); end f;"
        ),
        // Constants of packages, also of other packages and through each other.
        format!(
            "constant Real k = 2*Q.c; package Q constant Real c = 3; end Q; \
                 function f {header} protected Real t[2] = {{k, Q.c}}; algorithm \
                 y := u*t[1] + t[2]; end f;"
        ),
        // An inherited interface.
        format!(
            "partial function F {header} end F; function f extends F; algorithm \
                 y := sin(u) + max(u, 1); end f;"
        ),
    ] {
        let text =
            format!("package P {functions} model Main Real x = f(1.5 + 0*time); end Main; end P;");
        let expected = interpreted(&text, 1.5);
        let x = x_with(&compiled_class(&text, "P.Main"), &[]);
        assert!(
            (x - expected).abs() <= 1e-12 * expected.abs(),
            "{x} instead of {expected}: {text}"
        );
    }
}

#[test]
fn a_parameter_without_value_shapes_the_model_by_its_start() {
    let text = "model M
  parameter String kind(start = \"double\");
  parameter Integer n(start = 2);
  parameter Boolean more(start = true);
  Real part[n] = fill(1.5, n) if more;
  Real x = sum(part) * (if kind == \"double\" then 2 else 1);
end M;";
    let file = parse_stored_definition(SourceId::NONE, text).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let flattened = flatten(&library, &Name::parse("M"), &[]).expect("a model");
    let said: Vec<String> = flattened.warnings.iter().map(|w| w.message.clone()).collect();
    for name in ["n", "more"] {
        let taken = format!("`{name}` has no value, but its value is needed here: its start value");
        assert_eq!(said.iter().filter(|s| s.starts_with(&taken)).count(), 1, "{said:?}");
    }
    let program = compiled(text);
    assert_eq!(x_with(&program, &[]), 6.0);
}

#[test]
fn a_size_may_come_from_random_numbers_that_a_function_seeds_itself() {
    let text = include_str!("../../data/models/structural_parameters_seeded.mo");
    let (first, second) = (x_with(&compiled(text), &[]), x_with(&compiled(text), &[]));
    assert_eq!(first, second);
    assert!((2.0..=10.0).contains(&first), "{first}");
}
