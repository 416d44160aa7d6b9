//! The page for assistive technology: egui's tree of widgets as elements of the page, and what is
//! done with those elements as events for egui.
//!
//! A script (`www/voice.js`) makes the elements of a description: a line for each, in the order in
//! which they are read.

use egui::accesskit::{
    Action, ActionData, ActionRequest, Live, Node, NodeId, Role, Toggled, TreeId, TreeUpdate,
};
use egui::{Context, Event, FullOutput, Key, Modifiers, RawInput};
use std::collections::HashMap;
use std::fmt::Write;
use std::sync::{Arc, Mutex, PoisonError};

/// Ends a field of an element, and an element. No text that is shown has them.
const ENDS: [char; 2] = ['\u{1f}', '\u{1e}'];
/// Most elements.
const MOST: usize = 2000;
/// Most bytes of a text that can be written in as an element; of a longer one the beginning can be
/// read.
const LONGEST: usize = 64 << 10;

/// Events that wait for the next frame.
#[derive(Clone, Default)]
pub struct Acts(Arc<Mutex<Vec<Event>>>);

impl Acts {
    /// Adds what was done with an element: it was clicked (`click`), has got the focus (`focus`),
    /// or its number or text was changed (`number`, `text`).
    pub fn add(&self, element: u64, what: &str, value: &str) {
        let mut events = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match what {
            "click" => events.push(request(element, Action::Click, None)),
            "focus" => events.push(request(element, Action::Focus, None)),
            "number" => {
                let number = value.parse().unwrap_or(0.0);
                let number = ActionData::NumericValue(number);
                events.push(request(element, Action::SetValue, Some(number)));
            }
            "text" => {
                events.push(request(element, Action::Focus, None));
                events.push(Event::Key {
                    key: Key::A,
                    physical_key: None,
                    pressed: true,
                    repeat: false,
                    modifiers: Modifiers::COMMAND,
                });
                let text = ActionData::Value(value.into());
                events.push(request(element, Action::ReplaceSelectedText, Some(text)));
            }
            _ => {}
        }
    }
}

/// Makes an event that asks an element for something.
fn request(element: u64, action: Action, data: Option<ActionData>) -> Event {
    Event::AccessKitActionRequest(ActionRequest {
        action,
        target_tree: TreeId::ROOT,
        target_node: NodeId(element),
        data,
    })
}

/// The plugin of egui that tells what is painted.
pub struct Voice {
    acts: Acts,
    /// The last description.
    told: String,
}

impl Voice {
    /// Makes a plugin that hands on what is done with the elements.
    #[must_use]
    pub fn new(acts: Acts) -> Self {
        Self {
            acts,
            told: String::new(),
        }
    }
}

impl egui::Plugin for Voice {
    fn debug_name(&self) -> &'static str {
        "voice"
    }

    fn setup(&mut self, ctx: &Context) {
        ctx.enable_accesskit();
    }

    fn input_hook(&mut self, _ctx: &Context, input: &mut RawInput) {
        let mut events = self.acts.0.lock().unwrap_or_else(PoisonError::into_inner);
        input.events.append(&mut events);
    }

    fn output_hook(&mut self, _ctx: &Context, output: &mut FullOutput) {
        if let Some(update) = &output.platform_output.accesskit_update {
            let told = describe(update);
            if told != self.told {
                crate::show_elements(&told);
                self.told = told;
            }
        }
    }
}

/// Describes a tree: the element with the focus, then for each element its number, the number of
/// the dialog that it is in, its role, name, value, range, state, and place.
#[must_use]
pub fn describe(update: &TreeUpdate) -> String {
    let nodes: HashMap<NodeId, &Node> = update.nodes.iter().map(|(id, node)| (*id, node)).collect();
    let mut text = format!("{}{}", update.focus.0, ENDS[1]);
    let root = update.tree.as_ref().map(|tree| (tree.root, 0));
    // Deep trees need no deep stack.
    let mut stack: Vec<(NodeId, u64)> = root.into_iter().collect();
    let mut count = 0;
    while let Some((id, mut dialog)) = stack.pop() {
        let Some(node) = nodes.get(&id).filter(|_| count < MOST) else {
            continue;
        };
        if let Some(role) = role_of(node.role()) {
            count += 1;
            write_element(&mut text, [id.0, dialog], role, node);
            if role == "dialog" {
                dialog = id.0;
            }
        }
        stack.extend(node.children().iter().rev().map(|child| (*child, dialog)));
    }
    text
}

