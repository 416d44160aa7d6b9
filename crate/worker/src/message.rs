//! Messages between the page and a tracing worker: plain data, packed as bytes.

use scene::{Camera, Scene};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use tracer::{Known, Pass, Stats, Tile};

/// A tile to trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Order {
    /// The picture it belongs to.
    pub generation: u64,
    /// The pixels.
    pub tile: Tile,
    /// The pass: coarse, full or smooth.
    pub pass: Pass,
}

/// Meaning of the pixels of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Kind {
    /// Colours, as RGBA.
    #[default]
    Colours,
    /// Errors of the scene's digger, as the crate `digger` says.
    Errors,
}

/// A message to a worker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Request {
    /// A new picture begins: whatever is queued is forgotten.
    Begin {
        /// The picture's number, larger than those before.
        generation: u64,
        /// Scene to draw.
        scene: Arc<Scene>,
        /// The camera that sees it, if it is another than the scene's.
        camera: Option<Camera>,
        /// Width and height in pixels, each > 0.
        size: [u32; 2],
        /// Meaning of its pixels.
        kind: Kind,
        /// Whether others trace it, too, and want to hear of the first samples that were taken.
        shared: bool,
    },
    /// First samples that others took, which are not to be taken again.
    Learn {
        /// The picture.
        generation: u64,
        /// The samples.
        known: Vec<Known>,
    },
    /// Trace these tiles after those already queued.
    Trace(Vec<Order>),
    /// Forget whatever is queued, and the picture.
    Stop {
        /// A number larger than those before.
        generation: u64,
    },
}

/// An answer of a worker. A message holds a list of answers, as far as they came at about the same
/// time: a page that is busy drawing takes few messages a second.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Answer {
    /// The worker runs and takes requests. Sent once.
    Started,
    /// A [`Request::Begin`] or [`Request::Stop`] was taken note of: whatever the worker was at
    /// before is over. Left out if another one has come in meanwhile.
    Noted {
        /// The number of the request.
        generation: u64,
    },
    /// The picture is ready for tracing. Sent once for each [`Request::Begin`] that was not
    /// overtaken by a later one.
    Prepared {
        /// The picture.
        generation: u64,
    },
    /// A tile is done.
    Traced {
        /// The order.
        order: Order,
        /// Four bytes each, for what the [`Kind`] says; rows from the top.
        // Copied as a whole, not byte by byte.
        #[serde(with = "serde_bytes")]
        pixels: Vec<u8>,
        /// The work done for it.
        stats: Stats,
        /// Time it took.
        seconds: f64,
        /// The first samples, if others want to hear of them.
        known: Option<Known>,
    },
    /// The worker cannot go on, for this reason. The page replaces it.
    Failed(String),
}
