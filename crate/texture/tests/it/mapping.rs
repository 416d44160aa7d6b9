//! Texture coordinates, images, regions, mixtures.

use crate::common::{ODD, slope};
use core::f64::consts::{PI, TAU};
use glam::{DVec2, DVec3};
use texture::uv::{self, Arc, Sheet, Uv};
use texture::{Edge, Image, Region, Rgb8, Surface, blend, sample};
use trials::{Random, count};

const RING: Arc = Arc {
    center: DVec3::new(0.2, 0.1, -0.3),
    u: DVec3::X,
    v: DVec3::Z,
    sweep: 1.3,
    angle: 2.0,
};

/// Texture coordinates as a function of space.
type Mapping = Box<dyn Fn(DVec3) -> Uv>;

/// Every mapping, by name.
fn mappings() -> Vec<(&'static str, Mapping)> {
    let corners = [
        DVec3::new(-3.0, -2.0, 0.5),
        DVec3::new(3.0, -2.5, 0.0),
        DVec3::new(0.0, 3.0, -0.5),
    ];
    let sheet = Sheet::around(&corners, DVec3::Z).unwrap();
    let axes = [
        DVec3::new(1.0, 0.2, 0.0),
        DVec3::new(0.0, 1.5, 0.1),
        DVec3::new(0.0, 0.3, 0.8),
    ];
    vec![
        ("sphere", Box::new(|p| uv::sphere(DVec3::splat(0.1), p))),
        (
            "segment",
            Box::new(|p| uv::segment(DVec3::new(-1.0, 0.4, 0.0), DVec3::new(2.0, 1.0, 0.3), p)),
        ),
        ("arc", Box::new(|p| uv::arc(&RING, p))),
        (
            "torus",
            Box::new(|p| uv::arc(&Arc { angle: TAU, ..RING }, p)),
        ),
        ("triangle", Box::new(move |p| uv::triangle(corners, p))),
        (
            "plane",
            Box::new(|p| uv::plane(DVec3::ONE, DVec3::new(0.6, 0.0, 0.8), p)),
        ),
        ("sheet", Box::new(move |p| sheet.uv(p))),
        (
            "box",
            Box::new(move |p| uv::cuboid(DVec3::splat(0.1), axes, p)),
        ),
        (
            "piece",
            Box::new(|p| uv::segment(DVec3::ZERO, DVec3::Y, p).of_piece(0.25, 0.5)),
        ),
    ]
}

fn corner_image() -> Rgb8 {
    // Red, green above; blue, white below.
    Rgb8 {
        size: [2, 2],
        bytes: vec![255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255],
    }
}

#[test]
fn gradients_match_differences() {
    let mut random = Random::new(41);
    for (name, uv) in mappings() {
        let mut checked = 0;
        for _ in 0..count(600) {
            let p = random.vector(2.5);
            let here = uv(p);
            // Seams and ends are no place for differences.
            let calm = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().all(|d| {
                [-1.0, 1.0].into_iter().all(|s| {
                    let there = uv(p + 1e-3 * s * d);
                    (there.at - here.at).length() < 0.05
                        && (there.gradient[0] - here.gradient[0]).length() < 0.05
                        && (there.gradient[1] - here.gradient[1]).length() < 0.05
                })
            });
            if calm {
                checked += 1;
                for (i, got) in here.gradient.into_iter().enumerate() {
                    let want = slope(|p| uv(p).at[i], p, 1e-5);
                    assert!(
                        (got - want).length() < 1e-6,
                        "{name} at {p}: {got} instead of {want}"
                    );
                }
            }
        }
        assert!(checked > count(200), "{name}: {checked}");
    }
}

