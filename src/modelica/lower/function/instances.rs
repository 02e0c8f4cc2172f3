//! Functions compiled for certain arguments, each combination once.

use super::headers::{header_of, library_of, names_in_sizes};
use super::notices::warning_of;
use super::statements::Body;
use crate::budget::step_limit;
use crate::bytecode::{Code, ExternalCall, Failure, Functions, Instruction, Machine, Reason};
use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionBody, FunctionComponent, ValueType};
use crate::external::{Effect, Slot, SlotKind};
use crate::fault;
use crate::flatten::FlatModel;
use crate::lower::errors::{NO_CONSTANT_VALUE, NOT_SUPPORTED};
use crate::lower::expressions::Lowered;
use crate::lower::shape::Shape;
use crate::lower::shape::UNKNOWN_TEXT;
use crate::lower::string_array::StringArray;
use crate::name::{Ident, Name};
use crate::source::Span;
use indexmap::IndexMap;
use rustc_hash::FxHashSet;
use std::cell::Cell;
use std::sync::Arc;

/// Deepest nesting of functions being compiled.
const MAX_DEPTH: usize = 40;
/// Most functions.
const MAX_INSTANCES: usize = 5_000;
/// Most instructions of all functions of a model.
const MAX_INSTRUCTIONS: usize = 5_000_000;

/// Calls of numbers are left to the simulation after so many that took all the instructions that one
/// may take.
const MAX_FOLDED: u64 = 25;

/// What becomes of the output of a function whose value is used.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Output {
    /// It is written at an event.
    Written,
    /// What it prints is left out, since it is called at every step.
    #[default]
    LeftOut,
    /// It depends on branches that are not those of the function at hand.
    Refused,
}

/// What a function is compiled for.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
struct Signature {
    name: Name,
    arguments: Vec<Argument>,
    /// Whether computed Integers may decide sizes in statements.
    at_run_time: bool,
    /// Whether Strings are made when the function runs.
    composes: bool,
    /// Whether what it would print is left out.
    silent: bool,
    /// Whether the interpreter carries it out.
    interpreted: bool,
}

impl Signature {
    /// Whether Strings are passed by their numbers.
    fn takes_string_numbers(&self) -> bool {
        self.arguments.iter().any(Argument::holds_number_of_text)
    }
}

/// What is known of an argument.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Argument {
    /// Its shape; its scalars are passed.
    Shape(Shape),
    /// The bits of its value.
    Known(u64),
    /// A text.
    Text(Arc<str>),
    /// An array of Strings.
    Strings(StringArray),
    /// A record of which some components are known, on which sizes may depend.
    Record(Vec<(Ident, Argument)>),
}

impl Argument {
    /// Whether each of its scalars is passed.
    fn append_passed(&self, passed: &mut Vec<bool>) {
        match self {
            Argument::Shape(shape) => passed.extend(std::iter::repeat_n(true, shape.len())),
            Argument::Known(_) => passed.push(false),
            Argument::Text(_) | Argument::Strings(_) => {}
            Argument::Record(fields) => {
                fields.iter().for_each(|(_, field)| field.append_passed(passed));
            }
        }
    }

    /// Whether it is the number of a text, or one of its components is.
    fn holds_number_of_text(&self) -> bool {
        match self {
            Argument::Shape(shape) => shape.holds_number_of_text(),
            Argument::Record(fields) => {
                fields.iter().any(|(_, field)| field.holds_number_of_text())
            }
            Argument::Known(_) | Argument::Text(_) | Argument::Strings(_) => false,
        }
    }

    /// Whether a value is known, itself or one of its components.
    fn has_known(&self) -> bool {
        match self {
            Argument::Known(_) => true,
            Argument::Record(fields) => fields.iter().any(|(_, field)| field.has_known()),
            Argument::Shape(_) | Argument::Text(_) | Argument::Strings(_) => false,
        }
    }
}

/// Whether each scalar of all arguments is passed.
pub(super) fn passed(arguments: &[Argument]) -> Vec<bool> {
    let mut passed = Vec::new();
    arguments.iter().for_each(|argument| argument.append_passed(&mut passed));
    passed
}

