//! Rules that classes keep or break by their text: what is refused, and what is not.

use crate::support::simulated::simulated;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::{Access, Program};
use gapilib::internals::flatten::{Library, check, flatten};
use gapilib::internals::name::Name;
use gapilib::internals::sim::{Settings, simulate};
use gapilib::internals::source::SourceMap;
use gapilib::internals::syntax::parse_stored_definition;

fn library(text: &str) -> Library {
    let sources = SourceMap::default();
    let source = sources.add("test.mo", text);
    let mut library = Library::new();
    for class in parse_stored_definition(source, text).expect("Modelica").classes {
        library.define(&class).expect("loads");
    }
    library
}

/// The codes of what is wrong with the class `M` and those that take part in it.
#[track_caller]
fn refused(text: &str, code: &str) {
    let errors =
        flatten(&library(text), &Name::parse("M"), &[]).expect_err("the model is accepted");
    let codes: Vec<&str> = errors.iter().map(|error| error.code.slug).collect();
    assert!(codes.contains(&code), "{codes:?}");
}

/// What old libraries write is a warning.
#[track_caller]
fn warned(text: &str, code: &str) {
    let flattened = flatten(&library(text), &Name::parse("M"), &[]).expect("the model is refused");
    let codes: Vec<&str> = flattened.warnings.iter().map(|one| one.code.slug).collect();
    assert!(codes.contains(&code), "{codes:?}");
}

#[track_caller]
fn accepted(text: &str) {
    if let Err(errors) = flatten(&library(text), &Name::parse("M"), &[]) {
        panic!("{errors:?}");
    }
}

#[test]
fn specialized_classes_contain_what_they_may() {
    let code = "class-restriction";
    refused("record R Real x; algorithm x := 1; end R; model M R r; end M;", code);
    refused_if_strict(
        "record R Real x; protected constant Real y = 1; end R;
        model M R r(x = 1); end M;",
        code,
    );
    refused("record R output Real x; end R; model M R r(x = 1); end M;", code);
    refused("connector C outer Real x; end C; model M C c; end M;", code);
    refused("model A end A; record R A a; end R; model M R r; end M;", code);
    refused("package P Real x = 1; end P; model M Real y = P.x; end M;", code);
    refused_if_strict(
        "connector C Real e; flow Real f; end C; block B C c; equation c.e = 1; end B; \
        model M B b; end M;",
        code,
    );
    warned(
        "connector C Real e; Real g; flow Real f; end C; model M C c(e = 1, g = 2); end M;",
        code,
    );
    refused("connector C Real e; flow Real f[2]; stream Real s; end C; model M C c; end M;", code);
    refused("type T extends Real; Real x; end T; model M T t; end M;", code);
    accepted("record R Real x; Integer n; end R; model M R r(x = 1, n = 2); end M;");
    accepted("connector U = input Real; block B U u; end B; model M B b(u = 1); end M;");
}

#[test]
fn prefixes_fit_what_they_stand_before() {
    let code = "illegal-prefix";
    refused_if_strict("model A Real x = 1; end A; model M parameter A a; end M;", code);
    refused("connector C flow Boolean f; Boolean e; end C; model M C c; end M;", code);
    refused("model M stream Real s = 1; end M;", code);
    refused("connector C Real e = 1; end C; model M constant C c; end M;", code);
    refused_if_strict("model M input parameter Real p = 1; end M;", code);
    refused(
        "connector C input Real x; Real e; flow Real f; end C; model M output C c; end M;",
        code,
    );
}

#[test]
fn names_are_free_and_different() {
    refused("model M Real Integer = 1; end M;", "reserved-name");
    refused("model M type E = enumeration(a, start); E e = E.a; end M;", "reserved-name");
    refused("model M type E = enumeration(a, b, a); E e = E.a; end M;", "duplicate-element");
    refused("model M Real x = 1; model x end x; end M;", "duplicate-element");
    refused("type x = Real; model M x x = 1; end M;", "duplicate-element");
}

#[test]
fn what_is_extended_can_be() {
    let code = "illegal-extends";
    refused("model M replaceable model A Real x = 1; end A; extends A; end M;", code);
    refused("type T = Real[2]; model M extends T; Real y = 1; end M;", code);
    refused(
        "operator record R Real x; end R; record S extends R; end S; model M S s; end M;",
        code,
    );
}

