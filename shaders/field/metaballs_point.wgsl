// b0 b1 b2 b3 b12
fn metaballs_point(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {
    let c0 = constant(at + 0u);
    let c1 = constant(at + 1u);
    let t1 = max(min(((p.x - c0.x) * c0.w), 1000000000.0), (-1000000000.0));
    let t2 = max(min(((p.y - c0.y) * c0.w), 1000000000.0), (-1000000000.0));
    let t3 = max(min(((p.z - c0.z) * c0.w), 1000000000.0), (-1000000000.0));
    let t4 = ((t1 * t1) + (t2 * t2)) + (t3 * t3);
    let t5 = max(sqrt(t4), 0.16666667);
    let t6 = max((1.0 - t5), 0.0);
    let t7 = t4 < 0.11111111;
    let t8 = 1.5 * t6;
    let t9 = (-2.0) * select((t8 / t5), 3.0, t7);
    let t10 = c1.x * c0.w;
    let t11 = c1.x * select((t8 * t6), (1.0 - (3.0 * t4)), t7);
    let t12 = t10 * (t9 * t1);
    let t13 = t10 * (t9 * t2);
    let t14 = t10 * (t9 * t3);
    return vec4<f32>(t11, t12, t13, t14);
}
