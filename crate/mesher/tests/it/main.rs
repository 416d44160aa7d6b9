//! The tests of `mesher`, as one program: a module for each subject.

mod coating;
mod contact;
mod degenerate;
mod file;
mod judges;
mod painted;
mod scenes;
mod sculpted;
mod surfaces;
mod thin;
mod variation;
