//! A segment on the x axis, its middle at the origin.

/// A segment on the x axis, its middle at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<S> {
    /// Half the length.
    pub half: S,
}
