//! Texts of strokes.

use crate::clay::Clay;
use crate::error::Error;
use crate::perform::{Loader, begin, carry_out};
use crate::stroke::{Beginning, Stroke};
use crate::write;
use core::fmt;
use core::ops::Range;

/// Sculpture as text: what it starts from, and strokes. Parsing what is displayed gives the same.
///
/// ```
/// use sculpt::Script;
///
/// let text = "strokes 1\nstart box 4 # a cube\n\
///     pull sphere 0.3 0.3 0.3 bell 0.8 : 0 0 1, 0 0 1.5 0.5\nloop\n";
/// let script: Script = text.parse()?;
/// assert_eq!(script.strokes.len(), 2);
/// assert_eq!(script.to_string().parse::<Script>()?.strokes, script.strokes);
///
/// let error = "strokes 1\nstart box 4\npull globe 1 1 1 : 0 0 0\n".parse::<Script>().unwrap_err();
/// assert_eq!(error.to_string(), "line 3, column 6: a tool is expected: box, cylinder or sphere");
/// # Ok::<(), sculpt::Diagnostic>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// Mesh that the sculpture starts from.
    pub start: Beginning,
    /// The strokes, in order.
    pub strokes: Vec<Stroke>,
    /// Places of the start and of each stroke in the text.
    pub(crate) places: Vec<Place>,
}

/// Place of a text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Place {
    pub line: usize,
    pub column: usize,
    pub span: Range<usize>,
}

/// Problem of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Bytes of the text that it is about.
    pub span: Range<usize>,
    /// Sentence without its full stop.
    pub message: String,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "line {}, column {}: {}",
            self.line, self.column, self.message
        )
    }
}

impl core::error::Error for Diagnostic {}

impl Script {
    /// Returns a text with strokes that were not written yet.
    #[must_use]
    pub fn new(start: Beginning, strokes: Vec<Stroke>) -> Self {
        let places = vec![Place::default(); strokes.len() + 1];
        Self {
            start,
            strokes,
            places,
        }
    }

    /// The line of the start, from 1; 0 if it was not parsed.
    #[must_use]
    pub fn start_line(&self) -> usize {
        self.places.first().map_or(0, |place| place.line)
    }

    /// The line on which a stroke stands, from 1; 0 if it was not parsed.
    #[must_use]
    pub fn line(&self, stroke: usize) -> usize {
        self.places.get(stroke + 1).map_or(0, |place| place.line)
    }

    /// Returns a problem of the start.
    #[must_use]
    pub fn problem_at_start(&self, message: &str) -> Diagnostic {
        self.at_start(&Error(message.to_owned()))
    }

    /// The clay before the first stroke.
    ///
    /// # Errors
    /// If the start's file cannot be read, or is no mesh that can be sculpted.
    pub fn begin(&self, load: Loader<'_>) -> Result<Clay, Diagnostic> {
        begin(&self.start, load).map_err(|error| self.at_start(&error))
    }

    /// Carries out the strokes from one on. With those before it they may visit `most_work`
    /// vertices together.
    ///
    /// # Errors
    /// At the line that cannot be carried out, or at which it becomes too much work.
    pub fn resume(&self, clay: &mut Clay, from: usize, most_work: u64) -> Result<(), Diagnostic> {
        for (i, stroke) in self.strokes.iter().enumerate().skip(from) {
            carry_out(clay, stroke, most_work).map_err(|error| self.at(i, &error))?;
        }
        Ok(())
    }

    pub(crate) fn at_start(&self, error: &Error) -> Diagnostic {
        self.places
            .first()
            .cloned()
            .unwrap_or_default()
            .problem(error.0.clone())
    }

    pub(crate) fn at(&self, stroke: usize, error: &Error) -> Diagnostic {
        let place = self.places.get(stroke + 1).cloned().unwrap_or_default();
        place.problem(error.0.clone())
    }
}

impl Place {
    pub fn problem(self, message: String) -> Diagnostic {
        Diagnostic {
            line: self.line,
            column: self.column,
            span: self.span,
            message,
        }
    }
}

impl fmt::Display for Script {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "strokes 1\n{}", self.start)?;
        self.strokes
            .iter()
            .try_for_each(|stroke| writeln!(f, "{stroke}"))
    }
}

impl fmt::Display for Beginning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write::beginning(f, self)
    }
}

impl fmt::Display for Stroke {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write::stroke(f, self)
    }
}
