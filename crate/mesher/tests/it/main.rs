//! The tests of `mesher`, as one program: a module for each subject.

mod coating;
mod contact;
mod degenerate;
mod judges;
mod painted;
mod scenes;
mod sculpted;
mod surfaces;
mod thin;
mod variation;

#[allow(dead_code, reason = "the tracer's tests use the rest")]
#[path = "../../../tracer/tests/it/common/mod.rs"]
mod common;
#[allow(dead_code, reason = "the tracer's tests use the rest")]
#[path = "../../../tracer/tests/it/random.rs"]
mod random;
