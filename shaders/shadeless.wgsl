// The way of all light is free: programs that end with this file draw no shadows.

fn unblocked(light: u32, place: vec3f, normal: vec3f, towards: vec3f, limit: f32) -> f32 {
    return 1.0;
}
