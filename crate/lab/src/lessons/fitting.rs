//! Lesson 11: one coarse mesh with an implicit surface of balls and one of thin shells, both fitted
//! to points that can be dragged.

use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::plot::{self, Axis, Plot, grip, number};
use crate::tools::{Stage, choice, heading, reading, remark, slider};
use egui::{CursorIcon, Rect, Stroke, Ui, vec2};
use field::{Implicit, THRESHOLD};
use fit::{Observations, Options, Problem};
use glam::{DVec2, DVec3};
use mesh::TriangleMesh;
use metaballs::Metaballs;
use picture::contour::Grid;
use widgets::theme;

/// Half the side of the part of the plane that is shown.
const HALF: f64 = 2.1;
/// Samples of a side.
const SAMPLES: usize = 81;
/// Half the height of the ring of facets whose section is shown.
const RISE: f64 = 0.25;
/// Directions of the corners of the mesh, in degrees, and their distances from the middle: uneven,
/// as in meshes from the web.
const CORNERS: [(f64, f64); 9] = [
    (5.0, 1.25),
    (28.0, 1.3),
    (95.0, 1.1),
    (118.0, 1.25),
    (140.0, 1.3),
    (205.0, 1.0),
    (228.0, 1.15),
    (250.0, 1.25),
    (325.0, 1.1),
];
/// Measured points at the start: near the corners, farther out on one side and dented on another.
const POINTS: [[f64; 2]; 12] = [
    [1.45, 0.15],
    [1.25, 0.62],
    [0.85, 1.0],
    [0.3, 1.3],
    [-0.25, 1.35],
    [-0.75, 1.05],
    [-1.1, 0.55],
    [-1.05, -0.2],
    [-0.85, -0.8],
    [-0.35, -1.3],
    [0.35, -1.15],
    [1.05, -0.7],
];

/// Inputs of the figure.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    points: Vec<[f64; 2]>,
    /// k times the mean edge.
    sharpness: f64,
    /// Thickness of the shells.
    thickness: f64,
    /// Decimal logarithm of the weight of smoothness.
    smooth: f64,
    is_fitted: bool,
}

/// Surface of one kind, fitted.
struct Side {
    /// The mesh's section.
    ring: Vec<[f64; 2]>,
    outline: Vec<[[f32; 2]; 2]>,
    /// Root of the mean square of the distances of the points from the mesh and from the surface.
    errors: [f64; 2],
}

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "fitting",
    title: "Balls or thin shells?",
    name: "Balls or thin shells?",
    short: "Fitting",
    about: "implicit meshes that fit points",
    sentences: "One coarse mesh, here in a section, becomes a soft surface in two ways: with a \
                ball around each facet, or with a thin shell. Both surfaces are fitted to the \
                same measured points, and the mesh moves with its surface. A ball is as thick as \
                its facet is large: its mesh comes near the points, but its surface stays away \
                from them; a shell is as thin as you like.",
};

/// The lesson's state.
pub struct Fitting {
    key: Key,
    computed: Option<(Key, [Side; 2])>,
}

impl Default for Fitting {
    fn default() -> Self {
        Self {
            key: Key {
                points: POINTS.to_vec(),
                sharpness: 16.0,
                thickness: 0.02,
                smooth: -2.0,
                is_fitted: true,
            },
            computed: None,
        }
    }
}

impl Figure for Fitting {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let mut stage = Stage::new(ui, bench.narrow, bench.height, 1.5);
        self.controls(&mut stage.controls);
        if self
            .computed
            .as_ref()
            .is_none_or(|(key, _)| *key != self.key)
        {
            let mesh = ring();
            let [one, other] = self.key.kinds().map(|kind| self.key.side(&mesh, kind));
            if let (Some(one), Some(other)) = (one, other) {
                self.computed = Some((self.key.clone(), [one, other]));
            }
        }
        let all = stage.figure;
        let gap = 10.0;
        let places = if bench.narrow {
            let height = (all.height() - gap) / 2.0;
            let first = Rect::from_min_size(all.min, vec2(all.width(), height));
            [first, first.translate(vec2(0.0, height + gap))]
        } else {
            let width = (all.width() - gap) / 2.0;
            let first = Rect::from_min_size(all.min, vec2(width, all.height()));
            [first, first.translate(vec2(width + gap, 0.0))]
        };
        if let Some((_, sides)) = &self.computed {
            let titles = [
                "Balls around the facets (spherical)",
                "Thin shells around the facets (triangular)",
            ];
            for (i, side) in sides.iter().enumerate() {
                figure(ui, places[i], titles[i], i, side, &mut self.key.points);
            }
            let [balls, shells] = sides;
            let ui = &mut stage.controls;
            heading(ui, "Mean distance of the points from the mesh");
            let hues = [plot::hue(ui, 0), plot::hue(ui, 1)];
            reading(ui, "balls", &number(balls.errors[0]), hues[0]);
            reading(ui, "shells", &number(shells.errors[0]), hues[1]);
            heading(ui, "… and from the fitted surface");
            reading(ui, "balls", &number(balls.errors[1]), hues[0]);
            reading(ui, "shells", &number(shells.errors[1]), hues[1]);
            bench.readings.extend([
                ("spherical", balls.errors[0]),
                ("triangular", shells.errors[0]),
                ("spherical surface", balls.errors[1]),
                ("triangular surface", shells.errors[1]),
            ]);
            remark(
                ui,
                "Drag a point: both meshes are fitted again. A \
                 ball is as thick as its facet is large, \
                 so its mesh ends up inside the points, or outside them; \
                 the mesh of the shells lies \
                 on them.",
            );
        }
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Balls and shells", self.text())
    }
}

