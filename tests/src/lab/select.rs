//! Choosing: one option of each technique, so that their times fit a budget and their errors add up to the least, or the other
//! way about.

use super::record::{ChoiceRecord, Record};
use super::statistics::undominated;

/// What an option of a group takes and errs by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offer {
    /// Time in ms beyond that of the group's fastest.
    pub ms: f64,
    /// Error, in codes.
    pub error: f64,
}

/// A chosen set: an option of each group, with the sums.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// Index of the option in each group.
    pub options: Vec<usize>,
    /// Sum of times in ms.
    pub ms: f64,
    /// Sum of errors.
    pub error: f64,
}

/// Groups of a record that are chosen from: those whose errors are codes of pictures and that are timed, with the name and
/// options of each.
pub fn groups(record: &Record) -> Vec<(&str, Vec<&ChoiceRecord>)> {
    let whole = record.techniques.iter().filter(|t| t.choices.iter().all(|c| c.picture.is_some() && c.ms.is_some()));
    whole.map(|t| (t.name.as_str(), t.choices.iter().collect())).collect()
}

/// What each option takes beyond its group's fastest.
pub fn offers(choices: &[&ChoiceRecord]) -> Vec<Offer> {
    let ms = |choice: &ChoiceRecord| choice.ms.map_or(f64::INFINITY, |ms| ms.median);
    let least = choices.iter().map(|choice| ms(choice)).fold(f64::INFINITY, f64::min);
    choices.iter().map(|choice| Offer { ms: ms(choice) - least, error: choice.error }).collect()
}

/// The sets that no other beats, from the fastest to the most accurate: the multiple-choice knapsack, exactly, by the sets of
/// the groups before and each group's options.
fn fronts(groups: &[Vec<Offer>]) -> Vec<Chosen> {
    let mut sets = vec![Chosen { options: Vec::new(), ms: 0.0, error: 0.0 }];
    for group in groups {
        let kept = undominated(&group.iter().map(|offer| [offer.ms, offer.error]).collect::<Vec<_>>());
        let mut longer = Vec::new();
        for set in &sets {
            for (index, offer) in group.iter().enumerate().filter(|(index, _)| kept[*index]) {
                let options = set.options.iter().copied().chain([index]).collect();
                longer.push(Chosen { options, ms: set.ms + offer.ms, error: set.error + offer.error });
            }
        }
        longer.sort_by(|a, b| a.ms.total_cmp(&b.ms).then(a.error.total_cmp(&b.error)));
        let mut least = f64::INFINITY;
        longer.retain(|set| {
            let better = set.error < least;
            least = least.min(set.error);
            better
        });
        sets = longer;
    }
    sets
}

/// The most accurate set within `budget_ms` beyond the fastest frame; none if no set is.
pub fn within_budget(groups: &[Vec<Offer>], budget_ms: f64) -> Option<Chosen> {
    fronts(groups).into_iter().take_while(|set| set.ms <= budget_ms).last()
}

/// The fastest set whose errors add up to no more; none if no set's do.
pub fn within_error(groups: &[Vec<Offer>], most: f64) -> Option<Chosen> {
    fronts(groups).into_iter().find(|set| set.error <= most)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random_groups(seed: u64) -> Vec<Vec<Offer>> {
        let mut state = seed;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        (0..4).map(|_| (0..4).map(|_| Offer { ms: uniform(), error: uniform() }).collect()).collect()
    }

    /// Every set there is.
    fn all(groups: &[Vec<Offer>]) -> Vec<[f64; 2]> {
        let mut sums = vec![[0.0, 0.0]];
        for group in groups {
            let with = |sum: &[f64; 2]| group.iter().map(|o| [sum[0] + o.ms, sum[1] + o.error]).collect::<Vec<_>>();
            sums = sums.iter().flat_map(with).collect();
        }
        sums
    }

    #[test]
    fn no_set_is_better_than_the_chosen_one() {
        for seed in 0..25 {
            let groups = random_groups(seed);
            for bound in [0.1, 0.5, 1.0, 1.7, 3.0] {
                let best = |own: usize, other: usize| {
                    let within = all(&groups).into_iter().filter(|sum| sum[own] <= bound);
                    within.map(|sum| sum[other]).fold(f64::INFINITY, f64::min)
                };
                let found = within_budget(&groups, bound).map_or(f64::INFINITY, |set| set.error);
                assert!((found - best(0, 1)).abs() < 1e-12 || found == best(0, 1), "seed {seed}, {bound} ms");
                let found = within_error(&groups, bound).map_or(f64::INFINITY, |set| set.ms);
                assert!((found - best(1, 0)).abs() < 1e-12 || found == best(1, 0), "seed {seed}, error {bound}");
            }
        }
    }
}
