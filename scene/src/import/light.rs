//! KHR_lights_punctual.

use std::f32::consts::FRAC_PI_2;

use glam::{DVec3, Vec3};
use gltf_json::extensions::scene::khr_lights_punctual::Light as JsonLight;
use gltf_json::extensions::scene::khr_lights_punctual::Type;
use gltf_json::validation::Checked;

use super::node::{Attached, FlatNode};
use super::source::{Source, Warnings, beyond};
use super::switches::Switches;
use crate::draw_options::DEFAULT_MASK;
use crate::error::{SceneError, one_line};
use crate::light::{Light, LightKind};

/// Appends the lights of all nodes; returns the node (by list position) and the file index of each.
pub(super) fn import(
    source: &Source<'_>,
    nodes: &[FlatNode],
    lights: &mut Vec<Light>,
    warnings: &mut Warnings,
) -> Result<Vec<Attached>, SceneError> {
    let mut attached = Vec::new();
    let extensions = source.root.extensions.as_ref();
    let all: &[JsonLight] = extensions.and_then(|e| e.khr_lights_punctual.as_ref()).map_or(&[], |e| &e.lights);
    for (place, node) in nodes.iter().enumerate() {
        let Some(index) = node.light else {
            continue;
        };
        let json = all.get(index).ok_or_else(|| source.malformed(&node.at, beyond("light", index, all)))?;
        let at = format!("light {index}");
        if json.type_ == Checked::Invalid {
            warnings.push(format!("{at}: its type is unknown; it is left out"));
            continue;
        }
        let kind = kind(json, &at, warnings).map_err(|reason| source.malformed(&at, reason))?;
        let color = Vec3::from_array(json.color);
        if !(color.is_finite() && color.min_element() >= 0.0) {
            return Err(source.malformed(&at, format!("its color is {color}")));
        }
        let is_point = matches!(kind, LightKind::Point { .. });
        let direction = match Light::direction_of_node(&node.world_from_node) {
            Some(direction) => direction,
            None if is_point => Vec3::NEG_Z,
            None => {
                let reason = "its light has no direction: the node's z axis has no length";
                return Err(source.malformed(&node.at, reason));
            }
        };
        let position = match kind {
            LightKind::Directional { .. } => DVec3::ZERO,
            _ => node.world_from_node.w_axis.truncate(),
        };
        let name = json.name.as_deref().filter(|name| !name.is_empty());
        let name = one_line(name.unwrap_or(&node.name));
        let mut light = Light {
            name,
            kind,
            color,
            position,
            direction,
            rest: Some(attached.len()),
            shadow_strength: 1.0,
            halo: None,
            channels: DEFAULT_MASK,
        };
        let pointer = format!("/extensions/KHR_lights_punctual/lights/{index}");
        Switches::of(source.document, &pointer, &at, warnings).light(&mut light);
        lights.push(light);
        attached.push(Attached { node: place, index });
    }
    Ok(attached)
}

/// Returns the shape and strength of a light, with every number validated.
fn kind(json: &JsonLight, at: &str, warnings: &mut Warnings) -> Result<LightKind, String> {
    let Checked::Valid(shape) = json.type_ else {
        return Err("unknown type".into());
    };
    let strength = json.intensity;
    if !(strength >= 0.0 && strength.is_finite()) {
        return Err(format!("its intensity is {strength}"));
    }
    if let Some(range) = json.range
        && !(range > 0.0 && range.is_finite())
    {
        return Err(format!("its range is {range}, not above 0"));
    }
    let range_m = json.range;
    Ok(match shape {
        Type::Directional => LightKind::Directional { illuminance_lux: strength, angular_radius_rad: 0.0 },
        Type::Point => LightKind::Point { intensity_candela: strength, range_m },
        Type::Spot => {
            let spot = json.spot.as_ref().ok_or("it is a spot without cone angles")?;
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            if !(inner.is_finite() && outer.is_finite() && inner >= 0.0 && outer > 0.0) {
                return Err(format!("its cone angles are {inner} and {outer}"));
            }
            // Keeps the cone angles slightly apart, so that the falloff stays finite.
            let outer_cone_rad = outer.min(FRAC_PI_2);
            let inner_cone_rad = inner.min(outer_cone_rad * 0.999);
            if (inner_cone_rad, outer_cone_rad) != (inner, outer) {
                warnings.push(format!(
                    "{at}: its cone angles {inner} and {outer} were clamped to {inner_cone_rad} and {outer_cone_rad}"
                ));
            }
            LightKind::Spot { intensity_candela: strength, range_m, inner_cone_rad, outer_cone_rad }
        }
    })
}
