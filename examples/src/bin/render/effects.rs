//! Options of effects: ambient occlusion, reflections, glass layers, fog, bloom, depth of field, temporal anti-aliasing,
//! levels of detail, transparency and visible layers.

use crate::parse::{field, number};
use framegraph_passes::effects::transmission::MAX_GLASS_LAYERS;
use framegraph_passes::{
    BloomSettings, DofSettings, FogSettings, OcclusionSettings, ReflectionSettings, Settings, SettingsTable,
    TaaSettings, Transparency, Upscale,
};
use framegraph_scene::draw_options::DEFAULT_MASK;
use program::clap::Arg;
use program::cli::{Item, option};
use std::path::PathBuf;

/// Declares the options of this module.
pub fn options() -> Vec<Arg> {
    let all = vec![
        keyed::<OcclusionSettings>(
            "off (default), or a METHOD: sao (taps on a spiral) or gtao (horizons, more accurate)",
        ),
        keyed::<ReflectionSettings>("off (default), or on: needs several frames"),
        keyed::<FogSettings>("off (default) or on"),
        keyed::<BloomSettings>("off (default) or on"),
        option("dirt", "FILE", "PNG or JPEG picture of lens dirt, stretched over the frame; requires bloom"),
        keyed::<DofSettings>("off (default) or on"),
        keyed::<TaaSettings>("off (default) or on, over --frames frames"),
        option(
            "resolve",
            "linear|tone",
            "MSAA resolve of radiance, or of tone-mapped values, which keeps edges smooth in front of bright areas \
             when \
             bloom, --dof or --taa read the radiance (linear)",
        ),
        option(
            "scale",
            "X",
            "Render at X times the width and height, 0.25 to 1, and upscale (1); --linear-out has the rendered size",
        ),
        option("upscale", "bilinear|fsr", "Upscaling filter (fsr)"),
        option("sharpness", "X", "Sharpening after upscaling, 0 to 1 (0.9)"),
        option(
            "dynamic-resolution",
            "MS[:MIN]",
            "In --turntable and --sequence, scale each frame so that it takes MS milliseconds, but not below MIN \
             percent \
             of the sides, 25 to 100 (50)",
        ),
        option(
            "lod",
            "PX",
            "Draw simplified meshes while the geometric error is at most PX pixels, or shadow-map texels, 0 to 16; 0 \
             draws all triangles (0)",
        ),
        keyed::<Transparency>(
            "sorted (by object, default), two-passes (also back faces before front faces of double-sided surfaces), \
             weighted (weighted average), moments (weighted by moments of absorbance) or peeled (layer by layer, \
             exact)",
        ),
        option("glass-layers", "N", "Layers of glass visible through glass, 1 to 4; 1 shows only opaque surfaces (1)"),
        option(
            "layers",
            "MASK",
            "Visible layers of the scene, one bit each, such as 3, 0x03 or 0b11; objects in none of them are not \
             drawn \
             and cast no shadows (1)",
        ),
    ];
    all.into_iter().map(|option| option.help_heading("Effects")).collect()
}

/// Declares the option of an effect that has a table of settings.
fn keyed<S: SettingsTable>(methods: &str) -> Arg {
    let value = "METHOD[:KEY=X,...]";
    option(S::OPTION, value, format!("{}: {methods}. `--{} help` lists the keys", S::ABOUT, S::OPTION))
}

/// Settings of the effects.
#[derive(Clone, Debug)]
pub struct Effects {
    /// Ambient occlusion.
    pub occlusion: Option<OcclusionSettings>,
    /// Screen-space reflections.
    pub reflections: Option<ReflectionSettings>,
    /// Depth of field.
    pub dof: Option<DofSettings>,
    /// Bloom and lens flare.
    pub bloom: Option<BloomSettings>,
    /// Picture of lens dirt.
    pub dirt: Option<PathBuf>,
    /// Height fog.
    pub fog: Option<FogSettings>,
    /// Temporal anti-aliasing.
    pub taa: Option<TaaSettings>,
    /// Resolves MSAA samples after tone mapping.
    pub tone_resolve: bool,
    /// Upscaling.
    pub upscale: Option<Upscale>,
    /// Dynamic resolution: frame time in ms, and the minimum scale in percent of width and height.
    pub dynamic: Option<[f64; 2]>,
    /// Maximum geometric error of levels of detail, in pixels; 0 draws all triangles.
    pub lod_error_px: f32,
    /// Method for blended surfaces.
    pub transparency: Transparency,
    /// Maximum number of glass layers.
    pub glass_layers: u8,
    /// Layers of the scene that are shown, a bit each.
    pub visible_layers: u8,
}

