//! Settings files: RON text with a version. `docs/reference/settings.md` documents the schema.

use crate::frame::frame_settings::FrameSettings;
use crate::frame::tables::sections;
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
    #[error("{path}: {field} is {value}; expected {takes}")]
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

    /// Checks every value against its table.
    fn check(&self, path: &str) -> Result<(), SettingsError> {
        let rows = sections().iter().flat_map(|section| &section.rows);
        match rows.into_iter().find_map(|row| row.wrong(self).map(|wrong| (row, wrong))) {
            Some((row, (value, takes))) => {
                Err(SettingsError::Range { path: path.into(), field: &row.path, value, takes })
            }
            None => Ok(()),
        }
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
                "settings.transparency.layers is 33; expected a whole number from 1 to 32",
            ),
            ("(version: 1, frame: (settings: (samples: 3)))", "settings.samples is 3; expected 1 or 4"),
            (
                "(version: 1, frame: (settings: (post: (dither: NaN))))",
                "settings.post.dither is NaN; expected a number from 0 to 1",
            ),
            ("(version: 1, frame: (settings: (occlusion: (method: Sao(taps: 0, turns: 1)))))", "method.taps is 0"),
            (
                "(version: 1, frame: (settings: (occlusion: (method: Gtao(slices: 1, steps: 1, step_power: 11, occluders: Solid)))))",
                "settings.occlusion.method.step_power is 11; expected a number from 0.1 to 10",
            ),
            (
                "(version: 1, frame: (settings: (post: (look: (grading: (contrast: NaN))))))",
                "settings.post.look.grading.contrast is NaN; expected a number from 0 to 2",
            ),
            ("(version: 1, frame: (settings: (hdr_format: R8Unorm)))", "`Rgba16Float` or `Rg11b10Ufloat`"),
            ("(version: 1, frame: (settings: (blended: true)))", "no field `blended`"),
        ] {
            let error = FrameSettings::from_ron("a.ron", text).expect_err("that is wrong").to_string();
            assert!(error.contains(told) && error.starts_with("a.ron") && !error.contains('\n'), "{text}: {error}");
        }
    }
}
