//! The command line of `render`.

use crate::budget::{self, Budget};
use crate::debug::{self, Debugging};
use crate::decide::{self, Decide};
use crate::effects::{self, Effects};
use crate::given::Given;
use crate::grade::{self, Grade};
use crate::light::{self, Lighting};
use crate::look::{number, precision, quality, shading, switch};
use crate::moment::{self, Moment};
use crate::name::{plan_files, with_ending};
use crate::shadows::{self, Shadows};
use crate::values::{alias, camera, frames, memory, samples, size, threads};
use framegraph::Alias;
use framegraph_passes::PostSettings;
use framegraph_passes::{Effect, Precision, Quality, Settings, Shading};
use framegraph_scene::{BlockFormats, CameraChoice, LoadOptions, Memory};
use std::ffi::OsString;
use std::path::PathBuf;

/// What `render --help` prints.
pub fn help() -> String {
    let plain = |text: &str| text.trim_start_matches('\n').to_owned();
    HELP.replace("LIGHTING\n", &plain(light::HELP))
        .replace("GRADING\n", &plain(grade::HELP))
        .replace("SHADOWS\n", &plain(shadows::HELP))
        .replace("EFFECTS\n", &plain(effects::HELP))
        .replace("BUDGET\n", &plain(budget::HELP))
        .replace("FRAME\n", &plain(&decide::help()))
        .replace("MOMENT\n", &plain(moment::HELP))
        .replace("DEBUGGING\n", &plain(debug::HELP))
}

const HELP: &str = "\
Renders a scene through the compiled render graph, without a window.

usage: render [SCENE] [options]

SCENE is a glTF or GLB file, or a built-in scene: spheres (default), balls, columns, glass, lamps (lamps:N has N of them,
lamps 1000), lobes, materials, optics, panes (panes:N has N of them, panes 5).

  --size WxH           size of the picture in pixels (1280x720)
  --msaa 1|4           samples per pixel (4)
  --camera WHICH       a camera of the scene by name, `orbit` (the whole scene), or EX,EY,EZ:TX,TY,TZ:FOVY with eye and
                       target in meters and the vertical field of view in degrees; default: the scene's first, else orbit
  --camera-from-gltf   the first camera of the file, or that of --camera NAME; an error where it has none
  --variant NAME       the materials of a variant of the file (KHR_materials_variants)
MOMENT
LIGHTING
  --quality low|high|ultra  how surfaces are shaded: `low` as Filament does on phones, `high` as on desktops, `ultra` with
                       more bands of irradiance and finer reflections (high)
  --shade KEY=X,...    one by one: visibility=exact|fast, table=exact|fast (visibility's own), floor=R (least
                       roughness), f90-fades=on|off,
                       compensation=on|off|image|punctual (of light scattered more than once), bands=2|3|5 (of
                       irradiance), window=none|hann|sinc|laplacian:LAMBDA (of its bands, against ringing),
                       irradiance=harmonics|cube (the last level of the prefiltered environment),
                       environment-format=rg11b10|half|rgbm (of the prefiltered environment), aa=on|off|VARIANCE:THRESHOLD (of highlights), multi-bounce=on|off (of ambient
                       occlusion), specular-occlusion=on|off, micro-shadows=on|off (of the sun, by the material's
                       occlusion), fast-coat=on|off (reflection under varnish), coat-ior-change=on|off (clear coat lowers
                       the base's f0), transmission-blur=distance|angle (of what is behind rough bodies; angle as Filament), light-window=gltf|filament (how punctual lights end at their range), light-fade=off|M (meters
                       from the eye beyond which none shines)
  --precision f32|f16  the numbers that shading computes in; f16 where the adapter has it, roughness then from 0.089 (f32)
  --compensation EV    exposure compensation (0)
  --vignette EV        how much darker the corners are than the middle (0)
  --dither X           amplitude of the dither: 1 is half a code either way (1)
  --inline on|off      post-processing at the end of the color pass's shader, where that is sound (on)
  --alias heap|pool|none  textures that live at other times share memory: at offsets of one block, whatever their shape
                       (Vulkan; elsewhere the pool serves); textures of one shape (pool); or not
  --threads auto|N     threads that record a frame where that is measured to be faster (auto: as many as there are cores)
  --round-hdr          where it is inlined, round the radiance first as the device stores it: with --msaa 1 the same bits
                       as --inline off
  --split-post         a pass for each effect of post-processing
  --compare-post       no picture, but a table of what post-processing costs inlined, in one pass and in a pass for each
                       effect, at one and four samples (--size 1920x1080)
