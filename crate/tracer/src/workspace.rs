//! Working space of one thread.
use crate::hard::Crossing;
use crate::layout::PACKET;
use crate::nearby::Nearby;
use crate::ray::Ray;
use crate::sample::Sample;
use crate::scratch::Scratch;

/// Working space of one thread.
#[derive(Default)]
pub struct Workspace {
    pub(crate) scratch: Scratch,
    pub(crate) crossings: Vec<Crossing>,
    /// Blobs near the rays of a patch to a light.
    pub(crate) around: Nearby,
    /// Rays to a light.
    pub(crate) shadows: Vec<Shadow>,
    pub(crate) samples: Vec<[Sample; PACKET]>,
    /// Bodies that take the general way.
    pub(crate) general: Vec<(f64, u32)>,
}

impl Workspace {
    /// Starts the counts of a packet's evaluations at 0.
    pub(crate) fn begin(&mut self) {
        self.scratch.evaluations = 0;
        self.scratch.alone = [0; PACKET];
    }

    /// Returns the cost of each of the packet's first rays: the ray itself, its share of the
    /// evaluations made for all, and those made for it alone (see [`map`](crate::map)).
    pub(crate) fn costs(&self, rays: usize) -> [f32; PACKET] {
        let Scratch {
            evaluations, alone, ..
        } = &self.scratch;
        let shared = evaluations - alone.iter().sum::<u64>();
        alone.map(|own| (1 + own) as f32 + shared as f32 / rays as f32)
    }
}

/// A ray from a surface point to a light.
pub(crate) struct Shadow {
    /// Packet and lane of the surface point.
    pub hit: (usize, usize),
    pub ray: Ray,
    /// Distance of the light.
    pub limit: f64,
    /// Distance of the surface point from the eye.
    pub depth: f64,
    pub state: State,
    /// Cost of the decision whether the ray is dark.
    pub cost: f32,
}

/// State of a ray to a light.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum State {
    Unknown,
    /// Member of the patch that is being decided.
    Asked,
    Lit,
    Dark,
}
