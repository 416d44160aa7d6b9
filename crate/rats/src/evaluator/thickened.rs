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
            if known.is_none_or(|(own, _)| own != origin) {
                known = Some((origin, self.is_mesh(origin)));
            }
            let corners = match element.shape.skeleton() {
                Some(Skeleton::Triangle { corners }) => Some(*corners),
                _ => None,
            };
            let is_first = facets.first().is_some_and(|(first, ..)| {
                (first.origin, first.flesh, first.frame) != (origin, element.flesh, element.frame)
            });
            let is_facet = matches!(known, Some((_, true))) && element.flesh.is_some();
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
    let key = |corner: DVec3| corner.to_array().map(|x| (x + 0.0).to_bits());
    let mut normals: HashMap<[u64; 3], DVec3> = HashMap::new();
    let mut edges: HashMap<[[u64; 3]; 2], usize> = HashMap::new();
    let sides = |[a, b, c]: [DVec3; 3]| [[a, b], [b, c], [c, a]];
    let name = |[a, b]: [DVec3; 2]| {
        let mut ends = [key(a), key(b)];
        ends.sort_unstable();
        ends
    };
    for &(_, _, corners) in &*facets {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        for corner in corners {
            *normals.entry(key(corner)).or_default() += normal;
        }
        for side in sides(corners) {
            *edges.entry(name(side)).or_default() += 1;
        }
    }
    let offset = |corner: DVec3| {
        let normal = normals.get(&key(corner)).copied().unwrap_or_default();
        normal.normalize_or_zero() * radius
    };
    for (element, placement, corners) in facets.drain(..) {
        let mut add = |corners: [DVec3; 3], is_turned: bool| {
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
        };
        let [a, b, c] = corners;
        add(corners.map(|corner| corner + offset(corner)), false);
        add([a, c, b].map(|corner| corner - offset(corner)), true);
        for side in sides(corners)
            .into_iter()
            .filter(|side| edges[&name(*side)] == 1)
        {
            let [[a, over_a], [b, over_b]] =
                side.map(|corner| [corner - offset(corner), corner + offset(corner)]);
            add([a, b, over_b], false);
            add([a, over_b, over_a], false);
        }
    }
}
