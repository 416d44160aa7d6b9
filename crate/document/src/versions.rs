//! Earlier versions of a work: its texts as they were, densely for the last minutes and ever more
//! sparsely before.

use crate::history::Snapshot;
use rats::Project;
use serde::{Deserialize, Serialize};

/// Milliseconds between versions of a text that is changed little by little.
const PAUSE: f64 = 60_000.0;
/// Bytes that a change adds or takes at once if the text before is a version however young the last
/// one is.
const LARGE: usize = 200;
/// Most versions.
const MOST: usize = 100;
/// Most bytes of all versions.
const BYTES: usize = 4 << 20;

/// An earlier version of a work.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Version {
    /// Time until which the texts were so, milliseconds since 1970.
    pub until: f64,
    /// The texts.
    pub project: Project,
}

/// The earlier versions of a work, the oldest first.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Versions(Vec<Version>);

impl Versions {
    /// Returns the versions, the oldest first.
    #[must_use]
    pub fn all(&self) -> &[Version] {
        &self.0
    }

    /// Notes the texts `before` a change that was written at `now`, if they differ much from those
    /// `after` it or the last version is old. Returns whether they became a version.
    pub fn note(&mut self, before: Project, after: Option<&Project>, now: f64) -> bool {
        let last = self.0.last();
        let is_known = last.is_some_and(|last| last.project == before) || after == Some(&before);
        let is_old = last.is_none_or(|last| (now - last.until).abs() >= PAUSE);
        let is_large = after.is_none_or(|after| after.bytes().abs_diff(before.bytes()) >= LARGE);
        if is_known || !(is_old || is_large) {
            return false;
        }
        self.0.push(Version {
            until: now,
            project: before,
        });
        self.thin(now);
        true
    }

    /// Removes versions until there are few enough: the one whose neighbours are nearest for its
    /// age, so that the past is covered evenly on a logarithmic scale. The first and the last stay.
    fn thin(&mut self, now: f64) {
        while self.0.len() > 2 && (self.0.len() > MOST || size(&self.0) > BYTES) {
            let places = 1..self.0.len() - 1;
            let nearest = places.min_by(|a, b| {
                let [a, b] = [a, b].map(|at| self.gap(*at, now));
                a.total_cmp(&b)
            });
            self.0.remove(nearest.unwrap_or(1));
        }
        if size(&self.0) > BYTES {
            self.0.remove(0);
        }
    }

    /// Returns the time between the neighbours of a version by its age.
    fn gap(&self, at: usize, now: f64) -> f64 {
        let age = (now - self.0[at].until).max(1.0);
        (self.0[at + 1].until - self.0[at - 1].until) / age
    }
}

/// Returns the bytes of all texts of some versions.
fn size(versions: &[Version]) -> usize {
    versions.iter().map(|version| version.project.bytes()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Project {
        Project::single(text)
    }

    #[test]
    fn little_changes_within_a_minute_are_one_version_and_a_large_one_is_kept_at_once() {
        let mut versions = Versions::default();
        assert!(versions.note(text("a"), Some(&text("ab")), 0.0));
        assert!(!versions.note(text("ab"), Some(&text("abc")), 1000.0));
        let long = text(&"x".repeat(300));
        assert!(
            !versions.note(text("abc"), Some(&text("abc")), 2000.0),
            "no change"
        );
        assert!(
            versions.note(long.clone(), Some(&text("")), 3000.0),
            "all of it is deleted"
        );
        assert!(
            !versions.note(long.clone(), Some(&text("")), 1e9),
            "it is there already"
        );
        assert!(
            versions.note(text("ab"), Some(&text("abc")), 2e9),
            "a day later"
        );
        let until: Vec<f64> = versions.all().iter().map(|version| version.until).collect();
        assert_eq!(until, [0.0, 3000.0, 2e9]);
    }

    #[test]
    fn versions_are_few_small_and_reach_back_to_the_first() {
        for size in [10, 200_000] {
            let mut versions = Versions::default();
            for minute in 0..2000 {
                let now = f64::from(minute) * PAUSE;
                let before = text(&format!("{minute}{}", "x".repeat(size)));
                assert!(versions.note(before, None, now));
            }
            let all = versions.all();
            let bytes = size(all);
            assert!(
                all.len() <= MOST && bytes <= BYTES,
                "{} of {bytes}",
                all.len()
            );
            assert_eq!(
                (all[0].until, all[all.len() - 1].until),
                (0.0, 1999.0 * PAUSE)
            );
            // Steps into the past grow no faster than the age.
            for pair in all.windows(2).skip(1) {
                let (step, age) = (
                    pair[1].until - pair[0].until,
                    1999.0 * PAUSE - pair[0].until,
                );
                assert!(step <= 0.5 * age + PAUSE, "{step} at the age of {age}");
            }
        }
    }
}
