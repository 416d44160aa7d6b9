// What is seen behind everything: the background, and the ground. Follows view.wgsl.

// Colours from above to below change over between 30° above the horizon and 30° below it.
fn background(gaze: vec3f) -> vec3f {
    let share = 0.5 - clamp(dot(gaze, view.zenith.xyz), -0.5, 0.5);
    let place = share * (view.zenith.w - 1.0);
    let first = u32(min(place, 2.0));
    let last = u32(view.zenith.w - 1.0);
    let next = min(first + 1u, last);
    return mix(view.background[min(first, last)].rgb, view.background[next].rgb, place - f32(first));
}

// The ground along a ray from the eye: its distance, and how much of it covers the background; 0 where there is none.
fn ground_along(gaze: vec3f) -> vec2f {
    let eye = view.eye.xyz;
    let above = dot(eye, view.zenith.xyz) - view.levels.x;
    let fall = -dot(gaze, view.zenith.xyz);
    if view.ground.w < 0.5 || above <= 0.0 || fall <= 1e-6 {
        return vec2f(0.0);
    }
    let distance = above / fall;
    let place = eye + distance * gaze;
    let away = length(place - dot(place, view.zenith.xyz) * view.zenith.xyz);
    // It fades into the background, as the tracer's does.
    return vec2f(distance, 1.0 - smoothstep(4.0, 16.0, away));
}

// Light from behind everything. `shade` darkens the ground.
fn behind(gaze: vec3f, ground: vec2f, shade: f32) -> vec3f {
    // Fog without a height hides what is endlessly far.
    let veil = select(0.0, 1.0, view.fog.w > 0.0 && view.levels.z == 0.0);
    let light = mix(background(gaze), view.fog.rgb, veil);
    // The ground has its own colour wherever no shadow falls, whatever the lights.
    return mix(light, foggy(view.ground.rgb * shade, gaze, ground.x), ground.y);
}
