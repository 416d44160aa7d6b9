//! A scene as the numbers that `shaders/scene.wgsl` reads, four by four.

use crate::bounds::Bounds;
use crate::counted::Counted;
use crate::facade::{self, NoMesh};
use crate::facets;
use crate::formulas::Chart;
use crate::hierarchy;
use crate::look::{draft_colours, finite, with};
use crate::octree::{Cell, ENDLESS, Halt, Leaf, Limits, Octree, Told, corners};
use crate::paint::paint;
use crate::solid::{Kind, Solid, soft_end};
use bytemuck::{Pod, Zeroable};
use field::{Implicit, Primitive, Skeleton};
use glam::{DVec3, Vec3};
use mesh::TriangleMesh;
use scene::{Element, Finish, Form, Rgb, Scene, Shape, Surface, Unit};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Words of cells, as in `shaders/march.wgsl`.
const OUTSIDE: u32 = 0x4000_0000;
const INSIDE: u32 = 0x8000_0000;
const LEAF: u32 = 0xc000_0000;
/// Mark of a mixture of materials, as in `shaders/scene.wgsl`.
const MIXED: u32 = 0x8000_0000;
/// Most terms that a leaf lists.
const MOST_TERMS: usize = 128;
/// Share of an element in a field below which its material is not mixed in.
const NEGLIGIBLE: f64 = 1e-3;

/// Longest span of a ray in a leaf that lists terms, in widths of the narrowest kernel.
const SPAN: f64 = 0.35;
/// Parts of the work for a body of which one is for its cells.
const CELLS: u64 = 3;
/// Evaluations of a function that is no sum, for the colours of a leaf.
const COLOURS: u64 = 8;
/// Bodies among which what is left is shared out, at most: most models have few large ones.
const LARGE: usize = 4;
/// Number of a body's triangles above which their thickened shapes stand for it, if there is little
/// time.
const MANY_TRIANGLES: usize = 500;

/// Care with which the space around a scene is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Detail {
    /// Cells that can be made while a hand moves something.
    Quick,
    /// Cells as fine as a picture shows.
    #[default]
    Fine,
    /// Without bounds on the work, however long it takes.
    Full,
}

impl Detail {
    /// Returns the bounds for all bodies together.
    fn limits(self) -> Share {
        let [leaves, triangles, work] = match self {
            Self::Quick => [8_000, 100_000, 20_000_000],
            Self::Fine => [200_000, 300_000, 150_000_000],
            Self::Full => [600_000, 300_000, u64::MAX],
        };
        Share {
            leaves: leaves as usize,
            triangles: triangles as usize,
            work,
        }
    }

    /// Returns the most elements of a body that cells are tried for.
    fn most_elements(self) -> usize {
        match self {
            Self::Quick => 200,
            Self::Fine | Self::Full => usize::MAX,
        }
    }
}

/// Bounds on what is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Share {
    /// The most leaves.
    pub(crate) leaves: usize,
    /// The most triangles.
    pub(crate) triangles: usize,
    /// The most work, in evaluations of terms.
    pub(crate) work: u64,
}

/// Nobody waits for it any more.
struct Cancelled;

/// The uniform `frame` of `shaders/scene.wgsl`, but for what comes from a camera and lights.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable, Serialize, Deserialize)]
pub struct Frame {
    /// Numbers of bodies, of planes, of nodes of the hierarchy, and 0.
    pub counts: [u32; 4],
    /// Places in the data at which bodies, hard shapes and the hierarchy begin, and 0.
    pub places: [u32; 4],
}

/// A scene, packed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Packed {
    /// Vectors of four numbers of 32 bits, little-endian.
    #[serde(with = "serde_bytes")]
    pub data: Vec<u8>,
    /// Numbers of parts, and their places in the data.
    pub frame: Frame,
    /// Number of elements drawn.
    pub elements: usize,
    /// Number of cells that a surface passes.
    pub leaves: usize,
    /// Number of such cells in which the cubic is not close to the function.
    pub rough: usize,
    /// The formulas that cells list, as [`crate::formulas::code`] reads them.
    pub formulas: BTreeSet<u32>,
    /// The bodies drawn as meshes, or as thickened triangles: indices in [`Scene::bodies`].
    pub meshed: Vec<u32>,
    /// The work done, in evaluations of terms.
    pub work: u64,
    /// Whether bounds on the work left something rough: more care would show.
    pub is_cut: bool,
}

