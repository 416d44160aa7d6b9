// Draws what is behind everything. Follows view.wgsl and sky.wgsl.

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4f(corner, 0.5, 1.0);
}

@fragment
fn draw(@builtin(position) position: vec4f) -> Fragment {
    let gaze = gaze_at(position.xy);
    let ground = ground_along(gaze);
    var out: Fragment;
    out.depth = select(0.0, depth_at(ground.x, gaze), ground.y > 0.0);
    out.colour = written(behind(gaze, ground, 1.0));
    return out;
}
