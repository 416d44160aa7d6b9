//! The images that a text uses.

use std::sync::Arc;
use texture::Rgb8;

/// Images in the order in which the text names them first, each with its name in the project.
#[derive(Debug, Default)]
pub struct Images {
    /// The images.
    pub all: Vec<Arc<Rgb8>>,
    names: Vec<String>,
}

impl Images {
    /// Finds the index of the image of a name.
    pub fn position(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// Adds an image and returns its index.
    pub fn add(&mut self, name: String, image: Arc<Rgb8>) -> usize {
        self.names.push(name);
        self.all.push(image);
        self.all.len() - 1
    }
}