#[test]
fn coordinates_are_where_the_table_says() {
    fn close(a: DVec2, x: f64, y: f64) {
        assert!(
            (a - DVec2::new(x, y)).length() < 1e-12,
            "{a} instead of ({x}, {y})"
        );
    }
    fn cube(p: DVec3) -> DVec2 {
        uv::cuboid(DVec3::ZERO, [DVec3::X, DVec3::Y, DVec3::Z], p).at
    }
    // Seen from +z, u grows to the right and v upwards.
    close(uv::sphere(DVec3::ZERO, DVec3::Z).at, 0.5, 0.5);
    close(uv::sphere(DVec3::ZERO, DVec3::X).at, 0.75, 0.5);
    close(uv::sphere(DVec3::ZERO, -DVec3::X).at, 0.25, 0.5);
    close(
        uv::sphere(DVec3::ZERO, DVec3::new(0.0, 1.0, 1.0)).at,
        0.5,
        0.75,
    );
    // Against the parametric forms.
    let mut random = Random::new(42);
    for _ in 0..count(300) {
        let (u, v, r) = (
            random.range(0.01, 0.99),
            random.range(0.01, 0.99),
            random.range(0.1, 0.9),
        );
        let (lon, lat) = (TAU * (u - 0.5), PI * (v - 0.5));
        let p = 3.0
            * r
            * DVec3::new(
                libm::cos(lat) * libm::sin(lon),
                libm::sin(lat),
                libm::cos(lat) * libm::cos(lon),
            );
        close(uv::sphere(DVec3::ZERO, p).at, u, v);
        // An upright segment: its front looks to +z, and around it goes by the right hand.
        let p = DVec3::new(r * libm::sin(lon), 4.0 * u, r * libm::cos(lon));
        close(uv::segment(DVec3::ZERO, 4.0 * DVec3::Y, p).at, u, u);
        // An arc of 2 radians in the plane of x and z; v turns from outward to u × v = −y.
        let (out, up) = (
            r * libm::cos(TAU * (v - 0.5)),
            r * libm::sin(TAU * (v - 0.5)),
        );
        let t = 2.0 * u;
        let p =
            RING.center + (1.3 + out) * DVec3::new(libm::cos(t), 0.0, libm::sin(t)) - up * DVec3::Y;
        close(uv::arc(&RING, p).at, u, v);
        let corners = [random.vector(2.0), random.vector(2.0), random.vector(2.0)];
        let (a, b) = (0.9 * u, 0.9 * (1.0 - u) * v);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let p = corners[0] * (1.0 - a - b) + corners[1] * a + corners[2] * b + r * normal;
        assert!((uv::triangle(corners, p).at - DVec2::new(a, b)).length() < 1e-9);
    }
    // Ends are cut.
    assert_eq!(uv::segment(DVec3::ZERO, DVec3::Y, 3.0 * DVec3::Y).at.x, 1.0);
    assert_eq!(uv::segment(DVec3::ZERO, DVec3::Y, -DVec3::Y).at.x, 0.0);
    // Axes along z look up.
    assert_eq!(uv::segment(DVec3::ZERO, DVec3::Z, DVec3::Y).at.y, 0.5);
    // The ground: u to the right, v away.
    close(
        uv::plane(DVec3::ZERO, DVec3::Y, DVec3::new(2.0, 7.0, -3.0)).at,
        2.0,
        3.0,
    );
    // A square sheet.
    let square =
        [(1.0, 1.0), (3.0, 1.0), (3.0, 5.0), (1.0, 5.0)].map(|(x, y)| DVec3::new(x, y, 2.0));
    close(
        Sheet::around(&square, DVec3::Z)
            .unwrap()
            .uv(DVec3::new(2.0, 2.0, 9.0))
            .at,
        0.5,
        0.25,
    );
    // The faces of a cube: from each side, u to the right.
    close(cube(DVec3::new(0.5, 0.2, 1.0)), 0.75, 0.6);
    close(cube(DVec3::new(1.0, 0.2, -0.5)), 0.75, 0.6);
    close(cube(DVec3::new(-0.5, 0.2, -1.0)), 0.75, 0.6);
    close(cube(DVec3::new(-1.0, 0.2, 0.5)), 0.75, 0.6);
    close(cube(DVec3::new(0.5, 1.0, -0.2)), 0.75, 0.6);
    close(cube(DVec3::new(0.5, -1.0, 0.2)), 0.75, 0.6);
    // A quarter of a bone.
    close(
        uv::segment(DVec3::ZERO, DVec3::Y, DVec3::new(0.0, 0.5, 1.0))
            .of_piece(0.5, 0.75)
            .at,
        0.625,
        0.5,
    );
}

