// The fragment entry: data come as a texture, since WebGL2 has no storage buffers. Follows scene.wgsl.

@group(0) @binding(3) var data: texture_2d<u32>;

fn four(i: u32) -> vec4<u32> {
    return textureLoad(data, vec2u(i & 2047u, i >> 11u), 0);
}

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4f(corner, 0.5, 1.0);
}

@fragment
fn draw(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return see(position.xy).colour;
}
