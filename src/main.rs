//! The command `gapi`.

use mimalloc::MiMalloc;
use std::process::ExitCode;

/// Compiling a model makes and drops millions of small things.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

/// The option `purge_delay` of the allocator, the same number in its versions 2 and 3.
const PURGE_DELAY: libmimalloc_sys::mi_option_t = 15;

/// Freed memory goes back to the system after a second, not after 10 ms: the translation of a large
/// model frees and asks again for hundreds of megabytes, which the system clears each time. Of heat
/// conduction with 50,000 states it took 40 % of the time. And it comes in large pages where the
/// system gives them to those who ask: with 100,000 states the system then takes 0.8 s, not 1.9 s, and
/// no more memory.
#[allow(unsafe_code, reason = "options of the allocator, set before threads begin")]
fn set_up_memory() {
    // SAFETY: the options exist, and nothing but this thread runs yet.
    unsafe {
        libmimalloc_sys::mi_option_set(PURGE_DELAY, 1000);
        libmimalloc_sys::mi_option_set(libmimalloc_sys::mi_option_large_os_pages, 1);
    }
}

fn main() -> ExitCode {
    set_up_memory();
    gapilib::internals::cli::main()
}
