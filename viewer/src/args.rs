//! Command line of `viewer`.

use framegraph::Order;
use lexopt::{Arg, Parser, ValueExt};
use std::ffi::OsString;
use std::path::PathBuf;
use viewer::drawing::Theme;
use viewer::view::View;

/// Text of `viewer --help`.
pub const HELP: &str = "\
Shows the passes, decisions and costs of a frame.

usage: viewer [FILE] [options]
       viewer --headless --view VIEW --plan FILE [--against FILE] --out FILE.png|svg

       viewer --standard PRESET|SETTINGS.ron [options]
       viewer --live [SCENE] [--settings PRESET|SETTINGS.ron] [--environment FILE] [options]

FILE is a plan (JSON, docs/reference/plan-json.md), a graph (FRAME.ron, docs/reference/graph-format.md), or a trace
(`render --trace`). Graphs are compiled here, and again after each change. docs/reference/viewer.md shows the views.

  --plan FILE         same as FILE
  --standard PRESET   show the standard frame instead of a file: low, medium, high, ultra, or a FILE.ron of settings
                      (docs/reference/settings.md); its effects are features
  --live [SCENE]      draw the standard frame in the window and show its plan; SCENE is a glTF or GLB file or a built-in
                      scene (spheres)
  --settings PRESET   initial settings with --live: a preset or a FILE.ron (high)
  --environment FILE  environment light with --live: a .hdr, .exr or .ktx picture; default: a clear sky
  --against FILE      plan or graph to compare with
  --trace FILE        frame times to show
  --caps DEVICE       device for graphs: desktop, tiler, mali, adreno, apple, wgpu (default), wgpu-native, or a FILE.ron
  --size WxH          frame size in texels; default: the size in the file, else 1920x1080
  --set FEATURE=on|off
                      enable or disable a feature of the graph; repeatable
  --order ORDER       declared (default) or optimized
  --select NAME       select a pass or a resource
  --view VIEW         graph (default), timeline, memory, bandwidth, inspector, diff, trace,
                      accuracy or queues
  --theme THEME       light or dark; default: that of the desktop, light without a window
  --scale X           pixels per point, 0.5 to 4 (1)
  --headless          write --out without opening a window
  --out FILE          output of --headless, .png or .svg
  --picture WxH       size of a PNG in pixels; default: the size of the view
  --whole             draw the whole application into the PNG (1280x720)
  --frames N          draw continuously, close the window after N or N + 1 frames, and print their number
  --measure           print the cost of the panels on this machine, without a window
  --help              print this help

Exit codes: 0 success, 2 invalid input or output, 3 no device or window, 128 + N stopped by signal N.
";

/// Parsed options.
#[derive(Clone, Debug, PartialEq)]
pub struct Args {
    /// File to show.
    pub file: Option<PathBuf>,
    /// Preset or settings file of the standard frame.
    pub standard: Option<String>,
    /// Draws the standard frame; the file is a scene.
    pub live: bool,
    /// Initial settings of the live frame.
    pub settings: Option<String>,
    /// Prints the cost of the panels.
    pub measure: bool,
    /// Environment of the live frame.
    pub environment: Option<PathBuf>,
    /// File to compare with.
    pub against: Option<PathBuf>,
    /// File with frame times.
    pub trace: Option<PathBuf>,
    /// Name of a device preset, or path of a device file.
    pub caps: String,
    /// Frame size in texels.
    pub size: Option<[u32; 2]>,
    /// Features to enable (`true`) or disable.
    pub features: Vec<(String, bool)>,
    /// Order of passes.
    pub order: Order,
    /// Name of the selected pass or resource.
    pub select: Option<String>,
    /// View in front.
    pub view: View,
    /// Theme; `None` follows the desktop.
    pub theme: Option<Theme>,
    /// Pixels per point.
    pub scale: f32,
    /// Output file of a run without a window.
    pub out: Option<PathBuf>,
    /// Size of the output picture in pixels.
    pub picture: Option<[u32; 2]>,
    /// Draws the whole application instead of one view.
    pub whole: bool,
    /// Number of frames after which the window closes.
    pub frames: Option<u64>,
}

