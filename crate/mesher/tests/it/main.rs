//! The tests of `mesher`, as one program: a module for each subject.

mod clipping;
mod coating;
mod contact;
mod degenerate;
mod ends;
mod file;
mod judges;
mod look;
mod painted;
mod scenes;
mod sculpted;
mod surfaces;
mod thin;
mod variation;
