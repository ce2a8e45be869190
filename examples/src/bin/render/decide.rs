//! Options of the whole frame: presets, settings files, and feature culling.

use crate::load::Loaded;
use framegraph::Caps;
use framegraph_passes::effects::exposure::Measurement;
use framegraph_passes::feature_culling::{EnvironmentSummary, SceneSummary, decide};
use framegraph_passes::gpu_scene::view::ViewSettings;
use framegraph_passes::light::ibl::ImageLight;
use framegraph_passes::{Effect, EffectSet, FactInput, FactMemory, Facts, FrameSettings, Preset, Settings};
use framegraph_scene::Scene;
use program::clap::{Arg, ArgAction};
use program::cli::{Given, Item, flag, option};
use program::input;
use std::path::{Path, PathBuf};

/// Declares the options of this module.
pub fn options() -> Vec<Arg> {
    let effects = Effect::ALL.map(Effect::name).join(", ");
    let all = vec![
        option(
            "preset",
            "NAME",
            "Settings of the whole frame: low, medium, high or ultra (docs/reference/settings.md); other options \
             override them. With --record, the preset's options are chosen from the record",
        ),
        option(
            "settings",
            "FILE.ron",
            "Settings of the whole frame from a file (docs/reference/settings.md); other options override them",
        ),
        option("enable", "EFFECT", "Always draw the effect, at its default strength; repeatable")
            .action(ArgAction::Append),
        option("disable", "EFFECT", format!("Never draw the effect; repeatable. EFFECT is one of {effects}"))
            .action(ArgAction::Append),
        flag(
            "force-effects",
            "Draw every requested effect. By default, effects that provably change nothing in this scene are \
             dropped, and listed with their reasons after the table (docs/design/feature-culling.md)",
        ),
        option("facts", "FILE.json", "Write the decision on each effect"),
        flag(
            "effect-costs",
            "Also print the cost of each effect: the frame with and without it, measured alternately, all other \
             decisions unchanged. Times are medians of --frames, from recording to completion",
        )
        .alias("what-it-costs"),
        option(
            "graph",
            "FILE.ron",
            "Write the graph of the frame, for the program `plan` (docs/reference/graph-format.md)",
        ),
        option(
            "what-if",
            "DEVICE",
            format!(
                "Compare the plan's counts with those on another device: {}, or a FILE.ron that describes one \
                 (docs/reference/graph-format.md)",
                Caps::PRESETS.join(", ")
            ),
        ),
        option(
            "turntable",
            "N",
            "Write N pictures DIR/turntable_0000.png, … of one camera orbit around the scene instead of one picture",
        )
        .num_args(2)
        .value_names(["N", "DIR"]),
        option(
            "sequence",
            "N",
            "Write N consecutive frames DIR/frame_0000.png, … instead of one picture; with --time S an animation \
             plays from there at 30 frames per second",
        )
        .num_args(2)
        .value_names(["N", "DIR"]),
    ];
    all.into_iter().map(|option| option.help_heading("Frame")).collect()
}

/// Options of the whole frame.
#[derive(Clone, Debug, Default)]
pub struct Decide {
    /// Effects that are always drawn.
    pub enabled: EffectSet,
    /// Effects that are never drawn.
    pub disabled: EffectSet,
    /// Disables feature culling.
    pub forced: bool,
    /// Output file of the decisions, as JSON.
    pub json: Option<PathBuf>,
    /// Output file of the graph.
    pub graph: Option<PathBuf>,
    /// Device to compare the plan with.
    pub what_if: Option<String>,
    /// Measures the frame with and without each effect.
    pub effect_costs: bool,
    /// Several pictures instead of one.
    pub sequence: Option<Sequence>,
}

/// Several pictures instead of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    /// Moves the camera around the scene.
    pub turns: bool,
    /// Number of pictures.
    pub frames: u32,
    /// Folder of the pictures.
    pub folder: PathBuf,
    /// Frame rate of the animation.
    pub per_second: f64,
}

impl Decide {
    /// Parses the value of an option of this module; returns false for other options.
    ///
    /// # Errors
    /// One line that names the option and the expected value.
    pub fn take(&mut self, item: &Item) -> Result<bool, String> {
        match item.name() {
            "enable" => self.enabled = self.enabled.with(effect(item)?),
            "disable" => self.disabled = self.disabled.with(effect(item)?),
            "force-effects" => self.forced = true,
            "effect-costs" => self.effect_costs = true,
            "facts" => self.json = Some(crate::name::with_ending(item.raw().into(), "--facts", &["json"])?),
            "graph" => self.graph = Some(crate::name::with_ending(item.raw().into(), "--graph", &["ron"])?),
            "what-if" => self.what_if = Some(item.text()?),
            name @ ("turntable" | "sequence") => {
                let count = |text: &str| text.parse().ok().filter(|n| (1..=9999).contains(n));
                self.sequence = Some(Sequence {
                    turns: name == "turntable",
                    frames: item.parse("a number of pictures from 1 to 9999", count)?,
                    folder: item.second().into(),
                    per_second: 30.0,
                });
            }
            // `base` has read them before all other options.
            "preset" | "settings" => {}
            _ => return Ok(false),
        }
        if let Some(both) = self.enabled.and(self.disabled).iter().next() {
            return Err(format!("--enable {0}: cannot be used with --disable {0}", both.name()));
        }
        Ok(true)
    }

