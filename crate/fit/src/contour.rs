//! Outlines made of what can be seen: marching squares.

use crate::outlines::Outline;
use glam::DVec3;
use std::collections::BTreeMap;

/// Halvings of the place where an outline crosses a grid line.
const HALVINGS: u32 = 12;

/// The crossing of a grid line: from the node in a column and row, to the right or downwards.
type Crossing = (u32, u32, bool);

impl Outline {
    /// Sets the lines to the border of what is seen, at places where it crosses a grid of this many
    /// pixels. `is_seen` says whether a ray from a point in a direction meets anything.
    pub fn trace(&mut self, spacing: f64, is_seen: &mut dyn FnMut(DVec3, DVec3) -> bool) {
        self.lines.clear();
        let [columns, rows] = self.size.map(|s| (s / spacing).floor().max(1.0) as u32);
        let eye = DVec3::from_array(self.eye);
        let camera = self.clone();
        let mut seen = |pixel: [f64; 2]| {
            camera
                .direction(pixel)
                .is_some_and(|direction| is_seen(eye, direction))
        };
        let place = |column: u32, row: u32| [f64::from(column) * spacing, f64::from(row) * spacing];
        let mut nodes = Vec::new();
        for row in 0..=rows {
            nodes.extend((0..=columns).map(|column| seen(place(column, row))));
        }
        let node = |column: u32, row: u32| nodes[(row * (columns + 1) + column) as usize];
        let mut links: BTreeMap<Crossing, Vec<Crossing>> = BTreeMap::new();
        for row in 0..rows {
            for column in 0..columns {
                let corners = [
                    node(column, row),
                    node(column + 1, row),
                    node(column + 1, row + 1),
                    node(column, row + 1),
                ];
                let sides = [
                    (column, row, true),
                    (column + 1, row, false),
                    (column, row + 1, true),
                    (column, row, false),
                ];
                let crossed: Vec<Crossing> = (0..4)
                    .filter(|i| corners[*i] != corners[(i + 1) % 4])
                    .map(|i| sides[i])
                    .collect();
                for pair in crossed.chunks_exact(2) {
                    links.entry(pair[0]).or_default().push(pair[1]);
                    links.entry(pair[1]).or_default().push(pair[0]);
                }
            }
        }
        let mut cut = |(column, row, right): Crossing| {
            let (to_column, to_row) = if right {
                (column + 1, row)
            } else {
                (column, row + 1)
            };
            let (mut inside, mut outside) = (place(column, row), place(to_column, to_row));
            if !node(column, row) {
                (inside, outside) = (outside, inside);
            }
            for _ in 0..HALVINGS {
                let middle = [0, 1].map(|i| 0.5 * (inside[i] + outside[i]));
                *(if seen(middle) {
                    &mut inside
                } else {
                    &mut outside
                }) = middle;
            }
            [0, 1].map(|i| 0.5 * (inside[i] + outside[i]))
        };
        // Open lines first, from an end, then closed ones.
        for ends in [1, 2] {
            while let Some(start) = links
                .iter()
                .find(|(_, next)| !next.is_empty() && next.len() <= ends)
                .map(|(crossing, _)| *crossing)
            {
                let mut line = vec![cut(start)];
                let mut at = start;
                while let Some(next) = links.get_mut(&at).and_then(Vec::pop) {
                    if let Some(back) = links.get_mut(&next) {
                        back.retain(|crossing| *crossing != at);
                    }
                    line.push(cut(next));
                    at = next;
                }
                self.lines.push(line);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ball_has_a_circle_for_its_outline() {
        let mut outline = Outline {
            eye: [0.0, -5.0, 0.0],
            target: [0.0; 3],
            up: [0.0, 0.0, 1.0],
            fov: 40.0,
            size: [200.0, 160.0],
            lines: Vec::new(),
        };
        outline.trace(10.0, &mut |eye, way| eye.cross(way).length() < 1.0);
        assert_eq!(outline.lines.len(), 1);
        let line = &outline.lines[0];
        assert_eq!(line[0], line[line.len() - 1]);
        assert!(line.len() > 30);
        for pixel in line {
            let way = outline.direction(*pixel).unwrap();
            assert!((DVec3::new(0.0, -5.0, 0.0).cross(way).length() - 1.0).abs() < 1e-3);
        }
        // One that leaves the picture is open.
        outline.target = [1.8, 0.0, 0.0];
        outline.trace(10.0, &mut |eye, way| eye.cross(way).length() < 1.0);
        assert_eq!(outline.lines.len(), 1);
        assert_ne!(outline.lines[0].first(), outline.lines[0].last());
        outline.trace(10.0, &mut |_, _| false);
        assert!(outline.lines.is_empty());
    }
}
