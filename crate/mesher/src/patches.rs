//! Polynomials of the fifth degree that stand for the function in boxes near the surface, where
//! edits of the mesh look at it hundreds of times: each costs at most as much as some forty
//! evaluations, and then a twentieth of one.
//!
//! A box is a cell with at most two generations of cells below it that the surface may cross: these
//! are as fine as the shape is there, so that nothing lies between samples. The polynomial is the
//! one with the least squares of errors of values and gradients at 27 points. Where it is off there
//! or at 14 others by more than a small share of the tolerance, the cell's children are tried;
//! where leaves fail, as at kinks, the function itself is evaluated. What is proved of a mesh is
//! proved of the function.

use crate::forest::{Forest, NONE, Side};
use crate::lattice::{Lattice, pack};
use crate::options::{MeshError, Progress};
use crate::parallel::map_by;
use crate::space::Space;
use field::{Jet, THRESHOLD};
use glam::DVec3;
use std::sync::LazyLock;

/// Degree of the polynomials.
const DEGREE: usize = 5;
/// Number of their coefficients.
const TERMS: usize = (DEGREE + 1) * (DEGREE + 2) * (DEGREE + 3) / 6;
/// Points where they are fitted.
const NODES: usize = 27;
/// Values and slopes there.
const DATA: usize = 4 * NODES;

/// Generations of cells in a box.
const GENERATIONS: u32 = 2;
/// Largest error of a value, in tolerances times the slope.
const VALUE: f64 = 0.03;
/// Largest error of a gradient, as a share of the largest.
const SLOPE: f64 = 0.04;
/// The same in leaves, of which there are no smaller ones to try.
const LAST_SLOPE: f64 = 0.15;

/// Boxes that are fitted between two reports.
const BATCH: usize = 64;

/// A polynomial, in a box.
#[derive(Clone, Debug)]
struct Patch {
    center: DVec3,
    half: DVec3,
    /// Coefficients of xⁱyʲzᵏ, i + j + k ≤ 5, where x, y and z run from −1 to 1 in the box: sorted
    /// by k, then j, then i.
    coefficients: [f64; TERMS],
}

/// A place in a box, and the function there.
type Sample = (DVec3, Jet<f64>);

/// Polynomials of boxes that do not overlap.
#[derive(Debug, Default)]
pub struct Patches {
    patches: Vec<Patch>,
    /// For each cell of the forest the patch that serves in it, or [`NONE`].
    of_cell: Vec<u32>,
}

impl Patches {
    /// Value and gradient by the polynomial that serves in a leaf, if there is one and the point is
    /// in its box.
    pub fn jet(&self, leaf: u32, point: DVec3) -> Option<Jet<f64>> {
        let patch = *self.of_cell.get(leaf as usize)?;
        let patch = self.patches.get(patch as usize)?;
        let place = (point - patch.center) / patch.half;
        // A little more, as numbers are rounded.
        let is_in = place.abs().max_element() <= 1.0 + 1e-9;
        is_in.then(|| patch.jet(place))
    }

