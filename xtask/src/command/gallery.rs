//! `cargo xtask gallery`: renders the pictures of docs/gallery/README.md.

use std::fs;
use std::path::Path;

use super::Command;
use crate::options::Options;
use crate::{Failure, adapter, stage, workspace};

/// The command.
pub const COMMAND: Command = Command {
    name: "gallery",
    summary: "build in release and render the pictures of docs/gallery/README.md",
    details: "\
Renders the pictures of docs/gallery/README.md into docs/gallery/ by the commands listed
there. FlightHelmet is not part of the repository; if it is missing, its pictures
are kept and a message says so. tests/assets/README.md says where to find it.
",
    run,
};

/// Folder of the pictures, relative to the workspace's root.
const FOLDER: &str = "docs/gallery";
/// Folder of the plans, which the gallery does not show.
const PLANS: &str = "target/gallery";
/// Maximum size of a picture, in bytes.
const MAX_BYTES: u64 = 60_000;

/// A model that is too large for the repository.
const HELMET: &str = "tests/assets/models/FlightHelmet/FlightHelmet.gltf";

/// The pictures: name, model, and options for the light.
const PICTURES: [(&str, Model, &str); 33] = [
    ("balls-studio", Model::Balls, "--environment tests/assets/hdri/studio.hdr"),
    ("balls-sunset", Model::Balls, "--environment tests/assets/hdri/sunset.hdr"),
    ("balls-aces", Model::Balls, "--environment tests/assets/hdri/sunset.hdr --tone-map aces"),
    ("balls-agx", Model::Balls, "--environment tests/assets/hdri/sunset.hdr --tone-map agx --grade-by table:32:f16"),
    (
        "balls-graded",
        Model::Balls,
        "--environment tests/assets/hdri/sunset.hdr --grade temperature=-0.6,contrast=1.2,shadows=0.8:1:1.3:0 --edge-fade roundness=0.3",
    ),
    ("balls-venice", Model::Balls, "--environment tests/assets/hdri/venice.hdr"),
    ("balls-park", Model::Balls, "--environment tests/assets/hdri/park.hdr"),
    ("balls-park-negative", Model::Balls, "--environment tests/assets/hdri/park_negative.exr"),
    ("balls-sky", Model::Balls, "--exposure 16,1/125,100"),
    ("balls-uniform", Model::Balls, "--environment uniform:100,100,100"),
    ("balls-sun", Model::Balls, "--environment uniform:100,100,100 --sun 1,2,2:600 --background 20,20,20"),
    ("columns-open", Model::Columns, "--environment uniform:1000,1000,1000 --sun off"),
    ("columns-occlusion", Model::Columns, "--environment uniform:1000,1000,1000 --sun off --ao gtao"),
    ("spheres-environment", Model::Spheres, "--ssr off"),
    ("spheres-reflections", Model::Spheres, "--ssr on"),
    ("glass-one-layer", Model::Glass, "--glass-layers 1"),
    ("glass-layers", Model::Glass, "--glass-layers 3"),
    ("panes-sorted", Model::Panes, "--transparency sorted"),
    ("panes-two-passes", Model::Panes, "--transparency two-passes"),
    ("panes-weighted", Model::Panes, "--transparency weighted"),
    ("panes-moments", Model::Panes, "--transparency moments"),
    ("panes-peeled", Model::Panes, "--transparency peeled:layers=12"),
    ("columns-clear", Model::Aisle, "--fog off"),
    ("columns-fog", Model::Aisle, "--fog on:density=0.15,falloff=0.6,sharp=40"),
    ("balls-bloom", Model::Lamps, "--bloom on:strength=0.25"),
    ("balls-flare", Model::Lamps, "--bloom on:strength=0.25,dirt=12,flare=on --dirt tests/assets/lens_dirt.png"),
    ("balls-focus", Model::Near, "--dof on:focus=2.4,aperture=1.4,focal=0.085"),
    ("edges-fxaa", Model::Edges, "--msaa 1"),
    ("edges-taa", Model::Edges, "--msaa 1 --no-fxaa --taa on --frames 32"),
    ("helmet-studio", Model::Helmet, "--environment tests/assets/hdri/studio.hdr"),
    ("helmet-sunset", Model::Helmet, "--environment tests/assets/hdri/sunset.hdr"),
    ("helmet-venice", Model::Helmet, "--environment tests/assets/hdri/venice.hdr"),
    ("helmet-park", Model::Helmet, "--environment tests/assets/hdri/park.hdr"),
];

