//! Trials: measures a chosen set and chooses again with what was measured.

use super::select::{Chosen, Offer, Offers, Pair};

/// Bound on a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// Greatest time of a frame in milliseconds.
    Ms(f64),
    /// Greatest RMS difference from the reference, in 8-bit steps.
    Codes(f64),
}

/// Measured result of a set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Time of a frame in milliseconds.
    pub ms: f64,
    /// Mean square difference from the reference, in squared 8-bit steps.
    pub squares: f64,
}

/// Final choice.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// The set, with the predicted time and error.
    pub chosen: Chosen,
    /// Measured result of the set.
    pub trial: Trial,
    /// True if the set keeps the bound; otherwise no set that keeps it was found.
    pub holds: bool,
}

/// Fraction of the time that is aimed at. A frame aimed at exactly the budget exceeds it half of the time.
const AIM: f64 = 0.95;
/// Relative deviation from the predicted error above which errors count as not additive.
const OFF: f64 = 0.2;
/// Maximum number of trials.
const ROUNDS: usize = 8;

/// Chooses a set, measures it, and learns from the result. Times are scaled to the measured time. If the error is
/// more than a fifth off, the two options with the largest errors are measured together and become a [`Pair`]. The
/// choice is repeated until it was measured before. `offers` keeps what was learned.
///
/// # Errors
/// Returns errors of `attempt`, which is called with an option for each group.
pub fn settle<E>(
    offers: &mut Offers,
    bound: Bound,
    mut attempt: impl FnMut(&[usize]) -> Result<Trial, E>,
) -> Result<Settled, E> {
    let mut tried: Vec<Settled> = Vec::new();
    // Factor on the bound, after errors that no pair explains.
    let mut strict = 1.0;
    for _ in 0..ROUNDS {
        let fallback = |options: Vec<usize>| offers.predicted(&options);
        let chosen = match bound {
            Bound::Ms(ms) => offers.within_ms(AIM * ms).unwrap_or_else(|| fallback(offers.fastest())),
            Bound::Codes(codes) => offers.within_codes(codes / strict).unwrap_or_else(|| fallback(offers.finest())),
        };
        if tried.iter().any(|before| before.chosen.options == chosen.options) {
            break;
        }
        let trial = attempt(&chosen.options)?;
        let holds = match bound {
            Bound::Ms(ms) => trial.ms <= ms,
            Bound::Codes(codes) => trial.squares <= codes * codes,
        };
        offers.scale_to(&chosen.options, trial.ms);
        let off = (trial.squares.sqrt() - chosen.codes()).abs() > OFF * trial.squares.sqrt();
        let paired = match pair_of(offers, &chosen.options).filter(|_| off) {
            Some(at) => {
                let together = attempt(&set_of(offers, at))?;
                learn_pair(offers, at, together);
                true
            }
            None => false,
        };
        if let (Bound::Codes(codes), false, false) = (bound, holds, paired) {
            strict = 1.05 * (trial.squares.sqrt() / codes).max(strict);
        }
        tried.push(Settled { chosen, trial, holds });
    }
    let better = |a: &Settled, b: &Settled| match (a.holds, bound) {
        (true, Bound::Ms(_)) | (false, Bound::Codes(_)) => a.trial.squares.total_cmp(&b.trial.squares),
        (true, Bound::Codes(_)) | (false, Bound::Ms(_)) => a.trial.ms.total_cmp(&b.trial.ms),
    };
    let best = |holds: bool| tried.iter().filter(|set| set.holds == holds).min_by(|a, b| better(a, b)).cloned();
    Ok(best(true).or_else(|| best(false)).expect("the first round tries a set"))
}

