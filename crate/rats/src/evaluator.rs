//! Runs the commands of the parsed files, top to bottom, and builds the scene.
//!
//! This file holds the machine: files, blocks, loops, choices and calls. What the commands do is in the
//! modules below, one for each group of the table in [`crate::commands`].

pub mod camera;
mod later;
pub mod materials;
pub mod model;
pub mod objects;
pub mod options;
pub mod palette;
pub mod picture;
pub mod primitives;
pub mod run;
pub mod scene_commands;
pub mod textures;
pub mod variables;

use crate::commands::{self, Action};
use crate::compile::HotVariable;
use crate::limits;
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::report::Report;
use crate::scope::Scope;
use crate::symbol::Symbol;
use crate::syntax::{Command, Define, For, If, Node, Syntax};
use crate::value::Value;
use crate::{Project, Severity};
use model::Model;
use palette::Palette;
use scene::{Camera, Light, Origin, Scene, Settings};
use std::collections::HashMap;
use std::ops::Range;

/// What to do after a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Run the next one.
    Next,
    /// Leave the file or the call.
    Return,
    /// End the run.
    Quit,
}

/// A running text.
#[derive(Debug)]
pub struct Evaluator<'a> {
    project: &'a Project,
    syntaxes: &'a [Syntax],
    /// Variables, random numbers, steps.
    pub(crate) scope: Scope<'a>,
    report: Report,
    model: Model<'a>,
    palette: Palette<'a>,
    lights: Vec<Light>,
    background: scene::Rgb,
    camera: Camera,
    /// The file and place of the last `eyep` or `vrp`.
    aimed_at: (usize, Range<usize>),
    /// A vertical angle of view that differs from the horizontal one, and where it was given.
    vertical: Option<(f64, usize, Range<usize>)>,
    settings: Settings,
    definitions: HashMap<Symbol, (usize, &'a Define)>,
    hot: Vec<HotVariable>,
    /// The file that is being run.
    file: usize,
    /// The files that are being read, the innermost last.
    reading: Vec<usize>,
    /// Files whose mistakes of form have been reported.
    reported: Vec<bool>,
    /// Blocks, calls and files inside each other.
    depth: usize,
    /// Loops and calls inside each other.
    repeating: usize,
    /// The picture that `shoot` took.
    shot: Option<Scene>,
    told_after_shot: bool,
}

impl<'a> Evaluator<'a> {
    /// A machine that has run nothing yet; `syntaxes` are the parsed files of `project`.
    #[must_use]
    pub fn new(project: &'a Project, syntaxes: &'a [Syntax], scope: Scope<'a>) -> Self {
        Self {
            project,
            syntaxes,
            scope,
            report: Report::default(),
            model: Model::default(),
            palette: Palette::default(),
            lights: Vec::new(),
            background: scene::DEFAULT_BACKGROUND,
            camera: Camera::default(),
            aimed_at: (0, 0..0),
            vertical: None,
            settings: Settings::default(),
            definitions: HashMap::new(),
            hot: Vec::new(),
            file: 0,
            reading: Vec::new(),
            reported: vec![false; syntaxes.len()],
            depth: 0,
            repeating: 0,
            shot: None,
            told_after_shot: false,
        }
    }

    /// Runs the first file to the end and gives the scene, the messages and the hot variables.
    #[must_use]
    pub fn run(mut self) -> (Scene, Vec<crate::Diagnostic>, Vec<HotVariable>) {
        if !self.syntaxes.is_empty() {
            self.run_file(0);
        }
        self.check_camera();
        let scene = match self.shot.take() {
            Some(scene) => scene,
            None => self.picture(),
        };
        self.note_unused_materials();
        (scene, self.report.finish(self.project), self.hot)
    }

    /// Runs a file from its beginning.
    fn run_file(&mut self, file: usize) -> Flow {
        let outer = std::mem::replace(&mut self.file, file);
        self.reading.push(file);
        let syntaxes: &'a [Syntax] = self.syntaxes;
        let syntax = &syntaxes[file];
        if !std::mem::replace(&mut self.reported[file], true) {
            for problem in &syntax.problems {
                self.report
                    .add(file, Severity::Error, Box::new(problem.clone()));
            }
        }
        let flow = self.block(&syntax.block);
        self.reading.pop();
        self.file = outer;
        if flow == Flow::Quit {
            Flow::Quit
        } else {
            Flow::Next
        }
    }

