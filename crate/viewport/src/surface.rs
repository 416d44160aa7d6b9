//! Triangles to be drawn.

use glam::Vec3;

/// Triangles that share vertices by index, with edges of their own.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Vertices.
    pub positions: Vec<Vec3>,
    /// Normals of the vertices, of length 1.
    pub normals: Vec<Vec3>,
    /// Colours of the vertices as shown, 0 … 1.
    pub colors: Vec<[f32; 3]>,
    /// Triangles of three indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The triangles that stand out, if any do.
    pub chosen: Vec<bool>,
    /// Edges of the wireframe.
    pub edges: Vec<[u32; 2]>,
    /// Whether it has an inside, so that no triangle is seen from behind.
    pub is_closed: bool,
}

impl Surface {
    /// Sets the normals to the sums of those of the triangles by area.
    pub fn smooth(&mut self) {
        self.normals.clear();
        self.normals.resize(self.positions.len(), Vec3::ZERO);
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|i| self.positions[i as usize]);
            let normal = (b - a).cross(c - a);
            for i in triangle {
                self.normals[*i as usize] += normal;
            }
        }
        for normal in &mut self.normals {
            *normal = normal.normalize_or(Vec3::Z);
        }
    }

    /// The box around it; `None` without vertices.
    #[must_use]
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        let first = *self.positions.first()?;
        let points = self.positions.iter();
        Some(points.fold([first; 2], |[low, high], p| [low.min(*p), high.max(*p)]))
    }
}
