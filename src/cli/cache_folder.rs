//! The user's folder for what can be made again.

use std::fs;
use std::io;
use std::path::PathBuf;

/// The part of the folder for one kind of things; `None` where the user has no such folder.
pub(super) fn of(kind: &str) -> Option<PathBuf> {
    let variable = |name| std::env::var_os(name).map(PathBuf::from).filter(|p| p.is_absolute());
    let base = match () {
        () if cfg!(windows) => variable("LOCALAPPDATA"),
        () => variable("XDG_CACHE_HOME").or_else(|| {
            let home = variable("HOME")?;
            Some(home.join(if cfg!(target_os = "macos") { "Library/Caches" } else { ".cache" }))
        }),
    };
    Some(base?.join("gapi").join(kind))
}

/// The same, made so that nobody else can put anything there.
pub(super) fn made(kind: &str) -> io::Result<PathBuf> {
    let none = || io::Error::new(io::ErrorKind::NotFound, "there is no cache folder");
    let folder = of(kind).ok_or_else(none)?;
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(&folder)?;
    Ok(folder)
}
