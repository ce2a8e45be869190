//! What materials state in their [`Extras`]: Filament's material properties that glTF has no words for.

use super::extras::Extras;
use super::source::Warnings;
use crate::material::{AlphaMode, Material, Subsurface};

/// Reads the extras of a material into it.
pub(super) fn read(extras: &Extras<'_>, warnings: &mut Warnings, material: &mut Material) {
    let changes = extras.flag("clearCoatIorChange", warnings);
    if let (Some(coat), Some(changes)) = (&mut material.clear_coat, changes) {
        coat.keeps_base_f0 = !changes;
    }
    if let Some(given) = extras.child("subsurface", warnings) {
        let usual = Subsurface::default();
        material.subsurface = Some(Subsurface {
            color: given.color("color", warnings).unwrap_or(usual.color),
            power: given.number("power", [0.0, Subsurface::MAX_POWER], warnings).unwrap_or(usual.power),
            thickness: given.number("thickness", [0.0, 1.0], warnings).unwrap_or(usual.thickness),
        });
    }
    if let Some(strength) = extras.number("shadowCatcher", [0.0, 1.0], warnings) {
        (material.shadow_catcher, material.unlit, material.alpha) = (Some(strength), true, AlphaMode::Blend);
    }
    material.cloth_subsurface = extras.color("clothSubsurface", warnings);
}