#[test]
fn imports_name_one_public_element_of_a_package() {
    let packages = "package P constant Real a = 1; protected constant Real c = 3; end P; package Q constant Real a = 2; end Q;";
    refused(
        &format!("{packages} model M import P.a; import Q.a; Real x = a; end M;"),
        "illegal-import",
    );
    refused(
        &format!("{packages} model M import P.*; import Q.*; Real x = a; end M;"),
        "illegal-import",
    );
    refused(&format!("{packages} model M import P.c; Real x = c; end M;"), "protected-access");
    refused(
        "model A model B Real x = 1; end B; end A; model M import A.B; B b; end M;",
        "illegal-import",
    );
    accepted(&format!("{packages} model M import P.a; import b = Q.a; Real x = a + b; end M;"));
    accepted(&format!("{packages} model M import P.a; import P.a; Real x = a; end M;"));
}

#[test]
fn names_with_dots_look_into_packages() {
    warned(
        "model A Real x = 1; model B Real y = 2; end B; end A; model M A.B b; end M;",
        "illegal-access",
    );
    refused_if_strict(
        "partial package P constant Real a = 1; end P; model M Real x = P.a; end M;",
        "illegal-access",
    );
    refused(
        "package P protected constant Real a = 1; end P; model M Real x = P.a; end M;",
        "protected-access",
    );
    accepted(
        "model A Real x = 1; encapsulated model B Real y = 2; end B; end A; model M A.B b; end M;",
    );
}

#[test]
fn equations_and_statements_stand_where_they_may() {
    let code = "misplaced-equation";
    refused(
        "model M Real x; equation when time > 1 then when time > 2 then x = 1; end when; end when; end M;",
        code,
    );
    refused(
        "model M Real x; Real y; equation x + y = 1; when time > 1 then 2*x = 3; end when; end M;",
        code,
    );
    refused("model M Real x; algorithm x := 1; break; end M;", code);
    refused("model M Real x; algorithm x := 1; return; end M;", code);
    refused("model M parameter Real p = 1; algorithm p := 2; end M;", code);
    refused(
        "function f input Real x; output Real y; algorithm y := der(x); end f; model M Real x = f(time); end M;",
        code,
    );
    refused("record R Real x = time; end R; model M R r; end M;", code);
    let pins = "connector C Real e; flow Real f; end C;";
    refused(
        &format!(
            "{pins} model M C a; C b; equation when time > 1 then connect(a, b); end when; end M;"
        ),
        code,
    );
    refused(
        &format!(
            "{pins} model M C a; C b; equation if time > 1 then connect(a, b); end if; end M;"
        ),
        code,
    );
    refused(
        &format!("{pins} model M C a[2]; Integer n = 2; equation connect(a[1], a[n]); end M;"),
        code,
    );
}

#[test]
fn connections_join_connectors_that_fit() {
    let code = "invalid-connection";
    refused_if_strict("model M Real x = 1; Real y; equation connect(x, y); end M;", code);
    let connectors = "connector A input Real x; Real e; flow Real f; end A; connector B Real x; Real e; flow Real f; flow Real g; end B;";
    refused(&format!("{connectors} model M A a; B b; equation connect(a, b); end M;"), code);
    let connectors =
        "connector A parameter Real x = 1; end A; connector B constant Real x = 1; end B;";
    refused(&format!("{connectors} model M A a; B b; equation connect(a, b); end M;"), code);
}

#[test]
fn conditional_components_are_only_connected() {
    refused_if_strict("model M Real x if true; equation x = 1; end M;", "conditional-component");
    accepted("model M parameter Boolean on = true; Real x = 1 if on; end M;");
}

#[test]
fn operators_get_what_they_ask_for() {
    let code = "illegal-argument";
    refused("model M Integer n = 1; Real x = der(n); end M;", code);
    refused(
        "model M parameter Real p = 1; equation when time > 1 then reinit(p, 2); end when; end M;",
        code,
    );
    refused("model M Real x = delay(time, 2, 1); end M;", code);
    refused("model M Real x = delay(time, time); end M;", code);
    refused(
        "model M connector C Real e; flow Real f; end C; C c; Real x = inStream(c.e); end M;",
        code,
    );
}

