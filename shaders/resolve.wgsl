// Averages the 2×2 samples of each pixel. The average is taken of light, not of the
// gamma-corrected values that the samples hold.

@group(0) @binding(0) var samples: texture_2d<f32>;
// x: gamma.
@group(0) @binding(1) var<uniform> tone: vec4f;

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4f(corner, 0.5, 1.0);
}

fn light(at: vec2u) -> vec3f {
    return pow(textureLoad(samples, at, 0).rgb, vec3f(tone.x));
}

@fragment
fn resolve(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = vec2u(position.xy) * 2u;
    let sum = light(at)
        + light(at + vec2u(1u, 0u))
        + light(at + vec2u(0u, 1u))
        + light(at + vec2u(1u, 1u));
    return vec4f(pow(0.25 * sum, vec3f(1.0 / tone.x)), 1.0);
}
