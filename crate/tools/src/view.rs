//! The job of meshing a scene's soft surfaces for the eye: a picture of them for as long as the
//! user turns the model or drags a part of it.
//!
//! The result is bytes as a GPU takes them, so that the page has nothing to convert in the frame in
//! which it comes.

use crate::job::{Job, Pace, Progress};
use glam::DVec3;
use mesh::{Aabb, TriangleMesh};
use mesher::{Cage, MeshError, Spoke, look};
use scene::{Scene, SoftSurface, Surface};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;
use wide::f32x8;

/// Least and most side of cells where a surface bends, in diagonals of the skeletons' box with
/// their flesh.
const CELLS: [f64; 2] = [1.0 / 150.0, 1.0 / 50.0];
/// Side of those cells in radii of the thinnest part, within the limits of [`CELLS`].
const OF_RADIUS: f64 = 1.0;
/// Side of the cells for a fine mesh relative to those for a coarse one.
const FINER: f64 = 0.5;
/// Tolerance of a coarse mesh, in sides of the smallest usual cells.
const OFF: f64 = 0.06;

/// The closeness of the mesh of a [`ViewScene`] to the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Detail {
    /// Coarse enough to follow the user's hand.
    Coarse,
    /// Too fine for the eye to see a difference.
    Fine,
}

/// Meshes the soft surfaces of a scene for the eye while the user moves something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewScene {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Parameters of each finish that the view shows, 0 … 1, which are mixed by the shares of the
    /// elements: ambient, diffuse and specular colours, and the shine.
    pub looks: Vec<[f32; 10]>,
    /// The closeness wanted.
    pub detail: Detail,
}

/// A mesh for the eye: bytes as a GPU takes them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ViewMesh {
    /// The origin of the vertices' positions in the scene.
    pub origin: DVec3,
    /// Length of a unit of their positions.
    pub unit: f64,
    /// Vertices of [`ViewMesh::VERTEX`] bytes each: position (three `f32`), normal (four `i16`,
    /// parts of 32767, the last one 0), then parts of 255: the ambient colour and the shine, the
    /// diffuse colour and 1, the specular colour and 1.
    #[serde(with = "serde_bytes")]
    pub vertices: Vec<u8>,
    /// Numbers of the triangles' vertices, three `u32` each.
    #[serde(with = "serde_bytes")]
    pub triangles: Vec<u8>,
}

impl ViewMesh {
    /// Bytes of a vertex.
    pub const VERTEX: usize = 32;
}

impl Job for ViewScene {
    type Output = ViewMesh;
    const PACE: Pace = Pace::Quick;

    fn run(self, progress: &mut Progress<'_, ViewMesh>) -> Result<ViewMesh, String> {
        let Self {
            scene,
            looks,
            detail,
        } = self;
        let surfaces = scene.surfaces();
        let cages: Vec<Vec<Cage>> = surfaces
            .iter()
            .map(|surface| Cage::of_surface(&scene, surface))
            .collect();
        let spokes = cages.iter().flatten().flat_map(|cage| &cage.spokes);
        let thinnest = spokes
            .clone()
            .map(Spoke::radius)
            .fold(f64::INFINITY, f64::min);
        let bounds = Aabb::of_points(spokes.flat_map(|spoke| {
            let radius = spoke.radius();
            [spoke.origin - radius, spoke.origin + radius]
        }));
        let size = bounds.size().length();
        let is_sound = size > 0.0 && size.is_finite() && thinnest > 0.0;
        if !is_sound {
            return Err("there is no soft surface to see".into());
        }
        let [least, most] = CELLS.map(|share| share * size);
        let step = (OF_RADIUS * thinnest).clamp(least, most);
        let sizes = match detail {
            Detail::Coarse => [OFF * step, step],
            Detail::Fine => [FINER * FINER * OFF * step, FINER * step],
        };
        let mut view = ViewMesh {
            origin: bounds.center(),
            unit: 0.5 * size,
            ..ViewMesh::default()
        };
        for (i, (surface, cages)) in surfaces.iter().zip(&cages).enumerate() {
            let [start, end] = [i, i + 1].map(|done| done as f32 / surfaces.len() as f32);
            let mut told =
                |step: mesher::Step| progress.report(start + step.fraction * (end - start));
            let mut told = mesher::Progress::new(&mut told);
            let mesh = match look(surface.function(), cages, sizes, &mut told) {
                Err(MeshError::Nothing) => continue,
                mesh => mesh.map_err(|error| error.to_string())?,
            };
            add(&mut view, &scene, &looks, surface, &mesh);
        }
        if view.triangles.is_empty() {
            return Err("there is no soft surface to see".into());
        }
        Ok(view)
    }
}

