//! The command `gapi`.

fn main() {}