/// Parses the command line without the program name; `None` if help is requested.
///
/// # Errors
/// One line that names the option and the expected value.
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
            Arg::Short(letter) => return Err(format!("unknown option `-{letter}`; see --help")),
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
        (true, None) => return Err("--headless: requires --out FILE.png or --out FILE.svg".into()),
        (false, Some(_)) => return Err("--out: requires --headless".into()),
        _ => {}
    }
    let without_window =
        [(headless, "--headless"), (out.measure, "--measure")].into_iter().find(|(present, _)| *present);
    if let (Some((_, other)), true) = (without_window, out.frames.is_some()) {
        return Err(format!("--frames: cannot be used with {other}; it has no window"));
    }
    if out.measure && (headless || out.live || out.file.is_some() || out.standard.is_some()) {
        return Err("--measure: cannot be combined with other modes or a FILE; it measures its own plans".into());
    }
    if !headless && (out.whole || out.picture.is_some()) {
        return Err("--whole, --picture: require --headless".into());
    }
    if out.standard.is_some() && out.file.is_some() {
        return Err("--standard: cannot be used with a FILE".into());
    }
    if out.live && (headless || out.standard.is_some()) {
        return Err("--live: cannot be used with --headless or --standard".into());
    }
    if !out.live && (out.settings.is_some() || out.environment.is_some()) {
        return Err("--settings, --environment: require --live".into());
    }
    if headless && out.file.is_none() && out.standard.is_none() && out.view.is_of_a_plan() {
        return Err("--headless: requires a file; add --plan FILE".into());
    }
    Ok(Some(out))
}

/// Parses the value of one option.
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
        return Err(format!("unknown option `--{option}`; see --help"));
    }
    let name = format!("--{option}");
    let value = parser.value().map_err(|_| format!("{name}: missing value; see --help"))?;
    match option {
        "plan" => return set(&mut out.file, value.into(), "FILE"),
        "against" => return set(&mut out.against, value.into(), &name),
        "environment" => return set(&mut out.environment, value.into(), &name),
        "trace" => return set(&mut out.trace, value.into(), &name),
        "out" => return set(&mut out.out, value.into(), &name),
        _ => {}
    }
    let value = value.string().map_err(|_| format!("{name}: the value is not UTF-8"))?;
    let wrong = |expected: &str| format!("{name}: invalid value `{value}`; expected {expected}");
    match option {
        "caps" => out.caps = value,
        "select" => out.select = Some(value),
        "standard" => out.standard = Some(value),
        "settings" => out.settings = Some(value),
        "size" => out.size = Some(sides(&value, 65536).ok_or_else(|| wrong("WxH, each from 1 to 65536 texels"))?),
        "picture" => {
            let max = viewer::offscreen::MAX_PX;
            out.picture = Some(sides(&value, max).ok_or_else(|| wrong("WxH, each from 1 to 8192 pixels"))?);
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

/// Stores a value and rejects a second one.
fn set(place: &mut Option<PathBuf>, value: PathBuf, name: &str) -> Result<(), String> {
    match place.replace(value) {
        None => Ok(()),
        Some(_) => Err(format!("{name}: specified twice; remove one")),
    }
}

fn sides(value: &str, max: u32) -> Option<[u32; 2]> {
    let (w, h) = value.split_once('x')?;
    let side = |s: &str| s.parse().ok().filter(|side| (1..=max).contains(side));
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
            ("a.ron b.ron", "FILE: specified twice"),
            ("a.ron --plan b.ron", "FILE: specified twice"),
            ("--live --standard low", "--live"),
            ("--settings low", "require --live"),
            ("--frames 3 --headless --plan a.json --out a.png", "--frames: cannot be used with --headless"),
            ("a.json --measure", "--measure: cannot"),
            ("a.json --whole", "require --headless"),
            ("a.json --picture 8x8", "require --headless"),
            ("--capz tiler", "--capz"),
            ("-x", "-x"),
            ("a.ron --standard low", "--standard"),
            ("--caps", "--caps"),
            ("--view picture", "--view: invalid value `picture`"),
            ("--size 0x4", "--size: invalid value `0x4`"),
            ("--picture 9000x1", "--picture: invalid value `9000x1`"),
            ("--scale 9", "--scale: invalid value `9`"),
            ("--theme blue", "--theme: invalid value `blue`"),
            ("--order best", "declared or optimized"),
            ("--set =on", "--set: invalid value `=on`"),
            ("--frames x", "--frames: invalid value `x`"),
            ("--headless --plan a.json", "--out"),
            ("--out a.png", "--headless"),
            ("--headless --out a.png", "--plan"),
        ] {
            let error = parsed(line).expect_err(line);
            assert!(error.contains(named) && !error.contains('\n'), "{line}: {error}");
        }
    }
}