#[test]
fn conditions_are_boolean_and_enumerations_no_numbers() {
    let code = "type-mismatch";
    refused("model M equation assert(1, \"no\"); end M;", code);
    refused("model M parameter Integer i = 1; Real x = if i then 1 else 2; end M;", code);
    refused("model M type E = enumeration(a, b); Boolean x = E.a == 1; end M;", code);
    refused(
        "model M type E = enumeration(a); type F = enumeration(b); Boolean x = E.a == F.b; end M;",
        code,
    );
}

#[test]
fn redeclarations_fit_what_they_replace() {
    let code = "illegal-redeclaration";
    let classes = "model A Real x = 1; end A; model B Real x = 2; Real y = 3; end B;";
    refused_if_strict(
        &format!("{classes} model C A a; end C; model M C c(redeclare B a); end M;"),
        code,
    );
    refused(
        &format!("{classes} model C replaceable B b; end C; model M C c(redeclare A b); end M;"),
        code,
    );
    refused(&format!("{classes} model M replaceable A a constrainedby B; end M;"), code);
    refused_if_strict(
        &format!(
            "{classes} model C replaceable B b; end C; model D extends C(redeclare B b); end D; model M D d(redeclare A b); end M;"
        ),
        code,
    );
    refused_if_strict(
        "model C protected replaceable Real x = 1; end C; model M extends C; redeclare Real x = 2; end M;",
        code,
    );
    refused_if_strict(
        "model C replaceable constant Real x = 1; end C; model M C c(redeclare Real x = 2); end M;",
        code,
    );
    refused(
        "model C protected parameter Real p = 1; end C; model M C c(p = 2); end M;",
        "protected-access",
    );
    accepted(&format!(
        "{classes} model C replaceable A a; end C; model M C c(redeclare B a); end M;"
    ));
    let media = "package Gas constant Real R = 2; constant Real table = 3; end Gas; \
        package Liquid constant Real R = 4; end Liquid; \
        model C replaceable package Medium = Gas; Real x = Medium.R; end C;";
    refused_if_strict(
        &format!("{media} model M C c(redeclare package Medium = Liquid); end M;"),
        code,
    );
    warned(&format!("{media} model M C c(redeclare package Medium = Liquid); end M;"), code);
    refused(
        &format!(
            "{media} model D extends C; Real y = Medium.table; end D; \
             model M D d(redeclare package Medium = Liquid); end M;"
        ),
        "unknown-name",
    );
}

#[test]
fn operator_functions_have_the_inputs_of_their_operators() {
    let record = |function: &str| {
        format!("operator record R Real a; {function} end R; model M R r(a = 1); end M;")
    };
    let plus = "encapsulated operator function '+' import R; input R x; output R y; algorithm y := x; end '+';";
    refused(&record(plus), "illegal-operator");
    let zero = "encapsulated operator function '0' output Real y; algorithm y := 0; end '0';";
    refused(&record(zero), "illegal-operator");
    let plain = "record R Real a; encapsulated operator function '+' import R; input R x; input R y; \
        output R z; algorithm z.a := x.a + y.a; end '+'; end R; model M R r(a = 1); end M;";
    refused_if_strict(plain, "class-restriction");
}

#[test]
fn classes_that_nobody_uses_are_checked_alone() {
    let library = library("package P record R Real x; equation x = 1; end R; end P;");
    assert_eq!(check(&library, &Name::parse("P")), []);
    let errors = check(&library, &Name::parse("P.R"));
    assert_eq!(errors.len(), 1);
    assert_eq!(errors[0].code.slug, "class-restriction");
    assert_eq!(check(&library, &Name::parse("P.S")), []);
}

