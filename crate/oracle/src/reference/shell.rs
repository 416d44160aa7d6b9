//! Bounds on a kernel, its slope and its curvature in a shell of distances.
//!
//! A kernel is G(q) with q the squared distance in kernel widths. The slope of `h(r) = G(r²)` is
//! `2rG′`, and the matrix of second derivatives of `h(|x|)` has the eigenvalues `2G′` (across) and
//! `2G′ + 4qG″` (outward). G and −G′ fall; `√q·G′` and `q·G″` rise to one peak and fall, so that
//! their largest value in a shell is at the peak, or at the end of the shell that is nearer to it.
use field::Kernel;
use std::sync::OnceLock;

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

/// Computes G, −G′ and G″; at a kink those of the piece where G″ is larger.
fn kernel(kernel: Kernel, q: f64) -> [f64; 3] {
    // The ε² of a rounded pole (see [`Kernel`]).
    let pole = 1.0 / (q + 1e-10);
    let (root, i, v) = (pole.sqrt(), 1.0 / (1.0 + q), 1.0 - q);
    match kernel {
        Kernel::Cauchy => [1.0, 2.0 * i, 6.0 * i * i].map(|x| x * i * i),
        Kernel::Gauss => [libm::exp(-q); 3],
        Kernel::Inverse => [root, 0.5 * root * pole, 0.75 * root * pole * pole],
        Kernel::Squared => [pole, pole * pole, 2.0 * pole * pole * pole],
        Kernel::Cubed => [1.0, 1.5 * pole, 3.75 * pole * pole].map(|x| x * root * pole),
        Kernel::Metaballs | Kernel::Soft | Kernel::Quartic | Kernel::Compact6 if q > 1.0 => {
            [0.0; 3]
        }
        Kernel::Metaballs if q < 1.0 / 9.0 => [1.0 - 3.0 * q, 3.0, 0.0],
        Kernel::Metaballs => {
            let u = q.sqrt();
            [1.5 * (1.0 - u) * (1.0 - u), 1.5 / u - 1.5, 0.75 / (u * q)]
        }
        Kernel::Quartic => [v * v, 2.0 * v, 2.0],
        Kernel::Compact6 => [v * v * v, 3.0 * v * v, 6.0 * v],
        Kernel::Soft => [
            (5.0 + 4.0 * v) * v * v,
            (10.0 + 12.0 * v) * v,
            10.0 + 24.0 * v,
        ]
        .map(|x| x / 9.0),
    }
}

/// Returns the places q of the peaks of `√q·G′` and of `q·G″`.
fn peaks(of: Kernel) -> [f64; 2] {
    static PEAKS: OnceLock<Vec<[f64; 2]>> = OnceLock::new();
    let all = PEAKS.get_or_init(|| {
        let find = Kernel::ALL.iter().map(|of| {
            [
                peak(&|q| q.sqrt() * kernel(*of, q)[1]),
                peak(&|q| q * kernel(*of, q)[2]),
            ]
        });
        find.collect()
    });
    all[of as usize]
}

/// Returns the place of a function's peak between 10⁻¹⁴ and 1.
fn peak(f: &dyn Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (1e-14, 1.0);
    for _ in 0..400 {
        // The function may be 0 up to the peak.
        let ratio = libm::cbrt(high / low);
        if f(low * ratio) <= f(high / ratio) {
            low *= ratio;
        } else {
            high /= ratio;
        }
    }
    if f(low) < f(high) { high } else { low }
}

/// Returns the bounds between two distances in units of the kernel's width.
pub fn largest(of: Kernel, near: f64, far: f64) -> Largest {
    let (p, q) = (near * near, far * far);
    let [steepest, most_bent] = peaks(of).map(|peak| peak.clamp(p, q));
    let [value, first, _] = kernel(of, p);
    let [_, last, _] = kernel(of, q);
    // The second derivatives are `−2g` and `−2g + 4b`, where g falls from `first` to `last`.
    let bent = most_bent * kernel(of, most_bent)[2];
    Largest {
        value,
        slope: 2.0 * steepest.sqrt() * kernel(of, steepest)[1],
        curvature: (2.0 * first).max(4.0 * bent - 2.0 * last),
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
                    let g = kernel.derivatives(u * u);
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
