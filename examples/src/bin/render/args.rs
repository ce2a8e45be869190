//! Command line of `render`.

use crate::animation::AnimationTime;
use crate::budget::Budget;
use crate::debug::Debugging;
use crate::decide::{self, Decide};
use crate::effects::Effects;
use crate::explicit::ExplicitOptions;
use crate::grade::Grade;
use crate::help;
use crate::light::Lighting;
use crate::name::{plan_files, with_ending};
use crate::parse::{field, fields, precision};
use crate::shadows::Shadows;
use crate::values::{alias, camera, frames, memory, size, threads};
use framegraph::Alias;
use framegraph_passes::{Effect, FrameSettings, Precision, Settings};
use framegraph_scene::{BlockFormats, CameraChoice, LoadOptions, Memory};
use program::cli::Parsed;
use std::ffi::OsString;
use std::path::PathBuf;

/// Parsed options of a run.
#[derive(Clone, Debug)]
pub struct Args {
    /// Name of a built-in scene, or path of a file.
    pub scene: String,
    /// Picture width and height in pixels.
    pub size_px: [u32; 2],
    /// Camera; `None` selects the first camera of the scene, or else an orbit.
    pub camera: Option<CameraChoice>,
    /// Requires a camera of the file.
    pub camera_from_gltf: bool,
    /// Settings of the frame, without shadows.
    pub frame: FrameSettings,
    /// Environment, sun, background and exposure.
    pub lighting: Lighting,
    /// Table of color grading.
    pub grade: Grade,
    pub alias: Alias,
    /// Number of recording threads; 0 for the number of cores.
    pub threads: usize,
    /// Rounds inlined radiance to the precision of the HDR format.
    pub round_hdr: bool,
    /// Compares the costs of post-processing instead of rendering a picture.
    pub compare_post: bool,
    /// Shadow options.
    pub shadows: Shadows,
    /// Lens dirt and dynamic resolution.
    pub effects: Effects,
    /// File of the frame's settings.
    pub settings: Option<PathBuf>,
    /// Enabled and disabled effects, and additional outputs.
    pub decide: Decide,
    /// Name of the material variant.
    pub variant: Option<String>,
    /// Animation and its time.
    pub animation: AnimationTime,
    /// Number of measured frames.
    pub frames: u32,
    /// Path of the picture.
    pub out: PathBuf,
    /// Path of the linear radiance.
    pub linear_out: Option<PathBuf>,
    /// Path of the plan as text; `None` if the picture goes to a pipe or device and no path was specified.
    pub plan: Option<PathBuf>,
    /// Path of the plan as a graph; `None` if the text goes to a pipe or device.
    pub dot: Option<PathBuf>,
    /// Memory limit of loading in bytes; `None` for half of the machine's memory.
    pub memory_bytes: Option<u64>,
    /// Allows files outside the folder of the scene.
    pub allow_outside: bool,
    /// Inspection and bisection.
    pub debug: Debugging,
    /// Time or error limit of the frame.
    pub budget: Budget,
    /// Folder for the error by source.
    pub explain_error: Option<PathBuf>,
    /// Options of the frame to compare with.
    pub compare_with: Option<String>,
    /// All words of the command line, without the program name.
    pub words: Vec<OsString>,
    /// Set for the candidate frames of a budget search, which print no messages about the scene.
    pub trial: bool,
}

impl Args {
    /// Returns the loading options for a device that samples `block_formats`.
    ///
    /// Call it once: everything loaded with the result shares one memory budget.
    pub fn load_options(&self, block_formats: BlockFormats) -> LoadOptions {
        let memory = self.memory_bytes.map_or_else(Memory::default, Memory::new);
        LoadOptions {
            memory: memory.into(),
            allow_outside: self.allow_outside,
            variant: self.variant.clone(),
            block_formats,
            ..LoadOptions::default()
        }
    }
}

/// Parsed command line.
#[derive(Clone, Debug)]
pub enum Command {
    /// Print the help, or the keys of an option.
    Help(String),
    /// Render.
    Render(Box<Args>),
}

