//! The help: enough of the language to change an example, the keys, and on its second page the
//! reference.

mod reference;

use crate::first;
use crate::page::Page;
use crate::panel::Panel;
use crate::wish::{Setting, Wish, Wishes};
use crate::{places, screen, theme};
use egui::{RichText, ScrollArea, Ui};
use reference::Reference;

const LANGUAGE: [(&str, &str); 10] = [
    (
        "surface flesh, diffuse Coral, specular White, shine 40, blobbiness -2",
        "a material; blobbiness makes its shapes soft",
    ),
    ("sphere flesh 0.5, 0 0 0", "a ball: radius, centre"),
    (
        "cylinder flesh 0.3, 0 0 0, 2 0 0",
        "a bar: radius, both ends",
    ),
    (
        "arc flesh 1 0.2, 0 0 0, 0 0 1, 0 180",
        "a bent bar: radius of the bend and of the bar, centre, normal, from angle, by angle",
    ),
    ("light White point, position 4 6 8", "a light"),
    (
        "eyep 0 0 8",
        "where you look from; vrp: what you look at; fov: how wide",
    ),
    (
        "var r = 0.3 hot",
        "a number with a name; hot makes it a slider",
    ),
    (
        "preset thin, set r 0.1",
        "a button that sets sliders: each name, and its value",
    ),
    (
        "for i = 1 to 10 { sphere flesh 0.2, i/4 0 0 }",
        "repeats; numbers can be computed: 2*r, sin(i), rand(i)",
    ),
    ("# words", "a comment"),
];

const KEYS: [(&str, &str); 16] = [
    ("drag", "turn the model"),
    ("shift-drag, right-drag, two fingers", "move it"),
    ("wheel, pinch", "zoom"),
    (
        "click a shape",
        "find it in the text; its knobs move its numbers",
    ),
    (
        "Shift-drag a knob, Page Up and Page Down",
        "move it away from you and back",
    ),
    ("Ctrl+Z, Ctrl+Shift+Z", "undo, redo"),
    ("Ctrl+/", "turn lines into comments and back"),
    ("Tab, Shift+Tab", "indent"),
    ("Ctrl+Space", "what can be written here"),
    ("F1", "the manual of the command at the caret"),
    ("F12, Ctrl+click", "go to where a name is defined"),
    ("F2", "rename it everywhere"),
    ("F8", "fold the block at the caret, or unfold it"),
    ("Ctrl+F, Ctrl+H, Ctrl+G", "find, replace, go to a line"),
    ("Ctrl+Shift+F", "lay the text out neatly"),
    ("Ctrl+S", "save the picture as PNG"),
];

/// A page of the help.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Leaf {
    /// An introduction.
    #[default]
    Words,
    /// The reference of all commands.
    Reference,
}

/// The state of the help.
#[derive(Default)]
pub struct Help {
    leaf: Leaf,
    reference: Reference,
}

impl Help {
    /// Turns to the first page.
    pub fn turn_to_words(&mut self) {
        self.leaf = Leaf::Words;
    }

    /// Turns to a command of the reference; without a name to all of them.
    pub fn turn_to(&mut self, name: &str) {
        self.leaf = Leaf::Reference;
        self.reference.open(name);
    }

    fn head(&mut self, ui: &mut Ui, wishes: &mut Wishes) {
        let palette = theme::palette(ui.visuals());
        ui.horizontal(|ui| {
            // The narrowest phones need the room for the button.
            let is_short = ui.available_width() < 300.0;
            let size = if is_short { 12.5 } else { 17.0 };
            if is_short {
                ui.spacing_mut().item_spacing.x = 2.0;
            }
            for (leaf, title) in [
                (Leaf::Words, "How it works"),
                (Leaf::Reference, "Reference"),
            ] {
                let open = self.leaf == leaf;
                let colour = if open { palette.strong } else { palette.weak };
                let title = RichText::new(title).size(size).color(colour);
                let tab = ui.selectable_label(open, title);
                places::note(ui.ctx(), format!("help {leaf:?}").to_lowercase(), tab.rect);
                if tab.clicked() {
                    self.leaf = leaf;
                }
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Close").clicked() {
                    wishes.push(Wish::Close);
                }
            });
        });
    }
}

impl Panel for Help {
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        self.head(ui, wishes);
        ui.add_space(6.0);
        ScrollArea::vertical()
            .id_salt(self.leaf == Leaf::Words)
            .auto_shrink([false, true])
            .show(ui, |ui| match self.leaf {
                Leaf::Words => words(ui, page.settings.hints, wishes),
                Leaf::Reference => self.reference.show(ui, wishes),
            });
    }
}

fn words(ui: &mut Ui, mut hints: bool, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    first::offer(ui, wishes);
    ui.label(
        "A model is a text: a list of shapes made of materials. Soft shapes melt into each \
            other where they come near. Change a number and the picture follows; the link \
            behind Share carries everything.",
    );
    heading(ui, "Words");
    for (code, meaning) in LANGUAGE {
        ui.label(
            RichText::new(code)
                .monospace()
                .size(12.5)
                .color(palette.command),
        );
        ui.label(RichText::new(meaning).color(palette.weak).size(13.0));
        ui.add_space(5.0);
    }
    heading(ui, "Hands");
    keys(ui, "keys", &KEYS);
    heading(ui, "Sculpt");
    keys(ui, "sculpt keys", &modeling::KEYS);
    ui.add_space(6.0);
    if ui
        .checkbox(
            &mut hints,
            "While typing, show how the command at the caret is written",
        )
        .changed()
    {
        wishes.push(Setting::Hints(hints));
    }
    heading(ui, "Yours");
    ui.label(
        "What you write stays in this browser, under My work in the gallery. A link that \
            someone sends you never overwrites it. Texts, images and meshes can be dropped on \
            the page; links carry the texts.",
    );
}

/// Lists keys with their meanings, side by side where there is room.
fn keys(ui: &mut Ui, name: &str, rows: &[(&str, &str)]) {
    let palette = theme::palette(ui.visuals());
    let texts = rows.iter().map(|(key, meaning)| {
        let [key, meaning] = [(*key, palette.text), (*meaning, palette.weak)]
            .map(|(text, colour)| RichText::new(text).color(colour).size(13.0));
        (key, meaning)
    });
    if screen::is_narrow(ui.ctx()) {
        for (key, meaning) in texts {
            ui.label(key);
            ui.label(meaning);
            ui.add_space(5.0);
        }
        return;
    }
    egui::Grid::new(name).spacing([18.0, 5.0]).show(ui, |ui| {
        for (key, meaning) in texts {
            ui.label(key);
            ui.label(meaning);
            ui.end_row();
        }
    });
}

fn heading(ui: &mut Ui, text: &str) {
    let palette = theme::palette(ui.visuals());
    ui.add_space(12.0);
    ui.label(RichText::new(text).color(palette.strong).size(15.0));
    ui.add_space(2.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_shows_the_language() {
        let text: Vec<&str> = LANGUAGE.iter().map(|(code, _)| *code).collect();
        let file = rats::File {
            name: String::from("help.rat"),
            text: text.join("\n"),
        };
        let compiled = rats::compile(&rats::Project { files: vec![file] });
        assert_eq!(compiled.diagnostics, []);
        assert_eq!(compiled.scene.elements.len(), 13);
    }
}
