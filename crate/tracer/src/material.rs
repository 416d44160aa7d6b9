//! Materials at points of surfaces: finishes with their textures, each in the coordinates of its
//! object, mixed by the shares of the elements.
use field::Skeleton;
use field::skeleton::ring_vector;
use glam::{DAffine3, DMat3, DVec3, Vec3};
use scene::{Element, Finish, Scene, Shape, Skip};
use std::sync::Arc;
use texture::uv::{self, Sheet};
use texture::{Image, Rgb8, Site, Surface, Target, Texture, Uv, apply, blend};

/// Shares of elements below this part of all are left out.
const NEGLIGIBLE: f64 = 1e-4;
/// Straight pieces along which the coordinates of curves run.
const CURVE_PIECES: usize = 24;

/// The materials of a scene.
pub(crate) struct Materials {
    finishes: Vec<Material>,
    /// Index into `places` of each element whose finish has layers.
    place_of: Vec<Option<u32>>,
    places: Vec<Charted>,
    frames: Vec<Object>,
    images: Vec<Arc<Rgb8>>,
}

/// A finish.
struct Material {
    surface: Surface,
    dispersion: f32,
    skip: Skip,
    layers: Vec<Texture>,
    /// Whether an element with this finish is painted.
    is_painted: bool,
}

/// Coordinates of an object.
struct Object {
    /// Maps points of the unit scene to the object.
    to_object: DAffine3,
    /// Maps normals of the object to the unit scene: the transpose of `to_object`'s linear part.
    normals: DMat3,
    /// Maps normals of the unit scene to the object.
    from_world: DMat3,
}

/// The place of a textured or painted element.
struct Charted {
    object: u32,
    chart: Chart,
    paint: Option<Painted>,
}

/// Colours at the corners of a triangle.
struct Painted {
    /// The finish whose colours they multiply.
    finish: u32,
    corners: [Vec3; 3],
}

impl Painted {
    /// Returns the colour at a point of the triangle: the corners' mixed by barycentric shares,
    /// which are cut to the triangle.
    fn color(&self, uv: &Uv) -> Vec3 {
        let [second, third] = uv.at.as_vec2().to_array();
        let shares = [(1.0 - second - third).max(0.0), second, third];
        let mixed: Vec3 = (0..3).map(|k| shares[k] * self.corners[k]).sum();
        mixed / shares.iter().sum::<f32>()
    }
}

/// The texture coordinates of a shape, in its object's coordinates.
enum Chart {
    Sphere(DVec3),
    Segment([DVec3; 2]),
    Arc(uv::Arc),
    Curve([DVec3; 4]),
    Triangle([DVec3; 3]),
    Plane([DVec3; 2]),
    Sheet(Sheet),
    Box(DVec3, [DVec3; 3]),
}

/// A material at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    /// Parameters of shading; its normal has the textures' bumps.
    pub surface: Surface,
    /// Difference of the index between blue and red.
    pub dispersion: f32,
    pub skip: Skip,
}

impl Materials {
    /// Collects a scene's materials. The scene is the unit scene.
    pub fn new(scene: &Scene) -> Self {
        let mut finishes: Vec<Material> = scene.finishes.iter().map(material).collect();
        for element in scene.elements.iter().filter(|e| e.paint.is_some()) {
            if let Some(finish) = finishes.get_mut(element.finish as usize) {
                finish.is_painted = true;
            }
        }
        let frames: Vec<Object> = scene.frames.iter().map(|f| object(f.to_world)).collect();
        let (mut place_of, mut places) = (Vec::new(), Vec::new());
        let is_charted = |element: &Element| {
            let finish = finishes.get(element.finish as usize);
            element.paint.is_some() || finish.is_some_and(|finish| !finish.layers.is_empty())
        };
        if scene.elements.iter().any(is_charted) {
            for element in &scene.elements {
                let frame = frames.get(element.frame as usize);
                let Some(frame) = frame.filter(|_| is_charted(element)) else {
                    place_of.push(None);
                    continue;
                };
                place_of.push(Some(places.len() as u32));
                let paint = element.paint.as_ref();
                let paint = paint.filter(|paint| (paint.finish as usize) < finishes.len());
                places.push(Charted {
                    object: element.frame,
                    chart: chart(&element.shape, &frame.to_object),
                    paint: paint.map(|paint| Painted {
                        finish: paint.finish,
                        corners: paint.corners.map(Vec3::from),
                    }),
                });
            }
        }
        Self {
            finishes,
            place_of,
            places,
            frames,
            images: scene.images.clone(),
        }
    }

    /// Whether surfaces with a finish look the same everywhere.
    pub fn is_even(&self, finish: u32) -> bool {
        let finish = &self.finishes[finish as usize];
        finish.layers.is_empty() && !finish.is_painted
    }

    /// Returns the material of a finish without its textures and paint, at a point with an outward
    /// normal.
    pub fn plain(&self, finish: u32, normal: DVec3) -> Look {
        let material = &self.finishes[finish as usize];
        Look {
            surface: Surface {
                normal,
                ..material.surface
            },
            dispersion: material.dispersion,
            skip: material.skip,
        }
    }

