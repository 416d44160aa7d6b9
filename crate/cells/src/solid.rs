//! The draft's form of a shape's offset surface: an oriented box, and a few numbers that describe
//! the shape inside it. Everything is computed in `f64`; [`crate::pack`] packs it for the GPU.

use crate::facets;
use field::Skeleton;
use glam::{DMat3, DQuat, DVec2, DVec3, Vec2Swizzles as _, Vec3};
use scene::{Element, Ends, Rgb, Scene, Shape};

/// The kind of a solid, which decides the shader that draws it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Sphere,
    Cylinder,
    Arc,
    Triangle,
    Plane,
    Patch,
}

/// An element's offset surface in coordinates of its own, where its size is about 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Solid {
    pub(crate) kind: Kind,
    /// World position of the own coordinates' origin.
    pub(crate) origin: DVec3,
    /// The own axes in the world.
    pub(crate) rotation: DQuat,
    /// World length of one unit of the own coordinates.
    pub(crate) unit: f64,
    /// The box around the solid, own coordinates. Means nothing for a plane.
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    /// Numbers that the shape's shader explains; each is an `f32` for it.
    pub(crate) a: [f64; 4],
    pub(crate) b: [f64; 4],
    /// The unit normals at the corners of a patch, own coordinates.
    pub(crate) normals: [DVec3; 3],
}

/// Returns the radius at the end of a soft line whose flesh tapers; `None` for other shapes.
pub(crate) fn soft_end(scene: &Scene, element: &Element) -> Option<f64> {
    let is_line = element
        .shape
        .bone()
        .is_some_and(|bone| matches!(bone.skeleton, Skeleton::Segment { .. }));
    let flesh = scene.flesh_in_world(element).filter(|_| is_line);
    flesh.and_then(|flesh| flesh.end_radius)
}

impl Solid {
    /// The solids that the draft shows for an element of a scene; none where there is nothing to
    /// see: no radius, no length, numbers that are not finite, or a soft element that adds no
    /// flesh because its strength is not positive. `detail` is that of [`facets::detail`].
    pub(crate) fn of(scene: &Scene, element: &Element, detail: usize) -> Vec<Self> {
        let flesh = element
            .flesh
            .and_then(|flesh| scene.flesh.get(flesh as usize));
        let is_function = matches!(element.shape, Shape::Function(_));
        let adds = flesh.map_or(is_function, |flesh| flesh.strength > 0.0);
        if scene.is_soft(element) && !adds {
            return Vec::new();
        }
        let radius = scene.radius(element);
        let parts = match element.shape {
            Shape::Box(cuboid) => facets::cuboid(cuboid.center, cuboid.axes),
            Shape::Quadric(ref quadric) => facets::quadric(quadric, detail),
            ref other => other.parts(radius),
        };
        let paint = element.paint.as_ref().map(|paint| paint.corners);
        let end_radius = soft_end(scene, element);
        let solids = parts.into_iter().filter_map(|mut part| {
            if let (Some(_), Shape::Bone(bone)) = (end_radius, &mut part)
                && bone.end_radius.is_none()
            {
                (bone.radius, bone.end_radius) = (radius, end_radius);
            }
            let radius = if is_function { part.radius() } else { radius };
            Self::new(&part, radius, paint)
        });
        solids.collect()
    }