/// A compiled function.
#[derive(Debug, Clone)]
pub(crate) struct Instance {
    /// Its number.
    pub(super) code: u32,
    /// Shapes of its outputs.
    pub(super) outputs: Vec<Shape>,
    /// Whether a call with numbers is a number.
    pub(super) folds: bool,
    /// Whether equal calls may give different results.
    pub(super) impure: bool,
    /// Whether what it prints is left out.
    pub(super) silenced: bool,
    /// Whether calls write files or print.
    pub(super) writes: bool,
    /// Which scalars of the arguments are passed; the others are known.
    pub(super) passed: Vec<bool>,
}

/// All functions compiled so far.
#[derive(Debug, Default)]
pub(crate) struct Instances {
    pub(super) functions: Functions,
    /// Whether each function is compiled to its end.
    finished: Vec<bool>,
    known: IndexMap<Signature, Instance>,
    /// Why, and whether a text was missing.
    failed: IndexMap<Signature, (Diagnostic, bool)>,
    /// Functions that make Strings, by what they are made of.
    pub(super) composers: IndexMap<(Vec<Slot>, Vec<Arc<str>>), u32>,
    depth: usize,
    /// A model with nothing but the functions, if some are interpreted.
    pub(super) library: Option<Arc<FlatModel>>,
    /// How many statements the interpreter has run.
    pub(in crate::lower) interpreted: Cell<u64>,
    /// Where calls of numbers took zero for variables that nothing was assigned to.
    notices: Vec<(u32, Failure)>,
    /// How many instructions calls of numbers took.
    folded: u64,
    /// The last call of numbers that took too many.
    exhausted: Option<Failure>,
    instructions: usize,
    /// Most of them.
    max_instructions: usize,
    /// Whether results beyond the largest Real are faults, and not infinite.
    pub(super) refuses_overflow: bool,
    /// Whether a statement is at hand that may write.
    pub(crate) may_write: bool,
    /// What becomes of the output of functions whose values are used.
    pub(super) output: Output,
    /// Whether functions are compiled without what they print.
    pub(super) silent: bool,
    /// Whether statements are compiled size by size where a computed Integer decides.
    pub(super) sizes_at_run_time: bool,
    /// Whether a text was needed that is made at run time.
    pub(super) misses_text: bool,
    /// Whether the outputs of the next call are needed, though they be Strings made at run time.
    pub(in crate::lower) needs_string_outputs: bool,
}

impl Instances {
    /// Functions of a model, which is strict or not.
    pub(crate) fn new(strict: bool) -> Instances {
        let functions = Functions { takes_defaults: !strict, ..Functions::default() };
        Instances { functions, max_instructions: MAX_INSTRUCTIONS, ..Instances::default() }
    }

    /// Most instructions of all functions.
    pub(super) fn max_instructions(&self) -> usize {
        self.max_instructions
    }

    /// Lets what is compiled next have so many instructions, in the bounds of all functions.
    pub(super) fn allow(&mut self, instructions: usize) {
        self.max_instructions = MAX_INSTRUCTIONS.min(self.instructions + instructions);
    }

