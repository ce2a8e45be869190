//! What is measured: a choice with its options, its truth, its metric.

use super::record::TechniqueRecord;
use super::studio::{Setup, Truth};
use framegraph_passes::{FrameSettings, Preset};
use framegraph_wgpu::Gpu;
use std::error::Error;
use std::fmt;

/// What goes wrong is told in its own words.
pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// An error with its parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// The error, in the technique's unit.
    pub error: f64,
    /// Mean of the signed error, where that is told apart.
    pub bias: Option<f64>,
    /// Deviation from place to place of what should be the same, where that is told apart.
    pub noise: Option<f64>,
    /// Standard error of the truth, in the same unit: a claim below three times it is void.
    pub truth_error: f64,
}

impl Measured {
    /// Against a truth that is exact.
    pub fn exact(error: f64) -> Self {
        Self { error, ..Self::default() }
    }
}

/// How an option's error is found.
pub enum Subject {
    /// Its picture against the technique's truth: root mean square in codes of 255.
    Picture,
    /// A number of its own.
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

/// One way of doing it.
#[derive(Debug)]
pub struct Choice {
    /// For tables and files.
    pub name: String,
    /// How its error is found.
    pub subject: Subject,
    /// A frame that does it so: what is timed, and for pictures what is compared. None where no setting says so.
    pub setup: Option<Setup>,
    /// Functions of the shader library whose operations are counted and added up, each with whether it is in f16.
    pub functions: Vec<(&'static str, bool)>,
    /// Whether a preset's frame does it so.
    pub is_in: fn(&FrameSettings) -> bool,
}

/// A choice of the frame.
#[derive(Debug)]
pub struct Technique {
    /// For the command line, files and tables: lower case, words joined by `-`.
    pub name: String,
    /// What is approximated, and the metric, in a sentence.
    pub what: String,
    /// What is taken for the truth, in a sentence.
    pub truth: String,
    /// Unit of errors.
    pub unit: String,
    /// The picture that pictures are compared with.
    pub picture: Option<Truth>,
    /// The ways of doing it.
    pub choices: Vec<Choice>,
}

impl Technique {
    /// Draws another scene in all of its frames.
    pub fn show(&mut self, scene: &'static str) {
        if let Some(Truth::Frame(setup) | Truth::Supersampled(setup, _) | Truth::Suns(setup, _)) = &mut self.picture {
            setup.scene = scene;
        }
        self.choices.iter_mut().filter_map(|choice| choice.setup.as_mut()).for_each(|setup| setup.scene = scene);
    }

    /// Notes in what was measured which presets have each option.
    pub fn note_presets(&self, record: &mut TechniqueRecord) {
        for found in &mut record.choices {
            let own = self.choices.iter().find(|choice| choice.name == found.name);
            let has = |preset: &Preset| own.is_some_and(|choice| (choice.is_in)(&preset.frame()));
            found.presets = Preset::ALL.into_iter().filter(has).map(|preset| preset.name().to_owned()).collect();
        }
    }
}