    /// Fits polynomials to a function, wherever the surface may be, when the values at the vertices
    /// of the lattice are known.
    ///
    /// # Errors
    /// If the caller cancels.
    pub fn fit(
        space: &Space<'_>,
        lattice: &Lattice,
        tolerance: f64,
        threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Self, MeshError> {
        let forest = &space.forest;
        let heights = heights(forest);
        let mut own = vec![NONE; forest.cells.len()];
        let mut patches = Vec::new();
        let is_low = |i: u32| heights[i as usize].is_some_and(|height| height <= GENERATIONS);
        let children = |i: u32| {
            let child = forest.cells[i as usize].child;
            (0..8)
                .filter(move |_| child != NONE)
                .map(move |k| child + k)
        };
        // The largest boxes first.
        let mut open: Vec<u32> = Vec::new();
        let roots =
            (0..forest.cells.len() as u32).take_while(|i| forest.cells[*i as usize].level == 0);
        let mut high: Vec<u32> = roots.collect();
        while let Some(i) = high.pop() {
            if is_low(i) {
                open.push(i);
            } else {
                high.extend(children(i).filter(|i| heights[*i as usize].is_some()));
            }
        }
        open.sort_unstable();
        while !open.is_empty() {
            let fits = map_by(BATCH, threads, &open, progress, |i| {
                Patch::fit(space, lattice, *i, tolerance)
            })?;
            let mut next = Vec::new();
            for (i, fit) in open.into_iter().zip(fits) {
                if let Some(patch) = fit {
                    own[i as usize] = patches.len() as u32;
                    patches.push(patch);
                } else {
                    next.extend(children(i).filter(|i| heights[*i as usize].is_some()));
                }
            }
            open = next;
        }
        // Parents come before children.
        for i in 0..forest.cells.len() as u32 {
            for child in children(i) {
                if own[i as usize] != NONE {
                    own[child as usize] = own[i as usize];
                }
            }
        }
        Ok(Self {
            patches,
            of_cell: own,
        })
    }
}

/// The largest number of generations below a cell down to leaves that the surface may cross; `None`
/// if there is no such leaf.
fn heights(forest: &Forest) -> Vec<Option<u32>> {
    let mut heights = vec![None; forest.cells.len()];
    // Children come after their parents.
    for (i, cell) in forest.cells.iter().enumerate().rev() {
        heights[i] = if cell.child == NONE {
            (cell.side == Side::Crossing).then_some(0)
        } else {
            let first = cell.child as usize;
            let below = heights[first..first + 8].iter().copied().flatten().max();
            below.map(|height: u32| height + 1)
        };
    }
    heights
}

impl Patch {
    /// Fits a polynomial to the function in a cell; `None` if it is not near it.
    fn fit(space: &Space<'_>, lattice: &Lattice, cell: u32, tolerance: f64) -> Option<Self> {
        let cell = &space.forest.cells[cell as usize];
        let half = 0.5 * space.forest.size(cell.level);
        let center = space.forest.center(cell);
        let middle = space.forest.center_key(cell);
        let unit = f64::from(space.forest.span(cell.level) / 2);
        let exact = |place: DVec3| {
            // Most of these places are vertices of the lattice, where the function is known.
            let offset = place * unit;
            let known = (offset == offset.floor()).then(|| {
                let key = [0, 1, 2].map(|i| (f64::from(middle[i]) + offset[i]) as u32);
                lattice.jet(pack(key))
            });
            let jet = known.flatten();
            let jet = jet.unwrap_or_else(|| space.jet(cell.part, center + place * half));
            (place, jet)
        };
        let samples = nodes().map(exact);
        let data = values_and_slopes(samples.iter().map(|(_, jet)| *jet), half);
        let coefficients = FIT
            .each_ref()
            .map(|row| row.iter().zip(&data).map(|(a, b)| a * b).sum());
        let patch = Self {
            center,
            half,
            coefficients,
        };
        // Most that are off are so at the nodes already.
        let slope = if cell.child == NONE {
            LAST_SLOPE
        } else {
            SLOPE
        };
        let is_near = |samples: &[Sample]| patch.is_near(samples, VALUE * tolerance, slope);
        (is_near(&samples) && is_near(&others().map(exact))).then_some(patch)
    }

    /// Whether the polynomial is near the function at some places: as near as a distance tells and,
    /// of the slope, a share.
    fn is_near(&self, samples: &[Sample], distance: f64, share: f64) -> bool {
        let steepness = |jet: &Jet<f64>| DVec3::from_array(jet.gradient).length();
        // Where the surface may be, if it may be anywhere.
        let radius = self.half.length();
        let is_beside =
            |steep: f64, jet: &Jet<f64>| (jet.value - THRESHOLD).abs() <= radius * steep;
        let (mut beside, mut most) = (f64::INFINITY, 0.0_f64);
        for (_, jet) in samples {
            let steep = steepness(jet);
            most = most.max(steep);
            if is_beside(steep, jet) {
                beside = beside.min(steep);
            }
        }
        let steep = beside.min(most);
        samples.iter().all(|(place, jet)| {
            let own = self.jet(*place);
            let slope = DVec3::from_array(own.gradient) - DVec3::from_array(jet.gradient);
            // Not so for NaN.
            (own.value - jet.value).abs() <= distance * steep && slope.length() <= share * most
        })
    }