impl Packed {
    /// Packs a scene; `None` if `told` says that it is not wanted any more.
    pub fn new(
        scene: &Scene,
        detail: Detail,
        chart: &dyn Chart,
        told: &mut Told<'_>,
    ) -> Option<Self> {
        let bounds = Bounds::of(scene);
        let scene = &Unit::of_ball(bounds.center, bounds.radius).map_scene(scene);
        let mut packer = Packer {
            scene,
            chart,
            data: Vec::new(),
            out: Self::default(),
        };
        let meshes = packer.add_bodies(detail, told)?;
        packer.add_solids(&meshes);
        // There is always something to bind.
        packer.data.push([0; 4]);
        packer.out.data = bytemuck::cast_slice(&packer.data).to_vec();
        Some(packer.out)
    }
}

/// A scene in draft units on its way to numbers.
struct Packer<'a> {
    scene: &'a Scene,
    chart: &'a dyn Chart,
    data: Vec<[u32; 4]>,
    out: Packed,
}

/// Shape that stands for a piece of a body, with its material.
type Facet = (Solid, u32);

impl Packer<'_> {
    fn push(&mut self, numbers: [f32; 4]) {
        self.data.push(numbers.map(f32::to_bits));
    }

    fn push_with(&mut self, place: Vec3, word: u32) {
        let [x, y, z] = place.to_array().map(f32::to_bits);
        self.data.push([x, y, z, word]);
    }

    /// Returns a finish's place in the table of materials, or that of the fallback behind all.
    fn slot(&self, finish: u32) -> u32 {
        finish.min(self.scene.finishes.len() as u32)
    }

    /// Adds hard shapes and triangles of meshes, planes first, and their hierarchy. Soft planes are
    /// among them for what is beyond the octree of their body.
    fn add_solids(&mut self, facets: &[Facet]) {
        let scene = self.scene;
        let detail = facets::detail(scene);
        let mut solids = Vec::new();
        for element in &scene.elements {
            let is_soft = scene.is_soft(element);
            let is_plane = matches!(&element.shape, Shape::Bone(bone)
                if matches!(bone.skeleton, Skeleton::Plane { .. }));
            if element.finish as usize >= scene.finishes.len() || is_soft && !is_plane {
                continue;
            }
            // Others have few parts.
            let is_quadric = matches!(element.shape, Shape::Quadric(_));
            if is_quadric && solids.len() >= facets::MOST {
                continue;
            }
            let own = Solid::of(scene, element, detail);
            self.out.elements += usize::from(!own.is_empty() && !is_soft);
            for mut solid in own {
                if is_soft {
                    solid.a[1] = ENDLESS;
                }
                let paint = element.paint.as_ref().filter(|_| solid.kind == Kind::Patch);
                let finish = paint.map_or(element.finish, |paint| paint.finish);
                solids.push((solid.move_origin_near(DVec3::ZERO), self.slot(finish)));
            }
        }
        solids.extend_from_slice(facets);
        let (planes, others): (Vec<_>, Vec<_>) =
            (solids.into_iter()).partition(|(solid, _)| solid.kind == Kind::Plane);
        self.out.frame.counts[1] = planes.len() as u32;
        self.out.frame.places[1] = self.data.len() as u32;
        for (solid, material) in planes.iter().chain(&others) {
            let unit = (solid.unit as f32).clamp(1e-30, 1e15);
            self.push(solid.origin.as_vec3().extend(unit).to_array());
            self.push(solid.rotation.as_quat().normalize().to_array());
            self.push(solid.a.map(|x| x as f32));
            self.push(solid.b.map(|x| x as f32));
            let [low, high] = solid.corners();
            self.push_with(low, *material);
            self.push_with(high, solid.kind as u32);
        }
        let boxes: Vec<_> = (others.iter())
            .filter_map(|(solid, _)| solid.bounds())
            .map(|(low, high)| {
                let room = DVec3::splat(1e-5 + 1e-5 * low.distance(high));
                (low - room, high + room)
            })
            .collect();
        let nodes = hierarchy::nodes(&boxes);
        self.out.frame.counts[2] = nodes.len() as u32;
        self.out.frame.places[2] = self.data.len() as u32;
        for node in nodes {
            let item = node.item.map_or(u32::MAX, |i| i + planes.len() as u32);
            self.push_with(node.low.as_vec3(), node.next);
            self.push_with(node.high.as_vec3(), item);
        }
    }

    /// Adds the bodies' octrees, and returns the triangles of those that have none; `None` if it
    /// is not wanted any more.
    fn add_bodies(&mut self, detail: Detail, told: &mut Told<'_>) -> Option<Vec<Facet>> {
        let surfaces = self.scene.surfaces();
        let count = surfaces.len().max(1);
        let most = detail.limits();
        let mut roots = Vec::new();
        let mut facets = Vec::new();
        for (i, surface) in surfaces.iter().enumerate() {
            let mut told = |share: f32| told((i as f32 + share.min(1.0)) / count as f32);
            let function = Counted::new(surface);
            // Bodies that need little leave more to the others.
            let others = (count - i).min(LARGE);
            let share = Share {
                leaves: most.leaves.saturating_sub(self.out.leaves) / (count - i),
                triangles: most.triangles.saturating_sub(facets.len()) / others,
                work: most.work.saturating_sub(self.out.work) / others as u64,
            };
            let tree = self.look_at(surface, &function, share, detail, &mut facets, &mut told);
            if let Some(tree) = tree.ok()? {
                roots.push(self.add_tree(surface, &function, &tree));
            }
            self.out.work += function.work();
        }
        self.out.frame.counts[0] = roots.len() as u32;
        self.out.frame.places[0] = self.data.len() as u32;
        for (center, half, word) in roots {
            self.push(center.as_vec3().extend(half as f32).to_array());
            self.data.push([word, 0, 0, 0]);
        }
        Some(facets)
    }

    /// Returns the cells of a body; `None` if there are none, or if it has triangles, which are
    /// appended.
    fn look_at(
        &mut self,
        surface: &Surface,
        function: &Counted<'_>,
        share: Share,
        detail: Detail,
        facets: &mut Vec<Facet>,
        told: &mut Told<'_>,
    ) -> Result<Option<Octree>, Cancelled> {
        let own: BTreeSet<u32> = surface.element().iter().copied().collect();
        self.out.elements += own.len();
        if detail == Detail::Quick && self.is_skin(surface) {
            self.out.is_cut = true;
            self.out.meshed.push(surface.body());
            self.add_skin(&own, f64::INFINITY, share.triangles, facets);
            return Ok(None);
        }
        let mut limits = Limits {
            leaves: share.leaves,
            work: share.work / CELLS,
            is_strict: detail != Detail::Full,
        };
        if matches!(surface, Surface::Composed(_)) && own.len() > 1 && limits.is_strict {
            let most = limits.work / (COLOURS * function.whole());
            limits.leaves = limits.leaves.min(most as usize);
        }
        let list = |terms: Option<&[u32]>| match surface {
            Surface::Sum(sum) => list(self.chart, &sum.sum.primitives, terms),
            Surface::Composed(_) => Vec::new(),
        };
        if surface.element().len() <= detail.most_elements() {
            match Octree::new(function, limits, &list, told) {
                Ok(Some(tree)) if limits.is_strict && !tree.is_close() => {}
                Ok(tree) => return Ok(tree),
                Err(Halt::Cancelled) => return Err(Cancelled),
                Err(Halt::Limit) => {}
            }
        }
        self.out.is_cut = true;
        let before = facets.len();
        match facade::mesh(self.scene, surface, function, share, detail, told) {
            Ok((mesh, thin)) => {
                self.add_facets(surface, function, &mesh, facets);
                let left = share.triangles.saturating_sub(facets.len() - before);
                self.add_skin(&own, thin, left, facets);
            }
            Err(NoMesh::Dear) => self.add_skin(&own, f64::INFINITY, share.triangles, facets),
            Err(NoMesh::Endless) => {}
            Err(NoMesh::Cancelled) => return Err(Cancelled),
        }
        if facets.len() > before {
            self.out.meshed.push(surface.body());
            return Ok(None);
        }
        // Roughly, but at all.
        limits.is_strict = false;
        match Octree::new(function, limits, &list, told) {
            Ok(tree) => Ok(tree),
            Err(Halt::Limit) => Ok(None),
            Err(Halt::Cancelled) => Err(Cancelled),
        }
    }

    /// Adds the cells of a body, and returns the middle, half the side and the word of the first.
    fn add_tree(
        &mut self,
        surface: &Surface,
        function: &Counted<'_>,
        tree: &Octree,
    ) -> (DVec3, f64, u32) {
        self.out.leaves += tree.leaves.len();
        self.out.rough += tree.rough;
        let places = self.add_leaves(surface, function, tree);
        let first = self.data.len() as u32;
        let words = tree.cells.iter().map(|cell| match cell {
            Cell::Parted(at) => first + (at - 1) / 4,
            Cell::Outside => OUTSIDE,
            Cell::Inside => INSIDE,
            Cell::Leaf(number) => LEAF | places[*number as usize],
        });
        let words: Vec<u32> = words.collect();
        self.data.extend(words[1..].as_chunks::<4>().0);
        (tree.center, tree.half, words[0])
    }

    /// Whether a body is the skin of a mesh: many triangles, which take long.
    fn is_skin(&self, surface: &Surface) -> bool {
        let elements = surface.element().iter();
        let triangles = elements.filter(|element| {
            matches!(&self.scene.elements[**element as usize].shape, Shape::Bone(bone)
                if matches!(bone.skeleton, Skeleton::Triangle { .. }))
        });
        triangles.count() > MANY_TRIANGLES
    }

    /// Appends the hard shapes of a body's elements that are thinner than a radius, as many as
    /// there is room for: of all if it is infinite, else of bones whose flesh has that radius.
    fn add_skin(&self, elements: &BTreeSet<u32>, thin: f64, room: usize, facets: &mut Vec<Facet>) {
        let most = facets.len() + room;
        for element in elements {
            let element = &self.scene.elements[*element as usize];
            if thin.is_finite() && !self.is_plain(element) {
                continue;
            }
            // A plane is drawn by itself.
            let solids = Solid::of(self.scene, element, 0).into_iter();
            let solids = solids.filter(|solid| match solid.thinnest() {
                Some(radius) => radius < thin,
                None => thin.is_infinite() && solid.kind != Kind::Plane,
            });
            facets.extend(solids.map(|solid| (solid, self.slot(element.finish))));
            if facets.len() >= most {
                facets.truncate(most);
                return;
            }
        }
    }

    /// Whether the flesh of an element is about as thick as its radius says.
    fn is_plain(&self, element: &Element) -> bool {
        let flesh = element.flesh.map(|flesh| flesh as usize);
        let flesh = flesh.and_then(|flesh| self.scene.flesh.get(flesh));
        // Tapers of straight lines are drawn, no others.
        let is_tapered = flesh.is_some_and(|flesh| flesh.end_radius.is_some());
        let is_cone = soft_end(self.scene, element).is_some();
        let is_shaped = is_tapered != is_cone
            || flesh.is_some_and(|f| f.whole_profile().is_some() || f.strength < 1.0);
        let is_chain = match &element.shape {
            Shape::Bone(_) => true,
            Shape::Function(function) => matches!(function.form, Form::Skeleton(_)),
            Shape::Box(_) | Shape::Quadric(_) => false,
        };
        is_chain && !is_shaped
    }

    /// Appends the triangles of a body's mesh.
    fn add_facets(
        &self,
        surface: &Surface,
        function: &Counted<'_>,
        mesh: &TriangleMesh,
        facets: &mut Vec<Facet>,
    ) {
        let corners = mesh
            .triangles
            .iter()
            .map(|triangle| triangle.map(|corner| mesh.positions[corner as usize]));
        let middles = corners.map(|places| places.iter().sum::<DVec3>() / 3.0);
        let finishes = paint(self.scene, surface, function, middles);
        let normals = mesh.normals.as_deref().unwrap_or_default();
        for (triangle, finish) in mesh.triangles.iter().zip(finishes) {
            let places = triangle.map(|corner| mesh.positions[corner as usize]);
            let outward = triangle.map(|corner| {
                let normal = normals.get(corner as usize);
                normal.copied().unwrap_or_default()
            });
            let Some(solid) = Solid::patch(places, outward, [[1.0; 3]; 3]) else {
                continue;
            };
            facets.push((solid, self.slot(finish)));
        }
    }

    /// Adds the leaves of a body, and returns their places.
    fn add_leaves(&mut self, surface: &Surface, function: &Counted<'_>, tree: &Octree) -> Vec<u32> {
        let (scene, chart) = (self.scene, self.chart);
        let elements = surface.element().iter();
        let finishes: BTreeSet<u32> = elements
            .map(|element| scene.elements[*element as usize].finish)
            .collect();
        let around = scene.background.mean();
        let mut records: BTreeMap<u32, [u32; 4]> = BTreeMap::new();
        let mut places = Vec::with_capacity(tree.leaves.len());
        for leaf in &tree.leaves {
            let mixture = if finishes.len() > 1 {
                mixture(scene, surface, function, leaf)
            } else {
                Vec::new()
            };
            let mut list = Vec::new();
            let mut span = f64::INFINITY;
            if let Surface::Sum(sum) = surface {
                for term in &leaf.listed {
                    let primitive = &sum.sum.primitives[*term as usize];
                    span = span.min(SPAN / primitive.width);
                    let record = records
                        .entry(*term)
                        .or_insert_with(|| chart.pack(primitive, &mut self.data));
                    self.out.formulas.insert(record[0]);
                    list.push(*record);
                }
            }
            let terms = self.data.len() as u32;
            self.data.extend(&list);
            places.push(self.data.len() as u32);
            let shown = mixture.first().map(|(finish, _)| *finish);
            let finish = shown.or(finishes.first().copied()).unwrap_or(0);
            let word = if mixture.len() > 1 {
                MIXED
            } else {
                self.slot(finish)
            };
            let span = (span as f32).min(1e30).to_bits();
            self.data.push([word, list.len() as u32, span, terms]);
            for four in leaf.cubic.coefficients.as_chunks::<4>().0 {
                self.push(four.map(|x| x as f32));
            }
            if mixture.len() > 1 {
                for line in looks(scene, &mixture, around).as_flattened() {
                    self.push(*line);
                }
            }
        }
        places
    }
}

