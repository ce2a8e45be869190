//! Techniques: a setting with its options, reference and metric.

use super::record::TechniqueRecord;
use super::studio::{Setup, Truth};
use framegraph_passes::{FrameSettings, Preset};
use framegraph_wgpu::Gpu;
use std::error::Error;
use std::fmt;

/// Result of a measurement; errors are displayed as they are.
pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// Measured error of an option.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Error, in the technique's unit.
    pub error: f64,
    /// Mean of the signed error, if measured.
    pub bias: Option<f64>,
    /// Standard deviation of values that should be equal, if measured.
    pub noise: Option<f64>,
    /// Standard error of the reference, in the same unit. An error below three times this value is not significant.
    pub truth_error: f64,
}

impl Measured {
    /// Creates an error measured against an exact reference.
    pub fn exact(error: f64) -> Self {
        Self { error, ..Self::default() }
    }
}

/// Method by which an option's error is measured.
pub enum Subject {
    /// Compares its picture with the technique's reference: root mean square in 8-bit steps.
    Picture,
    /// Computes the error by a function.
    Formula(Box<dyn Fn(&Gpu) -> Outcome<Measured>>),
}

impl fmt::Debug for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Picture => "Picture",
            Self::Formula(_) => "Formula",
        })
    }
}

/// An option of a technique.
#[derive(Debug)]
pub struct Choice {
    /// Name in tables and files.
    pub name: String,
    /// Method by which the error is measured.
    pub subject: Subject,
    /// Frame with this option, which is timed and, for pictures, compared. `None` if no setting selects the option.
    pub setup: Option<Setup>,
    /// Functions of the shader library whose operations are counted and summed, each with true for its f16 build.
    pub functions: Vec<(&'static str, bool)>,
    /// Returns true if a preset uses this option.
    pub is_in: fn(&FrameSettings) -> bool,
}

/// A setting of the frame.
#[derive(Debug)]
pub struct Technique {
    /// Name for the command line, files and tables: lower case, words joined by `-`.
    pub name: String,
    /// Description of the approximation and the metric, one sentence.
    pub what: String,
    /// Description of the reference, one sentence.
    pub truth: String,
    /// Unit of errors.
    pub unit: String,
    /// Reference of pictures.
    pub picture: Option<Truth>,
    /// The options.
    pub choices: Vec<Choice>,
}

impl Technique {
    /// Replaces the scene of all frames.
    pub fn show(&mut self, scene: &'static str) {
        if let Some(Truth::Frame(setup) | Truth::Supersampled(setup, _) | Truth::Suns(setup, _)) = &mut self.picture {
            setup.scene = scene;
        }
        self.choices.iter_mut().filter_map(|choice| choice.setup.as_mut()).for_each(|setup| setup.scene = scene);
    }

    /// Records which presets use each option.
    pub fn note_presets(&self, record: &mut TechniqueRecord) {
        for found in &mut record.choices {
            let own = self.choices.iter().find(|choice| choice.name == found.name);
            let has = |preset: &Preset| own.is_some_and(|choice| (choice.is_in)(&preset.frame()));
            found.presets = Preset::ALL.into_iter().filter(has).map(|preset| preset.name().to_owned()).collect();
        }
    }
}
