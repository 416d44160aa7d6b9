//! Rigs of scenes: the nodes of skeletons become joints, each vertex follows the nodes of the
//! stretches that its place in the field comes from, and the scenes of further frames give an
//! animation.
//!
//! A vertex's weights are the shares of the primitives in the field there, each handed on to the
//! nodes whose mean the primitive's stretch of the curve is. Joints turn as the edges at their node
//! turn, along the shortest way from frame to frame.
//!
//! ```
//! use glam::DVec3;
//! use mesh::TriangleMesh;
//!
//! let text = "var y = 0 += 1\nsurface s, diffuse Red, radius 0.3\n\
//!     skeleton s, ARM { node A <0 0 0> node B <2 0 0> node C <4 y 0> curve A B C }";
//! let project = rats::Project::single(text);
//! let scenes = [0.0, 1.0, 2.0].map(|frame| {
//!     std::sync::Arc::unwrap_or_clone(rats::compile_at(&project, &[], frame).scene)
//! });
//! // Two vertices above the ends.
//! let vertices = vec![DVec3::new(0.0, 0.3, 0.0), DVec3::new(4.0, 0.3, 0.0)];
//! let mesh = TriangleMesh::new(vertices, vec![]);
//! let rig = rig::rig(&scenes, 25.0, &[(Some(0), &mesh)]).unwrap();
//! // One that stays, and three nodes.
//! assert_eq!(rig.joints.len(), 4);
//! let [left, right] =
//!     [0, 1].map(|i| rig.skin(mesh.positions[i], &rig.shares[0][i], &rig.frames[2]));
//! assert!(left.distance(mesh.positions[0]) < 0.2);
//! assert!(right.y > 1.5);
//! ```

mod pose;

use field::Implicit;
use glam::DVec3;
use mesh::{Joint, Pose, Rig, TriangleMesh};
use pose::Turns;
use scene::{Curves, Element, Ends, Form, Scene, Shape, SoftSurface};
use std::sync::Arc;

/// The most nodes of all skeletons that are rigged.
pub const MOST_NODES: usize = 2000;

/// The share of skeletons in the field that makes a vertex follow them.
const LEAST_SHARE: f64 = 0.01;

/// A skeleton of a scene.
struct Skeleton<'a> {
    /// The element's index in the scene.
    element: u32,
    curves: &'a Curves,
    /// The nodes' places in the world.
    places: Vec<DVec3>,
}

/// The skeletons of a scene, in the order of its elements.
fn skeletons(scene: &Scene) -> Vec<Skeleton<'_>> {
    let all = (0..).zip(&scene.elements);
    let own = all.filter_map(|(element, e): (u32, &Element)| {
        let Shape::Function(function) = &e.shape else {
            return None;
        };
        let curves = function.curves()?;
        let nodes = curves.skeleton.nodes.iter();
        let places = nodes.map(|node| function.to_world.transform_point3(node.position));
        Some(Skeleton {
            element,
            curves,
            places: places.collect(),
        })
    });
    own.collect()
}

/// Whether a scene has a skeleton, whose nodes can become joints.
#[must_use]
pub fn has_skeleton(scene: &Scene) -> bool {
    scene.elements.iter().any(|e| e.shape.curves().is_some())
}

/// A scene's skeletons alone: all that [`rig`] reads of the scenes after the first one.
#[must_use]
pub fn skeletons_of(scene: &Scene) -> Scene {
    let elements = scene.elements.iter();
    let own = elements.filter(|e| e.shape.curves().is_some());
    Scene {
        elements: own.cloned().collect(),
        ..Scene::default()
    }
}

/// The body, by its number in [`Scene::bodies`], whose soft surface is the mesh of this name: the
/// mesher names a soft surface as its body, and that of a body without a name `model`.
#[must_use]
pub fn body_of(scene: &Scene, name: &str) -> Option<u32> {
    let number = scene
        .bodies
        .iter()
        .position(|body| body.name == name || (body.name.is_empty() && name == "model"));
    number.map(|number| number as u32)
}

