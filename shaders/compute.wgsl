// The compute entry: a pixel of the picture for each invocation. Follows scene.wgsl.

@group(0) @binding(3) var<storage, read> data: array<vec4<u32>>;

struct Pixel {
    colour: vec4f,
    // The unit normal, and the distance; less than 0 where no surface is.
    seen: vec4f,
    // x: evaluations of the field.
    cost: vec4u,
}

@group(0) @binding(4) var<storage, read_write> pixels: array<Pixel>;

fn four(i: u32) -> vec4<u32> {
    return data[i];
}

@compute @workgroup_size(8, 8)
fn trace(@builtin(global_invocation_id) at: vec3u) {
    let size = vec2u(1.0 / view.picture.xy + 0.5);
    if any(at.xy >= size) {
        return;
    }
    let seen = see(vec2f(at.xy) + 0.5);
    pixels[at.y * size.x + at.x] = Pixel(
        seen.colour,
        vec4f(seen.normal, seen.distance),
        vec4u(evaluations, 0u, 0u, 0u),
    );
}
