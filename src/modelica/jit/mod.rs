//! Machine code, for [`bytecode`](crate::bytecode) and [`codegen`](crate::codegen): there is none where
//! the feature `jit` is left out.

#[cfg(feature = "jit")]
mod cranelift;
#[cfg(not(feature = "jit"))]
#[path = "without_cranelift.rs"]
mod cranelift;

pub(crate) use cranelift::*;
