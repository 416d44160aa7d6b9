//! Tests of mirrors and glass against paths made by hand, with Snell's law written as angles.

use crate::looks::*;
use field::Kernel;
use glam::DVec3;
use scene::{Background, Element, Finish, Light, LightKind, Scene, Shape};
use tracer::{Pass, Picture, Stats, Tile};

const SIZE: [u32; 2] = [48, 36];

/// Returns the direction of a ray behind a surface, by angles; `None` at total reflection. The
/// normal points against the ray.
fn bend(direction: DVec3, normal: DVec3, from: f64, to: f64) -> Option<DVec3> {
    let across = direction - normal * direction.dot(normal);
    let sine = across.length() * from / to;
    (sine < 1.0).then(|| {
        let angle = libm::asin(sine);
        across.normalize_or_zero() * libm::sin(angle) - normal * libm::cos(angle)
    })
}

/// Returns the point where a ray leaves the unit ball of glass, and its direction then; `None` if
/// it passes by.
fn through_ball(origin: DVec3, direction: DVec3, index: f64) -> Option<(DVec3, DVec3)> {
    let b = origin.dot(direction);
    let root = b * b - origin.length_squared() + 1.0;
    // Rays near the rim are bent too much for the ruler's divisions.
    if root < 0.5 {
        return None;
    }
    let at = origin + direction * (-b - root.sqrt());
    let inner = bend(direction, at, 1.0, index)?;
    let out = at - inner * 2.0 * inner.dot(at);
    Some((out, bend(inner, -out, index, 1.0)?))
}

/// Returns the reading of a ruler at this z where a ray meets it, as a byte.
fn reading((origin, direction): (DVec3, DVec3), z: f64, scale: f64) -> f64 {
    let x = origin.x + direction.x * (z - origin.z) / direction.z;
    let u = x * scale;
    (u - u.floor()) * 255.0
}

/// Checks the pixels for which `path` returns the ray beyond the glass; returns their number.
fn compare(
    scene: &Scene,
    scale: f64,
    (channel, bound): (usize, f64),
    path: impl Fn(DVec3, DVec3) -> Option<(DVec3, DVec3)>,
) -> usize {
    let mut count = 0;
    for (pixel, (origin, direction)) in draw(scene, SIZE).iter().zip(rays(scene, SIZE)) {
        if let Some(way) = path(origin, direction) {
            let want = reading(way, -3.0, scale);
            let off = around(pixel[channel], want);
            assert!(off < bound, "{pixel:?} {want} {way:?}");
            count += 1;
        }
    }
    count
}

#[test]
fn a_ball_of_glass_bends_light_by_snells_law() {
    for index in [1.5_f32, 1.1, 0.8] {
        for kernel in [None, Some(Kernel::Cauchy), Some(Kernel::Gauss)] {
            let mut scene = dark();
            ruler(&mut scene, -3.0, 4.0);
            let shape = ball(DVec3::ZERO, 1.0);
            if kernel.is_some() {
                scene.flesh[0].kernel = kernel;
                add_soft(&mut scene, shape, glass(index));
            } else {
                add(&mut scene, shape, glass(index));
            }
            // A soft ball is found within its tolerance, which bends rays by as much.
            let bound = if kernel.is_some() { 6.0 } else { 1.5 };
            let count = compare(&scene, 4.0, (0, bound), |o, d| {
                through_ball(o, d, f64::from(index))
            });
            assert!(count > 100, "{count}");
        }
    }
}

#[test]
fn dispersion_has_three_indices() {
    let mut scene = dark();
    ruler(&mut scene, -3.0, 4.0);
    let finish = Finish {
        dispersion: 0.12,
        ..glass(1.45)
    };
    add(&mut scene, ball(DVec3::ZERO, 1.0), finish);
    // Cauchy's law n = A + B/λ²: green has the index, blue exceeds red by the dispersion.
    let [red, green, blue] = [0.61_f64, 0.55, 0.465].map(|w| 1.0 / (w * w));
    let b = 0.12 / (blue - red);
    for (channel, power) in [red, green, blue].into_iter().enumerate() {
        let index = 1.45 + b * (power - green);
        let count = compare(&scene, 4.0, (channel, 1.5), |o, d| {
            through_ball(o, d, index)
        });
        assert!(count > 100, "{count}");
    }
}

