//! Normal equations of a least-squares problem, and their solution.

use glam::DVec3;

/// Symmetric matrix A and a right side: `A·x = −g`.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    matrix: Matrix,
    pub gradient: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Matrix {
    /// The rows of the lower triangle.
    Dense(Vec<f64>),
    /// The summands: residuals' derivatives by control points, and entries of all three axes.
    Sparse {
        rows: Vec<(u32, DVec3)>,
        /// Ends of the residuals in `rows`, and their weights.
        ends: Vec<(usize, f64)>,
        alike: Vec<(u32, u32, f64)>,
    },
}

/// Most steps of the conjugate gradients, and the residual at which they end, of that at the start.
const MOST_STEPS: usize = 300;
const EXACT: f64 = 1e-5;

impl Normal {
    /// Makes equations for which each control point may come with all others.
    pub fn dense(size: usize) -> Self {
        Self {
            matrix: Matrix::Dense(vec![0.0; size * (size + 1) / 2]),
            gradient: vec![0.0; size],
        }
    }

    /// Makes equations of very many control points, few of which come together.
    pub fn sparse(size: usize) -> Self {
        Self {
            matrix: Matrix::Sparse {
                rows: Vec::new(),
                ends: Vec::new(),
                alike: Vec::new(),
            },
            gradient: vec![0.0; size],
        }
    }

    fn start(row: usize) -> usize {
        row * (row + 1) / 2
    }

    /// Adds a residual with its derivative by control points (`row`, by number), times a weight.
    pub fn add(&mut self, residual: f64, row: &[(u32, DVec3)], weight: f64) {
        for (i, di) in row {
            for axis in 0..3 {
                self.gradient[3 * *i as usize + axis] += weight * di[axis] * residual;
            }
        }
        let matrix = match &mut self.matrix {
            Matrix::Dense(matrix) => matrix,
            Matrix::Sparse { rows, ends, .. } => {
                rows.extend(row);
                ends.push((rows.len(), weight));
                return;
            }
        };
        for (at, (i, di)) in row.iter().enumerate() {
            for axis in 0..3 {
                let (place, scaled) = (3 * *i as usize + axis, weight * di[axis]);
                let values = &mut matrix[Self::start(place)..];
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
        let (i, j) = (i.max(j), i.min(j));
        match &mut self.matrix {
            Matrix::Dense(matrix) => {
                let (i, j) = (3 * i as usize, 3 * j as usize);
                for axis in 0..3 {
                    matrix[Self::start(i + axis) + j + axis] += value;
                }
            }
            Matrix::Sparse { alike, .. } => alike.push((i, j, value)),
        }
    }

    /// Returns A·x.
    fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; x.len()];
        match &self.matrix {
            Matrix::Dense(matrix) => {
                for i in 0..x.len() {
                    let row = &matrix[Self::start(i)..=Self::start(i) + i];
                    product[i] += dot(row, &x[..=i]);
                    for (value, entry) in product[..i].iter_mut().zip(row) {
                        *value += entry * x[i];
                    }
                }
            }
            Matrix::Sparse { rows, ends, alike } => {
                let mut start = 0;
                for (end, weight) in ends {
                    let row = &rows[start..*end];
                    start = *end;
                    let along = row.iter().map(|(i, d)| d.dot(three(x, *i))).sum::<f64>();
                    for (i, d) in row {
                        add_three(&mut product, *i, *d * (along * weight));
                    }
                }
                for (i, j, value) in alike {
                    add_three(&mut product, *i, three(x, *j) * *value);
                    if i != j {
                        add_three(&mut product, *j, three(x, *i) * *value);
                    }
                }
            }
        }
        product
    }

    /// The decrease of `½·xᵀ·A·x + gᵀ·x` from 0 to x.
    pub fn decrease(&self, x: &[f64]) -> f64 {
        -(0.5 * dot(&self.product(x), x) + dot(&self.gradient, x))
    }

    fn diagonal(&self) -> Vec<f64> {
        let size = self.gradient.len();
        match &self.matrix {
            Matrix::Dense(matrix) => (0..size).map(|i| matrix[Self::start(i) + i]).collect(),
            Matrix::Sparse { rows, ends, alike } => {
                let mut diagonal = vec![0.0; size];
                let mut start = 0;
                for (end, weight) in ends {
                    for (i, d) in &rows[start..*end] {
                        add_three(&mut diagonal, *i, *d * *d * *weight);
                    }
                    start = *end;
                }
                for (i, _, value) in alike.iter().filter(|(i, j, _)| i == j) {
                    add_three(&mut diagonal, *i, DVec3::splat(*value));
                }
                diagonal
            }
        }
    }

    /// Solves `(A + μ·D)·x = −g`, D being A's diagonal and a little of its mean: by Cholesky's
    /// method, or nearly so by conjugate gradients where A is sparse. `None` if the matrix is not
    /// positive definite.
    pub fn solve(&self, damping: f64) -> Option<Vec<f64>> {
        let diagonal = self.diagonal();
        let mean = diagonal.iter().sum::<f64>() / diagonal.len() as f64;
        if !(mean > 0.0 && mean.is_finite()) {
            return None;
        }
        let added = diagonal.iter();
        let added = added.map(|d| damping * (d + 1e-3 * mean) + 1e-12 * mean);
        let added: Vec<f64> = added.collect();
        match &self.matrix {
            Matrix::Dense(matrix) => cholesky(matrix.clone(), &added, &self.gradient),
            Matrix::Sparse { .. } => self.descend(&added, &diagonal),
        }
    }