    /// The finished functions, and warnings of them.
    pub(crate) fn finish(self) -> (Functions, Vec<Diagnostic>) {
        let mut warnings: Vec<Diagnostic> = Vec::new();
        for notice in &self.notices {
            let warning = warning_of(&self.functions, notice);
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        (self.functions, warnings)
    }

    /// A function for arguments of which some scalars are known.
    pub(crate) fn instance(
        &mut self,
        flat: &FlatModel,
        function: &Arc<Function>,
        arguments: &[Lowered<Option<f64>>],
        span: Span,
    ) -> Result<Instance, Diagnostic> {
        let at_run_time = std::mem::replace(&mut self.sizes_at_run_time, false);
        let mut found = self.with_strings(flat, function, arguments, span);
        self.sizes_at_run_time = at_run_time;
        if at_run_time
            && let Err(e) = &found
            && [NO_CONSTANT_VALUE, NOT_SUPPORTED].contains(&e.code)
        {
            found = self.general_or_special(flat, function, arguments, false, span);
        }
        let found = found?;
        if !found.writes || self.may_write || self.depth > 0 {
            return Ok(found);
        }
        if !found.outputs.is_empty()
            && (self.output == Output::Written || self.changes_objects_alone(found.code))
        {
            return Ok(found);
        }
        self.without_output(flat, function, arguments, span)?.ok_or_else(|| {
            fault!(NOT_SUPPORTED, "the function `{}` writes files, so its value cannot be used in \
                equations",
                function.name;
                help: "call it in a when-clause")
            .at(span)
        })
    }

    /// A function without what it prints; `None` if it writes otherwise.
    fn without_output(
        &mut self,
        flat: &FlatModel,
        function: &Arc<Function>,
        arguments: &[Lowered<Option<f64>>],
        span: Span,
    ) -> Result<Option<Instance>, Diagnostic> {
        if self.output != Output::LeftOut {
            return Ok(None);
        }
        self.silent = true;
        let found = self.with_strings(flat, function, arguments, span);
        self.silent = false;
        let silenced = |instance: Instance| Instance { silenced: true, ..instance };
        Ok(found.map(silenced).ok().filter(|instance| !instance.writes))
    }

    /// A function whose Strings are known; one that makes them when it runs where they are not.
    fn with_strings(
        &mut self,
        flat: &FlatModel,
        function: &Arc<Function>,
        arguments: &[Lowered<Option<f64>>],
        span: Span,
    ) -> Result<Instance, Diagnostic> {
        let is_needed = std::mem::replace(&mut self.needs_string_outputs, false);
        if is_needed && function.outputs.iter().any(is_text) {
            self.misses_text = true;
            return self.general_or_special(flat, function, arguments, true, span);
        }
        let outer = std::mem::replace(&mut self.misses_text, false);
        let known = self.general_or_special(flat, function, arguments, false, span);
        let misses_text = std::mem::replace(&mut self.misses_text, outer);
        match known {
            Err(error) if misses_text => {
                self.misses_text = true;
                match self.general_or_special(flat, function, arguments, true, span) {
                    // What is compiled for known values may do without.
                    Err(_) if error.code == NO_CONSTANT_VALUE => Err(error),
                    made => made,
                }
            }
            known => known,
        }
    }

    /// A function for any values of its arguments, or else for those that are known.
    fn general_or_special(
        &mut self,
        flat: &FlatModel,
        function: &Arc<Function>,
        arguments: &[Lowered<Option<f64>>],
        composes: bool,
        span: Span,
    ) -> Result<Instance, Diagnostic> {
        let at_run_time = self.sizes_at_run_time;
        let mut first_error = None;
        let mut before = None;
        // The fewer values are built in, the more calls share the code: a recursive function that
        // counts its depth must not be compiled for each.
        for known in [ByValue::Nothing, ByValue::DeclaredSizes, ByValue::Everything] {
            let signature = signature(function, arguments, known, span)
                .inspect_err(|_| self.misses_text = true)?;
            let signature = Signature { at_run_time, composes, silent: self.silent, ..signature };
            if before.as_ref() == Some(&signature) {
                continue;
            }
            match self.compiled(flat, function, signature.clone(), span) {
                Err(e) if e.code == NO_CONSTANT_VALUE => first_error.get_or_insert(e),
                result => return result,
            };
            before = Some(signature);
        }
        let unknown = || fault!(NO_CONSTANT_VALUE, "a size is not known").at(span);
        Err(first_error.unwrap_or_else(unknown))
    }

    /// The functions of a model alone, once for all that are interpreted.
    pub(super) fn library(&mut self, flat: &FlatModel) -> Arc<FlatModel> {
        self.library.get_or_insert_with(|| library_of(flat, flat.strict)).clone()
    }

    /// A function that the interpreter carries out whenever it is called.
    pub(super) fn interpreted_instance(
        &mut self,
        flat: &FlatModel,
        function: &Arc<Function>,
        arguments: &[Lowered<Option<f64>>],
        span: Span,
    ) -> Result<Instance, Diagnostic> {
        if !matches!(function.body, FunctionBody::Algorithm(_)) {
            return Err(fault!(NOT_SUPPORTED, "`{}` without statements", function.name).at(span));
        }
        let header = Arc::new(header_of(function));
        let mut result = Err(fault!(NO_CONSTANT_VALUE, "a size is not known").at(span));
        for known in [ByValue::Nothing, ByValue::DeclaredSizes] {
            let signature = signature(&header, arguments, known, span)?;
            let signature = Signature { interpreted: true, ..signature };
            if let Some(known) = self.known.get(&signature) {
                return Ok(known.clone());
            }
            result = self.interpreted(flat, (function, &header), signature, span);
            if !matches!(&result, Err(e) if e.code == NO_CONSTANT_VALUE) {
                break;
            }
        }
        result
    }

    fn interpreted(
        &mut self,
        flat: &FlatModel,
        (function, header): (&Arc<Function>, &Arc<Function>),
        signature: Signature,
        span: Span,
    ) -> Result<Instance, Diagnostic> {
        let library = self.library(flat);
        let mut body = Body::new(flat, self, header);
        let outputs = body.declare(&signature.arguments, &[], span)?;
        let mut code = body.interpreted(function, &library, span)?;
        code.writes = self.writes(&code);
        code.impure = function.impure || self.has_effects(&code);
        let instance = Instance {
            outputs,
            folds: false,
            impure: code.impure,
            writes: code.writes,
            silenced: false,
            passed: passed(&signature.arguments),
            code: self.finished.len() as u32,
        };
        self.functions.files.grant_others(&flat.resources);
        self.functions.codes.push(code);
        self.finished.push(true);
        self.known.insert(signature, instance.clone());
        Ok(instance)
    }

    fn compiled(
        &mut self,
        flat: &FlatModel,
        function: &Arc<Function>,
        signature: Signature,
        span: Span,
    ) -> Result<Instance, Diagnostic> {
        if let Some(known) = self.known.get(&signature) {
            return Ok(known.clone());
        }
        if let Some((failed, misses_text)) = self.failed.get(&signature) {
            self.misses_text |= misses_text;
            return Err(failed.clone());
        }
        let name = &function.name;
        if let Some(reason) = super::external_kinds::refusal(function) {
            return Err(fault!(NOT_SUPPORTED, "the function `{name}` {reason}").at(span));
        }
        let statements = match &function.body {
            FunctionBody::Algorithm(statements) => statements.as_slice(),
            FunctionBody::PartialDerivative { .. } => {
                return Err(fault!(
                    NOT_SUPPORTED,
                    "`{name}`, a partial derivative, in a function that is not inlined"
                )
                .at(span));
            }
            FunctionBody::External(_) | FunctionBody::RecordConstructor => &[],
        };
        if self.depth >= MAX_DEPTH || self.finished.len() >= MAX_INSTANCES {
            return Err(fault!(
                NOT_SUPPORTED,
                "the function `{name}` calls itself with ever new sizes"
            )
            .at(span));
        }
        let before = (self.finished.len(), self.known.len());
        self.depth += 1;
        let result = self.compile(flat, function, statements, &signature, span);
        self.depth -= 1;
        if let Err(e) = &result {
            // Functions compiled meanwhile may call the one that failed.
            self.functions.codes.truncate(before.0);
            self.finished.truncate(before.0);
            self.known.truncate(before.1);
            self.failed.insert(signature, (e.clone(), self.misses_text));
        }
        result
    }

    fn compile(
        &mut self,
        flat: &FlatModel,
        function: &Arc<Function>,
        statements: &[crate::syntax::ast::Statement],
        signature: &Signature,
        span: Span,
    ) -> Result<Instance, Diagnostic> {
        let mut body = Body::new(flat, self, function);
        body.composes = signature.composes;
        if body.composes {
            body.instances.number_of(&"".into());
        }
        let outputs = body.declare(&signature.arguments, statements, span)?;
        let mut instance = Instance {
            code: body.instances.finished.len() as u32,
            outputs,
            folds: !function.impure
                && !super::external_kinds::handles_objects(function)
                && !signature.takes_string_numbers(),
            impure: function.impure,
            writes: false,
            silenced: false,
            passed: passed(&signature.arguments),
        };
        let returns_strings = instance.outputs.iter().any(Shape::holds_number_of_text);
        instance.folds &= !returns_strings;
        body.instances.functions.codes.push(Code::default());
        body.instances.finished.push(false);
        body.instances.known.insert(signature.clone(), instance.clone());
        let mut code = body.compile(statements)?;
        code.returns_strings = returns_strings;
        code.writes = self.writes(&code);
        code.impure = function.impure || self.has_effects(&code);
        if code.n_outputs == 0 {
            // Something replaces the call where its statement is executed.
            (code.outputs, code.n_outputs) = (code.frame, 1);
            code.constants.push((code.outputs, 0.0));
            code.frame += 1;
        }
        if code.impure {
            instance.folds = false;
            instance.impure = true;
            instance.writes = code.writes;
            self.known.insert(signature.clone(), instance.clone());
        }
        code.derivative = self.derivative(flat, function, &signature.arguments, span);
        code.inverses = self.inverses(flat, function, &signature.arguments, span);
        let instructions = self.instructions + code.instructions.len();
        let limit = self.max_instructions;
        if instructions > limit {
            let words = format!("the functions of this model need more than {limit} instructions");
            return Err(fault!(NOT_SUPPORTED, "{words}").at(function.span));
        }
        self.instructions = instructions;
        self.functions.codes[instance.code as usize] = code;
        self.finished[instance.code as usize] = true;
        Ok(instance)
    }

    /// A function that is compiled; returns its number.
    pub(super) fn add(&mut self, code: Code) -> u32 {
        self.functions.codes.push(code);
        self.finished.push(true);
        self.finished.len() as u32 - 1
    }

    /// The scalars that a call returns, if it has a value and nothing it needs is still being
    /// compiled.
    pub(crate) fn evaluate(&mut self, instance: &Instance, arguments: &[f64]) -> Option<Vec<f64>> {
        if !self.is_finished(instance.code) {
            return None;
        }
        if self.folded > MAX_FOLDED * step_limit() {
            return None;
        }
        let mut machine = Machine::default();
        let results = machine.call(&self.functions, instance.code, arguments.iter().copied());
        let is_exhausted = |failure: &Failure| failure.reason == Reason::Budget;
        self.exhausted = results.as_ref().err().copied().filter(is_exhausted).or(self.exhausted);
        let results = results.map(<[f64]>::to_vec);
        self.notices.extend(machine.notices());
        self.folded += machine.spent();
        results.ok().filter(|results| !results.iter().any(|x| x.is_nan()))
    }

    /// What the last call of numbers said that took too many instructions, once.
    pub(in crate::lower) fn take_exhausted(&mut self) -> Option<String> {
        let failure = self.exhausted.take()?;
        Some(self.functions.explain(&failure).0)
    }

    /// Whether a function writes, itself or by what it calls.
    fn writes(&self, code: &Code) -> bool {
        let of_call = |instruction: &Instruction| match instruction {
            Instruction::Call { function, .. } => self.functions.codes[*function as usize].writes,
            _ => false,
        };
        code.externals.iter().any(|call| call.entry.effect == Effect::Writes)
            || code.instructions.iter().any(of_call)
    }

    /// Whether a function writes, or reads or changes the hidden state, itself or by what it calls.
    /// A function in C without inputs counts as if it did: it would be called for nothing else, and
    /// a declaration that says neither `pure` nor `impure` promises nothing (MLS §12.3).
    fn has_effects(&self, code: &Code) -> bool {
        let of_call = |instruction: &Instruction| match instruction {
            Instruction::Call { function, .. } => self.functions.codes[*function as usize].impure,
            _ => false,
        };
        let is_alone = |call: &ExternalCall| call.entry.c.is_some() && code.n_inputs == 0;
        let has_effect = |call: &ExternalCall| call.entry.effect != Effect::None || is_alone(call);
        code.externals.iter().any(has_effect) || code.instructions.iter().any(of_call)
    }

    /// Whether a function and all that it calls are compiled to their ends.
    fn is_finished(&self, function: u32) -> bool {
        self.all_called(function, |function| self.finished[function as usize])
    }

    /// Whether a function reads files, itself or by what it calls.
    pub(super) fn reads_files(&self, function: u32) -> bool {
        let reads = |call: &ExternalCall| {
            call.entry.files().chain(call.entry.possible_files()).next().is_some()
        };
        !self.all_called(function, |function| {
            !self.functions.codes[function as usize].externals.iter().any(reads)
        })
    }

    /// Whether a function, or one that it calls, is in C or interpreted.
    pub(super) fn leaves_program(&self, function: u32) -> bool {
        let leaves = |call: &ExternalCall| call.entry.c.is_some() || call.in_modelica.is_some();
        !self.all_called(function, |function| {
            !self.functions.codes[function as usize].externals.iter().any(leaves)
        })
    }

    /// Whether all that a function writes, itself or by what it calls, are external objects in C: a
    /// package that is filled before it is sent. It is called where its value is used.
    fn changes_objects_alone(&self, function: u32) -> bool {
        let is_object = |slot: &Slot| slot.kind == SlotKind::Object;
        let is_harmless = |call: &ExternalCall| {
            call.entry.effect != Effect::Writes
                || call.entry.c.is_some() && call.arguments.iter().any(is_object)
        };
        self.all_called(function, |function| {
            self.functions.codes[function as usize].externals.iter().all(is_harmless)
        })
    }

    /// Whether something holds for a function and for all that it calls.
    fn all_called(&self, function: u32, holds: impl Fn(u32) -> bool) -> bool {
        let mut seen = FxHashSet::default();
        let mut stack = vec![function];
        while let Some(function) = stack.pop() {
            if !holds(function) {
                return false;
            }
            if seen.insert(function) {
                let code = &self.functions.codes[function as usize];
                stack.extend(code.instructions.iter().filter_map(
                    |instruction| match instruction {
                        Instruction::Call { function, .. } => Some(*function),
                        _ => None,
                    },
                ));
            }
        }
        true
    }
}

impl Instance {
    /// The scalars of arguments that a call passes.
    pub(super) fn passed_of<S: Copy>(&self, arguments: &[Lowered<S>]) -> Vec<S> {
        let mut scalars = Vec::with_capacity(self.passed.len());
        arguments.iter().for_each(|argument| argument.append_scalars(&mut scalars));
        let both = scalars.into_iter().zip(&self.passed);
        both.filter(|(_, passed)| **passed).map(|(scalar, _)| scalar).collect()
    }
}

/// Whether a component is a text.
pub(super) fn is_text(component: &FunctionComponent) -> bool {
    component.value_type == ValueType::String && component.dims.is_empty()
}

/// Which known arguments are built into the code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ByValue {
    Nothing,
    /// Those that occur in declared sizes.
    DeclaredSizes,
    Everything,
}

