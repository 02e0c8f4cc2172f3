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

/// What is wrong with the bytes of a shared library for this machine, as the end of a sentence; `None`
/// where nothing is, or the format of the system is not known here (that of Linux is, ELF).
pub fn unusable(library: &[u8]) -> Option<String> {
    if !cfg!(target_os = "linux") {
        return None;
    }
    if !library.starts_with(b"\x7fELF") {
        return Some("is not a shared library of Linux".to_owned());
    }
    let at = |begin: usize, count: usize| -> Option<u64> {
        let bytes = library.get(begin..begin + count)?;
        Some(bytes.iter().rev().fold(0, |value, byte| value << 8 | u64::from(*byte)))
    };
    let own = if cfg!(target_arch = "aarch64") { AARCH64 } else { X86_64 };
    match (at(4, 1), at(18, 2)) {
        (Some(2), Some(machine)) if machine == own.0 => {}
        (_, Some(machine)) => {
            let known = [X86_64, AARCH64, X86].into_iter().find(|one| one.0 == machine);
            let other = known.map_or("another processor", |one| one.1);
            return Some(format!("is for {other}, not for {}", own.1));
        }
        _ => return Some("is incomplete".to_owned()),
    }
    // The table of sections stands at the end.
    let table = at(40, 8).zip(at(58, 2)).zip(at(60, 2));
    let end = table.map(|((begin, size), count)| begin.saturating_add(size * count));
    let length = library.len() as u64;
    match end {
        Some(end) if end <= length => None,
        Some(end) => Some(format!("is incomplete: it ends after {length} of {end} bytes")),
        None => Some("is incomplete".to_owned()),
    }
}

/// Processors by their numbers in ELF.
const X86: (u64, &str) = (3, "x86");
const X86_64: (u64, &str) = (62, "x86_64");
const AARCH64: (u64, &str) = (183, "aarch64");

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::unusable;

    #[test]
    fn libraries_of_others_and_parts_of_libraries_are_not_usable() {
        let own = std::fs::read(std::env::current_exe().expect("a path")).expect("readable");
        assert_eq!(unusable(&own), None);
        let part = unusable(&own[..own.len() / 2]).expect("incomplete");
        assert!(part.contains("is incomplete: it ends after"), "{part}");
        assert_eq!(unusable(&own[..10]).as_deref(), Some("is incomplete"));
        assert_eq!(unusable(b"text").as_deref(), Some("is not a shared library of Linux"));
        let mut other = own;
        other[18..20].copy_from_slice(&[40, 0]);
        let other = unusable(&other).expect("another one");
        assert!(other.starts_with("is for another processor, not for "), "{other}");
    }
}