/// Returns the twelve triangles of a box.
fn triangles(low: DVec3, high: DVec3) -> Vec<[DVec3; 3]> {
    let faces = [
        [0, 1, 3, 2],
        [4, 6, 7, 5],
        [0, 4, 5, 1],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 5, 7, 3],
    ];
    let triangles = faces
        .into_iter()
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    triangles
        .map(|triangle| {
            triangle.map(|i| {
                let corner = [0, 1, 2].map(|k| if i >> k & 1 == 0 { low[k] } else { high[k] });
                DVec3::from_array(corner)
            })
        })
        .collect()
}

#[test]
fn slabs_shift_light_whether_boxes_or_meshes() {
    let (low, high) = (DVec3::new(-9.0, -9.0, -0.5), DVec3::new(9.0, 9.0, 1.0));
    let middle = 0.5 * (low + high);
    let half = 0.5 * (high - low);
    let mut whole = dark();
    whole.camera.eye = DVec3::new(3.0, 1.0, 6.0);
    ruler(&mut whole, -3.0, 4.0);
    let mut meshed = whole.clone();
    let axes = [DVec3::X * half.x, DVec3::Y * half.y, DVec3::Z * half.z];
    let center = middle;
    add(&mut whole, Shape::cuboid(center, axes), glass(1.6));
    meshed.finishes.push(glass(1.6));
    for (i, mut corners) in triangles(low, high).into_iter().enumerate() {
        // The order of crossings tells inside from outside, not the corners'.
        if i % 3 == 0 {
            corners.swap(0, 1);
        }
        meshed.elements.push(Element {
            finish: 2,
            ..Element::new(Shape::triangle(corners, 0.0))
        });
    }
    for scene in [whole, meshed] {
        let count = compare(&scene, 4.0, (0, 1.5), |origin, direction| {
            let at = origin + direction * (1.0 - origin.z) / direction.z;
            let inner = bend(direction, DVec3::Z, 1.0, 1.6)?;
            Some((at + inner * -1.5 / inner.z, direction))
        });
        assert_eq!(count, 48 * 36);
    }
}

/// Adds a prism of glass, whose finish is number 1: legs towards −x and +z, the long side between
/// them.
fn add_prism(scene: &mut Scene, index: f32) {
    assert_eq!(scene.finishes.len(), 1);
    scene.finishes.push(glass(index));
    let (a, b, c) = (
        DVec3::new(-1.0, 0.0, 1.0),
        DVec3::new(1.0, 0.0, 1.0),
        DVec3::new(-1.0, 0.0, -1.0),
    );
    let y = DVec3::Y * 2.0;
    let mut corners = vec![[a - y, b - y, c - y], [a + y, b + y, c + y]];
    for (p, q) in [(a, b), (b, c), (c, a)] {
        corners.push([p - y, q - y, q + y]);
        corners.push([p - y, q + y, p + y]);
    }
    for corners in corners {
        scene.elements.push(Element {
            finish: 1,
            ..Element::new(Shape::triangle(corners, 0.0))
        });
    }
}

