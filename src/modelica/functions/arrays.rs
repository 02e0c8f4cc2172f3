//! Making arrays and changing their shape (MLS §10.3.2, §10.3.3, §10.4.2).

use super::Builtin;
use super::plan::{Argument, Element, Elements, Plan, of};
use super::rules::{Known, TypeRule};
use crate::bail;
use crate::diag::Fault;
use crate::symbolic::function::UnitRule;
use crate::value::construct::do_not_fit;
use crate::value::errors::{DOMAIN_ERROR, SIZE_MISMATCH};
use crate::value::{element_count, sizes};

const MANY: usize = usize::MAX;

pub(super) const FUNCTIONS: &[Builtin] = &[
    Builtin {
        value_type: TypeRule::Joined,
        section: "MLS §10.4",
        ..Builtin::planned("array", (1, MANY), array, Known::Nothing)
    },
    Builtin {
        value_type: TypeRule::Unknown,
        section: "MLS §10.4.2",
        ..Builtin::planned("cat", (2, MANY), cat, Known::Dimension(0))
    },
    Builtin {
        section: "MLS §10.3.3",
        ..Builtin::planned("diagonal", (1, 1), diagonal, Known::Nothing)
    },
    Builtin {
        unit: UnitRule::As(0),
        section: "MLS §10.3.3",
        ..Builtin::planned("fill", (1, MANY), fill, Known::Sizes(1, MANY))
    },
    Builtin {
        value_type: TypeRule::Integer,
        section: "MLS §10.3.3",
        ..Builtin::planned("identity", (1, 1), identity, Known::Sizes(0, 1))
    },
    Builtin {
        value_type: TypeRule::Real,
        section: "MLS §10.3.3",
        ..Builtin::planned("linspace", (3, 3), linspace, Known::Sizes(2, 3))
    },
    Builtin {
        unit: UnitRule::As(0),
        section: "MLS §10.3.2",
        ..Builtin::planned("matrix", (1, 1), matrix, Known::Nothing)
    },
    Builtin {
        value_type: TypeRule::Integer,
        section: "MLS §10.3.3",
        ..Builtin::planned("ones", (1, MANY), |sizes| integers(1, sizes), Known::Sizes(0, MANY))
    },
    Builtin {
        unit: UnitRule::As(0),
        section: "MLS §10.3.1",
        ..Builtin::planned("promote", (2, 2), promote, Known::Dimension(1))
    },
    Builtin {
        unit: UnitRule::As(0),
        section: "MLS §10.3.2",
        ..Builtin::planned("scalar", (1, 1), scalar, Known::Nothing)
    },
    Builtin {
        unit: UnitRule::As(0),
        section: "MLS §10.3.2",
        ..Builtin::planned("vector", (1, 1), vector, Known::Nothing)
    },
    Builtin {
        value_type: TypeRule::Integer,
        section: "MLS §10.3.3",
        ..Builtin::planned("zeros", (1, MANY), |sizes| integers(0, sizes), Known::Sizes(0, MANY))
    },
];

/// The most dimensions that `promote` makes: no array of a model has more.
const MAX_RANK: i64 = 64;

fn sizes_of(arguments: &[Argument<'_>]) -> Result<Vec<usize>, Fault> {
    let size = |argument: &Argument<'_>| match usize::try_from(argument.number) {
        Ok(size) => Ok(size),
        Err(_) => bail!(DOMAIN_ERROR, "{} is not a valid array size", argument.number),
    };
    arguments.iter().map(size).collect()
}

/// `array(a, b, …)`: what `{a, b, …}` is.
fn array(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let inner = arguments[0].dims;
    if let Some(other) = arguments.iter().find(|argument| argument.dims != inner) {
        bail!(
            SIZE_MISMATCH,
            "the elements of an array have different sizes: {} and {}",
            shown(inner),
            shown(other.dims)
        );
    }
    let dims = [&[arguments.len()], inner].concat();
    let each = inner.iter().product::<usize>().max(1);
    Ok(Plan::each(dims, move |at| Element::Of(of(at / each, at % each))))
}

/// `fill(s, n1, n2, …)`; `s` may be an array itself.
fn fill(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let outer = sizes_of(&arguments[1..])?;
    let size = arguments[0].dims.iter().product::<usize>().max(1);
    let dims = [outer.as_slice(), arguments[0].dims].concat();
    element_count(&dims)?;
    Ok(Plan::rearranged(dims, move |at| at % size))
}

