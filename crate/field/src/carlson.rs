//! Carlson's symmetric elliptic integrals
//!
//! `R_F(x,y,z) = ½·∫₀^∞ dt/√((t+x)(t+y)(t+z))`, `R_D(x,y,z) = (3/2)·∫₀^∞ dt/((t+z)·√((t+x)(t+y)(t+z)))`.
//!
//! Legendre's integrals are special cases, but these have no branches, their arguments may be
//! exchanged (in R_D the first two), and everything in their computation is positive, so that nothing
//! cancels. They are what remains of the inverse kernel along an arc.
//!
//! Duplication: with `λ = √x√y + √x√z + √y√z` the integrals keep their values (but for a simple
//! term) when each argument a becomes (a+λ)/4. The arguments' square roots approach each other at
//! every step, first their ratios quadratically, then their differences by fours. When they are
//! nearly equal the Taylor series around equal arguments ends the work, here to seventh order (DLMF
//! 19.36). The number of steps is fixed for a type, [`Real::DUPLICATIONS`], so that all lanes go in step:
//! 5 in single precision leave an error below 3·10⁻⁸ of the value as long as the two smaller arguments,
//! or all but one that is 0, are above 10⁻¹⁴ of the largest (3·10⁻⁶ at 10⁻²⁰); 8 in double leave 2·10⁻¹⁵
//! down to 10⁻⁴⁰.
//!
//! At most one argument may be 0, and not the last of R_D. R_F is homogeneous of degree −½, R_D of −3/2;
//! `∂R_F/∂z = −R_D(x,y,z)/6`.
use crate::Real;

/// R_F and two of its derivatives, of one computation.
#[derive(Clone, Copy)]
pub struct Elliptic<R> {
    /// `R_F(x, y, z)`.
    pub f: R,
    /// `R_D(x, z, y) = −6·∂R_F/∂y`.
    pub d_y: R,
    /// `R_D(x, y, z) = −6·∂R_F/∂z`.
    pub d_z: R,
}

/// R_F of nearly equal arguments.
#[inline(always)]
fn series_f<R: Real>([x, y, z]: [R; 3]) -> R {
    let one = R::splat(1.0);
    let mean = (x + y + z) * R::splat(1.0 / 3.0);
    let inverse = one / mean;
    let (x, y) = ((mean - x) * inverse, (mean - y) * inverse);
    let z = -(x + y);
    let e2 = x * y - z * z;
    let e3 = x * y * z;
    let by_e2 = R::splat(-0.1) + e2 * (R::splat(1.0 / 24.0) - R::splat(5.0 / 208.0) * e2);
    let by_e3 = R::splat(1.0 / 14.0) + R::splat(3.0 / 104.0) * e3
        - e2 * (R::splat(3.0 / 44.0) - R::splat(1.0 / 16.0) * e2);
    (one + e2 * by_e2 + e3 * by_e3) * inverse.sqrt()
}

/// R_D of nearly equal arguments.
#[inline(always)]
fn series_d<R: Real>([x, y, z]: [R; 3]) -> R {
    let one = R::splat(1.0);
    let three = R::splat(3.0);
    let mean = (x + y + three * z) * R::splat(0.2);
    let inverse = one / mean;
    let (x, y) = ((mean - x) * inverse, (mean - y) * inverse);
    let z = (x + y) * R::splat(-1.0 / 3.0);
    let (xy, zz) = (x * y, z * z);
    let e2 = xy - R::splat(6.0) * zz;
    let e3 = (three * xy - R::splat(8.0) * zz) * z;
    let e4 = three * (xy - zz) * zz;
    let e5 = xy * zz * z;
    let by_e2 = R::splat(-3.0 / 14.0) + e2 * (R::splat(9.0 / 88.0) - R::splat(1.0 / 16.0) * e2)
        - e3 * (R::splat(9.0 / 52.0) - R::splat(45.0 / 272.0) * e2);
    let by_e3 = R::splat(1.0 / 6.0) + R::splat(3.0 / 40.0) * e3;
    let by_e4 = R::splat(-3.0 / 22.0) + R::splat(3.0 / 20.0) * e2 - R::splat(9.0 / 68.0) * e3;
    let by_e5 = R::splat(3.0 / 26.0) - R::splat(9.0 / 68.0) * e2;
    (one + e2 * by_e2 + e3 * by_e3 + e4 * by_e4 + e5 * by_e5) * inverse * inverse.sqrt()
}

