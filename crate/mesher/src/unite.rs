//! Boolean operations and convex hulls, by `manifold-rust`.

use crate::options::{MeshError, Progress};
use core::time::Duration;
use glam::DVec3;
use manifold_rust::cancel::CancelToken;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error, MeshGL64, OpType};
use mesh::TriangleMesh;
use std::sync::mpsc::{RecvTimeoutError, channel};

/// Triangles of two meshes that are united in a moment.
const FEW: usize = 10_000;
/// Time between two questions to the caller of a union that takes longer.
const PAUSE: Duration = Duration::from_millis(20);

/// Numbers of a vertex: position, normal, colour.
const PROPERTIES: usize = 9;

fn manifold(mesh: &TriangleMesh) -> Result<Manifold, MeshError> {
    let mut properties = Vec::with_capacity(mesh.positions.len() * PROPERTIES);
    for (i, position) in mesh.positions.iter().enumerate() {
        properties.extend(position.to_array());
        let normal = mesh
            .normals
            .as_ref()
            .map_or(DVec3::ZERO, |normals| normals[i]);
        properties.extend(normal.to_array());
        let color = mesh.colors.as_ref().map_or([1.0; 3], |colors| colors[i]);
        properties.extend(color.map(f64::from));
    }
    let manifold = Manifold::from_mesh_gl64(&MeshGL64 {
        num_prop: PROPERTIES as u64,
        vert_properties: properties,
        tri_verts: mesh
            .triangles
            .as_flattened()
            .iter()
            .map(|i| u64::from(*i))
            .collect(),
        ..MeshGL64::default()
    });
    match manifold.status() {
        Error::NoError => Ok(manifold),
        other => Err(MeshError::Failed(format!(
            "the meshes cannot be united: {other:?}"
        ))),
    }
}

