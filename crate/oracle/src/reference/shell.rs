//! Bounds on a kernel, its slope and its curvature in a shell of distances.
//!
//! A kernel is G(q) with q the squared distance in kernel widths. The slope of `h(r) = G(r²)` is
//! `2rG′`, and the matrix of second derivatives of `h(|x|)` has the eigenvalues `2G′` (across) and
//! `2G′ + 4qG″` (outward). Each of these rises to one peak and falls, so that its largest value in
//! a shell is at the peak, or at the end of the shell that is nearer to it.
use field::Kernel;

/// Upper bounds of magnitudes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Largest {
    /// Bound on the kernel.
    pub value: f64,
    /// Bound on its first derivative in any direction.
    pub slope: f64,
    /// Bound on its second derivative in any direction.
    pub curvature: f64,
}

/// ε² of the kernels with a rounded pole (see [`Kernel`]).
const POLE2: f64 = 1e-10;

/// Returns the bounds between two distances in units of the kernel's width.
pub fn largest(kernel: Kernel, near: f64, far: f64) -> Largest {
    let (p, q) = (near * near, far * far);
    // The argument between p and q at which a function with its peak at `peak` is largest.
    let at = |peak: f64| peak.clamp(p, q);
    match kernel {
        Kernel::Cauchy => {
            let g1 = |q: f64| 2.0 / ((1.0 + q) * (1.0 + q) * (1.0 + q));
            let s = at(0.2);
            let b = at(1.0 / 3.0);
            let bent = b * 6.0 / ((1.0 + b) * (1.0 + b) * (1.0 + b) * (1.0 + b));
            Largest {
                value: 1.0 / ((1.0 + p) * (1.0 + p)),
                slope: 2.0 * s.sqrt() * g1(s),
                curvature: curvature(g1(p), g1(q), bent),
            }
        }
        Kernel::Gauss => {
            let g = |q: f64| libm::exp(-q);
            let s = at(0.5);
            let b = at(1.0);
            Largest {
                value: g(p),
                slope: 2.0 * s.sqrt() * g(s),
                curvature: curvature(g(p), g(q), b * g(b)),
            }
        }
        Kernel::Inverse => {
            let g = |q: f64| 1.0 / (q + POLE2).sqrt();
            let g1 = |q: f64| 0.5 * g(q) / (q + POLE2);
            let s = at(POLE2 / 2.0);
            let b = at(2.0 * POLE2 / 3.0);
            let bent = b * 0.75 * g(b) / ((b + POLE2) * (b + POLE2));
            Largest {
                value: g(p),
                slope: 2.0 * s.sqrt() * g1(s),
                curvature: curvature(g1(p), g1(q), bent),
            }
        }
        Kernel::Squared => {
            let g = |q: f64| 1.0 / (q + POLE2);
            let g1 = |q: f64| g(q) * g(q);
            let s = at(POLE2 / 3.0);
            let b = at(POLE2 / 2.0);
            Largest {
                value: g(p),
                slope: 2.0 * s.sqrt() * g1(s),
                curvature: curvature(g1(p), g1(q), b * 2.0 * g(b) * g(b) * g(b)),
            }
        }
        Kernel::Cubed => {
            let g = |q: f64| 1.0 / ((q + POLE2) * (q + POLE2).sqrt());
            let g1 = |q: f64| 1.5 * g(q) / (q + POLE2);
            let s = at(POLE2 / 4.0);
            let b = at(0.4 * POLE2);
            let bent = b * 3.75 * g(b) / ((b + POLE2) * (b + POLE2));
            Largest {
                value: g(p),
                slope: 2.0 * s.sqrt() * g1(s),
                curvature: curvature(g1(p), g1(q), bent),
            }
        }
        _ if p > 1.0 => Largest::default(),
        Kernel::Metaballs => {
            let inner = 1.0 / 9.0;
            let g1 = |q: f64| {
                if q <= inner {
                    3.0
                } else if q < 1.0 {
                    1.5 * (1.0 / q.sqrt() - 1.0)
                } else {
                    0.0
                }
            };
            let s = at(inner);
            // 0 inside, then falling from its largest.
            let bent = if q < inner {
                0.0
            } else {
                0.75 / p.max(inner).sqrt()
            };
            Largest {
                value: if p <= inner {
                    1.0 - 3.0 * p
                } else {
                    1.5 * (1.0 - p.sqrt()) * (1.0 - p.sqrt())
                },
                slope: 2.0 * s.sqrt() * g1(s),
                curvature: curvature(g1(p), g1(q), bent),
            }
        }
        Kernel::Quartic => quartic(p, q),
        Kernel::Compact6 => compact6(p, q),
        // A mixture of those two.
        Kernel::Soft => {
            let (a, b) = (quartic(p, q), compact6(p, q));
            let mix = |a: f64, b: f64| (5.0 * a + 4.0 * b) / 9.0;
            Largest {
                value: mix(a.value, b.value),
                slope: mix(a.slope, b.slope),
                curvature: mix(a.curvature, b.curvature),
            }
        }
    }
}

