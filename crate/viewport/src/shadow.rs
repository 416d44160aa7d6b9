//! The shadow of a tool: a depth map seen along the light.

use crate::surface::Surface;
use glam::Vec3;

/// Cells along each side.
const SIDE: usize = 160;

/// The map of the shadow that a surface casts.
pub struct Shadow {
    axes: [Vec3; 3],
    /// The middle, and cells of a length.
    middle: Vec3,
    scale: f32,
    /// The farthest place along the light in each cell that is covered.
    far: Vec<f32>,
}

impl Shadow {
    /// The shadow of a surface moved by `place`, in light that comes from a direction.
    pub fn of(surface: &Surface, place: Vec3, light: Vec3) -> Self {
        let light = light.normalize_or(Vec3::Z);
        let a = light.any_orthonormal_vector();
        let axes = [a, light.cross(a), light];
        let reach = surface.positions.iter().map(|p| p.length());
        let reach = reach.fold(1e-9, f32::max);
        let mut shadow = Self {
            axes,
            middle: place,
            scale: 0.5 * (SIDE as f32 - 4.0) / reach,
            far: vec![f32::NEG_INFINITY; SIDE * SIDE],
        };
        let flat: Vec<[f32; 3]> = surface.positions.iter().map(|p| shadow.local(*p)).collect();
        for triangle in &surface.triangles {
            shadow.cover(triangle.map(|i| flat[i as usize]));
        }
        shadow
    }

    /// Cell coordinates, and the place along the light.
    fn local(&self, p: Vec3) -> [f32; 3] {
        let [x, y, z] = self.axes.map(|axis| axis.dot(p));
        let middle = 0.5 * SIDE as f32;
        [middle + x * self.scale, middle + y * self.scale, z]
    }

    fn cover(&mut self, [a, b, c]: [[f32; 3]; 3]) {
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area.abs() < 1e-6 {
            return;
        }
        let [columns, rows] = [0, 1].map(|k| {
            let (low, high) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
            (low.ceil().max(0.0) as usize)..=(high.floor().clamp(0.0, SIDE as f32 - 1.0) as usize)
        });
        for y in rows {
            for x in columns.clone() {
                let (px, py) = (x as f32, y as f32);
                let u = ((c[0] - b[0]) * (py - b[1]) - (c[1] - b[1]) * (px - b[0])) / area;
                let v = ((a[0] - c[0]) * (py - c[1]) - (a[1] - c[1]) * (px - c[0])) / area;
                let w = 1.0 - u - v;
                if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                    let far = &mut self.far[y * SIDE + x];
                    *far = far.max(u * a[2] + v * b[2] + w * c[2]);
                }
            }
        }
    }

    /// Returns the share of light that is kept from a point, 0 … 1, soft at the edges.
    pub fn at(&self, point: Vec3) -> f32 {
        let [x, y, z] = self.local(point - self.middle);
        let most = SIDE as f32 - 2.0;
        if !(x >= 1.0 && y >= 1.0 && x < most && y < most) {
            return 0.0;
        }
        let (i, j) = (x as usize, y as usize);
        let (fx, fy) = (x - i as f32, y - j as f32);
        let [top, bottom] = [j, j + 1].map(|j| {
            let [left, right] = [i, i + 1].map(|i| f32::from(u8::from(self.far[j * SIDE + i] > z)));
            left * (1.0 - fx) + right * fx
        });
        top * (1.0 - fy) + bottom * fy
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_darkens_what_is_behind_it() {
        let square = Surface {
            positions: vec![
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Surface::default()
        };
        let shadow = Shadow::of(&square, Vec3::new(5.0, 0.0, 2.0), Vec3::Z);
        assert_eq!(shadow.at(Vec3::new(5.2, 0.3, 0.0)), 1.0);
        assert_eq!(
            shadow.at(Vec3::new(5.2, 0.3, 3.0)),
            0.0,
            "between it and the light"
        );
        assert_eq!(shadow.at(Vec3::new(6.3, 0.3, 0.0)), 0.0, "beside it");
        assert_eq!(shadow.at(Vec3::new(60.0, 0.3, 0.0)), 0.0, "far away");
    }

    fn corner(x: f32, y: f32) -> Vec3 {
        Vec3::new(x, y, 0.0)
    }
}
