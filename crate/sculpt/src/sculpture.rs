//! Sculpture: clay, the strokes that made it, and undo.

use crate::clay::Clay;
use crate::delta::Delta;
use crate::drag::Drag;
use crate::error::Error;
use crate::limits::{MAX_UNDO, MAX_WORK};
use crate::perform::{Loader, carry_out};
use crate::script::{Diagnostic, Script};
use crate::stroke::{PathPoint, Stroke, Sweep};

/// Clay with the strokes that made it of its start. All strokes can be undone: what was changed is
/// kept, and where that would take too much memory, the strokes before are replayed.
///
/// ```
/// use sculpt::{Script, Sculpture};
///
/// let script: Script = "strokes 1\nstart sphere 4\npush sphere 0.5 0.5 0.5 : 1.2 0 0\n".parse()?;
/// let mut sculpture = Sculpture::open(&script, &mut |name| Err(format!("no {name}")))?;
/// let pushed = sculpture.clay().digest();
/// sculpture.undo()?;
/// assert_ne!(sculpture.clay().digest(), pushed);
/// sculpture.redo()?;
/// assert_eq!(sculpture.clay().digest(), pushed);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Sculpture {
    clay: Clay,
    start: Clay,
    done: Vec<Done>,
    undone: Vec<Done>,
    drag: Option<(Drag<'static>, Sweep)>,
    /// Bytes of all changes that are kept, and how many bytes they may take.
    bytes: usize,
    most_bytes: usize,
}

/// Stroke, and what it changed if that is kept.
struct Done {
    stroke: Stroke,
    delta: Option<Delta>,
}

impl Sculpture {
    /// Returns a sculpture of clay without strokes.
    #[must_use]
    pub fn new(clay: Clay) -> Self {
        Self {
            start: clay.clone(),
            clay,
            done: Vec::new(),
            undone: Vec::new(),
            drag: None,
            bytes: 0,
            most_bytes: MAX_UNDO,
        }
    }

    /// Carries out all strokes of a text.
    ///
    /// # Errors
    /// At the line that cannot be carried out.
    pub fn open(script: &Script, load: Loader<'_>) -> Result<Self, Diagnostic> {
        let start = script.begin(load)?;
        let mut sculpture = Self::new(start);
        for (i, stroke) in script.strokes.iter().enumerate() {
            sculpture
                .carry_out(stroke.clone())
                .map_err(|error| script.at(i, &error))?;
        }
        Ok(sculpture)
    }

    /// Limits the bytes that changes may take; older strokes are then undone by replaying.
    pub fn limit_undo(&mut self, bytes: usize) {
        self.most_bytes = bytes;
        self.forget();
    }

    /// The clay now.
    #[must_use]
    pub fn clay(&self) -> &Clay {
        &self.clay
    }

    /// The strokes that were carried out.
    pub fn strokes(&self) -> impl Iterator<Item = &Stroke> {
        self.done.iter().map(|done| &done.stroke)
    }

    /// Returns the numbers of strokes that can be undone and redone.
    #[must_use]
    pub fn depth(&self) -> [usize; 2] {
        [self.done.len(), self.undone.len()]
    }

    /// Carries out a stroke. Strokes that were undone are forgotten.
    ///
    /// # Errors
    /// If it cannot be carried out; then all is as it was before.
    pub fn carry_out(&mut self, stroke: Stroke) -> Result<(), Error> {
        self.end_drag();
        let delta = carry_out(&mut self.clay, &stroke, MAX_WORK)?;
        self.keep(stroke, delta);
        Ok(())
    }

    /// Begins a stroke of a tool whose path is still to come.
    pub fn begin_drag(&mut self, sweep: Sweep) {
        self.end_drag();
        let drag = Drag::new(&self.clay, &sweep);
        let path = Vec::new();
        self.drag = Some((drag, Sweep { path, ..sweep }));
    }

    /// Moves the tool of the stroke that was begun.
    pub fn drag_to(&mut self, point: PathPoint) {
        if let Some((drag, sweep)) = &mut self.drag {
            drag.step(&mut self.clay, point);
            sweep.path.push(point);
        }
    }

    /// Ends the stroke that was begun, and returns it if its path is not empty.
    pub fn end_drag(&mut self) -> Option<&Stroke> {
        let (drag, sweep) = self.drag.take()?;
        let delta = drag.end(&mut self.clay);
        if sweep.path.is_empty() {
            return None;
        }
        self.keep(Stroke::Sweep(sweep), delta);
        self.done.last().map(|done| &done.stroke)
    }

    /// Takes the last stroke back, and returns it; `None` if there is none.
    ///
    /// # Errors
    /// If strokes before had to be replayed and one of them failed, which it did not the first
    /// time.
    pub fn undo(&mut self) -> Result<Option<&Stroke>, Error> {
        self.end_drag();
        let Some(mut done) = self.done.pop() else {
            return Ok(None);
        };
        match &mut done.delta {
            Some(delta) => {
                self.bytes = self.bytes.saturating_sub(delta.bytes());
                delta.swap(&mut self.clay);
            }
            None => self.replay()?,
        }
        self.undone.push(done);
        Ok(self.undone.last().map(|done| &done.stroke))
    }

    /// Carries out the stroke again that was last undone, and returns it; `None` if there is none.
    ///
    /// # Errors
    /// If it cannot be carried out, which it could the first time.
    pub fn redo(&mut self) -> Result<Option<&Stroke>, Error> {
        let Some(mut done) = self.undone.pop() else {
            return Ok(None);
        };
        match &mut done.delta {
            Some(delta) => delta.swap(&mut self.clay),
            None => done.delta = Some(carry_out(&mut self.clay, &done.stroke, MAX_WORK)?),
        }
        self.bytes += done.delta.as_ref().map_or(0, Delta::bytes);
        self.done.push(done);
        self.forget();
        Ok(self.done.last().map(|done| &done.stroke))
    }

    /// Forgets the strokes that were undone.
    pub fn forget_undone(&mut self) {
        self.undone.clear();
    }

    fn replay(&mut self) -> Result<(), Error> {
        self.clay = self.start.clone();
        for done in &self.done {
            carry_out(&mut self.clay, &done.stroke, MAX_WORK)?;
        }
        Ok(())
    }

    fn keep(&mut self, stroke: Stroke, delta: Delta) {
        self.undone.clear();
        self.bytes += delta.bytes();
        let delta = Some(delta);
        self.done.push(Done { stroke, delta });
        self.forget();
    }

    /// Drops the oldest changes while all take too much.
    fn forget(&mut self) {
        let mut i = self.done.partition_point(|done| done.delta.is_none());
        while self.bytes > self.most_bytes && i < self.done.len() {
            if let Some(delta) = self.done[i].delta.take() {
                self.bytes = self.bytes.saturating_sub(delta.bytes());
            }
            i += 1;
        }
    }
}

/// Carries out all strokes of a text without keeping what they change. `each` is called after every
/// stroke with its index. Strokes may visit `most_work` vertices together; [`MAX_WORK`] is about a
/// minute or two.
///
/// # Errors
/// At the line that cannot be carried out, or at which it becomes too much work.
pub fn replay(
    script: &Script,
    load: Loader<'_>,
    most_work: u64,
    mut each: impl FnMut(usize, &Stroke, &Clay),
) -> Result<Clay, Diagnostic> {
    let mut clay = script.begin(load)?;
    for (i, stroke) in script.strokes.iter().enumerate() {
        carry_out(&mut clay, stroke, most_work).map_err(|error| script.at(i, &error))?;
        each(i, stroke, &clay);
    }
    Ok(clay)
}