/// Returns the bound on the second derivatives `−2g` and `−2g + 4b`, where g falls from `first` to
/// `last` and b is at most `bent`.
fn curvature(first: f64, last: f64, bent: f64) -> f64 {
    (2.0 * first).max(4.0 * bent - 2.0 * last)
}

/// Returns the bounds of `v²` with v = 1−q; p < 1.
fn quartic(p: f64, q: f64) -> Largest {
    let v = |q: f64| (1.0 - q).max(0.0);
    let s = (1.0f64 / 3.0).clamp(p, q);
    Largest {
        value: v(p) * v(p),
        slope: 4.0 * s.sqrt() * v(s),
        curvature: curvature(2.0 * v(p), 2.0 * v(q), 2.0 * q.min(1.0)),
    }
}

/// Returns the bounds of `v³` with v = 1−q; p < 1.
fn compact6(p: f64, q: f64) -> Largest {
    let v = |q: f64| (1.0 - q).max(0.0);
    let s = 0.2f64.clamp(p, q);
    let b = 0.5f64.clamp(p, q);
    Largest {
        value: v(p) * v(p) * v(p),
        slope: 6.0 * s.sqrt() * v(s) * v(s),
        curvature: curvature(3.0 * v(p) * v(p), 3.0 * v(q) * v(q), 6.0 * b * v(b)),
    }
}

#[cfg(test)]
mod tests {
    use super::largest;
    use field::Kernel;

    #[test]
    fn nothing_in_a_shell_is_larger() {
        let mut tight = 0;
        for kernel in Kernel::ALL {
            for i in 0..400 {
                let near = 0.01 * f64::from(i % 200);
                let far = near + [1e-3, 0.03, 0.4, 3.0][i as usize % 4];
                let bound = largest(kernel, near, far);
                let mut most = [0.0f64; 3];
                for k in 0..=64 {
                    let u = near + (far - near) * f64::from(k) / 64.0;
                    let g = kernel.derivatives(u * u).0;
                    let across = 2.0 * g[1];
                    let outward = across + 4.0 * u * u * g[2];
                    most[0] = most[0].max(g[0].abs());
                    most[1] = most[1].max((2.0 * u * g[1]).abs());
                    most[2] = most[2].max(across.abs()).max(outward.abs());
                }
                for (m, b) in most
                    .into_iter()
                    .zip([bound.value, bound.slope, bound.curvature])
                {
                    assert!(
                        m <= b * (1.0 + 1e-9) + 1e-300,
                        "{kernel:?} {near} {far}: {m} {b}"
                    );
                    tight += usize::from(m >= 0.5 * b);
                }
            }
        }
        assert!(tight > 7000, "{tight} of 9600");
    }
}