/// Balls of half-silvered glass inside each other ask for twice the rays at each surface: without a
/// limit 2³² for a pixel.
#[test]
fn rays_of_nested_glass_are_limited() {
    let mut scene = dark();
    (scene.settings.max_depth, scene.settings.vanish) = (32, 0.0);
    for i in 0..8 {
        let half = Finish {
            reflective: [0.5; 3],
            transparent: [0.5; 3],
            ..glass(1.0 + 0.1 * i as f32)
        };
        add(
            &mut scene,
            ball(DVec3::ZERO, 1.0 - 0.1 * f64::from(i)),
            half,
        );
    }
    let tile = Tile {
        x: 0,
        y: 0,
        width: 4,
        height: 4,
    };
    let mut stats = Stats::default();
    let picture = Picture::new(&scene, [4, 4]);
    picture
        .trace(tile, Pass::Full, &|| false, &mut stats)
        .expect("nobody stops");
    let each = stats.secondary_rays / stats.primary_rays;
    assert!(
        (1500..=2048).contains(&each),
        "{each} of {}",
        stats.primary_rays
    );
}

#[test]
fn a_prism_reflects_totally() {
    // Light enters a leg, is reflected at the long side and leaves by the other leg, towards −x.
    let mut scene = dark();
    scene.camera.fov = 8.0;
    add_prism(&mut scene, 1.5);
    for (normal, ambient) in [
        (DVec3::NEG_X, [1.0, 0.0, 0.0]),
        (DVec3::NEG_Z, [0.0, 0.0, 1.0]),
    ] {
        let wall = Shape::plane(normal * 4.0, normal, 0.0);
        let glow = Finish { ambient, ..black() };
        add(&mut scene, wall, glow);
    }
    assert!(draw(&scene, [8, 8]).iter().all(|p| *p == [255, 0, 0]));
    // A prism of less dense glass does not: sin 45° · 1.3 < 1.
    scene.finishes[1].index = 1.3;
    assert!(draw(&scene, [8, 8]).iter().all(|p| *p == [0, 0, 255]));
}

/// A prism whose index is near that of total reflection at 45°, √2, reflects blue and lets red
/// pass.
#[test]
fn colours_part_at_total_reflection() {
    let mut scene = dark();
    // Parallel light, nearly: an angle of a tenth of a degree would change the limit by 0.003.
    (scene.camera.eye, scene.camera.fov) = (DVec3::Z * 60.0, 0.2);
    add_prism(&mut scene, 1.414);
    scene.finishes[1].dispersion = 0.1;
    // Only what has been reflected totally comes here; red goes below it.
    let glow = Finish {
        ambient: [1.0; 3],
        ..black()
    };
    let wall = Shape::cuboid(DVec3::X * -4.0, [DVec3::X * 0.1, DVec3::Y * 2.0, DVec3::Z]);
    add(&mut scene, wall, glow);
    let middle = draw(&scene, [9, 9])[40];
    assert_eq!([middle[0], middle[2]], [0, 255], "{middle:?}");
    // Without dispersion all three are on one side.
    scene.finishes[1].dispersion = 0.0;
    let [r, g, b] = draw(&scene, [9, 9])[40];
    assert!(r == g && g == b, "{r} {g} {b}");
}

/// A ball of glass in a slab of water: each surface lies between the two media on its sides.
#[test]
fn a_body_in_another_bends_light_by_both_indices() {
    const WATER: f64 = 1.33;
    for (index, soft) in [(1.5_f32, false), (1.0, false), (1.5, true)] {
        let mut scene = dark();
        ruler(&mut scene, -3.0, 2.0);
        let center = DVec3::ZERO;
        let axes = [DVec3::X * 9.0, DVec3::Y * 9.0, DVec3::Z * 1.5];
        add(&mut scene, Shape::cuboid(center, axes), glass(1.33));
        let shape = ball(DVec3::ZERO, 1.0);
        if soft {
            add_soft(&mut scene, shape, glass(index));
        } else {
            add(&mut scene, shape, glass(index));
        }
        let bound = if soft { 6.0 } else { 1.5 };
        let count = compare(&scene, 2.0, (0, bound), |origin, direction| {
            let at = origin + direction * (1.5 - origin.z) / direction.z;
            let inner = bend(direction, DVec3::Z, 1.0, WATER)?;
            let b = at.dot(inner);
            let root = b * b - at.length_squared() + 1.0;
            if root < 0.5 {
                return None;
            }
            let at = at + inner * (-b - root.sqrt());
            let index = f64::from(index);
            let within = bend(inner, at, WATER, index)?;
            let at = at - within * 2.0 * within.dot(at);
            let inner = bend(within, -at, index, WATER)?;
            let at = at + inner * (-1.5 - at.z) / inner.z;
            let out = bend(inner, DVec3::Z, WATER, 1.0)?;
            // Grazing rays show the ruler's divisions too small.
            (out.z < -0.4).then_some((at, out))
        });
        assert!(count > 100, "{count}");
    }
}

