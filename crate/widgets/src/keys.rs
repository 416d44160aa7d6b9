//! Keys that a part of the page takes, so that no other one has them.
use egui::{Context, Key, Modifiers};

/// Takes a key with these modifiers; returns whether it was pressed.
pub fn take_key(ctx: &Context, modifiers: Modifiers, key: Key) -> bool {
    ctx.input_mut(|input| input.consume_key(modifiers, key))
}
