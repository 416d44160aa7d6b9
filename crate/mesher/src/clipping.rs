//! Meshes that cut the limbs of a skeleton, as beam lattices are clipped.

use crate::options::{MeshError, Progress};
use crate::unite;
use mesh::TriangleMesh;
use scene::curves::Clip;
use scene::{Element, Function, Scene, Shape, Surface};
use std::collections::BTreeMap;

/// Closed meshes that a surface is cut by.
pub struct Clipping {
    is_inside: bool,
    meshes: Vec<TriangleMesh>,
}

impl Clipping {
    /// Returns what a soft body is cut by; `None` if nothing cuts it. A note says if it cuts only
    /// some of the body's elements, which then are not cut.
    pub fn of_body(
        scene: &Scene,
        surface: &Surface,
        name: &str,
        notes: &mut Vec<String>,
    ) -> Option<Self> {
        let mut elements = surface.element().to_vec();
        elements.sort_unstable();
        elements.dedup();
        let elements = elements.iter().map(|i| &scene.elements[*i as usize]);
        // What one command makes is clipped together.
        let mut by_command: BTreeMap<_, Vec<(&Function, &Clip)>> = BTreeMap::new();
        for element in elements {
            let own = by_command.entry(place_of(element)).or_default();
            own.extend(clip_of(element));
        }
        let clips: Vec<_> = by_command.values().flatten().copied().collect();
        let &(_, first) = clips.first()?;
        let is_mixed = by_command.values().any(Vec::is_empty)
            || clips
                .iter()
                .any(|(_, clip)| clip.is_inside != first.is_inside);
        if is_mixed {
            notes.push(format!(
                "{name}: not clipped, as other limbs or shapes of the body are not clipped so"
            ));
            return None;
        }
        Some(Self::new(&clips))
    }

    /// Returns what each command's elements are cut by, for hard ones.
    pub fn by_command(scene: &Scene) -> BTreeMap<[u32; 3], Self> {
        let mut clips: BTreeMap<_, Vec<(&Function, &Clip)>> = BTreeMap::new();
        for element in &scene.elements {
            if let Some(own) = clip_of(element) {
                clips.entry(place_of(element)).or_default().push(own);
            }
        }
        let clips = clips.into_iter();
        clips.map(|(place, own)| (place, Self::new(&own))).collect()
    }

    fn new(clips: &[(&Function, &Clip)]) -> Self {
        let mut meshes: Vec<TriangleMesh> = Vec::new();
        for (function, clip) in clips {
            for (positions, triangles) in &clip.meshes {
                let positions = positions.iter();
                let mut mesh = TriangleMesh::new(
                    positions
                        .map(|p| function.to_world.transform_point3(*p))
                        .collect(),
                    triangles.clone(),
                );
                let is_sound = mesh.positions.iter().all(|p| p.is_finite())
                    && (mesh.triangles.as_flattened().iter())
                        .all(|i| (*i as usize) < mesh.positions.len());
                if !is_sound {
                    mesh = TriangleMesh::default();
                } else if mesh.signed_volume() < 0.0 {
                    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
                }
                // Elements of several materials have the same.
                if !meshes.contains(&mesh) {
                    meshes.push(mesh);
                }
            }
        }
        Self {
            is_inside: clips.first().is_none_or(|(_, clip)| clip.is_inside),
            meshes,
        }
    }

    /// Cuts a closed mesh, and returns whether it was cut; a note says if it could not be.
    ///
    /// # Errors
    /// If the caller cancels.
    pub fn apply(
        &self,
        mesh: &mut TriangleMesh,
        name: &str,
        notes: &mut Vec<String>,
        progress: &mut Progress<'_>,
    ) -> Result<bool, MeshError> {
        match unite::clip(mesh, &self.meshes, self.is_inside, progress) {
            Ok(cut) => {
                let side = if self.is_inside { "inside" } else { "outside" };
                if cut.triangles.is_empty() {
                    notes.push(format!(
                        "{name}: nothing is left {side} of the mesh that clips it"
                    ));
                }
                *mesh = cut;
                Ok(true)
            }
            Err(MeshError::Failed(_)) => {
                notes.push(format!(
                    "{name}: not clipped, as the mesh that clips it is not closed"
                ));
                Ok(false)
            }
            Err(other) => Err(other),
        }
    }
}

/// The place of the command that made an element.
pub fn place_of(element: &Element) -> [u32; 3] {
    [
        element.origin.file,
        element.origin.start,
        element.origin.end,
    ]
}

/// The meshes that cut an element's curves, with the function that places them.
fn clip_of(element: &Element) -> Option<(&Function, &Clip)> {
    let Shape::Function(function) = &element.shape else {
        return None;
    };
    let clip = function.curves()?.clip.as_deref()?;
    Some((function, clip))
}
