//! Surfaces that touch without blending.
//!
//! Where two implicit surfaces f₁ = T and f₂ = T would overlap, *precise contact modelling* (Cani
//! 1993; Angelidis, Jepp and Cani 2002) presses both onto the sheet f₁ = f₂ and lets them bulge
//! around it: f₁ becomes `f₁ + g(f₂)` and f₂ becomes `f₂ + g(f₁)`, where g(f) is T − f inside the
//! other surface and a small [`Bulge`] in a shell around it. [`Squashed`] is such a function, with
//! any number of others that it touches.
//!
//! ```
//! use contact::{Bulge, Squashed};
//! use field::{Exponentials, Implicit, THRESHOLD};
//! use glam::DVec3;
//! use std::sync::Arc;
//!
//! let ball = |x: f64| -> Arc<dyn Implicit> {
//!     Arc::new(Exponentials::new(3.0, vec![(DVec3::X * x, 1.0)]).expect("the numbers are usable"))
//! };
//! let (left, right) = (ball(-0.8), ball(0.8));
//! let squashed = Squashed::new(left.clone(), vec![(right, Bulge::default())]);
//! // Without the other ball the origin would be inside; now it is on the flat sheet between them.
//! assert!(left.jet(DVec3::ZERO).value > THRESHOLD);
//! assert!((squashed.jet(DVec3::ZERO).value - THRESHOLD).abs() < 1e-12);
//! ```
//!
//! The volume that is left to a ball of radius 1 and blobbiness −1.5 beside another one at a
//! distance of 1.5, as part of a ball's alone (`tests/it/volume.rs`, by Monte Carlo):
//!
//! | kernel | only cut off | fast 0.2 | height 0.2 0.65 0.25 | ripple 0.2 0.25 2 |
//! |---|---|---|---|---|
//! | cauchy | 95.1 % | 97.3 % | 100.2 % | 96.9 % |
//! | gauss | 95.1 % | 96.1 % | 97.6 % | 96.1 % |
//! | cubed | 95.1 % | 96.6 % | 98.8 % | 96.5 % |
//!
//! - `bulge.rs`: the three bulges and bounds on them;
//! - `squashed.rs`: the deformed function;
//! - `folded.rs`: the folds of one skeleton, which press each other;
//! - `coating.rs`: whether a bulge would wrap the other body.

mod bulge;
mod coating;
mod folded;
mod squashed;

pub use bulge::{Bulge, Spread};
pub use coating::coats;
pub use folded::Folded;
pub use squashed::Squashed;