fn signature(
    function: &Function,
    arguments: &[Lowered<Option<f64>>],
    by_value: ByValue,
    span: Span,
) -> Result<Signature, Diagnostic> {
    let mut list = Vec::with_capacity(arguments.len());
    let sizes = match by_value {
        ByValue::DeclaredSizes => names_in_sizes(function),
        ByValue::Nothing | ByValue::Everything => FxHashSet::default(),
    };
    for (input, argument) in function.inputs.iter().zip(arguments) {
        // Algorithms refuse to decide by it themselves.
        if let Lowered::Text(text) = argument
            && text.contains(UNKNOWN_TEXT)
            && super::external_kinds::reads_strings(function)
        {
            return Err(fault!(
                NOT_SUPPORTED,
                "the String for `{}` of `{}` must be known at translation",
                input.name,
                function.name
            )
            .at(span));
        }
        let with_values = by_value == ByValue::Everything || sizes.contains(&input.name);
        let known = known_of(&input.value_type, argument, with_values).ok_or_else(|| {
            fault!(
                NOT_SUPPORTED,
                "a String that changes during the simulation, for `{}` of `{}`",
                input.name,
                function.name
            )
            .at(span)
        })?;
        list.push(known);
    }
    let name = function.name.clone();
    Ok(Signature {
        name,
        arguments: list,
        at_run_time: false,
        composes: false,
        silent: false,
        interpreted: false,
    })
}

