//! EXT_mesh_gpu_instancing: several instances of a node's mesh.

use super::accessor::floats;
use super::limits::MAX_INSTANCES;
use super::source::Source;
use crate::error::{Quantity, SceneError};
use glam::{DMat4, DQuat, DVec3};

/// Reads the instance transforms of a node, relative to the node; `None` for a node without the extension.
///
/// # Errors
///
/// Fails for attributes of different lengths, values that are not finite, rotations of zero length, and too many
/// instances.
pub(super) fn read(source: &Source<'_>, node: usize, at: &str) -> Result<Option<Vec<DMat4>>, SceneError> {
    let extensions = source.root.nodes[node].extensions.as_ref();
    let Some(extension) = extensions.and_then(|e| e.others.get("EXT_mesh_gpu_instancing")) else {
        return Ok(None);
    };
    let at = format!("{at}: EXT_mesh_gpu_instancing");
    let accessor = |name: &str| match extension.get("attributes").and_then(|attributes| attributes.get(name)) {
        None => Ok(None),
        Some(index) => match index.as_u64().and_then(|index| usize::try_from(index).ok()) {
            Some(index) => Ok(Some(index)),
            None => Err(source.malformed(&at, format!("its {name} is not an accessor index"))),
        },
    };
    let vectors =
        |name: &str| accessor(name)?.map(|index| floats::<3>(source, index, &format!("{at} {name}"))).transpose();
    let translations = vectors("TRANSLATION")?;
    let scales = vectors("SCALE")?;
    let rotations =
        accessor("ROTATION")?.map(|index| floats::<4>(source, index, &format!("{at} ROTATION"))).transpose()?;
    let lengths =
        [translations.as_ref().map(Vec::len), rotations.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
    let Some(count) = lengths.into_iter().flatten().next() else {
        // Custom attributes alone define no transforms.
        return Ok(None);
    };
    if lengths.into_iter().flatten().any(|length| length != count) {
        return Err(source.malformed(&at, "its attributes have different lengths"));
    }
    if count > MAX_INSTANCES {
        return Err(source.too_large(Quantity::Instances, count as u64, MAX_INSTANCES as u64));
    }
    source.charge(count as u64 * size_of::<DMat4>() as u64)?;
    let place = |number: usize| {
        let vector = |all: &Option<Vec<[f32; 3]>>, default| {
            all.as_ref().map_or(default, |all| DVec3::from_array(all[number].map(f64::from)))
        };
        let rotation = rotations.as_ref().map_or(DQuat::IDENTITY, |all| DQuat::from_array(all[number].map(f64::from)));
        let length = rotation.length();
        if !(length > 1e-6 && length.is_finite()) {
            return Err(source.malformed(&at, format!("the rotation of instance {number} has no length")));
        }
        let (scale, translation) = (vector(&scales, DVec3::ONE), vector(&translations, DVec3::ZERO));
        let transform = DMat4::from_scale_rotation_translation(scale, rotation / length, translation);
        if transform.is_finite() {
            Ok(transform)
        } else {
            Err(source.malformed(&at, format!("the transform of instance {number} is not finite")))
        }
    };
    (0..count).map(place).collect::<Result<_, _>>().map(Some)
}
