//! Rigid alignment of a mesh to a cloud of points.

use crate::normal::Normal;
use glam::{DMat3, DVec3};
use mesh::{Aabb, Bvh};
use metaballs::nearest;

/// Points of the cloud that an alignment uses.
const POINTS: usize = 600;
/// Share of the points, the nearest ones, that count: the rest may be outliers.
const TRUSTED: f64 = 0.5;

/// Rigid motion: a rotation about the origin, then a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    /// Rotation.
    pub turn: DMat3,
    /// The shift.
    pub shift: DVec3,
}

impl Rigid {
    /// The motion that leaves everything in its place.
    pub const IDENTITY: Self = Self {
        turn: DMat3::IDENTITY,
        shift: DVec3::ZERO,
    };

    /// Returns a point turned and moved.
    #[must_use]
    pub fn apply(&self, point: DVec3) -> DVec3 {
        self.turn * point + self.shift
    }

    /// Returns the unit axis and the angle of the turn, degrees from 0 to 180.
    #[must_use]
    pub fn axis_angle(&self) -> (DVec3, f64) {
        let m = &self.turn;
        let twice = DVec3::new(
            m.y_axis.z - m.z_axis.y,
            m.z_axis.x - m.x_axis.z,
            m.x_axis.y - m.y_axis.x,
        );
        let cosine = 0.5 * (m.x_axis.x + m.y_axis.y + m.z_axis.z - 1.0);
        let angle = libm::atan2(0.5 * twice.length(), cosine);
        // Near a half turn the axis is the longest column of R + 1.
        let columns = [
            m.x_axis + DVec3::X,
            m.y_axis + DVec3::Y,
            m.z_axis + DVec3::Z,
        ];
        let longest = columns.into_iter().fold(DVec3::ZERO, |best, column| {
            if column.length_squared() > best.length_squared() {
                column
            } else {
                best
            }
        });
        let axis = if twice.length() > 1e-6 {
            twice
        } else {
            longest
        };
        (axis.normalize_or(DVec3::Z), angle.to_degrees())
    }

    /// Returns the motion that applies another first, then this.
    fn after(&self, other: &Self) -> Self {
        Self {
            turn: self.turn * other.turn,
            shift: self.apply(other.shift),
        }
    }

    fn inverse(&self) -> Self {
        let turn = self.turn.transpose();
        Self {
            turn,
            shift: -(turn * self.shift),
        }
    }
}

/// Returns how to turn and move a mesh onto points: iterated closest points, from where it is and
/// from the 24 turns of a cube about the middles, the best of all by the mean distance of half of
/// the points, the nearest.
pub(crate) fn align(positions: &[DVec3], triangles: &[[u32; 3]], points: &[DVec3]) -> Rigid {
    if points.len() < 4 {
        return Rigid::IDENTITY;
    }
    let step = points.len().div_ceil(POINTS);
    let points: Vec<DVec3> = points.iter().step_by(step).copied().collect();
    let target = Target::new(positions, triangles);
    // The points are moved onto the mesh, whose hierarchy so stays.
    let bounds = Aabb::of_points(positions.iter().copied());
    let to_middle = bounds.center() - median(&points);
    let mut starts = vec![Rigid::IDENTITY];
    starts.extend(cube_turns().into_iter().map(|turn| {
        let about = median(&points);
        Rigid {
            turn,
            shift: about + to_middle - turn * about,
        }
    }));
    let mut coarse: Vec<(f64, Rigid)> = starts
        .into_iter()
        .map(|start| target.iterate(&points, start, 8))
        .collect();
    coarse.sort_by(|a, b| a.0.total_cmp(&b.0));
    let fine = coarse
        .iter()
        .take(3)
        .map(|(_, rigid)| target.iterate(&points, *rigid, 60));
    let best = fine.min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or(Rigid::IDENTITY, |(_, rigid)| rigid.inverse())
}

/// Returns how to turn and move a mesh onto points that are near it: iterated closest points from
/// where it is. No motion where that brings half of the points less than twice as near.
pub(crate) fn nudge(positions: &[DVec3], triangles: &[[u32; 3]], points: &[DVec3]) -> Rigid {
    if points.len() < 4 {
        return Rigid::IDENTITY;
    }
    let step = points.len().div_ceil(POINTS);
    let points: Vec<DVec3> = points.iter().step_by(step).copied().collect();
    let target = Target::new(positions, triangles);
    let (_, before) = target.pairs(&points, &Rigid::IDENTITY);
    let (after, rigid) = target.iterate(&points, Rigid::IDENTITY, 60);
    if after < 0.5 * before {
        rigid.inverse()
    } else {
        Rigid::IDENTITY
    }
}

