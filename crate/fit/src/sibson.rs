//! Sibson's natural-neighbour coordinates in space.
//!
//! The coordinate uₖ of a point v is the part of v's Voronoi cell that would be control point k's
//! were v not there. The cell is cut out of a cube by the planes halfway to the controls, nearest
//! first; of it, the part nearer to k than to the other neighbours is cut in the same way. That
//! needs no triangulation, and equal distances are no special case.

use crate::cage::by_distance;
use crate::cell::{Cell, Scratch};
use crate::error::{Error, fail};
use glam::DVec3;
use mesh::Aabb;

/// Most control points.
pub const MAX_CONTROLS: usize = 4096;
/// The far corners are at this multiple of the box's half size.
const FAR: f64 = 4.0;
/// The smallest half size along an axis, of the largest: flat meshes have a box with a volume, too.
const FLAT: f64 = 0.25;
/// Half the cube that holds the cell of any point, of the largest half size of the box. With
/// corners at ±H from the middle a point x of the cell of v has `|xᵢ − vᵢ| ≤ 1.04·|H|²/Hᵢ`, which
/// is 50 at most.
const CUBE: f64 = 64.0;
/// Distance within which a point is on a control, of the box's size.
const EQUAL: f64 = 1e-12;
/// Least distance of two controls, of the box's size.
const APART: f64 = 1e-9;
/// Face of less area, of the square of its cell's radius, counts as none.
const NO_AREA: f64 = 1e-13;
/// Controls that are looked at together.
const BATCH: usize = 32;

/// Control points in and around a box, with eight far corners that are always added: points of the
/// box so have coordinates wherever the controls lie.
///
/// ```
/// use fit::Sibson;
/// use glam::DVec3;
/// use mesh::Aabb;
///
/// let bounds = Aabb::of_points([-DVec3::ONE, DVec3::ONE]);
/// let sibson = Sibson::new(&[DVec3::X, -DVec3::X, DVec3::Y], &bounds)?;
/// let point = DVec3::new(0.2, 0.1, 0.0);
/// let row = sibson.coordinates(point).expect("it lies in the box");
/// let sum: f64 = row.iter().map(|(_, weight)| weight).sum();
/// let mean: DVec3 = row.iter().map(|(k, weight)| sibson.sites()[*k as usize] * *weight).sum();
/// assert!((sum - 1.0).abs() < 1e-12 && mean.distance(point) < 1e-12);
/// # Ok::<(), fit::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sibson {
    /// The controls, then the far corners.
    sites: Vec<DVec3>,
    controls: usize,
    bounds: Aabb,
    /// The largest half size of the box.
    size: f64,
}

/// Memory for [`Sibson::row`].
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    near: Vec<(f64, u32)>,
    cell: Cell,
    part: Cell,
    scratch: Scratch,
    neighbors: Vec<u32>,
    others: Vec<(f64, u32)>,
}

impl Sibson {
    /// Prepares control points for points of a box.
    ///
    /// # Errors
    /// If there are none or too many, two are in one place, one is no finite point, or the box is
    /// empty or infinite.
    pub fn new(controls: &[DVec3], bounds: &Aabb) -> Result<Self, Error> {
        if controls.is_empty() {
            return fail("there are no control points");
        }
        if controls.len() > MAX_CONTROLS {
            return fail(format!(
                "there are {} control points, more than the {MAX_CONTROLS} that are taken",
                controls.len()
            ));
        }
        if let Some(bad) = controls.iter().position(|c| !c.is_finite()) {
            return fail(format!("control point {} is no finite point", bad + 1));
        }
        let half = 0.5 * bounds.size();
        let size = half.max_element();
        if bounds.is_empty() || !size.is_finite() {
            return fail("what is to be deformed has no finite points");
        }
        let size = if size > 0.0 { size } else { 1.0 };
        let half = half.max(DVec3::splat(FLAT * size));
        let center = bounds.center();
        let mut sites = controls.to_vec();
        for i in 0..8 {
            let sides = [1, 2, 4].map(|bit| if i & bit == 0 { -FAR } else { FAR });
            let corner = center + half * DVec3::from_array(sides);
            // A control that stands there takes its place.
            if controls.iter().all(|c| c.distance(corner) > APART * size) {
                sites.push(corner);
            }
        }
        let sibson = Self {
            sites,
            controls: controls.len(),
            bounds: *bounds,
            size,
        };
        match sibson.coincident() {
            Some([i, j]) => fail(format!(
                "control points {} and {} are in one place",
                i + 1,
                j + 1
            )),
            None => Ok(sibson),
        }
    }

