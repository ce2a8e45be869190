//! Command line of `reference`.

use ::tests::files::references;
use ::tests::reference::studio::Shade;
use program::clap::{self, ArgAction};
use program::cli::{self, Parsed, argument, flag, option};
use std::ffi::OsString;
use std::path::PathBuf;

const ABOUT: &str = "Renders the scenes described in a folder, and compares them with reference pictures.";

const AFTER: &str = "\
Exit codes: 0 if every rule holds; 1 if one does not, or accepts a picture that is a tenth too bright; 2 on
invalid input or output; 128 and its number after a signal.
Scenes with features that are not implemented are skipped, and their keys are listed.";

/// Returns the declaration of all options.
fn command() -> clap::Command {
    cli::command("reference", ABOUT, AFTER).override_usage("reference [DIR [ID...]] [OPTIONS]").args([
        argument(
            "DIR",
            "Statements (.json) with their pictures (.exr or .png) and charts (.csv); default: tests/references/filament",
        ),
        argument("ID", "Selects a statement by its name without extension").num_args(0..).action(ArgAction::Append),
        option("assets", "DIR", "Folder of models that statements name by their SHA-256"),
        option(
            "out",
            "DIR",
            "Write rendered pictures (ID.png, ID.exr) and differences (ID.difference.png: 8-bit differences times 8)",
        ),
        option("json", "FILE", "Write the table as JSON"),
        option(
            "quality",
            "maker|low|high|ultra",
            "Shading quality: that of Filament's references, which is our low quality with the exact DFG table and without \
             occlusion of reflections, or a preset (maker)",
        ),
        flag("compare-quality", "Compare the high quality with the low one, instead of with the references"),
    ])
}

/// Parsed options.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Args {
    /// Folder of the statements.
    pub folder: PathBuf,
    /// Identifiers of the statements to compare; all if empty.
    pub ids: Vec<String>,
    /// Folder of the models.
    pub assets: Option<PathBuf>,
    /// Output folder of the pictures.
    pub out: Option<PathBuf>,
    /// Shading quality and precision.
    pub shade: Shade,
    /// True to compare the two shading qualities.
    pub compare_quality: bool,
    /// Output file of the table as JSON.
    pub json: Option<PathBuf>,
}

/// Action that the command line requests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Command {
    /// Print the help.
    Help(String),
    /// Compare pictures.
    Run(Args),
}

/// Parses the command line, without the program's name.
///
/// # Errors
/// One line that names the option and the values it takes.
pub fn parse(args: impl IntoIterator<Item = OsString>) -> Result<Command, String> {
    let given = match cli::parse(command(), args)? {
        Parsed::Help(text) => return Ok(Command::Help(text)),
        Parsed::Given(given) => given,
    };
    let mut found = Args {
        folder: references(),
        ids: Vec::new(),
        assets: None,
        out: None,
        shade: Shade::Maker,
        compare_quality: false,
        json: None,
    };
    for item in given {
        match item.name() {
            "DIR" => found.folder = item.raw().into(),
            "ID" => found.ids.extend(item.values()?),
            "assets" => found.assets = Some(item.raw().into()),
            "out" => found.out = Some(item.raw().into()),
            "quality" => found.shade = item.parse("maker, low, high or ultra", Shade::from_name)?,
            "compare-quality" => found.compare_quality = true,
            _ => found.json = Some(item.raw().into()),
        }
    }
    Ok(Command::Run(found))
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_passes::Quality;

    fn parsed(words: &[&str]) -> Result<Command, String> {
        parse(words.iter().map(OsString::from))
    }

    #[test]
    fn options_set_what_they_name() {
        let found = parsed(&["refs", "a", "--out", "o", "b", "--json=j", "--assets", "s", "--quality", "high"]);
        let expected = Args {
            folder: "refs".into(),
            ids: vec!["a".into(), "b".into()],
            assets: Some("s".into()),
            out: Some("o".into()),
            shade: Shade::Preset(Quality::High),
            compare_quality: false,
            json: Some("j".into()),
        };
        assert_eq!(found, Ok(Command::Run(expected)));
        assert!(matches!(parsed(&["--help"]), Ok(Command::Help(_))));
        let Ok(Command::Run(found)) = parsed(&["--compare-quality"]) else { panic!("a sound command line") };
        assert!(
            found.compare_quality && found.folder.join("02_grid_sun_noshadow.json").is_file(),
            "the repository's own"
        );
    }

    #[test]
    fn wrong_words_are_named() {
        for (words, named) in [
            (&["refs", "--out"][..], "--out: missing DIR"),
            (&["refs", "--fast"], "--fast: unknown option"),
            (&["refs", "--quality", "best"], "--quality best"),
            (&["refs", "-x"], "-x: unknown option"),
        ] {
            let told = parsed(words).expect_err("the command line is wrong");
            assert!(told.contains(named) && !told.contains('\n'), "{told}");
        }
    }
}