fn write_element(text: &mut String, [id, dialog]: [u64; 2], role: &str, node: &Node) {
    let of_text = matches!(role, "text" | "textbox" | "textarea");
    let name = node.label().or(node.placeholder()).unwrap_or_default();
    let mut value = match node.numeric_value() {
        Some(value) if !of_text => value.to_string(),
        _ => node.value().unwrap_or_default().to_owned(),
    };
    let is_cut = value.len() > LONGEST;
    value.truncate(value.floor_char_boundary(LONGEST));
    let range = [node.min_numeric_value(), node.max_numeric_value()];
    let range = range.map(|end| end.map(|end| end.to_string()).unwrap_or_default());
    let state = [
        (node.is_disabled() || is_cut).then_some('d'),
        node.toggled().map(|toggled| match toggled {
            Toggled::True => 't',
            Toggled::False => 'f',
            Toggled::Mixed => 'm',
        }),
        node.live().filter(|live| *live != Live::Off).map(|_| 'l'),
    ];
    let state: String = state.into_iter().flatten().collect();
    let place = node.bounds().map_or([0.0; 4], |place| {
        [place.x0, place.y0, place.width(), place.height()]
    });
    let [end, last] = ENDS;
    // Writing to a string never fails.
    let _ = write!(
        text,
        "{id}{end}{dialog}{end}{role}{end}{}{end}{}{end}{}{end}{}{end}{state}",
        name.replace(ENDS, " "),
        value.replace(ENDS, " "),
        range[0],
        range[1],
    );
    for part in place {
        let _ = write!(text, "{end}{part:.0}");
    }
    text.push(last);
}

/// Returns the name of a role in the page; `None` for what only holds others.
fn role_of(role: Role) -> Option<&'static str> {
    Some(match role {
        Role::Button | Role::DefaultButton | Role::ColorWell | Role::DisclosureTriangle => "button",
        Role::CheckBox | Role::Switch => "checkbox",
        Role::RadioButton => "radio",
        Role::Slider => "slider",
        Role::SpinButton => "spinbutton",
        Role::TextInput | Role::SearchInput => "textbox",
        Role::MultilineTextInput => "textarea",
        Role::Label | Role::Status => "text",
        Role::Link => "link",
        Role::Image => "img",
        Role::ComboBox => "combobox",
        Role::ListBoxOption => "option",
        Role::MenuItem => "menuitem",
        Role::Tab => "tab",
        Role::ProgressIndicator => "progressbar",
        Role::Dialog | Role::Window => "dialog",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::accesskit::{Rect, TreeInfo};

    #[test]
    fn widgets_become_elements_in_their_order_and_dialogs_hold_theirs() {
        let mut root = Node::new(Role::GenericContainer);
        root.set_children(vec![NodeId(2), NodeId(4)]);
        let mut button = Node::new(Role::Button);
        button.set_label("Share\u{1f} it");
        button.set_disabled();
        button.set_bounds(Rect::new(1.2, 2.0, 31.0, 22.0));
        let mut dialog = Node::new(Role::Dialog);
        dialog.set_children(vec![NodeId(3)]);
        let mut slider = Node::new(Role::Slider);
        slider.set_numeric_value(0.5);
        slider.set_min_numeric_value(0.0);
        slider.set_max_numeric_value(2.0);
        let update = TreeUpdate {
            nodes: vec![
                (NodeId(3), slider),
                (NodeId(2), button),
                (NodeId(4), dialog),
                (NodeId(1), root),
            ],
            tree: Some(TreeInfo::new(NodeId(1))),
            tree_id: TreeId::ROOT,
            focus: NodeId(3),
        };
        let text = describe(&update);
        let lines: Vec<Vec<&str>> = text
            .split_terminator(ENDS[1])
            .map(|line| line.split(ENDS[0]).collect())
            .collect();
        assert_eq!(lines[0], ["3"]);
        let share = [
            "2",
            "0",
            "button",
            "Share  it",
            "",
            "",
            "",
            "d",
            "1",
            "2",
            "30",
            "20",
        ];
        assert_eq!(lines[1], share);
        assert_eq!(lines[2][..3], ["4", "0", "dialog"]);
        assert_eq!(lines[3][..7], ["3", "4", "slider", "", "0.5", "0", "2"]);
        assert_eq!(lines.len(), 4);
    }
}
