//! Root finders for comparison with the tracer's own, and the tracing worker that has them.
//!
//! ```
//! use glam::DVec3;
//! use scene::{Digger, Element, Flesh, Scene, Shape};
//!
//! let mut scene = Scene::default();
//! scene.flesh.push(Flesh { blobbiness: Some(2.0), ..Flesh::default() });
//! let ball = Shape::sphere(DVec3::ZERO, 0.5);
//! scene.elements.push(Element { flesh: Some(0), ..Element::new(ball) });
//! scene.settings.digger = Digger::Brent;
//! let picture = digger::picture(&scene, [64, 64]);
//! let hit = picture.cast(&[(DVec3::Z * 4.0, DVec3::NEG_Z)])[0].expect("a hit");
//! assert!((hit.t - 3.5).abs() < 1e-6);
//! ```
//!
//! These are the methods that the thesis compares with, each as its authors describe it, in a file
//! of its own. They follow rays one by one, in double precision, and see the field through a
//! `Sight`: the primitives that one ray can meet. Pictures show their hits unrefined, errors and
//! all; [`errors`] measures them.
//!
//! | digger | finds | can miss |
//! |---|---|---|
//! | `hermite` (the tracer's) | roots of spans with a bounded error | see the limits of `tracer` |
//! | `hermite2` | roots of n Hermite spans a primitive | crossings that its spans miss |
//! | `lagrange` | roots of polynomials through five samples | parts thinner than a step |
//! | `brent`, `ridder`, `rf` | changes of sign between steps, refined | parts thinner than a step |
//! | `lg` | monotone intervals, by Lipschitz constants | nothing longer than 10⁻⁷ |
//! | `sphere` | the surface, by safe steps towards it | nothing longer than 10⁻⁶ |
//!
//! Lengths are in units of the scene's size. Each method has a limit on the cost of one ray, so
//! that no scene takes unlimited time; the limits are far above the needs of pictures.
//!
//! The page fetches this build of the tracing worker when a text has the command `digger`; it does
//! all that the other one does, with the same bits.

mod brent;
#[cfg(all(target_arch = "wasm32", feature = "entry"))]
mod entry;
pub mod errors;
mod hermite2;
mod lagrange;
mod lg;
mod march;
mod regula_falsi;
mod ridder;
mod sight;
mod sphere;

use errors::Errors;
use field::{Bound, Primitive};
use march::march;
use scene::{Digger, Scene};
use sight::Sight;
use std::sync::Arc;
use tracer::{Picture, Quest, Ray, RootFinder};
use worker::Kind;
use worker::engine::Prepared;

/// Prepares a scene's picture, with the root finder that its settings name.
#[must_use]
pub fn picture(scene: &Scene, size: [u32; 2]) -> Picture {
    let mut picture = Picture::new(scene, size);
    if let Some(method) = method(scene.settings.digger) {
        let finder: Arc<dyn RootFinder> = Arc::new(Finder(method));
        picture.find_with(&finder);
    }
    picture
}

/// Prepares a scene in a worker: for `Engine::new`.
///
/// # Errors
/// Never.
pub fn prepare(scene: &Scene, size: [u32; 2], kind: Kind) -> Result<Prepared, String> {
    Ok(match kind {
        Kind::Colours => Prepared::colours(picture(scene, size)),
        Kind::Errors => {
            let errors = Errors::new(scene, size);
            Prepared::Other(Box::new(move |tile, stop| errors.trace(tile, stop)))
        }
    })
}

/// A function that finds the first crossing that the quest asks for (`First` or `Entry`) within the
/// sight's range.
type Method = Box<dyn Fn(&mut Sight<'_>, Quest) -> Option<f64> + Send + Sync>;

/// Returns the method of a name; `None` for the tracer's own.
fn method(name: Digger) -> Option<Method> {
    Some(match name {
        Digger::Hermite => return None,
        Digger::Spans(spans) => Box::new(move |sight, quest| hermite2::first(spans, sight, quest)),
        Digger::Lagrange => Box::new(lagrange::first),
        Digger::Brent => Box::new(|sight, quest| march(sight, quest, brent::refine)),
        Digger::Ridder => Box::new(|sight, quest| march(sight, quest, ridder::refine)),
        Digger::RegulaFalsi => Box::new(|sight, quest| march(sight, quest, regula_falsi::refine)),
        Digger::Lg => Box::new(lg::first),
        Digger::Sphere => Box::new(sphere::first),
    })
}

/// Adapter of a method to the tracer.
struct Finder(Method);

impl RootFinder for Finder {
    fn first(
        &self,
        terms: &[(&Primitive, &Bound)],
        ray: &Ray,
        limit: f64,
        quest: Quest,
    ) -> (Option<f64>, u64) {
        let Some(mut sight) = Sight::new(terms, ray, limit) else {
            return (None, 0);
        };
        let found = self.0(&mut sight, quest).filter(|t| *t > 0.0 && *t < limit);
        (found, sight.evaluations)
    }
}

/// The side of the surface on which a ray is; its changes are crossings.
#[derive(Clone, Copy, Debug)]
struct Side {
    inside: Option<bool>,
    quest: Quest,
}

impl Side {
    /// Returns the state at the start of a ray.
    fn unknown(quest: Quest) -> Self {
        Self {
            inside: None,
            quest,
        }
    }

    /// Records the side. Returns whether the ray has crossed since the last call, in the direction
    /// that the quest asks for.
    fn arrive(&mut self, inside: bool) -> bool {
        let crossed = self.inside.is_some_and(|before| before != inside);
        self.inside = Some(inside);
        crossed && (inside || self.quest != Quest::Entry)
    }
}
