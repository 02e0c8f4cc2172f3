//! Sizes of the arguments of functions and of constructors of records in models.

use crate::support::simulated::{refused, simulated};

const MODELS: &str = include_str!("../../data/models/argument_sizes.mo");

fn of(model: &str) -> String {
    format!("{MODELS}\nmodel Own = ArgumentSizes.{model};")
}

#[test]
fn arguments_of_the_declared_sizes_are_accepted() {
    for (model, variable, expected) in [
        ("Fixed", "y", 7.0),
        ("Parameter", "y", 2.0),
        ("EachRow", "y[2]", 5.0),
        ("EachNumber", "y[1]", 2.0),
        ("Nothing", "y", 0.0),
        ("Derived", "y", 18.0),
        ("NotTaken", "y", 0.0),
        ("OfRecord", "y", 3.0),
        ("Varying", "y", 2.0),
    ] {
        let value = simulated(&of(&format!("Right.{model}")), 1.0).last(variable);
        assert!((value - expected).abs() < 1e-12, "{model}: {value}");
    }
}

#[test]
fn arguments_of_other_sizes_are_refused() {
    for (model, sizes) in [
        ("Fixed", "`v` of `ArgumentSizes.norm3` has the sizes [3], but its argument has [4]"),
        ("OfInput", "[4], but its argument has [3]"),
        ("Parameter", "[4], but its argument has [3]"),
        ("OfArray", "`b` of `ArgumentSizes.dot` has the sizes [2], but its argument has [3]"),
        ("Named", "[2], but its argument has [3]"),
        ("Column", "[:, 2], but its argument has [1, 3]"),
        ("Vector", "[:, 2], but its argument has [2]"),
        ("Derived", "[3, 6], but its argument has [3, 5]"),
        ("EachRow", "[2], but its argument has [3]"),
        ("Inside", "[1], but its argument has [2]"),
        ("Record", "`v` of `ArgumentSizes.R` has the sizes [3], but its argument has [2]"),
        ("OfRecord", "[2], but its argument has [3]"),
        ("Statement", "[3], but its argument has [2]"),
    ] {
        let said = refused(&of(&format!("Wrong.{model}")));
        assert!(said.starts_with("array-mismatch"), "{model}: {said}");
        assert!(said.contains(sizes), "{model}: {said}");
    }
}
