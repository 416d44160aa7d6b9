// A piece of a torus with flat lids. The origin is the middle of the arc, x leads away from the
// centre of the circle, y along the arc, z along the axis. a: radius of the circle, radius of the
// tube, sine and cosine of half the angle swept; b.x: radius of the circle times that sine;
// b.y: 1 for the whole ring, which has no lids.
//
// With the origin on the arc, and not in the centre of the circle, a slightly bent arc of an
// enormous circle keeps its digits.

// Where a ray is with respect to the circle, and how that changes along the ray.
struct Near {
    // Square of the distance to the circle, less that of the tube's radius: negative inside.
    excess: f32,
    // Derivative of the excess along the ray.
    slope: f32,
    // Distance to the axis.
    axial: f32,
    // Points from the circle to the ray, its length is the distance.
    normal: vec3f,
}

fn near_circle(ray: Ray, solid: Solid, s: f32) -> Near {
    let p = ray.origin + s * ray.direction;
    let sweep = solid.a.x;
    let axial = max(length(vec2f(p.x + sweep, p.y)), 1e-12);
    let outward = vec2f(p.x + sweep, p.y) / axial;
    // axial - sweep, without their cancellation.
    let beyond = (2.0 * sweep * p.x + dot(p.xy, p.xy)) / (axial + sweep);
    var out: Near;
    out.excess = beyond * beyond + p.z * p.z - solid.a.y * solid.a.y;
    out.slope = 2.0 * (beyond * dot(outward, ray.direction.xy) + p.z * ray.direction.z);
    out.axial = axial;
    out.normal = vec3f(beyond * outward, p.z);
    return out;
}

// The most steps to a tube. A step that is proven not to pass the surface is long enough that
// about ten suffice; grazing rays need more.
const STEPS: u32 = 64u;

// The first s in [from, to] where the ray enters the tube, given that it is outside at `from`;
// more than `to` if there is none.
//
// With h the square of the distance to the circle and w the ray's speed across the axis, h''/2 =
// 1 - sweep * (distance to the axis)'' >= 1 - sweep * w^2 / (distance to the axis). As long as that
// distance stays above 3/4 of its present value, a parabola bounds h from below, and up to the
// parabola's root the ray is outside. So it is for a step of the distance to the tube.
fn enter(ray: Ray, solid: Solid, first: f32, last: f32) -> f32 {
    let tube = solid.a.y;
    let across = dot(ray.direction.xy, ray.direction.xy);
    let tolerance = 1e-4 * tube * tube + 1e-6 * tube;
    var s = first;
    for (var i = 0u; i < STEPS; i++) {
        let here = near_circle(ray, solid, s);
        if here.excess <= tolerance {
            break;
        }
        let bend = 1.0 - 4.0 / 3.0 * solid.a.x * across / here.axial;
        let square = here.slope * here.slope - 4.0 * bend * here.excess;
        var safe = 0.25 * here.axial;
        if square >= 0.0 {
            let divisor = sqrt(square) - here.slope;
            if divisor > 0.0 {
                safe = min(safe, 2.0 * here.excess / divisor);
            }
        }
        // distance - tube, without their cancellation
        let apart = here.excess / (length(here.normal) + tube);
        s += max(safe, apart);
        if s > last {
            break;
        }
    }
    return s;
}

// The first s from `first` on where the ray leaves the tube, given that it is inside there. Here
// h''/2 <= 1, so a parabola bounds h from above.
fn leave(ray: Ray, solid: Solid, first: f32) -> f32 {
    let tube = solid.a.y;
    var s = first;
    for (var i = 0u; i < STEPS; i++) {
        let here = near_circle(ray, solid, s);
        if here.excess >= -1e-5 * tube * tube {
            break;
        }
        let root = sqrt(here.slope * here.slope - 4.0 * here.excess);
        s += select(0.5 * (root - here.slope), -2.0 * here.excess / (root + here.slope), here.slope > 0.0);
    }
    return s;
}

