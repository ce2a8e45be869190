//! Options of `render`, and the lists of keys that `--ao help` and others print.

use crate::{accuracy, animation, budget, debug, decide, effects, grade, light, shadows};
use framegraph_passes::frame::tables::sections;
use program::clap::{Arg, Command};
use program::cli::{argument, flag, option};
use std::fmt::Write;

/// Returns the declaration of all options.
pub fn command() -> Command {
    program::cli::command("render", ABOUT, AFTER).override_usage("render [SCENE] [OPTIONS]").args(
        camera()
            .into_iter()
            .chain(animation::options())
            .chain(light::options())
            .chain(shading())
            .chain(post())
            .chain(grade::options())
            .chain(shadows::options())
            .chain(effects::options())
            .chain(decide::options())
            .chain(budget::options())
            .chain(accuracy::options())
            .chain(debug::options())
            .chain(execution())
            .chain(outputs()),
    )
}

/// Returns the list of keys of an option, for the value `help`; `None` for an option without keys.
pub fn keys(option: &str) -> Option<String> {
    let section = sections().iter().find(|section| !option.is_empty() && section.option == option)?;
    let mut text = format!("--{option}: {}\n", section.about);
    if !section.methods.is_empty() && option != "shadow" {
        _ = writeln!(text, "METHOD is one of {}; keys follow as METHOD:KEY=X,KEY=X\n", section.methods.join(", "));
    }
    for row in &section.rows {
        let unit = match row.unit() {
            "" => String::new(),
            "rad" => " degrees".into(),
            unit => format!(" {unit}"),
        };
        let default = if row.default.is_empty() { String::new() } else { format!(" ({})", row.default) };
        _ = writeln!(text, "  {}={}{unit}{default}\n          {}", row.key, row.takes, row.about);
    }
    Some(text.trim_end().to_owned())
}

const ABOUT: &str = "Renders a scene with the compiled render graph and writes the picture as PNG. It opens no window.";

fn camera() -> Vec<Arg> {
    vec![
        argument(
            "SCENE",
            "A glTF or GLB file, or a built-in scene: spheres (default), balls, columns, glass, lamps (1000 punctual \
             lights; lamps:N has N), lobes, materials, optics, panes (5 crossing blended panes; panes:N has N). \
             Defaults of options are in parentheses",
        ),
        option("size", "WxH", "Picture size in pixels (1280x720)"),
        option("msaa", "1|4", "Samples per pixel (4)"),
        option(
            "camera",
            "CAMERA",
            "A camera of the scene by name, `orbit` (frames the whole scene), or EX,EY,EZ:TX,TY,TZ:FOVY with eye and \
             target in meters and the vertical field of view in degrees; default: the first camera of the scene, else \
             orbit",
        ),
        flag("camera-from-gltf", "Require a camera of the file: the first, or the one named by --camera"),
        option("variant", "NAME", "Material variant of the file (KHR_materials_variants)"),
    ]
}

fn shading() -> impl Iterator<Item = Arg> {
    let all = [
        option(
            "quality",
            "low|high|ultra",
            "Shading quality: `low` as Filament on phones, `high` as on desktops, `ultra` with more bands of \
             irradiance and finer reflections (high)",
        ),
        option("shade", "KEY=X,...", "Single shading options; `--shade help` lists the keys"),
        option(
            "precision",
            "f32|f16",
            "Precision of shading; f16 requires adapter support and raises the minimum roughness to 0.089 (f32)",
        ),
    ];
    all.into_iter().map(|option| option.help_heading("Shading"))
}

fn post() -> impl Iterator<Item = Arg> {
    let all = [
        option("compensation", "EV", "Exposure compensation (0)"),
        option("vignette", "EV", "Darkening of the corners relative to the center (0)"),
        option("dither", "X", "Dither amplitude: 1 is half an 8-bit step in both directions (1)"),
        option("inline", "on|off", "Run post-processing at the end of the color pass's shader where possible (on)"),
        flag(
            "round-hdr",
            "With --inline, round radiance to the precision of the HDR format first; with --msaa 1 the picture then \
             equals that of --inline off bit for bit",
        ),
        flag("split-post", "Run every post-processing effect as a pass of its own"),
        flag(
            "compare-post",
            "Print the cost of post-processing inlined, in one pass, and in one pass per effect, at one and four \
             samples, instead of rendering a picture (--size 1920x1080)",
        ),
        flag("no-fxaa", "Disable FXAA"),
    ];
    all.into_iter().map(|option| option.help_heading("Post-processing"))
}

