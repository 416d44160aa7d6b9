//! Scene to pixels.
//!
//! [`Picture::new`] prepares a scene for tracing at a given size; [`Picture::trace`] draws one
//! tile of it. A tile's pixels depend on nothing but the scene, so tiles may be traced in any
//! order, by any number of threads or workers, on any platform, with equal results.
//!
//! # How a pixel comes about
//!
//! [`picture`] cuts a tile into squares of pixels, and those into packets of eight rays. What the packets of a
//! square share is in `square`: lists of what is near them, or beams that bounds are known of; packets that meet
//! nothing send no rays. `packet` finds what the rays of a packet hit, first among the hard elements (`solids`,
//! [`hard`]), then on the soft surface (`soft`). `shadows` asks which lights the hits see and adds up colours
//! (`shade`). `refine` sends more rays where neighbouring pixels differ; the hits of all those of one packet's pixels
//! share beams to the lights.
//!
//! The soft surface is found in one of two ways, both certified.
//!
//! - The quick way (`quick`) is for *lumps*, whose largest value on any piece of a ray is known in closed form
//!   (`field::course`): points and Gaussian segments, of kernels that end or nearly do. Gaussian arcs, curves and limbs
//!   that taper are strings of lumps (`field::beads`). `nearby` lists the lumps near a
//!   square, a part of it, a packet; `climb` steps along the packet's rays, each step proved to cross nothing.
//! - The general way is the thesis' (chapter 4): `slabs` decides for a whole beam which primitive needs Hermite spans
//!   of which length (`field::Bound` knows how large a field and the error of a span can be), and `walk` follows single
//!   packets through the slabs, adds up their spans' cubics (`spans`) and takes their roots (`roots`); what those leave
//!   in doubt `settle` decides. Nothing is cut off: what is far enough to be smooth across the beam is interpolated
//!   once for all its rays (`shared`), and distant primitives are judged in groups (`clusters`). `flesh` says what the
//!   surface is like at the hits. So is traced a packet that comes near anything but lumps, or of which a ray starts inside;
//!   and all of a square whose beam meets more than a few other primitives.
//!
//! Other ways of finding crossings, for comparison, are in `digger`; `map` shows what a picture costs.
//!
//! What pictures show is held against [`mod@reference`], which looks for the surface by bisection with
//! bounds of its own (`tests/certified.rs`, `examples/certify.rs`); `cast` follows single rays in the way of
//! pictures.
//!
//! # Limits
//!
//! - Of all primitives no more than 2·10⁻⁵·T is left out, all together, whatever `influence` says; that and single
//!   precision (about 10⁻⁶·T) are within the tolerance unless a surface is nearly flat in the field; a ray that they may
//!   have kept outside is settled where that was, with all of them. Shadows are not. A packet near more
//!   than 2¹⁶ lumps (beads count one each), or that makes more than 2²⁴ evaluations, goes the general way.
//! - There pictures show a field within 5·10⁻⁴·T of the true one, or as near as rounding lets it come where that is
//!   less, and what is shared adds at most 4·10⁻⁴·T; hits are then
//!   moved onto the field itself, unless what is shared moves them by less than half the tolerance; in double precision, where
//!   rounding may move them by more than that and no more than 2¹⁶ primitives are near.
//!   [`Picture::hits`] cuts nothing off and shares nothing; it may miss two crossings between which the field is
//!   within 10⁻⁹·T of T.
//! - Where spans leave a ray in doubt it is settled alone (`settle`), among very many primitives within what is shared, if that
//!   tells enough, and else exactly; stretches shorter than 5·10⁻⁷ of the scene are
//!   not looked into, and one packet looks at no more than 65536 pieces: a stretch at no more than a quarter of those left (all but an eighth for its next part),
//!   and what comes after its share is used up is decided by the signs at its ends.
//! - Where a packet is wider than the primitives in it, as in small pictures of clouds of very many, little can be
//!   shared and rounding leaves many rays in doubt: such pictures are slow.
//! - What is known of a profile holds between its kinks and jumps (`field::kinks`; polygons and curves have none). In
//!   scenes of at most 16 primitives, where those meet a slab, rays are settled
//!   alone, each in pieces from kink to kink; that would take too long in larger ones, so that thin flesh next to a
//!   kink may be missed there, and a hit be off.
//! - Where rounding may be as large as T, as beside Gaussian faces of blobbiness 20 and more, rays are settled alone at
//!   once.
//! - A packet looks at no more than 2¹⁷ list entries (what is evaluated to settle rays counts, too), or 64 times as
//!   many as there are primitives but never more than 2²²; after that its slabs are settled as they are, and where
//!   that looks at too many pieces what is left is decided by the signs at its ends. A slab is no shorter than 2⁻⁴⁰ of its beam.
//! - Soft planes are followed up to 10⁴ times the scene's size.

mod area;
mod beam;
mod beams;
mod blob_march;
mod blob_set;
mod cast;
mod clusters;
mod digger;
mod dug;
mod flesh;
mod function;
pub mod hard;
mod hierarchy;
mod kinks;
mod known;
mod lanes;
mod layout;
mod lens;
mod map;
mod meet;
mod nearby;
mod pick;
pub mod picture;
mod quick;
mod ray;
pub mod reference;
mod refine;
#[cfg(not(target_arch = "wasm32"))]
pub mod render;
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
#[cfg(test)]
mod tests;
pub mod tile;
mod unit;
mod view;
mod walk;
mod workspace;
mod world;

pub use known::{Known, around};
pub use pick::Picker;
pub use picture::{Hit, Picture};
pub use ray::Ray;
pub use reference::Reference;
#[cfg(not(target_arch = "wasm32"))]
pub use render::{render, render_picture};
pub use sample_cache::SampleCache;
pub use stats::Stats;
pub use tile::{Pass, Tile, tiles};
