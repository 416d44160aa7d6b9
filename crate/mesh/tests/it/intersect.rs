//! The exact test for self-intersections: cases that are decided by a hair, and random ones against
//! arithmetic on whole numbers.

use crate::solids::{sphere, torus};
use glam::DVec3;
use mesh::{TriangleMesh, self_intersections};
use trials::{Random, count};

fn pairs(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let positions = positions.iter().map(|p| DVec3::from(*p)).collect();
    let mesh = TriangleMesh::new(positions, triangles.to_vec());
    let found = self_intersections(&mesh, 1000).unwrap();
    assert!(found.is_complete);
    found.pairs
}

const GROUND: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// Returns a triangle with its lowest vertex at a point, above the ground triangle.
fn spike(tip: [f64; 3]) -> Vec<[u32; 2]> {
    let mut all = GROUND.to_vec();
    all.extend([tip, [0.2, 0.3, 1.0], [0.4, 0.2, 1.0]]);
    pairs(&all, &[[0, 1, 2], [3, 4, 5]])
}

#[test]
fn touching_counts_and_missing_by_a_hair_does_not() {
    assert_eq!(spike([0.25, 0.25, 0.0]), [[0, 1]]);
    assert_eq!(
        spike([0.25, 0.25, f64::MIN_POSITIVE.sqrt() * 1e80]).len(),
        0
    );
    assert_eq!(spike([0.25, 0.25, -1e-70]), [[0, 1]]);
    // On the slanted side, and one rounding beyond it.
    assert_eq!(spike([0.5, 0.5, 0.0]), [[0, 1]]);
    assert_eq!(spike([0.5, 0.5_f64.next_up(), 0.0]).len(), 0);
    assert_eq!(spike([1.0, 0.0, 0.0]), [[0, 1]]);
    assert_eq!(spike([1.0_f64.next_up(), 0.0, 0.0]).len(), 0);
}

#[test]
fn coplanar_triangles() {
    let with = |other: [[f64; 3]; 3]| {
        let all: Vec<_> = GROUND.iter().chain(&other).copied().collect();
        pairs(&all, &[[0, 1, 2], [3, 4, 5]]).len()
    };
    // Inside, around, across, side by side, at a corner, apart.
    assert_eq!(with([[0.1, 0.1, 0.0], [0.2, 0.1, 0.0], [0.1, 0.2, 0.0]]), 1);
    assert_eq!(
        with([[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]]),
        1
    );
    assert_eq!(
        with([[0.1, -1.0, 0.0], [0.2, -1.0, 0.0], [0.1, 2.0, 0.0]]),
        1
    );
    assert_eq!(
        with([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, -1.0, 0.0]]),
        1
    );
    assert_eq!(with([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]), 1);
    assert_eq!(with([[0.6, 0.6, 0.0], [2.0, 0.5, 0.0], [2.0, 1.0, 0.0]]), 0);
}

#[test]
fn neighbours_may_meet_where_they_share() {
    let shared = |more: &[[f64; 3]], triangle: [u32; 3]| {
        let all: Vec<_> = GROUND.iter().chain(more).copied().collect();
        pairs(&all, &[[0, 1, 2], triangle]).len()
    };
    // At an edge: bent, flat, folded over.
    assert_eq!(shared(&[[0.3, 0.3, 1e-60]], [1, 0, 3]), 0);
    assert_eq!(shared(&[[0.3, -0.3, 0.0]], [1, 0, 3]), 0);
    assert_eq!(shared(&[[0.3, 0.3, 0.0]], [1, 0, 3]), 1);
    // At a vertex: away, through, touching with the far side or the far corner, flat.
    assert_eq!(shared(&[[1.0, 0.0, 1.0], [0.0, 1.0, 1.0]], [0, 3, 4]), 0);
    assert_eq!(shared(&[[0.4, 0.4, 1.0], [0.4, 0.4, -1.0]], [0, 3, 4]), 1);
    assert_eq!(shared(&[[0.3, 0.3, 0.0], [1.0, 1.0, 1.0]], [0, 3, 4]), 1);
    assert_eq!(shared(&[[2.0, 2.0, 0.0], [1.0, 1.0, 1.0]], [0, 3, 4]), 1);
    assert_eq!(shared(&[[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]], [0, 3, 4]), 0);
    assert_eq!(shared(&[[2.0, 0.1, 0.0], [2.0, 0.2, 0.0]], [0, 3, 4]), 1);
    // The same three vertices.
    assert_eq!(shared(&[], [2, 1, 0]), 1);
}

#[test]
fn solids_are_free_and_shifted_copies_are_not() {
    for mesh in [sphere(12), torus(20, 14)] {
        assert!(self_intersections(&mesh, 10).unwrap().is_free());
        let mut twice = mesh.clone();
        let first = mesh.positions.len() as u32;
        twice
            .positions
            .extend(mesh.positions.iter().map(|p| *p + DVec3::X * 0.3));
        twice
            .triangles
            .extend(mesh.triangles.iter().map(|t| t.map(|i| i + first)));
        let found = self_intersections(&twice, 100_000).unwrap();
        assert!(found.is_complete && found.pairs.len() > 20);
        // All between the two, none within one.
        let own = mesh.triangles.len() as u32;
        assert!(found.pairs.iter().all(|[i, j]| *i < own && *j >= own));
        // A triangle folded over its neighbour.
        let mut dented = mesh.clone();
        let [a, b, c] = dented.triangles[7].map(|i| i as usize);
        dented.positions[a] = (dented.positions[b] + dented.positions[c]) * -0.9;
        assert!(!self_intersections(&dented, 10).unwrap().is_free());
    }
}