    /// Runs commands one after the other. A command that fails is reported and left out.
    fn block(&mut self, block: &'a [Node]) -> Flow {
        for node in block {
            let flow = self.node(node).or_else(|problem| {
                let fatal = problem.fatal;
                let span = problem.span.clone();
                self.report.add(self.file, Severity::Error, problem);
                if fatal {
                    return Ok(Flow::Quit);
                }
                self.scope.step(limits::STEPS_PER_ERROR, &span)?;
                Ok(Flow::Next)
            });
            match flow {
                Ok(Flow::Next) => {}
                Ok(flow) => return flow,
                Err(problem) => {
                    let problem: Box<Problem> = problem;
                    self.report.add(self.file, Severity::Error, problem);
                    return Flow::Quit;
                }
            }
        }
        Flow::Next
    }

    fn node(&mut self, node: &'a Node) -> Outcome<Flow> {
        match node {
            Node::Command(command) => self.command(command),
            Node::For(node) => self.repeat(node),
            Node::If(node) => self.choose(node),
            Node::Define(node) => {
                self.scope.step(1, &node.head.word_span)?;
                self.definitions.insert(node.name, (self.file, node));
                Ok(Flow::Next)
            }
        }
    }

    fn command(&mut self, command: &'a Command) -> Outcome<Flow> {
        self.scope.step(1, &command.word_span)?;
        let Some(spec) = command.spec else {
            return self.call(command);
        };
        self.tell_after_shot(command);
        match spec.action {
            Action::Run(run) => run(self, command),
            // The parser gives these no plain command.
            Action::Structure => Ok(Flow::Next),
            Action::NoEffect(reason) => {
                self.say(Severity::Note, command.word_span.clone(), || {
                    (
                        format!("`{}` changes nothing here: {reason}", spec.name),
                        None,
                    )
                });
                Ok(Flow::Next)
            }
            Action::Later => {
                self.not_carried_out(command.word_span.clone(), &format!("`{}`", spec.name));
                Ok(Flow::Next)
            }
        }
    }

    fn repeat(&mut self, node: &'a For) -> Outcome<Flow> {
        self.scope.step(1, &node.head.word_span)?;
        let mut read = self.reader(&node.head).unlisted();
        let (name, word) = read
            .peek_word()
            .ok_or_else(|| read.expected("the name of the loop's variable"))?;
        read.at += 1;
        if !read.sign(b'=') {
            return Err(read.expected(&format!("`=` after `{word}`")));
        }
        let from = read.number("the first value")?;
        if !read.keyword("to") {
            return Err(read.expected("`to`"));
        }
        let to = read.number("the last value")?;
        let mut step = 1.0;
        let start = read.start();
        if read.keyword("step") {
            step = read.number("the step")?;
            if step == 0.0 {
                return Err(Problem::new(read.since(start), "the step must not be 0"));
            }
        }
        read.end()?;
        // A last value that rounding puts just beyond the end still counts.
        let last = ((to - from) / step + 1e-9).floor();
        let before = self.scope.get(name);
        self.enter(&node.head.word_span)?;
        self.repeating += 1;
        let mut flow = Flow::Next;
        let mut index = 0.0;
        let mut result = Ok(());
        while index <= last && flow == Flow::Next {
            result = self.scope.step(1, &node.head.word_span);
            if result.is_err() {
                break;
            }
            self.scope.set(name, Value::Scalar(from + index * step));
            flow = self.block(&node.body);
            index += 1.0;
        }
        self.repeating -= 1;
        self.depth -= 1;
        self.scope.restore(name, before);
        result.map(|()| flow)
    }

    fn choose(&mut self, node: &'a If) -> Outcome<Flow> {
        self.scope.step(1, &node.head.word_span)?;
        let branch = if self.reader(&node.head).unlisted().condition()? {
            &node.then
        } else {
            &node.otherwise
        };
        self.enter(&node.head.word_span)?;
        let flow = self.block(branch);
        self.depth -= 1;
        Ok(flow)
    }