/// Appends a surface's mesh.
fn add(
    view: &mut ViewMesh,
    scene: &Scene,
    looks: &[[f32; 10]],
    surface: &Surface,
    mesh: &TriangleMesh,
) {
    let first = (view.vertices.len() / ViewMesh::VERTEX) as u32;
    let looks = mix_looks(scene, looks, surface, &mesh.positions);
    let normals = mesh.normals.as_deref().unwrap_or_default();
    for (i, (position, look)) in mesh.positions.iter().zip(looks).enumerate() {
        let own = (*position - view.origin) / view.unit;
        let normal = normals.get(i).copied().unwrap_or_default();
        let [x, y, z] = (normal.normalize_or_zero() * 32767.0).to_array();
        let bytes = &mut view.vertices;
        for place in own.as_vec3().to_array() {
            bytes.extend(place.to_le_bytes());
        }
        for part in [x, y, z, 0.0] {
            bytes.extend((part as i16).to_le_bytes());
        }
        let [ar, ag, ab, dr, dg, db, sr, sg, sb, shine] = look;
        let colours = [ar, ag, ab, shine, dr, dg, db, 1.0, sr, sg, sb, 1.0];
        bytes.extend(colours.map(|x| (255.0 * x.clamp(0.0, 1.0) + 0.5) as u8));
    }
    for corner in mesh.triangles.iter().flatten() {
        view.triangles.extend((first + corner).to_le_bytes());
    }
}

/// Returns the coordinates of up to eight points; the last one fills the other lanes.
fn eight(points: &[DVec3]) -> [f32x8; 3] {
    let last = points.len() - 1;
    [0, 1, 2].map(|axis| f32x8::from(core::array::from_fn(|i| points[i.min(last)][axis] as f32)))
}

/// Returns the mean of looks by their weights.
fn mix(looks: &[[f32; 10]], weights: &[f32]) -> [f32; 10] {
    let total: f32 = weights.iter().sum();
    let mut sum = [0.0; 10];
    for (weight, look) in weights.iter().zip(looks) {
        for (sum, own) in sum.iter_mut().zip(look) {
            *sum += weight / total * own;
        }
    }
    sum
}

