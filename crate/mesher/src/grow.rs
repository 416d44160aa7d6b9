//! Cells of the size that the surface's curvature asks for, as samples tell it: for meshes whose
//! error is measured, not proved.
//!
//! Bounds say where no surface can be, and when cells are so small that nothing hides between
//! samples. From there on samples decide alone, eight at a time: at the corners and centres of
//! cells, which neighbours share, and on the edges that the surface crosses. Where it leaves the
//! cells that were taken for all of it, it is followed into those beside them.

use crate::certify::{Vertex, sag};
use crate::crease::{is_turned, meet};
use crate::forest::{Cell, Forest, NONE, Side};
use crate::lattice::{Key, Lattice, pack, tetrahedra, unpack};
use crate::march::crossing_share;
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::refine::{around, coarse_range, crossing, error, side};
use crate::space::{SLACK, Space};
use core::hash::{BuildHasherDefault, Hasher};
use field::{Ball, Jet, Part, THRESHOLD};
use glam::DVec3;
use std::collections::HashMap;

/// Cells are taken to hide nothing if the second derivative's bound times the square of their size
/// is at most so many thresholds: first the least, then more where that asks for too many cells, as
/// where bounds are far from the truth.
pub const HIDING: [f64; 3] = [6.0, 60.0, 600.0];
/// Nor if they are no larger than this share of the width of the kernels that matter there.
const WIDTHS: f64 = 0.8;
/// Largest height of the surface's arc between two of its places in a cell, in tolerances.
pub const SAG: f64 = 0.8;
/// Largest distance from the surface, in tolerances, of a crease and of places on both sides of it.
const CREASED: f64 = 0.4;
/// Largest height of a bulge of the surface that a cell hides between samples, in tolerances.
const HIDDEN: f64 = 0.5;
/// Least cosine of the angle between the surface's normal in a cell and the mean of all there.
const EVEN: f64 = 0.5;
/// Cells are not divided below so many tolerances where only normals ask for it, as at creases.
pub const FINEST: f64 = 2.0;
/// Levels below that of the finest cells, for parts that are thinner.
pub const LEVELS: u32 = 6;
/// Largest dip of the function below its interpolant in a cell, over that along its edges and those
/// from its centre.
const BEND: f64 = 3.0;
/// Change of the function over the tolerance, in thresholds, below which it is flat.
pub const FLAT: f64 = 1e-10;
/// Bound on the relative error of values in single precision.
const SINGLE: f64 = 1e-5;
/// Cells that are looked at between two reports.
const BATCH: usize = 20_000;

/// Edges of a cell by the numbers of their ends: bit k of a corner's number is its place along the
/// axis k.
pub const EDGES: [[usize; 2]; 12] = {
    let mut edges = [[0; 2]; 12];
    let mut n = 0;
    while n < 12 {
        let (axis, place) = (n / 4, n % 4);
        let low = match axis {
            0 => 2 * place,
            1 => (place & 1) | (place & 2) << 1,
            _ => place,
        };
        edges[n] = [low, low | 1 << axis];
        n += 1;
    }
    edges
};

/// Mixes the bits of a key.
#[derive(Debug, Default)]
pub struct Mix(u64);

impl Hasher for Mix {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.write_u64(u64::from(*byte));
        }
    }

    fn write_u64(&mut self, key: u64) {
        let mixed = (self.0 ^ key).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ mixed >> 32;
    }
}

/// The function, less the threshold, at corners of cells.
#[derive(Debug, Default)]
pub struct Corners {
    numbers: HashMap<Key, u32, BuildHasherDefault<Mix>>,
    vertices: Vec<Vertex>,
    /// Number of each cell's list of corners; [`NONE`] if it has none.
    lists: Vec<u32>,
    corners: Vec<[u32; 8]>,
}

impl Corners {
    /// The function at the corners of a cell; `None` if it was not evaluated there.
    pub fn of(&self, node: u32) -> Option<[&Vertex; 8]> {
        let list = *self.lists.get(node as usize)?;
        let corners = self.corners.get(list as usize)?;
        Some(corners.map(|i| &self.vertices[i as usize]))
    }