#[test]
fn a_mirror_shows_what_the_mirrored_eye_sees() {
    let mut scene = dark();
    scene.camera.eye = DVec3::new(0.4, 0.3, 3.0);
    scene.camera.target = DVec3::new(0.1, 0.0, 0.0);
    scene.lights.push(Light::new(
        LightKind::Point {
            position: DVec3::new(4.0, 5.0, 9.0),
        },
        [1.0; 3],
    ));
    let shiny = Finish {
        diffuse: [0.7, 0.4, 0.2],
        specular: [0.5; 3],
        shine: 20.0,
        ..Finish::default()
    };
    // Behind the eye.
    for (x, y) in [(-0.5, 0.2), (0.4, -0.3), (0.7, 0.6)] {
        let place = DVec3::new(x, y, 5.0);
        add_soft(&mut scene, ball(place, 0.5), shiny.clone());
    }
    let mut mirrored = scene.clone();
    for place in [&mut mirrored.camera.eye, &mut mirrored.camera.target] {
        place.z = -place.z;
    }
    let mirror = Finish {
        reflective: [1.0; 3],
        ..black()
    };
    let plane = Shape::plane(DVec3::ZERO, DVec3::Z, 0.0);
    add(&mut scene, plane, mirror);
    let (seen, through) = (draw(&scene, SIZE), draw(&mirrored, SIZE));
    let (mut differ, mut lit) = (0, 0);
    for (i, pixel) in seen.iter().enumerate() {
        // Left and right are exchanged.
        let row = i / 48 * 48;
        let other = through[row + 47 - (i - row)];
        differ += usize::from(apart(*pixel, other) > 2);
        lit += usize::from(*pixel != [0; 3]);
    }
    assert!(lit > 300, "{lit}");
    assert!(differ <= 2, "{differ}");
}

#[test]
fn depth_and_vanishing_end_reflections() {
    // Between two parallel glowing mirrors: glow·(1 + r + r² + …).
    let mut scene = dark();
    for z in [-1.0, 8.0] {
        let mirror = Finish {
            ambient: [0.1; 3],
            reflective: [0.5; 3],
            ..black()
        };
        let plane = Shape::plane(DVec3::Z * z, DVec3::Z, 0.0);
        add(&mut scene, plane, mirror);
    }
    for depth in [0, 1, 2, 7] {
        scene.settings.max_depth = depth;
        scene.settings.vanish = 0.0;
        let sum: f64 = (0..=depth).map(|k| 0.1 * 0.5_f64.powi(k as i32)).sum();
        let got = draw(&scene, [8, 8])[27];
        assert_eq!(got, [(sum * 255.0 + 0.5) as u8; 3]);
    }
    // 0.5⁴ = 0.0625 is sent, 0.5⁵ is not.
    scene.settings.vanish = 0.06;
    let sum: f64 = (0..=4).map(|k| 0.1 * 0.5_f64.powi(k)).sum();
    assert_eq!(draw(&scene, [8, 8])[27], [(sum * 255.0 + 0.5) as u8; 3]);
}

