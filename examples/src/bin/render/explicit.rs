//! Explicit options and their conflicts: an option without effect is an error.

use crate::args::Args;
use crate::light::{EnvironmentSource, Sun};
use framegraph_passes::Effect;
use program::cli::{Given, Item};

/// Explicit options with their values, in the order of the command line.
#[derive(Debug, Default)]
pub struct ExplicitOptions {
    /// Name and value of every option.
    all: Vec<(String, String)>,
}

/// Options that write or show something of a single frame.
const SINGLE_FRAME: [&str; 9] =
    ["out", "linear-out", "plan", "inspect", "inspect-out", "inspect-mode", "inspect-sample", "inspect-all", "trace"];

/// Options that a budget search chooses.
const SEARCHED: [&str; 12] = [
    "msaa",
    "no-fxaa",
    "shadows",
    "no-shadows",
    "cascades",
    "shadow",
    "ao",
    "quality",
    "shade",
    "precision",
    "ssr",
    "glass-layers",
];

/// Options that render several frames.
const SEVERAL_FRAMES: [&str; 4] = ["compare-post", "bisect", "turntable", "sequence"];

/// Options that write or print something of the plan.
const PLAN_OUTPUTS: [&str; 3] = ["facts", "graph", "what-if"];

/// Options that print more about a single frame.
const MEASURED: [&str; 3] = ["timing", "effect-costs", "pick"];

/// Options that configure shadows.
const SHADOW_OPTIONS: [&str; 7] = [
    "cascades",
    "shadow",
    "show-cascades",
    "enable cascades",
    "enable sun-shadows",
    "enable punctual-shadows",
    "enable contact-shadows",
];

/// Values that disable an effect, for options named after an effect.
const OFF: [(&str, &str); 11] = [
    ("ao", "off"),
    ("bloom", "off"),
    ("cascades", "1"),
    ("dither", "0"),
    ("dof", "off"),
    ("fog", "off"),
    ("glass-layers", "1"),
    ("msaa", "1"),
    ("ssr", "off"),
    ("taa", "off"),
    ("vignette", "0"),
];

/// Conflicts: an option, the options it makes useless, and the reason.
///
/// A value after an option matches one of its comma-separated parts, up to a colon.
const CONFLICTS: [(&str, &[&str], &str); 43] = [
    ("budget-ms", &["max-error"], "choose one limit"),
    ("budget-ms", &SEARCHED, "the search chooses it; --preset and --settings set the base frame"),
    ("max-error", &SEARCHED, "the search chooses it; --preset and --settings set the base frame"),
    ("budget-ms", &SEVERAL_FRAMES, "the search is for a single frame"),
    ("max-error", &SEVERAL_FRAMES, "the search is for a single frame"),
    ("explain-error", &["compare-with", "budget-ms", "max-error", "guaranteed"], "it draws its own frames"),
    ("explain-error", &SEVERAL_FRAMES, "it is for a single frame"),
    ("explain-error", &SINGLE_FRAME, "it writes only heat maps"),
    ("explain-error", &PLAN_OUTPUTS, "it writes only heat maps"),
    ("explain-error", &MEASURED, "it prints only errors"),
    ("compare-with", &["budget-ms", "max-error", "guaranteed"], "it chooses no options"),
    ("compare-with", &SEVERAL_FRAMES, "it is for a single frame"),
    ("compare-with", &SINGLE_FRAME, "it writes no files"),
    ("compare-with", &PLAN_OUTPUTS, "it writes no files"),
    ("compare-with", &MEASURED, "it prints only times and errors of both frames"),
    ("turntable", &SINGLE_FRAME, "it writes its own pictures"),
    ("sequence", &SINGLE_FRAME, "it writes its own pictures"),
    (
        "turntable",
        &["sequence", "compare-post", "bisect", "timing", "facts", "graph", "what-if", "effect-costs"],
        "it writes only pictures",
    ),
    (
        "sequence",
        &["compare-post", "bisect", "timing", "facts", "graph", "what-if", "effect-costs"],
        "it writes only pictures",
    ),
    (
        "compare-post",
        &["facts", "graph", "what-if", "effect-costs", "enable", "disable", "force-effects"],
        "it enables every effect",
    ),
    ("compare-post", &SINGLE_FRAME, "it renders no picture"),
    (
        "compare-post",
        &["bisect", "timing", "debug", "msaa", "inline", "round-hdr", "split-post"],
        "it varies them itself",
    ),
    ("dynamic-resolution", &["scale"], "it chooses the scale"),
    ("bisect", &SINGLE_FRAME, "it compares pictures without writing any"),
    ("bisect", &["timing", "effect-costs", "frames"], "it measures no times"),
    ("bisect", &PLAN_OUTPUTS, "it compares pictures without writing any"),
    ("bisect", &["shadow keep=on"], "it redraws all shadow maps"),
    ("turntable", &["shadow keep=on"], "it redraws all shadow maps"),
    ("sequence", &["shadow keep=on"], "it redraws all shadow maps"),
    ("effect-costs", &["shadow keep=on"], "it redraws all shadow maps"),
    ("compare-post", &["shadow keep=on"], "it redraws all shadow maps"),
    ("turntable", &["frames"], "its first value is the number of pictures"),
    ("sequence", &["frames"], "its first value is the number of pictures"),
    ("no-shadows", &["shadows"], "remove one"),
    ("no-shadows", &SHADOW_OPTIONS, "shadows are off"),
    ("shadows off", &SHADOW_OPTIONS, "shadows are off"),
    ("disable sun-shadows", &["cascades", "show-cascades", "enable cascades"], "the sun casts no shadows"),
    ("no-fxaa", &["enable fxaa", "disable fxaa"], "remove one"),
    ("debug no-inline", &["inline", "round-hdr"], "nothing is inlined"),
    ("debug immediate", &["inline", "round-hdr"], "nothing is inlined"),
    ("debug no-alias", &["alias"], "memory sharing is off"),
    ("debug immediate", &["alias"], "memory sharing is off"),
    ("scale 1", &["upscale", "sharpness"], "nothing is upscaled"),
];

