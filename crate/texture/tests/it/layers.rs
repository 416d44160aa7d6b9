//! Layers: argument, bounds, masks, targets, bumps, limits.

use crate::common::ODD;
use glam::{DVec2, DVec3, Vec3};
use texture::{
    Fault, Grain, Image, MAX_LAYERS, Mapping, Method, Region, Rgb8, Site, Solid, Surface, Target,
    Texture, Uv, Wave, apply, blend, stack, uv,
};
use trials::{Random, count};

fn at_uv(u: f64, v: f64) -> Site {
    Site {
        point: DVec3::ZERO,
        normal: DVec3::Z,
        uv: Uv {
            at: DVec2::new(u, v),
            gradient: [2.0 * DVec3::X, 3.0 * DVec3::Y],
        },
    }
}

fn ramp() -> Rgb8 {
    Rgb8 {
        size: [2, 2],
        bytes: vec![255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255],
    }
}

fn region() -> Region {
    Region {
        min: DVec3::splat(-2.0),
        max: DVec3::splat(2.0),
        corners: [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| DVec3::new(x, y, 3.0)),
    }
}

/// Returns a texture of each method.
fn methods() -> Vec<Method> {
    let solids = Solid::ALL.into_iter().map(Method::Solid);
    let waves = Wave::ALL.into_iter().map(|w| Method::Waves([w, Wave::Hat]));
    let others = [
        Method::Colour(DVec3::new(0.2, 0.5, 0.9)),
        Method::Image(0, Mapping::Plain),
        Method::Image(0, Mapping::Region(region())),
        Method::Image(7, Mapping::Plain),
    ];
    solids.chain(waves).chain(others).collect()
}

const TARGETS: [Target; 10] = [
    Target::Diffuse,
    Target::Ambient,
    Target::Specular,
    Target::Reflective,
    Target::Transparent,
    Target::Index,
    Target::Shine,
    Target::Pigment,
    Target::Normal,
    Target::Strength,
];

fn full() -> Surface {
    Surface {
        diffuse: Vec3::new(0.8, 0.4, 0.2),
        ambient: Vec3::new(0.08, 0.04, 0.02),
        specular: Vec3::splat(0.5),
        reflective: Vec3::splat(0.25),
        transparent: Vec3::splat(0.3),
        index: 1.5,
        shine: 40.0,
        normal: DVec3::Z,
    }
}

fn is_finite(s: &Surface) -> bool {
    [
        s.diffuse,
        s.ambient,
        s.specular,
        s.reflective,
        s.transparent,
    ]
    .iter()
    .all(|c| c.is_finite() && c.min_element() >= 0.0)
        && s.index.is_finite()
        && s.index > 0.0
        && s.shine.is_finite()
        && s.normal.is_normalized()
}

/// The formula of a profile of the strength: times·(low + (high − low)·fu(x·u)·fv(y·v)).
#[test]
fn values_are_those_of_profiles() {
    let texture = Texture {
        scale: DVec3::new(22.0, 22.0, 1.0),
        times: DVec3::splat(1.15),
        bounds: [DVec3::splat(0.5), DVec3::splat(0.7)],
        ..Texture::new(Target::Diffuse, Method::Waves([Wave::Sin, Wave::One]))
    };
    let mut random = Random::new(31);
    for _ in 0..count(200) {
        let u = random.unit();
        let want = 1.15 * (0.5 + 0.2 * (0.5 + 0.5 * libm::sin(22.0 * u)));
        let got = texture.value(&at_uv(u, 0.3), &[]).unwrap();
        assert!((got - DVec3::splat(want)).length() < 1e-14);
    }
}

