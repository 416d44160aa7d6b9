//! An image or a mesh of the work, shown in the place of the text.

use crate::tray::item;
use crate::wish::{TextWish, Wishes};
use crate::{places, theme};
use ::picture::{Format, Picture, file};
use document::asset::{self, Asset, Kind};
use egui::{RichText, ScrollArea, TextureHandle, Ui};
use std::path::Path;
use std::sync::Arc;

/// Longest side of the image shown, pixels.
const PREVIEW: u32 = 512;

/// The image on show, decoded once.
#[derive(Default)]
pub struct AssetView {
    image: Option<(Arc<[u8]>, Option<TextureHandle>)>,
}

impl AssetView {
    /// Shows an image or a mesh in all the space of `ui`. Returns whether the user goes back to the
    /// text.
    pub fn show(&mut self, ui: &mut Ui, asset: &Asset, wishes: &mut Wishes) -> bool {
        let palette = theme::palette(ui.visuals());
        ui.painter().rect_filled(ui.max_rect(), 0.0, palette.paper);
        places::note(ui.ctx(), "asset", ui.max_rect());
        let mut back = false;
        egui::Frame::new().inner_margin(16).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.label(RichText::new(&asset.name).heading().color(palette.strong));
                let facts = asset::facts(asset).unwrap_or_else(|reason| reason);
                let size = asset::size(asset.bytes.len());
                ui.label(RichText::new(format!("{facts}, {size}")).color(palette.text));
                ui.label(
                    RichText::new(
                        "It belongs to this work and stays in this browser. \
                            Links carry texts only.",
                    )
                    .color(palette.weak)
                    .size(12.5),
                );
                ui.add_space(6.0);
                ui.horizontal(|ui| {
                    back = ui.button("Back to the text").clicked();
                    if ui.button("Remove").clicked() {
                        wishes.push(TextWish::RemoveAsset(asset.name.clone()));
                    }
                });
                ui.add_space(10.0);
                if asset::kind(&asset.name) == Some(Kind::Image) {
                    self.image(ui, asset);
                }
            });
        });
        back
    }

    fn image(&mut self, ui: &mut Ui, asset: &Asset) {
        let known = self.image.as_ref();
        if known.is_none_or(|(bytes, _)| !Arc::ptr_eq(bytes, &asset.bytes)) {
            // The header is checked again, as an old record may hold anything.
            let image = asset::facts(asset)
                .ok()
                .and_then(|_| decode(asset))
                .map(|picture| item::texture(ui.ctx(), &picture, PREVIEW));
            self.image = Some((asset.bytes.clone(), image));
        }
        match &self.image {
            Some((_, Some(texture))) => {
                let size = texture.size_vec2();
                let scale = (ui.available_width() / size.x).min(1.0);
                let image = egui::Image::from_texture(texture)
                    .fit_to_exact_size(size * scale)
                    .corner_radius(4)
                    .alt_text(&asset.name);
                let shown = ui.add(image);
                places::note(ui.ctx(), "asset image", shown.rect);
            }
            _ => {
                ui.weak("This image is damaged: it cannot be shown.");
            }
        }
    }
}

fn decode(asset: &Asset) -> Option<Picture> {
    let format = Format::of(Path::new(&asset.name)).ok()?;
    let most = u64::from(asset::MAX_SIDE).pow(2);
    file::decode_at_most(&asset.bytes, format, most).ok()
}