/// Options that require one of several others.
const REQUIRES: [(&str, &[&str]); 9] = [
    ("guaranteed", &["max-error"]),
    ("record", &["budget-ms", "max-error", "preset"]),
    ("animation", &["time"]),
    ("dynamic-resolution", &["turntable", "sequence"]),
    ("upscale", &["scale", "dynamic-resolution"]),
    ("sharpness", &["scale", "dynamic-resolution"]),
    ("inspect-out", &["inspect"]),
    ("inspect-sample", &["inspect"]),
    ("inspect-mode", &["inspect", "inspect-all"]),
];

impl ExplicitOptions {
    /// Reads the options and their values.
    pub fn of(given: &Given) -> Self {
        let value = |item: &Item| {
            let text = item.raw().to_string_lossy().into_owned();
            // Former names of effects are accepted.
            if matches!(item.name(), "enable" | "disable") {
                return Effect::from_name(&text).map_or(text, |effect| effect.name().to_owned());
            }
            text
        };
        Self { all: given.clone().into_iter().map(|item| (item.name().to_owned(), value(&item))).collect() }
    }

    /// Returns whether an option is present; `"name value"` also requires the value.
    pub fn has(&self, asked: &str) -> bool {
        let Some((option, value)) = asked.split_once(' ') else {
            return self.all.iter().any(|(name, _)| name == asked);
        };
        let is_it = |part: &str| part == value || part.split(':').next() == Some(value);
        self.all.iter().any(|(name, values)| name == option && values.split(',').any(is_it))
    }

