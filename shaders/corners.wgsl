// Covers a triangle by itself, not by a box around it, so that large meshes cost little. Follows patch.wgsl.

// What f32 may be off by, as a share of a distance. Triangles grow by so much, so that no ray passes
// between those with a common edge.
const ROUNDING: f32 = 5e-7;

@vertex
fn cover_corners(@builtin(vertex_index) index: u32, instance: Instance) -> Varying {
    var corner = instance.a.xy;
    if index == 1u {
        corner = instance.a.zw;
    }
    if index == 2u {
        corner = instance.b.xy;
    }
    let p = instance.a.xy;
    let q = instance.a.zw;
    let r = instance.b.xy;
    // Away from the middle: edges move as the radius of the inscribed circle grows.
    let around = distance(p, q) + distance(q, r) + distance(r, p);
    let inscribed = abs(area(p, q, r)) / around;
    let room = ROUNDING * (length(from_eye(instance)) / instance.unit + 1.0);
    let growth = min(room / max(inscribed, 1e-30), 0.1);
    let middle = (p + q + r) / 3.0;
    return cover_point(instance, vec3f(corner + growth * (corner - middle), 0.0));
}
