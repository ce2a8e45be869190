//! Mirror of `GradingUniforms` of `wgsl/effect/grade.wgsl`, and the settings behind it.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use crate::reference::grading::white_balance;

/// Color grading as an author sets it; the default changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grading {
    /// White balance from blue (-1) to amber (1); 0 changes nothing.
    pub temperature: f32,
    /// White balance from green (-1) to magenta (1); 0 changes nothing.
    pub tint: f32,
    /// Factor on the LogC value of each channel (ASC CDL slope).
    pub slope: Vec3,
    /// Added to the LogC value of each channel (ASC CDL offset).
    pub offset: Vec3,
    /// Exponent of the LogC value of each channel, above 0 (ASC CDL power).
    pub power: Vec3,
    /// Factor on the distance from 18 % grey in LogC, 0…2.
    pub contrast: f32,
    /// Saturation of colors of low saturation, reds least, 0…2.
    pub vibrance: f32,
    /// Saturation, from 0 for grey to 2; 1 changes nothing.
    pub saturation: f32,
}

impl Grading {
    /// Settings that change nothing.
    pub const NEUTRAL: Self = Self {
        temperature: 0.0,
        tint: 0.0,
        slope: Vec3::ONE,
        offset: Vec3::ZERO,
        power: Vec3::ONE,
        contrast: 1.0,
        vibrance: 1.0,
        saturation: 1.0,
    };
}

impl Default for Grading {
    fn default() -> Self {
        Self::NEUTRAL
    }
}

/// Settings of the effect `grade`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GradingUniforms {
    /// Columns of the white balance matrix on linear Rec.709; w is unused.
    pub white_balance: [Vec4; 3],
    /// [`Grading::slope`], not negative.
    pub slope: Vec3,
    /// [`Grading::contrast`].
    pub contrast: f32,
    /// [`Grading::offset`].
    pub offset: Vec3,
    /// [`Grading::vibrance`].
    pub vibrance: f32,
    /// [`Grading::power`], positive.
    pub power: Vec3,
    /// [`Grading::saturation`].
    pub saturation: f32,
}

impl GradingUniforms {
    /// Packs the settings; values beyond their range are clamped.
    pub fn new(grading: &Grading) -> Self {
        let Grading { temperature, tint, slope, offset, power, contrast, vibrance, saturation } = *grading;
        let balance = white_balance(temperature.into(), tint.into());
        Self {
            white_balance: [balance.x_axis, balance.y_axis, balance.z_axis].map(|axis| axis.as_vec3().extend(0.0)),
            slope: slope.max(Vec3::ZERO),
            contrast: contrast.clamp(0.0, 2.0),
            offset,
            vibrance: vibrance.clamp(0.0, 2.0),
            power: power.max(Vec3::splat(1e-5)),
            saturation: saturation.clamp(0.0, 2.0),
        }
    }
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(GradingUniforms { white_balance, slope, contrast, offset, vibrance, power, saturation })]
}
