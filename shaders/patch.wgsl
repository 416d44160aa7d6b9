// A triangle in the plane z = 0, lit as if it were curved. a: first and second corner, b.xy: third
// corner, b.zw: the colours at the corners (see `colour_at`). low and high, in order: the normals at
// the corners, two numbers each (see `unfold`).
//
// A unit vector from the square onto which the octahedron |x| + |y| + |z| = 1 unfolds.
fn unfold(flat: vec2f) -> vec3f {
    let z = 1.0 - abs(flat.x) - abs(flat.y);
    let folded = (1.0 - abs(flat.yx)) * select(vec2f(-1.0), vec2f(1.0), flat >= vec2f(0.0));
    return normalize(vec3f(select(flat, folded, z < 0.0), z));
}

// The colour at a corner. Each has 16 bits: 5 of red, 6 of green, 5 of blue; the bits of all three are
// the digits of two whole numbers below 2^24.
fn colour_at(corner: u32, numbers: vec2f) -> vec3f {
    let high = u32(numbers.x);
    let low = u32(numbers.y);
    var bits = high >> 8u;
    if corner == 1u {
        bits = ((high & 0xffu) << 8u) | (low >> 16u);
    }
    if corner == 2u {
        bits = low & 0xffffu;
    }
    return vec3f(f32(bits >> 11u) / 31.0, f32((bits >> 5u) & 63u) / 63.0, f32(bits & 31u) / 31.0);
}

// Twice the signed area of a triangle.
fn area(p: vec2f, q: vec2f, r: vec2f) -> f32 {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

fn meet_patch(ray: Ray, solid: Solid) -> Hit {
    let p = solid.a.xy;
    let q = solid.a.zw;
    let r = solid.b.xy;
    // Seen edge-on, where the ray meets the plane may be far from the triangle. But it does meet the
    // triangle, because that is drawn here.
    let reach = max(max(length(p), length(q)), length(r));
    let steep = abs(ray.direction.z) > 1e-12;
    let s = select(0.0, clamp(-ray.origin.z / ray.direction.z, -reach, reach), steep);
    let at = ray.origin.xy + s * ray.direction.xy;
    // The whole picture element belongs to the triangle, even if its middle is a little outside.
    let weights = max(vec3f(area(at, q, r), area(at, r, p), area(at, p, q)), vec3f(0.0));
    let mixed = weights.x * unfold(solid.low.xy)
        + weights.y * unfold(vec2f(solid.low.z, solid.high.x))
        + weights.z * unfold(solid.high.yz);
    let paint = (weights.x * colour_at(0u, solid.b.zw)
        + weights.y * colour_at(1u, solid.b.zw)
        + weights.z * colour_at(2u, solid.b.zw))
        / max(weights.x + weights.y + weights.z, 1e-30);
    let size = length(mixed);
    let normal = select(vec3f(0.0, 0.0, 1.0), mixed / max(size, 1e-30), size > 1e-15);
    // The side that is seen is the face's, as in crate/tracer/src/hard/patch.rs: a normal that
    // points the other way is turned until it is just edge-on.
    let tilt = dot(normal, ray.direction);
    let facing = select(-1.0, 1.0, normal.z >= 0.0) * ray.direction.z;
    if facing * tilt < 0.0 {
        return Hit(true, s, normal - ray.direction * (tilt - 1e-4 * sign(facing)), paint);
    }
    return Hit(true, s, normal, paint);
}
