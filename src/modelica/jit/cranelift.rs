//! What all translations to machine code share: the module that holds the code, and the switch that
//! disables them.

#![allow(unsafe_code, reason = "the memory of machine code is freed by hand")]

use cranelift_codegen::Context;
use cranelift_codegen::isa::TargetFrontendConfig;
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Linkage, Module, default_libcall_names};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Whether nothing is translated.
static INTERPRETED: AtomicBool = AtomicBool::new(false);

/// From now on nothing becomes machine code in this process.
pub(crate) fn interpret() {
    INTERPRETED.store(true, Ordering::Relaxed);
}

/// Whether nothing becomes machine code.
pub(crate) fn is_interpreted() -> bool {
    INTERPRETED.load(Ordering::Relaxed)
}

/// How long Cranelift may take for better code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effort {
    /// Until the code is good.
    Best,
    /// As short as possible.
    Quick,
}

/// Machine code while it is made.
pub(crate) struct Code(JITModule);

impl Code {
    /// No code yet; `None` on machines that Cranelift does not know.
    pub(crate) fn new(effort: Effort) -> Option<Code> {
        let (opt_level, regalloc_algorithm) = match effort {
            Effort::Best => ("speed", "backtracking"),
            Effort::Quick => ("none", "single_pass"),
        };
        let flags = [
            ("opt_level", opt_level),
            ("regalloc_algorithm", regalloc_algorithm),
            ("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" }),
            ("probestack_strategy", "inline"),
        ];
        cranelift_native::builder().ok()?;
        let builder = JITBuilder::with_flags(&flags, default_libcall_names()).ok()?;
        Some(Code(JITModule::new(builder)))
    }

    /// Adds a function that `translate` writes into the context.
    pub(crate) fn define(
        &mut self,
        name: &str,
        translate: impl FnOnce(TargetFrontendConfig, &mut Context) -> Option<()>,
    ) -> Option<FuncId> {
        let mut context = self.0.make_context();
        translate(self.0.target_config(), &mut context)?;
        let id = self.0.declare_function(name, Linkage::Export, &context.func.signature).ok()?;
        self.0.define_function(id, &mut context).ok()?;
        self.0.clear_context(&mut context);
        Some(id)
    }

    /// The code, which can be run as long as this is kept.
    pub(crate) fn finish(mut self) -> Option<Executable> {
        self.0.finalize_definitions().ok()?;
        Some(Executable(Mutex::new(Some(self.0))))
    }
}

/// Machine code in memory of its own.
pub(crate) struct Executable(Mutex<Option<JITModule>>);

impl Executable {
    /// Where a function begins.
    pub(crate) fn address(&self, id: FuncId) -> Option<*const u8> {
        let module = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        module.as_ref().map(|module| module.get_finalized_function(id))
    }
}

impl Drop for Executable {
    fn drop(&mut self) {
        let module = self.0.get_mut().unwrap_or_else(PoisonError::into_inner);
        if let Some(module) = module.take() {
            // SAFETY: who calls the code keeps this beside its address.
            unsafe { module.free_memory() };
        }
    }
}
