//! What can be wrong with a picture.

use crate::codes;

codes! {
    /// A picture in a format that is not written.
    UNKNOWN_PICTURE = "unknown-picture":
        "## What it means\n\nPictures are written as SVG, PNG or PDF, and the ending of the file name says which. This name has another ending, or none.\n\n## Example\n\n`gapi simulate M.mo --plot x --figure x.jpg`\n\n## What to do\n\nEnd the name in `.svg`, `.png` or `.pdf`.",
}
