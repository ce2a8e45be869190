//! Mirror of `GradingUniforms` of `wgsl/effect/grade.wgsl`, and the settings behind it.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use crate::reference::grading::white_balance;

/// Color grading as an author sets it; the default changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grading {
    /// Colder (-1) to warmer (1).
    pub temperature: f32,
    /// Greener (-1) to more magenta (1).
    pub tint: f32,
    /// Factor on LogC, by channel.
    pub slope: Vec3,
    /// Added to LogC, by channel.
    pub offset: Vec3,
    /// Exponent of LogC, by channel; above 0.
    pub power: Vec3,
    /// About 18 % grey, 0…2.
    pub contrast: f32,
    /// Saturation of all but reds, 0…2.
    pub vibrance: f32,
    /// 0 (grey) … 2.
    pub saturation: f32,
}

impl Grading {
    /// Changes nothing.
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
    /// Columns of the matrix of white balance; w is unused.
    pub white_balance: [Vec4; 3],
    /// Factor.
    pub slope: Vec3,
    /// About 18 % grey.
    pub contrast: f32,
    /// Added.
    pub offset: Vec3,
    /// Saturation of all but reds.
    pub vibrance: f32,
    /// Exponent.
    pub power: Vec3,
    /// 0 is grey.
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