    /// Rejects conflicting options.
    ///
    /// # Errors
    /// One line that names both options.
    pub fn check(&self, args: &Args) -> Result<(), String> {
        for (option, others, why) in CONFLICTS {
            if let Some(other) = others.iter().find(|other| self.has(option) && self.has(other)) {
                return Err(format!("--{other}: cannot be used with --{option}; {why}"));
            }
        }
        for name in Effect::ALL.map(Effect::name).into_iter().filter(|name| self.has(name)) {
            let is_off = OFF.iter().any(|(effect, off)| *effect == name && self.has(&format!("{name} {off}")));
            for option in ["enable", "disable"] {
                if self.has(&format!("{option} {name}")) && (option == "disable" || is_off) {
                    return Err(format!("--{option} {name}: cannot be used with --{name}; remove one"));
                }
            }
        }
        for (option, others) in REQUIRES {
            if self.has(option) && !others.iter().any(|other| self.has(other)) {
                let others = others.iter().map(|other| format!("--{other}")).collect::<Vec<_>>().join(" or ");
                return Err(format!("--{option}: requires {others}"));
            }
        }
        if args.round_hdr && !args.frame.inline {
            return Err("--round-hdr: cannot be used with --inline off; radiance is stored then".into());
        }
        if args.lighting.sun == Sun::InMap && !matches!(args.lighting.environment, EnvironmentSource::File(_)) {
            return Err("--sun in-map: requires --environment FILE".into());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::args::parse;
    use std::ffi::OsString;

    #[test]
    fn options_without_effect_are_rejected() {
        for (line, named) in [
            ("--compare-post --out a.png", "--out: cannot be used with --compare-post"),
            ("--compare-post --bisect", "--bisect: cannot be used with --compare-post"),
            ("--compare-post --msaa 1", "--msaa: cannot be used with"),
            ("--bisect --trace t.json", "--trace: cannot be used with --bisect"),
            ("--bisect --timing", "--timing: cannot be used with"),
            ("--inspect-out a.png", "--inspect-out: requires --inspect"),
            ("--inspect-mode auto", "--inspect-mode: requires --inspect or --inspect-all"),
            ("--round-hdr --inline off", "--round-hdr: cannot be used with --inline off"),
            ("--compare-post --shadow keep=on", "--shadow keep=on: cannot be used with --compare-post"),
            ("--budget-ms 9 --max-error 1", "--max-error: cannot be used with --budget-ms"),
            ("--max-error 1 --ao gtao", "--ao: cannot be used with --max-error"),
            ("--budget-ms 9 --bisect", "--bisect: cannot be used with --budget-ms"),
            ("--record a.json", "--record: requires --budget-ms or --max-error or --preset"),
            ("--dynamic-resolution 9", "--dynamic-resolution: requires --turntable or --sequence"),
            ("--compare-with --no-fxaa --budget-ms 9", "--budget-ms: cannot be used with --compare-with"),
            ("--compare-with --no-fxaa --max-error 9 --guaranteed", "--max-error: cannot be used with --compare-with"),
            ("--compare-with --no-fxaa --facts f.json", "--facts: cannot be used with --compare-with"),
            ("--compare-with --no-fxaa --effect-costs", "--effect-costs: cannot be used with --compare-with"),
            ("--explain-error . --timing", "--timing: cannot be used with --explain-error"),
            ("--explain-error . --what-if tiler", "--what-if: cannot be used with --explain-error"),
            ("--explain-error . --pick 1,1", "--pick: cannot be used with --explain-error"),
            ("--sun in-map", "--sun in-map: requires --environment FILE"),
            ("--bisect --facts f.json", "--facts: cannot be used with --bisect"),
            ("--bisect --graph g.ron", "--graph: cannot be used with"),
            ("--bisect --what-if tiler", "--what-if: cannot be used with"),
            ("--bisect --frames 3", "--frames: cannot be used with --bisect"),
            ("--bisect --shadow keep=on", "--shadow keep=on: cannot be used with --bisect"),
            ("--turntable 2 d --frames 99", "--frames: cannot be used with --turntable"),
            ("--sequence 2 d --shadow texels=64,keep=on", "--shadow keep=on: cannot be used with --sequence"),
            ("--shadows off --cascades 4", "--cascades: cannot be used with --shadows off"),
            ("--shadows=off --enable sun-shadows", "--enable sun-shadows: cannot be used with --shadows off"),
            ("--no-shadows --show-cascades", "--show-cascades: cannot be used with --no-shadows"),
            ("--no-shadows --shadows pcf", "--shadows: cannot be used with --no-shadows"),
            ("--no-shadows --shadow keep=on", "--shadow: cannot be used with --no-shadows"),
            ("--disable sun-shadows --cascades 2", "--cascades: cannot be used with --disable sun-shadows"),
            ("--no-fxaa --enable fxaa", "--enable fxaa: cannot be used with --no-fxaa"),
            ("--inline on --debug no-inline", "--inline: cannot be used with --debug no-inline"),
            ("--alias heap --debug poison,no-alias", "--alias: cannot be used with --debug no-alias"),
            ("--debug immediate --round-hdr", "--round-hdr: cannot be used with --debug immediate"),
            ("--scale 1 --upscale fsr", "--upscale: cannot be used with --scale 1"),
            ("--disable ao --ao gtao:slices=4", "--disable ao: cannot be used with --ao"),
            ("--enable taa --taa off", "--enable taa: cannot be used with --taa"),
            ("--msaa 1 --enable msaa", "--enable msaa: cannot be used with --msaa"),
            ("--no-fxaa --no-fxaa", "--no-fxaa: specified twice"),
        ] {
            let error = parse(line.split(' ').map(OsString::from)).map(drop);
            assert!(error.as_ref().is_err_and(|error| error.starts_with(named)), "{line}: {error:?}");
        }
        for line in [
            "--inspect hdr --inspect-out a.png",
            "--inspect-all . --inspect-mode auto",
            "--bisect --debug poison",
            "--shadows pcf --cascades 4",
            "--enable ao --ao gtao",
            "--alias none --debug no-inline",
            "--scale 0.5 --upscale fsr",
        ] {
            assert!(parse(line.split(' ').map(OsString::from)).is_ok(), "{line}");
        }
    }
}
