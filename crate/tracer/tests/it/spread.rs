//! Tests of lens, soft shadows, shutter, sky and fog in pictures against their laws.

use crate::looks::*;
use core::f64::consts::PI;
use glam::DVec3;
use scene::{Finish, Fog, Ground, Lens, Light, LightKind, Scene, Shape, Skip, Sky};
use tracer::{Pass, Picture, Stats, Tile, render, tiles};

fn glowing(colour: [f32; 3]) -> Finish {
    Finish {
        ambient: colour,
        ..black()
    }
}

fn white() -> Finish {
    Finish {
        diffuse: [1.0; 3],
        specular: [0.0; 3],
        ..black()
    }
}

/// Returns the pixels across the picture for one unit of length at the distance 1 from the eye.
fn scale(scene: &Scene, size: [u32; 2]) -> f64 {
    let half = libm::tan(scene.camera.fov.to_radians() * 0.5);
    0.5 * f64::from(size[0]) / half
}

/// Returns the mean of each column's green values, 0 … 1.
fn columns(picture: &[[u8; 3]], width: u32) -> Vec<f64> {
    let width = width as usize;
    let height = (picture.len() / width) as f64;
    (0..width)
        .map(|x| {
            let column = picture.iter().skip(x).step_by(width);
            column.map(|p| f64::from(p[1]) / 255.0).sum::<f64>() / height
        })
        .collect()
}

/// The mean square distance from the middle of an even disc is half its radius' square, and adds to
/// that of the ball's image.
#[test]
fn a_small_ball_is_blurred_to_the_circle_of_confusion() {
    const SIZE: [u32; 2] = [64, 64];
    for (z, focus, aperture, radius) in [(4.0, 8.0, 0.67, 0.13), (6.0, 3.0, 0.25, 0.2)] {
        let mut scene = dark();
        scene.settings.samples = 8;
        scene.lens = Lens {
            aperture,
            focus: Some(focus),
        };
        let ball = ball(DVec3::Z * (6.0 - z), radius);
        add(&mut scene, ball, glowing([1.0; 3]));
        let picture = draw_pass(&scene, SIZE, Pass::Smooth);
        let (mut sum, mut moment) = (0.0, 0.0);
        for (i, pixel) in picture.iter().enumerate() {
            let [x, y] = [i % 64, i / 64].map(|c| c as f64 + 0.5 - 32.0);
            sum += f64::from(pixel[0]);
            moment += f64::from(pixel[0]) * (x * x + y * y);
        }
        let own = radius / z * scale(&scene, SIZE);
        let got = (2.0 * moment / sum - own * own).sqrt();
        let want = aperture * (focus - z).abs() / (z * focus) * scale(&scene, SIZE);
        assert!((got / want - 1.0).abs() < 0.03, "{z}: {got} {want} pixels");
    }
}

/// A sharp ball is as without a lens, but for rounding.
#[test]
fn what_is_in_focus_is_sharp() {
    let mut scene = dark();
    scene.settings.samples = 4;
    scene.settings.contrast = [0.0; 3];
    let disc = Shape::triangle(
        [
            DVec3::new(-1.0, -1.0, 0.0),
            DVec3::new(1.0, -1.0, 0.0),
            DVec3::new(0.0, 1.0, 0.0),
        ],
        0.0,
    );
    add(&mut scene, disc, glowing([1.0; 3]));
    let sharp = draw_pass(&scene, [32; 2], Pass::Smooth);
    scene.lens.aperture = 0.3;
    let lens = draw_pass(&scene, [32; 2], Pass::Smooth);
    assert_eq!(sharp, lens);
}

/// Returns a floor, z = 0, seen from above, with a triangle that the eye does not see.
fn floor(blocker: Option<[DVec3; 3]>) -> Scene {
    let mut scene = dark();
    scene.up = DVec3::Z;
    scene.settings.samples = 8;
    let plane = Shape::plane(DVec3::ZERO, DVec3::Z, 0.0);
    add(&mut scene, plane, white());
    if let Some(corners) = blocker {
        let unseen = Finish {
            skip: Skip {
                pixel: true,
                ..Skip::default()
            },
            ..black()
        };
        let radius = 0.0;
        add(&mut scene, Shape::triangle(corners, radius), unseen);
    }
    scene
}

