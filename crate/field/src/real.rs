//! The numbers that formulas are written in.
//!
//! Each formula of this crate is written once, generic over [`Real`], without branches on values:
//! it runs as `f64` (the reference), `f32`, and `wide::f32x8` (eight at a time), and gives the
//! same bits on every platform because nothing here calls a platform's own `sin` or `atan`.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// A real number, or several side by side that are computed in step.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// The result of a comparison, one truth value a lane.
    type Mask: Copy;
    /// The same constant in every lane.
    fn splat(value: f64) -> Self;
}
