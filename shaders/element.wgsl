// What the draft's shapes share: the box that covers an element on the screen, and the viewing ray in the element's own
// coordinates.
//
// This file follows view.wgsl and solid.wgsl, and a shape's file follows this one. A last line names the shape's function
//     fn meet(ray: Ray, solid: Solid) -> Hit

struct Instance {
    @location(0) origin_high: vec3f,
    @location(1) material: u32,
    @location(2) origin_low: vec3f,
    // Draft units per unit of the element's own coordinates.
    @location(3) unit: f32,
    // Quaternion from the element's own axes to the world's.
    @location(4) rotation: vec4f,
    // Numbers that the shape's file explains.
    @location(5) a: vec4f,
    @location(6) b: vec4f,
    // The box around the element, in its own coordinates.
    @location(7) low: vec3f,
    @location(8) high: vec3f,
}

struct Varying {
    @builtin(position) position: vec4f,
    // xyz: the eye in the element's coordinates; w: draft units per unit of them.
    @location(0) @interpolate(flat, either) eye: vec4f,
    @location(1) @interpolate(flat, either) rotation: vec4f,
    @location(2) @interpolate(flat, either) a: vec4f,
    @location(3) @interpolate(flat, either) b: vec4f,
    @location(4) @interpolate(flat, either) low: vec3f,
    @location(5) @interpolate(flat, either) high: vec3f,
    @location(6) @interpolate(flat, either) material: u32,
}

// The element's origin seen from the eye. Near elements lose no digits, because differences of
// equal-sized numbers are exact.
fn from_eye(instance: Instance) -> vec3f {
    return (instance.origin_high - view.eye_high.xyz) + (instance.origin_low - view.eye_low.xyz);
}

fn vary(instance: Instance, offset: vec3f, position: vec4f) -> Varying {
    var out: Varying;
    out.position = position;
    out.eye = vec4f(unrotate(instance.rotation, -offset) / instance.unit, instance.unit);
    out.rotation = instance.rotation;
    out.a = instance.a;
    out.b = instance.b;
    out.low = instance.low;
    out.high = instance.high;
    out.material = instance.material;
    return out;
}

// Corner 0 … 35 of the twelve triangles of the unit cube, counter-clockwise seen from outside.
fn cube_corner(index: u32) -> vec3f {
    let face = index / 6u;
    let corner = index % 6u;
    let outer = f32(face / 3u);
    var along = vec2f(
        select(0.0, 1.0, corner == 1u || corner == 2u || corner == 4u),
        select(0.0, 1.0, corner == 2u || corner == 4u || corner == 5u),
    );
    if face < 3u {
        along = along.yx;
    }
    switch face % 3u {
        case 0u: { return vec3f(outer, along.x, along.y); }
        case 1u: { return vec3f(along.y, outer, along.x); }
        default: { return vec3f(along.x, along.y, outer); }
    }
}

// The box of an element. Its back faces are drawn, which are there even for an eye inside it.
@vertex
fn cover_box(@builtin(vertex_index) index: u32, instance: Instance) -> Varying {
    let corner = mix(
        instance.low - vec3f(BOX_ROOM),
        instance.high + vec3f(BOX_ROOM),
        cube_corner(index),
    );
    return cover_point(instance, corner);
}

// A corner of what covers an element, given in its own coordinates.
fn cover_point(instance: Instance, corner: vec3f) -> Varying {
    let offset = from_eye(instance);
    let seen = offset + rotate(instance.rotation, corner * instance.unit);
    return vary(instance, offset, on_picture(seen));
}

// The whole picture in one triangle, for what has no end.
@vertex
fn cover_picture(@builtin(vertex_index) index: u32, instance: Instance) -> Varying {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vary(instance, from_eye(instance), vec4f(corner, 0.5, 1.0));
}

@fragment
fn draw(solid: Varying) -> Fragment {
    let gaze = gaze_at(solid.position.xy);
    var ray: Ray;
    ray.direction = unrotate(solid.rotation, gaze);
    ray.start = dot(solid.eye.xyz, ray.direction);
    ray.origin = solid.eye.xyz - ray.start * ray.direction;

    let hit = meet(ray, Solid(solid.a, solid.b, solid.low, solid.high));
    if !hit.met || hit.s <= ray.start {
        discard;
    }
    let distance = (hit.s - ray.start) * solid.eye.w;
    let outward = normalize(rotate(solid.rotation, hit.normal));
    let normal = select(outward, -outward, dot(outward, gaze) > 0.0);
    var look = look_of(solid.material);
    look.ambient *= hit.paint;
    look.diffuse *= hit.paint;
    let light = phong(look, view.eye_high.xyz + distance * gaze, gaze, normal);

    var out: Fragment;
    out.colour = written(foggy(light, gaze, distance));
    out.depth = depth_at(distance, gaze);
    return out;
}
