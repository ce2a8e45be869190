//! What was measured, as a file: `accuracy.json`.

use super::statistics::{Times, undominated};
use framegraph_passes::budget::Measured;
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::path::Path;

/// The file's `schema`.
pub const SCHEMA: &str = "framegraph-accuracy";
/// Its `version`: another one is not read.
pub const VERSION: u32 = 2;

/// How often each choice is drawn to be timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rounds {
    /// Frames before any is timed.
    pub warm_up: u32,
    /// Timed frames.
    pub timed: u32,
}

impl Rounds {
    /// Those of a record that others are to rely on.
    pub const FULL: Self = Self { warm_up: 10, timed: 31 };
    /// Those of the short run: the order of options that differ by a tenth or more.
    pub const QUICK: Self = Self { warm_up: 3, timed: 11 };
}

/// All that was measured in one place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// [`SCHEMA`].
    pub schema: String,
    /// [`VERSION`].
    pub version: u32,
    /// Adapter, driver and interface.
    pub adapter: String,
    /// Pictures whose frames are timed, in pixels.
    pub size_px: [u32; 2],
    /// Processors, and how many tasks wanted one when the measuring began, over a minute.
    pub load: [f64; 2],
    /// Frames of each choice that are drawn before any is timed.
    pub warm_up: u32,
    /// Timed frames of each choice, interleaved with those of the others in random order.
    pub repeats: u32,
    /// The scene of all pictures; none where each technique has its own.
    pub scene: Option<String>,
    /// Whether it is the short run.
    pub quick: bool,
    /// Whether the program was optimized; one that is not takes longer about every frame.
    pub optimized: bool,
    /// In the order of their list.
    pub techniques: Vec<TechniqueRecord>,
    /// What frames are chosen from within a budget; none until all of it is measured.
    pub budget: Option<Measured>,
}

/// A choice of the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TechniqueRecord {
    /// Its name.
    pub name: String,
    /// What is approximated.
    pub what: String,
    /// What is taken for the truth.
    pub truth: String,
    /// Unit of errors.
    pub unit: String,
    /// In the order of their list.
    pub choices: Vec<ChoiceRecord>,
}

/// An option.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChoiceRecord {
    /// Its name.
    pub name: String,
    /// The error, in the technique's unit.
    pub error: f64,
    /// Mean of the signed error.
    pub bias: Option<f64>,
    /// Deviation of what should be the same.
    pub noise: Option<f64>,
    /// Standard error of the truth.
    pub truth_error: f64,
    /// What else a picture's difference comes to.
    pub picture: Option<PictureRecord>,
    /// Time of a whole frame.
    pub ms: Option<Times>,
    /// Of a frame, where the device has a clock of its own.
    pub steps: Vec<StepRecord>,
    /// Arithmetic, transcendental, texture and conversion operations of the shader's function.
    pub operations: Option<[u32; 4]>,
    /// Presets that have it.
    pub presets: Vec<String>,
}

/// Time of a step of a frame by the device's clock, in ms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepRecord {
    /// Names of its passes, joined by ` + `.
    pub passes: String,
    /// The least.
    pub min: f64,
    /// A quarter is below.
    pub p25: f64,
    /// Half is below.
    pub median: f64,
}

/// A picture against the truth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PictureRecord {
    /// The largest difference of a channel, in codes.
    pub worst: f64,
    /// What a thousandth of the channels exceeds, in codes.
    pub p999: f64,
    /// Peak signal-to-noise ratio in dB; none for equal pictures.
    pub psnr_db: Option<f64>,
    /// Mean FLIP.
    pub flip: f64,
    /// Mean of squares over (truth² + 0.01), of linear light.
    pub relative_mse: f64,
}

/// What every version begins with.
#[derive(Deserialize)]
struct Head {
    schema: String,
    version: u32,
}

impl ChoiceRecord {
    /// Whether the truth is not known well enough to say so: the error is below three of its standard errors.
    pub fn is_void(&self) -> bool {
        self.truth_error > 0.0 && self.error < 3.0 * self.truth_error
    }
}

impl TechniqueRecord {
    /// For each choice whether no other beats it: in time where all are timed, else in operations, else by error alone.
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
    /// How often its choices were drawn.
    pub fn rounds(&self) -> Rounds {
        Rounds { warm_up: self.warm_up, timed: self.repeats }
    }

    /// Reads one.
    ///
    /// # Errors
    /// With the file's name, when it is missing, no such record, or of another version.
    pub fn read(path: &Path) -> Result<Self, Box<dyn Error>> {
        let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let told = |error| format!("{}: {error}", path.display());
        // The version first: another one has other fields.
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

    /// Whether what one has measured may stand beside what the other has: all is the same but the results, and how busy the
    /// machine was.
    pub fn is_of_the_kind_of(&self, other: &Self) -> bool {
        let kind = |of: &Self| Self { load: [0.0; 2], techniques: Vec::new(), budget: None, ..of.clone() };
        kind(self) == kind(other)
    }

    /// As a file, a line each number of lines long that a person can read.
    ///
    /// # Errors
    /// When a number is none, which JSON has no word for.
    pub fn json(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}
