//! Options of effects: ambient occlusion, reflections, glass through glass, fog, bloom, depth of field,
//! anti-aliasing over time; levels of detail and visible layers.

use crate::look::number;
use framegraph_passes::transmission::MOST_GLASS_LAYERS;
use framegraph_passes::upscale::{DynamicResolution, UpscaleFilter};
use framegraph_passes::{
    BloomSettings, DofSettings, FogSettings, OcclusionSettings, ReflectionSettings, Settings, TaaSettings,
    Transparency, Upscale,
};
use framegraph_scene::draw_options::DEFAULT_MASK;
use lexopt::Parser;
use std::path::PathBuf;

/// What `render --help` prints of them.
pub const HELP: &str = "
  --ao METHOD[:KEY=X,...]  ambient occlusion from what the picture shows: off (default), sao (taps on a spiral) or gtao
                       (horizons in slices, nearer the truth). resolution=full|half, radius=M (0.3), bias=X (share of the
                       distance), intensity=X (1), power=X (1), horizon=DEG (least angle, 0), blur=off|medium|high,
                       threshold=M (between surfaces, 0.05), normals=fine|coarse, place=exact|filament (of taps),
                       bent-normals=on|off (for reflections), cone=on|off (contact shadow of the sun); sao:
                       quality=low|medium|high|ultra, taps=N, turns=N; gtao: slices=N, steps=N, step-power=X,
                       occluders=solid|fading|M (that thick)
  --ssr off|on[:KEY=X,...]  reflections of what the picture shows, from the frame before (off). thickness=M (of surfaces, 0.1),
                       bias=M (where rays begin, 0.01), distance=M (where they end, 3), stride=TEXELS (2),
                       roughness=R (from which on there are none, 0.7071)
  --fog off|on[:KEY=X,...]  fog that lies about a height (off). density=X (there, in 1/m, 0.1), height=M (0), falloff=X (of density
                       with height, in 1/m, 1), start=M (clear from the eye, 0), cut-off=M (none farther away, inf),
                       opacity=X (the most, 1), color=environment|R:G:B (nits; environment), tint=R:G:B (of the environment,
                       1:1:1), sharp=M (where that is blurred less, 100), sharp-levels=N (by how much, 1; all: 16),
                       glow=off|SIZE (about the sun, off), glow-start=M (0), mean=exact|filament (density where the start is clear)
  --bloom off|on[:KEY=X,...]  what is bright glows (off). strength=X (0.1), height=N (of the largest level in texels, 384), levels=N
                       (6), quality=low|medium|high (low), blend=add|interpolate (add), threshold=off|soft|hard (soft), at=X
                       (pre-exposed, 1), highlight=X (what it nears, 1000), fireflies=on|off (count less, on), kernel=wide|narrow (wide), dirt=X (0.2),
                       flare=on|off (of the lens, off), and with it starburst=on|off (on), aberration=X (0.005),
                       ghosts=N (4), ghost-spacing=X (0.6), ghost-at=X (10), halo=X (thickness, 0.1), halo-radius=X (0.4),
                       halo-at=X (10), flare-multiple=PX (centered in a picture of such sides, 16 as Filament; 1: in the picture)
  --dirt FILE          a PNG or JPEG picture of dirt on the lens, laid over the frame, through which bloom is seen; goes
                       together with bloom
  --dof off|on[:KEY=X,...]  what is out of focus is blurred as by a lens (off). focus=M (5), aperture=F (f-number, 2.8),
                       focal=M|view (length, of the view's angle on film of 24 mm), scale=X (of circles, 1),
                       resolution=full|half (half), before=PX, behind=PX (largest radii, 32), rings-before=N, rings-behind=N,
                       rings-even=N (of taps, 5), median=on|off (on), blended=before|after (the blur are blended surfaces drawn
                       that --transparency draws in any order; at --msaa 1 without --taa; before)
  --taa off|on[:KEY=X,...]  anti-aliasing over frames, of which --frames says how many there are (off): feedback=X (share of a
                       new frame, 0.12), width=X (of its filter, 1), jitter=rgss4|helix4|halton8|halton16|halton32,
                       box=bounds|variance|both (of colors that the sum is held to), clip=accurate|clamp|none, gamma=X
                       (deviations, 1), filter-history=on|off, filter-input=on|off, ycocg=on|off, steady=on|off (against
                       flickering), reproject=on|off, sharpness=X (afterwards, 0), converge=on|off
                       (while nothing moves, to the mean of all frames)
  --resolve linear|tone  the mean of a texel's samples: of light, or as a display shows them, which keeps edges before what
                       is bright smooth where bloom, --dof or --taa read the radiance (linear)
  --scale X            draw X times as wide and high as shown, 0.25 to 1 (1); --linear-out has the drawn size
  --upscale bilinear|fsr  how the picture is made larger then (fsr)
  --sharpness X        how much it is sharpened then, 0 to 1 (0.9)
  --dynamic-resolution MS[:LEAST]  in --turntable and --sequence, draw each frame as large as those before let it be, so that
                       it takes MS milliseconds; no smaller than LEAST percent of its sides, 25 to 100 (50)
  --lod PX             meshes are drawn in fewer triangles where they are no farther than so many pixels from where they are, or
                       texels of shadow maps, 0 to 16; 0 draws all triangles (0)
  --transparency METHOD[:KEY=X,...]  how blended surfaces are put in order: sorted (by object, default), two-passes (and back
                       faces before front faces of double-sided ones), weighted (an average, nearer ones count more), moments
                       (an average by where surfaces absorb) or peeled (layer by layer, exact); moments: precision=half|full
                       (half), overestimation=X (0.25); peeled: layers=N (1 to 32, 4)
  --glass-layers N     layers of glass that is seen through glass, 1 to 4; 1 shows what is opaque alone (1)
  --layers MASK        layers of the scene that are shown, a bit each, such as 3, 0x03 or 0b11; objects in none of them neither
                       show nor cast shadows (1)
";

/// What was asked for.
#[derive(Clone, Debug)]
pub struct Effects {
    /// Ambient occlusion.
    pub occlusion: Option<OcclusionSettings>,
    /// Reflections of what the picture shows.
    pub reflections: Option<ReflectionSettings>,
    /// Depth of field.
    pub dof: Option<DofSettings>,
    /// Bloom and lens flare.
    pub bloom: Option<BloomSettings>,
    /// The picture of dirt on the lens.
    pub dirt: Option<PathBuf>,
    /// Fog.
    pub fog: Option<FogSettings>,
    /// Anti-aliasing over time.
    pub taa: Option<TaaSettings>,
    /// Samples are averaged as a display shows them.
    pub tone_resolve: bool,
    /// Drawn smaller than shown.
    pub upscale: Option<Upscale>,
    /// Drawn as large as a time lets it be.
    pub dynamic: Option<DynamicResolution>,
    /// How far a mesh may be drawn from where it is, in pixels; 0 draws it whole.
    pub lod_error_px: f32,
    /// How blended surfaces are put in order.
    pub transparency: Transparency,
    /// Layers of glass.
    pub glass_layers: u8,
    /// Layers of the scene that are shown, a bit each.
    pub visible_layers: u8,
}

impl Default for Effects {
    /// None of them, whole meshes, and glass in one layer.
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
    /// Returns the width and height in which a picture of `shown_px` is drawn, in pixels.
    pub fn drawn_px(&self, shown_px: [u32; 2]) -> [u32; 2] {
        Settings { upscale: self.upscale, ..Settings::DEFAULT }.drawn_px(shown_px)
    }

    /// Returns how a frame that is drawn at `percent` of the width and height is enlarged; none for a whole frame.
    pub fn enlarging(&self, percent: f64) -> Option<Upscale> {
        let smaller = Upscale { percent: percent.round() as u16, ..self.upscale.unwrap_or_default() };
        (smaller.percent < 100).then_some(smaller)
    }

    /// Takes an option of this file; false for others.
    ///
    /// # Errors
    /// One line that names the option and what it takes.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        if name == "dirt" {
            self.dirt = Some(parser.value().map_err(|_| "--dirt: a file is missing")?.into());
            return Ok(true);
        }
        let mut value = || {
            let value = parser.value().map_err(|_| format!("--{name}: a value is missing"))?;
            value.into_string().map_err(|v| format!("--{name} {v:?}: the value is not Unicode"))
        };
        match name {
            "ao" => self.occlusion = OcclusionSettings::from_text(&value()?).map_err(|told| format!("--ao {told}"))?,
            "ssr" => {
                self.reflections = ReflectionSettings::from_text(&value()?).map_err(|told| format!("--ssr {told}"))?;
            }
            "bloom" => {
                self.bloom = BloomSettings::from_text(&value()?).map_err(|told| format!("--bloom {told}"))?;
            }
            "dof" => self.dof = DofSettings::from_text(&value()?).map_err(|told| format!("--dof {told}"))?,
            "fog" => self.fog = FogSettings::from_text(&value()?).map_err(|told| format!("--fog {told}"))?,
            "taa" => self.taa = TaaSettings::from_text(&value()?).map_err(|told| format!("--taa {told}"))?,
            "transparency" => {
                self.transparency =
                    Transparency::from_text(&value()?).map_err(|told| format!("--transparency {told}"))?;
            }
            "scale" => {
                self.upscale = self.enlarging(f64::from(100.0 * number("--scale", &value()?, 0.25..=1.0)?));
            }
            "upscale" => {
                let text = value()?;
                let found = UpscaleFilter::ALL.into_iter().find(|filter| filter.name() == text);
                let filter = found.ok_or_else(|| format!("--upscale {text}: `bilinear` or `fsr` is needed"))?;
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
                    other => return Err(format!("--resolve {other}: `linear` or `tone` is needed")),
                }
            }
            "dynamic-resolution" => self.dynamic = Some(dynamic(&value()?)?),
            "glass-layers" => {
                let text = value()?;
                let wrong = || format!("--glass-layers {text}: a number from 1 to {MOST_GLASS_LAYERS} is needed");
                let layers = text.parse().ok().filter(|layers| (1..=MOST_GLASS_LAYERS).contains(layers));
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

/// Eight bits, as a decimal, hexadecimal or binary number.
fn mask(text: &str) -> Option<u8> {
    let radix =
        [("0x", 16), ("0b", 2)].into_iter().find_map(|(prefix, radix)| Some((text.strip_prefix(prefix)?, radix)));
    let (digits, radix) = radix.unwrap_or((text, 10));
    u8::from_str_radix(digits, radix).ok().filter(|_| !digits.starts_with('+'))
}

/// A time in ms, and behind a colon the least share of the sides in percent.
fn dynamic(text: &str) -> Result<DynamicResolution, String> {
    let (target, least) = text.split_once(':').unwrap_or((text, "50"));
    let of = |part: &str, most: f64| part.parse::<f64>().ok().filter(|x| *x > 0.0 && *x <= most);
    match (of(target, 1e6), of(least, 100.0).filter(|least| *least >= 25.0)) {
        (Some(target_ms), Some(least_percent)) => {
            Ok(DynamicResolution { target_ms, least_percent, ..DynamicResolution::DEFAULT })
        }
        _ => Err(format!(
            "--dynamic-resolution {text}: milliseconds above 0 are needed, and behind a colon 25 to 100 percent"
        )),
    }
}
