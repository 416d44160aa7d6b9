//! Scene to pixels.
//!
//! [`Picture::new`] prepares a scene for tracing at a given size; [`Picture::trace`] draws one
//! tile of it. A tile's pixels depend on nothing but the scene, so tiles may be traced in any
//! order, by any number of threads or workers, on any platform, with equal results.
//!
//! ```
//! use glam::DVec3;
//! use scene::{Element, Flesh, Scene, Shape};
//! use tracer::Picture;
//!
//! // Two soft balls that blend.
//! let mut scene = Scene::default();
//! scene.flesh.push(Flesh { blobbiness: Some(2.0), ..Flesh::default() });
//! for x in [-0.6, 0.6] {
//!     let center = DVec3::X * x;
//!     let shape = Shape::sphere(center, 0.5);
//!     scene.elements.push(Element { flesh: Some(0), ..Element::new(shape) });
//! }
//! let picture = Picture::new(&scene, [64, 64]);
//! // A ray towards the first ball: the hit is nearer than the ball's own surface, which the other
//! // one inflates.
//! let ray = (DVec3::new(-0.6, 0.0, 4.0), DVec3::NEG_Z);
//! let hit = picture.cast(&[ray])[0].expect("a hit");
//! assert!(hit.t < 3.5 && hit.enters(ray.1));
//! ```
//!
//! # How a pixel is computed
//!
//! [`picture`] cuts a tile into squares of pixels, and those into packets of eight rays. The
//! packets of a square share data (`square`): lists of nearby primitives, or beams with bounds;
//! packets that can meet nothing trace no rays. `meet` finds the first crossings of a packet's rays
//! with hard elements (`solids`, [`hard`]) and soft surfaces (`soft`).
//! `shadows` traces shadow rays and adds up colours (`shade`). `refine` traces more rays where
//! neighbouring pixels differ; the hits of all those of one packet's pixels share beams to the
//! lights.
//!
//! Scenes that have more than Phong's model on one background colour
//! (`rich`) are shaded in waves of rays instead (`paths`): each surface point adds its own light
//! (`lamps`, `transmission`), with the material of its elements and their textures (`material`),
//! and asks for reflected and refracted rays, which `free` follows; `air` is what they pass and see
//! beside surfaces.
//!
//! Crossings with the soft surface are found in one of three certified ways.
//!
//! - The fast path (`quick`) is for *blobs*, whose largest value on any interval of a ray has a
//!   closed form (`field::blob`): points with compact or Gaussian kernels, and Gaussian segments.
//!   Gaussian arcs, curves and tapered limbs are chains of blobs (`field::blob_chain`). `nearby`
//!   lists the blobs near a square, a part of it, a packet; `blob_march` steps along the packet's
//!   rays, each step proved to hold no crossing.
//! - Bodies of 64 or more points of one kernel that never ends (but not the inverse one), of one
//!   finish and none of them negative, have a hierarchy of cells with polynomials of what is far
//!   (`field::far_field`); `far_march` steps among the near points of each cell.
//! - The general way is the thesis' (chapter 4): `slabs` decides for a whole beam which primitive
//!   needs Hermite spans of which length (`field::Bound` has bounds on fields and on the errors of
//!   spans), and `walk` traverses the slabs with single packets, adds up their spans' cubics
//!   (`spans`) and takes their roots (`roots`); `root_isolation` decides the doubtful ones. Nothing
//!   is cut off: primitives so far away that they are smooth across the beam are interpolated once
//!   for all its rays (`shared`), and distant primitives are bounded in groups (`clusters`). Sums
//!   of Gaussians are bounded by two values on each ray (`convex`), however many they are; rays
//!   that start deep inside of many poles are followed from where they leave a ball that is wholly
//!   inside (`inner_ball`). `refine_hits` samples the surface at the hits. This way takes packets
//!   near anything but blobs, or with a ray that starts inside, and all packets of a square whose
//!   beam meets more than 16 other primitives.
//!
//! Bodies that are met ray by ray ([`body`]) are those of other functions ([`function`], in
//! [`cells`] of space that all rays share), and all if a picture is to be drawn by another root
//! finder ([`root_finder`]); those of the literature are in the crate `digger`. `map` shows the
//! cost of each pixel.
//!
//! Pictures are checked against the crate `oracle`, whose reference finds the surface by bisection
//! with bounds of its own (`tests/it/certified.rs`, `examples/certify.rs`); `cast` traces single
//! rays as in pictures.
//!
//! # Limits
//!
//! - Fast path: primitives left out add up to at most 2·10⁻⁵·T, whatever `influence` is. With
//!   single precision (about 10⁻⁶·T) that is within the tolerance unless a surface is nearly flat
//!   in the field. A ray that passes so near to the surface is searched again there in double
//!   precision, with all primitives; shadow rays are not. A packet near more than 2¹⁶ blobs (points
//!   of chains count one each), or with more than 2²⁴ evaluations, takes the general way.
//! - Points that never end: the error of the field is at most about 1.3·10⁻⁴·T. Packets in which
//!   that moves a hit by more than half the tolerance, whose beam is wider than half a cell, in
//!   which a ray starts inside, or that visit more than 4096 cells take the general way. A ray that
//!   passes nearer to the surface than the error is searched again there in double precision, with
//!   all points; shadow rays are not.
//! - General way: the error of the field is at most 5·10⁻⁴·T, or that of rounding where it is
//!   larger, plus at most 4·10⁻⁴·T for shared interpolants. Hits are then refined on the field
//!   itself (with shared interpolants where those move them by less than half the tolerance), in
//!   double precision where rounding may move them by more than that and at most 2¹⁶ primitives are
//!   near.
//! - [`Picture::hits`] leaves out nothing and shares nothing; it may miss two crossings between
//!   which the field is within 10⁻⁹·T of T.
//! - Rays that spans leave in doubt are isolated one by one (`root_isolation`): among very many
//!   primitives with shared interpolants if their error allows it, else with all primitives.
//!   Intervals shorter than 5·10⁻⁷ of the scene are not subdivided. A packet uses at most 65536
//!   pieces, an interval at most a quarter of the remaining ones; after that the signs at the ends
//!   decide.
//! - Where a packet is wider than the primitives in it, as in small pictures of clouds of very
//!   many, little can be shared and rounding leaves many rays in doubt: such pictures are slow.
//! - Bounds on a profile hold between its kinks and jumps (`field::kinks`; polygons and curves have
//!   none). In bodies of at most 16 primitives, rays that meet a kink are isolated one by one, in
//!   pieces from kink to kink. In larger ones, where that would take too long, thin parts next to a
//!   kink may be missed, and hits there may be inaccurate.
//! - Where rounding may be as large as T, as beside Gaussian faces of blobbiness 20 and more, rays
//!   are isolated at once.
//! - A packet visits at most 2¹⁷ list entries (evaluations of root isolation count, too), or 64
//!   times the number of primitives, but at most 2²²; after that its slabs are decided by root
//!   isolation within its limits. A slab is no shorter than 2⁻⁴⁰ of its beam.
//! - Soft planes are followed up to 10⁴ times the scene's size.

