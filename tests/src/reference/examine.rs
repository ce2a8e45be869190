//! Examination of one reference: rendering, comparison and verdict.

use super::asset::{AssetError, Sources};
use super::built::{Gaps, gaps};
use super::chart::{self, ChartError};
use super::document::{Document, DocumentError, Output};
use super::metrics::Metrics;
use super::picture::{Picture, ReadError};
use super::rule::{self, Clause, Evidence, Number, Patch, Rule};
use super::studio::{self, Shade};
use framegraph_passes::Quality;
use framegraph_wgpu::Gpu;
use program::outputs::OutputError;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// A reference cannot be examined.
#[derive(thiserror::Error)]
pub enum ExamineError {
    /// The statement is invalid.
    #[error(transparent)]
    Document(#[from] DocumentError),
    /// A model or environment is not available.
    #[error("{file}: {error}")]
    Asset {
        /// Path of the statement.
        file: PathBuf,
        /// Reason.
        error: AssetError,
    },
    /// The picture cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The chart cannot be read.
    #[error(transparent)]
    Chart(#[from] ChartError),
    /// The scene cannot be rendered.
    #[error("{file}: {reason}")]
    Render {
        /// Path of the statement.
        file: PathBuf,
        /// Reason.
        reason: String,
    },
    /// A picture cannot be written.
    #[error(transparent)]
    Write(#[from] OutputError),
    /// The picture has another size.
    #[error("{file}: files: the picture is {}×{}, and scene.resolution {}×{}", found[0], found[1], stated[0], stated[1])]
    Size {
        /// Path of the statement.
        file: PathBuf,
        /// Size of the picture, in pixels.
        found: [u32; 2],
        /// Size in the statement, in pixels.
        stated: [u32; 2],
    },
    /// The statement has neither a picture nor a chart.
    #[error("{file}: files: neither exr nor png nor csv")]
    Nothing {
        /// Path of the statement.
        file: PathBuf,
    },
}

impl std::fmt::Debug for ExamineError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Verdict on a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// All clauses of the rule hold.
    Passed,
    /// Some clauses do not hold.
    Failed(Vec<String>),
    /// Only soft clauses do not hold.
    Missed(Vec<String>),
    /// There is no rule, or its syntax is unknown.
    Unjudged(String),
    /// The statement uses features that are not implemented: their keys.
    Skipped(Vec<String>),
}

/// Result for a reference.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Identifier of the reference.
    pub id: String,
    /// Verdict.
    pub verdict: Verdict,
    /// Metrics of the picture, if there is one.
    pub metrics: Option<Metrics>,
    /// Metrics of the chart, if there is one.
    pub chart: Option<ChartNumbers>,
    /// Keys of features that are implemented differently.
    pub otherwise: Vec<String>,
    /// Negative control of a passed rule: true if the rule rejects our picture with radiance multiplied by 1.1.
    pub control: Option<bool>,
    /// Rendered picture.
    pub picture: Option<Picture>,
}

/// Metrics of a chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartNumbers {
    /// Number of patches.
    pub count: usize,
    /// Share of patches that differ by at most 2 8-bit steps, 0…1.
    pub within_2: f64,
    /// Largest difference, in 8-bit steps.
    pub worst_codes: f64,
    /// Largest relative error, if the chart has linear light.
    pub worst_relative: Option<f64>,
}

/// Options for examining references.
#[derive(Clone, Copy, Debug, Default)]
pub struct How<'a> {
    /// Shading quality.
    pub shade: Shade,
    /// Folder of assets.
    pub assets: Option<&'a Path>,
    /// Output folder of rendered pictures and differences.
    pub out: Option<&'a Path>,
}

/// Factor on radiance that every rule must detect.
const CONTROL: f32 = 1.1;

