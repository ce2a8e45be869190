//! What each choice of the frame errs by and takes, as the lab of accuracy writes it (`accuracy.json`, `docs/accuracy.md`).

use framegraph_passes::Facts;
use framegraph_passes::budget::{Choices, Measured, Offers};
use serde::Deserialize;
use std::path::PathBuf;

/// The file's `schema`.
pub const SCHEMA: &str = "framegraph-accuracy";
/// The `version` that is read.
pub const VERSION: u32 = 2;

/// All that was measured in one place. Fields that no view shows are not read.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct AccuracyData {
    /// Adapter, driver and interface.
    pub adapter: String,
    /// Pictures whose frames were timed, in pixels.
    pub size_px: [u32; 2],
    /// In the order of their list.
    pub techniques: Vec<Technique>,
    /// What frames are chosen from within a time; none where that was not measured.
    #[serde(default)]
    pub budget: Option<Measured>,
    /// The folder of pictures beside the file, if there is one.
    #[serde(skip)]
    pub pictures: Option<PathBuf>,
}

/// What every version begins with.
#[derive(Deserialize)]
struct Head {
    schema: String,
    version: u32,
}

/// The most accurate frame within a time.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenFrame {
    /// Each choice of the frame with its option.
    pub options: Vec<[&'static str; 2]>,
    /// Time of the frame in ms.
    pub ms: f64,
    /// Root mean square difference from the finest frame, in codes of 255.
    pub codes: f64,
}

impl AccuracyData {
    /// What frames are chosen from: the selector of `render --budget-ms` ([`framegraph_passes::budget`]), of a scene that calls
    /// for everything.
    fn offers(&self) -> Option<(Choices, Offers)> {
        let measured = self.budget.as_ref()?;
        let choices = measured.choices(&Facts::default(), |_| true).ok()?;
        let offers = measured.offers(&choices, measured.fastest_ms, measured.reference_ms);
        Some((choices, offers))
    }

    /// Times of the fastest and of the finest frame in ms; none where frames were not measured as a whole.
    pub fn span_ms(&self) -> Option<[f64; 2]> {
        let (_, offers) = self.offers()?;
        Some([offers.fastest(), offers.finest()].map(|set| offers.predicted(&set).ms))
    }

    /// The most accurate frame that takes no more; where none does, the fastest. None where frames were not measured.
    pub fn within(&self, most_ms: f64) -> Option<ChosenFrame> {
        let (choices, offers) = self.offers()?;
        let set = offers.within_ms(most_ms).unwrap_or_else(|| offers.predicted(&offers.fastest()));
        let named = choices.iter().zip(&set.options);
        let options = named.map(|((group, options), index)| [group.name, options[*index].name]).collect();
        Some(ChosenFrame { options, ms: set.ms, codes: set.codes() })
    }

    /// The picture of a choice, reference, choice and sixteen times their difference side by side: where the lab puts it.
    pub fn picture(&self, technique: &Technique, choice: &Choice) -> Option<PathBuf> {
        let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
        let name: String = choice.name.chars().map(letter).collect();
        Some(self.pictures.as_ref()?.join(format!("{}.{name}.png", technique.name))).filter(|file| file.is_file())
    }
}

/// A choice of the frame.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Technique {
    /// Its name.
    pub name: String,
    /// What is approximated.
    pub what: String,
    /// What is taken for the truth.
    pub truth: String,
    /// Unit of errors.
    pub unit: String,
    /// In the order of their list.
    pub choices: Vec<Choice>,
}

/// An option.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Choice {
    /// Its name.
    pub name: String,
    /// The error, in the technique's unit.
    pub error: f64,
    /// Time of a whole frame; none where it was not timed.
    #[serde(default)]
    pub ms: Option<Times>,
    /// Operations of the shader's function, by kind.
    #[serde(default)]
    pub operations: Option<Vec<u32>>,
    /// Presets that have it.
    #[serde(default)]
    pub presets: Vec<String>,
}

/// A frame's time over repeats, in ms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
pub struct Times {
    /// Half is below.
    pub median: f64,
    /// Where the median lies in 95 of 100 samples drawn from the repeats: low end.
    pub low: f64,
    /// And high end.
    pub high: f64,
}

/// What choices of a technique cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Milliseconds of a whole frame.
    Ms,
    /// Operations of a function.
    Operations,
    /// Nobody knows.
    Nothing,
}

impl Technique {
    /// What costs are given in: times where all choices are timed, else operations where all are counted.
    pub fn unit_of_cost(&self) -> Unit {
        if self.choices.iter().all(|choice| choice.ms.is_some()) {
            Unit::Ms
        } else if self.choices.iter().all(|choice| choice.operations.is_some()) {
            Unit::Operations
        } else {
            Unit::Nothing
        }
    }

    /// The cost of a choice in that unit.
    pub fn cost(&self, choice: &Choice) -> f64 {
        let operations = || choice.operations.iter().flatten().map(|count| f64::from(*count)).sum();
        match self.unit_of_cost() {
            Unit::Ms => choice.ms.map_or(0.0, |ms| ms.median),
            Unit::Operations => operations(),
            Unit::Nothing => 0.0,
        }
    }

    /// For each choice whether no other is as cheap and as accurate, and better in one of both.
    pub fn front(&self) -> Vec<bool> {
        let points: Vec<[f64; 2]> = self.choices.iter().map(|choice| [self.cost(choice), choice.error]).collect();
        let beats = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
        points.iter().map(|point| !points.iter().any(|other| beats(other, point))).collect()
    }
}

/// Reads a file.
///
/// # Errors
/// A sentence: no JSON, of another version, or not what the lab writes.
pub fn read(text: &[u8]) -> Result<AccuracyData, String> {
    let told = |error| format!("the accuracy cannot be read: {error}");
    // The version first: another one has other fields.
    let Head { schema, version } = serde_json::from_slice(text).map_err(told)?;
    if (schema.as_str(), version) != (SCHEMA, VERSION) {
        return Err(format!(
            "it is `{schema}` of version {version}, and `{SCHEMA}` of version {VERSION} is read; measure anew with `accuracy` \
             (docs/accuracy.md)"
        ));
    }
    let data: AccuracyData = serde_json::from_slice(text).map_err(told)?;
    if let Some(measured) = &data.budget {
        measured.choices(&Facts::default(), |_| true).map_err(|error| format!("its `budget`: {error}"))?;
    }
    let finite = |x: f64| x.is_finite() && x >= 0.0;
    let is_sound = |choice: &Choice| finite(choice.error) && choice.ms.is_none_or(|ms| finite(ms.median));
    for technique in &data.techniques {
        if let Some(choice) = technique.choices.iter().find(|choice| !is_sound(choice)) {
            return Err(format!("{}, {}: a number is negative or none", technique.name, choice.name));
        }
    }
    Ok(data)
}
