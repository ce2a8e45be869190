//! Options of the whole frame: presets, settings as files, and which effects facts may leave out.

use crate::args::Args;
use crate::effects::Effects;
use crate::grade::Grade;
use crate::load::Loaded;
use crate::shadows::Shadows;
use framegraph_passes::facts::{Around, Survey, decide};
use framegraph_passes::ibl::ImageLight;
use framegraph_passes::measure::Measurement;
use framegraph_passes::view::ViewSettings;
use framegraph_passes::{Effect, EffectSet, FactInput, FactMemory, Facts, FrameSettings, Preset, Settings};
use framegraph_scene::Scene;
use lexopt::Parser;
use program::input;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

/// What `render --help` prints of them.
pub const HELP: &str = "
FRAME
  --preset NAME        the whole frame: low, medium, high or ultra (docs/settings.md); other options change it;
                       with --record, what that record chooses for it
  --settings FILE.ron  the whole frame from a file (docs/settings.md); other options change it
  --enable EFFECT      the effect in its default strength, whatever the scene calls for; may be given again
  --disable EFFECT     not the effect, whatever the scene calls for; may be given again. EFFECT is NAMES
  --force-effects      every effect that is asked for; without it, what facts about the scene prove to change nothing is left
                       out, and said after the table with its reason (docs/facts.md)
  --facts FILE.json    what was decided of each effect
  --what-it-costs      beside the picture a table of what each effect takes: the frame with it and without it, in turns, all
                       other decisions being made; times are medians of --frames, from recording to the end
  --graph FILE.ron     the frame's graph, for the program `plan` (docs/graph-format.md)
  --what-if WHICH      the plan's counts for a device that is not here, beside those for this one: desktop, tiler, wgpu, or a
                       FILE.ron that describes one (docs/graph-format.md)
  --turntable N DIR    no picture, but N of them as DIR/turntable_0000.png, …: the camera goes once around the scene
  --sequence N DIR     N frames in a row, as DIR/frame_0000.png, …; with --time S an animation plays on from there, 30 frames a
                       second
";

/// The help with the names of effects, in lines.
pub fn help() -> String {
    let names = Effect::ALL.map(Effect::name);
    let lines: Vec<String> = names.chunks(7).map(|names| names.join(", ")).collect();
    HELP.replace("NAMES", &format!("one of\n                       {}", lines.join(",\n                       ")))
}

/// What was asked for.
#[derive(Clone, Debug, Default)]
pub struct Decide {
    /// Effects that are there in any case.
    pub enabled: EffectSet,
    /// Effects that are not.
    pub disabled: EffectSet,
    /// Facts are not asked.
    pub forced: bool,
    /// What was decided, as JSON.
    pub json: Option<PathBuf>,
    /// The graph as a file.
    pub graph: Option<PathBuf>,
    /// A device to plan for beside this one.
    pub what_if: Option<String>,
    /// The frame is measured with and without each effect.
    pub what_it_costs: bool,
    /// Several pictures.
    pub sequence: Option<Sequence>,
}

/// Several pictures instead of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    /// The camera goes around the scene.
    pub turns: bool,
    /// How many.
    pub frames: u32,
    /// Where they go.
    pub folder: PathBuf,
    /// Frames a second of an animation.
    pub per_second: f64,
}

impl Decide {
    /// Takes an option of this file; false for others.
    ///
    /// # Errors
    /// One line that names the option and what it takes.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        let mut raw = |what: &str| parser.value().map_err(|_| format!("--{name}: {what} is missing"));
        let text = |value: OsString| value.into_string().map_err(|v| format!("--{name} {v:?}: it is not Unicode"));
        match name {
            "enable" => self.enabled = self.enabled.with(effect(name, &text(raw("an effect")?)?)?),
            "disable" => self.disabled = self.disabled.with(effect(name, &text(raw("an effect")?)?)?),
            "force-effects" => self.forced = true,
            "what-it-costs" => self.what_it_costs = true,
            "facts" => self.json = Some(crate::name::with_ending(raw("a file")?.into(), "--facts", &["json"])?),
            "graph" => self.graph = Some(crate::name::with_ending(raw("a file")?.into(), "--graph", &["ron"])?),
            "what-if" => self.what_if = Some(text(raw("a device")?)?),
            "turntable" | "sequence" => {
                let count = text(raw("a number of pictures")?)?;
                let wrong = || format!("--{name} {count}: a number of pictures from 1 to 9999 is needed");
                let frames = count.parse().ok().filter(|n| (1..=9999).contains(n)).ok_or_else(wrong)?;
                self.sequence = Some(Sequence {
                    turns: name == "turntable",
                    frames,
                    folder: raw("a folder")?.into(),
                    per_second: 30.0,
                });
            }
            // Read by `base`, before all others.
            "preset" | "settings" => _ = raw("a value")?,
            _ => return Ok(false),
        }
        if let Some(both) = self.enabled.and(self.disabled).iter().next() {
            return Err(format!("--enable {0} does not go together with --disable {0}", both.name()));
        }
        Ok(true)
    }

    /// The settings with what is enabled and without what is disabled.
    pub fn of(&self, settings: Settings) -> Settings {
        let enabled = self.enabled.iter().fold(settings, Settings::with);
        self.disabled.iter().fold(enabled, Settings::without)
    }
}