    /// Evaluates the function at the corners of leaves, where that was not done.
    fn extend(
        &mut self,
        space: &Space<'_>,
        leaves: &[u32],
        tolerance: f64,
        threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<(), MeshError> {
        let forest = &space.forest;
        let mut places = Vec::new();
        self.lists.resize(forest.cells.len(), NONE);
        for node in leaves {
            if self.lists[*node as usize] != NONE {
                continue;
            }
            let cell = &forest.cells[*node as usize];
            let corners = corner_keys(forest, cell).map(|key| {
                let next = (self.vertices.len() + places.len()) as u32;
                let number = *self.numbers.entry(key).or_insert(next);
                if number == next {
                    places.push((cell.part, forest.position(unpack(key))));
                }
                number
            });
            self.lists[*node as usize] = self.corners.len() as u32;
            self.corners.push(corners);
        }
        let jets = space.jets_in_parts(&places, tolerance, threads, progress)?;
        let found = places.iter().zip(&jets);
        (self.vertices).extend(found.map(|((_, place), jet)| Vertex::new(*place, jet)));
        Ok(())
    }
}

/// The corners of a cell.
fn corner_keys(forest: &Forest, cell: &Cell) -> [Key; 8] {
    let (low, span) = (forest.corner(cell), forest.span(cell.level));
    core::array::from_fn(|i| pack([0, 1, 2].map(|k| low[k] + span * (i as u32 >> k & 1))))
}

/// A cell by bounds.
struct Bounded {
    /// Bounds on values.
    range: [f64; 2],
    /// Bounds on the gradient, the second derivative, and jumps of the gradient and of the value.
    slope: f64,
    bend: f64,
    jump: f64,
    step: f64,
    /// Error of values.
    off: f64,
    /// Whether nothing hides between samples.
    is_tame: bool,
}

impl Bounded {
    fn new(space: &Space<'_>, cell: &Cell, hiding: f64) -> Self {
        let size = space.forest.size(cell.level);
        let (center, longest) = (space.forest.center(cell), size.max_element());
        let off = error(space, cell.part, size);
        let mut known = cell.bend;
        if hiding.is_infinite() {
            // No bounds are asked for.
            known = f64::MAX;
        } else if known.is_infinite() {
            let radius = 0.5 * size.length();
            let width = space.least_width(cell.part, Ball { center, radius });
            if longest <= WIDTHS * width {
                known = f64::MAX;
            }
        }
        if known.is_finite() {
            let [jump, step] = cell.jumps;
            return Self {
                range: [f64::NEG_INFINITY, f64::INFINITY],
                slope: f64::INFINITY,
                bend: known,
                jump,
                step,
                off,
                is_tame: true,
            };
        }
        let variation = around(space, cell.part, center, size);
        // Largest change of the gradient's part along a side of the cell, times that side: between
        // kinks, and with them.
        let bent = variation.curvature * longest * longest;
        let turn = bent + variation.jump * longest;
        // However small a cell with a kink is, its jump stays: there a cell of the usual size will
        // do, if the function is tame beside the kink.
        let most = hiding * THRESHOLD;
        let is_small = bent <= most && variation.jump > 0.0 && cell.level >= space.forest.usual;
        Self {
            range: coarse_range(&variation, off),
            slope: variation.range.slope,
            bend: variation.curvature,
            jump: variation.jump,
            step: variation.step,
            off,
            is_tame: turn <= most || is_small,
        }
    }

    /// The bounds on values with the function at the cell's centre, which may be single.
    fn narrow(&self, jet: &Jet<f64>, size: DVec3) -> [f64; 2] {
        let radius = 0.5 * size.length() * (1.0 + 1e-9);
        // A box is a part of the ball.
        let linear = (0.5 * DVec3::from_array(jet.gradient).abs() * size).element_sum();
        let bent = (0.5 * self.bend * radius + self.jump) * radius;
        let single = SINGLE * (THRESHOLD + jet.value.abs() + linear);
        let change = (linear + bent).min(self.slope * radius);
        let change = change + self.step + self.off + SLACK + single;
        [
            self.range[0].max(jet.value - change),
            self.range[1].min(jet.value + change),
        ]
    }
}

/// Verdict on a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Leaf(Side),
    Split,
}

