//! Options that hold for the whole picture.

use field::BlobScale;
use serde::{Deserialize, Serialize};

/// The settings of one picture, with the language's defaults.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Width and height of the picture in pixels (`framesize`), each 1 … [`Settings::MAX_FRAME`].
    pub frame: [u32; 2],
    /// `sample n`: at most n×n rays a pixel where the picture has contrast. 1 …
    /// [`Settings::MAX_SAMPLES`].
    pub samples: u32,
    /// Side, in pixels, of the blocks that one ray is sent for: a power of 2 up to
    /// [`Settings::MAX_BLOCK`], more than 1 by `sample` below 1. Then no pixel gets more rays.
    pub block: u32,
    /// Per-channel contrast between neighbouring pixels above which a pixel is sampled further.
    pub contrast: [f32; 3],
    /// `gamma g`: the picture's values are raised to 1/g.
    pub gamma: f32,
    /// `soft on`: soft elements blend; off: their offset surfaces are drawn.
    pub soft: bool,
    /// `double on`: faces are seen from both sides; off: those seen from behind are hidden.
    pub double_sided: bool,
    /// Meaning of a blobbiness.
    pub blob_scale: BlobScale,
    /// Soft primitives that take their material's radius instead of their own.
    pub fragile: Fragile,
    /// Depth of influence: a soft element is ignored where its field is below this share of the
    /// threshold. In (0, 1).
    pub influence: f64,
    /// Root finder for the soft surface.
    pub digger: Digger,
    /// `maxdepth n`: how many surfaces may mirror or refract a ray, one after the other. 0 …
    /// [`Settings::MAX_DEPTH`].
    pub max_depth: u32,
    /// `vanish v`: reflected and refracted rays that add less than this share of their light to
    /// each channel of the pixel are not sent. ≥ 0.
    pub vanish: f32,
    /// `epsilon e`: precision of hits with hard surfaces, > 0. Rays from there to lights, reflected
    /// and refracted ones start a hundredth of it above the surface, in halves of the scene's size.
    /// (Convolution surfaces know their own error, and the rays from them start as near as it
    /// allows.)
    pub epsilon: f64,
    /// `penumbra on`: lights with a size have soft shadows.
    pub penumbra: bool,
    /// `tone NAME`: how bright light becomes colours of the screen.
    pub tone: Tone,
    /// `map on g`: instead of colours the picture shows what its pixels cost, raised to 1/g.
    pub map: Option<f32>,
}

impl Settings {
    /// Largest picture side.
    pub const MAX_FRAME: u32 = 8192;
    /// Largest sampling grid side.
    pub const MAX_SAMPLES: u32 = 16;
    /// Largest side of a block of pixels with one ray.
    pub const MAX_BLOCK: u32 = 16;
    /// Largest depth of reflections and refractions.
    pub const MAX_DEPTH: u32 = 32;
    /// Most Hermite spans a primitive ([`Digger::Spans`]).
    pub const MAX_SPANS: u32 = 64;
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            frame: [128, 128],
            samples: 1,
            block: 1,
            contrast: [0.25, 0.2, 0.4],
            gamma: 1.0,
            soft: true,
            double_sided: true,
            blob_scale: BlobScale::Relative,
            fragile: Fragile::default(),
            influence: 1e-3,
            digger: Digger::Hermite,
            max_depth: 5,
            vanish: 4e-3,
            epsilon: 1e-4,
            penumbra: false,
            tone: Tone::None,
            map: None,
        }
    }
}

/// Map from light without limit to a channel of 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Tone {
    /// Light above 1 is cut.
    #[default]
    None,
    /// Shoulder like film's ([`texture::tone::filmic`]).
    Filmic,
}

/// `digger NAME`: the ways of finding where a ray meets the soft surface. All but the first are
/// there for comparison, and have their settings fixed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Digger {
    /// Hermite spans placed by a certified bound of their error.
    #[default]
    Hermite,
    /// `hermite2 n`: n equally long Hermite spans a primitive over its interval of the ray, 2 in
    /// the thesis; 1 … [`Settings::MAX_SPANS`].
    Spans(u32),
    /// Polynomials through samples.
    Lagrange,
    /// Marching to a change of sign, then Brent's method.
    Brent,
    /// Marching to a change of sign, then Ridders' method.
    Ridder,
    /// Marching to a change of sign, then the regula falsi.
    RegulaFalsi,
    /// Halving until Lipschitz constants of the field and its slope rule roots out or isolate them
    /// (Kalra and Barr).
    Lg,
    /// Steps as long as a Lipschitz constant allows (Hart).
    Sphere,
}

/// `fragile all|arc|pipe|cylinder|sphere|none`: the soft primitives whose own radius is overruled
/// by their material's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fragile {
    /// Arcs and arches.
    pub arc: bool,
    /// Pipes.
    pub pipe: bool,
    /// Cylinders.
    pub cylinder: bool,
    /// Spheres.
    pub sphere: bool,
}

impl Fragile {
    /// `fragile all`.
    pub const ALL: Self = Self {
        arc: true,
        pipe: true,
        cylinder: true,
        sphere: true,
    };
}
