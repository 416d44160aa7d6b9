//! The table itself, in the order of appendix C: a file for each group.

mod camera;
mod extensions;
mod materials;
mod objects;
mod options;
mod primitives;
mod run;
mod scene;
mod tools;

use super::parameter::Parameter;
use super::{Action, CommandSpec, Group, OptionSpec, Run};

/// All commands, group by group.
pub static GROUPS: &[(Group, &[CommandSpec])] = &[
    (Group::Run, run::RUN),
    (Group::Camera, camera::CAMERA),
    (Group::Materials, materials::MATERIALS),
    (Group::Primitives, primitives::PRIMITIVES),
    (Group::Objects, objects::OBJECTS),
    (Group::Options, options::OPTIONS),
    (Group::Scene, scene::SCENE),
    (Group::Tools, tools::TOOLS),
    (Group::Extensions, extensions::EXTENSIONS),
];

/// The text of an example: a light, a material to be seen by it, and the shapes.
macro_rules! clay {
    ($text:literal) => {
        concat!(
            "light White, position 4 8 10\nsurface Clay, diffuse SandyBrown, specular Gray50, shine 40\n",
            $text
        )
    };
}
/// As `clay`, with a soft material.
macro_rules! flesh {
    ($text:literal) => {
        concat!(
            "light White, position 4 8 10\nsurface Flesh, diffuse SandyBrown, specular Gray50, shine 40, radius 0.6, blobbiness -2\n",
            $text
        )
    };
}
use {clay, flesh};

const fn row(name: &'static str, meaning: &'static str, action: Action) -> CommandSpec {
    CommandSpec {
        name,
        parameters: &[],
        meaning,
        details: "",
        default: "",
        options: &[],
        example: "",
        action,
    }
}

const fn run(function: Run) -> Action {
    Action::Run(function)
}

const fn later() -> Action {
    Action::Later
}

const fn idle(reason: &'static str) -> Action {
    Action::NoEffect(reason)
}

const fn structure(name: &'static str, meaning: &'static str) -> CommandSpec {
    row(name, meaning, Action::Structure)
}

/// A command that is written in the language itself (see [`crate::library`]), which also tells its
/// parameters.
const fn library(name: &'static str, meaning: &'static str) -> CommandSpec {
    row(name, meaning, Action::Library)
}

impl CommandSpec {
    const fn takes(mut self, parameters: &'static [Parameter]) -> Self {
        self.parameters = parameters;
        self
    }

    const fn default(mut self, default: &'static str) -> Self {
        self.default = default;
        self
    }

    const fn options(mut self, options: &'static [OptionSpec]) -> Self {
        self.options = options;
        self
    }

    const fn details(mut self, details: &'static str) -> Self {
        self.details = details;
        self
    }

    const fn example(mut self, example: &'static str) -> Self {
        self.example = example;
        self
    }
}
