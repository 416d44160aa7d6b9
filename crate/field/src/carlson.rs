//! Carlson's symmetric elliptic integrals
//!
//! `R_F(x,y,z) = ½·∫₀^∞ dt/√((t+x)(t+y)(t+z))`,
//! `R_D(x,y,z) = (3/2)·∫₀^∞ dt/((t+z)·√((t+x)(t+y)(t+z)))`.
//!
//! Legendre's integrals are special cases, but these have no branches, their arguments may be
//! exchanged (in R_D the first two), and everything in their computation is positive, so that
//! nothing cancels. They are what remains of the inverse and the cubed kernel along an arc.
//!
//! Duplication: with `λ = √x√y + √x√z + √y√z` the integrals keep their values (but for a simple
//! term) when each argument a becomes (a+λ)/4. The arguments' square roots approach each other at
//! every step, first their ratios quadratically, then their differences by fours. When they are
//! nearly equal the Taylor series around equal arguments ends the work, here to seventh order (DLMF
//! 19.36). The number of steps is fixed for a type, [`Real::DUPLICATIONS`], so that all lanes go in
//! step: 5 in single precision leave an error below 3·10⁻⁸ of the value as long as the two smaller
//! arguments, or all but one that is 0, are above 10⁻¹⁴ of the largest (3·10⁻⁶ at 10⁻²⁰); 8 in
//! double leave 2·10⁻¹⁵ down to 10⁻⁴⁰.
//!
//! At most one argument may be 0, and not the last of R_D. R_F is homogeneous of degree −½, R_D of
//! −3/2; `∂R_F/∂z = −R_D(x,y,z)/6`. Second derivatives follow from differentiating the step of
//! duplication: with F_yy and F_yz those of R_F, a, b, c the roots of x, y, z and
//! `w = (a+b)(b+c) = y+λ`
//!
//! `F_yy = F_yy(next)/16 + (4b² + 2b(a+c) + ac)/(4b³w²)`,
//! `F_yz = F_yz(next)/16 + (a+b+c)/(4bc(a+b)(a+c)(b+c)²)`.
//!
//! Again everything is positive. What is left after the last step has a series like the others',
//! which are all of Carlson's `R_{−k}(b; x)`: `F_yy = (3/20)R_{−5/2}(½, 5/2, ½)`,
//! `F_yz = (1/20)R_{−5/2}(½, 3/2, 3/2)`.
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

