//! Selection of one option per group: the smallest error within a time, or the smallest time within an error.

/// Time and error of an option.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Offer {
    /// Time beyond that of the group's fastest option, in milliseconds.
    pub ms: f64,
    /// Mean square difference from the reference, in squared 8-bit steps. Squares of independent errors add up.
    pub squares: f64,
}

/// Joint time and error of two options of different groups, beyond their sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Group and option of both.
    pub at: [[usize; 2]; 2],
    /// Difference from the sum; may be negative.
    pub beyond: Offer,
}

/// A chosen set: one option of each group, with the total time and error.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// Index of the option in each group.
    pub options: Vec<usize>,
    /// Time of a whole frame in milliseconds.
    pub ms: f64,
    /// Mean square difference from the reference, in squared 8-bit steps.
    pub squares: f64,
}

impl Chosen {
    /// Returns the RMS difference from the reference, in 8-bit steps.
    pub fn codes(&self) -> f64 {
        self.squares.max(0.0).sqrt()
    }
}

/// Options to choose from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Offers {
    /// Options of each group.
    pub groups: Vec<Vec<Offer>>,
    /// Pairs whose times or errors are not additive.
    pub pairs: Vec<Pair>,
    /// Time of the frame with the fastest option of each group, in milliseconds.
    pub fastest_ms: f64,
}

impl Offers {
    /// Returns the time and error of a set.
    pub fn predicted(&self, options: &[usize]) -> Chosen {
        let mut sum = Offer { ms: self.fastest_ms, squares: 0.0 };
        for (group, index) in self.groups.iter().zip(options) {
            add(&mut sum, group[*index]);
        }
        let together = |pair: &&Pair| pair.at.iter().all(|[group, option]| options[*group] == *option);
        self.pairs.iter().filter(together).for_each(|pair| add(&mut sum, pair.beyond));
        Chosen { options: options.to_vec(), ms: sum.ms, squares: sum.squares }
    }

    /// Scales all option times so that `set` takes the measured time. The factor is limited to 4, since a single
    /// measurement may be wrong. If `set` is the fastest frame, sets the time of that frame.
    pub fn scale_to(&mut self, options: &[usize], took_ms: f64) {
        let (predicted, found) = (self.predicted(options).ms - self.fastest_ms, took_ms - self.fastest_ms);
        if predicted <= 0.0 {
            self.fastest_ms = took_ms;
            return;
        }
        let scale = (found / predicted).clamp(0.25, 4.0);
        self.groups.iter_mut().flatten().for_each(|offer| offer.ms *= scale);
        self.pairs.iter_mut().for_each(|pair| pair.beyond.ms *= scale);
    }

    /// Returns the option with the smallest error of each group: the reference.
    pub fn finest(&self) -> Vec<usize> {
        self.groups.iter().map(|group| least(group, |offer| offer.squares)).collect()
    }

    /// Returns the fastest option of each group.
    pub fn fastest(&self) -> Vec<usize> {
        self.groups.iter().map(|group| least(group, |offer| offer.ms)).collect()
    }

    /// Returns the Pareto front, from the fastest set to the most accurate. Solves the multiple-choice knapsack
    /// exactly: groups with pairs are enumerated in every combination. Each other group is then added to the
    /// remaining sets, and dominated sets are removed.
    pub fn front(&self) -> Vec<Chosen> {
        let paired = |index: usize| self.pairs.iter().any(|pair| pair.at.iter().any(|[group, _]| *group == index));
        let order: Vec<usize> = (0..self.groups.len())
            .filter(|i| paired(*i))
            .chain((0..self.groups.len()).filter(|i| !paired(*i)))
            .collect();
        let start = Offer { ms: self.fastest_ms, squares: 0.0 };
        let mut sets: Vec<(Vec<usize>, Offer)> = vec![(vec![0; self.groups.len()], start)];
        for (rank, index) in order.iter().enumerate() {
            let mut longer = Vec::new();
            for (options, sum) in &sets {
                for (option, offer) in self.groups[*index].iter().enumerate() {
                    let (mut options, mut sum) = (options.clone(), *sum);
                    options[*index] = option;
                    add(&mut sum, *offer);
                    let known = &order[..=rank];
                    for pair in &self.pairs {
                        let now = pair.at.iter().any(|[group, _]| group == index);
                        let whole =
                            pair.at.iter().all(|[group, option]| known.contains(group) && options[*group] == *option);
                        if now && whole {
                            add(&mut sum, pair.beyond);
                        }
                    }
                    longer.push((options, sum));
                }
            }
            // Sets stay in the running while pairs can still change sums.
            let settled = !order[rank + 1..].iter().any(|index| paired(*index));
            sets = if settled { unbeaten(longer) } else { longer };
        }
        let chosen = |(options, sum): (Vec<usize>, Offer)| Chosen { options, ms: sum.ms, squares: sum.squares };
        sets.into_iter().map(chosen).collect()
    }

