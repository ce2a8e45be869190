//! Options of what is made of the picture itself: ambient occlusion, reflections, glass through glass, anti-aliasing over time.

use framegraph_passes::transmission::MOST_GLASS_LAYERS;
use framegraph_passes::{OcclusionSettings, ReflectionSettings, TaaSettings};
use lexopt::Parser;

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
  --taa off|on[:KEY=X,...]  anti-aliasing over frames, of which --frames says how many there are (off): feedback=X (share of a
                       new frame, 0.12), width=X (of its filter, 1), jitter=rgss4|helix4|halton8|halton16|halton32,
                       box=bounds|variance|both (of colors that the sum is held to), clip=accurate|clamp|none, gamma=X
                       (deviations, 1), filter-history=on|off, filter-input=on|off, ycocg=on|off, steady=on|off (against
                       flickering), reproject=on|off, sharpness=X (afterwards, 0), converge=on|off
                       (while nothing moves, to the mean of all frames)
  --glass-layers N     layers of glass that is seen through glass, 1 to 4; 1 shows what is opaque alone (1)
";

/// What was asked for.
#[derive(Clone, Copy, Debug)]
pub struct Effects {
    /// Ambient occlusion.
    pub occlusion: Option<OcclusionSettings>,
    /// Reflections of what the picture shows.
    pub reflections: Option<ReflectionSettings>,
    /// Anti-aliasing over time.
    pub taa: Option<TaaSettings>,
    /// Layers of glass.
    pub glass_layers: u8,
}

impl Default for Effects {
    /// None of them, and glass in one layer.
    fn default() -> Self {
        Self { occlusion: None, reflections: None, taa: None, glass_layers: 1 }
    }
}

impl Effects {
    /// Takes an option of this file; false for others.
    ///
    /// # Errors
    /// One line that names the option and what it takes.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        let mut value = || {
            let value = parser.value().map_err(|_| format!("--{name}: a value is missing"))?;
            value.into_string().map_err(|v| format!("--{name} {v:?}: the value is not Unicode"))
        };
        match name {
            "ao" => self.occlusion = OcclusionSettings::from_text(&value()?).map_err(|told| format!("--ao {told}"))?,
            "ssr" => {
                self.reflections = ReflectionSettings::from_text(&value()?).map_err(|told| format!("--ssr {told}"))?;
            }
            "taa" => self.taa = TaaSettings::from_text(&value()?).map_err(|told| format!("--taa {told}"))?,
            "glass-layers" => {
                let text = value()?;
                let wrong = || format!("--glass-layers {text}: a number from 1 to {MOST_GLASS_LAYERS} is needed");
                let layers = text.parse().ok().filter(|layers| (1..=MOST_GLASS_LAYERS).contains(layers));
                self.glass_layers = layers.ok_or_else(wrong)?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}
