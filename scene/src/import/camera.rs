//! glTF cameras (section 3.10).

use std::f64::consts::PI;

use gltf_json::camera::{Camera as JsonCamera, Type};
use gltf_json::validation::Checked;

use super::node::{Attached, FlatNode};
use super::source::{Source, Warnings, beyond};
use crate::camera::{Camera, Projection};
use crate::error::{SceneError, one_line};

/// Appends the cameras of all nodes; returns the node (by list position) and the file index of each. A camera is named
/// after itself; without a name, or if several nodes share it, after its node; otherwise `camera N`.
pub(super) fn import(
    source: &Source<'_>,
    nodes: &[FlatNode],
    cameras: &mut Vec<Camera>,
    warnings: &mut Warnings,
) -> Result<Vec<Attached>, SceneError> {
    let mut attached = Vec::new();
    let all = &source.root.cameras;
    for (place, node) in nodes.iter().enumerate() {
        let Some(index) = node.camera else {
            continue;
        };
        let json = all.get(index).ok_or_else(|| source.malformed(&node.at, beyond("camera", index, all)))?;
        let at = format!("camera {index}");
        // A field of view of π or more is valid by section 5.15.4, but shows nothing.
        if json.perspective.as_ref().is_some_and(|p| p.yfov.is_finite() && f64::from(p.yfov) >= PI) {
            warnings.push(format!("{at}: its yfov is not below π radians; it is left out"));
            continue;
        }
        let projection = projection(json).map_err(|reason| source.malformed(&at, reason))?;
        let own = one_line(json.name.as_deref().unwrap_or_default());
        let free = |name: &str| !name.is_empty() && cameras.iter().all(|c| c.name != name);
        let name = [own, node.name.clone()]
            .into_iter()
            .find(|name| free(name))
            .unwrap_or_else(|| format!("camera {}", cameras.len()));
        match Camera::of_node(&name, &node.world_from_node, projection) {
            Some(camera) => {
                cameras.push(camera);
                attached.push(Attached { node: place, index });
            }
            None => warnings.push(format!("{}: its camera has no view direction and is left out", node.at)),
        }
    }
    Ok(attached)
}

fn projection(json: &JsonCamera) -> Result<Projection, String> {
    let checked = |what: &str, value: f32, good: bool, rule: &str| {
        let told = || format!("its {what} is {value}; it must be {rule}");
        if good && value.is_finite() { Ok(f64::from(value)) } else { Err(told()) }
    };
    const POSITIVE: &str = "finite and above 0";
    const BEYOND: &str = "finite and above znear";
    match (&json.type_, &json.perspective, &json.orthographic) {
        (Checked::Valid(Type::Perspective), Some(p), _) => {
            let near_m = checked("znear", p.znear, p.znear > 0.0, POSITIVE)?;
            let far_m = match p.zfar {
                Some(zfar) => Some(checked("zfar", zfar, zfar > p.znear, BEYOND)?),
                None => None,
            };
            let in_range = p.yfov > 0.0 && f64::from(p.yfov) < PI;
            let fov_y_rad = checked("yfov", p.yfov, in_range, "above 0 and below π, in radians")?;
            Ok(Projection::Perspective { fov_y_rad, near_m, far_m })
        }
        (Checked::Valid(Type::Orthographic), _, Some(o)) => Ok(Projection::Orthographic {
            half_width_m: Some(checked("xmag", o.xmag, o.xmag != 0.0, "finite and not 0")?.abs()),
            half_height_m: checked("ymag", o.ymag, o.ymag != 0.0, "finite and not 0")?.abs(),
            near_m: checked("znear", o.znear, o.znear >= 0.0, "finite and at least 0")?,
            far_m: checked("zfar", o.zfar, o.zfar > o.znear, BEYOND)?,
        }),
        _ => Err("its type is unknown or has no parameters".into()),
    }
}
