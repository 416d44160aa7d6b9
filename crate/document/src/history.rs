//! Undo and redo as a list of snapshots.
//!
//! Edits that follow each other within [`QUIET`] seconds make one step, and so do all edits between
//! [`History::hold`] and [`History::release`], so that typing a word or dragging a slider is undone
//! at once. Memory is bounded by [`MAX_STEPS`] and [`MAX_BYTES`]: the oldest steps are forgotten.

use serde::{Deserialize, Serialize};

/// Edits less than this many seconds apart belong to one step.
pub const QUIET: f64 = 0.5;
/// Steps kept.
pub const MAX_STEPS: usize = 300;
/// Bytes kept, as [`Snapshot::bytes`] counts them.
pub const MAX_BYTES: usize = 16 << 20;

/// Something that can be put back.
pub trait Snapshot: Clone + PartialEq {
    /// Returns about how many bytes of memory it takes.
    fn bytes(&self) -> usize;
}

/// The steps that can be undone and redone. The present state itself is kept by the owner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct History<T> {
    past: Vec<T>,
    future: Vec<T>,
    /// Time of the last edit of the step that is still open, seconds.
    #[serde(skip)]
    open: Option<f64>,
    #[serde(skip)]
    held: bool,
}

impl<T> Default for History<T> {
    fn default() -> Self {
        Self {
            past: Vec::new(),
            future: Vec::new(),
            open: None,
            held: false,
        }
    }
}

impl<T: Snapshot> History<T> {
    /// Notes that the state is about to change from `before`, at the time `now` in seconds.
    pub fn record(&mut self, before: &T, now: f64) {
        let continues = self
            .open
            .is_some_and(|last| self.held || now - last < QUIET);
        if !continues {
            self.past.push(before.clone());
            self.forget();
        }
        self.future.clear();
        self.open = Some(now);
    }

    /// Makes all edits until [`History::release`] one step, which starts with the next edit.
    pub fn hold(&mut self) {
        if !self.held {
            self.open = None;
            self.held = true;
        }
    }

    /// Ends the step that [`History::hold`] began.
    pub fn release(&mut self) {
        if self.held {
            self.held = false;
            self.open = None;
        }
    }

    /// Ends the step, so that the next edit starts a new one, however soon it comes.
    pub fn close(&mut self) {
        self.open = None;
    }

    /// Goes one step back. Returns the state to put in place of `present`.
    pub fn undo(&mut self, present: &T) -> Option<T> {
        Self::step(&mut self.past, &mut self.future, &mut self.open, present)
    }

    /// Goes one step forward again after [`History::undo`].
    pub fn redo(&mut self, present: &T) -> Option<T> {
        Self::step(&mut self.future, &mut self.past, &mut self.open, present)
    }

    /// Returns the states that [`History::undo`] and [`History::redo`] would go to.
    #[must_use]
    pub fn next(&self) -> [Option<&T>; 2] {
        [self.past.last(), self.future.last()]
    }

    /// Whether there is a step to undo.
    #[must_use]
    pub fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    /// Whether there is a step to redo.
    #[must_use]
    pub fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }

    /// Returns a copy of at most `bytes` to store: the steps nearest to the present.
    #[must_use]
    pub fn within(&self, bytes: usize) -> Self {
        let mut left = bytes;
        let mut nearest = |steps: &[T]| -> Vec<T> {
            let kept = steps
                .iter()
                .rev()
                .take_while(|step| {
                    let fits = step.bytes() <= left;
                    left = left.saturating_sub(step.bytes());
                    fits
                })
                .count();
            steps[steps.len() - kept..].to_vec()
        };
        Self {
            past: nearest(&self.past),
            future: nearest(&self.future),
            open: None,
            held: false,
        }
    }

    fn step(from: &mut Vec<T>, to: &mut Vec<T>, open: &mut Option<f64>, present: &T) -> Option<T> {
        *open = None;
        // A step that changed nothing (typed and deleted again) is passed over.
        while let Some(state) = from.pop() {
            if state != *present {
                to.push(present.clone());
                return Some(state);
            }
        }
        None
    }

    fn forget(&mut self) {
        let mut bytes: usize = self.past.iter().map(Snapshot::bytes).sum();
        let mut drop = 0;
        while self.past.len() - drop > 1
            && (self.past.len() - drop > MAX_STEPS || bytes > MAX_BYTES)
        {
            bytes -= self.past[drop].bytes();
            drop += 1;
        }
        self.past.drain(..drop);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Snapshot for String {
        fn bytes(&self) -> usize {
            self.len()
        }
    }

    fn edit(history: &mut History<String>, text: &mut String, to: &str, now: f64) {
        history.record(text, now);
        *text = to.to_owned();
    }

    #[test]
    fn quick_edits_are_one_step() {
        let (mut history, mut text) = (History::default(), String::new());
        edit(&mut history, &mut text, "a", 0.0);
        edit(&mut history, &mut text, "ab", 0.3);
        edit(&mut history, &mut text, "ab c", 2.0);
        text = history.undo(&text).unwrap();
        assert_eq!(text, "ab");
        text = history.undo(&text).unwrap();
        assert_eq!(text, "");
        assert!(!history.can_undo());
        text = history.redo(&text).unwrap();
        text = history.redo(&text).unwrap();
        assert_eq!(text, "ab c");
        assert!(!history.can_redo());
    }

    #[test]
    fn an_edit_after_undo_forgets_the_future() {
        let (mut history, mut text) = (History::default(), String::from("a"));
        edit(&mut history, &mut text, "b", 0.0);
        text = history.undo(&text).unwrap();
        edit(&mut history, &mut text, "c", 9.0);
        assert!(!history.can_redo());
        assert_eq!(history.undo(&text).as_deref(), Some("a"));
    }

    #[test]
    fn a_held_gesture_is_one_step_and_ends_the_step_before() {
        let (mut history, mut text) = (History::default(), String::from("0"));
        edit(&mut history, &mut text, "1", 0.0);
        history.hold();
        for i in 2..50 {
            edit(&mut history, &mut text, &i.to_string(), f64::from(i));
        }
        history.release();
        edit(&mut history, &mut text, "x", 49.1);
        text = history.undo(&text).unwrap();
        assert_eq!(text, "49");
        text = history.undo(&text).unwrap();
        assert_eq!(text, "1");
        assert_eq!(history.undo(&text).as_deref(), Some("0"));
    }

    #[test]
    fn memory_is_bounded() {
        let (mut history, mut text) = (History::default(), String::new());
        for i in 0..2 * MAX_STEPS {
            edit(&mut history, &mut text, &i.to_string(), i as f64);
        }
        assert_eq!(history.past.len(), MAX_STEPS);
        let big = "x".repeat(MAX_BYTES / 2 - 1);
        for i in 0..4 {
            edit(
                &mut history,
                &mut text,
                &format!("{i}{big}"),
                1e4 + f64::from(i),
            );
        }
        assert!(history.past.iter().map(String::len).sum::<usize>() <= MAX_BYTES);
        assert!(history.within(100).past.is_empty());
    }
}
