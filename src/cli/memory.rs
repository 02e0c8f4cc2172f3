//! The memory of the machine and what this process has of it, as Linux tells.

use std::fs::read_to_string;

/// Memory limits of the control group that the process runs in, as containers and schedulers of
/// clusters set them: version 2 and version 1.
const GROUPS: [&str; 2] =
    ["/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"];

/// Resident memory of this process in MiB.
pub(super) fn taken() -> Option<u64> {
    kibibytes("/proc/self/status", "VmRSS:").map(|kib| kib / 1024)
}

/// Three quarters of the memory that there is, in MiB: before the machine begins to swap, or the
/// system ends processes of its choice.
pub(super) fn default_limit() -> Option<u32> {
    let machine = kibibytes("/proc/meminfo", "MemTotal:")? / 1024;
    let groups = GROUPS.iter().filter_map(|file| read_to_string(file).ok()?.trim().parse().ok());
    let least = groups.map(|bytes: u64| bytes >> 20).fold(machine, u64::min);
    u32::try_from(least / 4 * 3).ok().filter(|limit| *limit > 0)
}

fn kibibytes(file: &str, label: &str) -> Option<u64> {
    let text = read_to_string(file).ok()?;
    let line = text.lines().find(|line| line.starts_with(label))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
