//! Looks up operands as the table describes them, materials, images and meshes.

use super::later;
use super::state::Evaluator;
use crate::commands::{CommandSpec, OptionSpec, Parameter};
use crate::given::Given;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::reads::SKELETONS;
use crate::syntax::{Command, Datum};
use crate::value::Value;
use crate::{Asset, commands, is_image, is_mesh, is_skeleton, library, limits, places, suggest};

impl<'a> Evaluator<'a> {
    /// Makes the problem that there is no such command.
    pub(super) fn unknown(&self, command: &Command) -> Box<Problem> {
        let word = self.scope.symbols.word(command.word);
        let problem = Problem::new(&command.word_span, format!("there is no command `{word}`"));
        let defined = self.definitions.keys().map(|s| self.scope.symbols.word(*s));
        problem.maybe_hint(commands::suggestion(word, defined))
    }

    /// Finds the index of a material. If it is made further down, the hint says so.
    pub(super) fn material(&self, name: &Name<'a>) -> Outcome<usize> {
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
                        .with_place(None, span, format!("`{}` is made here", name.text))
                }
                None => problem,
            }
        })
    }

    /// Reads the operands and options of a command as the table says. Within a chain its shapes
    /// leave out the material's name, which is that of the chain.
    pub(super) fn read_given(&mut self, command: &'a Command) -> Outcome<Given<'a>> {
        let Some(spec) = command.spec else {
            return Ok(Given::default());
        };
        self.read_given_by(command, spec, spec.parameters, spec.options)
    }

    /// Reads the operands and options of one of several forms of a command, as
    /// [`Self::read_given`] does.
    pub(super) fn read_given_by(
        &mut self,
        command: &'a Command,
        spec: &'static CommandSpec,
        parameters: &'static [Parameter],
        options: &'static [OptionSpec],
    ) -> Outcome<Given<'a>> {
        self.scope
            .step(limits::STEPS_PER_OPERANDS, &command.word_span)?;
        let is_shape = parameters.first().is_some_and(|first| first.in_chain);
        let mut skipped = 0;
        if is_shape {
            let in_chain = self.model.chain.is_some();
            let mut read = self.reader(command);
            read.more();
            let (at, datum, here) = (read.at, read.datum(), read.here());
            let found = read.next_text().unwrap_or_default();
            match datum {
                Some(Datum::Word(symbol)) if in_chain => match self.scope.get(symbol) {
                    // A parameter of a defined command that stands for the material.
                    Some(Value::Name(_)) => skipped = at + 1,
                    None if self.palette.has(self.scope.symbols.word(symbol)) => {
                        return Err(Problem::new(
                            &here,
                            "shapes of a chain leave out the material's name: the chain gives it",
                        ));
                    }
                    _ => {}
                },
                // `sphere 1 0 0 0`: better say this than that a coordinate is missing at the end.
                Some(Datum::Number(_)) if !in_chain && !self.palette.has(found) => {
                    return Err(Problem::new(
                        &here,
                        format!("expected the material's name, found `{found}`"),
                    )
                    .hint(spec.usage()));
                }
                _ => {}
            }
        }
        let chain = self.model.chain.clone().filter(|_| is_shape);
        let mut read = self.reader(command);
        read.at = skipped;
        let given = read.read_given(parameters, options, chain)?;
        if is_shape {
            self.watch_shape(command, &given);
        }
        Ok(given)
    }

    /// Finds an image or mesh of the project or the library that a text of the project names.
    pub(super) fn find_asset(&self, file: usize, name: &str) -> Option<&'a Asset> {
        let all = self.assets.iter().chain(library::assets());
        places(&self.sources.all[file].name, name)
            .iter()
            .find_map(|place| all.clone().find(|asset| asset.name == *place))
    }

    /// Finds the index of a text of strokes of the project.
    ///
    /// # Errors
    /// If there is none of this name.
    pub(super) fn strokes(&self, name: &Name<'_>) -> Outcome<usize> {
        let own = &self.sources.all[..self.sources.own];
        let places = places(&self.sources.all[self.file].name, name.text);
        let found = places
            .iter()
            .find_map(|place| own.iter().position(|source| source.name == *place));
        found.ok_or_else(|| {
            let texts = own.iter().map(|source| source.name.as_str());
            let known: Vec<&str> = texts.filter(|name| crate::is_strokes(name)).collect();
            let hint = suggest::hint(name.text, known.iter().copied()).unwrap_or_else(|| {
                String::from(
                    "add a file of this name, or draw it in Sculpt; it begins with `strokes 1`",
                )
            });
            let message = format!("there is no text of strokes `{}` in the project", name.text);
            Problem::new(&name.span, message).hint(hint)
        })
    }

    /// Finds an image or mesh of the project or the library.
    pub(super) fn asset(&self, name: &Name<'_>) -> Outcome<&'a Asset> {
        let bare = name.text.strip_prefix("./").unwrap_or(name.text);
        self.find_asset(self.file, name.text).ok_or_else(|| {
            if let Some(problem) = unread_kind(name) {
                return problem;
            }
            let known: Vec<_> = self
                .assets
                .iter()
                .map(|asset| asset.name.as_str())
                .collect();
            let hint = if known.is_empty() {
                String::from("drop the file onto the page, or put it beside the dataset")
            } else {
                suggest::hint(bare, known.iter().copied())
                    .unwrap_or_else(|| format!("the files are {}", known.join(", ")))
            };
            Problem::new(
                &name.span,
                format!("there is no image or mesh `{bare}` in the project"),
            )
            .hint(hint)
        })
    }
}

/// Makes the problem that files of this kind are not read, if they are not: whoever keeps files
/// does not fetch them then.
fn unread_kind(name: &Name<'_>) -> Option<Box<Problem>> {
    let (_, ending) = name.text.rsplit_once('.')?;
    if is_image(name.text) || is_mesh(name.text) || is_skeleton(name.text) {
        return None;
    }
    let name_of = name.text;
    let message = format!("`{name_of}` is not read: .{ending} is no kind of file known here");
    Some(Problem::new(&name.span, message).hint(format!(
        "images can be {}, meshes {}, and skeletons {}: save it as one of these",
        picture::Format::ENDINGS,
        mesh::Format::ENDINGS,
        SKELETONS.map(|ending| format!(".{ending}")).join(", ")
    )))
}
