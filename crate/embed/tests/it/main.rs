//! Tests of the models of other pages.

mod model;
