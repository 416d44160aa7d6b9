//! Judges of meshes.

use field::{Ball, Implicit, THRESHOLD};
use glam::DVec3;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error, MeshGL64};
use mesh::{Bvh, Topology, TriangleMesh, closest_point, self_intersections};
use trials::{Random, count};

/// Whether our half-edges and `manifold-rust` take a mesh for a closed manifold, of the volume that
/// we say it has.
pub fn manifold(mesh: &TriangleMesh) -> Result<(), String> {
    let topology = Topology::of(mesh).map_err(|error| error.to_string())?;
    if !topology.is_closed_manifold() {
        return Err(topology.to_string());
    }
    let positions = mesh.positions.iter().flat_map(|p| p.to_array());
    let judge = Manifold::from_mesh_gl64(&MeshGL64 {
        num_prop: 3,
        vert_properties: positions.collect(),
        tri_verts: mesh
            .triangles
            .as_flattened()
            .iter()
            .map(|i| u64::from(*i))
            .collect(),
        ..MeshGL64::default()
    });
    if !matches!(judge.status(), Error::NoError) {
        return Err(format!("no manifold: {:?}", judge.status()));
    }
    let (ours, theirs) = (mesh.signed_volume(), judge.volume());
    // The judge merges vertices that are nearer to each other than its own tolerance.
    if (ours - theirs).abs() > 3e-5 * mesh.area() * mesh.bounds().size().length() {
        return Err(format!("volumes {ours} and {theirs}"));
    }
    Ok(())
}

pub fn assert_manifold(name: &str, mesh: &TriangleMesh) {
    manifold(mesh).unwrap_or_else(|why| panic!("{name}: {why}"));
}

/// Whether a mesh is proved not to cut itself.
pub fn assert_embedded(name: &str, mesh: &TriangleMesh) {
    let crossings = self_intersections(mesh, 10).unwrap();
    assert!(crossings.is_free(), "{name}: {crossings:?}");
}

/// A point of the surface near a point, by steps of Newton's.
pub fn on_surface(function: &dyn Implicit, mut point: DVec3) -> Option<DVec3> {
    for _ in 0..30 {
        let jet = function.jet(point);
        let gradient = DVec3::from_array(jet.gradient);
        let step = gradient * ((THRESHOLD - jet.value) / gradient.length_squared());
        point += step.clamp_length_max(0.1);
        if step.length() < 1e-12 {
            return Some(point);
        }
    }
    None
}

/// A point of a triangle of a mesh, and the triangle.
pub fn of_mesh(random: &mut Random, mesh: &TriangleMesh) -> (usize, DVec3) {
    let i = random.below(mesh.triangles.len());
    (i, random.in_triangle(mesh.corners(i)))
}

/// Distances from a mesh.
pub struct Distances<'a> {
    mesh: &'a TriangleMesh,
    bvh: Bvh,
}

impl<'a> Distances<'a> {
    pub fn new(mesh: &'a TriangleMesh) -> Self {
        let bvh = Bvh::new(&mesh.triangle_boxes());
        Self { mesh, bvh }
    }

    pub fn to(&self, point: DVec3) -> f64 {
        let closest =
            |i: u32| closest_point(&self.mesh.corners(i as usize), point).distance_squared(point);
        let nearest = self.bvh.nearest(point, f64::INFINITY, closest);
        nearest.map_or(f64::INFINITY, |(_, square)| square.sqrt())
    }
}

/// The largest distances found, by sampling, from the mesh to the surface and from the surface to
/// the mesh.
pub fn distances(function: &dyn Implicit, mesh: &TriangleMesh, samples: usize) -> [f64; 2] {
    let near = Distances::new(mesh);
    let mut farthest = [0.0_f64; 2];
    let mut random = Random::new(7);
    for _ in 0..count(samples) {
        let (i, point) = of_mesh(&mut random, mesh);
        let Some(found) = on_surface(function, point) else {
            continue;
        };
        farthest[0] = farthest[0].max(point.distance(found));
        // A point of the surface somewhere near, found from outside of the mesh.
        let [a, b, c] = mesh.corners(i);
        let size = a.distance(b).max(a.distance(c));
        if let Some(found) = on_surface(function, point + 0.5 * random.vector(1.0) * size) {
            farthest[1] = farthest[1].max(near.to(found));
        }
    }
    farthest
}

/// Crossings of a ray with a surface, by bounds in balls around its parts: none that is left out is
/// wider than the resolution.
pub fn crossings(
    function: &dyn Implicit,
    origin: DVec3,
    direction: DVec3,
    to: f64,
    resolution: f64,
) -> Vec<f64> {
    let mut found = Vec::new();
    let mut stack = vec![[0.0, to]];
    let mut patience = 20_000;
    let value = |t: f64| function.jet(origin + direction * t).value;
    while let Some([a, b]) = stack.pop() {
        patience -= 1;
        if patience == 0 {
            break;
        }
        let radius = 0.5 * (b - a);
        let center = origin + direction * (a + radius);
        let range = function.enclose(Ball { center, radius }).value;
        if range[0] > THRESHOLD || range[1] < THRESHOLD {
            continue;
        }
        if b - a < resolution {
            if (value(a) > THRESHOLD) != (value(b) > THRESHOLD) {
                found.push(0.5 * (a + b));
            }
            continue;
        }
        stack.push([a + radius, b]);
        stack.push([a, a + radius]);
    }
    found
}
