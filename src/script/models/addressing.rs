//! The scalars of a model that a reference of a script names: `a.b`, an element `A[2, 1]`, a whole
//! array `A`, a part `A[1, :]`, and components of arrays of components, `cell.R` or `cell[2:3].R`.

use super::translated::{Declaration, Translated};
use crate::flatten::flat_reference;
use crate::source::Span;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ReferencePart, Subscript,
};

/// The scalars that a reference names.
#[derive(Debug, Clone)]
pub(super) struct Addressed {
    /// Their names, the last dimension fastest.
    pub names: Vec<String>,
    /// The sizes of what they make up; none for a single scalar.
    pub dims: Vec<usize>,
    /// What all of them are declared as.
    pub declaration: Declaration,
}

/// The scalars that a reference with literal subscripts names; `None` where the model declares none
/// of them, or they make up no array.
pub(super) fn addressed(model: &Translated, target: &ComponentReference) -> Option<Addressed> {
    let name = flat_name(target)?;
    if let Some(declaration) = model.declarations.get(&*name).filter(|d| d.dims.is_empty()) {
        let declaration = declaration.clone();
        return Some(Addressed { names: vec![name], dims: Vec::new(), declaration });
    }
    let first = target.parts.first()?.name.as_str();
    let candidates = model.declarations.iter().filter(|(name, _)| name.starts_with(first));
    let mut found: Vec<(Vec<usize>, String)> = Vec::new();
    let mut declared = None;
    for (name, declaration) in candidates {
        let own = flat_reference(name, Span::NONE);
        let places = places(target, &own, &declaration.dims);
        if !places.is_empty() {
            declared.get_or_insert(declaration);
        }
        found.extend(places);
    }
    found.sort();
    let dims = sizes(&found)?;
    let names = found.into_iter().map(|(_, name)| name).collect();
    Some(Addressed { names, dims, declaration: declared?.clone() })
}

/// A reference as variables of flat models are named: `pack.cell[2].V`; `None` if a subscript is
/// neither an Integer nor `:` nor a vector of Integers.
pub(super) fn flat_name(reference: &ComponentReference) -> Option<String> {
    let part = |part: &ReferencePart| {
        let subscripts: Option<Vec<String>> = part.subscripts.iter().map(shown).collect();
        Some(match subscripts?.join(",") {
            none if none.is_empty() => part.name.as_str().to_owned(),
            subscripts => format!("{}[{subscripts}]", part.name),
        })
    };
    Some(reference.parts.iter().map(part).collect::<Option<Vec<_>>>()?.join("."))
}

fn shown(subscript: &Subscript) -> Option<String> {
    match Positions::of(subscript)? {
        Positions::One(at) => Some(at.to_string()),
        Positions::Many(all) => {
            let all: Vec<String> = all.iter().map(i64::to_string).collect();
            Some(format!("{{{}}}", all.join(",")))
        }
        Positions::All => Some(":".to_owned()),
    }
}

/// What a literal subscript chooses of a dimension.
enum Positions {
    One(i64),
    Many(Vec<i64>),
    All,
}

impl Positions {
    fn of(subscript: &Subscript) -> Option<Positions> {
        let integer = |expression: &Expression| match expression.kind {
            ExpressionKind::Integer(at) => Some(at),
            _ => None,
        };
        match subscript {
            Subscript::All(_) => Some(Positions::All),
            Subscript::Index(expression) => match &expression.kind {
                ExpressionKind::Integer(at) => Some(Positions::One(*at)),
                ExpressionKind::Array(all) => {
                    all.iter().map(integer).collect::<Option<_>>().map(Positions::Many)
                }
                _ => None,
            },
        }
    }

    /// Where an element of the dimension comes in what is chosen, counted from 0: nowhere, or in
    /// dimensions that remain.
    fn places(&self, at: i64) -> Vec<Option<usize>> {
        match self {
            Positions::One(own) if *own == at => vec![None],
            Positions::One(_) => Vec::new(),
            Positions::Many(all) => {
                let places = all.iter().enumerate().filter(|(_, own)| **own == at);
                places.map(|(place, _)| Some(place)).collect()
            }
            Positions::All => usize::try_from(at - 1).map_or(Vec::new(), |at| vec![Some(at)]),
        }
    }
}

/// The scalars of a declared variable that the target names, each with its place in what they make
/// up.
fn places(
    target: &ComponentReference,
    own: &ComponentReference,
    dims: &[usize],
) -> Vec<(Vec<usize>, String)> {
    let have_same_names = target.parts.len() == own.parts.len()
        && target.parts.iter().zip(&own.parts).all(|(a, b)| a.name == b.name);
    if !have_same_names {
        return Vec::new();
    }
    let Some(name) = flat_name(own) else { return Vec::new() };
    let last = own.parts.len() - 1;
    let around = (0..last).fold(vec![Vec::new()], |before, at| {
        extended(before, &target.parts[at], &literals(&own.parts[at]))
    });
    let of_element = |indices: Vec<i64>| {
        let places = extended(around.clone(), &target.parts[last], &indices);
        let shown: Vec<String> = indices.iter().map(i64::to_string).collect();
        let element = match shown.is_empty() {
            true => name.clone(),
            false => format!("{name}[{}]", shown.join(",")),
        };
        places.into_iter().map(move |place| (place, element.clone()))
    };
    all_indices(dims).into_iter().flat_map(of_element).collect()
}

