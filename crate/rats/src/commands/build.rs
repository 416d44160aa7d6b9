//! Makes rows of the table of commands.
//!
//! ```text
//! pub static SPHERE: CommandSpec = row("sphere", "sphere; a point when soft")
//!     .with(takes!(sphere, SN, length("r", "the radius"), vector("POS", "the centre")))
//!     .example(flesh!("sphere Flesh 0.6, 0 0 0"));
//!
//! fn sphere<'a>(
//!     run: &mut Evaluator<'a>,
//!     command: &'a Command,
//!     sn: Name<'a>,
//!     radius: f64,
//!     center: DVec3,
//! ) -> Outcome<Flow> { … }
//! ```

use super::parameter::{OptionSpec, Parameter};
use super::spec::{Action, Bracket, CommandSpec, Routine};
use crate::evaluator::state::Evaluator;
use crate::limits;
use crate::syntax::Command;

/// Makes the text of an example: a light, a material `Clay`, and the commands.
macro_rules! clay {
    ($text:literal) => {
        concat!(
            "light White, position 4 8 10\n\
             surface Clay, diffuse SandyBrown, specular Gray50, shine 40\n",
            $text
        )
    };
}

/// Makes the text of an example: a light, a soft material `Flesh`, and the commands.
macro_rules! flesh {
    ($text:literal) => {
        concat!(
            "light White, position 4 8 10\n\
             surface Flesh, diffuse SandyBrown, specular Gray50, shine 40, radius 0.6, \
             blobbiness -2\n",
            $text
        )
    };
}

/// Makes a routine that reads operands and hands their values, in this order, to a function; a list
/// of options in brackets is handed on before them. In place of a function may stand a closure,
/// `|run, command, name, shift| …`.
///
/// All is read first; the function is only called if nothing was wrong.
macro_rules! reads {
    (|$run:ident, $command:ident $(, $value:ident)+| $does:expr, $($slot:expr),+ $(,)?) => {
        |$run, $command| {
            let given = $run.read_given($command)?;
            let mut values = given.values();
            let ($($value,)+) = ($(values.take(|| $slot)?,)+);
            $does
        }
    };
    ($run:path) => {
        |run, command| {
            run.read_given(command)?;
            $run(run, command)
        }
    };
    ($run:path, [$options:expr]) => {
        |run, command| {
            let given = run.read_given(command)?;
            $run(run, command, &given.options)
        }
    };
    ($run:path, [$options:expr], $($slot:expr),+ $(,)?) => {
        |run, command| {
            let given = run.read_given(command)?;
            let mut values = given.values();
            $run(run, command, &given.options, $(values.take(|| $slot)?),+)
        }
    };
    ($run:path, $($slot:expr),+ $(,)?) => {
        |run, command| {
            let given = run.read_given(command)?;
            let mut values = given.values();
            $run(run, command, $(values.take(|| $slot)?),+)
        }
    };
}

/// Makes the form of a command from the function that runs it (see `reads!`) and its operands:
/// `takes!(light, [LIGHT_OPTIONS], colour("Color", "the light's colour"))`.
macro_rules! takes {
    (|$run:ident, $command:ident $(, $value:ident)+| $does:expr, $($slot:expr),+ $(,)?) => {
        $crate::commands::build::by_itself(
            $crate::commands::build::reads!(
                |$run, $command $(, $value)+| $does, $($slot),+
            ),
            $crate::commands::build::plain![$($slot),+],
            &[],
        )
    };
    ($run:path, [$options:expr] $(, $slot:expr)* $(,)?) => {
        $crate::commands::build::by_itself(
            $crate::commands::build::reads!($run, [$options] $(, $slot)*),
            $crate::commands::build::plain![$($slot),*],
            $options,
        )
    };
    ($run:path $(, $slot:expr)* $(,)?) => {
        $crate::commands::build::by_itself(
            $crate::commands::build::reads!($run $(, $slot)*),
            $crate::commands::build::plain![$($slot),*],
            &[],
        )
    };
}

/// Makes the form of a command that sets something to the values of its operands:
/// `sets!(|run, gamma| run.settings.gamma = gamma as f32, number("value", "gamma"))`.
macro_rules! sets {
    (|$run:ident $(, $value:ident)+| $set:expr, $($slot:expr),+ $(,)?) => {
        $crate::commands::build::takes!(
            |$run, command $(, $value)+| {
                $set;
                Ok($crate::evaluator::state::Flow::Next)
            },
            $($slot),+
        )
    };
}

/// Makes parameters as the table keeps them.
macro_rules! plain {
    ($($slot:expr),* $(,)?) => { &[$($slot.plain),*] };
}

