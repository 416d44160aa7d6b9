use super::*;
use scene::{Element, Shape};

fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

fn near(a: DVec3, b: DVec3) -> bool {
    a.distance(b) <= 1e-9 * (1.0 + a.length())
}

fn camera_from_above() -> Camera {
    Camera {
        eye: DVec3::new(3.0, -2.0, 5.0),
        target: DVec3::new(0.5, 0.25, -1.0),
        up: DVec3::new(0.1, 0.2, 2.0),
        fov: 30.0,
        ..Camera::default()
    }
}

#[test]
fn orbit_keeps_target_distance_and_up() {
    let before = camera_from_above();
    let after = orbit(before, 0.3, -0.1);
    assert_eq!(after.target, before.target);
    assert_eq!(after.up, before.up);
    assert_eq!(after.fov, before.fov);
    let distances = [before, after].map(|c| c.eye.distance(c.target));
    assert!((distances[0] - distances[1]).abs() < 1e-12);
}

#[test]
fn nothing_moves_without_the_pointer() {
    let camera = camera_from_above();
    assert!(near(orbit(camera, 0.0, 0.0).eye, camera.eye));
    assert!(near(pan(camera, 0.0, 0.0, [3, 2]).eye, camera.eye));
    assert!(near(zoom(camera, 1.0).eye, camera.eye));
}

#[test]
fn points_in_front_follow_the_pointer() {
    // A point of the scene on the near side of the target must go right and down with the pointer.
    let camera = camera_from_above();
    let point = camera.target + (camera.eye - camera.target) * 0.1;
    let [(x, y), (u, v)] = [[0.02, 0.0], [0.0, 0.02]].map(|[across, down]| {
        let camera = orbit(camera, across, down);
        let projection = camera.projection(1, 1);
        let place = projection.world_from_view.transpose() * (point - camera.eye);
        (place.x / -place.z, place.y / -place.z)
    });
    assert!(x > 1e-4 && y.abs() < 1e-2, "{x} {y}");
    assert!(v < -1e-4 && u.abs() < 1e-9, "{u} {v}");
}

#[test]
fn a_full_turn_comes_back() {
    let mut camera = camera_from_above();
    for _ in 0..20 {
        camera = orbit(camera, 0.1, 0.0);
    }
    assert!(near(camera.eye, camera_from_above().eye));
}

#[test]
fn orbit_undoes_itself() {
    let there = orbit(camera_from_above(), 0.2, 0.15);
    assert!(near(orbit(there, -0.2, -0.15).eye, camera_from_above().eye));
}

#[test]
fn the_poles_stop_without_a_flip() {
    for sign in [1.0, -1.0] {
        let mut camera = camera_from_above();
        let right = camera.projection(1, 1).world_from_view.x_axis;
        for _ in 0..200 {
            camera = orbit(camera, 0.0, 0.03 * sign);
            let axes = camera.projection(1, 1).world_from_view;
            assert!(near(axes.x_axis, right), "the horizon turned");
            assert!(axes.y_axis.dot(camera.up) > 0.0, "upside down");
            assert!(angle(camera.eye - camera.target, camera.up * sign) > 0.5 * POLE);
        }
        assert!(angle(camera.eye - camera.target, camera.up * sign) < 2.0 * POLE);
    }
}

#[test]
fn orbit_leaves_a_pole_smoothly() {
    // Looking straight along the up vector, the picture's up is arbitrary but fixed; a little
    // pull must change the view a little only.
    let camera = Camera {
        eye: DVec3::new(0.0, 10.0, 0.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov: 45.0,
        ..Camera::default()
    };
    let after = orbit(camera, 0.0, -0.01);
    assert!(angle(camera.eye, after.eye) < 0.05);
}

#[test]
fn pan_moves_the_target_with_the_pointer() {
    let camera = camera_from_above();
    let size = [300, 200];
    let after = pan(camera, 0.25, 0.125, size);
    assert!(near(after.eye - after.target, camera.eye - camera.target));
    // The old target was in the middle; it must be a quarter right and an eighth down now.
    let p = after.projection(size[0], size[1]);
    let seen = p.direction(0.75, 0.625);
    assert!(angle(seen, camera.target - after.eye) < 1e-12);
}

#[test]
fn zoom_has_limits_and_keeps_the_direction() {
    let camera = camera_from_above();
    let direction = (camera.eye - camera.target).normalize();
    let mut nearer = camera;
    let mut farther = camera;
    for _ in 0..500 {
        nearer = zoom(nearer, 0.5);
        farther = zoom(farther, 2.0);
    }
    for (camera, limit) in [(nearer, DISTANCES[0]), (farther, DISTANCES[1])] {
        let way = camera.eye - camera.target;
        assert!((way.length() / limit - 1.0).abs() < 1e-6);
        assert!(angle(way, direction) < 1e-6);
    }
    for senseless in [0.0, -1.0, f64::NAN] {
        assert_eq!(zoom(camera, senseless), camera);
    }
}

#[test]
fn senseless_cameras_and_pointers_give_usable_cameras() {
    let strange = [
        DVec3::NAN,
        DVec3::INFINITY,
        DVec3::splat(1e300),
        DVec3::ZERO,
        DVec3::Y * 1e-300,
        DVec3::Y,
    ];
    for eye in strange {
        for target in strange {
            for up in strange {
                let camera = Camera {
                    eye,
                    target,
                    up,
                    fov: 45.0,
                    ..Camera::default()
                };
                for x in [0.3, f64::NAN, f64::INFINITY, -1e300] {
                    for after in [
                        orbit(camera, x, x),
                        pan(camera, x.clamp(-1e9, 1e9), 0.0, [0, 0]),
                        zoom(camera, x),
                    ] {
                        let p = after.projection(4, 3);
                        assert!(after.eye.is_finite() && after.target.is_finite());
                        assert!(p.world_from_view.is_finite(), "{camera:?} {x}");
                        assert!((p.world_from_view.determinant() - 1.0).abs() < 1e-9);
                    }
                }
            }
        }
    }
}

#[test]
fn frame_sees_everything_and_no_more_than_needed() {
    let ball = |x: f64| Element::new(Shape::sphere(DVec3::new(x, 2.0 * x, 100.0), 3.0));
    let scene = Scene {
        elements: vec![ball(-7.0), ball(4.0), ball(20.0)],
        camera: camera_from_above(),
        ..Scene::default()
    };
    for size in [[400, 300], [300, 400], [1000, 10]] {
        let camera = frame(&scene, scene.camera, size);
        let projection = camera.projection(size[0], size[1]);
        let mut widest: f64 = 0.0;
        for element in &scene.elements {
            let (center, radius) = (element.shape.middle(), element.shape.radius());
            let v = projection.world_from_view.transpose() * (center - camera.eye);
            assert!(-v.z > radius);
            // Well inside: the bounding sphere of the whole scene touches the margin.
            for (x, half) in [(v.x, projection.half_width), (v.y, projection.half_height)] {
                widest = widest.max((x.abs() + radius) / (-v.z - radius) / half);
            }
        }
        assert!(widest < 1.3 && widest > 0.3, "{widest} at {size:?}");
    }
}
