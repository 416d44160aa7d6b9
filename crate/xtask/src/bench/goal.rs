//! Goals and whether they are met.

/// Bound that a ratio should keep.
#[derive(Clone, Copy, Debug)]
pub enum Wanted {
    /// This or more.
    AtLeast(f64),
    /// This or less.
    AtMost(f64),
}

impl Wanted {
    fn met(self, ratio: f64) -> bool {
        match self {
            Self::AtLeast(least) => ratio >= least,
            Self::AtMost(most) => ratio <= most,
        }
    }
}

/// A row of the table of goals.
pub struct Goal {
    /// The measured quantity.
    pub what: String,
    /// With what it is compared.
    pub against: String,
    /// Its goal.
    pub wanted: Wanted,
    /// Unit behind the numbers: `×`, ` ms`, ….
    pub unit: &'static str,
    /// The measured value, or why there is none.
    pub measured: Result<f64, String>,
}

/// A number with two or three digits that count.
pub fn short(number: f64) -> String {
    match number.abs() {
        size if size >= 100.0 => format!("{number:.0}"),
        size if size >= 10.0 => format!("{number:.1}"),
        _ => format!("{number:.2}"),
    }
}

/// The table of rows; nothing if there are none.
pub fn table(rows: &[String]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let head = "## Goals\n\n| what | against | goal | measured | |\n|---|---|--:|--:|---|\n";
    format!("{head}{}\n", rows.concat())
}

impl Goal {
    /// The goal's row of the table.
    pub fn row(&self) -> String {
        let unit = self.unit;
        let wanted = match self.wanted {
            Wanted::AtLeast(least) => format!("≥ {least}{unit}"),
            Wanted::AtMost(most) => format!("≤ {most}{unit}"),
        };
        let (measured, met) = match &self.measured {
            Ok(ratio) if self.wanted.met(*ratio) => (short(*ratio) + unit, "met"),
            Ok(ratio) => (short(*ratio) + unit, "**not met**"),
            Err(reason) => (String::from("–"), reason.as_str()),
        };
        format!(
            "| {} | {} | {wanted} | {measured} | {met} |\n",
            self.what, self.against
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_goal_is_met_missed_or_not_measured() {
        let goal = |wanted, measured| Goal {
            what: String::from("a"),
            against: String::from("b"),
            wanted,
            unit: "×",
            measured,
        };
        let table = table(
            &[
                goal(Wanted::AtLeast(4.0), Ok(4.125)),
                goal(Wanted::AtMost(1.5), Ok(16.04)),
                goal(Wanted::AtMost(1.5), Err(String::from("no b here"))),
            ]
            .map(|goal| goal.row()),
        );
        assert!(table.contains("| a | b | ≥ 4× | 4.12× | met |"), "{table}");
        assert!(table.contains("| a | b | ≤ 1.5× | 16.0× | **not met** |"));
        assert!(table.contains("| a | b | ≤ 1.5× | – | no b here |"));
    }
}
