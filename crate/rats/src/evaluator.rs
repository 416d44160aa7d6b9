//! Runs the commands of the parsed files, top to bottom, and builds the scene.
//!
//! This file holds the machine: files, blocks, loops and choices. Calls of defined commands are in `call`,
//! what is said of the text in `messages`, and what the commands do in the modules below, one for each
//! group of the table in [`crate::commands`].

mod call;
pub mod camera;
mod later;
mod lints;
pub mod materials;
mod messages;
pub mod model;
pub mod objects;
pub mod options;
pub mod palette;
pub mod picture;
pub mod primitives;
pub mod run;
pub mod scene_commands;
pub mod textures;
pub mod tools;
pub mod variables;
pub mod watch;
mod words;

use crate::commands::{self, Action};
use crate::compile::{Compiled, HotVariable, Output, Placement};
use crate::given::Given;
use crate::limits;
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::report::Report;
use crate::scope::Scope;
use crate::sources::Sources;
use crate::symbol::Symbol;
use crate::syntax::{Command, Datum, Define, For, If, Node};
use crate::value::Value;
use crate::{Asset, Project, Severity, Tool};
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
    sources: &'a Sources<'a>,
    assets: &'a [Asset],
    /// The moment of the animation, in frames.
    moment: f64,
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
    /// The other way to place the camera.
    view_plane: camera::ViewPlane,
    /// A vertical angle of view that differs from the horizontal one, and where it was given.
    vertical: Option<(f64, usize, Range<usize>)>,
    settings: Settings,
    definitions: HashMap<Symbol, (usize, &'a Define)>,
    hot: Vec<HotVariable>,
    tools: Vec<Tool>,
    tool_origins: Vec<Origin>,
    output: Output,
    /// Whether a variable changes with every frame.
    animated: bool,
    /// The file that is being run.
    file: usize,
    /// The files that are being read, the innermost last.
    reading: Vec<usize>,
    /// Where the texts of the project use the library, the innermost last: what is to be said about a
    /// text of the library is said there.
    uses: Vec<(usize, Range<usize>)>,
    /// Files whose mistakes of form have been reported.
    reported: Vec<bool>,
    /// Blocks, calls and files inside each other.
    depth: usize,
    /// Loops and calls inside each other.
    repeating: usize,
    /// The picture that `shoot` took.
    shot: Option<(Scene, Vec<Placement>)>,
    told_after_shot: bool,
    /// Whether, and for which command, the run is watched.
    watch: Option<Box<watch::Watch<'a>>>,
}

impl<'a> Evaluator<'a> {
    /// A machine that has run nothing yet.
    #[must_use]
    pub fn new(
        sources: &'a Sources<'a>,
        assets: &'a [Asset],
        moment: f64,
        scope: Scope<'a>,
    ) -> Self {
        Self {
            sources,
            assets,
            moment,
            scope,
            report: Report::default(),
            model: Model::default(),
            palette: Palette::default(),
            lights: Vec::new(),
            background: scene::DEFAULT_BACKGROUND,
            camera: Camera::default(),
            aimed_at: (0, 0..0),
            view_plane: camera::ViewPlane::default(),
            vertical: None,
            settings: Settings::default(),
            definitions: HashMap::new(),
            hot: Vec::new(),
            tools: Vec::new(),
            tool_origins: Vec::new(),
            output: Output::default(),
            animated: false,
            file: 0,
            reading: Vec::new(),
            uses: Vec::new(),
            reported: vec![false; sources.all.len()],
            depth: 0,
            repeating: 0,
            shot: None,
            told_after_shot: false,
            watch: None,
        }
    }

    /// Runs the first file of the project to the end.
    #[must_use]
    pub fn run(mut self, project: &Project) -> Compiled {
        if !self.sources.all.is_empty() {
            self.run_file(0);
        }
        if !self.report.is_cut_off() {
            self.check_open_objects();
        }
        self.check_camera();
        self.check_words();
        let (scene, placements) = match self.shot.take() {
            Some(shot) => shot,
            None => {
                let parts = std::mem::take(&mut self.model.parts);
                self.picture(parts)
            }
        };
        self.note_unused_materials();
        self.lint(&scene);
        Compiled {
            scene,
            placements,
            diagnostics: self.report.finish(project),
            hot: self.hot,
            tools: self.tools,
            tool_origins: self.tool_origins,
            output: self.output,
            animated: self.animated,
        }
    }

