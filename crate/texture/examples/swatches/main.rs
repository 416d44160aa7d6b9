//! Contact sheet of all methods on lit shapes:
//! `cargo run -p texture --example swatches -- OUT.png`.
//!
//! Each swatch shows a ball and a block with a corner at the origin of texture space. Rows: solids;
//! solids in other colours or as bumps; waves, masks, images; texture coordinates of each kind of
//! primitive.

mod shapes;

use glam::{DMat3, DVec2, DVec3, Vec3};
use shapes::{Shape, ball, block, one, segment_distance};
use std::fs::File;
use std::io::BufWriter;
use texture::{
    Grain, Image, Mapping, Method, Region, Rgb8, Site, Solid, Surface, Target, Texture, Wave,
    apply, blend, uv,
};

/// Pixels of a swatch.
const CELL: [usize; 2] = [300, 190];
const COLUMNS: usize = 5;
/// Rays per pixel along each side.
const RAYS: usize = 2;

struct Swatch {
    name: String,
    surface: Surface,
    /// Layers for each part.
    layers: Vec<Vec<Texture>>,
    shapes: Vec<Shape>,
}

fn both(name: &str, surface: Surface, layers: Vec<Texture>) -> Swatch {
    let is_solid = matches!(layers[0].method, Method::Solid(_));
    let turn = if is_solid {
        DMat3::from_rotation_x(-1.1) * DMat3::from_rotation_y(0.3)
    } else {
        DMat3::IDENTITY
    };
    Swatch {
        name: name.into(),
        surface,
        layers: vec![layers],
        shapes: vec![
            ball(DVec3::new(-1.15, 0.0, 0.0), turn),
            block(DVec3::new(1.2, 0.0, 0.0)),
        ],
    }
}

fn colour(r: f64, g: f64, b: f64) -> DVec3 {
    DVec3::new(r, g, b)
}

fn plain(r: f32, g: f32, b: f32, specular: f32, shine: f32) -> Surface {
    let diffuse = Vec3::new(r, g, b);
    Surface {
        diffuse,
        ambient: 0.2 * diffuse,
        specular: Vec3::splat(specular),
        shine,
        ..Surface::default()
    }
}

fn solid(target: Target, solid: Solid, low: DVec3, high: DVec3, scale: f64) -> Texture {
    Texture {
        bounds: [low, high],
        scale: DVec3::splat(scale),
        ..Texture::new(target, Method::Solid(solid))
    }
}

fn pigment(pattern: Solid, low: DVec3, high: DVec3, scale: f64) -> Vec<Texture> {
    vec![solid(Target::Pigment, pattern, low, high, scale)]
}

fn bump(pattern: Solid, scale: f64) -> Vec<Texture> {
    vec![solid(
        Target::Normal,
        pattern,
        DVec3::ZERO,
        DVec3::ONE,
        scale,
    )]
}

fn waves(target: Target, waves: [Wave; 2], scale: [f64; 2]) -> Vec<Texture> {
    vec![Texture {
        scale: DVec3::new(scale[0], scale[1], 1.0),
        ..Texture::new(target, Method::Waves(waves))
    }]
}

/// Returns a picture with an up, a right and letters' shapes: a bird's-eye map with a red F on
/// stripes.
fn picture() -> Rgb8 {
    const ROWS: [&str; 8] = [
        "........", ".RRRRRR.", ".R......", ".RRRR...", ".R......", ".R......", ".R......",
        "........",
    ];
    let (width, height) = (128_usize, 128_usize);
    let mut bytes = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let letter = ROWS[y * 8 / height].as_bytes()[x * 8 / width] == b'R';
            let line = x % 16 == 0 || y % 16 == 0;
            let (u, v) = (x * 255 / width, 255 - y * 255 / height);
            bytes.extend(match (letter, line) {
                (true, _) => [215, 30, 30],
                (_, true) => [255, 255, 255],
                _ => [(60 + u / 2) as u8, (60 + v / 2) as u8, 150],
            });
        }
    }
    Rgb8 {
        size: [width as u32, height as u32],
        bytes,
    }
}