/// Returns the looks at points of a surface: those of its elements, mixed by their shares.
fn mix_looks(
    scene: &Scene,
    looks: &[[f32; 10]],
    surface: &Surface,
    points: &[DVec3],
) -> Vec<[f32; 10]> {
    // The looks of the surface's finishes, each once, and their numbers by element.
    let mut numbers = BTreeMap::new();
    let mut own: Vec<[f32; 10]> = Vec::new();
    let mut of: Vec<usize> = Vec::new();
    for element in surface.element() {
        let element = scene.elements.get(*element as usize);
        let finish = element.map_or(0, |element| element.finish);
        of.push(*numbers.entry(finish).or_insert_with(|| {
            own.push(looks.get(finish as usize).copied().unwrap_or([0.0; 10]));
            own.len() - 1
        }));
    }
    if let [only] = own[..] {
        return vec![only; points.len()];
    }
    let mut all = Vec::with_capacity(points.len());
    match surface {
        Surface::Sum(SoftSurface { sum, .. }) => {
            for chunk in points.chunks(8) {
                let places = eight(chunk);
                let mut weights = vec![f32x8::splat(0.0); own.len()];
                for (primitive, finish) in sum.primitives.iter().zip(&of) {
                    let value = primitive.value(places);
                    weights[*finish] += value.fast_max(f32x8::splat(0.0));
                }
                let lanes: Vec<[f32; 8]> = weights.into_iter().map(f32x8::to_array).collect();
                all.extend((0..chunk.len()).map(|i| {
                    let weights: Vec<f32> = lanes.iter().map(|lane| lane[i]).collect();
                    mix(&own, &weights)
                }));
            }
        }
        Surface::Composed(surface) => {
            let mut shares = Vec::new();
            for point in points {
                shares.clear();
                surface.function.shares(*point, &mut shares);
                let mut weights = vec![0.0; own.len()];
                for (element, share) in &shares {
                    if let Some(finish) = of.get(*element as usize) {
                        weights[*finish] += *share as f32;
                    }
                }
                all.push(mix(&own, &weights));
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::{Element, Finish, Flesh, Shape};

    /// Returns a scene of two soft balls that blend, of two finishes, and a hard one.
    fn scene(x: f64) -> Scene {
        let mut scene = Scene {
            finishes: vec![Finish::default(), Finish::default()],
            ..Scene::default()
        };
        scene.flesh.push(Flesh {
            blobbiness: Some(2.0),
            ..Flesh::default()
        });
        scene.elements = vec![
            ball(0.0, 0, Some(0)),
            ball(x, 1, Some(0)),
            ball(9.0, 0, None),
        ];
        scene
    }

    fn ball(x: f64, finish: u32, flesh: Option<u32>) -> Element {
        Element {
            flesh,
            finish,
            ..Element::new(Shape::sphere(DVec3::new(x, 0.0, 0.0), 1.0))
        }
    }

    fn looks() -> Vec<[f32; 10]> {
        let mut red = [0.0; 10];
        red[3] = 1.0;
        let mut blue = [0.0; 10];
        blue[5] = 1.0;
        blue[9] = 1.0;
        vec![red, blue]
    }

    fn view(x: f64, detail: Detail) -> ViewMesh {
        let job = ViewScene {
            scene: Arc::new(scene(x)),
            looks: looks(),
            detail,
        };
        job.run(&mut Progress::silent()).unwrap()
    }

    /// Returns the corners' places, normals, and twelve bytes of colours.
    fn corners(view: &ViewMesh) -> Vec<(DVec3, DVec3, [u8; 12])> {
        let corners = view.vertices.chunks_exact(ViewMesh::VERTEX).map(|bytes| {
            let place = [0, 4, 8]
                .map(|at| f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())));
            let normal = [12, 14, 16].map(|at| {
                f64::from(i16::from_le_bytes(bytes[at..at + 2].try_into().unwrap())) / 32767.0
            });
            (
                view.origin + DVec3::from_array(place) * view.unit,
                DVec3::from_array(normal),
                bytes[20..32].try_into().unwrap(),
            )
        });
        corners.collect()
    }

    #[test]
    fn corners_lie_on_the_surface_and_colours_follow_the_shares() {
        for detail in [Detail::Coarse, Detail::Fine] {
            let view = view(1.6, detail);
            let scene = scene(1.6);
            let surfaces = scene.surfaces();
            let function = surfaces[0].function();
            let all = corners(&view);
            assert!(all.len() > 100, "{detail:?} {}", all.len());
            for (place, normal, colours) in &all {
                let jet = function.jet(*place);
                // In a coarse mesh some corners stay inside.
                let is_on = (jet.value - 1.0).abs() < 0.02;
                assert!(
                    is_on || (detail == Detail::Coarse && jet.value > 1.0),
                    "{}",
                    jet.value
                );
                let outward = -DVec3::from_array(jet.gradient).normalize();
                assert!(normal.dot(outward) > 0.999 || !is_on);
                let [.., shine, red, _, blue, _, _, _, _, _] = *colours;
                let sum = u32::from(red) + u32::from(blue);
                assert!(
                    sum.abs_diff(255) <= 1 && shine.abs_diff(blue) <= 1,
                    "{colours:?}"
                );
                if place.x < -0.5 {
                    assert!(red > 200);
                }
                if place.x > 2.1 {
                    assert!(blue > 200);
                }
            }
            let numbers = view.triangles.chunks_exact(4);
            let most = numbers
                .map(|n| u32::from_le_bytes(n.try_into().unwrap()))
                .max();
            assert_eq!(most, Some(all.len() as u32 - 1));
            // The hard ball is not part of it.
            assert!(all.iter().all(|(place, ..)| place.x < 4.0));
        }
    }

    #[test]
    fn finer_mesh_has_more_triangles() {
        let [coarse, fine] = [Detail::Coarse, Detail::Fine].map(|detail| view(1.6, detail));
        assert!(fine.triangles.len() > 3 * coarse.triangles.len());
    }

    #[test]
    fn nothing_to_see_is_an_error() {
        for detail in [Detail::Coarse, Detail::Fine] {
            let job = ViewScene {
                scene: Arc::default(),
                looks: Vec::new(),
                detail,
            };
            let error = job.run(&mut Progress::silent()).unwrap_err();
            assert!(error.contains("no soft surface"), "{error}");
        }
    }
}
