// b0 b1 b2 b3 b4 b5 b6 b7 b8 b9 b10 b11 b12 | 37+5: 0 1 2 3
fn cauchy_curve(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {
    let c0 = constant(at + 0u);
    let c1 = constant(at + 1u);
    let c2 = constant(at + 2u);
    let c3 = constant(at + 3u);
    let t1 = p.x - c0.x;
    let t2 = p.y - c0.y;
    let t3 = p.z - c0.z;
    let t4 = min((((c0.w * t1) + (c1.x * t2)) + (c1.y * t3)), 1000000000.0);
    let t5 = max(t4, (-1000000000.0));
    let t6 = min((((c1.z * t1) + (c1.w * t2)) + (c2.x * t3)), 1000000000.0);
    let t7 = max(t6, (-1000000000.0));
    let t8 = min((((c2.y * t1) + (c2.z * t2)) + (c2.w * t3)), 1000000000.0);
    let t9 = max(t8, (-1000000000.0));
    var t10_0 = 0.0;
    var t10_1 = 0.0;
    var t10_2 = 0.0;
    var t10_3 = 0.0;
    for (var t11 = 0u; t11 < count; t11++) {
        let t11_0_0 = constant(at + 4u + 1u * t11);
        let t12 = t5 - t11_0_0.x;
        let t13 = t7 - t11_0_0.y;
        let t14 = t9 - t11_0_0.z;
        let t15 = ((t12 * t12) + (t13 * t13)) + (t14 * t14);
        let t16 = 1.0 / (1.0 + t15);
        let t17 = t16 * t16;
        let t18 = t11_0_0.w * t17;
        let t19 = t11_0_0.w * (-((2.0 * t17) * t16));
        let t20 = t19 * t12;
        let t21 = t19 * t13;
        let t22 = t19 * t14;
        t10_0 += t18;
        t10_1 += t20;
        t10_2 += t21;
        t10_3 += t22;
    }
    let t23 = c3.x * t10_0;
    let t24 = c3.x * (t10_1 + t10_1);
    let t25 = c3.x * (t10_2 + t10_2);
    let t26 = c3.x * (t10_3 + t10_3);
    let t27 = ((c0.w * t24) + (c1.z * t25)) + (c2.y * t26);
    let t28 = ((c1.x * t24) + (c1.w * t25)) + (c2.z * t26);
    let t29 = ((c1.y * t24) + (c2.x * t25)) + (c2.w * t26);
    return vec4<f32>(t23, t27, t28, t29);
}