    /// Returns the material of an element at a point of the unit scene with an outward normal.
    fn of_element(&self, finish: u32, element: u32, point: DVec3, normal: DVec3) -> Look {
        let mut look = self.plain(finish, normal);
        let place = self.place_of.get(element as usize).copied().flatten();
        if let Some(place) = place {
            let Charted {
                object,
                chart,
                paint,
            } = &self.places[place as usize];
            let object = &self.frames[*object as usize];
            let at = object.to_object.transform_point3(point);
            let own = (object.from_world * normal).normalize_or(normal);
            let uv = chart.uv(at);
            if let Some(paint) = paint {
                let color = paint.color(&uv);
                look = self.plain(paint.finish, normal);
                look.surface.diffuse *= color;
                look.surface.ambient *= color;
            }
            let site = Site {
                point: at,
                normal: own,
                uv,
            };
            let images: Vec<&dyn Image> = self.images.iter().map(|i| &**i as &dyn Image).collect();
            let bare = Surface {
                normal: own,
                ..look.surface
            };
            let layers = &self.finishes[finish as usize].layers;
            look.surface = apply(layers, bare, &site, &images);
            look.surface.normal = if look.surface.normal == own {
                normal
            } else {
                (object.normals * look.surface.normal).normalize_or(normal)
            };
        }
        look
    }

    /// Mixes the materials of the elements that make a surface, each given with its finish and its
    /// share; the sum of the shares need not be 1. The kinds of rays that pass by are those of the
    /// element with the largest share. `None` without elements.
    pub fn mix(&self, shares: &[(u32, u32, f64)], point: DVec3, normal: DVec3) -> Option<Look> {
        let most = shares.iter().map(|s| s.2).fold(0.0, f64::max);
        let mut parts: Vec<(f64, Surface)> = Vec::new();
        // The finishes of those parts that stand for all elements of an even finish.
        let mut even: Vec<(u32, usize)> = Vec::new();
        let mut strongest: Option<(f64, Skip)> = None;
        let (mut total, mut dispersion) = (0.0, 0.0);
        for &(element, finish, share) in shares {
            if shares.len() > 1 && (share <= NEGLIGIBLE * most || share.is_nan()) {
                continue;
            }
            let material = &self.finishes[finish as usize];
            total += share;
            dispersion += share * f64::from(material.dispersion);
            if strongest.is_none_or(|(most, _)| share > most) {
                strongest = Some((share, material.skip));
            }
            if !self.is_even(finish) {
                let surface = self.of_element(finish, element, point, normal).surface;
                parts.push((share, surface));
            } else if let Some(&(_, part)) = even.iter().find(|(own, _)| *own == finish) {
                parts[part].0 += share;
            } else {
                even.push((finish, parts.len()));
                parts.push((share, self.plain(finish, normal).surface));
            }
        }
        let (_, skip) = strongest?;
        let dispersion = (dispersion / total) as f32;
        Some(Look {
            surface: blend(&parts)?,
            dispersion: if dispersion.is_finite() {
                dispersion
            } else {
                0.0
            },
            skip,
        })
    }
}

/// Adds up the shares of pieces of one element, as those of a limb.
pub(crate) fn join_pieces(shares: &mut Vec<(u32, u32, f64)>) {
    field::heap_sort(shares, |a, b| {
        let order = (a.0, a.1).cmp(&(b.0, b.1));
        order.then(a.2.total_cmp(&b.2)).is_lt()
    });
    shares.dedup_by(|next, kept| {
        let same = (next.0, next.1) == (kept.0, kept.1);
        if same {
            kept.2 += next.2;
        }
        same
    });
}

/// Whether pictures of a finish need more than Phong's model.
pub(crate) fn is_plain(finish: &Finish) -> bool {
    finish.reflective == [0.0; 3]
        && finish.transparent == [0.0; 3]
        && finish.skip == Skip::default()
        && finish.layers.iter().all(|t| t.target == Target::Strength)
}

/// Whether light to other surfaces may pass a surface of this finish.
pub(crate) fn lets_light_through(finish: &Finish) -> bool {
    let mut layers = finish.layers.iter();
    finish.skip.shadow
        || finish.transparent != [0.0; 3]
        || layers.any(|layer| layer.target == Target::Transparent)
}

/// Replaces channels that are negative or not finite by 0.
fn share(colour: scene::Rgb) -> Vec3 {
    Vec3::from_array(colour.map(|c| if c > 0.0 && c.is_finite() { c } else { 0.0 }))
}

