//! Tool at work: a sweep, point by point.

use crate::clay::Clay;
use crate::decay::Decay;
use crate::delta::Delta;
use crate::limits::MAX_STEPS;
use crate::smooth::mean_of_neighbors;
use crate::solid::Solid;
use crate::spread::{Source, spread};
use crate::stroke::{Action, Constraint, PathPoint, Sweep};
use glam::DVec3;
use mesh::{Aabb, FaceId, VertexId};
use std::collections::{BTreeMap, BTreeSet};

/// Vertex and its motion.
type Motion = (u32, DVec3);

/// Tool on its way. Each point takes time in proportion to what the tool touches there.
pub struct Drag<'a> {
    solid: Box<dyn Solid + 'a>,
    action: Action,
    decay: Decay,
    range: f64,
    constraint: Option<Constraint>,
    only_region: bool,
    /// The signs of the axes of the tool and its mirror images.
    copies: Vec<DVec3>,
    last: Option<PathPoint>,
    /// The vertices that follow each copy, and how far.
    grabbed: Vec<Vec<(u32, f64)>>,
    chosen: BTreeSet<FaceId>,
    /// Values before the first change.
    positions: BTreeMap<u32, DVec3>,
    masks: BTreeMap<u32, f32>,
    colors: BTreeMap<u32, [f32; 3]>,
}

impl<'a> Drag<'a> {
    /// Returns a tool at the start of its way; the sweep's path is not used.
    #[must_use]
    pub fn new(clay: &Clay, sweep: &Sweep) -> Self {
        Self::with_solid(clay, sweep, Box::new(sweep.tool.solid()))
    }

    /// Like [`Drag::new`] with another solid as the tool: a body of a model.
    ///
    /// ```
    /// use glam::DVec3;
    /// use sculpt::{Action, Clay, Drag, Form, PathPoint, Shape, Start, Sweep, Tool};
    ///
    /// let mut clay = Clay::of_shape(&Start::new(Shape::Plane, 8))?;
    /// let hand = Tool::new(Form::Box, DVec3::splat(0.5));
    /// let sweep = Sweep::new(Action::Push, hand.clone());
    /// let mut drag = Drag::with_solid(&clay, &sweep, Box::new(hand.solid()));
    /// drag.step(&mut clay, PathPoint::new(DVec3::new(0.0, 0.0, 0.4)));
    /// drag.finish(&mut clay);
    /// assert!(clay.mesh().vertices().any(|v| clay.mesh().position(v).z < -0.05));
    /// # Ok::<(), sculpt::Error>(())
    /// ```
    #[must_use]
    pub fn with_solid(clay: &Clay, sweep: &Sweep, solid: Box<dyn Solid + 'a>) -> Self {
        let mut copies = vec![DVec3::ONE];
        for axis in (0..3).filter(|axis| clay.symmetry[*axis]) {
            for mut signs in copies.clone() {
                signs[axis] = -1.0;
                copies.push(signs);
            }
        }
        Self {
            solid,
            action: sweep.action,
            decay: sweep.decay,
            range: sweep.range,
            constraint: sweep.constraint,
            only_region: sweep.only_region,
            copies,
            last: None,
            grabbed: Vec::new(),
            chosen: BTreeSet::new(),
            positions: BTreeMap::new(),
            masks: BTreeMap::new(),
            colors: BTreeMap::new(),
        }
    }

    /// Moves the tool to a point in a straight line, in steps of half its least semi-axis.
    pub fn step(&mut self, clay: &mut Clay, point: PathPoint) {
        let from = self.last.replace(point);
        if self.action == Action::Pull {
            match from {
                None => self.grab(clay, point.position),
                Some(from) => self.pull(clay, point.position - from.position, point.pressure),
            }
            return;
        }
        let Some(from) = from else {
            self.touch(clay, point);
            return;
        };
        let way = point.position - from.position;
        let steps = (way.length() / self.solid.step())
            .ceil()
            .clamp(1.0, MAX_STEPS);
        for i in 1..=steps as u32 {
            let t = f64::from(i) / steps;
            let between = PathPoint {
                position: from.position + way * t,
                pressure: from.pressure + (point.pressure - from.pressure) * t,
            };
            self.touch(clay, if t == 1.0 { point } else { between });
        }
    }

