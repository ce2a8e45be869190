//! Settings of surface shading, and of the image-based light that it needs.
//!
//! Each setting is a constant of the color pass's pipelines, so a disabled feature costs nothing. Changed settings
//! compile other pipelines, but no other shaders. The presets `high` and `low` are Filament's desktop and mobile
//! shading. `ultra` is `high` with more accurate image-based light. Table, bands and window also apply when light is
//! prefiltered.

mod fields;

use crate::light::ibl::{DfgSettings, EnvironmentFormat, IblSettings};
use crate::settings::precision::Precision;
use framegraph_scene::environment::{ShBands, ShWindow};
use framegraph_shaders::reference::dfg::Visibility;

/// Settings of the color pass. See [`Quality`] for presets.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Shading {
    /// Numeric precision of shading.
    pub precision: Precision,
    /// The visibility term of the specular lobe.
    pub visibility: Visibility,
    /// Visibility term of the DFG table, and of the [`Lighting`](crate::Lighting). If it differs from `visibility`,
    /// energy is not conserved (white furnace test). Filament combines the fast term with the table of the exact term
    /// at low quality; use that to match its pictures.
    pub table: Visibility,
    /// Minimum perceptual roughness, 0.045…1. 0.045 is safe in f32. Half floats use at least 0.089.
    pub roughness_floor: f32,
    /// Fades reflectance at grazing angles for f0 below 0.02, which no material has (Lagarde and de Rousiers, "Moving
    /// Frostbite to PBR", 2014, section 3.1.3). If false, it is 1 for all materials.
    pub f90_fades: bool,
    /// Compensates image-based light for the energy that single scattering loses (Turquin 2019).
    pub compensate_image: bool,
    /// Compensates the sun and punctual lights for the energy that single scattering loses.
    pub compensate_punctual: bool,
    /// Evaluated bands of irradiance; at most the bands that the light was computed with.
    pub bands: ShBands,
    /// Windowing of the high bands of [`Lighting`](crate::Lighting) against ringing.
    pub window: ShWindow,
    /// Source of diffuse light from the environment.
    pub irradiance: Irradiance,
    /// Storage format of the prefiltered cube of [`Lighting`](crate::Lighting).
    pub environment_format: EnvironmentFormat,
    /// Increases roughness by the variation of normals within a pixel, as gltfio's materials do. `None` disables it,
    /// and highlights may flicker.
    pub specular_aa: Option<SpecularAa>,
    /// Brightens ambient occlusion by light that bounces between occluding surfaces (Jiménez et al. 2016).
    pub multi_bounce: bool,
    /// Occludes reflections of the environment by an estimate from ambient occlusion (Lagarde and de Rousiers 2014,
    /// listing 26). If false, they are not occluded.
    pub specular_occlusion: bool,
    /// Occludes the sun by the material's ambient occlusion (Chan, "Material Advances in Call of Duty: WWII", 2018).
    pub micro_shadows: bool,
    /// Approximates reflectance under a clear coat by Filament's cubic, without a square root. The error is at most
    /// 0.022.
    pub fast_coat: bool,
    /// Lowers the f0 of the base under a clear coat, since the base meets the coat instead of air. A material may opt
    /// out ([`ClearCoat::keeps_base_f0`](framegraph_scene::material::ClearCoat::keeps_base_f0)). This is Filament's
    /// material property `clearCoatIorChange`, which gltfio disables.
    pub coat_ior_change: bool,
    /// Blur of the background seen through rough refractive surfaces.
    pub transmission_blur: TransmissionBlur,
    /// Window function that ends punctual lights at their range.
    pub light_window: LightWindow,
    /// Distance from the eye in m, above 0, beyond which punctual lights are off. They fade over the last 11 % of it,
    /// to half at 0.949 of it. `None` disables fading. Filament uses 100 m, the far end of
    /// `setDynamicLightingOptions`.
    pub light_fade_m: Option<f32>,
}

/// Source of irradiance of the environment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Irradiance {
    /// Spherical harmonics of [`Shading::bands`], from the uniform block of the frame. Reads no texture.
    #[default]
    Harmonics,
    /// Last level of the prefiltered cube, where the lobe of roughness 1 approximates irradiance. Needs no more
    /// samplers or memory, but reads a texture. The level has 16 texels a side in `low`, and 4 in `high` and `ultra`.
    /// Uniform light has no cube and uses harmonics.
    Cube,
}

/// Blur of the background seen through rough refractive surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum TransmissionBlur {
    /// By the spread of light at the rough surface, the path within the volume, and the distance to the background.
    #[default]
    Distance,
    /// By an angle that depends on roughness only, as in Filament. Near and far backgrounds are equally blurred.
    Angle,
}

/// Window function of punctual lights, where d is the distance divided by the range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum LightWindow {
    /// 1 − d⁴, as KHR_lights_punctual specifies.
    #[default]
    Gltf,
    /// (1 − d⁴)², as in Filament: darker near the range.
    Filament,
}

/// Specular antialiasing after Tokuyoshi and Kaplanyan (2019).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SpecularAa {
    /// Footprint of a pixel, above 0: Filament's is 0.15, the paper's 0.25.
    pub variance: f32,
    /// Maximum increase of alpha²: Filament's is 0.2, the paper's 0.18.
    pub threshold: f32,
}

