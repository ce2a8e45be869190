//! Measurements as a file: `accuracy.json`.

use super::statistics::{Times, undominated};
use framegraph_passes::quality::Measured;
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::path::Path;

/// Value of `schema` in the file.
pub const SCHEMA: &str = "framegraph-accuracy";
/// Value of `version` in the file; other versions are rejected.
pub const VERSION: u32 = 2;

/// Number of frames per option.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rounds {
    /// Frames before timing starts.
    pub warm_up: u32,
    /// Timed frames.
    pub timed: u32,
}

impl Rounds {
    /// Frames of a complete record.
    pub const FULL: Self = Self { warm_up: 10, timed: 31 };
    /// Frames of the short run, enough to order options that differ by a tenth or more.
    pub const QUICK: Self = Self { warm_up: 3, timed: 11 };
}

/// All measurements on one adapter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// [`SCHEMA`].
    pub schema: String,
    /// [`VERSION`].
    pub version: u32,
    /// Adapter, driver and backend.
    pub adapter: String,
    /// Size of timed pictures, in pixels.
    pub size_px: [u32; 2],
    /// Number of processors, and the load average over one minute at the start.
    pub load: [f64; 2],
    /// Frames per option before timing starts.
    pub warm_up: u32,
    /// Timed frames per option, interleaved in random order.
    pub repeats: u32,
    /// Scene of all pictures; `None` if each technique uses its own.
    pub scene: Option<String>,
    /// True for the short run.
    pub quick: bool,
    /// True if the program was built with optimizations.
    pub optimized: bool,
    /// Techniques, in the order of their list.
    pub techniques: Vec<TechniqueRecord>,
    /// Measurements for budgets; `None` until they are complete.
    pub budget: Option<Measured>,
}

/// A technique: a setting of the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TechniqueRecord {
    /// Name of the technique.
    pub name: String,
    /// Description of the approximation.
    pub what: String,
    /// Description of the reference.
    pub truth: String,
    /// Unit of errors.
    pub unit: String,
    /// Options, in the order of their list.
    pub choices: Vec<ChoiceRecord>,
}

/// An option of a technique.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChoiceRecord {
    /// Name of the option.
    pub name: String,
    /// Error, in the technique's unit.
    pub error: f64,
    /// Mean of the signed error.
    pub bias: Option<f64>,
    /// Standard deviation of values that should be equal.
    pub noise: Option<f64>,
    /// Standard error of the reference.
    pub truth_error: f64,
    /// Further metrics of a picture.
    pub picture: Option<PictureRecord>,
    /// Time of a whole frame.
    pub ms: Option<Times>,
    /// GPU times of the frame's steps, if the device has timestamps.
    pub steps: Vec<StepRecord>,
    /// Counts of arithmetic, transcendental, texture and conversion operations in the shader's function.
    pub operations: Option<[u32; 4]>,
    /// Presets that use the option.
    pub presets: Vec<String>,
}

/// GPU time of a step, in ms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepRecord {
    /// Names of the step's passes, joined by ` + `.
    pub passes: String,
    /// Minimum.
    pub min: f64,
    /// First quartile.
    pub p25: f64,
    /// Median.
    pub median: f64,
}

/// Metrics of a picture compared to the reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PictureRecord {
    /// Largest difference of a channel, in 8-bit steps.
    pub worst: f64,
    /// Difference that 0.1 % of the channels exceed, in 8-bit steps.
    pub p999: f64,
    /// Peak signal-to-noise ratio in dB; `None` for equal pictures.
    pub psnr_db: Option<f64>,
    /// Mean FLIP error.
    pub flip: f64,
    /// Mean of squared differences divided by (reference² + 0.01), of linear radiance.
    pub relative_mse: f64,
}

/// Fields that every version starts with.
#[derive(Deserialize)]
struct Head {
    schema: String,
    version: u32,
}

impl ChoiceRecord {
    /// Returns true if the error is below three standard errors of the reference, and thus not significant.
    pub fn is_void(&self) -> bool {
        self.truth_error > 0.0 && self.error < 3.0 * self.truth_error
    }
}

impl TechniqueRecord {
    /// Marks the Pareto-optimal options: by time if all are timed, otherwise by operations, otherwise by error alone.
    pub fn front(&self) -> Vec<bool> {
        let timed = self.choices.iter().all(|choice| choice.ms.is_some());
        let point = |choice: &ChoiceRecord| {
            let operations = choice.operations.map_or(0.0, |parts| f64::from(parts.iter().sum::<u32>()));
            [choice.ms.filter(|_| timed).map_or(operations, |ms| ms.median), choice.error]
        };
        undominated(&self.choices.iter().map(point).collect::<Vec<_>>())
    }
}

impl Record {
    /// Returns the number of frames per option.
    pub fn rounds(&self) -> Rounds {
        Rounds { warm_up: self.warm_up, timed: self.repeats }
    }

    /// Reads a record from a file.
    ///
    /// # Errors
    /// A missing file, another schema or another version; the message names the file.
    pub fn read(path: &Path) -> Result<Self, Box<dyn Error>> {
        let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let told = |error| format!("{}: {error}", path.display());
        // The version is read first, since other versions have other fields.
        let Head { schema, version } = serde_json::from_str(&text).map_err(told)?;
        if schema != SCHEMA || version != VERSION {
            return Err(format!(
                "{}: it is {schema} of version {version}, and {SCHEMA} of version {VERSION} is read; measure anew",
                path.display()
            )
            .into());
        }
        Ok(serde_json::from_str(&text).map_err(told)?)
    }

    /// Returns true if two records can be combined: everything but the results and the load is equal.
    pub fn is_of_the_kind_of(&self, other: &Self) -> bool {
        let kind = |of: &Self| Self { load: [0.0; 2], techniques: Vec::new(), budget: None, ..of.clone() };
        kind(self) == kind(other)
    }

    /// Returns the file's text, with each array of numbers on one line.
    ///
    /// # Errors
    /// A value is NaN or infinite, which JSON cannot express.
    pub fn json(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}
