//! Boxes and quadrics as patches: triangles with a normal at each corner.
//!
//! A box is exact: two triangles a face. A quadric is cut into cells, and each cell into six
//! tetrahedra; in a tetrahedron the surface is taken to be flat between the edges that it crosses
//! (marching tetrahedra). Corners and normals are exact, so that light shows no cells.

use glam::{DVec3, IVec3};
use scene::{Quadric, Scene, Shape};

/// The most cells across a quadric.
const FINEST: usize = 24;
/// The fewest cells across a quadric.
const COARSEST: usize = 3;
/// The number of solids from which on no further quadric is drawn.
pub(crate) const MOST: usize = 300_000;
/// Corners of cells in all quadrics of a scene together.
const CORNERS: usize = 2_000_000;

/// Returns the number of cells across each quadric of a scene: the fewer, the more quadrics there
/// are, so that the draft is still made in an instant.
pub(crate) fn detail(scene: &Scene) -> usize {
    let elements = scene.elements.iter();
    let quadrics = elements.filter(|e| matches!(e.shape, Shape::Quadric(_)));
    let most_corners = CORNERS / quadrics.count().max(1);
    (COARSEST..=FINEST)
        .rev()
        .find(|cells| (cells + 1).pow(3) <= most_corners)
        .unwrap_or(COARSEST)
}

/// The faces of a box.
pub(crate) fn cuboid(center: DVec3, axes: [DVec3; 3]) -> Vec<Shape> {
    let mut patches = Vec::with_capacity(12);
    for i in 0..3 {
        let (out, x, y) = (axes[i], axes[(i + 1) % 3], axes[(i + 2) % 3]);
        for side in [out, -out] {
            let middle = center + side;
            let [a, b, c, d] = [
                middle - x - y,
                middle + x - y,
                middle + x + y,
                middle - x + y,
            ];
            for corners in [[a, b, c], [a, c, d]] {
                patches.push(Shape::patch(corners, [x.cross(y); 3]));
            }
        }
    }
    patches
}

/// A cell's corners on the way from its lowest to its highest corner, one axis after the other:
/// each order of the axes is a tetrahedron, and those of neighbouring cells share their faces.
const ORDERS: [[IVec3; 4]; 6] = {
    const fn path(a: IVec3, b: IVec3) -> [IVec3; 4] {
        let ab = IVec3::new(a.x + b.x, a.y + b.y, a.z + b.z);
        [IVec3::ZERO, a, ab, IVec3::ONE]
    }
    let [x, y, z] = [IVec3::X, IVec3::Y, IVec3::Z];
    [
        path(x, y),
        path(x, z),
        path(y, x),
        path(y, z),
        path(z, x),
        path(z, y),
    ]
};

/// Returns the cells of a cubic lattice, x first, then y and z.
fn grid(side: i32) -> impl Iterator<Item = IVec3> {
    (0..side)
        .flat_map(move |z| (0..side).flat_map(move |y| (0..side).map(move |x| IVec3::new(x, y, z))))
}

/// The surface of a quadric with this many cells across its box.
pub(crate) fn quadric(quadric: &Quadric, cells: usize) -> Vec<Shape> {
    let Some(to_normal) = quadric.local_from_world().map(|m| m.transpose()) else {
        return Vec::new();
    };
    let side = cells as i32 + 1;
    let place = |at: IVec3| at.as_dvec3() * (2.0 / cells as f64) - 1.0;
    let values: Vec<f64> = grid(side).map(|at| quadric.value(place(at)).0).collect();
    let mut patches = Vec::new();
    let mut add = |corners: [DVec3; 3]| {
        patches.push(Shape::patch(
            corners.map(|q| quadric.place(q)),
            corners.map(|q| to_normal * quadric.value(q).1),
        ));
    };
    for cell in grid(side - 1) {
        for order in &ORDERS {
            let corners = order.map(|step| cell + step);
            let (inside, outside): (Vec<IVec3>, Vec<IVec3>) = corners
                .into_iter()
                .partition(|at| values[((at.z * side + at.y) * side + at.x) as usize] < 0.0);
            match (&inside[..], &outside[..]) {
                (&[a], &[b, c, d]) | (&[b, c, d], &[a]) => {
                    add([b, c, d].map(|other| crossing(quadric, place(a), place(other))));
                }
                (&[a, b], &[c, d]) => {
                    let [ac, ad, bc, bd] = [[a, c], [a, d], [b, c], [b, d]]
                        .map(|[a, b]| crossing(quadric, place(a), place(b)));
                    add([ac, ad, bd]);
                    add([ac, bd, bc]);
                }
                _ => {}
            }
        }
    }
    patches
}

/// Returns the point at which the surface crosses an edge whose ends are on different sides of it.
fn crossing(quadric: &Quadric, from: DVec3, to: DVec3) -> DVec3 {
    // Along an edge the equation is a·t² + b·t + c = 0, and exactly one root is between 0 and 1.
    let (c, gradient) = quadric.value(from);
    let b = gradient.dot(to - from);
    let a = (to - from).dot(quadric.square * (to - from));
    let sum = -0.5 * (b + (b * b - 4.0 * a * c).max(0.0).sqrt().copysign(b));
    let roots = [sum / a, c / sum];
    // Rounding may push the root of an edge that ends on the surface a little out of the edge.
    let out = roots.map(|t| (t - t.clamp(0.0, 1.0)).abs());
    let t = if out[1] <= out[0] || roots[0].is_nan() {
        roots[1]
    } else {
        roots[0]
    };
    from.lerp(to, if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) })
}
