//! Options of color grading, tone curve and edge fade.

use crate::parse::pairs;
use framegraph_passes::PostSettings;
use framegraph_passes::grading::{GradeBy, Look, tone_map};
use framegraph_shaders::layout::EdgeFade;
use lexopt::Parser;
use std::path::PathBuf;

/// Help section.
pub const HELP: &str = "\
GRADING
  --tone-map NAME      linear, hill (ACES fit by Hill; default), filmic, neutral, aces (as in Filament), aces-legacy
                       (brighter by 1/0.6), linear-2020 (clipped in Rec.2020), agx, agx-golden, agx-punchy, gt7,
                       display-range (one color per stop), mobile (cheap, with the sRGB encoding), or generic[:CONTRAST:IN:OUT:WHITE]
  --grade KEY=X,...    color grading in Filament's order, in Rec.2020: exposure=EV, night=X (0 to 1), temperature, tint
                       (-1 to 1; 0), mixer-red|green|blue=R:G:B, shadows|midtones|highlights=R:G:B:OFFSET (1:1:1:0),
                       ranges=A:B:C:D (of luminance, 0:0.333:0.55:1), slope, offset, power=R:G:B (of LogC), contrast,
                       vibrance, saturation (0 to 2; 1), shadow-gamma, mid-point, highlight-scale=R:G:B (curves),
                       luminance-scaling=on|off (apply the tone curve to luminance only), gamut-mapping=on|off
  --grade-by METHOD    direct (computed per pixel; default), or table[:SIZE[:rgb10|f16]] (lookup table of 16 to 64 entries
                       per side; 32, f16)
  --look FILE.cube     color lookup table applied to the final picture; requires --grade-by table
  --edge-fade KEY=X,...  fade toward the edges as Filament's vignette: middle, roundness, feather (0 to 1; 0.5),
                       color=R:G:B (factor on linear color, 0:0:0)
";

/// Options of color grading, tone curve and edge fade.
#[derive(Clone, Debug, Default)]
pub struct Grade {
    look: Look,
    by: GradeBy,
    edge_fade: Option<EdgeFade>,
    /// Path of a color lookup table.
    pub color_table: Option<PathBuf>,
}

impl Grade {
    /// Starts with the grading of a frame.
    pub fn with(post: &PostSettings) -> Self {
        Self { look: post.look, by: post.by, edge_fade: post.edge_fade, color_table: None }
    }

    /// Parses the value of an option of this module; returns false for other options.
    ///
    /// # Errors
    /// One line that names the option and the expected value.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        if name == "look" {
            self.color_table = Some(parser.value().map_err(|_| "--look: missing file")?.into());
            return Ok(true);
        }
        if !matches!(name, "tone-map" | "grade" | "grade-by" | "edge-fade") {
            return Ok(false);
        }
        let value = parser.value().map_err(|_| format!("--{name}: missing value"))?;
        let value = value.into_string().map_err(|v| format!("--{name} {v:?}: the value is not Unicode"))?;
        match name {
            "tone-map" => self.look.tone_map = tone_map(&value).map_err(|error| format!("--tone-map {error}"))?,
            "grade-by" => self.by = GradeBy::from_text(&value).map_err(|error| format!("--grade-{error}"))?,
            "grade" => {
                for (key, value) in pairs("--grade", &value)? {
                    self.look.set(key, value).map_err(|error| format!("--grade {error}"))?;
                }
            }
            _ => {
                let mut fade = self.edge_fade.unwrap_or(EdgeFade::DEFAULT);
                for (key, value) in pairs("--edge-fade", &value)? {
                    set_fade(&mut fade, key, value)?;
                }
                self.edge_fade = Some(fade);
            }
        }
        Ok(true)
    }

    /// Writes the options into the post-processing settings.
    ///
    /// # Errors
    /// A color lookup table is specified without `--grade-by table`.
    pub fn apply(&self, post: &mut PostSettings) -> Result<(), String> {
        if self.color_table.is_some() && self.by == GradeBy::Direct {
            return Err("--look: requires a lookup table; add --grade-by table".into());
        }
        (post.look, post.by, post.edge_fade) = (self.look, self.by, self.edge_fade);
        Ok(())
    }
}

