//! Measured errors and costs of every setting, as written by the accuracy lab (`accuracy.json`, `docs/measurements/accuracy.md`).

use framegraph_passes::Facts;
use framegraph_passes::quality::{Choices, Measured, Offers};
use serde::Deserialize;
use std::path::PathBuf;

/// Value of the file's `schema`.
pub const SCHEMA: &str = "framegraph-accuracy";
/// Supported value of the file's `version`.
pub const VERSION: u32 = 2;

/// Measurements of one device. Fields that no view shows are ignored.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct AccuracyData {
    /// Name of the adapter, with driver and API.
    pub adapter: String,
    /// Size of the timed frames, in pixels.
    pub size_px: [u32; 2],
    /// Techniques in the order of the file.
    pub techniques: Vec<Technique>,
    /// Measurements for choosing a frame within a time budget; `None` if the file has none.
    #[serde(default)]
    pub budget: Option<Measured>,
    /// Folder of pictures next to the file, if it exists.
    #[serde(skip)]
    pub pictures: Option<PathBuf>,
}

/// Fields common to all versions.
#[derive(Deserialize)]
struct Head {
    schema: String,
    version: u32,
}

/// Most accurate frame within a time budget.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenFrame {
    /// Settings group and chosen option.
    pub options: Vec<[&'static str; 2]>,
    /// Time of the frame in milliseconds.
    pub ms: f64,
    /// Root-mean-square error against the reference frame, in 8-bit steps.
    pub error: f64,
}

impl AccuracyData {
    /// Returns the options of `render --budget-ms` ([`framegraph_passes::quality`]) for a scene that uses every effect.
    fn offers(&self) -> Option<(Choices, Offers)> {
        let measured = self.budget.as_ref()?;
        let choices = measured.choices(&Facts::default(), |_| true).ok()?;
        let offers = measured.offers(&choices, measured.fastest_ms, measured.reference_ms);
        Some((choices, offers))
    }

    /// Returns the times of the fastest and of the reference frame in milliseconds; `None` without measured frames.
    pub fn span_ms(&self) -> Option<[f64; 2]> {
        let (_, offers) = self.offers()?;
        Some([offers.fastest(), offers.finest()].map(|set| offers.predicted(&set).ms))
    }

    /// Returns the most accurate frame that takes at most `max_ms`, or else the fastest frame. `None` without measured
    /// frames.
    pub fn within(&self, max_ms: f64) -> Option<ChosenFrame> {
        let (choices, offers) = self.offers()?;
        let set = offers.within_ms(max_ms).unwrap_or_else(|| offers.predicted(&offers.fastest()));
        let named = choices.iter().zip(&set.options);
        let options = named.map(|((group, options), index)| [group.name, options[*index].name]).collect();
        Some(ChosenFrame { options, ms: set.ms, error: set.codes() })
    }

    /// Returns the comparison picture of a choice: reference, choice and their difference times sixteen, side by side.
    pub fn picture(&self, technique: &Technique, choice: &Choice) -> Option<PathBuf> {
        let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
        let name: String = choice.name.chars().map(letter).collect();
        Some(self.pictures.as_ref()?.join(format!("{}.{name}.png", technique.name))).filter(|file| file.is_file())
    }
}

/// Setting of the frame with its choices.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Technique {
    /// Name of the technique.
    pub name: String,
    /// Approximated quantity.
    pub what: String,
    /// Reference of the errors.
    pub truth: String,
    /// Unit of the errors.
    pub unit: String,
    /// Choices in the order of the file.
    pub choices: Vec<Choice>,
}

/// Value of a setting.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Choice {
    /// Name of the choice.
    pub name: String,
    /// Error in the technique's unit.
    pub error: f64,
    /// Time of a whole frame; `None` if it was not measured.
    #[serde(default)]
    pub ms: Option<Times>,
    /// Number of operations in the shader function, by kind.
    #[serde(default)]
    pub operations: Option<Vec<u32>>,
    /// Presets that use the choice.
    #[serde(default)]
    pub presets: Vec<String>,
}

/// Frame time over repeated measurements, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
pub struct Times {
    /// Median.
    pub median: f64,
    /// Lower end of the 95 % bootstrap confidence interval of the median.
    pub low: f64,
    /// Upper end of the 95 % bootstrap confidence interval of the median.
    pub high: f64,
}

/// Unit of the costs of a technique.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Milliseconds of a whole frame.
    Ms,
    /// Number of operations of a function.
    Operations,
    /// Unknown costs.
    Unknown,
}

impl Technique {
    /// Returns the unit of costs: times if all choices are timed, else operations if all are counted.
    pub fn unit_of_cost(&self) -> Unit {
        if self.choices.iter().all(|choice| choice.ms.is_some()) {
            Unit::Ms
        } else if self.choices.iter().all(|choice| choice.operations.is_some()) {
            Unit::Operations
        } else {
            Unit::Unknown
        }
    }

    /// Returns the cost of a choice in [`Self::unit_of_cost`].
    pub fn cost(&self, choice: &Choice) -> f64 {
        let operations = || choice.operations.iter().flatten().map(|count| f64::from(*count)).sum();
        match self.unit_of_cost() {
            Unit::Ms => choice.ms.map_or(0.0, |ms| ms.median),
            Unit::Operations => operations(),
            Unit::Unknown => 0.0,
        }
    }

    /// Marks the Pareto-optimal choices: no other choice is at least as cheap and as accurate, and better in one of both.
    pub fn front(&self) -> Vec<bool> {
        let points: Vec<[f64; 2]> = self.choices.iter().map(|choice| [self.cost(choice), choice.error]).collect();
        let beats = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
        points.iter().map(|point| !points.iter().any(|other| beats(other, point))).collect()
    }
}

/// Parses a file.
///
/// # Errors
/// A sentence: invalid JSON, an unsupported version, or an invalid value.
pub fn read(text: &[u8]) -> Result<AccuracyData, String> {
    let failed = |error| format!("invalid accuracy record: {error}");
    // Check the version first, because other versions have other fields.
    let Head { schema, version } = serde_json::from_slice(text).map_err(failed)?;
    if (schema.as_str(), version) != (SCHEMA, VERSION) {
        return Err(format!(
            "unsupported schema `{schema}` version {version}; expected `{SCHEMA}` version {VERSION}; measure again with `accuracy` \
             (docs/measurements/accuracy.md)"
        ));
    }
    let data: AccuracyData = serde_json::from_slice(text).map_err(failed)?;
    if let Some(measured) = &data.budget {
        measured.choices(&Facts::default(), |_| true).map_err(|error| format!("`budget`: {error}"))?;
    }
    let finite = |x: f64| x.is_finite() && x >= 0.0;
    let is_sound = |choice: &Choice| finite(choice.error) && choice.ms.is_none_or(|ms| finite(ms.median));
    for technique in &data.techniques {
        if let Some(choice) = technique.choices.iter().find(|choice| !is_sound(choice)) {
            return Err(format!("{}, {}: a number is negative or not finite", technique.name, choice.name));
        }
    }
    Ok(data)
}
