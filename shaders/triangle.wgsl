// A triangle in the plane z = 0, thickened to a prism. a: first and second corner, b.xy: third
// corner, counter-clockwise; b.z: half the thickness, 0 for a flat triangle.

struct Span {
    near: f32,
    far: f32,
    near_normal: vec3f,
    far_normal: vec3f,
}

// The part of a span that lies on the inner side of the edge from p to q.
fn cut(span: Span, ray: Ray, p: vec2f, q: vec2f) -> Span {
    var out = span;
    let outward = normalize(vec2f(q.y - p.y, p.x - q.x));
    let height = dot(ray.origin.xy - p, outward);
    let slope = dot(ray.direction.xy, outward);
    if abs(slope) < 1e-12 {
        if height > 0.0 {
            out.far = -1e30;
        }
        return out;
    }
    let s = -height / slope;
    if slope < 0.0 && s > out.near {
        out.near = s;
        out.near_normal = vec3f(outward, 0.0);
    }
    if slope > 0.0 && s < out.far {
        out.far = s;
        out.far_normal = vec3f(outward, 0.0);
    }
    return out;
}

fn meet_triangle(ray: Ray, solid: Solid) -> Hit {
    let faces = between(ray.origin.z, ray.direction.z, solid.b.z);
    let z = vec3f(0.0, 0.0, 1.0);
    var span = Span(faces.x, faces.y, z, z);
    span = cut(span, ray, solid.a.xy, solid.a.zw);
    span = cut(span, ray, solid.a.zw, solid.b.xy);
    span = cut(span, ray, solid.b.xy, solid.a.xy);
    if span.near > span.far {
        return MISS;
    }
    if span.near > ray.start {
        return Hit(true, span.near, span.near_normal, WHITE);
    }
    return Hit(true, span.far, span.far_normal, WHITE);
}
