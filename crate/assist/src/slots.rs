//! The use of each operand of a command, found without running anything.
//!
//! Parameters come from the same table as those of the language's own reader, operators from the
//! same [`rats::operator`]. The reader itself is another: that one computes values, needs all
//! variables for it, and stops at the first mistake; this one knows only whether something is a
//! number or a triple, goes on after a mistake, and notes where the operands end what could come
//! next. The tests hold the two together: in texts without errors every operand has a use here.

mod cursor;
mod expression;
mod operands;

pub use cursor::{Slot, Slots, Type, Want, What};

use crate::grammar::{Grammar, Param};
use rats::commands::OptionSpec;
use rats::syntax::Item;

impl<'i, 'p> Slots<'i, 'p> {
    /// Reads the operands of a command; `types` knows the variables.
    pub fn read(
        items: &'i [Item],
        text: &'p str,
        grammar: &Grammar<'p>,
        types: &'i dyn Fn(&str) -> Option<Type>,
    ) -> Self {
        let mut slots = Self::new(items, text, types);
        slots.parameters(&grammar.parameters, grammar.options, grammar.named);
        slots.options(grammar.options);
        while slots.more() {
            slots.extra();
        }
        slots
    }

    fn options(&mut self, options: &'static [OptionSpec]) {
        if options.is_empty() {
            return;
        }
        while !self.stopped {
            if !self.more() {
                self.wants.push(Want::Options(options));
                return;
            }
            let start = self.at;
            let Some(option) = self.option_here(options) else {
                self.extra();
                continue;
            };
            self.parameter = None;
            self.option = Some(option);
            self.push(start, What::Option);
            let parameters: Vec<Param<'_>> = option.parameters.iter().map(Param::from).collect();
            self.parameters(&parameters, options, false);
            self.option = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Index;
    use crate::walk;
    use rats::parser::parse;
    use rats::symbol::Symbols;
    use rats::{File, Project, commands, compile, library};

    /// The operands of a text's commands that the static reader has no use for.
    fn extras(text: &str) -> Vec<String> {
        let project = Project {
            files: vec![File {
                name: String::from("main.rat"),
                text: text.to_owned(),
            }],
        };
        let mut symbols = Symbols::default();
        let syntax = parse(text, &mut symbols);
        let mut starts = Vec::new();
        walk::commands(&syntax.block, &mut |command| {
            starts.push(command.word_span.start);
        });
        let mut extras = Vec::new();
        for start in starts {
            let index = Index::at(&project, Some((0, start)));
            let here = index.here.expect("a command");
            // The head of `define` is read by the parser; what is unknown is not run.
            let is_known = here.spec.is_some() || here.own.is_some();
            if here.word == "define" || !is_known {
                continue;
            }
            for (span, slot) in here.operands {
                let missing = slot.parameter.is_none() && slot.option.is_none();
                if matches!(slot.what, What::Extra) || missing {
                    extras.push(format!("{}: {}", here.word, &text[span]));
                }
            }
        }
        extras
    }

    /// The static reader reads what the evaluator reads: where there is no error, every operand has
    /// its use.
    #[test]
    fn every_operand_has_a_use() {
        let mut texts: Vec<String> = commands::all()
            .map(|spec| spec.example.to_owned())
            .collect();
        texts.extend(library::FILES.iter().map(|(_, text)| (*text).to_owned()));
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../www/examples");
        for entry in std::fs::read_dir(folder).expect("the examples") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|ending| ending == "rat") {
                let text = std::fs::read_to_string(path).expect("a text");
                if text.len() < 10_000 {
                    texts.push(text);
                }
            }
        }
        let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/../rats/tests/diagnostics");
        for entry in std::fs::read_dir(corpus).expect("the corpus") {
            let text = std::fs::read_to_string(entry.expect("an entry").path()).expect("a text");
            for section in text.split("\n### ") {
                let body = section.split_once('\n').map_or("", |(_, body)| body);
                if !body.contains("#! error") && !body.contains("#file ") {
                    texts.push(body.to_owned());
                }
            }
        }
        assert!(texts.len() > 150, "only {} texts", texts.len());
        let mut found = Vec::new();
        for text in texts {
            let project = Project {
                files: vec![File {
                    name: String::from("main.rat"),
                    text: text.clone(),
                }],
            };
            let errors = compile(&project).diagnostics;
            if errors.iter().all(|d| d.severity != rats::Severity::Error) {
                found.extend(extras(&text));
            }
        }
        assert!(found.is_empty(), "{found:#?}");
    }
}