fn solids() -> Vec<Swatch> {
    use Solid as S;
    use Target::Pigment;
    let (black, white) = (DVec3::ZERO, DVec3::ONE);
    let white_stone = plain(1.0, 1.0, 1.0, 0.35, 60.0);
    let dull = plain(1.0, 1.0, 1.0, 0.05, 8.0);
    let mut moon = pigment(S::Moon, black, white, 1.0);
    moon.push(solid(Target::Normal, S::Moon, black, white, 1.0));
    let mut ripples = vec![solid(Target::Normal, S::Ripples, black, white, 1.0)];
    ripples.push(solid(
        Pigment,
        S::Ripples,
        colour(0.55, 0.6, 0.7),
        white,
        1.0,
    ));
    let mut paint = pigment(S::Paint, black, white, 1.0);
    paint.push(solid(Target::Normal, S::Paint, black, white, 1.0));
    vec![
        both("marble", white_stone, pigment(S::Marble, black, white, 1.0)),
        both(
            "agate",
            white_stone,
            pigment(
                S::Agate,
                colour(0.35, 0.08, 0.05),
                colour(1.0, 0.85, 0.7),
                1.0,
            ),
        ),
        both(
            "granite",
            plain(0.95, 0.88, 0.86, 0.3, 50.0),
            pigment(S::Granite, black, white, 1.0),
        ),
        both("moon", dull, moon),
        both(
            "onion",
            plain(1.0, 0.95, 0.95, 0.35, 30.0),
            pigment(
                S::Onion,
                colour(0.3, 0.0, 0.2),
                colour(1.0, 0.93, 0.95),
                1.0,
            ),
        ),
        both(
            "wood",
            plain(0.91, 0.76, 0.55, 0.15, 20.0),
            pigment(S::Wood, colour(0.32, 0.2, 0.12), white, 1.0),
        ),
        both("ripples", plain(0.25, 0.5, 0.7, 0.8, 60.0), ripples),
        both(
            "sandal",
            plain(0.9, 0.66, 0.42, 0.15, 20.0),
            pigment(S::Sandal, colour(0.3, 0.22, 0.16), white, 1.0),
        ),
        both(
            "checker",
            white_stone,
            pigment(S::Checker, colour(0.08, 0.08, 0.1), white, 2.0),
        ),
        both("paint", plain(0.96, 0.96, 0.94, 0.5, 40.0), paint),
    ]
}

fn bumps() -> Vec<Swatch> {
    use Solid as S;
    let (black, white) = (DVec3::ZERO, DVec3::ONE);
    let clay = plain(0.8, 0.72, 0.62, 0.25, 20.0);
    let mut calm = solid(Target::Pigment, S::Marble, black, white, 2.0);
    calm.grain.turbulence = 0.25;
    let mut green = solid(
        Target::Pigment,
        S::Agate,
        colour(0.02, 0.22, 0.16),
        colour(0.75, 1.0, 0.85),
        1.6,
    );
    green.grain = Grain {
        turbulence: 0.3,
        octaves: 2.5,
    };
    vec![
        both("normal marble", clay, bump(S::Marble, 1.0)),
        both("normal granite", clay, bump(S::Granite, 1.0)),
        both("normal onion", clay, bump(S::Onion, 1.0)),
        both("normal wood", clay, bump(S::Wood, 1.0)),
        both("normal checker", clay, bump(S::Checker, 3.0)),
        both(
            "marble, turbulence 0.25, scale 2",
            plain(0.7, 0.85, 0.75, 0.4, 60.0),
            vec![calm],
        ),
        both(
            "malachite: agate, green",
            plain(0.3, 0.9, 0.6, 0.4, 60.0),
            vec![green],
        ),
        both(
            "sand: ripples, scale 0.5",
            plain(0.85, 0.75, 0.5, 0.1, 20.0),
            bump(S::Ripples, 0.5),
        ),
        both("normal moon, scale 2", clay, bump(S::Moon, 2.0)),
        both("normal sandal", clay, bump(S::Sandal, 1.0)),
    ]
}

fn flat() -> Vec<Swatch> {
    let white = plain(1.0, 1.0, 1.0, 0.3, 30.0);
    let red = Texture {
        scale: DVec3::new(8.0, 4.0, 1.0),
        mask: (0..32).map(|i| (i % 8 + i / 8) % 2 == 0).collect(),
        ..Texture::new(Target::Pigment, Method::Colour(colour(0.9, 0.1, 0.1)))
    };
    let image = Texture {
        replace: true,
        scale: DVec3::new(2.0, 1.0, 1.0),
        ..Texture::new(Target::Pigment, Method::Image(0, Mapping::Plain))
    };
    let embossed = Texture {
        target: Target::Normal,
        times: DVec3::splat(1.5),
        ..image.clone()
    };
    let corners =
        [(-0.7, -0.7), (0.7, -0.7), (0.7, 0.7), (-0.7, 0.7)].map(|(x, y)| DVec3::new(x, y, 1.8));
    let thrown = Texture {
        scale: DVec3::ONE,
        method: Method::Image(
            0,
            Mapping::Region(Region {
                min: DVec3::splat(-2.0),
                max: DVec3::splat(2.0),
                corners,
            }),
        ),
        ..image.clone()
    };
    let clay = plain(0.8, 0.72, 0.62, 0.3, 20.0);
    vec![
        both(
            "normal sin cos",
            clay,
            waves(Target::Normal, [Wave::Sin, Wave::Cos], [60.0, 30.0]),
        ),
        both(
            "pigment hat step",
            plain(0.5, 0.6, 0.95, 0.3, 20.0),
            waves(Target::Pigment, [Wave::Hat, Wave::Step], [6.0, 5.0]),
        ),
        both("mask", white, vec![red]),
        both("img plain", white, vec![image.clone()]),
        both("img region", clay, vec![thrown]),
        both("img plain, embossed", clay, vec![embossed]),
    ]
}

