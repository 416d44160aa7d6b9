// A mesh of the true surface of soft elements. Follows view.wgsl.

// As in crate/preview/src/mesh.rs.
const SHINE_OCTAVES: f32 = 12.0;

struct Corner {
    // In units of the mesh, from its origin.
    @location(0) position: vec3f,
    @location(1) normal: vec4f,
    // w: the exponent of the highlight, see `shine`.
    @location(2) ambient: vec4f,
    @location(3) diffuse: vec4f,
    @location(4) specular: vec4f,
    // The mesh's origin in draft units as a sum of two numbers; w of the first: draft units per unit of the mesh.
    @location(5) origin_high: vec4f,
    @location(6) origin_low: vec4f,
}

struct Varying {
    @builtin(position) position: vec4f,
    // From the eye, in draft units.
    @location(0) seen: vec3f,
    @location(1) normal: vec3f,
    @location(2) ambient: vec4f,
    @location(3) diffuse: vec3f,
    @location(4) specular: vec3f,
}

@vertex
fn cover(corner: Corner) -> Varying {
    let offset = (corner.origin_high.xyz - view.eye_high.xyz) + (corner.origin_low.xyz - view.eye_low.xyz);
    let seen = offset + corner.position * corner.origin_high.w;
    var out: Varying;
    out.position = on_picture(seen);
    out.seen = seen;
    out.normal = corner.normal.xyz;
    out.ambient = corner.ambient;
    out.diffuse = corner.diffuse.rgb;
    out.specular = corner.specular.rgb;
    return out;
}

@fragment
fn draw(corner: Varying) -> Fragment {
    let distance = max(length(corner.seen), 1e-30);
    let gaze = corner.seen / distance;
    let size = length(corner.normal);
    let outward = select(-gaze, corner.normal / max(size, 1e-30), size > 1e-6);
    let normal = select(outward, -outward, dot(outward, gaze) > 0.0);
    let shine = exp2(SHINE_OCTAVES * corner.ambient.w) - 1.0;
    let look = Look(corner.ambient.rgb, shine, corner.diffuse, corner.specular);
    let light = phong(look, view.eye_high.xyz + corner.seen, gaze, normal);
    var out: Fragment;
    out.colour = written(foggy(light, gaze, distance));
    out.depth = depth_at(distance, gaze);
    return out;
}
