//! Uniforms of the camera and the lights.

use bytemuck::{Pod, Zeroable};
use cells::{Bounds, Units, finite, with};
use glam::DVec3;
use scene::{Background, Camera, Ground, Light, LightKind, Scene, Tone};

/// Lights that the draft can take. Of more, the strongest count.
pub const MAX_LIGHTS: usize = 8;

/// Returns the gamma of a scene. One that makes no sense is 1; within the range, powers stay
/// finite.
pub(crate) fn gamma(scene: &Scene) -> f32 {
    let gamma = scene.settings.gamma;
    if gamma.is_finite() && gamma > 0.0 {
        gamma.clamp(1e-2, 1e2)
    } else {
        1.0
    }
}

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct PackedLight {
    place: [f32; 4],
    colour: [f32; 4],
    aim: [f32; 4],
}

/// The uniform `view` of `shaders/view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct View {
    right: [f32; 4],
    up: [f32; 4],
    forward: [f32; 4],
    eye: [f32; 4],
    picture: [f32; 4],
    lights: [PackedLight; MAX_LIGHTS],
    air: Air,
}

impl View {
    /// The view of a camera onto a picture of a size.
    pub(crate) fn new(
        camera: &Camera,
        size: [u32; 2],
        units: Units,
        gamma: f32,
        lights: &Lights,
        air: Air,
    ) -> Self {
        let projection = camera.projection(size[0], size[1]);
        let axes = projection.world_from_view;
        let [right, up, forward] = [
            (axes.x_axis, projection.half_width),
            (axes.y_axis, projection.half_height),
            (-axes.z_axis, projection.shift[1]),
        ]
        .map(|(axis, w)| axis.as_vec3().extend(w as f32).to_array());
        let [x, y, z] = units.place(projection.eye);
        Self {
            right,
            up,
            forward,
            eye: [x, y, z, projection.shift[0] as f32],
            picture: [
                1.0 / size[0] as f32,
                1.0 / size[1] as f32,
                gamma,
                lights.count as f32,
            ],
            lights: lights.packed,
            air,
        }
    }
}

/// The lights that count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lights {
    packed: [PackedLight; MAX_LIGHTS],
    count: usize,
    /// A bit for each of them that casts shadows.
    pub(crate) shadows: u32,
}

impl Lights {
    /// Packs the strongest lights, and returns the number of those left out.
    pub(crate) fn new(lights: &[Light], units: Units) -> (Self, usize) {
        let strengths = lights
            .iter()
            .map(|light| light.colour.map(finite).into_iter().sum());
        let mut order: Vec<(f32, usize)> = strengths.zip(0..).collect();
        // Of equally strong lights the first ones count.
        field::heap_sort(&mut order, |a, b| {
            b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).is_lt()
        });
        let order: Vec<&Light> = order.into_iter().map(|(_, i)| &lights[i]).collect();
        let mut packed = [PackedLight::zeroed(); MAX_LIGHTS];
        for (slot, light) in packed.iter_mut().zip(&order) {
            let (place, w) = match light.kind {
                LightKind::Point { position } | LightKind::Spot { position, .. } => {
                    (units.place(position), 1.0)
                }
                LightKind::Distant { towards } => {
                    (towards.normalize_or_zero().as_vec3().to_array(), 0.0)
                }
            };
            let [red, green, blue] = light.colour.map(finite);
            // The angle at which a spot's light ends and that over which it fades, both in radians.
            let (aim, fade) = match light.kind {
                LightKind::Spot {
                    direction,
                    angle,
                    edge,
                    ..
                } => {
                    let [x, y, z] = direction.normalize_or_zero().as_vec3().to_array();
                    let [angle, edge] =
                        [angle, edge].map(|degrees| finite(degrees.to_radians() as f32));
                    ([x, y, z, angle], edge)
                }
                _ => ([0.0; 4], 0.0),
            };
            *slot = PackedLight {
                place: [place[0], place[1], place[2], w],
                colour: [red, green, blue, fade],
                aim,
            };
        }
        let count = order.len().min(MAX_LIGHTS);
        let bits =
            (order.iter().take(count).enumerate()).map(|(i, light)| u32::from(light.shadow) << i);
        let lights = Self {
            packed,
            count,
            shadows: bits.sum(),
        };
        (lights, order.len() - count)
    }
}

/// Colours of a background that the draft can take. Of more, the first ones and the last count.
const MAX_COLOURS: usize = 4;

/// The air, ground and sky around the elements: the end of the uniform `view`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct Air {
    zenith: [f32; 4],
    background: [[f32; 4]; MAX_COLOURS],
    fog: [f32; 4],
    ground: [f32; 4],
    sky: [f32; 4],
    horizon: [f32; 4],
    levels: [f32; 4],
}

impl Air {
    /// The air of a scene, which may stand on the ground.
    pub(crate) fn of(scene: &Scene, units: Units) -> Self {
        let lowest = match scene.ground {
            Some(Ground { height: None, .. }) => {
                Bounds::lowest(scene, scene.up.normalize_or(DVec3::Y))
            }
            _ => 0.0,
        };
        let up = scene.up.normalize_or(DVec3::Y);
        let center = units.center.dot(up);
        let inverse = |length: f64| {
            let share = (units.radius / length) as f32;
            if share.is_finite() {
                share.max(0.0)
            } else {
                0.0
            }
        };
        let colours = match &scene.background {
            Background::Gradient(colours) if !colours.is_empty() => colours.clone(),
            other => vec![other.mean()],
        };
        let count = colours.len().min(MAX_COLOURS);
        let mut background = [[0.0; 4]; MAX_COLOURS];
        for (to, colour) in background.iter_mut().zip(&colours) {
            *to = with(*colour, 0.0);
        }
        if let Some(last) = colours.last() {
            background[count - 1] = with(*last, 0.0);
        }
        let [x, y, z] = up.as_vec3().to_array();
        let ground = scene.ground.map(|ground| ground.height.unwrap_or(lowest));
        let fog = scene.fog.filter(|fog| fog.distance > 0.0);
        let thins = fog.and_then(|fog| fog.height);
        let is_filmic = scene.settings.tone == Tone::Filmic;
        Self {
            zenith: [x, y, z, count as f32],
            background,
            fog: fog.map_or([0.0; 4], |fog| with(fog.colour, inverse(fog.distance))),
            ground: scene
                .ground
                .map_or([0.0; 4], |ground| with(ground.colour, 1.0)),
            sky: scene.sky.map_or([0.0; 4], |sky| with(sky.colour, 1.0)),
            horizon: scene.sky.map_or([0.0; 4], |sky| with(sky.horizon, 0.0)),
            levels: [
                ground.map_or(0.0, |height| {
                    finite(((height - center) / units.radius) as f32)
                }),
                finite(((0.0 - center) / units.radius) as f32),
                thins.map_or(0.0, inverse),
                f32::from(u8::from(is_filmic)),
            ],
        }
    }
}
