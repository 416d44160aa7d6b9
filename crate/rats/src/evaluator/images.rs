//! The images that textures and the background of a running text use.

use super::state::Evaluator;
use crate::assets;
use crate::limits::MAX_IMAGE_PIXELS;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use texture::Rgb8;

impl<'a> Evaluator<'a> {
    /// Finds the index of an image of the project.
    ///
    /// # Errors
    /// If there is no such file, it is no picture, or all together are too large.
    pub(super) fn image(&mut self, name: &Name<'a>) -> Outcome<usize> {
        let asset = self.asset(name)?;
        if let Some(index) = self.images.position(&asset.name) {
            return Ok(index);
        }
        self.scope.step(assets::cost(asset), &name.span)?;
        let image =
            assets::image(asset).map_err(|error| Problem::new(&name.span, error.to_string()))?;
        let total: u64 = self.images.all.iter().map(|image| pixels(image)).sum();
        if total + pixels(&image) > MAX_IMAGE_PIXELS {
            return Err(Problem::new(
                &name.span,
                format!("the images have more than {MAX_IMAGE_PIXELS} pixels together"),
            )
            .hint("make them smaller"));
        }
        Ok(self.images.add(asset.name.clone(), image))
    }
}

/// Returns the number of an image's pixels.
fn pixels(image: &Rgb8) -> u64 {
    u64::from(image.size[0]) * u64::from(image.size[1])
}