/// `R_F(x, y, z)` and its derivatives by the last two arguments.
#[inline(always)]
pub fn elliptic<R: Real>(mut x: R, mut y: R, mut z: R) -> Elliptic<R> {
    let quarter = R::splat(0.25);
    let three = R::splat(3.0);
    // The sums that the R_D gather on the way.
    let mut sums = [R::splat(0.0); 2];
    let mut scale = 1.0;
    for _ in 0..R::DUPLICATIONS {
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * (ry + rz) + ry * rz;
        let (a, b) = (y + lambda, z + lambda);
        sums[0] = sums[0] + R::splat(scale) / (ry * a);
        sums[1] = sums[1] + R::splat(scale) / (rz * b);
        scale *= 0.25;
        (x, y, z) = ((x + lambda) * quarter, a * quarter, b * quarter);
    }
    Elliptic {
        f: series_f([x, y, z]),
        d_y: three * sums[0] + R::splat(scale) * series_d([x, z, y]),
        d_z: three * sums[1] + R::splat(scale) * series_d([x, y, z]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::integral;
    use wide::f32x8;

    /// Arguments over many decades, one of them sometimes 0.
    fn arguments(floor: f64) -> Vec<[f64; 3]> {
        let mut all = vec![];
        for x in [0.0, 1e-3, 0.3, 1.0] {
            for y in [floor, floor.sqrt(), 0.1, 1.0, 1.1] {
                for z in [1e-4, 1.0, 37.0] {
                    all.push([x * y, y, z]);
                }
            }
        }
        all
    }

    /// The integrals over ln t, where they are smooth, as far as they count.
    fn by_quadrature([x, y, z]: [f64; 3]) -> [f64; 3] {
        let root = |t: f64| ((t + x) * (t + y) * (t + z)).sqrt();
        let low = libm::log(y.min(z)) - 80.0;
        let high = libm::log(y.max(z)) + 80.0;
        let breaks: Vec<f64> = (0..=80)
            .map(|i| low + (high - low) * f64::from(i) / 80.0)
            .collect();
        let over = |f: &dyn Fn(f64) -> f64| {
            integral(
                &mut |v| {
                    let t = libm::exp(v);
                    t * f(t)
                },
                &breaks,
                1e-14,
            )
        };
        [
            0.5 * over(&|t| 1.0 / root(t)),
            1.5 * over(&|t| 1.0 / ((t + y) * root(t))),
            1.5 * over(&|t| 1.0 / ((t + z) * root(t))),
        ]
    }

    fn close(value: f64, want: f64, relative: f64, what: &str) {
        assert!(
            (value - want).abs() <= relative * want.abs(),
            "{what}: {value:e} instead of {want:e}"
        );
    }

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn double_matches_quadrature() {
        for args in arguments(1e-18) {
            let [x, y, z] = args;
            let want = by_quadrature(args);
            let all = elliptic(x, y, z);
            let what = format!("{args:?}");
            close(all.f, want[0], 3e-13, &what);
            close(all.d_y, want[1], 3e-13, &what);
            close(all.d_z, want[2], 3e-13, &what);
        }
    }

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn single_matches_double() {
        let close32 = |value: f32, want: f64, what: &str| close(f64::from(value), want, 6e-7, what);
        for args in arguments(1e-12) {
            let narrow = args.map(|a| a as f32);
            let [x, y, z] = narrow;
            let want = narrow.map(f64::from);
            let want = elliptic(want[0], want[1], want[2]);
            let all = elliptic(x, y, z);
            let what = format!("{args:?}");
            close32(all.f, want.f, &what);
            close32(all.d_y, want.d_y, &what);
            close32(all.d_z, want.d_z, &what);
            let eight = elliptic(f32x8::splat(x), f32x8::splat(y), f32x8::splat(z));
            assert_eq!(
                [all.f, all.d_y, all.d_z],
                [eight.f, eight.d_y, eight.d_z].map(|v| v.to_array()[5])
            );
        }
    }

    /// Carlson's own examples (Numerical computation of real or complex elliptic integrals, 1995), in
    /// the 14 digits that are printed.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn published_values() {
        let first = elliptic(0.0, 2.0, 1.0);
        close(first.f, 1.311_028_777_146_1, 1e-13, "R_F(1, 2, 0)");
        close(first.d_z, 1.797_210_352_103_4, 1e-13, "R_D(0, 2, 1)");
        let second = elliptic(2.0, 3.0, 4.0);
        close(second.f, 0.584_082_841_677_15, 1e-13, "R_F(2, 3, 4)");
        close(second.d_z, 0.165_105_272_942_61, 1e-13, "R_D(2, 3, 4)");
        let equal = elliptic(4.0, 4.0, 4.0);
        close(equal.f, 0.5, 1e-15, "R_F(4, 4, 4)");
        close(equal.d_y, 0.125, 1e-15, "R_D(4, 4, 4)");
    }
}
