//! Options of effects: ambient occlusion, reflections, glass layers, fog, bloom, depth of field, temporal anti-aliasing,
//! levels of detail, transparency and visible layers.

use crate::parse::number;
use framegraph_passes::effects::transmission::MAX_GLASS_LAYERS;
use framegraph_passes::effects::upscale::{DynamicResolution, UpscaleFilter};
use framegraph_passes::{
    BloomSettings, DofSettings, FogSettings, OcclusionSettings, ReflectionSettings, Settings, TaaSettings,
    Transparency, Upscale,
};
use framegraph_scene::draw_options::DEFAULT_MASK;
use lexopt::Parser;
use std::path::PathBuf;

/// Help section.
pub const HELP: &str = "\
EFFECTS
  --ao METHOD[:KEY=X,...]  screen-space ambient occlusion: off (default), sao (taps on a spiral) or gtao (horizon search in
                       slices, more accurate). resolution=full|half, radius=M (0.3), bias=X (relative to distance),
                       intensity=X (1), power=X (1), horizon=DEG (minimum angle, 0), blur=off|low|medium|high,
                       threshold=M (depth difference between surfaces, 0.05), normals=fine|coarse,
                       place=exact|filament (position of taps), bent-normals=on|off (for reflections),
                       cone=on|off (contact shadow of the sun). sao: quality=low|medium|high|ultra, taps=N, turns=N.
                       gtao: slices=N, steps=N, step-power=X, occluders=solid|fading|M (thickness)
  --ssr off|on[:KEY=X,...]  screen-space reflections of the previous frame (off). thickness=M (of surfaces, 0.1),
                       bias=M (start of rays, 0.01), distance=M (maximum ray length, 3), stride=TEXELS (1; above, blocks are not skipped),
                       roughness=R (maximum roughness, 0.7071)
  --fog off|on[:KEY=X,...]  height fog (off). density=X (at the fog height, in 1/m, 0.1), height=M (0), falloff=X (height
                       falloff, in 1/m, 1), start=M (distance from the eye, 0), cut-off=M (no fog beyond, inf),
                       opacity=X (maximum, 1), color=environment|R:G:B (nits; environment), tint=R:G:B (of the environment,
                       1:1:1), sharp=M (distance from which it is blurred less, 100), sharp-levels=N (mip
                       levels less, 1; all: 16),
                       glow=off|SIZE (around the sun, off), glow-start=M (0), mean=exact|filament (mean density with start)
  --bloom off|on[:KEY=X,...]  bloom (off). strength=X (0.1), height=N (of the largest level in texels, 384), levels=N (6),
                       quality=low|medium|high (low), blend=add|interpolate (add), threshold=off|soft|hard (soft),
                       at=X (pre-exposed, 1), highlight=X (limit of compressed highlights, 1000), fireflies=on|off (reduce
                       them, on), kernel=wide|narrow (wide), dirt=X (0.2), flare=on|off (lens flare, off). Lens flare:
                       starburst=on|off (on), aberration=X (0.005), ghosts=N (4), ghost-spacing=X (0.6), ghost-at=X (10),
                       halo=X (thickness, 0.1), halo-radius=X (0.4), halo-at=X (10), flare-multiple=PX (center the flare in
                       a picture with sides rounded to a multiple of PX: 16 as Filament, 1 for the exact size)
  --dirt FILE          PNG or JPEG picture of lens dirt, stretched over the frame, for bloom; requires bloom
  --dof off|on[:KEY=X,...]  depth of field (off). focus=M (5), aperture=F (f-number, 2.8), focal=M|view (focal length; view:
                       from the field of view on 24 mm film), scale=X (of circles of confusion, 1), resolution=full|half
                       (half), before=PX, behind=PX (maximum radii, 32), rings-before=N, rings-behind=N, rings-even=N (of
                       taps, 5), median=on|off (on), blended=before|after (draw blended surfaces before or after the blur, before;
                       after needs an order-independent --transparency)
  --taa off|on[:KEY=X,...]  temporal anti-aliasing over --frames frames (off). feedback=X (weight of a new frame, 0.12),
                       width=X (of its filter, 1), jitter=rgss4|helix4|halton8|halton16|halton32,
                       box=bounds|variance|both (color box that clips the history), clip=accurate|clamp|none,
                       gamma=X (standard deviations, 1), filter-history=on|off, filter-input=on|off, ycocg=on|off,
                       steady=on|off (reduces flicker), reproject=on|off, sharpness=X (sharpening afterwards, 0),
                       converge=on|off (average all frames while nothing moves)
  --resolve linear|tone  MSAA resolve of radiance, or of tone-mapped values, which keeps edges smooth in front of bright
                       areas when bloom, --dof or --taa read the radiance (linear)
  --scale X            render at X times the width and height, 0.25 to 1, and upscale (1); --linear-out has the rendered size
  --upscale bilinear|fsr  upscaling filter (fsr)
  --sharpness X        sharpening after upscaling, 0 to 1 (0.9)
  --dynamic-resolution MS[:MIN]  in --turntable and --sequence, scale each frame so that it takes MS milliseconds, but not
                       below MIN percent of the sides, 25 to 100 (50)
  --lod PX             draw simplified meshes while the geometric error is at most PX pixels, or shadow-map texels, 0 to 16;
                       0 draws all triangles (0)
  --transparency METHOD[:KEY=X,...]  blended surfaces: sorted (by object, default), two-passes (also back faces before front
                       faces of double-sided surfaces), weighted (weighted average), moments (weighted by moments of
                       absorbance) or peeled (layer by layer, exact). moments: precision=half|full (half), overestimation=X
                       (0.25). peeled: layers=N (1 to 32, 4)
  --glass-layers N     layers of glass visible through glass, 1 to 4; 1 shows only opaque surfaces behind glass (1)
  --layers MASK        visible layers of the scene, one bit each, such as 3, 0x03 or 0b11; objects in none of them are not drawn
                       and cast no shadows (1)