/// Parses the command line; `args` excludes the program name.
///
/// # Errors
/// One line that names the option and the expected value.
pub fn parse(args: impl IntoIterator<Item = OsString>) -> Result<Command, String> {
    let words: Vec<OsString> = args.into_iter().collect();
    let given = match program::cli::parse(help::command(), words.clone())? {
        Parsed::Help(text) => return Ok(Command::Help(text)),
        Parsed::Given(given) => given,
    };
    let (frame, settings) = decide::base(&given)?;
    let explicit = ExplicitOptions::of(&given);
    let mut found = Args {
        scene: String::new(),
        size_px: [1280, 720],
        camera: None,
        camera_from_gltf: false,
        frame: FrameSettings { settings: Settings { samples: 4, ..Settings::DEFAULT }, ..FrameSettings::DEFAULT },
        lighting: Lighting::default(),
        grade: Grade::default(),
        alias: Alias::Pool,
        threads: 0,
        round_hdr: false,
        compare_post: false,
        shadows: Shadows::default(),
        effects: Effects::default(),
        settings,
        decide: Decide::default(),
        variant: None,
        animation: AnimationTime::default(),
        frames: 8,
        out: PathBuf::from("render.png"),
        linear_out: None,
        plan: None,
        dot: None,
        memory_bytes: None,
        allow_outside: false,
        debug: Debugging::default(),
        budget: Budget::default(),
        explain_error: None,
        compare_with: None,
        words,
        trial: false,
    };
    if let Some(frame) = frame {
        (found.frame, found.shadows) = (frame, Shadows::with(frame.settings.shadows));
    }
    let mut plan: Option<PathBuf> = None;
    let mut shade = String::new();
    let mut numbers: Option<Precision> = None;
    for item in given {
        if item.raw() == "help"
            && let Some(keys) = help::keys(item.name())
        {
            return Ok(Command::Help(keys));
        }
        match item.name() {
            "SCENE" => found.scene = item.text()?,
            "size" => found.size_px = size(&item)?,
            "camera" => found.camera = Some(camera(&item.text()?)?),
            "camera-from-gltf" => found.camera_from_gltf = true,
            "shade" => shade = item.text()?,
            "precision" => numbers = Some(precision(&item)?),
            "quality" | "inline" => field(&item, &mut found.frame)?,
            "msaa" => field(&item, &mut found.frame.settings)?,
            "compensation" | "vignette" | "dither" => field(&item, &mut found.frame.settings.post)?,
            "alias" => found.alias = alias(&item)?,
            "threads" => found.threads = threads(&item)?,
            "round-hdr" => found.round_hdr = true,
            "split-post" => found.frame.settings.split_post = true,
            "compare-post" => found.compare_post = true,
            "no-fxaa" => found.frame.settings.fxaa = false,
            "frames" => found.frames = frames(&item)?,
            "out" => found.out = with_ending(item.raw().into(), "--out", &["png"])?,
            "linear-out" => found.linear_out = Some(with_ending(item.raw().into(), "--linear-out", &["exr"])?),
            "memory" => found.memory_bytes = Some(memory(&item)?),
            "variant" => found.variant = Some(item.text()?),
            "explain-error" => found.explain_error = Some(item.raw().into()),
            "compare-with" => found.compare_with = Some(item.text()?),
            "allow-outside" => found.allow_outside = true,
            "plan" => plan = Some(item.raw().into()),
            name => {
                let taken = found.lighting.take(&item)?
                    || found.shadows.take(&item)?
                    || found.animation.take(&item)?
                    || found.grade.take(&mut found.frame.settings.post, &item)?
                    || found.decide.take(&item)?
                    || found.budget.take(&item)?
                    || found.debug.take(&item)?
                    || found.effects.take(&mut found.frame, &item)?;
                if !taken {
                    return Err(format!("internal error: no module has --{name}"));
                }
            }
        }
    }
    if found.scene.is_empty() {
        found.scene = "spheres".into();
    }
    if let (true, Some(CameraChoice::Orbit | CameraChoice::LookAt { .. })) = (found.camera_from_gltf, &found.camera) {
        return Err(
            "--camera-from-gltf: --camera does not name a camera of the file; name one, or remove one of both options"
                .into(),
        );
    }
    explicit.check(&found)?;
    found.keep_linear()?;
    found.grade.check(&found.frame.settings.post)?;
    let shading = &mut found.frame.settings.shading;
    if explicit.has("quality") {
        *shading = found.frame.quality.shading();
    }
    fields("shade", &shade, shading)?;
    shading.precision = numbers.unwrap_or(shading.precision);
    if found.compare_post && !explicit.has("size") {
        found.size_px = [1920, 1080];
    }
    (found.plan, found.dot) = plan_files(plan, &found.out);
    Ok(Command::Render(Box::new(found)))
}