// The s at which the ray crosses the lid's half plane, 1e30 if it does not. `side` is 1 for the
// lid where the arc ends, -1 where it begins.
fn cross_lid(ray: Ray, solid: Solid, side: f32) -> f32 {
    let sine = solid.a.z;
    let cosine = solid.a.w;
    let height = side * cosine * ray.origin.y - sine * ray.origin.x - solid.b.x;
    let slope = side * cosine * ray.direction.y - sine * ray.direction.x;
    if abs(slope) < 1e-12 {
        return 1e30;
    }
    let s = -height / slope;
    let p = ray.origin + s * ray.direction;
    // The plane goes on beyond the axis, the lid does not.
    let along = cosine * (p.x + solid.a.x) + side * sine * p.y;
    return select(1e30, s, along >= 0.0);
}

fn lid_normal(solid: Solid, side: f32) -> vec3f {
    return vec3f(-solid.a.z, side * solid.a.w, 0.0);
}

// Whether a point of the ray is in the sector that the arc sweeps.
fn swept(ray: Ray, solid: Solid, s: f32) -> bool {
    let p = ray.origin + s * ray.direction;
    return solid.a.w * abs(p.y) - solid.a.z * p.x - solid.b.x <= 0.0;
}

fn meet_arc(ray: Ray, solid: Solid) -> Hit {
    // The part of the ray within the element's box.
    let half = 0.5 * (solid.high - solid.low) + vec3f(BOX_ROOM);
    let middle = ray.origin - 0.5 * (solid.high + solid.low);
    let x = between(middle.x, ray.direction.x, half.x);
    let y = between(middle.y, ray.direction.y, half.y);
    let z = between(middle.z, ray.direction.z, half.z);
    let first = max(max(x.x, y.x), max(z.x, ray.start));
    let last = min(min(x.y, y.y), z.y);
    if first > last {
        return MISS;
    }

    // Cut it where it crosses the lids' half planes, in the order in which it meets them.
    var crossing = vec2f(1e30);
    var side = vec2f(1.0, -1.0);
    if solid.b.y == 0.0 {
        crossing = vec2f(cross_lid(ray, solid, 1.0), cross_lid(ray, solid, -1.0));
        crossing = select(crossing, vec2f(1e30), crossing <= vec2f(first));
        if crossing.x > crossing.y {
            crossing = crossing.yx;
            side = side.yx;
        }
    }
    let begins_swept = solid.b.y == 1.0 || swept(ray, solid, first);

    // The pieces of the ray that are in the sector: two if it begins there, else one.
    for (var piece = 0u; piece < 2u; piece++) {
        var begin = first;
        var end = min(crossing.x, last);
        var begin_side = 0.0;
        var end_side = select(0.0, side.x, crossing.x <= last);
        if !begins_swept || piece == 1u {
            if begins_swept {
                begin = crossing.y;
                end = last;
                begin_side = side.y;
                end_side = 0.0;
            } else {
                begin = crossing.x;
                end = min(crossing.y, last);
                begin_side = side.x;
                end_side = select(0.0, side.y, crossing.y <= last);
            }
        }
        if begin >= last {
            break;
        }
        if near_circle(ray, solid, begin).excess > 0.0 {
            let s = enter(ray, solid, begin, end);
            if s <= end {
                return Hit(true, s, near_circle(ray, solid, s).normal, WHITE);
            }
        } else if begin_side != 0.0 {
            return Hit(true, begin, lid_normal(solid, begin_side), WHITE);
        } else {
            let s = leave(ray, solid, begin);
            if s < end || end_side == 0.0 {
                return Hit(true, s, near_circle(ray, solid, s).normal, WHITE);
            }
            return Hit(true, end, lid_normal(solid, end_side), WHITE);
        }
        if !begins_swept {
            break;
        }
    }
    return MISS;
}
