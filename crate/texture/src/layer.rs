//! Textures: a target, a method and options; and layers of them on a surface.

use crate::image::{Edge, Image, Region, sample};
use crate::noise::sane;
use crate::solid::{Grain, Solid};
use crate::surface::{Site, Surface};
use crate::wave::Wave;
use glam::{DVec2, DVec3, Vec3};
use serde::{Deserialize, Serialize};

/// The most layers on a surface.
pub const MAX_LAYERS: usize = 12;

/// The most entries of a mask.
pub const MAX_MASK: usize = 4096;

/// Numbers of a texture are at most this large.
pub const MAX_NUMBER: f64 = 1e9;

/// Parameter of shading that a texture changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Target {
    /// [`Surface::diffuse`].
    Diffuse,
    /// [`Surface::ambient`].
    Ambient,
    /// [`Surface::specular`].
    Specular,
    /// [`Surface::reflective`].
    Reflective,
    /// [`Surface::transparent`].
    Transparent,
    /// [`Surface::index`].
    Index,
    /// [`Surface::shine`].
    Shine,
    /// Diffuse and ambient.
    Pigment,
    /// [`Surface::normal`]: bumps.
    Normal,
    /// The strength of the field along a bone. That is a profile, part of the shape: it changes no
    /// surface here.
    Strength,
}

/// Mapping of an image to a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Mapping {
    /// Read by u and v; the image repeats where they leave [0, 1].
    Plain,
    /// Projected onto a part of the surface.
    Region(Region),
}

/// Source of a texture's values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Method {
    /// Pattern of space.
    Solid(Solid),
    /// Constant colour.
    Colour(DVec3),
    /// The product of a wave of u and a wave of v.
    Waves([Wave; 2]),
    /// An image, by its place in the list that [`apply`] gets.
    Image(usize, Mapping),
}

/// Layer of texture.
///
/// Its **argument** q is `scale · (p − translate)`, where p is the point for solids and (u, v) for
/// all others; of images with a region it is the place in the rectangle. Its **value** is
/// `times · (low + (high − low)·pattern(q))` per channel, with the two `bounds`: so black and white
/// of the pattern become the two colours. Colour targets take all three channels, targets of one
/// number the first; patterns in colour (images, paint) give these their luminance.
///
/// ```
/// use glam::{DVec3, Vec3};
/// use texture::{Method, Site, Solid, Surface, Target, Texture, apply};
/// let tiles = Texture {
///     scale: DVec3::splat(2.0),
///     bounds: [DVec3::new(0.2, 0.1, 0.1), DVec3::ONE],
///     ..Texture::new(Target::Diffuse, Method::Solid(Solid::Checker))
/// };
/// let site = Site { point: DVec3::new(0.75, 0.25, 0.25), normal: DVec3::Z, ..Site::default() };
/// let tiled = apply(&[tiles], Surface::default(), &site, &[]);
/// assert_eq!(tiled.diffuse, Vec3::new(0.2, 0.1, 0.1));
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Texture {
    /// Parameter of shading that the texture changes.
    pub target: Target,
    /// Source of the values.
    pub method: Method,
    /// Shifts the pattern, in units of the object (of u and v for all but solids).
    pub translate: DVec3,
    /// Factors on the argument: the larger, the finer the pattern. 0 makes it the same all along
    /// that axis.
    pub scale: DVec3,
    /// Factors on the values.
    pub times: DVec3,
    /// The values where the pattern is 0 and where it is 1.
    pub bounds: [DVec3; 2],
    /// Noise of solids.
    pub grain: Grain,
    /// Tiles that are textured (`true`) or not; empty: all are. The argument's unit squares of x
    /// and y (u and v) are numbered along x first, X to a row, Y rows, X and Y being the scale's
    /// magnitudes, rounded up; then they repeat.
    pub mask: Vec<bool>,
    /// Whether the values take the place of the target's; else they scale it. Bumps add up, but
    /// with `replace` they undo those of the layers before.
    pub replace: bool,
}

/// Error in a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Number that is not finite or larger than [`MAX_NUMBER`].
    Number,
    /// Mask with another number of entries than its columns times its rows, which are given.
    Mask(usize, usize),
    /// Mask that would have more than [`MAX_MASK`] entries.
    LargeMask,
    /// Region whose four corners are not those of a rectangle.
    Region,
    /// More than [`MAX_LAYERS`] layers.
    Layers,
}

