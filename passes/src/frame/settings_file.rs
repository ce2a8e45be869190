//! Settings files: RON text with a version. `docs/reference/settings.md` documents the schema.

mod lens;

use crate::effects::occlusion::Method;
use crate::effects::transparency::{MAX_PEEL_LAYERS, Transparency};
use crate::frame::frame_settings::FrameSettings;
use framegraph::Format;
use framegraph::file::{FileErrors, document, to_document};
use std::fmt::Debug;

/// Version of the format that is read and written.
pub const SETTINGS_VERSION: u32 = 1;

/// Error of reading a settings file.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// Invalid RON, an unsupported version, or an unknown field or value.
    #[error(transparent)]
    File(#[from] FileErrors),
    /// A value is out of range.
    #[error("{path}: {field} is {value}; {takes} is needed")]
    Range {
        /// Name of the file.
        path: String,
        /// Path of the field within the frame settings.
        field: &'static str,
        /// Rejected value.
        value: String,
        /// Allowed range.
        takes: String,
    },
}

impl Debug for SettingsError {
    /// Prints the message, as `unwrap` shows it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Contents of a settings file.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct SettingsForm {
    version: u32,
    #[serde(default)]
    frame: FrameSettings,
}

impl FrameSettings {
    /// Reads settings from `text`. Errors name the file `path`. Omitted fields have their default.
    ///
    /// # Errors
    /// Fails as [`SettingsError`] describes.
    pub fn from_ron(path: &str, text: &str) -> Result<Self, SettingsError> {
        let form: SettingsForm = document(path, text, SETTINGS_VERSION)?;
        form.frame.check(path)?;
        Ok(form.frame)
    }

    /// Returns the settings as a complete file.
    ///
    /// # Errors
    /// Fails if RON cannot represent a value, which no valid settings have.
    pub fn to_ron(&self) -> Result<String, String> {
        to_document(&SettingsForm { version: SETTINGS_VERSION, frame: *self })
    }

    /// Checks the range of every number.
    fn check(&self, path: &str) -> Result<(), SettingsError> {
        let refuse =
            |field, value: String, takes: String| Err(SettingsError::Range { path: path.into(), field, value, takes });
        for (field, value, low, high) in self.ranges() {
            if !(low..=high).contains(&value) {
                return refuse(field, value.to_string(), format!("a number from {low} to {high}"));
            }
        }
        let settings = &self.settings;
        if !matches!(settings.samples, 1 | 4) {
            return refuse("settings.samples", settings.samples.to_string(), "1 or 4".into());
        }
        if !matches!(settings.shadows.map_or(1, |shadows| shadows.moments.samples), 1 | 4) {
            let samples = settings.shadows.map_or(0, |shadows| shadows.moments.samples).to_string();
            return refuse("settings.shadows.moments.samples", samples, "1 or 4".into());
        }
        for (field, value) in [
            ("settings.post.look", format!("{:?}", settings.post.look)),
            ("settings.post.edge_fade", format!("{:?}", settings.post.edge_fade)),
            ("settings.occlusion", format!("{:?}", settings.occlusion)),
        ] {
            if ["NaN", "inf"].iter().any(|word| value.contains(word)) {
                return refuse(field, "not finite".into(), "a finite number in each field".into());
            }
        }
        if !matches!(settings.hdr_format, Format::Rgba16Float | Format::Rg11b10Ufloat) {
            let takes = "Rgba16Float or Rg11b10Ufloat".into();
            return refuse("settings.hdr_format", format!("{:?}", settings.hdr_format), takes);
        }
        Ok(())
    }

