//! The arguments of a call as C sees them.

use super::CLibrary;
use super::declaration::{Argument, Declaration, Scalar};
use crate::diag::Fault;
use crate::external::call::{Call, Slot};
use std::ffi::CString;
use std::sync::Arc;

/// What a pointer of the row points to.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// `double`s.
    Reals(Vec<f64>),
    /// `int`s.
    Wholes(Vec<i32>),
    /// A `size_t`.
    Size(usize),
    /// Strings; where none was written, it stays.
    Strings(Vec<CString>),
    /// The address of an object.
    Object(usize),
}

/// The row of pointers: arguments, then the result.
#[derive(Debug, Clone, Default)]
pub struct Frame {
    /// What they point to.
    pub cells: Vec<Cell>,
    /// What `ModelicaMessage` and `ModelicaWarning` said.
    pub log: String,
}

impl Frame {
    /// The arguments of a call.
    pub fn of(declaration: &Declaration, call: &Call<'_>) -> Result<Frame, Fault> {
        let mut cells = Vec::with_capacity(call.arguments.len() + 1);
        for (at, argument) in declaration.arguments.iter().enumerate() {
            cells.push(cell(declaration, *argument, at, call)?);
        }
        match declaration.result {
            Some(Scalar::Real) => cells.push(Cell::Reals(vec![0.0])),
            Some(Scalar::Whole) => cells.push(Cell::Wholes(vec![0])),
            Some(Scalar::Text) => cells.push(Cell::Strings(vec![CString::default()])),
            Some(Scalar::Object) => cells.push(Cell::Object(0)),
            None => {}
        }
        Ok(Frame { cells, log: String::new() })
    }

    /// Writes what C has written: outputs, arrays, the result unless it is an object.
    pub fn store(self, declaration: &Declaration, call: &mut Call<'_>) -> Result<(), Fault> {
        let mut cells = self.cells.into_iter();
        for (at, argument) in declaration.arguments.iter().enumerate() {
            let (Some(cell), slot) = (cells.next(), call.arguments[at].clone()) else { break };
            if matches!(argument, Argument::Output(_) | Argument::Array(_)) {
                write(cell, &slot, call)?;
            }
        }
        match (cells.next(), call.result.cloned()) {
            (Some(cell), Some(slot)) => write(cell, &slot, call),
            _ => Ok(()),
        }
    }
}

fn cell(
    declaration: &Declaration,
    argument: Argument,
    at: usize,
    call: &Call<'_>,
) -> Result<Cell, Fault> {
    let slot = &call.arguments[at];
    let numbers = || &call.numbers[slot.first as usize..][..slot.len()];
    Ok(match argument {
        Argument::Size => match whole(call.number(at)) {
            Some(size) if size >= 0 => Cell::Size(size as usize),
            _ => return Err(call.fault(format!("{} is not a size", call.number(at)))),
        },
        Argument::Output(scalar) | Argument::Value(scalar) | Argument::Array(scalar) => {
            let is_output = matches!(argument, Argument::Output(_));
            match scalar {
                Scalar::Real => Cell::Reals(numbers().to_vec()),
                Scalar::Whole => Cell::Wholes(wholes(numbers(), is_output, call)?),
                Scalar::Text if is_output => Cell::Strings(vec![CString::default()]),
                Scalar::Text => Cell::Strings(strings(slot, call)?),
                Scalar::Object => Cell::Object(object(declaration, at, call)?.address()),
            }
        }
    })
}

/// An object of the class that C takes it for.
fn object<'c>(
    declaration: &Declaration,
    at: usize,
    call: &'c Call<'_>,
) -> Result<&'c CObject, Fault> {
    let object: &CObject = call.object(at)?;
    let name = |class: &Option<String>| class.clone().unwrap_or_default();
    match declaration.objects.get(at) {
        Some(expected) if *expected == object.class => Ok(object),
        expected => Err(call.fault(format!(
            "argument {} is an object of the class `{}`, not of `{}`",
            at + 1,
            name(&object.class),
            expected.map(name).unwrap_or_default()
        ))),
    }
}

/// An `int`.
fn whole(number: f64) -> Option<i32> {
    let is_int = number.fract() == 0.0 && number.abs() <= f64::from(i32::MAX);
    is_int.then_some(number as i32)
}

/// Numbers as `int`s; what is only written may have no value before.
fn wholes(numbers: &[f64], is_output: bool, call: &Call<'_>) -> Result<Vec<i32>, Fault> {
    let convert = |number: &f64| match whole(*number) {
        Some(whole) => Ok(whole),
        None if is_output || number.is_nan() => Ok(0),
        None => Err(call.fault(format!("{number} does not fit into an `int`"))),
    };
    numbers.iter().map(convert).collect()
}

fn strings(slot: &Slot, call: &Call<'_>) -> Result<Vec<CString>, Fault> {
    let strings = &call.strings[slot.first as usize..][..slot.len()];
    let convert = |text: &std::sync::Arc<str>| {
        CString::new(text.as_bytes()).map_err(|_| call.fault("a String contains a zero byte"))
    };
    strings.iter().map(convert).collect()
}

fn write(cell: Cell, slot: &Slot, call: &mut Call<'_>) -> Result<(), Fault> {
    let first = slot.first as usize;
    match cell {
        Cell::Reals(values) => call.numbers[first..][..values.len()].copy_from_slice(&values),
        Cell::Wholes(values) => {
            for (number, value) in call.numbers[first..].iter_mut().zip(values) {
                *number = f64::from(value);
            }
        }
        // Arrays of Strings are only read.
        Cell::Strings(strings) if slot.dims.is_empty() => {
            let text = strings.into_iter().next().unwrap_or_default().into_string();
            let text = text.map_err(|_| call.fault("the String returned is not valid UTF-8"))?;
            call.written.push((slot.first, text.into()));
        }
        Cell::Strings(_) | Cell::Size(_) | Cell::Object(_) => {}
    }
    Ok(())
}

/// An object that C has made; freed by its destructor when the last reference is dropped.
pub(crate) struct CObject {
    pub(super) library: Arc<dyn CLibrary>,
    pub(super) address: usize,
    /// Its class in Modelica.
    pub(super) class: Option<String>,
    pub(super) destructor: Option<usize>,
}

impl CObject {
    /// Where it is.
    pub(crate) fn address(&self) -> usize {
        self.address
    }
}

impl Drop for CObject {
    fn drop(&mut self) {
        if let Some(destructor) = self.destructor {
            let cells = vec![Cell::Object(self.address)];
            // There is no caller to report a failed destructor to.
            let _ = self.library.invoke(destructor, &mut Frame { cells, ..Frame::default() });
        }
    }
}
