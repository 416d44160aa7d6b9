//! Every kernel × every kind of skeleton × every evaluator, held to the conformance suite; and the
//! suite, to faults that it must find.

use field::Kernel;
use glam::DVec3;
use oracle::evaluation::{Evaluation, jet, peak};
use oracle::{cells, kernels};
use std::panic::{AssertUnwindSafe, catch_unwind};
use trials::skeletons::{ALL_KINDS, Kind};
use wide::f32x8;

const DOUBLE: Evaluation<'static> = &jet::<f64>;
const SINGLE: Evaluation<'static> = &jet::<f32>;
const EIGHT: Evaluation<'static> = &jet::<f32x8>;

/// Every check on every kind of skeleton, one test each, in a module named after the kernel.
macro_rules! chart {
    (() $($module:ident: $kernel:ident;)*) => {$(
        mod $module {
            use super::*;

            #[test]
            fn values_as_defined() {
                kernels::values_as_defined(Kernel::$kernel, &|q| Kernel::$kernel.derivatives(q));
            }

            #[test]
            fn integrals_as_defined() {
                let kernel = Kernel::$kernel;
                kernels::integrals_over_lines(kernel, &|a, b| kernel.between(a, b));
                kernels::integrals_over_rings(kernel, &|p, q| kernel.over_ring(p, q));
            }

            chart!(@checks Kernel::$kernel;
                matches_quadrature: DOUBLE;
                single_matches_double: [SINGLE, EIGHT];
                gradient_is_the_derivative: DOUBLE;
                superposition: DOUBLE;
                rigid_motion_and_scale: DOUBLE;
                doubles_fall_to_nothing falls_to_nothing: DOUBLE, f64::EPSILON;
                singles_fall_to_nothing falls_to_nothing: SINGLE, f64::from(f32::EPSILON) / 2.0;
                degenerate_geometry: [DOUBLE, EIGHT];
                radius_in_isolation: DOUBLE;
            );
        }
    )*};
    (@checks $kernel:expr; $($test:ident $($check:ident)?: $($input:expr),*;)*) => {
        $(chart!(@check $test $($check)?, $kernel, $($input),*);)*
    };
    (@check $check:ident, $kernel:expr, $($input:expr),*) => {
        chart!(@check $check $check, $kernel, $($input),*);
    };
    (@check $test:ident $check:ident, $kernel:expr, $($input:expr),*) => {
        #[test]
        fn $test() {
            for kind in ALL_KINDS {
                cells::$check($kernel, kind, $($input),*);
            }
        }
    };
}

mod conformance {
    use super::*;

    field::each_kernel!(chart!());
}

/// Asserts that a check of every kernel on a kind of skeleton finds a fault.
fn is_told(kind: Kind, check: impl Fn(Kernel, Kind)) {
    for kernel in Kernel::ALL {
        let held = catch_unwind(AssertUnwindSafe(|| check(kernel, kind)));
        assert!(held.is_err(), "{kernel:?} {kind:?}");
    }
}

/// Asserts that a check of every kernel finds a fault.
fn is_told_of(check: impl Fn(Kernel)) {
    for kernel in Kernel::ALL {
        let held = catch_unwind(AssertUnwindSafe(|| check(kernel)));
        assert!(held.is_err(), "{kernel:?}");
    }
}

#[test]
fn a_kernel_that_is_off_is_told() {
    for (order, share) in [(0, 1e-14), (1, 1e-9), (2, 1e-9)] {
        is_told_of(|kernel| {
            kernels::values_as_defined(kernel, &|q| {
                let mut derivatives = kernel.derivatives(q);
                derivatives[order] *= 1.0 + share;
                derivatives
            });
        });
    }
    is_told_of(|kernel| {
        kernels::integrals_over_lines(kernel, &|a, b| kernel.between(a, b) * (1.0 + 3e-9));
    });
    is_told_of(|kernel| {
        kernels::integrals_over_rings(kernel, &|p, q| kernel.over_ring(p, q) + 3e-9);
    });
}

#[test]
fn a_value_that_is_off_is_told() {
    for (share, kind) in [
        (1e-7, Kind::Segment),
        (-1e-7, Kind::Arc),
        (1e-7, Kind::Point),
    ] {
        let off: Evaluation<'_> = &|primitive, point| {
            let (value, gradient) = jet::<f64>(primitive, point);
            (value * (1.0 + share), gradient)
        };
        is_told(kind, |kernel, kind| {
            cells::matches_quadrature(kernel, kind, off)
        });
    }
    let off: Evaluation<'_> = &|primitive, point| {
        let (value, gradient) = jet::<f64>(primitive, point);
        (value * 1.001, gradient)
    };
    is_told(Kind::Point, |kernel, kind| {
        cells::radius_in_isolation(kernel, kind, off)
    });
}

#[test]
fn a_single_form_that_is_off_is_told() {
    let off: Evaluation<'_> = &|primitive, point| {
        let (value, gradient) = jet::<f32>(primitive, point);
        (value * 1.0002, gradient)
    };
    is_told(Kind::Segment, |kernel, kind| {
        cells::single_matches_double(kernel, kind, [off, off]);
    });
    is_told(Kind::Segment, |kernel, kind| {
        cells::single_matches_double(kernel, kind, [SINGLE, off]);
    });
}

#[test]
fn a_gradient_that_is_off_is_told() {
    let off: Evaluation<'_> = &|primitive, point| {
        let (value, gradient) = jet::<f64>(primitive, point);
        (value, 1.01 * gradient)
    };
    is_told(Kind::Segment, |kernel, kind| {
        cells::gradient_is_the_derivative(kernel, kind, off);
    });
}

#[test]
fn a_field_that_does_not_add_up_is_told() {
    let off: Evaluation<'_> = &|primitive, point| {
        let (value, gradient) = jet::<f64>(primitive, point);
        (value + 1e-6 * peak(primitive), gradient)
    };
    is_told(Kind::Segment, |kernel, kind| {
        cells::superposition(kernel, kind, off)
    });
}

#[test]
fn a_field_that_knows_a_direction_is_told() {
    let off: Evaluation<'_> = &|primitive, point| {
        let (value, gradient) = jet::<f64>(primitive, point);
        (
            value + 1e-6 * peak(primitive) * point.normalize_or_zero().x,
            gradient,
        )
    };
    is_told(Kind::Arc, |kernel, kind| {
        cells::rigid_motion_and_scale(kernel, kind, off)
    });
}

#[test]
fn a_field_that_does_not_fall_is_told() {
    let off: Evaluation<'_> = &|primitive, point| {
        let (value, gradient) = jet::<f64>(primitive, point);
        let distance = primitive.width * primitive.skeleton.distance(point);
        (value + 1e-3 * peak(primitive) * distance, gradient)
    };
    is_told(Kind::Segment, |kernel, kind| {
        cells::falls_to_nothing(kernel, kind, off, f64::EPSILON);
    });
}

#[test]
fn a_number_that_is_none_is_told() {
    let off: Evaluation<'_> = &|primitive, point| {
        let (value, gradient) = jet::<f64>(primitive, point);
        let is_odd = point == DVec3::new(0.5, 0.5, 1e-300);
        (if is_odd { f64::NAN } else { value }, gradient)
    };
    is_told(Kind::Triangle, |kernel, kind| {
        cells::degenerate_geometry(kernel, kind, [off, EIGHT]);
    });
}
