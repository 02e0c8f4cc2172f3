//! Matrices and vectors (MLS §10.3.5).

use super::Builtin;
use super::arrays::shown;
use super::plan::{Argument, Element, Plan, of};
use super::rules::{Known, TypeRule};
use crate::bail;
use crate::diag::Fault;
use crate::symbolic::function::UnitRule;
use crate::value::element_count;
use crate::value::errors::SIZE_MISMATCH;

pub(super) const FUNCTIONS: &[Builtin] = &[
    Builtin {
        value_type: TypeRule::Joined,
        section: "MLS §10.3.5",
        ..Builtin::planned("cross", (2, 2), cross, Known::Nothing)
    },
    Builtin {
        value_type: TypeRule::Joined,
        section: "MLS §10.3.5",
        ..Builtin::planned("outerProduct", (2, 2), outer_product, Known::Nothing)
    },
    Builtin { section: "MLS §10.3.5", ..Builtin::planned("skew", (1, 1), skew, Known::Nothing) },
    Builtin {
        unit: UnitRule::As(0),
        section: "MLS §10.3.5",
        ..Builtin::planned("symmetric", (1, 1), symmetric, Known::Nothing)
    },
    Builtin {
        unit: UnitRule::As(0),
        section: "MLS §10.3.5",
        ..Builtin::planned("transpose", (1, 1), transpose, Known::Nothing)
    },
];

/// The first two dimensions exchanged.
fn transpose(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let &[rows, columns, ref rest @ ..] = arguments[0].dims else {
        bail!(SIZE_MISMATCH, "`transpose` needs a matrix, got {}", shown(arguments[0].dims));
    };
    let each = rest.iter().product::<usize>().max(1);
    let dims = [&[columns, rows], rest].concat();
    Ok(Plan::rearranged(dims, move |at| {
        let (block, inner) = (at / each, at % each);
        let (column, row) = (block / rows, block % rows);
        (row * columns + column) * each + inner
    }))
}

/// The upper triangle mirrored at the diagonal.
fn symmetric(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let dims = arguments[0].dims;
    let &[rows, columns] = dims else {
        bail!(SIZE_MISMATCH, "`symmetric` needs a square matrix, got {}", shown(dims));
    };
    if rows != columns {
        bail!(SIZE_MISMATCH, "`symmetric` needs a square matrix, got {}", shown(dims));
    }
    Ok(Plan::rearranged(dims.to_vec(), move |at| {
        let (row, column) = (at / columns, at % columns);
        row.min(column) * columns + row.max(column)
    }))
}

/// The matrix x yᵀ of two vectors.
fn outer_product(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let (&[rows], &[columns]) = (arguments[0].dims, arguments[1].dims) else {
        bail!(
            SIZE_MISMATCH,
            "`outerProduct` needs two vectors, got {} and {}",
            shown(arguments[0].dims),
            shown(arguments[1].dims)
        );
    };
    element_count(&[rows, columns])?;
    let product = move |at: usize| Element::Product(of(0, at / columns), of(1, at % columns));
    Ok(Plan::each(vec![rows, columns], product))
}

/// x × y of two vectors with 3 elements.
fn cross(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    arguments.iter().try_for_each(|argument| three("cross", argument))?;
    Ok(Plan::each(vec![3], |at| {
        let (next, last) = ((at + 1) % 3, (at + 2) % 3);
        Element::Determinant([of(0, next), of(1, last)], [of(0, last), of(1, next)])
    }))
}

/// The matrix S with S y = x × y.
fn skew(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    three("skew", &arguments[0])?;
    Ok(Plan::each(vec![3, 3], |at| match at {
        1 => Element::Negative(of(0, 2)),
        2 => Element::Of(of(0, 1)),
        3 => Element::Of(of(0, 2)),
        5 => Element::Negative(of(0, 0)),
        6 => Element::Negative(of(0, 1)),
        7 => Element::Of(of(0, 0)),
        _ => Element::Integer(0),
    }))
}

fn three(name: &str, argument: &Argument<'_>) -> Result<(), Fault> {
    match argument.dims {
        [3] => Ok(()),
        other => {
            bail!(SIZE_MISMATCH, "`{name}` needs vectors with 3 elements, got {}", shown(other))
        }
    }
}
