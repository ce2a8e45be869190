//! How surfaces are shaded: the quality of the color pass, and the light that goes with it.
//!
//! Every choice is a constant of the color pass's pipelines, so what is off costs nothing, and choosing another makes
//! other pipelines, not other shaders. The presets `high` and `low` are Filament's desktop and mobile shading; `ultra` is
//! `high` with more accurate light. The table, bands and window are also what the light is made with.

use crate::light::ibl::{DfgSettings, EnvironmentFormat, IblSettings};
use crate::settings::key_value::{KeyValue, OptionError};
use crate::settings::precision::Precision;
use framegraph_scene::environment::{ShBands, ShWindow};
use framegraph_shaders::reference::dfg::Visibility;

/// How the color pass shades. See [`Quality`] for sets that go together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Shading {
    /// The numbers that it computes in.
    pub precision: Precision,
    /// The visibility term of the specular lobe.
    pub visibility: Visibility,
    /// The term that the DFG table is made with, and so the [`Lighting`](crate::Lighting): another than the one that
    /// shades breaks the white furnace twice. Filament shades its low quality with the fast term and the exact term's
    /// table; pictures of it are met only so.
    pub table: Visibility,
    /// Least perceptual roughness that is shaded, 0.045…1: 0.045 is safe in f32, 0.089 where half floats shade, which no precision of 16 bits goes below.
    pub roughness_floor: f32,
    /// Reflectance at grazing fades for an f0 below 0.02, which no material has (Lagarde and de Rousiers, "Moving
    /// Frostbite to PBR", 2014, section 3.1.3); else it is 1 for all.
    pub f90_fades: bool,
    /// Image-based light gets back what single scattering loses (Turquin 2019).
    pub compensate_image: bool,
    /// The sun and punctual lights get it back.
    pub compensate_punctual: bool,
    /// Bands of irradiance that are evaluated; no more than the light was made with.
    pub bands: ShBands,
    /// Whether the [`Lighting`](crate::Lighting)'s high bands are weakened against ringing.
    pub window: ShWindow,
    /// Source of diffuse light from the environment.
    pub irradiance: Irradiance,
    /// Format that the [`Lighting`](crate::Lighting)'s prefiltered cube is stored in.
    pub environment_format: EnvironmentFormat,
    /// Roughness is widened by how much normals turn within a pixel, as in gltfio's materials; none leaves highlights to
    /// flicker.
    pub specular_aa: Option<SpecularAa>,
    /// Ambient occlusion is brightened by light between the surfaces that occlude (Jiménez et al. 2016).
    pub multi_bounce: bool,
    /// Reflections of the environment are occluded by an estimate from ambient occlusion (Lagarde and de Rousiers 2014,
    /// listing 26), instead of not at all.
    pub specular_occlusion: bool,
    /// The sun is occluded by the material's ambient occlusion (Chan, "Material Advances in Call of Duty: WWII", 2018).
    pub micro_shadows: bool,
    /// Reflectance under a clear coat by Filament's cubic, which errs by up to 0.022 and knows no square root.
    pub fast_coat: bool,
    /// The base under a clear coat meets the coat instead of air, which lowers its reflectance at normal incidence, unless
    /// the material says otherwise ([`ClearCoat::keeps_base_f0`](framegraph_scene::material::ClearCoat::keeps_base_f0)).
    /// False turns it off for all materials. Filament's material property `clearCoatIorChange`, which gltfio turns off.
    pub coat_ior_change: bool,
    /// Blur of things behind rough bodies.
    pub transmission_blur: TransmissionBlur,
    /// Window that ends punctual lights at their range.
    pub light_window: LightWindow,
    /// Distance from the eye in m, above 0, beyond which no punctual light shines; they fade over the last 11 % of it, to
    /// half at 0.949 of it. `None`: they never fade. Filament has 100 m, the far end of `setDynamicLightingOptions`.
    pub light_fade_m: Option<f32>,
}

