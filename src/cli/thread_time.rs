//! The CPU time of a thread, which other work on the machine does not lengthen.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Measures the CPU time of the thread that it began on; on systems that do not tell it, the time
/// since then.
pub(super) struct ThreadTime {
    began: Instant,
    /// Where Linux writes how many nanoseconds the thread has run.
    statistics: Option<PathBuf>,
}

impl ThreadTime {
    /// Begins on this thread.
    pub(super) fn of_this_thread() -> ThreadTime {
        let thread = fs::read_link("/proc/thread-self").ok();
        let statistics = thread.map(|thread| Path::new("/proc").join(thread).join("schedstat"));
        let statistics = statistics.filter(|path| nanoseconds(path).is_some());
        ThreadTime { began: Instant::now(), statistics }
    }

    /// The time until now; asked from any thread.
    pub(super) fn elapsed(&self) -> Duration {
        let known = self.statistics.as_deref().and_then(nanoseconds);
        known.map_or_else(|| self.began.elapsed(), Duration::from_nanos)
    }
}

fn nanoseconds(statistics: &Path) -> Option<u64> {
    fs::read_to_string(statistics).ok()?.split_whitespace().next()?.parse().ok()
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::sync::mpsc;
    use std::thread;

    #[test]
    fn waiting_takes_no_time_and_working_does() {
        let (give, given) = mpsc::channel();
        let (begin, begun) = mpsc::channel::<()>();
        let worker = thread::spawn(move || {
            give.send(ThreadTime::of_this_thread()).unwrap();
            begun.recv().unwrap();
            let time = ThreadTime::of_this_thread();
            let before = time.elapsed();
            // Without an end if the clock stands still.
            while time.elapsed() < before + Duration::from_millis(30) {}
        });
        let time: ThreadTime = given.recv().unwrap();
        if time.statistics.is_none() {
            return;
        }
        thread::sleep(Duration::from_millis(200));
        assert!(time.elapsed() < Duration::from_millis(100), "{:?}", time.elapsed());
        begin.send(()).unwrap();
        worker.join().unwrap();
    }
}