#[test]
fn undecidable_meshes_are_reported() {
    let mesh = |p: DVec3| TriangleMesh::new(vec![p, DVec3::X, DVec3::Y], vec![[0, 1, 2]]);
    for p in [
        DVec3::NAN,
        DVec3::splat(1e80),
        DVec3::splat(1e-80),
        DVec3::INFINITY,
    ] {
        let told = self_intersections(&mesh(p), 1).unwrap_err().to_string();
        assert!(told.starts_with("vertex 0"), "{told}");
    }
    let flat = self_intersections(&mesh(DVec3::new(0.25, 0.75, 0.0)), 1).unwrap();
    assert_eq!((flat.flat.as_slice(), flat.is_free()), (&[0][..], false));
    let missing = TriangleMesh::new(vec![DVec3::X], vec![[0, 1, 2]]);
    assert!(
        self_intersections(&missing, 1)
            .unwrap_err()
            .to_string()
            .contains("vertex 1")
    );
}

/// Whether two closed triangles with whole coordinates meet: separating axes, exactly. Two convex
/// sets are apart if and only if one of these directions separates them.
fn meet(a: [[i64; 3]; 3], b: [[i64; 3]; 3]) -> bool {
    let sub = |p: [i64; 3], q: [i64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let cross = |p: [i64; 3], q: [i64; 3]| {
        [
            p[1] * q[2] - p[2] * q[1],
            p[2] * q[0] - p[0] * q[2],
            p[0] * q[1] - p[1] * q[0],
        ]
    };
    let sides = |t: [[i64; 3]; 3]| [sub(t[1], t[0]), sub(t[2], t[1]), sub(t[0], t[2])];
    let (sa, sb) = (sides(a), sides(b));
    let (na, nb) = (cross(sa[0], sa[1]), cross(sb[0], sb[1]));
    let mut axes = vec![na, nb];
    for s in sa.iter().chain(&sb) {
        axes.extend([cross(*s, na), cross(*s, nb)]);
    }
    for s in sa {
        axes.extend(sb.map(|t| cross(s, t)));
    }
    axes.into_iter().filter(|axis| *axis != [0; 3]).all(|axis| {
        let range = |t: [[i64; 3]; 3]| {
            let at = t.map(|p| p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2]);
            (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]))
        };
        let (one, other) = (range(a), range(b));
        one.0 <= other.1 && other.0 <= one.1
    })
}

#[test]
fn random_triangles_on_a_grid_are_judged_as_by_separating_axes() {
    let mut random = Random::new(8);
    let tried = count(60_000);
    let mut counts = [0; 2];
    for _ in 0..tried {
        let mut triangle = || [0; 3].map(|_| [0; 3].map(|_| random.below(5) as i64));
        let (a, b) = (triangle(), triangle());
        let positions: Vec<[f64; 3]> = a
            .iter()
            .chain(&b)
            .map(|p| p.map(|x| x as f64 * 0.1))
            .collect();
        // A tenth is no binary number: exactness is needed, and the grid's is lost; so whole ones,
        // too.
        let whole: Vec<DVec3> = a
            .iter()
            .chain(&b)
            .map(|p| DVec3::from(p.map(|x| x as f64)))
            .collect();
        let mesh = TriangleMesh::new(whole, vec![[0, 1, 2], [3, 4, 5]]);
        let found = self_intersections(&mesh, 10).unwrap();
        if found.flat.is_empty() {
            let expected = meet(a, b);
            assert_eq!(!found.pairs.is_empty(), expected, "{a:?} {b:?}");
            counts[usize::from(expected)] += 1;
        }
        // Turning triangles and swapping them changes nothing, with any coordinates.
        let one = pairs(&positions, &[[0, 1, 2], [3, 4, 5]]);
        let other = pairs(&positions, &[[4, 3, 5], [1, 2, 0]]);
        assert_eq!(one.len(), other.len());
    }
    assert!(counts.iter().all(|n| 12 * n > tried), "{counts:?}");
}

/// Triangles that share a vertex, judged by shrinking: they meet elsewhere if and only if they
/// still meet when the shared corner of one is cut off by a little.
#[test]
fn random_triangles_with_a_common_vertex() {
    let mut random = Random::new(12);
    let tried = count(40_000);
    let mut counts = [0; 2];
    for _ in 0..tried {
        let mut point = || [0; 3].map(|_| random.below(5) as i64 - 2);
        let [b, c, d, e] = [point(), point(), point(), point()];
        let whole = |p: [i64; 3]| DVec3::from(p.map(|x| x as f64));
        let positions = vec![DVec3::ZERO, whole(b), whole(c), whole(d), whole(e)];
        let mesh = TriangleMesh::new(positions, vec![[0, 1, 2], [0, 3, 4]]);
        let found = self_intersections(&mesh, 10).unwrap();
        if !found.flat.is_empty() {
            continue;
        }
        // The part of 0bc beyond a thousandth: a trapezium of two triangles; all times 1000.
        let scaled = |p: [i64; 3], by: i64| p.map(|x| x * by);
        let (b1, c1, b0, c0) = (scaled(b, 1000), scaled(c, 1000), b, c);
        let other = [[0; 3], scaled(d, 1000), scaled(e, 1000)];
        let expected = meet([b0, b1, c1], other) || meet([b0, c1, c0], other);
        assert_eq!(!found.pairs.is_empty(), expected, "{b:?} {c:?} {d:?} {e:?}");
        counts[usize::from(expected)] += 1;
    }
    assert!(counts.iter().all(|n| 14 * n > tried), "{counts:?}");
}
