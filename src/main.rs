//! The command `gapi`.

use std::process::ExitCode;

fn main() -> ExitCode {
    gapilib::cli::main()
}