/// MLS §7.3.2: without a constraining clause, the modifiers of the original declaration hold for all
/// redeclarations, those of a redeclaration for itself.
#[test]
fn the_modifiers_of_a_redeclaration_do_not_hold_for_the_next_one() {
    let classes = include_str!("../../data/models/checks_redeclared.mo");
    let text = |last: &str| format!("{classes} model M extends {last}; Real y = part.y; end M;");
    let cases = [
        ("One", 2003.0),
        ("Two", 41.0),
        ("Three", 2005.0),
        ("Four", 15.0),
        ("Five", 206.0),
        ("Six", 16.0),
        ("Seven", 2009.0),
        ("Eight", 19.0),
    ];
    for (name, expected) in cases {
        let library = library(&text(name));
        let flat = flatten(&library, &Name::parse("M"), &[]).expect("flattens").model;
        let program = Program::compile(causalize(&flat).expect("sorts")).expect("compiles");
        let (rows, _) = simulate(&mut program.system(), &Settings::default()).expect("runs");
        let y = program.find_variable("y").expect("the variable exists");
        let Access::Observed { column, .. } = program.variables()[y].access else {
            panic!("y is not observed")
        };
        assert_eq!(rows.column(column).last(), Some(&expected), "{name}");
    }
}

/// What libraries do against the specification: accepted, but not in a library that is to conform
/// in all.
#[track_caller]
fn refused_if_strict(text: &str, code: &str) {
    accepted(text);
    let mut library = library(text);
    library.set_strict(true);
    let errors = flatten(&library, &Name::parse("M"), &[]).expect_err("the model is accepted");
    let codes: Vec<&str> = errors.iter().map(|error| error.code.slug).collect();
    assert!(codes.contains(&code), "{codes:?}");
}

#[test]
fn what_libraries_do_is_refused_only_where_all_must_conform() {
    refused_if_strict(
        "model M parameter Integer p = 2; constant Integer c = p; Real x = c; end M;",
        "not-constant",
    );
    let base = "model B model P parameter Real k = 2; end P; end B;";
    let derived = |text: &str| format!("{base} model M extends B; {text} P p; end M;");
    refused_if_strict(&derived("model P parameter Real k = 3; end P;"), "duplicate-element");
    accepted(&derived("model P parameter Real k = 2; end P;"));
    refused_if_strict(
        "connector C Real e; flow Real f; end C; model A C c; equation c.e = c.f; end A;
         model B A a; end B; model M B b; A a; equation connect(a.c, b.a.c); end M;",
        "invalid-connection",
    );
    refused_if_strict(
        "model A outer parameter Real p = 2; Real x = p; end A;
         model M inner parameter Real p = 1; A a; end M;",
        "illegal-prefix",
    );
    refused_if_strict(
        "connector C Real e; flow Real f; end C; model M extends C(f = 2); equation e = 1; end M;",
        "type-mismatch",
    );
    refused_if_strict(
        "function f input Real x; output Real y; output Real z; algorithm y := x; z := 2*x; end f;
         model M Real a[2]; Real b[2]; equation (a, b) = f({1, 2}); end M;",
        "size-mismatch",
    );
}

/// Errors of causalization where all must conform, warnings elsewhere (MLS §4.9.7.1).
#[test]
fn an_attribute_of_states_that_cannot_be_obeyed_is_refused_only_where_all_must_conform() {
    let judged = |text: &str, strict: bool| {
        let mut library = library(text);
        library.set_strict(strict);
        let flat = flatten(&library, &Name::parse("M"), &[]).expect("a model").model;
        match causalize(&flat) {
            Ok(found) => found.dae.warnings.iter().map(|w| w.message.clone()).collect(),
            Err(error) => vec![format!("{}: {}", error.code.slug, error.message)],
        }
    };
    let never = "model M Real x(start = 1, fixed = true, stateSelect = StateSelect.never);
        equation der(x) = -x; end M;";
    let always = "model M Real x(stateSelect = StateSelect.always) = if time < 0.5 then 1 else 5;
        end M;";
    for (text, word) in [(never, "needed as a state"), (always, "cannot be a state")] {
        let (lenient, strict) = (judged(text, false), judged(text, true));
        assert!(lenient.len() == 1 && lenient[0].contains(word), "{lenient:?}");
        assert!(strict[0].starts_with("state-select: ") && strict[0].contains(word), "{strict:?}");
    }
    // Of two names of one variable the other may be meant, and a choice at run time obeys.
    let other = "model M Real x(stateSelect = StateSelect.never); Real y(start = 1, fixed = true);
        equation x = y; der(y) = -x; end M;";
    assert_eq!(judged(other, true), Vec::<String>::new());
}