/// Returns some primitives of a body, or all, if the card has their formulas and they are not many.
fn list(chart: &dyn Chart, primitives: &[Primitive], terms: Option<&[u32]>) -> Vec<u32> {
    let count = terms.map_or(primitives.len(), <[u32]>::len);
    if count > MOST_TERMS {
        return Vec::new();
    }
    let terms = terms.map_or_else(|| (0..count as u32).collect(), <[u32]>::to_vec);
    let known = terms.iter().all(|i| chart.has(&primitives[*i as usize]));
    if known { terms } else { Vec::new() }
}

/// Returns the share of each finish at a leaf's corners: all those that count at one of them.
fn mixture(
    scene: &Scene,
    surface: &Surface,
    function: &Counted<'_>,
    leaf: &Leaf,
) -> Vec<(u32, [f64; 8])> {
    let mut shares: BTreeMap<u32, [f64; 8]> = BTreeMap::new();
    for (corner, place) in corners().into_iter().enumerate() {
        let point = leaf.center + leaf.half * place;
        let mut own = Vec::new();
        match (surface, &leaf.terms) {
            (Surface::Sum(sum), Some(terms)) => {
                for &term in terms {
                    let value = sum.sum.primitives[term as usize].value(point.to_array());
                    own.push((term, f64::max(value, 0.0)));
                }
            }
            _ => function.shares(point, &mut own),
        }
        // At a pole one element is all.
        let all: f64 = own.iter().map(|(_, share)| share.min(1e30)).sum();
        for (number, share) in own {
            let Some(element) = surface.element().get(number as usize) else {
                continue;
            };
            let finish = scene.elements[*element as usize].finish;
            let sum = &mut shares.entry(finish).or_insert([0.0; 8])[corner];
            *sum += if all > 0.0 {
                share.min(1e30) / all
            } else {
                0.0
            };
        }
    }
    shares.retain(|_, own| own.iter().any(|share| *share > NEGLIGIBLE));
    shares.into_iter().collect()
}

