//! Command line of `viewer`.

use framegraph::{Caps, Order};
use program::clap::{self, ArgAction};
use program::cli::{self, Parsed, argument, flag, option};
use std::ffi::OsString;
use std::path::PathBuf;
use viewer::app::Pane;
use viewer::drawing::Theme;
use viewer::view::View;

/// Default view of a picture.
pub const GRAPH: Pane = Pane::View(View::Graph);

const ABOUT: &str = "Shows the passes, decisions and costs of a frame.";

const USAGE: &str = "\
viewer [FILE] [OPTIONS]
       viewer --headless --view VIEW --plan FILE [--against FILE] --out FILE.png|svg
       viewer --standard PRESET|SETTINGS.ron [OPTIONS]
       viewer --live [SCENE] [--settings PRESET|SETTINGS.ron] [--environment FILE] [OPTIONS]";

const AFTER: &str =
    "Exit codes: 0 success, 2 invalid input or output, 3 no device or window, 128 + N stopped by signal N.";

/// Returns the declaration of all options.
fn command() -> clap::Command {
    cli::command("viewer", ABOUT, AFTER).override_usage(USAGE).args([
        argument(
            "FILE",
            "A plan (JSON, docs/reference/plan-json.md), a graph (FRAME.ron, docs/reference/graph-format.md), or a trace \
             (`render --trace`). Graphs are compiled here, and again after each change. docs/reference/viewer.md shows the \
             views",
        ),
        option("plan", "FILE", "Same as FILE").conflicts_with("FILE"),
        option(
            "standard",
            "PRESET",
            "Show the standard frame instead of a file: low, medium, high, ultra, or a FILE.ron of settings \
             (docs/reference/settings.md); its effects are features",
        )
        .conflicts_with_all(["FILE", "plan"]),
        flag(
            "live",
            "Draw the standard frame in the window and show its plan; FILE is a glTF or GLB file or a built-in scene \
             (spheres)",
        )
        .conflicts_with_all(["headless", "standard"]),
        option(
            "attach",
            "HOST:PORT",
            "Show plan, times and textures of a running engine (framegraph_wgpu::remote; 127.0.0.1:9870)",
        )
        .conflicts_with_all(["FILE", "plan", "live", "standard"]),
        option("settings", "PRESET", "Initial settings with --live: a preset or a FILE.ron (high)"),
        option(
            "environment",
            "FILE",
            "Environment light with --live: a .hdr, .exr or .ktx picture; default: a clear sky",
        ),
        option("against", "FILE", "Plan or graph to compare with"),
        option("trace", "FILE", "Frame times to show"),
        option(
            "caps",
            "DEVICE",
            format!("Device for graphs: {}, or a FILE.ron that describes one (wgpu)", Caps::PRESETS.join(", ")),
        ),
        option("size", "WxH", "Frame size in texels; default: the size in the file, else 1920x1080"),
        option("set", "FEATURE=on|off", "Enable or disable a feature of the graph; repeatable").action(ArgAction::Append),
        option("order", "ORDER", "declared or optimized"),
        option("select", "NAME", "Select a pass or a resource"),
        option(
            "view",
            "VIEW",
            format!("{}; default: the last one, graph without a window", Pane::drawn().map(Pane::word).collect::<Vec<_>>().join(", ")),
        ),
        option("theme", "THEME", "light or dark; default: the last one, else that of the desktop; light without a window"),
        option("scale", "X", "Pixels per point, 0.5 to 4 (1)"),
        flag("headless", "Write --out without opening a window"),
        option("out", "FILE", "Output of --headless, .png or .svg"),
        option("picture", "WxH", "Size of a PNG in pixels; default: the size of the view"),
        flag("whole", "Draw the whole application into the PNG (1280x720)"),
        option(
            "frames",
            "N",
            "Draw continuously, close the window after N or N + 1 frames, and print their number",
        )
        .conflicts_with_all(["headless", "measure"]),
        flag(
            "measure",
            "Print the cost of the panels on this machine, without a window, also while the scene FILE loads (spheres)",
        )
        .conflicts_with_all(["headless", "live", "plan", "standard"]),
    ])
}

/// Parsed options.
#[derive(Clone, Debug, PartialEq)]
pub struct Args {
    /// File to show.
    pub file: Option<PathBuf>,
    /// Preset or settings file of the standard frame.
    pub standard: Option<String>,
    /// Draws the standard frame; the file is a scene.
    pub live: bool,
    /// Address of the engine to attach to.
    pub attach: Option<String>,
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
    /// View in front; `None` for the remembered one, without a window the graph.
    pub view: Option<Pane>,
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

/// Parsed command line.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Print the help.
    Help(String),
    /// Show a frame.
    Show(Box<Args>),
}

