//! Report of a part of the measurements, as text.

use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::fmt::{Display, Formatter};

/// A number, shown with two or three digits that count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Short(pub f64);

impl Display for Short {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        let digits = match self.0.abs() {
            size if size >= 100.0 => 0,
            size if size >= 10.0 => 1,
            _ => 2,
        };
        write!(f, "{:.digits$}", self.0)
    }
}

/// The text of a thing, or a dash where there is none.
pub fn or_dash(thing: Option<impl Display>) -> String {
    thing.map_or("–".into(), |thing| thing.to_string())
}

/// Rows of the table of goals, and the replacements of the marks `{…}` in a part's text.
#[derive(Default)]
pub struct Report {
    /// The rows.
    pub goals: Vec<String>,
    marks: BTreeMap<&'static str, String>,
}

impl Report {
    /// Sets the text that replaces a mark.
    pub fn set(&mut self, mark: &'static str, thing: impl Display) {
        self.marks.insert(mark, thing.to_string());
    }

    /// Adds a row to the table of a mark, and shows it, as the next one may take a while.
    pub fn row(&mut self, mark: &'static str, cells: String) {
        let row = format!("| {cells} |");
        println!("{row}");
        let table = self.marks.entry(mark).or_default();
        if !table.is_empty() {
            table.push('\n');
        }
        *table += &row;
    }

    /// Adds a row to the table of goals, given as far as its bound: `the thing | against another |
    /// ≥ 1.5×`. Where there is no number, it says why.
    pub fn goal(&mut self, goal: &str, measured: Result<Short>) -> Result<()> {
        let (_, bound) = goal.rsplit_once("| ").context("a goal has columns")?;
        let number = bound.trim_start_matches(['≥', '≤', ' ']);
        let unit = number.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
        let wanted: f64 = number.trim_end_matches(unit).parse()?;
        let least = bound.starts_with('≥');
        let outcome = match measured {
            Ok(it) => {
                let is_met = if least {
                    it.0 >= wanted
                } else {
                    it.0 <= wanted
                };
                let word = if is_met { "met" } else { "**not met**" };
                format!("{it}{unit} | {word}")
            }
            Err(reason) => format!("– | {reason:#}"),
        };
        self.goals.push(format!("| {goal} | {outcome} |"));
        Ok(())
    }

    /// A text with all marks filled in.
    pub fn fill(&self, text: &str) -> Result<String> {
        let mut text = text.trim_end().to_owned();
        for (mark, filling) in &self.marks {
            text = text.replace(&format!("{{{mark}}}"), filling.trim_end());
        }
        let left = text.lines().find(|line| line.starts_with('{'));
        left.map_or(Ok(()), |left| bail!("nothing stands for {left}"))?;
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_goal_is_met_missed_or_not_measured() {
        let mut report = Report::default();
        report.goal("a | b | ≥ 4×", Ok(Short(4.125))).unwrap();
        report.goal("a | b | ≤ 1.5 s", Ok(Short(16.04))).unwrap();
        report
            .goal("a | b | ≤ 1.5×", Err(anyhow::anyhow!("no b here")))
            .unwrap();
        let rows = [
            "| a | b | ≥ 4× | 4.12× | met |",
            "| a | b | ≤ 1.5 s | 16.0 s | **not met** |",
            "| a | b | ≤ 1.5× | – | no b here |",
        ];
        assert_eq!(report.goals, rows);
        report.row("rows", "1 | 2".into());
        assert_eq!(report.fill("a\n{rows}\n").unwrap(), "a\n| 1 | 2 |");
        assert!(report.fill("{columns}").is_err());
    }
}