mod air;
mod area;
mod beam;
mod beams;
mod blob_march;
mod blob_set;
mod body;
mod cast;
mod cells;
mod clusters;
mod convex;
mod exposure;
mod far_march;
mod free;
mod function;
pub mod hard;
mod hierarchy;
mod inner_ball;
mod kinks;
mod known;
mod lamps;
mod lanes;
mod layout;
mod lens;
mod look;
mod map;
mod material;
mod media;
mod meet;
mod nearby;
mod paths;
mod pick;
pub mod picture;
mod plain;
mod quick;
mod ray;
mod refine;
mod refine_hits;
#[cfg(not(target_arch = "wasm32"))]
pub mod render;
mod rich;
mod root_finder;
mod root_isolation;
mod roots;
mod sample;
mod sample_cache;
mod sampler;
mod scratch;
mod shade;
mod shadows;
mod shared;
mod slabs;
mod soft;
mod solids;
mod spans;
mod square;
mod stats;
mod surface_samples;
#[cfg(test)]
mod tests;
pub mod tile;
mod transmission;
mod view;
mod walk;
mod workspace;
mod world;

pub use known::{Known, around};
pub use pick::Picker;
pub use picture::{Hit, Picture};
pub use ray::Ray;
#[cfg(not(target_arch = "wasm32"))]
pub use render::render;
pub use root_finder::RootFinder;
pub use roots::{Roots, roots};
pub use sample_cache::SampleCache;
pub use stats::Stats;
pub use tile::{Pass, Tile, tiles};
pub use walk::Quest;
