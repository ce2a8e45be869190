//! Options of color grading, tone curve and edge fade.

use crate::parse::fields;
use framegraph_passes::PostSettings;
use framegraph_passes::grading::{GradeBy, tone_map};
use framegraph_shaders::layout::EdgeFade;
use program::clap::Arg;
use program::cli::{Item, option};
use std::path::PathBuf;

/// Declares the options of this module.
pub fn options() -> Vec<Arg> {
    let all = vec![
        option(
            "tone-map",
            "NAME",
            "linear, hill (ACES fit by Hill; default), filmic, neutral, aces (as in Filament), aces-legacy (brighter \
             by 1/0.6), linear-2020 (clipped in Rec.2020), agx, agx-golden, agx-punchy, gt7, display-range (one color \
             per stop), mobile (cheap, with the sRGB encoding), or generic[:CONTRAST:IN:OUT:WHITE]",
        ),
        option(
            "grade",
            "KEY=X,...",
            "Color grading in Filament's order, in Rec.2020, such as contrast=1.2,slope=1:1:0.9; `--grade help` lists \
             the keys",
        ),
        option(
            "grade-by",
            "METHOD",
            "direct (computed per pixel; default), or table[:SIZE[:rgb10|f16]] (lookup table of 16 to 64 entries per \
             side; 32, f16)",
        ),
        option("look", "FILE.cube", "Color lookup table applied to the final picture; requires --grade-by table"),
        option(
            "edge-fade",
            "KEY=X,...",
            "Fade toward the edges as Filament's vignette; `--edge-fade help` lists the keys",
        ),
    ];
    all.into_iter().map(|option| option.help_heading("Grading")).collect()
}

/// Options of color grading beside the settings of the frame.
#[derive(Clone, Debug, Default)]
pub struct Grade {
    /// Path of a color lookup table.
    pub color_table: Option<PathBuf>,
}

impl Grade {
    /// Parses the value of an option of this module into `post` or `self`; returns false for other options.
    ///
    /// # Errors
    /// One line that names the option and the expected value.
    pub fn take(&mut self, post: &mut PostSettings, item: &Item) -> Result<bool, String> {
        match item.name() {
            "look" => self.color_table = Some(item.raw().into()),
            "tone-map" => {
                post.look.tone_map = tone_map(&item.text()?).map_err(|error| format!("--tone-map {error}"))?;
            }
            "grade-by" => post.by = GradeBy::from_text(&item.text()?).map_err(|error| format!("--grade-{error}"))?,
            "grade" => fields("grade", &item.text()?, &mut post.look)?,
            "edge-fade" => {
                let fade = post.edge_fade.get_or_insert(EdgeFade::DEFAULT);
                fields("edge-fade", &item.text()?, fade)?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Checks the options against each other.
    ///
    /// # Errors
    /// A color lookup table is specified without `--grade-by table`.
    pub fn check(&self, post: &PostSettings) -> Result<(), String> {
        match (&self.color_table, post.by) {
            (Some(_), GradeBy::Direct) => Err("--look: requires a lookup table; add --grade-by table".into()),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_shaders::layout::{Grading, ToneMap};

    fn parsed(words: &[&str]) -> Result<PostSettings, String> {
        let (mut grade, mut post) = (Grade::default(), PostSettings::DEFAULT);
        crate::parse::taken(options(), words, |item| grade.take(&mut post, item))?;
        grade.check(&post)?;
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
            (["--grade", "contrast"], "--grade contrast=: expected a number"),
            (["--grade", "hue=1"], "--grade hue: unknown choice"),
            (["--grade", "tint=2"], "--grade tint=2"),
            (["--tone-map", "sepia"], "--tone-map sepia: unknown choice; there are linear, hill"),
            (["--grade-by", "lut"], "--grade-by=lut: expected `direct` or"),
            (["--look", "a.cube"], "--look: requires a lookup table; add --grade-by table"),
            (["--edge-fade", "size=1"], "--edge-fade size: unknown choice"),
            (["--edge-fade", "middle=2"], "--edge-fade middle=2: expected a number from 0 to 1"),
            (["--edge-fade", "color=1:2"], "--edge-fade color=1:2: expected 3 numbers"),
        ] {
            let error = parsed(&words).expect_err("the command line is invalid");
            assert!(error.contains(named) && !error.contains('\n'), "{error}");
        }
    }
}