/// Whether the corners on each side are connected by edges of the cell: then the surface is a disc
/// there.
fn is_simple(inside: [bool; 8]) -> bool {
    let mut group: [usize; 8] = core::array::from_fn(|i| i);
    for [a, b] in EDGES {
        if inside[a] == inside[b] {
            let (old, new) = (group[a], group[b]);
            group
                .iter_mut()
                .filter(|g| **g == old)
                .for_each(|g| *g = new);
        }
    }
    let count = (0..8).filter(|i| group.contains(i)).count();
    count <= 2
}

/// Returns how far a function is from the threshold, and the gradient of that: the surface hides
/// between samples only where this sags between them. Inside it may be the logarithm's: that of
/// kernels which add up hardly sags, while they are steep themselves.
fn margin(vertex: &Vertex, is_logarithmic: bool) -> (f64, DVec3) {
    if vertex.value > 0.0 && is_logarithmic {
        let share = THRESHOLD / (THRESHOLD + vertex.value);
        (-THRESHOLD * libm::log(share), vertex.gradient * share)
    } else if vertex.value > 0.0 {
        (vertex.value, vertex.gradient)
    } else {
        (-vertex.value, -vertex.gradient)
    }
}

/// Looks at a cell by samples, where nothing hides between them.
fn look(
    space: &Space<'_>,
    cell: &Cell,
    middle: &Vertex,
    corners: [&Vertex; 8],
    (tolerance, deepest): (f64, u32),
    is_crossed: bool,
) -> Fate {
    let forest = &space.forest;
    let is_usual = cell.level >= forest.usual;
    // A value that is no number counts as outside.
    let own = middle.value > 0.0;
    let inside = corners.map(|corner| corner.value > 0.0);
    let beyond = inside.iter().filter(|side| **side != own).count();
    if beyond == 0 {
        if is_crossed {
            return Fate::Leaf(Side::Crossing);
        }
        let is_logarithmic = space.is_logarithmic_inside();
        let (mut least, own_slope) = margin(middle, is_logarithmic);
        let margins = corners.map(|corner| margin(corner, is_logarithmic));
        let [mut bend, mut slope] = [0.0, own_slope.length()];
        for (corner, (margin, end)) in corners.iter().zip(&margins) {
            let way = corner.position - middle.position;
            bend = bend.max((*end - own_slope).dot(way));
            (least, slope) = (least.min(*margin), slope.min(end.length()));
        }
        for [low, high] in EDGES {
            let way = corners[high].position - corners[low].position;
            bend = bend.max((margins[high].1 - margins[low].1).dot(way));
        }
        // Between samples the function dips below its interpolant as along the edges between them
        // and from the centre. If that is too far, the surface bulges into the cell, but not much.
        // Not so for NaN.
        let is_far = BEND * bend / 8.0 < least + HIDDEN * tolerance * slope;
        if is_far || is_usual {
            return Fate::Leaf(if own { Side::Inside } else { Side::Outside });
        }
        return Fate::Split;
    }
    if beyond == 8 || !is_simple(inside) {
        let all = corners.iter().map(|corner| corner.gradient.length());
        let slope = all.fold(middle.gradient.length(), f64::max);
        // Where the function is flat its signs are those of roundings. Not so for NaN.
        let is_steep = slope * tolerance >= FLAT * THRESHOLD;
        let can_split = cell.level < deepest && (is_steep || !is_usual);
        return if can_split {
            Fate::Split
        } else {
            Fate::Leaf(Side::Crossing)
        };
    }
    if is_usual {
        return Fate::Leaf(Side::Crossing);
    }
    let mut places = [DVec3::ZERO; 8];
    let mut count = 0;
    for [a, b] in EDGES {
        if inside[a] != inside[b] && count < 8 {
            places[count] = on_edge([corners[a], corners[b]]);
            count += 1;
        }
    }
    let first = places[0];
    places[count..].fill(first);
    let jets = space.jets(cell.part, &places, tolerance);
    let found: [Vertex; 8] = core::array::from_fn(|i| Vertex::new(places[i], &jets[i]));
    let found = &found[..count];
    let normals = found.iter().map(Vertex::normal);
    let mean = normals.sum::<DVec3>().normalize_or_zero();
    let mut is_fine = found.iter().all(|vertex| vertex.normal().dot(mean) >= EVEN);
    for (i, one) in found.iter().enumerate() {
        is_fine &= found[..i]
            .iter()
            .all(|other| sag(one, other) <= SAG * tolerance);
    }
    if is_fine || is_creased(space, cell, found, tolerance) {
        Fate::Leaf(Side::Crossing)
    } else {
        Fate::Split
    }
}