impl core::fmt::Display for Fault {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Number => write!(
                f,
                "a number of the texture is too large: use at most {MAX_NUMBER:e}"
            ),
            Self::Mask(x, y) => write!(
                f,
                "the mask needs {x}·{y} entries, as many as the scale has tiles"
            ),
            Self::LargeMask => write!(
                f,
                "a mask has at most {MAX_MASK} entries: use a smaller scale"
            ),
            Self::Region => write!(
                f,
                "the corners of the region must be those of a rectangle, in order around it"
            ),
            Self::Layers => write!(f, "at most {MAX_LAYERS} layers of texture"),
        }
    }
}

impl core::error::Error for Fault {}

/// Adds layers upon others, as `texture t1 + t2` does.
///
/// # Errors
/// [`Fault::Layers`] if there would be more than [`MAX_LAYERS`]; then nothing is added.
pub fn stack(layers: &mut Vec<Texture>, more: &[Texture]) -> Result<(), Fault> {
    if layers.len() + more.len() > MAX_LAYERS {
        return Err(Fault::Layers);
    }
    layers.extend_from_slice(more);
    Ok(())
}

/// Height of an image's white over its black as a bump, in image widths, where `times` is 1.
const IMAGE_RELIEF: f64 = 1.0 / 32.0;

/// Step of the central differences that give the slope of solids, in units of the argument.
const STEP: f64 = 1.0 / 1024.0;

/// Bumps are no steeper than this.
const STEEPEST: f64 = 20.0;

/// The place where a texture is looked up.
struct Place {
    /// The point, or u and v.
    argument: DVec3,
    /// Directions in which the argument's x and y grow, of length 1 or 0. Not used for solids.
    directions: [DVec3; 2],
}

impl Texture {
    /// Returns a texture with the default options.
    #[must_use]
    pub fn new(target: Target, method: Method) -> Self {
        Self {
            target,
            method,
            translate: DVec3::ZERO,
            scale: DVec3::ONE,
            times: DVec3::ONE,
            bounds: [DVec3::ZERO, DVec3::ONE],
            grain: Grain::default(),
            mask: Vec::new(),
            replace: false,
        }
    }

    /// Columns and rows of a mask.
    #[must_use]
    pub fn tiles(&self) -> [usize; 2] {
        [self.scale.x, self.scale.y].map(|scale| {
            let scale = if scale.is_finite() { scale.abs() } else { 1.0 };
            // Saturates; a scale of 2.0000000001 still means two.
            ((scale - 1e-6).ceil().max(1.0)) as usize
        })
    }

    /// Whether the texture is as it should be. Evaluation of one that is not still gives finite
    /// numbers.
    ///
    /// # Errors
    /// Says what is wrong.
    pub fn check(&self) -> Result<(), Fault> {
        let vectors = [
            self.translate,
            self.scale,
            self.times,
            self.bounds[0],
            self.bounds[1],
        ];
        let grain = DVec3::new(self.grain.turbulence, self.grain.octaves, 0.0);
        if !(vectors.into_iter().all(fits) && fits(grain)) {
            return Err(Fault::Number);
        }
        match self.method {
            Method::Colour(colour) if !fits(colour) => return Err(Fault::Number),
            Method::Image(_, Mapping::Region(region)) => {
                let [a, b, c, d] = region.corners;
                if ![region.min, region.max, a, b, c, d].into_iter().all(fits) {
                    return Err(Fault::Number);
                }
                if !region.is_rectangle() {
                    return Err(Fault::Region);
                }
            }
            _ => {}
        }
        if self.mask.is_empty() {
            return Ok(());
        }
        let [x, y] = self.tiles();
        match x.checked_mul(y) {
            Some(count) if count <= MAX_MASK => {
                if count == self.mask.len() {
                    Ok(())
                } else {
                    Err(Fault::Mask(x, y))
                }
            }
            _ => Err(Fault::LargeMask),
        }
    }