    /// Value and gradient at a place in the box, from −1 to 1 along each axis.
    fn jet(&self, place: DVec3) -> Jet<f64> {
        // Horner's scheme in x for each pair of powers of y and z, in y for each power of z, and in
        // z.
        let DVec3 { x, y, z } = place;
        let mut end = TERMS;
        let [mut value, mut by_x, mut by_y, mut by_z] = [0.0; 4];
        for k in (0..=DEGREE).rev() {
            let [mut v, mut vx, mut vy] = [0.0; 3];
            for j in (0..=DEGREE - k).rev() {
                let count = DEGREE + 1 - k - j;
                let row = &self.coefficients[end - count..end];
                end -= count;
                let [mut p, mut px] = [0.0; 2];
                for c in row.iter().rev() {
                    px = px * x + p;
                    p = p * x + c;
                }
                vy = vy * y + v;
                vx = vx * y + px;
                v = v * y + p;
            }
            by_z = by_z * z + value;
            by_y = by_y * z + vy;
            by_x = by_x * z + vx;
            value = value * z + v;
        }
        let gradient = DVec3::new(by_x, by_y, by_z) / self.half;
        Jet {
            value,
            gradient: gradient.to_array(),
        }
    }
}

/// Values at the nodes, each with its slopes along the axes in halves of the box.
fn values_and_slopes(jets: impl Iterator<Item = Jet<f64>>, half: DVec3) -> [f64; DATA] {
    let mut data = [0.0; DATA];
    for (four, jet) in data.chunks_exact_mut(4).zip(jets) {
        let slope = DVec3::from_array(jet.gradient) * half;
        four.copy_from_slice(&[jet.value, slope.x, slope.y, slope.z]);
    }
    data
}

/// The points where polynomials are fitted.
fn nodes() -> [DVec3; NODES] {
    core::array::from_fn(|i| {
        let at = |i: usize| i as f64 - 1.0;
        DVec3::new(at(i % 3), at(i / 3 % 3), at(i / 9))
    })
}

/// Other points where they are tested: halfway from the middle to corners and to faces.
fn others() -> [DVec3; 14] {
    core::array::from_fn(|i| {
        let sign = |bit: usize| if i & bit == 0 { -0.5 } else { 0.5 };
        match i {
            0..8 => DVec3::new(sign(1), sign(2), sign(4)),
            _ => DVec3::from_array(core::array::from_fn(|axis| {
                if axis == (i - 8) / 2 { sign(1) } else { 0.0 }
            })),
        }
    })
}

/// Each coefficient as a linear function of the data: (AᵀA)⁻¹Aᵀ, where A has the values and slopes
/// of the terms at the nodes.
static FIT: LazyLock<[[f64; DATA]; TERMS]> = LazyLock::new(|| {
    let term = |i: usize| {
        let mut patch = Patch {
            center: DVec3::ZERO,
            half: DVec3::ONE,
            coefficients: [0.0; TERMS],
        };
        patch.coefficients[i] = 1.0;
        values_and_slopes(
            nodes().into_iter().map(|place| patch.jet(place)),
            patch.half,
        )
    };
    let mut right: [[f64; DATA]; TERMS] = core::array::from_fn(term);
    let product =
        |a: &[f64; DATA], b: &[f64; DATA]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let mut square: [[f64; TERMS]; TERMS] =
        core::array::from_fn(|i| core::array::from_fn(|j| product(&right[i], &right[j])));
    // Gauss and Jordan's elimination; the matrix is positive definite.
    for i in 0..TERMS {
        let pivot = 1.0 / square[i][i];
        square[i].iter_mut().for_each(|x| *x *= pivot);
        right[i].iter_mut().for_each(|x| *x *= pivot);
        let (row, own) = (square[i], right[i]);
        for j in (0..TERMS).filter(|j| *j != i) {
            let factor = square[j][i];
            square[j]
                .iter_mut()
                .zip(row)
                .for_each(|(x, y)| *x -= factor * y);
            right[j]
                .iter_mut()
                .zip(own)
                .for_each(|(x, y)| *x -= factor * y);
        }
    }
    right
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::refine::Refinement;
    use crate::surface::box_of;
    use core::ops::ControlFlow;
    use field::{BlobScale, Implicit, Kernel, Primitive, Shaping, Skeleton, Sum};
    use trials::{Random, count};

    #[test]
    fn polynomials_of_the_fifth_degree_are_found_again() {
        let mut random = Random::new(3);
        for _ in 0..count(20) {
            let patch = Patch {
                center: DVec3::ZERO,
                half: DVec3::ONE,
                coefficients: core::array::from_fn(|_| random.range(-1.0, 1.0)),
            };
            let jets = nodes().into_iter().map(|place| patch.jet(place));
            let data = values_and_slopes(jets, patch.half);
            for (row, own) in FIT.iter().zip(patch.coefficients) {
                let found: f64 = row.iter().zip(&data).map(|(a, b)| a * b).sum();
                assert!((found - own).abs() < 1e-9, "{found} {own}");
            }
        }
    }

    #[test]
    fn value_and_gradient_are_those_of_the_terms() {
        let mut random = Random::new(4);
        for _ in 0..count(50) {
            let patch = Patch {
                center: DVec3::ZERO,
                half: 1.5 + random.vector(1.0),
                coefficients: core::array::from_fn(|_| random.range(-1.0, 1.0)),
            };
            let at = |place: DVec3| {
                let mut all = 0.0;
                let mut next = patch.coefficients.iter();
                for k in 0..=DEGREE as i32 {
                    for j in 0..=DEGREE as i32 - k {
                        for i in 0..=DEGREE as i32 - k - j {
                            let powers = place.x.powi(i) * place.y.powi(j) * place.z.powi(k);
                            all += next.next().unwrap() * powers;
                        }
                    }
                }
                assert!(next.next().is_none());
                all
            };
            let place = random.vector(1.0);
            let jet = patch.jet(place);
            assert!((jet.value - at(place)).abs() < 1e-12);
            for (axis, slope) in DVec3::AXES.into_iter().zip(jet.gradient) {
                let step = 1e-5;
                let way = axis * step / patch.half;
                let difference = (at(place + way) - at(place - way)) / (2.0 * step);
                assert!((slope - difference).abs() < 1e-7 * (1.0 + slope.abs()));
            }
        }
    }

    #[test]
    fn polynomials_are_near_the_function_where_the_surface_is() {
        let mut random = Random::new(6);
        let kernels = [Kernel::Gauss, Kernel::Cauchy, Kernel::Quartic];
        let (mut served, mut all) = (0, 0);
        for trial in 0..count(12) {
            let shaping = Shaping {
                kernel: kernels[trial % 3],
                radius: random.range(0.2, 0.4),
                blobbiness: 2.0,
                blob_scale: BlobScale::Relative,
                strength: 1.0,
                influence: 1e-3,
                taper: None,
            };
            let limbs = [(); 3].map(|()| Skeleton::Segment {
                base: random.vector(1.0),
                apex: random.vector(1.0),
            });
            let limbs = limbs.into_iter();
            let sum: Sum = limbs
                .filter_map(|limb| Primitive::new(limb, &shaping, None))
                .collect();
            let domain = box_of(sum.support().unwrap());
            let size = (domain.max - domain.min).max_element();
            let tolerance = 2e-3 * size;
            let mut space = Space::new(&sum, Forest::new(&domain, 2.0 * tolerance, 0), 2e-3);
            let mut report = |_| ControlFlow::Continue(());
            let mut progress = Progress::new(&mut report);
            let tolerances = [16.0 * tolerance, tolerance];
            let mut cells = Refinement::new(&mut space, tolerances, 1_000_000, 1);
            cells.settle(&mut progress).unwrap();
            let lattice = cells.lattice;
            space.fit(&lattice, tolerance, 1, &mut progress).unwrap();
            let leaves = crate::refine::crossing(&space.forest);
            for leaf in leaves.into_iter().step_by(7) {
                let cell = space.forest.cells[leaf as usize];
                let half = 0.5 * space.forest.size(cell.level);
                let point = space.forest.center(&cell) + random.vector(1.0) * half;
                all += 1;
                let before = space.evaluations();
                let near = space.near_jet_at(point);
                if space.evaluations() > before {
                    assert_eq!(near, space.jet_at(point), "no polynomial, so the function");
                    continue;
                }
                served += 1;
                let jet = space.jet_at(point);
                let [slope, own] = [jet, near].map(|jet| DVec3::from_array(jet.gradient));
                // Far from the surface a cell's slope is not that of the surface.
                if (jet.value - THRESHOLD).abs() > half.length() * slope.length() {
                    continue;
                }
                let off = (jet.value - near.value).abs() / slope.length();
                assert!(off < 4.0 * VALUE * tolerance, "{off} {tolerance} {cell:?}");
                let turned = slope.distance(own) / slope.length();
                assert!(turned < 4.0 * LAST_SLOPE, "{turned} {cell:?}");
            }
        }
        assert!(
            20 * served > 17 * all && all > count(1000),
            "{served} of {all}"
        );
    }
}
