// b0 b1 b2 b3 b4 b5 b6 b7 b8 b9 b10 b11 b12 b13
fn inverse_segment(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {
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
    let t10 = c3.y + c3.y;
    let t11 = ((t7 * t7) + (t9 * t9)) + 1e-10;
    let t12 = c3.y + t5;
    let t13 = c3.y - t5;
    let t14 = sqrt((t11 + (t12 * t12)));
    let t15 = sqrt((t11 + (t13 * t13)));
    let t16 = t14 + t15;
    let t17 = t14 + abs(t12);
    let t18 = t15 + abs(t13);
    let t19 = select((t11 / t17), t17, (t12 < 0.0)) + select((t11 / t18), t18, (t13 < 0.0));
    let t20 = t10 + t10;
    let t21 = 1.0 / t19;
    let t22 = -(t20 / (t14 * t15));
    let t23 = (t22 * (t16 / (t16 + t10))) * t21;
    let t24 = c3.x * logarithm_of_1_plus((t20 * t21));
    let t25 = c3.x * ((t22 * t5) / t16);
    let t26 = c3.x * (t23 * t7);
    let t27 = c3.x * (t23 * t9);
    let t28 = ((c0.w * t25) + (c1.z * t26)) + (c2.y * t27);
    let t29 = ((c1.x * t25) + (c1.w * t26)) + (c2.z * t27);
    let t30 = ((c1.y * t25) + (c2.x * t26)) + (c2.w * t27);
    return vec4<f32>(t24, t28, t29, t30);
}