impl SpecularAa {
    /// Filament's settings.
    pub const FILAMENT: Self = Self { variance: 0.15, threshold: 0.2 };
}

/// Use of alpha: values of the shader's `ALPHA_MODE`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AlphaUse {
    /// Opaque: alpha is ignored.
    None = 0,
    /// Discards fragments with alpha below the material's cutoff.
    Mask = 1,
    /// Multiplies color by alpha, for blending.
    Blend = 2,
}

/// Presets of [`Shading`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Quality {
    /// Hammon's visibility term with its own table, minimum roughness 0.089, single-bounce ambient occlusion.
    Low,
    /// Exact visibility term, minimum roughness 0.045, multi-bounce ambient occlusion, specular occlusion.
    #[default]
    High,
    /// [`High`](Self::High) with five bands of irradiance and reflections of twice the resolution, for still pictures.
    Ultra,
}

impl Quality {
    /// All presets.
    pub const ALL: [Self; 3] = [Self::Low, Self::High, Self::Ultra];

    /// Returns the name used in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::High => "high",
            Self::Ultra => "ultra",
        }
    }

    /// Returns the quality with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quality| quality.name() == name)
    }

    /// Returns the shading settings.
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

    /// Returns the settings of image-based light. `Low` has Filament's five levels. `High` has seven, with a smaller
    /// error between levels. `Ultra` has eight levels of a 512-texel cube (`docs/measurements/image-light.md`).
    pub const fn light(self) -> LightSettings {
        self.shading().light(self)
    }
}

/// Settings of image-based light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSettings {
    /// Settings of the prefiltered environment.
    pub image: IblSettings,
    /// Settings of the DFG table.
    pub dfg: DfgSettings,
}

impl Default for Shading {
    /// Returns the settings of [`Quality::High`].
    fn default() -> Self {
        Quality::High.shading()
    }
}

impl Shading {
    /// Returns the settings of image-based light that this shading needs, with the resolution of `quality`.
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

    /// Names of the color shader's `override` constants. Constants of a lobe exist only in shaders with that lobe.
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

    /// Returns the values of [`Shading::CONSTANTS`] for light with these `bands`.
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::key_value::OptionError;
    use crate::settings::table::SettingsTable;
    use framegraph_shaders::{Feature, Features, library, resolve};

    fn value(shading: &Shading, bands: ShBands, name: &str) -> Option<f64> {
        let values = shading.constants(AlphaUse::None, bands);
        Shading::CONSTANTS.iter().zip(values).find(|(own, _)| **own == name).map(|(_, value)| value)
    }

    /// The shader has all constants, and its defaults are the default quality.
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
    fn fields_are_set_by_name() -> Result<(), OptionError> {
        for quality in Quality::ALL {
            assert_eq!(Quality::from_name(quality.name()), Some(quality));
            assert_eq!(quality.light().dfg.visibility, quality.shading().visibility, "table and term are a pair");
        }
        assert_eq!(Quality::from_name("medium"), None);
        crate::settings::table::test::<Shading>();
        let mut low = Quality::High.shading();
        low.set_all("visibility=fast,floor=0.089,f90-fades=off,multi-bounce=off,fast-coat=on")?;
        assert_eq!(low, Quality::Low.shading());
        low.set("table", "exact")?;
        assert_eq!((low.visibility, low.table), (Visibility::Fast, Visibility::Exact));
        low.set_all(
            "coat-ior-change=off,transmission-blur=angle,light-window=filament,light-fade=100,irradiance=cube",
        )?;
        for (name, expected) in [
            ("COAT_IOR_CHANGE", 0.0),
            ("TRANSMISSION_BY_ANGLE", 1.0),
            ("SQUARED_LIGHT_WINDOW", 1.0),
            ("LIGHT_FADE_INV_FAR2", 1e-4),
            ("IRRADIANCE_FROM_CUBE", 1.0),
        ] {
            assert_eq!(value(&low, ShBands::Three, name), Some(expected), "{name}");
        }
        low.set_all("environment-format=rgbm,window=laplacian:0.5,aa=0.25:0.18,compensation=image")?;
        let image = low.light(Quality::Low).image;
        assert_eq!((image.format, image.window), (EnvironmentFormat::Rgbm, ShWindow::Laplacian { lambda: 0.5 }));
        assert_eq!(low.specular_aa, Some(SpecularAa { variance: 0.25, threshold: 0.18 }));
        assert_eq!((low.compensate_image, low.compensate_punctual), (true, false));
        for (key, value, named) in [
            ("gloss", "1", "gloss: unknown choice"),
            ("bandz", "3", "bandz: unknown choice; did you mean `bands`?"),
            ("floor", "0", "floor=0: expected a number from 0.045 to 1"),
            ("bands", "4", "bands=4: expected `2`, `3` or `5`"),
            ("window", "laplacian", "window=laplacian"),
            ("aa", "x:y", "aa=x:y: expected `on`, `off` or VARIANCE:THRESHOLD"),
            ("light-fade", "0", "light-fade=0: expected `off` or a number from 0.01 to"),
        ] {
            let error = low.set(key, value).expect_err(key).to_string();
            assert!(error.starts_with(named) && !error.contains('\n'), "{error}");
        }
        Ok(())
    }
}
