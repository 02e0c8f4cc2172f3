//! Calls with their names resolved (MLS ch. 12): operators and conversions become what they mean,
//! functions their full names.

use crate::diag::Diagnostic;
use crate::eval::Function;
use crate::fault;
use crate::flatten::errors::{NOT_SUPPORTED, UNKNOWN_CLASS};
use crate::flatten::expressions::local::Local;
use crate::flatten::expressions::vectorization::vectorized;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::types::Type;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind};
use std::sync::Arc;

impl Instantiation<'_> {
    /// A call as an expression.
    pub(crate) fn call(
        &mut self,
        span: Span,
        function: &ComponentReference,
        arguments: &Arguments,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let bare;
        let function = match self.is_global_builtin(function, context)? {
            true => {
                bare = ComponentReference { global: false, ..function.clone() };
                &bare
            }
            false => function,
        };
        let special = self.special_call(span, function, arguments, context, local)?;
        if let Some(value) = special {
            return Ok(value);
        }
        let written = arguments;
        let arguments = self.arguments(arguments, context, local)?;
        let is_sum = function.as_ident().is_some_and(|name| name == "sum");
        if is_sum
            && !has_open_names(&arguments, local)
            && let Some(sum) = self.sum_of_arrays(written, &arguments, span)
        {
            return Ok(sum);
        }
        if is_sum
            && let ([argument], true) = (&arguments.positional[..], arguments.iterators.is_empty())
            && let Some(sum) = self.overloaded_sum(argument, local, span)?
        {
            return Ok(sum);
        }
        if function.as_ident().is_some_and(|name| name == "String")
            && let Some(text) = self.overloaded_string(&arguments, local, span)?
        {
            return Ok(text);
        }
        let name = self.called_name(function, &arguments, span, context, local)?;
        let instance = self.instance_at(context);
        let arguments = self.functions.with_defaults(&name, arguments, instance.as_deref(), span);
        let (name, arguments) = self.functions.specialized(name, arguments, span, 0)?;
        // Variables of a function have no sizes here, though the model may have some of their names.
        if !has_open_names(&arguments, local)
            && let Some(called) = self.functions.table.get(&name).cloned().flatten()
        {
            let is_strict = self.classes.library.is_strict();
            let surplus = &mut |argument: &Expression, rank| self.surplus_sizes(argument, rank);
            if let Some(calls) = vectorized(&called, (&name, &arguments), surplus, is_strict, span)?
            {
                return Ok(calls);
            }
        }
        let function = ComponentReference::from_name(&name, function.span);
        let kind = ExpressionKind::Call { function, arguments: Box::new(arguments) };
        self.bounded_by_literals(Expression::new(kind, span), written, context, local)
    }

    /// Whether it is the name of a function of the language with a dot before it, `.ones`, as
    /// libraries write it by mistake for `*.`; no class of this name is in sight.
    fn is_global_builtin(
        &mut self,
        function: &ComponentReference,
        context: ScopeId,
    ) -> Result<bool, Diagnostic> {
        let [part] = function.parts.as_slice() else { return Ok(false) };
        Ok(function.global
            && crate::functions::is_builtin(part.name.as_str())
            && self.classes.lookup(context, &Name::from(part.name))?.is_none())
    }

    /// The name of the instance of a model that a scope belongs to.
    fn instance_at(&self, context: ScopeId) -> Option<String> {
        let is_of_model =
            context != ScopeId::TOP && !self.classes.tree.in_package(self.classes.node_of(context));
        is_of_model.then(|| self.classes.instance_name(context))
    }

    /// A call that is not one of a function: of an operator of connections, of a conversion, of
    /// `size`, `getInstanceName` or `array`.
    fn special_call(
        &mut self,
        span: Span,
        function: &ComponentReference,
        arguments: &Arguments,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Expression>, Diagnostic> {
        if let Some(value) = self.connection_operator(span, function, arguments, context, local)? {
            return Ok(Some(value));
        }
        if let Some(value) = self.state_operator(span, function, arguments, context, local)? {
            return Ok(Some(value));
        }
        if let Some(value) = self.conversion(span, function, arguments, context, local)? {
            return Ok(Some(value));
        }
        if let Some(name) = function.as_ident()
            && let Some(size) = self.size_call(name.as_str(), arguments, context, local, span)?
        {
            return Ok(Some(size));
        }
        if function.as_ident().is_some_and(|name| name == "getInstanceName")
            && let Some(name) = self.instance_at(context)
        {
            return Ok(Some(Expression::new(ExpressionKind::String(name.into()), span)));
        }
        if let Some(folder) = self.class_directory(span, function, context)? {
            return Ok(Some(Expression::new(ExpressionKind::String(folder.into()), span)));
        }
        if self.classes.is_array_constructor(function, arguments, context)? {
            if let ([element], false) =
                (arguments.positional.as_slice(), arguments.iterators.is_empty())
            {
                return self
                    .array_iteration(element, &arguments.iterators, span, context, local)
                    .map(Some);
            }
            let elements = self.all(&arguments.positional, context, local)?;
            return Ok(Some(Expression::new(ExpressionKind::Array(elements), span)));
        }
        Ok(None)
    }

    /// `classDirectory()` of other tools: the folder of the file that the class is in, with a slash at
    /// its end. `None` for other calls.
    fn class_directory(
        &mut self,
        span: Span,
        function: &ComponentReference,
        context: ScopeId,
    ) -> Result<Option<String>, Diagnostic> {
        let Some(name) = function.as_ident().filter(|name| *name == "classDirectory") else {
            return Ok(None);
        };
        let is_declared = self.classes.lookup(context, &Name::from(name))?.is_some();
        if is_declared || context == ScopeId::TOP || self.classes.library.is_strict() {
            return Ok(None);
        }
        let class = &self.classes.text(context).name;
        let folder = self.classes.library.resources().path(&format!("modelica://{class}/"));
        let folder = folder.map_err(|fault| fault.at(span))?;
        let warning = fault!(UNKNOWN_CLASS, "`classDirectory` is not a function of Modelica: it \
            gives the folder of this class";
            help: "write `Modelica.Utilities.Files.loadResource(\"modelica://{class}/…\")`");
        self.warnings.add_once(warning.at(span));
        Ok(Some(folder))
    }

    /// The full name of the function that a call means.
    fn called_name(
        &mut self,
        function: &ComponentReference,
        arguments: &Arguments,
        span: Span,
        context: ScopeId,
        local: &Local,
    ) -> Result<Name, Diagnostic> {
        let name = if function.as_ident().is_some_and(|name| local.get(name).is_some()) {
            function.name()
        } else {
            self.function_name(&function.name(), context, function.span)?
        };
        let in_model =
            context != ScopeId::TOP && !self.classes.tree.in_package(self.classes.node_of(context));
        let name = match self.classes.lookup(context, &function.name())? {
            Some(Type::Class(class)) => {
                self.overloaded_constructor(class, arguments, local)?.unwrap_or(name)
            }
            _ if in_model
                && !self.functions.table.contains_key(&name)
                && !is_builtin(&name, local) =>
            {
                return Err(self.classes.unknown_function(context, &name, function.span));
            }
            _ => name,
        };
        let called = self.functions.table.get(&name).and_then(Option::as_ref);
        let is_refused =
            |f: &Arc<Function>| f.impure && !(local.is_equation && f.outputs.is_empty());
        if called.is_some_and(is_refused) && !local.impure && in_model {
            return Err(
                fault!(NOT_SUPPORTED, "`{name}` is impure; calls of impure functions in models \
                                       are not supported yet";
                help: "declare it `pure` if it always returns equal values for equal arguments")
                .at(span),
            );
        }
        Ok(name)
    }
}

