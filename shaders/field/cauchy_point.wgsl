// b0 b1 b2 b3 b12
fn cauchy_point(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {
    let c0 = constant(at + 0u);
    let c1 = constant(at + 1u);
    let t1 = max(min(((p.x - c0.x) * c0.w), 1000000000.0), (-1000000000.0));
    let t2 = max(min(((p.y - c0.y) * c0.w), 1000000000.0), (-1000000000.0));
    let t3 = max(min(((p.z - c0.z) * c0.w), 1000000000.0), (-1000000000.0));
    let t4 = 1.0 / (1.0 + (((t1 * t1) + (t2 * t2)) + (t3 * t3)));
    let t5 = t4 * t4;
    let t6 = (-2.0) * ((2.0 * t5) * t4);
    let t7 = c1.x * c0.w;
    let t8 = c1.x * t5;
    let t9 = t7 * (t6 * t1);
    let t10 = t7 * (t6 * t2);
    let t11 = t7 * (t6 * t3);
    return vec4<f32>(t8, t9, t10, t11);
}