/// The places found so far, continued by those of one more part of the reference.
fn extended(before: Vec<Vec<usize>>, part: &ReferencePart, indices: &[i64]) -> Vec<Vec<usize>> {
    let mut places = before;
    if part.subscripts.len() > indices.len() {
        return Vec::new();
    }
    for (dimension, at) in indices.iter().enumerate() {
        let chosen = match part.subscripts.get(dimension) {
            None => Some(Positions::All),
            Some(subscript) => Positions::of(subscript),
        };
        let own = chosen.map_or(Vec::new(), |chosen| chosen.places(*at));
        let with = |place: &Vec<usize>| {
            let one = |next: &Option<usize>| place.iter().copied().chain(*next).collect();
            own.iter().map(one).collect::<Vec<Vec<usize>>>()
        };
        places = places.iter().flat_map(with).collect();
    }
    places
}

fn literals(part: &ReferencePart) -> Vec<i64> {
    let integer = |subscript: &Subscript| match Positions::of(subscript) {
        Some(Positions::One(at)) => at,
        _ => 0,
    };
    part.subscripts.iter().map(integer).collect()
}

/// All indices of an array of these sizes, the last dimension fastest.
pub(super) fn all_indices(dims: &[usize]) -> Vec<Vec<i64>> {
    dims.iter().fold(vec![Vec::new()], |before: Vec<Vec<i64>>, size| {
        let with = |start: &Vec<i64>| {
            (1..=*size as i64).map(|at| [start.as_slice(), &[at]].concat()).collect::<Vec<_>>()
        };
        before.iter().flat_map(with).collect()
    })
}

/// The sizes of the array that sorted places fill; `None` if they leave a place empty.
fn sizes(found: &[(Vec<usize>, String)]) -> Option<Vec<usize>> {
    let rank = found.first()?.0.len();
    let size = |dimension: usize| {
        let places = found.iter().map(|(place, _)| place.get(dimension).copied());
        places.collect::<Option<Vec<usize>>>()?.into_iter().max().map(|last| last + 1)
    };
    let dims: Vec<usize> = (0..rank).map(size).collect::<Option<_>>()?;
    let is_full = dims.iter().product::<usize>() == found.len()
        && found.windows(2).all(|pair| pair[0].0 != pair[1].0)
        && found.iter().all(|(place, _)| place.len() == rank);
    is_full.then_some(dims)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Session;
    use crate::models::simulation::translate;
    use crate::source::SourceId;
    use crate::syntax;
    use crate::world::MemoryWorld;

    const CLASSES: &str = "
model Cell
  parameter Real R = 1;
  parameter Real w[2] = {3, 4};
end Cell;
model Pack
  parameter Real A[2, 3] = [1, 2, 3; 4, 5, 6];
  Cell cell[3];
end Pack;";

    #[test]
    fn references_name_scalars_in_the_order_of_the_elements() {
        let mut session = Session::new(Box::new(MemoryWorld::new()));
        session.load_text("Pack.mo", CLASSES).expect("classes");
        let model = translate(&mut session, "Pack").expect("a model");
        let found = |text: &str| {
            let parsed = syntax::parse_expression(SourceId::NONE, text).expect("an expression");
            let ExpressionKind::Reference(target) = parsed.kind else { panic!("a reference") };
            addressed(&model, &target).map(|found| (found.dims, found.names.join(" ")))
        };
        let some = |dims: &[usize], names: &str| Some((dims.to_vec(), names.to_owned()));
        assert_eq!(found("A[2, 1]"), some(&[], "A[2,1]"));
        assert_eq!(found("A[:, 2]"), some(&[2], "A[1,2] A[2,2]"));
        assert_eq!(found("A[2, {3, 1}]"), some(&[2], "A[2,3] A[2,1]"));
        assert_eq!(found("A").map(|(dims, _)| dims), Some(vec![2, 3]));
        assert_eq!(found("cell[2].R"), some(&[], "cell[2].R"));
        assert_eq!(found("cell.R"), some(&[3], "cell[1].R cell[2].R cell[3].R"));
        assert_eq!(
            found("cell[{1, 3}].w"),
            some(&[2, 2], "cell[1].w[1] cell[1].w[2] cell[3].w[1] cell[3].w[2]")
        );
        assert_eq!(found("A[3, 1]"), None);
        assert_eq!(found("A[2]"), some(&[3], "A[2,1] A[2,2] A[2,3]"));
        assert_eq!(found("A[1, 1, 1]"), None);
        assert_eq!(found("cell[4].R"), None);
    }
}
