//! The table itself, in the order of appendix C: a file for each group.

mod camera;
mod extensions;
mod materials;
mod objects;
mod options;
mod primitives;
mod run;
mod scene;
mod tools;

use super::spec::{CommandSpec, Group};

/// All commands, group by group.
pub static GROUPS: &[(Group, &[CommandSpec])] = &[
    (Group::Run, run::RUN),
    (Group::Camera, camera::CAMERA),
    (Group::Materials, materials::MATERIALS),
    (Group::Primitives, primitives::PRIMITIVES),
    (Group::Objects, objects::OBJECTS),
    (Group::Options, options::OPTIONS),
    (Group::Scene, scene::SCENE),
    (Group::Tools, tools::TOOLS),
    (Group::Extensions, extensions::EXTENSIONS),
];
