//! Which options were given, and which of them do not go together: an option that would do nothing is refused.

use crate::args::Args;
use crate::light::{Around, Sun};

/// Options by name, in the order in which they were given.
#[derive(Debug, Default)]
pub struct Given(Vec<String>);

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

/// An option with others that it leaves nothing to do, and why.
const AGAINST: [(&str, &[&str], &str); 15] = [
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
    ("bisect", &["timing", "what-it-costs"], "it measures nothing"),
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
    /// Notes an option.
    ///
    /// # Errors
    /// When it was given before.
    pub fn note(&mut self, name: &str) -> Result<(), String> {
        if self.has(name) && !REPEATED.contains(&name) {
            return Err(format!("--{name}: it is given twice"));
        }
        self.0.push(name.to_owned());
        Ok(())
    }

    /// Whether an option was given.
    pub fn has(&self, name: &str) -> bool {
        self.0.iter().any(|given| given == name)
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
        for (option, others) in BESIDE {
            if self.has(option) && !others.iter().any(|other| self.has(other)) {
                let others = others.iter().map(|other| format!("--{other}")).collect::<Vec<_>>().join(" or ");
                return Err(format!("--{option} goes together with {others} only"));
            }
        }
        if args.round_hdr && !args.inline {
            return Err("--round-hdr does not go together with --inline off: what is not inlined is stored".into());
        }
        if args.decide.sequence.is_some() && args.shadows.keep {
            return Err(
                "--shadow keep=on does not go together with --turntable and --sequence: they draw whole frames".into(),
            );
        }
        if args.decide.what_it_costs && args.shadows.keep {
            return Err("--shadow keep=on does not go together with --what-it-costs: it draws whole frames".into());
        }
        if args.compare_post && args.shadows.keep {
            return Err("--shadow keep=on does not go together with --compare-post: it draws whole frames".into());
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
            ("--no-fxaa --no-fxaa", "--no-fxaa: it is given twice"),
        ] {
            let told = parse(line.split(' ').map(OsString::from)).map(drop);
            assert!(told.as_ref().is_err_and(|told| told.starts_with(named)), "{line}: {told:?}");
        }
        for line in
            ["--inspect hdr --inspect-out a.png", "--inspect-all . --inspect-mode auto", "--bisect --debug poison"]
        {
            assert!(parse(line.split(' ').map(OsString::from)).is_ok(), "{line}");
        }
    }
}