/// Model to render.
#[derive(Clone, Copy)]
enum Model {
    Balls,
    Columns,
    Spheres,
    Glass,
    Panes,
    Aisle,
    Lamps,
    Near,
    Edges,
    Helmet,
}

impl Model {
    const fn words(self) -> &'static str {
        match self {
            Self::Balls => "balls --camera wide --size 368x105",
            Self::Columns => "columns --size 368x207",
            Self::Spheres => "spheres --camera 0,1.3,6.4:-2.3,0.25,2:30 --size 336x189",
            Self::Glass => "glass --camera 2.1,0.75,3.1:1.5,0.42,0:36 --size 256x144",
            Self::Panes => "panes --size 232x130",
            Self::Aisle => "columns --size 368x207 --camera 0.5,1.2,6:0,1.2,-4:45",
            Self::Lamps => {
                "balls --camera -1.3,0.5,3.2:-1.3,0.33,0:34 --size 272x153 --environment tests/assets/hdri/studio.hdr --compensation 1 --resolve tone"
            }
            Self::Near => "balls --camera 2.2,0.8,1.6:-1,0.3,-0.4:30 --size 368x207",
            Self::Edges => "columns --size 184x104",
            Self::Helmet => "tests/assets/models/FlightHelmet/FlightHelmet.gltf --size 168x198",
        }
    }

    /// Returns the file of the model; `None` for built-in models.
    fn file(self) -> Option<&'static str> {
        match self {
            Self::Helmet => Some(HELMET),
            _ => None,
        }
    }
}

/// Returns the arguments of `render` for a picture, as the document lists them.
fn words((name, model, light): (&str, Model, &str)) -> String {
    let model = model.words();
    // Effects that accumulate over frames need several of them.
    let frames = if light.contains("--frames") { "" } else { " --frames 1" };
    format!("{model} {light} --dither 0{frames} --out {FOLDER}/{name}.png --plan {PLANS}/{name}.txt")
}

fn run(options: &Options) -> Result<(), Failure> {
    let root = workspace::root();
    adapter::ready(options)?;
    for folder in [FOLDER, PLANS] {
        fs::create_dir_all(root.join(folder)).map_err(|error| Failure::Failed(format!("{folder}: {error}")))?;
    }
    let build = ["build", "--release", "--package", "examples", "--bin", "render"];
    stage::run("build", &mut workspace::cargo(&build))
        .result
        .map_err(|reason| Failure::Failed(format!("build: {reason}")))?;
    for picture in PICTURES {
        let (name, model, _) = picture;
        if !model.file().is_none_or(|file| root.join(file).is_file()) {
            program::line(format_args!(
                "== {name}: skipped; {HELMET} is not here, and tests/assets/README.md says where to find it"
            ));
            continue;
        }
        let line = format!("run --quiet --release --package examples --bin render -- {}", words(picture));
        let arguments: Vec<&str> = line.split(' ').collect();
        let made = stage::run(name, &mut workspace::cargo(&arguments)).result;
        made.map_err(|reason| Failure::Failed(format!("{name}: {reason}")))?;
        small(&root.join(FOLDER).join(format!("{name}.png"))).map_err(Failure::Failed)?;
    }
    Ok(())
}

/// Checks the size of a picture: the history of a repository keeps every version.
fn small(picture: &Path) -> Result<(), String> {
    let length = fs::metadata(picture).map_err(|error| format!("{}: {error}", picture.display()))?.len();
    if length <= MAX_BYTES {
        return Ok(());
    }
    Err(format!("{}: {length} bytes exceed the limit of {MAX_BYTES}; reduce the picture size", picture.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The document lists the command of every picture, every picture exists, and none is too large.
    #[test]
    fn the_document_shows_every_picture_with_its_command() {
        let document = include_str!("../../../docs/gallery/README.md");
        for picture in PICTURES {
            let (name, ..) = picture;
            let command = format!("cargo run --release --bin render -- {}", words(picture));
            assert!(document.contains(&command), "docs/gallery/README.md lacks `{command}`");
            assert!(document.contains(&format!("]({name}.png)")), "docs/gallery/README.md does not show {name}");
            small(&workspace::root().join(FOLDER).join(format!("{name}.png"))).expect("a small picture");
        }
        let shown = document.matches(".png)").count();
        assert_eq!(shown, PICTURES.len(), "the document shows what the command does not make");
    }
}
