//! Reading pipes and devices, as shells make them (`<(…)`, `/dev/stdin`), but not for ever.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, RecvTimeoutError, SyncSender};
use std::time::Duration;

/// How long nothing may come from a pipe or a device.
const PATIENCE: Duration = Duration::from_secs(30);
/// How much may come from one.
const LONGEST: usize = 1 << 30;
/// How much is read at once.
const PIECE: usize = 1 << 16;
/// How many pieces may wait to be taken.
const WAITING: usize = 16;

/// The bytes of a pipe or a device.
///
/// # Errors
/// It cannot be read; nothing comes from it; it does not end.
pub(super) fn read(path: &Path) -> io::Result<Vec<u8>> {
    read_device(path, PATIENCE, LONGEST)
}

/// A thread opens and reads, as both may wait without end; a caller that waits in vain abandons it.
fn read_device(path: &Path, patience: Duration, longest: usize) -> io::Result<Vec<u8>> {
    let (sender, pieces) = mpsc::sync_channel(WAITING);
    let place = path.to_owned();
    std::thread::Builder::new().name("pipe".to_owned()).spawn(move || send(&place, &sender))?;
    let mut bytes = Vec::new();
    loop {
        match pieces.recv_timeout(patience) {
            Ok(piece) => bytes.extend(piece?),
            Err(RecvTimeoutError::Disconnected) => return Ok(bytes),
            Err(RecvTimeoutError::Timeout) => {
                let message = format!("no data arrived for {} s", patience.as_secs_f64());
                return Err(io::Error::new(io::ErrorKind::TimedOut, message));
            }
        }
        if bytes.len() > longest {
            let message = format!("it delivered more than {} MiB", longest >> 20);
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
        }
    }
}

fn send(path: &PathBuf, pieces: &SyncSender<io::Result<Vec<u8>>>) {
    let mut file = match File::open(path) {
        Ok(file) => file,
        Err(error) => return drop(pieces.send(Err(error))),
    };
    loop {
        let mut piece = vec![0; PIECE];
        let read = file.read(&mut piece);
        match read {
            Ok(0) => return,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Ok(count) => {
                piece.truncate(count);
                if pieces.send(Ok(piece)).is_err() {
                    return;
                }
            }
            Err(error) => return drop(pieces.send(Err(error))),
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn endless_and_silent_devices_end() {
        let short = Duration::from_millis(50);
        let endless = read_device(Path::new("/dev/zero"), short, 1 << 20).unwrap_err();
        assert_eq!(endless.to_string(), "it delivered more than 1 MiB");
        assert_eq!(read_device(Path::new("/dev/null"), short, 10).unwrap(), Vec::<u8>::new());
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
        assert!(made.success());
        let silent = read_device(&pipe, short, 10).unwrap_err();
        assert_eq!(silent.to_string(), "no data arrived for 0.05 s");
    }
}
