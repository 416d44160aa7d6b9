// b0 b1 b2 b3 b12
fn soft_point(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {
    let c0 = constant(at + 0u);
    let c1 = constant(at + 1u);
    let t1 = max(min(((p.x - c0.x) * c0.w), 1000000000.0), (-1000000000.0));
    let t2 = max(min(((p.y - c0.y) * c0.w), 1000000000.0), (-1000000000.0));
    let t3 = max(min(((p.z - c0.z) * c0.w), 1000000000.0), (-1000000000.0));
    let t4 = max((1.0 - (((t1 * t1) + (t2 * t2)) + (t3 * t3))), 0.0);
    let t5 = 0.44444445 * t4;
    let t6 = (-2.0) * (t4 * (1.1111112 + (3.0 * t5)));
    let t7 = c1.x * c0.w;
    let t8 = c1.x * ((t4 * t4) * (0.5555556 + t5));
    let t9 = t7 * (t6 * t1);
    let t10 = t7 * (t6 * t2);
    let t11 = t7 * (t6 * t3);
    return vec4<f32>(t8, t9, t10, t11);
}