/// An input of expandable connectors needs a source in one of them; those of the model itself may
/// get it from outside (MLS §9.1.3).
#[test]
fn inputs_of_expandable_connectors_have_a_source() {
    let model = |source: &str| {
        format!(
            "expandable connector Bus end Bus; connector In = input Real; connector Out = output Real;
             model User In u = 1; end User; model Source Out y = 1; end Source;
             model A Bus bus; User user; {source} equation connect(user.u, bus.u); end A;
             model M A a; end M;"
        )
    };
    refused_if_strict(&model(""), "invalid-connection");
    let accepted_if_strict = |text: &str, name: &str| {
        let mut library = library(text);
        library.set_strict(true);
        let flat = flatten(&library, &Name::parse(name), &[]);
        assert!(flat.is_ok(), "{:?}", flat.err());
    };
    accepted_if_strict(&model(""), "A");
    let with_source = model("Source s;").replace("In u = 1", "In u");
    let with_source = with_source.replace("equation", "equation connect(s.y, bus.u);");
    accepted_if_strict(&with_source, "M");
}

/// The size of an array declared with a colon: of its value, or of any attribute that is an array
/// (MLS §10.1).
#[test]
fn an_attribute_gives_the_size_of_an_array() {
    let model = |x: &str| {
        format!(
            "function positive input Integer x[:]; output Integer y[:];
             algorithm for i in 1:size(x, 1) loop if x[i] > 0 then y := cat(1, y, x[i:i]); end if;
             end for; end positive;
             model M {x}; parameter Integer n = size(x, 1); equation x = fill(time, n); end M;"
        )
    };
    let library =
        library(&model("Real x[:](each nominal = 2, start = positive({-2, 1, 0, 4, 2}))"));
    let flat = flatten(&library, &Name::parse("M"), &[]).expect("flattens").model;
    assert_eq!(flat.variables["x"].dims, [3]);
    refused(&model("Real x[:](each start = 2)"), "value-needed");
}

#[test]
fn a_loop_does_not_change_the_size_that_gives_its_range() {
    let function = |range: &str, assigned: &str| {
        format!(
            "function f input Integer n; output Integer y; protected Integer x[:];
             algorithm y := 1; x := ones(n);
             for i{range} loop {assigned} y := y + x[i]; end for; end f;
             model M parameter Integer k = f(3); end M;"
        )
    };
    refused(&function("", "x := ones(size(x, 1) - 1);"), "size-mismatch");
    accepted(&function("", ""));
    accepted(&function(" in 1:n", "x := ones(n);"));
}

/// A flow variable sums to zero in connectors only.
#[test]
fn a_flow_variable_outside_of_connectors_is_a_variable() {
    accepted(
        "record R Real f; end R; connector C flow R r; Real e; end C;
         model M C c; flow Real x = 3; equation c.e = 1; end M;",
    );
}

/// What iterators name in an expression is no variable; operators of events are no parameters.
#[test]
fn variability_is_that_of_all_that_an_expression_reads() {
    let connected = |condition: &str| {
        format!(
            "connector C Real v; flow Real i; end C; model M C a, b; Real i = time; Integer n = 1;
            parameter Real p[3] = {{1, 2, 3}};
            equation if {condition} then connect(a, b); end if; end M;"
        )
    };
    accepted(&connected("sum(i for i in 1:3) > 0"));
    accepted(&connected("p[2] > 0"));
    refused(&connected("p[n] > 0"), "misplaced-equation");
    refused("model M parameter Boolean p = initial(); end M;", "not-constant");
    refused("model M parameter Real p = if terminal() then 1 else 2; end M;", "not-constant");
    refused("model M Boolean b = sample(time, 2*0.1); end M;", "illegal-argument");
}

/// The last iterator is the outer one (MLS §10.4.1).
#[test]
fn ranges_of_iterators_use_those_after_them() {
    let text = "model M Real j = 1.5; Integer n = sum(i for i in j:j + 1, j in 1:3); end M;";
    accepted(text);
    refused(
        "model M Real j = 1.5; Integer n = sum(i + k for i in 1:2, k in j:3); end M;",
        "type-mismatch",
    );
}

#[test]
fn operators_by_element_take_numbers_too() {
    for operator in ["+", ".+", "-", ".-", "*", ".*", "/", "./", "^", ".^"] {
        refused(&format!("model M Real x = true {operator} 1; end M;"), "type-mismatch");
    }
}

