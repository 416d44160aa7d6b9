//! Implicit meshes: any triangle mesh as a soft surface, one metaball for each facet.
//!
//! ```
//! use field::{Implicit, THRESHOLD};
//! use glam::DVec3;
//! use metaballs::{Kind, Metaballs};
//!
//! let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
//! let kind = Kind::Triangular { thickness: 0.1 };
//! let slab = Metaballs::new(&corners, &[[0, 1, 2]], kind, 40.0)?;
//! // The surface of a single facet is at its thickness.
//! let above = slab.jet(DVec3::new(0.2, 0.2, 0.1));
//! assert!((above.value - THRESHOLD).abs() < 1e-12);
//! assert!((above.gradient[2] + 40.0).abs() < 1e-9);
//! # Ok::<(), metaballs::Error>(())
//! ```
//!
//! The function is `F(x) = Σ φ(k·(dᵢ(x) − ρᵢ))` with `φ(s) = e^−s`, after Ilić and Fua. [`Kind`]
//! says what the distance dᵢ from a facet and its radius ρᵢ are. Two changes to `e^−s`, both
//! continuous with their derivative, are part of the definition ([`profile`](profile())):
//! - From s = 16 to 20 it falls to 0, so that a facet acts within ρᵢ + 20/k only. The sum differs
//!   from the plain one by less than `1.2·10⁻⁷` for each facet that is near, which moves the
//!   surface by less than `1.2·10⁻⁷·n/k`.
//! - Below s = −40 it goes on as its tangent, so that nothing overflows deep inside.
//!
//! Facets are found by a hierarchy of boxes: the costs of a value and of an enclosure grow with the
//! number of facets that are near.
//!
//! F is continuous, and so is its gradient but on the facets themselves (of balls: at their
//! centres), where it is largest. Second derivatives jump where the nearest feature of a facet
//! changes, and are at most `max(k², k/d)·e^(−k(d−ρ))` for each facet at the distance d.

mod ball;
mod enclose;
mod function;
mod profile;
mod triangle;

pub use ball::circumcircle;
pub use function::{Error, Kind, Metaballs};
pub use profile::{CUT, profile};
pub use triangle::{Nearest, nearest};
