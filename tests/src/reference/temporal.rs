//! Conversion of stated temporal anti-aliasing to our settings.

use super::document::{Taa, TaaBox, TaaClipping, TaaJitter};
use framegraph_passes::effects::taa::{Clipping, ColorBox, JitterPattern, TaaSettings};

/// Number of frames that the references accumulate.
pub const FRAMES: u32 = 24;

/// Converts temporal anti-aliasing; missing options have Filament's defaults.
pub fn settings(stated: &Taa) -> TaaSettings {
    let own = TaaSettings::DEFAULT;
    let number = |value: Option<f64>, default: f32| value.map_or(default, |value| value as f32);
    TaaSettings {
        feedback: number(stated.feedback, own.feedback),
        filter_width: number(stated.filter_width, own.filter_width),
        sharpness: number(stated.sharpness, own.sharpness),
        jitter: stated.jitter_pattern.map_or(own.jitter, |pattern| match pattern {
            TaaJitter::Rgss4 => JitterPattern::Rgss4,
            TaaJitter::Helix4 => JitterPattern::Helix4,
            TaaJitter::Halton8 => JitterPattern::Halton8,
            TaaJitter::Halton16 => JitterPattern::Halton16,
            TaaJitter::Halton32 => JitterPattern::Halton32,
        }),
        color_box: stated.box_type.map_or(own.color_box, |kind| match kind {
            TaaBox::Aabb => ColorBox::Bounds,
            TaaBox::Variance => ColorBox::Variance,
            TaaBox::AabbVariance => ColorBox::Both,
        }),
        clipping: stated.box_clipping.map_or(own.clipping, |clipping| match clipping {
            TaaClipping::Accurate => Clipping::Accurate,
            TaaClipping::Clamp => Clipping::Clamp,
            TaaClipping::None => Clipping::None,
        }),
        variance_gamma: number(stated.variance_gamma, own.variance_gamma),
        filter_history: stated.filter_history.unwrap_or(own.filter_history),
        filter_input: stated.filter_input.unwrap_or(own.filter_input),
        ycocg: stated.use_ycocg.unwrap_or(own.ycocg),
        prevent_flickering: stated.prevent_flickering.unwrap_or(own.prevent_flickering),
        reproject: stated.history_reprojection.unwrap_or(own.reproject),
        ..own
    }
}