impl Default for Effects {
    /// Returns settings without effects, without levels of detail, and with one glass layer.
    fn default() -> Self {
        Self {
            occlusion: None,
            reflections: None,
            taa: None,
            tone_resolve: false,
            upscale: None,
            dynamic: None,
            dof: None,
            bloom: None,
            dirt: None,
            fog: None,
            lod_error_px: 0.0,
            transparency: Transparency::Sorted,
            glass_layers: 1,
            visible_layers: DEFAULT_MASK,
        }
    }
}

impl Effects {
    /// Returns the rendered width and height in pixels for a picture of size `shown_px`.
    pub fn drawn_px(&self, shown_px: [u32; 2]) -> [u32; 2] {
        Settings { upscale: self.upscale, ..Settings::DEFAULT }.drawn_px(shown_px)
    }

    /// Returns the upscaling for a frame rendered at `percent` of the sides; `None` at 100 %.
    pub fn enlarging(&self, percent: f64) -> Option<Upscale> {
        let smaller = Upscale { percent: percent.round() as u16, ..self.upscale.unwrap_or_default() };
        (smaller.percent < 100).then_some(smaller)
    }

    /// Parses the value of an option of this module; returns false for other options.
    ///
    /// # Errors
    /// One line that names the option and the expected value.
    pub fn take(&mut self, item: &Item) -> Result<bool, String> {
        match item.name() {
            "ao" => self.occlusion = effect(item)?,
            "ssr" => self.reflections = effect(item)?,
            "bloom" => self.bloom = effect(item)?,
            "dof" => self.dof = effect(item)?,
            "fog" => self.fog = effect(item)?,
            "taa" => self.taa = effect(item)?,
            "dirt" => self.dirt = Some(item.raw().into()),
            "transparency" => {
                let text = item.text()?;
                self.transparency = Transparency::parse(&text).map_err(|error| format!("--transparency {error}"))?;
            }
            "scale" => self.upscale = self.enlarging(f64::from(100.0 * number(item, 0.25..=1.0)?)),
            "upscale" | "sharpness" => field(item, self.upscale.get_or_insert_default())?,
            "lod" => self.lod_error_px = number(item, 0.0..=16.0)?,
            "resolve" => {
                self.tone_resolve = item.parse("`linear` or `tone`", |text| match text {
                    "linear" => Some(false),
                    "tone" => Some(true),
                    _ => None,
                })?;
            }
            "dynamic-resolution" => {
                let expected =
                    "milliseconds above 0, with an optional minimum scale of 25 to 100 percent after a colon";
                self.dynamic = Some(item.parse(expected, dynamic)?);
            }
            "glass-layers" => {
                let expected = format!("a number from 1 to {MAX_GLASS_LAYERS}");
                let layers = |text: &str| text.parse().ok().filter(|layers| (1..=MAX_GLASS_LAYERS).contains(layers));
                self.glass_layers = item.parse(&expected, layers)?;
            }
            "layers" => self.visible_layers = item.parse("a mask of eight layers, such as 3, 0x03 or 0b11", mask)?,
            _ => return Ok(false),
        }
        Ok(true)
    }
}

/// Parses the settings of an effect.
fn effect<S: SettingsTable>(item: &Item) -> Result<Option<S>, String> {
    S::from_text(&item.text()?).map_err(|error| format!("--{} {error}", item.name()))
}

/// Parses eight bits from a decimal, hexadecimal or binary number.
fn mask(text: &str) -> Option<u8> {
    let radix =
        [("0x", 16), ("0b", 2)].into_iter().find_map(|(prefix, radix)| Some((text.strip_prefix(prefix)?, radix)));
    let (digits, radix) = radix.unwrap_or((text, 10));
    u8::from_str_radix(digits, radix).ok().filter(|_| !digits.starts_with('+'))
}

/// Parses a frame time in milliseconds, and an optional minimum scale in percent after a colon.
fn dynamic(text: &str) -> Option<[f64; 2]> {
    let (target, min) = text.split_once(':').unwrap_or((text, "50"));
    let of = |part: &str, max: f64| part.parse::<f64>().ok().filter(|x| *x > 0.0 && *x <= max);
    Some([of(target, 1e6)?, of(min, 100.0).filter(|min| *min >= 25.0)?])
}
