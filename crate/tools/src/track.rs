//! A quick mesh of a surface for the eye: the surface is followed from cell to cell of a grid, and
//! in each cell it is taken to be flat between the edges that it crosses (marching tetrahedra); the
//! vertices are brought onto it by one step of Newton's method.
//!
//! Nothing is proved: parts thinner than a cell are missed, as are those that no seed lies on.

use field::{Implicit, Jet, THRESHOLD};
use glam::{DVec3, IVec3};
use mesh::TriangleMesh;
use std::collections::{HashMap, HashSet};
use wide::f32x8;

/// A cell's corners on the way from its lowest to its highest corner, one axis after the other:
/// each order of the axes is a tetrahedron, and those of neighbouring cells share their faces.
const ORDERS: [[IVec3; 4]; 6] = {
    const fn way(a: IVec3, b: IVec3) -> [IVec3; 4] {
        let ab = IVec3::new(a.x + b.x, a.y + b.y, a.z + b.z);
        [IVec3::ZERO, a, ab, IVec3::ONE]
    }
    let [x, y, z] = [IVec3::X, IVec3::Y, IVec3::Z];
    [
        way(x, y),
        way(x, z),
        way(y, x),
        way(y, z),
        way(z, x),
        way(z, y),
    ]
};

/// Returns the coordinates of up to eight points; the last one fills the other lanes.
pub(crate) fn eight(points: &[DVec3]) -> [f32x8; 3] {
    let last = points.len() - 1;
    [0, 1, 2].map(|axis| f32x8::from(core::array::from_fn(|i| points[i.min(last)][axis] as f32)))
}

/// Computes values and gradients at many points, eight at a time.
pub(crate) fn jets(function: &dyn Implicit, points: &[DVec3]) -> Vec<Jet<f32>> {
    let mut all = Vec::with_capacity(points.len());
    for chunk in points.chunks(8) {
        let jet = function.jet8(eight(chunk));
        let values = jet.value.to_array();
        let gradients = jet.gradient.map(f32x8::to_array);
        all.extend((0..chunk.len()).map(|i| Jet {
            value: values[i],
            gradient: [0, 1, 2].map(|axis| gradients[axis][i]),
        }));
    }
    all
}

/// Whether a value is that of a point inside the surface; NaN is not.
fn is_inside(value: f32) -> bool {
    value > THRESHOLD as f32
}

/// Follows the surface of a function through the cells of a grid with this step, from the cells
/// around the seeds.
///
/// # Errors
/// If it goes through more than `most` cells.
pub(crate) fn track(
    function: &dyn Implicit,
    seeds: &[DVec3],
    step: f64,
    most: usize,
) -> Result<TriangleMesh, String> {
    let origin = seeds.first().copied().unwrap_or_default();
    let place = |at: IVec3| origin + at.as_dvec3() * step;
    let mut values: HashMap<IVec3, f32> = HashMap::new();
    let mut seen: HashSet<IVec3> = HashSet::new();
    let mut next: Vec<IVec3> = Vec::new();
    for seed in seeds {
        let cell = ((*seed - origin) / step).floor().as_ivec3();
        let near = (0..27).map(|i| cell + IVec3::new(i % 3, i / 3 % 3, i / 9) - 1);
        next.extend(near.filter(|cell| seen.insert(*cell)));
    }
    let mut crossed = Vec::new();
    while !next.is_empty() {
        let cells = core::mem::take(&mut next);
        let mut missing = Vec::new();
        for cell in &cells {
            for corner in corners(*cell) {
                // All are evaluated together below.
                values.entry(corner).or_insert_with(|| {
                    missing.push(corner);
                    f32::NAN
                });
            }
        }
        let points: Vec<DVec3> = missing.iter().map(|at| place(*at)).collect();
        for (at, jet) in missing.iter().zip(jets(function, &points)) {
            values.insert(*at, jet.value);
        }
        for cell in cells {
            let inside = corners(cell).map(|corner| is_inside(values[&corner]));
            if inside.iter().all(|is| *is == inside[0]) {
                continue;
            }
            crossed.push(cell);
            for axis in 0..3 {
                for side in [0, 1] {
                    let bit = 1 << axis;
                    let face = (0..8).filter(|i| (i & bit != 0) == (side == 1));
                    let mut face = face.map(|i| inside[i]);
                    let first = face.next();
                    if face.any(|is| Some(is) != first) {
                        let toward = IVec3::AXES[axis] * (2 * side - 1);
                        next.extend(Some(cell + toward).filter(|cell| seen.insert(*cell)));
                    }
                }
            }
        }
        if crossed.len() > most {
            return Err("the surface has too many parts".into());
        }
    }
    Ok(march(function, &crossed, &values, &place, step))
}

