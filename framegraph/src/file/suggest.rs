//! The name that was probably meant.

/// Longer names are not compared: that takes the product of their lengths.
const MOST_BYTES: usize = 200;

/// The candidate nearest to `name`, if it is near: at most a third of its letters away, one at least, and never all.
pub(super) fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let short = |name: &str| name.len() <= MOST_BYTES;
    if !short(name) {
        return None;
    }
    let letters = name.chars().count();
    let allowed = (letters / 3).max(1).min(letters.saturating_sub(1));
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates.into_iter().filter(|c| short(c)) {
        let distance = distance(&name.to_lowercase(), &candidate.to_lowercase(), allowed);
        if distance <= allowed && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Insertions, deletions, changes and swaps of neighbours from `a` to `b` (optimal string alignment); `limit + 1` when
/// the lengths alone rule the limit out.
fn distance(a: &str, b: &str, limit: usize) -> usize {
    let (a, b): (Vec<_>, Vec<_>) = (a.chars().collect(), b.chars().collect());
    if a.len().abs_diff(b.len()) > limit {
        return limit + 1;
    }
    let mut before = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let change = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = change.min(last[j] + 1).min(row[j - 1] + 1);
            let swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if swapped {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_found_and_strangers_are_not() {
        let names = ["tonemap", "bloom", "shadow"];
        assert_eq!(nearest("tonmap", names), Some("tonemap"));
        assert_eq!(nearest("Blomo", names), Some("bloom"));
        assert_eq!(nearest("ssao", names), None);
        assert_eq!(nearest("", names), None);
        assert_eq!(nearest("a", ["b"]), None);
    }

    #[test]
    fn distances_by_hand() {
        assert_eq!(distance("kitten", "sitting", 9), 3);
        assert_eq!(distance("ab", "ba", 9), 1);
        assert_eq!(distance("", "abc", 9), 3);
        assert_eq!(distance("abc", "", 1), 2);
    }
}
