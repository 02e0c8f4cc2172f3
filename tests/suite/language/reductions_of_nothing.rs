//! `min` and `max` of no elements are the greatest and the least value of their type (MLS §10.3.4.1,
//! table of reduction expressions): the same in models, in functions and in scripts.

use crate::support::simulated::simulated;
use gapilib::Session;
use gapilib::world::MemoryWorld;

const LITERALS: &str = "type E = enumeration(one, two, three); ";
const REAL: [f64; 2] = [f64::MAX, f64::MIN];
const INTEGER: [f64; 2] = [i64::MAX as f64, i64::MIN as f64];
const BOOLEAN: [f64; 2] = [1.0, 0.0];
const ENUMERATION: [f64; 2] = [3.0, 1.0];

/// The type of the elements, the argument of `min` and `max`, their values; `none` is an array without
/// elements, `n` is 0.
const CASES: &[(&str, &str, [f64; 2])] = &[
    ("Real", "none", REAL),
    ("Real", "0.5*i for i in 1:n", REAL),
    ("Real", "none[i] + 1 for i in 1:n", REAL),
    ("Real", "x for x in 2.0:1", REAL),
    ("Integer", "none", INTEGER),
    ("Integer", "none[i] for i in 1:n", INTEGER),
    ("Integer", "i*j for i in 1:n, j in 1:2", INTEGER),
    ("Integer", "integer(0.5*i) for i in 1:0", INTEGER),
    ("Boolean", "none", BOOLEAN),
    ("Boolean", "i > 1 for i in 1:n", BOOLEAN),
    ("Boolean", "b for b in true:false", BOOLEAN),
    ("E", "none", ENUMERATION),
    ("E", "none[i] for i in 1:n", ENUMERATION),
    ("E", "e for e in E.three:E.one", ENUMERATION),
    ("E", "if i > 1 then none[i] else none[1] for i in 1:n", ENUMERATION),
];

fn function(kind: &str, argument: &str) -> String {
    format!(
        "{LITERALS} function f input Integer n; input {kind} none[:]; \
         output {kind} y[2] = {{min({argument}), max({argument})}}; end f; "
    )
}

#[test]
fn in_models() {
    for (kind, argument, expected) in CASES {
        let text = format!(
            "model M {LITERALS} parameter Integer n = 0; {kind} none[0]; \
             {kind} y[2] = {{min({argument}), max({argument})}}; end M;"
        );
        let run = simulated(&text, 1.0);
        assert_eq!([run.last("y[1]"), run.last("y[2]")], *expected, "{kind}: {argument}");
    }
}

#[test]
fn in_functions_of_models() {
    for (kind, argument, expected) in CASES {
        let text = format!(
            "model M {} parameter Integer n = 0; {kind} none[n]; {kind} y[2] = f(n, none); end M;",
            function(kind, argument)
        );
        let run = simulated(&text, 1.0);
        assert_eq!([run.last("y[1]"), run.last("y[2]")], *expected, "{kind}: {argument}");
    }
}

/// Functions are compiled at the third call.
#[test]
fn in_scripts() {
    for (kind, argument, expected) in CASES {
        let literal = match *kind {
            "Boolean" => "false",
            "E" => "P.E.one",
            "Integer" => "0",
            _ => "0.0",
        };
        let number = match *kind {
            "Boolean" => "if v[k] then 1 else 0",
            _ => "v[k]",
        };
        let number = if *kind == "E" { "Integer(v[k])" } else { number };
        let world = MemoryWorld::new();
        let streams = world.streams();
        let mut session = Session::new(Box::new(world));
        let script = format!(
            "loadString(\"package P {} end P;\"); n := 0; none := fill({literal}, 0);
             for call in 1:4 loop v := P.f(n, none); k := 1; least := {number}; k := 2;
             greatest := {number}; end for;",
            function(kind, argument)
        );
        session.run_text("s.mos", &script);
        assert_eq!(streams.errors(), "", "{kind}: {argument}");
        let found = ["least", "greatest"]
            .map(|name| session.variable(name).and_then(|value| value.as_real()).expect(name));
        assert_eq!(found, *expected, "{kind}: {argument}");
    }
}
