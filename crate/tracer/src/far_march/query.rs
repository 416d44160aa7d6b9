//! Queries for the rays of a packet, and the working space of one thread.
use crate::blob_march::{RayBlob, RayInterval};
use crate::layout::PACKET;
use crate::ray::Ray;
use crate::root_isolation::BoundedTerms;
use crate::surface_samples::SurfaceSamples;
use crate::walk::Quest;
use field::THRESHOLD;
use wide::f32x8;

/// Bound on the rounding of sums in single precision near T.
pub const ROUNDING: f64 = 4e-6 * THRESHOLD;

/// Working space of one thread.
#[derive(Default)]
pub struct FarWork {
    pub blobs: Vec<RayBlob>,
    pub intervals: Vec<RayInterval>,
    pub tops: Vec<f32x8>,
    /// Positions relative to the middle of the present piece, point by point of the cell's list.
    pub places: Vec<[f32; 3]>,
    /// Indices into the cell's list: of points that are blobs, and of those that are spans.
    pub strong: Vec<u32>,
    pub weak: Vec<u32>,
    /// Surface samples at the hits of the last packet.
    pub samples: SurfaceSamples,
    pub evaluations: u64,
    /// Rays searched again in double precision.
    pub doubts: u64,
}

/// A query for the rays of a packet.
#[derive(Clone, Copy)]
pub struct FarQuery<'r> {
    pub rays: &'r [Ray; PACKET],
    /// End of each ray.
    pub limits: &'r [f64; PACKET],
    /// The rays to follow, a bit each.
    pub alive: u32,
    pub quest: Quest,
    /// Width of a pixel at distance 1.
    pub pixel: f64,
    /// The scene's primitives with their bounds.
    pub sight: BoundedTerms<'r>,
    /// Length of rays below which nothing is resolved.
    pub resolution: f64,
}
