//! Selection of tests within a part: `cargo xtask test PART FILTER`.

use crate::shell::{command, read, root, words};
use anyhow::{Context, Result};
use std::collections::BTreeSet;

/// The selection.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Chosen {
    /// Packages, folders in `crate/`: all if `None`, the workspace's `default-members` if empty.
    packages: Option<Vec<String>>,
    /// Part of the names of tests, or of files of browser tests.
    pub test: Option<String>,
}

impl Chosen {
    /// Interprets a filter: a package if there is one of that name, else tests.
    pub fn new(filter: Option<String>) -> Self {
        let (packages, test) = match filter {
            Some(name) if is_package(&name) => (Some(vec![name]), None),
            test => (None, test),
        };
        Self { packages, test }
    }

    /// Interprets a filter as tests, for parts without packages.
    pub fn tests(filter: Option<String>) -> Self {
        Self {
            packages: None,
            test: filter,
        }
    }

    /// Interprets a filter like [`Chosen::new`]; without one, selects the packages that have been
    /// changed since the last commit.
    ///
    /// # Errors
    /// If git does not say what has been changed.
    pub fn of_changes(filter: Option<String>) -> Result<Self> {
        let mut chosen = Self::new(filter);
        if chosen.test.is_some() {
            // Tests of a name are looked for in the packages that build quickly.
            chosen.packages = Some(Vec::new());
        } else if chosen.packages.is_none() {
            let status = words("status --porcelain --no-renames -uall");
            let status = read(&mut command("git", &status))
                .context("git does not say what has been changed; name a package")?;
            chosen.packages = Some(packages_of(&status));
        }
        Ok(chosen)
    }

    /// Whether everything is selected.
    pub fn is_all(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the options that tell cargo the packages.
    pub fn packages(&self) -> Vec<&str> {
        let Some(names) = &self.packages else {
            return vec!["--workspace"];
        };
        names
            .iter()
            .flat_map(|name| ["--package", name.as_str()])
            .collect()
    }

    /// Whether a package is selected.
    pub fn has(&self, package: &str) -> bool {
        let names = self.packages.as_deref().unwrap_or_default();
        names.is_empty() || names.iter().any(|name| name == package)
    }
}

fn is_package(name: &str) -> bool {
    let is_word = name
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
    is_word && root().join("crate").join(name).join("Cargo.toml").is_file()
}

/// Returns the packages with files that `git status --porcelain` lists.
fn packages_of(status: &str) -> Vec<String> {
    let names: BTreeSet<&str> = status
        .lines()
        .filter_map(|line| line.split_once("crate/")?.1.split('/').next())
        .filter(|name| is_package(name))
        .collect();
    names.into_iter().map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filter_is_a_package_or_a_test() {
        fn choose(name: &str) -> Chosen {
            Chosen::new(Some(name.to_owned()))
        }
        assert_eq!(choose("field").packages(), ["--package", "field"]);
        assert!(choose("field").has("field") && !choose("field").has("tracer"));
        assert_eq!(choose("far_out").packages(), ["--workspace"]);
        assert_eq!(choose("far_out").test.as_deref(), Some("far_out"));
        assert!(Chosen::new(None).is_all() && !choose("far_out").is_all());
        assert_eq!(
            choose("../crate/field").test.as_deref(),
            Some("../crate/field")
        );
    }

    #[test]
    fn packages_of_changes_are_found() {
        let status = "M crate/tracer/src/lib.rs\n M crate/field/Cargo.toml\n\
            ?? crate/tracer/x y\n M README.md\n D crate/gone/a";
        assert_eq!(packages_of(status), ["field", "tracer"]);
    }
}