    /// Runs a command that the text defines.
    fn call(&mut self, command: &'a Command) -> Outcome<Flow> {
        let Some(&(file, define)) = self.definitions.get(&command.word) else {
            return Err(self.unknown(command));
        };
        let mut values = Vec::with_capacity(define.parameters.len());
        let mut read = self.reader(command);
        for (name, triple) in &define.parameters {
            let what = format!("`{}`", read.scope.symbols.word(*name));
            let value = if *triple {
                read.triple(&what)?
            } else {
                Value::Scalar(read.number(&what)?)
            };
            values.push((*name, value));
        }
        read.end()?;
        if self.scope.calls() >= limits::MAX_NESTED_CALLS {
            return Err(Problem::new(
                command.word_span.clone(),
                format!(
                    "stopped here: commands call each other more than {} deep",
                    limits::MAX_NESTED_CALLS
                ),
            )
            .hint("give a command that calls itself an `if` that ends it")
            .fatal());
        }
        self.enter(&command.word_span)?;
        self.repeating += 1;
        let frame = self.scope.enter(values.into_iter());
        let outer = std::mem::replace(&mut self.file, file);
        let flow = self.block(&define.body);
        self.file = outer;
        self.scope.leave(frame);
        self.repeating -= 1;
        self.depth -= 1;
        Ok(if flow == Flow::Quit {
            Flow::Quit
        } else {
            Flow::Next
        })
    }

    fn unknown(&self, command: &Command) -> Box<Problem> {
        let word = self.scope.symbols.word(command.word);
        let problem = Problem::new(
            command.word_span.clone(),
            format!("there is no command `{word}`"),
        );
        let defined = self.definitions.keys().map(|s| self.scope.symbols.word(*s));
        problem.maybe_hint(commands::suggestion(word, defined))
    }

    /// The index of a material. If it is made further down, the hint says so.
    fn material(&self, name: &Name<'a>) -> Outcome<usize> {
        self.palette.find(name).map_err(|problem| {
            if problem.quiet {
                return problem;
            }
            match later::line_of_material(self.syntaxes, self.project, self.file, name) {
                Some(line) => problem.hint(format!(
                    "it is made further down, in line {line}: move that up"
                )),
                None => problem,
            }
        })
    }

    /// One level deeper.
    fn enter(&mut self, span: &Range<usize>) -> Outcome<()> {
        if self.depth >= limits::MAX_NESTED {
            return Err(Problem::new(
                span.clone(),
                format!(
                    "stopped here: files, blocks and calls are more than {} deep",
                    limits::MAX_NESTED
                ),
            )
            .fatal());
        }
        self.depth += 1;
        Ok(())
    }

    /// Reads the operands of a command of the present file.
    fn reader(&mut self, command: &Command) -> Reader<'_, 'a> {
        let items = &self.syntaxes[self.file].items;
        let text = &self.project.files[self.file].text;
        Reader::new(command, items, text, &mut self.scope)
    }

    /// Adds a message that is no error; it is made only if it is the first about its place.
    fn say(
        &mut self,
        severity: Severity,
        span: Range<usize>,
        message: impl FnOnce() -> (String, Option<String>),
    ) {
        if self.report.is_new(self.file, severity, &span) {
            let (message, hint) = message();
            let problem = Problem::new(span, message).maybe_hint(hint);
            self.report.add(self.file, severity, problem);
        }
    }

    /// Warns that something is known but not done.
    fn not_carried_out(&mut self, span: Range<usize>, what: &str) {
        self.say(Severity::Warning, span, || {
            (
                format!("{what} is understood but not carried out in this version"),
                None,
            )
        });
    }

    fn tell_after_shot(&mut self, command: &Command) {
        use commands::Group;
        if self.shot.is_none() || self.told_after_shot {
            return;
        }
        let Some(spec) = command.spec else { return };
        let changes = matches!(
            spec.group,
            Group::Camera | Group::Materials | Group::Primitives | Group::Objects
        ) || matches!(spec.name, "light" | "background" | "shoot");
        if changes {
            self.told_after_shot = true;
            self.say(Severity::Warning, command.word_span.clone(), || {
                (
                    String::from(
                        "what follows the first `shoot` is not in the picture in this version",
                    ),
                    Some(String::from("put `shoot` last")),
                )
            });
        }
    }

    /// Where an element of this command comes from.
    fn origin(&self, command: &Command) -> Origin {
        let small = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Origin {
            file: small(self.file),
            start: small(command.span.start),
            end: small(command.span.end),
        }
    }
}