/// Parses the command line without the program name.
///
/// # Errors
/// One line that names the option and the expected value.
pub fn parse(args: impl Iterator<Item = OsString>) -> Result<Command, String> {
    let given = match cli::parse(command(), args)? {
        Parsed::Help(text) => return Ok(Command::Help(text)),
        Parsed::Given(given) => given,
    };
    let headless = given.has("headless");
    for (name, other) in [
        ("out", "headless"),
        ("whole", "headless"),
        ("picture", "headless"),
        ("settings", "live"),
        ("environment", "live"),
    ] {
        if given.has(name) && !given.has(other) {
            return Err(format!("--{name}: requires --{other}"));
        }
    }
    if headless && !given.has("out") {
        return Err("--headless: requires --out FILE.png or --out FILE.svg".into());
    }
    let mut out = Args {
        file: None,
        standard: None,
        live: false,
        measure: false,
        attach: None,
        settings: None,
        environment: None,
        against: None,
        trace: None,
        caps: "wgpu".into(),
        size: None,
        features: Vec::new(),
        order: Order::Declared,
        select: None,
        view: None,
        theme: None,
        scale: 1.0,
        out: None,
        picture: None,
        whole: false,
        frames: None,
    };
    for item in given {
        let max = viewer::offscreen::MAX_PX;
        match item.name() {
            "headless" => {}
            "whole" => out.whole = true,
            "live" => out.live = true,
            "measure" => out.measure = true,
            "FILE" | "plan" => out.file = Some(item.raw().into()),
            "against" => out.against = Some(item.raw().into()),
            "environment" => out.environment = Some(item.raw().into()),
            "trace" => out.trace = Some(item.raw().into()),
            "out" => out.out = Some(item.raw().into()),
            "attach" => out.attach = Some(item.text()?),
            "caps" => out.caps = item.text()?,
            "select" => out.select = Some(item.text()?),
            "standard" => out.standard = Some(item.text()?),
            "settings" => out.settings = Some(item.text()?),
            "size" => out.size = Some(item.parse("WxH, each from 1 to 65536 texels", |text| sides(text, 65536))?),
            "picture" => {
                out.picture = Some(item.parse("WxH, each from 1 to 8192 pixels", |text| sides(text, max))?);
            }
            "set" => out.features.push(item.parse("FEATURE=on or FEATURE=off", switch)?),
            "order" => out.order = item.parse("declared or optimized", order)?,
            "view" => {
                let views = format!("one of {}", Pane::drawn().map(Pane::word).collect::<Vec<_>>().join(", "));
                out.view = Some(item.parse(&views, |text| Pane::drawn().find(|pane| pane.word() == text))?);
            }
            "theme" => out.theme = Some(item.parse("light or dark", theme)?),
            "scale" => {
                let scale = |text: &str| text.parse().ok().filter(|scale| (0.5..=4.0).contains(scale));
                out.scale = item.parse("a number from 0.5 to 4", scale)?;
            }
            _ => out.frames = Some(item.parse("a whole number of frames", |text| text.parse().ok())?),
        }
    }
    let has_plan = out.file.is_some() || out.standard.is_some() || out.attach.is_some();
    if headless && !has_plan && out.view.unwrap_or(GRAPH).is_of_a_plan() {
        return Err("--headless: requires a file; add --plan FILE".into());
    }
    Ok(Command::Show(Box::new(out)))
}

fn order(text: &str) -> Option<Order> {
    match text {
        "declared" => Some(Order::Declared),
        "optimized" => Some(Order::Optimized),
        _ => None,
    }
}

fn theme(text: &str) -> Option<Theme> {
    match text {
        "light" => Some(Theme::Light),
        "dark" => Some(Theme::Dark),
        _ => None,
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

    fn parsed(line: &str) -> Result<Command, String> {
        parse(line.split_whitespace().map(OsString::from))
    }

    #[test]
    fn the_whole_command_line_is_read() {
        let line = "--headless --view memory --plan a.json --against b.ron --trace t.json --caps tiler --size 64x32 \
                    --set msaa=on --order optimized --select hdr --theme dark --scale 2 --out c.png --picture 640x360 \
                    --whole";
        let Ok(Command::Show(args)) = parsed(line) else { panic!("the line is sound") };
        assert_eq!((args.file, args.against), (Some("a.json".into()), Some("b.ron".into())));
        assert_eq!((args.view, args.theme, args.scale), (Some(Pane::View(View::Memory)), Some(Theme::Dark), 2.0));
        assert_eq!((args.size, args.picture, args.whole), (Some([64, 32]), Some([640, 360]), true));
        assert_eq!((args.features, args.order), (vec![("msaa".into(), true)], Order::Optimized));
        assert!(matches!(parsed("--help --capz"), Ok(Command::Help(_))));
    }

    #[test]
    fn every_mistake_is_one_line_that_names_it() {
        for (line, named) in [
            ("a.ron b.ron", "b.ron: unexpected argument"),
            ("a.ron --plan b.ron", "cannot be used with"),
            ("--live --standard low", "--live"),
            ("a.ron --attach 127.0.0.1:1", "--attach"),
            ("--settings low", "--settings: requires --live"),
            ("--frames 3 --headless --plan a.json --out a.png", "--frames: cannot be used with"),
            ("--live --measure", "cannot be used with"),
            ("a.json --whole", "requires --headless"),
            ("a.json --picture 8x8", "requires --headless"),
            ("--capz tiler", "--capz: unknown option; did you mean `--caps`?"),
            ("-x", "-x"),
            ("a.ron --standard low", "--standard"),
            ("--caps", "--caps"),
            ("--view picture", "--view picture: expected one of"),
            ("--size 0x4", "--size 0x4: expected"),
            ("--headless --plan a.json --out a.png --picture 9000x1", "--picture 9000x1: expected"),
            ("--scale 9", "--scale 9: expected"),
            ("--theme blue", "--theme blue: expected"),
            ("--order best", "declared or optimized"),
            ("--set =on", "--set =on: expected"),
            ("--frames x", "--frames x: expected"),
            ("--headless --plan a.json", "--out"),
            ("--out a.png", "--headless"),
            ("--headless --out a.png", "--plan"),
        ] {
            let error = parsed(line).expect_err(line);
            assert!(error.contains(named) && !error.contains('\n'), "{line}: {error}");
        }
    }
}
