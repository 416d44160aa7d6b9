//! The noise of measured points, told by themselves.

use crate::align::largest_eigenvector;
use glam::DVec3;

/// Points whose neighbours are looked at, and points among which these are searched.
const PROBES: usize = 200;
const AMONG: usize = 20_000;
/// Neighbours through which a plane is laid.
const NEIGHBOURS: usize = 8;

/// Returns the standard deviation of points across the surface that they are of: the median of
/// their distances from planes through their nearest neighbours, so that nearly half of them may be
/// of no surface: with 40 % of these it is up to three times too large. So it is where points are
/// sparse, by how the surface bends between them; infinite of few.
pub(crate) fn noise(points: &[DVec3]) -> f64 {
    let among: Vec<DVec3> = points
        .iter()
        .step_by(points.len().div_ceil(AMONG).max(1))
        .copied()
        .collect();
    if among.len() < 4 * NEIGHBOURS {
        return f64::INFINITY;
    }
    let mut apart = Vec::with_capacity(PROBES);
    let mut near: Vec<(f64, usize)> = Vec::with_capacity(among.len());
    for probe in (0..among.len()).step_by(among.len().div_ceil(PROBES)) {
        let place = among[probe];
        near.clear();
        for (i, point) in among.iter().enumerate() {
            if i != probe {
                near.push((point.distance_squared(place), i));
            }
        }
        near.select_nth_unstable_by(NEIGHBOURS, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        near[..NEIGHBOURS].sort_unstable_by_key(|(_, i)| *i);
        apart.push(from_plane(
            place,
            near[..NEIGHBOURS].iter().map(|(_, i)| among[*i]),
        ));
    }
    apart.sort_by(f64::total_cmp);
    1.4826 * apart[apart.len() / 2]
}

/// Returns the distance of a place from the plane that is nearest to points.
fn from_plane(place: DVec3, points: impl Iterator<Item = DVec3> + Clone) -> f64 {
    let middle = points.clone().sum::<DVec3>() / points.clone().count() as f64;
    let mut moments = [[0.0; 4]; 4];
    for point in points {
        let arm = point - middle;
        // The largest eigenvalue of |arm|² − arm·armᵀ is of the direction across the plane.
        for i in 0..3 {
            moments[i][i] += arm.length_squared();
            for j in 0..3 {
                moments[i][j] -= arm[i] * arm[j];
            }
        }
    }
    let [x, y, z, _] = largest_eigenvector(moments);
    (place - middle).dot(DVec3::new(x, y, z)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Disturbance, Numbers};

    #[test]
    fn noise_of_a_ball_is_found_among_outliers() {
        let mut numbers = Numbers::new(3);
        let points: Vec<DVec3> = (0..5000).map(|_| numbers.direction()).collect();
        for (outliers, most) in [(0.0, 1.3), (0.4, 3.0)] {
            for exact in [0.005, 0.02] {
                let disturbance = Disturbance {
                    noise: exact,
                    outliers,
                    seed: 5,
                    ..Disturbance::default()
                };
                let found = noise(&disturbance.apply(&points));
                let ratio = found / exact;
                assert!(ratio > 0.8 && ratio < most, "{outliers} {exact} {found}");
            }
        }
        assert_eq!(noise(&points[..9]), f64::INFINITY);
        // Points anywhere are of no surface.
        let bounds = mesh::Aabb::of_points([-DVec3::ONE, DVec3::ONE]);
        let anywhere: Vec<DVec3> = (0..2000).map(|_| numbers.within(&bounds)).collect();
        assert!(noise(&anywhere) > 0.03);
    }
}
