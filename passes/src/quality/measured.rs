//! Measured time and error of options, as data of a file.

use super::groups::{FrameOption, Group};
use super::select::{Offer, Offers, Pair};
use crate::feature_culling::Facts;

/// Times and errors of all options on one adapter; each option is changed alone in the reference.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Measured {
    /// Time of the frame with the first option of each group, in milliseconds.
    pub fastest_ms: f64,
    /// Time of the reference in milliseconds.
    pub reference_ms: f64,
    /// The groups.
    pub groups: Vec<MeasuredGroup>,
    /// Pairs of options whose errors are not additive.
    pub pairs: Vec<MeasuredPair>,
    /// Options with passes of their own, and the share of a frame that these passes take.
    #[cfg_attr(feature = "files", serde(default))]
    pub shares: Vec<MeasuredShare>,
}

/// A group of options.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct MeasuredGroup {
    /// [`Group::name`].
    pub name: String,
    /// Built-in scene on which the options were measured; it needs their effects.
    pub scene: String,
    /// Options that the adapter supports, in the order of the group.
    pub options: Vec<MeasuredOption>,
}

/// An option.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct MeasuredOption {
    /// [`FrameOption::name`].
    pub name: String,
    /// Time of the reference with this option, in milliseconds.
    pub ms: f64,
    /// RMS difference from the reference picture, in 8-bit steps.
    pub codes: f64,
}

/// Two options together.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct MeasuredPair {
    /// Group and option of both.
    pub options: [[String; 2]; 2],
    /// Mean square difference beyond the sum of both, in squared 8-bit steps.
    pub squares: f64,
}

/// Time of an option's own passes in a frame of a preset.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct MeasuredShare {
    /// Name of the preset, in which the option replaces that of its group.
    pub preset: String,
    /// Group and option.
    pub option: [String; 2],
    /// Built-in scene in which the passes take the largest share.
    pub scene: String,
    /// Their share of the time of all passes, 0 to 1.
    pub share: f64,
}

/// Groups to choose from, each with its options.
pub type Choices = Vec<(&'static Group, Vec<&'static FrameOption>)>;

/// Error of reading a record.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeasuredError {
    /// The record names an unknown group or option.
    #[error("it has `{name}`, which this version of the frame has not; measure anew")]
    Unknown {
        /// The unknown name.
        name: String,
    },
    /// The device supports no option of a group.
    #[error("`{name}` has no option that this device has; measure anew")]
    Empty {
        /// The group.
        name: String,
    },
}

impl std::fmt::Debug for MeasuredError {
    /// Prints the message, as `unwrap` shows it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl Measured {
    /// Returns the groups that feature culling leaves a choice in, each with the options that were measured and that
    /// the device supports.
    ///
    /// # Errors
    /// Fails if the record names an unknown group or option, or leaves a group without options.
    pub fn choices(&self, facts: &Facts, has: impl Fn(&FrameOption) -> bool) -> Result<Choices, MeasuredError> {
        let unknown = |name: &String| MeasuredError::Unknown { name: name.clone() };
        let mut choices = Vec::new();
        for MeasuredGroup { name, options, .. } in &self.groups {
            let group = Group::of(name).ok_or_else(|| unknown(name))?;
            let known = options.iter().map(|own| group.option(&own.name).ok_or_else(|| unknown(&own.name)));
            let mut known = known.collect::<Result<Vec<_>, _>>()?;
            known.retain(|option| has(option));
            if known.is_empty() {
                return Err(MeasuredError::Empty { name: name.clone() });
            }
            if !group.is_dropped(facts) {
                choices.push((group, known));
            }
        }
        Ok(choices)
    }

    /// Returns the measured option.
    pub fn of(&self, group: &Group, option: &FrameOption) -> Option<&MeasuredOption> {
        let own = self.groups.iter().find(|own| own.name == group.name)?;
        own.options.iter().find(|own| own.name == option.name)
    }

    /// Returns the share of a preset's frame that the option's own passes take; 0 if it is not measured.
    pub fn share(&self, preset: &str, group: &Group, option: &FrameOption) -> f64 {
        let mut of_preset = self.shares.iter().filter(|own| own.preset == preset);
        let own = of_preset.find(|own| own.option == [group.name, option.name]);
        own.map_or(0.0, |own| own.share)
    }

