//! A part of a plane in a figure.

use egui::{Color32, Mesh, Painter, Pos2, Rect, Shape, vec2};

/// Map between a part of a plane and the screen.
pub struct Plane {
    center: Pos2,
    scale: f32,
    half: [f64; 2],
    samples: [usize; 2],
}

impl Plane {
    /// Fits the part of the plane within `half` of the middle into a rectangle. Fields have this
    /// number of samples across and up.
    pub fn new(place: Rect, half: [f64; 2], samples: [usize; 2]) -> Self {
        let [across, up] = half.map(|half| 2.0 * half as f32);
        Self {
            center: place.center(),
            scale: (place.width() / across).min(place.height() / up),
            half,
            samples,
        }
    }

    /// Fits it into a panel with a title.
    pub fn below_title(panel: Rect, half: [f64; 2], samples: [usize; 2]) -> Self {
        let inner = panel.shrink2(vec2(8.0, 6.0));
        Self::new(inner.with_min_y(panel.top() + 26.0), half, samples)
    }

    /// Converts a place of the plane.
    pub fn at(&self, [x, y]: [f64; 2]) -> Pos2 {
        self.center + self.scale * vec2(x as f32, -(y as f32))
    }

    /// Returns the place of the plane at a point of the screen.
    pub fn world(&self, at: Pos2) -> [f64; 2] {
        let by = (at - self.center) / self.scale.max(1e-6);
        [f64::from(by.x), f64::from(-by.y)]
    }

    /// Converts a place in units of samples.
    pub fn sample(&self, [x, y]: [f32; 2]) -> Pos2 {
        self.at([(x, 0), (y, 1)].map(|(sample, axis)| {
            let share = f64::from(sample) / (self.samples[axis] - 1) as f64;
            self.half[axis] * (2.0 * share - 1.0)
        }))
    }

    /// Fills convex polygons, given in units of samples.
    pub fn fill(&self, painter: &Painter, polygons: &[Vec<[f32; 2]>], tint: Color32) {
        let mut mesh = Mesh::default();
        for polygon in polygons {
            let base = mesh.vertices.len() as u32;
            for corner in polygon {
                mesh.colored_vertex(self.sample(*corner), tint);
            }
            for corner in 2..polygon.len() as u32 {
                mesh.add_triangle(base, base + corner - 1, base + corner);
            }
        }
        painter.add(Shape::mesh(mesh));
    }
}
