//! The scene's own rules: the projection, whose radius counts, which elements blend, and the
//! message form.

use field::Skeleton;
use glam::DVec3;
use scene::{
    Body, Camera, Element, Flesh, Fragile, Frame, Light, LightKind, Quadric, Scene, Shape,
    SoftSurface,
};
use trials::{Random, count};

fn soft(radius: f64) -> Flesh {
    Flesh {
        blobbiness: Some(2.0),
        radius,
        ..Flesh::default()
    }
}

fn element(shape: Shape, flesh: u32) -> Element {
    Element {
        flesh: Some(flesh),
        ..Element::new(shape)
    }
}

/// The convolution surface of the body without a name.
fn surface(scene: &Scene) -> SoftSurface {
    let mut surfaces = scene.soft_surfaces();
    assert!(surfaces.len() <= 1, "there is one body");
    surfaces.pop().unwrap_or_default()
}

fn ball(radius: f64) -> Shape {
    Shape::sphere(DVec3::ZERO, radius)
}

fn close(a: DVec3, b: DVec3) -> bool {
    (a - b).length() < 1e-12
}

#[test]
fn the_middle_of_the_picture_looks_at_the_target() {
    let camera = Camera {
        eye: DVec3::new(3.0, 3.0, 3.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        fov: 50.0,
        ..Camera::default()
    };
    let projection = camera.projection(640, 480);
    assert!(close(
        projection.direction(0.5, 0.5),
        -DVec3::ONE.normalize()
    ));
    // Up in the picture is towards +z, right is towards the viewer's right hand.
    assert!(projection.direction(0.5, 0.0).z > projection.direction(0.5, 1.0).z);
    assert!(
        projection
            .direction(1.0, 0.5)
            .dot(DVec3::new(-1.0, 1.0, 0.0))
            > 0.0
    );
}

#[test]
fn the_angle_of_view_is_the_horizontal_one_and_pixels_are_square() {
    let camera = Camera {
        fov: 90.0,
        ..Camera::default()
    };
    let projection = camera.projection(200, 100);
    assert!(close(
        projection.direction(1.0, 0.5),
        DVec3::new(1.0, 0.0, -1.0).normalize()
    ));
    assert!(close(
        projection.direction(0.5, 0.0),
        DVec3::new(0.0, 0.5, -1.0).normalize()
    ));
}

/// Pixels that are not square stretch the picture upwards, and nothing else.
#[test]
fn pixels_that_are_not_square_stretch_the_picture() {
    let square = Camera::default();
    for pixel in [0.5, 1.25, 3.0] {
        let camera = Camera { pixel, ..square };
        let [a, b] = [square, camera].map(|camera| camera.projection(300, 200));
        assert!(close(a.view(0.2, 0.5), b.view(0.2, 0.5)));
        assert!((b.half_height / a.half_height - pixel).abs() < 1e-12);
        assert_eq!((a.half_width, a.shift), (b.half_width, b.shift));
    }
    // Senseless values are repaired.
    for pixel in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300] {
        let view = Camera { pixel, ..square }.projection(3, 2).view(0.0, 0.0);
        assert!(view.is_finite(), "{pixel}");
    }
}

/// The rays of an eye far away pass the places that a parallel projection shows there, within the
/// bound that is promised.
#[test]
fn a_far_eye_sees_as_parallel_rays_do() {
    let mut numbers = Random::new(5);
    for _ in 0..count(500) {
        let normal = numbers.direction();
        let right = normal.any_orthonormal_vector();
        let up = normal.cross(right);
        let lean = 1.2 * numbers.vector(1.0);
        let half = numbers.decades(-2.0, 2.0);
        let camera = Camera {
            target: numbers.vector(3.0),
            ..Camera::default()
        };
        let scale = 0.1 + numbers.unit();
        let direction = DVec3::new(lean.x, lean.y, 1.0) * scale;
        let far = camera.far([right, up, normal], direction, half);
        let projection = far.projection(200, 100);
        let [x, y, z] = [
            numbers.range(-1.0, 1.0),
            0.5 * numbers.range(-1.0, 1.0),
            3.0 * numbers.range(-1.0, 1.0),
        ];
        let place = camera.target + half * (right * x + up * y + normal * z);
        // Along the direction of the rays to the plane through the target.
        let shown = [x - z * lean.x, y - z * lean.y];
        let ray = projection.direction(0.5 + 0.5 * shown[0], 0.5 - shown[1]);
        let from = place - far.eye;
        let apart = (from - ray * from.dot(ray)).length() / half;
        let bound = (1.0 + z.abs()) * (z.abs() * libm::hypot(shown[0], shown[1]) + 1e-6) / 11_459.0;
        assert!(apart <= bound + 1e-9, "{apart} {bound}");
        assert!((far.eye - camera.target).dot(normal) > 11_000.0 * half);
    }
}

