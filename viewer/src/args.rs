//! The command line of `viewer`.

use framegraph::Order;
use lexopt::{Arg, Parser, ValueExt};
use std::ffi::OsString;
use std::path::PathBuf;
use viewer::drawing::Theme;
use viewer::view::View;

/// What `viewer --help` prints.
pub const HELP: &str = "\
Shows what a frame does, why, and what it costs.

usage: viewer [FILE] [options]
       viewer --headless --view VIEW --plan FILE [--against FILE] --out FILE.png|svg

       viewer --standard PRESET|SETTINGS.ron [options]
       viewer --live [SCENE] [--settings PRESET|SETTINGS.ron] [--environment FILE] [options]

FILE is a plan (JSON, docs/plan-json.md), a graph (FRAME.ron, docs/graph-format.md), which is planned here, watched, and
planned anew when it changes, or a trace (`render --trace`). docs/viewer.md shows the views.

  --plan FILE         the same as FILE
  --standard WHICH    the standard frame instead of a file: low, medium, high, ultra, or a FILE.ron of settings
                      (docs/settings.md); its effects are features
  --live [SCENE]      the standard frame, drawn in the window: FILE is a glTF or GLB file or a built-in scene (spheres);
                      the views show the plan that is executed
  --settings WHICH    with --live: the settings that it begins with (high)
  --environment FILE  with --live: light from a .hdr, .exr or .ktx picture instead of a clear sky
  --against FILE      a plan or graph to compare with
  --trace FILE        times of many frames
  --caps WHICH        graphs are planned for: desktop, tiler, wgpu (default), or a FILE.ron that describes a device
  --size WxH          size of the frame in texels; default: what the file says, else 1920x1080
  --set FEATURE=on|off
                      switches a feature of the graph; may be given several times
  --order WHICH       declared (default) or optimized
  --select NAME       selects a pass or a resource
  --view VIEW         graph (default), timeline, memory, bandwidth, inspector, diff, trace,
                      accuracy or queues
  --theme WHICH       light or dark; default: what the desktop says, light without a window
  --scale X           pixels per point, 0.5 to 4 (1)
  --headless          no window: writes --out and ends
  --out FILE          what --headless writes, by its extension a .png or .svg
  --picture WxH       size of a PNG in pixels; default: as large as the view
  --whole             the PNG shows the whole application, 1280x720 if --picture says nothing
  --frames N          the window draws without a pause, closes after so many frames or one more, and says how many
  --measure           no window: prints what the panels cost on this machine
  --help              this text

Exit codes: 0 done, 2 bad input or output, 3 no device or window, 128 and its number after a signal.
";

/// What was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Args {
    /// The file to look at.
    pub file: Option<PathBuf>,
    /// The standard frame of a preset or of a file of settings.
    pub standard: Option<String>,
    /// The standard frame is drawn; the file is a scene.
    pub live: bool,
    /// The settings that it begins with.
    pub settings: Option<String>,
    /// Prints what the panels cost.
    pub measure: bool,
    /// What lights its scene.
    pub environment: Option<PathBuf>,
    /// The file to compare with.
    pub against: Option<PathBuf>,
    /// Times.
    pub trace: Option<PathBuf>,
    /// A preset or a file.
    pub caps: String,
    /// The frame, in texels.
    pub size: Option<[u32; 2]>,
    /// Features with what they are set to.
    pub features: Vec<(String, bool)>,
    /// In which order passes run.
    pub order: Order,
    /// What is selected.
    pub select: Option<String>,
    /// Which view.
    pub view: View,
    /// Light or dark.
    pub theme: Option<Theme>,
    /// Pixels per point.
    pub scale: f32,
    /// Without a window, into this file.
    pub out: Option<PathBuf>,
    /// The picture, in pixels.
    pub picture: Option<[u32; 2]>,
    /// The whole application rather than one view.
    pub whole: bool,
    /// Frames after which the window closes.
    pub frames: Option<u64>,
}

