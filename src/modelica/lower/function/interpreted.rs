//! Functions that cannot be compiled: the interpreter carries out their calls when they are made.
//!
//! Sizes inside them may be anything that the arguments make them: `Real d[n, max(s .* s)]` with an `s`
//! that is computed. What they call again and again is compiled for the sizes at hand.
//!
//! ```text
//! call(code, x, n)  →  Interpreted: values of x and n  →  eval  →  numbers of the outputs
//! ```

use super::emitter::Operand;
use super::external_kinds::{effect_of, is_object};
use super::on_demand::OnDemand;
use super::statements::Body;
use crate::budget;
use crate::bytecode::{Code, ExternalCall, Instruction};
use crate::diag::{Diagnostic, Fault};
use crate::eval::{self, Callee, Function, FunctionComponent, Host, RunCompiled, ValueType};
use crate::external::{Call, Callable, Entry, Outside, Slot, SlotKind};
use crate::fault;
use crate::flatten::FlatModel;
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::expressions::Lowered;
use crate::lower::number_values::{append_numbers, value_of};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::ComponentReference;
use crate::value::{ArrayValue, Elements, RecordValue, Value};
use std::sync::{Arc, Mutex, PoisonError};

/// A function that the interpreter carries out.
struct Interpreted {
    function: Arc<Function>,
    /// A model with nothing but functions.
    library: Arc<FlatModel>,
    /// What its inputs are made of.
    inputs: Vec<Layout>,
    /// Compilers that no call uses now: simulations run side by side.
    idle: Mutex<Vec<OnDemand>>,
}

/// How an input is made of arguments of the call.
enum Layout {
    /// One argument: a number, a String or an array of either.
    Argument(ValueType),
    /// The components of a record.
    Record(Name, Vec<(Ident, Layout)>),
}

impl Body<'_, '_> {
    /// The code of a function whose inputs and outputs are declared: a call of the interpreter.
    pub(super) fn interpreted(
        mut self,
        function: &Arc<Function>,
        library: &Arc<FlatModel>,
        span: Span,
    ) -> Result<Code, Diagnostic> {
        let (mut arguments, mut signature, mut inputs) = (Vec::new(), String::new(), Vec::new());
        for input in &function.inputs {
            let value = self.local(&[input.name]).cloned();
            let value = value.ok_or_else(|| refused(function, input, span))?;
            let layout = self.layout(value, input, span, &mut arguments)?;
            inputs.push(layout.ok_or_else(|| refused(function, input, span))?);
        }
        signature.extend(arguments.iter().map(letter));
        for output in &function.outputs {
            let value = self.local(&[output.name]).cloned();
            let is_number = matches!(value, Some(Lowered::Array(_))) && !is_object(output);
            let value = value.filter(|_| is_number);
            let slot =
                self.slot(value.ok_or_else(|| refused(function, output, span))?, None, span)?;
            signature.push(letter(&slot).to_ascii_uppercase());
            arguments.push(slot);
        }
        let effect = effect_of(function, &library.functions);
        let name = Ident::new(&function.name.to_string());
        let entry = Entry::in_modelica(name.as_str(), Ident::new(&signature).as_str(), effect);
        let interpreted = Interpreted {
            function: function.clone(),
            library: library.clone(),
            inputs,
            idle: Mutex::default(),
        };
        let mut call = ExternalCall::new(entry, arguments, None);
        call.in_modelica = Some(Arc::new(interpreted));
        let external = self.emitter.external(call);
        self.emitter.place(span);
        self.emitter.emit(Instruction::External { external });
        Ok(self.finish())
    }

    /// Appends the arguments that an input is; `None` if it is of a type that cannot be passed.
    fn layout(
        &mut self,
        value: Lowered<Operand>,
        component: &FunctionComponent,
        span: Span,
        arguments: &mut Vec<Slot>,
    ) -> Result<Option<Layout>, Diagnostic> {
        match (value, &component.value_type) {
            (Lowered::Record(fields), ValueType::Record(name, types))
                if component.dims.is_empty() =>
            {
                let mut layouts = Vec::with_capacity(fields.len());
                for (name, field) in fields {
                    let Some(component) = types.get(&name) else { return Ok(None) };
                    let Some(layout) = self.layout(field, component, span, arguments)? else {
                        return Ok(None);
                    };
                    layouts.push((name, layout));
                }
                Ok(Some(Layout::Record(name.clone(), layouts)))
            }
            (Lowered::Record(_), _) | (_, ValueType::Record(..)) => Ok(None),
            (_, ValueType::ExternalObject(_) | ValueType::Function) => Ok(None),
            (value, _) if value.shape().is_none_or(|shape| shape.holds_unknown_text()) => Ok(None),
            (value, expected) => {
                arguments.push(self.slot(value, None, span)?);
                Ok(Some(Layout::Argument(expected.clone())))
            }
        }
    }
}

fn refused(function: &Function, component: &FunctionComponent, span: Span) -> Diagnostic {
    fault!(
        NOT_SUPPORTED,
        "the type of `{}` of `{}` in a function whose sizes only the simulation knows",
        component.name,
        function.name
    )
    .at(span)
}

