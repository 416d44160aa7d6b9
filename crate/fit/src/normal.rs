//! Normal equations of a least-squares problem, and their solution.

use glam::DVec3;

/// Symmetric matrix, kept as the rows of its lower triangle, and a right side:
/// `A·x = −g`.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    size: usize,
    matrix: Vec<f64>,
    pub gradient: Vec<f64>,
}

impl Normal {
    pub fn new(size: usize) -> Self {
        Self {
            size,
            matrix: vec![0.0; size * (size + 1) / 2],
            gradient: vec![0.0; size],
        }
    }

    fn start(row: usize) -> usize {
        row * (row + 1) / 2
    }

    /// Adds a residual with its derivative by control points (`row`, by number), times a weight.
    pub fn add(&mut self, residual: f64, row: &[(u32, DVec3)], weight: f64) {
        for (at, (i, di)) in row.iter().enumerate() {
            for axis in 0..3 {
                let (place, scaled) = (3 * *i as usize + axis, weight * di[axis]);
                self.gradient[place] += scaled * residual;
                let values = &mut self.matrix[Self::start(place)..];
                for (j, dj) in &row[..at] {
                    let first = 3 * *j as usize;
                    for other in 0..3 {
                        values[first + other] += scaled * dj[other];
                    }
                }
                let first = 3 * *i as usize;
                for other in 0..=axis {
                    values[first + other] += scaled * di[other];
                }
            }
        }
    }

    /// Adds to an entry of all three axes, which the others do not mix with.
    pub fn add_alike(&mut self, i: u32, j: u32, value: f64) {
        let (i, j) = (i.max(j) as usize, i.min(j) as usize);
        for axis in 0..3 {
            self.matrix[Self::start(3 * i + axis) + 3 * j + axis] += value;
        }
    }

    /// The decrease of `½·xᵀ·A·x + gᵀ·x` from 0 to x.
    pub fn decrease(&self, x: &[f64]) -> f64 {
        -(0..self.size)
            .map(|i| {
                let entries = &self.matrix[Self::start(i)..=Self::start(i) + i];
                let half: f64 = dot(&entries[..i], &x[..i]) + 0.5 * entries[i] * x[i];
                x[i] * (half + self.gradient[i])
            })
            .sum::<f64>()
    }

    /// The sum of the diagonal.
    pub fn trace(&self) -> f64 {
        (0..self.size)
            .map(|i| self.matrix[Self::start(i) + i])
            .sum()
    }

    /// Solves `(A + μ·D)·x = −g` by Cholesky's method, D being A's diagonal and a little of its
    /// mean. `None` if the matrix is not positive definite.
    pub fn solve(&self, damping: f64) -> Option<Vec<f64>> {
        let size = self.size;
        let mut factor = self.matrix.clone();
        let mean = self.trace() / size as f64;
        if !(mean > 0.0 && mean.is_finite()) {
            return None;
        }
        for i in 0..size {
            let diagonal = &mut factor[Self::start(i) + i];
            *diagonal += damping * (*diagonal + 1e-3 * mean) + 1e-12 * mean;
        }
        for i in 0..size {
            let (before, rest) = factor.split_at_mut(Self::start(i));
            let row = &mut rest[..=i];
            for j in 0..i {
                let other = &before[Self::start(j)..=Self::start(j) + j];
                let sum: f64 = dot(&row[..j], &other[..j]);
                row[j] = (row[j] - sum) / other[j];
            }
            let square = row[i] - dot(&row[..i], &row[..i]);
            if square <= 0.0 || square.is_nan() {
                return None;
            }
            row[i] = square.sqrt();
        }
        let mut x: Vec<f64> = self.gradient.iter().map(|g| -g).collect();
        for i in 0..size {
            let row = &factor[Self::start(i)..];
            x[i] = (x[i] - dot(&row[..i], &x[..i])) / row[i];
        }
        for i in (0..size).rev() {
            let row = &factor[Self::start(i)..];
            x[i] /= row[i];
            let solved = x[i];
            for (value, entry) in x[..i].iter_mut().zip(row) {
                *value -= entry * solved;
            }
        }
        Some(x)
    }
}

/// Returns a sum of products, in four partial sums.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (four_a, four_b) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = four_a
        .remainder()
        .iter()
        .zip(four_b.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in four_a.zip(four_b) {
        for i in 0..4 {
            sums[i] += x[i] * y[i];
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_equations_are_solved() {
        // Residuals a·x − b of known x have their least sum there.
        let exact = [1.0, -2.0, 0.5, 3.0, 0.25, -1.5];
        let (mut normal, mut before) = (Normal::new(6), 0.0);
        for i in 0..40 {
            let t = f64::from(i);
            let row = [0, 1].map(|k| {
                let s = t + 7.3 * f64::from(k);
                let way = DVec3::new(libm::sin(s), libm::cos(1.3 * s), libm::sin(2.1 * s));
                (k, way)
            });
            let value: f64 = row
                .iter()
                .map(|(k, way)| way.dot(DVec3::from_slice(&exact[3 * *k as usize..])))
                .sum();
            normal.add(-value, &row, 2.0);
            before += value * value;
        }
        let x = normal.solve(0.0).expect("a positive definite matrix");
        for (x, exact) in x.iter().zip(exact) {
            assert!((x - exact).abs() < 1e-9);
        }
        // Nothing of half the sum of weighted squares is left.
        assert!((normal.decrease(&x) / before - 1.0).abs() < 1e-9);
        assert!(normal.decrease(&[0.0; 6]) == 0.0);
        assert!(Normal::new(3).solve(1.0).is_none());
    }
}