/// Returns the two options of a set with the largest errors, if no pair of them is known.
fn pair_of(offers: &Offers, options: &[usize]) -> Option<[[usize; 2]; 2]> {
    let mut heavy: Vec<[usize; 2]> = options.iter().enumerate().map(|(group, option)| [group, *option]).collect();
    let squares = |[group, option]: &[usize; 2]| offers.groups[*group][*option].squares;
    heavy.retain(|at| squares(at) > 0.0);
    heavy.sort_by(|a, b| squares(b).total_cmp(&squares(a)));
    let known = |at: &[[usize; 2]; 2]| offers.pairs.iter().any(|pair| at.iter().all(|own| pair.at.contains(own)));
    let pairs = heavy.iter().enumerate().flat_map(|(i, a)| heavy[..i].iter().map(|b| [*b, *a]));
    pairs.take(3).find(|at| !known(at))
}

/// Returns the reference with two options changed.
fn set_of(offers: &Offers, at: [[usize; 2]; 2]) -> Vec<usize> {
    let mut options = offers.finest();
    at.into_iter().for_each(|[group, option]| options[group] = option);
    options
}

fn learn_pair(offers: &mut Offers, at: [[usize; 2]; 2], together: Trial) {
    let sum = offers.predicted(&set_of(offers, at));
    offers.pairs.push(Pair { at, beyond: Offer { ms: 0.0, squares: together.squares - sum.squares } });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offers() -> Offers {
        let group =
            |offers: &[[f64; 2]]| offers.iter().map(|[ms, squares]| Offer { ms: *ms, squares: *squares }).collect();
        let groups = vec![
            group(&[[0.0, 4.0], [1.0, 1.0], [4.0, 0.0]]),
            group(&[[0.0, 9.0], [2.0, 0.0]]),
            group(&[[0.0, 1.0], [3.0, 0.0]]),
        ];
        Offers { groups, pairs: Vec::new(), fastest_ms: 2.0 }
    }

    /// A device that takes twice the measured time, on which the errors of two options amplify each other.
    fn device(options: &[usize]) -> Trial {
        let told = offers().predicted(options);
        let doubled = if options[0] == 0 && options[1] == 0 { 2.0 } else { 1.0 };
        Trial { ms: 2.0 + 2.0 * (told.ms - 2.0), squares: doubled * told.squares }
    }

    #[test]
    fn frames_are_within_their_budgets_though_times_were_other_ones() {
        for budget in 3..22 {
            let bound = f64::from(budget);
            let settled = settle(&mut offers(), Bound::Ms(bound), |set| Ok::<_, ()>(device(set))).expect("no error");
            assert!(settled.holds && settled.trial.ms <= bound, "{bound} ms: {settled:?}");
            // No swap of one option within the target is more accurate.
            for (group, options) in offers().groups.iter().enumerate() {
                for option in 0..options.len() {
                    let mut swapped = settled.chosen.options.clone();
                    swapped[group] = option;
                    let trial = device(&swapped);
                    assert!(
                        trial.ms > AIM * bound || trial.squares >= settled.trial.squares,
                        "{bound} ms: {swapped:?}"
                    );
                }
            }
        }
        let settled = settle(&mut offers(), Bound::Ms(1.0), |set| Ok::<_, ()>(device(set))).expect("no error");
        assert!(!settled.holds && settled.chosen.options == [0, 0, 0], "the fastest there is: {settled:?}");
    }

    #[test]
    fn errors_that_do_not_add_up_are_learnt() {
        let mut learnt = offers();
        // Their separate errors sum to the root of 14.
        let settled = settle(&mut learnt, Bound::Codes(3.8), |set| Ok::<_, ()>(device(set))).expect("no error");
        assert!(settled.holds && settled.trial.squares <= 3.8 * 3.8, "{settled:?}");
        assert_eq!(learnt.pairs.len(), 1, "{:?}", learnt.pairs);
        assert_eq!(learnt.pairs[0].beyond.squares, 13.0, "4 and 9 come to 26");
        let none = settle(&mut offers(), Bound::Codes(0.0), |set| Ok::<_, ()>(device(set))).expect("no error");
        assert!(none.holds && none.chosen.options == [2, 1, 1], "the reference: {none:?}");
    }
}
