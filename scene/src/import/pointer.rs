//! KHR_animation_pointer: properties targeted by JSON pointers of animation channels.

use serde_json::Value;

use super::channel_pointer::pointers;
use super::source::Source;
use crate::material::MaterialId;
use crate::motion::property::{EMISSIVE, STRENGTH};
use crate::motion::{CameraProperty, LightProperty, MaterialProperty, NodeProperty, Target};

/// Parts of a scene that a pointer may refer to.
pub(super) struct Parts<'a> {
    /// List position of each node of the file.
    pub places: &'a [Option<usize>],
    /// File index of each light of the scene.
    pub lights: &'a [usize],
    /// File index of each camera of the scene.
    pub cameras: &'a [usize],
    /// Materials of the scene by file index.
    pub material: &'a dyn Fn(usize) -> Option<MaterialId>,
    /// Number of morph targets of a node, by its list position.
    pub targets: &'a dyn Fn(usize) -> usize,
}

/// Properties targeted by a pointer.
pub(super) struct Pointed {
    /// Targets: several if nodes share a light or a camera; none if the scene does not use the object.
    pub targets: Vec<Target>,
    /// Numbers per value.
    pub width: usize,
    /// Conversion from values of the file to values of the target.
    pub scale: Scale,
}

/// Conversion from values of the file to values of a property.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scale {
    /// Values are used unchanged.
    None,
    /// Each number is multiplied by a factor.
    By(f32),
    /// One number becomes three, multiplied by these factors.
    Spread([f32; 3]),
}

/// Resolves a pointer of an animation; `None` for a property that cannot be animated.
pub(super) fn resolve(source: &Source<'_>, animation: usize, pointer: &str, parts: &Parts<'_>) -> Option<Pointed> {
    let mut words = pointer.strip_prefix('/')?.splitn(3, '/');
    let (kind, index, rest) = (words.next()?, words.next()?, words.next()?);
    let plain = |targets: Vec<Target>, width| Some(Pointed { targets, width, scale: Scale::None });
    match kind {
        "nodes" => {
            let place = *parts.places.get(index.parse::<usize>().ok()?)?;
            let (property, width) = match rest {
                "translation" => (NodeProperty::Translation, 3),
                "rotation" => (NodeProperty::Rotation, 4),
                "scale" => (NodeProperty::Scale, 3),
                "weights" => (NodeProperty::Weights, place.map_or(0, parts.targets)),
                _ => return None,
            };
            plain(place.map(|place| Target::Node(place, property)).into_iter().collect(), width)
        }
        "materials" => {
            let index: usize = index.parse().ok()?;
            source.root.materials.get(index)?;
            let target =
                |property| (parts.material)(index).map(|id| Target::Material(id, property)).into_iter().collect();
            let factors = || source.json.get("materials").and_then(|all| all.get(index));
            // Emission is one color here, factor times strength. If both are animated, the strength multiplies the
            // factor.
            let has = |property: &str| {
                let animation = source.json.get("animations").and_then(|all| all.get(animation));
                animation.into_iter().flat_map(pointers).any(|own| own == format!("/materials/{index}/{property}"))
            };
            if rest == STRENGTH && !has(EMISSIVE) {
                let factor = factors().and_then(|material| material.get(EMISSIVE)).and_then(Value::as_array);
                let channel = |i: usize| factor.and_then(|f| f.get(i)).and_then(Value::as_f64).unwrap_or(0.0) as f32;
                let scale = Scale::Spread([0, 1, 2].map(channel));
                return Some(Pointed { targets: target(MaterialProperty::at(EMISSIVE)?), width: 1, scale });
            }
            let property = MaterialProperty::at(rest)?;
            let strength = || factors().and_then(|material| material.pointer(&format!("/{STRENGTH}"))?.as_f64());
            let scale = match rest {
                EMISSIVE if !has(STRENGTH) => Scale::By(strength().unwrap_or(1.0) as f32),
                _ => Scale::None,
            };
            Some(Pointed { targets: target(property), width: property.width(), scale })
        }
        "cameras" => {
            let index: usize = index.parse().ok()?;
            source.root.cameras.get(index)?;
            let property = match rest {
                "perspective/yfov" => CameraProperty::FovY,
                "perspective/znear" | "orthographic/znear" => CameraProperty::Near,
                "perspective/zfar" | "orthographic/zfar" => CameraProperty::Far,
                "orthographic/xmag" => CameraProperty::HalfWidth,
                "orthographic/ymag" => CameraProperty::HalfHeight,
                _ => return None,
            };
            plain(places_of(parts.cameras, index).map(|camera| Target::Camera(camera, property)).collect(), 1)
        }
        "extensions" if index == "KHR_lights_punctual" => {
            let (index, rest) = rest.strip_prefix("lights/")?.split_once('/')?;
            let index: usize = index.parse().ok()?;
            source.root.extensions.as_ref()?.khr_lights_punctual.as_ref()?.lights.get(index)?;
            let property = match rest {
                "color" => LightProperty::Color,
                "intensity" => LightProperty::Intensity,
                "range" => LightProperty::Range,
                "spot/innerConeAngle" => LightProperty::InnerCone,
                "spot/outerConeAngle" => LightProperty::OuterCone,
                _ => return None,
            };
            let targets = places_of(parts.lights, index).map(|light| Target::Light(light, property)).collect();
            plain(targets, property.width())
        }
        _ => None,
    }
}

/// Returns the positions of `index` in a list.
fn places_of(all: &[usize], index: usize) -> impl Iterator<Item = usize> {
    all.iter().enumerate().filter(move |(_, own)| **own == index).map(|(place, _)| place)
}

impl Scale {
    /// Scales consecutive values of `width` numbers each.
    pub fn apply(self, values: Vec<f64>) -> Vec<f64> {
        match self {
            Self::None => values,
            Self::By(factor) => values.into_iter().map(|value| value * f64::from(factor)).collect(),
            Self::Spread(factors) => {
                values.into_iter().flat_map(|value| factors.map(|factor| value * f64::from(factor))).collect()
            }
        }
    }
}
