//! Textures: what a surface looks like from point to point; and small closed forms of shading.
//!
//! Pure functions from a place on a surface ([`Site`]: a point of the object's own space, its
//! normal, u and v) to the parameters of shading ([`Surface`]). This crate knows no scene, no field
//! and no language. Every result has the same bits on every machine.
//!
//! A [`Texture`] is a target, a method and options; [`apply`] puts layers of them on a surface:
//!
//! ```
//! use glam::{DVec3, Vec3};
//! use texture::{Method, Site, Solid, Surface, Target, Texture, apply, uv};
//!
//! let light_wood = Surface { diffuse: Vec3::new(0.91, 0.76, 0.65), ..Surface::default() };
//! let rings = Texture {
//!     bounds: [DVec3::new(0.45, 0.3, 0.2), DVec3::ONE],
//!     scale: DVec3::new(3.0, 3.0, 1.0),
//!     ..Texture::new(Target::Pigment, Method::Solid(Solid::Wood))
//! };
//! let bumps = Texture {
//!     times: DVec3::splat(0.5),
//!     ..Texture::new(Target::Normal, Method::Solid(Solid::Wood))
//! };
//! let point = DVec3::new(0.3, 0.4, 0.0).normalize();
//! let site = Site { point, normal: point, uv: uv::sphere(DVec3::ZERO, point) };
//! let wood = apply(&[rings, bumps], Surface { normal: point, ..light_wood }, &site, &[]);
//! assert!(wood.diffuse.cmple(light_wood.diffuse).all());
//! assert!(wood.normal.is_normalized());
//! ```
//!
//! On a soft surface each element near the point has texture coordinates of its own ([`uv`]):
//! texture each element's surface by itself, then [`blend`] them by the elements' shares of the
//! field.
//!
//! | looking for | go to |
//! |---|---|
//! | noise, fractal sums | [`noise()`], [`fractal`], [`turbulence`] |
//! | marble, wood, … | [`Solid`] |
//! | `sin one` and such | [`Wave`] |
//! | images, flat or thrown onto a part | [`Image`], [`Region`] |
//! | refraction, dispersion, total reflection | [`refraction`] |
//! | points on a lens, on lights | [`disc`] |
//! | well spread numbers for each pixel and sample | [`sequence`] |
//! | fog, tone mapping | [`fog`], [`tone`] |

mod image;
mod layer;
mod noise;
mod solid;
mod surface;
mod wave;

pub mod disc;
pub mod fog;
pub mod refraction;
pub mod sequence;
pub mod tone;
pub mod uv;

pub use image::{Edge, Image, Region, Rgb8, sample};
pub use layer::{
    Fault, MAX_LAYERS, MAX_MASK, MAX_NUMBER, Mapping, Method, Target, Texture, apply, stack,
};
pub use noise::{MAX_OCTAVES, fractal, noise, noise_jet, turbulence};
pub use solid::{Grain, Solid};
pub use surface::{Site, Surface, blend};
pub use uv::Uv;
pub use wave::Wave;
