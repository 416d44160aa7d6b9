//! Bones whose radius and blobbiness vary along them, held to the conformance suite.

use field::Kernel;
use oracle::evaluation::{Evaluation, jet};
use oracle::tapers;
use wide::f32x8;

const DOUBLE: Evaluation<'static> = &jet::<f64>;
const SINGLES: [Evaluation<'static>; 2] = [&jet::<f32>, &jet::<f32x8>];

/// Every check, one test each, in a module named after the kernel.
macro_rules! kernels {
    (() $($module:ident: $kernel:ident;)*) => {$(
        mod $module {
            use super::*;
            kernels!(@checks Kernel::$kernel,
                matches_quadrature(DOUBLE),
                single_matches_double(SINGLES),
                gradient_is_the_derivative(DOUBLE),
                superposition(DOUBLE),
                scale_invariance(DOUBLE),
                cones_have_their_radius(),
                bounds_hold(),
                degenerate_tapers());
        }
    )*};
    (@checks $kernel:expr, $($check:ident($($input:expr)?)),*) => {
        $(
            #[test]
            fn $check() {
                tapers::$check($kernel $(, $input)?);
            }
        )*
    };
}

field::each_kernel!(kernels!());
