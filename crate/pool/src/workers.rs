//! The interface between decisions and the workers that carry them out.

/// Starts workers, ends them and sends to them. Their messages go to the manager, with the worker's
/// index.
pub trait Workers {
    /// Starts a worker and ends the one that had this index, of which no message may be passed on
    /// after that.
    ///
    /// # Errors
    /// Says why no worker can be started.
    fn restart(&mut self, index: usize) -> Result<(), String>;
    /// Ends a worker.
    fn end(&mut self, index: usize);
    /// Sends a packed request to a running worker.
    fn send(&mut self, index: usize, request: &[u8]);
}

/// A message of a worker.
#[derive(Debug)]
pub enum Message {
    /// The bytes it sent.
    Bytes(Vec<u8>),
    /// The reason for which it cannot continue.
    Failed(String),
}

/// Decides what the workers of a crew do.
pub trait Manager: 'static {
    /// The workers: threads, or those of the web.
    type Workers: Workers;

    /// Returns the workers.
    fn workers(&mut self) -> &mut Self::Workers;
    /// Notes that workers can be started from now on, or why their program could not be loaded.
    fn note_program(&mut self, outcome: Result<(), String>, now: f64);
    /// Takes a worker's message. Returns whether the app should draw.
    fn receive(&mut self, index: usize, message: Message, now: f64) -> bool;
    /// Notes that time has passed. Returns whether the app should draw.
    fn tick(&mut self, now: f64) -> bool;
    /// Whether [`Manager::tick`] must be called from time to time.
    fn is_busy(&self) -> bool;
}