/// Makes the ring of facets.
fn ring() -> TriangleMesh {
    let count = CORNERS.len() as u32;
    let mut mesh = TriangleMesh::default();
    for rise in [-RISE, RISE] {
        for (angle, out) in CORNERS {
            let (sine, cosine) = libm::sincos(angle.to_radians());
            mesh.positions
                .push(DVec3::new(out * cosine, out * sine, rise));
        }
    }
    for i in 0..count {
        let j = (i + 1) % count;
        mesh.triangles.push([i, j, i + count]);
        mesh.triangles.push([j, j + count, i + count]);
    }
    mesh
}

impl Key {
    fn kinds(&self) -> [metaballs::Kind; 2] {
        [
            metaballs::Kind::Spherical,
            metaballs::Kind::Triangular {
                thickness: self.thickness,
            },
        ]
    }

    /// Returns the vertices of the mesh, fitted or not.
    fn positions(&self, mesh: &TriangleMesh, kind: metaballs::Kind, slope: f64) -> Vec<DVec3> {
        if !self.is_fitted {
            return mesh.positions.clone();
        }
        let rises = [-0.6 * RISE, 0.0, 0.6 * RISE];
        let points = self.points.iter();
        let points = points.flat_map(|&[x, y]| rises.map(|z| DVec3::new(x, y, z)));
        let observations = Observations {
            points: points.collect(),
            sights: Vec::new(),
        };
        let options = Options {
            kind: match kind {
                metaballs::Kind::Spherical => fit::Kind::Spherical,
                metaballs::Kind::Triangular { thickness } => fit::Kind::Triangular { thickness },
            },
            slope: Some(slope),
            smooth: libm::exp(self.smooth * core::f64::consts::LN_10),
            iterations: 40,
            ..Options::default()
        };
        // The control points are the mesh's own vertices.
        let fitted = Problem::new(mesh, mesh, observations, options)
            .and_then(|problem| fit::fit(&problem, &mut |_| true));
        fitted.map_or_else(|_| mesh.positions.clone(), |fitted| fitted.positions)
    }

    /// Makes the surface of a kind; `None` if its numbers cannot be computed with.
    fn side(&self, mesh: &TriangleMesh, kind: metaballs::Kind) -> Option<Side> {
        let slope = self.sharpness / fit::mean_edge(&mesh.positions, &mesh.triangles);
        let positions = self.positions(mesh, kind, slope);
        let balls = Metaballs::new(&positions, &mesh.triangles, kind, slope).ok()?;
        let step = 2.0 * HALF / (SAMPLES - 1) as f64;
        // The logarithm is nearly linear, so that lines are straight within a cell.
        let log = |p: DVec2| libm::log(balls.jet(p.extend(0.0)).value.max(1e-30) / THRESHOLD);
        let samples = (0..SAMPLES * SAMPLES).map(|i| {
            let [x, y] = [i % SAMPLES, i / SAMPLES].map(|i| i as f64 * step - HALF);
            log(DVec2::new(x, y)) as f32
        });
        let grid = Grid {
            width: SAMPLES,
            height: SAMPLES,
            values: samples.collect(),
        };
        let outline = grid.line(0.0).into_iter();
        let outline =
            outline.map(|ends| ends.map(|p| p.map(|c| (f64::from(c) * step - HALF) as f32)));
        let (lower, upper) = positions.split_at(CORNERS.len());
        let middles = lower.iter().zip(upper).map(|(a, b)| 0.5 * (*a + *b));
        let ring: Vec<DVec2> = middles.map(DVec3::truncate).collect();
        let mut squares = [0.0; 2];
        for point in self.points.iter().copied().map(DVec2::from) {
            squares[0] += distance(&ring, point).powi(2);
            squares[1] += (log(point) / slope).powi(2);
        }
        let count = self.points.len().max(1) as f64;
        Some(Side {
            errors: squares.map(|sum| (sum / count).sqrt()),
            outline: outline.collect(),
            ring: ring.iter().map(DVec2::to_array).collect(),
        })
    }
}

