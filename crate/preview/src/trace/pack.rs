//! A scene as the numbers that `shaders/scene.wgsl` reads, four by four.

use super::formulas;
use super::hierarchy;
use super::octree::{Cell, ENDLESS, Leaf, Octree, corners};
use crate::facets;
use crate::materials::{Table, draft_colours, finite, with};
use crate::solid::{Kind, Solid};
use bytemuck::{Pod, Zeroable};
use field::{Primitive, Skeleton};
use glam::{DVec3, Vec3};
use scene::{Finish, Rgb, Scene, Shape, Surface};
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

/// The uniform `frame` of `shaders/scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Frame {
    pub(crate) middle: [f32; 4],
    pub(crate) counts: [u32; 4],
    pub(crate) places: [u32; 4],
}

/// A scene, packed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Packed {
    pub(crate) data: Vec<[u32; 4]>,
    pub(crate) frame: Frame,
    /// Numbers of elements drawn, of leaves, of leaves whose cubics are not close.
    pub(crate) elements: usize,
    pub(crate) leaves: usize,
    pub(crate) rough: usize,
    /// The formulas that leaves' terms have, as [`formulas::code`] reads them.
    pub(crate) formulas: BTreeSet<u32>,
}

/// Longest span of a ray in a leaf that lists terms, in widths of the narrowest kernel.
const SPAN: f64 = 0.35;

impl Packed {
    /// Packs a scene in draft units, with about `most` leaves.
    pub(crate) fn new(scene: &Scene, materials: &Table, most: usize) -> Self {
        let mut packed = Self::default();
        packed.add_solids(scene, materials);
        packed.add_bodies(scene, materials, most);
        // There is always something to bind.
        packed.data.push([0; 4]);
        packed
    }

    fn push(&mut self, numbers: [f32; 4]) {
        self.data.push(numbers.map(f32::to_bits));
    }

    fn push_with(&mut self, place: Vec3, word: u32) {
        let [x, y, z] = place.to_array().map(f32::to_bits);
        self.data.push([x, y, z, word]);
    }

    /// Adds hard shapes, planes first, and their hierarchy. Soft planes are among them for what is
    /// beyond the octree of their body.
    fn add_solids(&mut self, scene: &Scene, materials: &Table) {
        let detail = facets::detail(scene);
        let mut solids = Vec::new();
        for element in &scene.elements {
            let is_soft = scene.is_soft(element);
            let is_plane = matches!(&element.shape, Shape::Bone(bone)
                if matches!(bone.skeleton, Skeleton::Plane { .. }));
            if element.finish as usize >= scene.finishes.len() || is_soft && !is_plane {
                continue;
            }
            let own = Solid::of(scene, element, detail);
            self.elements += usize::from(!own.is_empty() && !is_soft);
            for mut solid in own {
                if is_soft {
                    solid.a[1] = ENDLESS;
                }
                let paint = element.paint.as_ref().filter(|_| solid.kind == Kind::Patch);
                let finish = paint.map_or(element.finish, |paint| paint.finish);
                let material = materials.slot(finish as usize);
                solids.push((solid.move_origin_near(DVec3::ZERO), material));
            }
        }
        let (planes, others): (Vec<_>, Vec<_>) =
            (solids.into_iter()).partition(|(solid, _)| solid.kind == Kind::Plane);
        self.frame.counts[1] = planes.len() as u32;
        self.frame.places[1] = self.data.len() as u32;
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
        self.frame.counts[2] = nodes.len() as u32;
        self.frame.places[2] = self.data.len() as u32;
        for node in nodes {
            let item = node.item.map_or(u32::MAX, |i| i + planes.len() as u32);
            self.push_with(node.low.as_vec3(), node.next);
            self.push_with(node.high.as_vec3(), item);
        }
    }

    /// Adds the bodies' octrees.
    fn add_bodies(&mut self, scene: &Scene, materials: &Table, most: usize) {
        let surfaces = scene.surfaces();
        let most = most / surfaces.len().max(1);
        let mut roots = Vec::new();
        for surface in &surfaces {
            let own: BTreeSet<u32> = surface.element().iter().copied().collect();
            self.elements += own.len();
            let tree = Octree::new(surface.function(), most, &|terms| match surface {
                Surface::Sum(sum) => list(&sum.sum.primitives, terms),
                Surface::Composed(_) => Vec::new(),
            });
            let Some(tree) = tree else {
                continue;
            };
            self.leaves += tree.leaves.len();
            self.rough += tree.rough;
            let places = self.add_leaves(scene, surface, &tree, materials);
            let first = self.data.len() as u32;
            let words = tree.cells.iter().map(|cell| match cell {
                Cell::Parted(at) => first + (at - 1) / 4,
                Cell::Outside => OUTSIDE,
                Cell::Inside => INSIDE,
                Cell::Leaf(number) => LEAF | places[*number as usize],
            });
            let words: Vec<u32> = words.collect();
            self.data.extend(words[1..].as_chunks::<4>().0);
            roots.push((tree.center, tree.half, words[0]));
        }
        self.frame.counts[0] = roots.len() as u32;
        self.frame.places[0] = self.data.len() as u32;
        for (center, half, word) in roots {
            self.push(center.as_vec3().extend(half as f32).to_array());
            self.data.push([word, 0, 0, 0]);
        }
    }

    /// Adds the leaves of a body, and returns their places.
    fn add_leaves(
        &mut self,
        scene: &Scene,
        surface: &Surface,
        tree: &Octree,
        materials: &Table,
    ) -> Vec<u32> {
        let elements = surface.element().iter();
        let finishes: BTreeSet<u32> = elements
            .map(|element| scene.elements[*element as usize].finish)
            .collect();
        let around = scene.background.mean();
        let mut records: BTreeMap<u32, [u32; 4]> = BTreeMap::new();
        let mut places = Vec::with_capacity(tree.leaves.len());
        for leaf in &tree.leaves {
            let mixture = if finishes.len() > 1 {
                mixture(scene, surface, leaf)
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
                        .or_insert_with(|| formulas::pack(primitive, &mut self.data));
                    self.formulas.insert(record[0]);
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
                materials.slot(finish as usize)
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
fn list(primitives: &[Primitive], terms: Option<&[u32]>) -> Vec<u32> {
    let count = terms.map_or(primitives.len(), <[u32]>::len);
    if count > MOST_TERMS {
        return Vec::new();
    }
    let terms = terms.map_or_else(|| (0..count as u32).collect(), <[u32]>::to_vec);
    let known = terms
        .iter()
        .all(|i| formulas::has(&primitives[*i as usize]));
    if known { terms } else { Vec::new() }
}

/// Returns the share of each finish at a leaf's corners: all those that count at one of them.
fn mixture(scene: &Scene, surface: &Surface, leaf: &Leaf) -> Vec<(u32, [f64; 8])> {
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
            _ => surface.function().shares(point, &mut own),
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
