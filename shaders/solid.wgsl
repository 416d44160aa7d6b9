// What the intersections of rays with hard shapes share. A shape's file has a function, as
//     fn meet_sphere(ray: Ray, solid: Solid) -> Hit
// which finds the nearest point of the shape in front of the ray's start.
//
// Every element has its own coordinates, in which its size is about 1, so that neither tiny nor huge elements run out of
// f32's digits.

// A ray in an element's coordinates: the points origin + s * direction.
struct Ray {
    // The point of the ray's line nearest to the element's own origin: seen from far off, the
    // coefficients of the equations stay small.
    origin: vec3f,
    // Unit vector.
    direction: vec3f,
    // The value of s at the eye; what lies before it is behind the eye.
    start: f32,
}

// An element in its own coordinates.
struct Solid {
    // Numbers that the shape's file explains.
    a: vec4f,
    b: vec4f,
    // The box around the element.
    low: vec3f,
    high: vec3f,
}

struct Hit {
    met: bool,
    s: f32,
    // Not necessarily of unit length, nor turned to the eye.
    normal: vec3f,
    // Factor of the material's ambient and diffuse colours.
    paint: vec3f,
}

const WHITE = vec3f(1.0);
const MISS: Hit = Hit(false, 0.0, vec3f(0.0), WHITE);

fn rotate(q: vec4f, v: vec3f) -> vec3f {
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

fn unrotate(q: vec4f, v: vec3f) -> vec3f {
    return rotate(vec4f(-q.xyz, q.w), v);
}

// A little room around the box, so that rounding never cuts a silhouette.
const BOX_ROOM: f32 = 1e-3;

// The first s in front of the eye of a convex solid that the ray enters at `near` and leaves at
// `far`: where it enters it, or for an eye inside, where it leaves it.
fn boundary(ray: Ray, near: f32, far: f32) -> f32 {
    return select(far, near, near > ray.start);
}

// Where a line is between two parallel planes: the values of s at which origin + s * slope is
// -half and half, in order. A parallel line is between them always or never.
fn between(origin: f32, slope: f32, half: f32) -> vec2f {
    if abs(slope) < 1e-12 {
        return select(vec2f(1.0, -1.0), vec2f(-1.0, 1.0), abs(origin) <= half) * 1e30;
    }
    let middle = -origin / slope;
    let reach = half / abs(slope);
    return vec2f(middle - reach, middle + reach);
}
