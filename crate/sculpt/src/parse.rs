//! Parsing texts of strokes.

use crate::decay::Decay;
use crate::grammar::COMMANDS;
use crate::holes::Deletion;
use crate::limits::{LARGEST, MAX_BYTES, MAX_LEVELS, MAX_POINTS, MAX_STROKES, SMALLEST};
use crate::refine::Refinement;
use crate::region::{Choice, RegionChange};
use crate::script::{Diagnostic, Place, Script};
use crate::start::{Shape, Start};
use crate::stroke::{Action, Beginning, Constraint, MaskChange, PathPoint, Stroke, Sweep};
use crate::tool::{Form, Tool};
use core::fmt::Display;
use core::str::FromStr;
use glam::DVec3;

/// Problems that are told at most.
const MOST_PROBLEMS: usize = 20;

type Parsed<T> = Result<T, Diagnostic>;

impl FromStr for Script {
    type Err = Diagnostic;

    fn from_str(text: &str) -> Result<Self, Diagnostic> {
        Self::parse(text).map_err(|mut problems| problems.swap_remove(0))
    }
}

impl Script {
    /// Parses a text. Returns all problems if there are any, at most twenty.
    ///
    /// # Errors
    /// The problems.
    pub fn parse(text: &str) -> Result<Self, Vec<Diagnostic>> {
        if text.len() > MAX_BYTES {
            let message = format!(
                "this text has {} bytes; strokes have at most {MAX_BYTES}",
                text.len()
            );
            return Err(vec![Place::default().problem(message)]);
        }
        let mut reader = ScriptReader::default();
        let mut problems = Vec::new();
        let mut offset = 0;
        for (number, content) in (1..).zip(text.split('\n')) {
            let mut line = Line::new(content, number, offset);
            offset += content.len() + 1;
            if line.is_done() {
                continue;
            }
            if let Err(problem) = reader.line(&mut line) {
                problems.push(problem);
                if problems.len() == MOST_PROBLEMS {
                    break;
                }
            }
        }
        let end = Line::new("", text.split('\n').count(), text.len());
        if problems.is_empty() && reader.start.is_none() {
            problems.push(end.problem_here("there must be `strokes 1`, then a `start`"));
        }
        match reader.start {
            Some(start) if problems.is_empty() => Ok(Self {
                start,
                strokes: reader.strokes,
                places: reader.places,
            }),
            _ => Err(problems),
        }
    }
}

/// State of the parser: the part of a text that has been read.
#[derive(Default)]
struct ScriptReader {
    has_heading: bool,
    start: Option<Beginning>,
    strokes: Vec<Stroke>,
    places: Vec<Place>,
}

impl ScriptReader {
    fn line(&mut self, line: &mut Line<'_>) -> Parsed<()> {
        let place = line.whole();
        let name = line.word("a command is expected")?;
        if !self.has_heading {
            self.has_heading = true;
            if name != "strokes" {
                return Err(place.problem("the first line must be `strokes 1`".into()));
            }
            let version = line.whole_number("the version", 1, u32::MAX)?;
            if version != 1 {
                return Err(place.problem(format!("version {version} is not known, only 1")));
            }
            return line.end();
        }
        match (name, &self.start) {
            ("start", None) => {
                self.start = Some(line.beginning()?);
                self.places.push(place);
            }
            ("start", Some(_)) => {
                return Err(place.problem("there is a `start` before".into()));
            }
            (_, None) => {
                // The next lines are read, too.
                self.start = Some(Beginning::Shape(Start::new(Shape::Sphere, 1)));
                self.places.push(Place::default());
                return Err(place.problem("there must be a `start` first".into()));
            }
            _ => {
                if self.strokes.len() == MAX_STROKES {
                    let message = format!("there are more than {MAX_STROKES} strokes");
                    return Err(place.problem(message));
                }
                let stroke = line.stroke(name, &place)?;
                self.strokes.push(stroke);
                self.places.push(place);
            }
        }
        line.end()
    }
}