/// Source of irradiance of the environment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Irradiance {
    /// Spherical harmonics of [`Shading::bands`], from the frame's uniform block: no texture is read.
    #[default]
    Harmonics,
    /// Last level of the prefiltered cube, which the lobe of roughness 1 fills with irradiance: no sampler or memory is added,
    /// and a texture is read. As fine as that level: 16 texels a side in `low`, 4 in `high` and `ultra`. Even light, which has
    /// no cube, keeps harmonics.
    Cube,
}

/// Blur of what is seen through rough bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum TransmissionBlur {
    /// By the light's spread at the rough face, over the way within the body and the distance from it to the thing behind it.
    #[default]
    Distance,
    /// By an angle from the eye that the roughness alone decides, as Filament has it. Things that touch the body are blurred
    /// as much as those far behind.
    Angle,
}

/// Factor on a punctual light that ends it at its range, where d is the distance over the range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum LightWindow {
    /// 1 − d⁴, as KHR_lights_punctual specifies.
    #[default]
    Gltf,
    /// (1 − d⁴)², as Filament has it: darker near the range.
    Filament,
}

/// Specular antialiasing after Tokuyoshi and Kaplanyan (2019).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SpecularAa {
    /// Footprint of a pixel, above 0: Filament's is 0.15, the paper's 0.25.
    pub variance: f32,
    /// The most that may be added to alpha²: Filament's is 0.2, the paper's 0.18.
    pub threshold: f32,
}

impl SpecularAa {
    /// Filament's.
    pub const FILAMENT: Self = Self { variance: 0.15, threshold: 0.2 };
}

/// What alpha does to a surface: values of the shader's `ALPHA_MODE`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AlphaUse {
    /// Nothing: the surface is opaque.
    None = 0,
    /// Texels below the material's cutoff are not drawn.
    Mask = 1,
    /// Color is multiplied by alpha, for blending.
    Blend = 2,
}

/// Sets of choices that go together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Quality {
    /// Hammon's visibility term with its own table, roughness from 0.089 on, occlusion without bounces.
    Low,
    /// The exact term, roughness from 0.045 on, occlusion with bounces and of reflections.
    #[default]
    High,
    /// The same with five bands of irradiance and reflections of twice the resolution: for still pictures.
    Ultra,
}

impl Quality {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Low, Self::High, Self::Ultra];

    /// As it is asked for.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::High => "high",
            Self::Ultra => "ultra",
        }
    }

    /// The quality of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quality| quality.name() == name)
    }

    /// What it chooses.
    pub const fn shading(self) -> Shading {
        let high = !matches!(self, Self::Low);
        Shading {
            precision: Precision::Full,
            visibility: if high { Visibility::Exact } else { Visibility::Fast },
            table: if high { Visibility::Exact } else { Visibility::Fast },
            roughness_floor: if high { 0.045 } else { 0.089 },
            f90_fades: high,
            compensate_image: true,
            compensate_punctual: true,
            bands: if matches!(self, Self::Ultra) { ShBands::Five } else { ShBands::Three },
            window: ShWindow::None,
            irradiance: Irradiance::Harmonics,
            environment_format: EnvironmentFormat::Rg11b10,
            specular_aa: Some(SpecularAa::FILAMENT),
            multi_bounce: high,
            specular_occlusion: true,
            micro_shadows: true,
            fast_coat: !high,
            coat_ior_change: true,
            transmission_blur: TransmissionBlur::Distance,
            light_window: LightWindow::Gltf,
            light_fade_m: None,
        }
    }

    /// What its light is made with: the low one has Filament's five levels, the high one seven, which err less between
    /// levels, and the ultra one eight of a cube of 512 texels (`docs/measurements/image-light.md`).
    pub const fn light(self) -> LightSettings {
        self.shading().light(self)
    }
}

/// What light is made with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSettings {
    /// The environment's.
    pub image: IblSettings,
    /// The table's.
    pub dfg: DfgSettings,
}

impl Default for Shading {
    /// [`Quality::High`].
    fn default() -> Self {
        Quality::High.shading()
    }
}

impl Shading {
    /// What light must be made with for this shading, as fine as `quality` says.
    pub const fn light(&self, quality: Quality) -> LightSettings {
        let (cube_texels, levels, texels) = match quality {
            Quality::Low => (256, 5, 64),
            Quality::High => (256, 7, 128),
            Quality::Ultra => (512, 8, 128),
        };
        let (bands, window, format) = (self.bands, self.window, self.environment_format);
        let image = IblSettings { cube_texels, levels, bands, window, format };
        LightSettings { image, dfg: DfgSettings { texels, visibility: self.table } }
    }

