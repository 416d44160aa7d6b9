//! Checks of a kernel, as a function of distance, against its definition: its values, its
//! derivatives, its integrals and what is said of its shape.
//!
//! Each panics where a kernel does not hold.

use crate::quadrature::{Definition, define, difference, split};
use field::Kernel;
use trials::{Random, count};

/// Checks that a kernel has the values of its definition, to 10⁻¹⁵ of themselves, and that its
/// derivatives are differences of each other, to 10⁻¹¹; and that its kinks, its pole and its end
/// are where the definition has them. `derivatives` are G and four derivatives by q.
pub fn values_as_defined(kernel: Kernel, derivatives: &dyn Fn(f64) -> [f64; 5]) {
    let definition = define(kernel);
    assert!(
        definition.kinks().eq(kernel.kinks().iter().copied()),
        "{kernel:?}"
    );
    assert_eq!(definition.has_pole(), kernel.has_pole(), "{kernel:?}");
    let is_compact = matches!(definition, Definition::Pieces(_));
    assert_eq!(is_compact, kernel.is_compact(), "{kernel:?}");
    for dimension in [1, 2] {
        let is_finite = definition.is_finite_over(dimension);
        assert_eq!(is_finite, kernel.is_finite_over(dimension), "{kernel:?}");
    }
    let mut random = Random::new(108);
    let mut places = vec![0.0, 0.1, 0.3, 0.5, 0.9, 1.0, 1.5, 1e3];
    places.extend(
        definition
            .kinks()
            .flat_map(|u| [u.next_down(), u, u.next_up()]),
    );
    places.extend((0..count(1_000)).map(|_| random.decades(-7.0, 2.0)));
    for u in places {
        let want = definition.value(u * u);
        for value in [kernel.value(u), derivatives(u * u)[0]] {
            assert!(
                (value - want).abs() <= 1e-15 * want,
                "{kernel:?}: {value:e} instead of {want:e} at {u}"
            );
        }
    }
    for _ in 0..count(1_000) {
        // Smooth functions have no singularity nearer than −1.
        let (scale, q) = match definition {
            Definition::Pole(_) => {
                let q = random.decades(-12.0, 2.0);
                (q + 1e-10, q)
            }
            Definition::Smooth(_) => (1.0, random.decades(-1.0, 1.0)),
            Definition::Pieces(_) => {
                let q = random.decades(-1.5, 0.2);
                (q, q)
            }
        };
        let h = 0.005 * scale;
        if definition.kinks().any(|u| (u * u - q).abs() <= 4.0 * h) {
            continue;
        }
        let here = derivatives(q);
        for order in 1..5 {
            let slope = here[order];
            let want = difference(|q| derivatives(q)[order - 1], q, h);
            let most = 1e-11 * (want.abs() + here[order - 1].abs() / scale);
            assert!(
                (slope - want).abs() <= most,
                "{kernel:?}: {slope:e} instead of {want:e} at q = {q}, derivative {order}"
            );
        }
    }
}

/// Checks that a kernel's integrals over lines from a to b through the point, 0 ≤ a ≤ b, are those
/// of its definition by adaptive quadrature: to 10⁻⁹ clear of the pole, from 0.1 on, and from 0 on
/// to 10⁻⁹ of themselves.
pub fn integrals_over_lines(kernel: Kernel, between: &dyn Fn(f64, f64) -> f64) {
    let definition = define(kernel);
    integrals_as_defined(kernel, between, definition.kinks(), 1e-5, |u| {
        definition.value(u * u)
    });
}

/// Checks the same of a kernel's integrals of G over q, from p to q, 0 ≤ p ≤ q.
pub fn integrals_over_rings(kernel: Kernel, over_ring: &dyn Fn(f64, f64) -> f64) {
    let definition = define(kernel);
    let squares = definition.kinks().map(|u| u * u);
    integrals_as_defined(kernel, over_ring, squares, 1e-10, |q| definition.value(q));
}

/// Checks integrals of a function with kinks, which may have a pole of some width at 0.
fn integrals_as_defined(
    kernel: Kernel,
    integral: &dyn Fn(f64, f64) -> f64,
    kinks: impl Iterator<Item = f64> + Clone,
    pole: f64,
    f: impl Fn(f64) -> f64,
) {
    let mut random = Random::new(109);
    for _ in 0..count(200) {
        let inner = random.range(0.1, 1.2);
        let a = random.pick(&[0.0, 0.1, inner]);
        let length = random.decades(-3.0, 0.5);
        let kinks = kinks.clone().map(|kink| (kink - a) / length);
        let grain = (pole + a) / length;
        let want = length * split(|t| f(a + length * t), 0.0, grain, kinks);
        let got = integral(a, a + length);
        let most = 1e-9 * if a < 0.1 { want } else { 1.0 };
        assert!(
            (got - want).abs() <= most,
            "{kernel:?}: {got:e} instead of {want:e} from {a} over {length}"
        );
    }
}