    /// Ends the way. Returns what has changed.
    pub(crate) fn end(self, clay: &mut Clay) -> Delta {
        let mut delta = Delta {
            moved: self.positions.into_iter().collect(),
            masks: self.masks.into_iter().collect(),
            colors: self.colors.into_iter().collect(),
            ..Delta::default()
        };
        if let Action::Region(choice) = self.action {
            delta.region = Some(clay.region.clone());
            clay.choose(&self.chosen, choice);
        }
        if !delta.colors.is_empty() && !clay.is_painted {
            delta.is_painted = Some(false);
            clay.is_painted = true;
        }
        delta
    }

    /// Ends the way.
    pub fn finish(self, clay: &mut Clay) {
        drop(self.end(clay));
    }

    /// The vertices inside a copy of the tool, in ascending order.
    fn vertices_inside(&self, clay: &mut Clay, signs: DVec3, center: DVec3) -> Vec<u32> {
        let own = self.solid.bounds();
        let corners = [own.min, own.max].map(|corner| (corner + center) * signs);
        let mut near = Vec::new();
        clay.grid.near(&Aabb::of_points(corners), &mut near);
        clay.work += near.len() as u64;
        near.retain(|v| {
            let v = VertexId(*v);
            self.solid.contains(clay.mesh.position(v) * signs - center)
                && (!self.only_region || clay.mesh.vertex_faces(v).any(|f| clay.is_in_region(f)))
        });
        near
    }

    /// The weights with which vertices follow a copy of the tool.
    fn weights(&self, clay: &mut Clay, signs: DVec3, center: DVec3) -> Vec<(u32, f64)> {
        let touched = self.vertices_inside(clay, signs, center);
        let sources: Vec<Source> = touched
            .into_iter()
            .map(|vertex| Source {
                vertex,
                strength: 1.0,
            })
            .collect();
        let reached = self.spread(clay, &sources);
        reached
            .into_iter()
            .map(|(v, _, weight)| (v, weight))
            .collect()
    }

    /// Vertices that sources reach, with the source's index and the weight.
    fn spread(&self, clay: &mut Clay, sources: &[Source]) -> Vec<(u32, u32, f64)> {
        let reached = spread(
            &clay.mesh,
            &mut clay.scratch,
            sources,
            self.decay,
            self.range,
        );
        clay.work += reached.len() as u64;
        let plain = reached.into_iter().map(|r| (r.vertex, r.source, r.weight));
        plain.collect()
    }

    fn grab(&mut self, clay: &mut Clay, center: DVec3) {
        self.grabbed = self
            .copies
            .iter()
            .map(|signs| self.weights(clay, *signs, center))
            .collect();
    }

    fn pull(&mut self, clay: &mut Clay, way: DVec3, pressure: f64) {
        let mut motions: Vec<Motion> = Vec::new();
        for (signs, grabbed) in self.copies.iter().zip(&self.grabbed) {
            let motion = way * *signs * pressure;
            motions.extend(grabbed.iter().map(|(v, weight)| (*v, motion * *weight)));
        }
        clay.work += motions.len() as u64;
        self.move_vertices(clay, motions);
    }

    /// Carries out the action at one place.
    fn touch(&mut self, clay: &mut Clay, point: PathPoint) {
        match self.action {
            Action::Pull => {}
            Action::Push => self.push(clay, point),
            Action::Region(_) => {
                for signs in self.copies.clone() {
                    let touched = self.vertices_inside(clay, signs, point.position);
                    let faces = touched
                        .iter()
                        .flat_map(|v| clay.mesh.vertex_faces(VertexId(*v)));
                    self.chosen.extend(faces);
                }
            }
            Action::Smooth | Action::Mask(_) | Action::Paint(_) => self.brush(clay, point),
        }
    }

    fn push(&mut self, clay: &mut Clay, point: PathPoint) {
        let mut motions: Vec<Motion> = Vec::new();
        let mut inside: Vec<Vec<u32>> = Vec::new();
        for signs in &self.copies {
            let touched = self.vertices_inside(clay, *signs, point.position);
            let driven = self.drive_out(clay, &touched, *signs, point);
            let sources: Vec<Source> = driven
                .iter()
                .map(|(v, motion)| Source {
                    vertex: *v,
                    strength: motion.length(),
                })
                .collect();
            for (v, source, weight) in self.spread(clay, &sources) {
                motions.push((v, driven[source as usize].1 * weight));
            }
            inside.push(touched);
        }
        self.move_vertices(clay, motions);
        if self.range <= 0.0 {
            return;
        }
        // Vertices that no neighbour's motion has brought out.
        let mut motions: Vec<Motion> = Vec::new();
        for (signs, touched) in self.copies.iter().zip(&inside) {
            motions.extend(self.drive_out(clay, touched, *signs, point));
        }
        self.move_vertices(clay, motions);
    }