/// Reads the statement `file`, renders it, compares, and judges.
///
/// # Errors
/// [`ExamineError`]; a picture outside the tolerance is not an error.
pub fn examine(gpu: &Gpu, file: &Path, how: How<'_>) -> Result<Outcome, ExamineError> {
    let document = Document::read(file)?;
    let Gaps { missing, otherwise } = gaps(&document);
    let id = document.id.clone();
    if !missing.is_empty() {
        let verdict = Verdict::Skipped(missing);
        return Ok(Outcome { id, verdict, metrics: None, chart: None, otherwise, control: None, picture: None });
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    let reference = Reference::read(&document, file, folder)?;
    let rule = document.suggested_pass.as_deref().map(rule::parse);
    let picture = match rule.iter().flatten().find_map(|rule| rule.filtered.as_ref()) {
        Some(unfiltered) => {
            let filtered = studio::antialiased(gpu, &Picture::read(&folder.join(unfiltered))?);
            filtered.map_err(|error| ExamineError::Render { file: file.into(), reason: error.to_string() })?
        }
        None => render(gpu, &document, file, how)?,
    };
    if let Some(out) = how.out {
        write(&picture, &document, reference.picture.as_ref(), out)?;
    }
    let compared = reference.compare(&picture);
    let (verdict, control) = match rule {
        None => (Verdict::Unjudged("no rule is stated".into()), None),
        Some(Err(part)) => (Verdict::Unjudged(format!("unknown rule: {part}")), None),
        Some(Ok(Rule { clauses, soft, .. })) => {
            let failures = reference.failures(&clauses, &picture, compared.as_ref());
            let missed = reference.failures(&soft, &picture, compared.as_ref());
            if !failures.is_empty() {
                (Verdict::Failed(failures), None)
            } else if !missed.is_empty() {
                (Verdict::Missed(missed), None)
            } else {
                // Soft clauses may be too weak to detect the control.
                let noticed = (!clauses.is_empty()).then(|| reference.notices(&clauses, &picture.brighter(CONTROL)));
                (Verdict::Passed, noticed)
            }
        }
    };
    let chart = reference.chart(&picture);
    Ok(Outcome { id, verdict, metrics: compared, chart, otherwise, control, picture: Some(picture) })
}

/// Renders a statement that was read from `file`.
///
/// # Errors
/// An invalid model, or a failure of the device.
pub fn render(gpu: &Gpu, document: &Document, file: &Path, how: How<'_>) -> Result<Picture, ExamineError> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let fails = |reason: String| ExamineError::Render { file: file.into(), reason };
    let sources = Sources::of(&document.scene, folder, how.assets);
    let sources = sources.map_err(|error| ExamineError::Asset { file: file.into(), error })?;
    let sources = sources.ok_or_else(|| fails("scene.assets: no model".into()))?;
    studio::render(gpu, document, &sources, how.shade).map_err(|error| fails(error.to_string()))
}

/// Compares the picture at high quality with the one at low quality. Returns `None` if the statement uses features that
/// are not implemented.
///
/// # Errors
/// The errors of [`examine`].
pub fn between_qualities(gpu: &Gpu, file: &Path, how: How<'_>) -> Result<Option<(String, Metrics)>, ExamineError> {
    let document = Document::read(file)?;
    if !gaps(&document).missing.is_empty() {
        return Ok(None);
    }
    let [low, high] = [Quality::Low, Quality::High]
        .map(|quality| render(gpu, &document, file, How { shade: Shade::Preset(quality), ..how }));
    Ok(Metrics::of(&high?, &low?).map(|metrics| (document.id, metrics)))
}

/// Picture or chart to compare with.
struct Reference {
    picture: Option<Picture>,
    /// True if the picture has 8-bit values.
    codes: bool,
    patches: Vec<Patch>,
    centres: Vec<[f64; 2]>,
}

impl Reference {
    fn read(document: &Document, file: &Path, folder: &Path) -> Result<Self, ExamineError> {
        let files = &document.files;
        let picture = files.exr.as_ref().or(files.png.as_ref()).map(|path| Picture::read(&folder.join(path)));
        let picture = picture.transpose()?;
        let stated = document.scene.resolution;
        if let Some(found) = picture.as_ref().map(|p| p.size_px).filter(|size| *size != stated) {
            return Err(ExamineError::Size { file: file.into(), found, stated });
        }
        let coded = document.scene.output == Output::Ldr;
        let patches = files.csv.as_ref().map(|path| chart::read(&folder.join(path), coded)).transpose()?;
        if picture.is_none() && patches.is_none() {
            return Err(ExamineError::Nothing { file: file.into() });
        }
        let centres = studio::seen_at(document, &document.spheres);
        let centres = centres.map_err(|reason| ExamineError::Render { file: file.into(), reason })?;
        Ok(Self { picture, codes: files.exr.is_none(), patches: patches.unwrap_or_default(), centres })
    }

    fn compare(&self, ours: &Picture) -> Option<Metrics> {
        self.picture.as_ref().and_then(|reference| Metrics::of(&self.comparable(ours), reference))
    }

    /// Clamps linear light before comparing it with 8-bit values.
    fn comparable<'a>(&self, ours: &'a Picture) -> Cow<'a, Picture> {
        if self.codes { Cow::Owned(ours.clamped()) } else { Cow::Borrowed(ours) }
    }

    fn failures(&self, clauses: &[Clause], picture: &Picture, metrics: Option<&Metrics>) -> Vec<String> {
        let Self { patches, centres, .. } = self;
        let mut failures = rule::failures(clauses, Evidence { picture, metrics, patches, centres });
        let bad = picture.not_finite();
        if bad > 0 {
            failures.push(format!("{bad} texels are not finite"));
        }
        failures
    }

    /// Returns true if a clause rejects a picture. FLIP is by far the slowest metric and is evaluated last.
    fn notices(&self, clauses: &[Clause], wrong: &Picture) -> bool {
        let is_flip = |clause: &Clause| matches!(clause, Clause::AtMost(Number::Flip, _));
        let quick: Vec<Clause> = clauses.iter().copied().filter(|clause| !is_flip(clause)).collect();
        let metrics =
            self.picture.as_ref().and_then(|reference| Metrics::without_flip(&self.comparable(wrong), reference));
        !self.failures(&quick, wrong, metrics.as_ref()).is_empty()
            || !self.failures(clauses, wrong, self.compare(wrong).as_ref()).is_empty()
    }

    fn chart(&self, picture: &Picture) -> Option<ChartNumbers> {
        if self.patches.is_empty() {
            return None;
        }
        let count = self.patches.len();
        let off: Vec<f64> = self.patches.iter().map(|patch| rule::codes_off(picture, patch)).collect();
        let light = !self.patches[0].codes;
        let relative = || self.patches.iter().map(|patch| rule::patch_relative(picture, patch)).fold(0.0, f64::max);
        Some(ChartNumbers {
            count,
            within_2: off.iter().filter(|o| **o <= 2.0).count() as f64 / count as f64,
            worst_codes: off.into_iter().fold(0.0, f64::max),
            worst_relative: light.then(relative),
        })
    }
}

/// Writes `ID.png`, `ID.exr` for linear light, and `ID.difference.png`.
fn write(picture: &Picture, document: &Document, reference: Option<&Picture>, out: &Path) -> Result<(), OutputError> {
    // Identifiers may have characters that are invalid in file names.
    let name: String =
        document.id.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
    picture.write_png(&out.join(format!("{name}.png")))?;
    if document.scene.output == Output::Linear {
        picture.write_exr(&out.join(format!("{name}.exr")))?;
    }
    if let Some(reference) = reference {
        picture.difference(reference).write_png(&out.join(format!("{name}.difference.png")))?;
    }
    Ok(())
}
