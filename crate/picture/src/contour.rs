//! Lines of equal value on a grid of samples, by marching squares.

/// Values at the corners of a grid's cells, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid {
    /// Columns of samples.
    pub width: usize,
    /// Rows of samples.
    pub height: usize,
    /// The samples; row 0 first.
    pub values: Vec<f32>,
}

impl Grid {
    fn get(&self, x: usize, y: usize) -> f32 {
        self.values[y * self.width + x]
    }

    /// Finds the pieces of the line on which the value is `level`, in units of samples. A saddle is
    /// cut by the mean of its corners.
    #[must_use]
    pub fn line(&self, level: f32) -> Vec<[[f32; 2]; 2]> {
        let mut pieces = Vec::new();
        if self.values.len() < self.width * self.height {
            return pieces;
        }
        for y in 0..self.height.saturating_sub(1) {
            for x in 0..self.width.saturating_sub(1) {
                let corners = [
                    self.get(x, y),
                    self.get(x + 1, y),
                    self.get(x + 1, y + 1),
                    self.get(x, y + 1),
                ];
                cell(corners, level, [x as f32, y as f32], &mut pieces);
            }
        }
        pieces
    }

    /// Finds the pieces of the sheets on which two bodies in contact touch: where the leading body
    /// changes, and both their fields are `level`. `leading` has the leading body at each sample
    /// and its lead.
    #[must_use]
    pub fn border(&self, leading: &[(u32, f32)], level: f32) -> Vec<[[f32; 2]; 2]> {
        let mut pieces = Vec::new();
        if leading.len() < self.width * self.height || self.values.len() < leading.len() {
            return pieces;
        }
        for y in 0..self.height.saturating_sub(1) {
            for x in 0..self.width.saturating_sub(1) {
                let corners = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
                let at = corners.map(|[x, y]| y * self.width + x);
                // Beside a sheet a field is above its level by half of what it leads by.
                let is_sheet = at.iter().all(|i| {
                    let (_, apart) = leading[*i];
                    let off = self.values[*i] - level - 0.5 * apart;
                    apart.is_finite() && off.abs() < 0.03 * (1.0 + apart)
                });
                if !is_sheet || at.iter().all(|i| leading[*i].0 == leading[at[0]].0) {
                    continue;
                }
                let mut crossings = Vec::new();
                for side in 0..4 {
                    let [a, b] = [side, (side + 1) % 4];
                    let ((first, here), (second, there)) = (leading[at[a]], leading[at[b]]);
                    if first != second {
                        let t = here / (here + there).max(f32::MIN_POSITIVE);
                        let [p, q] = [corners[a], corners[b]].map(|p| p.map(|c| c as f32));
                        crossings.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
                    }
                }
                match crossings[..] {
                    [p, q] => pieces.push([p, q]),
                    // Three bodies meet.
                    _ => {
                        let middle = [x as f32 + 0.5, y as f32 + 0.5];
                        pieces.extend(crossings.iter().map(|p| [*p, middle]));
                    }
                }
            }
        }
        pieces
    }

    /// Returns polygons that cover the area where the value is above `level`, in units of samples:
    /// one for each run of cells that lie inside as a whole, one for each cell that the line
    /// crosses.
    #[must_use]
    pub fn inside(&self, level: f32) -> Vec<Vec<[f32; 2]>> {
        let mut polygons = Vec::new();
        if self.values.len() < self.width * self.height {
            return polygons;
        }
        for y in 0..self.height.saturating_sub(1) {
            let mut run: Option<usize> = None;
            for x in 0..self.width - 1 {
                let corners = [
                    ([x, y], self.get(x, y)),
                    ([x + 1, y], self.get(x + 1, y)),
                    ([x + 1, y + 1], self.get(x + 1, y + 1)),
                    ([x, y + 1], self.get(x, y + 1)),
                ];
                let above = corners.iter().filter(|(_, value)| *value > level).count();
                if above == 4 {
                    run.get_or_insert(x);
                    continue;
                }
                if let Some(from) = run.take() {
                    polygons.push(strip(from, x, y));
                }
                if above > 0 {
                    polygons.push(cut(corners, level));
                }
            }
            if let Some(from) = run {
                polygons.push(strip(from, self.width - 1, y));
            }
        }
        polygons
    }
}