#[test]
fn degenerate_primitives_have_coordinates() {
    fn fine(uv: Uv) {
        assert!(
            uv.at.is_finite() && uv.gradient[0].is_finite() && uv.gradient[1].is_finite(),
            "{uv:?}"
        );
    }
    let p = DVec3::new(0.3, -0.2, 0.5);
    fine(uv::sphere(p, p));
    fine(uv::sphere(p, p + DVec3::Y));
    fine(uv::segment(p, p, p));
    fine(uv::segment(p, p, DVec3::ONE));
    fine(uv::segment(DVec3::ZERO, DVec3::Z, 0.5 * DVec3::Z));
    fine(uv::arc(&RING, RING.center));
    fine(uv::arc(&RING, RING.center + 1.3 * DVec3::X));
    fine(uv::arc(
        &Arc {
            sweep: 0.0,
            angle: 0.0,
            ..RING
        },
        p,
    ));
    fine(uv::triangle([p; 3], p));
    fine(uv::triangle([p, 2.0 * p, 3.0 * p], DVec3::ONE));
    fine(uv::plane(p, DVec3::ZERO, p));
    fine(uv::plane(p, DVec3::X, DVec3::ONE));
    fine(uv::cuboid(p, [DVec3::X; 3], p));
    fine(uv::cuboid(p, [DVec3::X, DVec3::Y, DVec3::Z], p));
    assert_eq!(Sheet::around(&[], DVec3::Z), None);
    assert_eq!(Sheet::around(&[p, p], DVec3::Z), None);
    assert_eq!(Sheet::around(&[DVec3::splat(f64::NAN); 3], DVec3::Z), None);
}

#[test]
fn images_interpolate_and_wrap() {
    fn at(u: f64, v: f64, edge: Edge) -> DVec3 {
        DVec3::from_array(sample(&corner_image(), DVec2::new(u, v), edge).unwrap())
    }
    fn is(a: DVec3, b: DVec3) {
        assert!((a - b).length() < 1e-12, "{a} instead of {b}");
    }
    let (red, green, blue, white) = (DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE);
    is(at(0.25, 0.75, Edge::Wrap), red);
    is(at(0.75, 0.75, Edge::Wrap), green);
    is(at(0.25, 0.25, Edge::Wrap), blue);
    is(at(0.75, 0.25, Edge::Wrap), white);
    is(at(0.5, 0.75, Edge::Wrap), 0.5 * (red + green));
    is(
        at(0.0, 0.0, Edge::Wrap),
        0.25 * (red + green + blue + white),
    );
    is(at(0.0, 0.0, Edge::Hold), blue);
    is(at(-3.75, 5.25, Edge::Wrap), blue);
    is(at(-3.75, 5.25, Edge::Hold), red);
    let mut random = Random::new(43);
    for _ in 0..count(500) {
        let (u, v) = (random.range(-2.0, 2.0), random.range(-2.0, 2.0));
        is(at(u, v, Edge::Wrap), at(u + 3.0, v - 2.0, Edge::Wrap));
        assert!((at(u, v, Edge::Wrap) - at(u + 1e-6, v, Edge::Wrap)).length() < 1e-5);
    }
    for x in ODD {
        for edge in [Edge::Wrap, Edge::Hold] {
            assert!(at(x, 0.3, edge).is_finite() && at(0.3, x, edge).is_finite());
        }
    }
    assert_eq!(sample(&Rgb8::default(), DVec2::ZERO, Edge::Wrap), None);
    // Bytes that are missing are black.
    let short = Rgb8 {
        size: [9, 9],
        bytes: vec![255],
    };
    assert_eq!(short.texel(8, 8), [0.0; 3]);
}

/// Slanted rectangle in space: points on the lines from its inside meet it where they came from.
#[test]
fn regions_catch_normals() {
    let mut random = Random::new(44);
    for _ in 0..count(300) {
        let (origin, right) = (random.vector(2.0), random.direction());
        let up = right.cross(random.direction()).normalize() * random.range(0.2, 3.0);
        let right = right * random.range(0.2, 3.0);
        let region = Region {
            min: DVec3::splat(100.0),
            max: DVec3::splat(-100.0),
            corners: [origin, origin + right, origin + right + up, origin + up],
        };
        assert!(region.is_rectangle());
        let (a, b) = (random.range(-0.5, 1.5), random.range(-0.5, 1.5));
        let normal = random.direction();
        let from = origin + a * right + b * up - random.range(0.01, 5.0) * normal;
        if normal.dot(right.cross(up).normalize()).abs() < 0.05 {
            continue;
        }
        let got = region.uv(from, normal);
        let inside = (0.0..1.0).contains(&a) && (0.0..1.0).contains(&b);
        assert_eq!(got.is_some(), inside, "({a}, {b})");
        if let Some(got) = got {
            assert!((got - DVec2::new(a, b)).length() < 1e-9);
        }
        // The other way it runs off, and outside the box there is nothing.
        assert_eq!(region.uv(from, -normal), None);
        let boxed = Region {
            min: from + DVec3::splat(0.1),
            max: from + DVec3::ONE,
            ..region
        };
        assert_eq!(boxed.uv(from, normal), None);
    }
}

