//! The tests of `sketch`, as one program: a module for each subject.

mod cuts;
mod feet;
mod texts;
