//! The materials and textures that a running text has made.
//!
//! A material that is made anew under an old name is a new one: shapes made before keep the old. So
//! a dataset can vary one material along a row of shapes. Between two pictures it changes the
//! shapes that the first one shows, as a model lives on behind a `shoot`.

use crate::limits::{MAX_LAYERS, MAX_MATERIALS};
use crate::operands::Share;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::suggest;
use field::Profile;
use scene::{Finish, Flesh, Rgb};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// Material and all that the language must remember of it.
#[derive(Clone, Debug)]
pub struct Surface {
    /// The colours.
    pub finish: Finish,
    /// The softness.
    pub flesh: Flesh,
    /// Whether its strength was given.
    pub has_strength: bool,
    /// The texture that says the strength of pieces of its bones, if any.
    pub pattern: Option<texture::Texture>,
    /// Whether its flesh stands at its radius, however short its bones are.
    pub exact: bool,
    /// The colours it was made with, which a copy goes on from.
    pub colours: Colours,
    /// The file and place of its name.
    pub origin: (usize, Range<usize>),
    /// Whether a shape is made of it, since the last `shoot` if there is one.
    pub used: bool,
    /// Whether a `shoot` has shown shapes of it, and it has not been made again since.
    pub shown: bool,
    /// Whether another material began as its copy.
    pub copied: bool,
}

impl Surface {
    /// Returns whether no shape is made of it.
    fn is_idle(&self) -> bool {
        !self.used && !self.shown
    }

    /// Returns whether its shapes, all of which earlier pictures show, can become those of another
    /// material: what is soft, hard or tapers stays so.
    fn changes_to(&self, other: &Self) -> bool {
        let [own, new] = [&self.flesh, &other.flesh].map(|flesh| {
            let tapers = flesh.end_radius.is_some() || flesh.end_blobbiness.is_some();
            (flesh.is_soft(), tapers)
        });
        self.shown && !self.used && own == new
    }
}

/// The colours of a material as the text gives them; shares refer to others.
#[derive(Clone, Debug, Default)]
pub struct Colours {
    /// `body`
    pub body: Option<Rgb>,
    /// `ambient`
    pub ambient: Option<Share>,
    /// `diffuse`
    pub diffuse: Option<Share>,
}

/// Layers of texture, and the profile of those whose target is the strength.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Texture {
    /// The layers that surfaces show, the first one at the bottom.
    pub layers: Vec<texture::Texture>,
    /// The profile of the strength, if any.
    pub profile: Option<Profile>,
    /// The solid or image that says the strength, if any.
    pub pattern: Option<texture::Texture>,
}

/// The materials and textures.
#[derive(Debug, Default)]
pub struct Palette<'a> {
    /// The materials ever made that are or may be used.
    pub surfaces: Vec<Surface>,
    by_name: HashMap<&'a str, usize>,
    textures: HashMap<&'a str, Texture>,
    broken: HashSet<&'a str>,
}

impl<'a> Palette<'a> {
    /// Adds a material under its name.
    ///
    /// # Errors
    /// If there are too many.
    pub fn insert(&mut self, name: &Name<'a>, surface: Surface) -> Outcome<()> {
        match self.by_name.get(name.text) {
            Some(&index) if self.surfaces[index].is_idle() => self.surfaces[index] = surface,
            Some(&index) if self.surfaces[index].changes_to(&surface) => {
                self.surfaces[index] = Surface {
                    used: true,
                    ..surface
                };
            }
            _ => {
                self.refuse_more(name)?;
                self.by_name.insert(name.text, self.surfaces.len());
                self.surfaces.push(surface);
            }
        }
        Ok(())
    }

    /// Returns whether shapes of an earlier picture keep the material of this name when `surface`
    /// takes its name, as they cannot become soft, hard or of varying width.
    #[must_use]
    pub fn keeps_old(&self, name: &Name<'a>, surface: &Surface) -> bool {
        let old = self
            .by_name
            .get(name.text)
            .map(|&index| &self.surfaces[index]);
        old.is_some_and(|old| old.shown && !old.used && !old.changes_to(surface))
    }

    /// Remembers that a picture shows all shapes made so far.
    pub fn mark_shown(&mut self) {
        for surface in &mut self.surfaces {
            surface.shown |= std::mem::take(&mut surface.used);
        }
    }

    /// Adds a copy of a material, without a name, whose colours are multiplied by another.
    ///
    /// # Errors
    /// If there are too many.
    pub fn add_tint(&mut self, name: &Name<'_>, material: usize, tint: Rgb) -> Outcome<usize> {
        self.refuse_more(name)?;
        let mut surface = self.surfaces[material].clone();
        let finish = &mut surface.finish;
        for (k, tint) in tint.into_iter().enumerate() {
            finish.ambient[k] *= tint;
            finish.diffuse[k] *= tint;
        }
        self.surfaces[material].used = true;
        self.surfaces.push(surface);
        Ok(self.surfaces.len() - 1)
    }

