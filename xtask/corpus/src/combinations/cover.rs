//! Covering arrays: few cases that contain every pair, or every triple, of levels of different factors.
//!
//! A greedy construction in the manner of AETG (Cohen, Dalal, Fredman and Patton, "The AETG system: an approach to testing based
//! on combinatorial design", 1997). Equal inputs give equal arrays.

/// Cases that are built for each one that is kept.
const CANDIDATES: u32 = 8;

/// A level of a factor, by numbers from 0.
pub type Level = (usize, usize);

/// Factors with their numbers of levels, and pairs of levels that no case contains.
///
/// Level 0 of each factor goes with every other level, so that each partial case can be completed.
#[derive(Clone, Debug)]
pub struct Space {
    /// Number of levels of each factor, at least 1.
    pub levels: Vec<usize>,
    /// Pairs of levels that exclude each other; no level 0 among them.
    pub excluded: Vec<[Level; 2]>,
}

impl Space {
    /// Returns whether two levels may be in one case.
    #[must_use]
    pub fn allows(&self, a: Level, b: Level) -> bool {
        !self.excluded.iter().any(|pair| *pair == [a, b] || *pair == [b, a])
    }
}

/// Numbers sets of `strength` levels, in the order of their factors.
struct Sets {
    /// Number of the first level of each factor among all levels.
    first: Vec<usize>,
    /// Number of all levels.
    count: usize,
    strength: usize,
}

impl Sets {
    fn index(&self, set: &[Level]) -> usize {
        set.iter().fold(0, |index, (factor, level)| index * self.count + self.first[*factor] + level)
    }

    /// Calls `visit` with each set of `rest` more of the given levels, after those of `set`.
    fn each(&self, from: &[Level], rest: usize, set: &mut Vec<Level>, visit: &mut impl FnMut(&[Level])) {
        if rest == 0 {
            return visit(set);
        }
        for at in 0..from.len() {
            set.push(from[at]);
            self.each(&from[at + 1..], rest - 1, set, visit);
            set.pop();
        }
    }

    /// Calls `visit` with the number of each set of 2 or 3 levels of a partial case that contains `last`.
    fn with(&self, case: &[Option<usize>], last: Level, visit: &mut impl FnMut(usize)) {
        let number = |(factor, level): Level| self.first[factor] + level;
        let (last_factor, last) = (last.0, number(last));
        let others: Vec<usize> = chosen(case).filter(|(factor, _)| *factor != last_factor).map(number).collect();
        for (at, a) in others.iter().enumerate() {
            if self.strength == 2 {
                visit(last.min(*a) * self.count + last.max(*a));
                continue;
            }
            for b in &others[at + 1..] {
                // Numbers rise with the factors, so that a comes before b.
                let [x, y, z] = if last < *a {
                    [last, *a, *b]
                } else if last < *b {
                    [*a, last, *b]
                } else {
                    [*a, *b, last]
                };
                visit((x * self.count + y) * self.count + z);
            }
        }
    }
}

/// Returns the levels that a partial case has.
fn chosen(case: &[Option<usize>]) -> impl Iterator<Item = Level> + '_ {
    case.iter().enumerate().filter_map(|(factor, level)| Some((factor, (*level)?)))
}

/// Returns cases, each with a level for every factor, that contain every allowed set of `strength` levels (2 or 3) of as many
/// factors or more.
#[must_use]
pub fn cover(space: &Space, strength: usize) -> Vec<Vec<usize>> {
    let mut first = Vec::new();
    let mut count = 0;
    for levels in &space.levels {
        first.push(count);
        count += levels;
    }
    let sets = Sets { first, count, strength };
    // Sets that are left to cover, in a fixed order, and by number.
    let mut wanted = Vec::new();
    let mut is_open = vec![false; count.pow(strength as u32)];
    wanted_sets(space, 0, strength, &mut Vec::new(), &mut |set| {
        is_open[sets.index(set)] = true;
        wanted.push(set.to_vec());
    });
    let mut random = 1_u64;
    let mut cases = Vec::new();
    for set in &wanted {
        while is_open[sets.index(set)] {
            let candidates = (0..CANDIDATES).map(|_| candidate(space, &sets, &is_open, set, &mut random));
            let Some((_, case)) = candidates.reduce(|best, next| if next.0 > best.0 { next } else { best }) else {
                break;
            };
            let levels: Vec<Level> = case.iter().copied().enumerate().collect();
            sets.each(&levels, strength, &mut Vec::new(), &mut |set| is_open[sets.index(set)] = false);
            cases.push(case);
        }
    }
    cases
}

