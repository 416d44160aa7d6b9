// b3 b4 b5 b6 b7 b8 b9 b10 b11 p0 p1 p2 p3 p4 p5 p6
fn profile_nowhere(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {
    let c0 = constant(at + 0u);
    let c1 = constant(at + 1u);
    let c2 = constant(at + 2u);
    let c3 = constant(at + 3u);
    let t1 = c2.w * 0.0;
    let t2 = sine_cosine(t1);
    let t3 = 0.5 * t2.x;
    let t4 = 0.5 * t2.y;
    let t5 = (2.0 * t2.x) * t2.y;
    let t6 = t1 - floor(t1);
    var t7_0 = 0.0;
    var t7_1 = 0.0;
    switch u32(c2.y + 0.5) {
        case 0u: {
            t7_0 = 1.0;
        }
        case 1u: {
            let t8 = min(max(t1, 0.0), 1.0);
            let t9 = select(0.0, 1.0, ((0.0 < t1) && (t1 < 1.0)));
            t7_0 = t8;
            t7_1 = t9;
        }
        case 2u: {
            let t10 = 0.5 + t3;
            t7_0 = t10;
            t7_1 = t4;
        }
        case 3u: {
            let t11 = 0.5 + t4;
            let t12 = -t3;
            t7_0 = t11;
            t7_1 = t12;
        }
        case 4u: {
            let t13 = t2.x * t2.x;
            t7_0 = t13;
            t7_1 = t5;
        }
        case 5u: {
            let t14 = t2.y * t2.y;
            let t15 = -t5;
            t7_0 = t14;
            t7_1 = t15;
        }
        case 6u: {
            t7_0 = t6;
            t7_1 = 1.0;
        }
        case 7u: {
            let t16 = (2.0 * t6) - 1.0;
            let t17 = 1.0 - abs(t16);
            let t18 = -select(2.0, (-2.0), (t16 < 0.0));
            t7_0 = t17;
            t7_1 = t18;
        }
        default: {
            let t19 = select(1.0, 0.0, (t6 < 0.5));
            t7_0 = t19;
        }
    }
    let t20 = c3.x * 0.0;
    let t21 = sine_cosine(t20);
    let t22 = 0.5 * t21.x;
    let t23 = 0.5 * t21.y;
    let t24 = (2.0 * t21.x) * t21.y;
    let t25 = t20 - floor(t20);
    var t26_0 = 0.0;
    var t26_1 = 0.0;
    switch u32(c2.z + 0.5) {
        case 0u: {
            t26_0 = 1.0;
        }
        case 1u: {
            let t27 = min(max(t20, 0.0), 1.0);
            let t28 = select(0.0, 1.0, ((0.0 < t20) && (t20 < 1.0)));
            t26_0 = t27;
            t26_1 = t28;
        }
        case 2u: {
            let t29 = 0.5 + t22;
            t26_0 = t29;
            t26_1 = t23;
        }
        case 3u: {
            let t30 = 0.5 + t23;
            let t31 = -t22;
            t26_0 = t30;
            t26_1 = t31;
        }
        case 4u: {
            let t32 = t21.x * t21.x;
            t26_0 = t32;
            t26_1 = t24;
        }
        case 5u: {
            let t33 = t21.y * t21.y;
            let t34 = -t24;
            t26_0 = t33;
            t26_1 = t34;
        }
        case 6u: {
            t26_0 = t25;
            t26_1 = 1.0;
        }
        case 7u: {
            let t35 = (2.0 * t25) - 1.0;
            let t36 = 1.0 - abs(t35);
            let t37 = -select(2.0, (-2.0), (t35 < 0.0));
            t26_0 = t36;
            t26_1 = t37;
        }
        default: {
            let t38 = select(1.0, 0.0, (t25 < 0.5));
            t26_0 = t38;
        }
    }
    let t39 = ((0.0 * t26_0) * 0.0) + ((t7_0 * 0.0) * 0.0);
    let t40 = c3.y + (c3.z * (t7_0 * t26_0));
    let t41 = 1.0 - c3.w;
    let t42 = (t41 * (c3.z * t39)) + (t40 * 0.0);
    let t43 = t40 * t41;
    let t44 = ((c0.x * t42) + (c0.w * t42)) + (c1.z * 0.0);
    let t45 = ((c0.y * t42) + (c1.x * t42)) + (c1.w * 0.0);
    let t46 = ((c0.z * t42) + (c1.y * t42)) + (c2.x * 0.0);
    return vec4<f32>(t43, t44, t45, t46);
}
