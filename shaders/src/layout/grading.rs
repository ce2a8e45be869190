//! Mirror of `GradingUniforms` of `wgsl/effect/grade.wgsl`.

use crate::reference::grade::Grade;
use bytemuck::{Pod, Zeroable};
use glam::{DMat3, Vec3, Vec4};

/// Settings of the effect `grade`, packed from [`Grade`].
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GradingUniforms {
    /// Columns of [`Grade::into`]; w is unused.
    pub into: [Vec4; 3],
    /// Columns of [`Grade::mixer`]; w is unused.
    pub mixer: [Vec4; 3],
    /// Columns of [`Grade::out_of`]; w is unused.
    pub out_of: [Vec4; 3],
    /// Copy of [`Grade::ranges`].
    pub ranges: Vec4,
    /// Copy of [`Grade::weights`].
    pub weights: Vec3,
    /// Copy of [`Grade::exposure`].
    pub exposure: f32,
    /// First entry of [`Grade::tones`].
    pub shadows: Vec3,
    /// Copy of [`Grade::night`].
    pub night: f32,
    /// Second entry of [`Grade::tones`].
    pub midtones: Vec3,
    /// Copy of [`Grade::contrast`].
    pub contrast: f32,
    /// Third entry of [`Grade::tones`].
    pub highlights: Vec3,
    /// Copy of [`Grade::vibrance`].
    pub vibrance: f32,
    /// Copy of [`Grade::slope`].
    pub slope: Vec3,
    /// Copy of [`Grade::saturation`].
    pub saturation: f32,
    /// Copy of [`Grade::offset`].
    pub offset: Vec3,
    /// Padding; zero.
    pub _pad0: f32,
    /// Copy of [`Grade::power`].
    pub power: Vec3,
    /// Padding; zero.
    pub _pad1: f32,
    /// Copy of [`Grade::shadow_gamma`].
    pub shadow_gamma: Vec3,
    /// Padding; zero.
    pub _pad2: f32,
    /// Copy of [`Grade::middle`].
    pub middle: Vec3,
    /// Padding; zero.
    pub _pad3: f32,
    /// Copy of [`Grade::highlight_scale`].
    pub highlight_scale: Vec3,
    /// Padding; zero.
    pub _pad4: f32,
}

impl GradingUniforms {
    /// Packs the computed values of a grade.
    pub fn new(grade: &Grade) -> Self {
        let columns = |m: DMat3| [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.as_vec3().extend(0.0));
        let [shadows, midtones, highlights] = grade.tones.map(|tone| tone.as_vec3());
        Self {
            into: columns(grade.into),
            mixer: columns(grade.mixer),
            out_of: columns(grade.out_of),
            ranges: Vec4::from_array(grade.ranges.map(|x| x as f32)),
            weights: grade.weights.as_vec3(),
            exposure: grade.exposure as f32,
            shadows,
            night: grade.night as f32,
            midtones,
            contrast: grade.contrast as f32,
            highlights,
            vibrance: grade.vibrance as f32,
            slope: grade.slope.as_vec3(),
            saturation: grade.saturation as f32,
            offset: grade.offset.as_vec3(),
            power: grade.power.as_vec3(),
            shadow_gamma: grade.shadow_gamma.as_vec3(),
            middle: grade.middle.as_vec3(),
            highlight_scale: grade.highlight_scale.as_vec3(),
            ..Self::zeroed()
        }
    }
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(GradingUniforms {
        into,
        mixer,
        out_of,
        ranges,
        weights,
        exposure,
        shadows,
        night,
        midtones,
        contrast,
        highlights,
        vibrance,
        slope,
        saturation,
        offset,
        _pad0,
        power,
        _pad1,
        shadow_gamma,
        _pad2,
        middle,
        _pad3,
        highlight_scale,
        _pad4
    })]
}
