//! A text of strokes, and the mesh that they make.

use sculpt::{Clay, Loader, PathPoint, Script, Sculpture, Stroke, Sweep};

/// A text of strokes that is worked on. Remarks and blank lines of the text stay where they are.
pub struct Document {
    /// The lines before the first stroke.
    head: String,
    /// The lines of each stroke, with the remarks before it.
    lines: Vec<String>,
    /// The lines of each stroke that was undone; redoing takes the last one first.
    undone: Vec<String>,
    /// The lines after the last stroke of the text that was opened.
    tail: String,
    sculpture: Sculpture,
    /// Rises with every change of the mesh.
    revision: u64,
    /// Rises with every change of its elements or its region.
    topology: u64,
}

impl Document {
    /// Carries out the strokes of a text.
    ///
    /// # Errors
    /// If the text is wrong; the message names the line.
    pub fn open(text: &str, load: Loader<'_>) -> Result<Self, String> {
        let script: Script = text
            .parse()
            .map_err(|error: sculpt::Diagnostic| error.to_string())?;
        let sculpture = Sculpture::open(&script, load).map_err(|error| error.to_string())?;
        let mut rest = text.split_inclusive('\n');
        let mut done = script.start_line();
        let head = take(&mut rest, done);
        let mut lines = Vec::with_capacity(script.strokes.len());
        for stroke in 0..script.strokes.len() {
            let line = script.line(stroke);
            lines.push(take(&mut rest, line.saturating_sub(done)));
            done = line;
        }
        let tail = take(&mut rest, usize::MAX);
        Ok(Self {
            head,
            lines,
            undone: Vec::new(),
            tail,
            sculpture,
            revision: 0,
            topology: 0,
        })
    }

    /// The text as it is now.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = self.head.clone();
        text.extend(self.lines.iter().map(String::as_str));
        text + &self.tail
    }

    /// The mesh as it is now.
    #[must_use]
    pub fn clay(&self) -> &Clay {
        self.sculpture.clay()
    }

    /// Rises with every change of the mesh.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Rises where its elements or its region may have changed.
    #[must_use]
    pub fn topology(&self) -> u64 {
        self.topology
    }

    /// Returns the numbers of strokes that can be undone and redone.
    #[must_use]
    pub fn depth(&self) -> [usize; 2] {
        self.sculpture.depth()
    }

    /// The names of the stages, with the number of strokes up to each.
    #[must_use]
    pub fn stages(&self) -> Vec<(String, usize)> {
        let all = (1..).zip(self.sculpture.strokes());
        let stages = all.filter_map(|(count, stroke)| match stroke {
            Stroke::Stage(name) => Some((name.clone(), count)),
            _ => None,
        });
        stages.collect()
    }

    /// Carries out a stroke, and writes it.
    ///
    /// # Errors
    /// If it cannot be carried out; then nothing changes.
    pub fn carry_out(&mut self, stroke: Stroke) -> Result<(), String> {
        let line = format!("{stroke}\n");
        self.sculpture
            .carry_out(stroke)
            .map_err(|error| error.to_string())?;
        self.wrote(line);
        Ok(())
    }

    /// Begins a stroke of a tool.
    pub fn begin(&mut self, sweep: Sweep) {
        self.sculpture.begin_drag(sweep);
    }

    /// Moves the tool of the stroke that was begun.
    pub fn drag(&mut self, point: PathPoint) {
        self.sculpture.drag_to(point);
        self.revision += 1;
    }

    /// Ends the stroke that was begun, and writes it. Returns whether there was one.
    pub fn end(&mut self) -> bool {
        let Some(line) = self
            .sculpture
            .end_drag()
            .map(|stroke| format!("{stroke}\n"))
        else {
            return false;
        };
        self.wrote(line);
        true
    }

    /// Gives the stroke up that was begun, as if it had never been.
    pub fn cancel(&mut self) {
        if self.end() {
            // Earlier undone steps are gone, and no redo brings this one back.
            let _ = self.undo();
            self.undone.clear();
            self.sculpture.forget_undone();
        }
    }

    fn wrote(&mut self, line: String) {
        // Remarks at the end stay where they are, before what is new.
        let remarks = core::mem::take(&mut self.tail);
        let before = self.lines.last_mut().unwrap_or(&mut self.head);
        before.push_str(&remarks);
        if !before.ends_with('\n') {
            before.push('\n');
        }
        self.lines.push(line);
        self.undone.clear();
        self.revision += 1;
        self.topology += 1;
    }

    /// Takes the last stroke back; returns whether there was one.
    ///
    /// # Errors
    /// If strokes before had to be carried out again and one of them failed, which it did not the
    /// first time.
    pub fn undo(&mut self) -> Result<bool, String> {
        self.end();
        let is_undone = self
            .sculpture
            .undo()
            .map_err(|error| error.to_string())?
            .is_some();
        if is_undone {
            self.undone.extend(self.lines.pop());
            self.revision += 1;
            self.topology += 1;
        }
        Ok(is_undone)
    }

    /// Carries out the stroke again that was last undone; returns whether there was one.
    ///
    /// # Errors
    /// If it cannot be carried out, which it could the first time.
    pub fn redo(&mut self) -> Result<bool, String> {
        self.end();
        let is_redone = self
            .sculpture
            .redo()
            .map_err(|error| error.to_string())?
            .is_some();
        if is_redone {
            self.lines.extend(self.undone.pop());
            self.revision += 1;
            self.topology += 1;
        }
        Ok(is_redone)
    }

    /// Undoes or redoes until so many strokes are carried out, as far as there are any.
    ///
    /// # Errors
    /// Fails as [`Document::undo`] and [`Document::redo`] do.
    pub fn go_to(&mut self, strokes: usize) -> Result<(), String> {
        while self.depth()[0] > strokes && self.undo()? {}
        while self.depth()[0] < strokes && self.redo()? {}
        Ok(())
    }
}