    /// Solves `(A + added)·x = −g` by conjugate gradients, with the diagonal before it.
    fn descend(&self, added: &[f64], diagonal: &[f64]) -> Option<Vec<f64>> {
        let before: Vec<f64> = added.iter().zip(diagonal).map(|(a, d)| a + d).collect();
        let scaled =
            |r: &[f64]| -> Vec<f64> { r.iter().zip(&before).map(|(r, d)| r / d).collect() };
        let mut x = vec![0.0; before.len()];
        let mut rest: Vec<f64> = self.gradient.iter().map(|g| -g).collect();
        let mut way = scaled(&rest);
        let mut square = dot(&rest, &way);
        let least = EXACT * EXACT * square;
        for _ in 0..MOST_STEPS {
            if square <= least {
                break;
            }
            let mut image = self.product(&way);
            for (value, (a, w)) in image.iter_mut().zip(added.iter().zip(&way)) {
                *value += a * w;
            }
            let length = square / dot(&way, &image);
            if !(length > 0.0 && length.is_finite()) {
                return None;
            }
            for i in 0..x.len() {
                x[i] += length * way[i];
                rest[i] -= length * image[i];
            }
            let next = scaled(&rest);
            let after = dot(&rest, &next);
            for (way, next) in way.iter_mut().zip(next) {
                *way = next + *way * (after / square);
            }
            square = after;
        }
        Some(x)
    }
}

/// Solves `(A + added)·x = −g` with the rows of A's lower triangle.
fn cholesky(mut factor: Vec<f64>, added: &[f64], gradient: &[f64]) -> Option<Vec<f64>> {
    let (size, start) = (gradient.len(), Normal::start);
    for i in 0..size {
        factor[start(i) + i] += added[i];
    }
    for i in 0..size {
        let (before, rest) = factor.split_at_mut(start(i));
        let row = &mut rest[..=i];
        for j in 0..i {
            let other = &before[start(j)..=start(j) + j];
            let sum: f64 = dot(&row[..j], &other[..j]);
            row[j] = (row[j] - sum) / other[j];
        }
        let square = row[i] - dot(&row[..i], &row[..i]);
        if square <= 0.0 || square.is_nan() {
            return None;
        }
        row[i] = square.sqrt();
    }
    let mut x: Vec<f64> = gradient.iter().map(|g| -g).collect();
    for i in 0..size {
        let row = &factor[start(i)..];
        x[i] = (x[i] - dot(&row[..i], &x[..i])) / row[i];
    }
    for i in (0..size).rev() {
        let row = &factor[start(i)..];
        x[i] /= row[i];
        let solved = x[i];
        for (value, entry) in x[..i].iter_mut().zip(row) {
            *value -= entry * solved;
        }
    }
    Some(x)
}

/// Returns the three numbers of a control point.
fn three(x: &[f64], i: u32) -> DVec3 {
    DVec3::from_slice(&x[3 * i as usize..])
}

fn add_three(x: &mut [f64], i: u32, value: DVec3) {
    for (to, from) in x[3 * i as usize..].iter_mut().zip(value.to_array()) {
        *to += from;
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
        for mut normal in [Normal::dense(6), Normal::sparse(6)] {
            let mut before = 0.0;
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
                assert!((x - exact).abs() < 1e-4);
            }
            // Nothing of half the sum of weighted squares is left.
            assert!((normal.decrease(&x) / before - 1.0).abs() < 1e-6);
            assert!(normal.decrease(&[0.0; 6]) == 0.0);
        }
        assert!(Normal::dense(3).solve(1.0).is_none());
        assert!(Normal::sparse(3).solve(1.0).is_none());
    }

    #[test]
    fn both_matrices_are_the_same() {
        let [mut dense, mut sparse] = [Normal::dense(9), Normal::sparse(9)];
        for normal in [&mut dense, &mut sparse] {
            normal.add(0.3, &[(0, DVec3::X), (2, DVec3::new(0.2, -1.0, 0.5))], 1.5);
            normal.add(-1.0, &[(1, DVec3::ONE)], 0.5);
            normal.add_alike(2, 2, 2.0);
            normal.add_alike(1, 2, -0.7);
            normal.add_alike(1, 1, 1.0);
        }
        let x = [0.1, 0.2, -0.3, 0.4, 0.5, -0.6, 0.7, 0.8, 0.9];
        for (a, b) in dense.product(&x).iter().zip(sparse.product(&x)) {
            assert!((a - b).abs() < 1e-14);
        }
        assert_eq!(dense.diagonal(), sparse.diagonal());
        let solved = [dense, sparse].map(|normal| normal.solve(0.1).unwrap());
        for (a, b) in solved[0].iter().zip(&solved[1]) {
            assert!((a - b).abs() < 1e-4);
        }
    }
}
