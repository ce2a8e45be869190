//! What materials state in their [`Extras`]: Filament's material properties that glTF has no words for.

use super::extras::Extras;
use super::source::Warnings;
use crate::material::Material;

/// Reads the extras of a material into it.
pub(super) fn read(extras: &Extras<'_>, warnings: &mut Warnings, material: &mut Material) {
    let changes = extras.flag("clearCoatIorChange", warnings);
    if let (Some(coat), Some(changes)) = (&mut material.clear_coat, changes) {
        coat.keeps_base_f0 = !changes;
    }
}
