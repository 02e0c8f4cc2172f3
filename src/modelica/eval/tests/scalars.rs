//! The quick way to scalars.

use super::TestHost;
use crate::eval::scalar::MAX_DEPTH;
use crate::eval::scalar_expression::scalar;
use crate::eval::{Scope, evaluate};
use crate::name::Ident;
use crate::source::SourceId;
use crate::syntax::parse_expression;
use crate::value::Value;

/// Where the quick way gives a value, the general way gives the same.
#[test]
fn the_quick_way_and_the_general_way_agree() {
    let mut scope = Scope::script();
    for (name, value) in [
        ("x", Value::Real(2.5)),
        ("n", Value::Integer(7)),
        ("b", Value::Boolean(true)),
        ("s", Value::string("text")),
        ("big", Value::Integer(i64::MAX)),
    ] {
        scope.set(Ident::new(name), value).expect("assignable");
    }
    let atoms = ["x", "n", "b", "s", "big", "0", "2", "0.0", "1.5"];
    let operators = ["+", "-", "*", "/", "<", "<=", ">", ">=", "==", "and", "^"];
    let mut quick = 0;
    for a in atoms {
        for operator in operators {
            for b in atoms {
                let text = format!("{a} {operator} {b} + n*x");
                let expression = parse_expression(SourceId::NONE, &text).expect("readable");
                let Some(found) = scalar(&scope, &expression, MAX_DEPTH) else { continue };
                quick += 1;
                let expected = evaluate(&expression, &mut scope, &mut TestHost::default());
                assert_eq!(expected.expect("a value"), Value::from(found), "{text}");
            }
        }
    }
    assert!(quick > 100, "{quick}");
}
