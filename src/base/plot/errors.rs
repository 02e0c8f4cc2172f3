//! What can be wrong with a picture.

use crate::codes;

codes! {
    /// A picture in a format that is not written.
    UNKNOWN_PICTURE = "unknown-picture":
        "## What it means\n\nFigures are written as SVG, PNG or PDF, selected by the file extension. This name has a different extension, or none.\n\n## Example\n\n`gapi simulate M.mo --plot x --figure x.jpg`\n\n## What to do\n\nUse the extension `.svg`, `.png` or `.pdf`.",
}
