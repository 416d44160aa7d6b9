//! Texts of soft shapes, compiled, and their fields.

use glam::DVec3;
use rats::{Compiled, Project, compile};
use scene::Scene;

/// Compiles a text whose eye is far away.
pub fn read(text: &str) -> Compiled {
    compile(&Project::single(format!("verbose on\neyep 0 0 90\n{text}")))
}

/// Returns the scene of a text that says nothing.
pub fn scene(text: &str) -> Scene {
    let compiled = read(text);
    assert_eq!(compiled.diagnostics, [], "{text}");
    std::sync::Arc::unwrap_or_clone(compiled.scene)
}

/// Returns the value of the first body's function.
pub fn value(scene: &Scene, place: DVec3) -> f64 {
    scene.surfaces()[0].function().jet(place).value
}