fn mappings() -> Vec<Swatch> {
    let white = plain(1.0, 1.0, 1.0, 0.25, 30.0);
    let image = Texture {
        replace: true,
        ..Texture::new(Target::Pigment, Method::Image(0, Mapping::Plain))
    };
    let striped = Texture {
        scale: DVec3::new(6.0, 1.0, 1.0),
        bounds: [colour(0.9, 0.3, 0.1), colour(1.0, 0.95, 0.8)],
        ..Texture::new(Target::Pigment, Method::Waves([Wave::Step, Wave::One]))
    };
    let turn = DMat3::from_rotation_x(0.35);
    let (a, b) = (DVec3::new(-1.1, -0.3, 0.0), DVec3::new(1.1, 0.3, 0.0));
    let capsule = one(
        Box::new(move |p| segment_distance(a, b, p) - 0.55),
        Box::new(move |p| uv::segment(a, b, p)),
        DMat3::IDENTITY,
        DVec3::ZERO,
    );
    let ring = uv::Arc {
        center: DVec3::ZERO,
        u: DVec3::X,
        v: DVec3::Y,
        sweep: 0.85,
        angle: 4.5,
    };
    let torus = one(
        Box::new(move |p| {
            let angle = libm::atan2(p.y, p.x);
            let angle = if angle < 0.0 {
                angle + core::f64::consts::TAU
            } else {
                angle
            };
            let t = if angle <= ring.angle {
                angle
            } else if angle - ring.angle < core::f64::consts::TAU - angle {
                ring.angle
            } else {
                0.0
            };
            let (s, c) = libm::sincos(t);
            (p - ring.sweep * DVec3::new(c, s, 0.0)).length() - 0.38
        }),
        Box::new(move |p| uv::arc(&ring, p)),
        turn,
        DVec3::ZERO,
    );
    let corners = [
        DVec3::new(-1.4, -0.9, 0.0),
        DVec3::new(1.4, -0.9, 0.0),
        DVec3::new(0.2, 1.1, 0.0),
    ];
    let prism = one(
        Box::new(move |p| {
            let q = DVec2::new(p.x, p.y);
            let edges = [0, 1, 2].map(|i| {
                let (a, b) = (corners[i].truncate(), corners[(i + 1) % 3].truncate());
                (q - a).dot(-(b - a).perp().normalize())
            });
            edges.into_iter().fold(p.z.abs() - 0.15, f64::max)
        }),
        Box::new(move |p| uv::triangle(corners, p)),
        turn,
        DVec3::ZERO,
    );
    let slab = one(
        Box::new(|p| (p.y.abs() - 0.1).max(p.x.abs() - 1.9).max(p.z.abs() - 1.9)),
        Box::new(|p| uv::plane(DVec3::ZERO, DVec3::Y, p)),
        DMat3::from_rotation_x(0.9),
        DVec3::ZERO,
    );
    // A ball with the image and a limb with stripes, of the field `ball_and_limb`.
    let soft = Shape {
        distance: Box::new(move |p| {
            let (a, b) = ball_and_limb(p);
            if a + b > 1e-3 {
                0.28 * (1.0 - (a + b)).clamp(-1.0, 0.999)
            } else {
                0.5
            }
        }),
        parts: vec![
            (
                Box::new(|p| ball_and_limb(p).0),
                Box::new(|p| uv::sphere(DVec3::new(-0.8, 0.0, 0.0), p)),
                0,
            ),
            (
                Box::new(|p| ball_and_limb(p).1),
                Box::new(|p| {
                    uv::segment(DVec3::new(-0.6, 0.0, 0.0), DVec3::new(1.7, 0.25, 0.0), p)
                }),
                1,
            ),
        ],
        turn: DMat3::IDENTITY,
        shift: DVec3::ZERO,
    };
    let swatch = |name: &str, shape: Shape| Swatch {
        name: name.into(),
        surface: white,
        layers: vec![vec![image.clone()], vec![striped.clone()]],
        shapes: vec![shape],
    };
    vec![
        swatch("uv of a segment", capsule),
        swatch("uv of an arc", torus),
        swatch("uv of a triangle", prism),
        swatch("uv of a plane", slab),
        swatch("cross-dissolve", soft),
    ]
}

