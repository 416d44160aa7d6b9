//! A packet's way through a part of a cell.
use crate::beam::Beam;
use crate::blob_march::Backdrop;
use crate::layout::PACKET;
use crate::ray::Ray;
use crate::spans::Node;
use field::far_field::{Cell, DEGREE};
use field::{Cut, Real};
use glam::DVec3;
use wide::f32x8;

/// A part of a packet's way, within one cell.
#[derive(Clone, Copy)]
pub struct Piece<'a> {
    pub cell: &'a Cell,
    beam: &'a Beam,
    /// Middle of the beam's axis there, and the parameter.
    pub middle: DVec3,
    pub t: f64,
    pub half: f64,
    /// Width of the beam.
    pub width: f64,
    /// Direction of the beam's axis.
    pub axis: [f32x8; 3],
    /// Rays relative to the middle.
    pub origin: [f32x8; 3],
    pub direction: [f32x8; 3],
}

/// The backdrop of a piece, the sum of all that is not among its blobs, with its error.
#[derive(Clone, Copy)]
pub struct Known {
    pub backdrop: Backdrop,
    pub error: f64,
}

impl<'a> Piece<'a> {
    /// Returns the part of the rays' way between two parameters.
    pub fn new(cell: &'a Cell, beam: &'a Beam, rays: &[Ray; PACKET], [from, to]: [f64; 2]) -> Self {
        let t = 0.5 * (from + to);
        let middle = beam.axis.at(t);
        let at = rays.map(|ray| ray.at(t) - middle);
        Self {
            cell,
            beam,
            middle,
            t,
            half: 0.5 * (to - from),
            width: beam.extent(to),
            axis: beam.axis.direction.as_vec3().to_array().map(f32x8::splat),
            origin: core::array::from_fn(|k| f32x8::from_lanes(|i| at[i][k])),
            direction: core::array::from_fn(|k| f32x8::from_lanes(|i| rays[i].direction[k])),
        }
    }

    /// Returns the point of the beam's axis at a parameter.
    pub fn axis_at(&self, t: f64) -> DVec3 {
        self.beam.axis.at(t)
    }

    /// Returns the rays' places, relative to the middle, at parameters relative to the middle's.
    #[inline(always)]
    pub fn places(&self, t: f32x8) -> [f32x8; 3] {
        core::array::from_fn(|i| self.origin[i] + self.direction[i] * t)
    }

    /// Converts places relative to the middle to the world's coordinates.
    #[inline(always)]
    pub fn world(&self, place: [f32x8; 3]) -> [f32x8; 3] {
        let middle = self.middle.as_vec3().to_array();
        core::array::from_fn(|i| f32x8::splat(middle[i]) + place[i])
    }

    /// Converts places relative to the middle to the coordinates of a cell's expansion.
    pub fn local(&self, cell: &Cell, place: [f32x8; 3]) -> [f32x8; 3] {
        let scale = 1.0 / cell.reach();
        let shift = ((self.middle - cell.center) * scale).as_vec3().to_array();
        let scale = f32x8::splat(scale as f32);
        core::array::from_fn(|i| f32x8::splat(shift[i]) + place[i] * scale)
    }

    /// Returns the cell's polynomial along the rays.
    pub fn far(&self) -> Backdrop {
        let scale = f32x8::splat((self.half / self.cell.reach()) as f32);
        const { assert!(DEGREE == 5) };
        Backdrop {
            coefficients: self.cell.expansion.along(
                self.local(self.cell, self.origin),
                self.direction.map(|x| x * scale),
                f32x8::splat,
            ),
            half: self.half as f32,
        }
    }

    /// Adds the Hermite cubic with values and slopes at the piece's two ends.
    pub fn add_span(&self, backdrop: &mut Backdrop, [left, right]: [Node<f32x8>; 2]) {
        // On −1 ≤ x ≤ 1, slopes by x.
        let half = f32x8::splat(self.half as f32);
        let (a, b, da, db) = (
            left.value,
            right.value,
            left.slope * half,
            right.slope * half,
        );
        let quarter = f32x8::splat(0.25);
        let cubic = [
            quarter * (a + a + b + b + da - db),
            quarter * (f32x8::splat(3.0) * (b - a) - da - db),
            quarter * (db - da),
            quarter * (a - b + da + db),
        ];
        for (own, more) in backdrop.coefficients.iter_mut().zip(cubic) {
            *own += more;
        }
    }
}

/// Returns the parameter, beyond t, at which a ray leaves a cell that it is in at t.
pub fn leaves(axis: &Ray, t: f64, cell: &Cell) -> f64 {
    let mut end = f64::INFINITY;
    for i in 0..3 {
        let pace = axis.direction[i];
        let wall = cell.center[i] + if pace < 0.0 { -cell.half } else { cell.half };
        let there = (wall - axis.origin[i]) / pace;
        // Never for a ray along the wall.
        if there < end {
            end = there;
        }
    }
    // Rounding may leave the start a little outside.
    end.at_least(t + 1e-6 * cell.half)
        .at_most(t + 3.5 * cell.half)
}
