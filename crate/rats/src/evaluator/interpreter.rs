//! Runs files, blocks, loops, choices and calls of defined commands.

use super::state::{Evaluator, Flow};
use crate::commands::Action;
use crate::limits;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::sources::Sources;
use crate::symbol::Symbol;
use crate::syntax::{Command, For, If, Node};
use crate::value::Value;
use crate::{Severity, library, places, suggest};

impl<'a> Evaluator<'a> {
    /// Runs a file from its beginning.
    pub(super) fn run_file(&mut self, file: usize) -> Flow {
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
                // Errors that follow from a reported one are found and dropped quickly.
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
        if spec.yields() && self.definitions.contains_key(&command.word) {
            return self.call(command, command.word);
        }
        self.note_after_shot(command);
        match spec.action {
            Action::Run(run) => run(self, command).inspect_err(|_| {
                if let Some(mark) = spec.mark_failed {
                    mark(self, command);
                }
            }),
            // The parser gives these no plain command.
            Action::Structure => Ok(Flow::Next),
            Action::Library => self.call_library(command, spec.name),
            Action::NoEffect(reason) => {
                self.read_given(command)?;
                let message = format_args!("`{}` changes nothing here: {reason}", spec.name);
                self.note(&command.word_span, message, "");
                Ok(Flow::Next)
            }
        }
    }

    fn repeat(&mut self, node: &'a For) -> Outcome<Flow> {
        self.scope.step(1, &node.head.word_span)?;
        let mut read = self.reader(&node.head).joining();
        let (name, word) = read
            .peek_word()
            .ok_or_else(|| read.missing("the name of the loop's variable"))?;
        read.at += 1;
        if !read.sign(b'=') {
            return Err(read.missing(&format!("`=` after `{word}`")));
        }
        let from = read.number("the first value")?;
        if !read.keyword("to") {
            return Err(read.missing("`to`"));
        }
        let to = read.number("the last value")?;
        let mut step = 1.0;
        let start = read.start();
        if read.keyword("step") {
            step = read.number("the step")?;
            if step == 0.0 {
                return Err(Problem::new(&read.since(start), "the step must not be 0"));
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
        let branch = if self.reader(&node.head).joining().condition()? {
            &node.then
        } else {
            &node.otherwise
        };
        self.enter(&node.head.word_span)?;
        let flow = self.block(branch);
        self.depth -= 1;
        Ok(flow)
    }

    /// Runs a command of the library, which is read when it is used for the first time.
    fn call_library(&mut self, command: &'a Command, name: &'static str) -> Outcome<Flow> {
        let symbol = self.scope.symbols.find(name);
        let is_new = symbol.is_none_or(|symbol| !self.definitions.contains_key(&symbol));
        if is_new && let Some(file) = self.sources.find_built_in(&format!("{name}.rat")) {
            self.enter(&command.word_span)?;
            self.uses.push((self.file, command.span.clone()));
            self.run_file(file);
            self.uses.pop();
            self.depth -= 1;
        }
        match symbol.filter(|symbol| self.definitions.contains_key(symbol)) {
            Some(symbol) => self.call(command, symbol),
            None => Err(self.unknown(command)),
        }
    }

    /// Runs a command that a text defines, under the name `symbol`.
    fn call(&mut self, command: &'a Command, symbol: Symbol) -> Outcome<Flow> {
        let Some(&(file, define)) = self.definitions.get(&symbol) else {
            return Err(self.unknown(command));
        };
        self.scope
            .step(limits::STEPS_PER_CALL, &command.word_span)?;
        let values = self.arguments(command, define)?;
        if self.scope.calls() >= limits::MAX_NESTED_CALLS {
            return Err(Problem::new(
                &command.word_span,
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
        let from_own = self.file < self.sources.own;
        if from_own {
            self.uses.push((self.file, command.span.clone()));
        }
        let frame = self.scope.enter(
            values
                .iter()
                .filter_map(|(name, value)| Some((*name, (*value)?))),
        );
        let outer = std::mem::replace(&mut self.file, file);
        let flow = self
            .defaults(define, &values)
            .map(|()| self.block(&define.body));
        self.file = outer;
        self.scope.leave(frame);
        if from_own {
            self.uses.pop();
        }
        self.repeating -= 1;
        self.depth -= 1;
        Ok(if flow? == Flow::Quit {
            Flow::Quit
        } else {
            Flow::Next
        })
    }

    /// Runs another text; messages about one of the library or an example go here.
    pub(super) fn run_inner(&mut self, command: &'a Command, file: usize) -> Outcome<Flow> {
        self.enter(&command.word_span)?;
        let leaves_own = self.is_own() && file >= self.sources.own;
        if leaves_own {
            self.uses.push((self.file, command.span.clone()));
        }
        let flow = self.run_file(file);
        if leaves_own {
            self.uses.pop();
        }
        self.depth -= 1;
        Ok(flow)
    }

    /// Finds the file of a name, of the project or the library.
    pub(super) fn find_file(&self, name: &Name<'_>) -> Outcome<usize> {
        let places = places(&self.sources.all[self.file].name, name.text);
        let found = places.iter().find_map(|place| self.sources.find(place));
        found.ok_or_else(|| {
            let own = self.sources.all[..self.sources.own]
                .iter()
                .map(|source| source.name.as_str());
            let known: Vec<&str> = own
                .chain(library::FILES.iter().map(|file| file.0))
                .collect();
            let bare = name.text.strip_prefix("./").unwrap_or(name.text);
            let hint = suggest::hint(bare, known.iter().copied())
                .unwrap_or_else(|| format!("the files are {}", known.join(", ")));
            Problem::new(
                &name.span,
                format!("there is no file `{}` in the project", name.text),
            )
            .hint(hint)
        })
    }
}
