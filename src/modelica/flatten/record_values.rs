//! Values of records that are computed: resolved once, shared by the bindings of their components. A
//! record of a hundred components that a function of such records computes would otherwise be
//! resolved, kept and lowered a hundred times.

use super::Variability;
use super::ids::ScopeId;
use crate::syntax::ast::{Expression, ExpressionKind};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Resolved values by the address of what is resolved, by scope, and by whether impure functions may
/// be called.
#[derive(Debug, Default)]
pub(crate) struct RecordValues {
    resolved: FxHashMap<(usize, ScopeId, bool), Shared>,
    /// Resolved values whose components may have a variability, by address.
    fitting: FxHashMap<(usize, Variability), Arc<Expression>>,
}

#[derive(Debug)]
struct Shared {
    /// Keeps the address from being used again.
    _given: Arc<Expression>,
    resolved: Arc<Expression>,
}

impl RecordValues {
    /// What is resolved already.
    pub(crate) fn get(
        &self,
        given: &Arc<Expression>,
        context: ScopeId,
        impure: bool,
    ) -> Option<Arc<Expression>> {
        let shared = self.resolved.get(&(Arc::as_ptr(given) as usize, context, impure))?;
        Some(shared.resolved.clone())
    }

    /// Keeps what something resolves to.
    pub(crate) fn insert(
        &mut self,
        given: &Arc<Expression>,
        context: ScopeId,
        impure: bool,
        resolved: &Arc<Expression>,
    ) {
        let shared = Shared { _given: given.clone(), resolved: resolved.clone() };
        self.resolved.insert((Arc::as_ptr(given) as usize, context, impure), shared);
    }

    /// Whether another component of the record that this is one of has the variability.
    pub(crate) fn may_be(&self, component: &Expression, variability: Variability) -> bool {
        let at = |record| (Arc::as_ptr(record) as usize, variability);
        record_of(component).is_some_and(|record| self.fitting.contains_key(&at(record)))
    }

    /// The record that this is a component of may have components with the variability.
    pub(crate) fn keep_may_be(&mut self, component: &Expression, variability: Variability) {
        let at = |record| (Arc::as_ptr(record) as usize, variability);
        self.fitting.extend(record_of(component).map(|record| (at(record), record.clone())));
    }
}

/// The record that a resolved value is a component of, if it is computed.
fn record_of(component: &Expression) -> Option<&Arc<Expression>> {
    match &component.kind {
        ExpressionKind::Field { base, .. } if is_computed(base) => Some(base),
        _ => None,
    }
}

/// Whether a value is the result of a call, or a component of one.
pub(crate) fn is_computed(value: &Expression) -> bool {
    match &value.kind {
        ExpressionKind::Call { .. } => true,
        ExpressionKind::Field { base, .. } => is_computed(base),
        _ => false,
    }
}
