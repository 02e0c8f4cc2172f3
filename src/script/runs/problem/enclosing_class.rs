//! The class around the model of an experiment: what the experiment sets beyond values of
//! parameters, as Modelica.

use crate::diag::Diagnostic;
use crate::script::Session;

/// Modifications, declarations and equations that a class around the model has.
#[derive(Default)]
pub(super) struct EnclosingClass {
    pub modifications: Vec<String>,
    pub declarations: String,
    /// A section of initial equations, or nothing.
    pub equations: String,
}

impl EnclosingClass {
    /// Loads the class around `model` of the experiment with this number, and returns its name; the
    /// model itself where nothing is around it.
    pub(super) fn load(
        &self,
        session: &mut Session,
        model: &str,
        number: usize,
    ) -> Result<String, Vec<Diagnostic>> {
        if self.modifications.is_empty() && self.declarations.is_empty() {
            return Ok(model.to_owned());
        }
        let (class, inner) = match model.split_once('(') {
            Some((class, inner)) => {
                (class.trim(), inner.trim_end().strip_suffix(')').unwrap_or(inner))
            }
            None => (model.trim(), ""),
        };
        let own = std::iter::once(inner.trim()).filter(|inner| !inner.is_empty());
        let all: Vec<&str> = own.chain(self.modifications.iter().map(String::as_str)).collect();
        let name = format!("GAPILibExperiment{}", number + 1);
        let text = format!(
            "model {name}
  extends {class}(
    {});
{}{}end {name};
",
            all.join(
                ",
    "
            ),
            self.declarations,
            self.equations
        );
        session.load_text(&format!("experiment {} of the problem", number + 1), &text)?;
        Ok(name)
    }
}
