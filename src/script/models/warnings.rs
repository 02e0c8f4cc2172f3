//! Warnings about models, each of which is reported once.

use crate::Session;
use crate::diag::Diagnostic;
use crate::lower::errors::INPUT_WITHOUT_DATA;

/// Reports the warnings about a model that were not reported yet, whatever it was asked before.
pub(super) fn warn(session: &mut Session, warnings: &[Diagnostic]) {
    for warning in warnings {
        let warning = &session.classes.in_users_terms(warning.clone());
        let is_meant = warning.code != INPUT_WITHOUT_DATA || !session.models.inputs_come_later;
        if is_meant && session.models.is_new_warning(warning.span(), &warning.message) {
            session.report(warning.clone());
        } else if let Some(overheard) = &mut session.output.overheard {
            // Another session that finds the model has not reported it.
            overheard.push(warning.clone());
        }
    }
}