    /// Adds a copy of a material, without a name, with a blobbiness.
    ///
    /// # Errors
    /// If there are too many.
    pub fn add_soft(
        &mut self,
        name: &Name<'_>,
        material: usize,
        blobbiness: f64,
    ) -> Outcome<usize> {
        self.refuse_more(name)?;
        let mut surface = self.surfaces[material].clone();
        surface.flesh.blobbiness = Some(blobbiness);
        self.surfaces[material].used = true;
        self.surfaces.push(surface);
        Ok(self.surfaces.len() - 1)
    }

    /// Returns an error at a name if there are as many materials as there can be.
    fn refuse_more(&self, name: &Name<'_>) -> Outcome<()> {
        if self.surfaces.len() < MAX_MATERIALS {
            return Ok(());
        }
        Err(Problem::new(
            &name.span,
            format!("there are more than {MAX_MATERIALS} materials"),
        ))
    }

    /// Returns the place where a material of this name was made, if nothing was made of it.
    #[must_use]
    pub fn idle_place(&self, name: &str) -> Option<&(usize, Range<usize>)> {
        let surface = &self.surfaces[*self.by_name.get(name)?];
        (surface.is_idle() && !surface.copied).then_some(&surface.origin)
    }

    /// Remembers that a material or texture should have been made here but was not.
    pub fn insert_broken(&mut self, name: &'a str) {
        self.broken.insert(name);
    }

    /// Returns whether there is a material of this name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.by_name.contains_key(name)
    }

    /// Finds the index of a material.
    ///
    /// # Errors
    /// If there is none of this name.
    pub fn find(&self, name: &Name<'_>) -> Outcome<usize> {
        self.by_name.get(name.text).copied().ok_or_else(|| {
            if self.broken.contains(name.text) {
                return Problem::follow_up(&name.span);
            }
            let suggestion = suggest::hint(name.text, self.by_name.keys().copied());
            Problem::new(
                &name.span,
                format!("there is no material `{}` yet", name.text),
            )
            .hint(
                suggestion.unwrap_or_else(|| {
                    format!("make it before it is used: `surface {} …`", name.text)
                }),
            )
        })
    }

    /// Adds a texture under its name.
    ///
    /// # Errors
    /// If there are too many.
    pub fn insert_texture(&mut self, name: &Name<'a>, texture: Texture) -> Outcome<()> {
        if self.textures.len() >= MAX_MATERIALS && !self.textures.contains_key(name.text) {
            return Err(Problem::new(
                &name.span,
                format!("there are more than {MAX_MATERIALS} textures"),
            ));
        }
        self.textures.insert(name.text, texture);
        Ok(())
    }

    /// Finds a texture.
    ///
    /// # Errors
    /// If there is none of this name.
    pub fn texture(&self, name: &Name<'_>) -> Outcome<&Texture> {
        self.textures.get(name.text).ok_or_else(|| {
            if self.broken.contains(name.text) {
                return Problem::follow_up(&name.span);
            }
            let suggestion = suggest::hint(name.text, self.textures.keys().copied());
            Problem::new(
                &name.span,
                format!("there is no texture `{}` yet", name.text),
            )
            .hint(
                suggestion.unwrap_or_else(|| {
                    format!("make it before it is used: `texture {} …`", name.text)
                }),
            )
        })
    }

    /// Puts the layers of all `names` upon each other; the first profile counts.
    ///
    /// # Errors
    /// If one does not exist, or there are more than [`MAX_LAYERS`].
    pub fn layers(&self, names: &[Name<'_>]) -> Outcome<Texture> {
        let mut together = Texture::default();
        self.stack(&mut together, names)?;
        Ok(together)
    }

    /// Puts the layers of all `names` upon a texture; its own profile counts, else the first of
    /// theirs.
    ///
    /// # Errors
    /// Fails as [`Self::layers`] does.
    pub fn stack(&self, together: &mut Texture, names: &[Name<'_>]) -> Outcome<()> {
        for name in names {
            let texture = self.texture(name)?;
            let fits = texture::stack(&mut together.layers, &texture.layers);
            together.profile = together.profile.or(texture.profile);
            together.pattern = together.pattern.take().or_else(|| texture.pattern.clone());
            let count = together.layers.len()
                + usize::from(together.profile.is_some())
                + usize::from(together.pattern.is_some());
            if fits.is_err() || count > MAX_LAYERS {
                return Err(Problem::new(
                    &name.span,
                    format!("there are more than {MAX_LAYERS} layers of textures"),
                ));
            }
        }
        Ok(())
    }

    /// Forgets the names of all materials; shapes keep theirs.
    pub fn forget_surfaces(&mut self) {
        for index in self.by_name.values() {
            self.surfaces[*index].used = true;
        }
        self.by_name.clear();
    }

    /// Returns the materials that have a name.
    pub fn with_names(&self) -> impl Iterator<Item = &Surface> {
        self.by_name.values().map(|index| &self.surfaces[*index])
    }

    /// Returns the number of textures.
    #[must_use]
    pub fn textures(&self) -> usize {
        self.textures.len()
    }

    /// Forgets all textures; materials keep their profiles.
    pub fn forget_textures(&mut self) {
        self.textures.clear();
    }

    /// Returns the materials that no shape is made of.
    pub fn idle_surfaces(&self) -> impl Iterator<Item = &Surface> {
        self.by_name
            .values()
            .map(|index| &self.surfaces[*index])
            .filter(|surface| surface.is_idle())
    }
}