    /// Returns the first two controls that are in one place.
    fn coincident(&self) -> Option<[usize; 2]> {
        let apart = APART * self.size;
        let controls = &self.sites[..self.controls];
        let mut order: Vec<usize> = (0..controls.len()).collect();
        order.sort_by(|i, j| controls[*i].x.total_cmp(&controls[*j].x));
        for (place, i) in order.iter().enumerate() {
            let after = order[place + 1..].iter();
            for j in after.take_while(|j| controls[**j].x - controls[*i].x <= apart) {
                if controls[*i].distance(controls[*j]) <= apart {
                    return Some([*i.min(j), *i.max(j)]);
                }
            }
        }
        None
    }

    /// The control points, then the far corners.
    #[must_use]
    pub fn sites(&self) -> &[DVec3] {
        &self.sites
    }

    /// Number of control points.
    #[must_use]
    pub fn controls(&self) -> usize {
        self.controls
    }

    /// Returns the coordinates of a point that are not 0, as pairs of a number in [`Sibson::sites`]
    /// and a weight > 0, by number. The weights' sum is 1, and the weighted mean of the sites is
    /// the point. `None` if the point is outside the box.
    #[must_use]
    pub fn coordinates(&self, point: DVec3) -> Option<Vec<(u32, f64)>> {
        let mut row = Vec::new();
        self.row(point, &mut Workspace::default(), &mut row)
            .then_some(row)
    }

    /// Sets the coordinates of a point. Returns false if it is outside the box.
    pub(crate) fn row(
        &self,
        point: DVec3,
        work: &mut Workspace,
        row: &mut Vec<(u32, f64)>,
    ) -> bool {
        row.clear();
        let slack = 1e-9 * self.size;
        let outside = self.bounds.distance_squared(point) > slack * slack;
        if outside || !point.is_finite() {
            return false;
        }
        if let Some(k) = self.cut_cell(point, work) {
            row.push((k, 1.0));
            return true;
        }
        self.steal(point, work, row);
        row.sort_unstable_by_key(|(k, _)| *k);
        true
    }

    /// Cuts out the point's cell, relative to the point. Returns a site if the point is on it.
    fn cut_cell(&self, point: DVec3, work: &mut Workspace) -> Option<u32> {
        let Workspace {
            near,
            cell,
            scratch,
            ..
        } = work;
        near.clear();
        near.extend(
            (0..)
                .zip(&self.sites)
                .map(|(k, site)| (site.distance_squared(point), k)),
        );
        let outside = u32::MAX;
        cell.set_cube(CUBE * self.size, outside);
        let (mut sorted, mut used) = (0, 0);
        while used < near.len() {
            if used == sorted {
                sorted = (2 * sorted).max(BATCH).min(near.len());
                if sorted < near.len() {
                    near[used..].select_nth_unstable_by(sorted - used, by_distance);
                }
                near[used..sorted].sort_unstable_by(by_distance);
            }
            let (square, k) = near[used];
            if used == 0 && square <= (EQUAL * self.size).powi(2) {
                return Some(k);
            }
            // Only planes nearer than the farthest vertex cut.
            if square.sqrt() > 2.0 * cell.radius() {
                break;
            }
            let way = self.sites[k as usize] - point;
            cell.cut(way, 0.5 * square, k, scratch);
            used += 1;
        }
        // Again from a cube of the cell's size: the first vertices have roundings of the large
        // cube's size.
        let radius = cell.radius();
        cell.set_cube(radius * (1.0 + 1e-9), outside);
        for (square, k) in &near[..used] {
            let way = self.sites[*k as usize] - point;
            cell.cut(way, 0.5 * square, *k, scratch);
        }
        None
    }

    /// Appends the parts of the cell that were each neighbour's.
    fn steal(&self, point: DVec3, work: &mut Workspace, row: &mut Vec<(u32, f64)>) {
        let Workspace {
            cell,
            part,
            scratch,
            neighbors,
            others,
            ..
        } = work;
        neighbors.clear();
        // A control that touches the cell in a point or an edge has no part of it. In a grid of
        // controls most do.
        let least = NO_AREA * cell.radius().powi(2);
        neighbors.extend(cell.labels(least).filter(|k| *k != u32::MAX));
        let mut total = 0.0;
        for k in neighbors.iter() {
            let own = self.sites[*k as usize] - point;
            others.clear();
            others.extend(neighbors.iter().filter(|j| *j != k).map(|j| {
                let other = self.sites[*j as usize] - point;
                (other.distance_squared(own), *j)
            }));
            others.sort_unstable_by(by_distance);
            part.copy(cell);
            for (_, j) in others.iter() {
                let other = self.sites[*j as usize] - point;
                let way = other - own;
                part.cut(way, 0.5 * way.dot(other + own), *j, scratch);
                if part.vertices.is_empty() {
                    break;
                }
            }
            let volume = part.volume();
            if volume > 0.0 {
                total += volume;
                row.push((*k, volume));
            }
        }
        for (_, weight) in row {
            *weight /= total;
        }
    }
}
