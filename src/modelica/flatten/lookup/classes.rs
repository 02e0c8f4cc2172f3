//! The classes of one instantiation, each in its enclosing scope, and what was found by name so far.

use super::modification::Modifier;
use super::scope::Scope;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::TOO_LARGE;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::tree::Tree;
use crate::flatten::library::Library;
use crate::flatten::lookup::scope::Nested;
use crate::flatten::lookup::scope::Stage;
use crate::flatten::lookup::scope::Text;
use crate::flatten::lookup::types::Type;
use crate::name::{Ident, Name};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// The most scopes that one model may need.
const MAX_SCOPES: usize = 1_000_000;

/// Classes in their enclosing scopes. Every class has a node in the instance tree, whose components
/// its names mean: the nodes of packages hold their constants.
pub(crate) struct Classes<'a> {
    pub library: &'a Library,
    pub tree: Tree,
    /// Classes in their enclosing scopes; the first is the top.
    pub scopes: Vec<Scope>,
    pub roots: FxHashMap<Ident, Rc<Nested>>,
    /// Classes found by name in a class and in what encloses it.
    pub nested: FxHashMap<(ScopeId, Ident), Option<Rc<Nested>>>,
    pub found: FxHashMap<(ScopeId, Ident), Option<Type>>,
    /// How many classes are looking up their bases, and how many short classes lead to another.
    pub searching: usize,
    pub renaming: usize,
}

impl<'a> Classes<'a> {
    /// The top scope alone, with the node 0 as its instance.
    pub(crate) fn new(library: &'a Library) -> Classes<'a> {
        Classes {
            library,
            tree: Tree::new(),
            scopes: vec![Self::top_scope()],
            roots: FxHashMap::default(),
            nested: FxHashMap::default(),
            found: FxHashMap::default(),
            searching: 0,
            renaming: 0,
        }
    }
}

impl Classes<'_> {
    pub(crate) fn scope(&self, id: ScopeId) -> &Scope {
        &self.scopes[id.0 as usize]
    }

    /// The text of a scope; that of the top is not asked for.
    pub(crate) fn text(&self, id: ScopeId) -> &Text {
        self.scope(id).text.as_ref().expect("only the top scope has no text")
    }

    /// The full name of a class that is in a scope; a modifier of a simulated model is in that of
    /// the whole library.
    pub(crate) fn name_within(&self, scope: ScopeId, name: Ident) -> Name {
        let text = self.scope(scope).text.as_ref();
        text.map_or_else(|| Name::from(name), |text| text.name.child(name))
    }

    /// The instance whose components a scope's names mean.
    pub(crate) fn node_of(&self, id: ScopeId) -> NodeId {
        self.scope(id).node
    }

    pub(crate) fn is_encapsulated(&self, id: ScopeId) -> bool {
        self.scope(id).text.as_ref().is_none_or(|text| text.definition.encapsulated)
    }

    pub(crate) fn add_scope(
        &mut self,
        text: Text,
        parent: ScopeId,
        node: NodeId,
        modifier: Modifier,
        defaults: Modifier,
    ) -> Result<ScopeId, Diagnostic> {
        if self.scopes.len() > MAX_SCOPES {
            return Err(
                fault!(TOO_LARGE, "the model needs too many class instances").at(text.span())
            );
        }
        let id = ScopeId(self.scopes.len() as u32);
        self.scopes.push(Scope {
            text: Some(text),
            parent: Some(parent),
            node,
            modifier,
            defaults,
            derived: None,
            excluded: Vec::new(),
            bases: Stage::Pending,
            elements: Stage::Pending,
        });
        Ok(id)
    }

    /// The top scope, without a class.
    fn top_scope() -> Scope {
        Scope {
            text: None,
            parent: None,
            node: NodeId(0),
            modifier: Modifier::default(),
            defaults: Modifier::default(),
            derived: None,
            excluded: Vec::new(),
            bases: Stage::Done(Rc::new([])),
            elements: Stage::Done(Rc::default()),
        }
    }
}
