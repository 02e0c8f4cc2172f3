//! Interactive statements, one after another.

use crate::diag::{At, Diagnostic, Fault, suggest};
use crate::errors::BAD_IMPORT;
use crate::eval::errors::WRONG_OUTPUTS;
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::RUN_COMMAND;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, Import, ImportKind, InteractiveKind,
    InteractiveStatement, Statement, StatementKind,
};
use crate::{Session, builtins};
use std::sync::Arc;

impl Session {
    /// Executes one statement of a script and shows its answer as the dialect does.
    pub(crate) fn top_level(
        &mut self,
        statement: &InteractiveStatement,
        outermost: bool,
    ) -> Result<(), Diagnostic> {
        if outermost {
            self.begin_exchange(statement.span);
        }
        self.echo_input(statement.span);
        self.interactive(statement)
    }

    fn begin_exchange(&mut self, span: Span) {
        self.output.begin(&self.sources, span);
    }

    fn interactive(&mut self, statement: &InteractiveStatement) -> Result<(), Diagnostic> {
        match &statement.kind {
            InteractiveKind::Statement(inner) => self.statement(inner),
            InteractiveKind::Expression(expression) => {
                let value = self.evaluate(expression)?;
                self.echo_value(expression, &value);
                Ok(())
            }
            InteractiveKind::Declaration(clause) => self.declare(clause),
            InteractiveKind::Class(class) => self.classes.define(class),
            InteractiveKind::Import(import) => self.import(import),
            InteractiveKind::Command { name, argument } => self.command(name, argument),
        }
    }

    fn statement(&mut self, statement: &Statement) -> Result<(), Diagnostic> {
        match &statement.kind {
            StatementKind::Assign { target, value } => {
                let is_new =
                    target.as_ident().is_some_and(|name| !self.workspace.variables.contains(name));
                self.execute(statement)?;
                if let Some(name) = target.as_ident() {
                    self.echo_assignment(name, is_new, value);
                }
                Ok(())
            }
            StatementKind::MultiAssign { targets, value } => {
                self.warn_of_other_outputs(targets, value);
                let names = targets.iter().flatten().filter_map(ComponentReference::as_ident);
                let new: Vec<Ident> =
                    names.filter(|name| !self.workspace.variables.contains(*name)).collect();
                self.execute(statement)?;
                new.into_iter().for_each(|name| self.echo_declaration(name));
                Ok(())
            }
            _ => {
                self.execution.descend();
                let done = self.execute(statement);
                self.execution.ascend();
                if done.is_ok() {
                    self.echo_nothing();
                }
                done
            }
        }
    }

    /// Warns where a variable has the name of an output of the command, and takes another one.
    fn warn_of_other_outputs(
        &mut self,
        targets: &[Option<ComponentReference>],
        value: &Expression,
    ) {
        let ExpressionKind::Call { function, .. } = &value.kind else { return };
        let Some(command) = builtins::find(&function.name(), self.dialect()) else { return };
        let outputs =
            command.function().outputs.iter().map(|output| output.name).collect::<Vec<_>>();
        let other = targets.iter().zip(&outputs).find_map(|(target, taken)| {
            let target = target.as_ref()?;
            let name = target.as_ident().filter(|name| name != taken)?;
            outputs.contains(&name).then_some((name, taken, target.span))
        });
        let Some((name, taken, place)) = other else { return };
        let all = outputs.iter().map(|output| output.as_str()).collect::<Vec<_>>().join(", ");
        let fault = fault!(WRONG_OUTPUTS, "`{name}` takes the output `{taken}` of `{}`", function.name();
            help: "outputs are assigned in their order; write `({all}) := ...`, and leave out what is \
                   not needed: `(, b) := ...`");
        self.report(fault.at(place).warning());
    }

    fn import(&mut self, import: &Import) -> Result<(), Diagnostic> {
        self.workspace.callees.clear();
        match &import.kind {
            ImportKind::Qualified(name) => self.import_as(name.last(), name.clone(), import.span),
            ImportKind::Renaming(alias, name) => {
                self.import_as(Some(*alias), name.clone(), import.span)
            }
            ImportKind::Unqualified(package) => {
                self.importable(package, import.span)?;
                self.workspace.open_package(package.clone());
                Ok(())
            }
            ImportKind::Group(package, names) => names.iter().try_for_each(|name| {
                self.import_as(Some(*name), package.child(*name), import.span)
            }),
        }
    }

    fn import_as(
        &mut self,
        alias: Option<Ident>,
        name: Name,
        span: Span,
    ) -> Result<(), Diagnostic> {
        self.importable(&name, span)?;
        if let Some(alias) = alias {
            self.workspace.import(alias, name);
        }
        Ok(())
    }

    fn importable(&mut self, name: &Name, span: Span) -> Result<(), Diagnostic> {
        let text = name.to_string();
        let known = builtins::is_package(&text)
            || builtins::find(name, self.dialect()).is_some()
            || self.class_exists(name)
            || self.constant(&ComponentReference::from_name(name, span)).at(span)?.is_some();
        if known {
            return Ok(());
        }
        let packages = builtins::packages();
        Err(fault!(BAD_IMPORT, "cannot import `{text}`: there is no package or class of that name")
            .help_if(suggest::did_you_mean(&text, packages.iter().copied()))
            .at(span))
    }

    fn command(
        &mut self,
        name: &Spanned<Arc<str>>,
        argument: &Spanned<Arc<str>>,
    ) -> Result<(), Diagnostic> {
        match &*name.node {
            "clear" => self.clear(),
            "clearlog" => self.output.messages.clear(),
            "exit" => {
                let status = argument.node.trim_matches(['(', ')', ' ']).parse().unwrap_or(0);
                self.execution.exit(status);
            }
            "experiment" => self.set_experiment(argument)?,
            RUN_COMMAND => {
                let script = argument.node.trim().trim_matches('"');
                let around = self.execution.begin_call(name.span);
                self.execution.descend();
                let done = self.run_nested(script);
                self.execution.ascend();
                self.execution.end_call(around);
                done.map_err(|failure| self.last_of(failure, name.span))?;
            }
            // The grammar knows no other command.
            _ => {
                let folder = argument.node.trim().trim_matches('"');
                self.change_directory(folder).at(name.span)?;
            }
        }
        Ok(())
    }

    /// `experiment StopTime=10 Tolerance=1e-7`, as scripts of Dymola 4 to 6 have it.
    fn set_experiment(&mut self, settings: &Spanned<Arc<str>>) -> Result<(), Diagnostic> {
        let tight: Vec<&str> = settings.node.split('=').map(str::trim).collect();
        let tight = tight.join("=").replace(',', " ");
        let call =
            format!("experiment({})", tight.split_whitespace().collect::<Vec<_>>().join(", "));
        self.value_of("experiment", &call).map(drop)
    }

    /// Forgets variables, flags, imports and classes.
    pub(crate) fn clear(&mut self) {
        self.workspace.clear();
        self.models.forget_variables();
        self.forget_classes();
    }

    /// Changes the working directory and shows it; an empty path only shows it.
    pub(crate) fn change_directory(&mut self, path: &str) -> Result<(), Fault> {
        if !path.is_empty() {
            self.world.change_dir(path)?;
        }
        let shown = format!("{}\n", self.world.current_dir().display());
        self.print(&shown);
        Ok(())
    }
}