fn execution() -> impl Iterator<Item = Arg> {
    let all = [
        option("frames", "N", "Measured frames, after four warm-up frames (8)"),
        option(
            "alias",
            "heap|pool|off",
            "Memory sharing of transient textures: heap places them in one memory block (Vulkan; elsewhere as pool), \
             pool reuses textures of equal description, off disables sharing (pool)",
        ),
        option(
            "threads",
            "auto|N",
            "Threads that record a frame where measurements show a gain (auto: number of cores)",
        ),
        option(
            "memory",
            "BYTES",
            "Memory limit of loading: files, decoding, mip levels, upload; such as 512MiB or 2GB (half of the \
             machine's memory)",
        ),
        flag("allow-outside", "Allow buffers and images outside the folder of the scene"),
    ];
    all.into_iter().map(|option| option.help_heading("Execution"))
}

fn outputs() -> impl Iterator<Item = Arg> {
    let all = [
        option("out", "FILE.png", "The picture (render.png)"),
        option(
            "linear-out",
            "FILE.exr",
            "Exposed radiance before tone mapping, linear Rec.709, at the rendered size. It contains shading, \
             shadows, ao, ssr, glass, blending, fog, background, msaa, taa and dof. It excludes bloom, flares, \
             --compensation, vignette, edge fade, grading, tone curve, dither, fxaa and upscaling. Values above 1 are kept, so it \
             conflicts with --disable hdr-target",
        ),
        option("plan", "FILE", "The plan as text, with its graph in a .dot file of the same name (PICTURE.plan.txt)"),
    ];
    all.into_iter().map(|option| option.help_heading("Output"))
}

const AFTER: &str = "\
The best adapter is chosen, hardware first; WGPU_BACKEND and WGPU_ADAPTER_NAME select another.
Image-based light is cached in the user's cache folder; FRAMEGRAPH_LIGHT_CACHE names another folder, or `off`.
All files are written together at the end, or none; pipes and devices are written through. SIGINT and SIGTERM stop the run at
its next step without writing files.
Exit codes: 0 success, 1 device failure, 2 invalid input or output, 128 + N stopped by signal N.";

#[cfg(test)]
mod tests {
    /// The manual lists the options that the program prints. `FRAMEGRAPH_WRITE_REFERENCES=1` writes them anew.
    #[test]
    fn the_manual_has_all_options() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/render.md");
        let manual = std::fs::read_to_string(path).expect("the manual");
        let (before, rest) = manual.split_once("<!-- help -->\n```text\n").expect("the manual has a block of options");
        let (block, after) = rest.split_once("\n```\n<!-- end -->").expect("the block ends");
        let help = program::cli::help(super::command());
        let help: Vec<_> = help.trim_end().lines().map(str::trim_end).collect();
        let help = help.join("\n");
        if std::env::var_os("FRAMEGRAPH_WRITE_REFERENCES").is_some() {
            let text = format!("{before}<!-- help -->\n```text\n{help}\n```\n<!-- end -->{after}");
            std::fs::write(path, text).expect("the manual is written");
            return;
        }
        assert!(block == help, "docs/render.md: set FRAMEGRAPH_WRITE_REFERENCES=1 to write the options anew");
    }

    #[test]
    fn keys_are_listed_from_the_tables() {
        let text = super::keys("ao").expect("keys of ambient occlusion");
        assert!(text.contains("step-power=a number from 0.1 to 10 (1)"), "{text}");
        assert!(text.contains("horizon=a number from 0 to 90 degrees (0)"), "{text}");
        assert_eq!(super::keys("size"), None);
    }
}
