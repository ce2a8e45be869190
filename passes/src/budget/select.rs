//! Choosing: an option of each group, so that their times fit a bound and their errors are the least, or the other way about.

/// What an option takes and errs by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Offer {
    /// Time in ms beyond that of the group's fastest option.
    pub ms: f64,
    /// Mean square of what the picture differs from the reference's, in codes of 255 squared: the squares of errors that
    /// have nothing to do with each other add up.
    pub squares: f64,
}

/// What two options of different groups take and err by together, beyond what each does alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Group and option of both.
    pub at: [[usize; 2]; 2],
    /// Beyond the sum, which may be less than nothing.
    pub beyond: Offer,
}

/// A chosen set: an option of each group, with what they take and err by together.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// Index of the option in each group.
    pub options: Vec<usize>,
    /// Time of a whole frame in ms.
    pub ms: f64,
    /// Mean square difference from the reference, in codes squared.
    pub squares: f64,
}

impl Chosen {
    /// Root mean square difference from the reference, in codes of 255.
    pub fn codes(&self) -> f64 {
        self.squares.max(0.0).sqrt()
    }
}

/// What there is to choose from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Offers {
    /// Options of each group.
    pub groups: Vec<Vec<Offer>>,
    /// Where times and errors do not add up.
    pub pairs: Vec<Pair>,
    /// Time in ms of the frame with the fastest option of each group.
    pub fastest_ms: f64,
}

impl Offers {
    /// What a set takes and errs by.
    pub fn predicted(&self, options: &[usize]) -> Chosen {
        let mut sum = Offer { ms: self.fastest_ms, squares: 0.0 };
        for (group, index) in self.groups.iter().zip(options) {
            add(&mut sum, group[*index]);
        }
        let together = |pair: &&Pair| pair.at.iter().all(|[group, option]| options[*group] == *option);
        self.pairs.iter().filter(together).for_each(|pair| add(&mut sum, pair.beyond));
        Chosen { options: options.to_vec(), ms: sum.ms, squares: sum.squares }
    }

    /// Scales what options take beyond the fastest frame, so that a set takes what it did, by a factor of four at most: one
    /// measurement is not believed beyond. Of the fastest frame it is that frame's time.
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

    /// The option of each group that errs least: the reference.
    pub fn finest(&self) -> Vec<usize> {
        self.groups.iter().map(|group| least(group, |offer| offer.squares)).collect()
    }

    /// The fastest option of each group.
    pub fn fastest(&self) -> Vec<usize> {
        self.groups.iter().map(|group| least(group, |offer| offer.ms)).collect()
    }

    /// The sets that no other beats, from the fastest to the most accurate: the multiple-choice knapsack, exactly. Groups of
    /// pairs are taken in every combination; each of the others is added to the sets that are left, of which those that
    /// another beats in both go.
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
            // While pairs may still change sums, no set is out of the running.
            let settled = !order[rank + 1..].iter().any(|index| paired(*index));
            sets = if settled { unbeaten(longer) } else { longer };
        }
        let chosen = |(options, sum): (Vec<usize>, Offer)| Chosen { options, ms: sum.ms, squares: sum.squares };
        sets.into_iter().map(chosen).collect()
    }

    /// The most accurate set that takes no more; none if no set does.
    pub fn within_ms(&self, most_ms: f64) -> Option<Chosen> {
        self.front().into_iter().take_while(|set| set.ms <= most_ms).last()
    }

    /// The fastest set that errs no more, in codes of 255; none if no set does.
    pub fn within_codes(&self, most_codes: f64) -> Option<Chosen> {
        self.front().into_iter().find(|set| set.codes() <= most_codes)
    }
}

fn add(sum: &mut Offer, more: Offer) {
    (sum.ms, sum.squares) = (sum.ms + more.ms, sum.squares + more.squares);
}

fn least(group: &[Offer], of: impl Fn(&Offer) -> f64) -> usize {
    // The last of equals, which is the finer option.
    (0..group.len()).rev().min_by(|a, b| of(&group[*a]).total_cmp(&of(&group[*b]))).unwrap_or(0)
}

/// Those that no other beats in both, from the fastest on.
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

    /// Four groups of four options, and pairs that make sums larger and smaller.
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

    /// Every set there is.
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
