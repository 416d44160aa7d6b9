//! The interface between a pool's decisions and its workers.

/// Starts workers, ends them and sends to them. Their answers go to the pool's core with the worker's index.
pub trait Workers {
    /// Starts a worker and ends the one that had this index, of which no answer may be passed on after that.
    ///
    /// # Errors
    /// Says why no worker can be started.
    fn restart(&mut self, index: usize) -> Result<(), String>;
    /// Ends a worker.
    fn end(&mut self, index: usize);
    /// Sends a packed request to a running worker.
    fn send(&mut self, index: usize, request: &[u8]);
}