impl Args {
    /// Keeps the half-float HDR format for `--linear-out`, because 8-bit values would be clipped at 1.
    fn keep_linear(&mut self) -> Result<(), String> {
        if self.linear_out.is_none() {
            return Ok(());
        }
        if self.decide.disabled.contains(Effect::HdrTarget) {
            return Err(
                "--linear-out: without hdr-target, values above 1 are clipped; remove --disable hdr-target or \
                        --linear-out"
                    .into(),
            );
        }
        self.decide.enabled = self.decide.enabled.with(Effect::HdrTarget);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_passes::LightSearch;

    fn args(words: &[&str]) -> Result<Args, String> {
        match parse(words.iter().map(OsString::from))? {
            Command::Render(args) => Ok(*args),
            Command::Help(_) => Err("help".into()),
        }
    }

    #[test]
    fn defaults_need_no_file() {
        let found = args(&[]).expect("no argument is needed");
        assert_eq!((found.scene.as_str(), found.size_px, found.frame.settings.samples), ("spheres", [1280, 720], 4));
        assert_eq!((found.plan, found.dot), (Some("render.plan.txt".into()), Some("render.plan.dot".into())));
    }

    #[test]
    fn effects_are_set_by_their_options() {
        let found = |words: &[&str]| args(words).map(|found| found.frame);
        let lights = |words: &[&str]| found(words).map(|frame| frame.lights);
        assert_eq!((lights(&[]), lights(&["--lights", "all"])), (Ok(LightSearch::default()), Ok(LightSearch::All)));
        let fog = |words: &[&str]| found(words).map(|frame| frame.settings.fog.map(|fog| fog.density));
        assert_eq!((fog(&[]), fog(&["--fog", "on:density=0.5"])), (Ok(None), Ok(Some(0.5))));
        assert_eq!(fog(&["--preset", "ultra", "--fog", "off"]), Ok(None));
        let preset = found(&["--preset", "low"]);
        assert_eq!(preset, Ok(framegraph_passes::Preset::Low.frame()));
    }

    #[test]
    fn former_names_of_options_are_valid() {
        let costs = |option: &str| args(&[option]).map(|found| found.decide.effect_costs);
        assert_eq!((costs("--effect-costs"), costs("--what-it-costs")), (Ok(true), Ok(true)));
        let both = args(&["--effect-costs", "--what-it-costs"]).map(drop);
        assert_eq!(both, Err("--effect-costs: specified twice; remove one".into()));
        for name in ["punctual-shadows", "lamp-shadows"] {
            let conflict = args(&["--no-shadows", "--enable", name]).map(drop);
            assert!(conflict.is_err_and(|error| error.starts_with("--enable punctual-shadows: cannot")), "{name}");
        }
    }

    #[test]
    fn post_processing_is_compared_at_full_hd_by_default() {
        let size = |words: &[&str]| args(words).map(|found| found.size_px);
        assert_eq!(size(&["--compare-post"]), Ok([1920, 1080]));
        assert_eq!(size(&["--size", "64x32", "--compare-post"]), Ok([64, 32]));
    }

    /// `--linear-out` keeps the half-float format, independent of feature culling and of the order of options.
    #[test]
    fn a_linear_picture_keeps_its_half_floats() {
        let kept = |words: &[&str]| args(words).map(|found| found.decide.enabled.contains(Effect::HdrTarget));
        assert_eq!(kept(&[]), Ok(false));
        assert_eq!(kept(&["--linear-out", "a.exr"]), Ok(true));
        assert_eq!(kept(&["--disable", "fxaa", "--linear-out", "a.exr"]), Ok(true));
        assert_eq!(kept(&["--disable", "hdr-target"]), Ok(false));
    }

    #[test]
    fn options_of_another_frame_are_a_value() {
        for words in [&["--compare-with", "--no-fxaa"][..], &["--compare-with=--no-fxaa"]] {
            let found = args(words).map(|found| (found.compare_with, found.frame.settings.fxaa));
            assert_eq!(found, Ok((Some("--no-fxaa".into()), true)), "{words:?}");
        }
    }

    #[test]
    fn the_plan_has_a_neighbour() {
        let found = args(&["--plan", "a/b.txt"]).expect("a sound command line");
        assert_eq!((found.plan, found.dot), (Some("a/b.txt".into()), Some("a/b.dot".into())));
        let found = args(&["--plan=a/b.dot"]).expect("a sound command line");
        assert_eq!((found.plan, found.dot), (Some("a/b.txt".into()), Some("a/b.dot".into())));
    }

    #[test]
    fn invalid_options_are_reported_in_one_line() {
        let cases: [(&[&str], &str); 48] = [
            (&["--threads", "0"], "--threads 0"),
            (&["--size", "0x0"], "--size 0x0"),
            (&["--size", "12"], "--size 12"),
            (&["--size", "-1x5"], "--size -1x5"),
            (&["--size"], "--size"),
            (&["--msaa", "3"], "--msaa 3"),
            (&["--ev100", "NaN"], "--ev100 NaN"),
            (&["--ev100", "99"], "--ev100 99"),
            (&["--tone-map", "sepia"], "--tone-map sepia"),
            (&["--inline", "maybe"], "--inline maybe"),
            (&["--lod", "17"], "--lod 17"),
            (&["--layers", "256"], "--layers 256"),
            (&["--layers", "0b102"], "--layers 0b102"),
            (&["--alias", "heaps"], "--alias heaps"),
            (&["--quality", "best"], "--quality best"),
            (&["--precision", "f64"], "--precision f64"),
            (&["--shade", "gloss=1"], "--shade gloss"),
            (&["--shade", "bands=3,floor"], "--shade floor"),
            (&["--vignette", "-1"], "--vignette -1"),
            (&["--grade", "hue=1"], "--grade hue"),
            (&["--ao", "ssao"], "--ao ssao"),
            (&["--ao", "sao:gloss=1"], "--ao gloss"),
            (&["--lights", "some"], "--lights some: "),
            (&["--lights", "froxels:far=1"], "--lights near=5: expected less than `far`"),
            (&["--transparency", "exact"], "--transparency exact: unknown choice"),
            (&["--transparency", "peeled:layers=0"], "--transparency layers=0"),
            (&["--glass-layers", "0"], "--glass-layers 0"),
            (&["--glass-layers", "5"], "--glass-layers 5"),
            (&["--ssr", "maybe"], "--ssr maybe"),
            (&["--ssr", "on:stride=0"], "--ssr stride=0"),
            (&["--fog", "on:density=x"], "--fog density=x"),
            (&["--taa", "on:feedback=2"], "--taa feedback=2"),
            (&["--dynamic-resolution", "9:10"], "--dynamic-resolution 9:10"),
            (&["--time", "-1"], "--time -1"),
            (&["--budget-ms", "0"], "--budget-ms 0"),
            (&["--max-error", "NaN"], "--max-error NaN"),
            (&["--record", "a.txt", "--budget-ms", "9"], "--record a.txt"),
            (&["--camera", "1,2:3"], "--camera"),
            (&["--camera", "orbit", "--camera-from-gltf"], "--camera-from-gltf"),
            (&["--out", "a.jpg"], "--out a.jpg"),
            (&["--linear-out", "a.png"], "--linear-out a.png"),
            (&["--linear-out", "a.exr", "--disable", "hdr-target"], "--linear-out: without hdr-target"),
            (&["--disable", "hdr-target", "--linear-out=a.exr"], "remove --disable hdr-target"),
            (&["--frames", "0"], "--frames 0"),
            (&["--memory", "0MiB"], "--memory 0MiB"),
            (&["--size", "1x1", "--size=2x2"], "--size: specified twice"),
            (&["--colour"], "--colour"),
            (&["spheres", "columns"], "columns"),
        ];
        for (words, named) in cases {
            let error = args(words).expect_err("the command line is invalid");
            assert!(error.contains(named) && !error.contains('\n'), "{words:?}: {error}");
        }
    }
}
