//! The tests of `assist`, as one program: a module for each subject.

mod complete;
mod fold;
mod format;
mod guides;
mod handles;
mod highlight;
mod hover;
mod manual;
mod names;
mod nearly_right;
mod reference;
mod signature;
mod speed;
mod texts;
