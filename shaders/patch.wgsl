// A triangle in the plane z = 0, lit as if it were curved. a: first and second corner, b.xy: third
// corner. low and high, in order: the normals at the corners, two numbers each (see `unfold`).
//
// What is drawn is the triangle itself, not a box around it, so that triangles with a common edge
// leave no gap, and large meshes cost little.

@vertex
fn cover_corners(@builtin(vertex_index) index: u32, instance: Instance) -> Varying {
    var corner = instance.a.xy;
    if index == 1u {
        corner = instance.a.zw;
    }
    if index == 2u {
        corner = instance.b.xy;
    }
    return cover_point(instance, vec3f(corner, 0.0));
}

// A unit vector from the square onto which the octahedron |x| + |y| + |z| = 1 unfolds.
fn unfold(flat: vec2f) -> vec3f {
    let z = 1.0 - abs(flat.x) - abs(flat.y);
    let folded = (1.0 - abs(flat.yx)) * select(vec2f(-1.0), vec2f(1.0), flat >= vec2f(0.0));
    return normalize(vec3f(select(flat, folded, z < 0.0), z));
}

// Twice the signed area of a triangle.
fn area(p: vec2f, q: vec2f, r: vec2f) -> f32 {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

fn meet(ray: Ray, solid: Varying) -> Hit {
    if abs(ray.direction.z) < 1e-12 {
        return MISS;
    }
    let s = -ray.origin.z / ray.direction.z;
    let at = ray.origin.xy + s * ray.direction.xy;
    let p = solid.a.xy;
    let q = solid.a.zw;
    let r = solid.b.xy;
    // The whole picture element belongs to the triangle, even if its middle is a little outside.
    let weights = max(vec3f(area(at, q, r), area(at, r, p), area(at, p, q)), vec3f(0.0));
    let mixed = weights.x * unfold(solid.low.xy)
        + weights.y * unfold(vec2f(solid.low.z, solid.high.x))
        + weights.z * unfold(solid.high.yz);
    let size = length(mixed);
    let normal = select(vec3f(0.0, 0.0, 1.0), mixed / max(size, 1e-30), size > 1e-15);
    // The side that is seen is the face's, as in crate/tracer/src/hard/patch.rs: a normal that
    // points the other way is turned until it is just edge-on.
    let tilt = dot(normal, ray.direction);
    let facing = select(-1.0, 1.0, normal.z >= 0.0) * ray.direction.z;
    if facing * tilt < 0.0 {
        return Hit(true, s, normal - ray.direction * (tilt - 1e-4 * sign(facing)));
    }
    return Hit(true, s, normal);
}