/// Makes the rig of meshes of a scene. The first of `scenes` is the one that was meshed; all, in
/// order, are the frames of the animation, up to the first one whose skeletons are not the same
/// curves. `rate` is in frames per second. With each mesh comes the number of the body whose soft
/// surface it is, in [`Scene::bodies`]; none for hard shapes, which stay.
///
/// The first joint stays where it is: vertices that no skeleton has a share in hang on it.
///
/// # Errors
/// A sentence, if there is no skeleton, or if the skeletons have more than [`MOST_NODES`] nodes.
pub fn rig(
    scenes: &[Scene],
    rate: f64,
    meshes: &[(Option<u32>, &TriangleMesh)],
) -> Result<Rig, String> {
    let Some(first) = scenes.first() else {
        return Err("there is no scene to rig".into());
    };
    let rest = skeletons(first);
    if rest.is_empty() {
        return Err("there is no skeleton to rig: joints come from the command `skeleton`".into());
    }
    let count: usize = rest.iter().map(|own| own.places.len()).sum();
    if count > MOST_NODES {
        return Err(format!(
            "the skeletons have {count} nodes; {MOST_NODES} can be rigged"
        ));
    }
    let mut joints = vec![Joint {
        name: "still".into(),
        parent: None,
        place: DVec3::ZERO,
    }];
    // For each skeleton the joint of each node.
    let mut joint_of = Vec::new();
    for (number, own) in rest.iter().enumerate() {
        joint_of.push(hang(number, own, &mut joints));
    }
    let mut frames = Vec::new();
    let mut turns: Vec<Turns> = rest
        .iter()
        .map(|own| Turns::new(&own.curves.skeleton.curves, &own.places))
        .collect();
    for scene in scenes {
        let now = skeletons(scene);
        let same = now.len() == rest.len()
            && now.iter().zip(&rest).all(|(a, b)| {
                a.curves.skeleton.curves == b.curves.skeleton.curves
                    && a.places.len() == b.places.len()
            });
        if !same {
            break;
        }
        let still = Pose {
            place: DVec3::ZERO,
            turn: glam::DQuat::IDENTITY,
        };
        let mut frame = vec![still; joints.len()];
        for ((own, turns), joint_of) in now.iter().zip(&mut turns).zip(&joint_of) {
            for (node, turn) in turns.follow(&own.places).into_iter().enumerate() {
                frame[joint_of[node]] = Pose {
                    place: own.places[node],
                    turn,
                };
            }
        }
        frames.push(frame);
    }
    let weights = Weights::new(first, &rest, &joint_of)?;
    let shares = meshes.iter().map(|(body, mesh)| weights.of(*body, mesh));
    Ok(Rig {
        joints,
        shares: shares.collect(),
        frames,
        rate,
    })
}

/// Adds the joints of a skeleton, each hanging on a neighbour along a curve. Returns the joint of
/// each node.
fn hang(number: usize, own: &Skeleton<'_>, joints: &mut Vec<Joint>) -> Vec<usize> {
    let nodes = own.places.len();
    let mut around = vec![Vec::new(); nodes];
    for pair in own.curves.skeleton.curves.iter().flat_map(|c| c.windows(2)) {
        around[pair[0]].push(pair[1]);
        around[pair[1]].push(pair[0]);
    }
    let mut joint_of = vec![usize::MAX; nodes];
    for root in 0..nodes {
        if joint_of[root] != usize::MAX {
            continue;
        }
        let mut open = vec![(root, None)];
        while let Some((node, parent)) = open.pop() {
            if joint_of[node] != usize::MAX {
                continue;
            }
            joint_of[node] = joints.len();
            let parent = parent.map(|node: usize| joint_of[node]);
            joints.push(Joint {
                name: format!("skeleton{}.{}", number + 1, node + 1),
                parent,
                place: own.places[node],
            });
            let next = around[node].iter().rev();
            open.extend(next.map(|&other| (other, Some(node))));
        }
    }
    joint_of
}

/// The joints to which a primitive hands its share on, with their weights.
type Hold = Vec<(usize, f64)>;

/// The weights of the joints in space.
struct Weights {
    surfaces: Vec<(SoftSurface, Vec<Hold>)>,
    joints: usize,
}

