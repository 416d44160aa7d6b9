//! Keys of the whole page.

use crate::page::Page;
use crate::panels::Panels;
use crate::stage::pencil::tool::Tool;
use crate::text::editor::find::Seek;
use crate::wish::{LabWish, TextWish, ViewWish, Wish, Wishes};
use egui::{Context, Key, KeyboardShortcut, Modifiers};

/// Lists the wishes of keys that are pressed.
pub fn listen(page: &Page, panels: &Panels, ctx: &Context, wishes: &mut Wishes) {
    let pressed = |modifiers: Modifiers, key: Key| {
        ctx.input_mut(|input| input.consume_shortcut(&KeyboardShortcut::new(modifiers, key)))
    };
    if panels.sculpt.is_open() && page.dialog.is_none() {
        // Sculpting has keys of its own.
        return;
    }
    if page.is_lab_open {
        // The text is out of sight, so no key may change it.
        if pressed(Modifiers::NONE, Key::Escape) {
            wishes.push(LabWish::Close);
        }
        return;
    }
    // The longer combination first: the shorter one matches it too.
    if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y)
    {
        wishes.push(TextWish::Redo);
    } else if pressed(Modifiers::COMMAND, Key::Z) {
        wishes.push(TextWish::Undo);
    }
    if pressed(Modifiers::COMMAND, Key::S) {
        wishes.push(ViewWish::Save);
    }
    // With Shift, F lays the text out.
    if page.dialog.is_none() && !ctx.input(|input| input.modifiers.shift) {
        for (key, seek) in [
            (Key::F, Seek::Text),
            (Key::H, Seek::Replace),
            (Key::G, Seek::Line),
        ] {
            if pressed(Modifiers::COMMAND, key) {
                wishes.push(TextWish::Find(seek));
            }
        }
    }
    if page.dialog.is_some() && pressed(Modifiers::NONE, Key::Escape) {
        wishes.push(Wish::Close);
    }
    let types = ctx.egui_wants_keyboard_input();
    if page.dialog.is_none() && !types && pressed(Modifiers::NONE, Key::D) {
        let tool = match panels.stage.pencil.tool() {
            None => Some(Tool::Draw),
            Some(_) => None,
        };
        wishes.push(ViewWish::SetTool(tool));
    }
}
