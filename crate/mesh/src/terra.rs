//! Height field: a grid of heights as a smooth surface.

use crate::error::{Error, fail};
use crate::heights::Heights;
use crate::limits::MAX_TERRA;
use crate::triangle_mesh::TriangleMesh;
use core::ops::RangeInclusive;
use glam::DVec3;

/// The surface over the rectangle from the origin to `size.x`, `size.y`, with heights from 0 to
/// `size.z`: the picture's left edge is x = 0, its lower edge is y = 0, and white is `size.z` high.
/// It has normals, so that it is lit as a smooth surface.
///
/// A picture of more than 257 × 257 pixels, or as many in other proportions, would have more than
/// [`MAX_TERRA`] triangles: it is averaged to a smaller grid.
///
/// # Errors
/// If the picture has a single row or column, or a size is not a positive number.
pub fn terra(heights: &Heights, size: DVec3) -> Result<TriangleMesh, Error> {
    if !size.is_finite() || size.min_element() <= 0.0 {
        return fail("a height field needs a size above 0 in all three directions");
    }
    let (columns, rows) = (heights.width() - 1, heights.height() - 1);
    if columns == 0 || rows == 0 {
        return fail("a height field needs a picture of at least two by two pixels");
    }
    let [across, down] = cells(columns, rows);
    let grid = Grid {
        across,
        down,
        size,
        values: average(heights, across, down),
    };
    let mut mesh = TriangleMesh::default();
    let mut normals = Vec::with_capacity(grid.values.len());
    for j in 0..=down {
        for i in 0..=across {
            mesh.add_vertex(grid.place(i, j))?;
            normals.push(grid.normal(i, j));
        }
    }
    mesh.normals = Some(normals);
    for j in 0..down {
        for i in 0..across {
            let a = (j * (across + 1) + i) as u32;
            let d = a + across as u32 + 1;
            let [b, c] = [a + 1, d + 1];
            mesh.add_triangle([a, d, b])?;
            mesh.add_triangle([b, d, c])?;
        }
    }
    Ok(mesh)
}

/// Cells of the grid across and down: the picture's, or fewer in the same proportions.
fn cells(columns: usize, rows: usize) -> [usize; 2] {
    let most = MAX_TERRA / 2;
    if columns * rows <= most {
        return [columns, rows];
    }
    let shrink = (most as f64 / (columns as f64 * rows as f64)).sqrt();
    let [across, down] = [columns, rows].map(|n| ((n as f64 * shrink) as usize).max(1));
    // Of a very long strip one side is a single cell, which leaves fewer for the other.
    let across = across.min(most / down);
    [across, down.min(most / across)]
}

/// The heights at the corners of a grid: the mean of the pixels nearer to a corner than to the
/// next.
fn average(heights: &Heights, across: usize, down: usize) -> Vec<f64> {
    let mut values = Vec::with_capacity((across + 1) * (down + 1));
    for j in 0..=down {
        for i in 0..=across {
            let (mut sum, mut count) = (0.0, 0.0);
            for y in pixels_near(j, down, heights.height()) {
                for x in pixels_near(i, across, heights.width()) {
                    sum += f64::from(heights.at(x, y));
                    count += 1.0;
                }
            }
            values.push(sum / count);
        }
    }
    values
}

/// Returns the pixels nearer to a corner than to the next, of a row of so many cells.
fn pixels_near(i: usize, cells: usize, pixels: usize) -> RangeInclusive<usize> {
    // Pixels lie at the corners of as many cells as there are steps between them.
    let step = (pixels - 1) as f64 / cells as f64;
    let first = ((i as f64 - 0.5) * step).ceil().max(0.0) as usize;
    let last = ((i as f64 + 0.5) * step).floor() as usize;
    let last = last.min(pixels - 1);
    first.min(last)..=last
}

struct Grid {
    across: usize,
    down: usize,
    size: DVec3,
    /// Heights at the corners of the cells, 0 … 1, row by row from the top.
    values: Vec<f64>,
}

impl Grid {
    fn place(&self, i: usize, j: usize) -> DVec3 {
        let x = i as f64 / self.across as f64;
        let y = 1.0 - j as f64 / self.down as f64;
        self.size * DVec3::new(x, y, self.values[j * (self.across + 1) + i])
    }

    /// Returns the unit vector across the lines between the neighbours on both sides; at an edge of
    /// the grid the corner itself stands for the missing neighbour.
    fn normal(&self, i: usize, j: usize) -> DVec3 {
        let [left, right] = [i.saturating_sub(1), (i + 1).min(self.across)];
        let [above, below] = [j.saturating_sub(1), (j + 1).min(self.down)];
        let along = self.place(right, j) - self.place(left, j);
        let up = self.place(i, above) - self.place(i, below);
        along.cross(up).normalize_or(DVec3::Z)
    }
}
