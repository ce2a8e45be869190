//! Mirror of `GradingUniforms` of `wgsl/effect/grade.wgsl`.

use crate::reference::grade::Grade;
use bytemuck::{Pod, Zeroable};
use glam::{DMat3, Vec3, Vec4};

/// Settings of the effect `grade`: those of [`Grade`].
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GradingUniforms {
    /// Columns; w is unused.
    pub into: [Vec4; 3],
    /// Columns; w is unused.
    pub mixer: [Vec4; 3],
    /// Columns; w is unused.
    pub out_of: [Vec4; 3],
    /// [`Grade::ranges`].
    pub ranges: Vec4,
    /// [`Grade::weights`].
    pub weights: Vec3,
    /// [`Grade::exposure`].
    pub exposure: f32,
    /// The first of [`Grade::tones`].
    pub shadows: Vec3,
    /// [`Grade::night`].
    pub night: f32,
    /// The second of [`Grade::tones`].
    pub midtones: Vec3,
    /// [`Grade::contrast`].
    pub contrast: f32,
    /// The third of [`Grade::tones`].
    pub highlights: Vec3,
    /// [`Grade::vibrance`].
    pub vibrance: f32,
    /// [`Grade::slope`].
    pub slope: Vec3,
    /// [`Grade::saturation`].
    pub saturation: f32,
    /// [`Grade::offset`].
    pub offset: Vec3,
    /// Padding; zero.
    pub _pad0: f32,
    /// [`Grade::power`].
    pub power: Vec3,
    /// Padding; zero.
    pub _pad1: f32,
    /// [`Grade::shadow_gamma`].
    pub shadow_gamma: Vec3,
    /// Padding; zero.
    pub _pad2: f32,
    /// [`Grade::middle`].
    pub middle: Vec3,
    /// Padding; zero.
    pub _pad3: f32,
    /// [`Grade::highlight_scale`].
    pub highlight_scale: Vec3,
    /// Padding; zero.
    pub _pad4: f32,
}

impl GradingUniforms {
    /// Packs what was worked out.
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