    /// Returns the numbers that have a range: field, value, minimum and maximum.
    pub fn ranges(&self) -> Vec<(&'static str, f64, f64, f64)> {
        let s = &self.settings;
        let mut all = vec![
            ("lod_error_px", self.lod_error_px.into(), 0.0, 16.0),
            ("visible_layers", self.visible_layers.into(), 0.0, 255.0),
            (
                "settings.glass_layers",
                f64::from(s.glass_layers),
                1.0,
                f64::from(crate::effects::transmission::MAX_GLASS_LAYERS),
            ),
            ("settings.shading.roughness_floor", s.shading.roughness_floor.into(), 0.045, 1.0),
            ("settings.post.compensation_ev", s.post.compensation_ev.into(), -16.0, 16.0),
            ("settings.post.vignette_ev", s.post.vignette_ev.into(), 0.0, 16.0),
            ("settings.post.dither", s.post.dither.into(), 0.0, 1.0),
        ];
        match s.transparency {
            Transparency::Peeled { layers } => {
                all.push(("settings.transparency.layers", layers.into(), 1.0, MAX_PEEL_LAYERS.into()));
            }
            Transparency::Moments(moments) => {
                all.push(("settings.transparency.overestimation", moments.overestimation.into(), 0.0, 1.0));
            }
            Transparency::Sorted | Transparency::TwoPasses | Transparency::Weighted => {}
        }
        if let Some(aa) = s.shading.specular_aa {
            all.push(("settings.shading.specular_aa.variance", aa.variance.into(), 1e-6, 1.0));
            all.push(("settings.shading.specular_aa.threshold", aa.threshold.into(), 0.0, 1.0));
        }
        if let Some(shadows) = &s.shadows {
            let most = f64::from(crate::gpu_scene::shadow_views::MAX_MAPS);
            let cascades = f64::from(shadows.cascades);
            all.extend([
                ("settings.shadows.map_texels", shadows.map_texels.into(), 16.0, 16384.0),
                ("settings.shadows.cascades", cascades, 0.0, 4.0),
                ("settings.shadows.local_maps", shadows.local_maps.into(), 0.0, most - cascades.min(4.0)),
                ("settings.shadows.local_layers", shadows.local_layers.into(), 1.0, most),
                ("settings.shadows.far_m", shadows.far_m.unwrap_or(1.0), 0.01, 1e7),
                ("settings.shadows.bias.constant_m", shadows.bias.constant_m.into(), 0.0, 10.0),
                ("settings.shadows.bias.normal", shadows.bias.normal.into(), 0.0, 100.0),
                ("settings.shadows.bias.slope", shadows.bias.slope.into(), 0.0, 100.0),
                ("settings.shadows.bulb_m", shadows.bulb_m.unwrap_or(1.0).into(), 1e-6, 1e3),
                ("settings.shadows.moments.blur_texels", shadows.moments.blur_texels.into(), 0.0, 125.0),
                ("settings.shadows.moments.levels", shadows.moments.levels.into(), 1.0, 8.0),
                ("settings.shadows.moments.bleed", shadows.moments.bleed.into(), 0.0, 0.99),
            ]);
            if let Some(contact) = shadows.contact {
                all.push(("settings.shadows.contact.steps", contact.steps.into(), 1.0, 256.0));
                all.push(("settings.shadows.contact.distance_m", contact.distance_m.into(), 0.001, 100.0));
            }
        }
        if let Some(occlusion) = &s.occlusion {
            all.extend([
                ("settings.occlusion.radius_m", occlusion.radius_m.into(), 0.0, 1e4),
                ("settings.occlusion.bias", occlusion.bias.into(), 0.0, 1.0),
                ("settings.occlusion.intensity", occlusion.intensity.into(), 0.0, 16.0),
                ("settings.occlusion.power", occlusion.power.into(), 0.0, 16.0),
            ]);
            match occlusion.method {
                Method::Sao { taps, turns } => all.extend([
                    ("settings.occlusion.method.taps", taps.into(), 1.0, 64.0),
                    ("settings.occlusion.method.turns", turns.into(), 1.0, 64.0),
                ]),
                Method::Gtao(gtao) => all.extend([
                    ("settings.occlusion.method.slices", gtao.slices.into(), 1.0, 16.0),
                    ("settings.occlusion.method.steps", gtao.steps.into(), 1.0, 32.0),
                    ("settings.occlusion.method.step_power", gtao.step_power.into(), 0.1, 10.0),
                ]),
            }
            if let Some(blur) = occlusion.blur {
                all.extend([
                    ("settings.occlusion.blur.reach", blur.reach.into(), 1.0, 12.0),
                    ("settings.occlusion.blur.stride", blur.stride.into(), 1.0, 16.0),
                    ("settings.occlusion.blur.sigma", blur.sigma.into(), 0.1, 100.0),
                    ("settings.occlusion.blur.threshold_m", blur.threshold_m.into(), 1e-6, 1e4),
                ]);
            }
        }
        if let Some(upscale) = &s.upscale {
            all.push(("settings.upscale.percent", upscale.percent.into(), 25.0, 100.0));
            all.push(("settings.upscale.sharpness", upscale.sharpness.into(), 0.0, 1.0));
        }
        if let Some(taa) = &s.taa {
            all.extend([
                ("settings.taa.feedback", taa.feedback.into(), 0.0, 1.0),
                ("settings.taa.filter_width", taa.filter_width.into(), 0.5, 4.0),
                ("settings.taa.sharpness", taa.sharpness.into(), 0.0, 1.0),
                ("settings.taa.variance_gamma", taa.variance_gamma.into(), 0.0, 4.0),
            ]);
        }
        if let Some(reflections) = &s.reflections {
            all.extend([
                ("settings.reflections.thickness_m", reflections.thickness_m.into(), 0.0, 1e4),
                ("settings.reflections.bias_m", reflections.bias_m.into(), 0.0, 100.0),
                ("settings.reflections.reach_m", reflections.reach_m.into(), 1e-3, 1e5),
                ("settings.reflections.stride_texels", reflections.stride_texels.into(), 1.0, 64.0),
                ("settings.reflections.most_roughness", reflections.most_roughness.into(), 0.0, 1.0),
            ]);
        }
        all.extend(lens::ranges(s));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quality::preset::Preset;

    #[test]
    fn files_say_what_they_were_written_from() -> Result<(), Box<dyn std::error::Error>> {
        let frames = Preset::ALL.map(Preset::frame).into_iter().chain([FrameSettings::DEFAULT]);
        for frame in frames {
            let text = frame.to_ron()?;
            assert_eq!(FrameSettings::from_ron("a.ron", &text)?, frame, "{text}");
        }
        assert_eq!(FrameSettings::from_ron("a.ron", "(version: 1)")?, FrameSettings::DEFAULT);
        Ok(())
    }

    #[test]
    fn what_is_wrong_is_named_with_what_was_meant() {
        for (text, told) in [
            ("()", "version"),
            ("(version: 2)", "version 2"),
            ("(version: 1, fame: ())", "did you mean `frame`?"),
            ("(version: 1, frame: (settings: (sample: 4)))", "did you mean `samples`?"),
            ("(version: 1, frame: (settings: (shading: (micro_shadow: true))))", "did you mean `micro_shadows`?"),
            ("(version: 1, frame: (quality: Hgih))", "did you mean `High`?"),
            (
                "(version: 1, frame: (settings: (transparency: Peeled(layers: 33))))",
                "settings.transparency.layers is 33; a number from 1 to 32",
            ),
            ("(version: 1, frame: (settings: (samples: 3)))", "settings.samples is 3; 1 or 4 is needed"),
            (
                "(version: 1, frame: (settings: (post: (dither: NaN))))",
                "settings.post.dither is NaN; a number from 0 to 1",
            ),
            ("(version: 1, frame: (settings: (occlusion: (method: Sao(taps: 0, turns: 1)))))", "method.taps is 0"),
            (
                "(version: 1, frame: (settings: (post: (look: (grading: (contrast: NaN))))))",
                "settings.post.look is not finite",
            ),
            ("(version: 1, frame: (settings: (hdr_format: R8Unorm)))", "Rgba16Float or Rg11b10Ufloat"),
            ("(version: 1, frame: (settings: (blended: true)))", "no field `blended`"),
        ] {
            let error = FrameSettings::from_ron("a.ron", text).expect_err("that is wrong").to_string();
            assert!(error.contains(told) && error.starts_with("a.ron") && !error.contains('\n'), "{text}: {error}");
        }
    }
}