/// Colour of a shape at a point of its space, seen along `ray`.
/// Returns the fields e^(−r²) of two elements at a point.
fn ball_and_limb(p: DVec3) -> (f64, f64) {
    let ball = 2.2 * libm::exp(-2.0 * (p - DVec3::new(-0.8, 0.0, 0.0)).length_squared());
    let d = segment_distance(DVec3::new(-0.6, 0.0, 0.0), DVec3::new(1.7, 0.25, 0.0), p);
    (ball, 1.6 * libm::exp(-5.0 * d * d))
}

fn shade(swatch: &Swatch, shape: &Shape, point: DVec3, ray: DVec3, images: &[&dyn Image]) -> Vec3 {
    let slopes = DVec3::AXES
        .map(|d| (shape.distance)(point + 1e-5 * d) - (shape.distance)(point - 1e-5 * d));
    let normal = DVec3::from_array(slopes).normalize_or(DVec3::Z);
    let parts: Vec<_> = shape
        .parts
        .iter()
        .map(|(weight, coordinates, layers)| {
            let site = Site {
                point,
                normal,
                uv: coordinates(point),
            };
            let surface = Surface {
                normal,
                ..swatch.surface
            };
            (
                weight(point),
                apply(&swatch.layers[*layers], surface, &site, images),
            )
        })
        .collect();
    let surface = blend(&parts).expect("a part");
    let normal = shape.turn * surface.normal;
    let mut colour = surface.ambient;
    for (light, strength) in [
        (DVec3::new(-3.0, 4.0, 5.0), 0.85),
        (DVec3::new(4.0, 1.0, 3.0), 0.3),
    ] {
        let light = light.normalize();
        let falling = normal.dot(light).max(0.0) as f32;
        let mirrored = 2.0 * normal.dot(light) * normal - light;
        let glint = libm::powf(mirrored.dot(-ray).max(0.0) as f32, surface.shine)
            * f32::from(falling > 0.0);
        colour += strength * (falling * surface.diffuse + glint * surface.specular);
    }
    colour
}

fn trace(swatch: &Swatch, at: DVec2, images: &[&dyn Image]) -> Vec3 {
    let eye = DVec3::new(0.0, 0.0, 9.0);
    let ray = DVec3::new(at.x, at.y, -9.0).normalize();
    let mut best = (f64::INFINITY, Vec3::new(0.16, 0.17, 0.2));
    for shape in &swatch.shapes {
        let back = shape.turn.transpose();
        let (start, way) = (back * (eye - shape.shift), back * ray);
        let mut t = 5.0;
        for _ in 0..400 {
            let d = (shape.distance)(start + t * way);
            if d < 1e-6 || t > 14.0 {
                break;
            }
            t += d;
        }
        if t < 14.0 && t < best.0 {
            best = (t, shade(swatch, shape, start + t * way, ray, images));
        }
    }
    best.1
}

fn main() {
    let path = std::env::args().nth(1).expect("usage: swatches OUT.png");
    let picture = picture();
    let images: [&dyn Image; 1] = [&picture];
    let swatches: Vec<_> = solids()
        .into_iter()
        .chain(bumps())
        .chain(flat())
        .chain(mappings())
        .collect();
    let rows = swatches.len().div_ceil(COLUMNS);
    let (width, height) = (COLUMNS * CELL[0], rows * CELL[1]);
    let mut bytes = vec![255_u8; 3 * width * height];
    for (i, swatch) in swatches.iter().enumerate() {
        println!(
            "row {}, column {}: {}",
            i / COLUMNS + 1,
            i % COLUMNS + 1,
            swatch.name
        );
        for y in 0..CELL[1] {
            for x in 0..CELL[0] {
                let mut sum = Vec3::ZERO;
                for k in 0..RAYS * RAYS {
                    let inside =
                        DVec2::new((k % RAYS) as f64 + 0.5, (k / RAYS) as f64 + 0.5) / RAYS as f64;
                    let pixel = DVec2::new(x as f64, y as f64) + inside;
                    let at = (pixel - 0.5 * DVec2::new(CELL[0] as f64, CELL[1] as f64))
                        * (4.9 / CELL[0] as f64);
                    sum += trace(swatch, DVec2::new(at.x, -at.y), &images)
                        .clamp(Vec3::ZERO, Vec3::ONE);
                }
                let colour = sum / (RAYS * RAYS) as f32;
                let start = 3 * ((i / COLUMNS * CELL[1] + y) * width + i % COLUMNS * CELL[0] + x);
                for channel in 0..3 {
                    bytes[start + channel] = (255.0 * libm::powf(colour[channel], 1.0 / 1.6)) as u8;
                }
            }
        }
    }
    let file = BufWriter::new(File::create(path).expect("the file can be made"));
    let mut encoder = png::Encoder::new(file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&bytes).expect("pixels");
}