    /// The offset surface of a shape at the given radius. `paint` gives colours to the corners of a
    /// patch, and of a triangle without thickness, which then becomes a patch.
    fn new(shape: &Shape, radius: f64, paint: Option<[Rgb; 3]>) -> Option<Self> {
        if !radius.is_finite() {
            return None;
        }
        let Shape::Bone(bone) = shape else {
            return None;
        };
        let solid = match bone.skeleton {
            Skeleton::Point { center } => Self::sphere(center, radius),
            Skeleton::Segment { base, apex } => match bone.ends {
                Ends::Open => Self::pipe(base, apex, radius),
                Ends::Lids | Ends::Round => Self::cone([base, apex], bone.radii(radius)),
            },
            Skeleton::Arc {
                center,
                u,
                v,
                radius: sweep,
                angle,
            } => Self::arc(center, u, v, sweep, angle, radius),
            Skeleton::Triangle { corners } => match (&bone.normals, paint) {
                (Some(normals), _) => {
                    Self::patch(corners, **normals, paint.unwrap_or([[1.0; 3]; 3]))
                }
                (None, Some(colors)) if radius == 0.0 => {
                    Self::patch(corners, [DVec3::ZERO; 3], colors)
                }
                (None, _) => Self::triangle(corners, radius),
            },
            Skeleton::Plane { point, normal } => Self::plane(point, normal, radius),
            // Made of several solids.
            _ => None,
        }?;
        let numbers = solid.a.iter().chain(&solid.b);
        (solid.origin.is_finite()
            && solid.rotation.is_finite()
            && solid.unit.is_finite()
            && solid.unit > 0.0
            && solid.low.is_finite()
            && solid.high.is_finite()
            && solid.normals.iter().all(|n| n.is_finite())
            && numbers.copied().all(f64::is_finite))
        .then_some(solid)
    }

    /// World corners of the axis-parallel box around the solid; none for a plane, which has no end.
    pub(crate) fn bounds(&self) -> Option<(DVec3, DVec3)> {
        if self.kind == Kind::Plane {
            return None;
        }
        let middle = self.origin + self.rotation * ((self.low + self.high) * 0.5 * self.unit);
        let half = (self.high - self.low) * 0.5 * self.unit;
        let axes = DMat3::from_quat(self.rotation);
        let reach =
            axes.x_axis.abs() * half.x + axes.y_axis.abs() * half.y + axes.z_axis.abs() * half.z;
        Some((middle - reach, middle + reach))
    }

    /// Returns the least radius of a ball, a cylinder or an arc, or half a triangle's thickness;
    /// `None` for planes and patches.
    pub(crate) fn thinnest(&self) -> Option<f64> {
        let own = match self.kind {
            Kind::Sphere => 1.0,
            Kind::Cylinder => self.a[0] - self.a[1] * self.a[2].abs(),
            Kind::Arc => self.a[1],
            Kind::Triangle => self.b[2],
            Kind::Plane | Kind::Patch => return None,
        };
        Some(own * self.unit)
    }

    /// Moves the origin, where that is free, as near to a point as possible: a plane looks the same
    /// from anywhere along it, but digits are best where the scene is.
    pub(crate) fn move_origin_near(mut self, point: DVec3) -> Self {
        if self.kind == Kind::Plane {
            let normal = self.rotation * DVec3::Z;
            self.origin = point - normal * normal.dot(point - self.origin);
        }
        self
    }

    fn sphere(center: DVec3, radius: f64) -> Option<Self> {
        (radius > 0.0).then_some(Self {
            kind: Kind::Sphere,
            origin: center,
            rotation: DQuat::IDENTITY,
            unit: radius,
            low: DVec3::NEG_ONE,
            high: DVec3::ONE,
            a: [1.0, 0.0, 0.0, 0.0],
            b: [0.0; 4],
            normals: [DVec3::ZERO; 3],
        })
    }

    fn cone([base, apex]: [DVec3; 2], [first, last]: [f64; 2]) -> Option<Self> {
        let length = base.distance(apex);
        let radius = first.max(last);
        let sound = radius > 0.0 && first.min(last) >= 0.0 && length > 0.0;
        if !sound {
            return None;
        }
        let unit = radius.max(0.5 * length);
        let high = DVec3::new(radius, radius, 0.5 * length) / unit;
        // Flatter than this it cannot be told from a disc, and squares must stay `f32`s.
        let slope = ((last - first) / length).clamp(-1e6, 1e6);
        Some(Self {
            kind: Kind::Cylinder,
            origin: base.midpoint(apex),
            rotation: with_z(apex - base)?,
            unit,
            low: -high,
            high,
            a: [first.midpoint(last) / unit, 0.5 * length / unit, slope, 0.0],
            b: [0.0; 4],
            normals: [DVec3::ZERO; 3],
        })
    }

