//! Meshes that cut the limbs of a skeleton, as beam lattices are clipped.

use crate::options::{MeshError, Progress};
use crate::unite;
use mesh::TriangleMesh;
use scene::curves::Clip;
use scene::{Element, Function, Scene, Shape, Surface};
use std::collections::BTreeMap;

/// Most triangles of the meshes that cut a surface.
const MOST_TRIANGLES: usize = 100_000;

/// Closed meshes that a surface is cut by.
pub struct Clipping {
    is_inside: bool,
    meshes: Vec<TriangleMesh>,
    is_too_large: bool,
}

impl Clipping {
    /// Returns the meshes that cut a soft body; `None` if nothing cuts it, or if its elements are
    /// not all cut by the same meshes at the same place, of which a note tells. Elements of a
    /// command without meshes of their own, as the balls of a lattice, are cut by those of the
    /// command's others.
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
        // Whether each command has meshes that cut.
        let mut commands: BTreeMap<_, bool> = BTreeMap::new();
        let mut clips: Vec<(&Function, &Clip)> = Vec::new();
        for element in elements {
            let own = clip_of(element);
            *commands.entry(place_of(element)).or_default() |= own.is_some();
            clips.extend(own);
        }
        let first = clips.first()?;
        let is_mixed = commands.values().any(|has_clip| !has_clip)
            || clips.iter().any(|own| !is_same(own, first));
        if is_mixed {
            notes.push(format!(
                "{name}: not clipped, as other limbs or shapes of the body are not clipped so"
            ));
            return None;
        }
        Some(Self::new(first))
    }

    fn new((function, clip): &(&Function, &Clip)) -> Self {
        let triangles = clip.meshes.iter().map(|(_, triangles)| triangles.len());
        let is_too_large = triangles.sum::<usize>() > MOST_TRIANGLES;
        let mut meshes: Vec<TriangleMesh> = Vec::new();
        for (positions, triangles) in clip.meshes.iter().filter(|_| !is_too_large) {
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
            meshes.push(mesh);
        }
        Self {
            is_inside: clip.is_inside,
            meshes,
            is_too_large,
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
        let cut = if self.is_too_large {
            Err(MeshError::Failed(format!(
                "the mesh that clips it has more than {MOST_TRIANGLES} triangles"
            )))
        } else {
            unite::clip(mesh, &self.meshes, self.is_inside, progress)
        };
        match cut {
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
            Err(MeshError::Failed(why)) => {
                let note = format!("{name}: not clipped, as {why}");
                if notes.last() != Some(&note) {
                    notes.push(note);
                }
                Ok(false)
            }
            Err(other) => Err(other),
        }
    }
}

/// A mesh that cuts an element, with its place.
type OwnClip<'a> = (&'a Function, &'a Clip);

/// The meshes that cut the hard elements of a scene. They are placed one element at a time, as
/// there may be many copies.
pub struct HardClips<'a> {
    /// Elements with what cuts them, in their order, by the command that made them.
    of: BTreeMap<[u32; 3], Vec<(&'a Element, OwnClip<'a>)>>,
    last: Option<(OwnClip<'a>, Clipping)>,
}

impl<'a> HardClips<'a> {
    /// Lists the meshes of a scene.
    pub fn new(scene: &'a Scene) -> Self {
        let mut of: BTreeMap<_, Vec<_>> = BTreeMap::new();
        for element in &scene.elements {
            if let Some(own) = clip_of(element) {
                of.entry(place_of(element))
                    .or_default()
                    .push((element, own));
            }
        }
        Self { of, last: None }
    }

    /// Returns the meshes that cut an element of the scene. One without its own, as a ball of a
    /// lattice, is cut by those of the last element before it that the same command made, and
    /// otherwise by those of the first behind it: copies stand together.
    pub fn find(&mut self, element: &Element) -> Option<&Clipping> {
        let all = self.of.get(&place_of(element))?;
        let before = all.partition_point(|(other, _)| {
            core::ptr::from_ref(*other) <= core::ptr::from_ref(element)
        });
        let (_, clip) = all[before.saturating_sub(1)];
        if !(self.last.as_ref()).is_some_and(|(last, _)| is_same(last, &clip)) {
            self.last = Some((clip, Clipping::new(&clip)));
        }
        self.last.as_ref().map(|(_, clipping)| clipping)
    }
}

/// The place of the command that made an element.
fn place_of(element: &Element) -> [u32; 3] {
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

/// Whether two elements are cut by the same meshes at the same place.
fn is_same((function, clip): &(&Function, &Clip), (other, others): &(&Function, &Clip)) -> bool {
    let is_one = core::ptr::eq(*clip, *others);
    function.to_world == other.to_world && (is_one || clip == others)
}
