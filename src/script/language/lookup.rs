//! What called names stand for: functions of scripts and of loaded libraries, and commands.

use crate::Session;
use crate::builtins;
use crate::diag::{Diagnostic, Fault};
use crate::errors::OWN_FUNCTION;
use crate::eval::c_function::{brings_code, destructor};
use crate::eval::{Callee, Function, FunctionBody, ValueType};
use crate::name::{Ident, Name};
use crate::packages::FOLDER;
use crate::syntax::ast::{ClassSpecifier, Section};
use std::collections::BTreeSet;
use std::sync::Arc;

impl Session {
    /// A function of a script or a loaded library first, then a command.
    pub(super) fn callee_named(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        let revision = self.classes.revision();
        if let Some(known) = self.workspace.callees.get(name, revision, self.dialect()) {
            return Ok(known);
        }
        let callee = self.look_up_callee(name)?;
        self.workspace.callees.put(name, callee.as_ref());
        Ok(callee)
    }

    fn look_up_callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        let loaded = self.loaded_function(name)?;
        let replacing = self.replacing(name, loaded.as_deref())?;
        if let Some(function) = replacing.or(loaded) {
            let callee = self.loaded_callee(function);
            self.note_replaced(name, &callee);
            return Ok(Some(callee));
        }
        for candidate in self.workspace.candidates(name) {
            if let Some(id) = builtins::find(&candidate, self.dialect()) {
                return Ok(Some(Callee::Builtin(id.function())));
            }
        }
        for candidate in self.workspace.candidates(name) {
            let is_intrinsic = candidate.is_simple()
                && crate::functions::names().any(|intrinsic| candidate.parts[0] == intrinsic);
            if !is_intrinsic && self.class_exists(&Name::new(candidate.first())) {
                let function = self.loaded_function(name)?;
                return Ok(function.map(|function| self.loaded_callee(function)));
            }
        }
        Ok(None)
    }

    /// The loaded function that replaces a command called by its bare name: one of the command's full
    /// name, as long as no function of the bare name was loaded later.
    fn replacing(
        &mut self,
        name: &Name,
        bare: Option<&Function>,
    ) -> Result<Option<Arc<Function>>, Diagnostic> {
        let Some(command) = builtins::find(name, self.dialect()).filter(|_| name.is_simple())
        else {
            return Ok(None);
        };
        for package in command.packages() {
            let full = Name::parse(package).child(name.parts[0]);
            let root = Name::new(full.first());
            let is_shipped = self.is_shipped(&root);
            let library = self.library();
            let is_older = bare.is_some_and(|bare| {
                let other = Name::new(bare.name.first());
                library.find(&other).is_some_and(|other| Some(other) > library.find(&root))
            });
            if !is_shipped && !is_older && library.contains(&full) {
                return self.function_named(&full);
            }
        }
        Ok(None)
    }

    /// Whether a class is one of the program's own.
    fn is_shipped(&self, name: &Name) -> bool {
        self.source_file(name).is_some_and(|file| file.starts_with(FOLDER))
    }

    /// Says once that a function of a package is called in place of a command. That one of the
    /// script itself is called by its own name needs no word.
    fn note_replaced(&mut self, name: &Name, callee: &Callee) {
        let (Callee::Function(function), Some(command)) = (callee, name.last()) else { return };
        let is_own = function.name.is_simple() || self.is_shipped(&function.name);
        let replaces = builtins::find(name, self.dialect()).is_some();
        if replaces && self.workspace.replaces_newly(command, &function.name) && !is_own {
            let called = &function.name;
            let message = format!(
                "`{command}` is the function `{called}` that was loaded, not the built-in command"
            );
            self.report(Fault::new(OWN_FUNCTION, message).at(function.span).note());
        }
    }

    /// A loaded function, or the command that it declares with `external "builtin"`, or that is its
    /// implementation: the functions of `Modelica.Utilities` are commands, loaded or not.
    fn loaded_callee(&self, function: Arc<Function>) -> Callee {
        let is_utility = function.name.to_string().starts_with("Modelica.Utilities.");
        let own = builtins::find(&function.name, self.dialect()).filter(|_| is_utility);
        let command = own.or_else(|| match &function.body {
            FunctionBody::External(external) if external.language.as_deref() == Some("builtin") => {
                external
                    .function
                    .as_ref()
                    .and_then(|called| builtins::find(&Name::new([called.node]), self.dialect()))
            }
            _ => None,
        });
        command.map_or(Callee::Function(function), |id| Callee::Builtin(id.function()))
    }

    /// The functions in C of the package that a function is in, and of the external objects that it
    /// takes: in a script they share the variables of their sources.
    pub(super) fn c_functions_near(&mut self, function: &Function) -> Vec<Arc<Function>> {
        let mut packages = BTreeSet::from([function.name.parent()]);
        for component in function.inputs.iter().chain(&function.outputs) {
            if let ValueType::ExternalObject(class) = &component.value_type {
                packages.insert(class.parent());
            }
        }
        let mut names = vec![destructor(function)];
        for package in packages {
            for child in self.library().children(&package) {
                let child = package.child(child);
                // The two parts of a class of external objects.
                let part = |name| child.child(Ident::new(name));
                names.extend(["constructor", "destructor"].map(part));
                names.push(child);
            }
        }
        names.retain(|name| self.is_in_c(name));
        let loaded = names.iter().filter_map(|name| match self.callee_named(name) {
            Ok(Some(Callee::Function(function))) => Some(function),
            _ => None,
        });
        loaded.collect()
    }

    fn is_in_c(&mut self, name: &Name) -> bool {
        let Some(definition) = self.library().definition(name) else { return false };
        let ClassSpecifier::Long(class) = &definition.specifier else { return false };
        class.sections.iter().any(|section| match section {
            Section::External(clause) => brings_code(clause),
            _ => false,
        })
    }
}