/// Reads the command line, without the program's name; none where help is asked for.
///
/// # Errors
/// One line that names the option and what it takes.
pub fn parse(args: impl Iterator<Item = OsString>) -> Result<Option<Args>, String> {
    let mut out = Args {
        file: None,
        standard: None,
        live: false,
        measure: false,
        settings: None,
        environment: None,
        against: None,
        trace: None,
        caps: "wgpu".into(),
        size: None,
        features: Vec::new(),
        order: Order::Declared,
        select: None,
        view: View::Graph,
        theme: None,
        scale: 1.0,
        out: None,
        picture: None,
        whole: false,
        frames: None,
    };
    let mut parser = Parser::from_args(args);
    let mut headless = false;
    while let Some(arg) = parser.next().map_err(|e| e.to_string())? {
        let option = match arg {
            Arg::Long(name) => name.to_owned(),
            Arg::Short(letter) => return Err(format!("there is no option `-{letter}`; see --help")),
            Arg::Value(value) => {
                set(&mut out.file, value.into(), "FILE")?;
                continue;
            }
        };
        match option.as_str() {
            "help" => return Ok(None),
            "headless" => headless = true,
            "whole" => out.whole = true,
            "live" => out.live = true,
            "measure" => out.measure = true,
            _ => value(&mut parser, &option, &mut out)?,
        }
    }
    match (headless, &out.out) {
        (true, None) => return Err("--headless needs --out FILE.png or FILE.svg".into()),
        (false, Some(_)) => return Err("--out goes together with --headless only".into()),
        _ => {}
    }
    let without_window = [(headless, "--headless"), (out.measure, "--measure")].into_iter().find(|(given, _)| *given);
    if let (Some((_, other)), true) = (without_window, out.frames.is_some()) {
        return Err(format!("--frames does not go together with {other}: there is no window"));
    }
    if out.measure && (headless || out.live || out.file.is_some() || out.standard.is_some()) {
        return Err("--measure goes alone: it measures plans of its own".into());
    }
    if !headless && (out.whole || out.picture.is_some()) {
        return Err("--whole and --picture go together with --headless only".into());
    }
    if out.standard.is_some() && out.file.is_some() {
        return Err("--standard does not go together with a FILE".into());
    }
    if out.live && (headless || out.standard.is_some()) {
        return Err("--live does not go together with --headless or --standard".into());
    }
    if !out.live && (out.settings.is_some() || out.environment.is_some()) {
        return Err("--settings and --environment go together with --live only".into());
    }
    if headless && out.file.is_none() && out.standard.is_none() && out.view.is_of_a_plan() {
        return Err("--headless needs a file to look at: --plan FILE".into());
    }
    Ok(Some(out))
}

/// Reads the value of one option.
fn value(parser: &mut Parser, option: &str, out: &mut Args) -> Result<(), String> {
    const KNOWN: [&str; 17] = [
        "standard",
        "settings",
        "environment",
        "plan",
        "against",
        "trace",
        "caps",
        "size",
        "set",
        "order",
        "select",
        "view",
        "theme",
        "scale",
        "out",
        "picture",
        "frames",
    ];
    if !KNOWN.contains(&option) {
        return Err(format!("there is no option `--{option}`; see --help"));
    }
    let name = format!("--{option}");
    let value = parser.value().map_err(|_| format!("{name} needs a value; see --help"))?;
    match option {
        "plan" => return set(&mut out.file, value.into(), "FILE"),
        "against" => return set(&mut out.against, value.into(), &name),
        "environment" => return set(&mut out.environment, value.into(), &name),
        "trace" => return set(&mut out.trace, value.into(), &name),
        "out" => return set(&mut out.out, value.into(), &name),
        _ => {}
    }
    let value = value.string().map_err(|_| format!("{name}: the value is not UTF-8"))?;
    let wrong = |takes: &str| format!("{name}: `{value}` is not {takes}");
    match option {
        "caps" => out.caps = value,
        "select" => out.select = Some(value),
        "standard" => out.standard = Some(value),
        "settings" => out.settings = Some(value),
        "size" => out.size = Some(sides(&value, 65536).ok_or_else(|| wrong("WxH with 1 to 65536 texels each way"))?),
        "picture" => {
            let most = viewer::offscreen::MOST_PX;
            out.picture = Some(sides(&value, most).ok_or_else(|| wrong("WxH with 1 to 8192 pixels each way"))?);
        }
        "set" => out.features.push(switch(&value).ok_or_else(|| wrong("FEATURE=on or FEATURE=off"))?),
        "order" => {
            out.order = match value.as_str() {
                "declared" => Order::Declared,
                "optimized" => Order::Optimized,
                _ => return Err(wrong("declared or optimized")),
            };
        }
        "view" => {
            let views = View::ALL.map(View::word).join(", ");
            let named = View::ALL.into_iter().find(|view| view.word() == value);
            out.view = named.ok_or_else(|| wrong(&format!("one of {views}")))?;
        }
        "theme" => {
            out.theme = match value.as_str() {
                "light" => Some(Theme::Light),
                "dark" => Some(Theme::Dark),
                _ => return Err(wrong("light or dark")),
            };
        }
        "scale" => {
            let scale = value.parse().ok().filter(|scale| (0.5..=4.0).contains(scale));
            out.scale = scale.ok_or_else(|| wrong("a number from 0.5 to 4"))?;
        }
        _ => out.frames = Some(value.parse().map_err(|_| wrong("a whole number of frames"))?),
    }
    Ok(())
}

