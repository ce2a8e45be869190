//! What each choice of the frame errs by and takes, as the lab of accuracy writes it (`accuracy.json`, `docs/accuracy.md`).

use serde::Deserialize;

/// The file's `schema`.
pub const SCHEMA: &str = "framegraph-accuracy";

/// All that was measured in one place. Fields that no view shows are not read, so files of later versions open too.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct AccuracyData {
    schema: String,
    /// Adapter, driver and interface.
    pub adapter: String,
    /// Pictures whose frames were timed, in pixels.
    pub size_px: [u32; 2],
    /// In the order of their list.
    pub techniques: Vec<Technique>,
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

    /// The most accurate choice that takes at most so many milliseconds more than the fastest, of those that are as accurate the
    /// fastest; none where choices are not timed.
    pub fn within(&self, more_ms: f64) -> Option<usize> {
        let timed = || self.choices.iter().enumerate().filter_map(|(i, c)| Some((i, c.error, c.ms?.median)));
        if self.unit_of_cost() != Unit::Ms {
            return None;
        }
        let least = timed().map(|(.., ms)| ms).fold(f64::INFINITY, f64::min);
        let fits = timed().filter(|(.., ms)| *ms <= least + more_ms);
        fits.min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2))).map(|(index, ..)| index)
    }
}

/// Reads a file.
///
/// # Errors
/// A sentence: no JSON, or not what the lab writes.
pub fn read(text: &[u8]) -> Result<AccuracyData, String> {
    let data: AccuracyData = serde_json::from_slice(text).map_err(|e| format!("the accuracy cannot be read: {e}"))?;
    if data.schema != SCHEMA {
        return Err(format!(
            "it is `{}`, and `{SCHEMA}` is read; `accuracy` writes it (docs/accuracy.md)",
            data.schema
        ));
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