/// Shift by XYZ moves the pattern by XYZ of the object, whatever the scale.
#[test]
fn translate_moves_and_scale_refines() {
    let still = Texture {
        scale: DVec3::new(3.0, 2.0, 5.0),
        ..Texture::new(Target::Diffuse, Method::Solid(Solid::Marble))
    };
    let shift = DVec3::new(0.25, -0.5, 1.0);
    let moved = Texture {
        translate: shift,
        ..still.clone()
    };
    let mut random = Random::new(32);
    for _ in 0..count(200) {
        let point = random.vector(2.0);
        let site = Site {
            point,
            ..at_uv(0.0, 0.0)
        };
        let there = Site {
            point: point + shift,
            ..site
        };
        let (a, b) = (
            still.value(&site, &[]).unwrap(),
            moved.value(&there, &[]).unwrap(),
        );
        assert!((a - b).length() < 1e-9);
        let want = Solid::Marble.pattern(still.scale * point, Grain::default());
        assert_eq!(a.to_array(), want);
    }
}

#[test]
fn masks_name_tiles_along_u_first() {
    let red = Texture {
        scale: DVec3::new(3.0, 2.0, 1.0),
        mask: [1, 0, 0, 0, 1, 1].map(|x| x == 1).to_vec(),
        ..Texture::new(Target::Diffuse, Method::Colour(DVec3::X))
    };
    assert_eq!(red.check(), Ok(()));
    for (u, v, shown) in [
        (0.1, 0.1, true),
        (0.5, 0.1, false),
        (0.9, 0.1, false),
        (0.1, 0.9, false),
        (0.5, 0.9, true),
        (0.9, 0.9, true),
        // The far edges belong to the last tiles.
        (1.0, 0.1, false),
        (1.0, 1.0, true),
        (0.0, 0.0, true),
        // Beyond, tiles repeat.
        (1.1, 0.1, true),
        (-0.9, 0.1, true),
        (-0.1, -0.1, true),
    ] {
        assert_eq!(red.value(&at_uv(u, v), &[]).is_some(), shown, "({u}, {v})");
        let got = apply(std::slice::from_ref(&red), full(), &at_uv(u, v), &[]).diffuse;
        assert_eq!(
            got,
            if shown {
                Vec3::new(0.8, 0.0, 0.0)
            } else {
                full().diffuse
            }
        );
    }
    // A solid's tiles are those of x and y of the argument.
    let wood = Texture {
        method: Method::Solid(Solid::Wood),
        ..red
    };
    for (x, y, shown) in [(0.1, 0.1, true), (0.4, 0.1, false), (0.4, 0.6, true)] {
        let site = Site {
            point: DVec3::new(x, y, 9.0),
            ..at_uv(0.0, 0.0)
        };
        assert_eq!(wood.value(&site, &[]).is_some(), shown, "({x}, {y})");
    }
}

#[test]
fn faults_are_found() {
    fn check(change: impl FnOnce(&mut Texture)) -> Result<(), Fault> {
        let mut texture = Texture::new(Target::Diffuse, Method::Colour(DVec3::ONE));
        change(&mut texture);
        texture.check()
    }
    assert_eq!(check(|_| ()), Ok(()));
    assert_eq!(
        check(|t| {
            t.scale.x = 2.0;
            t.mask = vec![true; 3];
        }),
        Err(Fault::Mask(2, 1))
    );
    assert_eq!(
        check(|t| {
            t.scale.x = -1.5;
            t.mask = vec![true; 2];
        }),
        Ok(())
    );
    assert_eq!(
        check(|t| {
            t.scale = DVec3::new(100.0, 100.0, 1.0);
            t.mask = vec![true; 3];
        }),
        Err(Fault::LargeMask)
    );
    assert_eq!(
        check(|t| {
            t.scale = DVec3::splat(1e9);
            t.mask = vec![true];
        }),
        Err(Fault::LargeMask)
    );
    assert_eq!(check(|t| t.times.y = f64::NAN), Err(Fault::Number));
    assert_eq!(check(|t| t.translate.z = 1e10), Err(Fault::Number));
    assert_eq!(
        check(|t| t.grain.octaves = f64::INFINITY),
        Err(Fault::Number)
    );
    assert_eq!(
        check(|t| t.method = Method::Colour(DVec3::splat(f64::NAN))),
        Err(Fault::Number)
    );
    let mut bent = region();
    assert_eq!(
        check(|t| t.method = Method::Image(0, Mapping::Region(region()))),
        Ok(())
    );
    bent.corners[2].z += 1.0;
    assert_eq!(
        check(|t| t.method = Method::Image(0, Mapping::Region(bent))),
        Err(Fault::Region)
    );
    let fine = Texture::new(Target::Diffuse, Method::Colour(DVec3::ONE));
    let mut layers = vec![fine.clone(); MAX_LAYERS - 1];
    assert_eq!(
        stack(&mut layers, &[fine.clone(), fine.clone()]),
        Err(Fault::Layers)
    );
    assert_eq!(layers.len(), MAX_LAYERS - 1);
    assert_eq!(stack(&mut layers, std::slice::from_ref(&fine)), Ok(()));
    assert!(Fault::Mask(2, 3).to_string().contains("2·3"));
}