fn set_fade(fade: &mut EdgeFade, key: &str, value: &str) -> Result<(), String> {
    let number = |text: &str, max: f32| {
        let wrong = || format!("--edge-fade {key}={value}: out of range; expected 0 to {max}");
        text.parse::<f32>().ok().filter(|x| (0.0..=max).contains(x)).ok_or_else(wrong)
    };
    match key {
        "middle" => fade.middle = number(value, 1.0)?,
        "roundness" => fade.roundness = number(value, 1.0)?,
        "feather" => fade.feather = number(value, 1.0)?,
        "color" => {
            let parts: Vec<&str> = value.split(':').collect();
            let [r, g, b] = parts[..] else {
                return Err(format!("--edge-fade color={value}: expected three numbers separated by `:`"));
            };
            fade.color = [number(r, 1000.0)?, number(g, 1000.0)?, number(b, 1000.0)?];
        }
        _ => return Err(format!("--edge-fade {key}: unknown key; expected middle, roundness, feather, color")),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_shaders::layout::{Grading, ToneMap};
    use std::ffi::OsString;

    fn parsed(words: &[&str]) -> Result<PostSettings, String> {
        let mut grade = Grade::default();
        let mut parser = Parser::from_args(words.iter().map(OsString::from));
        while let Some(arg) = parser.next().map_err(|e| e.to_string())? {
            let lexopt::Arg::Long(name) = arg else { return Err("expected an option".into()) };
            let name = name.to_owned();
            assert!(grade.take(&name, &mut parser)?, "{name}");
        }
        let mut post = PostSettings::DEFAULT;
        grade.apply(&mut post)?;
        Ok(post)
    }

    #[test]
    fn options_are_parsed() {
        let post = parsed(&[
            "--grade",
            "contrast=1.25,tint=-0.5,luminance-scaling=on",
            "--tone-map",
            "agx-punchy",
            "--grade-by",
            "table:16",
            "--look",
            "a.cube",
            "--edge-fade",
            "feather=1,color=1:0.5:0",
        ])
        .expect("sound options");
        assert_eq!(post.look.grading, Grading { contrast: 1.25, tint: -0.5, ..Grading::NEUTRAL });
        assert_eq!((post.look.tone_map, post.look.luminance_scaling), (ToneMap::AgxPunchy, true));
        assert_eq!(Ok(post.by), GradeBy::from_text("table:16"));
        assert_eq!(post.edge_fade, Some(EdgeFade { feather: 1.0, color: [1.0, 0.5, 0.0], ..EdgeFade::DEFAULT }));
        assert_eq!(parsed(&[]), Ok(PostSettings::DEFAULT));
    }

    #[test]
    fn invalid_options_are_reported() {
        for (words, named) in [
            (["--grade", "contrast"], "--grade contrast: expected KEY=X"),
            (["--grade", "hue=1"], "--grade hue: unknown choice"),
            (["--grade", "tint=2"], "--grade tint=2"),
            (["--tone-map", "sepia"], "--tone-map sepia: unknown choice; there are linear, hill"),
            (["--grade-by", "lut"], "--grade-by=lut: `direct` or"),
            (["--look", "a.cube"], "--look: requires a lookup table; add --grade-by table"),
            (["--edge-fade", "size=1"], "--edge-fade size: unknown key"),
            (["--edge-fade", "middle=2"], "--edge-fade middle=2: out of range; expected 0 to 1"),
            (["--edge-fade", "color=1:2"], "--edge-fade color=1:2: expected three numbers"),
        ] {
            let error = parsed(&words).expect_err("the command line is invalid");
            assert!(error.contains(named) && !error.contains('\n'), "{error}");
        }
    }
}
