//! The reference in the help: every command of the language, by group, with a field that searches names
//! and meanings.

use crate::command::Command;
use crate::{places, theme};
use egui::text::{LayoutJob, TextFormat};
use egui::{CollapsingHeader, FontId, RichText, TextEdit, Ui};
use rats::commands::{COMMANDS, CommandSpec, Group, OptionSpec};

/// The groups in the order in which a newcomer needs them.
const GROUPS: [(Group, &str); 9] = [
    (Group::Primitives, "Shapes"),
    (Group::Materials, "Materials and textures"),
    (Group::Objects, "Objects"),
    (Group::Scene, "Light and picture"),
    (Group::Camera, "Camera"),
    (Group::Extensions, "Programming"),
    (Group::Options, "Settings"),
    (Group::Run, "Running"),
    (Group::Tools, "Tools"),
];

/// The state of the reference.
#[derive(Default)]
pub struct Reference {
    search: String,
    /// The command whose card opens at the next frame.
    wanted: Option<String>,
}

impl Reference {
    /// Shows this command's card, whatever was searched before.
    pub fn open(&mut self, name: &str) {
        name.clone_into(&mut self.search);
        self.wanted = Some(name.to_owned());
    }

    /// Shows the field and what it finds.
    pub fn show(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let palette = theme::palette(ui.visuals());
        let field = ui.add(
            TextEdit::singleline(&mut self.search)
                .hint_text("Search the commands")
                .desired_width(f32::INFINITY)
                .margin(egui::Margin::symmetric(8, 6)),
        );
        places::note(ui.ctx(), "search commands", field.rect);
        let wanted = self.wanted.take();
        let mut found = 0;
        for (group, title) in GROUPS {
            let hits: Vec<&CommandSpec> = COMMANDS
                .iter()
                .filter(|spec| spec.group == group && matches(spec, &self.search))
                .collect();
            if hits.is_empty() {
                continue;
            }
            found += hits.len();
            ui.add_space(10.0);
            ui.label(RichText::new(title).color(palette.strong).size(15.0));
            for spec in hits {
                let open = (wanted.as_deref() == Some(spec.name)).then_some(true);
                let shown = CollapsingHeader::new(heading(spec, palette))
                    .id_salt(("command", spec.name))
                    .open(open)
                    .show(ui, |ui| card(ui, spec, commands));
                if open.is_some() {
                    shown.header_response.scroll_to_me(None);
                }
            }
        }
        if found == 0 {
            ui.add_space(8.0);
            ui.weak("No command has this word in its name, its options or its meaning.");
        }
    }
}

fn heading(spec: &CommandSpec, palette: &theme::Palette) -> LayoutJob {
    let mut job = LayoutJob::default();
    let name = TextFormat::simple(FontId::monospace(13.0), palette.command);
    let meaning = TextFormat::simple(FontId::proportional(13.0), palette.weak);
    job.append(spec.name, 0.0, name);
    job.append(spec.meaning, 10.0, meaning);
    job
}

/// How a command is written and what its options mean.
pub fn card(ui: &mut Ui, spec: &CommandSpec, _commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    let small = |text: &str| RichText::new(text).size(13.0).color(palette.text);
    ui.label(
        RichText::new(spec.synopsis())
            .monospace()
            .size(12.5)
            .color(palette.command),
    );
    if !spec.default.is_empty() {
        ui.label(small(&format!("Without it: {}.", spec.default)));
    }
    if spec.options.is_empty() {
        return;
    }
    ui.add_space(4.0);
    egui::Grid::new(("options", spec.name))
        .num_columns(2)
        .spacing([14.0, 4.0])
        .show(ui, |ui| {
            for option in spec.options {
                let written = format!("{} {}", option.name, option.arguments);
                ui.label(
                    RichText::new(written.trim_end())
                        .monospace()
                        .size(12.0)
                        .color(palette.option),
                );
                ui.add(egui::Label::new(small(&told(option))).wrap());
                ui.end_row();
            }
        });
}

/// What an option means, with its default.
fn told(option: &OptionSpec) -> String {
    if option.default.is_empty() {
        option.meaning.to_owned()
    } else {
        format!("{} ({})", option.meaning, option.default)
    }
}

/// Whether all words of the search are found in the command's name, meaning or options.
fn matches(spec: &CommandSpec, search: &str) -> bool {
    search.split_whitespace().all(|word| {
        let word = word.to_lowercase();
        let has = |text: &str| text.to_lowercase().contains(&word);
        has(spec.name) || has(spec.meaning) || spec.options.iter().any(|option| has(option.name))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_is_in_one_group() {
        for spec in COMMANDS {
            let groups = GROUPS.iter().filter(|(group, _)| *group == spec.group);
            assert_eq!(groups.count(), 1, "{}", spec.name);
        }
    }

    #[test]
    fn names_meanings_and_options_are_searched() {
        let find = |search: &str| -> Vec<&str> {
            COMMANDS
                .iter()
                .filter(|spec| matches(spec, search))
                .map(|spec| spec.name)
                .collect()
        };
        assert_eq!(find("SPHERE").first(), Some(&"sphere"));
        assert!(find("blobbiness").contains(&"surface"));
        assert!(find("colour").len() > 1);
        assert_eq!(find("sphere xyzzy"), Vec::<&str>::new());
        assert_eq!(find(" ").len(), COMMANDS.len());
    }
}
