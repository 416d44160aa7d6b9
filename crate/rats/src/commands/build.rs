//! Makes rows of the table of commands.

use super::parameter::{OptionSpec, Parameter};
use super::spec::{Action, CommandSpec, Routine};

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
pub(super) use {clay, flesh};

pub(super) const fn row(name: &'static str, meaning: &'static str, action: Action) -> CommandSpec {
    CommandSpec {
        name,
        parameters: &[],
        meaning,
        details: "",
        default: "",
        options: &[],
        example: "",
        is_newer: false,
        action,
    }
}

pub(super) const fn run(routine: Routine) -> Action {
    Action::Run(routine)
}

pub(super) const fn idle(reason: &'static str) -> Action {
    Action::NoEffect(reason)
}

pub(super) const fn structure(name: &'static str, meaning: &'static str) -> CommandSpec {
    row(name, meaning, Action::Structure)
}

/// A command that is written in the language itself (see [`crate::library`]), which also tells its
/// parameters.
pub(super) const fn library(name: &'static str, meaning: &'static str) -> CommandSpec {
    row(name, meaning, Action::Library)
}

impl CommandSpec {
    pub(super) const fn takes(mut self, parameters: &'static [Parameter]) -> Self {
        self.parameters = parameters;
        self
    }

    pub(super) const fn default(mut self, default: &'static str) -> Self {
        self.default = default;
        self
    }

    pub(super) const fn options(mut self, options: &'static [OptionSpec]) -> Self {
        self.options = options;
        self
    }

    pub(super) const fn details(mut self, details: &'static str) -> Self {
        self.details = details;
        self
    }

    /// Newer than the first published texts: one's own command of this name hides it.
    pub(super) const fn newer(mut self) -> Self {
        self.is_newer = true;
        self
    }

    pub(super) const fn example(mut self, example: &'static str) -> Self {
        self.example = example;
        self
    }
}