#[test]
fn degenerate_cameras_still_project() {
    for camera in [
        Camera {
            eye: DVec3::ZERO,
            target: DVec3::ZERO,
            ..Camera::default()
        },
        Camera {
            up: DVec3::Z,
            ..Camera::default()
        },
        Camera {
            up: DVec3::ZERO,
            eye: DVec3::Y,
            ..Camera::default()
        },
        Camera {
            fov: f64::INFINITY,
            ..Camera::default()
        },
    ] {
        let direction = camera.projection(0, 7).direction(0.3, 0.9);
        assert!(
            (direction.length() - 1.0).abs() < 1e-12,
            "{camera:?} gives {direction}"
        );
    }
}

#[test]
fn fragile_lets_the_material_overrule_a_soft_primitives_radius() {
    let mut scene = Scene {
        flesh: vec![soft(0.5), Flesh::default(), soft(0.0)],
        ..Scene::default()
    };
    let [flesh, bone, bare] = [0, 1, 2].map(|flesh| element(ball(0.2), flesh));
    assert_eq!(scene.radius(&flesh), 0.2);
    scene.settings.fragile = Fragile {
        sphere: true,
        ..Fragile::default()
    };
    assert_eq!(scene.radius(&flesh), 0.5);
    assert_eq!(scene.radius(&bone), 0.2, "hard elements keep their own");
    assert_eq!(
        scene.radius(&bare),
        0.2,
        "a material without a radius has none to give"
    );
    let tube = Shape::cylinder(DVec3::ZERO, DVec3::X, 0.1);
    assert_eq!(
        scene.radius(&element(tube.clone(), 0)),
        0.1,
        "cylinders were not listed"
    );
    scene.settings.fragile = Fragile::ALL;
    assert_eq!(scene.radius(&element(tube, 0)), 0.5);
}

#[test]
fn soft_off_leaves_no_flesh() {
    let mut scene = Scene {
        flesh: vec![soft(0.5), Flesh::default()],
        ..Scene::default()
    };
    scene.elements = vec![element(ball(0.2), 1), element(ball(0.3), 0)];
    let whole = surface(&scene);
    assert_eq!(whole.element, [1], "only the soft element");
    assert!(matches!(
        whole.sum.primitives[0].skeleton,
        Skeleton::Point { .. }
    ));
    scene.settings.soft = false;
    assert!(surface(&scene).sum.primitives.is_empty());
}

#[test]
fn an_isolated_ball_has_its_radius() {
    let mut scene = Scene {
        flesh: vec![soft(0.5)],
        ..Scene::default()
    };
    scene.elements = vec![element(ball(0.3), 0)];
    let field = surface(&scene).sum;
    assert!((field.jet(DVec3::new(0.0, 0.3, 0.0)).value - field::THRESHOLD).abs() < 1e-12);
}

#[test]
fn a_scene_survives_the_journey_to_a_worker() {
    let mut scene = Scene {
        flesh: vec![soft(0.5)],
        ..Scene::default()
    };
    scene.elements = vec![element(Shape::plane(DVec3::ONE, DVec3::Y, 0.1), 0)];
    scene.lights = vec![Light {
        kind: LightKind::Distant { towards: DVec3::Z },
        colour: [1.0, 0.5, 0.25],
        shadow: true,
        size: 0.0,
    }];
    let bytes = postcard::to_allocvec(&scene).expect("packs");
    assert_eq!(
        postcard::from_bytes::<Scene>(&bytes).expect("unpacks"),
        scene
    );
    for cut in 0..bytes.len() {
        assert!(
            postcard::from_bytes::<Scene>(&bytes[..cut]).is_err(),
            "a message cut at {cut} is refused"
        );
    }
}

