// A cylinder with flat lids along z. a.x: radius; a.y: half its length.

fn meet(ray: Ray, solid: Varying) -> Hit {
    let radius = solid.a.x;
    let lids = between(ray.origin.z, ray.direction.z, solid.a.y);

    // The endless cylinder: where the ray is within the radius of the axis, seen along the axis.
    let slope = dot(ray.direction.xy, ray.direction.xy);
    var wall = vec2f(-1e30, 1e30);
    var foot = ray.origin.xy;
    if slope > 1e-14 {
        let middle = -dot(ray.origin.xy, ray.direction.xy) / slope;
        foot = ray.origin.xy + middle * ray.direction.xy;
        let reach = sqrt(max(radius * radius - dot(foot, foot), 0.0) / slope);
        wall = vec2f(middle - reach, middle + reach);
    }
    let near = max(lids.x, wall.x);
    let far = min(lids.y, wall.y);
    if dot(foot, foot) > radius * radius || near > far {
        return MISS;
    }
    let s = boundary(ray, near, far);
    let point = ray.origin + s * ray.direction;
    if s == lids.x || s == lids.y {
        return Hit(true, s, vec3f(0.0, 0.0, 1.0));
    }
    return Hit(true, s, vec3f(point.xy, 0.0));
}