    /// Returns the place at which the pattern is evaluated; `None` where the surface is not
    /// textured.
    fn place(&self, site: &Site) -> Option<Place> {
        let (raw, directions) = match self.method {
            Method::Solid(_) => (site.point, [DVec3::ZERO; 2]),
            Method::Image(_, Mapping::Region(region)) => {
                let uv = region.uv(site.point, site.normal)?;
                let [a, b, _, d] = region.corners;
                (uv.extend(0.0), [b - a, d - a])
            }
            _ => (site.uv.at.extend(0.0), site.uv.gradient),
        };
        let scale = sane(self.scale);
        let flat = !matches!(self.method, Method::Solid(_));
        if !self.mask.is_empty() {
            // The far edge of the last tile belongs to it.
            let [x, y] = [raw.x, raw.y].map(|x| if flat && x == 1.0 { 1.0 - 1e-9 } else { x });
            let at = self.argument(DVec3::new(x, y, raw.z));
            let [columns, rows] = self.tiles();
            let [row, column] = [(at.y, rows), (at.x, columns)].map(|(x, count)| {
                (x.floor() as i64).rem_euclid(i64::try_from(count).unwrap_or(1).max(1)) as usize
            });
            let index = row.saturating_mul(columns).saturating_add(column);
            if !self.mask.get(index).copied().unwrap_or(true) {
                return None;
            }
        }
        Some(Place {
            argument: self.argument(raw),
            directions: [0, 1].map(|i| {
                let sign = if scale[i] == 0.0 {
                    0.0
                } else {
                    scale[i].signum()
                };
                sign * sane(directions[i]).normalize_or_zero()
            }),
        })
    }

    /// Returns the argument of the pattern at a point or at coordinates u, v, 0.
    fn argument(&self, p: DVec3) -> DVec3 {
        sane(sane(self.scale) * (sane(p) - sane(self.translate)))
    }

    /// The pattern at an argument. `None` if there is no such image.
    fn pattern(&self, argument: DVec3, images: &[&dyn Image]) -> Option<DVec3> {
        Some(DVec3::from_array(match self.method {
            Method::Solid(solid) => solid.pattern(argument, self.grain),
            Method::Colour(colour) => sane(colour).to_array(),
            Method::Waves([u, v]) => [u.jet(argument.x).0 * v.jet(argument.y).0; 3],
            Method::Image(index, mapping) => look(images, index, mapping, argument.truncate())?,
        }))
    }

    /// The pattern as one number.
    fn grey(&self, pattern: DVec3) -> f64 {
        match self.method {
            Method::Image(..) | Method::Solid(Solid::Paint) => luminance(pattern),
            _ => pattern.x,
        }
    }

    /// Returns the texture's value per channel for a value of its pattern.
    fn stretch(&self, pattern: DVec3) -> DVec3 {
        let [low, high] = self.bounds.map(sane);
        sane(self.times) * (low + (high - low) * pattern)
    }

    /// The texture's values at a place. `None` where it textures nothing: a tile that is masked
    /// out, outside its region, or without its image.
    #[must_use]
    pub fn value(&self, site: &Site, images: &[&dyn Image]) -> Option<DVec3> {
        let place = self.place(site)?;
        Some(self.stretch(self.pattern(place.argument, images)?))
    }

    /// The value as one number, of the first channel.
    fn number(&self, site: &Site, images: &[&dyn Image]) -> Option<f64> {
        let place = self.place(site)?;
        let grey = self.grey(self.pattern(place.argument, images)?);
        Some(self.stretch(DVec3::splat(grey)).x)
    }

    /// Slope of the texture as a bump: the gradient of its height along the surface, in texture
    /// space.
    ///
    /// A texture that is scaled down has smaller bumps, not steeper ones: heights are in units of
    /// the argument, of which `times` and `bounds` make more or less. For solids they are
    /// [`Solid::relief`], whose slope is measured by central differences over ±1/1024 of the
    /// argument; for waves the waves themselves, by their derivatives; white of an image stands out
    /// by 1/32 of the image's width.
    #[must_use]
    pub fn slope(&self, site: &Site, images: &[&dyn Image]) -> Option<DVec3> {
        let place = self.place(site)?;
        let rise = sane(self.times).x * (sane(self.bounds[1]).x - sane(self.bounds[0]).x);
        let q = place.argument;
        let [right, up] = place.directions;
        let slope = match self.method {
            Method::Colour(_) => DVec3::ZERO,
            Method::Waves([u, v]) => {
                let (u, v) = (u.jet(q.x), v.jet(q.y));
                u.1 * v.0 * right + u.0 * v.1 * up
            }
            Method::Solid(solid) => self.solid_slope(solid, q, site.normal),
            Method::Image(index, mapping) => {
                let size = images.get(index)?.size();
                let step = DVec2::new(f64::from(size[0]), f64::from(size[1]))
                    .max(DVec2::ONE)
                    .recip();
                let (x, y) = (DVec2::new(step.x, 0.0), DVec2::new(0.0, step.y));
                let [x, before_x, y, before_y] = [x, -x, y, -y].map(|by| {
                    look(images, index, mapping, q.truncate() + by)
                        .map(|c| luminance(DVec3::from_array(c)))
                });
                let (x, y) = (x? - before_x?, y? - before_y?);
                IMAGE_RELIEF * (x / (2.0 * step.x) * right + y / (2.0 * step.y) * up)
            }
        };
        let normal = site.normal;
        let slope = rise * slope;
        let slope = slope - normal * slope.dot(normal);
        slope.is_finite().then(|| slope.clamp_length_max(STEEPEST))
    }