/// Calls `visit` with each allowed set of levels of `rest` factors from `factor` on.
fn wanted_sets(space: &Space, factor: usize, rest: usize, set: &mut Vec<Level>, visit: &mut impl FnMut(&[Level])) {
    if rest == 0 {
        return visit(set);
    }
    for next in factor..space.levels.len() {
        for level in 0..space.levels[next] {
            if set.iter().all(|other| space.allows(*other, (next, level))) {
                set.push((next, level));
                wanted_sets(space, next + 1, rest - 1, set, visit);
                set.pop();
            }
        }
    }
}

/// Completes a set to a case, one factor after another in a random order, with the level that covers most, or else level 0.
/// Returns how many open sets it covers, too.
fn candidate(space: &Space, sets: &Sets, is_open: &[bool], set: &[Level], random: &mut u64) -> (usize, Vec<usize>) {
    let mut case = vec![None; space.levels.len()];
    for (factor, level) in set {
        case[*factor] = Some(*level);
    }
    let mut covered = 1;
    let mut left: Vec<usize> = (0..case.len()).filter(|factor| case[*factor].is_none()).collect();
    while !left.is_empty() {
        let factor = left.swap_remove(next(random, left.len()));
        let turn = next(random, space.levels[factor]);
        // Level 0, unless another one covers something: most of a late case is then left out, and so is its cost.
        let mut best = (0, 0);
        for level in (0..space.levels[factor]).map(|level| (level + turn) % space.levels[factor]) {
            if !chosen(&case).all(|other| space.allows(other, (factor, level))) {
                continue;
            }
            let mut gain = 0;
            sets.with(&case, (factor, level), &mut |index| gain += usize::from(is_open[index]));
            if gain > best.0 {
                best = (gain, level);
            }
        }
        covered += best.0;
        case[factor] = Some(best.1);
    }
    (covered, case.into_iter().map(Option::unwrap_or_default).collect())
}

/// Returns a pseudo-random number below `end`: xorshift64 (Marsaglia, "Xorshift RNGs", 2003).
fn next(random: &mut u64, end: usize) -> usize {
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    (*random % end as u64) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space() -> Space {
        let levels = vec![3, 2, 4, 2, 3, 1, 2, 3];
        Space { levels, excluded: vec![[(0, 1), (2, 3)], [(2, 3), (4, 2)], [(1, 1), (7, 1)]] }
    }

    /// Counts allowed sets that no case contains, without the construction's own numbering.
    fn missing(space: &Space, cases: &[Vec<usize>], strength: usize) -> usize {
        let mut open = 0;
        wanted_sets(space, 0, strength, &mut Vec::new(), &mut |set| {
            let is_in = |case: &&Vec<usize>| set.iter().all(|(factor, level)| case[*factor] == *level);
            open += usize::from(!cases.iter().any(|case| is_in(&case)));
        });
        open
    }

    #[test]
    fn every_allowed_pair_and_triple_is_covered_and_no_excluded_pair() {
        let space = space();
        for strength in [2, 3] {
            let cases = cover(&space, strength);
            assert_eq!(missing(&space, &cases, strength), 0);
            assert!(missing(&space, &cases[1..], strength) > 0, "the first case is of use");
            for case in &cases {
                assert_eq!(case.len(), space.levels.len());
                for [a, b] in &space.excluded {
                    assert!(case[a.0] != a.1 || case[b.0] != b.1, "{case:?}");
                }
            }
        }
    }

    #[test]
    fn arrays_are_small_and_repeat() {
        let space = space();
        // 12 pairs of the two largest factors, and 36 triples of the three largest, are lower bounds.
        let [pairs, triples] = [2, 3].map(|strength| cover(&space, strength));
        assert!((11..=16).contains(&pairs.len()), "{}", pairs.len());
        assert!((30..=52).contains(&triples.len()), "{}", triples.len());
        assert_eq!(pairs, cover(&space, 2));
    }
}