    /// Runs a file from its beginning.
    fn run_file(&mut self, file: usize) -> Flow {
        let outer = std::mem::replace(&mut self.file, file);
        self.reading.push(file);
        let sources: &'a Sources<'a> = self.sources;
        let syntax = &sources.all[file].syntax;
        if !std::mem::replace(&mut self.reported[file], true) {
            for problem in &syntax.problems {
                self.tell(Severity::Error, Box::new(problem.clone()));
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
            let flow = self.node(node).or_else(|mut problem| {
                let fatal = problem.fatal;
                let span = problem.span.clone();
                // What follows from an error that was reported is found and dropped soon.
                let cost = if problem.quiet {
                    20
                } else {
                    let size = self.sources.all[self.file].syntax.items.len();
                    limits::STEPS_PER_ERROR + (size / limits::OPERANDS_PER_STEP) as u64
                };
                if let Node::Command(command) = node
                    && let Some(spec) = command.spec
                {
                    problem.command.get_or_insert(spec.name);
                }
                self.tell(Severity::Error, problem);
                if fatal {
                    return Ok(Flow::Quit);
                }
                self.scope.step(cost, &span)?;
                Ok(Flow::Next)
            });
            match flow {
                Ok(Flow::Next) => {}
                Ok(flow) => return flow,
                Err(problem) => {
                    let problem: Box<Problem> = problem;
                    self.tell(Severity::Error, problem);
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
        if self.watch.as_ref().is_some_and(|watch| watch.is_done()) {
            return Ok(Flow::Quit);
        }
        let Some(spec) = command.spec else {
            return self.call(command, command.word);
        };
        self.tell_after_shot(command);
        match spec.action {
            Action::Run(run) => run(self, command),
            // The parser gives these no plain command.
            Action::Structure => Ok(Flow::Next),
            Action::Library => self.call_library(command, spec.name),
            Action::NoEffect(reason) => {
                self.given(command)?;
                self.say(Severity::Note, command.word_span.clone(), || {
                    (
                        format!("`{}` changes nothing here: {reason}", spec.name),
                        None,
                    )
                });
                Ok(Flow::Next)
            }
            Action::Later => {
                let given = self.given(command)?;
                // What is switched off is as if it were not there.
                if given.is_off() {
                    return Ok(Flow::Next);
                }
                if self.is_news(Severity::Warning, &command.word_span) {
                    self.not_carried_out(command.word_span.clone(), &format!("`{}`", spec.name));
                }
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
        self.watch_loop(name);
        self.enter(&node.head.word_span)?;
        self.repeating += 1;
        let mut flow = Flow::Next;
        let mut index = 0.0;
        let mut result = Ok(());
        while index <= last && flow == Flow::Next {
            result = self
                .scope
                .step(limits::STEPS_PER_TURN, &node.head.word_span);
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
            let source = &self.sources.all[self.file];
            match later::place_of_material(source, name) {
                Some(span) => {
                    let line = source.text[..span.start].matches('\n').count() + 1;
                    problem
                        .hint(format!(
                            "it is made further down, in line {line}: move that up"
                        ))
                        .related(None, span, format!("`{}` is made here", name.text))
                }
                None => problem,
            }
        })
    }

    /// All operands and options of a command, read as the table says. Within a chain its shapes leave
    /// out the material's name.
    fn given(&mut self, command: &'a Command) -> Outcome<Given<'a>> {
        let Some(spec) = command.spec else {
            return Ok(Given::default());
        };
        self.scope
            .step(limits::STEPS_PER_OPERANDS, &command.word_span)?;
        let mut parameters = spec.parameters;
        let mut skipped = 0;
        if let Some(first) = parameters.first()
            && first.name == "sn"
        {
            let in_chain = self.model.chain.is_some();
            let mut read = self.reader(command);
            read.more();
            let (at, datum, here) = (read.at, read.datum(), read.here());
            let found = read.found().unwrap_or_default();
            match datum {
                Some(Datum::Word(symbol)) if in_chain => match self.scope.get(symbol) {
                    // A parameter of a defined command that stands for the material.
                    Some(Value::Name(_)) => skipped = at + 1,
                    None if self.palette.has(self.scope.symbols.word(symbol)) => {
                        return Err(Problem::new(
                            here,
                            "shapes of a chain leave out the material's name: the chain gives it",
                        ));
                    }
                    _ => {}
                },
                // `sphere 1 0 0 0`: better say this than that a coordinate is missing at the end.
                Some(Datum::Number(_)) if !in_chain && !self.palette.has(found) => {
                    return Err(Problem::new(
                        here,
                        format!("expected the material's name, found `{found}`"),
                    )
                    .hint(spec.usage()));
                }
                _ => {}
            }
            if in_chain {
                parameters = &parameters[1..];
            }
        }
        let mut read = self.reader(command);
        read.at = skipped;
        read.given(parameters, spec.options)
    }

    /// An image or mesh of the project.
    fn asset(&self, name: &Name<'_>) -> Outcome<&'a Asset> {
        let assets: &'a [Asset] = self.assets;
        let bare = name.text.strip_prefix("./").unwrap_or(name.text);
        let find = |place: &String| {
            let mut all = assets.iter().chain(crate::library::assets());
            all.find(|asset| asset.name == *place)
        };
        let places = crate::places(&self.sources.all[self.file].name, name.text);
        places.iter().find_map(find).ok_or_else(|| {
            let known: Vec<_> = assets.iter().map(|asset| asset.name.as_str()).collect();
            let hint = if known.is_empty() {
                String::from("drop the file onto the page, or put it beside the dataset")
            } else {
                crate::suggest::hint(bare, known.iter().copied())
                    .unwrap_or_else(|| format!("the files are {}", known.join(", ")))
            };
            Problem::new(
                name.span.clone(),
                format!("there is no image or mesh `{bare}` in the project"),
            )
            .hint(hint)
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
        let source = &self.sources.all[self.file];
        Reader::new(command, &source.syntax.items, source.text, &mut self.scope)
    }

    /// Where an element of this command comes from: in the user's text, even if the library makes it.
    fn origin(&self, command: &Command) -> Origin {
        let small = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let (file, span) = match self.uses.last() {
            Some((file, span)) if !self.is_own() => (*file, span),
            _ => (self.file, &command.span),
        };
        Origin {
            file: small(file),
            start: small(span.start),
            end: small(span.end),
        }
    }
}