fn effect(option: &str, name: &str) -> Result<Effect, String> {
    let known = || Effect::ALL.map(Effect::name).join(", ");
    Effect::from_name(name).ok_or_else(|| format!("--{option} {name}: unknown effect; there are {}", known()))
}

/// The frame that a command line begins with: that of `--preset` or `--settings`, if it has one; and the file that was read.
///
/// # Errors
/// One line that names the option, and the file with the place.
pub fn base(args: &[OsString]) -> Result<(Option<FrameSettings>, Option<PathBuf>), String> {
    let (preset, file) = (value(args, "--preset"), value(args, "--settings"));
    match (preset, file) {
        (Some(_), Some(_)) => Err("--settings does not go together with --preset: each is the whole frame".into()),
        (None, None) => Ok((None, None)),
        (Some(name), None) => {
            let name = name.to_string_lossy();
            let known = || Preset::ALL.map(Preset::name).join(", ");
            let unknown = || format!("--preset {name}: unknown preset; there are {}", known());
            let preset = Preset::from_name(&name).ok_or_else(unknown)?;
            let Some(record) = value(args, "--record") else { return Ok((Some(preset.frame()), None)) };
            let (measured, _) = crate::budget::record(Some(Path::new(&record)))?;
            let frame = preset.measured(&measured, |_| true).map_err(|error| format!("--record: {error}"))?;
            Ok((Some(frame), None))
        }
        (None, Some(path)) => {
            let shown = path.to_string_lossy();
            let text =
                input::text(Path::new(&path), input::MOST_TEXT_BYTES).map_err(|error| format!("--settings {error}"))?;
            let frame = FrameSettings::from_ron(&shown, &text).map_err(|error| format!("--settings {error}"))?;
            Ok((Some(frame), Some(path.into())))
        }
    }
}

/// The value of an option, as `--option value` or `--option=value`; none where it is missing, which parsing will say.
fn value(args: &[OsString], option: &str) -> Option<OsString> {
    let own = |arg: &OsStr| arg.to_str()?.strip_prefix(option)?.strip_prefix('=').map(OsString::from);
    let after = args.iter().position(|arg| arg == option).and_then(|at| args.get(at + 1)).cloned();
    args.iter().find_map(|arg| own(arg)).or(after)
}

impl Args {
    /// Begins with a frame, which other options change.
    pub fn begin_with(&mut self, frame: &FrameSettings) {
        let FrameSettings { quality, lights, lod_error_px, visible_layers, inline, settings } = *frame;
        (self.quality, self.lighting.lights, self.inline) = (quality, lights, inline);
        (self.samples, self.shading, self.post, self.fxaa) =
            (settings.samples, settings.shading, settings.post, settings.fxaa);
        (self.shadows, self.grade) = (Shadows::with(settings.shadows), Grade::with(&settings.post));
        self.split_post = settings.split_post;
        let Settings {
            occlusion,
            reflections,
            tone_resolve,
            taa,
            upscale,
            dof,
            bloom,
            fog,
            glass_layers,
            transparency,
            ..
        } = settings;
        let own = Effects::default();
        self.effects = Effects {
            occlusion,
            reflections,
            tone_resolve,
            taa,
            upscale,
            dof,
            bloom,
            fog,
            lod_error_px,
            visible_layers,
            glass_layers,
            transparency,
            ..own
        };
    }
}

/// What facts are decided with, kept from frame to frame.
#[derive(Debug)]
pub struct Deciding {
    survey: Survey,
    memory: FactMemory,
    forced: EffectSet,
    off: bool,
}

impl Deciding {
    pub fn new(asked: &Decide, loaded: &Loaded, settings: &Settings) -> Self {
        let mut forced = asked.enabled;
        // What tints by cascades shows those that were asked for.
        if settings.shadows.is_some_and(|shadows| shadows.show_cascades) {
            forced = forced.with(Effect::SunShadows).with(Effect::Cascades);
        }
        let memory = FactMemory::default();
        Self { survey: Survey::new(&loaded.scene), memory, forced, off: asked.forced }
    }

    /// Reads the surfaces of the scene again, after an animation has changed materials.
    pub fn resurvey(&mut self, scene: &Scene) {
        self.survey = Survey::new(scene);
    }

    /// What the facts say of a view; nothing where effects are forced.
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
            around: Around::from(light),
            background: &loaded.background,
            views: std::slice::from_ref(seen),
            settings,
            measured,
            forced: self.forced,
            most_codes: FactInput::MOST_CODES,
        };
        decide(&input, &mut self.memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<OsString> {
        line.split(' ').map(OsString::from).collect()
    }

    #[test]
    fn the_frame_begins_with_a_preset_or_a_file() {
        assert_eq!(base(&words("--msaa 1")), Ok((None, None)));
        for line in ["--preset ultra --msaa 1", "spheres --preset=ultra"] {
            assert_eq!(base(&words(line)), Ok((Some(Preset::Ultra.frame()), None)));
        }
        for (line, named) in [
            ("--preset best", "--preset best: unknown preset; there are low, medium, high, ultra"),
            ("--preset low --record no/such.json", "--record no/such.json: "),
            ("--preset low --settings a.ron", "--settings does not go together with --preset"),
            ("--settings no/such.ron", "--settings no/such.ron: "),
        ] {
            let told = base(&words(line)).expect_err("that is wrong");
            assert!(told.starts_with(named), "{told}");
        }
    }
}