#[test]
fn degenerate_regions_texture_nothing() {
    let square =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 2.0));
    let region = Region {
        min: DVec3::splat(-9.0),
        max: DVec3::splat(9.0),
        corners: square,
    };
    assert_eq!(region.uv(DVec3::ZERO, DVec3::X), None); // beside
    assert_eq!(region.uv(DVec3::new(f64::NAN, 0.0, 0.0), DVec3::Z), None);
    assert_eq!(region.uv(DVec3::ZERO, DVec3::splat(f64::NAN)), None);
    for corners in [
        [DVec3::ZERO; 4],
        [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X, DVec3::X],
        [DVec3::splat(f64::NAN); 4],
    ] {
        let flat = Region { corners, ..region };
        assert!(!flat.is_rectangle());
        assert_eq!(flat.uv(DVec3::ZERO, DVec3::Z), None);
    }
    // A point in the rectangle itself is hit at once.
    assert_eq!(
        region.uv(DVec3::new(0.0, 0.0, 2.0), DVec3::Z),
        Some(DVec2::splat(0.5))
    );
}

#[test]
fn mixtures_are_weighted_means() {
    fn surface(random: &mut Random) -> Surface {
        Surface {
            diffuse: random.vector(1.0).as_vec3().abs(),
            ambient: random.vector(1.0).as_vec3().abs(),
            specular: random.vector(1.0).as_vec3().abs(),
            reflective: random.vector(1.0).as_vec3().abs(),
            transparent: random.vector(1.0).as_vec3().abs(),
            index: random.range(1.0, 2.0) as f32,
            shine: random.range(1.0, 200.0) as f32,
            normal: random.direction(),
        }
    }
    let mut random = Random::new(45);
    for _ in 0..count(200) {
        let (a, b) = (surface(&mut random), surface(&mut random));
        let share = random.unit();
        let got = blend(&[(3.0 * share, a), (3.0 * (1.0 - share), b)]).unwrap();
        let (s, t) = (share as f32, 1.0 - share as f32);
        for (x, a, b) in [
            (got.diffuse, a.diffuse, b.diffuse),
            (got.ambient, a.ambient, b.ambient),
            (got.specular, a.specular, b.specular),
            (got.reflective, a.reflective, b.reflective),
            (got.transparent, a.transparent, b.transparent),
        ] {
            assert!((x - s * a - t * b).length() < 1e-5);
        }
        assert!((got.index - s * a.index - t * b.index).abs() < 1e-5);
        assert!((got.shine - s * a.shine - t * b.shine).abs() < 1e-3);
        let normal = (share * a.normal + (1.0 - share) * b.normal).normalize();
        assert!((got.normal - normal).length() < 1e-12);
        // Parameters without weight do not matter.
        let with = blend(&[
            (3.0 * share, a),
            (-1.0, surface(&mut random)),
            (3.0 * (1.0 - share), b),
            (f64::NAN, a),
        ])
        .unwrap();
        assert!((with.diffuse - got.diffuse).length() < 1e-6);
    }
    let (a, b) = (surface(&mut random), surface(&mut random));
    assert_eq!(blend(&[]), None);
    assert_eq!(blend(&[(0.3, a)]), Some(a));
    let equal = blend(&[(0.0, a), (0.0, b)]).unwrap();
    assert!((equal.diffuse - 0.5 * (a.diffuse + b.diffuse)).length() < 1e-6);
    let huge = blend(&[(1e308, a), (1e308, b)]).unwrap();
    assert!((huge.diffuse - equal.diffuse).length() < 1e-6);
    // Opposite normals have no mean: the one with the larger weight stays.
    let c = Surface {
        normal: -a.normal,
        ..a
    };
    assert_eq!(blend(&[(1.0, a), (1.0, c)]).unwrap().normal, a.normal);
}