    /// Returns the most accurate set within a time in milliseconds, if any.
    pub fn within_ms(&self, most_ms: f64) -> Option<Chosen> {
        self.front().into_iter().take_while(|set| set.ms <= most_ms).last()
    }

    /// Returns the fastest set within an error in 8-bit steps, if any.
    pub fn within_codes(&self, max_steps: f64) -> Option<Chosen> {
        self.front().into_iter().find(|set| set.codes() <= max_steps)
    }
}

fn add(sum: &mut Offer, more: Offer) {
    (sum.ms, sum.squares) = (sum.ms + more.ms, sum.squares + more.squares);
}

fn least(group: &[Offer], of: impl Fn(&Offer) -> f64) -> usize {
    // The last of equal options is the finer one.
    (0..group.len()).rev().min_by(|a, b| of(&group[*a]).total_cmp(&of(&group[*b]))).unwrap_or(0)
}

/// Returns the sets that no other dominates, from the fastest on.
fn unbeaten(mut sets: Vec<(Vec<usize>, Offer)>) -> Vec<(Vec<usize>, Offer)> {
    sets.sort_by(|(_, a), (_, b)| a.ms.total_cmp(&b.ms).then(a.squares.total_cmp(&b.squares)));
    let mut best = f64::INFINITY;
    sets.retain(|(_, sum)| {
        let better = sum.squares < best;
        best = best.min(sum.squares);
        better
    });
    sets
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four groups of four options, with pairs that increase and decrease sums.
    pub(crate) fn random_offers(seed: u64) -> Offers {
        let mut state = seed;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        let mut offer = || Offer { ms: uniform(), squares: uniform() };
        let groups = (0..4).map(|_| (0..4).map(|_| offer()).collect()).collect();
        let half = |o: Offer| Offer { ms: 0.5 * o.ms - 0.2, squares: o.squares - 0.5 };
        let pairs = vec![
            Pair { at: [[0, 1], [2, 3]], beyond: half(offer()) },
            Pair { at: [[3, 0], [2, 3]], beyond: half(offer()) },
        ];
        Offers { groups, pairs, fastest_ms: 0.3 }
    }

    /// Returns every set.
    fn all(offers: &Offers) -> Vec<Chosen> {
        (0..256).map(|i| offers.predicted(&[i & 3, i >> 2 & 3, i >> 4 & 3, i >> 6])).collect()
    }

    #[test]
    fn no_set_is_better_than_the_chosen_one() {
        for seed in 0..25 {
            let offers = random_offers(seed);
            for bound in [0.4, 0.7, 1.0, 1.7, 3.0] {
                let within = all(&offers).into_iter().filter(|set| set.ms <= bound);
                let best = within.map(|set| set.squares).fold(f64::INFINITY, f64::min);
                let found = offers.within_ms(bound);
                let squares = found.as_ref().map_or(f64::INFINITY, |set| set.squares);
                assert!((squares - best).abs() < 1e-12 || squares == best, "seed {seed}, {bound} ms");
                if let Some(set) = found {
                    let again = offers.predicted(&set.options);
                    assert!((again.ms - set.ms).abs() + (again.squares - set.squares).abs() < 1e-12, "{set:?}");
                }
                let within = all(&offers).into_iter().filter(|set| set.codes() <= bound);
                let best = within.map(|set| set.ms).fold(f64::INFINITY, f64::min);
                let found = offers.within_codes(bound).map_or(f64::INFINITY, |set| set.ms);
                assert!((found - best).abs() < 1e-12 || found == best, "seed {seed}, {bound} codes");
            }
        }
    }
}