/// The median of each coordinate.
fn median(points: &[DVec3]) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|axis| {
        let mut values: Vec<f64> = points.iter().map(|p| p[axis]).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    }))
}

/// The turns that map a cube to itself.
fn cube_turns() -> Vec<DMat3> {
    let axes = [
        DVec3::X,
        -DVec3::X,
        DVec3::Y,
        -DVec3::Y,
        DVec3::Z,
        -DVec3::Z,
    ];
    let mut turns = Vec::new();
    for x in axes {
        for y in axes.iter().filter(|y| y.dot(x) == 0.0) {
            turns.push(DMat3::from_cols(x, *y, x.cross(*y)));
        }
    }
    turns
}

/// Mesh to which points are moved.
struct Target {
    facets: Vec<[DVec3; 3]>,
    bvh: Bvh,
}

impl Target {
    fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let facets: Vec<_> = triangles
            .iter()
            .map(|t| t.map(|i| positions[i as usize]))
            .collect();
        let boxes: Vec<Aabb> = facets.iter().map(|f| Aabb::of_points(*f)).collect();
        Self {
            facets,
            bvh: Bvh::new(&boxes),
        }
    }

    /// The nearest point, and the unit normal of its facet; 0 for one without area.
    fn nearest(&self, point: DVec3) -> (DVec3, DVec3) {
        let found = self.bvh.nearest(point, f64::INFINITY, |i| {
            let nearest = nearest(&self.facets[i as usize], point).point;
            nearest.distance_squared(point)
        });
        let Some((facet, _)) = found else {
            return (point, DVec3::ZERO);
        };
        let facet @ [a, b, c] = self.facets[facet as usize];
        let normal = (b - a).cross(c - a).normalize_or_zero();
        (nearest(&facet, point).point, normal)
    }

    /// Iterated closest points. Returns the mean distance of the trusted points, and how they are
    /// moved.
    fn iterate(&self, points: &[DVec3], start: Rigid, most: usize) -> (f64, Rigid) {
        let (mut pairs, mut mean) = self.pairs(points, &start);
        let mut rigid = start;
        for _ in 0..most {
            // Onto the planes of the facets is the quicker way where it leads nearer: points slide
            // along the surface.
            let steps = [onto_planes(&pairs), Some(onto(&pairs))];
            let better = steps.into_iter().flatten().find_map(|step| {
                let next = step.after(&rigid);
                let (pairs, distance) = self.pairs(points, &next);
                (distance < mean * (1.0 - 1e-6)).then_some((next, pairs, distance))
            });
            let Some(better) = better else {
                break;
            };
            (rigid, pairs, mean) = better;
        }
        (mean, rigid)
    }

    /// Moves the points and pairs each with the nearest of the mesh. Returns the pairs that are
    /// trusted, and their mean distance.
    fn pairs(&self, points: &[DVec3], rigid: &Rigid) -> (Vec<Pair>, f64) {
        let mut pairs: Vec<Pair> = points
            .iter()
            .map(|p| {
                let moved = rigid.apply(*p);
                let (near, normal) = self.nearest(moved);
                Pair {
                    distance: near.distance(moved),
                    moved,
                    near,
                    normal,
                }
            })
            .collect();
        pairs.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        pairs.truncate(((TRUSTED * points.len() as f64) as usize).max(3));
        let sum: f64 = pairs.iter().map(|pair| pair.distance).sum();
        let mean = sum / pairs.len().max(1) as f64;
        (pairs, mean)
    }
}

/// Point and the nearest of the mesh.
struct Pair {
    distance: f64,
    moved: DVec3,
    near: DVec3,
    /// The unit normal of the nearest facet.
    normal: DVec3,
}

/// The rigid motion that brings points nearest to the planes of their facets, to the first order of
/// the turn. `None` if it is not determined.
fn onto_planes(pairs: &[Pair]) -> Option<Rigid> {
    let count = pairs.len().max(1) as f64;
    let middle = pairs.iter().map(|pair| pair.moved).sum::<DVec3>() / count;
    let mut normal = Normal::dense(6);
    for pair in pairs {
        // n·(p + ω × p + t − q)
        let arm = pair.moved - middle;
        let row = [(0, arm.cross(pair.normal)), (1, pair.normal)];
        let gap = pair.normal.dot(pair.moved - pair.near);
        normal.add(gap, &row, 1.0);
    }
    let found = normal.solve(1e-6)?;
    let (turn, shift) = (DVec3::from_slice(&found), DVec3::from_slice(&found[3..]));
    let angle = turn.length().min(0.5);
    let (sine, cosine) = libm::sincos(angle);
    let axis = turn.normalize_or_zero();
    // Rodrigues' formula.
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z]
        .map(|v| v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine)));
    let turn = DMat3::from_cols(x, y, z);
    (found.iter().all(|v| v.is_finite())).then(|| Rigid {
        turn,
        shift: middle + shift - turn * middle,
    })
}