impl Weights {
    fn new(scene: &Scene, rest: &[Skeleton<'_>], joint_of: &[Vec<usize>]) -> Result<Self, String> {
        let mut stretches = Vec::new();
        for (own, joint_of) in rest.iter().zip(joint_of) {
            stretches.push((own.element, of_stretches(scene, own, joint_of)?));
        }
        // Of curves that are convolved locally, or end flat, all stretches share: near a fold that
        // touches at rest too.
        let mut whole = scene.clone();
        for element in &mut whole.elements {
            if let Shape::Bone(bone) = &mut element.shape {
                bone.soft_ends = [Ends::Round; 2];
            }
            if let Shape::Function(function) = &mut element.shape
                && let Form::Skeleton(curves) = &mut function.form
                && (curves.local.is_some() || !curves.flat.is_empty())
            {
                let curves = Arc::make_mut(curves);
                curves.local = None;
                curves.flat.clear();
            }
        }
        let surfaces = whole.soft_surfaces().into_iter().map(|surface| {
            let holds = surface.sum.primitives.iter().zip(&surface.element);
            let holds = holds.map(|(primitive, element)| {
                let all = stretches.iter().find(|(own, _)| own == element);
                let middle = primitive.bounding_sphere().map(|(center, _)| center);
                let (Some((_, all)), Some(middle)) = (all, middle) else {
                    return Vec::new();
                };
                // Long stretches are cut into several primitives, so that it is found by its place.
                let nearest = all.iter().min_by(|a, b| {
                    let [a, b] = [a.0, b.0].map(|place| place.distance_squared(middle));
                    a.total_cmp(&b)
                });
                nearest.map_or_else(Vec::new, |(_, hold)| hold.clone())
            });
            let holds = holds.collect();
            (surface, holds)
        });
        let surfaces = surfaces.collect();
        let joints = 1 + joint_of.iter().map(Vec::len).sum::<usize>();
        Ok(Self { surfaces, joints })
    }

    /// The four strongest joints of each vertex.
    fn of(&self, body: Option<u32>, mesh: &TriangleMesh) -> Vec<[(u16, f32); 4]> {
        let mut shares = Vec::new();
        let mut sums = vec![0.0; self.joints];
        let mut surfaces = self.surfaces.iter();
        let surface = surfaces.find(|(surface, _)| Some(surface.body) == body);
        let weights = mesh.positions.iter().map(|point| {
            sums.fill(0.0);
            if let Some((surface, holds)) = surface {
                shares.clear();
                surface.sum.shares(*point, &mut shares);
                let all: f64 = shares.iter().map(|(_, share)| share).sum();
                for &(primitive, share) in &shares {
                    for &(joint, weight) in &holds[primitive as usize] {
                        sums[joint] += share * weight;
                    }
                }
                // Of a shape far from all skeletons a trace is left of each.
                if sums.iter().sum::<f64>() < LEAST_SHARE * all {
                    sums.fill(0.0);
                }
            }
            strongest(&sums)
        });
        weights.collect()
    }
}

/// The four largest numbers, as shares of their sum; the first joint has all if there is none.
fn strongest(sums: &[f64]) -> [(u16, f32); 4] {
    let mut best = [(0u16, 0.0f64); 4];
    for (joint, &sum) in sums.iter().enumerate() {
        if sum > best[3].1 {
            best[3] = (joint as u16, sum);
            best.sort_by(|a, b| b.1.total_cmp(&a.1));
        }
    }
    let all: f64 = best.iter().map(|(_, sum)| sum).sum();
    if all > 0.0 && all.is_finite() {
        best.map(|(joint, sum)| (joint, (sum / all) as f32))
    } else {
        [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]
    }
}

/// Returns the middle of each stretch of a skeleton's curves in the world, and the joints that move
/// it.
fn of_stretches(
    scene: &Scene,
    own: &Skeleton<'_>,
    joint_of: &[usize],
) -> Result<Vec<(DVec3, Hold)>, String> {
    let curves = own.curves;
    let weights = curves
        .skeleton
        .weights(curves.scheme, curves.levels)
        .map_err(|error| error.to_string())?;
    let Shape::Function(function) = &scene.elements[own.element as usize].shape else {
        return Ok(Vec::new());
    };
    let Some(polyline) = curves.polyline() else {
        return Ok(Vec::new());
    };
    let stretches = polyline.segments.iter().map(|segment| {
        let [a, b] = segment.ends.map(|end| polyline.vertices[end].position);
        let mut hold: Hold = Vec::new();
        for (node, weight) in segment.ends.iter().flat_map(|&end| &weights[end]) {
            // Those behind others pull the wrong way: skins take no such weights.
            let weight = weight.max(0.0);
            match hold.iter_mut().find(|(joint, _)| *joint == joint_of[*node]) {
                Some((_, sum)) => *sum += weight,
                None => hold.push((joint_of[*node], weight)),
            }
        }
        let sum: f64 = hold.iter().map(|(_, weight)| weight).sum();
        for (_, weight) in &mut hold {
            *weight /= sum;
        }
        (function.to_world.transform_point3((a + b) * 0.5), hold)
    });
    Ok(stretches.collect())
}
