//! Small pictures that are files beside the page, fetched when they are first shown.

use document::examples;
use egui::{ColorImage, TextureHandle, TextureOptions, Ui, Vec2};
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

/// A picture on its way.
pub(crate) enum Thumbnail {
    /// The file was asked for.
    Coming(Rc<RefCell<Option<Vec<u8>>>>),
    /// The picture is here.
    Here(TextureHandle),
    /// The file came, but is no picture.
    Broken,
}

impl Thumbnail {
    /// Asks for a file beside the page.
    pub fn fetch(ui: &Ui, path: &'static str) -> Self {
        let inbox = Rc::new(RefCell::new(None));
        let (letter, ctx) = (inbox.clone(), ui.ctx().clone());
        // A file that does not come leaves its place empty.
        browser::fetch(path, move |bytes| {
            *letter.borrow_mut() = bytes;
            ctx.request_repaint();
        });
        Self::Coming(inbox)
    }

    /// Makes a texture of the file when it is here.
    pub fn arrive(&mut self, ui: &Ui) {
        let Self::Coming(inbox) = self else { return };
        let Some(bytes) = inbox.borrow_mut().take() else {
            return;
        };
        *self = Self::show(ui, &bytes).unwrap_or(Self::Broken);
    }

    fn show(ui: &Ui, bytes: &[u8]) -> Option<Self> {
        let image = examples::decode(bytes)?;
        let size = image.size.map(|side| side as usize);
        let pixels = ColorImage::from_rgba_unmultiplied(size, &image.rgba);
        let texture = ui.load_texture("thumbnail", pixels, TextureOptions::LINEAR);
        Some(Self::Here(texture))
    }
}

/// Pictures by their addresses.
#[derive(Default)]
pub(crate) struct Thumbnails(HashMap<&'static str, Thumbnail>);

impl Thumbnails {
    /// Shows a picture at this size, or an empty place until it is here.
    pub fn show(&mut self, ui: &mut Ui, path: &'static str, size: Vec2) {
        let picture = self
            .0
            .entry(path)
            .or_insert_with(|| Thumbnail::fetch(ui, path));
        picture.arrive(ui);
        match picture {
            Thumbnail::Here(texture) => {
                let image = egui::Image::new(&*texture).fit_to_exact_size(size);
                ui.add(image.corner_radius(crate::theme::ROUND));
            }
            _ => {
                ui.allocate_space(size);
            }
        }
    }
}
