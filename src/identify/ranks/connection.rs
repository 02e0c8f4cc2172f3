//! What passes messages between processes.

/// Passes messages between processes, which are numbered from 0.
pub trait Connection: Send + Sync {
    /// Number of processes.
    fn size(&self) -> usize;
    /// Sends a message; returns when the bytes may be reused. Messages between two processes arrive
    /// in their order.
    fn send(&self, rank: usize, message: &[u8]);
    /// The next message that has arrived, written over `message`, and who sent it.
    fn receive(&self, message: &mut Vec<u8>) -> Option<usize>;
    /// Seconds since an arbitrary moment.
    fn seconds(&self) -> f64;
}
