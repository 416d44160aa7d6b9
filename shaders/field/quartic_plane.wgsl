// b0 b1 b2 b3 b4 b5 b6 b7 b8 b9 b10 b11 b12
fn quartic_plane(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {
    let c0 = constant(at + 0u);
    let c1 = constant(at + 1u);
    let c2 = constant(at + 2u);
    let c3 = constant(at + 3u);
    let t1 = (c2.y * (p.x - c0.x)) + (c2.z * (p.y - c0.y));
    let t2 = min((t1 + (c2.w * (p.z - c0.z))), 1000000000.0);
    let t3 = max(t2, (-1000000000.0));
    let t4 = max((1.0 - (t3 * t3)), 0.0);
    let t5 = t4 * t4;
    let t6 = 0.0 * t4;
    let t7 = c3.x * ((t5 * t4) * (1.0471976 + t6));
    let t8 = c3.x * 0.0;
    let t9 = c3.x * (((-6.2831855) * t3) * (t5 * (1.0 + t6)));
    let t10 = ((c0.w * t8) + (c1.z * t8)) + (c2.y * t9);
    let t11 = ((c1.x * t8) + (c1.w * t8)) + (c2.z * t9);
    let t12 = ((c1.y * t8) + (c2.x * t8)) + (c2.w * t9);
    return vec4<f32>(t7, t10, t11, t12);
}
