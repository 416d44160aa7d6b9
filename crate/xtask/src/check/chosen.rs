//! Selection of tests within a part: `cargo xtask test PART FILTER`.

use crate::shell::{command, read, root};
use anyhow::{Result, bail};
use std::collections::BTreeSet;

/// The selection: everything, a package, tests by a part of their names, or changed packages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Chosen {
    /// All of it.
    All,
    /// One package, a folder in `crate/`.
    Package(String),
    /// The packages of the workspace's `default-members`.
    Default,
    /// Packages that have been changed since the last commit.
    Changed(Vec<String>),
    /// Tests whose names, or files of browser tests whose names, contain this.
    Test(String),
}

impl Chosen {
    /// Interprets a filter: a package if there is one of that name, else tests.
    pub fn new(filter: Option<String>) -> Self {
        match filter {
            None => Self::All,
            Some(name) if is_package(&name) => Self::Package(name),
            Some(name) => Self::Test(name),
        }
    }

    /// The same, but without a filter what has been changed since the last commit, or if nothing has the packages that cargo
    /// builds if it is told nothing.
    ///
    /// # Errors
    /// If git does not say what has been changed.
    pub fn changed(filter: Option<String>) -> Result<Self> {
        if filter.is_some() {
            return Ok(Self::new(filter));
        }
        let Some(status) = read(&mut command(
            "git",
            &["status", "--porcelain", "--no-renames", "-uall"],
        )) else {
            bail!("git does not say what has been changed; name a package");
        };
        let changed = packages_of(&status);
        Ok(if changed.is_empty() {
            Self::Default
        } else {
            Self::Changed(changed)
        })
    }

    /// Options that say to cargo which packages are meant.
    pub fn packages(&self) -> Vec<&str> {
        match self {
            Self::All | Self::Test(_) => vec!["--workspace"],
            Self::Default => Vec::new(),
            Self::Package(name) => vec!["--package", name],
            Self::Changed(names) => names
                .iter()
                .flat_map(|name| ["--package", name.as_str()])
                .collect(),
        }
    }

    /// Whether a package is among them.
    pub fn has(&self, package: &str) -> bool {
        match self {
            Self::All | Self::Test(_) | Self::Default => true,
            Self::Package(name) => name == package,
            Self::Changed(names) => names.iter().any(|name| name == package),
        }
    }

    /// Text that names of tests must contain, if any.
    pub fn test(&self) -> Option<&str> {
        match self {
            Self::Test(name) => Some(name),
            _ => None,
        }
    }
}

fn is_package(name: &str) -> bool {
    let plain = name
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
    plain && root().join("crate").join(name).join("Cargo.toml").is_file()
}

/// The packages with files that `git status --porcelain` lists.
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
        let chosen = |name: &str| Chosen::new(Some(name.to_owned()));
        assert_eq!(chosen("field").packages(), ["--package", "field"]);
        assert!(chosen("field").has("field") && !chosen("field").has("tracer"));
        assert_eq!(chosen("far_out").packages(), ["--workspace"]);
        assert_eq!(chosen("far_out").test(), Some("far_out"));
        assert_eq!(Chosen::new(None).test(), None);
        assert_eq!(chosen("../crate/field").test(), Some("../crate/field"));
    }

    #[test]
    fn changed_packages_are_found() {
        let status = "M crate/tracer/src/lib.rs\n M crate/field/Cargo.toml\n?? crate/tracer/x y\n M README.md\n D crate/gone/a";
        assert_eq!(packages_of(status), ["field", "tracer"]);
    }
}