/// Refuses a second value.
fn set(place: &mut Option<PathBuf>, value: PathBuf, name: &str) -> Result<(), String> {
    match place.replace(value) {
        None => Ok(()),
        Some(_) => Err(format!("{name} is given twice")),
    }
}

fn sides(value: &str, most: u32) -> Option<[u32; 2]> {
    let (w, h) = value.split_once('x')?;
    let side = |s: &str| s.parse().ok().filter(|side| (1..=most).contains(side));
    Some([side(w)?, side(h)?])
}

fn switch(value: &str) -> Option<(String, bool)> {
    let (feature, state) = value.split_once('=').filter(|(feature, _)| !feature.is_empty())?;
    match state {
        "on" => Some((feature.into(), true)),
        "off" => Some((feature.into(), false)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Option<Args>, String> {
        parse(line.split_whitespace().map(OsString::from))
    }

    #[test]
    fn the_whole_command_line_is_read() {
        let line = "--headless --view memory --plan a.json --against b.ron --trace t.json --caps tiler --size 64x32 \
                    --set msaa=on --order optimized --select hdr --theme dark --scale 2 --out c.png --picture 640x360 \
                    --whole";
        let args = parsed(line).expect("the line is sound").expect("no help is asked for");
        assert_eq!((args.file, args.against), (Some("a.json".into()), Some("b.ron".into())));
        assert_eq!((args.view, args.theme, args.scale), (View::Memory, Some(Theme::Dark), 2.0));
        assert_eq!((args.size, args.picture, args.whole), (Some([64, 32]), Some([640, 360]), true));
        assert_eq!((args.features, args.order), (vec![("msaa".into(), true)], Order::Optimized));
        assert_eq!(parsed("--help --capz"), Ok(None));
    }

    #[test]
    fn every_mistake_is_one_line_that_names_it() {
        for (line, named) in [
            ("a.ron b.ron", "FILE is given twice"),
            ("a.ron --plan b.ron", "FILE is given twice"),
            ("--live --standard low", "--live"),
            ("--settings low", "--live only"),
            ("--frames 3 --headless --plan a.json --out a.png", "--frames does not go together with --headless"),
            ("a.json --measure", "--measure goes alone"),
            ("a.json --whole", "--headless only"),
            ("a.json --picture 8x8", "--headless only"),
            ("--capz tiler", "--capz"),
            ("-x", "-x"),
            ("a.ron --standard low", "--standard"),
            ("--caps", "--caps"),
            ("--view picture", "--view: `picture`"),
            ("--size 0x4", "--size: `0x4`"),
            ("--picture 9000x1", "--picture: `9000x1`"),
            ("--scale 9", "--scale: `9`"),
            ("--theme blue", "--theme: `blue`"),
            ("--order best", "declared or optimized"),
            ("--set =on", "--set: `=on`"),
            ("--frames x", "--frames: `x`"),
            ("--headless --plan a.json", "--out"),
            ("--out a.png", "--headless"),
            ("--headless --out a.png", "--plan"),
        ] {
            let error = parsed(line).expect_err(line);
            assert!(error.contains(named) && !error.contains('\n'), "{line}: {error}");
        }
    }
}