/// The union of two, or the result of another operation. The caller is asked before, and natively
/// all the while: then another thread computes, and ends soon after the caller cancels. In wasm a
/// page ends the worker instead.
fn joined(
    one: &Manifold,
    other: &Manifold,
    operation: OpType,
    progress: &mut Progress<'_>,
) -> Result<Manifold, MeshError> {
    progress.again()?;
    if one.num_tri() + other.num_tri() <= FEW || cfg!(target_arch = "wasm32") {
        return Ok(one.boolean(other, operation));
    }
    let token = CancelToken::new();
    let (sender, united) = channel();
    let compute = {
        let token = token.clone();
        move || {
            // Nobody listens any more to what was cancelled.
            let _ = sender.send(one.boolean_with_token(other, operation, Some(&token)));
        }
    };
    std::thread::scope(|scope| {
        let computing = scope.spawn(compute);
        loop {
            match united.recv_timeout(PAUSE) {
                Ok(united) => return Ok(united),
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(cancelled) = progress.again() {
                        token.cancel();
                        return Err(cancelled);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => {
                    if let Err(panic) = computing.join() {
                        std::panic::resume_unwind(panic);
                    }
                    return Err(MeshError::Cancelled);
                }
            }
        }
    })
}

/// The union of closed meshes, with colours and normals; where two surfaces meet, normals are 0.
///
/// # Errors
/// If one is no closed manifold, or if the caller cancels.
pub fn union(
    meshes: &[TriangleMesh],
    progress: &mut Progress<'_>,
) -> Result<TriangleMesh, MeshError> {
    triangles(&joint(meshes, progress)?)
}

/// Returns the part of a closed mesh that is inside other closed meshes, or outside all of them.
///
/// # Errors
/// If a mesh is not closed or the cut fails, with the reason, or if the caller cancels.
pub fn clip(
    mesh: &TriangleMesh,
    by: &[TriangleMesh],
    is_inside: bool,
    progress: &mut Progress<'_>,
) -> Result<TriangleMesh, MeshError> {
    fn because(error: MeshError, why: &str) -> MeshError {
        match error {
            MeshError::Failed(_) => MeshError::Failed(why.into()),
            other => other,
        }
    }
    let by = joint(by, progress);
    let by = by.map_err(|error| because(error, "the mesh that clips it is not closed"))?;
    let own = manifold(mesh).map_err(|error| because(error, "its own mesh is not closed"))?;
    let operation = match is_inside {
        true => OpType::Intersect,
        false => OpType::Subtract,
    };
    let cut = triangles(&joined(&own, &by, operation, progress)?);
    cut.map_err(|error| because(error, "the cut fails"))
}

/// The union of closed meshes.
fn joint(meshes: &[TriangleMesh], progress: &mut Progress<'_>) -> Result<Manifold, MeshError> {
    let mut manifolds = Vec::with_capacity(meshes.len());
    for mesh in meshes {
        progress.again()?;
        manifolds.push(manifold(mesh)?);
    }
    // In pairs, so that each step is short and few triangles are copied often.
    while manifolds.len() > 1 {
        let mut larger = Vec::with_capacity(manifolds.len().div_ceil(2));
        for pair in manifolds.chunks(2) {
            larger.push(match pair {
                [one, other] => joined(one, other, OpType::Add, progress)?,
                _ => pair[0].clone(),
            });
        }
        manifolds = larger;
    }
    Ok(manifolds.pop().unwrap_or_default())
}

/// The triangles of a result, with colours and normals.
fn triangles(united: &Manifold) -> Result<TriangleMesh, MeshError> {
    if !matches!(united.status(), Error::NoError) {
        return Err(MeshError::Failed(format!(
            "the meshes cannot be united: {:?}",
            united.status()
        )));
    }
    let gl = united.get_mesh_gl64(-1);
    let count = gl.num_prop as usize;
    let vertices: Vec<&[f64]> = gl.vert_properties.chunks_exact(count).collect();
    // Vertices that were doubled because their properties differ are joined again.
    let mut first: Vec<u32> = (0..vertices.len() as u32).collect();
    for (from, to) in gl.merge_from_vert.iter().zip(&gl.merge_to_vert) {
        first[*from as usize] = *to as u32;
    }
    let mut place = vec![u32::MAX; vertices.len()];
    let mut mesh = TriangleMesh::default();
    let (mut normals, mut colors) = (Vec::new(), Vec::new());
    for (i, vertex) in vertices.iter().enumerate() {
        let own = first[i] as usize;
        let normal = match vertex.get(3..6) {
            Some([x, y, z]) => DVec3::new(*x, *y, *z).normalize_or_zero(),
            _ => DVec3::ZERO,
        };
        if place[own] == u32::MAX {
            place[own] = mesh.positions.len() as u32;
            mesh.positions
                .push(DVec3::new(vertex[0], vertex[1], vertex[2]));
            normals.push(normal);
            let color = vertex.get(6..9).map_or([1.0; 3], |c| [c[0], c[1], c[2]]);
            colors.push(color.map(|c| c as f32));
        } else if normals[place[own] as usize].dot(normal) < 0.99 {
            normals[place[own] as usize] = DVec3::ZERO;
        }
        place[i] = place[own];
    }
    let triangles = gl.tri_verts.chunks_exact(3);
    mesh.triangles = triangles
        .map(|t| [t[0], t[1], t[2]].map(|i| place[i as usize]))
        .collect();
    mesh.normals = Some(normals);
    mesh.colors = Some(colors);
    Ok(mesh)
}

/// The convex hull of points; `None` if they have no volume.
pub fn convex_hull(points: &[DVec3]) -> Option<TriangleMesh> {
    let points: Vec<_> = points
        .iter()
        .map(|p| manifold_rust::linalg::Vec3::new(p.x, p.y, p.z))
        .collect();
    let hull = Manifold::hull(&points);
    if hull.is_empty() || !matches!(hull.status(), Error::NoError) {
        return None;
    }
    let gl = hull.get_mesh_gl64(-1);
    let positions = gl.vert_properties.chunks_exact(gl.num_prop as usize);
    let triangles = gl.tri_verts.chunks_exact(3);
    Some(TriangleMesh::new(
        positions.map(|v| DVec3::new(v[0], v[1], v[2])).collect(),
        triangles
            .map(|t| [t[0], t[1], t[2]].map(|i| i as u32))
            .collect(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::ops::ControlFlow;
    use scene::Shape;

    fn ball(center: DVec3, tolerance: f64) -> TriangleMesh {
        let shape = Shape::sphere(center, 1.0);
        let mut solid = crate::solids::tessellate(&shape, 1.0, tolerance, &mesh::Aabb::EMPTY);
        solid.shells.swap_remove(0)
    }

    /// A union the caller of which cancels at a question; the result, and the number of questions.
    fn cancelled_at(
        question: usize,
        meshes: &[TriangleMesh],
    ) -> (Result<TriangleMesh, MeshError>, usize) {
        let mut asked = 0;
        let mut report = |_| {
            asked += 1;
            if asked == question {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let result = union(meshes, &mut Progress::new(&mut report));
        (result, asked)
    }

    #[test]
    fn caller_is_asked_between_all_pairs() {
        let balls: Vec<TriangleMesh> = (0..5)
            .map(|i| ball(DVec3::X * 0.7 * f64::from(i), 0.1))
            .collect();
        // Once for each mesh, and once for each pair.
        let (all, asked) = cancelled_at(0, &balls);
        assert_eq!(asked, 9);
        assert!(all.unwrap().signed_volume() > 8.0);
        for question in 1..=9 {
            let (result, asked) = cancelled_at(question, &balls);
            assert_eq!(result, Err(MeshError::Cancelled));
            assert_eq!(asked, question);
        }
    }

    #[test]
    fn large_pair_is_given_up_while_it_is_computed() {
        let balls = [DVec3::ZERO, DVec3::X].map(|center| ball(center, 5e-5));
        assert!(balls[0].triangles.len() > FEW);
        // The third question is before the computation, the fourth during it.
        let (result, asked) = cancelled_at(4, &balls);
        assert_eq!(result, Err(MeshError::Cancelled));
        assert_eq!(asked, 4);
    }
}