/// Makes options and the list of them. Each has the type of its operands, its word, its default,
/// its meaning and the operands, at most three:
/// `options! { LIST: ANGLE: f64 = ("angle", "30", "the angle", degrees("a", "the angle")); }`.
macro_rules! options {
    ($(#[$doc:meta])* $list:ident: $($name:ident: $kind:ty = ($($choice:tt)+);)+) => {
        $(
            pub(super) const $name: $crate::commands::slot::Choice<$kind> =
                $crate::commands::build::choice!($($choice)+);
        )+
        $(#[$doc])*
        pub static $list: &[$crate::commands::OptionSpec] =
            $crate::commands::build::plain![$($name),+];
    };
}

/// Makes an option of its word, default, meaning and operands.
macro_rules! choice {
    (@option $name:literal, $default:literal, $meaning:expr $(, $slot:expr)*) => {
        $crate::commands::build::option(
            $name,
            $default,
            $meaning,
            $crate::commands::build::plain![$($slot),*],
        )
    };
    ($name:literal, $default:literal, $meaning:expr) => {
        $crate::commands::slot::Choice::none(
            $crate::commands::build::choice!(@option $name, $default, $meaning),
        )
    };
    ($name:literal, $default:literal, $meaning:expr, $a:expr) => {
        $crate::commands::slot::Choice::one(
            $crate::commands::build::choice!(@option $name, $default, $meaning, $a),
            || $a,
        )
    };
    ($name:literal, $default:literal, $meaning:expr, $a:expr, $b:expr) => {
        $crate::commands::slot::Choice::two(
            $crate::commands::build::choice!(@option $name, $default, $meaning, $a, $b),
            || $a,
            || $b,
        )
    };
    ($name:literal, $default:literal, $meaning:expr, $a:expr, $b:expr, $c:expr) => {
        $crate::commands::slot::Choice::three(
            $crate::commands::build::choice!(@option $name, $default, $meaning, $a, $b, $c),
            || $a,
            || $b,
            || $c,
        )
    };
}
pub(crate) use {choice, clay, flesh, options, plain, reads, sets, takes};

/// The way in which a command is written and carried out.
pub struct Form {
    pub parameters: &'static [Parameter],
    pub options: &'static [OptionSpec],
    pub action: Action,
}

/// Makes the form of a command whose function reads its operands by itself.
pub const fn by_itself(
    run: Routine,
    parameters: &'static [Parameter],
    options: &'static [OptionSpec],
) -> Form {
    Form {
        parameters,
        options,
        action: Action::Run(run),
    }
}

/// Makes the form of a command that changes nothing, for this reason.
pub const fn idle(reason: &'static str, parameters: &'static [Parameter]) -> Form {
    Form {
        parameters,
        options: &[],
        action: Action::NoEffect(reason),
    }
}

/// Makes the form of a command that the parser makes part of the tree.
pub const fn structure(parameters: &'static [Parameter]) -> Form {
    Form {
        parameters,
        options: &[],
        action: Action::Structure,
    }
}

/// The form of a command that is written in the language itself (see [`crate::library`]), which
/// also tells its parameters.
pub const LIBRARY: Form = Form {
    parameters: &[],
    options: &[],
    action: Action::Library,
};

/// Name and meaning of a command, from which [`Opcode::with`] makes its row.
pub struct Opcode {
    name: &'static str,
    meaning: &'static str,
}

/// Begins a row of the table.
pub const fn row(name: &'static str, meaning: &'static str) -> Opcode {
    Opcode { name, meaning }
}

impl Opcode {
    /// Makes the row of a command that is written and carried out so.
    pub const fn with(self, form: Form) -> CommandSpec {
        CommandSpec {
            name: self.name,
            parameters: form.parameters,
            meaning: self.meaning,
            details: "",
            default: "",
            options: form.options,
            example: "",
            bracket: None,
            includes: false,
            is_newer: false,
            interrupts: false,
            most_operands: limits::MAX_OPERANDS,
            action: form.action,
            mark_failed: None,
        }
    }
}

impl CommandSpec {
    pub(crate) const fn default(mut self, default: &'static str) -> Self {
        self.default = default;
        self
    }

    pub(crate) const fn details(mut self, details: &'static str) -> Self {
        self.details = details;
        self
    }

    /// Marks it as newer than the first published texts: one's own command of this name hides it.
    pub(crate) const fn newer(mut self) -> Self {
        self.is_newer = true;
        self
    }

    pub(crate) const fn example(mut self, example: &'static str) -> Self {
        self.example = example;
        self
    }

    /// Marks it as one that ends or undoes the run of the text it stands in.
    pub(crate) const fn interrupts(mut self) -> Self {
        self.interrupts = true;
        self
    }

    /// Lets it begin or end a group of shapes.
    pub(crate) const fn bracket(mut self, bracket: Bracket) -> Self {
        self.bracket = Some(bracket);
        self
    }

    /// Marks it as one that runs the texts of the files that it names.
    pub(crate) const fn includes(mut self) -> Self {
        self.includes = true;
        self
    }

    /// Lets more operands than usual stand behind it.
    pub(crate) const fn most_operands(mut self, most: usize) -> Self {
        self.most_operands = most;
        self
    }

    /// Lets this be run where the command fails.
    pub(crate) const fn mark_failed(
        mut self,
        mark: for<'a> fn(&mut Evaluator<'a>, &'a Command),
    ) -> Self {
        self.mark_failed = Some(mark);
        self
    }
}

/// Makes an option as the table keeps it.
pub const fn option(
    name: &'static str,
    default: &'static str,
    meaning: &'static str,
    parameters: &'static [Parameter],
) -> OptionSpec {
    OptionSpec {
        name,
        parameters,
        meaning,
        default,
    }
}

/// Makes an option of a word alone.
pub const fn word_of(name: &'static str, meaning: &'static str) -> OptionSpec {
    option(name, "", meaning, &[])
}
