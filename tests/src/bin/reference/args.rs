//! Command line of `reference`.

use ::tests::files::references;
use ::tests::reference::studio::Shade;
use std::ffi::OsString;
use std::path::PathBuf;

/// Text of `--help`.
pub const HELP: &str = "\
Renders the scenes described in a folder, and compares them with reference pictures.

usage: reference [DIR [ID...]] [options]

DIR has statements (.json) with their pictures (.exr or .png) and charts (.csv). The default is
tests/references/filament of this repository. An ID selects a statement by its name without extension.

  --assets DIR         folder of models that statements name by their SHA-256
  --out DIR            write rendered pictures (ID.png, ID.exr) and differences (ID.difference.png: 8-bit
                       differences times 8)
  --json FILE          write the table as JSON
  --quality maker|low|high|ultra
                       shading quality: that of Filament's references, which is our low quality with the exact
                       DFG table and without occlusion of reflections, or a preset (maker)
  --compare-quality    compare the high quality with the low one, instead of with the references
  --help               print this help

Exit codes: 0 if every rule holds; 1 if one does not, or accepts a picture that is a tenth too bright; 2 on
invalid input or output; 128 and its number after a signal.
Scenes with features that are not implemented are skipped, and their keys are listed.";

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
    Help,
    /// Compare pictures.
    Run(Args),
}

/// Parses the command line, without the program's name.
///
/// # Errors
/// One line that names the option and the values it takes.
pub fn parse(args: impl IntoIterator<Item = OsString>) -> Result<Command, String> {
    use lexopt::prelude::*;
    let mut parser = lexopt::Parser::from_args(args);
    let mut found = Args {
        folder: PathBuf::new(),
        ids: Vec::new(),
        assets: None,
        out: None,
        shade: Shade::Maker,
        compare_quality: false,
        json: None,
    };
    let mut folder = None;
    while let Some(arg) = parser.next().map_err(|error| error.to_string())? {
        let path = |parser: &mut lexopt::Parser, option: &str| {
            parser.value().map(PathBuf::from).map_err(|_| format!("{option}: missing value"))
        };
        match arg {
            Long("help") | Short('h') => return Ok(Command::Help),
            Long("assets") => found.assets = Some(path(&mut parser, "--assets")?),
            Long("out") => found.out = Some(path(&mut parser, "--out")?),
            Long("quality") => {
                let given =
                    parser.value().map_err(|_| "--quality: missing value; use maker, low, high or ultra".to_owned())?;
                let named = given.to_str().and_then(Shade::from_name);
                found.shade = named.ok_or_else(|| {
                    format!("--quality {}: unknown quality; use maker, low, high or ultra", given.display())
                })?;
            }
            Long("compare-quality") => found.compare_quality = true,
            Long("json") => found.json = Some(path(&mut parser, "--json")?),
            Value(value) if folder.is_none() => folder = Some(PathBuf::from(value)),
            Value(value) => {
                found.ids.push(value.into_string().map_err(|v| format!("ID {v:?}: the name is not Unicode"))?);
            }
            Long(name) => return Err(format!("--{name}: unknown option; see `reference --help`")),
            Short(name) => return Err(format!("-{name}: unknown option; see `reference --help`")),
        }
    }
    found.folder = folder.unwrap_or_else(references);
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
        assert_eq!(parsed(&["--help"]), Ok(Command::Help));
        let Ok(Command::Run(found)) = parsed(&["--compare-quality"]) else { panic!("a sound command line") };
        assert!(
            found.compare_quality && found.folder.join("02_grid_sun_noshadow.json").is_file(),
            "the repository's own"
        );
    }

    #[test]
    fn wrong_words_are_named() {
        for (words, named) in [
            (&["refs", "--out"][..], "--out: missing value"),
            (&["refs", "--fast"], "--fast: unknown option"),
            (&["refs", "--quality", "best"], "--quality best"),
            (&["refs", "-x"], "-x: unknown option"),
        ] {
            let told = parsed(words).expect_err("the command line is wrong");
            assert!(told.contains(named) && !told.contains('\n'), "{told}");
        }
    }
}