/// R_F, its first and two sums of its second derivatives.
#[derive(Clone, Copy)]
pub struct Second<R> {
    /// R_F and its derivatives.
    pub first: Elliptic<R>,
    /// `F_yy + F_yz` and `F_zz + F_yz`.
    pub sums: [R; 2],
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

/// `R_{−5/2}(b; x)` of nearly equal arguments, where the three b add up to 7/2:
/// `A^{−5/2}·Σ T_n·5/(5+2n)` with `A = (2/7)Σ bᵢxᵢ`, `Zᵢ = 1−xᵢ/A`, `p_k = Σ bᵢZᵢᵏ` and
/// `n·T_n = p₁T_{n−1} + … + p_n`.
#[inline(always)]
fn series_second<R: Real>(b: [f64; 3], x: [R; 3]) -> R {
    let one = R::splat(1.0);
    let weighted =
        |x: [R; 3]| R::splat(b[0]) * x[0] + R::splat(b[1]) * x[1] + R::splat(b[2]) * x[2];
    let mean = weighted(x) * R::splat(2.0 / 7.0);
    let inverse = one / mean;
    let off = x.map(|x| (mean - x) * inverse);
    let mut powers = off;
    // p₁ is 0.
    let mut p = [R::splat(0.0); 6];
    for p in &mut p {
        powers = core::array::from_fn(|i| powers[i] * off[i]);
        *p = weighted(powers);
    }
    let [p2, p3, p4, p5, p6, p7] = p;
    let t2 = R::splat(0.5) * p2;
    let t3 = R::splat(1.0 / 3.0) * p3;
    let t4 = R::splat(0.25) * (p4 + p2 * t2);
    let t5 = R::splat(0.2) * (p5 + p3 * t2 + p2 * t3);
    let t6 = R::splat(1.0 / 6.0) * (p6 + p4 * t2 + p3 * t3 + p2 * t4);
    let t7 = R::splat(1.0 / 7.0) * (p7 + p5 * t2 + p4 * t3 + p3 * t4 + p2 * t5);
    let of = |n: f64| R::splat(5.0 / (5.0 + 2.0 * n));
    let sum =
        of(2.0) * t2 + of(3.0) * t3 + of(4.0) * t4 + of(5.0) * t5 + of(6.0) * t6 + of(7.0) * t7;
    (one + sum) * inverse * inverse * inverse.sqrt()
}

/// `R_F(x, y, z)`, its derivatives by the last two arguments, and sums of its second derivatives by
/// those.
#[inline(always)]
pub fn elliptic_second<R: Real>(x: R, y: R, z: R) -> Second<R> {
    let quarter = R::splat(0.25);
    // F_yy, F_zz and F_yz, as far as the steps have gone.
    let mut sums = [R::splat(0.0); 3];
    let mut scale = 0.25;
    let (mut p, mut q, mut r) = (x, y, z);
    for _ in 0..R::DUPLICATIONS {
        let (a, b, c) = (p.sqrt(), q.sqrt(), r.sqrt());
        let (ab, ac, bc) = (a + b, a + c, b + c);
        let lambda = a * bc + b * c;
        let by = R::splat(scale);
        let own = |b: R, a: R, c: R, w: R| {
            let two_b = b + b;
            by * (two_b * (two_b + a + c) + a * c) / (b * b * b * (w * w))
        };
        let (w_b, w_c) = (ab * bc, ac * bc);
        sums[0] = sums[0] + own(b, a, c, w_b);
        sums[1] = sums[1] + own(c, a, b, w_c);
        sums[2] = sums[2] + by * (ab + c) / (b * c * (w_b * w_c));
        scale *= 1.0 / 16.0;
        (p, q, r) = (
            (p + lambda) * quarter,
            (q + lambda) * quarter,
            (r + lambda) * quarter,
        );
    }
    let rest =
        |b: [f64; 3], factor: f64| R::splat(4.0 * scale * factor) * series_second(b, [p, q, r]);
    let yz = sums[2] + rest([0.5, 1.5, 1.5], 1.0 / 20.0);
    Second {
        first: elliptic(x, y, z),
        sums: [
            sums[0] + rest([0.5, 2.5, 0.5], 3.0 / 20.0) + yz,
            sums[1] + rest([0.5, 0.5, 2.5], 3.0 / 20.0) + yz,
        ],
    }
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
    use crate::integral::integral;
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
    fn by_quadrature([x, y, z]: [f64; 3]) -> [f64; 5] {
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
            over(&|t| (0.375 / (t + y) + 0.125 / (t + z)) / ((t + y) * root(t))),
            over(&|t| (0.375 / (t + z) + 0.125 / (t + y)) / ((t + z) * root(t))),
        ]
    }

    fn close(value: f64, want: f64, relative: f64, what: &str) {
        assert!(
            (value - want).abs() <= relative * want.abs(),
            "{what}: {value:e} instead of {want:e}"
        );
    }

    #[test]
    fn double_matches_quadrature() {
        for args in arguments(1e-18) {
            let [x, y, z] = args;
            let want = by_quadrature(args);
            let all = elliptic(x, y, z);
            let what = format!("{args:?}");
            close(all.f, want[0], 3e-13, &what);
            close(all.d_y, want[1], 3e-13, &what);
            close(all.d_z, want[2], 3e-13, &what);
            let all = elliptic_second(x, y, z);
            close(all.first.d_y, want[1], 3e-13, &what);
            close(all.sums[0], want[3], 3e-13, &what);
            close(all.sums[1], want[4], 3e-13, &what);
        }
    }

    #[test]
    fn single_matches_double() {
        let close32 = |value: f32, want: f64, what: &str| close(f64::from(value), want, 6e-7, what);
        for args in arguments(1e-12) {
            let narrow = args.map(|a| a as f32);
            let [x, y, z] = narrow;
            let want_of = narrow.map(f64::from);
            let want = elliptic(want_of[0], want_of[1], want_of[2]);
            let all = elliptic(x, y, z);
            let what = format!("{args:?}");
            close32(all.f, want.f, &what);
            close32(all.d_y, want.d_y, &what);
            close32(all.d_z, want.d_z, &what);
            let second = elliptic_second(x, y, z);
            let double = elliptic_second(want_of[0], want_of[1], want_of[2]);
            for i in 0..2 {
                close32(second.sums[i], double.sums[i], &what);
            }
            let lanes = elliptic_second(f32x8::splat(x), f32x8::splat(y), f32x8::splat(z));
            assert_eq!(second.sums, lanes.sums.map(|v| v.to_array()[3]));
            let eight = elliptic(f32x8::splat(x), f32x8::splat(y), f32x8::splat(z));
            assert_eq!(
                [all.f, all.d_y, all.d_z],
                [eight.f, eight.d_y, eight.d_z].map(|v| v.to_array()[5])
            );
        }
    }

    /// Carlson's own examples (Numerical computation of real or complex elliptic integrals, 1995),
    /// in the 14 digits that are printed.
    #[test]
    fn values_are_carlsons() {
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
