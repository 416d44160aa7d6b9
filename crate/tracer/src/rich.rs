//! Data of scenes that need more than Phong's model on a background of one colour; others are drawn
//! without.
use crate::air::Air;
use crate::material::{Materials, is_plain, lets_light_through};
use crate::soft::{MakeUp, Soft};
use crate::solids::Solids;
use field::Skeleton;
use glam::{DVec3, Vec3};
use scene::unit::lowest;
use scene::{Background, Light, Scene, Settings, Tone, Unit};
use std::collections::BTreeMap;

/// Keys of sheets, beyond the numbers of all surfaces.
const SHEETS: u32 = 1 << 31;

/// Materials, air and settings of a scene that needs them.
pub(crate) struct Rich {
    pub materials: Materials,
    pub air: Air,
    /// Whether light may pass through some surface.
    pub see_through: bool,
    /// Whether no ray leaves a surface except straight to lights, and no surface has textures.
    pub is_direct: bool,
    /// Most reflections and refractions of a ray.
    pub max_depth: u32,
    /// Shares of light below which rays are not sent.
    pub vanish: f32,
    /// Whether lights have a size.
    pub penumbra: bool,
    tone: Tone,
    /// The make-up of each soft body's materials.
    pub make_up: Vec<MakeUp>,
    /// Keys of the media of the solids that enclose no space, `None` for other solids: the same for
    /// all with one finish in one object.
    pub sheets: Vec<Option<u32>>,
}

/// Whether surfaces get light from lights only and are of even materials that neither mirror nor
/// let light pass.
fn is_direct(scene: &Scene) -> bool {
    scene.finishes.iter().all(is_plain) && scene.sky.is_none()
}

/// Whether a scene needs nothing beyond Phong's model.
fn is_simple(scene: &Scene) -> bool {
    let sized = scene.settings.penumbra && scene.lights.iter().any(|light| light.size > 0.0);
    is_direct(scene)
        && !sized
        && scene.elements.iter().all(|element| element.paint.is_none())
        && matches!(scene.background, Background::Colour(_))
        && (scene.ground, scene.fog) == (None, None)
        && scene.clouds.is_empty()
        && scene.settings.tone == Tone::None
        && scene.lens.aperture <= 0.0
        && scene.moments.is_empty()
}

impl Rich {
    /// Whether a scene needs more than Phong's model.
    pub fn is_needed(scene: &Scene) -> bool {
        !is_simple(scene)
    }

    /// Whether light of a weight is followed.
    pub fn shows(&self, weight: Vec3) -> bool {
        weight.max_element() >= self.vanish && weight != Vec3::ZERO
    }

    /// Prepares a scene, given as it is and in units of its size.
    pub fn new(world: &Scene, unit: Unit, scene: &Scene, solids: &Solids) -> Self {
        let settings = &world.settings;
        let middle = unit.world(DVec3::ZERO);
        let mut finishes = scene.finishes.iter().enumerate();
        Self {
            materials: Materials::new(scene),
            air: Air::new(world, lowest(world), middle, unit.length(1.0)),
            is_direct: is_direct(world),
            see_through: finishes.any(|(i, finish)| {
                lets_light_through(finish) && scene.elements.iter().any(|e| e.finish as usize == i)
            }),
            max_depth: settings.max_depth.min(Settings::MAX_DEPTH),
            vanish: if settings.vanish >= 0.0 {
                settings.vanish
            } else {
                0.0
            },
            penumbra: settings.penumbra,
            tone: settings.tone,
            make_up: Vec::new(),
            sheets: sheets(scene, solids),
        }
    }

    /// Completes it with the make-ups of the convolution surfaces.
    pub fn complete(mut self, soft: &Soft) -> Self {
        self.make_up = soft.make_ups();
        self
    }

    /// Whether the light of lights and sky at a surface point is a mean over many directions.
    pub fn has_soft_light(&self, lights: &[Light]) -> bool {
        self.air.sky.is_some() || self.penumbra && lights.iter().any(|light| light.size > 0.0)
    }

    /// Maps light to a colour on the screen.
    pub fn tone(&self, light: Vec3) -> Vec3 {
        match self.tone {
            Tone::None => light,
            Tone::Filmic => texture::tone::filmic(light),
        }
    }
}

/// Returns the keys of the media of those solids that enclose no space ([`Rich::sheets`]).
fn sheets(scene: &Scene, solids: &Solids) -> Vec<Option<u32>> {
    let (mut keys, mut sheets) = (BTreeMap::new(), Vec::new());
    for solid in 0..solids.len() {
        let element = &scene.elements[solids.element(solid) as usize];
        let is_face = element
            .shape
            .skeleton()
            .is_some_and(|bone| bone.dimension() == 2 && !matches!(bone, Skeleton::Plane { .. }));
        let is_sheet = is_face && scene.radius(element) == 0.0;
        let next = SHEETS + keys.len() as u32;
        let paint = element.paint.as_ref();
        let finish = paint.map_or(element.finish, |paint| paint.finish);
        let object = (finish, element.body, element.frame);
        sheets.push(is_sheet.then(|| *keys.entry(object).or_insert(next)));
    }
    sheets
}