    fn pipe(base: DVec3, apex: DVec3, radius: f64) -> Option<Self> {
        let mut pipe = Self::cone([base, apex], [radius; 2])?;
        pipe.a[3] = 1.0;
        Some(pipe)
    }

    /// A flat triangle with colours at its corners, whose normals there may have any length; 0
    /// stands for the face's.
    pub(crate) fn patch(
        corners: [DVec3; 3],
        normals: [DVec3; 3],
        colors: [Rgb; 3],
    ) -> Option<Self> {
        let flat = Self::triangle(corners, 0.0)?;
        let [p, q, r] = [
            [flat.a[0], flat.a[1]],
            [flat.a[2], flat.a[3]],
            [flat.b[0], flat.b[1]],
        ];
        // The corners may have been renumbered; a normal and a colour belong to the one nearest to
        // their place.
        let back = flat.rotation.inverse();
        let order = [p, q, r].map(|corner| {
            let world = flat.origin + flat.rotation * DVec2::from(corner).extend(0.0) * flat.unit;
            let distances = corners.map(|corner| corner.distance_squared(world));
            let nearest = (0..3).min_by(|&i, &j| distances[i].total_cmp(&distances[j]));
            nearest.unwrap_or(0)
        });
        let [high, low] = pack(order.map(|k| colors[k]));
        Some(Self {
            kind: Kind::Patch,
            normals: order.map(|k| (back * normals[k]).normalize_or(DVec3::Z)),
            b: [r[0], r[1], high, low],
            ..flat
        })
    }

    fn arc(center: DVec3, u: DVec3, v: DVec3, sweep: f64, angle: f64, radius: f64) -> Option<Self> {
        if radius <= 0.0 || sweep <= 0.0 || angle.is_nan() || angle <= 0.0 {
            return None;
        }
        let full = core::f64::consts::TAU;
        // A ring that all but closes has lids which nothing can be seen of.
        let ring = angle >= full * (1.0 - 1e-9);
        let half_angle = 0.5 * angle.min(full);
        let (sine, cosine) = libm::sincos(half_angle);
        let u = u.try_normalize()?;
        let v = v.reject_from_normalized(u).try_normalize()?;
        let x = u * cosine + v * sine;
        let y = v * cosine - u * sine;
        let z = u.cross(v);

        let inner = (sweep - radius).max(0.0);
        let outer = sweep + radius;
        // The reach towards the circle's centre. 1 − cos is written without cancellation: of a
        // slightly bent arc of an enormous circle, the bend is what is seen.
        let half_sine = libm::sin(0.5 * half_angle);
        let bend = 2.0 * half_sine * half_sine;
        let low_x = if cosine >= 0.0 {
            (inner - sweep) - inner * bend
        } else {
            (outer - sweep) - outer * bend
        };
        let high_y = if cosine <= 0.0 { outer } else { outer * sine };
        let unit = radius.max(high_y).max(-low_x);
        Some(Self {
            kind: Kind::Arc,
            origin: center + x * sweep,
            rotation: DQuat::from_mat3(&DMat3::from_cols(x, y, z)).normalize(),
            unit,
            low: DVec3::new(low_x, -high_y, -radius) / unit,
            high: DVec3::new(radius, high_y, radius) / unit,
            a: [sweep / unit, radius / unit, sine, cosine],
            b: [sweep * sine / unit, f64::from(u8::from(ring)), 0.0, 0.0],
            normals: [DVec3::ZERO; 3],
        })
    }

