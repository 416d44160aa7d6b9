//! The reference in the help: the commands of the language by group, with a search field.

use crate::first;
use crate::wish::{Wishes, WorkWish};
use crate::{places, theme};
use assist::manual::{TASKS, commands_of};
use egui::text::{LayoutJob, TextFormat};
use egui::{CollapsingHeader, Color32, FontId, Label, RichText, TextEdit, Ui};
use rats::commands::CommandSpec;
use rats::{library, manual};

/// The state of the reference.
#[derive(Default)]
pub struct Reference {
    search: String,
    /// The command whose card opens at the next frame.
    wanted: Option<String>,
}

impl Reference {
    /// Shows this command's card and clears the search.
    pub fn open(&mut self, name: &str) {
        name.clone_into(&mut self.search);
        self.wanted = Some(name.to_owned());
    }

    /// Shows the search field and the commands that it finds.
    pub fn show(&mut self, ui: &mut Ui, wishes: &mut Wishes) {
        let palette = theme::palette(ui.visuals());
        let field = ui.add(
            TextEdit::singleline(&mut self.search)
                .hint_text("Search the commands")
                .desired_width(f32::INFINITY)
                .margin(egui::Margin::symmetric(8, 6)),
        );
        places::note(ui.ctx(), "search commands", field.rect);
        if self.search.is_empty() {
            ui.add_space(6.0);
            first::offer(ui, wishes);
        }
        let wanted = self.wanted.take();
        let mut found = 0;
        for (group, title) in TASKS {
            let hits: Vec<&CommandSpec> = commands_of(group)
                .iter()
                .copied()
                .filter(|spec| matches(spec, &self.search))
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
                    .show(ui, |ui| card(ui, spec, wishes));
                if open.is_some() {
                    shown.header_response.scroll_to_me(None);
                }
            }
        }
        ui.add_space(10.0);
        if found == 0 {
            ui.weak("No command has this word in its name, its options or its meaning.");
        }
        ui.hyperlink_to("The whole reference as a page", "reference.html");
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

/// Shows the synopsis of a command, the meanings of operands and options, and an example to try.
pub fn card(ui: &mut Ui, spec: &CommandSpec, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    ui.add(Label::new(code(&spec.synopsis(), palette.command)).wrap());
    if !spec.details.is_empty() {
        ui.add(Label::new(small(spec.details, palette.text)).wrap());
    }
    if !spec.default.is_empty() {
        let text = format!("Without it: {}.", spec.default);
        ui.add(Label::new(small(&text, palette.weak)).wrap());
    }
    if let Some(reason) = spec.idle() {
        let text = format!("Changes nothing here: {reason}.");
        ui.add(Label::new(small(&text, palette.warning)).wrap());
    }
    let rows = rows(spec);
    if !rows.is_empty() {
        ui.add_space(4.0);
        let width = (0.36 * ui.available_width()).min(210.0);
        for (written, meaning, is_option) in rows {
            ui.horizontal_top(|ui| {
                let colour = if is_option {
                    palette.option
                } else {
                    palette.number
                };
                ui.vertical(|ui| {
                    ui.set_width(width);
                    ui.add(Label::new(code(&written, colour)).wrap());
                });
                ui.vertical(|ui| ui.add(Label::new(small(&meaning, palette.text)).wrap()));
            });
        }
    }
    if !spec.example.is_empty() {
        ui.add_space(6.0);
        egui::Frame::new()
            .fill(palette.paper)
            .corner_radius(theme::ROUND)
            .inner_margin(8)
            .show(ui, |ui| {
                ui.set_width(ui.available_width());
                let mut job = crate::text::code::colour(spec.example.trim_end(), palette);
                job.wrap.max_width = ui.available_width();
                ui.add(Label::new(job));
            });
        let button = ui
            .button("Try it")
            .on_hover_text("Open this example; your own work is kept");
        if button.clicked() {
            wishes.push(WorkWish::OpenText {
                name: spec.name.to_owned(),
                text: spec.example.to_owned(),
            });
        }
    }
    ui.add_space(6.0);
}

/// Returns a text in the letters of explanations.
fn small(text: &str, colour: Color32) -> RichText {
    RichText::new(text).size(13.0).color(colour)
}

/// Returns a text in the letters of code.
fn code(text: &str, colour: Color32) -> RichText {
    RichText::new(text).monospace().size(12.5).color(colour)
}

/// Returns spelling and meaning of operands and options, and whether each is an option.
fn rows(spec: &CommandSpec) -> Vec<(String, String, bool)> {
    let mut rows: Vec<(String, String, bool)> = spec
        .parameters
        .iter()
        .map(|parameter| {
            let meaning = manual::parameter_line(parameter);
            (parameter.synopsis(), meaning, false)
        })
        .collect();
    for parameter in library::parameters(spec.name) {
        let meaning = add_default(&parameter.meaning, parameter.default);
        rows.push((parameter.name.to_owned(), meaning, false));
    }
    for option in spec.options {
        let meaning = add_default(option.meaning, option.default);
        rows.push((option.synopsis(), meaning, true));
    }
    rows
}

/// Adds to a meaning what is taken if nothing is given.
fn add_default(meaning: &str, default: &str) -> String {
    match default {
        "" => meaning.to_owned(),
        default => format!("{meaning} (by default {default})"),
    }
}

/// Whether a command's name, meaning or options contain all words of the search.
fn matches(spec: &CommandSpec, search: &str) -> bool {
    search.split_whitespace().all(|word| {
        let word = word.to_lowercase();
        [spec.name, spec.meaning]
            .into_iter()
            .chain(spec.options.iter().map(|option| option.name))
            .any(|text| text.to_lowercase().contains(&word))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rats::commands;

    #[test]
    fn every_group_is_shown_once() {
        let shown: usize = TASKS
            .iter()
            .map(|(group, _)| commands_of(*group).len())
            .sum();
        assert_eq!(shown, commands::all().count());
        let groups: std::collections::HashSet<_> = TASKS.iter().map(|(group, _)| group).collect();
        assert_eq!(groups.len(), TASKS.len());
    }

    #[test]
    fn names_meanings_and_options_are_searched() {
        assert!(find("SPHERE").contains(&"sphere"));
        assert!(find("blobbiness").contains(&"surface"));
        assert!(find("colour").len() > 1);
        assert_eq!(find("sphere xyzzy"), Vec::<&str>::new());
        assert_eq!(find(" ").len(), commands::all().count());
    }

    fn find(search: &str) -> Vec<&'static str> {
        commands::all()
            .filter(|spec| matches(spec, search))
            .map(|spec| spec.name)
            .collect()
    }
}