/// Returns soft and hard bodies, nested and overlapping, of one finish.
fn crowd(finish: &Finish) -> Scene {
    let mut scene = dark();
    scene.settings.max_depth = 32;
    scene.settings.vanish = 0.0;
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    add(&mut scene, ball(at(-0.8, 0.5), 0.6), finish.clone());
    add(&mut scene, ball(at(-0.7, 0.5), 0.3), finish.clone());
    add(&mut scene, ball(at(-0.3, 0.4), 0.4), finish.clone());
    for (x, y) in [(0.6, 0.3), (0.9, -0.2), (0.2, -0.5)] {
        add_soft(&mut scene, ball(at(x, y), 0.4), finish.clone());
    }
    let (base, apex) = (at(-0.9, -0.6), at(0.9, -0.4));
    let radius = 0.2;
    add_soft(
        &mut scene,
        Shape::cylinder(base, apex, radius),
        finish.clone(),
    );
    add(&mut scene, Shape::cylinder(base, apex, 0.1), finish.clone());
    scene
}

#[test]
fn glass_in_an_even_light_is_not_seen() {
    // No light is lost: whatever way it takes, it comes from the white background.
    for (index, dispersion, reflective) in [
        (1.5, 0.0, 0.0),
        (1.3, 0.1, 0.25),
        (1.0, 0.0, 0.0),
        (0.7, 0.3, 0.1),
    ] {
        let finish = Finish {
            reflective: [reflective; 3],
            transparent: [1.0 - reflective; 3],
            dispersion,
            ..glass(index)
        };
        let mut scene = crowd(&finish);
        if reflective > 0.0 {
            // Rays part at each surface; the lightest are lost.
            scene.settings.vanish = 0.001;
        }
        scene.background = Background::Colour([1.0; 3]);
        let pixels = draw(&scene, SIZE);
        let lost = pixels.iter().filter(|p| p[1] < 200).count();
        let least = pixels.iter().map(|p| p[1]).min();
        // Light that goes round in a body for more than 32 reflections does not come back.
        assert!(lost <= 12, "{index}: {lost} {least:?}");
    }
}

#[test]
fn index_one_is_as_if_there_were_nothing() {
    let mut empty = dark();
    ruler(&mut empty, -3.0, 4.0);
    let mut scene = crowd(&glass(1.0));
    ruler(&mut scene, -3.0, 4.0);
    let off = draw(&scene, SIZE).into_iter().zip(draw(&empty, SIZE));
    assert!(
        off.map(|(a, b)| around(a[0], f64::from(b[0])))
            .fold(0.0, f64::max)
            <= 1.0
    );
}

#[test]
fn numbers_that_make_no_sense_are_drawn() {
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-30, 1e30] {
        for k in 0..4 {
            let mut finish = Finish {
                diffuse: [0.2; 3],
                reflective: [0.3; 3],
                dispersion: 0.1,
                ..glass(1.5)
            };
            match k {
                0 => finish.index = bad,
                1 => finish.dispersion = bad,
                2 => finish.reflective = [bad; 3],
                _ => finish.transparent = [bad; 3],
            }
            let mut scene = crowd(&finish);
            scene.settings.max_depth = 4;
            scene.background = Background::Colour([0.5; 3]);
            let pixels = draw(&scene, [8, 8]);
            assert_eq!(pixels[0], [128; 3], "beside the bodies");
        }
    }
}

#[test]
fn no_picture_is_brighter_than_its_lights() {
    let finish = Finish {
        diffuse: [0.3; 3],
        specular: [0.1; 3],
        shine: 3.0,
        reflective: [0.3; 3],
        transparent: [0.3; 3],
        index: 1.4,
        ambient: [0.0; 3],
        ..Finish::default()
    };
    let mut scene = crowd(&finish);
    scene.settings.max_depth = 6;
    for (x, colour) in [(4.0, 0.3), (-5.0, 0.25)] {
        let position = DVec3::new(x, 3.0, 5.0);
        scene
            .lights
            .push(Light::new(LightKind::Point { position }, [colour; 3]));
    }
    let most = draw(&scene, SIZE).into_iter().map(|p| p[0]).max();
    assert!(most.is_some_and(|m| (40..=140).contains(&m)), "{most:?}");
}