/// Whether the surface has a crease in a cell, and is flat between it and the places where edges of
/// the cell cross the surface.
fn is_creased(space: &Space<'_>, cell: &Cell, found: &[Vertex], tolerance: f64) -> bool {
    if !is_turned(found) {
        return false;
    }
    let edge = meet(found);
    let room = 0.5 * space.forest.size(cell.level);
    let off = (edge - space.forest.center(cell)).abs();
    // Not so for NaN.
    let is_within = off.cmple(room).all();
    if !is_within {
        return false;
    }
    let mut places = [edge; 8];
    for (place, own) in places[1..].iter_mut().zip(found) {
        *place = 0.5 * (edge + own.position);
    }
    let jets = space.jets(cell.part, &places, tolerance);
    let mut places = places.iter().zip(&jets);
    places.all(|(place, jet)| Vertex::new(*place, jet).distance() <= CREASED * tolerance)
}

/// The place of the surface on an edge whose ends are on different sides, by the function there.
pub fn on_edge([a, b]: [&Vertex; 2]) -> DVec3 {
    let way = b.position - a.position;
    let slopes = [a, b].map(|end| end.gradient.dot(way));
    a.position + way * crossing_share([a.value, b.value], slopes)
}

/// Sizes and limits of cells.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    /// The tolerance.
    pub tolerance: f64,
    /// Trust in bounds: one of [`HIDING`], or infinity for a look at samples alone.
    pub hiding: f64,
    /// Most cells.
    pub most: usize,
    /// Threads.
    pub threads: usize,
}

/// Divides the cells that are not known yet, and follows the surface along edges of cells, from
/// some leaves that it is known to cross, besides.
///
/// # Errors
/// If there are too many cells, or if the caller cancels.
pub fn grow(
    space: &mut Space<'_>,
    corners: &mut Corners,
    crossed: Vec<u32>,
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    let mut left = crossed;
    let mut fraction = 0.0;
    loop {
        let mut fresh = divide(space, corners, &left, sizes, progress)?;
        fraction += 0.3 * (1.0 - fraction);
        progress.at(fraction)?;
        let forest = &space.forest;
        fresh.retain(|i| is_crossing(forest, *i));
        let found = map_told(sizes.threads, &fresh, progress, |node| {
            let mut found = Vec::new();
            each_crossed_edge(forest, corners, *node, false, |ring, _| {
                let beside = ring.into_iter().flatten();
                found.extend(beside.filter(|i| !is_crossing(forest, *i)));
            });
            found
        })?;
        left = found.into_iter().flatten().collect();
        left.sort_unstable();
        left.dedup();
        if left.is_empty() {
            return Ok(());
        }
    }
}

fn is_crossing(forest: &Forest, node: u32) -> bool {
    let cell = &forest.cells[node as usize];
    cell.child == NONE && cell.side == Side::Crossing
}

