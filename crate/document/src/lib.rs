//! The user's work without a window: its texts, images and meshes, its undo steps, the scene that
//! they make, its way to storage, links and files, and the jobs that are done on it.
//!
//! - [`session`]: texts, undo steps ([`history`]), compiling, the present scene and camera
//! - [`work`]: the open work and its origin; [`storage`] keeps works and their [`versions`],
//!   [`share`] makes links of them, [`project_file`] files,
//!   [`intake`] sorts files from outside, [`examples`] lists ours
//! - [`heavy`]: scenes whose pictures are not begun unasked
//! - [`player`]: the frames of a film; [`desk`]: the files that jobs on pictures find
//! - [`reading`], [`fitting`], [`mesh_export`]: jobs of the tools workers

pub mod asset;
pub mod desk;
pub mod examples;
pub mod fitting;
pub mod heavy;
pub mod history;
pub mod intake;
pub mod mesh_export;
pub mod numerals;
pub mod picture;
pub mod player;
pub mod project_file;
pub mod reading;
pub mod session;
pub mod share;
pub mod size;
pub mod storage;
mod typed;
pub mod versions;
pub mod work;
