// b0 b1 b2 b3 b4 b5 b6 b7 b8 b9 b10 b11 p0 p1 p2 p3 p4 p5 p6 p7 p8 p9 p10 p11 p12
fn profile_plane(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {
    let c0 = constant(at + 0u);
    let c1 = constant(at + 1u);
    let c2 = constant(at + 2u);
    let c3 = constant(at + 3u);
    let c4 = constant(at + 4u);
    let c5 = constant(at + 5u);
    let c6 = constant(at + 6u);
    let t1 = p.x - c0.x;
    let t2 = p.y - c0.y;
    let t3 = p.z - c0.z;
    let t4 = ((c0.w * t1) + (c1.x * t2)) + (c1.y * t3);
    let t5 = ((c1.z * t1) + (c1.w * t2)) + (c2.x * t3);
    let t6 = ((c4.w * t4) + (c5.x * t5)) + c5.w;
    let t7 = ((c5.y * t4) + (c5.z * t5)) + c6.x;
    let t8 = c3.z * min(max(t6, 0.0), 1.0);
    let t9 = sine_cosine(t8);
    let t10 = 0.5 * t9.x;
    let t11 = 0.5 * t9.y;
    let t12 = (2.0 * t9.x) * t9.y;
    let t13 = t8 - floor(t8);
    var t14_0 = 0.0;
    var t14_1 = 0.0;
    switch u32(c3.x + 0.5) {
        case 0u: {
            t14_0 = 1.0;
        }
        case 1u: {
            let t15 = min(max(t8, 0.0), 1.0);
            let t16 = select(0.0, 1.0, ((0.0 < t8) && (t8 < 1.0)));
            t14_0 = t15;
            t14_1 = t16;
        }
        case 2u: {
            let t17 = 0.5 + t10;
            t14_0 = t17;
            t14_1 = t11;
        }
        case 3u: {
            let t18 = 0.5 + t11;
            let t19 = -t10;
            t14_0 = t18;
            t14_1 = t19;
        }
        case 4u: {
            let t20 = t9.x * t9.x;
            t14_0 = t20;
            t14_1 = t12;
        }
        case 5u: {
            let t21 = t9.y * t9.y;
            let t22 = -t12;
            t14_0 = t21;
            t14_1 = t22;
        }
        case 6u: {
            t14_0 = t13;
            t14_1 = 1.0;
        }
        case 7u: {
            let t23 = (2.0 * t13) - 1.0;
            let t24 = 1.0 - abs(t23);
            let t25 = -select(2.0, (-2.0), (t23 < 0.0));
            t14_0 = t24;
            t14_1 = t25;
        }
        default: {
            let t26 = select(1.0, 0.0, (t13 < 0.5));
            t14_0 = t26;
        }
    }
    let t27 = select(0.0, (c3.z * t14_1), ((0.0 < t6) && (t6 < 1.0)));
    let t28 = c3.w * min(max(t7, 0.0), 1.0);
    let t29 = sine_cosine(t28);
    let t30 = 0.5 * t29.x;
    let t31 = 0.5 * t29.y;
    let t32 = (2.0 * t29.x) * t29.y;
    let t33 = t28 - floor(t28);
    var t34_0 = 0.0;
    var t34_1 = 0.0;
    switch u32(c3.y + 0.5) {
        case 0u: {
            t34_0 = 1.0;
        }
        case 1u: {
            let t35 = min(max(t28, 0.0), 1.0);
            let t36 = select(0.0, 1.0, ((0.0 < t28) && (t28 < 1.0)));
            t34_0 = t35;
            t34_1 = t36;
        }
        case 2u: {
            let t37 = 0.5 + t30;
            t34_0 = t37;
            t34_1 = t31;
        }
        case 3u: {
            let t38 = 0.5 + t31;
            let t39 = -t30;
            t34_0 = t38;
            t34_1 = t39;
        }
        case 4u: {
            let t40 = t29.x * t29.x;
            t34_0 = t40;
            t34_1 = t32;
        }
        case 5u: {
            let t41 = t29.y * t29.y;
            let t42 = -t32;
            t34_0 = t41;
            t34_1 = t42;
        }
        case 6u: {
            t34_0 = t33;
            t34_1 = 1.0;
        }
        case 7u: {
            let t43 = (2.0 * t33) - 1.0;
            let t44 = 1.0 - abs(t43);
            let t45 = -select(2.0, (-2.0), (t43 < 0.0));
            t34_0 = t44;
            t34_1 = t45;
        }
        default: {
            let t46 = select(1.0, 0.0, (t33 < 0.5));
            t34_0 = t46;
        }
    }
    let t47 = select(0.0, (c3.w * t34_1), ((0.0 < t7) && (t7 < 1.0)));
    let t48 = t27 * t34_0;
    let t49 = t14_0 * t47;
    let t50 = c4.x + (c4.y * (t14_0 * t34_0));
    let t51 = (1.0 - t6) - t7;
    let t52 = 0.0 < min(min(t6, t7), t51);
    let t53 = 27.0 * c4.z;
    let t54 = (1.0 - c4.z) + select(0.0, (t53 * ((t6 * t7) * t51)), t52);
    let t55 = select(0.0, (t53 * (t7 * (t51 - t6))), t52);
    let t56 = select(0.0, (t53 * (t6 * (t51 - t7))), t52);
    let t57 = t54 * (c4.y * ((t48 * c4.w) + (t49 * c5.y)));
    let t58 = t57 + (t50 * ((t55 * c4.w) + (t56 * c5.y)));
    let t59 = t54 * (c4.y * ((t48 * c5.x) + (t49 * c5.z)));
    let t60 = t59 + (t50 * ((t55 * c5.x) + (t56 * c5.z)));
    let t61 = t50 * t54;
    let t62 = ((c0.w * t58) + (c1.z * t60)) + (c2.y * 0.0);
    let t63 = ((c1.x * t58) + (c1.w * t60)) + (c2.z * 0.0);
    let t64 = ((c1.y * t58) + (c2.x * t60)) + (c2.w * 0.0);
    return vec4<f32>(t61, t62, t63, t64);
}