/// What is known of an argument; `None` if it is or holds a text that changes.
fn known_of(
    expected: &ValueType,
    argument: &Lowered<Option<f64>>,
    with_values: bool,
) -> Option<Argument> {
    let is_whole =
        matches!(expected, ValueType::Integer | ValueType::Boolean | ValueType::Enumeration(_));
    Some(match argument {
        Lowered::Numbered(_) => Argument::Shape(Shape::Numbered),
        Lowered::Text(text) => Argument::Text(text.clone()),
        Lowered::Strings(strings) => Argument::Strings(strings.clone()),
        Lowered::Array(array) => match array.elements.as_slice() {
            [Some(value)] if array.dims.is_empty() && is_whole && with_values => {
                Argument::Known(value.to_bits())
            }
            _ => Argument::Shape(Shape::Array(array.dims.clone())),
        },
        Lowered::Record(fields) => {
            if let (ValueType::Record(_, types), true) = (expected, with_values) {
                let field = |(name, field): &(Ident, Lowered<_>)| {
                    let known = known_of(&types.get(name)?.value_type, field, with_values)?;
                    Some((*name, known))
                };
                let known = fields.iter().map(field).collect::<Option<_>>().map(Argument::Record);
                if let Some(known) = known.filter(Argument::has_known) {
                    return Some(known);
                }
            }
            Argument::Shape(argument.shape()?)
        }
    })
}
