//! Tables of the settings of post-processing and of the fade toward the edges.

use super::PostSettings;
use crate::grading::{GradeBy, TableDesc, TableFormat};
use crate::settings::field::{Field, choice, number, text};
use crate::settings::place::{Place, Words, num, switched, word};
use crate::settings::table::SettingsTable;
use framegraph_shaders::layout::EdgeFade;

impl Words for TableFormat {
    const WORDS: &'static [(&'static str, Self)] = &[("rgb10", Self::Rgb10), ("f16", Self::Half)];
}

fn table(s: &mut PostSettings, place: fn(&mut TableDesc) -> Place<'_>) -> Place<'_> {
    match &mut s.by {
        GradeBy::Table(own) => place(own),
        GradeBy::Direct => Place::Only("grade-by=table"),
    }
}

impl SettingsTable for PostSettings {
    const OPTION: &'static str = "";
    const PATH: &'static str = "settings.post";
    const ABOUT: &'static str = "post-processing";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[];
    const FIELDS: &'static [Field<Self>] = &[
        number("compensation", "compensation_ev", [-16.0, 16.0], |s: &mut Self| num(&mut s.compensation_ev))
            .about("exposure compensation"),
        number("vignette", "vignette_ev", [0.0, 16.0], |s: &mut Self| num(&mut s.vignette_ev))
            .about("darkening of the corners relative to the center"),
        text("edge-fade", "edge_fade", "`on` or `off`", &["off", "on"], |s: &mut Self, text| {
            s.edge_fade = switched(text)?.then_some(EdgeFade::DEFAULT);
            Some(())
        })
        .about("fade toward the edges, as Filament's vignette"),
        text("grade-by", "by", "`direct` or `table[:SIZE[:rgb10|f16]]`", &["direct", "table"], |s: &mut Self, text| {
            s.by = GradeBy::from_text(text).ok()?;
            Some(())
        })
        .about("evaluation of the look: per pixel, or from a lookup table"),
        number("table-entries", "by.entries", [16.0, 64.0], |s: &mut Self| table(s, |t| num(&mut t.entries)))
            .about("entries along each of three axes of the table"),
        choice("table-format", "by.format", |s: &mut Self| table(s, |t| word(&mut t.format)))
            .about("number format of the table"),
        number("dither", "dither", [0.0, 1.0], |s: &mut Self| num(&mut s.dither))
            .about("amplitude of the dither: 1 is half an 8-bit step in both directions"),
    ];
}

impl SettingsTable for EdgeFade {
    const OPTION: &'static str = "edge-fade";
    const PATH: &'static str = "settings.post.edge_fade";
    const ABOUT: &'static str = "fade toward the edges, as Filament's vignette";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[];
    const FIELDS: &'static [Field<Self>] = &[
        number("middle", "middle", [0.0, 1.0], |s: &mut Self| num(&mut s.middle))
            .about("distance from the center where it begins"),
        number("roundness", "roundness", [0.0, 1.0], |s: &mut Self| num(&mut s.roundness))
            .about("from a rounded rectangle (0) over an oval (0.5) to a circle (1)"),
        number("feather", "feather", [0.0, 1.0], |s: &mut Self| num(&mut s.feather)).about("softness"),
        number("color", "color", [0.0, 1e3], |s: &mut Self| Place::Numbers(&mut s.color))
            .about("factor on light at the edges"),
        number("multiple", "multiple_px", [1.0, 65536.0], |s: &mut Self| num(&mut s.multiple_px))
            .about("multiple to which the sides of the fading area are rounded up"),
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tables_describe_the_settings() {
        crate::settings::table::test::<PostSettings>();
        crate::settings::table::test::<EdgeFade>();
    }
}
