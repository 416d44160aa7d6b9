//! The engine of a tracing worker: tiles on request.
//!
//! ```
//! use tracer::{Pass, tiles};
//! use worker::{Answer, Engine, Kind, Order, Request, Step};
//!
//! let mut engine = Engine::default();
//! engine.accept(Request::Begin {
//!     generation: 1,
//!     scene: Default::default(),
//!     camera: None,
//!     size: [8, 8],
//!     kind: Kind::Colours,
//!     shared: false,
//! });
//! let order = |tile| Order { generation: 1, tile, pass: Pass::Full };
//! engine.accept(Request::Trace(tiles(8, 8, 8).into_iter().map(order).collect()));
//! let mut bytes = 0;
//! while !engine.is_idle() {
//!     if let Step::Answer(Answer::Traced { pixels, .. }) = engine.step(&|| false, &|| 0.0) {
//!         bytes += pixels.len();
//!     }
//! }
//! assert_eq!(bytes, 4 * 8 * 8);
//! ```
//!
//! The page cuts a picture into tiles and sends [`Request`]s to its workers; a worker keeps them in
//! an [`Engine`], does one step of work at a time and sends [`Answer`]s. Between two steps it looks
//! at new requests, so queued tiles of an older picture are never begun. The same engine runs
//! on a thread in native builds. The part for web workers is in `entry`.
//!
//! This build of the worker finds surfaces in the tracer's own way. The crate `digger` is another
//! one, with the root finders for comparison.

pub mod engine;
#[cfg(target_arch = "wasm32")]
pub mod entry;
pub mod message;

pub use engine::{Engine, Step};
pub use message::{Answer, Kind, Order, Request};