    /// Names of the `override` constants of the color shader. Those of lobes are in shaders that have the lobe.
    pub const CONSTANTS: [&'static str; 18] = [
        "ALPHA_MODE",
        "FAST_VISIBILITY",
        "ROUGHNESS_FLOOR",
        "F90_FADES",
        "ENERGY_COMPENSATION",
        "PUNCTUAL_COMPENSATION",
        "SH_BANDS",
        "IRRADIANCE_FROM_CUBE",
        "SPECULAR_AA_VARIANCE",
        "SPECULAR_AA_THRESHOLD",
        "MULTI_BOUNCE_OCCLUSION",
        "SPECULAR_OCCLUSION",
        "MICRO_SHADOWS",
        "FAST_COAT",
        "COAT_IOR_CHANGE",
        "TRANSMISSION_BY_ANGLE",
        "SQUARED_LIGHT_WINDOW",
        "LIGHT_FADE_INV_FAR2",
    ];

    /// The values of [`Shading::CONSTANTS`] where the light has these `bands`.
    pub(crate) fn constants(&self, alpha: AlphaUse, bands: ShBands) -> [f64; Self::CONSTANTS.len()] {
        let aa = self.specular_aa.unwrap_or(SpecularAa { variance: 0.0, threshold: 0.0 });
        [
            f64::from(alpha as u8),
            f64::from(self.visibility == Visibility::Fast),
            self.roughness_floor.max(self.precision.roughness_floor()).into(),
            f64::from(self.f90_fades),
            f64::from(self.compensate_image),
            f64::from(self.compensate_punctual),
            self.bands.count().min(bands.count()) as f64,
            f64::from(self.irradiance == Irradiance::Cube),
            aa.variance.into(),
            aa.threshold.into(),
            f64::from(self.multi_bounce),
            f64::from(self.specular_occlusion),
            f64::from(self.micro_shadows),
            f64::from(self.fast_coat),
            f64::from(self.coat_ior_change),
            f64::from(self.transmission_blur == TransmissionBlur::Angle),
            f64::from(self.light_window == LightWindow::Filament),
            self.light_fade_m.map_or(0.0, |far| f64::from(far.clamp(0.01, 1e9)).powi(-2)),
        ]
    }

