//! Which options were given, and which of them do not go together: an option that would do nothing is refused.

use crate::args::Args;
use crate::light::{Around, Sun};
use framegraph_passes::Effect;
use std::ffi::OsString;

/// Options by name, in the order in which they were given.
#[derive(Debug, Default)]
pub struct Given {
    names: Vec<String>,
    /// Each word behind an option, with the option's name: its value, if it takes one.
    values: Vec<(String, String)>,
}

/// What writes or shows something of one rendered frame.
const OF_ONE_FRAME: [&str; 9] =
    ["out", "linear-out", "plan", "inspect", "inspect-out", "inspect-mode", "inspect-sample", "inspect-all", "trace"];

/// What a frame within a budget is chosen from.
const CHOSEN: [&str; 12] = [
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

/// What renders other frames than one.
const OF_MANY: [&str; 4] = ["compare-post", "bisect", "turntable", "sequence"];

/// What may be given several times.
const REPEATED: [&str; 2] = ["enable", "disable"];

/// What of the plan is written and printed.
const OF_THE_PLAN: [&str; 3] = ["facts", "graph", "what-if"];

/// What says how shadows are drawn.
const OF_SHADOWS: [&str; 7] = [
    "cascades",
    "shadow",
    "show-cascades",
    "enable cascades",
    "enable sun-shadows",
    "enable lamp-shadows",
    "enable contact-shadows",
];

/// What stands for no effect where an option has the effect's name.
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

/// An option with others that it leaves nothing to do, and why. A value behind an option is one of those between its commas,
/// up to its colon.
const AGAINST: [(&str, &[&str], &str); 33] = [
    ("budget-ms", &["max-error"], "a frame is held to one of both"),
    ("budget-ms", &CHOSEN, "it chooses that itself; --preset and --settings are what it begins with"),
    ("max-error", &CHOSEN, "it chooses that itself; --preset and --settings are what it begins with"),
    ("budget-ms", &OF_MANY, "it is for one frame"),
    ("max-error", &OF_MANY, "it is for one frame"),
    ("turntable", &OF_ONE_FRAME, "it renders pictures of its own"),
    ("sequence", &OF_ONE_FRAME, "it renders pictures of its own"),
    (
        "turntable",
        &["sequence", "compare-post", "bisect", "timing", "facts", "graph", "what-if", "what-it-costs"],
        "it renders pictures alone",
    ),
    (
        "sequence",
        &["compare-post", "bisect", "timing", "facts", "graph", "what-if", "what-it-costs"],
        "it renders pictures alone",
    ),
    (
        "compare-post",
        &["facts", "graph", "what-if", "what-it-costs", "enable", "disable", "force-effects"],
        "it compares frames of every effect",
    ),
    ("compare-post", &OF_ONE_FRAME, "it renders no picture"),
    (
        "compare-post",
        &["bisect", "timing", "debug", "msaa", "inline", "round-hdr", "split-post"],
        "it goes through all ways of post-processing itself",
    ),
    ("dynamic-resolution", &["scale"], "it finds the scale"),
    ("bisect", &OF_ONE_FRAME, "it compares pictures and keeps none"),
    ("bisect", &["timing", "what-it-costs", "frames"], "it measures nothing"),
    ("bisect", &OF_THE_PLAN, "it compares pictures and keeps none"),
    ("bisect", &["shadow keep=on"], "it draws whole frames"),
    ("turntable", &["shadow keep=on"], "it draws whole frames"),
    ("sequence", &["shadow keep=on"], "it draws whole frames"),
    ("what-it-costs", &["shadow keep=on"], "it draws whole frames"),
    ("compare-post", &["shadow keep=on"], "it draws whole frames"),
    ("turntable", &["frames"], "the number before its folder says how many there are"),
    ("sequence", &["frames"], "the number before its folder says how many there are"),
    ("no-shadows", &["shadows"], "one of both says whether there are shadows"),
    ("no-shadows", &OF_SHADOWS, "nothing casts a shadow"),
    ("shadows off", &OF_SHADOWS, "nothing casts a shadow"),
    ("disable sun-shadows", &["cascades", "show-cascades", "enable cascades"], "the sun casts no shadow"),
    ("no-fxaa", &["enable fxaa", "disable fxaa"], "one of both says whether edges are softened"),
    ("debug no-inline", &["inline", "round-hdr"], "nothing is inlined"),
    ("debug immediate", &["inline", "round-hdr"], "nothing is inlined"),
    ("debug no-alias", &["alias"], "no memory is shared"),
    ("debug immediate", &["alias"], "no memory is shared"),
    ("scale 1", &["upscale", "sharpness"], "the picture is drawn as large as it is shown"),
];

/// An option that means something only beside one of others.
const BESIDE: [(&str, &[&str]); 8] = [
    ("record", &["budget-ms", "max-error", "preset"]),
    ("animation", &["time"]),
    ("dynamic-resolution", &["turntable", "sequence"]),
    ("upscale", &["scale", "dynamic-resolution"]),
    ("sharpness", &["scale", "dynamic-resolution"]),
    ("inspect-out", &["inspect"]),
    ("inspect-sample", &["inspect"]),
    ("inspect-mode", &["inspect", "inspect-all"]),
];

impl Given {
    /// Nothing yet of these words.
    pub fn of(words: &[OsString]) -> Self {
        let mut values = Vec::new();
        let words: Vec<_> = words.iter().map(|word| word.to_string_lossy()).collect();
        for (index, word) in words.iter().enumerate() {
            let Some(option) = word.strip_prefix("--") else { continue };
            let next = words.get(index + 1).map_or("", AsRef::as_ref);
            let (name, value) = option.split_once('=').unwrap_or((option, next));
            values.push((name.to_owned(), value.to_owned()));
        }
        Self { names: Vec::new(), values }
    }

    /// Notes an option.
    ///
    /// # Errors
    /// When it was given before.
    pub fn note(&mut self, name: &str) -> Result<(), String> {
        if self.has(name) && !REPEATED.contains(&name) {
            return Err(format!("--{name}: it is given twice"));
        }
        self.names.push(name.to_owned());
        Ok(())
    }

    /// Whether an option was given; with a value behind it, whether that was.
    pub fn has(&self, asked: &str) -> bool {
        let Some((option, value)) = asked.split_once(' ') else { return self.names.iter().any(|name| name == asked) };
        let is_it = |part: &str| part == value || part.split(':').next() == Some(value);
        self.values.iter().any(|(name, values)| name == option && values.split(',').any(is_it))
    }

    /// Refuses what does not go together.
    ///
    /// # Errors
    /// One line that names both options.
    pub fn check(&self, args: &Args) -> Result<(), String> {
        for (option, others, why) in AGAINST {
            if let Some(other) = others.iter().find(|other| self.has(option) && self.has(other)) {
                return Err(format!("--{other} does not go together with --{option}: {why}"));
            }
        }
        for name in Effect::ALL.map(Effect::name).into_iter().filter(|name| self.has(name)) {
            let is_off = OFF.iter().any(|(effect, off)| *effect == name && self.has(&format!("{name} {off}")));
            for option in ["enable", "disable"] {
                if self.has(&format!("{option} {name}")) && (option == "disable" || is_off) {
                    return Err(format!("--{option} {name} does not go together with --{name}: one of both says it"));
                }
            }
        }
        for (option, others) in BESIDE {
            if self.has(option) && !others.iter().any(|other| self.has(other)) {
                let others = others.iter().map(|other| format!("--{other}")).collect::<Vec<_>>().join(" or ");
                return Err(format!("--{option} goes together with {others} only"));
            }
        }
        if args.round_hdr && !args.inline {
            return Err("--round-hdr does not go together with --inline off: what is not inlined is stored".into());
        }
        if args.lighting.sun == Sun::InMap && !matches!(args.lighting.around, Around::File(_)) {
            return Err("--sun in-map goes together with --environment FILE only: there is no map".into());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::args::parse;
    use std::ffi::OsString;

    #[test]
    fn options_that_would_do_nothing_are_refused() {
        for (line, named) in [
            ("--compare-post --out a.png", "--out does not go together with --compare-post"),
            ("--compare-post --bisect", "--bisect does not go together with --compare-post"),
            ("--compare-post --msaa 1", "--msaa does not"),
            ("--bisect --trace t.json", "--trace does not go together with --bisect"),
            ("--bisect --timing", "--timing does not"),
            ("--inspect-out a.png", "--inspect-out goes together with --inspect only"),
            ("--inspect-mode auto", "--inspect-mode goes together with --inspect or --inspect-all only"),
            ("--round-hdr --inline off", "--round-hdr does not go together with --inline off"),
            ("--compare-post --shadow keep=on", "--shadow keep=on does not go together with --compare-post"),
            ("--budget-ms 9 --max-error 1", "--max-error does not go together with --budget-ms"),
            ("--max-error 1 --ao gtao", "--ao does not go together with --max-error"),
            ("--budget-ms 9 --bisect", "--bisect does not go together with --budget-ms"),
            ("--record a.json", "--record goes together with --budget-ms or --max-error or --preset only"),
            ("--dynamic-resolution 9", "--dynamic-resolution goes together with --turntable or --sequence only"),
            ("--sun in-map", "--sun in-map goes together with --environment FILE only"),
            ("--bisect --facts f.json", "--facts does not go together with --bisect"),
            ("--bisect --graph g.ron", "--graph does not"),
            ("--bisect --what-if tiler", "--what-if does not"),
            ("--bisect --frames 3", "--frames does not go together with --bisect"),
            ("--bisect --shadow keep=on", "--shadow keep=on does not go together with --bisect"),
            ("--turntable 2 d --frames 99", "--frames does not go together with --turntable"),
            ("--sequence 2 d --shadow texels=64,keep=on", "--shadow keep=on does not go together with --sequence"),
            ("--shadows off --cascades 4", "--cascades does not go together with --shadows off"),
            ("--shadows=off --enable sun-shadows", "--enable sun-shadows does not go together with --shadows off"),
            ("--no-shadows --show-cascades", "--show-cascades does not go together with --no-shadows"),
            ("--no-shadows --shadows pcf", "--shadows does not go together with --no-shadows"),
            ("--no-shadows --shadow keep=on", "--shadow does not go together with --no-shadows"),
            ("--disable sun-shadows --cascades 2", "--cascades does not go together with --disable sun-shadows"),
            ("--no-fxaa --enable fxaa", "--enable fxaa does not go together with --no-fxaa"),
            ("--inline on --debug no-inline", "--inline does not go together with --debug no-inline"),
            ("--alias heap --debug poison,no-alias", "--alias does not go together with --debug no-alias"),
            ("--debug immediate --round-hdr", "--round-hdr does not go together with --debug immediate"),
            ("--scale 1 --upscale fsr", "--upscale does not go together with --scale 1"),
            ("--disable ao --ao gtao:slices=4", "--disable ao does not go together with --ao"),
            ("--enable taa --taa off", "--enable taa does not go together with --taa"),
            ("--msaa 1 --enable msaa", "--enable msaa does not go together with --msaa"),
            ("--no-fxaa --no-fxaa", "--no-fxaa: it is given twice"),
        ] {
            let told = parse(line.split(' ').map(OsString::from)).map(drop);
            assert!(told.as_ref().is_err_and(|told| told.starts_with(named)), "{line}: {told:?}");
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