    /// Returns times and errors of the options, scaled to the times in milliseconds of the fastest frame and of the
    /// reference. Differences between options scale in proportion.
    pub fn offers(&self, choices: &Choices, fastest_ms: f64, reference_ms: f64) -> Offers {
        let place = |[group, option]: &[String; 2]| {
            let at = choices.iter().position(|(own, _)| own.name == *group)?;
            Some([at, choices[at].1.iter().position(|own| own.name == *option)?])
        };
        let groups = choices.iter().map(|(group, options)| {
            let measured: Vec<_> = options.iter().filter_map(|option| self.of(group, option)).collect();
            let least = measured.iter().map(|option| option.ms).fold(f64::INFINITY, f64::min);
            measured.iter().map(|o| Offer { ms: o.ms - least, squares: o.codes * o.codes }).collect()
        });
        let pairs = self.pairs.iter().filter_map(|pair| {
            let at = [place(&pair.options[0])?, place(&pair.options[1])?];
            Some(Pair { at, beyond: Offer { ms: 0.0, squares: pair.squares } })
        });
        let mut offers = Offers { groups: groups.collect(), pairs: pairs.collect(), fastest_ms };
        let finest = offers.finest();
        offers.scale_to(&finest, reference_ms);
        offers
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feature_culling::{Decision, Effect, Fact, Proof};
    use crate::quality::GROUPS;

    /// The finest options take this much longer than the fastest, with one millisecond between neighbors.
    fn more_ms() -> f64 {
        GROUPS.iter().map(|group| group.options.len() - 1).sum::<usize>() as f64
    }

    /// Every group, with options one millisecond and one 8-bit step apart.
    fn measured() -> Measured {
        let group = |group: &Group| {
            let last = group.options.len() - 1;
            let option = |(index, own): (usize, &FrameOption)| MeasuredOption {
                name: own.name.to_owned(),
                ms: 10.0 + index as f64,
                codes: (last - index) as f64,
            };
            let options = group.options.iter().enumerate().map(option).collect();
            MeasuredGroup { name: group.name.to_owned(), scene: "columns".to_owned(), options }
        };
        let pair = MeasuredPair {
            options: [["edges", "none"], ["occlusion", "none"]].map(|p| p.map(str::to_owned)),
            squares: 1.5,
        };
        Measured {
            fastest_ms: 5.0,
            reference_ms: 20.0,
            groups: GROUPS.iter().map(group).collect(),
            pairs: vec![pair],
            shares: Vec::new(),
        }
    }

    #[test]
    fn what_facts_drop_is_not_chosen_and_costs_nothing() {
        let all = measured().choices(&Facts::default(), |_| true).expect("known names");
        assert_eq!(all.len(), GROUPS.len());
        let plain = measured().offers(&all, 10.0, 10.0 + more_ms());
        assert_eq!(plain.groups[0][1], Offer { ms: 1.0, squares: 1.0 });
        let offers = measured().offers(&all, 10.0, 10.0 + 2.0 * more_ms());
        assert_eq!(offers.groups[0][1], Offer { ms: 2.0, squares: 1.0 }, "twice as slow here");
        assert_eq!(offers.pairs.len(), 1);
        let row = |effect: Effect, decision| Fact { effect, decision, proof: Proof::Exact, reason: String::new() };
        let mut facts = Facts::default();
        let without = |dropped: Effect| {
            let effects = GROUPS.iter().flat_map(|group| group.effects).copied();
            effects.map(|e| row(e, if e == dropped { Decision::Dropped } else { Decision::Kept })).collect()
        };
        facts.rows = without(Effect::Occlusion);
        let left = measured().choices(&facts, |_| true).expect("known names");
        assert!(left.len() == GROUPS.len() - 1 && left.iter().all(|(group, _)| group.name != "occlusion"));
        assert!(measured().offers(&left, 10.0, 20.0).pairs.is_empty(), "its pair is out of the question");
        facts.rows = vec![row(Effect::Msaa, Decision::Dropped)];
        assert!(Group::of("edges").is_some_and(|edges| edges.is_dropped(&facts)), "the other was not asked for");
        facts.rows = without(Effect::Fxaa);
        assert_eq!(
            measured().choices(&facts, |_| true).expect("known names").len(),
            GROUPS.len(),
            "one of both is there"
        );
    }

    #[test]
    fn unknown_names_are_told() {
        let mut other = measured();
        other.groups[0].options[0].name = "sepia".to_owned();
        let told = other.choices(&Facts::default(), |_| true).expect_err("no such option").to_string();
        assert!(told.contains("`sepia`") && told.contains("measure anew"), "{told}");
        other.groups[0].options.clear();
        assert!(other.choices(&Facts::default(), |_| true).is_err());
    }
}
