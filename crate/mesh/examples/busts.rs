//! Writes the meshes of two busts, after figures 3.18 and 3.19 of Sherstyuk's thesis, whose own
//! meshes are lost: a queen with a tall crown, of 1,242 triangles, and an elder with large ears, of
//! 3,422.
//!
//! `cargo run -p mesh --example busts FOLDER` writes FOLDER/queen.obj and FOLDER/elder.obj. A bust
//! is a stack of ovals, lofted smoothly, with bumps and dents that make a face of it. It looks
//! along −y; z is up.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// An oval of the stack: height and y of its middle, its radii to the side, to the front and to the
/// back, and how much higher than the middle its front is, as a slope.
type Oval = [f64; 6];

/// Bump (or, if its height is negative, a dent) that looks outward: angle from the front (both
/// sides get one), height above the ground, half widths of both, and how far it stands out.
type Bump = [f64; 5];

struct Bust {
    name: &'static str,
    ovals: &'static [Oval],
    bumps: &'static [Bump],
    /// Vertices around.
    around: usize,
    /// Rings of vertices between the lowest point and the highest.
    rings: usize,
    /// Strength, below 1, by which vertices are denser in front than behind.
    dense: f64,
    /// Heights at which vertices stand densest: middle, half width, factor.
    face: [f64; 3],
}

const QUEEN: Bust = Bust {
    name: "queen",
    ovals: &[
        [-1.72, 0.34, 0.62, 0.46, 0.46, -0.10],
        [-1.50, 0.32, 0.46, 0.37, 0.40, -0.06],
        [-1.20, 0.26, 0.32, 0.30, 0.32, 0.00],
        [-0.90, 0.18, 0.30, 0.31, 0.33, 0.05],
        [-0.70, 0.10, 0.36, 0.47, 0.38, 0.10],
        [-0.55, 0.04, 0.42, 0.60, 0.46, 0.04],
        [-0.30, 0.00, 0.49, 0.62, 0.56, 0.00],
        [0.00, 0.00, 0.53, 0.61, 0.64, 0.00],
        [0.25, 0.02, 0.55, 0.60, 0.68, 0.04],
        [0.44, 0.05, 0.56, 0.62, 0.70, 0.12],
        [0.52, 0.07, 0.63, 0.69, 0.76, 0.22],
        [0.80, 0.20, 0.69, 0.70, 0.76, 0.32],
        [1.20, 0.40, 0.77, 0.72, 0.78, 0.42],
        [1.60, 0.62, 0.86, 0.76, 0.82, 0.50],
        [1.90, 0.79, 0.92, 0.80, 0.86, 0.55],
        [1.98, 0.83, 0.80, 0.70, 0.75, 0.55],
    ],
    bumps: &[
        // nose: ridge, tip, wings
        [0.0, 0.14, 0.13, 0.16, 0.07],
        [0.0, -0.06, 0.15, 0.13, 0.17],
        [0.17, -0.12, 0.09, 0.06, 0.05],
        // lips, the groove between them, and chin
        [0.0, -0.275, 0.22, 0.045, 0.055],
        [0.0, -0.375, 0.20, 0.045, 0.055],
        [0.0, -0.325, 0.25, 0.022, -0.03],
        [0.0, -0.46, 0.25, 0.05, -0.03],
        [0.0, -0.58, 0.25, 0.09, 0.05],
        // eyes in their sockets, brows, cheekbones
        [0.42, 0.15, 0.24, 0.10, -0.085],
        [0.40, 0.14, 0.15, 0.055, 0.07],
        [0.42, 0.30, 0.30, 0.05, 0.035],
        [0.72, -0.06, 0.28, 0.13, 0.035],
        [0.62, -0.34, 0.25, 0.13, -0.04],
        // ears
        [1.55, 0.02, 0.17, 0.17, 0.09],
    ],
    around: 27,
    rings: 23,
    dense: 0.52,
    face: [-0.05, 0.52, 2.2],
};

const ELDER: Bust = Bust {
    name: "elder",
    ovals: &[
        [-1.50, 0.22, 0.78, 0.56, 0.56, 0.00],
        [-1.32, 0.22, 0.66, 0.50, 0.52, 0.00],
        [-1.05, 0.16, 0.40, 0.36, 0.40, 0.02],
        [-0.85, 0.10, 0.40, 0.42, 0.42, 0.06],
        [-0.68, 0.04, 0.50, 0.58, 0.52, 0.06],
        [-0.45, 0.00, 0.66, 0.68, 0.66, 0.00],
        [-0.20, 0.00, 0.76, 0.70, 0.78, 0.00],
        [0.10, 0.02, 0.82, 0.70, 0.86, 0.00],
        [0.40, 0.05, 0.82, 0.71, 0.88, 0.04],
        [0.65, 0.08, 0.74, 0.66, 0.82, 0.08],
        [0.85, 0.12, 0.58, 0.52, 0.68, 0.10],
        [0.98, 0.15, 0.34, 0.32, 0.42, 0.10],
    ],
    bumps: &[
        // a short, broad nose
        [0.0, -0.02, 0.16, 0.12, 0.10],
        [0.14, -0.07, 0.09, 0.06, 0.05],
        // a wide mouth with thin lips, and a chin
        [0.0, -0.33, 0.42, 0.035, 0.045],
        [0.0, -0.37, 0.46, 0.020, -0.05],
        [0.0, -0.43, 0.38, 0.040, 0.05],
        [0.0, -0.60, 0.26, 0.08, 0.06],
        [0.55, -0.36, 0.12, 0.16, -0.04],
        // large eyes with lids and pouches, under heavy brows
        [0.46, 0.15, 0.28, 0.12, -0.10],
        [0.44, 0.14, 0.19, 0.085, 0.11],
        [0.46, 0.02, 0.24, 0.03, 0.035],
        [0.46, 0.29, 0.34, 0.045, 0.065],
        // folds of the forehead and cheeks
        [0.0, 0.40, 0.60, 0.022, 0.030],
        [0.0, 0.49, 0.60, 0.022, 0.030],
        [0.0, 0.58, 0.55, 0.022, 0.026],
        [0.75, -0.14, 0.25, 0.12, 0.04],
        // ears: long, pointing aside and a little up, hollow in front
        [1.60, 0.08, 0.30, 0.20, 0.42],
        [1.62, 0.11, 0.17, 0.115, 0.50],
        [1.64, 0.14, 0.09, 0.060, 0.42],
        [1.38, 0.08, 0.10, 0.09, -0.22],
    ],
    around: 59,
    rings: 29,
    dense: 0.34,
    face: [0.05, 0.60, 2.0],
};