/// Cutting long and tapered bones into pieces leaves the field as it is.
#[test]
fn limbs_are_cut_without_a_trace() {
    use field::{BlobScale, Kernel, Primitive, Shaping, Sum, Taper};
    let bones = [
        Skeleton::Segment {
            base: DVec3::ZERO,
            apex: DVec3::new(3.0, 0.5, 0.0),
        },
        Skeleton::Arc {
            center: DVec3::ZERO,
            u: DVec3::X,
            v: DVec3::Y,
            radius: 1.5,
            angle: 4.0,
        },
        Skeleton::Curve {
            control: [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 3.0, 0.5), DVec3::Y],
        },
    ];
    for kernel in [Kernel::Cauchy, Kernel::Gauss, Kernel::Quartic] {
        for bone in &bones {
            for end in [None, Some((0.1, 3.0)), Some((0.0, 1.0))] {
                let shaping = Shaping {
                    kernel,
                    radius: 0.4,
                    blobbiness: 1.0,
                    blob_scale: BlobScale::Relative,
                    strength: 1.0,
                    influence: 1e-3,
                    taper: end.map(|(radius, blobbiness)| Taper { radius, blobbiness }),
                };
                let pieces = scene::limbs::cut(bone.clone(), shaping);
                if end.is_some() {
                    assert!(pieces.len() > 3, "{} pieces", pieces.len());
                }
                let one = |(bone, shaping): &(Skeleton, Shaping)| {
                    Primitive::new(bone.clone(), shaping, None).expect("flesh")
                };
                let whole = one(&(bone.clone(), shaping));
                let cut: Sum = pieces.iter().map(one).collect();
                for i in 0..40 {
                    let t = f64::from(i);
                    let p = DVec3::new(libm::sin(t), libm::cos(1.7 * t), 0.3 * libm::sin(2.3 * t));
                    let (a, b) = (whole.value(p.to_array()), cut.jet(p).value);
                    assert!(
                        (a - b).abs() <= 1e-7 * a.max(1.0),
                        "{a} {b}: {kernel:?} {bone:?} {end:?}"
                    );
                }
            }
        }
    }
}

/// The field of one element of a material, at some places.
fn values(shape: Shape, flesh: Flesh) -> Vec<f64> {
    let mut scene = Scene {
        flesh: vec![flesh],
        ..Scene::default()
    };
    scene.settings.fragile = Fragile {
        cylinder: true,
        pipe: true,
        ..Fragile::default()
    };
    scene.elements = vec![element(shape, 0)];
    let field = surface(&scene).sum;
    (0..20)
        .map(|i| {
            let t = f64::from(i);
            let p = DVec3::new(libm::sin(t), libm::cos(1.7 * t), 0.3 * libm::sin(2.3 * t));
            field.jet(p).value
        })
        .collect()
}

#[test]
fn a_soft_cone_is_a_limb_that_tapers() {
    let (base, apex) = (DVec3::new(-0.5, 0.1, 0.0), DVec3::new(0.6, 0.3, 0.2));
    for (from, to) in [(0.4, 0.1), (0.2, 0.2), (0.3, 0.0), (0.0, 0.3)] {
        let cone = Shape::cone(base, from, apex, to);
        // The material's radius is ignored.
        let of_cone = values(cone, soft(7.0));
        let limb = Flesh {
            end_radius: Some(to),
            ..soft(from)
        };
        let radius = 1.0;
        let of_limb = values(Shape::cylinder(base, apex, radius), limb);
        assert!(of_cone[0] > 0.0);
        for (a, b) in of_cone.iter().zip(&of_limb) {
            assert!((a - b).abs() < 1e-9 * a.max(1.0), "{from} {to}: {a} {b}");
        }
    }
    let mut scene = Scene {
        flesh: vec![soft(7.0)],
        ..Scene::default()
    };
    scene.settings.fragile = Fragile::ALL;
    let long = |apex: DVec3, apex_radius: f64| {
        let base = DVec3::ZERO;
        let base_radius = 1.0;
        let shape = Shape::cone(base, base_radius, apex, apex_radius);
        element(shape, 0)
    };
    assert_eq!(scene.radius(&long(DVec3::X, 2.0)), 2.0, "the larger one");
    assert!(scene.is_too_long(&long(DVec3::X * 1e6, 0.5)));
    assert!(!scene.is_too_long(&long(DVec3::X * 1e6, 1.0)), "one width");
}

