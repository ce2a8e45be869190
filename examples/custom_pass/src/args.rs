//! Command line of `custom_pass`.

use custom_pass::frame::Settings;
use std::ffi::OsString;
use std::path::PathBuf;

/// Text of `custom_pass --help`.
pub const HELP: &str = "\
Draws an animation with an existing engine and two effects from the render graph: a glow and outlines.

usage: custom_pass [options]

  --out FILE.png   draw without a window and write the last frame
  --size WxH       picture size or initial window size in pixels (960x540)
  --frames N       number of frames to draw; with --out at 60 frames per second of the animation (1), else the window
                   closes after them (unlimited)
  --no-blur        start without the glow
  --no-outline     start without outlines
  --plan           print the plan with its reasons
  --help           print this help

Keys in the window: B and O toggle glow and outlines, P prints the plan, space pauses, Escape closes.

WGPU_BACKEND and WGPU_ADAPTER_NAME select another adapter.
Exit codes: 0 success, 1 device failure, 2 invalid input or output, 128 + N stopped by signal N.";

/// Parsed options of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Args {
    /// Output file; `None` opens a window.
    pub out: Option<PathBuf>,
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// Number of frames to draw.
    pub frames: Option<u32>,
    /// Effects that are enabled at the start.
    pub settings: Settings,
    /// Prints the plan.
    pub plan: bool,
}

/// Parsed command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Command {
    /// Print the help.
    Help,
    /// Draw.
    Draw(Args),
}

/// Parses the command line; `args` excludes the program name.
///
/// # Errors
/// One line that names the option and the expected value.
pub fn parse(args: impl IntoIterator<Item = OsString>) -> Result<Command, String> {
    use lexopt::prelude::*;
    let mut parser = lexopt::Parser::from_args(args);
    let mut found = Args { out: None, size_px: [960, 540], frames: None, settings: Settings::default(), plan: false };
    while let Some(arg) = parser.next().map_err(|e| e.to_string())? {
        match arg {
            Long("help") | Short('h') => return Ok(Command::Help),
            Long("out") => found.out = Some(png(&mut parser)?),
            Long("size") => found.size_px = size(&text(&mut parser, "--size")?)?,
            Long("frames") => found.frames = Some(frames(&text(&mut parser, "--frames")?)?),
            Long("no-blur") => found.settings.blur = false,
            Long("no-outline") => found.settings.outline = false,
            Long("plan") => found.plan = true,
            Value(value) => return Err(format!("{value:?}: unexpected argument; see `custom_pass --help`")),
            Long(name) => return Err(format!("--{name}: unknown option; see `custom_pass --help`")),
            Short(name) => return Err(format!("-{name}: unknown option; `custom_pass --help` lists them")),
        }
    }
    Ok(Command::Draw(found))
}

fn text(parser: &mut lexopt::Parser, option: &str) -> Result<String, String> {
    let value = parser.value().map_err(|_| format!("{option}: missing value"))?;
    value.into_string().map_err(|v| format!("{option} {v:?}: the value is not Unicode"))
}

fn png(parser: &mut lexopt::Parser) -> Result<PathBuf, String> {
    let path = parser.value().map(PathBuf::from).map_err(|_| "--out: missing file".to_owned())?;
    let fits = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    if fits || program::outputs::is_special(&path) {
        Ok(path)
    } else {
        Err(format!("--out {}: the file must end in .png", path.display()))
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("--size {text}: expected two whole numbers from 1, such as 1280x720");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
    match [width, height].map(str::parse::<u32>) {
        [Ok(width), Ok(height)] if width > 0 && height > 0 => Ok([width, height]),
        _ => Err(wrong()),
    }
}

fn frames(text: &str) -> Result<u32, String> {
    match text.parse::<u32>() {
        Ok(frames @ 1..=1_000_000) => Ok(frames),
        _ => Err(format!("--frames {text}: expected a number from 1 to 1000000")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args(words: &[&str]) -> Result<Command, String> {
        parse(words.iter().map(OsString::from))
    }

    #[test]
    fn what_is_asked_for_is_read() {
        let settings = Settings { blur: false, outline: true };
        let expected = Args { out: Some("a.PNG".into()), size_px: [64, 48], frames: Some(3), settings, plan: true };
        let words = ["--out", "a.PNG", "--size=64x48", "--frames", "3", "--no-blur", "--plan"];
        assert_eq!(args(&words), Ok(Command::Draw(expected)));
        assert_eq!(args(&["-h"]), Ok(Command::Help));
    }

    #[test]
    fn wrong_words_are_named_in_one_line() {
        let cases: [&[&str]; 9] = [
            &["--size", "0x4"],
            &["--size", "4"],
            &["--size"],
            &["--frames", "0"],
            &["--frames", "many"],
            &["--out", "a.jpg"],
            &["--out"],
            &["--glow"],
            &["scene.gltf"],
        ];
        for words in cases {
            let error = args(words).err().unwrap_or_else(|| panic!("{words:?} was taken"));
            assert!(error.contains(words[0]) && !error.contains('\n'), "{error}");
        }
    }
}