    fn triangle(corners: [DVec3; 3], radius: f64) -> Option<Self> {
        let half = radius.max(0.0);
        // The longest edge becomes the x-axis, so the box is tight.
        let squares = [0, 1, 2].map(|k| corners[k].distance_squared(corners[(k + 1) % 3]));
        let longest = (0..3).max_by(|&i, &j| squares[i].total_cmp(&squares[j]))?;
        let [p, q, r] = [0, 1, 2].map(|k| corners[(longest + k) % 3]);
        let x = (q - p).try_normalize()?;
        let aside = (r - p).reject_from_normalized(x);
        let length = q.distance(p);
        // Corners on one line span no face.
        if aside.length() <= 1e-12 * length {
            return None;
        }
        let y = aside.try_normalize()?;
        let z = x.cross(y);
        let peak = DVec2::new((r - p).dot(x), aside.length());
        let middle = DVec2::new(length, peak.y) * 0.5;
        let unit = half.max(middle.max_element());
        let [p2, q2, r2] =
            [DVec2::ZERO, DVec2::new(length, 0.0), peak].map(|corner| (corner - middle) / unit);
        let high = middle.extend(half) / unit;
        Some(Self {
            kind: Kind::Triangle,
            origin: p + x * middle.x + y * middle.y,
            rotation: DQuat::from_mat3(&DMat3::from_cols(x, y, z)).normalize(),
            unit,
            low: -high,
            high,
            a: [p2.x, p2.y, q2.x, q2.y],
            b: [r2.x, r2.y, half / unit, 0.0],
            normals: [DVec3::ZERO; 3],
        })
    }

    fn plane(point: DVec3, normal: DVec3, radius: f64) -> Option<Self> {
        let half = radius.max(0.0);
        let unit = if half > 0.0 { half } else { 1.0 };
        Some(Self {
            kind: Kind::Plane,
            origin: point,
            rotation: with_z(normal)?,
            unit,
            low: DVec3::NEG_ONE,
            high: DVec3::ONE,
            a: [half / unit, 0.0, 0.0, 0.0],
            b: [0.0; 4],
            normals: [DVec3::ZERO; 3],
        })
    }
}

impl Solid {
    /// Returns the numbers `low` and `high` of the shaders: the corners of the box. A patch is
    /// covered by itself and needs no box, but has normals.
    pub(crate) fn corners(&self) -> [Vec3; 2] {
        if self.kind == Kind::Patch {
            let [[a, b], [c, d], [e, f]] = self.normals.map(fold);
            [Vec3::new(a, b, c), Vec3::new(d, e, f)]
        } else {
            [self.low, self.high].map(|corner| corner.as_vec3())
        }
    }
}

/// A unit vector as a point of the square onto which the octahedron |x| + |y| + |z| = 1 unfolds;
/// the lower half is folded outwards.
fn fold(v: DVec3) -> [f32; 2] {
    let flat = v.truncate() / v.abs().element_sum();
    let folded = (1.0 - flat.abs().yx()) * flat.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
    let place = if v.z < 0.0 { folded } else { flat };
    place.as_vec2().to_array()
}

/// A rotation that takes the z-axis to a direction; none for a direction without length.
fn with_z(direction: DVec3) -> Option<DQuat> {
    let z = direction.try_normalize()?;
    let x = z.any_orthonormal_vector();
    Some(DQuat::from_mat3(&DMat3::from_cols(x, z.cross(x), z)).normalize())
}

/// Packs three colours in two whole numbers below 2^24, for `patch.wgsl`: 16 bits each, of which
/// red has 5, green 6, blue 5.
fn pack(colors: [Rgb; 3]) -> [f64; 2] {
    let mut bits = 0u64;
    for color in colors {
        for (channel, width) in color.into_iter().zip([5, 6, 5]) {
            let most = ((1 << width) - 1) as f32;
            bits = bits << width | (channel.clamp(0.0, 1.0) * most).round() as u64;
        }
    }
    [bits >> 24, bits & 0xff_ffff].map(|number| number as f64)
}
