//! Reasons for which a skeleton has no polyline.
use crate::{LARGEST, MOST_CURVES, MOST_LEVELS, MOST_NODES, MOST_SEGMENTS};
use core::fmt;

/// Mistake in a skeleton, or a limit that it passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// Skeleton of this many nodes, more than [`MOST_NODES`].
    Nodes(usize),
    /// Skeleton of this many curves, more than [`MOST_CURVES`].
    Curves(usize),
    /// Subdivision to this many levels, more than [`MOST_LEVELS`].
    Levels(u32),
    /// Polyline of more than [`MOST_SEGMENTS`] segments.
    Segments,
    /// Node of this index with a coordinate or a radius that is not usable.
    Node(usize),
    /// Curve of this index with fewer than two nodes.
    Short(usize),
    /// Curve of this index that names a node which does not exist.
    Unknown(usize),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nodes(count) => write!(
                f,
                "a skeleton has at most {MOST_NODES} nodes, this one has {count}: make several \
                 skeletons of it"
            ),
            Self::Curves(count) => write!(
                f,
                "a skeleton has at most {MOST_CURVES} curves, this one has {count}: make several \
                 skeletons of it"
            ),
            Self::Levels(levels) => write!(
                f,
                "a curve is subdivided at most {MOST_LEVELS} times, not {levels} times"
            ),
            Self::Segments => write!(
                f,
                "a skeleton has at most {MOST_SEGMENTS} segments: subdivide it less, or make \
                 several skeletons of it"
            ),
            Self::Node(index) => write!(
                f,
                "node {index}: coordinates must be numbers up to {LARGEST:e}, and the radius one \
                 from 0 to {LARGEST:e}"
            ),
            Self::Short(index) => write!(f, "curve {index} needs two nodes or more"),
            Self::Unknown(index) => write!(f, "curve {index} names a node that there is not"),
        }
    }
}

impl core::error::Error for Error {}
