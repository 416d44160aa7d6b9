// b0 b1 b2 b3 b4 b5 b6 b7 b8 b9 b10 b11 p0 p1 p2 p3 p4 p5 p6 p7 p8 p9 p10 p11
fn profile_circle(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {
    let c0 = constant(at + 0u);
    let c1 = constant(at + 1u);
    let c2 = constant(at + 2u);
    let c3 = constant(at + 3u);
    let c4 = constant(at + 4u);
    let c5 = constant(at + 5u);
    let t1 = p.x - c0.x;
    let t2 = p.y - c0.y;
    let t3 = p.z - c0.z;
    let t4 = c4.w + (((c0.w * t1) + (c1.x * t2)) + (c1.y * t3));
    let t5 = c5.x * t4;
    let t6 = c5.x * (((c1.z * t1) + (c1.w * t2)) + (c2.x * t3));
    let t7 = max(((t5 * t5) + (t6 * t6)), 1e-30);
    let t8 = c4.w * c4.w;
    let t9 = t7 + t8;
    let t10 = t8 / t9;
    let t11 = (4.0 * t10) * (1.0 - t10);
    let t12 = (((8.0 * t10) * ((2.0 * t10) - 1.0)) / t9) * c5.x;
    let t13 = abs(t6);
    let t14 = abs(t5);
    let t15 = min(t13, t14);
    let t16 = max(t13, t14);
    let t17 = (t16 * 0.41421357) < t15;
    let t18 = select(t15, (t15 - t16), t17) / max(select(t16, (t15 + t16), t17), 1e-37);
    let t19 = t18 * t18;
    let t20 = ((((-0.069082156) * t19) + 0.1089104) * t19) + (-0.14278346);
    let t21 = (-0.33333334) + (t19 * ((t20 * t19) + 0.1999996));
    let t22 = t18 + ((t18 * t19) * t21);
    let t23 = select(t22, (t22 + 0.7853982), t17);
    let t24 = select(t23, (1.5707964 - t23), (t14 < t13));
    let t25 = select(t24, (3.1415927 - t24), (t5 < 0.0));
    let t26 = (select(t25, (-t25), (t6 < 0.0)) + c5.y) * c5.z;
    let t27 = (-((c5.x * t6) * c5.z)) / t7;
    let t28 = ((c5.x * t5) * c5.z) / t7;
    let t29 = c3.z * min(max(t26, 0.0), 1.0);
    let t30 = sine_cosine(t29);
    let t31 = 0.5 * t30.x;
    let t32 = 0.5 * t30.y;
    let t33 = (2.0 * t30.x) * t30.y;
    let t34 = t29 - floor(t29);
    var t35_0 = 0.0;
    var t35_1 = 0.0;
    switch u32(c3.x + 0.5) {
        case 0u: {
            t35_0 = 1.0;
        }
        case 1u: {
            let t36 = min(max(t29, 0.0), 1.0);
            let t37 = select(0.0, 1.0, ((0.0 < t29) && (t29 < 1.0)));
            t35_0 = t36;
            t35_1 = t37;
        }
        case 2u: {
            let t38 = 0.5 + t31;
            t35_0 = t38;
            t35_1 = t32;
        }
        case 3u: {
            let t39 = 0.5 + t32;
            let t40 = -t31;
            t35_0 = t39;
            t35_1 = t40;
        }
        case 4u: {
            let t41 = t30.x * t30.x;
            t35_0 = t41;
            t35_1 = t33;
        }
        case 5u: {
            let t42 = t30.y * t30.y;
            let t43 = -t33;
            t35_0 = t42;
            t35_1 = t43;
        }
        case 6u: {
            t35_0 = t34;
            t35_1 = 1.0;
        }
        case 7u: {
            let t44 = (2.0 * t34) - 1.0;
            let t45 = 1.0 - abs(t44);
            let t46 = -select(2.0, (-2.0), (t44 < 0.0));
            t35_0 = t45;
            t35_1 = t46;
        }
        default: {
            let t47 = select(1.0, 0.0, (t34 < 0.5));
            t35_0 = t47;
        }
    }
    let t48 = select(0.0, (c3.z * t35_1), ((0.0 < t26) && (t26 < 1.0)));
    let t49 = c3.w * 0.0;
    let t50 = sine_cosine(t49);
    let t51 = 0.5 * t50.x;
    let t52 = 0.5 * t50.y;
    let t53 = (2.0 * t50.x) * t50.y;
    let t54 = t49 - floor(t49);
    var t55_0 = 0.0;
    var t55_1 = 0.0;
    switch u32(c3.y + 0.5) {
        case 0u: {
            t55_0 = 1.0;
        }
        case 1u: {
            let t56 = min(max(t49, 0.0), 1.0);
            let t57 = select(0.0, 1.0, ((0.0 < t49) && (t49 < 1.0)));
            t55_0 = t56;
            t55_1 = t57;
        }
        case 2u: {
            let t58 = 0.5 + t51;
            t55_0 = t58;
            t55_1 = t52;
        }
        case 3u: {
            let t59 = 0.5 + t52;
            let t60 = -t51;
            t55_0 = t59;
            t55_1 = t60;
        }
        case 4u: {
            let t61 = t50.x * t50.x;
            t55_0 = t61;
            t55_1 = t53;
        }
        case 5u: {
            let t62 = t50.y * t50.y;
            let t63 = -t53;
            t55_0 = t62;
            t55_1 = t63;
        }
        case 6u: {
            t55_0 = t54;
            t55_1 = 1.0;
        }
        case 7u: {
            let t64 = (2.0 * t54) - 1.0;
            let t65 = 1.0 - abs(t64);
            let t66 = -select(2.0, (-2.0), (t64 < 0.0));
            t55_0 = t65;
            t55_1 = t66;
        }
        default: {
            let t67 = select(1.0, 0.0, (t54 < 0.5));
            t55_0 = t67;
        }
    }
    let t68 = t48 * t55_0;
    let t69 = (t35_0 * 0.0) * 0.0;
    let t70 = (t35_0 * t55_0) - c5.w;
    let t71 = (t11 * ((t68 * t27) + t69)) + (t70 * (t12 * t5));
    let t72 = (t11 * ((t68 * t28) + t69)) + (t70 * (t12 * t6));
    let t73 = c4.x + (c4.y * (c5.w + (t11 * t70)));
    let t74 = 1.0 - t26;
    let t75 = 0.0 < min(min(t26, 0.0), t74);
    let t76 = 27.0 * c4.z;
    let t77 = (1.0 - c4.z) + select(0.0, (t76 * ((t26 * 0.0) * t74)), t75);
    let t78 = select(0.0, (t76 * (0.0 * (t74 - t26))), t75);
    let t79 = select(0.0, (t76 * (t26 * t74)), t75) * 0.0;
    let t80 = (t77 * (c4.y * t71)) + (t73 * ((t78 * t27) + t79));
    let t81 = (t77 * (c4.y * t72)) + (t73 * ((t78 * t28) + t79));
    let t82 = t73 * t77;
    let t83 = ((c0.w * t80) + (c1.z * t81)) + (c2.y * 0.0);
    let t84 = ((c1.x * t80) + (c1.w * t81)) + (c2.z * 0.0);
    let t85 = ((c1.y * t80) + (c2.x * t81)) + (c2.w * 0.0);
    return vec4<f32>(t82, t83, t84, t85);
}
