//! Hints for mistyped words: "did you mean …?"

/// Bytes of the longest word that is taken for a slip; comparing longer ones would cost time.
const MAX_WORD: usize = 40;
/// Names among which a hint is looked for; a text can have many thousands, and as many slips.
const MAX_CANDIDATES: usize = 2000;
/// Pairs of letters that one hint may compare, a tenth of a millisecond; where it would take more,
/// no hint is looked for.
const MAX_PAIRS: usize = 60_000;

/// Finds the candidate that is nearest to a mistyped word, ignoring case, if it is near enough: at
/// most one slip in three letters. Of several equally near ones the first in the alphabet counts.
#[must_use]
pub fn nearest<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    if word.len() > MAX_WORD {
        return None;
    }
    let mut candidates: Vec<&str> = candidates.into_iter().take(MAX_CANDIDATES + 1).collect();
    if candidates.len() > MAX_CANDIDATES {
        return None;
    }
    let allowed = (word.chars().count() / 3).max(1);
    candidates.retain(|c| c.len().abs_diff(word.len()) <= allowed && c.len() <= MAX_WORD);
    let letters: usize = candidates.iter().map(|c| c.len()).sum();
    if letters * word.len() > MAX_PAIRS {
        return None;
    }
    candidates
        .into_iter()
        .map(|c| (distance(word.as_bytes(), c.as_bytes()), c))
        .filter(|(d, _)| *d <= allowed)
        // Some candidates come from maps, which have no order; the same text must get the same
        // hint.
        .min()
        .map(|(_, c)| c)
}

/// Returns a hint for a mistyped word, if a candidate is near.
#[must_use]
pub fn hint<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<String> {
    nearest(word, candidates).map(|c| format!("did you mean `{c}`?"))
}

/// Computes the optimal string alignment distance, ignoring case: insertions, deletions,
/// replacements and swaps of neighbours. Both words have at most [`MAX_WORD`] bytes.
fn distance(a: &[u8], b: &[u8]) -> usize {
    let mut rows = [[0_usize; MAX_WORD + 1]; 3];
    for (j, cell) in rows[0].iter_mut().enumerate() {
        *cell = j;
    }
    for i in 1..=a.len() {
        let [last, before] = [(i - 1) % 3, (i + 1) % 3];
        let mut row = [0; MAX_WORD + 1];
        row[0] = i;
        for j in 1..=b.len() {
            let replace =
                rows[last][j - 1] + usize::from(!a[i - 1].eq_ignore_ascii_case(&b[j - 1]));
            row[j] = replace.min(rows[last][j] + 1).min(row[j - 1] + 1);
            let is_swap = i > 1
                && j > 1
                && a[i - 1].eq_ignore_ascii_case(&b[j - 2])
                && a[i - 2].eq_ignore_ascii_case(&b[j - 1]);
            if is_swap {
                row[j] = row[j].min(rows[before][j - 2] + 1);
            }
        }
        rows[i % 3] = row;
    }
    rows[a.len() % 3][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_slips() {
        let words = ["sphere", "cylinder", "surface", "arc", "arch"];
        assert_eq!(nearest("spehre", words), Some("sphere"));
        assert_eq!(nearest("Cilinder", words), Some("cylinder"));
        assert_eq!(nearest("surfac", words), Some("surface"));
        assert_eq!(nearest("arcg", words), Some("arc"));
        assert_eq!(nearest("banana", words), None);
        assert_eq!(nearest("", words), None);
    }
}
