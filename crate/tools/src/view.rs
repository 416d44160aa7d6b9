//! Meshes of a scene's soft surfaces for the eye: what the page shows while a hand turns the model or drags a part of it.
//!
//! A coarse one is a coating, which starts from what the last one found; a fine one is within a tolerance. The result is bytes as a GPU takes
//! them, so that the page has nothing to do with it in the frame in which it comes.

use crate::job::Progress;
use crate::message::{Detail, ViewJob, ViewMesh, pack, unpack};
use core::ops::ControlFlow;
use glam::DVec3;
use mesh::{Aabb, TriangleMesh};
use mesher::{Cage, Coating, Options};
use scene::{Scene, Surface};

/// Largest |f − T| in the middle of a coating's edge.
const BOUND: f64 = 0.08;
/// Tolerance of a fine mesh, as a share of the diagonal of the surfaces' box.
const TOLERANCE: f64 = 1e-3;
/// Most triangles of a body's fine mesh: of a model that has more, the coating is all that is seen.
const MOST_TRIANGLES: usize = 400_000;

/// Meshes the soft surfaces of a scene.
///
/// # Errors
/// If there is nothing to see, or a surface has no end or too many triangles; in words.
pub fn run(job: ViewJob, progress: &mut Progress<'_>) -> Result<ViewMesh, String> {
    let ViewJob {
        scene,
        looks,
        detail,
        coatings,
    } = job;
    let surfaces = scene.surfaces();
    let (meshes, coatings) = match detail {
        Detail::Coarse => {
            // What cannot be read is of no use; all is found anew then.
            let mut known: Vec<Coating> = unpack(&coatings).unwrap_or_default();
            known.resize_with(surfaces.len(), Coating::default);
            let mut meshes = Vec::with_capacity(surfaces.len());
            for (i, (surface, coating)) in surfaces.iter().zip(&mut known).enumerate() {
                let cages = Cage::of_surface(&scene, surface);
                let coat = coating.update(surface.function(), &cages, &|_| BOUND);
                meshes.push(coat.mesh);
                progress.report(i as f32 / surfaces.len() as f32);
            }
            (meshes, pack(&known).unwrap_or_default())
        }
        Detail::Fine => (fine(&surfaces, progress)?, coatings),
    };
    let bounds = meshes.iter().map(TriangleMesh::bounds);
    let bounds = bounds.fold(Aabb::EMPTY, |all, own| all.union(&own));
    let unit = 0.5 * bounds.size().max_element();
    let is_sound = unit > 0.0 && unit.is_finite() && bounds.center().is_finite();
    if !is_sound {
        return Err("there is no soft surface to see".into());
    }
    let mut view = ViewMesh {
        origin: bounds.center(),
        unit,
        coatings,
        ..ViewMesh::default()
    };
    for (surface, mesh) in surfaces.iter().zip(&meshes) {
        add(&mut view, &scene, &looks, surface, mesh);
    }
    progress.report(1.0);
    Ok(view)
}

