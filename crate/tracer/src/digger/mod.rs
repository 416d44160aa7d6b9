//! Diggers: ways of finding where rays cross the soft surface, behind one trait.
//!
//! The one that pictures are normally made with, [`hermite`], is certified and takes packets of rays.
//! The others are the methods that the thesis compares with, each as its authors describe it, in a
//! file of its own. They follow rays one by one ([`Single`]), in double precision, and see the
//! field through a [`Sight`]: the primitives that one ray can meet. Pictures show their hits unrefined,
//! errors and all.
//!
//! | digger | finds | can miss |
//! |---|---|---|
//! | [`hermite`] | roots of Hermite spans with a bounded error; of blobs, by steps with a bound on their bend | little: see the limits of this crate |
//! | [`hermite2`] | roots of n Hermite spans a primitive | crossings that its spans miss |
//! | [`lagrange`] | roots of polynomials through five samples | parts thinner than its samples are apart |
//! | [`brent`], [`ridder`], [`regula_falsi`] | changes of sign between steps, refined | parts thinner than a step |
//! | [`lg`] | intervals where the field is monotone, by its Lipschitz constants | nothing longer than 10⁻⁷ |
//! | [`sphere`] | the surface, by safe steps towards it | nothing longer than 10⁻⁶ |
//!
//! Lengths are in units of the scene's size. What one ray may cost is limited for each of them, so that
//! no scene takes unlimited time; the limits are far above the needs of pictures.

mod brent;
mod hermite;
mod hermite2;
mod lagrange;
mod lg;
mod march;
mod regula_falsi;
mod ridder;
mod sight;
mod sphere;

use crate::layout::PACKET;
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::soft::Soft;
use crate::walk::Quest;
pub(crate) use hermite::Hermite;
pub(crate) use sight::Sight;

/// Some rays to follow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Packet<'r> {
    /// One ray a lane.
    pub rays: &'r [Ray; PACKET],
    /// End of each ray.
    pub limits: &'r [f64; PACKET],
    /// The lanes to follow, a bit each.
    pub alive: u32,
}

/// Parameter of each lane's crossing; `None` without one.
pub(crate) type Crossings = [Option<f64>; PACKET];

/// A way of finding where rays cross the soft surface.
pub(crate) trait Digger: Send + Sync {
    /// The first crossing with the surface of a body that the quest asks for (`First` or `Entry`) on each ray, 0 < t < limit.
    fn dig(
        &self,
        soft: &Soft,
        body: u32,
        packet: &Packet<'_>,
        quest: Quest,
        scratch: &mut Scratch,
    ) -> Crossings;
}

/// A digger that follows one ray at a time.
pub(crate) trait Single: Send + Sync {
    /// The first crossing that the quest asks for (`First` or `Entry`) within the sight's range.
    fn dig(&self, sight: &mut Sight<'_>, quest: Quest) -> Option<f64>;
}

impl<D: Single> Digger for D {
    fn dig(
        &self,
        soft: &Soft,
        body: u32,
        packet: &Packet<'_>,
        quest: Quest,
        scratch: &mut Scratch,
    ) -> Crossings {
        core::array::from_fn(|lane| {
            if packet.alive >> lane & 1 == 0 {
                return None;
            }
            let mut sight = Sight::new(soft, body, &packet.rays[lane], packet.limits[lane])?;
            let found = Single::dig(self, &mut sight, quest);
            scratch.evaluations += sight.evaluations;
            scratch.alone[lane] += sight.evaluations;
            found.filter(|t| *t > 0.0 && *t < packet.limits[lane])
        })
    }
}

/// The digger of this name.
pub(crate) fn of(name: scene::Digger) -> Box<dyn Digger> {
    match name {
        scene::Digger::Hermite => Box::new(Hermite),
        scene::Digger::Spans(spans) => Box::new(hermite2::Spans::new(spans)),
        scene::Digger::Lagrange => Box::new(lagrange::Lagrange),
        scene::Digger::Brent => Box::new(brent::Brent),
        scene::Digger::Ridder => Box::new(ridder::Ridder),
        scene::Digger::RegulaFalsi => Box::new(regula_falsi::RegulaFalsi),
        scene::Digger::Lg => Box::new(lg::Lg),
        scene::Digger::Sphere => Box::new(sphere::Sphere),
    }
}

/// Tracks on which side of the surface a ray is, and detects crossings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    inside: Option<bool>,
    quest: Quest,
}

impl Side {
    /// State at the start of a ray.
    pub fn unknown(quest: Quest) -> Self {
        Self {
            inside: None,
            quest,
        }
    }

    /// Records the side; returns whether the ray has crossed since the last call in the direction that the quest asks for.
    pub fn arrive(&mut self, inside: bool) -> bool {
        let crossed = self.inside.is_some_and(|before| before != inside);
        self.inside = Some(inside);
        crossed && (inside || self.quest != Quest::Entry)
    }
}
