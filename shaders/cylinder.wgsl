// A cylinder or a cone along z, with flat lids or without. a.x: radius in the middle; a.y: half the
// length; a.z: how much the radius grows per unit of z; a.w: 1 for a pipe, which has no lids.

fn meet_cylinder(ray: Ray, solid: Solid) -> Hit {
    let lids = between(ray.origin.z, ray.direction.z, solid.a.y);

    // The endless wall: where the ray is within the radius of the axis, seen along the axis. From
    // the point of the ray that is nearest to the axis the equation has no large numbers that
    // cancel. (A ray along the axis has no such point.)
    let slope = dot(ray.direction.xy, ray.direction.xy);
    let middle = select(0.0, -dot(ray.origin.xy, ray.direction.xy) / max(slope, 1e-30), slope > 1e-14);
    let foot = ray.origin + middle * ray.direction;
    let aside = dot(foot.xy, foot.xy);
    let radius = solid.a.x + solid.a.z * foot.z;
    let growth = solid.a.z * ray.direction.z;
    var wall = vec2f(-1e30, 1e30);
    if slope > 1e-14 || growth != 0.0 {
        // steep * s * s - 2 * radius * growth * s + aside - radius * radius, negative inside.
        let square = slope * (radius * radius - aside) + growth * growth * aside;
        if square < 0.0 {
            return MISS;
        }
        let steep = slope - growth * growth;
        let half = radius * growth;
        let sum = half + select(-1.0, 1.0, half >= 0.0) * max(sqrt(square), 1e-15);
        let one = sum / select(steep, 1e-12, abs(steep) < 1e-12);
        let other = (aside - radius * radius) / sum;
        wall = middle + vec2f(min(one, other), max(one, other));
        // A line steeper than the wall is inside from one root on, or up to the other; what lies
        // beyond the tip is no part of the cone.
        if steep <= -1e-12 {
            wall = select(vec2f(-1e30, wall.x), vec2f(wall.y, 1e30), growth > 0.0);
        }
    } else if aside > radius * radius {
        return MISS;
    }

    if solid.a.w > 0.5 {
        let shown = (wall >= lids.xx) & (wall <= lids.yy) & (wall > vec2f(ray.start));
        if !any(shown) {
            return MISS;
        }
        let s = select(wall.y, wall.x, shown.x);
        return Hit(true, s, vec3f(ray.origin.xy + s * ray.direction.xy, 0.0), WHITE);
    }
    let near = max(lids.x, wall.x);
    let far = min(lids.y, wall.y);
    if near > far {
        return MISS;
    }
    let s = boundary(ray, near, far);
    let point = ray.origin + s * ray.direction;
    if s == lids.x || s == lids.y {
        return Hit(true, s, vec3f(0.0, 0.0, 1.0), WHITE);
    }
    return Hit(true, s, vec3f(point.xy, -solid.a.z * (solid.a.x + solid.a.z * point.z)), WHITE);
}
