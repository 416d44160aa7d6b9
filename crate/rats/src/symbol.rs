//! Words as small numbers, so that variables are found by index, not by comparing text.

use std::collections::HashMap;

/// A word of the project's texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Symbol(u32);

impl Symbol {
    /// Returns the index, from 0 without gaps.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The words met so far.
#[derive(Clone, Debug, Default)]
pub struct Symbols<'a> {
    symbols: HashMap<&'a str, Symbol>,
    words: Vec<&'a str>,
}

impl<'a> Symbols<'a> {
    /// Returns the symbol of a word, a new one for a new word.
    pub fn intern(&mut self, word: &'a str) -> Symbol {
        *self.symbols.entry(word).or_insert_with(|| {
            self.words.push(word);
            Symbol(u32::try_from(self.words.len() - 1).unwrap_or(u32::MAX))
        })
    }

    /// Finds the symbol of a word, if it occurs in the texts.
    #[must_use]
    pub fn find(&self, word: &str) -> Option<Symbol> {
        self.symbols.get(word).copied()
    }

    /// Returns the word of a symbol.
    #[must_use]
    pub fn word(&self, symbol: Symbol) -> &'a str {
        self.words[symbol.index()]
    }

    /// Returns the word with an index.
    #[must_use]
    pub fn at(&self, index: usize) -> &'a str {
        self.words[index]
    }

    /// Returns the number of words.
    #[must_use]
    pub fn count(&self) -> usize {
        self.words.len()
    }
}
