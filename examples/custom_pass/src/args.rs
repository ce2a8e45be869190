//! The command line of `custom_pass`.

use custom_pass::frame::Settings;
use std::ffi::OsString;
use std::path::PathBuf;

/// What `custom_pass --help` prints.
pub const HELP: &str = "\
An engine of its own with two effects from the render graph: a glow and outlines.

usage: custom_pass [options]

  --out FILE.png   draw without a window, and write the last frame
  --size WxH       size of the picture, or of the window at first, in pixels (960x540)
  --frames N       frames to draw, at 60 a second of the animation; without --out, the window closes after them (1 with
                   --out, without end in a window)
  --no-blur        begin without the glow
  --no-outline     begin without outlines
  --plan           print what the compiler planned, with its reasons
  --help           this text

In the window, B and O switch glow and outlines, P prints the plan, the space bar stops time, Escape closes.

WGPU_BACKEND and WGPU_ADAPTER_NAME choose another adapter.
Exit codes: 0 done, 1 the device failed, 2 bad input or output, 128 and its number after a signal.";

/// What was asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Args {
    /// The picture; a window without.
    pub out: Option<PathBuf>,
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// Frames to draw.
    pub frames: Option<u32>,
    /// Effects to begin with.
    pub settings: Settings,
    /// Print the plan.
    pub plan: bool,
}

/// What the command line comes to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Command {
    /// Print the help.
    Help,
    /// Draw.
    Draw(Args),
}

/// Reads the command line; `args` without the program's name.
///
/// # Errors
/// One line that names the option and what it takes.
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
            Value(value) => return Err(format!("{value:?}: no file is read; `custom_pass --help` lists the options")),
            Long(name) => return Err(format!("--{name}: unknown option; `custom_pass --help` lists them")),
            Short(name) => return Err(format!("-{name}: unknown option; `custom_pass --help` lists them")),
        }
    }
    Ok(Command::Draw(found))
}

fn text(parser: &mut lexopt::Parser, option: &str) -> Result<String, String> {
    let value = parser.value().map_err(|_| format!("{option}: a value is missing"))?;
    value.into_string().map_err(|v| format!("{option} {v:?}: the value is not Unicode"))
}

fn png(parser: &mut lexopt::Parser) -> Result<PathBuf, String> {
    let path = parser.value().map(PathBuf::from).map_err(|_| "--out: a file is missing".to_owned())?;
    let fits = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    if fits || program::outputs::is_special(&path) {
        Ok(path)
    } else {
        Err(format!("--out {}: the file must end in .png", path.display()))
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("--size {text}: two whole numbers from 1 are needed, such as 1280x720");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
    match [width, height].map(str::parse::<u32>) {
        [Ok(width), Ok(height)] if width > 0 && height > 0 => Ok([width, height]),
        _ => Err(wrong()),
    }
}

fn frames(text: &str) -> Result<u32, String> {
    match text.parse::<u32>() {
        Ok(frames @ 1..=1_000_000) => Ok(frames),
        _ => Err(format!("--frames {text}: a number from 1 to 1000000 is needed")),
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
            let told = args(words).err().unwrap_or_else(|| panic!("{words:?} was taken"));
            assert!(told.contains(words[0]) && !told.contains('\n'), "{told}");
        }
    }
}
