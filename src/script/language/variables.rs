//! Variables, flags and dotted names of a session.

use crate::Session;
use crate::bail;
use crate::builtins::component_names;
use crate::diag::Fault;
use crate::errors::NO_WINDOW;
use crate::name::{Ident, Name};
use crate::registry::BAD_OPTION;
use crate::syntax;
use crate::value::Value;
use std::collections::BTreeSet;

/// Classes whose components are completed.
const MAX_COMPLETED: usize = 500;

impl Session {
    /// All variables with types and values.
    pub fn listed_variables(&self) -> String {
        self.workspace.listing("*", true)
    }

    /// All variables of scripts, in the order in which they were made.
    pub fn variables(&self) -> impl Iterator<Item = (&'static str, &Value)> {
        self.workspace.variables.iter().map(|(name, value)| (name.as_str(), value))
    }

    /// Gives a variable of scripts a value.
    ///
    /// # Errors
    ///
    /// `bad-option` for what is no identifier; those of an assignment to a variable of another type.
    pub fn set_variable(&mut self, name: &str, value: Value) -> Result<(), Fault> {
        let is_letter = |c: char| c.is_ascii_alphabetic() || c == '_';
        let is_identifier = name.starts_with(is_letter)
            && name.chars().all(|c| is_letter(c) || c.is_ascii_digit())
            && !syntax::is_keyword(name);
        if !is_identifier {
            bail!(BAD_OPTION, "`{name}` cannot be the name of a variable");
        }
        self.models.note_own(Ident::new(name));
        self.workspace.variables.set(Ident::new(name), value)
    }

    /// What can be typed: variables, classes, and the parameters and variables of the model
    /// translated last.
    pub fn names_to_complete(&self) -> Vec<String> {
        let variables = self.workspace.variables.iter().map(|(name, _)| name.as_str().to_owned());
        let classes = self.classes.read_names();
        let mut names: Vec<String> = variables.chain(classes.iter().map(Name::to_string)).collect();
        for class in classes.iter().take(MAX_COMPLETED) {
            let Some(definition) = self.classes.library.definition(class) else { continue };
            let components = component_names(&definition).into_iter();
            names.extend(components.map(|component| format!("{class}.{component}")));
        }
        names.extend(self.names_in_model());
        names.extend(crate::functions::names().map(str::to_owned));
        names
    }

    /// The names of the classes in a class, or at the top level where the name is empty; a library is
    /// loaded for that if it can be.
    pub fn classes_in(&mut self, parent: &str) -> Vec<String> {
        if parent.is_empty() {
            let roots: Vec<Ident> = self.library().roots().collect();
            let all: BTreeSet<Ident> = self.loadable_classes().into_iter().chain(roots).collect();
            let mut names: Vec<String> = all.iter().map(|name| name.as_str().to_owned()).collect();
            names.sort();
            return names;
        }
        let parent = Name::parse(parent);
        match self.find_class(&parent) {
            Ok(true) => {
                let children = self.library().children(&parent).into_iter();
                children.map(|child| format!("{parent}.{child}")).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The names of the variables and parameters of the model translated last.
    pub fn names_in_model(&self) -> Vec<String> {
        let model = self.last_model();
        let declared = model.iter().flat_map(|model| model.declarations.keys());
        declared.map(|name| name.to_string()).collect()
    }

    /// The text of a loaded class, or of one that can be.
    pub fn declaration(&mut self, name: &str) -> Option<String> {
        let name = Name::parse(name);
        if !self.class_exists(&name) {
            return None;
        }
        let class = self.library().definition(&name)?;
        Some(syntax::print::class(&class))
    }

    /// Says once that a command has no effect because there is no window.
    pub(crate) fn no_effect(&mut self, command: &'static str) {
        if self.output.is_first_without_window(command) {
            self.note(NO_WINDOW, format!("`{command}` has no effect here"));
        }
    }
}