#[test]
fn targets_scale_or_are_replaced() {
    fn half(target: Target, replace: bool) -> Surface {
        let texture = Texture {
            replace,
            ..Texture::new(target, Method::Colour(DVec3::new(0.5, 0.25, 1.0)))
        };
        apply(&[texture], full(), &at_uv(0.3, 0.3), &[])
    }
    let f = full();
    let by = Vec3::new(0.5, 0.25, 1.0);
    assert_eq!(
        half(Target::Diffuse, false),
        Surface {
            diffuse: f.diffuse * by,
            ..f
        }
    );
    assert_eq!(half(Target::Diffuse, true), Surface { diffuse: by, ..f });
    assert_eq!(
        half(Target::Ambient, false),
        Surface {
            ambient: f.ambient * by,
            ..f
        }
    );
    assert_eq!(half(Target::Specular, true), Surface { specular: by, ..f });
    assert_eq!(
        half(Target::Reflective, false),
        Surface {
            reflective: f.reflective * by,
            ..f
        }
    );
    assert_eq!(
        half(Target::Transparent, true),
        Surface {
            transparent: by,
            ..f
        }
    );
    assert_eq!(half(Target::Index, false), Surface { index: 0.75, ..f });
    assert_eq!(half(Target::Index, true), Surface { index: 0.5, ..f });
    assert_eq!(half(Target::Shine, false), Surface { shine: 20.0, ..f });
    assert_eq!(
        half(Target::Pigment, false),
        Surface {
            diffuse: f.diffuse * by,
            ambient: f.ambient * by,
            ..f
        }
    );
    // Ambient was a tenth of diffuse and stays so.
    let replaced = half(Target::Pigment, true);
    assert_eq!(replaced.diffuse, by);
    assert!((replaced.ambient - 0.1 * by).length() < 1e-7);
    assert_eq!(half(Target::Normal, false), f);
    assert_eq!(half(Target::Strength, true), f);
    // An index of 0 would be no glass.
    let none = Texture {
        times: DVec3::ZERO,
        ..Texture::new(Target::Index, Method::Colour(DVec3::ONE))
    };
    assert_eq!(apply(&[none], f, &at_uv(0.0, 0.0), &[]), f);
}

#[test]
fn layers_go_on_one_another_in_order() {
    let [red, half] =
        [(true, DVec3::X), (false, DVec3::splat(0.5))].map(|(replace, colour)| Texture {
            replace,
            ..Texture::new(Target::Diffuse, Method::Colour(colour))
        });
    let site = at_uv(0.0, 0.0);
    assert_eq!(
        apply(&[red.clone(), half.clone()], full(), &site, &[]).diffuse,
        Vec3::new(0.5, 0.0, 0.0)
    );
    assert_eq!(apply(&[half, red], full(), &site, &[]).diffuse, Vec3::X);
}