/// Prepares a finish. Numbers without sense get harmless values.
fn material(finish: &Finish) -> Material {
    let layers = finish
        .layers
        .iter()
        .filter(|t| t.target != Target::Strength);
    Material {
        surface: Surface {
            diffuse: Vec3::from(finish.diffuse),
            ambient: Vec3::from(finish.ambient),
            specular: Vec3::from(finish.specular),
            reflective: share(finish.reflective),
            transparent: share(finish.transparent),
            index: if finish.index > 0.0 && finish.index.is_finite() {
                finish.index
            } else {
                1.0
            },
            shine: finish.shine.max(0.0),
            normal: DVec3::Z,
        },
        dispersion: if finish.dispersion.is_finite() {
            finish.dispersion
        } else {
            0.0
        },
        skip: finish.skip,
        layers: layers.take(texture::MAX_LAYERS).cloned().collect(),
        is_painted: false,
    }
}

/// Prepares a frame. One that squeezes everything flat counts as the world's own.
fn object(to_world: DAffine3) -> Object {
    let inverse = to_world.inverse();
    let to_object = if inverse.is_finite() {
        inverse
    } else {
        DAffine3::IDENTITY
    };
    let from_world = to_object.matrix3.inverse().transpose();
    Object {
        to_object,
        normals: to_object.matrix3.transpose(),
        from_world: if from_world.is_finite() {
            from_world
        } else {
            DMat3::IDENTITY
        },
    }
}

/// Returns the texture coordinates of a shape of the unit scene, given its object's coordinates.
fn chart(shape: &Shape, to: &DAffine3) -> Chart {
    let point = |p: DVec3| to.transform_point3(p);
    let vector = |v: DVec3| to.transform_vector3(v);
    let skeleton = match shape {
        Shape::Bone(bone) => &bone.skeleton,
        Shape::Box(cuboid) => return Chart::Box(point(cuboid.center), cuboid.axes.map(vector)),
        Shape::Quadric(own) => return Chart::Box(point(own.center), own.axes.map(vector)),
        Shape::Function(function) => return Chart::Sphere(point(function.middle())),
    };
    match *skeleton {
        Skeleton::Segment { base, apex } => Chart::Segment([point(base), point(apex)]),
        Skeleton::Arc {
            center,
            u,
            v,
            radius,
            angle,
        } => {
            let along = vector(u * radius);
            let u = along.normalize_or(u);
            let v = vector(v);
            Chart::Arc(uv::Arc {
                center: point(center),
                u,
                v: (v - u * u.dot(v)).normalize_or(u.any_orthonormal_vector()),
                sweep: along.length(),
                angle,
            })
        }
        Skeleton::Curve { control } => Chart::Curve(control.map(point)),
        Skeleton::Triangle { corners } => Chart::Triangle(corners.map(point)),
        Skeleton::Plane {
            point: foot,
            normal,
        } => {
            let normal = to.matrix3.inverse().transpose() * normal;
            Chart::Plane([point(foot), normal.normalize_or(DVec3::Y)])
        }
        Skeleton::Polygon { ref rings } => {
            let corners: Vec<DVec3> = rings.iter().flatten().map(|&p| point(p)).collect();
            let first = corners.first().copied().unwrap_or_default();
            let outer = rings.first().map_or(0, Vec::len);
            let normal = ring_vector(&corners[..outer]).normalize_or(DVec3::Y);
            match Sheet::around(&corners, normal) {
                Some(sheet) => Chart::Sheet(sheet),
                None => Chart::Plane([first, normal]),
            }
        }
        ref other => Chart::Sphere(point(other.middle())),
    }
}

impl Chart {
    /// Returns the texture coordinates of a point.
    fn uv(&self, point: DVec3) -> Uv {
        match self {
            Self::Sphere(center) => uv::sphere(*center, point),
            Self::Segment([base, apex]) => uv::segment(*base, *apex, point),
            Self::Arc(arc) => uv::arc(arc, point),
            Self::Curve(control) => along_curve(control, point),
            Self::Triangle(corners) => uv::triangle(*corners, point),
            Self::Plane([origin, normal]) => uv::plane(*origin, *normal, point),
            Self::Sheet(sheet) => sheet.uv(point),
            Self::Box(center, axes) => uv::cuboid(*center, *axes, point),
        }
    }
}

/// Returns coordinates along and around a Bézier curve: those of the nearest of straight pieces
/// between evenly spaced parameters.
fn along_curve([a, b, c, d]: &[DVec3; 4], point: DVec3) -> Uv {
    let pieces: [(f64, DVec3); CURVE_PIECES + 1] = core::array::from_fn(|i| {
        let t = i as f64 / CURVE_PIECES as f64;
        let s = 1.0 - t;
        let place =
            *a * (s * s * s) + *b * (3.0 * s * s * t) + *c * (3.0 * s * t * t) + *d * (t * t * t);
        (t, place)
    });
    let mut nearest = (f64::INFINITY, 0);
    for i in 0..CURVE_PIECES {
        let (base, apex) = (pieces[i].1, pieces[i + 1].1);
        let axis = apex - base;
        let along = ((point - base).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        let apart = point.distance_squared(base + along * axis);
        if apart < nearest.0 {
            nearest = (apart, i);
        }
    }
    let [(from, base), (to, apex)] = [pieces[nearest.1], pieces[nearest.1 + 1]];
    uv::segment(base, apex, point).of_piece(from, to)
}
