//! Where the shared library of a unit is (FMI 2.0.5 §2.3, FMI 3.0.2 §2.5).

use super::plan::InterfaceKind;
use crate::Description;
use crate::description::{Interface, Version};

/// The folder of binaries for this machine in FMI 2.0, and the ending of libraries.
const PLATFORM_2: &str = if cfg!(target_os = "macos") {
    "darwin64"
} else if cfg!(windows) {
    "win64"
} else {
    "linux64"
};
/// The same in FMI 3.0: architecture and system.
const PLATFORM_3: &str = match (cfg!(target_arch = "aarch64"), cfg!(target_os = "macos")) {
    (true, true) => "aarch64-darwin",
    (false, true) => "x86_64-darwin",
    (true, false) if cfg!(windows) => "aarch64-windows",
    (false, false) if cfg!(windows) => "x86_64-windows",
    (true, false) => "aarch64-linux",
    (false, false) => "x86_64-linux",
};
const ENDING: &str = if cfg!(target_os = "macos") {
    ".dylib"
} else if cfg!(windows) {
    ".dll"
} else {
    ".so"
};

/// What a unit says of a kind.
///
/// # Errors
/// The unit does not have this kind, in one sentence.
pub(super) fn interface(
    description: &Description,
    kind: InterfaceKind,
) -> Result<&Interface, String> {
    let (interface, name) = match kind {
        InterfaceKind::ModelExchange => (&description.model_exchange, "model exchange"),
        InterfaceKind::CoSimulation => (&description.co_simulation, "co-simulation"),
        InterfaceKind::ScheduledExecution => {
            (&description.scheduled_execution, "scheduled execution")
        }
    };
    interface.as_ref().ok_or_else(|| format!("it is not made for {name}"))
}

/// The path of the shared library of a unit within its archive.
///
/// # Errors
/// The unit does not have this kind, in one sentence.
pub fn library_path(description: &Description, kind: InterfaceKind) -> Result<String, String> {
    let identifier = &interface(description, kind)?.model_identifier;
    let platform = match description.version {
        Version::V2 => PLATFORM_2,
        Version::V3 => PLATFORM_3,
    };
    Ok(format!("binaries/{platform}/{identifier}{ENDING}"))
}