    /// Enables and disables effects in the settings.
    pub fn of(&self, settings: Settings) -> Settings {
        let enabled = self.enabled.iter().fold(settings, Settings::with);
        self.disabled.iter().fold(enabled, Settings::without)
    }
}

fn effect(item: &Item) -> Result<Effect, String> {
    item.parse(&format!("one of {}", Effect::ALL.map(Effect::name).join(", ")), Effect::from_name)
}

/// Returns the base settings from `--preset` or `--settings`, and the settings file.
///
/// # Errors
/// One line that names the option, and the place in the file.
pub fn base(given: &Given) -> Result<(Option<FrameSettings>, Option<PathBuf>), String> {
    let value = |name| given.values(name).next();
    let (preset, file) = (value("preset"), value("settings"));
    match (preset, file) {
        (Some(_), Some(_)) => Err("--settings: cannot be used with --preset; both set the whole frame".into()),
        (None, None) => Ok((None, None)),
        (Some(name), None) => {
            let name = name.to_string_lossy();
            let known = || Preset::ALL.map(Preset::name).join(", ");
            let unknown = || format!("--preset {name}: unknown preset; expected one of {}", known());
            let preset = Preset::from_name(&name).ok_or_else(unknown)?;
            let Some(record) = value("record") else { return Ok((Some(preset.frame()), None)) };
            let (measured, _) = crate::budget::record(Some(Path::new(record)))?;
            let frame = preset.measured(&measured, |_| true).map_err(|error| format!("--record: {error}"))?;
            Ok((Some(frame), None))
        }
        (None, Some(path)) => {
            let shown = path.to_string_lossy();
            let text =
                input::text(Path::new(path), input::MAX_TEXT_BYTES).map_err(|error| format!("--settings {error}"))?;
            let frame = FrameSettings::from_ron(&shown, &text).map_err(|error| format!("--settings {error}"))?;
            Ok((Some(frame), Some(path.into())))
        }
    }
}

/// Inputs of feature culling that persist between frames.
#[derive(Debug)]
pub struct FeatureCulling {
    survey: SceneSummary,
    memory: FactMemory,
    forced: EffectSet,
    off: bool,
}

impl FeatureCulling {
    pub fn new(asked: &Decide, loaded: &Loaded, settings: &Settings) -> Self {
        let mut forced = asked.enabled;
        // Cascade tinting requires the cascades.
        if settings.shadows.is_some_and(|shadows| shadows.show_cascades) {
            forced = forced.with(Effect::SunShadows).with(Effect::Cascades);
        }
        let memory = FactMemory::default();
        Self { survey: SceneSummary::new(&loaded.scene), memory, forced, off: asked.forced }
    }

    /// Summarizes the materials of the scene again after an animation changed them.
    pub fn resurvey(&mut self, scene: &Scene) {
        self.survey = SceneSummary::new(scene);
    }

    /// Returns feature culling without history that keeps these effects, and those that it always keeps.
    pub fn keeping(&self, kept: EffectSet) -> Self {
        let forced = kept.iter().fold(self.forced, EffectSet::with);
        Self { survey: self.survey.clone(), memory: FactMemory::default(), forced, off: self.off }
    }

    /// Returns the decisions on all effects of a view; none if effects are forced.
    pub fn facts(
        &mut self,
        loaded: &Loaded,
        light: &ImageLight,
        seen: &ViewSettings,
        settings: &Settings,
        measured: Measurement,
    ) -> Facts {
        if self.off {
            return Facts::default();
        }
        let input = FactInput {
            scene: &loaded.scene,
            survey: &self.survey,
            around: EnvironmentSummary::from(light),
            background: &loaded.background,
            views: std::slice::from_ref(seen),
            settings,
            measured,
            forced: self.forced,
            max_steps: FactInput::MAX_CODES,
        };
        decide(&input, &mut self.memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn base(line: &str) -> Result<(Option<FrameSettings>, Option<PathBuf>), String> {
        let command = program::cli::command("render", "", "").args(options()).args(crate::budget::options());
        match program::cli::parse(command, line.split(' ').map(std::ffi::OsString::from))? {
            program::cli::Parsed::Given(given) => super::base(&given),
            program::cli::Parsed::Help(text) => Err(text),
        }
    }

    #[test]
    fn the_frame_begins_with_a_preset_or_a_file() {
        assert_eq!(base("--force-effects"), Ok((None, None)));
        for line in ["--preset ultra --force-effects", "--preset=ultra"] {
            assert_eq!(base(line), Ok((Some(Preset::Ultra.frame()), None)));
        }
        for (line, named) in [
            ("--preset best", "--preset best: unknown preset; expected one of low, medium, high, ultra"),
            ("--preset low --record no/such.json", "--record no/such.json: "),
            ("--preset low --settings a.ron", "--settings: cannot be used with --preset"),
            ("--settings no/such.ron", "--settings no/such.ron: "),
        ] {
            let error = base(line).expect_err("the command line is invalid");
            assert!(error.starts_with(named), "{error}");
        }
    }
}