fn integers(value: i64, sizes: &[Argument<'_>]) -> Result<Plan, Fault> {
    let dims = sizes_of(sizes)?;
    element_count(&dims)?;
    Ok(Plan { dims, elements: Elements::Same(value) })
}

/// `identity(n)`: Integer, as the MLS has it.
fn identity(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let size = sizes_of(arguments)?[0];
    element_count(&[size, size])?;
    let one = move |at: usize| Element::Integer(i64::from(at / size == at % size));
    Ok(Plan::each(vec![size, size], one))
}

/// `diagonal(v)`: a square matrix with `v` on its diagonal.
fn diagonal(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let &[size] = arguments[0].dims else {
        bail!(SIZE_MISMATCH, "`diagonal` needs a vector, got {}", shown(arguments[0].dims));
    };
    element_count(&[size, size])?;
    Ok(Plan::each(vec![size, size], move |at| match at / size == at % size {
        true => Element::Of(of(0, at / size)),
        false => Element::Integer(0),
    }))
}

/// `linspace(x1, x2, n)`: `n >= 2` Reals at equal distances, both ends included.
fn linspace(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let count = arguments[2].number;
    if count < 2 {
        bail!(DOMAIN_ERROR, "`linspace` needs at least 2 points, not {count}");
    }
    let count = sizes_of(&arguments[2..])?[0];
    element_count(&[count])?;
    Ok(Plan::each(vec![count], move |at| match at + 1 == count {
        true => Element::Of(of(1, 0)),
        false => Element::Between(of(0, 0), of(1, 0), at as f64, (count - 1) as f64),
    }))
}

/// `matrix(A)`: the first two dimensions, where all others are 1.
fn matrix(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let dims = arguments[0].dims;
    if dims.iter().skip(2).any(|size| *size != 1) {
        bail!(
            SIZE_MISMATCH,
            "`matrix` needs dimensions of size 1 after the first two, got {}",
            shown(dims)
        );
    }
    let mut dims = dims.to_vec();
    dims.resize(2, 1);
    Ok(Plan::reshaped(dims))
}

/// `vector(A)`: all elements, where at most one dimension is not 1.
fn vector(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let dims = arguments[0].dims;
    if dims.iter().filter(|size| **size != 1).count() > 1 {
        bail!(
            SIZE_MISMATCH,
            "`vector` needs at most one dimension larger than 1, got {}",
            shown(dims)
        );
    }
    Ok(Plan::reshaped(vec![dims.iter().product()]))
}

/// `scalar(A)`: the only element.
fn scalar(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let dims = arguments[0].dims;
    if dims.iter().any(|size| *size != 1) {
        bail!(SIZE_MISMATCH, "`scalar` needs a single element, got {}", shown(dims));
    }
    Ok(Plan::reshaped(Vec::new()))
}

/// `promote(A, n)`: dimensions of size 1 appended up to `n` dimensions.
fn promote(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let (mut dims, rank) = (arguments[0].dims.to_vec(), arguments[1].number);
    if rank > MAX_RANK {
        bail!(DOMAIN_ERROR, "an array with {rank} dimensions is not supported");
    }
    match usize::try_from(rank) {
        Ok(rank) if rank >= dims.len() => dims.resize(rank, 1),
        _ => bail!(DOMAIN_ERROR, "cannot promote {} to {rank} dimensions", shown(&dims)),
    }
    Ok(Plan::reshaped(dims))
}

/// `cat(k, A, B, …)`: `k` counted from 1; the other sizes agree.
fn cat(arguments: &[Argument<'_>]) -> Result<Plan, Fault> {
    let dimension = arguments[0].number;
    let parts: Vec<&[usize]> = arguments[1..].iter().map(|part| part.dims).collect();
    let axis = match usize::try_from(dimension) {
        Ok(at @ 1..) if at <= parts[0].len() => at - 1,
        Ok(1..) => bail!(
            SIZE_MISMATCH,
            "cannot concatenate {} along dimension {dimension}",
            shown(parts[0])
        ),
        _ => bail!(
            DOMAIN_ERROR,
            "the first argument of `cat` is a dimension, from 1, not {dimension}"
        ),
    };
    let plan = concatenation(axis, &parts)?;
    Ok(Plan::each(plan.dims.clone(), move |at| match plan.element(at) {
        // The first argument is the dimension.
        Element::Of(pick) => Element::Of(of(pick.argument + 1, pick.at)),
        other => other,
    }))
}

/// Arrays put together along dimension `axis`, from 0; the other sizes agree.
///
/// # Errors
///
/// Other sizes differ, or the array would be too large.
pub(crate) fn concatenation(axis: usize, parts: &[&[usize]]) -> Result<Plan, Fault> {
    let Some(first) = parts.first() else { bail!(SIZE_MISMATCH, "nothing to concatenate") };
    let mut dims = first.to_vec();
    // The position along the dimension where each part begins.
    let mut begins = Vec::with_capacity(parts.len());
    dims[axis] = 0;
    for part in parts {
        let fits =
            part.len() == dims.len() && (0..dims.len()).all(|d| d == axis || part[d] == dims[d]);
        if !fits {
            return Err(do_not_fit([first, part], axis));
        }
        begins.push(dims[axis]);
        dims[axis] += part[axis];
    }
    element_count(&dims)?;
    let widths: Vec<usize> = parts.iter().map(|part| part[axis]).collect();
    let (all, inner) = (dims[axis].max(1), dims[axis + 1..].iter().product::<usize>().max(1));
    Ok(Plan::each(dims, move |at| {
        let (outer, along, rest) = (at / inner / all, at / inner % all, at % inner);
        let part = begins.partition_point(|begin| *begin <= along) - 1;
        let at = (outer * widths[part] + along - begins[part]) * inner + rest;
        Element::Of(of(part, at))
    }))
}

/// Sizes for messages.
pub(super) fn shown(dims: &[usize]) -> String {
    if dims.is_empty() { "a scalar".into() } else { format!("an array {}", sizes(dims)) }
}
