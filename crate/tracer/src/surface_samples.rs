//! Data of the surface samples at a packet's hits;
//! [`refine_hits`](crate::refine_hits) and [`quick`](crate::quick) fill them.
use crate::layout::PACKET;
use crate::slabs::Slabs;
use glam::DVec3;
use wide::f32x8;

/// Half the least tolerance of pictures ([`Picture::tolerance`](crate::Picture::tolerance)), in
/// units of the scene.
pub const FINEST: f64 = 1e-6;
/// Half the largest tolerance of pictures, or less, for blobs.
pub const COARSEST_OF_BLOBS: f64 = 5e-5;
/// Difference of the field from T within which normal and colours are those of the surface: they
/// change by about 0.1 % on the way there, less than a picture shows.
pub const NEAR_ENOUGH: f32 = 1e-3;

/// Samples of the surface at the hits of a packet.
#[derive(Default)]
pub struct SurfaceSamples {
    /// Ray parameter of each hit, refined.
    pub t: [f64; PACKET],
    /// Gradient of the field.
    pub gradient: [f32x8; 3],
    /// Finishes, with each one's share of the (positive) field in every lane.
    pub weights: Vec<(u32, f32x8)>,
}

impl SurfaceSamples {
    /// Returns the gradients of the field, hit by hit.
    pub fn gradients(&self) -> [DVec3; PACKET] {
        let gradient = self.gradient.map(f32x8::to_array);
        core::array::from_fn(|i| DVec3::from_array([0, 1, 2].map(|k| f64::from(gradient[k][i]))))
    }
}

/// Primitives that are evaluated at a packet's hits.
#[derive(Default)]
pub(crate) struct ActivePrimitives {
    /// Primitive and lanes, a bit each.
    pub list: Vec<(u32, u32)>,
    /// Packets in which the primitives were last listed, and their indices there.
    stamps: Vec<(u32, u32)>,
    stamp: u32,
}

impl ActivePrimitives {
    /// Lists the primitives that count in some slabs, each for its lanes; with `shared` also those
    /// that interpolants stand for.
    pub fn collect(
        &mut self,
        slabs: &Slabs<'_>,
        places: &[(u32, u32)],
        shared: bool,
        count: usize,
    ) {
        self.stamps.resize(count, (0, 0));
        self.stamp = self.stamp.wrapping_add(1);
        if self.stamp == 0 {
            self.stamps.fill((0, 0));
            self.stamp = 1;
        }
        self.list.clear();
        for &(slab, lanes) in places {
            slabs.each(slab, shared, |p| {
                let (stamp, at) = &mut self.stamps[p as usize];
                if *stamp == self.stamp {
                    self.list[*at as usize].1 |= lanes;
                } else {
                    (*stamp, *at) = (self.stamp, self.list.len() as u32);
                    self.list.push((p, lanes));
                }
            });
        }
        self.list.sort_unstable();
    }
}