/// Takes the next `count` lines of a text, the last of them ended.
fn take<'t>(rest: &mut impl Iterator<Item = &'t str>, count: usize) -> String {
    let mut lines: String = rest.take(count).collect();
    if !lines.is_empty() && !lines.ends_with('\n') {
        lines.push('\n');
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use sculpt::{Action, Form, Tool};

    const TEXT: &str = "# a horned ball\nstrokes 1\n\nstart sphere 4 # round\n# up\n\
        pull sphere 0.3 0.3 0.3 bell 0.5 : 0 0 1, 0 0 1.5\nstage horn\nloop\n# the end\n";

    fn open(text: &str) -> Document {
        Document::open(text, &mut |name| Err(format!("no {name}"))).expect("a text of strokes")
    }

    #[test]
    fn text_stays_as_it_was_written_and_undo_takes_lines_away() {
        let mut document = open(TEXT);
        assert_eq!(document.text(), TEXT);
        assert_eq!(document.stages(), [(String::from("horn"), 2)]);
        let first = document.clay().digest();
        document.undo().unwrap();
        let shorter = document.text();
        assert!(shorter.ends_with("stage horn\n# the end\n"), "{shorter}");
        assert_eq!(open(&shorter).clay().digest(), document.clay().digest());
        document.go_to(0).unwrap();
        assert_eq!(
            document.text(),
            "# a horned ball\nstrokes 1\n\nstart sphere 4 # round\n# the end\n"
        );
        document.go_to(3).unwrap();
        assert_eq!(
            (document.text(), document.clay().digest()),
            (TEXT.to_owned(), first)
        );
    }

    #[test]
    fn strokes_of_the_hand_are_written_so_that_they_make_the_same_mesh() {
        let mut document = open(TEXT);
        let mut sweep = Sweep::new(Action::Push, Tool::new(Form::Sphere, DVec3::splat(0.25)));
        sweep.range = 0.2;
        document.begin(sweep.clone());
        for x in 0..5 {
            let mut point = PathPoint::new(DVec3::new(0.1 * f64::from(x), -1.0, 0.1));
            point.pressure = 0.2 * f64::from(x);
            document.drag(point);
        }
        assert!(document.end());
        let again = open(&document.text());
        assert_eq!(again.clay().digest(), document.clay().digest());
        assert!(document.text().contains("# the end\npush sphere"));
        // Giving up leaves nothing.
        let (text, digest) = (document.text(), document.clay().digest());
        document.begin(sweep);
        document.drag(PathPoint::new(DVec3::new(0.0, 1.0, 0.0)));
        document.cancel();
        assert_eq!((document.text(), document.clay().digest()), (text, digest));
        assert_eq!(document.depth()[1], 0);
    }

    #[test]
    fn mistakes_are_told_with_their_line() {
        for (text, mistake) in [
            (
                "strokes 1\nstart sphere 4\npull\n",
                "line 3, column 5: a tool is expected: box, cylinder or sphere",
            ),
            (
                "strokes 1\nstart file a.obj\n",
                "line 2, column 1: no a.obj",
            ),
        ] {
            let opened = Document::open(text, &mut |name| Err(format!("no {name}")));
            assert_eq!(opened.err().unwrap(), mistake);
        }
    }
}