/// Calls a function with the leaves around each edge of a leaf whose ends are on different sides,
/// unless finer leaves have parts of that edge, and with the edge's ends, the inner one first. The
/// leaves are in the order in which they surround the way outward; `None` where the box ends. If
/// `once`, only the first of the smallest leaves around an edge is called for it.
pub fn each_crossed_edge(
    forest: &Forest,
    corners: &Corners,
    node: u32,
    once: bool,
    mut each: impl FnMut([Option<u32>; 4], [&Vertex; 2]),
) {
    let cell = &forest.cells[node as usize];
    let Some(ends) = corners.of(node) else {
        return;
    };
    'edges: for (n, [low, high]) in EDGES.into_iter().enumerate() {
        let is_out = ends[low].value > 0.0;
        if is_out == (ends[high].value > 0.0) {
            continue;
        }
        let axis = n / 4;
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let [at_u, at_v] = [u, v].map(|k| (low >> k & 1) as i64);
        let mut ring = [None; 4];
        let mut is_first = true;
        // Counter-clockwise around the axis.
        for (own, [x, y]) in ring.iter_mut().zip([[-1, -1], [0, -1], [0, 0], [-1, 0]]) {
            let mut direction = [0; 3];
            direction[u] = x + at_u;
            direction[v] = y + at_v;
            *own = if direction == [0; 3] {
                is_first = false;
                Some(node)
            } else {
                forest.neighbor(cell, direction)
            };
            let Some(other) = own.map(|i| &forest.cells[i as usize]) else {
                continue;
            };
            let is_before = once && is_first && other.level == cell.level;
            if other.child != NONE || is_before {
                continue 'edges;
            }
        }
        if !is_out {
            ring.reverse();
        }
        let [low, high] = [low, high].map(|i| ends[i]);
        each(ring, if is_out { [low, high] } else { [high, low] });
    }
}

/// Does the same for tetrahedra: finds values at the vertices of all tetrahedra of cells that the
/// surface crosses, and cells beside them that it crosses, too.
///
/// # Errors
/// If there are too many cells, or if the caller cancels.
pub fn grow_tetrahedra(
    space: &mut Space<'_>,
    corners: &mut Corners,
    lattice: &mut Lattice,
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    let mut left = Vec::new();
    let mut fraction = 0.0;
    loop {
        divide(space, corners, &left, sizes, progress)?;
        fraction += 0.3 * (1.0 - fraction);
        progress.at(fraction)?;
        let cells = crossing(&space.forest);
        lattice.extend(
            space,
            &cells,
            false,
            sizes.tolerance,
            sizes.threads,
            progress,
        )?;
        left = follow(space, lattice, &cells, sizes.threads, progress)?;
        if left.is_empty() {
            return Ok(());
        }
    }
}