#[test]
fn light_is_coloured_by_what_it_passes() {
    // A lamp above a white floor, with a pane between: each of its two faces lets its share pass.
    let floor = |finish: Option<Finish>| {
        let mut scene = dark();
        scene.camera.eye = DVec3::new(0.0, 4.0, 4.0);
        scene.camera.fov = 5.0;
        let white = Finish {
            diffuse: [1.0; 3],
            ..black()
        };
        let plane = Shape::plane(DVec3::ZERO, DVec3::Y, 0.0);
        add(&mut scene, plane, white);
        if let Some(finish) = finish {
            let (center, y) = (DVec3::Y * 1.0, DVec3::Y * 0.1);
            let axes = [DVec3::X, y, DVec3::Z].map(|axis| axis * 0.8);
            add(&mut scene, Shape::cuboid(center, axes), finish);
        }
        let towards = DVec3::Y;
        scene
            .lights
            .push(Light::new(LightKind::Distant { towards }, [0.9; 3]));
        draw(&scene, [9, 9])[40]
    };
    let stained = Finish {
        transparent: [0.8, 0.5, 0.0],
        ..glass(1.5)
    };
    let byte = |share: f64| (0.9 * share * 255.0 + 0.5) as u8;
    assert_eq!(floor(None), [byte(1.0); 3]);
    assert_eq!(floor(Some(black())), [0; 3]);
    assert_eq!(floor(Some(stained.clone())), [byte(0.64), byte(0.25), 0]);
    let mut skipped = stained;
    skipped.skip.shadow = true;
    assert_eq!(floor(Some(skipped)), [byte(1.0); 3]);
}

#[test]
fn rays_skip_what_they_are_told_to() {
    // A glowing ball behind the eye, seen in a mirror; and one in front, seen by itself and through
    // a pane.
    let scene = |skip: fn(&mut scene::Skip)| {
        let mut scene = dark();
        let mut glow = Finish {
            ambient: [1.0; 3],
            ..black()
        };
        skip(&mut glow.skip);
        add(
            &mut scene,
            ball(DVec3::new(-1.2, 0.0, 0.0), 0.3),
            glow.clone(),
        );
        add_soft(
            &mut scene,
            ball(DVec3::new(0.0, 0.0, 0.0), 0.3),
            glow.clone(),
        );
        add(&mut scene, ball(DVec3::new(1.2, 0.0, 20.0), 0.9), glow);
        let pane = Shape::cuboid(
            DVec3::new(0.0, 0.0, 1.0),
            [DVec3::X * 0.5, DVec3::Y * 0.5, DVec3::Z * 0.05],
        );
        add(&mut scene, pane, glass(1.0));
        let mirror = Finish {
            reflective: [1.0; 3],
            ..black()
        };
        let axes = [DVec3::X * 0.3, DVec3::Y * 0.3, DVec3::Z * 0.1];
        let center = DVec3::new(1.2, 0.0, 0.0);
        // Tilted so that it shows what is right behind the eye.
        let turn = glam::DMat3::from_rotation_y(-0.1);
        let axes = axes.map(|axis| turn * axis);
        add(&mut scene, Shape::cuboid(center, axes), mirror);
        let pixels = draw(&scene, [49, 13]);
        [6, 24, 42].map(|x| pixels[6 * 49 + x][0] == 255)
    };
    assert_eq!(scene(|_| ()), [true, true, true]);
    assert_eq!(scene(|s| s.pixel = true), [false, true, true]);
    assert_eq!(scene(|s| s.transmitted = true), [true, false, true]);
    assert_eq!(scene(|s| s.reflected = true), [true, true, false]);
    assert_eq!(scene(|s| s.shadow = true), [true, true, true]);
}