    /// The motions that drive vertices out of a copy of the tool.
    fn drive_out(
        &self,
        clay: &Clay,
        vertices: &[u32],
        signs: DVec3,
        point: PathPoint,
    ) -> Vec<Motion> {
        vertices
            .iter()
            .filter_map(|v| {
                let local = clay.mesh.position(VertexId(*v)) * signs - point.position;
                let out = self.solid.drive_out(local)? - local;
                Some((*v, out * signs * point.pressure))
            })
            .collect()
    }

    /// Moves vertices; of several motions of a vertex in the same direction of an axis the largest
    /// counts, so that a tool and its mirror images are one tool where they overlap.
    fn move_vertices(&mut self, clay: &mut Clay, mut motions: Vec<Motion>) {
        motions.sort_by_key(|(v, _)| *v);
        let mut places: Vec<Motion> = Vec::with_capacity(motions.len());
        for group in motions.chunk_by(|a, b| a.0 == b.0) {
            let v = VertexId(group[0].0);
            let free = 1.0 - f64::from(clay.mask(v));
            let motion = match group {
                [(_, only)] => *only,
                _ => {
                    group.iter().fold(DVec3::ZERO, |sum, (_, m)| sum.max(*m))
                        + group.iter().fold(DVec3::ZERO, |sum, (_, m)| sum.min(*m))
                }
            };
            let motion = match self.constraint {
                None => motion,
                Some(constraint) => {
                    let normal = clay.normal(v);
                    let along = normal * motion.dot(normal);
                    match constraint {
                        Constraint::Normal => along,
                        Constraint::Tangent => motion - along,
                    }
                }
            };
            if free > 0.0 && motion != DVec3::ZERO {
                places.push((v.0, clay.mesh.position(v) + motion * free));
            }
        }
        self.set_places(clay, places);
    }

    fn set_places(&mut self, clay: &mut Clay, places: Vec<Motion>) {
        for (v, place) in places {
            let old = clay.replace_position(v, place);
            self.positions.entry(v).or_insert(old);
        }
    }

    /// Smooths, masks or paints.
    fn brush(&mut self, clay: &mut Clay, point: PathPoint) {
        let mut weights: Vec<(u32, f64)> = Vec::new();
        for signs in &self.copies {
            weights.extend(self.weights(clay, *signs, point.position));
        }
        weights.sort_by_key(|(v, _)| *v);
        let weights = weights.chunk_by(|a, b| a.0 == b.0).map(|group| {
            let most = group.iter().map(|(_, weight)| *weight).fold(0.0, f64::max);
            (group[0].0, most * point.pressure)
        });
        match self.action {
            Action::Mask(value) => weights.for_each(|(v, weight)| {
                let mask = &mut clay.masks[v as usize];
                self.masks.entry(v).or_insert(*mask);
                *mask = mix(*mask, value, weight);
            }),
            Action::Paint(color) => {
                let color = color.map(linear);
                weights.for_each(|(v, weight)| {
                    let own = &mut clay.colors[v as usize];
                    self.colors.entry(v).or_insert(*own);
                    *own = [0, 1, 2].map(|k| mix(own[k], color[k], weight));
                });
            }
            _ => {
                let moved: Vec<(u32, DVec3, f64)> = weights
                    .map(|(v, weight)| {
                        let id = VertexId(v);
                        let p = clay.mesh.position(id);
                        let free = 1.0 - f64::from(clay.mask(id));
                        let motion = mean_of_neighbors(&clay.mesh, id) - p;
                        (v, motion * weight, free)
                    })
                    .collect();
                let moving = moved.into_iter().filter(|(_, _, free)| *free > 0.0);
                let motions = moving.map(|(v, motion, _)| (v, motion)).collect();
                self.move_vertices(clay, motions);
            }
        }
    }
}

/// Returns a value on the way to another, `from + (to − from)·weight`, cut to 0 … 1.
fn mix(from: f32, to: f64, weight: f64) -> f32 {
    let from = f64::from(from);
    ((from + (to - from) * weight) as f32).clamp(0.0, 1.0)
}

/// The linear value of an sRGB channel, 0 … 1.
fn linear(channel: f64) -> f64 {
    if channel <= 0.040_45 {
        channel / 12.92
    } else {
        libm::pow((channel + 0.055) / 1.055, 2.4)
    }
}
