//! The user's folder for what can be made again, and the key that distinguishes what this program
//! has put there from what others have.
//!
//! Folder and key are used only if they belong to the user and no other user can write them, as ssh
//! and git require it. The key lies in the home folder, not in the cache: a folder of a stranger
//! that becomes the cache (`XDG_CACHE_HOME` below the working folder) brings no entries along that
//! count.

use sha2::{Digest, Sha256};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// Bytes of a key and of a code.
pub(super) const LENGTH: usize = 32;
/// Bytes of a block of SHA-256.
const BLOCK: usize = 64;
const KEY: &str = "cache.key";

fn variable(name: &str) -> Option<PathBuf> {
    std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute())
}

/// The folder for all kinds, which may not exist yet.
pub(super) fn base() -> Option<PathBuf> {
    let base = match () {
        () if cfg!(windows) => variable("LOCALAPPDATA"),
        () => variable("XDG_CACHE_HOME").or_else(|| {
            let home = variable("HOME")?;
            Some(home.join(if cfg!(target_os = "macos") { "Library/Caches" } else { ".cache" }))
        }),
    };
    Some(base?.join("gapi"))
}

/// The folder that the key is in.
fn key_folder() -> Option<PathBuf> {
    let folder = match () {
        () if cfg!(windows) => variable("APPDATA")?,
        () if cfg!(target_os = "macos") => variable("HOME")?.join("Library/Application Support"),
        () => variable("HOME")?.join(".local/state"),
    };
    Some(folder.join("gapi"))
}

/// The folders that are closed to scripts and models.
pub(super) fn closed() -> impl Iterator<Item = PathBuf> {
    base().into_iter().chain(key_folder())
}

/// The part of the folder for one kind of things; `None` where the user has no such folder, or where
/// others can write it.
pub(super) fn of(kind: &str) -> Option<PathBuf> {
    let base = base()?;
    let folder = base.join(kind);
    (is_private(&base) && is_private(&folder)).then_some(folder)
}

/// The same, created so that no other user can put anything there.
///
/// # Errors
/// There is no such folder, it cannot be made, or others can write it.
pub(super) fn made(kind: &str) -> io::Result<PathBuf> {
    let none = || io::Error::new(io::ErrorKind::NotFound, "there is no cache folder");
    let folder = base().ok_or_else(none)?.join(kind);
    make(&folder)?;
    of(kind).ok_or_else(|| {
        let message = format!(
            "`{}` is a link, belongs to another user, or others can write it",
            folder.display()
        );
        io::Error::new(io::ErrorKind::PermissionDenied, message)
    })
}

fn make(folder: &Path) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}

/// Whether a folder is not a link and belongs to the user, and no other user can write it.
#[cfg(unix)]
fn is_private(folder: &Path) -> bool {
    fs::symlink_metadata(folder).is_ok_and(|found| found.is_dir() && is_of_user(&found, 0o022))
}

#[cfg(not(unix))]
fn is_private(folder: &Path) -> bool {
    fs::symlink_metadata(folder).is_ok_and(|found| found.is_dir())
}

/// Whether it belongs to the user and gives others none of these rights.
#[cfg(unix)]
fn is_of_user(found: &fs::Metadata, rights: u32) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    found.uid() == rustix::process::geteuid().as_raw() && found.mode() & rights == 0
}

/// The code by which an entry of the cache is known: HMAC-SHA-256 (RFC 2104) with the user's key, of
/// the name and the content of the entry. `None` where there is no key that only the user can read.
pub(super) fn code(name: &str, content: &[u8]) -> Option<[u8; LENGTH]> {
    static KEY: LazyLock<Option<[u8; LENGTH]>> = LazyLock::new(|| key().ok());
    let key = (*KEY)?;
    let padded = |pad: u8| {
        let mut block = [pad; BLOCK];
        key.iter().zip(&mut block).for_each(|(byte, place)| *place ^= byte);
        block
    };
    let inner = Sha256::new()
        .chain_update(padded(0x36))
        .chain_update((name.len() as u64).to_le_bytes())
        .chain_update(name)
        .chain_update(content)
        .finalize();
    Some(Sha256::new().chain_update(padded(0x5c)).chain_update(inner).finalize().into())
}

/// The key of the user, made when it is first needed.
fn key() -> io::Result<[u8; LENGTH]> {
    let folder = key_folder().ok_or(io::ErrorKind::NotFound)?;
    let path = folder.join(KEY);
    let mut key = [0; LENGTH];
    match opened(&path) {
        Ok(mut file) => file.read_exact(&mut key)?,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            make(&folder)?;
            key = random()?;
            let mut options = OpenOptions::new();
            options.write(true).create_new(true);
            #[cfg(unix)]
            std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
            options.open(&path)?.write_all(&key)?;
        }
        Err(error) => return Err(error),
    }
    Ok(key)
}

/// The key, if it is a file that no other user can read.
#[cfg(unix)]
fn opened(path: &Path) -> io::Result<File> {
    use rustix::fs::OFlags;
    use std::os::unix::fs::{MetadataExt as _, OpenOptionsExt as _};
    let flags = (OFlags::NOFOLLOW | OFlags::NONBLOCK).bits();
    let file = OpenOptions::new().read(true).custom_flags(flags as i32).open(path)?;
    let found = file.metadata()?;
    match found.is_file() && found.nlink() == 1 && is_of_user(&found, 0o077) {
        true => Ok(file),
        false => Err(io::ErrorKind::PermissionDenied.into()),
    }
}

#[cfg(not(unix))]
fn opened(path: &Path) -> io::Result<File> {
    File::open(path)
}

#[cfg(unix)]
fn random() -> io::Result<[u8; LENGTH]> {
    let mut bytes = [0; LENGTH];
    File::open("/dev/urandom")?.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// The standard library takes the keys of its hashes from the system.
#[cfg(not(unix))]
fn random() -> io::Result<[u8; LENGTH]> {
    use std::hash::{BuildHasher as _, RandomState};
    let mut digest = Sha256::new();
    for number in 0..LENGTH {
        digest.update(RandomState::new().hash_one(number).to_le_bytes());
    }
    Ok(digest.finalize().into())
}