/// Returns the cells of a row from one column to another, as one rectangle.
fn strip(from: usize, to: usize, row: usize) -> Vec<[f32; 2]> {
    let [l, r, t] = [from as f32, to as f32, row as f32];
    vec![[l, t], [r, t], [r, t + 1.0], [l, t + 1.0]]
}

/// Returns the part of a cell that is above the level.
fn cut(corners: [([usize; 2], f32); 4], level: f32) -> Vec<[f32; 2]> {
    let mut polygon = Vec::with_capacity(6);
    for side in 0..4 {
        let (a, value) = corners[side];
        let (b, next) = corners[(side + 1) % 4];
        let [a, b] = [a, b].map(|p| p.map(|c| c as f32));
        if value > level {
            polygon.push(a);
        }
        if (value > level) != (next > level) {
            let t = (level - value) / (next - value);
            polygon.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
        }
    }
    polygon
}

/// Adds the pieces of the line in a cell, whose corners go around it from its origin.
fn cell(corners: [f32; 4], level: f32, [x, y]: [f32; 2], pieces: &mut Vec<[[f32; 2]; 2]>) {
    const PLACES: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let above = corners.map(|value| value > level);
    if corners.iter().any(|value| !value.is_finite()) {
        return;
    }
    // The places where the line crosses the sides, in order around the cell.
    let mut crossings = [[0.0; 2]; 4];
    let mut count = 0;
    for side in 0..4 {
        let next = (side + 1) % 4;
        if above[side] != above[next] {
            let t = (level - corners[side]) / (corners[next] - corners[side]);
            let [a, b] = [PLACES[side], PLACES[next]];
            crossings[count] = [x + a[0] + t * (b[0] - a[0]), y + a[1] + t * (b[1] - a[1])];
            count += 1;
        }
    }
    match count {
        2 => pieces.push([crossings[0], crossings[1]]),
        4 => {
            let middle = corners.iter().sum::<f32>() / 4.0 > level;
            // Corner 0 is cut off by itself where the middle is on the other side.
            if middle == above[0] {
                pieces.push([crossings[0], crossings[1]]);
                pieces.push([crossings[2], crossings[3]]);
            } else {
                pieces.push([crossings[3], crossings[0]]);
                pieces.push([crossings[1], crossings[2]]);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_found() {
        let (width, height) = (41, 31);
        let values = (0..width * height)
            .map(|i| {
                let (x, y) = ((i % width) as f32 - 20.0, (i / width) as f32 - 15.0);
                (x * x + y * y).sqrt()
            })
            .collect();
        let grid = Grid {
            width,
            height,
            values,
        };
        let line = grid.line(10.0);
        let mut length = 0.0;
        for [a, b] in &line {
            for p in [a, b] {
                let r = ((p[0] - 20.0).powi(2) + (p[1] - 15.0).powi(2)).sqrt();
                assert!((r - 10.0).abs() < 0.02, "{r}");
            }
            length += ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt();
        }
        assert!((length - 20.0 * core::f32::consts::PI).abs() < 0.3);
        assert!(grid.line(100.0).is_empty());
        // Inside the circle the value is below; the rest of the rectangle is above.
        let area: f32 = grid
            .inside(10.0)
            .iter()
            .map(|polygon| {
                (0..polygon.len())
                    .map(|i| (polygon[i], polygon[(i + 1) % polygon.len()]))
                    .map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0]))
                    .sum::<f32>()
            })
            .sum();
        assert!(
            (area - (1200.0 - 100.0 * core::f32::consts::PI)).abs() < 2.0,
            "{area}"
        );
    }

    #[test]
    fn saddles_do_not_cross() {
        fn line(values: [f32; 4]) -> Vec<[[f32; 2]; 2]> {
            let grid = Grid {
                width: 2,
                height: 2,
                values: values.to_vec(),
            };
            grid.line(0.3)
        }
        // Row by row: corners 0, 1, then 3, 2.
        for values in [
            [1.0, 0.0, 0.0, 1.0],
            [0.9, 0.0, 0.0, 0.2],
            [0.0, 1.0, 0.4, 0.0],
        ] {
            let line = line(values);
            assert_eq!(
                line.len(),
                if values[3] == 0.2 { 1 } else { 2 },
                "{values:?}"
            );
        }
        let line = line([f32::NAN, 0.0, 0.0, 1.0]);
        assert!(line.is_empty());
    }
}
