//! Working space of one thread for following packets of rays.
use crate::far_march::FarWork;
use crate::layout::PACKET;
use crate::quick::Quick;
use crate::slabs::Space;
use crate::surface_samples::{ActivePrimitives, SurfaceSamples};
use crate::walk::Memories;
use wide::f32x8;

/// Working space that is kept between packets.
#[derive(Default)]
pub struct Scratch {
    pub(crate) memory: Memories<f32x8>,
    /// Allocations of slabs that are no longer needed.
    pub(crate) spaces: Vec<Space>,
    pub(crate) active: ActivePrimitives,
    pub(crate) samples: SurfaceSamples,
    pub(crate) quick: Quick,
    pub(crate) far: FarWork,
    /// Evaluations of one primitive's field at one point, so far.
    pub evaluations: u64,
    /// Evaluations that were made for a single ray.
    pub alone: [u64; PACKET],
}
