//! Suggestions for misspelled names.

/// Maximum length of names that are compared, in bytes.
const MAX_BYTES: usize = 200;

/// Maximum edit distance of a suggestion.
const MAX_DISTANCE: usize = 12;

/// Maximum number of compared character pairs, about ten milliseconds. Names of usual length reach it at ten thousand
/// candidates.
const MAX_PAIRS: usize = 1 << 22;

/// Returns the closest candidate to `name`. Its distance must be at most a third of the length, at most twelve, and
/// less than the length.
pub fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    search(name, candidates).0
}

/// Returns the closest candidate and the number of compared character pairs.
fn search<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> (Option<&'c str>, usize) {
    let (mut best, mut pairs) = (None, 0);
    if name.len() > MAX_BYTES {
        return (best, pairs);
    }
    let letters: Vec<char> = name.to_lowercase().chars().collect();
    let allowed = (letters.len() / 3).clamp(1, MAX_DISTANCE).min(letters.len().saturating_sub(1));
    // Only a closer candidate can replace the best so far.
    let mut limit = Some(allowed);
    for candidate in candidates.into_iter().filter(|candidate| candidate.len() <= MAX_BYTES) {
        let Some(most) = limit.filter(|_| pairs < MAX_PAIRS) else { break };
        let other: Vec<char> = candidate.to_lowercase().chars().collect();
        if let Some(found) = distance(&letters, &other, most, &mut pairs) {
            (best, limit) = (Some(candidate), found.checked_sub(1));
        }
    }
    (best, pairs)
}

/// Returns the optimal string alignment distance: insertions, deletions, substitutions and transpositions. `None` if it
/// exceeds `limit`.
///
/// Compares only pairs within `limit` positions of the diagonal (Ukkonen 1985), and counts them.
fn distance(a: &[char], b: &[char], limit: usize, pairs: &mut usize) -> Option<usize> {
    if a.len().abs_diff(b.len()) > limit {
        return None;
    }
    let beyond = limit + 1;
    let mut before = vec![beyond; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    let mut row = before.clone();
    for i in 1..=a.len() {
        let band = i.saturating_sub(limit).max(1)..=(i + limit).min(b.len());
        *pairs += 1 + band.clone().count();
        // Cells outside of the band exceed the limit.
        row.fill(beyond);
        row[0] = i;
        for j in band {
            let change = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = change.min(last[j] + 1).min(row[j - 1] + 1);
            let swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if swapped {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        if row.iter().all(|distance| *distance > limit) {
            return None;
        }
        (before, last, row) = (last, row, before);
    }
    Some(last[b.len()]).filter(|distance| *distance <= limit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slips(a: &str, b: &str, limit: usize) -> Option<usize> {
        let [a, b] = [a, b].map(|text| text.chars().collect::<Vec<_>>());
        distance(&a, &b, limit, &mut 0)
    }

    #[test]
    fn slips_are_found_and_strangers_are_not() {
        let names = ["tonemap", "bloom", "shadow"];
        assert_eq!(nearest("tonmap", names), Some("tonemap"));
        assert_eq!(nearest("Blomo", names), Some("bloom"));
        assert_eq!(nearest("ssao", names), None);
        assert_eq!(nearest("", names), None);
        assert_eq!(nearest("a", ["b"]), None);
        // The closest candidate wins; of equals, the first.
        assert_eq!(nearest("shadow", ["shadwos", "shadows", "shadown"]), Some("shadows"));
    }

    #[test]
    fn distances_by_hand() {
        assert_eq!(slips("kitten", "sitting", 9), Some(3));
        assert_eq!(slips("ab", "ba", 9), Some(1));
        assert_eq!(slips("", "abc", 9), Some(3));
        assert_eq!(slips("abc", "", 1), None);
    }

    #[test]
    fn a_band_finds_what_the_whole_table_finds() {
        // All words of six and of three letters over a two-letter alphabet.
        let words: Vec<String> =
            (0..64).map(|n| format!("{n:06b}")).chain((0..8).map(|n| format!("{n:03b}"))).collect();
        for (a, b) in words.iter().flat_map(|a| words.iter().map(move |b| (a, b))) {
            let whole = slips(a, b, 9).expect("all distances are below 9");
            for limit in 0..6 {
                assert_eq!(slips(a, b, limit), (whole <= limit).then_some(whole), "{a} {b} {limit}");
            }
        }
    }

    #[test]
    fn the_work_is_bounded() {
        // Very different words end after a few rows of the band.
        let (mut pairs, [a, b]) = (0, ["a", "b"].map(|letter| letter.repeat(190).chars().collect::<Vec<_>>()));
        assert_eq!(distance(&a, &b, MAX_DISTANCE, &mut pairs), None);
        assert!(pairs <= (MAX_DISTANCE + 1) * (2 * MAX_DISTANCE + 2), "{pairs}");
        // Words that differ only at the end need all rows; the limit on pairs stops the search.
        let names: Vec<String> = (0..40_000).map(|n| format!("{}{n:018}", "a".repeat(172))).collect();
        let (_, pairs) = search(&format!("{}{}", "a".repeat(172), "x".repeat(18)), names.iter().map(String::as_str));
        // The last comparison is completed.
        assert!(pairs < MAX_PAIRS + 200 * (2 * MAX_DISTANCE + 2), "{pairs}");
    }
}
