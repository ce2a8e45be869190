//! Cycles of files that use each other, directly or through others.

use super::uses::Uses;

/// Returns the strongly connected components of two or more files. Files are indices below `count`, sorted.
pub fn circles(count: usize, uses: &Uses) -> Vec<Vec<usize>> {
    let reached: Vec<Vec<bool>> = (0..count).map(|file| reachable(file, count, uses)).collect();
    let mut found: Vec<Vec<usize>> = Vec::new();
    for (file, from_here) in reached.iter().enumerate() {
        let circle: Vec<usize> = (0..count).filter(|other| from_here[*other] && reached[*other][file]).collect();
        // Each cycle is reported at its first file.
        if circle.len() > 1 && circle[0] == file {
            found.push(circle);
        }
    }
    found
}

/// Marks the files that a file uses, directly or through others.
fn reachable(from: usize, count: usize, uses: &Uses) -> Vec<bool> {
    let mut reached = vec![false; count];
    let mut open = vec![from];
    while let Some(file) = open.pop() {
        for (_, used) in uses.range((file, 0)..(file + 1, 0)).map(|(pair, _)| *pair) {
            if !std::mem::replace(&mut reached[used], true) {
                open.push(used);
            }
        }
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_those_that_lead_back_are_in_a_circle() {
        let uses = |pairs: &[(usize, usize)]| pairs.iter().map(|pair| (*pair, Default::default())).collect::<Uses>();
        assert!(circles(4, &uses(&[(0, 1), (0, 2), (1, 3), (2, 3)])).is_empty());
        assert_eq!(
            circles(6, &uses(&[(0, 1), (1, 2), (2, 1), (2, 3), (3, 4), (4, 5), (5, 3)])),
            [vec![1, 2], vec![3, 4, 5]]
        );
    }
}
