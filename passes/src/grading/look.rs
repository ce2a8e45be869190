//! Color processing from radiance to the encoded picture, except dither; with its `f64` reference.

use super::error::GradingError;
use framegraph_scene::ColorTable;
use framegraph_shaders::layout::{Grading, ToneMap};
use framegraph_shaders::reference::grade::Grade;
use framegraph_shaders::reference::srgb::srgb_from_linear;
use framegraph_shaders::reference::tone_map::{tone_curve, tone_in_rec2020, tone_map_with};
use glam::DVec3;
use std::fmt;
use std::sync::Arc;

/// Color grading and tone curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Look {
    /// Grading, before the tone curve.
    pub grading: Grading,
    /// Tone curve.
    pub tone_map: ToneMap,
    /// Applies the curve to luminance only, which keeps hues (Filament's luminance scaling).
    pub luminance_scaling: bool,
    /// Moves colors outside the display's gamut into it at the same hue, instead of clipping (Filament's gamut
    /// mapping).
    pub gamut_mapping: bool,
}

/// Custom tone curve: maps linear Rec.2020 to linear Rec.2020 of a display with white at 1. Called with finite
/// non-negative numbers, from several threads. Results are clamped to 0…1, and NaN becomes 0.
#[derive(Clone)]
pub struct OwnCurve(Arc<dyn Fn(DVec3) -> DVec3 + Send + Sync>);

impl OwnCurve {
    /// Wraps a function as a tone curve.
    pub fn new(curve: impl Fn(DVec3) -> DVec3 + Send + Sync + 'static) -> Self {
        Self(Arc::new(curve))
    }
}

impl fmt::Debug for OwnCurve {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("OwnCurve")
    }
}

/// Parts of a look that exist only on the CPU and require a table.
#[derive(Clone, Debug, Default)]
pub struct Extras {
    /// Curve for [`ToneMap::Own`].
    pub own: Option<OwnCurve>,
    /// Color table applied last, to sRGB encoded colors.
    pub colors: Option<Arc<ColorTable>>,
}

impl Look {
    /// Neutral grading, and Hill's fit of the ACES curve.
    pub const DEFAULT: Self =
        Self { grading: Grading::NEUTRAL, tone_map: ToneMap::Hill, luminance_scaling: false, gamut_mapping: false };

    /// Checks that a shader can compute the whole look.
    ///
    /// # Errors
    /// Fails with [`GradingError::NeedsTable`] if a part requires a table.
    pub fn is_direct(&self, extras: &Extras) -> Result<(), GradingError> {
        match (self.tone_map, &extras.colors) {
            (ToneMap::Own, _) => Err(GradingError::NeedsTable { what: "a custom tone curve" }),
            (_, Some(_)) => Err(GradingError::NeedsTable { what: "a file of colors" }),
            _ => Ok(()),
        }
    }

    /// Returns true if the tone effect outputs sRGB encoded colors. The curve is then an encoded one, without luminance
    /// scaling and gamut mapping, which need linear light.
    pub const fn is_encoded(&self) -> bool {
        self.tone_map.is_encoded() && !self.luminance_scaling && !self.gamut_mapping
    }

    /// Returns true if output channels are independent, so that a one-dimensional table suffices.
    pub fn keeps_channels_apart(&self, extras: &Extras) -> bool {
        // Grading in Rec.2020 mixes the channels of Rec.709, unless it is neutral and skipped.
        let grading = if self.tone_map.graded_in_rec2020() {
            self.grading == Grading::NEUTRAL
        } else {
            self.grading.keeps_channels_apart()
        };
        grading
            && self.tone_map.keeps_channels_apart()
            && !self.luminance_scaling
            && !self.gamut_mapping
            && extras.colors.is_none()
    }

    /// Returns the look as a function from linear Rec.709 to sRGB encoded colors, 0…1.
    ///
    /// # Errors
    /// Fails with [`GradingError::NoOwnCurve`] if the custom curve is missing.
    pub fn function<'a>(&self, extras: &'a Extras) -> Result<impl Fn(DVec3) -> DVec3 + Sync + use<'a>, GradingError> {
        let Self { grading, tone_map, luminance_scaling, gamut_mapping } = *self;
        let grade = (grading != Grading::NEUTRAL).then(|| Grade::new(&grading, tone_map.graded_in_rec2020()));
        let own = match tone_map.number() {
            Some(_) => None,
            None => Some(extras.own.as_ref().ok_or(GradingError::NoOwnCurve)?),
        };
        let (number, generic) = (tone_map.number().unwrap_or(u32::MAX), tone_map.generic());
        let finite = |c: DVec3| DVec3::from_array(c.to_array().map(|x| if x.is_nan() { 0.0 } else { x }));
        Ok(move |color: DVec3| {
            let graded = grade.as_ref().map_or(color, |grade| grade.apply(color));
            let curve = |c: DVec3| match own {
                Some(OwnCurve(own)) => finite(own(c.clamp(DVec3::ZERO, DVec3::splat(65504.0)))),
                None => tone_curve(c, number, generic),
            };
            let shown = tone_map_with(graded, tone_in_rec2020(number), curve, luminance_scaling, gamut_mapping);
            let codes = srgb_from_linear(shown);
            extras.colors.as_ref().map_or(codes, |colors| colors.sample(codes).clamp(DVec3::ZERO, DVec3::ONE))
        })
    }
}
