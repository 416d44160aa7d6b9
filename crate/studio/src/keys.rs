//! Keys of the whole page.

use crate::page::Page;
use crate::panels::Panels;
use crate::stage::pencil::tool::Tool;
use crate::text::editor::find::Seek;
use crate::wish::{LabWish, TextWish, ViewWish, Wish, Wishes};
use egui::{Context, Key, Modifiers};
use widgets::keys::take_key;

/// Lists the wishes of keys that are pressed.
pub fn listen(page: &Page, panels: &Panels, ctx: &Context, wishes: &mut Wishes) {
    if panels.sculpt.is_open() && page.dialog.is_none() {
        // Sculpting has keys of its own.
        return;
    }
    if page.is_lab_open {
        // The text is out of sight, so no key may change it.
        if take_key(ctx, Modifiers::NONE, Key::Escape) {
            wishes.push(LabWish::Close);
        }
        return;
    }
    // The longer combination first: the shorter one matches it too.
    if take_key(ctx, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)
        || take_key(ctx, Modifiers::COMMAND, Key::Y)
    {
        wishes.push(TextWish::Redo);
    } else if take_key(ctx, Modifiers::COMMAND, Key::Z) {
        wishes.push(TextWish::Undo);
    }
    if take_key(ctx, Modifiers::COMMAND, Key::S) {
        wishes.push(ViewWish::Save);
    }
    // With Shift, F lays the text out.
    if page.dialog.is_none() && !ctx.input(|input| input.modifiers.shift) {
        for (key, seek) in [
            (Key::F, Seek::Text),
            (Key::H, Seek::Replace),
            (Key::G, Seek::Line),
        ] {
            if take_key(ctx, Modifiers::COMMAND, key) {
                wishes.push(TextWish::Find(seek));
            }
        }
    }
    if page.dialog.is_some() && take_key(ctx, Modifiers::NONE, Key::Escape) {
        wishes.push(Wish::Close);
    }
    let types = ctx.egui_wants_keyboard_input();
    if page.dialog.is_none() && !types && take_key(ctx, Modifiers::NONE, Key::D) {
        let tool = match panels.stage.pencil.tool() {
            None => Some(Tool::Draw),
            Some(_) => None,
        };
        wishes.push(ViewWish::SetTool(tool));
    }
}
