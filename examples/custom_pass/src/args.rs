//! Command line of `custom_pass`.

use custom_pass::frame::Settings;
use program::clap;
use program::cli::{self, Parsed, flag, option};
use std::ffi::OsString;
use std::path::PathBuf;

const ABOUT: &str = "\
Draws an animation with an existing engine and two effects from the render graph: a glow and outlines.";

const AFTER: &str = "\
Keys in the window: B and O toggle glow and outlines, P prints the plan, space pauses, Escape closes.

WGPU_BACKEND and WGPU_ADAPTER_NAME select another adapter.
Exit codes: 0 success, 1 device failure, 2 invalid input or output, 128 + N stopped by signal N.";

/// Returns the declaration of all options.
fn command() -> clap::Command {
    cli::command("custom_pass", ABOUT, AFTER).args([
        option("out", "FILE.png", "Draw without a window and write the last frame"),
        option("size", "WxH", "Picture size or initial window size in pixels (960x540)"),
        option(
            "frames",
            "N",
            "Number of frames to draw; with --out at 60 frames per second of the animation (1), else the window closes \
             after them (unlimited)",
        ),
        flag("no-blur", "Start without the glow"),
        flag("no-outline", "Start without outlines"),
        flag("plan", "Print the plan with its reasons"),
    ])
}

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
    Help(String),
    /// Draw.
    Draw(Args),
}

/// Parses the command line; `args` excludes the program name.
///
/// # Errors
/// One line that names the option and the expected value.
pub fn parse(args: impl IntoIterator<Item = OsString>) -> Result<Command, String> {
    let given = match cli::parse(command(), args)? {
        Parsed::Help(text) => return Ok(Command::Help(text)),
        Parsed::Given(given) => given,
    };
    let mut found = Args { out: None, size_px: [960, 540], frames: None, settings: Settings::default(), plan: false };
    for item in given {
        match item.name() {
            "out" => found.out = Some(png(item.raw().into())?),
            "size" => found.size_px = item.parse("two whole numbers from 1, such as 1280x720", size)?,
            "frames" => found.frames = Some(item.parse("a number from 1 to 1000000", frames)?),
            "no-blur" => found.settings.blur = false,
            "no-outline" => found.settings.outline = false,
            _ => found.plan = true,
        }
    }
    Ok(Command::Draw(found))
}

fn png(path: PathBuf) -> Result<PathBuf, String> {
    let fits = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    if fits || program::outputs::is_special(&path) {
        Ok(path)
    } else {
        Err(format!("--out {}: the file must end in .png", path.display()))
    }
}

fn size(text: &str) -> Option<[u32; 2]> {
    let (width, height) = text.split_once(['x', 'X'])?;
    Some([width.parse().ok()?, height.parse().ok()?]).filter(|size| !size.contains(&0))
}

fn frames(text: &str) -> Option<u32> {
    text.parse().ok().filter(|frames| (1..=1_000_000).contains(frames))
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
        assert!(matches!(args(&["-h"]), Ok(Command::Help(_))));
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