/// The rigid motion that brings the points of pairs nearest to those of the mesh, by Horn's
/// quaternion.
fn onto(pairs: &[Pair]) -> Rigid {
    let count = pairs.len() as f64;
    let from = pairs.iter().map(|pair| pair.moved).sum::<DVec3>() / count;
    let to = pairs.iter().map(|pair| pair.near).sum::<DVec3>() / count;
    let mut s = [[0.0; 3]; 3];
    for Pair { moved, near, .. } in pairs {
        let (p, q) = (*moved - from, *near - to);
        for i in 0..3 {
            for j in 0..3 {
                s[i][j] += p[i] * q[j];
            }
        }
    }
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = s;
    let matrix = [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, yy - xx - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, zz - xx - yy],
    ];
    let [w, x, y, z] = largest_eigenvector(matrix);
    let turn = DMat3::from_cols(
        DVec3::new(
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y + w * z),
            2.0 * (x * z - w * y),
        ),
        DVec3::new(
            2.0 * (x * y - w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z + w * x),
        ),
        DVec3::new(
            2.0 * (x * z + w * y),
            2.0 * (y * z - w * x),
            1.0 - 2.0 * (x * x + y * y),
        ),
    );
    Rigid {
        turn,
        shift: to - turn * from,
    }
}

/// The unit eigenvector of a symmetric matrix with the largest eigenvalue, by Jacobi's rotations.
pub(crate) fn largest_eigenvector(mut a: [[f64; 4]; 4]) -> [f64; 4] {
    let mut vectors = [[0.0; 4]; 4];
    for (i, row) in vectors.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for _ in 0..30 {
        for p in 0..4 {
            for q in p + 1..4 {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for row in &mut a {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                let [one, other] = [a[p], a[q]];
                a[p] = core::array::from_fn(|k| c * one[k] - s * other[k]);
                a[q] = core::array::from_fn(|k| s * one[k] + c * other[k]);
                for row in &mut vectors {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
            }
        }
    }
    let best = (1..4).fold(0, |best, i| if a[i][i] > a[best][best] { i } else { best });
    vectors.map(|row| row[best])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn head_is_turned_back_by_its_points() {
        let head = crate::trial::head(400);
        let points = crate::trial::sample(&head.positions, &head.triangles, 500, 3);
        let (s, c) = (libm::sin(0.7), libm::cos(0.7));
        let exact = Rigid {
            turn: DMat3::from_cols(DVec3::new(c, s, 0.0), DVec3::new(-s, c, 0.0), DVec3::Z),
            shift: DVec3::new(0.5, -0.3, 0.2),
        };
        let turned: Vec<DVec3> = points.iter().map(|p| exact.apply(*p)).collect();
        let found = align(&head.positions, &head.triangles, &turned);
        let (axis, angle) = found.axis_angle();
        assert!((angle - 0.7_f64.to_degrees()).abs() < 0.1, "{angle}");
        assert!(axis.distance(DVec3::Z) < 0.01 && found.shift.distance(exact.shift) < 0.01);
    }

    #[test]
    fn points_that_are_turned_are_turned_back() {
        let (s, c) = (libm::sin(0.4), libm::cos(0.4));
        let turn = DMat3::from_cols(DVec3::new(c, s, 0.0), DVec3::new(-s, c, 0.0), DVec3::Z);
        let exact = Rigid {
            turn,
            shift: DVec3::new(0.3, -0.2, 1.0),
        };
        let points = (0..20).map(f64::from);
        let points = points.map(|t| DVec3::new(libm::sin(t), libm::cos(1.7 * t), 0.3 * t));
        let pairs: Vec<_> = points
            .map(|p| Pair {
                distance: 0.0,
                moved: p,
                near: exact.apply(p),
                normal: DVec3::ZERO,
            })
            .collect();
        let found = onto(&pairs);
        assert!(found.shift.distance(exact.shift) < 1e-12);
        let (axis, angle) = found.axis_angle();
        assert!(axis.distance(DVec3::Z) < 1e-9 && (angle - 0.4_f64.to_degrees()).abs() < 1e-9);
        let half = Rigid {
            turn: DMat3::from_diagonal(DVec3::new(-1.0, 1.0, -1.0)),
            shift: DVec3::ZERO,
        };
        assert_eq!(half.axis_angle(), (DVec3::Y, 180.0));
    }
}
