// What is behind everything: the background, and the ground. Follows view.wgsl.

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4f(corner, 0.5, 1.0);
}

// Colours from above to below change over between 30° above the horizon and 30° below it.
fn background(gaze: vec3f) -> vec3f {
    let share = 0.5 - clamp(dot(gaze, view.zenith.xyz), -0.5, 0.5);
    let place = share * (view.zenith.w - 1.0);
    let first = u32(min(place, 2.0));
    let last = u32(view.zenith.w - 1.0);
    let next = min(first + 1u, last);
    return mix(view.background[min(first, last)].rgb, view.background[next].rgb, place - f32(first));
}

@fragment
fn draw(@builtin(position) position: vec4f) -> Fragment {
    let gaze = gaze_at(position.xy);
    var out: Fragment;
    out.depth = 0.0;
    // Fog without a height hides what is endlessly far.
    let veil = select(0.0, 1.0, view.fog.w > 0.0 && view.levels.z == 0.0);
    var light = mix(background(gaze), view.fog.rgb, veil);
    let eye = view.eye_high.xyz;
    let above = dot(eye, view.zenith.xyz) - view.levels.x;
    let fall = -dot(gaze, view.zenith.xyz);
    if view.ground.w > 0.5 && above > 0.0 && fall > 1e-6 {
        let distance = above / fall;
        let place = eye + distance * gaze;
        let away = length(place - dot(place, view.zenith.xyz) * view.zenith.xyz);
        // It fades into the background, as the tracer's does.
        let cover = 1.0 - smoothstep(4.0, 16.0, away);
        // The ground has its own colour wherever no shadow falls, whatever the lights.
        light = mix(light, foggy(view.ground.rgb, gaze, distance), cover);
        if cover > 0.0 {
            out.depth = depth_at(distance, gaze);
        }
    }
    out.colour = written(light);
    return out;
}