/// Looks at some leaves that the surface is known to cross, then at all that are not known, and
/// splits those that need it, until there are none. Returns all that were looked at.
fn divide(
    space: &mut Space<'_>,
    corners: &mut Corners,
    crossed: &[u32],
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<Vec<u32>, MeshError> {
    let mut open = crossed.to_vec();
    let mut looked = Vec::new();
    let mut is_crossed = true;
    let mut fresh = 0;
    loop {
        looked.extend_from_slice(&open);
        for batch in open.chunks(BATCH) {
            progress.again()?;
            let fates = decide(space, corners, batch, sizes, is_crossed, progress)?;
            let split = batch.iter().zip(&fates);
            let split = split.filter(|(_, fate)| **fate == Fate::Split);
            let split: Vec<u32> = split.map(|(node, _)| *node).collect();
            for (node, fate) in batch.iter().zip(fates) {
                let cell = &mut space.forest.cells[*node as usize];
                // Else a neighbour was split.
                if cell.child == NONE {
                    cell.side = match fate {
                        Fate::Leaf(side) => side,
                        Fate::Split => Side::Crossing,
                    };
                }
            }
            split_all(space, &split, sizes.threads, progress)?;
            if space.forest.cells.len() > sizes.most {
                return Err(MeshError::TooMany {
                    limit: sizes.most,
                    fitting: None,
                });
            }
        }
        is_crossed = false;
        let cells = &space.forest.cells;
        let all = (fresh..cells.len() as u32).zip(&cells[fresh as usize..]);
        let new = all.filter(|(_, cell)| cell.child == NONE && cell.side == Side::Unknown);
        open = new.map(|(i, _)| i).collect();
        fresh = cells.len() as u32;
        if open.is_empty() {
            return Ok(looked);
        }
    }
}

/// Splits leaves, and gives their children the terms of the function that matter there.
pub fn split_all(
    space: &mut Space<'_>,
    leaves: &[u32],
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    let parts: Vec<Option<Part>> = map_told(threads, leaves, progress, |node| {
        space.narrow(&space.forest.cells[*node as usize])
    })?;
    for (node, part) in leaves.iter().zip(parts) {
        let cell = space.forest.cells[*node as usize];
        if cell.child != NONE {
            // For the sake of a neighbour.
            continue;
        }
        if let Some(part) = part {
            space.forest.cells[*node as usize].part = space.add(part, cell.part);
        }
        space.forest.cells[*node as usize].side = Side::Crossing;
        space.forest.split(*node);
    }
    Ok(())
}

/// Decides on leaves.
fn decide(
    space: &mut Space<'_>,
    corners: &mut Corners,
    leaves: &[u32],
    sizes: &Sizes,
    is_crossed: bool,
    progress: &mut Progress<'_>,
) -> Result<Vec<Fate>, MeshError> {
    let Sizes {
        tolerance,
        hiding,
        threads,
        ..
    } = *sizes;
    let mut fates = vec![Fate::Split; leaves.len()];
    // By bounds.
    let bounded = map_told(threads, leaves, progress, |node| {
        Bounded::new(space, &space.forest.cells[*node as usize], hiding)
    })?;
    let mut open: Vec<usize> = Vec::new();
    for (i, own) in bounded.iter().enumerate() {
        let sure = side(own.range);
        if is_crossed || sure == Side::Crossing || own.jump > 0.0 {
            open.push(i);
        } else {
            fates[i] = Fate::Leaf(sure);
        }
    }
    // By the function at their centres.
    let centers = open.iter().map(|i| {
        let cell = space.forest.cells[leaves[*i] as usize];
        (cell.part, space.forest.center(&cell))
    });
    let centers: Vec<(u32, DVec3)> = centers.collect();
    let jets = space.jets_in_parts(&centers, tolerance, threads, progress)?;
    let mut near: Vec<(usize, Vertex)> = Vec::new();
    for ((i, (_, center)), jet) in open.iter().zip(&centers).zip(&jets) {
        let (own, cell) = (&bounded[*i], space.forest.cells[leaves[*i] as usize]);
        let sure = side(own.narrow(jet, space.forest.size(cell.level)));
        if !is_crossed && sure != Side::Crossing {
            fates[*i] = Fate::Leaf(sure);
        } else if own.is_tame || cell.level >= space.forest.deepest {
            // Bounds of a tame cell hold for the cells inside it, which need none of their own;
            // infinite ones would tell nothing there.
            if own.is_tame && own.jump.is_finite() {
                let cell = &mut space.forest.cells[leaves[*i] as usize];
                (cell.bend, cell.jumps) = (own.bend, [own.jump, own.step]);
            }
            near.push((*i, Vertex::new(*center, jet)));
        }
    }
    // Without bounds, samples tell nothing of finer parts.
    let deepest = match hiding.is_infinite() {
        true => space.forest.usual,
        false => space.forest.deepest,
    };
    // By all samples.
    let nodes: Vec<u32> = near.iter().map(|(i, _)| leaves[*i]).collect();
    corners.extend(space, &nodes, tolerance, threads, progress)?;
    let (space, corners) = (&*space, &*corners);
    let found = map_told(threads, &near, progress, |(i, middle)| {
        let cell = space.forest.cells[leaves[*i] as usize];
        match corners.of(leaves[*i]) {
            Some(ends) => look(space, &cell, middle, ends, (tolerance, deepest), is_crossed),
            None => Fate::Split,
        }
    })?;
    for ((i, _), fate) in near.iter().zip(found) {
        fates[*i] = fate;
    }
    Ok(fates)
}

/// The cells beside some that the surface crosses, which it crosses too, but are not known to be.
fn follow(
    space: &Space<'_>,
    lattice: &Lattice,
    cells: &[u32],
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<Vec<u32>, MeshError> {
    let found = map_told(threads, cells, progress, |node| {
        let mut found = Vec::new();
        tetrahedra(&space.forest, *node, &mut |keys, owners| {
            let cells = owners.map(|i| (i, space.forest.cells[i as usize].side));
            let new = cells
                .into_iter()
                .filter(|(_, side)| *side != Side::Crossing);
            let before = found.len();
            found.extend(new.map(|(i, _)| i));
            if found.len() > before {
                let inside = keys.map(|key| lattice.value(lattice.index(key)) > 0.0);
                if !inside.contains(&true) || !inside.contains(&false) {
                    found.truncate(before);
                }
            }
        });
        found
    })?;
    let mut found: Vec<u32> = found.into_iter().flatten().collect();
    found.sort_unstable();
    found.dedup();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::Sum;
    use mesh::Aabb;
    use trials::{Random, count};

    /// A ball bulges into cells whose corners it does not reach by less than the part of the
    /// tolerance that they may hide.
    #[test]
    fn cells_hide_a_small_bulge() {
        fn on_ball(position: DVec3) -> Vertex {
            Vertex {
                position,
                value: 0.5 * (1.0 - position.length_squared()),
                gradient: -position,
            }
        }
        let (nothing, side) = (Sum::default(), DVec3::splat(2.0));
        let domain = Aabb::of_points([-side, side]);
        let space = Space::new(&nothing, Forest::new(&domain, 0.01, LEVELS), 1e-3);
        let cell = space.forest.cells[0];
        assert!(cell.level < space.forest.usual);
        let mut random = Random::new(5);
        let [mut hidden, mut seen] = [0; 2];
        for _ in 0..count(20_000) {
            let half = random.range(0.01, 0.15);
            let tolerance = half * half * random.range(0.1, 5.0);
            let mut center = random.direction() * 0.3 * half;
            center[random.below(3)] = 1.0 + half * (1.0 - half * random.range(-0.3, 1.2));
            let corners: [Vertex; 8] = core::array::from_fn(|i| {
                let way = [0, 1, 2].map(|k| if i >> k & 1 == 0 { -half } else { half });
                on_ball(center + DVec3::from(way))
            });
            let nearest = DVec3::ZERO.clamp(center - half, center + half);
            let depth = 1.0 - nearest.length();
            if depth < 0.0 || corners.iter().any(|corner| corner.value > 0.0) {
                continue;
            }
            let middle = on_ball(center);
            if look(
                &space,
                &cell,
                &middle,
                corners.each_ref(),
                (tolerance, space.forest.deepest),
                false,
            ) == Fate::Split
            {
                seen += 1;
            } else {
                assert!(
                    depth <= 1.05 * HIDDEN * tolerance,
                    "{depth} of {tolerance}, {half}"
                );
                hidden += 1;
            }
        }
        println!("{hidden} hidden, {seen} seen");
        assert!(hidden > count(100) && seen > count(100));
    }

    #[test]
    fn edges_join_corners_that_differ_along_one_axis() {
        let mut seen = Vec::new();
        for (n, [low, high]) in EDGES.into_iter().enumerate() {
            assert_eq!(low ^ high, 1 << (n / 4));
            assert!(low < high);
            seen.push([low, high]);
        }
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), 12);
    }

    /// A surface that crosses each edge once at most is a disc in a cell where walks along edges
    /// reach all corners on a side.
    #[test]
    fn simple_cells_have_one_piece_on_each_side() {
        fn reach(inside: &[bool; 8], from: usize) -> [bool; 8] {
            let mut seen = [false; 8];
            let mut open = vec![from];
            while let Some(i) = open.pop() {
                if !core::mem::replace(&mut seen[i], true) {
                    let beside = [1, 2, 4].map(|bit| i ^ bit);
                    open.extend(beside.into_iter().filter(|j| inside[*j] == inside[i]));
                }
            }
            seen
        }
        for bits in 1..255_u32 {
            let inside: [bool; 8] = core::array::from_fn(|i| bits >> i & 1 == 1);
            let own = reach(&inside, inside.iter().position(|is| *is).unwrap());
            let other = reach(&inside, inside.iter().position(|is| !*is).unwrap());
            let all = (0..8).all(|i| own[i] || other[i]);
            assert_eq!(is_simple(inside), all, "{bits:08b}");
        }
    }
}