/// Meshes within the tolerance.
fn fine(surfaces: &[Surface], progress: &mut Progress<'_>) -> Result<Vec<TriangleMesh>, String> {
    let count = 2.0 * surfaces.len() as f32;
    let mut done = 0.0;
    let mut part =
        |run: &mut dyn FnMut(&mut mesher::Progress<'_>) -> Result<(), mesher::MeshError>| {
            let mut report = |step: mesher::Step| {
                progress.report((done + step.fraction) / count);
                ControlFlow::Continue(())
            };
            let result = run(&mut mesher::Progress::new(&mut report));
            done += 1.0;
            result.map_err(|error| error.to_string())
        };
    let mut domains = Vec::with_capacity(surfaces.len());
    let mut all = Aabb::EMPTY;
    for surface in surfaces {
        let function = surface.function();
        let Some(ball) = function.support() else {
            return Err("the surface has no end".into());
        };
        let within = mesher::box_of(ball);
        let mut hull = None;
        if ball.radius > 0.0 {
            part(&mut |progress| {
                hull = mesher::extent(function, &within, 1, progress)?;
                Ok(())
            })?;
        }
        all = all.union(&hull.unwrap_or(Aabb::EMPTY));
        domains.push(hull.map(|hull| {
            // So that nothing touches the sides.
            let room = 0.05 * hull.size().max_element();
            Aabb {
                min: (hull.min - room).max(within.min),
                max: (hull.max + room).min(within.max),
            }
        }));
    }
    let options = Options {
        max_triangles: MOST_TRIANGLES,
        ..Options::new(TOLERANCE * all.size().length())
    };
    let mut meshes = Vec::with_capacity(surfaces.len());
    for (surface, domain) in surfaces.iter().zip(&domains) {
        let mut mesh = TriangleMesh::default();
        if let Some(domain) = domain {
            part(&mut |progress| {
                mesh = mesher::polygonize(surface.function(), domain, &options, progress)?.mesh;
                Ok(())
            })?;
        }
        meshes.push(mesh);
    }
    Ok(meshes)
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
    let finish = |primitive: u32| {
        let element = surface.element().get(primitive as usize)?;
        let finish = scene.elements.get(*element as usize)?.finish;
        looks.get(finish as usize)
    };
    let mut finishes = (0..surface.element().len() as u32).map(finish);
    let only = match finishes.next() {
        Some(first) if finishes.all(|other| other == first) => first.copied(),
        _ => None,
    };
    let mut shares = Vec::new();
    let mut look_at = |point: DVec3| {
        if let Some(only) = only {
            return only;
        }
        shares.clear();
        surface.function().shares(point, &mut shares);
        let total: f64 = shares.iter().map(|(_, share)| share).sum();
        let mut sum = [0.0; 10];
        for (primitive, share) in &shares {
            let share = (share / total) as f32;
            for (sum, own) in sum.iter_mut().zip(finish(*primitive).unwrap_or(&[0.0; 10])) {
                *sum += share * own;
            }
        }
        sum
    };
    let byte = |x: f32| (255.0 * x.clamp(0.0, 1.0) + 0.5) as u8;
    let normals = mesh.normals.as_deref().unwrap_or_default();
    for (i, position) in mesh.positions.iter().enumerate() {
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
        let [ar, ag, ab, dr, dg, db, sr, sg, sb, shine] = look_at(*position);
        let colours = [ar, ag, ab, shine, dr, dg, db, 1.0, sr, sg, sb, 1.0];
        bytes.extend(colours.map(byte));
    }
    for corner in mesh.triangles.iter().flatten() {
        view.triangles.extend((first + corner).to_le_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Job, Output, run};
    use scene::{Element, Finish, Flesh, Shape};

    /// Two soft balls that blend, of two finishes, and a hard one.
    fn scene(x: f64) -> Scene {
        let mut scene = Scene::default();
        scene.finishes = vec![Finish::default(), Finish::default()];
        scene.flesh.push(Flesh {
            blobbiness: -2.0,
            ..Flesh::default()
        });
        let ball = |x: f64, finish, flesh| Element {
            flesh,
            finish,
            ..Element::new(Shape::Sphere {
                center: DVec3::new(x, 0.0, 0.0),
                radius: 1.0,
            })
        };
        scene.elements = vec![
            ball(0.0, 0, Some(0)),
            ball(x, 1, Some(0)),
            ball(9.0, 0, None),
        ];
        scene
    }

    fn looks() -> Vec<[f32; 10]> {
        let mut red = [0.0; 10];
        red[3] = 1.0;
        let mut blue = [0.0; 10];
        blue[5] = 1.0;
        blue[9] = 1.0;
        vec![red, blue]
    }

    fn view(x: f64, detail: Detail, coatings: Vec<u8>) -> ViewMesh {
        let job = ViewJob {
            scene: scene(x),
            looks: looks(),
            detail,
            coatings,
        };
        match run(Job::View(Box::new(job)), &mut Progress::silent()) {
            Ok(Output::View(view)) => *view,
            other => panic!("{other:?}"),
        }
    }

    /// Places, normals, and the twelve bytes of colours.
    fn corners(view: &ViewMesh) -> Vec<(DVec3, DVec3, [u8; 12])> {
        let corner = |bytes: &[u8]| {
            let place = |i: usize| f32::from_le_bytes(bytes[4 * i..4 * i + 4].try_into().unwrap());
            let normal = |i: usize| {
                let at = 12 + 2 * i;
                f64::from(i16::from_le_bytes(bytes[at..at + 2].try_into().unwrap())) / 32767.0
            };
            let place = DVec3::from_array([0, 1, 2].map(|i| f64::from(place(i))));
            let place = view.origin + place * view.unit;
            let normal = DVec3::from_array([0, 1, 2].map(normal));
            (place, normal, bytes[20..32].try_into().unwrap())
        };
        view.vertices
            .chunks_exact(ViewMesh::VERTEX)
            .map(corner)
            .collect()
    }

    #[test]
    fn corners_lie_on_the_surface_and_colours_follow_the_shares() {
        for detail in [Detail::Coarse, Detail::Fine] {
            let view = view(1.6, detail, Vec::new());
            let scene = scene(1.6);
            let surfaces = scene.surfaces();
            let function = surfaces[0].function();
            let all = corners(&view);
            assert!(all.len() > 100, "{detail:?} {}", all.len());
            for (place, normal, colours) in &all {
                let jet = function.jet(*place);
                // In a coating some corners stay inside, where another shell covers them.
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
    fn coating_goes_on_from_the_last_one_and_from_nonsense() {
        let first = view(1.6, Detail::Coarse, Vec::new());
        assert!(!first.coatings.is_empty());
        let moved = view(1.62, Detail::Coarse, first.coatings.clone());
        let anew = view(1.62, Detail::Coarse, vec![255; 9]);
        assert_eq!(moved.triangles.len(), anew.triangles.len());
        let kept = view(1.62, Detail::Fine, first.coatings.clone());
        assert_eq!(kept.coatings, first.coatings);
    }

    #[test]
    fn nothing_to_see_is_told() {
        for detail in [Detail::Coarse, Detail::Fine] {
            let job = ViewJob {
                scene: Scene::default(),
                looks: Vec::new(),
                detail,
                coatings: Vec::new(),
            };
            let told = run(Job::View(Box::new(job)), &mut Progress::silent()).unwrap_err();
            assert!(told.contains("no soft surface"), "{told}");
        }
    }
}
