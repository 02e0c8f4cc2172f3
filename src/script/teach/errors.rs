//! What can be wrong with a trace.

use crate::codes;

codes! {
    /// A file is not a trace, or ends before anything was recorded.
    BAD_TRACE = "bad-trace":
        "## What it means\n\n`gapi teach` reads files written by `--trace`. This file has a different format, was written by another version, or contains no generation.\n\n## Example\n\n`gapi teach result.json`\n\n## What to do\n\nRecord the run again with `gapi run SCRIPT --trace FILE`, or pass the script itself to `gapi teach`.",
}