";

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
    /// Dynamic resolution.
    pub dynamic: Option<DynamicResolution>,
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
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        if name == "dirt" {
            self.dirt = Some(parser.value().map_err(|_| "--dirt: missing file")?.into());
            return Ok(true);
        }
        let mut value = || {
            let value = parser.value().map_err(|_| format!("--{name}: missing value"))?;
            value.into_string().map_err(|v| format!("--{name} {v:?}: the value is not Unicode"))
        };
        match name {
            "ao" => {
                self.occlusion = OcclusionSettings::from_text(&value()?).map_err(|error| format!("--ao {error}"))?;
            }
            "ssr" => {
                self.reflections =
                    ReflectionSettings::from_text(&value()?).map_err(|error| format!("--ssr {error}"))?;
            }
            "bloom" => {
                self.bloom = BloomSettings::from_text(&value()?).map_err(|error| format!("--bloom {error}"))?;
            }
            "dof" => self.dof = DofSettings::from_text(&value()?).map_err(|error| format!("--dof {error}"))?,
            "fog" => self.fog = FogSettings::from_text(&value()?).map_err(|error| format!("--fog {error}"))?,
            "transparency" => {
                self.transparency =
                    Transparency::from_text(&value()?).map_err(|error| format!("--transparency {error}"))?;
            }
            "taa" => self.taa = TaaSettings::from_text(&value()?).map_err(|error| format!("--taa {error}"))?,
            "scale" => {
                self.upscale = self.enlarging(f64::from(100.0 * number("--scale", &value()?, 0.25..=1.0)?));
            }
            "upscale" => {
                let text = value()?;
                let found = UpscaleFilter::ALL.into_iter().find(|filter| filter.name() == text);
                let filter = found.ok_or_else(|| format!("--upscale {text}: expected `bilinear` or `fsr`"))?;
                self.upscale.get_or_insert_default().filter = filter;
            }
            "sharpness" => {
                self.upscale.get_or_insert_default().sharpness = number("--sharpness", &value()?, 0.0..=1.0)?;
            }
            "lod" => self.lod_error_px = number("--lod", &value()?, 0.0..=16.0)?,
            "resolve" => {
                self.tone_resolve = match value()?.as_str() {
                    "linear" => false,
                    "tone" => true,
                    other => return Err(format!("--resolve {other}: expected `linear` or `tone`")),
                }
            }
            "dynamic-resolution" => self.dynamic = Some(dynamic(&value()?)?),
            "glass-layers" => {
                let text = value()?;
                let wrong = || format!("--glass-layers {text}: expected a number from 1 to {MAX_GLASS_LAYERS}");
                let layers = text.parse().ok().filter(|layers| (1..=MAX_GLASS_LAYERS).contains(layers));
                self.glass_layers = layers.ok_or_else(wrong)?;
            }
            "layers" => {
                let text = value()?;
                self.visible_layers = mask(&text).ok_or_else(|| {
                    format!("--layers {text}: a mask of eight layers is needed, such as 3, 0x03 or 0b11")
                })?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}

/// Parses eight bits from a decimal, hexadecimal or binary number.
fn mask(text: &str) -> Option<u8> {
    let radix =
        [("0x", 16), ("0b", 2)].into_iter().find_map(|(prefix, radix)| Some((text.strip_prefix(prefix)?, radix)));
    let (digits, radix) = radix.unwrap_or((text, 10));
    u8::from_str_radix(digits, radix).ok().filter(|_| !digits.starts_with('+'))
}

/// Parses a frame time in milliseconds, and an optional minimum scale in percent after a colon.
fn dynamic(text: &str) -> Result<DynamicResolution, String> {
    let (target, min) = text.split_once(':').unwrap_or((text, "50"));
    let of = |part: &str, max: f64| part.parse::<f64>().ok().filter(|x| *x > 0.0 && *x <= max);
    match (of(target, 1e6), of(min, 100.0).filter(|min| *min >= 25.0)) {
        (Some(target_ms), Some(least_percent)) => {
            Ok(DynamicResolution { target_ms, least_percent, ..DynamicResolution::DEFAULT })
        }
        _ => Err(format!(
            "--dynamic-resolution {text}: expected milliseconds above 0, with an optional minimum scale of 25 to 100 percent after a colon"
        )),
    }
}