fn is_sign(c: char) -> bool {
    c == ':' || c == ','
}

/// Line that is read from left to right.
struct Line<'a> {
    text: &'a str,
    number: usize,
    /// Bytes of the text before the line.
    offset: usize,
    /// Bytes that are read.
    at: usize,
    /// Bytes before the last token.
    last: usize,
}

impl<'a> Line<'a> {
    fn new(text: &'a str, number: usize, offset: usize) -> Self {
        let text = text.split('#').next().unwrap_or("");
        Self {
            text,
            number,
            offset,
            at: 0,
            last: 0,
        }
    }

    fn skip(&mut self) {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
    }

    fn is_done(&mut self) -> bool {
        self.skip();
        self.at == self.text.len()
    }

    /// The place from one byte of the line to another.
    fn place(&self, from: usize, to: usize) -> Place {
        Place {
            line: self.number,
            column: self.text[..from].chars().count() + 1,
            span: self.offset + from..self.offset + to,
        }
    }

    fn whole(&self) -> Place {
        self.place(self.at, self.text.trim_end().len().max(self.at))
    }

    fn peek(&mut self) -> &'a str {
        self.skip();
        let rest = &self.text[self.at..];
        if rest.starts_with(is_sign) {
            return &rest[..1];
        }
        let end = rest.find(|c: char| c.is_whitespace() || is_sign(c));
        &rest[..end.unwrap_or(rest.len())]
    }

    fn next(&mut self) -> &'a str {
        let token = self.peek();
        self.last = self.at;
        self.at += token.len();
        token
    }

    /// Reads a number of levels, from 1; 1 if none is given.
    fn levels(&mut self, what: &str) -> Parsed<u32> {
        if self.is_number() {
            return self.whole_number(what, 1, MAX_LEVELS);
        }
        Ok(1)
    }

    /// Reads a token if it is this one.
    fn takes(&mut self, token: &str) -> bool {
        let is_next = self.peek() == token;
        if is_next {
            self.next();
        }
        is_next
    }

    /// Returns the problem that something else than `what` stands here.
    fn problem_here(&self, what: &str) -> Diagnostic {
        let rest = &self.text[self.at..];
        let at = self.at + (rest.len() - rest.trim_start().len());
        let length = self.text[at..].find(char::is_whitespace);
        let end = length.map_or(self.text.len(), |length| at + length);
        self.place(at, end).problem(what.into())
    }

    /// Returns the problem that the last token is not right.
    fn wrong(&self, message: impl Into<String>) -> Diagnostic {
        self.place(self.last, self.at).problem(message.into())
    }

    fn word(&mut self, what: &str) -> Parsed<&'a str> {
        match self.peek() {
            "" | ":" | "," => Err(self.problem_here(what)),
            _ => Ok(self.next()),
        }
    }

    fn end(&mut self) -> Parsed<()> {
        if self.is_done() {
            return Ok(());
        }
        Err(self.problem_here("the line should end here"))
    }

    /// Whether a number comes next.
    fn is_number(&mut self) -> bool {
        self.peek().parse::<f64>().is_ok()
    }

    fn number(&mut self, what: &str, low: f64, high: f64) -> Parsed<f64> {
        self.any_number("a number", what, low, high)
    }

    fn whole_number(&mut self, what: &str, low: u32, high: u32) -> Parsed<u32> {
        self.any_number("a whole number", what, low, high)
    }

    fn any_number<N>(&mut self, kind: &str, what: &str, low: N, high: N) -> Parsed<N>
    where
        N: FromStr + PartialOrd + Display,
    {
        let Ok(number) = self.peek().parse::<N>() else {
            return Err(self.problem_here(&format!("{kind} is expected: {what}")));
        };
        self.next();
        if (&low..=&high).contains(&&number) {
            Ok(number)
        } else {
            Err(self.wrong(format!("{what} must be from {low} to {high}")))
        }
    }

    fn vector(&mut self, what: &str, low: f64, high: f64) -> Parsed<DVec3> {
        let x = self.number(what, low, high)?;
        let y = self.number(what, low, high)?;
        let z = self.number(what, low, high)?;
        Ok(DVec3::new(x, y, z))
    }

    fn beginning(&mut self) -> Parsed<Beginning> {
        if self.takes("file") {
            let name = self.text[self.at..].trim();
            if name.is_empty() {
                return Err(self.problem_here("the name of a file is expected"));
            }
            self.at = self.text.len();
            return Ok(Beginning::File(name.into()));
        }
        let shapes = Shape::ALL.into_iter();
        let name = self.peek();
        let Some(shape) = shapes.into_iter().find(|shape| shape.name() == name) else {
            return Err(self.problem_here(
                "a start shape is expected: plane, sphere, tetrahedron, cylinder or box; or `file`",
            ));
        };
        self.next();
        let divisions = self.whole_number("the divisions of an edge", 1, 1000)?;
        let mut start = Start::new(shape, divisions);
        start.check().map_err(|error| self.wrong(error.0))?;
        if self.is_number() {
            start.semi_axes = self.vector("a factor of the size", SMALLEST, LARGEST)?;
        }
        Ok(Beginning::Shape(start))
    }

    fn stroke(&mut self, name: &str, place: &Place) -> Parsed<Stroke> {
        Ok(match name {
            "stage" => {
                let name = self.text[self.at..].trim();
                if name.is_empty() {
                    return Err(self.problem_here("the name of the stage is expected"));
                }
                self.at = self.text.len();
                Stroke::Stage(name.into())
            }
            "symmetry" => Stroke::Symmetry(self.symmetry()?),
            "push" => self.sweep(Action::Push)?,
            "pull" => self.sweep(Action::Pull)?,
            "smooth" => self.sweep(Action::Smooth)?,
            "mask" if self.takes("clear") => Stroke::Masks(MaskChange::Clear),
            "mask" if self.takes("invert") => Stroke::Masks(MaskChange::Invert),
            "mask" => {
                let value = self.number("the mask", 0.0, 1.0)?;
                self.sweep(Action::Mask(value))?
            }
            "paint" => {
                let color = self.vector("a channel of the colour", 0.0, 1.0)?;
                self.sweep(Action::Paint(color.to_array()))?
            }
            "region" => self.region()?,
            "refine" => {
                let word = self.peek();
                let how = Refinement::ALL.into_iter().find(|how| how.name() == word);
                if how.is_some() {
                    self.next();
                }
                Stroke::Refine(how.unwrap_or(Refinement::Propagate))
            }
            "loop" => Stroke::Loop(self.levels("the levels")?),
            "average" => {
                let times = self.levels("how often")?;
                let share = match self.is_number() {
                    true => self.number("the share of the way", 0.0, 1.0)?,
                    false => 1.0,
                };
                Stroke::Average(times, share)
            }
            "fill" => Stroke::Fill,
            "delete" if self.takes("face") => Stroke::Delete(Deletion::Face),
            "delete" if self.takes("hole") => Stroke::Delete(Deletion::Hole),
            "delete" => return Err(self.problem_here("`face` or `hole` is expected")),
            "simplify" => Stroke::Simplify(self.number("the share of faces", 0.0, 1.0)?),
            _ => return Err(self.unknown(name, place)),
        })
    }

    fn unknown(&self, name: &str, place: &Place) -> Diagnostic {
        let names: Vec<&str> = COMMANDS.iter().map(|command| command.name).collect();
        let mut place = place.clone();
        place.span.end = place.span.start + name.len();
        place.problem(format!(
            "there is no command `{name}`; there are {}",
            names.join(", ")
        ))
    }

    fn symmetry(&mut self) -> Parsed<[bool; 3]> {
        if self.takes("off") {
            return Ok([false; 3]);
        }
        let mut planes = [false; 3];
        loop {
            let name = self.peek();
            match ["x", "y", "z"].iter().position(|axis| *axis == name) {
                Some(axis) => planes[axis] = true,
                None if planes == [false; 3] => {
                    return Err(self.problem_here("x, y, z or `off` is expected"));
                }
                None => return Ok(planes),
            }
            self.next();
        }
    }

    fn region(&mut self) -> Parsed<Stroke> {
        let simple = [
            ("all", RegionChange::All),
            ("none", RegionChange::None),
            ("invert", RegionChange::Invert),
        ];
        for (name, change) in simple {
            if self.takes(name) {
                return Ok(Stroke::Region(change));
            }
        }
        for (name, is_growth) in [("grow", true), ("shrink", false)] {
            if self.takes(name) {
                let times = match self.is_done() {
                    true => 1,
                    false => self.whole_number("how often", 1, MAX_LEVELS)?,
                };
                return Ok(Stroke::Region(match is_growth {
                    true => RegionChange::Grow(times),
                    false => RegionChange::Shrink(times),
                }));
            }
        }
        let word = self.peek();
        let choices = Choice::ALL.into_iter();
        let choice = choices.into_iter().find(|choice| choice.name() == word);
        match choice {
            Some(choice) if choice != Choice::Replace => {
                self.next();
                self.sweep(Action::Region(choice))
            }
            _ => self.sweep(Action::Region(Choice::Replace)),
        }
    }

    /// Reads a tool with decay, options and path.
    fn sweep(&mut self, action: Action) -> Parsed<Stroke> {
        let mut sweep = Sweep::new(action, self.tool()?);
        if let Some(decay) = Decay::of_name(self.peek()) {
            self.next();
            sweep.decay = decay;
            sweep.range = self.number("the range of the decay", 0.0, LARGEST)?;
            if sweep.range == 0.0 {
                sweep.decay = Decay::Flat;
            }
        }
        loop {
            if self.takes("normal") {
                sweep.constraint = Some(Constraint::Normal);
            } else if self.takes("tangent") {
                sweep.constraint = Some(Constraint::Tangent);
            } else if self.takes("only") {
                sweep.only_region = true;
            } else if self.takes(":") {
                break;
            } else {
                return Err(self.problem_here(
                    "a colon and the path are expected, or a decay (goo, bell, cusp, cone or flat, \
                     with its range), `normal`, `tangent` or `only`",
                ));
            }
        }
        loop {
            if sweep.path.len() == MAX_POINTS {
                return Err(self.problem_here(&format!("a path has at most {MAX_POINTS} points")));
            }
            let position = self.vector("a coordinate of the path", -LARGEST, LARGEST)?;
            let pressure = match self.is_number() {
                true => self.number("the pressure", 0.0, 1.0)?,
                false => 1.0,
            };
            sweep.path.push(PathPoint { position, pressure });
            if !self.takes(",") {
                return Ok(Stroke::Sweep(sweep));
            }
        }
    }

    fn tool(&mut self) -> Parsed<Tool> {
        let name = self.peek();
        let Some(form) = Form::ALL.into_iter().find(|form| form.name() == name) else {
            return Err(self.problem_here("a tool is expected: box, cylinder or sphere"));
        };
        self.next();
        let mut tool = Tool::new(form, self.vector("a semi-axis", SMALLEST, LARGEST)?);
        if self.is_number() {
            let [low, high] = Tool::EXPONENTS;
            tool.exponents[0] = self.number("an exponent", low, high)?;
            tool.exponents[1] = self.number("an exponent", low, high)?;
        }
        if self.takes("turn") {
            tool.turn = self.vector("an angle in degrees", -LARGEST, LARGEST)?;
        }
        Ok(tool)
    }
}