FRAME
BUDGET
EFFECTS
  --no-fxaa            leave edges as they are
  --frames N           measured frames after four for warming up (8)
  --out FILE.png       the picture (render.png)
  --linear-out FILE.exr  radiance times exposure before tone mapping, linear Rec.709, of the size as drawn. It contains
                       shading, shadows, ao, ssr, glass, blending, fog, the background, msaa, taa and dof; not bloom, flares,
                       --compensation, vignette, edge fade, grading, the tone curve, dither, fxaa and enlarging. Values above
                       1 are kept, so it does not go together with --disable hdr-target
  --plan FILE          the plan as text; its graph goes beside it with the ending .dot (the picture's name with .plan.txt)
  --memory BYTES       what loading may take: files, decoding, mip levels, upload; 512MiB, 2GB, … (half of the machine's)
  --allow-outside      buffers and images of the scene may lie outside of its folder
GRADING
SHADOWS
DEBUGGING
  --help               this text

The adapter is the best there is, hardware first; WGPU_BACKEND and WGPU_ADAPTER_NAME choose another.
Light of an environment is kept in the user's cache folder; FRAMEGRAPH_LIGHT_CACHE names another, or is `off`.
Files are written together at the end, whole or not at all; a pipe or a device is written through. SIGINT and SIGTERM stop the
run at its next step, and nothing is written.
Exit codes: 0 done, 1 the device failed, 2 bad input or output, 128 and its number after a signal.";

/// What was asked for.
#[derive(Clone, Debug)]
pub struct Args {
    /// Built-in name or file.
    pub scene: String,
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// Samples per pixel.
    pub samples: u8,
    /// The camera; none takes the scene's first, else an orbit.
    pub camera: Option<CameraChoice>,
    /// The camera must be one of the scene's own.
    pub camera_from_gltf: bool,
    /// What lights the scene, what is behind it, exposure.
    pub lighting: Lighting,
    /// How fine light is.
    pub quality: Quality,
    /// How surfaces are shaded.
    pub shading: Shading,
    /// Exposure, vignette, grading, tone curve, dither.
    pub post: PostSettings,
    /// Grading and tone curve as they were asked for; [`Args::post`] has them.
    pub grade: Grade,
    /// Post-processing in the color pass's shader, where that is sound.
    pub inline: bool,
    pub alias: Alias,
    /// 0 for as many as there are cores.
    pub threads: usize,
    /// Round the radiance as the device stores it, where it is not stored.
    pub round_hdr: bool,
    /// A pass for each effect.
    pub split_post: bool,
    /// Compare ways of post-processing instead of rendering a picture.
    pub compare_post: bool,
    /// How lights cast shadows.
    pub shadows: Shadows,
    /// Ambient occlusion, reflections, glass, fog.
    pub effects: Effects,
    /// The frame that these options change: what they do not name is its.
    pub base: Settings,
    /// The file that it was read from.
    pub settings: Option<PathBuf>,
    /// Which effects stay and go, and what else is done with the frame.
    pub decide: Decide,
    /// Name of the material variant.
    pub variant: Option<String>,
    /// At which moment of an animation the scene is.
    pub moment: Moment,
    /// Soften edges.
    pub fxaa: bool,
    /// Measured frames.
    pub frames: u32,
    /// The picture.
    pub out: PathBuf,
    /// Linear radiance.
    pub linear_out: Option<PathBuf>,
    /// The plan as text; none where the picture goes to a pipe or a device and nothing was said.
    pub plan: Option<PathBuf>,
    /// The plan as a graph; none where the text goes to a pipe or a device.
    pub dot: Option<PathBuf>,
    /// What loading may take in bytes; none for half of the machine's.
    pub memory_bytes: Option<u64>,
    /// Files of the scene may lie outside of its folder.
    pub allow_outside: bool,
    /// Looking into the frame, and bisecting it.
    pub debug: Debugging,
    /// What the frame is held to.
    pub budget: Budget,
    /// It is one of several frames that are tried, and what was told of the scene is not told again.
    pub trial: bool,
}

impl Args {
    /// Returns the options of loading for a device that samples these formats. Everything that is loaded shares one budget:
    /// make them once.
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

/// What the command line comes to.
#[derive(Clone, Debug)]
pub enum Command {
    /// Print the help.
    Help,
    /// Render.
    Render(Box<Args>),
}

/// Reads the command line; `args` without the program's name.
///
/// # Errors
/// One line that names the option and what it takes.
pub fn parse(args: impl IntoIterator<Item = OsString>) -> Result<Command, String> {
    use lexopt::prelude::*;
    let args: Vec<OsString> = args.into_iter().collect();
    let (frame, settings) = decide::base(&args)?;
    let base = frame.map_or(Settings::default(), |frame| frame.settings);
    let mut given = Given::of(&args);
    let mut parser = lexopt::Parser::from_args(args);
    let mut found = Args {
        scene: String::new(),
        size_px: [1280, 720],
        samples: 4,
        camera: None,
        camera_from_gltf: false,
        lighting: Lighting::default(),
        quality: Quality::default(),
        shading: Shading::default(),
        post: PostSettings::DEFAULT,
        grade: Grade::default(),
        inline: true,
        alias: Alias::Pool,
        threads: 0,
        round_hdr: false,
        split_post: false,
        compare_post: false,
        shadows: Shadows::default(),
        effects: Effects::default(),
        base,
        settings,
        decide: Decide::default(),
        variant: None,
        moment: Moment::default(),
        fxaa: true,
        frames: 8,
        out: PathBuf::from("render.png"),
        linear_out: None,
        plan: None,
        dot: None,
        memory_bytes: None,
        allow_outside: false,
        debug: Debugging::default(),
        budget: Budget::default(),
        trial: false,
    };
    if let Some(frame) = &frame {
        found.begin_with(frame);
    }
    let mut plan: Option<PathBuf> = None;
    let mut shade = String::new();
    let mut numbers: Option<Precision> = None;
    while let Some(arg) = parser.next().map_err(|e| e.to_string())? {
        if let Long(name) = arg {
            given.note(name)?;
        }
        match arg {
            Long("help") | Short('h') => return Ok(Command::Help),
            Long("size") => found.size_px = size(&text(&mut parser, "--size")?)?,
            Long("msaa") => found.samples = samples(&text(&mut parser, "--msaa")?)?,
            Long("camera") => found.camera = Some(camera(&text(&mut parser, "--camera")?)?),
            Long("camera-from-gltf") => found.camera_from_gltf = true,
            Long("quality") => found.quality = quality(&text(&mut parser, "--quality")?)?,
            Long("shade") => shade = text(&mut parser, "--shade")?,
            Long("precision") => numbers = Some(precision(&text(&mut parser, "--precision")?)?),
            Long("compensation") => {
                let stops = text(&mut parser, "--compensation")?;
                found.post.compensation_ev = number("--compensation", &stops, -16.0..=16.0)?;
            }
            Long("vignette") => {
                found.post.vignette_ev = number("--vignette", &text(&mut parser, "--vignette")?, 0.0..=16.0)?;
            }
            Long("dither") => found.post.dither = number("--dither", &text(&mut parser, "--dither")?, 0.0..=1.0)?,
            Long("alias") => found.alias = alias(&text(&mut parser, "--alias")?)?,
            Long("threads") => found.threads = threads(&text(&mut parser, "--threads")?)?,
            Long("inline") => found.inline = switch("--inline", &text(&mut parser, "--inline")?)?,
            Long("round-hdr") => found.round_hdr = true,
            Long("split-post") => found.split_post = true,
            Long("compare-post") => found.compare_post = true,
            Long("no-fxaa") => found.fxaa = false,
            Long("frames") => found.frames = frames(&text(&mut parser, "--frames")?)?,
            Long("out") => found.out = with_ending(path(&mut parser, "--out")?, "--out", &["png"])?,
            Long("linear-out") => {
                found.linear_out = Some(with_ending(path(&mut parser, "--linear-out")?, "--linear-out", &["exr"])?);
            }
            Long("memory") => found.memory_bytes = Some(memory(&text(&mut parser, "--memory")?)?),
            Long("variant") => found.variant = Some(text(&mut parser, "--variant")?),
            Long("allow-outside") => found.allow_outside = true,
            Long("plan") => plan = Some(path(&mut parser, "--plan")?),
            Value(value) if found.scene.is_empty() => {
                found.scene = value.into_string().map_err(|v| format!("SCENE {v:?}: the name is not Unicode"))?;
            }
            Value(value) => return Err(format!("{value:?}: one scene at a time; SCENE is `{}` already", found.scene)),
            Long(name) => {
                let name = name.to_owned();
                let taken = found.lighting.take(&name, &mut parser)?
                    || found.shadows.take(&name, &mut parser)?
                    || found.effects.take(&name, &mut parser)?
                    || found.moment.take(&name, &mut parser)?
                    || found.grade.take(&name, &mut parser)?
                    || found.decide.take(&name, &mut parser)?
                    || found.budget.take(&name, &mut parser)?
                    || found.debug.take(&name, &mut parser)?;
                if !taken {
                    return Err(format!("--{name}: unknown option; `render --help` lists them"));
                }
            }
            Short(name) => return Err(format!("-{name}: unknown option; `render --help` lists them")),
        }
    }
    if found.scene.is_empty() {
        found.scene = "spheres".into();
    }
    if let (true, Some(CameraChoice::Orbit | CameraChoice::LookAt { .. })) = (found.camera_from_gltf, &found.camera) {
        return Err(
            "--camera-from-gltf: --camera asks for one that is not the file's; give its name, or one of the two".into(),
        );
    }
    given.check(&found)?;
    found.keep_linear()?;
    found.grade.apply(&mut found.post)?;
    let chosen = if given.has("quality") { found.quality.shading() } else { found.shading };
    found.shading = shading(chosen, &shade)?;
    found.shading.precision = numbers.unwrap_or(found.shading.precision);
    if found.compare_post && !given.has("size") {
        found.size_px = [1920, 1080];
    }
    (found.plan, found.dot) = plan_files(plan, &found.out);
    Ok(Command::Render(Box::new(found)))
}

impl Args {
    /// Keeps the target of half floats where its radiance is written to a file: eight bits would cut off values above 1.
    fn keep_linear(&mut self) -> Result<(), String> {
        if self.linear_out.is_none() {
            return Ok(());
        }
        if self.decide.disabled.contains(Effect::HdrTarget) {
            return Err(
                "--linear-out: without hdr-target values above 1 are cut off; leave out --disable hdr-target or \
                        --linear-out"
                    .into(),
            );
        }
        self.decide.enabled = self.decide.enabled.with(Effect::HdrTarget);
        Ok(())
    }
}

fn text(parser: &mut lexopt::Parser, option: &str) -> Result<String, String> {
    let value = parser.value().map_err(|_| format!("{option}: a value is missing"))?;
    value.into_string().map_err(|v| format!("{option} {v:?}: the value is not Unicode"))
}

fn path(parser: &mut lexopt::Parser, option: &str) -> Result<PathBuf, String> {
    parser.value().map(PathBuf::from).map_err(|_| format!("{option}: a file is missing"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args(words: &[&str]) -> Result<Args, String> {
        match parse(words.iter().map(OsString::from))? {
            Command::Render(args) => Ok(*args),
            Command::Help => Err("help".into()),
        }
    }

    #[test]
    fn defaults_need_no_file() {
        let found = args(&[]).expect("no argument is needed");
        assert_eq!((found.scene.as_str(), found.size_px, found.samples), ("spheres", [1280, 720], 4));
        assert_eq!((found.plan, found.dot), (Some("render.plan.txt".into()), Some("render.plan.dot".into())));
    }

    #[test]
    fn comparing_is_done_at_full_hd_unless_asked_otherwise() {
        let size = |words: &[&str]| args(words).map(|found| found.size_px);
        assert_eq!(size(&["--compare-post"]), Ok([1920, 1080]));
        assert_eq!(size(&["--size", "64x32", "--compare-post"]), Ok([64, 32]));
    }

    /// Whatever the facts say of the scene, and whatever order the options have.
    #[test]
    fn a_linear_picture_keeps_its_half_floats() {
        let kept = |words: &[&str]| args(words).map(|found| found.decide.enabled.contains(Effect::HdrTarget));
        assert_eq!(kept(&[]), Ok(false));
        assert_eq!(kept(&["--linear-out", "a.exr"]), Ok(true));
        assert_eq!(kept(&["--disable", "fxaa", "--linear-out", "a.exr"]), Ok(true));
        assert_eq!(kept(&["--disable", "hdr-target"]), Ok(false));
    }

    #[test]
    fn the_plan_has_a_neighbour() {
        let found = args(&["--plan", "a/b.txt"]).expect("a sound command line");
        assert_eq!((found.plan, found.dot), (Some("a/b.txt".into()), Some("a/b.dot".into())));
        let found = args(&["--plan=a/b.dot"]).expect("a sound command line");
        assert_eq!((found.plan, found.dot), (Some("a/b.txt".into()), Some("a/b.dot".into())));
    }

    #[test]
    fn wrong_words_are_named_in_one_line() {
        let cases: [(&[&str], &str); 44] = [
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
            (&["--disable", "hdr-target", "--linear-out=a.exr"], "leave out --disable hdr-target"),
            (&["--frames", "0"], "--frames 0"),
            (&["--memory", "0MiB"], "--memory 0MiB"),
            (&["--size", "1x1", "--size=2x2"], "--size: it is given twice"),
            (&["--colour"], "--colour"),
            (&["spheres", "columns"], "columns"),
        ];
        for (words, named) in cases {
            let error = args(words).expect_err("the command line is wrong");
            assert!(error.contains(named) && !error.contains('\n'), "{words:?}: {error}");
        }
    }
}