/// The value of a function has the type of its output, which may be an enumeration.
#[test]
fn the_values_of_functions_have_types() {
    let model = |declaration: &str| {
        format!(
            "model M type E = enumeration(a, b); type F = enumeration(c);
            function f input Real u; output E y; algorithm y := if u > 1 then E.a else E.b; end f;
            {declaration}; end M;"
        )
    };
    accepted(&model("parameter E e = f(2)"));
    for wrong in ["Real x = f(2)", "Integer n = f(2)", "F e = f(2)"] {
        refused(&model(&format!("parameter {wrong}")), "type-mismatch");
    }
}

/// A range has as many numbers in models as in scripts (MLS §10.4.3), and iterators the same order.
#[test]
fn ranges_of_models_are_those_of_scripts() {
    let text = "model A parameter Integer j = 10; Real x[3, 2] = {i for i in j:j + 1, j in 1:3};
        Real y[4] = 100:0.1:100.3; end A; model M A a; end M;";
    let run = simulated(text, 1.0);
    for row in 1..=3 {
        for column in 1..=2 {
            let expected = f64::from(row + column - 1);
            assert_eq!(run.last(&format!("a.x[{row},{column}]")), expected);
        }
    }
    assert_eq!(run.last("a.y[4]"), 100.3);
}

/// Sizes follow the arguments, given by position or by name, and calls for each element.
#[test]
fn sizes_of_calls_follow_their_arguments() {
    let text = "function f input Real u[:]; input Integer n; output Real y[n];
        algorithm y := fill(sum(u), n); end f;
        model M Real y[2]; Real z[3, 2]; parameter Integer n[2] = size(f(fill(1, 3, 4), n = 5));
        equation y = f({time, 1}, n = 2); z = f({{time, 1}, {1, 2}, {3, 4}}, n = 2); end M;";
    let run = simulated(text, 1.0);
    assert_eq!([run.last("y[2]"), run.last("z[3,1]")], [2.0, 7.0]);
    assert_eq!([run.last("n[1]"), run.last("n[2]")], [3.0, 5.0]);
}

/// A matrix of Integers to a power is made of products, an Integer to a power is a Real (MLS §10.6.7,
/// §10.6.8).
#[test]
fn powers_of_matrices_of_integers_are_integers() {
    accepted("model M constant Integer A[2, 2] = {{1, 2}, {3, 4}}; Integer B[2, 2] = A^2; end M;");
    refused("model M constant Integer a = 2; Integer b = a^2; end M;", "type-mismatch");
    refused(
        "model M constant Integer A[2, 2] = {{1, 2}, {3, 4}}; Integer B[2, 2] = A .^ 2; end M;",
        "type-mismatch",
    );
}

/// Operands have the types of their operators (MLS §3.5, §10.6), elements of arrays as well.
#[test]
fn operands_have_the_types_of_their_operators() {
    let code = "type-mismatch";
    for wrong in ["2 and true", "time > 0.5 or 1", "not 1", "n or time > 1", "not {1, 2}"] {
        refused(&format!("model M Integer n = 2; Boolean b = {wrong}; end M;"), code);
    }
    for wrong in ["2*c", "c .* {1, 2}", "-c + {1, 2}", "{abs(c[1]), 2}"] {
        let text = format!("model M Boolean c[2] = {{true, false}}; Real x[2] = {wrong}; end M;");
        refused(&text, code);
    }
    accepted(
        "model M Boolean c[2] = {true, false}; Boolean d[2] = not c; Boolean e = c[1] or d[2];
        Real x[2, 2] = {{1, 2}, {3, 4}}; Real y[2] = 2*x[:, 1] + x[2, :]; end M;",
    );
}

