//! Offset surfaces of meshes whose material is soft, as `soft off` draws them: two sheets at the
//! radius on either side, closed along the rim. (A prism for each facet would be a hedgehog where
//! facets are smaller than the radius.)

use super::later;
use super::state::Evaluator;
use crate::compiled::Placement;
use field::Skeleton;
use glam::DVec3;
use scene::{Element, Origin, Scene, Shape};
use std::collections::HashMap;

impl Evaluator<'_> {
    /// Puts sheets in the place of the facets of soft meshes, where soft shapes are drawn hard.
    pub(super) fn thicken_meshes(&self, scene: &mut Scene, placements: &mut Vec<Placement>) {
        if scene.settings.soft {
            return;
        }
        let elements = std::mem::take(&mut scene.elements);
        let places = std::mem::take(placements);
        let mut known: Option<(Origin, bool)> = None;
        let mut facets: Vec<(Element, Placement, [DVec3; 3])> = Vec::new();
        for (element, placement) in elements.into_iter().zip(places) {
            let origin = element.origin;
            let corners = match element.shape.skeleton() {
                Some(Skeleton::Triangle { corners }) if element.flesh.is_some() => Some(*corners),
                _ => None,
            };
            // Finding a command takes time.
            if corners.is_some() && known.is_none_or(|(own, _)| own != origin) {
                known = Some((origin, self.is_mesh(origin)));
            }
            let is_first = facets.first().is_some_and(|(first, ..)| {
                (first.origin, first.flesh, first.frame) != (origin, element.flesh, element.frame)
            });
            let is_facet = matches!(known, Some((_, true)));
            let corners = corners.filter(|_| is_facet && scene.radius(&element) > 0.0);
            if is_first || corners.is_none() {
                add_sheets(scene, placements, &mut facets);
            }
            if let Some(corners) = corners {
                facets.push((element, placement, corners));
            } else {
                scene.elements.push(element);
                placements.push(placement);
            }
        }
        add_sheets(scene, placements, &mut facets);
    }

    /// Returns whether the command at a place makes a mesh.
    fn is_mesh(&self, origin: Origin) -> bool {
        let Some(source) = self.sources.all.get(origin.file as usize) else {
            return false;
        };
        let start = origin.start as usize;
        let command = later::find(&source.syntax.block, &|command| command.span.start == start);
        let spec = command.and_then(|command| command.spec);
        spec.is_some_and(|spec| matches!(spec.name, "mesh" | "terra"))
    }
}

/// Bits of a corner's coordinates, by which corners are the same.
type Key = [u64; 3];

fn key(corner: DVec3) -> Key {
    corner.to_array().map(|x| (x + 0.0).to_bits())
}

/// Returns the keys of an edge's ends, in order.
fn edge([a, b]: [DVec3; 2]) -> [Key; 2] {
    let mut ends = [key(a), key(b)];
    ends.sort_unstable();
    ends
}

fn sides([a, b, c]: [DVec3; 3]) -> [[DVec3; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Adds the sheets of facets, which are used up.
fn add_sheets(
    scene: &mut Scene,
    placements: &mut Vec<Placement>,
    facets: &mut Vec<(Element, Placement, [DVec3; 3])>,
) {
    let Some((first, ..)) = facets.first() else {
        return;
    };
    let radius = scene.radius(first);
    let mut normals: HashMap<Key, DVec3> = HashMap::new();
    let mut edges: HashMap<[Key; 2], usize> = HashMap::new();
    for &(_, _, corners) in &*facets {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        for corner in corners {
            *normals.entry(key(corner)).or_default() += normal;
        }
        for side in sides(corners) {
            *edges.entry(edge(side)).or_default() += 1;
        }
    }
    for normal in normals.values_mut() {
        *normal = normal.normalize_or_zero() * radius;
    }
    for (element, placement, corners) in facets.drain(..) {
        let over = corners.map(|corner| corner + normals[&key(corner)]);
        let under = corners.map(|corner| corner - normals[&key(corner)]);
        let mut sheets = vec![(over, false), ([under[0], under[2], under[1]], true)];
        for (i, side) in sides(corners).into_iter().enumerate() {
            if edges[&edge(side)] == 1 {
                let j = (i + 1) % 3;
                sheets.push(([under[i], under[j], over[j]], false));
                sheets.push(([under[i], over[j], over[i]], false));
            }
        }
        for (corners, is_turned) in sheets {
            let mut paint = element.paint.clone();
            if let (true, Some(paint)) = (is_turned, &mut paint) {
                paint.corners.swap(1, 2);
            }
            scene.elements.push(Element {
                shape: Shape::triangle(corners, 0.0),
                flesh: None,
                paint,
                ..element.clone()
            });
            placements.push(placement);
        }
    }
}
