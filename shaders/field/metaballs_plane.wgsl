// b0 b1 b2 b3 b4 b5 b6 b7 b8 b9 b10 b11 b12
fn metaballs_plane(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {
    let c0 = constant(at + 0u);
    let c1 = constant(at + 1u);
    let c2 = constant(at + 2u);
    let c3 = constant(at + 3u);
    let t1 = (c2.y * (p.x - c0.x)) + (c2.z * (p.y - c0.y));
    let t2 = min((t1 + (c2.w * (p.z - c0.z))), 1000000000.0);
    let t3 = max(t2, (-1000000000.0));
    let t4 = abs(t3);
    let t5 = max((1.0 - t4), 0.0);
    let t6 = 3.0 * t4;
    let t7 = max((1.0 - t6), 0.0);
    let t8 = 0.055555556 * (((t7 * t7) * t7) * (1.0 + (3.0 * t6)));
    let t9 = (1.5 * (((t5 * t5) * t5) * (1.0 + t6))) - t8;
    let t10 = t3 * t3;
    let t11 = max((1.0 - max(sqrt(t10), 0.16666667)), 0.0);
    let t12 = select(((1.5 * t11) * t11), (1.0 - (3.0 * t10)), (t10 < 0.11111111));
    let t13 = c3.x * (0.5235988 * t9);
    let t14 = c3.x * 0.0;
    let t15 = c3.x * (((-6.2831855) * t3) * t12);
    let t16 = ((c0.w * t14) + (c1.z * t14)) + (c2.y * t15);
    let t17 = ((c1.x * t14) + (c1.w * t14)) + (c2.z * t15);
    let t18 = ((c1.y * t14) + (c2.x * t14)) + (c2.w * t15);
    return vec4<f32>(t13, t16, t17, t18);
}
