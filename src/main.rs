//! The command `gapi`.

use mimalloc::MiMalloc;
use std::process::ExitCode;

/// Compiling a model makes and drops millions of small things.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    gapilib::cli::main()
}
