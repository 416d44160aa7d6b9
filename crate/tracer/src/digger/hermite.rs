//! The certified digger, for whole packets: the quick way for blobs, else slabs of Hermite spans with a bounded error.
//!
//! Pictures do not call it here: there the packets of a square share lists, or the slabs of one beam. Here
//! each packet has its own, with the same result within the same tolerance.
use super::{Crossings, Digger, Packet};
use crate::beam::Beam;
use crate::beams::Beams;
use crate::layout::PACKET;
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::soft::Soft;
use crate::walk::{Bundle, Quest};

pub(crate) struct Hermite;

impl Digger for Hermite {
    fn dig(
        &self,
        soft: &Soft,
        body: u32,
        packet: &Packet<'_>,
        quest: Quest,
        scratch: &mut Scratch,
    ) -> Crossings {
        if let Some((looked, base)) = soft.quick_alone(
            body,
            packet.rays,
            packet.limits,
            packet.alive,
            quest,
            &mut scratch.quick,
        ) {
            scratch.evaluations += looked.evaluations;
            let t = scratch.quick.flesh.t;
            return core::array::from_fn(|i| {
                // A query for an entry gets no parameter.
                let t = if quest == Quest::Entry { 0.0 } else { t[i] };
                (looked.met >> i & 1 != 0).then_some(base + t)
            });
        }
        let (rays, limits) = (packet.rays, packet.limits);
        let far = &mut scratch.far;
        let met = soft.far_first(body, rays, limits, packet.alive, quest, far);
        scratch.evaluations += core::mem::take(&mut far.evaluations);
        if let Some(met) = met {
            let t = scratch.far.flesh.t;
            return core::array::from_fn(|i| {
                let t = if quest == Quest::Entry { 0.0 } else { t[i] };
                (met >> i & 1 != 0).then_some(t)
            });
        }
        let alive = |lane: &usize| packet.alive >> lane & 1 != 0;
        let rays: Vec<Ray> = (0..PACKET).filter(alive).map(|i| packet.rays[i]).collect();
        let furthest = (0..PACKET).filter(alive).map(|i| packet.limits[i]);
        let furthest = furthest.fold(0.0, f64::max);
        let slabs = Beam::around(&rays).and_then(|beam| {
            let whole = |base: f64| Beams::one(beam.from(base));
            soft.slabs(body, beam, whole, furthest, &mut scratch.spaces)
        });
        let mut crossings = [None; PACKET];
        let Some((mut slabs, base)) = slabs else {
            return crossings;
        };
        // Lanes not in use repeat the first ray.
        let based: [Ray; PACKET] = core::array::from_fn(|i| {
            let ray = if alive(&i) { &packet.rays[i] } else { &rays[0] };
            Ray {
                origin: ray.at(base),
                direction: ray.direction,
            }
        });
        let limits = packet.limits.map(|limit| limit - base);
        let bundle = Bundle {
            rays: &based,
            limits: &limits,
            alive: packet.alive,
            number: 0,
        };
        let found = soft.walk(body, &mut slabs, bundle, quest, scratch);
        if found.is_empty() {
            return crossings;
        }
        match quest {
            // Refined on the surface, as in pictures.
            Quest::First => {
                soft.flesh(&slabs, &based, base, &found, scratch);
                for hit in &found {
                    crossings[hit.lane] = Some(base + scratch.flesh.t[hit.lane]);
                }
            }
            _ => {
                for hit in &found {
                    crossings[hit.lane] = Some(base + hit.t);
                }
            }
        }
        crossings
    }
}