/// Colour patterns give targets of one number their luminance; images that are missing change
/// nothing.
#[test]
fn images_are_read_by_number() {
    let image = ramp();
    let images: [&dyn Image; 1] = [&image];
    let index = Texture {
        replace: true,
        ..Texture::new(Target::Shine, Method::Image(0, Mapping::Plain))
    };
    let got = apply(&[index], full(), &at_uv(0.25, 0.25), &images).shine;
    assert!((got - 0.0722).abs() < 1e-6, "{got}: blue is lower left");
    let missing = Texture::new(Target::Diffuse, Method::Image(1, Mapping::Plain));
    assert_eq!(
        apply(&[missing], full(), &at_uv(0.25, 0.25), &images),
        full()
    );
    let empty = Rgb8::default();
    let none = Texture::new(Target::Normal, Method::Image(0, Mapping::Plain));
    assert_eq!(
        apply(&[none], full(), &at_uv(0.25, 0.25), &[&empty]),
        full()
    );
}

/// The slope of a solid is the gradient of its relief along the surface, in units of the argument:
/// stretched axes count in proportion, and the size of the whole does not.
#[test]
fn bumps_of_solids_follow_their_relief() {
    let mut random = Random::new(33);
    let (mut off, mut all) = (0, 0);
    for solid in [Solid::Marble, Solid::Moon, Solid::Ripples, Solid::Wood] {
        for scale in [
            DVec3::splat(1.0),
            DVec3::new(4.0, 2.0, 1.0),
            DVec3::new(-3.0, 0.0, 3.0),
        ] {
            let texture = Texture {
                scale,
                times: DVec3::splat(0.5),
                bounds: [DVec3::ONE, DVec3::splat(3.0)],
                grain: Grain {
                    turbulence: 0.5,
                    octaves: 1.0,
                },
                ..Texture::new(Target::Normal, Method::Solid(solid))
            };
            for _ in 0..count(50) {
                let (point, normal) = (random.vector(3.0), random.direction());
                let site = Site {
                    point,
                    normal,
                    uv: Uv::default(),
                };
                let got = texture.slope(&site, &[]).unwrap();
                let size = scale.abs().max_element();
                // Height in space, whose waves are 1/size as high as in units of the argument.
                let want = crate::common::slope(
                    |p: DVec3| solid.relief(scale * p, texture.grain) / size,
                    point,
                    1e-3 / size,
                );
                let want = want - want.dot(normal) * normal;
                assert!(got.dot(normal).abs() < 1e-12);
                all += 1;
                // Differences are no slope where a relief has a crease.
                off += usize::from((got - want).length() >= 0.06);
            }
        }
    }
    assert!(200 * off <= all, "{off} of {all}");
}

#[test]
fn bumps_of_waves_and_images_rise_towards_white() {
    fn waves(x: f64, y: f64) -> Texture {
        Texture {
            scale: DVec3::new(x, y, 1.0),
            ..Texture::new(Target::Normal, Method::Waves([Wave::Sin, Wave::One]))
        }
    }
    let site = at_uv(0.2, 0.4);
    // u grows along x: derivative ½ cos of the argument, whatever the gradient's length.
    let slope = waves(3.0, 1.0).slope(&site, &[]).unwrap();
    assert!((slope - 0.5 * libm::cos(0.6) * DVec3::X).length() < 1e-14);
    let slope = waves(-3.0, 1.0).slope(&site, &[]).unwrap();
    assert!((slope + 0.5 * libm::cos(0.6) * DVec3::X).length() < 1e-14);
    assert_eq!(waves(0.0, 0.0).slope(&site, &[]), Some(DVec3::ZERO));
    let image = Rgb8 {
        size: [4, 1],
        bytes: vec![0, 0, 0, 85, 85, 85, 170, 170, 170, 255, 255, 255],
    };
    let embossed = Texture::new(Target::Normal, Method::Image(0, Mapping::Plain));
    // A third of white a texel of a quarter of the width, over 32.
    let slope = embossed.slope(&at_uv(0.5, 0.5), &[&image]).unwrap();
    assert!(
        (slope - DVec3::X * (4.0 / 3.0 / 32.0)).length() < 1e-7,
        "{slope}"
    );
    // White stands out: the normal leans to the dark side.
    let got = apply(&[embossed], full(), &at_uv(0.5, 0.5), &[&image]).normal;
    assert!(got.x < 0.0 && got.z > 0.9);
}