/// Whether a call means a function that is in no class: of the language, or one that is passed
/// to the function in progress.
fn is_builtin(name: &Name, local: &Local) -> bool {
    let ident = name.first().filter(|_| name.is_simple());
    ident.is_some_and(|ident| {
        crate::functions::is_builtin(ident.as_str()) || local.get(ident).is_some()
    })
}

/// Whether one of the arguments, or of the ranges, needs a local name that has no value.
fn has_open_names(arguments: &Arguments, local: &Local) -> bool {
    let named = arguments.named.iter().map(|argument| &argument.value);
    let ranges = arguments.iterators.iter().filter_map(|index| index.range.as_ref());
    let mut all = arguments.positional.iter().chain(named).chain(ranges);
    all.any(|argument| local.is_open_in(argument))
}

impl Classes<'_> {
    /// The class that is simulated, and the path to the instance (MLS §3.7.4.4).
    fn instance_name(&self, context: ScopeId) -> String {
        match self.tree.nodes[self.node_of(context).0].path.as_str() {
            "" => self.tree.model_name.to_string(),
            path => format!("{}.{path}", self.tree.model_name),
        }
    }

    /// Whether a call is `array(a, b)`, another form of `{a, b}` (MLS §10.4).
    fn is_array_constructor(
        &mut self,
        function: &ComponentReference,
        arguments: &Arguments,
        context: ScopeId,
    ) -> Result<bool, Diagnostic> {
        let is_named = function.as_ident().is_some_and(|name| name == "array");
        let lists = arguments.named.is_empty() && !arguments.positional.is_empty();
        Ok(is_named && lists && self.lookup(context, &function.name())?.is_none())
    }
}