/// Returns the corners of a cell: bit 0 of their numbers is x, bit 1 y, bit 2 z.
fn corners(cell: IVec3) -> [IVec3; 8] {
    core::array::from_fn(|i| cell + IVec3::new(i as i32 & 1, i as i32 >> 1 & 1, i as i32 >> 2 & 1))
}

/// Returns the mesh in the cells that the surface crosses. `values`: those at the cells' corners.
fn march(
    function: &dyn Implicit,
    cells: &[IVec3],
    values: &HashMap<IVec3, f32>,
    place: &dyn Fn(IVec3) -> DVec3,
    step: f64,
) -> TriangleMesh {
    let mut numbers: HashMap<[IVec3; 2], u32> = HashMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    let mut vertex = |inside: IVec3, outside: IVec3| {
        *numbers.entry([inside, outside]).or_insert_with(|| {
            let [high, low] = [inside, outside].map(|at| f64::from(values[&at]) - THRESHOLD);
            let share = high / (high - low);
            // A value may be NaN or infinite.
            let is_between = (0.0..=1.0).contains(&share);
            let share = if is_between { share } else { 0.5 };
            positions.push(place(inside).lerp(place(outside), share));
            positions.len() as u32 - 1
        })
    };
    for cell in cells {
        for order in ORDERS {
            let tetrahedron = order.map(|offset| *cell + offset);
            let (inside, outside): (Vec<IVec3>, Vec<IVec3>) = tetrahedron
                .into_iter()
                .partition(|corner| is_inside(values[corner]));
            match (&inside[..], &outside[..]) {
                ([a], [b, c, d]) => {
                    triangles.push([vertex(*a, *b), vertex(*a, *c), vertex(*a, *d)])
                }
                ([a, b, c], [d]) => {
                    triangles.push([vertex(*a, *d), vertex(*b, *d), vertex(*c, *d)])
                }
                ([a, b], [c, d]) => {
                    let around = [[a, c], [a, d], [b, d], [b, c]];
                    let [p, q, r, s] = around.map(|[from, to]| vertex(*from, *to));
                    triangles.extend([[p, q, r], [p, r, s]]);
                }
                _ => {}
            }
        }
    }
    let mut normals = Vec::with_capacity(positions.len());
    let jets = jets(function, &positions);
    for (position, jet) in positions.iter_mut().zip(jets) {
        let gradient = DVec3::from_array(jet.gradient.map(f64::from));
        let squared = gradient.length_squared();
        let off = gradient * ((THRESHOLD - f64::from(jet.value)) / squared);
        if off.length() < 0.5 * step {
            *position += off;
        }
        normals.push(-gradient.normalize_or_zero());
    }
    // Counter-clockwise seen from outside.
    for triangle in &mut triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize]);
        let out: DVec3 = triangle.iter().map(|i| normals[*i as usize]).sum();
        if (b - a).cross(c - a).dot(out) < 0.0 {
            triangle.swap(1, 2);
        }
    }
    let mut mesh = TriangleMesh::new(positions, triangles);
    mesh.normals = Some(normals);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::{BlobScale, Kernel, Primitive, Shaping, Skeleton, Sum};

    fn sum(skeletons: &[Skeleton]) -> Sum {
        let shaping = Shaping {
            kernel: Kernel::Gauss,
            radius: 1.0,
            blobbiness: 2.0,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: None,
        };
        skeletons
            .iter()
            .filter_map(|skeleton| Primitive::new(skeleton.clone(), &shaping, None))
            .collect()
    }

    #[test]
    fn surface_is_followed_and_closed() {
        let far = DVec3::new(7.0, 0.0, 0.0);
        let two = sum(&[DVec3::ZERO, far].map(|center| Skeleton::Point { center }));
        let whole = 4.0 / 3.0 * core::f64::consts::PI;
        // Of two apart, only the one with a seed is found.
        for (seeds, count) in [(vec![DVec3::X], 1.0), (vec![DVec3::X, far - DVec3::X], 2.0)] {
            let mesh = track(&two, &seeds, 0.2, 10_000).unwrap();
            let volume = mesh.signed_volume();
            assert!((volume / (count * whole) - 1.0).abs() < 0.02, "{volume}");
            let topology = mesh::Topology::of(&mesh).unwrap();
            assert_eq!(topology.genera, vec![0; count as usize]);
            for p in &mesh.positions {
                assert!((two.jet(*p).value - 1.0).abs() < 0.02);
            }
        }
        let error = track(&two, &[DVec3::X], 0.2, 50).unwrap_err();
        assert!(error.contains("too many"), "{error}");
        // Without a seed on the surface there is no mesh.
        assert!(
            track(&two, &[3.5 * DVec3::X], 0.2, 50)
                .unwrap()
                .triangles
                .is_empty()
        );
        assert!(track(&two, &[], 0.2, 50).unwrap().triangles.is_empty());
    }
}