#[test]
fn pipes_and_patches_have_the_skeletons_of_their_kin() {
    let (base, apex, radius) = (DVec3::NEG_X, DVec3::Y, 0.3);
    for given in [0.0, 0.5] {
        let cylinder = Shape::cylinder(base, apex, radius);
        let pipe = Shape::pipe(base, apex, radius);
        let flesh = soft(given);
        assert_eq!(values(pipe, flesh.clone()), values(cylinder, flesh));
    }
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let normals = [DVec3::Z; 3];
    let flat = Shape::triangle(corners, 0.0);
    let patch = Shape::patch(corners, normals);
    let flesh = soft(0.2);
    assert_eq!(values(patch.clone(), flesh.clone()), values(flat, flesh));
    // As an offset surface it is a prism; without flesh, itself.
    let prism = patch.parts(0.2);
    assert!(matches!(&prism[..], [Shape::Bone(own)] if own.radius == 0.2 && own.normals.is_none()));
    assert_eq!(patch.parts(0.0), [patch]);
}

#[test]
fn shapes_without_a_skeleton_stay_hard() {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let quadric = Quadric {
        square: glam::DMat3::IDENTITY,
        linear: DVec3::ZERO,
        constant: -0.5,
        center: DVec3::ZERO,
        axes,
    };
    let mut scene = Scene {
        flesh: vec![soft(0.5)],
        ..Scene::default()
    };
    let center = DVec3::ZERO;
    scene.elements = vec![
        element(Shape::cuboid(center, axes), 0),
        element(Shape::Quadric(Box::new(quadric)), 0),
    ];
    for element in &scene.elements {
        assert!(!scene.is_soft(element) && scene.radius(element) == 0.0);
    }
    assert!(surface(&scene).sum.primitives.is_empty());
    let bytes = postcard::to_allocvec(&scene).expect("packs");
    assert_eq!(
        postcard::from_bytes::<Scene>(&bytes).expect("unpacks"),
        scene
    );
}

/// Makes two balls in each of two bodies, one after the other, and one in none.
#[test]
fn elements_blend_within_their_body_only() {
    let mut scene = Scene {
        flesh: vec![soft(0.5)],
        ..Scene::default()
    };
    for name in ["A", "EMPTY", "B"] {
        scene.bodies.push(Body { name: name.into() });
    }
    let in_body = |body| Element {
        body,
        ..element(ball(0.3), 0)
    };
    scene.elements = [1, 3, 1, 0, 3].map(in_body).to_vec();
    let surfaces = scene.soft_surfaces();
    let found: Vec<(u32, &[u32])> = surfaces.iter().map(|s| (s.body, &s.element[..])).collect();
    assert_eq!(found, [(0, &[3][..]), (1, &[0, 2]), (3, &[1, 4])]);
    let values = [0, 1, 2].map(|i| surfaces[i].sum.jet(DVec3::ZERO).value);
    assert_eq!([values[1], values[2]], [2.0 * values[0]; 2]);
    // A body that is not there has no surface.
    scene.elements = vec![in_body(4)];
    assert!(scene.soft_surfaces().is_empty());
}

/// Scaling an object is the same as writing everything larger.
#[test]
fn flesh_grows_with_the_frame() {
    use field::BlobScale;
    for blob_scale in [BlobScale::Relative, BlobScale::Absolute] {
        for depth in [0.0, 1.5] {
            let small = Flesh {
                end_radius: Some(0.25),
                depth,
                ..soft(0.5)
            };
            let mut scene = Scene {
                flesh: vec![small.clone(), small.scaled(4.0, blob_scale)],
                frames: vec![
                    Frame::WORLD,
                    Frame {
                        growth: 4.0,
                        ..Frame::WORLD
                    },
                ],
                ..Scene::default()
            };
            scene.settings.blob_scale = blob_scale;
            scene.settings.fragile = Fragile::ALL;
            let (base, apex, radius) = (DVec3::NEG_X, DVec3::Y, 0.3);
            let tube = Shape::cylinder(base, apex, radius);
            let grown = Element {
                frame: 1,
                ..element(tube.clone(), 0)
            };
            let written = element(tube, 1);
            assert_eq!(scene.radius(&grown), scene.radius(&written));
            let mut values = [grown, written].map(|element| {
                scene.elements = vec![element];
                surface(&scene).sum.jet(DVec3::new(0.3, 0.2, 0.9)).value
            });
            assert!(values[0] > 0.0, "{values:?}");
            values.sort_by(f64::total_cmp);
            assert_eq!(values[0], values[1]);
        }
    }
}