impl Bust {
    /// Position on the side of the stack: `up` from 0 at the lowest oval to 1 at the highest,
    /// `angle` from the front.
    fn point(&self, up: f64, angle: f64) -> [f64; 3] {
        let [z, y, side, front, back, slope] = oval(self.ovals, up);
        let (sin, cos) = libm::sincos(angle);
        let radius = if cos > 0.0 { front } else { back };
        // Bumps are measured along the oval and added along its radius.
        let height = z + slope * radius * cos;
        let out: f64 = self
            .bumps
            .iter()
            .map(|&[at, level, wide, high, out]| {
                let bump = |at: f64| {
                    let around = (angle - at) / wide;
                    let along = (height - level) / high;
                    libm::exp(-around * around - along * along)
                };
                out * if at == 0.0 {
                    bump(0.0)
                } else {
                    bump(at) + bump(-at)
                }
            })
            .sum();
        [
            (side + out) * sin,
            y - (radius + out) * cos,
            z + slope * radius * cos,
        ]
    }

    /// The mesh as the text of an OBJ file.
    fn obj(&self) -> String {
        let mut text = format!(
            "# {}: {} triangles. It looks along -y, z is up. \
             Made by crate/mesh/examples/busts.rs\n",
            self.name,
            2 * self.around * self.rings
        );
        let rings = self.rings;
        let ups = self.ups(rings);
        let mut put = |[x, y, z]: [f64; 3]| {
            let _ = writeln!(text, "v {x:.3} {y:.3} {z:.3}");
        };
        let pole = |up: f64| {
            let [z, y, ..] = oval(self.ovals, up);
            [0.0, y, z]
        };
        put(pole(0.0));
        for &up in &ups {
            for k in 0..self.around {
                let turn = TAU * k as f64 / self.around as f64;
                let turn = if turn > PI { turn - TAU } else { turn };
                put(self.point(up, turn - self.dense * libm::sin(turn)));
            }
        }
        put(pole(1.0));
        let n = self.around;
        let at = |ring: usize, k: usize| 2 + ring * n + k % n;
        let last = 2 + rings * n;
        for k in 0..n {
            let _ = writeln!(text, "f 1 {} {}", at(0, k + 1), at(0, k));
            for ring in 1..rings {
                let [a, b] = [at(ring - 1, k), at(ring - 1, k + 1)];
                let [c, d] = [at(ring, k), at(ring, k + 1)];
                let _ = writeln!(text, "f {a} {b} {d}\nf {a} {d} {c}");
            }
            let top = rings - 1;
            let _ = writeln!(text, "f {} {} {last}", at(top, k), at(top, k + 1));
        }
        text
    }

    /// Places of the rings on the stack, denser at the face.
    fn ups(&self, rings: usize) -> Vec<f64> {
        let [middle, wide, factor] = self.face;
        let weight = |up: f64| {
            let off = (oval(self.ovals, up)[0] - middle) / wide;
            1.0 + (factor - 1.0) * libm::exp(-off.powi(4))
        };
        let steps = 4000;
        let sums: Vec<f64> = (0..=steps)
            .scan(0.0, |sum, k| {
                let before = *sum;
                *sum += weight(f64::from(k) / f64::from(steps));
                Some(before)
            })
            .collect();
        let whole = sums[sums.len() - 1];
        (0..rings)
            .map(|ring| {
                let wanted = whole * ring as f64 / (rings - 1) as f64;
                let k = sums.partition_point(|&sum| sum < wanted);
                k.min(sums.len() - 1) as f64 / f64::from(steps)
            })
            .collect()
    }
}

/// An oval of the stack by a Catmull–Rom spline through all of them.
fn oval(ovals: &[Oval], up: f64) -> Oval {
    let last = ovals.len() - 1;
    let place = up.clamp(0.0, 1.0) * last as f64;
    let k = (place as usize).min(last - 1);
    let t = place - k as f64;
    let [a, b, c, d] = [k.saturating_sub(1), k, k + 1, (k + 2).min(last)].map(|k| ovals[k]);
    std::array::from_fn(|i| {
        let (from, to) = (0.5 * (c[i] - a[i]), 0.5 * (d[i] - b[i]));
        let (t2, t3) = (t * t, t * t * t);
        b[i] * (2.0 * t3 - 3.0 * t2 + 1.0)
            + from * (t3 - 2.0 * t2 + t)
            + c[i] * (3.0 * t2 - 2.0 * t3)
            + to * (t3 - t2)
    })
}

fn main() -> std::io::Result<()> {
    let Some(folder) = std::env::args_os().nth(1).map(std::path::PathBuf::from) else {
        eprintln!("usage: busts FOLDER");
        std::process::exit(2);
    };
    for bust in [QUEEN, ELDER] {
        std::fs::write(folder.join(bust.name).with_extension("obj"), bust.obj())?;
    }
    Ok(())
}