/// Arguments are converted and spread over calls as the language says (MLS §10.6.13, §12.4.6).
#[test]
fn arguments_have_the_types_of_their_inputs() {
    let right = include_str!("../../data/models/checks_arguments.mo");
    if let Err(errors) = flatten(&library(right), &Name::parse("Arguments.M"), &[]) {
        panic!("{errors:?}");
    }
    let function = "type E = enumeration(a, b); function f input Real x; input Integer n = 1; \
                    output Real y = n*x; end f; ";
    let (types, twice) = ("type-mismatch", "wrong-arguments");
    for wrong in
        ["f(true)", "f(1, 2.5)", "f(1, n = time)", "f(1, E.a)", "f(\"1\")", "sum(f({true}))"]
    {
        refused(&format!("{function} model M Real y = {wrong}; end M;"), types);
    }
    for wrong in ["f(1, x = 2)", "f(1, 2, n = 3)", "f(n = 1, x = 2, n = 3)"] {
        refused(&format!("{function} model M Real y = {wrong}; end M;"), twice);
    }
}

/// An Integer has no Real value, whatever gives it (MLS §10.6.13).
#[test]
fn integers_hold_no_reals() {
    let code = "type-mismatch";
    let pair = "function f output Real a = 1.5; output Real b = 2; end f;";
    refused("model M Integer k; algorithm k := 3/2; end M;", code);
    refused("model M Integer k(start = 1.5); equation k = 1; end M;", code);
    refused(
        "model M Integer k(start = 0, fixed = true);
        equation when time > 0.5 then k = pre(k) + 0.5; end when; end M;",
        code,
    );
    refused(&format!("{pair} model M Integer i; Real y; algorithm (i, y) := f(); end M;"), code);
    refused(
        "function f input Integer n; output Integer m; algorithm m := n/2; end f;
        model M Real y = f(3); end M;",
        code,
    );
    refused(
        "function f input Real v[:]; output Real y = m; protected Integer m = size(v, 1)/2; end f;
        model M Real y = f({1, 2, 3}); end M;",
        code,
    );
}

/// An enumeration has the values of its literals alone (MLS §4.9.5).
#[test]
fn enumerations_have_no_other_values_than_literals() {
    let model = |body: &str| format!("model M type E = enumeration(a, b, c); {body} end M;");
    let code = "type-mismatch";
    refused(&model("E e; algorithm e := 7;"), code);
    refused(&model("E e; equation e = 7;"), code);
    refused(&model("E e(start = 7); equation e = E.a;"), code);
    refused(&model("E e = E(4);"), code);
    refused(&model("E e = E(0);"), code);
    accepted(&model("E e = E(3); Integer i = Integer(e); E f[2] = {E(i) for i in 1:2};"));
    let numbered = model(
        "parameter Integer k = 2; E e = E(k); E f(start = E.a, fixed = true); Integer n;
        equation when time > 0.3 then f = E(Integer(pre(f)) + 1); end when; n = Integer(f);",
    );
    let run = simulated(&numbered, 1.0);
    assert_eq!([run.last("e"), run.last("n")], [2.0, 2.0]);
    for number in ["E(k)", "E(integer(3*time) + 2)", "f(k)"] {
        let text = model(&format!(
            "parameter Integer k = 4; E e = {number};
            function f input Integer i; output E e; algorithm e := E(i); end f;"
        ));
        let (program, _, _, ended) = crate::support::simulated::attempt(&text, 1.0);
        let error = program.explain(&ended.expect_err("there is no such literal"));
        let said = &error.message;
        assert!(said.contains("has no literal with this number"), "{number}: {said}");
    }
}

/// Outside of when-clauses, only what is discrete has a value before (MLS §3.7.5.1).
#[test]
fn continuous_variables_have_no_value_before_outside_of_when_clauses() {
    use crate::support::simulated::refused as said;
    let model = |body: &str| {
        format!("model M Real x(start = 2, fixed = true); {body} equation der(x) = 1; end M;")
    };
    for wrong in [
        "Real y = pre(x);",
        "Boolean b = change(x);",
        "Real y; algorithm y := pre(x) + 1;",
        "Real y; algorithm y := 0; for i in 1:integer(time) loop y := y + pre(x); end for;",
        "discrete Real d(start = 0, fixed = true); equation when pre(x) > 3 then d = x; end when;",
    ] {
        let found = said(&model(wrong));
        assert!(found.starts_with("not-discrete"), "{wrong}: {found}");
    }
    let right =
        "discrete Real d(start = 0, fixed = true); Boolean b = time > 0.5; Boolean e = edge(b);
        Integer n(start = 0, fixed = true); Real z = pre(d) + (if change(n) then 1 else 0);
        Real w(start = 0, fixed = true); algorithm when edge(b) then w := pre(x); end when;
        equation when b then d = pre(x) + 1; n = pre(n) + 1; end when;";
    let run = simulated(&model(right), 1.0);
    let values = [run.last("d"), run.last("z"), run.last("w"), run.last("n")];
    crate::support::simulated::all_near(&values, &[3.5, 3.5, 2.5, 1.0], 1e-6);
    // An input that is declared discrete holds its samples (MLS §3.8.4); another one need not.
    let block = |prefix: &str| format!("block B {prefix} input Real u; Real y = pre(u); end B;");
    let text = format!(
        "model M {} discrete Real d(start = 0, fixed = true); B b(u = d); equation
         when time > 0.5 then d = pre(d) + 2; end when; end M;",
        block("discrete")
    );
    crate::support::simulated::all_near(&[simulated(&text, 1.0).last("b.y")], &[2.0], 1e-12);
    assert!(crate::support::simulated::compiled(&block("discrete")).is_ok());
    assert!(said(&block("")).starts_with("not-discrete"));
}

