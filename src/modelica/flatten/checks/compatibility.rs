//! Whether a class can stand where another one is expected (MLS §6.4), as both are declared. Where
//! a class is not wholly known, it can.

use super::scope::{Component, Scope};
use crate::flatten::declared::classes::Type;
use crate::flatten::library::ClassId;
use crate::name::Ident;
use crate::syntax::ast::{ClassSpecifier, Restriction, Visibility};
use rustc_hash::FxHashSet;

/// What a class lacks to be compatible with another.
pub(crate) struct Lack(pub String);

/// What a class lacks to stand where `expected` is expected.
pub(crate) fn lack(candidate: Scope<'_>, expected: Scope<'_>) -> Option<Lack> {
    lack_within(candidate, expected, &mut Compared::default())
}

/// Pairs of classes of which the first was compared with the second: the first lack ends all.
type Compared = FxHashSet<(ClassId, ClassId)>;

fn lack_within(candidate: Scope<'_>, expected: Scope<'_>, compared: &mut Compared) -> Option<Lack> {
    if !compared.insert((candidate.class, expected.class)) {
        return None;
    }
    let is_function =
        |class: Scope<'_>| matches!(class.restriction(), Restriction::Function { .. });
    let derives = candidate.lineage().any(|class| class.class == expected.class);
    if derives || is_function(expected) || is_function(candidate) {
        return None;
    }
    if !is_known(candidate) || !is_known(expected) {
        return None;
    }
    if let Some(kind) = expected.predefined() {
        let same = candidate.predefined() == Some(kind);
        return (!same).then(|| Lack(format!("`{}` has a different type", candidate.name())));
    }
    for required in expected.lineage().flat_map(Scope::components) {
        if required.visibility == Visibility::Public {
            let found = candidate.component(required.name());
            if let Some(lack) = component_lack(candidate, found, &required, compared) {
                return Some(lack);
            }
        }
    }
    None
}

fn component_lack(
    candidate: Scope<'_>,
    found: Option<Component<'_>>,
    expected: &Component<'_>,
    compared: &mut Compared,
) -> Option<Lack> {
    let name = expected.name();
    let Some(found) = found.filter(|found| found.visibility == Visibility::Public) else {
        return Some(Lack(format!("`{}` has no public component `{name}`", candidate.name())));
    };
    match (found.meaning()?, expected.meaning()?) {
        (Type::Predefined(a), Type::Predefined(b)) => (a != b).then(|| other_type(candidate, name)),
        (Type::Class(a), Type::Class(b)) => {
            lack_within(found.owner.of(a), expected.owner.of(b), compared)
        }
        (Type::Class(class), Type::Predefined(kind))
        | (Type::Predefined(kind), Type::Class(class)) => {
            let class = candidate.of(class);
            let differs = is_known(class) && class.predefined() != Some(kind);
            differs.then(|| other_type(candidate, name))
        }
    }
}

fn other_type(class: Scope<'_>, name: Ident) -> Lack {
    Lack(format!("`{name}` of `{}` has a different type", class.name()))
}

/// Whether a class and all that it extends are found, and none is replaceable.
fn is_known(class: Scope<'_>) -> bool {
    class.lineage().all(|class| {
        let bases = class.library.declared_bases(class.class).len();
        let written = match &class.definition().specifier {
            ClassSpecifier::Short(_) => 1,
            ClassSpecifier::Long(_) => class.library.class(class.class).extends.len(),
            _ => return true,
        };
        bases == written || class.predefined().is_some()
    })
}

/// The number of dimensions that a type itself has, through short classes.
pub(crate) fn dimensions(class: Scope<'_>) -> usize {
    let short = class.lineage().filter_map(|class| match &class.definition().specifier {
        ClassSpecifier::Short(short) => Some(short.subscripts.len()),
        _ => None,
    });
    short.sum()
}
