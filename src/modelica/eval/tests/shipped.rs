//! The shipped functions of the paper, run as Modelica code.

use super::host::TestHost;
use super::{Scope, run_in};
use crate::name::Ident;
use crate::source::SourceId;
use crate::syntax::parse_stored_definition;
use crate::value::Value;
use crate::value::show::{Style, show};

fn with_shipped(script: &str, shown: &str) -> String {
    let mut host = TestHost::default();
    let strings = [
        include_str!("../../../../models/GAPILib/Basics/Cross.mo"),
        include_str!("../../../../models/GAPILib/Basics/Ram_Gen_ARENA.mo"),
    ];
    for text in strings {
        let definition = parse_stored_definition(SourceId::NONE, text).expect("reads");
        definition.classes.iter().for_each(|class| host.define(class));
    }
    let mut scope = Scope::script();
    if let Err(error) = run_in(script, &mut scope, &mut host) {
        panic!("fails: {error} {:?}", error.trace);
    }
    let value: &Value = scope.get(Ident::new(shown)).expect("assigned");
    show(value, Style::OpenModelica)
}

#[test]
fn cross_exchanges_the_genes_after_the_point() {
    let script = "old := [1, 2, 3, 4; 5, 6, 7, 8; 9, 10, 11, 12]; new := Cross(2, 1, old);";
    let expected = "{{1.0, 2.0, 3.0, 4.0}, {1.0, 2.0, 7.0, 8.0}, {5.0, 6.0, 3.0, 4.0}}";
    assert_eq!(with_shipped(script, "new"), expected);
}

/// The first numbers of MRG32k3a from the seed 12345 (L'Ecuyer et al. 2002).
#[test]
fn the_generator_gives_the_published_numbers() {
    let script = "(u, s) := Ram_Gen_ARENA(fill(12345, 1, 6), 3); r := u[1, 1];";
    let first: f64 = with_shipped(script, "r").parse().expect("a number");
    assert!((first - 0.127_011_122_046_577_14).abs() < 1e-15, "{first}");
}