/// Returns three channels of four – ambient and shine, diffuse, specular – as linear functions in a
/// leaf: the mean, and the growth along x, y and z.
fn looks(scene: &Scene, mixture: &[(u32, [f64; 8])], around: Rgb) -> [[[f32; 4]; 4]; 3] {
    let fallback = Finish::default();
    let mut lines = [[[0.0; 4]; 4]; 3];
    for (corner, place) in corners().into_iter().enumerate() {
        let all: f64 = mixture.iter().map(|(_, shares)| shares[corner]).sum();
        for (finish, shares) in mixture {
            let weight = if all > 0.0 {
                shares[corner] / all
            } else {
                1.0 / mixture.len() as f64
            };
            let finish = scene.finishes.get(*finish as usize).unwrap_or(&fallback);
            let [ambient, diffuse] = draft_colours(finish, around);
            let channels = [
                with(ambient, finite(finish.shine).max(0.0)),
                with(diffuse, 0.0),
                with(finish.specular, 0.0),
            ];
            for (line, channel) in lines.iter_mut().zip(&channels) {
                let factors = [1.0, place.x, place.y, place.z].map(|x| (x * weight / 8.0) as f32);
                for (to, factor) in line.iter_mut().zip(factors) {
                    for (sum, own) in to.iter_mut().zip(channel) {
                        *sum += factor * own;
                    }
                }
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formulas::Cubics;

    /// Limbs that end thinner than a cell of their body's mesh, beside thick ones.
    #[test]
    fn thin_limbs_are_whole_beside_a_coarse_mesh() {
        let mut text = String::from(
            "surface core diffuse Red, blob -1.2, radius 0.6\n\
             surface thin diffuse Red, blob -1, radius 0.03 0.004\n\
             surface thick diffuse Red, blob -1, radius 0.3\n\
             gauss core <0 0 0>\nline thick <0 0 0> <0 0 -1.5>\n",
        );
        for i in 0..300 {
            let z = 1.0 - f64::from(2 * i + 1) / 600.0;
            let (sine, cosine) = libm::sincos(2.4 * f64::from(i));
            let way = DVec3::from([cosine, sine, 0.0]) * libm::sqrt(1.0 - z * z);
            let [base, tip] = [0.3, 1.4].map(|far| far * (way + z * DVec3::Z));
            let [base, tip] = [base, tip].map(|p| format!("<{} {} {}>", p.x, p.y, p.z));
            text += &format!("line thin {base} {tip}\n");
        }
        let file = rats::File {
            name: "main.rat".into(),
            text,
        };
        let scene = rats::compile(&rats::Project { files: vec![file] }).scene;
        // The scene in another unit.
        let unit = Unit::of_ball(DVec3::ZERO, 20.0);
        let scene = unit.map_scene(&scene);
        let mut packer = Packer {
            scene: &scene,
            chart: &Cubics,
            data: Vec::new(),
            out: Packed::default(),
        };
        let facets = packer.add_bodies(Detail::Quick, &mut |_| true);
        let facets = facets.expect("wanted");
        assert_eq!(packer.out.meshed, [0]);
        let cones = facets.iter().map(|(solid, _)| solid);
        let cones: Vec<&Solid> = cones.filter(|solid| solid.kind != Kind::Patch).collect();
        assert!(cones.iter().all(|cone| cone.kind == Kind::Cylinder));
        let lines = scene.elements.iter().skip(2);
        let lines = lines.filter_map(|element| match element.shape.skeleton()? {
            Skeleton::Segment { base, apex } => Some([*base, *apex]),
            _ => None,
        });
        let lines: Vec<[DVec3; 2]> = lines.collect();
        assert_eq!((lines.len(), cones.len()), (300, 300));
        for (cone, [base, apex]) in cones.iter().zip(lines) {
            let half = cone.rotation * DVec3::Z * cone.a[1] * cone.unit;
            assert!((cone.origin - half).distance(base) < 1e-9);
            assert!((cone.origin + half).distance(apex) < 1e-9);
            let thinnest = unit.length(cone.thinnest().expect("round"));
            assert!((thinnest - 0.004).abs() < 1e-9);
        }
    }
}