#[test]
fn a_penumbra_is_the_share_of_the_disc_that_is_seen() {
    const SIZE: [u32; 2] = [32, 8];
    let edge = [
        DVec3::new(0.0, -40.0, 2.0),
        DVec3::new(0.0, 40.0, 2.0),
        DVec3::new(-40.0, 0.0, 2.0),
    ];
    let (position, towards) = (DVec3::Z * 4.0, DVec3::Z);
    // The line of sight to the edge, half way up, meets the light's height at −x; a distant light's
    // disc, which is at the distance 1, at −x/2.
    for (kind, size, reach) in [
        (LightKind::Point { position }, 1.0, 1.0),
        (LightKind::Distant { towards }, 0.3, 0.6),
    ] {
        let [free, shadowed] = [None, Some(edge)].map(|blocker| {
            let mut scene = floor(blocker);
            scene.settings.penumbra = true;
            scene.lights.push(Light {
                size,
                ..Light::new(kind, [1.0; 3])
            });
            columns(&draw_pass(&scene, SIZE, Pass::Smooth), SIZE[0])
        });
        let pixel = 6.0 / scale(&dark(), SIZE);
        for x in 0..SIZE[0] as usize {
            let c = ((x as f64 + 0.5 - 16.0) * pixel / reach).clamp(-1.0, 1.0);
            let want = 0.5 + (c * (1.0 - c * c).sqrt() + libm::asin(c)) / PI;
            let got = shadowed[x] / free[x];
            assert!((got - want).abs() < 0.02, "{kind:?} {c}: {got} {want}");
        }
    }
}

/// The cosine's law within the cone, and the edge's polynomial of the angle.
#[test]
fn a_spot_lights_its_cone() {
    const SIZE: [u32; 2] = [40, 40];
    let (position, angle, edge) = (DVec3::new(0.2, -0.1, 3.0), 24.0, 9.0);
    let mut scene = floor(None);
    let kind = LightKind::Spot {
        position,
        direction: DVec3::NEG_Z,
        angle,
        edge,
    };
    scene.lights.push(Light::new(kind, [1.0; 3]));
    let (mut full, mut soft, mut dark) = (0, 0, 0);
    for (pixel, (origin, direction)) in draw(&scene, SIZE).iter().zip(rays(&scene, SIZE)) {
        let point = origin - direction * (origin.z / direction.z);
        let across = libm::hypot(point.x - position.x, point.y - position.y);
        let off = libm::atan2(across, position.z);
        let inner = ((angle - off.to_degrees()) / edge).clamp(0.0, 1.0);
        let share = inner * inner * (3.0 - 2.0 * inner);
        full += u32::from(share == 1.0);
        soft += u32::from(share > 0.0 && share < 1.0);
        dark += u32::from(share == 0.0);
        let want = 255.0 * share * libm::cos(off);
        let got = f64::from(pixel[1]);
        assert!((got - want).abs() <= 1.0, "{point}: {got} {want}");
    }
    assert!(full > 50 && soft > 50 && dark > 50, "{full} {soft} {dark}");
}

/// The share is held to a sum over directions spread as their cosine, each met with the wall by
/// hand.
#[test]
fn a_wall_hides_its_share_of_the_sky() {
    const SIZE: [u32; 2] = [32, 8];
    let wall = [
        DVec3::new(-1.0, -4000.0, -4000.0),
        DVec3::new(-1.0, 4000.0, -4000.0),
        DVec3::new(-1.0, 0.0, 1.0),
    ];
    let [free, hidden] = [None, Some(wall)].map(|blocker| {
        let mut scene = floor(blocker);
        scene.sky = Some(Sky {
            colour: [0.9; 3],
            horizon: [0.9; 3],
            samples: 1,
        });
        columns(&draw_pass(&scene, SIZE, Pass::Smooth), SIZE[0])
    });
    let pixel = 6.0 / scale(&dark(), SIZE);
    for x in 0..SIZE[0] as usize {
        let from = (x as f64 + 0.5 - 16.0) * pixel + 1.0;
        if from > 0.1 {
            const STEPS: u32 = 200;
            let mut open = 0;
            for i in 0..STEPS * STEPS {
                let [a, b] =
                    [i / STEPS, i % STEPS].map(|k| (f64::from(k) + 0.5) / f64::from(STEPS));
                let (r, angle) = (a.sqrt(), 2.0 * PI * b);
                let (dx, dy) = (r * libm::cos(angle), r * libm::sin(angle));
                let t = -from / dx;
                let (y, z) = (t * dy, t * (1.0 - r * r).sqrt());
                // The wall is a triangle with its top at y = 0, z = 1.
                let is_hidden = dx < 0.0 && z < 1.0 - y.abs() * 4001.0 / 4000.0;
                open += u32::from(!is_hidden);
            }
            let want = f64::from(open) / f64::from(STEPS * STEPS);
            let got = hidden[x] / free[x];
            assert!((got - want).abs() < 0.02, "{from}: {got} {want}");
        }
    }
}

