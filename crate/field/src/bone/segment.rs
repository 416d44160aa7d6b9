//! A segment on the x axis, its middle at the origin.

/// See the module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<S> {
    /// Half the length.
    pub half: S,
}