/// What is known at translation is compared with `min` and `max` (MLS §4.9).
#[test]
fn values_outside_of_declared_ranges_are_warned_of() {
    let warnings = |declarations: &str| {
        let text = format!("model M {declarations} end M;");
        let program = crate::support::simulated::program(&text);
        let outside = program.warnings().iter().filter(|one| one.code.slug == "outside-range");
        outside.map(|one| one.message.clone()).collect::<Vec<_>>()
    };
    for (declarations, expected) in [
        ("parameter Real p(max = 1) = 2;", "`p` is 2, above its `max` of 1"),
        ("parameter Integer n(min = 1) = -3;", "`n` is -3, below its `min` of 1"),
        ("constant Real c(max = 5) = 6;", "`c` is 6, above its `max` of 5"),
        ("parameter Real q[3](each min = 0) = {1, -1, -2};", "`q[2]` is -1, below its `min` of 0"),
        ("parameter Real l = 3; parameter Real p(min = l) = 2;", "`p` is 2, below its `min` of 3"),
        (
            "Real x(start = -1, fixed = true, min = 0); equation der(x) = 1;",
            "the start value of `x` is -1, below its `min` of 0",
        ),
    ] {
        assert_eq!(warnings(declarations), [expected], "{declarations}");
    }
    // Each of two instances, each side, the value of a function; once for all elements of an array.
    let tank = "model Tank parameter Real a(min = 0, max = b); parameter Real b = 5; end Tank;";
    for (declarations, expected) in [
        (
            "Tank first(a = -1), second(a = -2), right(a = 3);",
            &["`first.a` is -1, below its `min` of 0", "`second.a` is -2, below its `min` of 0"][..],
        ),
        (
            "Tank row[3](a = {-1, 6, -2}, each b = 4);",
            &["`row[1].a` is -1, below its `min` of 0", "`row[2].a` is 6, above its `max` of 4"],
        ),
        (
            "Tank both(a = -1, b = -2);",
            &["`both.a` is -1, below its `min` of 0", "`both.a` is -1, above its `max` of -2"],
        ),
        (
            "function f input Real u; output Real y = u^2; end f; parameter Real p(min = f(3)) = 8;",
            &["`p` is 8, below its `min` of 9"],
        ),
        (
            "Tank a(a = 6), b(a = 7), c(a = 8), d(a = 9), e(a = 10), f(a = -1), g(a = 11);",
            &[
                "`a.a` is 6, above its `max` of 5",
                "`b.a` is 7, above its `max` of 5",
                "`c.a` is 8, above its `max` of 5",
                "`d.a` is 9, above its `max` of 5",
                "`e.a` is 10, above its `max` of 5",
                "also outside of `min` and `max`: `f.a`, `g.a`",
            ],
        ),
    ] {
        assert_eq!(warnings(&format!("{tank} {declarations}")), expected, "{declarations}");
    }
    let right = "parameter Real p(min = 0, max = 1) = 1; parameter Real q(min = 0) = p;
        Real x(start = -1, min = 0); type E = enumeration(a, b); parameter E e(max = E.b) = E.b;
        equation der(x) = 1;";
    assert_eq!(warnings(right), [""; 0]);
}
