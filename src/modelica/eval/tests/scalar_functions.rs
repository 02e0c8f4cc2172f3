//! The quick way to call functions of scalars.

use super::{TestHost, run_in};
use crate::eval::{Arguments, Compiled, Scope, call_function};
use crate::source::Span;
use crate::value::Value;

/// Declarations and algorithms of functions with the inputs `Real x`, `Integer n`, and the output
/// `Real y`.
const BODIES: &[&str] = &[
    "algorithm y := 2*x + 1;",
    "algorithm y := if x > 1 then n elseif x < -1 then -n else x^2;",
    "Integer k = 2*n; algorithm y := k + div(n, 2) + mod(-n, 3);",
    "algorithm y := 0; for i in 1:n loop y := y + i*x; if y > 20 then break; end if; end for;",
    "algorithm y := 1; for i in n:-1:1 loop if i == 2 then return; end if; y := y*i; end for;",
    "algorithm y := 0; for i in 0:0.1:x loop y := y + i; end for;",
    "Integer k = n; algorithm y := 0; while k > 0 and y < 9 loop y := y + 1; k := k - 1; end while;",
    "algorithm y := sin(x) + max(x, 2) + sqrt(x) + abs(-n);",
    "Boolean b = not x > 2; algorithm y := if b or n > 0 then 1 else 2;",
    "algorithm assert(x > 0, \"x is not positive\"); y := 1/n;",
    "Integer k; algorithm if n > 2 then k := n; end if; y := k;",
    "Integer k; algorithm k := x*n; y := k;",
    "algorithm if n > 0 then y := x; end if;",
    "algorithm y := n*n*n*n; y := y + 9223372036854775807*n;",
    "algorithm for i in 1:n loop for i in 1:2 loop y := i; end for; end for;",
    "algorithm y := log(x);",
];

/// A function that only calculates, and its twin that the general way alone can call.
fn functions(body: &str) -> TestHost {
    let (declarations, algorithm) = body.split_at(body.find("algorithm").expect("an algorithm"));
    let with = |name: &str, unused: &str| {
        format!(
            "function {name} input Real x; input Integer n = 3; output Real y; \
             protected {declarations} {unused} {algorithm} end {name};\n"
        )
    };
    let mut host = TestHost::default();
    let text = with("quick", "") + &with("general", "String s;");
    run_in(&text, &mut Scope::script(), &mut host).expect(body);
    host
}

fn outcome(host: &mut TestHost, name: &str, arguments: &[Value]) -> Result<Vec<Value>, String> {
    let function = host.functions[name].clone();
    let arguments = Arguments::from(arguments.to_vec());
    let result = call_function(&function, arguments, Span::NONE, host);
    result.map_err(|error| error.message.clone())
}

#[test]
fn the_quick_way_and_the_general_way_to_call_agree() {
    let mut quick = 0;
    for body in BODIES {
        let mut host = functions(body);
        for x in [Value::Real(-2.5), Value::Real(0.0), Value::Integer(1), Value::Real(3.7)] {
            for n in [-3, 0, 1, 2, 5, i64::MAX / 2] {
                let arguments = [x.clone(), Value::Integer(n)];
                if n > 5 && body.contains("loop") {
                    continue;
                }
                let given = arguments.clone().map(Some);
                let function = host.functions["quick"].clone();
                quick += usize::from(Compiled::call(&function, &given, &mut host).is_some());
                let found = outcome(&mut host, "quick", &arguments);
                let expected = outcome(&mut host, "general", &arguments);
                assert_eq!(found, expected, "{body} of {arguments:?}");
            }
        }
    }
    assert!(quick > 150, "{quick}");
}

#[test]
fn defaults_and_arrays_are_taken_as_ever() {
    let mut host = functions(BODIES[0]);
    assert_eq!(outcome(&mut host, "quick", &[Value::Real(2.0)]), Ok(vec![Value::Real(5.0)]));
    let vector = [Value::reals(vec![1.0, 2.0])];
    assert_eq!(outcome(&mut host, "quick", &vector), Ok(vec![Value::reals(vec![3.0, 5.0])]));
}

/// Names of functions of the language may be those of functions of a library.
#[test]
fn what_the_host_knows_wins_over_functions_of_the_language() {
    let mut host = TestHost::default();
    let text = "function sin input Real u; output Real y; algorithm y := 7; end sin;\n\
                function f input Real x; output Real y; algorithm y := sin(x); end f;";
    run_in(text, &mut Scope::script(), &mut host).expect("readable");
    assert_eq!(outcome(&mut host, "f", &[Value::Real(0.0)]), Ok(vec![Value::Real(7.0)]));
}
