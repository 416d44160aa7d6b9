//! The state of a running text besides the scene: variables, random numbers and steps.

use crate::limits;
use crate::problem::{Outcome, Problem};
use crate::random::Random;
use crate::symbol::{Symbol, Symbols};
use crate::value::Value;
use std::cell::Cell;
use std::ops::Range;

/// A variable's slot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Slot {
    /// Never set.
    #[default]
    Empty,
    /// Missing: the command failed, which was reported; uses of it are not reported again.
    Broken,
    /// Set.
    Full(Value),
}

/// The variables, the random stream and the step counter.
#[derive(Debug)]
pub struct Scope<'a> {
    /// The words of all texts.
    pub symbols: Symbols<'a>,
    /// The stream of `rand`.
    pub random: Random,
    globals: Vec<Slot>,
    /// Parameters and variables of the running calls; the innermost call's begin at `frame`.
    locals: Vec<(Symbol, Value)>,
    frame: usize,
    calls: usize,
    steps: Cell<u64>,
}

/// The state to restore when a call ends.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    start: usize,
}

impl<'a> Scope<'a> {
    /// Makes a scope without variables.
    #[must_use]
    pub fn new(symbols: Symbols<'a>) -> Self {
        let globals = vec![Slot::Empty; symbols.count()];
        Self {
            symbols,
            random: Random::new(0.0),
            globals,
            locals: Vec::new(),
            frame: 0,
            calls: 0,
            steps: Cell::new(0),
        }
    }

    /// Counts work.
    ///
    /// # Errors
    /// Fatally, when the text has done more than [`limits::MAX_STEPS`].
    pub fn step(&mut self, cost: u64, span: &Range<usize>) -> Outcome<()> {
        self.charge(cost);
        if self.steps.get() <= limits::MAX_STEPS {
            return Ok(());
        }
        Err(Problem::new(
            span,
            format!(
                "stopped here: the text took more than {} steps",
                limits::MAX_STEPS
            ),
        )
        .hint("make the loops shorter")
        .fatal())
    }

    /// Returns the work counted so far.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps.get()
    }

    /// Counts work that the next [`Self::step`] may refuse to go on from.
    fn charge(&self, cost: u64) {
        self.steps.set(self.steps.get().saturating_add(cost));
    }

    /// Counts a look through the variables of the running call, which takes time where there are
    /// many.
    fn charge_locals(&self) {
        self.charge((self.locals.len() - self.frame) as u64 / 16);
    }

    /// Returns the value of a variable: of the running call, else of the whole text.
    #[must_use]
    pub fn get(&self, name: Symbol) -> Option<Value> {
        self.charge_locals();
        if let Some((_, value)) = self.locals[self.frame..]
            .iter()
            .rev()
            .find(|(local, _)| *local == name)
        {
            return Some(*value);
        }
        match self.globals.get(name.index()) {
            Some(Slot::Full(value)) => Some(*value),
            _ => None,
        }
    }

    /// Returns whether the command that should have set a variable failed.
    #[must_use]
    pub fn is_broken(&self, name: Symbol) -> bool {
        self.globals.get(name.index()) == Some(&Slot::Broken)
    }

    /// Sets a variable: of the running call if there is one, else of the whole text.
    pub fn set(&mut self, name: Symbol, value: Value) {
        self.charge_locals();
        if self.calls == 0 {
            if let Some(slot) = self.globals.get_mut(name.index()) {
                *slot = Slot::Full(value);
            }
        } else if let Some((_, slot)) = self.locals[self.frame..]
            .iter_mut()
            .rev()
            .find(|(local, _)| *local == name)
        {
            *slot = value;
        } else {
            self.locals.push((name, value));
        }
    }

    /// Marks a variable that should have been set but was not, unless it has a value already.
    pub fn set_broken(&mut self, name: Symbol) {
        if let Some(slot @ Slot::Empty) = self.globals.get_mut(name.index()) {
            *slot = Slot::Broken;
        }
    }

    /// Puts a variable back to what it was, possibly nothing (at the end of a loop).
    pub fn restore(&mut self, name: Symbol, value: Option<Value>) {
        if let Some(value) = value {
            self.set(name, value);
        } else if self.calls == 0 {
            self.globals[name.index()] = Slot::Empty;
        } else if let Some(index) = self.locals[self.frame..]
            .iter()
            .rposition(|(local, _)| *local == name)
        {
            self.locals.remove(self.frame + index);
        }
    }

    /// Forgets the variables of the whole text.
    pub fn clear(&mut self) {
        self.charge(self.globals.len() as u64 / 16);
        self.globals.fill(Slot::Empty);
    }

    /// Begins a call with these parameters.
    pub fn enter(&mut self, parameters: impl Iterator<Item = (Symbol, Value)>) -> Frame {
        let before = Frame { start: self.frame };
        self.frame = self.locals.len();
        self.locals.extend(parameters);
        self.calls += 1;
        before
    }

    /// Ends the call that [`Self::enter`] began.
    pub fn leave(&mut self, before: Frame) {
        self.locals.truncate(self.frame);
        self.frame = before.start;
        self.calls -= 1;
    }

    /// Returns the number of calls that are running.
    #[must_use]
    pub fn calls(&self) -> usize {
        self.calls
    }

    /// Returns all variables that are set, with their values.
    pub fn variables(&self) -> impl Iterator<Item = (&'a str, Value)> {
        let locals = self.locals[self.frame..].iter().copied();
        let globals = self.globals.iter().enumerate();
        let globals = globals.filter_map(|(index, slot)| match slot {
            Slot::Full(value) => Some((self.symbols.at(index), *value)),
            _ => None,
        });
        globals.chain(locals.map(|(name, value)| (self.symbols.word(name), value)))
    }

    /// Returns the names of all variables that are set, for suggestions.
    pub fn names(&self) -> impl Iterator<Item = &'a str> {
        let locals = self.locals[self.frame..].iter().map(|(name, _)| *name);
        let globals = (0..self.globals.len())
            .filter(|index| matches!(self.globals[*index], Slot::Full(_)))
            .map(|index| self.symbols.at(index));
        locals.map(|name| self.symbols.word(name)).chain(globals)
    }
}
