//! All that happens to a color between radiance and code, but dither; and its value in f64.

use super::error::GradingError;
use framegraph_scene::ColorTable;
use framegraph_shaders::layout::{Grading, ToneMap};
use framegraph_shaders::reference::grade::Grade;
use framegraph_shaders::reference::srgb::srgb_from_linear;
use framegraph_shaders::reference::tone_map::{tone_curve, tone_in_rec2020, tone_map_with};
use glam::DVec3;
use std::fmt;
use std::sync::Arc;

/// Grading and tone curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Look {
    /// Before the curve.
    pub grading: Grading,
    /// The curve.
    pub tone_map: ToneMap,
    /// Only luminance goes through the curve, and hues stay (Filament's luminance scaling).
    pub luminance_scaling: bool,
    /// What the display cannot show is moved to where it can, at its hue, and not cut off (Filament's gamut mapping).
    pub gamut_mapping: bool,
}

/// A tone curve as a function of linear Rec.2020, to linear Rec.2020 of a display whose white is 1. It is called with
/// finite numbers, none below 0, from several threads; what it makes beyond 0…1 is cut off, and no number is 0.
#[derive(Clone)]
pub struct OwnCurve(Arc<dyn Fn(DVec3) -> DVec3 + Send + Sync>);

impl OwnCurve {
    /// A function as a curve.
    pub fn new(curve: impl Fn(DVec3) -> DVec3 + Send + Sync + 'static) -> Self {
        Self(Arc::new(curve))
    }
}

impl fmt::Debug for OwnCurve {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("OwnCurve")
    }
}

/// What a look may have beside its settings, known to tables alone.
#[derive(Clone, Debug, Default)]
pub struct Extras {
    /// The curve of [`ToneMap::Own`].
    pub own: Option<OwnCurve>,
    /// Colors that sRGB codes become at the end.
    pub colors: Option<Arc<ColorTable>>,
}

impl Look {
    /// Whether all of it is settings, which a shader can compute.
    ///
    /// # Errors
    /// [`GradingError::NeedsTable`] with what it is that is not.
    pub fn is_direct(&self, extras: &Extras) -> Result<(), GradingError> {
        match (self.tone_map, &extras.colors) {
            (ToneMap::Own, _) => Err(GradingError::NeedsTable { what: "a tone curve of one's own" }),
            (_, Some(_)) => Err(GradingError::NeedsTable { what: "a file of colors" }),
            _ => Ok(()),
        }
    }

    /// Whether the tone effect gives sRGB encoded colors: the curve is an encoded one, and neither luminance scaling nor gamut
    /// mapping, which work on light, follows.
    pub const fn is_encoded(&self) -> bool {
        self.tone_map.is_encoded() && !self.luminance_scaling && !self.gamut_mapping
    }

    /// Whether no channel of what comes out depends on another, so that a table of one axis holds it.
    pub fn keeps_channels_apart(&self, extras: &Extras) -> bool {
        // Grading in Rec.2020 mixes channels of Rec.709, but where it is left out.
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

    /// The look as a function of linear Rec.709 light to sRGB codes, 0…1.
    ///
    /// # Errors
    /// [`GradingError::NoOwnCurve`].
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