/// Returns the distance of a point from a closed polyline.
fn distance(ring: &[DVec2], p: DVec2) -> f64 {
    let mut least = f64::INFINITY;
    for (i, a) in ring.iter().copied().enumerate() {
        let along = ring[(i + 1) % ring.len()] - a;
        let t = ((p - a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
        least = least.min(p.distance(a + along * t));
    }
    least
}

impl Fitting {
    fn controls(&mut self, ui: &mut Ui) {
        let key = &mut self.key;
        choice(
            ui,
            &mut key.is_fitted,
            &[(false, "As it was"), (true, "Fitted to the points")],
        );
        slider(ui, "k × mean edge", &mut key.sharpness, 4.0..=60.0, "");
        slider(ui, "thickness d₀", &mut key.thickness, 0.0..=0.3, "");
        slider(ui, "log₁₀ smoothness", &mut key.smooth, -4.0..=1.0, "");
        let again = ui.button("Reset the points");
        widgets::places::note(ui.ctx(), "lab again", again.rect);
        if again.clicked() {
            key.points = POINTS.to_vec();
        }
    }

    /// Writes both surfaces of a mesh, deformed, as a dataset.
    fn text(&self) -> String {
        let thickness = self.key.thickness.max(0.005);
        format!(
            "# One mesh with balls and with thin shells around \
             its facets, both deformed by the same\n\
             # control points.\n\
             # Drag the control points: put the caret into a deform.\n\n\
             framesize 480 300\neyep 0 -9 3\nvrp 0 0 0\nvup 0 0 1\nfov 40\n\
             light White, position -4 -6 8, intensity 0.9\n\
             surface Balls, diffuse IndianRed, specular Gray40, shine 40\n\
             surface Shells, diffuse SeaGreen, specular Gray40, shine 40\n\n\
             body BALLS\n  mesh Balls gem.obj metaballs spherical 12\n  {DEFORM}close\n\
             translate -1.6 0 0\n\n\
             body SHELLS\n  mesh Shells gem.obj metaballs triangular {thickness:.3} 60\n  \
             {DEFORM}close\ntranslate 1.6 0 0\n"
        )
    }
}

/// Deformation in the dataset.
const DEFORM: &str =
    "deform { control <0 0 -1.2> move <0.4 0 0>\n    control <0 0 0.65> move <0 0 0.2> }\n";

/// Draws one of the two figures. Dragging a point changes it for both.
fn figure(
    ui: &mut Ui,
    place: Rect,
    title: &str,
    index: usize,
    side: &Side,
    points: &mut [[f64; 2]],
) {
    let palette = theme::palette(ui.visuals());
    plot::panel(ui, place);
    let size = place.width().min(place.height() - 26.0);
    let square = Rect::from_center_size(place.center() + vec2(0.0, 10.0), vec2(size, size));
    let axis = Axis::new([-HALF, HALF], "").bare();
    let plot = Plot::new(ui, square, axis, axis);
    ui.painter().text(
        place.min + vec2(14.0, 9.0),
        egui::Align2::LEFT_TOP,
        title,
        egui::FontId::proportional(12.5),
        palette.text,
    );
    let hue = plot::hue(ui, index);
    for ends in &side.outline {
        let ends = ends.map(|[x, y]| plot.at(f64::from(x), f64::from(y)));
        plot.painter.line_segment(ends, Stroke::new(2.5, hue));
    }
    let mut ring: Vec<_> = side.ring.iter().map(|[x, y]| plot.at(*x, *y)).collect();
    ring.extend(ring.first().copied());
    for corner in &ring {
        plot.painter.circle_filled(*corner, 3.0, palette.strong);
    }
    plot.painter.line(ring, Stroke::new(1.3, palette.strong));
    for (i, point) in points.iter_mut().enumerate() {
        let name = match index {
            0 => format!("point {}", i + 1),
            _ => format!("point {} beside", i + 1),
        };
        let at = plot.at(point[0], point[1]);
        let grip = grip(ui, &name, at, palette.accent, CursorIcon::Grab);
        if grip.dragged() {
            let moved = plot.value(at + grip.drag_delta());
            *point = moved.map(|c| c.clamp(-0.97 * HALF, 0.97 * HALF));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thin_shells_bring_the_mesh_to_the_points_and_balls_do_not() {
        let key = Fitting::default().key;
        let mesh = ring();
        let sides = key.kinds().map(|kind| key.side(&mesh, kind).unwrap());
        let [balls, shells] = sides.map(|side| side.errors);
        assert!(shells[0] < 0.1, "{shells:?}");
        assert!(balls[0] > 2.0 * shells[0], "{balls:?} {shells:?}");
        let before = Key {
            is_fitted: false,
            ..key
        };
        let before = before.kinds().map(|kind| before.side(&mesh, kind).unwrap());
        assert!(before[1].errors[0] > 1.5 * shells[0]);
        assert!(!before[0].outline.is_empty());
    }
}