    /// Changes one choice by name: `visibility=exact`, `floor=0.089`, `bands=5`, `aa=0.15:0.2`. [`Shading::KEYS`] has all.
    /// The visibility term brings its table.
    ///
    /// # Errors
    /// When there is no such key, or it does not take the value: one line that names the key and what it takes.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), OptionError> {
        let choice = KeyValue { key, value };
        let (wrong, switch) = (|takes| choice.wrong(takes), || choice.switch());
        let term = || match value {
            "exact" => Ok(Visibility::Exact),
            "fast" => Ok(Visibility::Fast),
            _ => Err(wrong("`exact` or `fast`")),
        };
        match key {
            "visibility" => (self.visibility, self.table) = (term()?, term()?),
            "table" => self.table = term()?,
            "floor" => self.roughness_floor = choice.number(0.045, 1.0)?,
            "f90-fades" => self.f90_fades = switch()?,
            "compensation" => {
                (self.compensate_image, self.compensate_punctual) = match value {
                    "on" => (true, true),
                    "off" => (false, false),
                    "image" => (true, false),
                    "punctual" => (false, true),
                    _ => return Err(wrong("`on`, `off`, `image` or `punctual`")),
                }
            }
            "bands" => {
                self.bands = match value {
                    "2" => ShBands::Two,
                    "3" => ShBands::Three,
                    "5" => ShBands::Five,
                    _ => return Err(wrong("2, 3 or 5")),
                }
            }
            "window" => {
                self.window = match (value, value.split_once(':')) {
                    ("none", _) => ShWindow::None,
                    ("hann", _) => ShWindow::Hann,
                    ("sinc", _) => ShWindow::Sinc,
                    (_, Some(("laplacian", lambda))) => {
                        ShWindow::Laplacian { lambda: KeyValue { key, value: lambda }.number(0.0, 1.0)?.into() }
                    }
                    _ => return Err(wrong("`none`, `hann`, `sinc` or laplacian:LAMBDA")),
                }
            }
            "irradiance" => {
                self.irradiance = match value {
                    "harmonics" => Irradiance::Harmonics,
                    "cube" => Irradiance::Cube,
                    _ => return Err(wrong("`harmonics` or `cube`")),
                }
            }
            "environment-format" => {
                self.environment_format = match value {
                    "half" => EnvironmentFormat::Half,
                    "rg11b10" => EnvironmentFormat::Rg11b10,
                    "rgbm" => EnvironmentFormat::Rgbm,
                    _ => return Err(wrong("`half`, `rg11b10` or `rgbm`")),
                }
            }
            "aa" => {
                self.specular_aa = match value {
                    "off" => None,
                    "on" => Some(SpecularAa::FILAMENT),
                    _ => {
                        let (variance, threshold) =
                            value.split_once(':').ok_or_else(|| wrong("`on`, `off` or VARIANCE:THRESHOLD"))?;
                        let number = |value| KeyValue { key, value }.number(0.0, 1.0);
                        let (variance, threshold) = (number(variance)?, number(threshold)?);
                        (variance > 0.0).then_some(SpecularAa { variance, threshold })
                    }
                }
            }
            "multi-bounce" => self.multi_bounce = switch()?,
            "specular-occlusion" => self.specular_occlusion = switch()?,
            "micro-shadows" => self.micro_shadows = switch()?,
            "fast-coat" => self.fast_coat = switch()?,
            "coat-ior-change" => self.coat_ior_change = switch()?,
            "transmission-blur" => {
                self.transmission_blur = match value {
                    "distance" => TransmissionBlur::Distance,
                    "angle" => TransmissionBlur::Angle,
                    _ => return Err(wrong("`distance` or `angle`")),
                }
            }
            "light-window" => {
                self.light_window = match value {
                    "gltf" => LightWindow::Gltf,
                    "filament" => LightWindow::Filament,
                    _ => return Err(wrong("`gltf` or `filament`")),
                }
            }
            "light-fade" => {
                self.light_fade_m = match value {
                    "off" => None,
                    _ => Some(choice.number(0.01, 1e9)?),
                }
            }
            _ => return Err(choice.unknown(&Self::KEYS)),
        }
        Ok(())
    }

    /// The names that [`Shading::set`] takes.
    pub const KEYS: [&str; 18] = [
        "visibility",
        "table",
        "floor",
        "f90-fades",
        "compensation",
        "bands",
        "window",
        "irradiance",
        "environment-format",
        "aa",
        "multi-bounce",
        "specular-occlusion",
        "micro-shadows",
        "fast-coat",
        "coat-ior-change",
        "transmission-blur",
        "light-window",
        "light-fade",
    ];
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_shaders::{Feature, Features, library, resolve};

    fn value(shading: &Shading, bands: ShBands, name: &str) -> Option<f64> {
        let values = shading.constants(AlphaUse::None, bands);
        Shading::CONSTANTS.iter().zip(values).find(|(own, _)| **own == name).map(|(_, value)| value)
    }

    /// The shader has all of these constants, and its defaults are the default quality.
    #[test]
    fn the_constants_are_those_of_the_shader() -> Result<(), Box<dyn std::error::Error>> {
        let features =
            Features::NONE.with(Feature::ENVIRONMENT_MAP).with(Feature::CLEAR_COAT).with(Feature::TRANSMISSION);
        let shader = resolve(&library::pass("pass/color.wgsl").ok_or("color")?, &features, &[])?;
        let values = Shading::default().constants(AlphaUse::None, ShBands::Five);
        for (name, value) in Shading::CONSTANTS.into_iter().zip(values) {
            let found = shader.reflection.overrides.iter().find(|o| o.name == name).ok_or(name)?;
            assert!(found.default.is_some_and(|d| (d - value).abs() < 1e-7), "{name}: {:?} for {value}", found.default);
        }
        Ok(())
    }

    #[test]
    fn half_floats_raise_the_floor_and_never_lower_it() {
        for (precision, asked, held) in
            [(Precision::Full, 0.045, 0.045_f32), (Precision::Half, 0.045, 0.089), (Precision::Half, 0.2, 0.2)]
        {
            let shading = Shading { precision, roughness_floor: asked, ..Shading::default() };
            assert_eq!(value(&shading, ShBands::Three, "ROUGHNESS_FLOOR"), Some(f64::from(held)));
        }
    }

    #[test]
    fn bands_that_the_light_lacks_are_not_evaluated() {
        let shading = Shading { bands: ShBands::Five, ..Shading::default() };
        let bands = |light| value(&shading, light, "SH_BANDS");
        assert_eq!([ShBands::Two, ShBands::Three, ShBands::Five].map(bands), [Some(2.0), Some(3.0), Some(5.0)]);
    }

    #[test]
    fn choices_are_made_by_name() -> Result<(), OptionError> {
        for quality in Quality::ALL {
            assert_eq!(Quality::from_name(quality.name()), Some(quality));
            assert_eq!(quality.light().dfg.visibility, quality.shading().visibility, "table and term are a pair");
        }
        assert_eq!(Quality::from_name("medium"), None);
        let mut low = Quality::High.shading();
        for (key, value) in [
            ("visibility", "fast"),
            ("floor", "0.089"),
            ("f90-fades", "off"),
            ("compensation", "on"),
            ("bands", "3"),
            ("window", "none"),
            ("irradiance", "harmonics"),
            ("environment-format", "rg11b10"),
            ("aa", "on"),
            ("micro-shadows", "on"),
            ("multi-bounce", "off"),
            ("specular-occlusion", "on"),
            ("fast-coat", "on"),
            ("coat-ior-change", "on"),
            ("transmission-blur", "distance"),
            ("light-window", "gltf"),
            ("light-fade", "off"),
        ] {
            assert!(Shading::KEYS.contains(&key));
            low.set(key, value)?;
        }
        assert_eq!(low, Quality::Low.shading());
        low.set("table", "exact")?;
        assert_eq!((low.visibility, low.table), (Visibility::Fast, Visibility::Exact));
        for (key, value) in [
            ("coat-ior-change", "off"),
            ("transmission-blur", "angle"),
            ("light-window", "filament"),
            ("light-fade", "100"),
            ("irradiance", "cube"),
            ("environment-format", "rgbm"),
        ] {
            low.set(key, value)?;
        }
        assert_eq!((low.coat_ior_change, low.light_window), (false, LightWindow::Filament));
        for (name, expected) in [
            ("COAT_IOR_CHANGE", 0.0),
            ("TRANSMISSION_BY_ANGLE", 1.0),
            ("SQUARED_LIGHT_WINDOW", 1.0),
            ("LIGHT_FADE_INV_FAR2", 1e-4),
            ("IRRADIANCE_FROM_CUBE", 1.0),
        ] {
            assert_eq!(value(&low, ShBands::Three, name), Some(expected), "{name}");
        }
        assert_eq!(low.light(Quality::Low).image.format, EnvironmentFormat::Rgbm);
        low.set("window", "laplacian:0.01")?;
        assert_eq!(low.light(Quality::Low).image.window, ShWindow::Laplacian { lambda: f64::from(0.01_f32) });
        low.set("aa", "0.25:0.18")?;
        assert_eq!(low.specular_aa, Some(SpecularAa { variance: 0.25, threshold: 0.18 }));
        for (key, value) in [
            ("gloss", "1"),
            ("floor", "0"),
            ("floor", "NaN"),
            ("bands", "4"),
            ("window", "laplacian"),
            ("aa", "1"),
            ("aa", "x:y"),
            ("light-window", "square"),
            ("transmission-blur", "on"),
            ("light-fade", "0"),
            ("irradiance", "2"),
            ("environment-format", "float"),
        ] {
            let told = low.set(key, value).expect_err("that is no choice").to_string();
            assert!(told.contains(key) && !told.contains('\n'), "{told}");
        }
        Ok(())
    }
}
