//! The stiffness of a control mesh: the energy of displacements that differ between neighbours.

use glam::DVec3;

/// Entries of the matrix K with `XᵀKX = ∫ |∇X|²` over the triangles, for X linear on each: linear
/// finite elements. Each pair (i, j) with i ≥ j stands for both of its places. Degenerate triangles
/// add nothing.
pub(crate) fn stiffness(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<(u32, u32, f64)> {
    let mut entries = Vec::new();
    for triangle in triangles {
        let corners = triangle.map(|i| positions[i as usize]);
        let area = 0.5
            * (corners[1] - corners[0])
                .cross(corners[2] - corners[0])
                .length();
        let longest = (0..3)
            .map(|i| corners[i].distance_squared(corners[(i + 1) % 3]))
            .fold(0.0, f64::max);
        // Slivers would be infinitely stiff.
        if area <= 1e-3 * longest {
            continue;
        }
        // The gradient of a corner's hat function is the opposite side, turned, over twice the
        // area.
        let sides = [0, 1, 2].map(|i| corners[(i + 2) % 3] - corners[(i + 1) % 3]);
        for i in 0..3 {
            for j in 0..=i {
                let value = sides[i].dot(sides[j]) / (4.0 * area);
                let (a, b) = (triangle[i].max(triangle[j]), triangle[i].min(triangle[j]));
                entries.push((a, b, value));
            }
        }
    }
    entries
}

/// `½ Σ XᵀKX` over the three axes.
pub(crate) fn energy(entries: &[(u32, u32, f64)], moves: &[DVec3]) -> f64 {
    entries
        .iter()
        .map(|(i, j, value)| {
            let product = moves[*i as usize].dot(moves[*j as usize]) * value;
            if i == j { 0.5 * product } else { product }
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_the_integral_of_the_gradient() {
        // A square of side 2 in two triangles; a linear field with the gradient (3, −1): ½ ∫ |∇X|²
        // = ½·10·4.
        let positions = [
            DVec3::ZERO,
            DVec3::new(2.0, 0.0, 0.0),
            DVec3::new(2.0, 2.0, 0.0),
            DVec3::new(0.0, 2.0, 0.0),
        ];
        let entries = stiffness(&positions, &[[0, 1, 2], [0, 2, 3]]);
        let moves = positions.map(|p| DVec3::X * (3.0 * p.x - p.y + 7.0));
        assert!((energy(&entries, &moves) - 20.0).abs() < 1e-12);
        assert!(energy(&entries, &[DVec3::ONE; 4]).abs() < 1e-12);
        assert!(stiffness(&positions, &[[0, 1, 1]]).is_empty());
    }
}
