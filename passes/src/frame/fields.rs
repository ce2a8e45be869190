//! Tables of the settings of the whole frame.

use crate::effects::transmission::MAX_GLASS_LAYERS;
use crate::frame::Settings;
use crate::frame::frame_settings::FrameSettings;
use crate::settings::field::{Field, choice, number};
use crate::settings::place::{Place, Words, flag, num, word};
use crate::settings::table::SettingsTable;
use framegraph::Format;

impl Words for Format {
    const WORDS: &'static [(&'static str, Self)] =
        &[("Rgba16Float", Self::Rgba16Float), ("Rg11b10Ufloat", Self::Rg11b10Ufloat)];
}

impl SettingsTable for FrameSettings {
    const OPTION: &'static str = "";
    const PATH: &'static str = "";
    const ABOUT: &'static str = "the frame";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[];
    const FIELDS: &'static [Field<Self>] = &[
        choice("quality", "quality", |s: &mut Self| word(&mut s.quality)).about("quality of image-based light"),
        number("lod", "lod_error_px", [0.0, 16.0], |s: &mut Self| num(&mut s.lod_error_px))
            .about("maximum error of simplified meshes, also in texels of shadow maps; 0 draws all triangles"),
        number("layers", "visible_layers", [0.0, 255.0], |s: &mut Self| num(&mut s.visible_layers))
            .about("visible layers of the scene, one bit each"),
        choice("inline", "inline", |s: &mut Self| flag(&mut s.inline))
            .about("runs post-processing at the end of the color pass's shader where possible"),
    ];
}

impl SettingsTable for Settings {
    const OPTION: &'static str = "";
    const PATH: &'static str = "settings";
    const ABOUT: &'static str = "passes of the frame";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[];
    const FIELDS: &'static [Field<Self>] = &[
        choice("msaa", "samples", |s: &mut Self| Place::Count(&mut s.samples, &[1, 4])).about("samples per pixel"),
        choice("resolve", "tone_resolve", |s: &mut Self| Place::Switch(&mut s.tone_resolve, ["linear", "tone"]))
            .about("MSAA resolve of radiance, or of tone-mapped values: smooth edges in front of bright areas"),
        number("glass-layers", "glass_layers", [1.0, MAX_GLASS_LAYERS as f64], |s: &mut Self| num(&mut s.glass_layers))
            .about("layers of glass visible through glass; 1 shows only opaque surfaces behind glass"),
        choice("prepass", "prepass", |s: &mut Self| flag(&mut s.prepass))
            .about("draws depth before shading, so that each pixel is shaded once; the picture does not change"),
        choice("sky", "sky", |s: &mut Self| flag(&mut s.sky)).about("draws the background"),
        choice("fxaa", "fxaa", |s: &mut Self| flag(&mut s.fxaa)).about("smooths edges of the finished picture"),
        choice("hdr-format", "hdr_format", |s: &mut Self| word(&mut s.hdr_format)).about("format of radiance"),
        choice("split-post", "split_post", |s: &mut Self| flag(&mut s.split_post))
            .about("runs every post-processing effect as a separate pass"),
    ];
}