#[test]
fn an_open_shutter_shows_shares_of_time() {
    const SIZE: [u32; 2] = [48, 4];
    const MOMENTS: u32 = 16;
    let (radius, from, to) = (0.5, -1.0, 1.0);
    let at = |x: f64| {
        let mut scene = dark();
        scene.settings.samples = 4;
        let block = Shape::sphere(DVec3::new(x, 0.0, 0.0), radius);
        add(&mut scene, block, glowing([1.0; 3]));
        scene
    };
    let mut scene = at(from);
    for i in 0..MOMENTS {
        let share = (f64::from(i) + 0.5) / f64::from(MOMENTS);
        scene.moments.push(at(from + (to - from) * share));
    }
    let picture = draw_pass(&scene, SIZE, Pass::Smooth);
    let still = draw_pass(&scene, SIZE, Pass::Full);
    let alone = draw_pass(&at(from), SIZE, Pass::Full);
    assert_eq!(still, alone, "one ray a pixel shows the frame itself");
    let pixel = 6.0 / scale(&scene, SIZE);
    let mut off = 0.0;
    for x in 0..SIZE[0] as usize {
        let place = (x as f64 + 0.5 - 24.0) * pixel;
        // The middle of the ball is within its radius, but for the picture's few rows.
        let first = (place - radius).clamp(from, to);
        let last = (place + radius).clamp(from, to);
        let want = (last - first) / (to - from);
        let got = f64::from(picture[SIZE[0] as usize + x][0]) / 255.0;
        assert!(
            (got - want).abs() < 1.6 / f64::from(MOMENTS),
            "{place}: {got} {want}"
        );
        off += (got - want) / f64::from(SIZE[0]);
    }
    assert!(off.abs() < 0.01, "{off}");
}

#[test]
fn fog_takes_light_by_the_exponential_law() {
    let distance = 5.0;
    let mut scene = dark();
    scene.fog = Some(Fog {
        colour: [0.0, 0.0, 1.0],
        distance,
        height: None,
    });
    let plane = Shape::plane(DVec3::Z * -3.0, DVec3::new(0.8, 0.0, 0.6), 0.0);
    add(&mut scene, plane, glowing([1.0, 0.0, 0.0]));
    const SIZE: [u32; 2] = [24, 24];
    for (pixel, (origin, direction)) in draw(&scene, SIZE).iter().zip(rays(&scene, SIZE)) {
        let normal = DVec3::new(0.8, 0.0, 0.6);
        let t = (DVec3::Z * -3.0 - origin).dot(normal) / direction.dot(normal);
        let clear = if t > 0.0 {
            libm::exp(-t / distance)
        } else {
            0.0
        };
        let want = [clear, 0.0, 1.0 - clear].map(|share| share * 255.0);
        for i in 0..3 {
            let off = (f64::from(pixel[i]) - want[i]).abs();
            assert!(off <= 1.0, "{t}: {pixel:?} {want:?}");
        }
    }
}

/// Returns a scene with lens, sky, ground and a large light, moved along x.
fn busy(x: f64) -> Scene {
    let mut scene = dark();
    scene.settings.samples = 2;
    scene.settings.penumbra = true;
    scene.lens.aperture = 0.2;
    scene.up = DVec3::Y;
    scene.sky = Some(Sky {
        colour: [0.4, 0.5, 0.6],
        horizon: [0.3; 3],
        samples: 2,
    });
    scene.ground = Some(Ground {
        colour: [0.7; 3],
        height: None,
    });
    scene.lights.push(Light {
        size: 1.0,
        ..Light::new(
            LightKind::Point {
                position: DVec3::new(3.0, 6.0, 4.0),
            },
            [0.8; 3],
        )
    });
    for (x, finish) in [(x - 0.4, white()), (x + 0.5, glass(1.4))] {
        let ball = ball(DVec3::new(x, 0.1, 0.3 * x), 0.6);
        add_soft(&mut scene, ball, finish);
    }
    let hard = Shape::sphere(DVec3::new(0.9, -0.5, -1.0), 0.5);
    add(&mut scene, hard, white());
    scene
}

#[test]
fn tiles_and_threads_do_not_matter() {
    const SIZE: [u32; 2] = [70, 21];
    let mut moving = busy(0.0);
    moving.moments = [0.0, 0.1, 0.2].map(busy).to_vec();
    let mut lamps = busy(0.0);
    lamps.lens = Lens::default();
    for scene in [moving, lamps] {
        let picture = Picture::new(&scene, SIZE);
        let (whole, _) = render(&picture, 1, Pass::Smooth, &|_| ());
        let (threads, _) = render(&picture, 3, Pass::Smooth, &|_| ());
        assert!(whole == threads);
        let (first, _) = render(&picture, 1, Pass::Full, &|_| ());
        assert!(whole != first);
        let mut some: Vec<Tile> = tiles(SIZE[0], SIZE[1], 13);
        some.truncate(5);
        for tile in some {
            let part = picture.trace(tile, Pass::Smooth, &|| false, &mut Stats::default());
            let part = part.expect("nobody stops");
            for (row, y) in part.chunks_exact(4 * tile.width as usize).zip(tile.y..) {
                let from = 4 * (y * SIZE[0] + tile.x) as usize;
                assert!(row == &whole[from..from + row.len()], "{tile:?}");
            }
        }
    }
}
