//! Opens a source location in the user's editor.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Editors that run in a terminal, which the application does not have.
const IN_TERMINALS: [&str; 10] = ["vi", "vim", "nvim", "nano", "pico", "ed", "hx", "helix", "micro", "kak"];
/// Editor that is used if `VISUAL` and `EDITOR` name none with a window.
const DEFAULT: &str = "code";

/// Opens `PATH:LINE` or `PATH:LINE:COLUMN` in the editor of `VISUAL` or `EDITOR`, or in Visual Studio Code.
///
/// A relative path is relative to the current folder, or else to `sources`: the folder in which the engine was built.
///
/// # Errors
/// One line: the file does not exist, or no editor with a window was found.
pub fn open(place: &str, sources: &Path) -> Result<(), String> {
    let (path, line) = parsed(place);
    let path = existing(path, sources).ok_or_else(|| format!("{path}: the source file does not exist here"))?;
    let named = ["VISUAL", "EDITOR"].into_iter().filter_map(|name| std::env::var(name).ok());
    let [program, arguments @ ..] = &command(named, &path, line)[..] else { return Ok(()) };
    let started =
        Command::new(program).args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    let mut child = started.map_err(|error| {
        let program = program.to_string_lossy();
        format!("{program}: cannot be started: {error}; set EDITOR to an editor with a window")
    })?;
    // The child is awaited on another thread, so that no zombie remains.
    std::thread::spawn(move || child.wait());
    Ok(())
}

/// Splits a place into path and line.
fn parsed(place: &str) -> (&str, u32) {
    let mut path = place;
    let mut line = 1;
    for _ in 0..2 {
        let Some((rest, number)) = path.rsplit_once(':') else { break };
        let Ok(number) = number.parse() else { break };
        (path, line) = (rest, number);
    }
    (path, line)
}

/// Returns the path of a source file, relative to the current folder or to `sources`.
fn existing(path: &str, sources: &Path) -> Option<PathBuf> {
    [PathBuf::from(path), sources.join(path)].into_iter().find(|path| path.is_file())
}

/// Returns the program and its arguments.
fn command(editors: impl Iterator<Item = String>, path: &Path, line: u32) -> Vec<OsString> {
    let words = |text: String| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let name_of = |program: &str| {
        let name = Path::new(program).file_stem().map(|name| name.to_string_lossy().to_lowercase());
        name.unwrap_or_default()
    };
    let has_window = |words: &Vec<String>| words.first().is_some_and(|p| !IN_TERMINALS.contains(&name_of(p).as_str()));
    let editor = editors.map(words).find(has_window).unwrap_or_else(|| vec![DEFAULT.to_owned()]);
    let mut at = path.as_os_str().to_owned();
    at.push(format!(":{line}"));
    let place: Vec<OsString> = match name_of(&editor[0]).as_str() {
        "code" | "code-insiders" | "codium" | "vscodium" | "cursor" => vec!["-g".into(), at],
        "subl" | "sublime_text" | "zed" | "zeditor" | "lapce" => vec![at],
        "idea" | "rustrover" | "clion" | "kate" => vec!["--line".into(), line.to_string().into(), path.into()],
        _ => vec![format!("+{line}").into(), path.into()],
    };
    editor.into_iter().map(OsString::from).chain(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn editors_with_a_window_are_started_at_the_line() {
        let of = |editors: &[&str]| {
            let editors = editors.iter().map(|text| (*text).to_owned());
            let words = command(editors, Path::new("a b.rs"), 12);
            words.iter().map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>()
        };
        assert_eq!(of(&[]), ["code", "-g", "a b.rs:12"]);
        assert_eq!(of(&["vim", "/usr/bin/nano -w"]), ["code", "-g", "a b.rs:12"], "they need a terminal");
        assert_eq!(of(&["", "codium --wait"]), ["codium", "--wait", "-g", "a b.rs:12"]);
        assert_eq!(of(&["gedit"]), ["gedit", "+12", "a b.rs"]);
        assert_eq!(of(&["kate"]), ["kate", "--line", "12", "a b.rs"]);
        assert_eq!(parsed("src/a.rs:3:9"), ("src/a.rs", 3));
        assert_eq!(parsed("frame.ron:7"), ("frame.ron", 7));
        assert_eq!(parsed("frame"), ("frame", 1));
        assert!(open("none.rs:3", Path::new(".")).is_err_and(|error| error.starts_with("none.rs: the source file")));
        assert!(existing("egui/src/editor.rs", Path::new("..")).is_some());
    }
}
