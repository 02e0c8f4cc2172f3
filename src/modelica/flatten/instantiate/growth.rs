//! How many components a model will have, estimated while it is built: classes that contain several
//! of the former, which contain several of theirs, grow exponentially, beyond time and memory.
//!
//! Components are completed depth first. When the first of several alike ones is complete, its size
//! is that of the others, so that the product over the levels is known as soon as the deepest one is
//! reached (D. E. Knuth, "Estimating the efficiency of backtrack programs", Math. Comp. 29 (1975)
//! 121-136, without chance).

use super::instance::Declaration;
use super::instance::MemberState;
use super::instance::Shape;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::TOO_LARGE;
use crate::flatten::ids::NodeId;
use crate::flatten::instantiate::tree::MAX_INSTANCES;
use crate::flatten::instantiate::tree::Tree;
use crate::flatten::lookup::classes::Classes;
use crate::source::Span;
use std::sync::Arc;

/// The components of ordinary models, which are not looked at.
const UNSUSPICIOUS: usize = 20_000;

/// Components of one class with different modifiers may differ in size. A class that holds two of
/// itself, which its modifiers end, may do so twenty times and has a million of them at most.
const SURELY: usize = 1_000_000_000;

/// The components that are being completed, outermost first.
#[derive(Debug, Default)]
pub(crate) struct Growth {
    levels: Vec<Level>,
    /// How many components there were at the last estimate.
    estimated: usize,
}

/// A component that is being completed.
#[derive(Debug, Clone, Copy)]
struct Level {
    /// The instance that holds it, and the number of its member.
    holder: NodeId,
    member: usize,
    /// How many elements of the same array follow.
    elements: usize,
    /// How many nodes the tree had before.
    before: usize,
}

/// How many components an instance will hold.
#[derive(Debug, Clone, Copy, Default)]
struct Expected {
    /// If those that are declared alike are as large.
    known: usize,
    /// If all of one class are as large.
    likely: usize,
}

impl Growth {
    /// A component begins to be completed.
    pub(crate) fn enter(&mut self, holder: NodeId, member: usize, elements: usize, before: usize) {
        self.levels.push(Level { holder, member, elements, before });
    }

    /// It is complete.
    pub(crate) fn leave(&mut self) {
        self.levels.pop();
    }

    /// An error if the components that are being completed lead to more than a model may have.
    /// Asked after the completion of each, it is answered whenever their number has doubled.
    pub(crate) fn check(&mut self, classes: &mut Classes<'_>) -> Result<(), Diagnostic> {
        let count = classes.tree.nodes.len();
        if count < UNSUSPICIOUS.max(2 * self.estimated) {
            return Ok(());
        }
        self.estimated = count;
        let mut expected = Expected::default();
        for level in self.levels.iter().rev() {
            let Some(declaration) = classes.tree.declaration_at(level.holder, level.member) else {
                continue;
            };
            let built = count.saturating_sub(level.before);
            let alike = classes.alike(level, &declaration);
            expected = expected.raised(built, 1 + level.elements, alike);
            if expected.is_too_large() {
                return Err(classes.too_many(level.holder, declaration.span, &expected));
            }
        }
        Ok(())
    }
}

impl Classes<'_> {
    fn too_many(&self, holder: NodeId, span: Span, expected: &Expected) -> Diagnostic {
        let class = self.tree.scope_of(holder).map(|scope| self.text(scope).name.clone());
        fault!(
            TOO_LARGE,
            "the model has more than {MAX_INSTANCES} components: `{}` alone would contain {}",
            class.unwrap_or_default(),
            expected.known.max(expected.likely);
            help: "each of its classes contains several components of the next one: use fewer \
                   components or fewer levels")
        .at(span)
    }

    /// How many components after one in the same instance, which are not built yet, are declared as
    /// it is, and how many of its class at all.
    fn alike(&mut self, level: &Level, declaration: &Declaration) -> [usize; 2] {
        let members =
            self.tree.composite_of(level.holder).and_then(|holder| holder.members.as_ref());
        let Some(members) = members else { return [0; 2] };
        let pending: Vec<Arc<Declaration>> = members
            .values()
            .skip(level.member + 1)
            .filter(|member| matches!(member.state, MemberState::Pending))
            .map(|member| member.declaration.clone())
            .collect();
        let class = self.class_span(declaration);
        let mut count = [0; 2];
        for other in pending {
            if other.condition.is_none() && other.dims.len() == declaration.dims.len() {
                let is_same = other.scope == declaration.scope
                    && other.type_specifier.name == declaration.type_specifier.name
                    && other.modifier.is_same(&declaration.modifier);
                count[0] += usize::from(is_same);
                count[1] +=
                    usize::from(is_same || class.is_some() && self.class_span(&other) == class);
            }
        }
        count
    }

    /// Where the class of a component is written, short classes followed.
    fn class_span(&mut self, declaration: &Declaration) -> Option<Span> {
        match self.expand(declaration).ok()?.shape {
            Shape::Class(class) => Some(self.text(class).definition.span),
            _ => None,
        }
    }
}

impl Tree {
    fn declaration_at(&self, holder: NodeId, member: usize) -> Option<Arc<Declaration>> {
        let members = self.composite_of(holder)?.members.as_ref()?;
        members.get_index(member).map(|(_, member)| member.declaration.clone())
    }
}

impl Expected {
    /// One level up, where `built` components are there, and others are to come that are as large.
    fn raised(self, built: usize, elements: usize, alike: [usize; 2]) -> Expected {
        let raise = |size: usize, alike| built.max(size).saturating_mul(elements + alike);
        Expected { known: raise(self.known, alike[0]), likely: raise(self.likely, alike[1]) }
    }

    fn is_too_large(&self) -> bool {
        self.known > MAX_INSTANCES || self.likely > SURELY
    }
}