/// The letter of a signature for an argument that is read.
fn letter(slot: &Slot) -> char {
    match (slot.kind, slot.dims.is_empty()) {
        (SlotKind::Text, false) => 's',
        (SlotKind::Text | SlotKind::Numbered, _) => 't',
        (SlotKind::Object, _) => 'o',
        (SlotKind::Number, true) => 'n',
        (SlotKind::Number, false) => 'a',
    }
}

impl Callable for Interpreted {
    fn call(&self, call: &mut Call<'_>) -> Result<(), Fault> {
        let mut slots = call.arguments.iter();
        let values = self.inputs.iter().map(|layout| value(layout, &mut slots, call));
        let values: Option<Vec<Value>> = values.collect();
        let outputs = slots.as_slice();
        let values = values.ok_or_else(|| self.lost())?;
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut host = Interpreting {
            library: &self.library,
            outside: &mut *call.outside,
            steps: 0,
            compiler: idle,
        };
        let made = eval::call_function(&self.function, values.into(), Span::NONE, &mut host);
        if let Some(compiler) = host.compiler {
            self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(compiler);
        }
        let made = made.map_err(|e| Fault::new(e.code, in_words(&e, &self.function)))?;
        for (slot, value) in outputs.iter().zip(&made) {
            let mut numbers = Vec::with_capacity(slot.len());
            append_numbers(value, &mut numbers).ok_or_else(|| self.lost())?;
            let place = &mut call.numbers[slot.first as usize..][..slot.len()];
            if numbers.len() != place.len() {
                return Err(self.lost());
            }
            place.copy_from_slice(&numbers);
        }
        Ok(())
    }
}

impl Interpreted {
    /// Arguments or outputs are not what they were when the call was compiled.
    fn lost(&self) -> Fault {
        fault!(
            NOT_SUPPORTED,
            "the sizes of the arguments or outputs of `{}` change",
            self.function.name
        )
    }
}

/// What an input is in a call.
fn value<'s>(
    layout: &Layout,
    slots: &mut impl Iterator<Item = &'s Slot>,
    call: &Call<'_>,
) -> Option<Value> {
    let expected = match layout {
        Layout::Record(name, fields) => {
            let field = |(name, field): &(Ident, Layout)| Some((*name, value(field, slots, call)?));
            let fields = fields.iter().map(field).collect::<Option<_>>()?;
            return Some(Value::Record(RecordValue { type_name: name.clone(), fields }));
        }
        Layout::Argument(expected) => expected,
    };
    let slot = slots.next()?;
    let (first, dims) = (slot.first as usize, slot.dims.iter().map(|n| *n as usize));
    let dims: Vec<usize> = dims.collect();
    if slot.kind != SlotKind::Text {
        return value_of(call.numbers.get(first..first + slot.len())?, &dims, expected);
    }
    if dims.is_empty() {
        return Some(Value::String(call.strings.get(first)?.clone()));
    }
    let elements = Elements::String(call.strings.get(first..first + slot.len())?.to_vec());
    Some(Value::Array(ArrayValue::new(dims, elements)))
}

/// What the interpreter says, and which function in the call said it.
fn in_words(error: &Diagnostic, called: &Function) -> String {
    let own = format!("function `{}`", called.name);
    match error.trace.first().filter(|frame| frame.what != own) {
        Some(frame) => format!("{}, in the {}", error.message, frame.what),
        None => error.message.clone(),
    }
}

/// Answers the interpreter in a simulation.
struct Interpreting<'a> {
    library: &'a Arc<FlatModel>,
    outside: &'a mut dyn Outside,
    steps: u64,
    compiler: Option<OnDemand>,
}

impl Host for Interpreting<'_> {
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        Ok(self.library.functions.get(name).cloned().map(Callee::Function))
    }

    fn variable(&mut self, _: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
        Ok(None)
    }

    fn outside(&mut self) -> Option<&mut dyn Outside> {
        Some(self.outside)
    }

    fn c_companions(&mut self, _: &Function) -> Vec<Arc<Function>> {
        self.library.functions.values().cloned().collect()
    }

    fn warn(&mut self, warning: Diagnostic) {
        // Who cannot take it has no place for it.
        let _ = self.outside.log(&warning.message);
    }

    fn takes_default(&mut self, warning: Diagnostic) -> bool {
        if !self.library.strict {
            self.warn(warning);
        }
        !self.library.strict
    }

    fn interrupted(&mut self) -> Option<Fault> {
        self.steps += 1;
        let limit = budget::statement_limit();
        (self.steps > limit).then(|| {
            let limit = budget::in_millions(limit);
            fault!(
                NOT_SUPPORTED,
                "more than {limit} statements (`--instruction-limit` allows more)"
            )
        })
    }

    fn overflows(&self) -> bool {
        true
    }

    fn compiler(&mut self) -> Option<&mut dyn RunCompiled> {
        OnDemand::of_long_call(&mut self.compiler, self.steps, || self.library.clone())
    }
}