#[test]
fn bumps_that_replace_others_start_anew() {
    let bump = Texture {
        scale: DVec3::new(3.0, 1.0, 1.0),
        ..Texture::new(Target::Normal, Method::Waves([Wave::Sin, Wave::One]))
    };
    let only = Texture {
        replace: true,
        ..bump.clone()
    };
    let site = at_uv(0.2, 0.4);
    let once = apply(std::slice::from_ref(&bump), full(), &site, &[]).normal;
    assert_eq!(
        apply(&[bump.clone(), only], full(), &site, &[]).normal,
        once
    );
    assert!(apply(&[bump.clone(), bump], full(), &site, &[]).normal.x < once.x);
}

#[test]
fn odd_numbers_give_surfaces() {
    let image = ramp();
    let images: [&dyn Image; 1] = [&image];
    for method in methods() {
        for target in TARGETS {
            for a in ODD {
                for b in [0.5, f64::NAN, f64::INFINITY, 0.0] {
                    let texture = Texture {
                        scale: DVec3::new(a, b, 1.0),
                        translate: DVec3::new(b, a, 0.0),
                        times: DVec3::new(1.0, a, b),
                        bounds: [DVec3::splat(b), DVec3::splat(a)],
                        grain: Grain {
                            turbulence: a,
                            octaves: 2.0,
                        },
                        mask: vec![true, false],
                        replace: a > 0.0,
                        ..Texture::new(target, method)
                    };
                    let mut plain = Texture::new(target, method);
                    plain.grain.octaves = 2.0;
                    let odd = Site {
                        point: DVec3::new(a, b, 0.2),
                        normal: DVec3::Z,
                        uv: Uv {
                            at: DVec2::new(a, b),
                            gradient: [DVec3::splat(a), DVec3::splat(b)],
                        },
                    };
                    let even = Site {
                        point: DVec3::new(0.1, 0.2, 0.3),
                        ..at_uv(0.4, 0.6)
                    };
                    for (texture, site) in [(&texture, &even), (&plain, &odd), (&texture, &odd)] {
                        let got = apply(std::slice::from_ref(texture), full(), site, &images);
                        assert!(is_finite(&got), "{texture:?} at {site:?}: {got:?}");
                    }
                }
            }
        }
    }
}

/// Over a blend of two elements the mixture goes from one's texture to the other's without a step.
#[test]
fn textures_cross_dissolve() {
    let stripes = Texture {
        scale: DVec3::splat(20.0),
        ..Texture::new(Target::Diffuse, Method::Waves([Wave::Sin, Wave::One]))
    };
    let at = |x: f64| {
        // In front of the axis, away from poles and seams.
        let point = DVec3::new(x, 0.3, 1.0);
        let segment = uv::segment(DVec3::new(-2.0, 0.0, 0.0), DVec3::ZERO, point);
        let parts = [(-1.0, segment), (1.0, uv::sphere(DVec3::X, point))].map(|(center, uv)| {
            let site = Site {
                point,
                normal: DVec3::Z,
                uv,
            };
            let share = libm::exp(-(x - center) * (x - center));
            (
                share,
                apply(std::slice::from_ref(&stripes), full(), &site, &[]),
            )
        });
        let [(_, a), (_, b)] = parts;
        (blend(&parts).unwrap().diffuse, a.diffuse, b.diffuse)
    };
    let (mixed, a, _) = at(-3.0);
    assert!((mixed - a).length() < 1e-3);
    let (mixed, _, b) = at(3.0);
    assert!((mixed - b).length() < 1e-3);
    for i in -3000..3000 {
        let x = f64::from(i) * 1e-3 + 1e-4;
        assert!((at(x).0 - at(x + 1e-3).0).length() < 0.03, "at {x}");
    }
}
