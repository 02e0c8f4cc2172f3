//! A function of a loaded unit, called as those in Rust are.

use super::declaration::{Declaration, Scalar};
use super::frame::{CObject, Cell, Frame};
use super::{CLibrary, Request};
use crate::diag::Fault;
use crate::external::call::Call;
use crate::external::errors::EXTERNAL_FAILED;
use crate::external::{Effect, Entry};
use crate::fault;
use rustc_hash::FxHashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A function of a loaded unit.
pub struct CFunction {
    library: Arc<dyn CLibrary>,
    declaration: Declaration,
    number: usize,
    /// The wrapper of the destructor.
    destructor: Option<usize>,
}

impl CFunction {
    /// Calls it.
    ///
    /// # Errors
    /// The text of `ModelicaError`, or values that C has no room for.
    pub fn call(&self, call: &mut Call<'_>) -> Result<(), Fault> {
        let mut frame = Frame::of(&self.declaration, call)?;
        let done = self.library.invoke(self.number, &mut frame);
        for line in frame.log.lines() {
            call.outside.log(line)?;
        }
        done.map_err(|message| {
            let function = &self.declaration.function;
            fault!(EXTERNAL_FAILED, "`{function}`: {}", message.trim_end())
        })?;
        match (self.declaration.result, frame.cells.last()) {
            (Some(Scalar::Object), Some(Cell::Object(address))) => {
                let (library, address) = (self.library.clone(), *address);
                let class = self.declaration.objects.last().cloned().flatten();
                frame.store(&self.declaration, call)?;
                call.give_object(CObject { library, address, class, destructor: self.destructor })
            }
            _ => frame.store(&self.declaration, call),
        }
    }
}

/// The entry of the requested function in a loaded unit. Entries live as long as the program:
/// there is one for each function of each unit.
pub fn entry(request: &Request, library: &Arc<dyn CLibrary>) -> &'static Entry {
    type Known = Mutex<FxHashMap<(String, usize), &'static Entry>>;
    static KNOWN: OnceLock<Known> = OnceLock::new();
    let known = KNOWN.get_or_init(Known::default);
    let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
    let key = (library.key().to_owned(), request.requested);
    known.entry(key).or_insert_with(|| {
        let declaration = request.requested().clone();
        let freed_by = declaration.destructor.as_ref();
        let position = |class: &String| request.declarations.iter().position(|d| d.class == *class);
        let function = CFunction {
            library: library.clone(),
            number: request.requested,
            destructor: freed_by.and_then(position),
            declaration: declaration.clone(),
        };
        Box::leak(Box::new(Entry {
            name: Box::leak(declaration.function.clone().into_boxed_str()),
            signature: Box::leak(declaration.signature().into_boxed_str()),
            effect: declaration.effect,
            in_steps: declaration.effect != Effect::None,
            confirms: false,
            stands_for: "",
            run: unreachable_in_rust,
            c: Some(Box::leak(Box::new(function))),
        }))
    })
}

fn unreachable_in_rust(call: &mut Call<'_>) -> Result<(), Fault> {
    Err(call.fault("it is implemented in C"))
}