    /// Slope of a solid's relief in the plane across a normal.
    fn solid_slope(&self, solid: Solid, q: DVec3, normal: DVec3) -> DVec3 {
        let scale = sane(self.scale);
        let largest = scale.abs().max_element();
        if largest == 0.0 || !normal.is_finite() {
            return DVec3::ZERO;
        }
        crate::disc::frame(normal)
            .into_iter()
            .map(|d| {
                let step = scale / largest * d * STEP;
                let rise = solid.relief(q + step, self.grain) - solid.relief(q - step, self.grain);
                rise / (2.0 * STEP) * d
            })
            .sum()
    }
}

/// Whether no component is larger than [`MAX_NUMBER`], or NaN.
fn fits(v: DVec3) -> bool {
    v.abs().cmple(DVec3::splat(MAX_NUMBER)).all()
}

fn luminance(colour: DVec3) -> f64 {
    colour.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

/// Returns the colour at (u, v) of an image of the list; `None` if there is no such image.
fn look(images: &[&dyn Image], index: usize, mapping: Mapping, uv: DVec2) -> Option<[f64; 3]> {
    let edge = match mapping {
        Mapping::Plain => Edge::Wrap,
        Mapping::Region(_) => Edge::Hold,
    };
    sample(*images.get(index)?, uv, edge)
}

/// Returns the colour times values, or the values themselves; never negative, and finite if the
/// colour is.
fn tint(colour: Vec3, values: DVec3, replace: bool) -> Vec3 {
    let old = colour.as_dvec3();
    let new = if replace { values } else { old * values };
    let new = new.as_vec3().max(Vec3::ZERO);
    if new.is_finite() { new } else { colour }
}

fn sum(colour: Vec3) -> f64 {
    f64::from(colour.x) + f64::from(colour.y) + f64::from(colour.z)
}

/// Puts layers of texture on a surface, the first one at the bottom. Where a layer textures
/// nothing (see [`Texture::value`]) the surface stays as it is.
///
/// `pigment` that replaces gives the values to diffuse, and to ambient in the ratio of the sums of
/// the two before; where diffuse was black, ambient stays. An index that would be 0 or less stays
/// as it was.
#[must_use]
pub fn apply(layers: &[Texture], surface: Surface, site: &Site, images: &[&dyn Image]) -> Surface {
    layers.iter().fold(surface, |surface, layer| {
        apply_one(layer, surface, site, images).unwrap_or(surface)
    })
}

fn apply_one(
    layer: &Texture,
    mut surface: Surface,
    site: &Site,
    images: &[&dyn Image],
) -> Option<Surface> {
    let replace = layer.replace;
    let values = || layer.value(site, images);
    let number = |old: f32| {
        let value = layer.number(site, images)?;
        let new = if replace {
            value
        } else {
            f64::from(old) * value
        } as f32;
        Some(if new.is_finite() { new } else { old })
    };
    match layer.target {
        Target::Diffuse => surface.diffuse = tint(surface.diffuse, values()?, replace),
        Target::Ambient => surface.ambient = tint(surface.ambient, values()?, replace),
        Target::Specular => surface.specular = tint(surface.specular, values()?, replace),
        Target::Reflective => surface.reflective = tint(surface.reflective, values()?, replace),
        Target::Transparent => surface.transparent = tint(surface.transparent, values()?, replace),
        Target::Pigment => {
            let values = values()?;
            let (diffuse, ambient) = (sum(surface.diffuse), sum(surface.ambient));
            surface.diffuse = tint(surface.diffuse, values, replace);
            if !replace {
                surface.ambient = tint(surface.ambient, values, false);
            } else if diffuse > 0.0 {
                surface.ambient = tint(surface.ambient, values * (ambient / diffuse), true);
            }
        }
        Target::Index => {
            let new = number(surface.index)?;
            if new > 0.0 {
                surface.index = new;
            }
        }
        Target::Shine => surface.shine = number(surface.shine)?.max(0.0),
        Target::Normal => {
            let slope = layer.slope(site, images)?;
            let from = if replace { site.normal } else { surface.normal };
            surface.normal = (from - slope).normalize_or(surface.normal);
        }
        Target::Strength => {}
    }
    Some(surface)
}
